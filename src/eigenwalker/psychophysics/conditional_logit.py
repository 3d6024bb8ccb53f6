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
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.linalg import solve_triangular
from scipy.optimize import nnls

from eigenwalker.psychophysics.reliability import Bootstrap, times_drawn
from eigenwalker.psychophysics.trials import Trials

if TYPE_CHECKING:
    from eigenwalker.core.progress import Progress

OPEN = 0.5
"""Log-likelihood, in nats, by less of which much more weight is worse: it is open upwards then."""

MUCH = 10.0
"""How many times as much that is, or, of a weight below one per unit of spread, how much."""

_MOST_STEPS = 100
_SAME = 1e-9
"""Share of its values within which a column does not vary."""


@dataclass(frozen=True, eq=False)
class ChoiceFit:
    """Weights with which a sum of distances tells best what observers chose.

    Parameters
    ----------
    weights : array of shape (group,)
        w_k, 0 or more. A pair that differs by 1 more is chosen 1/e times as often.
    log_likelihood : float
        Of all choices, in nats; guessing has ``-n_trials * log(6)``.
    n_trials : float
        Trials that count.

    """

    weights: np.ndarray
    log_likelihood: float
    n_trials: float

    @property
    def relative_weights(self) -> np.ndarray:
        """Weights divided by their sum; all 0 where no group tells anything."""
        total = self.weights.sum()
        return self.weights / total if total > 0 else self.weights

    def __repr__(self) -> str:
        surprise = -self.log_likelihood / self.n_trials
        return f"ChoiceFit({len(self.weights)} weights, {surprise:.3f} nats a trial)"


def fit_choices(X: ArrayLike, trials: Trials, *, counts: ArrayLike | None = None) -> ChoiceFit:
    """Return the weights of joint groups that make what observers chose most likely.

    Newton's method, of which each step is a problem of non-negative least squares. Warns of weights
    that the choices leave open upwards, as of a group that differs only in pairs never chosen.

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

    >>> import pandas as pd
    >>> pairs = pd.MultiIndex.from_tuples([("a", "b"), ("c", "d")])
    >>> shown, chosen = np.array([[0, 1]] * 4), np.array([0, 0, 0, 1])
    >>> trials = ew.psychophysics.Trials(pairs, ("Eva",), np.zeros(4, dtype=int), shown, chosen)
    >>> fit_choices([[1.0], [2.0]], trials).weights.round(4), np.log(3).round(4)
    (array([1.0986]), np.float64(1.0986))

    """
    times = np.ones(len(trials.chosen)) if counts is None else np.asarray(counts, dtype=float)
    amiss = times.shape != trials.chosen.shape or not np.isfinite(times).all()
    if amiss or times.min(initial=0) < 0 or not times.sum() > 0:
        raise ValueError(
            f"counts must be one number a trial, 0 or more and not all zero; got shape "
            f"{times.shape} for {len(trials.chosen)} trials, {times[~(times >= 0)][:5]} among them."
        )
    problem = ChoiceProblem.of(X, trials)
    found = problem.fit(times)
    if still_open := problem.open_upwards(found, times):
        warnings.warn(
            f"The choices leave open how large the weights of the columns {still_open}, counted "
            "from 0, are: much more fits as well, as pairs that differ in them were hardly ever "
            "chosen.",
            stacklevel=2,
        )
    return ChoiceFit(problem.weights(found), -found.surprise, float(times.sum()))


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
    Intervals of weights that are not 0 are a little narrow: in repeated simulations of the paper's
    study those of 95 per cent held the planted weight 86 to 91 times of 100.

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
    if len(trials.observers) < 2:
        raise ValueError(
            f"Intervals come from how observers differ; there are answers of "
            f"{len(trials.observers)} observer."
        )
    problem = ChoiceProblem.of(X, trials)
    start = problem.fit(np.ones(len(trials.chosen)))
    samples = []
    drawn = times_drawn(np.random.default_rng(seed), len(trials.observers), n_samples)
    for done, times in enumerate(drawn, start=1):
        found = problem.fit(times[trials.observer].astype(float), start)
        samples.append(problem.weights(found))
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


class _Found(NamedTuple):
    """Weights of columns of unit spread, and minus the log-likelihood there."""

    scaled: np.ndarray
    surprise: float


class ChoiceProblem(NamedTuple):
    """How much more each pair shown differs than the chosen one, columns of unit spread.

    Parameters
    ----------
    apart : array of shape (trial, 6, group)
    spread : array of shape (group,)
        By which the columns were divided; infinite for those that do not vary.

    """

    apart: np.ndarray
    spread: np.ndarray

    @classmethod
    def of(cls, X: ArrayLike, trials: Trials) -> ChoiceProblem:
        """Return the problem of fitting weights of a table to trials; refuse what does not fit."""
        table = np.asarray(X, dtype=float)
        if table.ndim != 2 or len(table) != len(trials.pairs):
            raise ValueError(
                f"Expected a table of {len(trials.pairs)} pairs by groups, as the answers have "
                f"pairs; got shape {table.shape}."
            )
        if not np.isfinite(table).all():
            raise ValueError("The table of pairs by groups has numbers that are not finite.")
        apart = table[trials.shown] - table[trials.chosen_pairs][:, None]
        spread = np.sqrt((apart**2).mean(axis=(0, 1)))
        spread[spread <= _SAME * np.abs(table).max(axis=0)] = np.inf
        return cls(apart / spread, spread)

    def weights(self, found: _Found) -> np.ndarray:
        """Return weights per unit of the table's columns."""
        return found.scaled / self.spread

    def fit(self, times: np.ndarray, start: _Found | None = None) -> _Found:
        """Return the weights of least surprise, trials counting so many times."""
        kept = times > 0
        apart, times = self.apart[kept], times[kept]
        n_groups = apart.shape[2]
        weights = np.zeros(n_groups) if start is None else start.scaled
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
            way = nnls(root.T, target)[0] - weights
            expected = slope @ way
            if expected > -1e-10 * times.sum():
                break
            step = 1.0
            found, chances = _surprise(apart, times, weights + way)
            while found > surprise + 1e-4 * step * expected and step > 1e-8:
                step /= 2
                found, chances = _surprise(apart, times, weights + step * way)
            if found > surprise:  # no way down is left that numbers could tell
                break
            weights, surprise, likely = weights + step * way, found, chances
        return _Found(weights, surprise)

    def open_upwards(self, found: _Found, times: np.ndarray) -> list[int]:
        """Return groups of which ten times the weight would hardly be less likely."""
        groups = np.flatnonzero(found.scaled).tolist()

        def is_open(direction: np.ndarray) -> bool:
            more = found.scaled + MUCH * direction / min(direction.max(), 1.0)
            return _surprise(self.apart, times, more)[0] - found.surprise < OPEN

        if groups and is_open(found.scaled):  # all of them together
            return groups
        return [group for group in groups if is_open(np.diag(found.scaled)[group])]


def _surprise(
    apart: np.ndarray, times: np.ndarray, weights: np.ndarray
) -> tuple[float, np.ndarray]:
    """Return minus the log-likelihood, and how likely each pair is in each trial."""
    away = apart @ weights
    least = away.min(axis=1, keepdims=True)
    odds = np.exp(least - away)
    total = odds.sum(axis=1, keepdims=True)
    return float(times @ (np.log(total) - least)[:, 0]), odds / total
