"""Which pairs observers chose as the most similar, counted (P5, P6)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
import pandas as pd

from eigenwalker.metric.observers import difference

SHOWN = ("a", "b", "c", "d")
CHOSEN = ("chosen_1", "chosen_2")


@dataclass(frozen=True, eq=False)
class PairCounts:
    """How often each observer was shown each pair of walkers, and chose it.

    Parameters
    ----------
    pairs : MultiIndex
        The two walkers of each pair, in the order of `itertools.combinations` over sorted names.
    observers : tuple
        The observers.
    chosen, shown : array of shape (observer, pair)
        Counts.

    """

    pairs: pd.MultiIndex
    observers: tuple
    chosen: np.ndarray
    shown: np.ndarray

    def __repr__(self) -> str:
        return (
            f"PairCounts({len(self.observers)} observers, {len(self.pairs)} pairs, "
            f"{self.chosen.sum():.0f} choices)"
        )

    @property
    def differences(self) -> pd.Series:
        """The share of times that each pair was shown and not chosen; NaN if never shown."""
        shares = difference(self.chosen.sum(axis=0), self.shown.sum(axis=0))
        return pd.Series(shares, index=self.pairs, name="difference")


def count_pairs(answers: pd.DataFrame, *, walkers: Sequence[str] | None = None) -> PairCounts:
    """Return how often each observer was shown each pair, and chose it as the most similar.

    Parameters
    ----------
    answers : DataFrame
        One row a trial: ``observer``; the four walkers shown, ``a`` to ``d``; and the two chosen,
        ``chosen_1`` and ``chosen_2``. Trials without an answer (NaN) do not count (A34).
    walkers : sequence of str, optional
        All walkers in the order of pairs wanted, such as that of a `group_table`; left out, those
        that were shown, sorted.

    Returns
    -------
    PairCounts

    Raises
    ------
    ValueError
        If a column is missing, a trial shows a walker twice or one that is not known, or walkers
        were chosen that it did not show, naming the row.

    Examples
    --------
    >>> answers = pd.DataFrame(
    ...     [
    ...         ["Eva", "w1", "w2", "w3", "w4", "w2", "w4"],
    ...         ["Eva", "w1", "w2", "w4", "w5", "w2", "w4"],
    ...     ],
    ...     columns=["observer", "a", "b", "c", "d", "chosen_1", "chosen_2"],
    ... )
    >>> counts = count_pairs(answers)
    >>> counts.differences[("w2", "w4")], counts.differences[("w1", "w2")]
    (np.float64(0.0), np.float64(1.0))

    """
    columns = ["observer", *SHOWN, *CHOSEN]
    if missing := [name for name in columns if name not in answers]:
        raise ValueError(
            f"Answers need the columns {columns}; {missing} are missing from {list(answers)}."
        )
    answered = answers.dropna(subset=list(CHOSEN))
    shown, chosen = (answered[list(names)].to_numpy(dtype=str) for names in (SHOWN, CHOSEN))
    names = sorted(set(shown.ravel())) if walkers is None else [str(name) for name in walkers]
    _check_trials(shown, chosen, answered.index, set(names))
    number = {name: index for index, name in enumerate(names)}
    seen, picked = (np.vectorize(number.__getitem__)(table) for table in (shown, chosen))
    observers, who = np.unique(answered["observer"].to_numpy(), return_inverse=True)
    rows, columns = np.triu_indices(len(names), 1)
    place = np.zeros((len(names), len(names)), dtype=int)
    place[rows, columns] = place[columns, rows] = np.arange(len(rows))
    counts = np.zeros((2, len(observers), len(rows)))
    for first, second in combinations(range(4), 2):
        np.add.at(counts[0], (who, place[seen[:, first], seen[:, second]]), 1)
    np.add.at(counts[1], (who, place[picked[:, 0], picked[:, 1]]), 1)
    pairs = pd.MultiIndex.from_tuples(combinations(names, 2), names=["first", "second"])
    return PairCounts(pairs, tuple(observers.tolist()), chosen=counts[1], shown=counts[0])


def _check_trials(shown: np.ndarray, chosen: np.ndarray, index: pd.Index, known: set[str]) -> None:
    if not len(shown):
        raise ValueError("There is no answered trial.")
    for row, four, two in zip(index, shown.tolist(), chosen.tolist(), strict=True):
        if len(set(four)) < 4:
            raise ValueError(f"Trial {row} shows {four}; expected four different walkers.")
        if not set(four) <= known:
            raise ValueError(
                f"Trial {row} shows {sorted(set(four) - known)}, which are not among the walkers "
                f"{sorted(known)[:20]}."
            )
        if len(set(two)) < 2 or not set(two) <= set(four):
            raise ValueError(f"Trial {row} shows {four}, of which {two} cannot be the pair chosen.")
