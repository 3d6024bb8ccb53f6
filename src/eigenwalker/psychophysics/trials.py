"""Which pairs observers chose as the most similar, trial by trial and counted (P5, P6)."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
import pandas as pd

from eigenwalker.psychophysics.reliability import difference

_WHOLE = re.compile(r"^(\d+)\.0$")

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


@dataclass(frozen=True, eq=False)
class Trials:
    """Which pairs each answered trial showed, and which of them was chosen.

    Parameters
    ----------
    pairs : MultiIndex
        The two walkers of each pair, as in `PairCounts`.
    observers : tuple
        Their names.
    observer : array of int of shape (trial,)
        Whose trial it was, as a number in `observers`.
    shown : array of int of shape (trial, 6)
        The pairs of the four walkers shown, as rows of `pairs`. Other experiments may show more
        pairs or fewer.
    chosen : array of int of shape (trial,)
        Which of those shown was chosen, from 0.

    """

    pairs: pd.MultiIndex
    observers: tuple
    observer: np.ndarray
    shown: np.ndarray
    chosen: np.ndarray

    def __post_init__(self) -> None:
        n_trials = len(self.shown)
        amiss = []
        if self.shown.ndim != 2 or not n_trials:
            amiss.append(f"shown has shape {self.shown.shape}")
        for name, length in (("observer", len(self.observers)), ("chosen", self.shown.shape[-1])):
            numbers = getattr(self, name)
            if numbers.shape != (n_trials,):
                amiss.append(f"{name} has shape {numbers.shape}")
            elif n_trials and not 0 <= numbers.min() <= numbers.max() < length:
                amiss.append(f"{name} goes from {numbers.min()} to {numbers.max()} of {length}")
        if n_trials and not 0 <= self.shown.min() <= self.shown.max() < len(self.pairs):
            amiss.append(f"shown names the pairs {self.shown.min()} to {self.shown.max()}")
        if amiss:
            raise ValueError(
                f"Expected trials of {len(self.pairs)} pairs, one row each: {'; '.join(amiss)}."
            )

    def __repr__(self) -> str:
        return (
            f"Trials({len(self.chosen)} of {len(self.observers)} observers, "
            f"{len(self.pairs)} pairs)"
        )

    @property
    def chosen_pairs(self) -> np.ndarray:
        """The pair chosen in each trial, as a row of `pairs`."""
        return self.shown[np.arange(len(self.shown)), self.chosen]


def read_trials(answers: pd.DataFrame, *, walkers: Sequence[object] | None = None) -> Trials:
    """Return answers trial by trial, checked.

    Parameters
    ----------
    answers, walkers
        As for `count_pairs`.

    Returns
    -------
    Trials

    Raises
    ------
    ValueError
        As `count_pairs` does.

    Examples
    --------
    >>> answers = pd.DataFrame(
    ...     [["Eva", "w1", "w2", "w3", "w4", "w2", "w4"]],
    ...     columns=["observer", "a", "b", "c", "d", "chosen_1", "chosen_2"],
    ... )
    >>> trials = read_trials(answers)
    >>> trials.pairs[trials.chosen_pairs].tolist()
    [('w2', 'w4')]

    """
    columns = ["observer", *SHOWN, *CHOSEN]
    if missing := [name for name in columns if name not in answers]:
        raise ValueError(
            f"Answers need the columns {columns}; {missing} are missing from {list(answers)}."
        )
    given = answers[columns].notna().to_numpy()
    kept = given[:, -2:].all(axis=1)
    answered, lines = pd.DataFrame(answers[kept]), 2 + np.flatnonzero(kept)
    _refuse_empty(given[kept], columns, lines)
    shown, chosen = (_names_in(answered, names) for names in (SHOWN, CHOSEN))
    names = sorted(set(shown.ravel().tolist()))
    if walkers is not None:
        names = [as_name(each) for each in walkers]
    if twice := sorted({name for name in names if names.count(name) > 1}):
        raise ValueError(f"Each walker is to be named once; {twice[:20]} come more than once.")
    _check_trials(shown, chosen, lines, set(names))
    number = {name: index for index, name in enumerate(names)}
    seen, picked = (np.vectorize(number.__getitem__)(table) for table in (shown, chosen))
    observers, who = np.unique(_names_in(answered, ["observer"])[:, 0], return_inverse=True)
    rows, columns = np.triu_indices(len(names), 1)
    place = np.zeros((len(names), len(names)), dtype=int)
    place[rows, columns] = place[columns, rows] = np.arange(len(rows))
    six = np.stack([place[seen[:, i], seen[:, j]] for i, j in combinations(range(4), 2)], axis=1)
    return Trials(
        pairs=pd.MultiIndex.from_tuples(combinations(names, 2), names=["first", "second"]),
        observers=tuple(observers.tolist()),
        observer=who,
        shown=six,
        chosen=(six == place[picked[:, 0], picked[:, 1]][:, None]).argmax(axis=1),
    )


def count_pairs(
    answers: pd.DataFrame | Trials, *, walkers: Sequence[object] | None = None
) -> PairCounts:
    """Return how often each observer was shown each pair, and chose it as the most similar.

    Parameters
    ----------
    answers : DataFrame
        One row a trial: ``observer``; the four walkers shown, ``a`` to ``d``; and the two chosen,
        ``chosen_1`` and ``chosen_2``. Trials without an answer (NaN) do not count (A34). Or
        `Trials`, which have been read.
    walkers : sequence of str, optional
        All walkers in the order of pairs wanted, such as that of a `group_table`; left out, those
        that were shown, sorted. Numbers may stand for names.

    Returns
    -------
    PairCounts

    Raises
    ------
    ValueError
        If a column or an observer is missing, a trial shows a walker twice, none, or one that is
        not known, or walkers were chosen that it did not show; or `walkers` names one twice. Lines
        are counted as in a file whose first line is the headings.

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
    trials = answers if isinstance(answers, Trials) else read_trials(answers, walkers=walkers)
    counts = np.zeros((2, len(trials.observers), len(trials.pairs)))
    np.add.at(counts[0], (trials.observer[:, None], trials.shown), 1)
    np.add.at(counts[1], (trials.observer, trials.chosen_pairs), 1)
    return PairCounts(trials.pairs, trials.observers, chosen=counts[1], shown=counts[0])


def as_name(said: object) -> str:
    """Return a walker's name; 3.0, as columns of numbers with an empty cell are written, is 3."""
    return _WHOLE.sub(r"\1", str(said).strip())


def _names_in(answers: pd.DataFrame, columns: Sequence[str]) -> np.ndarray:
    return np.column_stack([answers[name].map(as_name).to_numpy(dtype=str) for name in columns])


def _few(names: Sequence[str], most: int = 20) -> str:
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return f"{list(names[:most])}{more}"


def _refuse_empty(given: np.ndarray, columns: list[str], lines: np.ndarray) -> None:
    if given.all():
        return
    row, column = np.argwhere(~given)[0]
    raise ValueError(
        f"Line {lines[row]} of the answers has an empty cell in the column {columns[column]!r}; an "
        "answered trial needs its observer and the four walkers shown."
    )


def _check_trials(
    shown: np.ndarray, chosen: np.ndarray, lines: np.ndarray, known: set[str]
) -> None:
    if not len(shown):
        raise ValueError("There is no answered trial.")
    for line, four, two in zip(lines, shown.tolist(), chosen.tolist(), strict=True):
        if len(set(four)) < 4:
            raise ValueError(
                f"Line {line} of the answers shows {four}; expected four different walkers."
            )
        if not set(four) <= known:
            raise ValueError(
                f"Line {line} of the answers shows {sorted(set(four) - known)}, which are not "
                f"among the walkers {_few(sorted(known))}."
            )
        if len(set(two)) < 2 or not set(two) <= set(four):
            raise ValueError(
                f"Line {line} of the answers shows {four}, of which {two} cannot be the pair "
                "chosen. Where there was no answer, leave both cells of the choice empty."
            )
