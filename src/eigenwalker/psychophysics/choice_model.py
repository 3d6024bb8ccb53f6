"""Dissimilarities of pairs of walkers, as the choices tell them that observers made."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import combinations
from typing import NamedTuple

import numpy as np
import pandas as pd
from scipy.optimize import minimize
from scipy.stats import norm

from eigenwalker.core.arguments import check_kind
from eigenwalker.psychophysics.difference_table import square_table
from eigenwalker.psychophysics.reliability import Reliability, split_half
from eigenwalker.psychophysics.trials import Trials, count_pairs, read_trials, walker_name

ODD_COLUMNS = ["observer", "a", "b", "c", "odd"]
_DENSE = 1500
"""Pairs up to which the whole curvature is inverted."""
_ROUNDS = 40


@dataclass(frozen=True, eq=False)
class ChoiceModel:
    """How different pairs of walkers look, in log odds of being chosen as the most similar.

    Parameters
    ----------
    dissimilarities : DataFrame of shape (walker, walker)
        Symmetric, sorted by label, on average 0 over pairs; a pair that is higher by 1 is chosen
        1/e times as often. NaN on the diagonal.
    intervals : DataFrame
        A row a pair: ``first``, ``second``, ``dissimilarity``, ``se``, ``low``, ``high``,
        ``shown``, ``chosen``, and a ``note`` where it was never shown, never or always chosen.
    observers : DataFrame
        A row an observer: ``answers``, ``log_likelihood`` an answer, and ``above_guessing``: how
        much that is above guessing, in nats. Below 0 the observer answers unlike the others.
    spread : float
        Standard deviation of dissimilarities over pairs.
    reliability : Reliability
        Of the table of differences by counting, over halves of the observers: its ``ceiling`` is
        what the true differences would correlate with it. NaN with fewer than two observers.
    n_answers : int

    See Also
    --------
    fit_choice_model : makes it.
    """

    dissimilarities: pd.DataFrame
    intervals: pd.DataFrame
    observers: pd.DataFrame
    spread: float
    reliability: Reliability
    n_answers: int

    def __repr__(self) -> str:
        return (
            f"ChoiceModel({len(self.dissimilarities)} walkers, {self.n_answers} answers of "
            f"{len(self.observers)} observers)"
        )


def fit_choice_model(answers: pd.DataFrame | Trials, *, confidence: float = 0.95) -> ChoiceModel:
    r"""Return dissimilarities of all pairs of walkers, fitted to single choices.

    A pair p of the set S that is shown is chosen as the most similar with

    .. math:: P(p) = \frac{e^{-\delta_p}}{\sum_{q \in S} e^{-\delta_q}}

    so that it counts which other pairs a trial showed. Dissimilarities of pairs are taken as a
    sample from a normal distribution, whose spread is estimated with them: pairs that were never or
    always chosen get finite values, pairs never shown together the average, with the interval of
    what is not known.

    Parameters
    ----------
    answers : DataFrame or Trials
        One row a trial, as for `read_trials`; or, of the odd one out of three, ``observer``, ``a``,
        ``b``, ``c`` and ``odd``: there the other two are the most similar pair.
    confidence : float
        Of the intervals.

    Returns
    -------
    ChoiceModel

    Raises
    ------
    ValueError
        If columns are missing, or a trial shows a walker twice or none that was chosen.

    See Also
    --------
    difference_table : By counting, without the other pairs.
    fit_choices : Weights of a metric, fitted to the same choices.

    References
    ----------
    Pražák et al. (2010), section 4; McFadden (1974), Conditional logit analysis; Luce (1959).

    Examples
    --------
    >>> rows = [["Eva", "w1", "w2", "w3", "w3"]] * 6 + [["Eva", "w1", "w2", "w3", "w1"]]
    >>> model = fit_choice_model(pd.DataFrame(rows, columns=["observer", "a", "b", "c", "odd"]))
    >>> model.intervals.sort_values("dissimilarity")[["first", "second"]].values.tolist()[0]
    ['w1', 'w2']

    """
    trials = answers if isinstance(answers, Trials) else _trials(answers)
    fit = _fit(trials)
    counts = count_pairs(trials)
    chosen, shown = counts.chosen.sum(axis=0), counts.shown.sum(axis=0)
    pairs = pd.DataFrame(trials.pairs.to_list(), columns=["first", "second"])
    half = norm.isf((1 - confidence) / 2) * fit.se
    pairs = pairs.assign(dissimilarity=fit.delta, se=fit.se)
    pairs = pairs.assign(low=fit.delta - half, high=fit.delta + half)
    pairs = pairs.assign(shown=shown.astype(int), chosen=chosen.astype(int))
    notes = [shown == 0, (chosen == 0) & (shown > 0), (chosen == shown) & (shown > 0)]
    words = ["never shown together", "never chosen", "always chosen"]
    pairs["note"] = np.select(notes, words, default="")
    index = pd.Index(trials.observers, name="observer")
    n = np.bincount(trials.observer, minlength=len(index))
    mean = np.bincount(trials.observer, fit.log_probability, len(index)) / n
    observers = pd.DataFrame({"answers": n, "log_likelihood": mean}, index=index)
    observers["above_guessing"] = mean + np.log(trials.shown.shape[1])
    reliability = Reliability(np.nan, np.nan, np.nan)
    if len(index) > 1 and len(trials.pairs) <= _DENSE:
        reliability = split_half(counts.chosen, counts.shown, n_splits=50)
    return ChoiceModel(
        square_table(pd.Series(fit.delta, index=trials.pairs), diagonal=np.nan),
        pairs,
        observers,
        fit.spread,
        reliability,
        len(trials.chosen),
    )


class _Fit(NamedTuple):
    delta: np.ndarray
    se: np.ndarray
    spread: float
    log_probability: np.ndarray
    """Of the choice of each trial."""


def _fit(trials: Trials) -> _Fit:
    """Find the most likely dissimilarities, and the spread by the EM algorithm."""
    n_pairs, shown, chosen = len(trials.pairs), trials.shown, trials.chosen_pairs
    times_chosen = np.bincount(chosen, minlength=n_pairs).astype(float)

    def loss(delta: np.ndarray, precision: float) -> tuple[float, np.ndarray, np.ndarray]:
        utility = -delta[shown]
        top = utility.max(axis=1, keepdims=True)
        odds = np.exp(utility - top)
        total = odds.sum(axis=1, keepdims=True)
        probability = odds / total
        log_likelihood = -(delta @ times_chosen) - (np.log(total) + top).sum()
        expected = np.bincount(shown.ravel(), probability.ravel(), n_pairs)
        gradient = times_chosen - expected + precision * delta
        return precision / 2 * delta @ delta - log_likelihood, gradient, probability

    delta, spread = np.zeros(n_pairs), 1.0
    for _ in range(_ROUNDS):
        delta = _mode(loss, delta, spread**-2, shown)
        variance = _variance(loss(delta, spread**-2)[2], shown, spread**-2, n_pairs)
        last, spread = spread, max(float(np.sqrt((delta**2 + variance).mean())), 0.05)
        if abs(spread - last) < 1e-3 * last:
            break
    probability = loss(delta, 0.0)[2]
    log_probability = np.log(probability[np.arange(len(shown)), trials.chosen])
    return _Fit(delta, np.sqrt(variance), spread, log_probability)


def _mode(
    loss: Callable[..., tuple[float, np.ndarray, np.ndarray]],
    start: np.ndarray,
    precision: float,
    shown: np.ndarray,
) -> np.ndarray:
    if len(start) > _DENSE:
        found = minimize(
            lambda d: loss(d, precision)[:2],
            start,
            jac=True,
            method="L-BFGS-B",
            options={"maxiter": 300, "gtol": 1e-3},
        )
        return found.x
    delta = start
    for _ in range(50):
        value, gradient, probability = loss(delta, precision)
        step = np.linalg.solve(_curvature(probability, shown, precision, len(delta)), gradient)
        length = 1.0
        while loss(delta - length * step, precision)[0] > value and length > 1e-6:
            length /= 2
        delta = delta - length * step
        if np.abs(step).max() < 1e-6:
            break
    return delta


def _curvature(
    probability: np.ndarray, shown: np.ndarray, precision: float, n_pairs: int
) -> np.ndarray:
    curvature = np.zeros(n_pairs * n_pairs)
    n_shown = shown.shape[1]
    for i in range(n_shown):
        for j in range(n_shown):
            product = -probability[:, i] * probability[:, j]
            curvature += np.bincount(
                shown[:, i] * n_pairs + shown[:, j], product, n_pairs * n_pairs
            )
    curvature = curvature.reshape(n_pairs, n_pairs)
    diagonal = np.bincount(shown.ravel(), probability.ravel(), n_pairs)
    curvature[np.diag_indices(n_pairs)] += diagonal + precision
    return curvature


def _variance(
    probability: np.ndarray, shown: np.ndarray, precision: float, n_pairs: int
) -> np.ndarray:
    """Return the variance of each dissimilarity.

    Of many pairs by the first terms of the series of the inverse: each is shown with so many
    others that what any one of them adds is next to nothing.
    """
    if n_pairs <= _DENSE:
        return np.diag(np.linalg.inv(_curvature(probability, shown, precision, n_pairs))).copy()
    own = (probability * (1 - probability)).ravel()
    diagonal = np.bincount(shown.ravel(), own, n_pairs) + precision
    more = np.zeros(n_pairs)
    for i, j in combinations(range(shown.shape[1]), 2):
        product = (probability[:, i] * probability[:, j]) ** 2
        more += np.bincount(shown[:, i], product / diagonal[shown[:, j]], n_pairs)
        more += np.bincount(shown[:, j], product / diagonal[shown[:, i]], n_pairs)
    return 1 / diagonal + more / diagonal**2


def _trials(answers: pd.DataFrame) -> Trials:
    """Return trials of four walkers, or of the odd one out of three."""
    check_kind(answers, pd.DataFrame, "a table of answers (read_answers) or Trials")
    if "odd" not in answers:
        return read_trials(answers)
    if missing := [name for name in ODD_COLUMNS if name not in answers]:
        raise ValueError(
            f"Answers of the odd one out need the columns {ODD_COLUMNS}; {missing} are missing "
            "from "
            f"{list(answers)}."
        )
    table = answers[ODD_COLUMNS].set_axis(range(2, len(answers) + 2))
    table = table[table["odd"].notna()].map(walker_name)
    three, odd = table[["a", "b", "c"]].to_numpy(str), table["odd"].to_numpy(str)
    if not len(table):
        raise ValueError("There is no answered trial.")
    for line, shown, other in zip(table.index, three.tolist(), odd.tolist(), strict=True):
        if len(set(shown)) < 3 or other not in shown:
            raise ValueError(
                f"Line {line} of the answers shows {shown}, of which {other!r} is the odd one; "
                "expected three different walkers and one of them."
            )
    names = np.unique(three)
    pairs = list(combinations(names.tolist(), 2))
    place = np.searchsorted(names, three)
    pair_of = np.zeros((len(names), len(names)), int)
    first, second = np.triu_indices(len(names), 1)
    pair_of[first, second] = pair_of[second, first] = np.arange(len(pairs))
    together = [(1, 2), (0, 2), (0, 1)]  # of the other two, by which is odd
    shown = np.stack([pair_of[place[:, i], place[:, j]] for i, j in together], axis=1)
    observers, observer = np.unique(table["observer"].to_numpy(str), return_inverse=True)
    return Trials(
        pairs=pd.MultiIndex.from_tuples(pairs, names=["first", "second"]),
        observers=tuple(observers.tolist()),
        observer=observer,
        shown=shown,
        chosen=(three == odd[:, None]).argmax(axis=1),
    )
