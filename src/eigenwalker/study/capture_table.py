"""The table of the captures of a folder and of their traits."""

from __future__ import annotations

import csv
import re
from pathlib import Path

import numpy as np
import pandas as pd

from eigenwalker.io.read import SUFFIXES, is_capture

FILE = "file"
"""Column of a traits table that names the capture, relative to the folder."""


def capture_table(
    folder: str | Path,
    traits: pd.DataFrame | str | Path | None = None,
    trait_from_name: str | None = None,
) -> pd.DataFrame:
    """Return the captures of a folder with their traits, as `fit_folder` reads them.

    Parameters
    ----------
    folder, traits, trait_from_name
        As `fit_folder` takes them.

    Returns
    -------
    DataFrame
        One row a capture: ``file``, relative to the folder, and a column a trait.

    Raises
    ------
    ValueError
        If folder, table or pattern make no sense.
    """
    folder = Path(folder)
    if not folder.is_dir():
        raise ValueError(f"{folder} is no folder; name one that holds captures ({_known()}).")
    if traits is not None:
        table = _traits_table(traits)
    else:
        names = sorted(captures_in(folder))
        table = pd.DataFrame({FILE: names})
    if table.empty:
        raise ValueError(f"There are no captures ({_known()}) in {folder}.")
    if not trait_from_name:
        return table
    named = _named_traits(table[FILE], trait_from_name)
    if both := [str(name) for name in named if name in table]:
        raise ValueError(f"Both the traits table and the pattern name {both}; let one do so.")
    return table.join(named)


def captures_in(folder: Path) -> list[str]:
    """Return the captures of a folder and its subfolders, by their paths relative to it."""
    return [path.relative_to(folder).as_posix() for path in folder.rglob("*") if is_capture(path)]


def _known() -> str:
    return ", ".join(f"*{suffix}" for suffix in sorted(SUFFIXES))


def _traits_table(traits: pd.DataFrame | str | Path) -> pd.DataFrame:
    if not isinstance(traits, pd.DataFrame):
        try:
            traits = pd.read_csv(
                traits,
                sep=None,
                engine="python",
                encoding="utf-8-sig",
                converters={FILE: str, "person": str},
            )
        except (OSError, ValueError, csv.Error) as error:
            why = str(error).strip().rstrip(".")
            raise ValueError(
                f"The traits table {traits} could not be read: {why}. Save it as CSV in UTF-8."
            ) from error
    tidy = {name: str(name).strip() for name in traits}
    traits = traits.rename(columns=tidy).rename(columns={"File": FILE, "FILE": FILE})
    if FILE not in traits:
        raise ValueError(
            f"The traits table needs a column 'file' (relative to the folder); it has "
            f"{list(traits.columns)}."
        )
    table = traits.reset_index(drop=True)
    missing = table[FILE].isna() | (table[FILE].astype(str).str.strip() == "")
    if missing.any():
        row = int(np.flatnonzero(missing)[0]) + 1
        raise ValueError(f"Row {row} of the traits table names no file.")
    table[FILE] = [Path(str(name).strip()).as_posix() for name in table[FILE]]
    if (twice := table[FILE][table[FILE].duplicated()]).any():
        raise ValueError(f"The traits table lists {sorted(set(twice))[:5]} more than once.")
    return table


def _named_traits(names: pd.Series, pattern: str) -> pd.DataFrame:
    try:
        compiled = re.compile(pattern)
    except re.error as error:
        raise ValueError(f"{pattern!r} is no regular expression: {error}.") from error
    if not compiled.groupindex:
        raise ValueError(
            f"{pattern!r} has no named group; write for instance 'walk_(?P<style>[a-z]+)_'."
        )
    matches = [compiled.search(name) for name in names]
    if not any(matches):
        raise ValueError(f"{pattern!r} matches no file name; the first is {names.iloc[0]!r}.")
    traits = pd.DataFrame(
        [match.groupdict() if match else dict.fromkeys(compiled.groupindex) for match in matches]
    )
    return traits.apply(_numbers_where_all_are)


def _numbers_where_all_are(column: pd.Series) -> pd.Series:
    numbers = pd.to_numeric(column, errors="coerce")
    return numbers if numbers.notna().equals(column.notna()) else column
