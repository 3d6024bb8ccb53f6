"""Weights fitted to the choices themselves, and not to shares of them (P5, P14, A31).

The paper fits a sum of distances to the share of times that each pair was not chosen. Where four
walkers are shown and one of six pairs is chosen, that share depends on the other five, and levels
off: a pair that differs much is never chosen, however much it differs. A model of the choice itself
has no such limit. Here a pair is chosen the more likely, the less it differs from the other five
(McFadden's conditional logit, 1974):

    P(pair chosen) = exp(-d_pair) / sum of exp(-d) over the pairs shown,   d = sum_k w_k F(d_k)

with no w_k below 0, as in the paper. Its likelihood has one maximum.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike
from scipy.linalg import solve_triangular
from scipy.optimize import nnls

from eigenwalker.folds import Progress
from eigenwalker.metric.answers import Trials, count_pairs
from eigenwalker.metric.fit_quality import goodness
from eigenwalker.metric.observers import Bootstrap

_MOST_STEPS = 100
_CERTAIN = 1e-3
"""Mean surprise of a choice, in nats, below which the choices leave the sum of weights open."""


@dataclass(frozen=True, eq=False)
class ChoiceFit:
    """Weights with which a sum of distances tells best what observers chose.

    Parameters
    ----------
    weights : array of shape (group,)
        w_k, 0 or more. A pair that differs by 1 more is chosen 1/e times as often.
    log_likelihood : float
        Of all choices, in nats; guessing has ``-n_trials * log(6)``.
    n_trials : int

    """

    weights: np.ndarray
    log_likelihood: float
    n_trials: int

    @property
    def relative_weights(self) -> np.ndarray:
        """Weights divided by their sum; all 0 where no group tells anything."""
        total = self.weights.sum()
        return self.weights / total if total > 0 else self.weights

    def __repr__(self) -> str:
        surprise = -self.log_likelihood / max(self.n_trials, 1)
        return f"ChoiceFit({len(self.weights)} weights, {surprise:.3f} nats a trial)"


def fit_choices(X: ArrayLike, trials: Trials, *, counts: ArrayLike | None = None) -> ChoiceFit:
    """Return the weights of joint groups that make what observers chose most likely.

    Newton's method, of which each step is a problem of non-negative least squares.

    Parameters
    ----------
    X : array of shape (pair, group)
        Mean F(d_k) of all pairs, in the order of ``trials.pairs``: what `PerceptualMetric` takes.
    trials : Trials
        What was shown and chosen.
    counts : array of shape (trial,), optional
        How often each trial counts; left out, once.

    Returns
    -------
    ChoiceFit

    Raises
    ------
    ValueError
        If X does not fit the pairs, or no trial counts.

    Examples
    --------
    Of two pairs, the one that differs by 1 less is chosen three times of four, so that its odds
    are e to the power of the weight:

    >>> pairs = pd.MultiIndex.from_tuples([("a", "b"), ("c", "d")])
    >>> shown, chosen = np.array([[0, 1]] * 4), np.array([0, 0, 0, 1])
    >>> trials = ew.Trials(pairs, ("Eva",), np.zeros(4, dtype=int), shown, chosen)
    >>> fit_choices([[1.0], [2.0]], trials).weights.round(4), np.log(3).round(4)
    (array([1.0986]), np.float64(1.0986))

    """
    X = _checked(X, trials)
    times = np.ones(len(trials.chosen)) if counts is None else np.asarray(counts, dtype=float)
    if times.shape != trials.chosen.shape or not (times >= 0).all() or not times.sum() > 0:
        raise ValueError(
            f"counts must be one number a trial, 0 or more and not all zero; got shape "
            f"{times.shape} for {len(trials.chosen)} trials."
        )
    spread = _spread(X)
    found, surprise = _most_likely(_to_chosen(X / spread, trials), times, None)
    if surprise < _CERTAIN * times.sum():
        warnings.warn(
            "These choices are foretold almost without exception, so they leave the sum of the "
            "weights open; their ratios are what they tell.",
            stacklevel=2,
        )
    return ChoiceFit(found / spread, -surprise, int(np.count_nonzero(times)))


def bootstrap_choices(
    X: ArrayLike,
    trials: Trials,
    *,
    n_samples: int = 1000,
    seed: int = 0,
    progress: Progress | None = None,
) -> Bootstrap:
    """Return weights fitted anew to the choices of observers drawn with replacement.

    Observers are drawn rather than trials, since the answers of one observer belong together.

    Parameters
    ----------
    X, trials
        As for `fit_choices`; two observers or more.
    n_samples : int
        How often to draw.
    seed : int
        The same seed draws the same.
    progress : callable, optional
        Called with the number of samples that are done, and of all.

    Returns
    -------
    Bootstrap
        Its constants are 0: choices tell none.

    Raises
    ------
    ValueError
        If X does not fit the pairs, or there is one observer only.

    """
    X = _checked(X, trials)
    if len(trials.observers) < 2:
        raise ValueError(
            f"Intervals come from how observers differ; there are answers of "
            f"{len(trials.observers)} observer."
        )
    rng = np.random.default_rng(seed)
    spread = _spread(X)
    apart = _to_chosen(X / spread, trials)
    start, _ = _most_likely(apart, np.ones(len(apart)), None)
    n = len(trials.observers)
    drawn = rng.multinomial(n, np.full(n, 1 / n), size=n_samples)
    samples = []
    for done, times in enumerate(drawn, start=1):
        samples.append(_most_likely(apart, times[trials.observer], start)[0] / spread)
        if progress is not None:
            progress(done, n_samples)
    return Bootstrap(np.array(samples), np.zeros(n_samples))


def choice_probabilities(distances: ArrayLike, shown: np.ndarray) -> np.ndarray:
    """Return how likely each pair shown is to be chosen as the most similar.

    Parameters
    ----------
    distances : array of shape (pair,)
        d of each pair.
    shown : array of int of shape (trial, 6)
        As in `Trials`.

    Returns
    -------
    array of shape (trial, 6)

    Examples
    --------
    >>> choice_probabilities([0.0, np.log(2), np.log(4)], np.array([[0, 1, 2]])).round(3)
    array([[0.571, 0.286, 0.143]])

    """
    away = np.asarray(distances, dtype=float)[shown]
    odds = np.exp(away.min(axis=1, keepdims=True) - away)
    return odds / odds.sum(axis=1, keepdims=True)


def expected_differences(distances: ArrayLike, trials: Trials) -> np.ndarray:
    """Return the table of differences that choices by these distances would give on average.

    Parameters
    ----------
    distances : array of shape (pair,)
        d of each pair.
    trials : Trials
        Of which what was shown counts, not what was chosen.

    Returns
    -------
    array of shape (pair,)
        Share of times that a pair is shown and not chosen (P6); NaN if it is never shown.

    """
    likely = choice_probabilities(distances, trials.shown)
    n_pairs = len(trials.pairs)
    chosen = np.bincount(trials.shown.ravel(), likely.ravel(), n_pairs)
    shown = np.bincount(trials.shown.ravel(), minlength=n_pairs)
    return 1 - np.divide(chosen, shown, out=np.full(n_pairs, np.nan), where=shown > 0)


def unseen_differences(X: ArrayLike, trials: Trials) -> np.ndarray:
    """Return what is expected of each pair by weights that know neither of its walkers.

    They are fitted to the trials that showed neither, and tell what is chosen in those that showed
    both.

    Parameters
    ----------
    X, trials
        As for `fit_choices`.

    Returns
    -------
    array of shape (pair,)
        NaN where no trial showed the pair, or all others showed one of the two.

    """
    X = _checked(X, trials)
    spread = _spread(X)
    apart = _to_chosen(X / spread, trials)
    start, _ = _most_likely(apart, np.ones(len(apart)), None)
    ends = np.array([[*map(str, pair)] for pair in trials.pairs])
    walkers, number = np.unique(ends, return_inverse=True)
    number = number.reshape(ends.shape)
    there = np.zeros((len(trials.chosen), len(walkers)), dtype=bool)
    rows = np.arange(len(there))
    for at in trials.shown.T:
        there[rows[:, None], number[at]] = True
    expected = np.full(len(ends), np.nan)
    for pair, (first, second) in enumerate(number):
        others = ~(there[:, first] | there[:, second])
        both = (trials.shown == pair).any(axis=1)
        if others.any() and both.any():
            weights, _ = _most_likely(apart, others.astype(float), start)
            shown = trials.shown[both]
            likely = choice_probabilities(X @ (weights / spread), shown)
            expected[pair] = 1 - likely[shown == pair].mean()
    return expected


def compare_by_choices(
    tables: Mapping[str, ArrayLike], trials: Trials, *, progress: Progress | None = None
) -> pd.DataFrame:
    """Return how well several metrics tell what observers chose.

    Parameters
    ----------
    tables : mapping of str to array of shape (pair, column)
        For each metric its distances, or mean F(d_k) of each group. Each gets the weights that make
        the choices most likely; a published metric, of one column, keeps all but its factor.
    trials : Trials
        What was shown and chosen.
    progress : callable, optional
        Called with the number of metrics that are done, and of all.

    Returns
    -------
    DataFrame
        Rows are metrics; columns ``n_weights`` (that are not 0); ``bits``, how much likelier than
        by guessing a choice is in the mean, as a power of 2; ``pearson``, the correlation of the
        differences that are expected with those observed; and ``cv_pearson``, the same of
        `unseen_differences`.

    """
    counted = count_pairs(trials)
    observed = counted.differences.to_numpy()
    seen = np.isfinite(observed)
    rows = {}
    for done, (name, table) in enumerate(tables.items(), start=1):
        X = np.asarray(table, dtype=float).reshape(len(observed), -1)
        fitted = fit_choices(X, trials)
        expected = expected_differences(X @ fitted.weights, trials)
        unseen = unseen_differences(X, trials)
        known = np.isfinite(unseen) & seen
        gain = fitted.log_likelihood / fitted.n_trials + np.log(trials.shown.shape[1])
        rows[name] = {
            "n_weights": int((fitted.weights > 0).sum()),
            "bits": gain / np.log(2),
            "pearson": goodness(observed[seen], expected[seen])["pearson"],
            "cv_pearson": goodness(observed[known], unseen[known])["pearson"],
        }
        if progress is not None:
            progress(done, len(tables))
    return pd.DataFrame.from_dict(rows, orient="index").rename_axis("metric")


def _checked(X: ArrayLike, trials: Trials) -> np.ndarray:
    table = np.asarray(X, dtype=float)
    if table.ndim != 2 or len(table) != len(trials.pairs) or not np.isfinite(table).all():
        raise ValueError(
            f"Expected a finite table of {len(trials.pairs)} pairs by groups, as the answers have "
            f"pairs; got shape {table.shape}."
        )
    return table


def _spread(X: np.ndarray) -> np.ndarray:
    spread = X.std(axis=0)
    return np.where(spread > 0, spread, 1.0)


def _to_chosen(X: np.ndarray, trials: Trials) -> np.ndarray:
    """Return how much more each pair shown differs than the chosen one, (trial, 6, group)."""
    return X[trials.shown] - X[trials.chosen_pairs][:, None]


def _most_likely(
    apart: np.ndarray, times: np.ndarray, start: np.ndarray | None
) -> tuple[np.ndarray, float]:
    """Return the weights of least surprise, and their surprise: minus the log-likelihood."""
    kept = times > 0
    apart, times = apart[kept], times[kept]
    n_groups = apart.shape[2]
    weights = np.zeros(n_groups) if start is None else start
    surprise, likely = _surprise(apart, times, weights)
    for _ in range(_MOST_STEPS):
        mean = np.einsum("tp,tpk->tk", likely, apart)
        slope = -times @ mean
        scaled = apart * np.sqrt(likely * times[:, None])[:, :, None]
        scaled = scaled.reshape(-1, n_groups)
        bend = scaled.T @ scaled - (mean * times[:, None]).T @ mean
        bend[np.diag_indices(n_groups)] += 1e-9 * times.sum()
        root = np.linalg.cholesky(bend)
        target = root.T @ weights - solve_triangular(root, slope, lower=True)
        aim = nnls(root.T, target)[0]
        expected = slope @ (aim - weights)
        if expected > -1e-10 * times.sum():
            break
        step = 1.0
        while True:
            tried = weights + step * (aim - weights)
            found, chances = _surprise(apart, times, tried)
            if found <= surprise + 1e-4 * step * expected or step < 1e-8:
                break
            step /= 2
        weights, surprise, likely = tried, found, chances
    return weights, surprise


def _surprise(
    apart: np.ndarray, times: np.ndarray, weights: np.ndarray
) -> tuple[float, np.ndarray]:
    """Return minus the log-likelihood, and how likely each pair is in each trial."""
    away = apart @ weights
    least = away.min(axis=1, keepdims=True)
    odds = np.exp(least - away)
    total = odds.sum(axis=1, keepdims=True)
    return float(times @ (np.log(total) - least)[:, 0]), odds / total
