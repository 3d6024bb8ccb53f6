"""The report of the main job: who walked, what tells them apart, and how that looks."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd
import xarray as xr

from eigenwalker._version import __version__
from eigenwalker.analysis.classification import (
    N_PANELS,
    Classification,
    Progress,
    Regression,
    classify as classify_inputs,
    regress as regress_inputs,
)
from eigenwalker.analysis.contrast import Contrast, trait_contrast
from eigenwalker.analysis.direction import Kind
from eigenwalker.analysis.plausibility import plausibility
from eigenwalker.analysis.trait_axis import TraitAxis, trait_axis
from eigenwalker.analysis.walker_space import WalkerSpace
from eigenwalker.core.walker import Walker
from eigenwalker.decomposition.pca import decompose_pca
from eigenwalker.plotting.components import figure_scores, figure_variance
from eigenwalker.plotting.curves import figure_curves, figure_regression_curves
from eigenwalker.plotting.eigenpostures import figure_eigenpostures
from eigenwalker.plotting.walker_films import Style, write_film
from eigenwalker.plotting.walker_space_figure import figure_space
from eigenwalker.plotting.walkers import figure_joints, figure_walkers
from eigenwalker.population.population import Population
from eigenwalker.report.blocks import (
    Block,
    Code,
    Figure,
    Film,
    Items,
    Link,
    Report,
    Section,
    Table,
    Text,
)
from eigenwalker.report.classification_tables import (
    chance_sentence,
    gait_table,
    missed_table,
    multiple_inputs_sentence,
    plausibility_table,
    results_table,
)
from eigenwalker.report.html_report import write_report


class _View(NamedTuple):
    """A way to show a trait: which axis, of walkers with or without their size."""

    name: str
    words: str
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
ALPHAS = (-6, -3, 0, 3, 6)
"""Standard deviations along the trait at which walkers are shown, to the paper's extreme (J30)."""
_CITE = (
    "Troje, N. F. (2002). Decomposing biological motion: A framework for analysis and synthesis of "
    "human gait patterns. Journal of Vision, 2(5), 371-387."
)


def write_main_job(
    folder: str | Path,
    population: Population,
    trait: str,
    *,
    example: xr.DataArray | None = None,
    n_permutations: int = 200,
    beside: Link | None = None,
    progress: Progress | None = None,
) -> tuple[Path, Classification | Regression]:
    """Classify a trait, film it, and write a report page on both.

    Parameters
    ----------
    folder : path
        Made where it does not exist; holds ``report.html`` and the films.
    population : Population
        Its flagged walkers are named in the report and left out of everything else.
    trait : str
        As `contrast` takes it.
    example : DataArray of shape (time, marker, axis), optional
        A walk in place, to show how sines stand for its scores (J fig. 3).
    n_permutations : int
        Random deals of the trait to compare with.
    beside : Link, optional
        A page in the same folder for the report to link to.
    progress : callable, optional
        Called with the number of steps done and of all.

    Returns
    -------
    page : Path
    found : Classification or Regression

    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    asked = trait_contrast(population, trait)
    tell = classify_inputs if asked.two_classes else regress_inputs
    found = tell(population, trait, n_permutations=n_permutations, progress=progress)
    report = Report(
        title=f"{_capital(asked.trait)} from gait",
        lead=_lead(found),
        sections=[
            Section("Who walked", _who(population)),
            Section("How well the model holds", _model(population, example)),
            Section("What tells them apart", _classifiers(population, found)),
            Section("What it looks like", _looks(folder, population, trait)),
            Section("Mind", [Items(_cautions(population, found))]),
            Section("Made with", [Code(f"eigenwalker {__version__}\n{_CITE}")]),
        ],
        beside=beside,
    )
    return write_report(report, folder), found


def _capital(words: str) -> str:
    return words[:1].upper() + words[1:].replace("_", " ")


def _lead(found: Classification | Regression) -> str:
    asked, table = found.contrast, found.table()
    n = len(asked.rows)
    if isinstance(found, Classification):
        best = table.iloc[0]
        are = "is" if best["errors"] == 1 else "are"
        with_n = (
            "component that does" if best["best n"] == 1 else f"{best['best n']} components that do"
        )
        return (
            f"Left out one at a time, {best['errors']} of {n} walkers {are} misclassified from "
            f"everything that is known of them, with the {with_n} best; "
            f"{best['nested errors']} when that number is chosen without them. "
            f"{chance_sentence(found)}"
        )
    best = table.iloc[0]
    return (
        f"Told from everything, {asked.trait} of {n} walkers left out one at a time correlates "
        f"with the truth at {best['correlation']:.2f} (R2 {best['R2']:.2f}) with the number of "
        f"components that does best; at {best['nested correlation']:.2f} "
        f"(R2 {best['nested R2']:.2f}) when that number is chosen without them. "
        f"{chance_sentence(found)}"
    )


def _who(population: Population) -> list[Block]:
    rows = [_trait_row(str(name), population.traits[name]) for name in population.traits]
    blocks: list[Block] = [
        Text(
            f"{len(population)} walkers with {len(population.layout.markers)} points each, "
            f"{population.flagged.sum()} of them flagged; "
            f"{len(population.feature_names)} numbers describe a walk."
        )
    ]
    told = {key: value for key, value in population.provenance.items() if key != "recipe"}
    if told:
        blocks.append(Items([f"{key}: {value}" for key, value in told.items()]))
    known = [row for row in rows if row is not None]
    if known:
        blocks.append(Table("Traits", ["trait", "values", "known of"], known))
    if population.flagged.any():
        named = population.traits[population.flagged]
        names = population.names
        flagged = [[names[row], flag] for row, flag in zip(named.index, named["flag"], strict=True)]
        blocks.append(Table("Flagged, and left out of all that follows", ["walk", "why"], flagged))
    return blocks


def _trait_row(name: str, values: pd.Series) -> list | None:
    if name in ("flag", "file"):
        return None
    known = values[values.notna() & (values.astype(str) != "")]
    if known.empty:
        return None
    if pd.api.types.is_numeric_dtype(known):
        said = f"{known.mean():.4g} (SD {known.std():.2g})"
    else:
        counts = known.astype(str).value_counts()
        said = ", ".join(f"{value} {count}" for value, count in counts.head(8).items())
        said += ", ..." if len(counts) > 8 else ""
    return [name, said, len(known)]


def _model(population: Population, example: xr.DataArray | None) -> list[Block]:
    known = population.unflagged() if not population.flagged.all() else population
    average = population.walker(population.average)
    blocks: list[Block] = []
    fits = [walker.fit for walker in known.walkers if walker.fit is not None]
    if fits:
        shares = np.array([fit.variance_share[:4].sum() for fit in fits])
        blocks += [
            Text(
                f"Four principal components hold {100 * shares.mean():.1f} % of the variance of "
                f"a walk (mean over walkers); as sines they explain "
                f"{100 * np.mean([fit.r2 for fit in fits]):.1f} %, two Fourier harmonics "
                f"{100 * np.mean([fit.fourier_r2 for fit in fits]):.1f} %."
            ),
            Figure(
                figure_variance(known.walkers),
                "Variance of the first components, mean and standard deviation over walkers.",
                "Bar chart: most variance lies in the first component, little after the fourth.",
            ),
        ]
    if example is not None:
        blocks.append(
            Figure(
                figure_scores(example, decompose_pca(example)),
                f"{_capital(str(example.attrs.get('source', 'one walk')))}: scores of the "
                "eigenpostures over time, and below them the sines that take their place.",
                "Four wavy curves over five seconds, and below them the same as pure sines.",
            )
        )
    if len(known) > 1:
        alike = known.posture_correlations()
        rows = [
            [name, *map(float, row)] for name, row in zip(alike.index, alike.values, strict=True)
        ]
        blocks.append(
            Table(
                "How alike postures are: mean correlation over all pairs of walkers",
                ["posture", *alike.columns],
                rows,
            )
        )
    blocks += [
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
    return blocks


def _classifiers(population: Population, found: Classification | Regression) -> list[Block]:
    blocks: list[Block] = [results_table(found)]
    if sentence := multiple_inputs_sentence(found):
        blocks.append(Text(sentence))
    if isinstance(found, Classification):
        panels = {each.input.title: each.curves for each in found.results[:N_PANELS]}
        blocks.append(
            Figure(
                figure_curves(panels, n_walkers=len(found.contrast.rows)),
                "Misclassified walkers over the number of components: among those trained on "
                "(dashed) and among those left out (solid).",
                "Nine panels of two curves each: training errors fall to zero, errors on walkers "
                "left out stay above.",
            )
        )
        if missed := missed_table(population, found):
            blocks.append(missed)
    else:
        told = {each.input.title: each.curves for each in found.results[:N_PANELS]}
        blocks.append(
            Figure(
                figure_regression_curves(told),
                f"Share of the variance of {found.contrast.trait} told over the number of "
                "components: of those trained on (dashed) and of those left out (solid). Below 0 "
                "the mean tells more; a curve that falls far below leaves its panel.",
                "Panels of two curves each: on those trained on the share told rises to one, on "
                "those left out it stays below.",
            )
        )
    return blocks


def _looks(folder: Path, population: Population, trait: str) -> list[Block]:
    axis = trait_axis(population, trait)
    asked = axis.contrast
    blocks: list[Block] = []
    for view in _VIEWS:
        blocks += _seen(folder, population, trait, view)
    if asked.two_classes:
        blocks.append(
            Figure(
                figure_walkers(_class_averages(population, asked)),
                "The average of either class, and their difference tripled.",
                "Stick figures of both classes' averages, and of both exaggerated.",
            )
        )
    X = population.X[asked.rows]
    blocks.append(
        Figure(
            figure_space(
                WalkerSpace().fit(X),
                X,
                asked.labels,
                trait_name=asked.trait,
                step=axis.step,
                poles=(asked.negative, asked.positive),
            ),
            "Walkers on the first two eigenwalkers, and the axis of the discriminant.",
            "Scatter plot of walkers with the axis of the trait drawn through the average.",
        )
    )
    return blocks


def _seen(folder: Path, population: Population, trait: str, view: _View) -> list[Block]:
    """Walkers from one pole of a trait to the other, as films, figure and tables."""
    shown = population.size_normalised() if view.size_normalised else population
    axis = trait_axis(shown, trait, kind=view.kind)
    asked, walkers = axis.contrast, _along(shown, axis)
    slug = "".join(letter if letter.isalnum() else "-" for letter in asked.trait)
    return [
        Text(view.words),
        *_films(folder, f"{slug}-{view.name}", walkers),
        Figure(
            figure_walkers(walkers),
            f"From {asked.negative} to {asked.positive}: standard deviations of the walkers "
            "along the axis.",
            "Stick figures from one pole of the trait to the other, front and side.",
        ),
        gait_table(walkers),
        plausibility_table(
            {
                _title(asked, alpha): plausibility(shown, shown.average + alpha * axis.step)
                for alpha in ALPHAS
            }
        ),
    ]


def _along(population: Population, axis: TraitAxis) -> dict[str, Walker]:
    """Walkers from one pole of a trait to the other, by title."""
    return {
        _title(axis.contrast, alpha): population.walker(population.average + alpha * axis.step)
        for alpha in ALPHAS
    }


def _class_averages(population: Population, asked: Contrast) -> dict[str, Walker]:
    """The average walker of either class, and both with their difference tripled (M5)."""
    X = population.X[asked.rows]
    low, high = X[asked.y < 0].mean(axis=0), X[asked.y > 0].mean(axis=0)
    middle, half = (high + low) / 2, (high - low) / 2
    return {
        f"{asked.negative}, average": population.walker(middle - half),
        f"{asked.positive}, average": population.walker(middle + half),
        f"{asked.negative}, tripled": population.walker(middle - 3 * half),
        f"{asked.positive}, tripled": population.walker(middle + 3 * half),
    }


def _title(asked: Contrast, alpha: float) -> str:
    if alpha == 0:
        return "average"
    return f"{asked.positive if alpha > 0 else asked.negative} {abs(alpha):g} SD"


def _films(folder: Path, name: str, walkers: Mapping[str, Walker]) -> list[Film]:
    """Walkers side by side, as points of light and as sticks."""
    titles = list(walkers)
    ends = [titles[0], titles[len(titles) // 2], titles[-1]]
    kinds: list[tuple[Style, str, list[str]]] = [
        ("dots", "Points of light", ends),
        ("sticks", "Sticks", titles),
    ]
    films = []
    for style, words, shown in kinds:
        path = write_film(
            [walkers[title] for title in shown],
            folder / f"{name}-{style}.mp4",
            n_strides=2,
            azimuth_deg=30,
            size_px=420,
            style=style,
            titles=shown,
        )
        caption = f"{words}: {', '.join(shown)}, in one tempo."
        films.append(Film(path, caption, f"Film of walkers side by side. {caption}"))
    return films


def _cautions(population: Population, found: Classification | Regression) -> list[str]:
    asked = found.contrast
    cautions = []
    if "simulated" in population.provenance:
        cautions.append(
            f"{_capital(population.provenance['simulated'])}. Differences between the walkers were "
            "put in, from published figures; they are no evidence about people."
        )
    if "style" in asked.trait.lower():
        cautions.append(
            "These are styles that few people acted, not traits of the walkers: errors say how "
            "well the acts can be told apart, not how well people can."
        )
    if asked.persons is not None:
        n_persons = len(set(asked.persons))
        cautions.append(
            f"The walks are of {n_persons} persons; all walks of a person are left out together."
        )
    elif "person" not in population.traits and "file" in population.traits:
        cautions.append(
            "No column tells whose walk each is, so trials, not persons, were left out: if a "
            "person walked more than once, errors on new people will be higher."
        )
    cautions += [
        "The best number of components is picked on the curve that is reported, as in the paper; "
        "nested errors are free of that choice.",
        "Size (eq. 12) and correspondence of eigenpostures use no labels and are fixed once; "
        "standardisation, components and their order are found anew without each walker left out.",
    ]
    return cautions
