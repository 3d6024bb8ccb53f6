"""Everything about a trait of a population: how well it is predicted, and how it looks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import get_args

import numpy as np
import pandas as pd

from eigenwalker.analysis.classification import Classification, Regression
from eigenwalker.analysis.contrast import Contrast
from eigenwalker.analysis.direction import Kind
from eigenwalker.analysis.plausibility import Plausibility, plausibility
from eigenwalker.analysis.trait_axis import trait_axis
from eigenwalker.analysis.walker_space import WalkerSpace
from eigenwalker.core.arguments import check_kind
from eigenwalker.core.walker import Walker
from eigenwalker.population.population import Population, check_population

ALPHAS = (-6, -3, 0, 3, 6)
"""Standard deviations along the trait at which walkers are shown, up to the paper's 6."""


@dataclass(frozen=True, eq=False)
class TraitView:
    """Walkers from one pole of a trait to the other, by title, and how plausible each is.

    See Also
    --------
    study_trait : Makes them.

    References
    ----------
    Troje (2002), eq. 13.
    """

    walkers: Mapping[str, Walker]
    plausibility: Mapping[str, Plausibility]
    step: np.ndarray


@dataclass(frozen=True, eq=False)
class TraitStudy:
    """Everything about a trait of a population that its report shows.

    Attributes
    ----------
    result, table, missed
        How well the trait is told, `result.table()`, and the walkers that several inputs
        misclassify (None of a number).
    names, traits, provenance
        Of all walkers.
    walkers, average, correlations
        The walkers without a flag, their average, and how alike their postures are (None of one).
    views : mapping of str to TraitView
        Walkers along the ``discriminant``, and along the ``mean_difference`` without their size.
    class_averages : mapping of str to Walker
        Of either class, and both with their difference tripled; none of a number.
    X, space
        The walkers that have the trait (walker, feature), and the space fitted to them.
    contrast_walkers : tuple of Walker
        The same as walkers.

    See Also
    --------
    study_trait : Makes it.
    eigenwalker.report.write_classification_report : Writes it as a page.

    References
    ----------
    Troje (2002), eq. 9 to 13 and fig. 4.
    """

    result: Classification | Regression
    table: pd.DataFrame
    missed: pd.Series | None
    names: list[str]
    traits: pd.DataFrame
    provenance: Mapping[str, str]
    walkers: tuple[Walker, ...]
    average: Walker
    correlations: pd.DataFrame | None
    views: Mapping[Kind, TraitView]
    class_averages: Mapping[str, Walker]
    X: np.ndarray
    space: WalkerSpace
    keep_size: bool
    contrast_walkers: tuple[Walker, ...] = ()


def study_trait(
    population: Population, result: Classification | Regression, *, keep_size: bool = False
) -> TraitStudy:
    """Return everything about a trait that its report shows.

    Parameters
    ----------
    population : Population
        Its flagged walkers are named and left out of all else.
    result : Classification or Regression
        Of `classify` or `regress`.
    keep_size : bool
        Whether walkers along the axes keep the size that goes with the trait. Otherwise it is
        divided out, as in the stimuli of Troje (2002).

    Returns
    -------
    TraitStudy

    See Also
    --------
    eigenwalker.report.write_classification_report : Makes a page of it.

    References
    ----------
    Troje (2002), eq. 13 and figure 6: walkers up to 6 standard deviations along an axis.

    Examples
    --------
    >>> people = ew.simulate_population(4, 4, seed=1)
    >>> result = ew.classify(people, "sex", n_permutations=0)
    >>> list(study_trait(people, result).views["discriminant"].walkers)
    ['female 6 SD', 'female 3 SD', 'average', 'male 3 SD', 'male 6 SD']
    """
    check_population(population)
    check_kind(result, (Classification, Regression), "what classify or regress returns")
    contrast = result.contrast
    trait = contrast.trait
    if contrast.two_classes:
        trait += f"={contrast.negative}:{contrast.positive}"
    shown = population if keep_size else population.size_normalised()
    views: dict[Kind, TraitView] = {}
    for kind in get_args(Kind):
        step = trait_axis(shown, trait, kind=kind).step
        vectors = {_title(contrast, alpha): shown.average + alpha * step for alpha in ALPHAS}
        plausible = {title: plausibility(shown, vector) for title, vector in vectors.items()}
        walkers = {title: shown.walker(vector) for title, vector in vectors.items()}
        views[kind] = TraitView(walkers, plausible, step)
    used = population.select(population.in_average)
    X = shown.X[contrast.rows]
    return TraitStudy(
        result=result,
        table=result.table(),
        missed=result.often_misclassified() if isinstance(result, Classification) else None,
        names=population.names,
        traits=population.traits,
        provenance=population.provenance,
        walkers=tuple(used.walkers),
        average=population.walker(population.average),
        correlations=used.posture_correlations() if len(used) > 1 else None,
        views=views,
        class_averages=_class_averages(shown, contrast, X) if contrast.two_classes else {},
        X=X,
        space=WalkerSpace().fit(X),
        keep_size=keep_size,
        contrast_walkers=tuple(population.select(contrast.rows).walkers),
    )


def _title(contrast: Contrast, alpha: float) -> str:
    if alpha == 0:
        return "average"
    return f"{contrast.positive if alpha > 0 else contrast.negative} {abs(alpha):g} SD"


def _class_averages(population: Population, contrast: Contrast, X: np.ndarray) -> dict[str, Walker]:
    low, high = X[contrast.y < 0].mean(axis=0), X[contrast.y > 0].mean(axis=0)
    middle, half = (high + low) / 2, (high - low) / 2
    return {
        f"{pole}, {name}": population.walker(middle + times * half)
        for name, factor in (("average", 1), ("tripled", 3))
        for pole, times in ((contrast.negative, -factor), (contrast.positive, factor))
    }
