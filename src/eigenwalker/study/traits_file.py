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

import pandas as pd

from eigenwalker.io.capture_file import as_utf8
from eigenwalker.study.workbook import MAX_BYTES, MOST_ABOVE, workbook_rows

LINE = "line"
"""Attribute of the table: the line of the file in which each row stands."""
DECIMAL_COMMA = "decimal_comma"
"""Attribute: whether the separator says that commas stand before decimals."""
UNITS = "units"
"""Attribute: the units in a line of their own below the headings, by heading."""
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
    top = [_is_headings(row) for _, row in filled[:MOST_ABOVE]]
    above = top.index(True) if True in top else 0
    while above + 1 < len(top) and top[above + 1]:  # of headings in two lines, the lower one
        above += 1
    if above and len(filled) > above + 1:
        warnings.warn(
            f"The headings of the traits table are taken to stand in line {filled[above][0]}; what "
            "is above is passed over.",
            stacklevel=2,
        )
        filled = filled[above:]
    (_, header), *body = filled
    header = [" ".join(heading.split()) for heading in header]
    units = _units_below(header, body)
    body = body[1:] if units else body
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
    table.attrs[UNITS] = units
    return table


def names_files(heading: str) -> bool:
    """Return whether a heading is a word for the names of captures."""
    return re.sub(r"[\W_]", "", heading.casefold()) in FILE_WORDS


def _is_headings(row: Sequence[str]) -> bool:
    return sum(map(bool, row)) > 1 and any(map(names_files, row))


def _units_below(header: Sequence[str], body: Sequence[tuple[int, list[str]]]) -> dict[str, str]:
    """Return the units that stand in a line of their own, below headings and without a file."""
    at = next((at for at, heading in enumerate(header) if names_files(heading)), None)
    if at is None or len(body) < 2 or any(row[at : at + 1] in ([], [""]) for _, row in body[1:]):
        return {}
    line, row = body[0]
    named = {head: cell for head, cell in zip(header, row, strict=False) if cell}
    if "".join(row[at : at + 1]) or any(map(str.isdecimal, "".join(row))):
        return {}
    warnings.warn(f"Line {line} of the traits table is taken to hold units: {named}.", stacklevel=3)
    return named


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
        return workbook_rows(content, _is_headings), ""
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


def _tidy(text: str) -> str:
    return text.replace("\u00a0", " ").strip()


def _counts(cells: Sequence[str]) -> bool:
    """Return whether cells count from 0 or 1, as numbers of rows do."""
    numbers = [str(at) for at in range(len(cells) + 1)]
    return list(cells) in (numbers[:-1], numbers[1:])
