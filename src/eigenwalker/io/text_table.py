"""Tables in text: from bytes to lines, from lines to cells, from cells to numbers."""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence

import numpy as np

from eigenwalker.io.errors import AGAIN, UnreadableFile
from eigenwalker.io.numbers import MOST_DISTANT

MISSING = frozenset(
    ("", "nan", "-nan", "na", "n/a", "null", "none", "nan(ind)", "-nan(ind)", "1.#qnan", "-1.#ind")
)
"""What programs write in a cell where nothing was measured, in small letters."""

_PLAIN = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?", re.ASCII)
_TEXT_CONTROLS = frozenset(b"\t\n\r\f\x1a")


def is_text(content: bytes) -> bool:
    """Return whether a file holds text, by its first bytes.

    Examples
    --------
    >>> is_text(b"time,nose_x"), is_text(bytes(16))
    (True, False)

    """
    if content.startswith((b"\xff\xfe", b"\xfe\xff")):
        return True
    return not any(byte < 32 and byte not in _TEXT_CONTROLS for byte in content[:1024])


def lines_of(content: bytes, source: str) -> list[str]:
    """Return the lines of a text, in whatever way its program writes letters and ends lines.

    Parameters
    ----------
    content : bytes
        The whole file: UTF-8 with or without a mark, UTF-16 with one, or else Windows' letters.
    source : str
        Its name, for messages.

    Returns
    -------
    list of str
        Without those at the end that are empty.

    Raises
    ------
    UnreadableFile
        If it is no text.

    """
    wide = content.startswith((b"\xff\xfe", b"\xfe\xff"))
    try:
        text = content.decode("utf-16" if wide else "utf-8-sig")
    except UnicodeDecodeError:
        text = content.decode("cp1252", errors="replace")
    if "\0" in text:
        raise UnreadableFile(source, "text", "bytes that are no letters", AGAIN)
    return re.split(r"\r\n|\n|\r", text.rstrip("\n\r\x1a "))


def separator_of(line: str) -> str | None:
    """Return what separates the cells of a line; None for blanks.

    Examples
    --------
    >>> separator_of("Frame;X 1;Y 1"), separator_of("1.0  2.0") is None
    (';', True)

    """
    return next((mark for mark in "\t;," if mark in line), None)


def cells(line: str, separator: str | None) -> list[str]:
    """Return the cells of a line without blanks and quotation marks around them.

    Examples
    --------
    >>> cells('1, "Hip, left" ,2', ",")
    ['1', 'Hip, left', '2']

    """
    if separator and '"' in line:
        try:
            row = next(csv.reader([line], delimiter=separator, skipinitialspace=True), [])
            return [cell.strip() for cell in row]
        except csv.Error:  # cells that are too long, or a mark in a wrong place
            pass
    return [cell.strip().strip('"') for cell in line.split(separator)]


def table_of(
    lines: Sequence[str],
    n_columns: int,
    *,
    separator: str | None,
    source: str,
    first: int = 1,
    short_by: int = 0,
    columns: Sequence[int] | None = None,
) -> np.ndarray:
    """Return lines of numbers as an array of shape (line, column), NaN for empty cells.

    Where cells are not separated by commas, numbers may have decimal commas.

    Parameters
    ----------
    lines : sequence of str
        One row a line.
    n_columns : int
        Cells a line.
    separator : str or None
        What stands between cells; None for blanks.
    source : str
        Name of the file, for messages.
    first : int
        Number of the first line in the file, for messages.
    short_by : int
        A line but the last may end before a multiple of so many cells which are empty, as when an
        editor cut blanks from the ends of lines.
    columns : sequence of int, optional
        The columns that are wanted; others may hold anything.

    Returns
    -------
    array of shape (line, column)

    Raises
    ------
    UnreadableFile
        If there is no line, or one has fewer or more cells, or something else than numbers.

    """
    if not lines:
        raise UnreadableFile(source, "a line of numbers or more", "none")
    comma = separator != "," and any(re.search(r"\d,\d", line) for line in lines[:20])
    rows: list[np.ndarray] = []
    room = sum(map(len, lines)) + n_columns
    for at, line in enumerate(lines):
        plain = line.replace(",", ".") if comma else line
        words = cells(plain, separator) if '"' in plain else plain.split(separator)
        if len(words) > n_columns:
            words = [*words[:n_columns], *(word for word in words[n_columns:] if word.strip())]
        lack = n_columns - len(words)
        if lack > 0 and short_by and lack % short_by == 0 and at < len(lines) - 1 and lack < room:
            words += [""] * lack
            room -= lack
        if len(words) != n_columns:
            late = ": the file is cut short" if lack > 0 and at == len(lines) - 1 else ""
            raise UnreadableFile(
                source,
                f"{n_columns} cells in line {first + at}",
                f"{len(words)}{late}",
            )
        wanted = words if columns is None else [words[column] for column in columns]
        rows.append(_row(wanted, first + at, source))
    return np.array(rows).reshape(len(rows), n_columns if columns is None else len(columns))


def _row(words: list[str], line: int, source: str) -> np.ndarray:
    try:
        row = np.array([float(word) for word in words])
        sound = all(word.isascii() and "_" not in word for word in words)  # 1_0 is not 10 here
    except ValueError:
        row, sound = np.zeros(0), False
    if not sound or not np.all(np.isnan(row) | (np.abs(row) < MOST_DISTANT)):
        row = np.array([_cell(word.strip(), line, source) for word in words])
    return row


def _cell(word: str, line: int, source: str) -> float:
    if word.lower() in MISSING:
        return np.nan
    value = float(word) if _PLAIN.fullmatch(word) else np.inf
    if not abs(value) < MOST_DISTANT:
        raise UnreadableFile(source, f"a finite number in line {line}", repr(word[:40]))
    return value


def refuse_cut_number(content: bytes, lines: Sequence[str], source: str) -> None:
    """Refuse a file that ends within its last number, as far as that can be seen.

    It can where the file has no end of line at its end and all earlier lines have the same number
    of decimals in their last cell.

    Parameters
    ----------
    content : bytes
        The whole file.
    lines : sequence of str
        Its lines of numbers.
    source : str
        Its name, for messages.

    Raises
    ------
    UnreadableFile
        If the last number is shorter than those above it.

    """
    if len(lines) < 2 or content[-1:].isspace() or content[-2:] in (b"\n\0", b"\r\0"):
        return
    between = r"[\t;]" if re.search(r"[\t;]", lines[0]) else r"[\s,]"
    last = [re.split(between, line)[-1].strip() for line in lines[-20:]]
    decimals = [len(word.replace(",", ".").partition(".")[2]) for word in last]
    if len(set(decimals[:-1])) == 1 and decimals[-1] < decimals[0]:
        raise UnreadableFile(
            source,
            f"{decimals[0]} decimals in each last number of a line",
            f"{last[-1]!r} at its end: the file is cut short",
        )
