"""Answers of observers: which pairs of walkers each trial showed, and which pair was chosen."""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path

import numpy as np
import pandas as pd

from eigenwalker.core.arguments import check_kind, check_whole

SHOWN = ["a", "b", "c", "d"]
CHOSEN = ["chosen_1", "chosen_2"]
COLUMNS = ["observer", *SHOWN, *CHOSEN]

_WHOLE_NUMBER = re.compile(r"^(\d+)\.0$")
_MAX_NAMES = 20
"""Names listed in a message."""


@dataclass(frozen=True, eq=False)
class PairCounts:
    """How often each observer was shown each pair of walkers, and chose it.

    Parameters
    ----------
    pairs : MultiIndex
        The two walkers of each pair, in the order of `itertools.combinations` over their names.
    observers : tuple of str
    chosen, shown : array of shape (observer, pair)
        Counts.

    See Also
    --------
    count_pairs : makes it.

    References
    ----------
    Pražák et al. (2010), section 4.
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
        shares = share_not_chosen(self.chosen.sum(axis=0), self.shown.sum(axis=0))
        return pd.Series(shares, index=self.pairs, name="difference")


@dataclass(frozen=True, eq=False)
class Trials:
    """Which pairs each answered trial showed, and which of them was chosen.

    Parameters
    ----------
    pairs : MultiIndex
        The two walkers of each pair, as in `PairCounts`.
    observers : tuple of str
    observer : array of int of shape (trial,)
        The observer of each trial, as a position in `observers`.
    shown : array of int of shape (trial, 6)
        The pairs of the four walkers shown, as rows of `pairs`. Other experiments may show more
        pairs or fewer.
    chosen : array of int of shape (trial,)
        Which of the pairs shown was chosen: column of `shown`, counted from 0.

    See Also
    --------
    read_trials : Makes it of a table of answers.
    fit_choices : Fits weights to it.

    References
    ----------
    Pražák et al. (2010), section 4 and fig. 2.
    """

    pairs: pd.MultiIndex
    observers: tuple
    observer: np.ndarray
    shown: np.ndarray
    chosen: np.ndarray

    def __post_init__(self) -> None:
        for name, *dims in (("observer", "trial"), ("shown", "trial", "pair"), ("chosen", "trial")):
            object.__setattr__(self, name, check_whole(getattr(self, name), name, *dims))
        n_trials = len(self.shown)
        problems = []
        for name, length in (("observer", len(self.observers)), ("chosen", self.shown.shape[-1])):
            numbers = getattr(self, name)
            if numbers.shape != (n_trials,):
                problems.append(f"{name} has shape {numbers.shape}")
            elif not 0 <= numbers.min() <= numbers.max() < length:
                problems.append(f"{name} goes from {numbers.min()} to {numbers.max()} of {length}")
        if not 0 <= self.shown.min() <= self.shown.max() < len(self.pairs):
            problems.append(f"shown names the pairs {self.shown.min()} to {self.shown.max()}")
        if problems:
            raise ValueError(
                f"Expected trials of {len(self.pairs)} pairs, one row each: {'; '.join(problems)}."
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


def read_answers(path: str | Path) -> pd.DataFrame:
    r"""Return a table of observers' answers from a CSV file.

    Parameters
    ----------
    path : path
        Text in UTF-8, separated by commas, semicolons or tabs.

    Returns
    -------
    DataFrame
        The columns that `read_trials` and `fit_to_answers` take; all cells are text.

    Raises
    ------
    ValueError
        If the file cannot be read, or lacks columns.

    See Also
    --------
    read_trials : Checks what it returns.

    References
    ----------
    Pražák et al. (2010), section 4.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from pathlib import Path
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder, "answers.csv")
    ...     n_characters = file.write_text(
    ...         "observer;a;b;c;d;chosen_1;chosen_2\nEva;w1;w2;w3;w4;w2;w4\n"
    ...     )
    ...     read_answers(file).iloc[0].tolist()
    ['Eva', 'w1', 'w2', 'w3', 'w4', 'w2', 'w4']
    """
    try:
        table = pd.read_csv(path, dtype=str, sep=None, engine="python", encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise ValueError(
            f"The answers {path} are no text in UTF-8; save them as 'CSV UTF-8'."
        ) from error
    except (ValueError, OSError, csv.Error) as error:
        reason = str(getattr(error, "strerror", None) or error).strip()
        raise ValueError(f"The answers {path} could not be read as CSV: {reason}") from error
    table.columns = [str(name).strip() for name in table.columns]
    if missing := [name for name in COLUMNS if name not in table]:
        raise ValueError(
            f"The answers {path} lack the columns {missing}; they have {list(table)[:12]}."
        )
    return table


def read_trials(answers: pd.DataFrame, *, walkers: Sequence[object] | None = None) -> Trials:
    """Return answers trial by trial, checked.

    Parameters
    ----------
    answers : DataFrame
        One row a trial: ``observer``; the four walkers shown, ``a`` to ``d``; and the two chosen
        as the most similar, ``chosen_1`` and ``chosen_2``. Trials without an answer (NaN) do not
        count.
    walkers : sequence of str, optional
        All walkers in the order of pairs wanted, such as that of a `group_table`; left out, those
        that were shown, sorted. Answers call them by these names, by file names without suffix,
        or, as ``walker 3`` of a population, by number.

    Returns
    -------
    Trials

    Raises
    ------
    ValueError
        If a column or an observer is missing, a trial does not show four different known walkers
        or shows none that was chosen, or `walkers` names one twice. Lines are counted as in a file
        whose first line is the headings.

    See Also
    --------
    read_answers : Reads the table of a file.
    count_pairs : The same by pairs.

    References
    ----------
    Pražák et al. (2010), section 4.

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
    check_kind(answers, pd.DataFrame, "a table of answers (read_answers) or Trials")
    if missing := [name for name in COLUMNS if name not in answers]:
        raise ValueError(
            f"Answers need the columns {COLUMNS}; {missing} are missing from {list(answers)}."
        )
    table = answers[COLUMNS].set_axis(pd.RangeIndex(2, len(answers) + 2))  # lines of a file
    table = table[table[CHOSEN].notna().all(axis=1)]
    if (empty := table.isna()).any(axis=None):
        row, place = np.argwhere(empty.to_numpy())[0]
        line, column = table.index[row], table.columns[place]
        raise ValueError(
            f"Line {line} of the answers has an empty cell in the column {column!r}; an "
            "answered trial needs its observer and the four walkers shown."
        )
    names = [walker_name(each) for each in walkers or ()]
    full_name = _full_names(names)
    shown, chosen = (
        table[columns].map(walker_name).map(lambda cell: full_name.get(cell, cell)).to_numpy(str)
        for columns in (SHOWN, CHOSEN)
    )
    if walkers is None:
        names = sorted(set(shown.ravel().tolist()))
    if repeated := sorted({name for name in names if names.count(name) > 1}):
        raise ValueError(
            f"Each walker is to be named once; {repeated[:_MAX_NAMES]} come more than once."
        )
    _check_trials(shown, chosen, table.index, set(names))
    first, second = np.triu_indices(len(names), 1)
    pair_of = np.zeros((len(names), len(names)), dtype=int)
    pair_of[first, second] = pair_of[second, first] = np.arange(len(first))
    a_to_d, two = (
        pd.Index(names).get_indexer(pd.Index(each.ravel())).reshape(each.shape)
        for each in (shown, chosen)
    )
    pairs = np.stack([pair_of[a_to_d[:, i], a_to_d[:, j]] for i, j in combinations(range(4), 2)], 1)
    observers, observer = np.unique(
        table.observer.map(walker_name).to_numpy(str), return_inverse=True
    )
    return Trials(
        pairs=pd.MultiIndex.from_tuples(combinations(names, 2), names=["first", "second"]),
        observers=tuple(observers.tolist()),
        observer=observer,
        shown=pairs,
        chosen=(pairs == pair_of[two[:, 0], two[:, 1]][:, None]).argmax(axis=1),
    )


def count_pairs(
    answers: pd.DataFrame | Trials, *, walkers: Sequence[object] | None = None
) -> PairCounts:
    """Return how often each observer was shown each pair, and chose it as the most similar.

    Parameters
    ----------
    answers : DataFrame or Trials
        One row a trial: ``observer``; the four walkers shown, ``a`` to ``d``; and the two chosen
        as the most similar, ``chosen_1`` and ``chosen_2``.
    walkers : sequence of str, optional
        All walkers in the order of pairs wanted; left out, those that were shown, sorted.

    Returns
    -------
    PairCounts
        Its `differences`, over all observers 1 - (times chosen) / (times shown) of each pair, are
        what `PerceptualMetric` is fitted to.

    See Also
    --------
    read_trials : The same answers, trial by trial.

    References
    ----------
    Pražák et al. (2010), section 4: the table of perceived differences.

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
    chosen, shown = np.zeros((2, len(trials.observers), len(trials.pairs)))
    np.add.at(shown, (trials.observer[:, None], trials.shown), 1)
    np.add.at(chosen, (trials.observer, trials.chosen_pairs), 1)
    return PairCounts(trials.pairs, trials.observers, chosen, shown)


def share_not_chosen(chosen: np.ndarray, shown: np.ndarray) -> np.ndarray:
    """Return the share of times that pairs were shown and not chosen; NaN if never shown."""
    never = np.full(np.shape(shown), np.nan)
    return 1 - np.divide(chosen, shown, out=never, where=np.asarray(shown) > 0)


def walker_name(cell: object) -> str:
    """Return a walker's name; 3.0, as columns of numbers with an empty cell are written, is 3."""
    return _WHOLE_NUMBER.sub(r"\1", str(cell).strip())


def _full_names(names: list[str]) -> dict[str, str]:
    """Return the name of each walker by what answers may call it: name, file stem or number."""
    stems = [Path(name).stem for name in names]
    full = {stem: name for stem, name in zip(stems, names, strict=True) if stems.count(stem) == 1}
    full |= {name.removeprefix("walker "): name for name in names}
    return full | {name: name for name in names}


def _check_trials(shown: np.ndarray, chosen: np.ndarray, lines: pd.Index, known: set[str]) -> None:
    if not len(shown):
        raise ValueError("There is no answered trial.")
    for line, four, two in zip(lines, shown.tolist(), chosen.tolist(), strict=True):
        if len(set(four)) < 4:
            raise ValueError(
                f"Line {line} of the answers shows {four}; expected four different walkers."
            )
        if unknown := sorted(set(four) - known):
            more = f" and {len(known) - _MAX_NAMES} more" if len(known) > _MAX_NAMES else ""
            raise ValueError(
                f"Line {line} of the answers shows {unknown}, which are not among the walkers "
                f"{sorted(known)[:_MAX_NAMES]}{more}."
            )
        if len(set(two)) < 2 or not set(two) <= set(four):
            raise ValueError(
                f"Line {line} of the answers shows {four}, of which {two} cannot be the pair "
                "chosen. Where there was no answer, leave both cells of the choice empty."
            )
