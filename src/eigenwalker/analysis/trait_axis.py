"""The line through the space of walkers along which a trait changes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from eigenwalker.analysis.contrast import Contrast, trait_contrast
from eigenwalker.analysis.direction import Kind, Units, step_in_scores
from eigenwalker.analysis.discriminant_weights import Weights, discriminant_weights
from eigenwalker.analysis.span import Span, span_of
from eigenwalker.population.population import Population

if TYPE_CHECKING:
    from eigenwalker.analysis.discriminant import DiscriminantClassifier, DiscriminantRegressor
    from eigenwalker.analysis.walker_space import WalkerSpace

N_EIGENWALKERS = 10
"""Eigenwalkers that the synthesiser of Troje (2002) uses."""


@dataclass(frozen=True, eq=False)
class TraitAxis:
    """The step along which a trait changes in any walker.

    Parameters
    ----------
    contrast : Contrast
        The trait, its poles and its walkers.
    step : array of shape (feature,)
        Add alpha times this to a walker; it leads towards ``contrast.positive``. Zero outside
        `columns`.
    walkers : array of shape (walker, column)
        What it was fitted on: these columns of the contrast's walkers.
    columns : array of int
        Features that the discriminant uses.
    span, weights
        What the walkers span, and the discriminant of their scores, in numbers.

    See Also
    --------
    trait_axis : makes it.

    References
    ----------
    Troje (2002), eq. 13.
    """

    contrast: Contrast
    step: np.ndarray
    walkers: np.ndarray
    columns: np.ndarray
    span: Span
    weights: Weights

    @cached_property
    def space(self) -> WalkerSpace:
        """The fitted space, as an estimator."""
        from eigenwalker.analysis.walker_space import WalkerSpace

        return WalkerSpace(n_components=len(self.span.eigenwalkers)).fit(self.walkers)

    @cached_property
    def discriminant(self) -> DiscriminantClassifier | DiscriminantRegressor:
        """The discriminant of the walkers' scores, as a fitted estimator."""
        from eigenwalker.analysis.discriminant import DiscriminantClassifier, DiscriminantRegressor

        discriminant = (
            DiscriminantClassifier() if self.contrast.two_classes else DiscriminantRegressor()
        )
        return discriminant.fit(self.space.transform(self.walkers), self.contrast.y)

    def __repr__(self) -> str:
        contrast = self.contrast
        return f"TraitAxis({contrast.trait}: {contrast.negative} to {contrast.positive})"

    def positions(self, vectors: np.ndarray) -> np.ndarray:
        """Return where walkers (walker, feature) lie along the axis, in steps from the average."""
        average = self._projections(self.span.average_walker)
        one_step = self._projections(self.span.average_walker + self.step[self.columns])
        return (self._projections(vectors[:, self.columns]) - average) / (one_step - average)

    def _projections(self, walkers: np.ndarray) -> np.ndarray:
        return self.span.scores(np.atleast_2d(walkers)) @ self.weights.c


def trait_axis(
    population: Population,
    trait: str,
    *,
    part: str = "all",
    n_components: int = N_EIGENWALKERS,
    kind: Kind = "discriminant",
    units: Units = "sd",
) -> TraitAxis:
    r"""Return the axis of a trait in a population.

    .. math:: w = w_0 + \alpha V c'

    V holds the first few eigenwalkers, those of most variance, so that a step leads where walkers
    differ. Every walk counts once, also several of a person, whom `classify` leaves out together:
    a person with more walks has more weight. For an axis of people, keep one walk of each.

    Parameters
    ----------
    population : Population
        Its flagged walkers are left out.
    trait : str
        As `trait_contrast` takes it: ``"sex"``, ``"weight"``, ``"style=feminine:masculine"``.
    part : str
        What the discriminant uses: ``"all"``, ``"structure"``, ``"dynamics"``, ``"p1+p2"``.
    n_components : int
        Eigenwalkers to span the space with. Of the usual 10, fewer where the walkers span fewer;
        other numbers are as many as they span at most.
    kind : {"discriminant", "mean_difference"}
        What predicts the trait best, or what varies with it; see `direction`.
    units : {"sd", "raw", "classmean"}
        What alpha = 1 is: one standard deviation of the walkers along the axis, eq. 13 as printed,
        or half the distance of the class means.

    Returns
    -------
    TraitAxis

    See Also
    --------
    direction : The step of a fitted space and discriminant.
    plausibility : How far a walker along the axis is from those captured.

    References
    ----------
    Troje (2002), Decomposing biological motion, eq. 13. Troje (2002), The little difference, eq. 6.

    Examples
    --------
    >>> people = ew.load_population()
    >>> sex = trait_axis(people, "sex")
    >>> caricature = people.walker(people.average + 6 * sex.step)  # very much a man
    """
    contrast = trait_contrast(population, trait)
    columns = population.layout.columns(part)
    span = strongest_span(population.X[np.ix_(contrast.rows, columns)], n_components)
    if (n_spanned := len(span.eigenwalkers)) < n_components != N_EIGENWALKERS:
        raise ValueError(
            f"n_components={n_components} is more than these {len(contrast.rows)} walkers span; "
            f"give 1 to {n_spanned}."
        )
    return axis_within(span, population, contrast, columns, kind=kind, units=units)


def strongest_span(walkers: np.ndarray, n_components: int = N_EIGENWALKERS) -> Span:
    """Return the span of the first few eigenwalkers, or of all where there are fewer."""
    if n_components < 1:
        raise ValueError(f"n_components={n_components} must be 1 or more.")
    return span_of(walkers).strongest(n_components)


def axis_within(
    span: Span,
    population: Population,
    contrast: Contrast,
    columns: np.ndarray,
    *,
    kind: Kind = "discriminant",
    units: Units = "sd",
) -> TraitAxis:
    """Return the axis of a trait within the span of these columns of the contrast's rows."""
    walkers = population.X[np.ix_(contrast.rows, columns)]
    scores, y = span.scores(walkers), contrast.y
    two = contrast.two_classes
    weights = discriminant_weights(scores, y, centred=not two)
    means = np.array([scores[y == sign].mean(axis=0) for sign in (-1, 1)]) if two else None
    step = np.zeros(population.X.shape[1])
    along = step_in_scores(
        weights.c, weights.pattern, weights.spread, means, kind=kind, units=units
    )
    step[columns] = along @ span.eigenwalkers
    return TraitAxis(contrast, step, walkers, columns, span, weights)
