"""The line through the space of walkers along which a trait changes (J30, W6 to W8)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from eigenwalker.analysis.contrast import Contrast, trait_contrast
from eigenwalker.analysis.direction import Discriminant, Kind, Units, direction
from eigenwalker.analysis.discriminant import DiscriminantClassifier, DiscriminantRegressor
from eigenwalker.analysis.walker_space import WalkerSpace
from eigenwalker.population.population import Population

N_EIGENWALKERS = 10
"""Eigenwalkers that the paper's synthesiser uses (J30)."""


@dataclass(frozen=True, eq=False)
class TraitAxis:
    """A step that makes any walker more of a trait.

    Parameters
    ----------
    contrast : Contrast
        The trait, its poles and the walkers that show it.
    step : array of shape (feature,)
        Add alpha times this to a walker; it leads towards ``contrast.positive``. Zero outside the
        part of the features that the classifier knows.
    space : WalkerSpace
        Fitted on that part of the walkers' features.
    discriminant : DiscriminantClassifier or DiscriminantRegressor
        Fitted on their scores.
    columns : array of int
        The features that are this part.

    """

    contrast: Contrast
    step: np.ndarray
    space: WalkerSpace
    discriminant: Discriminant
    columns: np.ndarray

    def __repr__(self) -> str:
        asked = self.contrast
        return f"TraitAxis({asked.trait}: {asked.negative} to {asked.positive})"

    def positions(self, vectors: np.ndarray) -> np.ndarray:
        """Return where walkers lie along the axis, in steps from the average of its walkers.

        Parameters
        ----------
        vectors : array of shape (walker, feature)

        Returns
        -------
        array of shape (walker,)

        """
        per_step = self._told(self.space.average_walker_ + self.step[self.columns])
        middle = self._told(self.space.average_walker_)
        return (self._told(vectors[:, self.columns]) - middle) / (per_step - middle)

    def _told(self, walkers: np.ndarray) -> np.ndarray:
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
    """Return the axis of a trait in a population.

    Eq. 13 of Troje (2002), ``w = w_0 + alpha V c'``: V holds the first few eigenwalkers, those of
    most variance, so that a step leads where walkers differ (J30).

    Parameters
    ----------
    population : Population
        Its flagged walkers are left out.
    trait : str
        As `contrast` takes it: ``"sex"``, ``"weight"``, ``"style=feminine:masculine"``.
    part : str
        What the classifier knows: ``"all"``, ``"structure"``, ``"dynamics"``, ``"p1+p2"`` (J31).
    n_components : int
        Eigenwalkers to span the space with; fewer where the walkers span fewer.
    kind : {"discriminant", "mean_difference"}
        What tells the trait best, or what shows it best (A13).
    units : {"sd", "raw", "classmean"}
        What alpha = 1 is: one standard deviation of the walkers along the axis (A12), eq. 13 as
        printed, or half the distance of the classes' means.

    Returns
    -------
    TraitAxis

    Examples
    --------
    >>> people = ew.load_population()
    >>> sex = trait_axis(people, "sex")
    >>> caricature = people.walker(people.average + 6 * sex.step)  # very much a man

    """
    asked = trait_contrast(population, trait)
    columns = population.layout.columns(part)
    space = strongest_space(population.X[np.ix_(asked.rows, columns)], n_components)
    return axis_within(space, population, asked, columns, kind=kind, units=units)


def strongest_space(walkers: np.ndarray, n_components: int = N_EIGENWALKERS) -> WalkerSpace:
    """Return the space of the first few eigenwalkers, or of all where there are fewer."""
    n_spanned = len(WalkerSpace().fit(walkers).eigenwalkers_)
    return WalkerSpace(n_components=min(n_components, n_spanned)).fit(walkers)


def axis_within(
    space: WalkerSpace,
    population: Population,
    asked: Contrast,
    columns: np.ndarray,
    *,
    kind: Kind = "discriminant",
    units: Units = "sd",
) -> TraitAxis:
    """Return the axis of a trait within a space that its walkers span already.

    Parameters
    ----------
    space : WalkerSpace
        Fitted on these columns of the walkers that the contrast asks for.
    population, asked, columns, kind, units
        As in `TraitAxis` and `trait_axis`.

    Returns
    -------
    TraitAxis

    """
    scores = space.transform(population.X[np.ix_(asked.rows, columns)])
    discriminant = DiscriminantClassifier() if asked.two_classes else DiscriminantRegressor()
    discriminant.fit(scores, asked.y)
    step = np.zeros(population.X.shape[1])
    step[columns] = direction(space, discriminant, kind=kind, units=units)
    return TraitAxis(asked, step, space, discriminant, columns)
