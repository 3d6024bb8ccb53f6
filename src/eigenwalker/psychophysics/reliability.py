"""How much answers tell: intervals of fitted weights, and how well any metric could predict."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from eigenwalker.core.arguments import check_numbers
from eigenwalker.psychophysics.perceptual_metric import Weights, non_negative_fit, relative_weights
from eigenwalker.psychophysics.trials import share_not_chosen

MIN_PAIRS = 3
"""Different pairs of walkers that a sample needs to say anything about weights."""
_MAX_ROUNDS = 50
"""Rounds of drawing before too few samples hold enough pairs."""


class Bootstrap(NamedTuple):
    """Weights (sample, group) and constants (sample,), fitted to resampled observers.

    See Also
    --------
    bootstrap_weights, bootstrap_choices : make it.
    """

    weights: np.ndarray
    constants: np.ndarray

    @property
    def relative_weights(self) -> np.ndarray:
        """Weights divided by their sum, of shape (sample, group); 0 where all are."""
        return relative_weights(self.weights)

    def intervals(self, names: ArrayLike, *, level: float = 0.95) -> pd.DataFrame:
        """Return percentile intervals of each group's weight and relative weight.

        Rows are the named groups; columns ``low``, ``high``, ``relative_low``, ``relative_high``
        of the interval that holds the share `level` of the samples, and ``share_zero``, the share
        in which the group weighs nothing.
        """
        tails = [(1 - level) / 2, (1 + level) / 2]
        low, high = np.quantile(self.weights, tails, axis=0)
        relative_low, relative_high = np.quantile(self.relative_weights, tails, axis=0)
        columns = {"low": low, "high": high}
        columns |= {"relative_low": relative_low, "relative_high": relative_high}
        columns["share_zero"] = (self.weights == 0).mean(axis=0)
        return pd.DataFrame(columns, index=pd.Index(np.asarray(names), name="group"))


def bootstrap_weights(
    X: ArrayLike,
    chosen: ArrayLike,
    shown: ArrayLike,
    *,
    pairs: Sequence[tuple[object, object]] | None = None,
    n_samples: int = 1000,
    random_state: int = 0,
) -> Bootstrap:
    """Return weights of `PerceptualMetric` refitted to resampled observers and walkers.

    Observers are drawn with replacement rather than answers, since the answers of one observer
    belong together; walkers rather than pairs, for the same reason. Neither is calibrated: with
    walkers, samples spread wider than repeated studies do, by about a half, as a walker drawn twice
    makes pairs count four times; with observers alone, less than half as much as studies with other
    walkers.

    Parameters
    ----------
    X : array of shape (pair, group)
        Mean F(d_k), as `PerceptualMetric` takes it.
    chosen, shown : array of shape (observer, pair)
        How often each observer chose a pair as the most similar, and was shown it.
    pairs : sequence of pairs, optional
        The two walkers of each pair; left out, only observers are drawn.
    n_samples, random_state : int
        Number of samples, and seed of the random numbers.

    Returns
    -------
    Bootstrap
        Pairs that the observers drawn were never shown are left out of that sample; samples of
        fewer than `MIN_PAIRS` different pairs are drawn again.

    See Also
    --------
    bootstrap_choices : The same for weights fitted to choices.

    References
    ----------
    Efron & Tibshirani (1993), An introduction to the bootstrap, chapter 13.

    Examples
    --------
    >>> X = np.array([[0.0], [1.0], [2.0]])
    >>> shown = np.full((5, 3), 10)
    >>> samples = bootstrap_weights(X, [[6, 4, 2]] * 5, shown, n_samples=10)
    >>> samples.intervals(["calf"])[["low", "high"]].round(6).values.tolist()
    [[0.2, 0.2]]
    """
    X = check_numbers(X, "X", "pair", "group")
    chosen, shown = _check_counts(chosen, shown, n_pairs=len(X))
    rng = np.random.default_rng(random_state)
    fits: list[Weights] = []
    for _ in range(_MAX_ROUNDS):
        times = draw_counts(rng, len(shown), n_samples)
        differences = share_not_chosen(times @ chosen, times @ shown)
        counts = np.ones_like(differences)
        if pairs is not None:
            counts = _counts_of_pairs(pairs, rng, n_samples)
        for y, count in zip(differences, counts, strict=True):
            seen = np.isfinite(y) & (count > 0)
            if seen.sum() >= MIN_PAIRS and len(fits) < n_samples:
                fits.append(non_negative_fit(X[seen], y[seen], sample_weight=count[seen]))
        if len(fits) == n_samples:
            break
    else:
        raise ValueError(
            f"Only {len(fits)} of {_MAX_ROUNDS * n_samples} samples hold {MIN_PAIRS} different "
            f"pairs, of {len(X)} pairs; four walkers or more, each shown with each, are needed."
        )
    return Bootstrap(
        np.array([fit.weights for fit in fits]), np.array([fit.constant for fit in fits])
    )


def draw_counts(rng: np.random.Generator, n: int, n_samples: int) -> np.ndarray:
    """Return how often each of n is among n drawn with replacement, of shape (sample, n)."""
    return rng.multinomial(n, np.full(n, 1 / n), size=n_samples)


def _counts_of_pairs(
    pairs: Sequence[tuple[object, object]], rng: np.random.Generator, n_samples: int
) -> np.ndarray:
    """Return how often each pair of two different walkers is among those drawn, (sample, pair)."""
    walkers, numbers = np.unique(
        [[str(walker) for walker in pair] for pair in pairs], return_inverse=True
    )
    times = draw_counts(rng, len(walkers), n_samples)
    first, second = numbers.reshape(-1, 2).T
    return (times[:, first] * times[:, second]).astype(float)


class Reliability(NamedTuple):
    """Correlations of halves of the observers, of all, and the ceiling that a fit can reach.

    See Also
    --------
    split_half : makes it.
    """

    halves: float
    whole: float
    ceiling: float


def split_half(
    chosen: ArrayLike, shown: ArrayLike, *, n_splits: int = 200, random_state: int = 0
) -> Reliability:
    r"""Return how reliable a table of perceived differences is, and the ceiling of any metric.

    Observers are split into random halves and the tables of the halves correlated over pairs. From
    the mean correlation r of halves, that of all observers with as many others is estimated
    (Spearman and Brown), or 0 where r is below 0:

    .. math:: r_{whole} = \frac{2 r}{1 + r}

    Even the true differences correlate with the table only by the square root of it: the ceiling.
    Choices predicted knowing what else each trial showed (`expected_differences`) can come nearer.

    Parameters
    ----------
    chosen, shown : array of shape (observer, pair)
        How often each observer chose a pair as the most similar, and was shown it.
    n_splits, random_state : int
        Number of random splits, and seed of the random numbers.

    Returns
    -------
    Reliability
        Correlations: ``halves`` (r), ``whole`` and ``ceiling``; NaN, with a warning, where halves
        have no differences that could be correlated.

    See Also
    --------
    bootstrap_weights : Intervals of the weights.

    References
    ----------
    Spearman (1910), Brown (1910), British Journal of Psychology 3, 271-322.

    Examples
    --------
    Four observers who answer alike:

    >>> shown = np.full((4, 3), 10)
    >>> round(split_half([[6, 4, 2]] * 4, shown, n_splits=5).ceiling, 6)
    1.0
    """
    chosen, shown = _check_counts(chosen, shown)
    rng = np.random.default_rng(random_state)
    half = len(shown) // 2
    correlations = []
    for _ in range(n_splits):
        order = rng.permutation(len(shown))
        first, second = (
            share_not_chosen(chosen[part].sum(axis=0), shown[part].sum(axis=0))
            for part in (order[:half], order[half : 2 * half])
        )
        both = np.isfinite(first) & np.isfinite(second)
        if both.sum() >= MIN_PAIRS and np.ptp(first[both]) > 0 and np.ptp(second[both]) > 0:
            correlations.append(np.corrcoef(first[both], second[both])[0, 1])
    if not correlations:
        warnings.warn(
            f"How far halves of the {len(shown)} observers agree is unknown: no two halves saw "
            f"{MIN_PAIRS} pairs in common, of which they chose some more often than others.",
            stacklevel=2,
        )
        return Reliability(np.nan, np.nan, np.nan)
    halves = float(np.mean(correlations))
    whole = 2 * max(halves, 0.0) / (1 + max(halves, 0.0))
    return Reliability(halves, whole, float(np.sqrt(whole)))


def _check_counts(
    chosen: ArrayLike, shown: ArrayLike, n_pairs: int | None = None
) -> tuple[np.ndarray, np.ndarray]:
    chosen = check_numbers(chosen, "chosen", "observer", "pair", missing=True)
    shown = check_numbers(shown, "shown", "observer", "pair", missing=True)
    problem = ""
    if chosen.shape != shown.shape:
        problem = f"chosen has shape {chosen.shape} and shown {shown.shape}"
    elif not (np.isfinite(chosen) & np.isfinite(shown) & (chosen >= 0) & (chosen <= shown)).all():
        problem = "some pairs were chosen more often than shown, or counts are below 0 or NaN"
    elif len(shown) < 2:
        problem = f"there are answers of {len(shown)} observer"
    elif n_pairs not in (None, shown.shape[1]):
        problem = f"they count {shown.shape[1]} pairs, and X has {n_pairs}"
    if problem:
        raise ValueError(
            f"Expected counts of shape (observer, pair), of two observers or more: {problem}."
        )
    return chosen, shown
