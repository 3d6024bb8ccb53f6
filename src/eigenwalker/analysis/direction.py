"""How to exaggerate what tells walkers apart, and how far that leads (Troje 2002, eq. 13)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from eigenwalker.analysis.discriminant import DiscriminantClassifier, DiscriminantRegressor
from eigenwalker.analysis.walker_space import WalkerSpace

Kind = Literal["discriminant", "mean_difference"]
Units = Literal["sd", "raw", "classmean"]
Discriminant = DiscriminantClassifier | DiscriminantRegressor


def direction(
    space: WalkerSpace,
    discriminant: Discriminant,
    kind: Kind = "discriminant",
    units: Units = "sd",
) -> np.ndarray:
    """Return the step that makes a walker more of a trait: ``w + alpha * step`` is the caricature.

    Eq. 13 of Troje (2002), ``w_0 + alpha V c'`` with c' a column (A11), holds for the average
    walker and for any other (WDP2002). The step leads towards ``discriminant.positive_pole_``.

    Parameters
    ----------
    space : WalkerSpace
        Fitted on walkers.
    discriminant : DiscriminantClassifier or DiscriminantRegressor
        Fitted on their scores in that space.
    kind : {"discriminant", "mean_difference"}
        Along c itself, which is the filter that tells best; or along cov(K) c, the pattern that
        shows best what goes along with it. For two classes the latter is the difference of the
        class means within the components kept (Moler's M - F, and the other way round than his:
        here the positive pole is at +1).
    units : {"sd", "raw", "classmean"}
        What one step is (A12). "sd": c k changes by its standard deviation over the walkers, so
        alpha is a z-score. "raw": V c' as printed, or V cov(K) c. "classmean": c k changes by half
        the distance between the two classes, so that +1 and -1 lie where their means do.

    Returns
    -------
    array of shape (feature,)
        In units of the features.

    Raises
    ------
    ValueError
        If the discriminant was fitted on other columns than this space's scores; if it does not
        vary; if `units` is "classmean" and the trait continuous.

    Examples
    --------
    >>> walkers = np.array([[1.0, 5], [2, 4], [6, 4], [7, 5]])
    >>> space = WalkerSpace(scale=None).fit(walkers)
    >>> sex = ["female", "female", "male", "male"]
    >>> classifier = DiscriminantClassifier(n_components=1).fit(space.transform(walkers), sex)
    >>> step = direction(space, classifier, units="classmean")
    >>> (space.average_walker_ + step).round(6).tolist()
    [6.5, 4.5]

    """
    for name, choice, choices in (("kind", kind, Kind), ("units", units, Units)):
        if choice not in get_args(choices):
            raise ValueError(
                f"{name}={choice!r} is unknown; choose from {', '.join(get_args(choices))}."
            )
    c = discriminant.coef_
    if len(c) != len(space.eigenwalkers_):
        raise ValueError(
            f"The discriminant was fitted on {len(c)} columns, the space has "
            f"{len(space.eigenwalkers_)} eigenwalkers; fit it on space.transform(walkers)."
        )
    scores = c if kind == "discriminant" else discriminant.pattern_
    if units != "raw":
        scores = scores * _length(discriminant, units) / _advance(c, scores)
    return scores @ space.eigenwalkers_


def _advance(c: np.ndarray, scores: np.ndarray) -> float:
    """How much c k changes along a step in the scores."""
    advance = float(c @ scores)
    if not advance > 0:
        raise ValueError(
            "The discriminant is the same for all walkers it was fitted on, so there is no "
            "direction to exaggerate; the trait may not go with any component that was kept."
        )
    return advance


def _length(discriminant: Discriminant, units: Units) -> float:
    """How much c k shall change in one step."""
    if units == "sd":
        return discriminant.spread_
    if not isinstance(discriminant, DiscriminantClassifier):
        raise ValueError(
            "units='classmean' is half the distance of two classes, and a continuous trait has "
            "none; use units='sd'."
        )
    first, second = discriminant.class_means_ @ discriminant.coef_
    return (second - first) / 2


@dataclass(frozen=True, eq=False)
class SpacePosition:
    """How far a walker lies from those a space was made from.

    Parameters
    ----------
    distance : float
        Distance from the average walker in standardised features, over its root mean square for
        the walkers of the space: 1 is usual, 3 is three times as unlike the average as they are.
    mahalanobis : float
        The root of the sum of squared `z_scores`. Where a space keeps nearly as many eigenwalkers
        as it had walkers, it is the same for all of them and tells little.
    z_scores : array of shape (component,)
        Score on each eigenwalker in standard deviations of the walkers.
    outside : float
        Share of the walker's squared distance that no eigenwalker accounts for: 0 within the
        space, 1 for a way of differing that the walkers never showed.
    percentile : float
        Percentage of the walkers given that are closer to the average; NaN if none was given.

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
        The walker in question, say a caricature.
    walkers : array of shape (walker, feature), optional
        Walkers to rank it among, as a rule those of the space.

    Returns
    -------
    SpacePosition

    Examples
    --------
    >>> walkers = np.array([[1.0, 5], [2, 4], [6, 4], [7, 5]])
    >>> space = WalkerSpace(n_components=1).fit(walkers)
    >>> report = position_in_space(space, [14, 4.5], walkers=walkers)
    >>> report.z_scores.round(2).tolist(), report.percentile
    ([3.4], 100.0)

    """
    vector = np.asarray(vector, dtype=float)
    if vector.shape != space.average_walker_.shape:
        raise ValueError(
            f"A walker in this space is a vector of {len(space.average_walker_)} features; got an "
            f"array of shape {vector.shape}."
        )
    scores = space.transform(vector[None])
    z_scores = scores[0] / np.sqrt(space.explained_variance_)
    squared, percentile = _squared_distances(space, vector[None])[0], float("nan")
    if walkers is not None:
        nearer = _squared_distances(space, np.asarray(walkers, dtype=float)) < squared
        percentile = 100 * float(nearer.mean())
    total_variance = space.explained_variance_[0] / space.explained_variance_ratio_[0]
    residual = _squared_distances(space, vector - space.inverse_transform(scores), about_mean=False)
    return SpacePosition(
        distance=float(np.sqrt(squared / total_variance)),
        mahalanobis=float(np.linalg.norm(z_scores)),
        z_scores=z_scores,
        outside=float(residual[0] / squared) if squared > 0 else 0.0,
        percentile=percentile,
    )


def _squared_distances(
    space: WalkerSpace, walkers: np.ndarray, *, about_mean: bool = True
) -> np.ndarray:
    """Squared lengths in standardised features, of deviations from the average walker."""
    deviations = walkers - space.average_walker_ if about_mean else walkers
    return ((deviations / space.scale_) ** 2).sum(axis=1)
