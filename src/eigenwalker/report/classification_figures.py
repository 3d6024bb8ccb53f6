"""The figures and films of the classification report, with their captions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import xarray as xr

from eigenwalker.analysis.classification import N_PANELS, Classification, Regression
from eigenwalker.analysis.contrast import Contrast
from eigenwalker.analysis.trait_study import TraitStudy
from eigenwalker.core.walker import Walker
from eigenwalker.decomposition.pca import decompose_pca
from eigenwalker.plotting.components import figure_scores, figure_variance
from eigenwalker.plotting.curves import figure_curves, figure_regression_curves
from eigenwalker.plotting.eigenpostures import figure_eigenpostures
from eigenwalker.plotting.walker_films import Style, write_film
from eigenwalker.plotting.walker_space_figure import figure_space
from eigenwalker.plotting.walkers import figure_joints, figure_walkers
from eigenwalker.report.blocks import Figure, Film


def variance_figure(walkers: Sequence[Walker]) -> Figure:
    """Return the share of variance that each component has."""
    return Figure(
        figure_variance(walkers),
        "Variance of the first components, mean and standard deviation over walkers.",
        "Bar chart: most variance lies in the first component, little after the fourth.",
    )


def scores_figure(walk: xr.DataArray) -> Figure:
    """Return the scores of a walk over time, and the sines that take their place."""
    source = str(walk.attrs.get("source", "one walk"))
    return Figure(
        figure_scores(walk, decompose_pca(walk)),
        f"{source[:1].upper()}{source[1:].replace('_', ' ')}: scores of the eigenpostures over "
        "time, and below them the sines that take their place.",
        "Four wavy curves over five seconds, and below them the same as pure sines.",
    )


def average_walker_figures(average: Walker) -> list[Figure]:
    """Return the joints and the eigenpostures of the average walker."""
    return [
        Figure(
            figure_joints(average),
            "The joints of the average walker.",
            "Stick figure of the average walker from three sides, joints named.",
        ),
        Figure(
            figure_eigenpostures(average),
            "What each eigenposture of the average walker does to its mean posture (grey). Blue: "
            "the mean posture plus the eigenposture, with arrows from where each joint is on "
            "average; red and dashed: minus the eigenposture. Left limbs are paler. Small "
            "movements are drawn larger: 5-fold is five times what they are.",
            "Stick figures of the mean posture with each eigenposture added and taken away.",
        ),
    ]


def curves_figure(result: Classification | Regression) -> Figure:
    """Return how well each input predicts the trait, over the number of components."""
    if isinstance(result, Classification):
        panels = {each.input.title: each.curves for each in result.results[:N_PANELS]}
        return Figure(
            figure_curves(panels, n_walkers=len(result.contrast.rows)),
            "Misclassified walkers over the number of components: among those trained on (dashed) "
            "and among those left out (solid).",
            "Nine panels of two curves each: training errors fall to zero, errors on walkers left "
            "out stay above.",
        )
    panels = {each.input.title: each.curves for each in result.results[:N_PANELS]}
    return Figure(
        figure_regression_curves(panels),
        f"Share of the variance of {result.contrast.trait} explained over the number of "
        "components: of those trained on (dashed) and of those left out (solid). Below 0 the mean "
        "explains more; a curve that falls far below leaves its panel.",
        "Panels of two curves each: on those trained on the share explained rises to one, on those "
        "left out it stays below.",
    )


def poles_figure(walkers: Mapping[str, Walker], contrast: Contrast) -> Figure:
    """Return walkers from one pole of a trait to the other."""
    return Figure(
        figure_walkers(walkers),
        f"From {contrast.negative} to {contrast.positive}: standard deviations of the walkers "
        "along the axis.",
        "Stick figures from one pole of the trait to the other, front and side.",
    )


def class_averages_figure(walkers: Mapping[str, Walker]) -> Figure:
    """Return the average walker of either class, and both exaggerated."""
    return Figure(
        figure_walkers(walkers),
        "The average of either class, and their difference tripled.",
        "Stick figures of both classes' averages, and of both exaggerated.",
    )


def space_figure(study: TraitStudy) -> Figure:
    """Return walkers on the first two eigenwalkers, with the axis of the trait."""
    contrast = study.result.contrast
    drawing = figure_space(
        study.space,
        study.X,
        contrast.labels,
        trait_name=contrast.trait,
        step=study.views["discriminant"].step,
        poles=(contrast.negative, contrast.positive),
    )
    return Figure(
        drawing,
        "Walkers on the first two eigenwalkers, and the axis of the discriminant.",
        "Scatter plot of walkers with the axis of the trait drawn through the average.",
    )


def write_films(walkers: Mapping[str, Walker], stem: Path) -> list[Film]:
    """Film walkers side by side, as points of light and as sticks."""
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
