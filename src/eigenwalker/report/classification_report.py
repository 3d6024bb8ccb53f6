"""The report on a classification: who walked, what tells them apart, and how that looks."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr

from eigenwalker._version import __version__
from eigenwalker.analysis.classification import Classification, Regression
from eigenwalker.analysis.contrast import Contrast
from eigenwalker.analysis.direction import Kind
from eigenwalker.analysis.plausibility import Plausibility, plausibility
from eigenwalker.analysis.trait_axis import trait_axis
from eigenwalker.core.walker import Walker
from eigenwalker.population.population import Population
from eigenwalker.report.blocks import Block, Code, Items, Link, Report, Section, Text
from eigenwalker.report.classification_figures import (
    average_walker_figures,
    class_averages_figure,
    curves_figure,
    poles_figure,
    scores_figure,
    space_figure,
    variance_figure,
    write_films,
)
from eigenwalker.report.classification_tables import (
    chance_sentence,
    correlations_table,
    flags_table,
    gait_table,
    missed_table,
    multiple_inputs_sentence,
    plausibility_table,
    results_table,
    traits_table,
)
from eigenwalker.report.html_report import write_report

ALPHAS = (-6, -3, 0, 3, 6)
"""Standard deviations along the trait at which walkers are shown, up to the paper's 6."""
_CITE = (
    "Troje, N. F. (2002). Decomposing biological motion: A framework for analysis and synthesis of "
    "human gait patterns. Journal of Vision, 2(5), 371-387."
)


class _View(NamedTuple):
    """A way to show a trait: along which axis, of walkers with or without their size."""

    name: str
    description: str
    kind: Kind
    size_normalised: bool


_VIEWS = (
    _View(
        "discriminant",
        "Along the discriminant, in the space of the first ten eigenwalkers, as in the paper: what "
        "tells the walkers apart.",
        "discriminant",
        False,
    ),
    _View(
        "mean-difference",
        "Along the mean difference, size divided out: what goes along with the trait in build and "
        "movement, whoever is tall.",
        "mean_difference",
        True,
    ),
)


class _AlongTrait(NamedTuple):
    """Walkers from one pole of a trait to the other by title, and how plausible they are."""

    view: _View
    walkers: dict[str, Walker]
    plausibility: dict[str, Plausibility]
    step: np.ndarray


def write_classification_report(
    result: Classification | Regression,
    population: Population,
    folder: str | Path,
    *,
    example: xr.DataArray | None = None,
    beside: Link | None = None,
) -> Path:
    """Write a report on how well a trait can be told from gait, with films; return its page.

    Parameters
    ----------
    result : Classification or Regression
        As `classify` or `regress` gives it.
    population : Population
        Of which it is. Its flagged walkers are named in the report and left out of all else.
    folder : path
        Made where it does not exist; holds ``report.html`` and the films.
    example : DataArray of shape (time, marker, axis), optional
        A walk in place, to show how sines stand for its scores (Troje 2002, figure 3).
    beside : Link, optional
        A page in the same folder for the report to link to.

    Returns
    -------
    Path

    See Also
    --------
    eigenwalker.analysis.classify, eigenwalker.analysis.regress

    References
    ----------
    Troje (2002), figures 2 to 4 and eq. 13: walkers along the discriminant, up to 6 SD.

    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    contrast = result.contrast
    views = [_walk_along_trait(population, contrast, view) for view in _VIEWS]
    report = Report(
        title=f"{_capital(contrast.trait)} from gait",
        lead=_lead(result),
        sections=[
            Section("Who walked", _who(population)),
            Section("How well the model holds", _model(population, example)),
            Section("What tells them apart", _results(population, result)),
            Section("What it looks like", _appearance(folder, population, contrast, views)),
            Section("Mind", [Items(_cautions(population, contrast))]),
            Section("Made with", [Code(f"eigenwalker {__version__}\n{_CITE}")]),
        ],
        beside=beside,
    )
    return write_report(report, folder)


def _walk_along_trait(population: Population, contrast: Contrast, view: _View) -> _AlongTrait:
    shown = population.size_normalised() if view.size_normalised else population
    trait = contrast.trait
    if contrast.two_classes:
        trait += f"={contrast.negative}:{contrast.positive}"
    step = trait_axis(shown, trait, kind=view.kind).step
    vectors = {_title(contrast, alpha): shown.average + alpha * step for alpha in ALPHAS}
    return _AlongTrait(
        view,
        {title: shown.walker(vector) for title, vector in vectors.items()},
        {title: plausibility(shown, vector) for title, vector in vectors.items()},
        step,
    )


def _title(contrast: Contrast, alpha: float) -> str:
    if alpha == 0:
        return "average"
    return f"{contrast.positive if alpha > 0 else contrast.negative} {abs(alpha):g} SD"


def _class_averages(population: Population, contrast: Contrast) -> dict[str, Walker]:
    """Return the average walker of either class, and both with their difference tripled."""
    X = population.X[contrast.rows]
    low, high = X[contrast.y < 0].mean(axis=0), X[contrast.y > 0].mean(axis=0)
    middle, half = (high + low) / 2, (high - low) / 2
    return {
        f"{pole}, {name}": population.walker(middle + times * half)
        for name, factor in (("average", 1), ("tripled", 3))
        for pole, times in ((contrast.negative, -factor), (contrast.positive, factor))
    }


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:].replace("_", " ")


def _lead(result: Classification | Regression) -> str:
    n_walkers, best = len(result.contrast.rows), result.table().iloc[0]
    if isinstance(result, Classification):
        are = "is" if best["errors"] == 1 else "are"
        n = best["best n"]
        components = "component that does" if n == 1 else f"{n} components that do"
        return (
            f"Left out one at a time, {best['errors']} of {n_walkers} walkers {are} misclassified "
            f"from everything that is known of them, with the {components} best; "
            f"{best['nested errors']} when that number is chosen without them. "
            f"{chance_sentence(result)}"
        )
    return (
        f"Predicted from everything, {result.contrast.trait} of {n_walkers} walkers left out one "
        f"at a time correlates with the truth at {best['correlation']:.2f} (R2 {best['R2']:.2f}) "
        "with the number of components that does best; at "
        f"{best['nested correlation']:.2f} (R2 {best['nested R2']:.2f}) when that number is chosen "
        f"without them. {chance_sentence(result)}"
    )


def _who(population: Population) -> list[Block]:
    blocks: list[Block] = [
        Text(
            f"{len(population)} walkers with {len(population.layout.markers)} points each, "
            f"{population.flagged.sum()} of them flagged; "
            f"{len(population.feature_names)} numbers describe a walk."
        )
    ]
    provenance = [f"{key}: {v}" for key, v in population.provenance.items() if key != "recipe"]
    if provenance:
        blocks.append(Items(provenance))
    return blocks + [each for each in (traits_table(population), flags_table(population)) if each]


def _model(population: Population, example: xr.DataArray | None) -> list[Block]:
    used = population.unflagged() if not population.flagged.all() else population
    blocks: list[Block] = []
    fits = [walker.fit for walker in used.walkers if walker.fit is not None]
    if fits:
        shares = np.array([fit.variance_share[:4].sum() for fit in fits])
        blocks += [
            Text(
                f"Four principal components hold {100 * shares.mean():.1f} % of the variance of "
                f"a walk (mean over walkers); as sines they explain "
                f"{100 * np.mean([fit.r2 for fit in fits]):.1f} %, two Fourier harmonics "
                f"{100 * np.mean([fit.fourier_r2 for fit in fits]):.1f} %."
            ),
            variance_figure(used.walkers),
        ]
    if example is not None:
        blocks.append(scores_figure(example))
    if len(used) > 1:
        blocks.append(correlations_table(used.posture_correlations()))
    return blocks + average_walker_figures(population.walker(population.average))


def _results(population: Population, result: Classification | Regression) -> list[Block]:
    blocks: list[Block] = [results_table(result)]
    if sentence := multiple_inputs_sentence(result):
        blocks.append(Text(sentence))
    blocks.append(curves_figure(result))
    if isinstance(result, Classification) and (missed := missed_table(population, result)):
        blocks.append(missed)
    return blocks


def _appearance(
    folder: Path, population: Population, contrast: Contrast, views: list[_AlongTrait]
) -> list[Block]:
    stem = "".join(letter if letter.isalnum() else "-" for letter in contrast.trait)
    blocks: list[Block] = []
    for view, walkers, plausible, _ in views:
        blocks += [
            Text(view.description),
            *write_films(walkers, folder / f"{stem}-{view.name}"),
            poles_figure(walkers, contrast),
            gait_table(walkers),
            plausibility_table(plausible),
        ]
    if contrast.two_classes:
        blocks.append(class_averages_figure(_class_averages(population, contrast)))
    return [*blocks, space_figure(population.X[contrast.rows], contrast, views[0].step)]


def _cautions(population: Population, contrast: Contrast) -> list[str]:
    cautions = []
    if "simulated" in population.provenance:
        cautions.append(
            f"{_capital(population.provenance['simulated'])}. Differences between the walkers were "
            "put in, from published figures; they are no evidence about people."
        )
    if "style" in contrast.trait.lower():
        cautions.append(
            "These are styles that few people acted, not traits of the walkers: errors say how "
            "well the acts can be told apart, not how well people can."
        )
    if contrast.persons is not None:
        n_persons = len(set(contrast.persons))
        cautions.append(
            f"The walks are of {n_persons} persons; all walks of a person are left out together."
        )
    elif "person" not in population.traits and "file" in population.traits:
        cautions.append(
            "No column tells whose walk each is, so trials, not persons, were left out: if a "
            "person walked more than once, errors on new people will be higher."
        )
    return [
        *cautions,
        "The best number of components is picked on the curve that is reported, as in the paper; "
        "nested errors are free of that choice.",
        "Size (eq. 12) and correspondence of eigenpostures use no labels and are fixed once; "
        "standardisation, components and their order are found anew without each walker left out.",
    ]
