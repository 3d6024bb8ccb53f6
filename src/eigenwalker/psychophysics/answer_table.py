"""What a table of answers must have before it is analysed: its columns, numbers, whole designs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from eigenwalker.core.arguments import LARGEST, check_kind


def take_columns(
    table: Any,
    columns: Mapping[str, Any],
    *,
    numbers: tuple[str, ...] = (),
    empty: tuple[str, ...] = (),
) -> pd.DataFrame:
    """Return the columns of a table under the names of what they mean, checked.

    `columns` has the name of each in the table. Those in `numbers` become float64, and must be
    finite; the others are labels, and no cell of them may be empty but of those in `empty`. Rows
    keep the lines of a file whose first line is the headings.
    """
    check_kind(table, pd.DataFrame, "a table of answers (a pandas DataFrame)")
    has = f"the table has {[str(name) for name in table.columns][:20]}"
    if missing := [f"{role}={name!r}" for role, name in columns.items() if name not in table]:
        raise ValueError(f"Columns are missing: {', '.join(missing)}; {has}.")
    named = list(columns.values())
    if twice := [name for name in dict.fromkeys(named) if named.count(name) > 1]:
        roles = [role for role, name in columns.items() if name == twice[0]]
        raise ValueError(
            f"The column {twice[0]!r} is taken for two things, {' and '.join(roles)}; each needs a "
            f"column of its own, and {has}."
        )
    if not table.columns.is_unique and len(table[named].columns) > len(named):
        raise ValueError(f"Two columns of the table have the same name; {has}.")
    if not len(table):
        raise ValueError("The table has no rows; expected one row an answer.")
    taken = table[named].set_axis([*columns], axis=1).set_axis(range(2, len(table) + 2))
    for role, name in columns.items():
        if role in numbers:
            taken[role] = _finite_numbers(taken[role], name)
        elif role not in empty and (unnamed := taken[role].isna()).any():
            raise ValueError(
                f"Line {unnamed.idxmax()} of the table has an empty cell in the column {name!r}; "
                "name what belongs there, or leave the line out."
            )
    return taken


def levels_of(column: pd.Series) -> list[Any]:
    """Return the levels of a factor that occur: categories in their order, else as they come."""
    if isinstance(column.dtype, pd.CategoricalDtype):
        used = set(column.unique())
        return [level for level in column.cat.categories if level in used]
    return column.unique().tolist()


def cell_means(taken: pd.DataFrame) -> pd.DataFrame:
    """Return the mean `dv` of each `subject` (rows) at each level of `within`; none is missing."""
    row, subjects = pd.factorize(taken["subject"])
    levels = levels_of(taken["within"])
    cell = row * len(levels) + pd.Index(levels).get_indexer(pd.Index(taken["within"]))
    n_cells = len(subjects) * len(levels)
    counts = np.bincount(cell, minlength=n_cells)
    sums = np.bincount(cell, taken["dv"], minlength=n_cells)
    values = (sums / np.where(counts, counts, np.nan)).reshape(len(subjects), -1)
    means = pd.DataFrame(values, index=pd.Index(subjects), columns=pd.Index(levels))
    if (empty := np.isnan(values)).any():
        row, column = np.argwhere(empty)[0]
        others = int(empty.any(axis=1).sum()) - 1
        more = f", and {others} more observers lack cells" if others else ""
        raise ValueError(
            f"Observer {written(means.index[row])} has no answers at the level "
            f"{written(means.columns[column])}"
            f"{more}; an ANOVA needs all cells of an observer. Leave such observers out, or use "
            "crossed_logistic(), which takes the answers there are."
        )
    return means


def groups_of(taken: pd.DataFrame, subjects: pd.Index, name: Any) -> pd.Series:
    """Return the group of each observer; refuse observers in two, and groups of one."""
    row, observers = pd.factorize(taken["subject"])
    first = np.unique(row, return_index=True)[1]
    group = taken["between"].iloc[first].set_axis(subjects)
    other = taken["between"].to_numpy() != group.to_numpy()[row]
    if other.any():
        who, second = observers[row[other.argmax()]], taken["between"].iloc[other.argmax()]
        raise ValueError(
            f"Observer {written(who)} is in two groups of {name!r}, {written(group[who])} and "
            f"{written(second)} (line "
            f"{taken.index[other.argmax()]}); expected one. If these are two people, give them two "
            "names."
        )
    counts = group.value_counts()
    counts = counts[counts > 0]
    if len(counts) < 2:
        raise ValueError(
            f"All {len(group)} observers are in one group, {written(counts.index[0])}, of "
            f"{name!r}; "
            "expected two groups or more."
        )
    if len(alone := counts.index[counts < 2]):
        who = group.index[(group == alone[0]).to_numpy()][0]
        raise ValueError(
            f"The group {written(alone[0])} of {name!r} has one observer, {written(who)}; expected "
            "two or more "
            "in each group, since one tells nothing of how observers differ."
        )
    return group


def written(value: Any) -> str:
    """Return a cell's value for a message: texts in quotes, numbers as such."""
    return repr(value.item() if hasattr(value, "item") else value)


def _finite_numbers(column: pd.Series, name: Any) -> pd.Series:
    values = pd.to_numeric(column, errors="coerce").astype(float)
    wrong = ~(values.abs() <= LARGEST)
    if wrong.any():
        row = int(wrong.to_numpy().argmax())
        raise ValueError(
            f"Line {row + 2} of the table has {written(column.iloc[row])} in the column {name!r}; "
            "expected a finite number. Correct it, or leave the line out."
        )
    return values
