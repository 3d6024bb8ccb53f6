"""Weights of a metric fitted to the choices themselves, not to shares of them.

The paper fits a sum of distances to the share of times that each pair was not chosen. Where four
walkers are shown and one of six pairs is chosen, that share depends on the other five pairs and
levels off: a pair that differs much is never chosen, however much it differs. A model of the choice
itself has no such limit.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.linalg import solve_triangular
from scipy.optimize import nnls

from eigenwalker.core.arguments import check_kind, check_numbers
from eigenwalker.core.progress import Progress, ticked
from eigenwalker.psychophysics.perceptual_metric import relative_weights
from eigenwalker.psychophysics.reliability import Bootstrap, draw_counts
from eigenwalker.psychophysics.trials import Trials, share_not_chosen

FLAT_NATS = 0.5
"""Loss of log-likelihood below which a much larger weight fits as well: the weight is unbounded."""
MUCH_LARGER = 10.0
"""By how many times larger, or, of a weight below one per unit of spread, by how much."""
_MAX_STEPS = 100
_CONSTANT = 1e-9
"""Share of its values within which a column counts as constant."""


@dataclass(frozen=True, eq=False)
class ChoiceFit:
    """Weights with which a sum of distances best predicts what observers chose.

    Parameters
    ----------
    weights : array of shape (group,)
        w_k, 0 or more. A pair that differs by 1 more is chosen 1/e times as often.
    log_likelihood : float
        Of all choices, in nats; guessing has ``-n_trials * log(6)``.
    n_trials : float
        Trials that count.

    See Also
    --------
    fit_choices : makes it.
    """

    weights: np.ndarray
    log_likelihood: float
    n_trials: float

    @property
    def relative_weights(self) -> np.ndarray:
        """Weights divided by their sum; all 0 where no group predicts anything."""
        return relative_weights(self.weights)

    def __repr__(self) -> str:
        nats = -self.log_likelihood / self.n_trials
        return f"ChoiceFit({len(self.weights)} weights, {nats:.3f} nats a trial)"


def fit_choices(X: ArrayLike, trials: Trials, *, counts: ArrayLike | None = None) -> ChoiceFit:
    r"""Return the weights of joint groups that make what observers chose most likely.

    A conditional logit: of the pairs shown, pair i is chosen with the probability

    .. math:: P(i) = e^{-d_i} / \sum_j e^{-d_j}, \qquad d_i = \sum_k w_k F(d_{ik}), \; w_k \ge 0

    The likelihood has one maximum, found by Newton's method with steps of non-negative least
    squares. Warns of weights without an upper bound, as of a group that differs only in pairs that
    were never chosen.

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

    See Also
    --------
    PerceptualMetric : The paper's fit, to shares of choices.
    bootstrap_choices : Intervals of the weights.

    References
    ----------
    McFadden (1974), Conditional logit analysis of qualitative choice behavior.

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
    problem = ChoiceProblem.from_trials(X, trials)
    if counts is None:
        counts = np.ones(len(trials.chosen))
    times = check_numbers(counts, "counts", "trial")
    if times.shape != trials.chosen.shape or times.min(initial=0) < 0 or not times.sum() > 0:
        raise ValueError(
            f"counts must be one number a trial, 0 or more and not all zero; got shape "
            f"{times.shape} for {len(trials.chosen)} trials, {times[~(times >= 0)][:5]} among them."
        )
    weights, scaled, loss = problem.fit(times)
    if unbounded := problem.unbounded(scaled, loss, times):
        warnings.warn(
            f"The choices leave open how large the weights of the columns {unbounded}, counted "
            "from 0, are: much more fits as well, as pairs that differ in them were hardly ever "
            "chosen.",
            stacklevel=2,
        )
    return ChoiceFit(weights, -loss, float(times.sum()))


def bootstrap_choices(
    X: ArrayLike,
    trials: Trials,
    *,
    n_samples: int = 1000,
    random_state: int = 0,
    progress: Progress | None = None,
) -> Bootstrap:
    """Return weights of `fit_choices` refitted to observers drawn with replacement.

    Observers are drawn rather than trials, since the answers of one observer belong together.
    Intervals of weights that are not 0 are a little narrow: in repeated simulations of the paper's
    study those of 95 per cent held the planted weight 86 to 91 times of 100.

    Parameters
    ----------
    X : array of shape (pair, group)
        Mean F(d_k) of all pairs, in the order of ``trials.pairs``.
    trials : Trials
        What was shown and chosen, by two observers or more.
    n_samples, random_state : int
        Number of samples, and seed of the random numbers.
    progress : callable, optional
        Called with the number of samples that are done, and of all.

    Returns
    -------
    Bootstrap
        Weights of shape (sample, group), per unit of X. Its constants are 0: a model of choices has
        none.

    See Also
    --------
    fit_choices : The weights of all observers.

    References
    ----------
    Efron & Tibshirani (1993), An introduction to the bootstrap, chapter 13.
    """
    problem = ChoiceProblem.from_trials(X, trials)
    if len(trials.observers) < 2:
        raise ValueError(
            f"Intervals come from how observers differ; there are answers of "
            f"{len(trials.observers)} observer."
        )
    start = problem.fit(np.ones(len(trials.chosen)))[1]
    draws = draw_counts(np.random.default_rng(random_state), len(trials.observers), n_samples)
    samples = [
        problem.fit(times[trials.observer].astype(float), start)[0]
        for times in ticked(draws, n_samples, progress)
    ]
    return Bootstrap(np.array(samples), np.zeros(n_samples))


def choice_probabilities(distances: ArrayLike, shown: np.ndarray) -> np.ndarray:
    """Return the probability, of shape (trial, 6), that each pair shown is chosen."""
    return _softmax(np.asarray(distances)[shown])[0]


def expected_differences(distances: ArrayLike, trials: Trials) -> np.ndarray:
    """Return the table of differences that choices by these distances would give on average.

    Parameters
    ----------
    distances : array of shape (pair,)
        d of each pair.
    trials : Trials
        Only what was shown is used, not what was chosen.

    Returns
    -------
    array of shape (pair,)
        Expected share of times that a pair is shown and not chosen; NaN if it is never shown.

    See Also
    --------
    fit_choices : Fits the weights.

    References
    ----------
    McFadden (1974), Conditional logit analysis of qualitative choice behavior.
    """
    check_kind(trials, Trials, "Trials, as read_trials() returns them")
    n_pairs = len(trials.pairs)
    distances = check_numbers(distances, "distances", "pair", least=n_pairs)
    probability = choice_probabilities(distances, trials.shown)
    return share_not_chosen(
        np.bincount(trials.shown.ravel(), probability.ravel(), n_pairs),
        np.bincount(trials.shown.ravel(), minlength=n_pairs),
    )


class ChoiceProblem(NamedTuple):
    """The likelihood of choices as a function of weights of columns of unit spread."""

    differences: np.ndarray
    """How much more each pair shown differs than the chosen one, (trial, 6, group)."""
    spread: np.ndarray
    """By which the columns were divided, (group,); infinite for those that do not vary."""

    @classmethod
    def from_trials(cls, X: ArrayLike, trials: Trials) -> ChoiceProblem:
        """Return the problem of fitting weights of a table to trials."""
        check_kind(trials, Trials, "Trials, as read_trials() returns them")
        table = check_numbers(X, "X", "pair", "group")
        if len(table) != len(trials.pairs):
            raise ValueError(
                f"Expected a table of {len(trials.pairs)} pairs by groups, as the answers have "
                f"pairs; got shape {table.shape}."
            )
        differences = table[trials.shown] - table[trials.chosen_pairs][:, None]
        spread = np.sqrt((differences**2).mean(axis=(0, 1)))
        spread[spread <= _CONSTANT * np.abs(table).max(axis=0)] = np.inf
        return cls(differences / spread, spread)

    def fit(
        self, times: np.ndarray, start: np.ndarray | None = None
    ) -> tuple[np.ndarray, np.ndarray, float]:
        """Find the most likely weights, with trials that count so many times.

        Returns weights per unit of the table's columns, those of columns of unit spread, at which
        another fit can start, and the negative log-likelihood.
        """
        counted = times > 0
        differences, times = self.differences[counted], times[counted]
        n_groups = differences.shape[2]
        weights = np.zeros(n_groups) if start is None else start
        loss, probability = _negative_log_likelihood(differences, times, weights)
        for _ in range(_MAX_STEPS):
            mean = np.einsum("tp,tpk->tk", probability, differences)
            gradient = -times @ mean
            scaled = differences * np.sqrt(probability * times[:, None])[:, :, None]
            scaled = scaled.reshape(-1, n_groups)
            hessian = scaled.T @ scaled - (mean * times[:, None]).T @ mean
            hessian[np.diag_indices(n_groups)] += 1e-9 * times.sum()
            root = np.linalg.cholesky(hessian)
            target = root.T @ weights - solve_triangular(root, gradient, lower=True)
            step = nnls(root.T, target)[0] - weights
            slope = gradient @ step
            if slope > -1e-10 * times.sum():
                break
            length = 1.0
            tried, probability = _negative_log_likelihood(differences, times, weights + step)
            while tried > loss + 1e-4 * length * slope and length > 1e-8:
                length /= 2
                tried, probability = _negative_log_likelihood(
                    differences, times, weights + length * step
                )
            if tried > loss:  # rounding errors hide any further descent
                break
            weights, loss = weights + length * step, tried
        return weights / self.spread, weights, loss

    def unbounded(self, scaled: np.ndarray, least: float, times: np.ndarray) -> list[int]:
        """Return groups of which a much larger weight would hardly be less likely."""
        groups = np.flatnonzero(scaled).tolist()

        def is_flat(direction: np.ndarray) -> bool:
            more = scaled + MUCH_LARGER * direction / min(direction.max(), 1.0)
            return _negative_log_likelihood(self.differences, times, more)[0] - least < FLAT_NATS

        if groups and is_flat(scaled):  # all of them together
            return groups
        return [group for group in groups if is_flat(np.diag(scaled)[group])]


def _negative_log_likelihood(
    differences: np.ndarray, times: np.ndarray, weights: np.ndarray
) -> tuple[float, np.ndarray]:
    """Return minus the log-likelihood, and the probability of each pair in each trial."""
    probability, log_total = _softmax(differences @ weights)
    return float(times @ log_total), probability


def _softmax(distances: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return exp(-d) over its sum in each row, and the logarithm of that sum."""
    least = distances.min(axis=1, keepdims=True)
    odds = np.exp(least - distances)
    total = odds.sum(axis=1, keepdims=True)
    return odds / total, (np.log(total) - least)[:, 0]
