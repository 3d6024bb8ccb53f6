"""The table of the captures of a folder and of their traits."""

from __future__ import annotations

import os
import re
import unicodedata
import warnings
from collections import Counter
from collections.abc import Iterable, Sequence
from difflib import get_close_matches
from pathlib import Path

import numpy as np
import pandas as pd

from eigenwalker.io.read import SUFFIXES, is_capture
from eigenwalker.population.persons import person_column
from eigenwalker.population.population import FLAG
from eigenwalker.population.trait_table import check_traits
from eigenwalker.study.trait_cells import UNIT, in_one_spelling, trait_values
from eigenwalker.study.traits_file import DECIMAL_COMMA, LINE, UNITS, names_files, read_traits_file

MAX_NAMED = 5
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

    See Also
    --------
    fit_folder : Makes what it shows.
    """
    folder = Path(folder)
    if not folder.is_dir():
        raise ValueError(f"{folder} is no folder; name one that holds captures ({_known()}).")
    if traits is not None:
        table = _traits_table(traits, folder)
    else:
        names = sorted(captures_in(folder))
        table = pd.DataFrame({FILE: names}, dtype=object)  # names that are no text are kept too
    if table.empty:
        raise ValueError(f"There are no captures ({_known()}) in {folder}.")
    if not trait_from_name:
        return _checked(table, table)
    named = traits_of_names(table[FILE], trait_from_name)
    if both := [str(name) for name in named if name in table]:
        raise ValueError(f"Both the traits table and the pattern name {both}; let one do so.")
    return _checked(table.join(named), table)


def _checked(table: pd.DataFrame, read: pd.DataFrame) -> pd.DataFrame:
    """Return a table that was checked, with the units of the one that was read."""
    checked = check_traits(table)
    checked.attrs[UNITS] = read.attrs.get(UNITS, {})
    return checked


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
    cells = traits if isinstance(traits, pd.DataFrame) else read_traits_file(Path(traits))
    names = [unicodedata.normalize("NFC", str(name)).strip() for name in cells]
    names = _with_file(names, cells, folder)
    if twice := sorted(name for name, count in Counter(names).items() if count > 1):
        raise ValueError(f"The traits table has the columns {twice} more than once.")
    table = cells.set_axis(names, axis=1)
    table = pd.DataFrame({name: _tidied(table[name]) for name in table})
    blank = table.isna() | (table == "")
    lines = np.array(cells.attrs.get(LINE, np.arange(len(cells)) + 1))
    if (unnamed := np.flatnonzero(blank[FILE] & ~blank.all(axis=1))).size:
        kind = "Line" if LINE in cells.attrs else "Row"
        raise ValueError(f"{kind} {lines[unnamed[0]]} of the traits table names no file.")
    keep = ~blank.all(axis=1)
    table, lines = table[keep].reset_index(drop=True), lines[keep.to_numpy()]
    table[FILE] = pd.Series(_as_on_disk(map(str, table[FILE]), folder), dtype=object)
    if (twice := table[FILE][table[FILE].duplicated()]).any():
        raise ValueError(f"The traits table lists {sorted(set(twice))[:5]} more than once.")
    persons = person_column(table)
    letters, units = cells.attrs.get("letters", {}), dict(cells.attrs.get(UNITS, {}))
    for given, name in zip(cells, names, strict=True):
        if name in (FILE, FLAG):
            continue
        if name == persons:
            table[name] = _persons(table[name])
        elif LINE in cells.attrs:
            column = letters.get(given, "")
            values = trait_values(
                table[name].tolist(),
                name,
                lambda at, column=column: f"cell {column}{lines[at]}",
                decimal_comma=cells.attrs[DECIMAL_COMMA],
            )
            units[name] = values.attrs.get(UNIT) or units.get(given, "")
            table[name] = values
        elif _holds_text(table[name]):
            table[name] = in_one_spelling(_numbers_where_all_are(table[name]))
    found = pd.DataFrame({name: table[name] for name in table})
    found.attrs[UNITS] = units
    return found


def _persons(cells: pd.Series) -> pd.Series:
    return in_one_spelling(cells) if _holds_text(cells) else cells


def _with_file(names: Sequence[str], cells: pd.DataFrame, folder: Path) -> list[str]:
    """Return the headings with ``file`` for the one that names the captures."""
    if FILE in names:
        return list(names)
    at = next((at for at, name in enumerate(names) if names_files(name)), None)
    if at is None:  # the column whose cells are captures of the folder
        known = {_stem(name) for name in captures_in(folder)}
        if not known.isdisjoint(map(_stem, names)):
            raise ValueError(
                "The first line of the traits table names a capture; put headings above it, such "
                "as file and sex."
            )
        stems = [[_stem(str(cell)) for cell in cells[name]] for name in cells]
        found = [sum(stem in known for stem in column) for column in stems]
        best = int(np.argmax(found)) if found else 0
        at = best if found and 2 * found[best] > len(cells) else None
    if at is None:
        raise ValueError(
            f"The traits table needs a column 'file' (relative to the folder); it has "
            f"{list(names)[:20]}."
        )
    if names[at].casefold() != FILE:
        warnings.warn(f"The column {names[at]!r} is taken to name the files.", stacklevel=2)
    return [FILE if number == at else name for number, name in enumerate(names)]


def _stem(name: str) -> str:
    name = Path(unicodedata.normalize("NFC", name).replace("\\", "/").casefold()).name
    return Path(name).stem if Path(name).suffix in SUFFIXES else name


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
    return tidy.astype(object)


def _as_on_disk(names: Iterable[str], folder: Path) -> list[str]:
    r"""Return listed files by the names that they have in the folder.

    A name that is not there as it is written is compared with those of the captures: both composed
    (NFC), with ``/`` for ``\\``, then in small letters, without suffix and without folder. It is
    taken where one capture has it.
    """
    written = [Path(name).as_posix() for name in names]
    if all(os.path.lexists(folder / name) for name in written):
        return written
    known: dict[str, list[str]] = {}
    for name in captures_in(folder):
        # Where the system speaks ASCII, names on disk have escapes for all other letters.
        text = os.fsencode(name).decode("utf-8", "surrogateescape")
        composed = unicodedata.normalize("NFC", text)
        folded = Path(composed.casefold())
        stem = folded.with_suffix("")
        keys = {composed, f"folded {folded.as_posix()}", f"stem {stem.as_posix()}"}
        for key in keys | {f"alone {folded.name}", f"alone stem {stem.name}"}:
            known.setdefault(key, []).append(name)

    def found(name: str) -> str:
        plain = Path(unicodedata.normalize("NFC", name).replace("\\", "/")).as_posix()
        folded = plain.casefold()
        stem = (
            Path(folded).with_suffix("").as_posix() if Path(folded).suffix in SUFFIXES else folded
        )
        ways = (plain, f"folded {folded}", f"stem {folded}", f"alone {folded.rpartition('/')[2]}")
        ways += (f"alone stem {stem.rpartition('/')[2]}",)
        same = next((known[way] for way in ways if way in known), [])
        return name if os.path.lexists(folder / name) or len(same) != 1 else same[0]

    names_found = [found(name) for name in written]
    missing = [name for name in names_found if not os.path.lexists(folder / name)]
    free = sorted(set(captures_in(folder)) - set(names_found)) if missing else []
    for name in missing[:MAX_NAMED]:
        if near := get_close_matches(name, free, n=1):
            warnings.warn(
                f"{name} of the traits table is not in the folder; did you mean {near[0]}?",
                stacklevel=2,
            )
    return names_found


def traits_of_names(names: pd.Series, pattern: str) -> pd.DataFrame:
    """Return the traits that the named groups of a pattern find in file names, a row a name."""
    try:
        compiled = re.compile(unicodedata.normalize("NFC", pattern))
    except re.error as error:
        raise ValueError(
            f"trait_from_name={pattern!r} is no regular expression: {error.msg}, after "
            f"{error.pos} letters."
        ) from error
    if not compiled.groupindex:
        raise ValueError(
            f"trait_from_name={pattern!r} has no named group; write for instance "
            "'walk_(?P<style>[a-z]+)_'."
        )
    matches = [compiled.search(unicodedata.normalize("NFC", name)) for name in names]
    if not any(matches):
        raise ValueError(
            f"trait_from_name={pattern!r} matches no file name; the first is {names.iloc[0]!r}."
        )
    traits = pd.DataFrame(
        [match.groupdict() if match else dict.fromkeys(compiled.groupindex) for match in matches]
    )
    return traits.apply(_numbers_where_all_are).apply(in_one_spelling)


def _numbers_where_all_are(column: pd.Series) -> pd.Series:
    numbers = pd.to_numeric(column, errors="coerce")
    return numbers if numbers.notna().equals(column.notna()) else column
