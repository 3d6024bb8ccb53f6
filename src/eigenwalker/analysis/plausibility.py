"""How far a synthetic walker is from the walkers that were captured."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from eigenwalker.analysis.span import Span, span_of
from eigenwalker.core.arguments import check_numbers
from eigenwalker.core.skeleton import LIMBS
from eigenwalker.population.population import Population, check_population

if TYPE_CHECKING:
    from eigenwalker.analysis.walker_space import WalkerSpace


@dataclass(frozen=True, eq=False)
class Plausibility:
    """How far a walker is from the walkers of a population.

    Parameters
    ----------
    position : SpacePosition
        Its distance from the average walker relative to theirs, and the share outside their space.
    limb_change : Series
        How much longer each limb is than the average walker's, mean of left and right: 0.1 is a
        tenth longer.
    limb_stretch : Series
        Standard deviation of each limb's length over the stride as a share of its mean: bones are
        rigid, sums of walkers not quite.

    See Also
    --------
    plausibility : makes it.

    References
    ----------
    Troje (2002), eq. 4 to 8.
    """

    position: SpacePosition
    limb_change: pd.Series
    limb_stretch: pd.Series


def plausibility(population: Population, vector: np.ndarray) -> Plausibility:
    """Return how plausible a synthetic walker is.

    Parameters
    ----------
    population : Population
        Of walkers with the 15 joints, or some of them.
    vector : array of shape (feature,)
        The walker in question.

    Returns
    -------
    Plausibility

    See Also
    --------
    position_in_space : the first part of it, in any space.

    References
    ----------
    Troje (2002), Decomposing biological motion: walkers up to 6 standard deviations along eq. 13.

    Examples
    --------
    >>> people = ew.load_population()
    >>> bool(plausibility(people, people.average).limb_change.abs().max() < 1e-9)
    True
    """
    check_population(population)
    walkers = population.X[population.in_average]
    span = span_of(walkers)
    vector = check_numbers(vector, "vector", "feature")
    own, average = (_limb_lengths(population, each) for each in (vector, population.average))
    return Plausibility(
        position=_position(span, float(span.variances.sum()), vector, walkers),
        limb_change=own.mean() / average.mean() - 1,
        limb_stretch=own.std() / own.mean(),
    )


def _limb_lengths(population: Population, vector: np.ndarray) -> pd.DataFrame:
    """Length of each limb over a stride in mm, sides averaged: a table (time, limb)."""
    walker = population.walker(vector)
    stride = walker.trajectories(np.linspace(0, walker.period_s, 100, endpoint=False)).values
    places = dict(zip(walker.markers, np.moveaxis(stride, 1, 0), strict=True))
    lengths: dict[str, np.ndarray] = {}
    for limb, (upper, lower) in LIMBS.items():
        sides = [
            np.linalg.norm(places[f"{side}_{upper}"] - places[f"{side}_{lower}"], axis=-1)
            for side in ("left", "right")
            if {f"{side}_{upper}", f"{side}_{lower}"} <= set(places)
        ]
        if sides:
            lengths[limb] = np.mean(sides, axis=0)
    return pd.DataFrame(lengths)


@dataclass(frozen=True, eq=False)
class SpacePosition:
    """How far a walker lies from those a space was made from.

    Parameters
    ----------
    distance : float
        Distance from the average walker in standardised features, over its root mean square for
        the walkers of the space: 1 is typical, 3 is three times as far from the average.
    mahalanobis : float
        The root of the sum of squared `z_scores`. Where a space has nearly as many eigenwalkers as
        walkers, it is the same for all of them.
    z_scores : array of shape (component,)
        Score on each eigenwalker in standard deviations of the walkers.
    outside : float
        Share of the walker's squared distance that no eigenwalker accounts for: 0 within the
        space, 1 for a difference that no walker of the space has.
    percentile : float
        Percentage of the given walkers that are closer to the average; NaN if none is given.

    See Also
    --------
    position_in_space : makes it.

    References
    ----------
    Troje (2002), eq. 4 to 8.
    """

    distance: float
    mahalanobis: float
    z_scores: np.ndarray
    outside: float
    percentile: float


def position_in_space(
    space: WalkerSpace, vector: ArrayLike, *, walkers: ArrayLike | None = None
) -> SpacePosition:
    """Return how far a walker lies from those a space was made from.

    Parameters
    ----------
    space : WalkerSpace
        Fitted on walkers.
    vector : array of shape (feature,)
        The walker in question, such as a caricature.
    walkers : array of shape (walker, feature), optional
        Walkers to rank it among, usually those of the space.

    Returns
    -------
    SpacePosition

    See Also
    --------
    plausibility : with the lengths of limbs.

    References
    ----------
    Troje (2002), eq. 13: positions along an axis as z-scores.

    Examples
    --------
    >>> walkers = np.array([[1.0, 5], [2, 4], [6, 4], [7, 5]])
    >>> space = ew.analysis.WalkerSpace(n_components=1).fit(walkers)
    >>> report = position_in_space(space, [14, 4.5], walkers=walkers)
    >>> report.z_scores.round(2).tolist(), report.percentile
    ([3.4], 100.0)
    """
    vector = check_numbers(vector, "vector", "feature")
    if vector.shape != space.average_walker_.shape:
        raise ValueError(
            f"A walker in this space is a vector of {len(space.average_walker_)} features; got an "
            f"array of shape {vector.shape}."
        )
    span = Span(space.average_walker_, space.scale_, space.eigenwalkers_, space.explained_variance_)
    total_variance = space.explained_variance_[0] / space.explained_variance_ratio_[0]
    others = None if walkers is None else check_numbers(walkers, "walkers", "walker", "feature")
    return _position(span, total_variance, vector, others)


def _position(
    span: Span, total_variance: float, vector: np.ndarray, walkers: np.ndarray | None
) -> SpacePosition:
    scores = span.scores(vector[None])
    z_scores = scores[0] / np.sqrt(span.variances)
    average, percentile = span.average_walker, float("nan")
    squared = _squared(span, vector[None] - average)[0]
    if walkers is not None:
        percentile = 100 * float((_squared(span, walkers - average) < squared).mean())
    residual = _squared(span, vector - average - scores @ span.eigenwalkers)
    return SpacePosition(
        distance=float(np.sqrt(squared / total_variance)),
        mahalanobis=float(np.linalg.norm(z_scores)),
        z_scores=z_scores,
        outside=float(residual[0] / squared) if squared > 0 else 0.0,
        percentile=percentile,
    )


def _squared(span: Span, deviations: np.ndarray) -> np.ndarray:
    """Squared lengths of deviations (walker, feature) in standardised features."""
    return ((deviations / span.scale) ** 2).sum(axis=1)
