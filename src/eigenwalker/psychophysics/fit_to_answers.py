"""A metric fitted to a table of observers' answers, and what the fit is worth."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike
from sklearn.model_selection import cross_val_predict

from eigenwalker.core.arguments import check_kind
from eigenwalker.core.progress import Progress
from eigenwalker.metric.clips import Clip
from eigenwalker.metric.group_tables import group_table
from eigenwalker.metric.pairwise import distances_by_metric
from eigenwalker.psychophysics.conditional_logit import (
    bootstrap_choices,
    expected_differences,
    fit_choices,
)
from eigenwalker.psychophysics.cross_validation import (
    compare_by_choices,
    compare_metrics,
    leave_walkers_out,
    left_out_differences,
)
from eigenwalker.psychophysics.perceptual_metric import PerceptualMetric, relative_weights
from eigenwalker.psychophysics.reliability import (
    Bootstrap,
    Reliability,
    bootstrap_weights,
    split_half,
)
from eigenwalker.psychophysics.trials import PairCounts, count_pairs, read_trials

FITTED, AS_PUBLISHED = "fitted to these answers", ", as published"


@dataclass(frozen=True, eq=False)
class MetricFit:
    """A metric fitted to answers, and how well it predicts them.

    ``name`` is the published metric whose component and function F were taken, ``model`` the
    `PerceptualMetric` fitted to shares of choices. ``weights`` and ``by_choices`` are of joint
    groups, fitted to shares and to choices: ``weight``, ``relative`` and `Bootstrap.intervals`.
    ``pairs`` has ``shown``, ``difference``, ``predicted``, and ``unseen``, predicted without both
    walkers of the pair; ``expected`` and ``expected_unseen`` are those of a fit to choices.
    ``compared`` has for each metric what `compare_metrics` gives, and after ``choices_`` what
    `compare_by_choices` does. ``n_unanswered`` trials had no answer.

    See Also
    --------
    fit_to_answers : makes it.

    References
    ----------
    Pražák et al. (2010), section 5 and fig. 5.
    """

    name: str
    model: PerceptualMetric
    counts: PairCounts
    weights: pd.DataFrame
    by_choices: pd.DataFrame
    pairs: pd.DataFrame
    compared: pd.DataFrame
    reliability: Reliability
    n_unanswered: int = 0

    def __repr__(self) -> str:
        return f"MetricFit({self.name} of {self.counts})"


def fit_to_answers(
    walks: Mapping[str, Clip],
    answers: pd.DataFrame,
    *,
    metric: str = "positions-sigmoid",
    others: Mapping[str, ArrayLike] | None = None,
    progress: Progress | None = None,
) -> MetricFit:
    """Return the metric that best predicts observers' answers, and how well it does.

    Weights are fitted to the choices (`fit_choices`) and, as in the paper, to the differences of
    pairs (`PerceptualMetric`), with intervals, and compared with the published metrics on pairs of
    walkers that were left out of the fit.

    Parameters
    ----------
    walks : mapping of str to DataArray, Walker or PreparedClip
        What observers saw, by name, five walks or more: such as ``walks_of_folder(folder).clips``.
    answers : DataFrame
        One row a trial: ``observer``; the four walks shown, ``a`` to ``d``; and the two chosen as
        the most similar, ``chosen_1`` and ``chosen_2`` (`read_trials`).
    metric : str
        Name of the published metric whose component and function F to take.
    others : mapping of str to array of shape (pair,), optional
        Distances of all pairs of walks, in the order of `itertools.combinations`, to compare with
        beside the published metrics.
    progress : callable, optional
        Called with the numbers of steps done and of all: of pairs, then samples, then metrics.

    Returns
    -------
    MetricFit
        Pairs that were never shown together are left out, with a warning.

    See Also
    --------
    walks_of_folder, walks_of_population : All walks of a folder or population.
    save_weights, load_metric : The weights file.

    References
    ----------
    Pražák et al. (2010), sections 4 and 5.

    Examples
    --------
    >>> walks = {f"w{i}": ew.simulate_walk(seed=i, rate_hz=60) for i in range(5)}
    >>> rng = np.random.default_rng(0)
    >>> four = [sorted(rng.permutation(list(walks))[:4]) for trial in range(30)]
    >>> chosen = [rng.permutation(shown)[:2] for shown in four]
    >>> rows = [[f"observer {i % 3}", *four[i], *chosen[i]] for i in range(30)]
    >>> columns = ["observer", "a", "b", "c", "d", "chosen_1", "chosen_2"]
    >>> fit = fit_to_answers(walks, pd.DataFrame(rows, columns=columns))
    >>> fit
    MetricFit(positions-sigmoid of PairCounts(3 observers, 10 pairs, 30 choices))
    >>> fit.by_choices.index.tolist()
    ['head', 'clavicle', 'upper_arm', 'forearm', 'hand', 'thigh', 'calf', 'toe']
    """
    check_kind(walks, Mapping, "walks by name")
    names = list(walks)
    trials = read_trials(answers, walkers=names)
    counts = count_pairs(trials)
    y = counts.differences.to_numpy()
    seen = np.isfinite(y)
    if not seen.all():
        first, second = counts.pairs[int(seen.argmin())]
        warnings.warn(
            f"{(~seen).sum()} of {len(y)} pairs were never shown together, such as {first} and "
            f"{second}; they are left out of the fit.",
            stacklevel=2,
        )
    table = group_table(walks, metric, progress=progress)
    published = distances_by_metric(walks).add_suffix(AS_PUBLISHED)
    tables = {FITTED: table.to_numpy(), **published.to_dict("series"), **(others or {})}
    X, y, pairs = table[seen], y[seen], counts.pairs[seen].tolist()
    chosen, shown = counts.chosen[:, seen], counts.shown[:, seen]
    model = PerceptualMetric().fit(X, y)
    choices = fit_choices(table, trials)
    by_shares = compare_metrics(
        {name: np.asarray(each)[seen] for name, each in tables.items()}, y, pairs
    )
    weights = _with_intervals(X, model.weights_, bootstrap_weights(X, chosen, shown, pairs=pairs))
    by_choices = _with_intervals(
        X, choices.weights, bootstrap_choices(table, trials, progress=progress)
    )
    predictions = {
        "shown": shown.sum(axis=0),
        "difference": y,
        "predicted": model.predict(X),
        "unseen": cross_val_predict(PerceptualMetric(), X, y, cv=leave_walkers_out(pairs)),
        "expected": expected_differences(table @ choices.weights, trials)[seen],
        "expected_unseen": left_out_differences(table, trials)[seen],
    }
    compared = compare_by_choices(tables, trials, progress=progress).add_prefix("choices_")
    return MetricFit(
        name=metric,
        model=model,
        counts=counts,
        weights=weights,
        by_choices=by_choices,
        pairs=pd.DataFrame(predictions, index=counts.pairs[seen]),
        compared=by_shares.join(compared),
        reliability=split_half(chosen, shown),
        n_unanswered=len(answers) - len(trials.chosen),
    )


def _with_intervals(X: pd.DataFrame, weights: np.ndarray, samples: Bootstrap) -> pd.DataFrame:
    columns = {"weight": weights, "relative": relative_weights(weights)}
    return pd.DataFrame(columns, index=X.columns).join(samples.intervals(X.columns))
