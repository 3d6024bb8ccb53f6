"""The figures and films of the classification report, with their captions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

import matplotlib.figure
import xarray as xr

from eigenwalker.analysis.classification import Classification, results_of_panels
from eigenwalker.analysis.contrast import Contrast
from eigenwalker.analysis.trait_study import TraitStudy
from eigenwalker.core.walker import Walker
from eigenwalker.decomposition.pca import decompose_pca
from eigenwalker.plotting.components import figure_scores, figure_variance
from eigenwalker.plotting.curves import figure_curves, figure_regression_curves
from eigenwalker.plotting.eigenpostures import figure_eigenpostures
from eigenwalker.plotting.style import INK, NEGATIVE, POSITIVE
from eigenwalker.plotting.walker_films import Style, write_film
from eigenwalker.plotting.walker_space_figure import figure_space
from eigenwalker.plotting.walkers import figure_joints, figure_walkers
from eigenwalker.report.blocks import Figure, Film
from eigenwalker.report.words import figure


def draw_figures(study: TraitStudy, example: xr.DataArray | None) -> dict[str, Figure]:
    """Return all figures of a study by name, those of a walk if there is an example."""
    result, contrast = study.result, study.result.contrast
    drawings: dict[str, matplotlib.figure.Figure] = {}
    if any(walker.fit is not None for walker in study.walkers):
        drawings["variance"] = figure_variance(study.walkers)
    if example is not None:
        drawings["scores"] = figure_scores(example, decompose_pca(example))
    drawings["joints"] = figure_joints(study.average)
    drawings["eigenpostures"] = figure_eigenpostures(study.average)
    if isinstance(result, Classification):
        curves = {each.input.title: each.curves for each in results_of_panels(result.results)}
        drawings["class curves"] = figure_curves(curves, n_walkers=len(contrast.rows))
    else:
        curves = {each.input.title: each.curves for each in results_of_panels(result.results)}
        drawings["regression curves"] = figure_regression_curves(curves)
    for kind, view in study.views.items():
        drawings[kind] = figure_walkers(view.walkers, colors=_inks(view.walkers, contrast))
    if study.class_averages:
        inks = _inks(study.class_averages, contrast)
        drawings["classes"] = figure_walkers(study.class_averages, colors=inks)
    drawings["space"] = figure_space(
        study.space,
        study.X,
        contrast.labels,
        trait_name=contrast.trait,
        step=study.views["discriminant"].step,
        poles=(contrast.negative, contrast.positive),
    )
    source = "one walk" if example is None else str(example.attrs.get("source", "one walk"))
    names = {"trait": contrast.trait, "negative": contrast.negative, "positive": contrast.positive}
    names["source"] = source[:1].upper() + source[1:].replace("_", " ")
    return {name: figure(drawing, name, **names) for name, drawing in drawings.items()}


def _inks(walkers: Iterable[str], contrast: Contrast) -> list[str]:
    """Return the colour of the class after which each walker is called; black for an average."""
    if not contrast.two_classes:
        return []
    poles = {contrast.positive: POSITIVE, contrast.negative: NEGATIVE}
    by_length = sorted(poles, key=len, reverse=True)  # "old" before "o"
    return [
        next((poles[pole] for pole in by_length if title.startswith(pole)), INK)
        for title in walkers
    ]


def write_films(walkers: Mapping[str, Walker], stem: Path) -> list[Film]:
    """Film walkers side by side: the first, middle and last as points of light, all as sticks.

    The films are ``STEM-dots.mp4`` and ``STEM-sticks.mp4``.
    """
    titles = list(walkers)
    ends = [titles[0], titles[len(titles) // 2], titles[-1]]
    kinds: list[tuple[Style, str, list[str]]] = [
        ("dots", "Points of light", ends),
        ("sticks", "Sticks", titles),
    ]
    films = []
    for style, name, shown in kinds:
        path = write_film(
            [walkers[title] for title in shown],
            stem.with_name(f"{stem.name}-{style}.mp4"),
            n_strides=2,
            azimuth_deg=30,
            size_px=420,
            style=style,
            titles=shown,
        )
        caption = f"{name}: {', '.join(shown)}, in one tempo."
        films.append(Film(path, caption, f"Film of walkers side by side. {caption}"))
    return films
