"""A table of traits as spreadsheets save it (CSV, TSV, XLSX), read as the texts in its cells."""

from __future__ import annotations

import csv
import io
import re
import warnings
import zipfile
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from eigenwalker.io.capture_file import as_utf8

MAX_BYTES = 50_000_000
"""More, packed or unpacked, is no table of traits."""
MAX_CELLS = 2_000_000
LINE = "line"
"""Attribute of the table: the line of the file in which each row stands."""
DECIMAL_COMMA = "decimal_comma"
"""Attribute: whether the separator says that commas stand before decimals."""
FILE_WORDS = (
    "file",
    "files",
    "filename",
    "filenames",
    "path",
    "filepath",
    "datei",
    "dateiname",
    "capture",
)
"""Headings, in small letters alone, that name the captures."""
MOST_ABOVE = 10
"""Lines among which headings are looked for, below a title."""
_SEPARATORS = "\t;,|"
_OTHER = {
    ".xls": "an old Excel file",
    ".ods": "a file of LibreOffice",
    ".numbers": "a file of Numbers",
    ".sav": "a file of SPSS",
    ".dta": "a file of Stata",
    ".mat": "a file of MATLAB",
    ".rds": "a file of R",
    ".pdf": "a PDF",
    ".docx": "a file of Word",
}


def read_traits_file(path: Path) -> pd.DataFrame:
    """Return the cells of a table as text, without rows and columns that are empty.

    A first column without heading that only counts the rows, as R writes it, is left out.
    """
    try:
        rows, separator = _rows(path)
    except (OSError, ValueError, csv.Error, KeyError, zipfile.BadZipFile) as error:
        why = (getattr(error, "strerror", None) or str(error)).strip().rstrip(".")
        raise ValueError(
            f"The traits table {path} could not be read: {why}. Save it as CSV in UTF-8 or as XLSX."
        ) from error
    filled = [(at, row) for at, row in enumerate(rows, start=1) if any(row)]
    if len(filled) < 2:
        raise ValueError(f"The traits table {path} has no line below its headings.")
    above = next((at for at, (_, row) in enumerate(filled[:MOST_ABOVE]) if _is_headings(row)), 0)
    if above and len(filled) > above + 1:
        warnings.warn(
            f"The headings of the traits table are taken to stand in line {filled[above][0]}; what "
            "is above is passed over.",
            stacklevel=2,
        )
        filled = filled[above:]
    (_, header), *body = filled
    width = max(len(row) for _, row in filled)
    if len(header) == width - 1 and _counts([row[0] for _, row in body]):
        header = ["", *header]  # of R's write.table, which has no heading above its row names
    header = [*header, *[""] * (width - len(header))]
    columns = [[row[at] if at < len(row) else "" for _, row in body] for at in range(width)]
    keep = [
        at
        for at in range(width)
        if header[at] or (any(columns[at]) and not (at == 0 and _counts(columns[at])))
    ]
    if unnamed := [at for at in keep if not header[at]]:
        raise ValueError(
            f"Column {letters_of(unnamed[0])} of the traits table has no heading in line "
            f"{filled[0][0]}, where headings such as file and sex are looked for."
        )
    if twice := sorted(name for name, n in Counter(header[at] for at in keep).items() if n > 1):
        where = [letters_of(at) for at in keep if header[at] in twice]
        raise ValueError(
            f"The traits table has the columns {twice} more than once (columns "
            f"{', '.join(where)}); rename or remove those that do not count."
        )
    table = pd.DataFrame({header[at]: columns[at] for at in keep}, dtype=object)
    letters = {header[at]: letters_of(at) for at in keep}
    table.attrs.update({LINE: [at for at, _ in body], "letters": letters})
    table.attrs[DECIMAL_COMMA] = separator == ";"
    return table


def names_files(heading: str) -> bool:
    """Return whether a heading is a word for the names of captures."""
    return re.sub(r"[\W_]", "", heading.casefold()) in FILE_WORDS


def _is_headings(row: Sequence[str]) -> bool:
    return sum(map(bool, row)) > 1 and any(map(names_files, row))


def letters_of(column: int) -> str:
    """Return the letters by which spreadsheets call a column, counted from 0."""
    letters = ""
    column += 1
    while column:
        column, rest = divmod(column - 1, 26)
        letters = chr(65 + rest) + letters
    return letters


def _rows(path: Path) -> tuple[list[list[str]], str]:
    if kind := _OTHER.get(path.suffix.lower()):
        raise ValueError(f"it is {kind}")
    if path.stat().st_size > MAX_BYTES:
        raise ValueError(f"it has more than {MAX_BYTES // 1_000_000} MB")
    content = path.read_bytes()
    if content.startswith(b"PK"):
        return _of_workbook(content), ""
    return _of_text(content)


def _of_text(content: bytes) -> tuple[list[list[str]], str]:
    content = as_utf8(content)
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = content.decode("cp1252", errors="replace")  # as Excel saves CSV on Windows
    if "\0" in text:
        raise ValueError("it is no text")
    lines = text.splitlines()
    separator = ""
    if lines and lines[0].lower().startswith("sep=") and len(lines[0]) == 5:
        separator, text = lines[0][4], "\n" + "\n".join(lines[1:])
    head = next((line for line in text.splitlines() if line.strip()), "")
    separator = separator or max(_SEPARATORS, key=head.count)
    if not head.count(separator):
        separator = " " if " " in head.strip() else ","
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=separator, skipinitialspace=True)
    return [[_tidy(cell) for cell in row] for row in reader], separator


def _of_workbook(content: bytes) -> list[list[str]]:
    """Return the cells of the first sheet with a column of files, else of any cells, as texts."""
    from openpyxl import load_workbook

    sheets: list[tuple[str, list[list[str]]]] = []
    n_cells = 0

    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        if sum(entry.file_size for entry in archive.infolist()) > MAX_BYTES:
            raise ValueError(f"it unpacks to more than {MAX_BYTES // 1_000_000} MB")
        if "xl/workbook.xml" not in archive.namelist():
            raise ValueError("it is no XLSX file")
    try:
        book: Any = load_workbook(io.BytesIO(content), read_only=True, data_only=True)
        for sheet in book.worksheets:
            rows: list[list[str]] = []
            for row in sheet.iter_rows(values_only=True):
                n_cells += len(row)
                if n_cells > MAX_CELLS:
                    raise ValueError(f"it has more than {MAX_CELLS} cells")
                rows.append(_without_empty_end([_as_text(cell) for cell in row]))
            if any(map(any, rows)):
                sheets.append((sheet.title, rows))
    except (ValueError, OSError):
        raise
    except Exception as error:  # a damaged workbook fails anywhere in the library, in many ways
        raise ValueError(f"a damaged XLSX file ({type(error).__name__})") from error
    if not sheets:
        return []
    with_files = [sheet for sheet in sheets if any(map(_is_headings, sheet[1][:MOST_ABOVE]))]
    title, rows = (with_files or sheets)[0]
    if len(sheets) > 1:
        others = [name for name, _ in sheets if name != title][:MOST_ABOVE]
        warnings.warn(
            f"The traits are read from the sheet {title!r} of the workbook, not from {others}.",
            stacklevel=2,
        )
    _say_unsaved(content, title, rows)
    return rows


def _say_unsaved(content: bytes, title: str, rows: Sequence[Sequence[str]]) -> None:
    """Say which cells hold formulas without the values that spreadsheet programs save with them."""
    from openpyxl import load_workbook

    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        inside = [name for name in archive.namelist() if name.startswith("xl/worksheets/")]
        if not any(b"<f" in archive.read(name) for name in inside):
            return
    sheet: Any = load_workbook(io.BytesIO(content), read_only=True)[title]
    unsaved = [
        f"{letters_of(column)}{line + 1}"
        for line, cells in enumerate(sheet.iter_rows(values_only=True))
        for column, cell in enumerate(cells)
        if str(cell).startswith("=") and not "".join(rows[line][column : column + 1])
    ]
    if unsaved:
        warnings.warn(
            f"{len(unsaved)} cells of the traits table, first {unsaved[0]}, hold formulas whose "
            "values are not in the file, and are taken as unknown: open it in a spreadsheet "
            "program and save it.",
            stacklevel=2,
        )


def _as_text(value: object) -> str:
    if value is None:
        return ""
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        return str(int(value))
    return _tidy(str(value)).removesuffix(" 00:00:00")


def _tidy(text: str) -> str:
    return text.replace("\u00a0", " ").strip()


def _without_empty_end(row: list[str]) -> list[str]:
    while row and not row[-1]:
        row.pop()
    return row


def _counts(cells: Sequence[str]) -> bool:
    """Return whether cells count from 0 or 1, as numbers of rows do."""
    numbers = [str(at) for at in range(len(cells) + 1)]
    return list(cells) in (numbers[:-1], numbers[1:])
