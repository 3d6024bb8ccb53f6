"""How well metrics foretell choices, of walkers that they were not fitted to."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from eigenwalker.psychophysics.conditional_logit import (
    ChoiceProblem,
    choice_probabilities,
    expected_differences,
)
from eigenwalker.psychophysics.cross_validation import goodness
from eigenwalker.psychophysics.trials import Trials, count_pairs

if TYPE_CHECKING:
    from eigenwalker.core.progress import Progress


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
        NaN where no trial showed the pair, or all others showed one of the two, as they do where
        there are five walkers or fewer.

    """
    table = np.asarray(X, dtype=float)
    problem = ChoiceProblem.of(table, trials)
    start = problem.fit(np.ones(len(trials.chosen)))
    ends = np.array([[*map(str, pair)] for pair in trials.pairs])
    walkers, number = np.unique(ends, return_inverse=True)
    number = number.reshape(ends.shape)
    there = np.zeros((len(trials.chosen), len(walkers)), dtype=bool)
    rows = np.arange(len(there))[:, None]
    for at in trials.shown.T:
        there[rows, number[at]] = True
    expected = np.full(len(ends), np.nan)
    for pair, (first, second) in enumerate(number):
        others = ~(there[:, first] | there[:, second])
        both = (trials.shown == pair).any(axis=1)
        if others.any() and both.any():
            weights = problem.weights(problem.fit(others.astype(float), start))
            shown = trials.shown[both]
            likely = choice_probabilities(table @ weights, shown)
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
        `unseen_differences`, NaN where there are too few walkers.

    """
    observed = count_pairs(trials).differences.to_numpy()
    seen = np.isfinite(observed)
    rows = {}
    for done, (name, table) in enumerate(tables.items(), start=1):
        X = np.asarray(table, dtype=float).reshape(len(observed), -1)
        problem = ChoiceProblem.of(X, trials)
        fitted = problem.fit(np.ones(len(trials.chosen)))
        weights = problem.weights(fitted)
        expected = expected_differences(X @ weights, trials)
        unseen = unseen_differences(X, trials)
        known = np.isfinite(unseen) & seen
        gain = np.log(trials.shown.shape[1]) - fitted.surprise / len(trials.chosen)
        rows[name] = {
            "n_weights": int((weights > 0).sum()),
            "bits": gain / np.log(2),
            "pearson": goodness(observed[seen], expected[seen])["pearson"],
            "cv_pearson": goodness(observed[known], unseen[known])["pearson"],
        }
        if progress is not None:
            progress(done, len(tables))
    return pd.DataFrame.from_dict(rows, orient="index").rename_axis("metric")
