"""The table of the captures of a folder and of their traits."""

from __future__ import annotations

import csv
import os
import re
import unicodedata
import warnings
from collections import Counter
from pathlib import Path

import numpy as np
import pandas as pd

from eigenwalker.io.read import SUFFIXES, is_capture
from eigenwalker.population.trait_table import check_traits

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
        table = _traits_table(traits, folder)
    else:
        names = sorted(captures_in(folder))
        table = pd.DataFrame({FILE: names})
    if table.empty:
        raise ValueError(f"There are no captures ({_known()}) in {folder}.")
    if not trait_from_name:
        return check_traits(table)
    named = _named_traits(table[FILE], trait_from_name)
    if both := [str(name) for name in named if name in table]:
        raise ValueError(f"Both the traits table and the pattern name {both}; let one do so.")
    return check_traits(table.join(named))


def captures_in(folder: Path) -> list[str]:
    """Return the captures of a folder and its subfolders, by their paths relative to it.

    Hidden ones are left out: those of macOS (``._walk.c3d``), and what is being written.
    """
    paths = [path.relative_to(folder) for path in folder.rglob("*") if is_capture(path)]
    hidden = [any(part.startswith(".") for part in path.parts) for path in paths]
    return [path.as_posix() for path, out in zip(paths, hidden, strict=True) if not out]


def _known() -> str:
    return ", ".join(f"*{suffix}" for suffix in sorted(SUFFIXES))


def _traits_table(traits: pd.DataFrame | str | Path, folder: Path) -> pd.DataFrame:
    if not isinstance(traits, pd.DataFrame):
        traits = _read_table(Path(traits))
    names = [unicodedata.normalize("NFC", str(name)).strip() for name in traits]
    names = [FILE if name in ("File", "FILE") else name for name in names]
    if FILE not in names:
        raise ValueError(
            f"The traits table needs a column 'file' (relative to the folder); it has {names}."
        )
    if twice := sorted(name for name, count in Counter(names).items() if count > 1):
        raise ValueError(f"The traits table has the columns {twice} more than once.")
    table = traits.set_axis(names, axis=1)
    table = pd.DataFrame({name: _tidied(table[name]) for name in table})
    empty = [name for name in names if name.startswith("Unnamed: ") and table[name].isna().all()]
    table = table.drop(columns=empty)
    blank = table.isna() | (table == "")
    if (unnamed := np.flatnonzero(blank[FILE] & ~blank.all(axis=1))).size:
        raise ValueError(f"Row {unnamed[0] + 1} of the traits table names no file.")
    table = table[~blank.all(axis=1)].reset_index(drop=True)
    table[FILE] = _as_on_disk(table[FILE].astype(str), folder)
    if (twice := table[FILE][table[FILE].duplicated()]).any():
        raise ValueError(f"The traits table lists {sorted(set(twice))[:5]} more than once.")
    return pd.DataFrame({name: _in_one_spelling(table[name]) for name in table})


def _read_table(path: Path) -> pd.DataFrame:
    try:
        return pd.read_csv(
            path,
            sep=None,
            engine="python",
            encoding="utf-16" if _begins_as_utf16(path) else "utf-8-sig",
            converters={FILE: str, "person": str},
        )
    except (OSError, ValueError, csv.Error) as error:
        why = str(error).strip().rstrip(".")
        raise ValueError(
            f"The traits table {path} could not be read: {why}. Save it as CSV in UTF-8."
        ) from error


def _begins_as_utf16(path: Path) -> bool:
    with path.open("rb") as file:
        return file.read(2) in (b"\xff\xfe", b"\xfe\xff")


def _holds_text(values: pd.Series) -> bool:
    return pd.api.types.is_object_dtype(values) or pd.api.types.is_string_dtype(values)


def _tidied(values: pd.Series) -> pd.Series:
    """Return a column with its texts composed (NFC), without blanks around them."""
    if not _holds_text(values):
        return values
    tidy = values.map(
        lambda value: (
            unicodedata.normalize("NFC", value).strip() if isinstance(value, str) else value
        )
    )
    if values.name in (FILE, "person"):
        return tidy
    return _numbers_where_all_are(tidy.where(tidy != "")) if (tidy == "").any() else tidy


def _in_one_spelling(values: pd.Series) -> pd.Series:
    """Return a column in which texts that differ in case only are the same, with a warning.

    The spelling in small letters is taken where there is one, else the most frequent one.
    """
    if values.name == FILE or not _holds_text(values):
        return values
    counts = values[values.map(lambda value: isinstance(value, str))].value_counts()
    spelled: dict[str, list[str]] = {}
    for text in counts.index:
        spelled.setdefault(text.casefold(), []).append(text)
    chosen = {}
    for folded, several in spelled.items():
        if len(several) > 1:
            best = folded if folded in several else several[0]
            chosen |= dict.fromkeys(several, best)
            named = ", ".join(map(repr, sorted(several)))
            warnings.warn(f"{values.name}: {named} are taken as one, {best!r}.", stacklevel=2)
    return values.replace(chosen)


def _as_on_disk(names: pd.Series, folder: Path) -> list[str]:
    r"""Return listed files by the names that they have in the folder.

    A name that is not there as it is written is compared with those of the captures: both composed
    (NFC), with ``/`` for ``\\``, and then in small letters. It is taken where one capture has it.
    """
    written = [Path(name).as_posix() for name in names]
    if all(os.path.lexists(folder / name) for name in written):
        return written
    known: dict[str, list[str]] = {}
    for name in captures_in(folder):
        # Where the system speaks ASCII, names on disk have escapes for all other letters.
        text = os.fsencode(name).decode("utf-8", "surrogateescape")
        composed = unicodedata.normalize("NFC", text)
        for key in {composed, f"folded {composed.casefold()}"}:
            known.setdefault(key, []).append(name)

    def found(name: str) -> str:
        plain = Path(unicodedata.normalize("NFC", name).replace("\\", "/")).as_posix()
        same = known.get(plain) or known.get(f"folded {plain.casefold()}", [])
        return name if os.path.lexists(folder / name) or len(same) != 1 else same[0]

    return [found(name) for name in written]


def _named_traits(names: pd.Series, pattern: str) -> pd.DataFrame:
    try:
        compiled = re.compile(unicodedata.normalize("NFC", pattern))
    except re.error as error:
        raise ValueError(f"{pattern!r} is no regular expression: {error}.") from error
    if not compiled.groupindex:
        raise ValueError(
            f"{pattern!r} has no named group; write for instance 'walk_(?P<style>[a-z]+)_'."
        )
    matches = [compiled.search(unicodedata.normalize("NFC", name)) for name in names]
    if not any(matches):
        raise ValueError(f"{pattern!r} matches no file name; the first is {names.iloc[0]!r}.")
    traits = pd.DataFrame(
        [match.groupdict() if match else dict.fromkeys(compiled.groupindex) for match in matches]
    )
    return traits.apply(_numbers_where_all_are).apply(_in_one_spelling)


def _numbers_where_all_are(column: pd.Series) -> pd.Series:
    numbers = pd.to_numeric(column, errors="coerce")
    return numbers if numbers.notna().equals(column.notna()) else column
