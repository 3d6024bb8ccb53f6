"""How well metrics predict choices between walkers that they were not fitted to."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from eigenwalker.core.progress import Progress, ticked
from eigenwalker.psychophysics.conditional_logit import (
    ChoiceProblem,
    choice_probabilities,
    expected_differences,
)
from eigenwalker.psychophysics.cross_validation import goodness
from eigenwalker.psychophysics.trials import Trials, count_pairs


def left_out_differences(X: ArrayLike, trials: Trials) -> np.ndarray:
    """Return the expected difference of each pair, predicted without its two walkers.

    For each pair, weights are fitted (`fit_choices`) to the trials that showed neither of its two
    walkers. With these weights, its difference is 1 - P, with P the mean probability that it is
    chosen in the trials that showed it.

    Parameters
    ----------
    X, trials
        As for `fit_choices`.

    Returns
    -------
    array of shape (pair,)
        Expected share of times that the pair is not chosen, from 0 to 1. NaN if no trial showed it,
        or if every trial showed one of its walkers; with five walkers or fewer that is always so.

    See Also
    --------
    compare_by_choices : Several metrics, compared in this way.
    leave_walkers_out : The same split for `PerceptualMetric`.
    """
    table = np.asarray(X, dtype=float)
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
    observed = count_pairs(trials).differences.to_numpy()
    seen = np.isfinite(observed)
    rows = {}
    for name, table in ticked(tables.items(), len(tables), progress):
        X = np.asarray(table, dtype=float).reshape(len(observed), -1)
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
