"""The line through the space of walkers along which a trait changes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from eigenwalker.analysis.contrast import Contrast, trait_contrast
from eigenwalker.analysis.direction import Discriminant, Kind, Units, direction
from eigenwalker.analysis.discriminant import DiscriminantClassifier, DiscriminantRegressor
from eigenwalker.analysis.walker_space import WalkerSpace
from eigenwalker.population.population import Population

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
    space : WalkerSpace
        Fitted on these columns of the walkers.
    discriminant : DiscriminantClassifier or DiscriminantRegressor
        Fitted on their scores.
    columns : array of int
        Features that the discriminant uses.

    See Also
    --------
    trait_axis : makes it.

    References
    ----------
    Troje (2002), eq. 13.
    """

    contrast: Contrast
    step: np.ndarray
    space: WalkerSpace
    discriminant: Discriminant
    columns: np.ndarray

    def __repr__(self) -> str:
        contrast = self.contrast
        return f"TraitAxis({contrast.trait}: {contrast.negative} to {contrast.positive})"

    def positions(self, vectors: np.ndarray) -> np.ndarray:
        """Return where walkers (walker, feature) lie along the axis, in steps from the average."""
        average = self._projections(self.space.average_walker_)
        one_step = self._projections(self.space.average_walker_ + self.step[self.columns])
        return (self._projections(vectors[:, self.columns]) - average) / (one_step - average)

    def _projections(self, walkers: np.ndarray) -> np.ndarray:
        return self.space.transform(np.atleast_2d(walkers)) @ self.discriminant.coef_


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
        Eigenwalkers to span the space with; fewer where the walkers span fewer.
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
    space = strongest_space(population.X[np.ix_(contrast.rows, columns)], n_components)
    return axis_within(space, population, contrast, columns, kind=kind, units=units)


def strongest_space(walkers: np.ndarray, n_components: int = N_EIGENWALKERS) -> WalkerSpace:
    """Return the space of the first few eigenwalkers, or of all where there are fewer."""
    n_spanned = len(WalkerSpace().fit(walkers).eigenwalkers_)
    return WalkerSpace(n_components=min(n_components, n_spanned)).fit(walkers)


def axis_within(
    space: WalkerSpace,
    population: Population,
    contrast: Contrast,
    columns: np.ndarray,
    *,
    kind: Kind = "discriminant",
    units: Units = "sd",
) -> TraitAxis:
    """Return the axis of a trait within a space fitted on these columns of the contrast's rows."""
    scores = space.transform(population.X[np.ix_(contrast.rows, columns)])
    discriminant = DiscriminantClassifier() if contrast.two_classes else DiscriminantRegressor()
    discriminant.fit(scores, contrast.y)
    step = np.zeros(population.X.shape[1])
    step[columns] = direction(space, discriminant, kind=kind, units=units)
    return TraitAxis(contrast, step, space, discriminant, columns)
