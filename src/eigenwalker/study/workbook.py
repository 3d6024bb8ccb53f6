"""The cells of an XLSX workbook as texts, as its user sees them."""

from __future__ import annotations

import io
import re
import warnings
import zipfile
from collections.abc import Callable, Sequence
from typing import Any

MAX_BYTES = 50_000_000
"""More, packed or unpacked, is no table of traits."""
MAX_CELLS = 2_000_000
MOST_ABOVE = 10
"""Lines among which headings are looked for, below a title."""
_MAX_NAMED = 5
_SPECIAL = re.compile(rb'<f[ >]|<mergeCell |hidden="(1|true)"')
"""Formulas, merged cells and hidden rows, which take a slower reader to see."""


def workbook_rows(content: bytes, is_headings: Callable[[list[str]], bool]) -> list[list[str]]:
    """Return the cells of the first sheet in sight that has headings, else of any, as texts."""
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        if sum(entry.file_size for entry in archive.infolist()) > MAX_BYTES:
            raise ValueError(f"it unpacks to more than {MAX_BYTES // 1_000_000} MB")
        if "xl/workbook.xml" not in archive.namelist():
            raise ValueError("it is no XLSX file")
        inside = [name for name in archive.namelist() if name.startswith("xl/worksheets/")]
        special = any(_SPECIAL.search(archive.read(name)) for name in inside)
    try:
        title, rows, others = _of_best_sheet(content, is_headings)
        if special:
            rows = _with_special(content, title, rows)
    except (ValueError, OSError):
        raise
    except Exception as error:  # a damaged workbook fails anywhere in the library, in many ways
        raise ValueError(f"a damaged XLSX file ({type(error).__name__})") from error
    if others:
        _say(
            f"The traits are read from the sheet {title!r} of the workbook, not from "
            f"{others[:MOST_ABOVE]}."
        )
    return rows


def _of_best_sheet(
    content: bytes, is_headings: Callable[[list[str]], bool]
) -> tuple[str, list[list[str]], list[str]]:
    """Return the title and cells of the sheet that is read, and the titles of others."""
    from openpyxl import load_workbook

    found: list[tuple[tuple[bool, bool], str, list[list[str]]]] = []
    n_cells = 0
    book: Any = load_workbook(io.BytesIO(content), read_only=True, data_only=True)
    for sheet in book.worksheets:
        rows: list[list[str]] = []
        for row in sheet.iter_rows():
            n_cells += len(row)
            if n_cells > MAX_CELLS:
                raise ValueError(f"it has more than {MAX_CELLS} cells")
            rows.append(_without_empty_end([_as_text(cell) for cell in row]))
        if any(map(any, rows)):
            named = any(map(is_headings, rows[:MOST_ABOVE]))
            found.append(((not named, sheet.sheet_state != "visible"), sheet.title, rows))
    if not found:
        return "", [], []
    _, title, rows = min(found, key=lambda each: each[0])
    return title, rows, [name for _, name, _ in found if name != title]


def _with_special(content: bytes, title: str, rows: list[list[str]]) -> list[list[str]]:
    """Return rows with merged cells filled; formulas without values and hidden rows are said."""
    from openpyxl import load_workbook

    sheet: Any = load_workbook(io.BytesIO(content))[title]
    _say_unsaved(sheet, rows)
    hidden = [f"row {number}" for number, row in sheet.row_dimensions.items() if row.hidden] + [
        f"column {letter}" for letter, each in sheet.column_dimensions.items() if each.hidden
    ]
    if hidden:
        more = f" and {len(hidden) - _MAX_NAMED} more" if len(hidden) > _MAX_NAMED else ""
        _say(
            f"The traits table hides {', '.join(hidden[:_MAX_NAMED])}{more}; what is hidden is "
            "read like all the rest."
        )
    return _with_merged_filled(sheet, rows)


def _with_merged_filled(sheet: Any, rows: list[list[str]]) -> list[list[str]]:
    filled = [list(row) for row in rows]
    merged: list[str] = []
    for cells in sheet.merged_cells.ranges:
        top, column = cells.min_row - 1, cells.min_col - 1
        value = "".join(filled[top][column : column + 1]) if top < len(filled) else ""
        if not value or cells.max_row == cells.min_row:
            continue
        for row in filled[top + 1 : cells.max_row]:
            row.extend([""] * (column + 1 - len(row)))
            row[column] = value
        merged.append(f"{cells.coord} ({value!r})")
    if merged:
        more = f" and {len(merged) - _MAX_NAMED} more" if len(merged) > _MAX_NAMED else ""
        _say(
            f"Merged cells of the traits table count for each of their rows: "
            f"{', '.join(merged[:_MAX_NAMED])}{more}."
        )
    return filled


def _say_unsaved(sheet: Any, rows: Sequence[Sequence[str]]) -> None:
    """Say which cells hold formulas without the values that spreadsheet programs save with them."""
    unsaved = [
        cell.coordinate
        for line, cells in enumerate(sheet.iter_rows(max_row=len(rows)))
        for column, cell in enumerate(cells)
        if cell.data_type == "f" and not "".join(rows[line][column : column + 1])
    ]
    if unsaved:
        _say(
            f"{len(unsaved)} cells of the traits table, first {unsaved[0]}, hold formulas whose "
            "values are not in the file, and are taken as unknown: open it in a spreadsheet "
            "program and save it."
        )


def _as_text(cell: Any) -> str:
    value = cell.value
    if value is None:
        return ""
    if isinstance(value, int | float) and not isinstance(value, bool):
        if "%" in str(cell.number_format):
            return f"{100 * value:.12g}%"
        if float(value).is_integer() and abs(value) < 1e15:
            return str(int(value))
    return str(value).replace("\u00a0", " ").strip().removesuffix(" 00:00:00")


def _without_empty_end(row: list[str]) -> list[str]:
    while row and not row[-1]:
        row.pop()
    return row


def _say(sentence: str) -> None:
    warnings.warn(sentence, stacklevel=3)
