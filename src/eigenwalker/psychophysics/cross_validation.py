"""How well metrics predict differences and choices of walkers that they were not fitted to."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike
from scipy.stats import rankdata
from sklearn.model_selection import cross_val_predict

from eigenwalker.core.arguments import check_kind, check_numbers
from eigenwalker.core.progress import Progress, ticked
from eigenwalker.psychophysics.conditional_logit import (
    ChoiceProblem,
    choice_probabilities,
    expected_differences,
)
from eigenwalker.psychophysics.perceptual_metric import PerceptualMetric
from eigenwalker.psychophysics.trials import Trials, count_pairs


def goodness(observed: ArrayLike, predicted: ArrayLike) -> dict[str, float]:
    """Return how near predictions come to perceived differences of pairs.

    Parameters
    ----------
    observed, predicted : array of shape (pair,)
        Each pair of two walkers once.

    Returns
    -------
    dict
        ``rss``, the sum of squared errors; ``rms``, the root of their mean; ``pearson`` and
        ``spearman`` correlations, NaN if one of the two does not vary or there is no pair.

    See Also
    --------
    compare_metrics : The same for several metrics.

    References
    ----------
    Pražák et al. (2010), figure 5, whose "difference" can only be twice this ``rss``.

    Examples
    --------
    >>> round(goodness([0.2, 0.4, 0.9], [0.3, 0.4, 0.8])["rss"], 6)
    0.02
    """
    observed = check_numbers(observed, "observed", "pair", least=0)
    predicted = check_numbers(predicted, "predicted", "pair", least=0)
    if len(observed) != len(predicted):
        raise ValueError(f"observed has {len(observed)} pairs, and predicted {len(predicted)}.")
    error = observed - predicted
    if not error.size:
        return {"rss": 0.0, "rms": np.nan, "pearson": np.nan, "spearman": np.nan}
    varies = np.ptp(observed) > 0 and np.ptp(predicted) > 1e-12 * np.abs(predicted).max()
    ranks = [rankdata(observed), rankdata(predicted)]
    return {
        "rss": float(error @ error),
        "rms": float(np.sqrt(np.mean(error**2))),
        "pearson": float(np.corrcoef(observed, predicted)[0, 1]) if varies else np.nan,
        "spearman": float(np.corrcoef(ranks)[0, 1]) if varies else np.nan,
    }


def leave_walkers_out(
    pairs: Sequence[tuple[object, object]],
) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return a split for each pair that leaves out both its walkers, with all pairs they are in.

    Leaving pairs out alone would let a metric know the walkers from their other pairs.

    Parameters
    ----------
    pairs : sequence of pairs
        The two walkers of each pair; four walkers or more.

    Returns
    -------
    list of pairs of arrays
        Rows to fit to, and the one row to predict: scikit-learn's ``cv=leave_walkers_out(pairs)``.

    See Also
    --------
    left_out_differences : The same split for `fit_choices`.

    References
    ----------
    Pražák et al. (2010), section 5: the fit that it tests.

    Examples
    --------
    >>> import itertools
    >>> pairs = list(itertools.combinations("abcd", 2))
    >>> train, test = leave_walkers_out(pairs)[0]
    >>> [pairs[row] for row in train], [pairs[row] for row in test]
    ([('c', 'd')], [('a', 'b')])
    """
    names = np.array([[str(walker) for walker in pair] for pair in pairs])
    splits = []
    for row, pair in enumerate(names):
        train = np.flatnonzero(~np.isin(names, pair).any(axis=1))
        if not train.size:
            a, b = map(str, pair)
            raise ValueError(
                f"Every pair holds the walker {a!r} or {b!r}, so that none is left to fit to; "
                "compare four walkers or more, each with each."
            )
        splits.append((train, np.array([row])))
    return splits


def compare_metrics(
    tables: Mapping[str, ArrayLike], y: ArrayLike, pairs: Sequence[tuple[object, object]]
) -> pd.DataFrame:
    """Return how well several metrics predict the same differences.

    Each table gets the constant and the weights, none below 0, that fit best; a published metric,
    of one column, gets a constant and a factor.

    Parameters
    ----------
    tables : mapping of str to array of shape (pair, column)
        For each metric its distances, or mean F(d_k) of each group.
    y : array of shape (pair,)
        Perceived differences.
    pairs : sequence of pairs
        The two walkers of each pair.

    Returns
    -------
    DataFrame
        Rows are metrics; columns ``n_weights`` (that are not 0), the four of `goodness`, and
        ``cv_rms``, ``cv_pearson``, ``cv_spearman`` of pairs whose two walkers were both left out.

    See Also
    --------
    compare_by_choices : The same by trials.

    References
    ----------
    Pražák et al. (2010), figure 5.
    """
    _check_tables(tables)
    y = check_numbers(y, "y", "pair")
    splits = leave_walkers_out(pairs)
    rows = {}
    for name, table in tables.items():
        X = _of_pairs(name, table, len(y))
        metric = PerceptualMetric().fit(X, y)
        left_out = goodness(y, np.asarray(cross_val_predict(PerceptualMetric(), X, y, cv=splits)))
        rows[name] = {
            "n_weights": int((metric.weights_ > 0).sum()),
            **goodness(y, metric.predict(X)),
            **{f"cv_{measure}": left_out[measure] for measure in ("rms", "pearson", "spearman")},
        }
    return pd.DataFrame.from_dict(rows, orient="index").rename_axis("metric")


def left_out_differences(X: ArrayLike, trials: Trials) -> np.ndarray:
    """Return the expected difference of each pair, predicted without its two walkers.

    For each pair, weights are fitted (`fit_choices`) to the trials that showed neither of its two
    walkers. With these weights, its difference is 1 - P, with P the mean probability that it is
    chosen in the trials that showed it.

    Parameters
    ----------
    X : array of shape (pair, group)
        Mean F(d_k) of all pairs, in the order of ``trials.pairs``.
    trials : Trials
        What was shown and chosen.

    Returns
    -------
    array of shape (pair,)
        Expected share of times that the pair is not chosen, from 0 to 1. NaN if no trial showed it,
        or if every trial showed one of its walkers; with five walkers or fewer that is always so.

    See Also
    --------
    compare_by_choices : Several metrics, compared in this way.
    leave_walkers_out : The same split for `PerceptualMetric`.

    References
    ----------
    McFadden (1974), Conditional logit analysis of qualitative choice behavior.
    """
    table = check_numbers(X, "X", "pair", "group")
    problem = ChoiceProblem.from_trials(table, trials)
    start = problem.fit(np.ones(len(trials.chosen)))[1]
    names = np.array([[*map(str, pair)] for pair in trials.pairs])
    walkers, number = np.unique(names, return_inverse=True)
    number = number.reshape(names.shape)
    in_trial = np.zeros((len(trials.chosen), len(walkers)), dtype=bool)
    rows = np.arange(len(in_trial))[:, None]
    for pair in trials.shown.T:
        in_trial[rows, number[pair]] = True
    expected = np.full(len(names), np.nan)
    for pair, (first, second) in enumerate(number):
        neither = ~(in_trial[:, first] | in_trial[:, second])
        both = (trials.shown == pair).any(axis=1)
        if neither.any() and both.any():
            weights = problem.fit(neither.astype(float), start)[0]
            shown = trials.shown[both]
            probability = choice_probabilities(table @ weights, shown)
            expected[pair] = 1 - probability[shown == pair].mean()
    return expected


def compare_by_choices(
    tables: Mapping[str, ArrayLike], trials: Trials, *, progress: Progress | None = None
) -> pd.DataFrame:
    """Return how well several metrics predict what observers chose.

    Each table gets the weights that make the choices most likely; a published metric, of one
    column, gets a factor.

    Parameters
    ----------
    tables : mapping of str to array of shape (pair, column)
        For each metric its distances, or mean F(d_k) of each group.
    trials : Trials
        What was shown and chosen.
    progress : callable, optional
        Called with the number of metrics that are done, and of all.

    Returns
    -------
    DataFrame
        Rows are metrics; columns ``n_weights`` (that are not 0); ``bits``, the mean gain in
        log2-likelihood of a choice over guessing; ``pearson``, the correlation of expected and
        observed differences; and ``cv_pearson``, the same of `left_out_differences`, NaN where
        there are too few walkers.

    See Also
    --------
    compare_metrics : The same by differences of pairs.
    """
    _check_tables(tables)
    observed = count_pairs(trials).differences.to_numpy()
    seen = np.isfinite(observed)
    rows = {}
    for name, table in ticked(tables.items(), len(tables), progress):
        X = _of_pairs(name, table, len(observed))
        problem = ChoiceProblem.from_trials(X, trials)
        weights, _, loss = problem.fit(np.ones(len(trials.chosen)))
        expected = expected_differences(X @ weights, trials)
        left_out = left_out_differences(X, trials)
        known = np.isfinite(left_out) & seen
        rows[name] = {
            "n_weights": int((weights > 0).sum()),
            "bits": (np.log(trials.shown.shape[1]) - loss / len(trials.chosen)) / np.log(2),
            "pearson": goodness(observed[seen], expected[seen])["pearson"],
            "cv_pearson": goodness(observed[known], left_out[known])["pearson"],
        }
    return pd.DataFrame.from_dict(rows, orient="index").rename_axis("metric")


def _check_tables(tables: Mapping[str, ArrayLike]) -> None:
    check_kind(tables, Mapping, "a table for each metric, by name")
    if not tables:
        raise ValueError("There is no metric to compare.")


def _of_pairs(name: str, table: ArrayLike, n_pairs: int) -> np.ndarray:
    """Return the table of a metric, or its column, of shape (pair, column)."""
    values = check_numbers(table, f"The table of {name!r}")
    if not values.ndim or len(values) != n_pairs:
        raise ValueError(f"The table of {name!r} has shape {values.shape}, for {n_pairs} pairs.")
    return values.reshape(n_pairs, -1)
