"""Text files: from lines to cells, from cells to numbers and points."""

from __future__ import annotations

import csv
import re
from collections import Counter
from collections.abc import Sequence
from datetime import UTC, datetime
from operator import itemgetter
from typing import NamedTuple

import numpy as np

from eigenwalker.io.capture_file import CaptureFile
from eigenwalker.io.errors import EXPORT_AGAIN
from eigenwalker.io.missing_codes import is_code
from eigenwalker.io.number_format import N_SAMPLED, NumberMarks, mark_apart, number_marks

MAX_SIZE = 1e9
"""No length, angle or time in a sound file is larger than this, whatever its unit."""
MISSING = frozenset(
    (
        *("", "nan", "-nan", "na", "n/a", "<na>", "null", "(null)", "none", "undefined", "missing"),
        *("nan(ind)", "-nan(ind)", "1.#qnan", "-1.#qnan", "1.#snan", "1.#ind", "-1.#ind"),
        *("1.#inf", "-1.#inf", "inf", "+inf", "-inf", "infinity", "-infinity"),
        *("#n/a", "#na", "#num!", "#value!", "#div/0!", "#ref!", "#null!", "#name?"),
        *("-", "--", "---", ".", "..", "?", "*"),
    )
)
"""What programs write in a cell where nothing was measured, in lower case."""

MAX_CLOCK = 1e20
"""No time is larger, be it in nanoseconds since 1970."""
_TIME_OF_DAY = re.compile(r"((?P<h>\d{1,2}):)?(?P<m>\d{1,2}):(?P<s>\d{1,2}(\.\d*)?)", re.ASCII)
_NUMBER = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?", re.ASCII)

_UNIT = re.compile(r"[ _]*[\[(](mm|cm|m)[\])]$|_(mm|cm|m)$")
_AXIS_AFTER = re.compile(
    r"(?P<name>.+?)(?:[ _.:\-\[(]{1,9}[tp]?(?P<after>[xyzXYZ])[\])]?|(?P<glued>[XYZ]))"
)
_AXIS_BEFORE = re.compile(r"(?P<axis>[xyzXYZ])[ _.](?P<name>.+)")


def separator_of(line: str) -> str | None:
    """Return what separates the cells of a line; None for blanks."""
    return next((mark for mark in "\t;," if mark in line), None)


def cells(line: str, separator: str | None) -> list[str]:
    """Return the cells of a line without blanks and quotation marks around them."""
    if separator and '"' in line:
        try:
            row = next(csv.reader([line], delimiter=separator, skipinitialspace=True), list[str]())
            return [cell.strip() for cell in row]
        except csv.Error:  # cells that are too long, or a mark in a wrong place
            pass
    return [cell.strip().strip('"') for cell in line.split(separator)]


def number(word: str, where: str, file: CaptureFile) -> float:
    """Return the number that a word is; refuse words that are none, and absurd numbers."""
    value = float(word) if _NUMBER.fullmatch(word) else np.nan
    if not abs(value) < MAX_SIZE:
        grouped = re.search(r"\d[^\d.eE+-]\d", word)
        advice = "write numbers with a decimal point and no other mark" if grouped else EXPORT_AGAIN
        raise file.error(f"a finite number in {where}", repr(word[:40]), advice)
    return value


def plain_numbers(words: Sequence[str], clock: int | None = None) -> np.ndarray | None:
    """Return words as numbers, NaN included; None if one is no number, infinite or absurd.

    The number in the place `clock` is a time, which may be large.
    """
    try:
        row = np.array(list(map(float, words)))
    except ValueError:
        return None
    text = "".join(words)
    sound = np.isnan(row) | (np.abs(row) < MAX_SIZE)
    if clock is not None:
        sound[clock] = abs(row[clock]) < MAX_CLOCK
    return row if sound.all() and text.isascii() and "_" not in text else None  # 1_0 is not 10


def table_of(
    file: CaptureFile,
    lines: Sequence[str],
    n_columns: int,
    *,
    separator: str | None,
    first: int = 1,
    short_by: int = 0,
    columns: Sequence[int],
    clock: int | None = None,
    others: Sequence[int] = (),
    marks: NumberMarks | None = None,
) -> np.ndarray:
    """Return columns of lines of numbers as an array, with NaN for empty cells.

    In the columns `others` are numbers too, and anything in those that are not named. `clock` is
    the column of times, which comes last. Numbers may have decimal commas where these do not
    separate cells, or marks between thousands (`number_marks`). Any line but the last may lack a
    multiple of `short_by` cells at its end, which are then empty: some editors strip blanks from
    the ends of lines. `first` is the number of the first line in the file, for messages.
    """
    if not lines:
        raise file.error("a line of numbers or more", "none")
    marks = marks or marks_in(lines, separator, columns)
    wanted = [*others, *columns] if clock is None else [*others, *columns, clock]
    take = None if wanted == list(range(n_columns)) else itemgetter(*wanted, wanted[0])
    rows = np.empty((len(lines), len(wanted)))
    room = sum(map(len, lines)) + n_columns
    for at, line in enumerate(lines):
        plain = line if separator == "," or marks.thousands else marks.plain(line)
        words = cells(plain, separator) if '"' in plain else plain.split(separator)
        if len(words) > n_columns:
            words = [*words[:n_columns], *(word for word in words[n_columns:] if word.strip())]
        lack = n_columns - len(words)
        if lack > 0 and short_by and lack % short_by == 0 and at < len(lines) - 1 and lack < room:
            words += [""] * lack
            room -= lack
        if len(words) != n_columns:
            reason = ": the file is cut short" if lack > 0 and at == len(lines) - 1 else ""
            raise file.error(f"{n_columns} cells in line {first + at}", f"{len(words)}{reason}")
        if take:
            words = take(words)[:-1]
        if marks.thousands:
            words = [marks.plain(word) for word in words]
        row = plain_numbers(words, None if clock is None else -1)
        rows[at] = _cells(words, first + at, file, clock) if row is None else row
    return rows[:, len(others) :]


def marks_in(lines: Sequence[str], separator: str | None, columns: Sequence[int]) -> NumberMarks:
    """Return the marks in the numbers of a table."""
    apart = mark_apart(lines, separator)
    if separator == ",":
        has_commas = any('"' in line for line in lines)
    else:
        has_commas = any(re.search(r"\d,\d", line) for line in lines)
    if not (apart or has_commas) and not any("." in line for line in lines[:N_SAMPLED]):
        return NumberMarks()
    rows = (cells(line, separator) for line in lines)
    coordinates = ([row[at] for at in columns if at < len(row)] for row in rows)
    if apart and separator == ",":
        coordinates = list(coordinates)
        has_commas = any("," in cell for row in coordinates for cell in row)
    marks = number_marks(coordinates, has_commas=has_commas, apart=apart)
    return NumberMarks() if separator == "," and not marks.thousands else marks


def _cells(words: Sequence[str], line: int, file: CaptureFile, clock: int | None) -> list[float]:
    """Return the numbers in the cells of a line one by one."""
    *words, last = words
    if clock is None:
        return [_cell(word, line, file) for word in (*words, last)]
    return [*(_cell(word, line, file) for word in words), clock_time(last, line, file)]


def _cell(word: str, line: int, file: CaptureFile) -> float:
    word = word.strip()
    missing = word.lower() in MISSING or is_code(word)
    return np.nan if missing else number(word, f"line {line}", file)


def clock_time(word: str, line: int, file: CaptureFile) -> float:
    """Return a time as it is written: a number, or seconds since 1970 or midnight of a date."""
    word = word.strip()
    if word.lower() in MISSING:
        return np.nan
    if _NUMBER.fullmatch(word) and abs(float(word)) < MAX_CLOCK:
        return float(word)
    seconds = seconds_of_date(word)
    if seconds is None and file.rate_hz is None and file.default_rate_hz is None:
        raise file.error(
            f"a number or a date (ISO 8601) as the time in line {line}",
            repr(word[:40]),
            "if it is a date, name the rate instead: read_mocap(..., rate_hz=...)",
        )
    return np.nan if seconds is None else seconds


def seconds_of_date(word: str) -> float | None:
    """Return a date as ISO 8601 writes it in seconds since 1970, a time of day since midnight."""
    try:
        moment = datetime.fromisoformat(word)
    except ValueError:
        hit = _TIME_OF_DAY.fullmatch(word)
        hours, minutes, seconds = (hit[part] or 0 for part in ("h", "m", "s")) if hit else (0,) * 3
        return 3600 * int(hours) + 60 * int(minutes) + float(seconds) if hit else None
    return (moment if moment.tzinfo else moment.replace(tzinfo=UTC)).timestamp()


def cut_number(file: CaptureFile, lines: Sequence[str]) -> str:
    """Return the last number of a file that ends within it, as far as that can be seen.

    It can be seen where the file has no end of line at its end, and all earlier lines have the
    same number of decimals in their last cell. Empty where the file is whole.
    """
    if len(lines) < 2 or file.content[-1:].isspace():
        return ""
    between = r"[\t;]" if re.search(r"[\t;]", lines[0]) else r"[\s,]"
    last = [re.split(between, line)[-1].strip() for line in lines[-20:]]
    decimals = [len(word.replace(",", ".").partition(".")[2]) for word in last]
    is_cut = len(set(decimals[:-1])) == 1 and decimals[-1] < decimals[0]
    return repr(last[-1]) if is_cut else ""


def refuse_cut_number(file: CaptureFile, lines: Sequence[str]) -> None:
    """Refuse a file that ends within its last number."""
    if number := cut_number(file, lines):
        expected = "as many decimals in the last number as in those above it"
        raise file.error(expected, f"{number} at its end: the file is cut short")


class Points(NamedTuple):
    """Points that a header names, the columns of their x, y and z, and all other columns."""

    names: list[str]
    columns: list[tuple[int, int, int]]
    others: list[int]


def points_of(header: Sequence[str]) -> Points:
    """Return the points whose three coordinates a header names, in the order of their first.

    Cells are such as ``nose_x``, ``Head (X)``, ``noseX``, ``x_nose``, ``LASI_tx``. A cell that is
    only an axis belongs to the point named before it.
    """
    axes_of: dict[tuple[str, int], dict[str, int]] = {}
    times: Counter[tuple[str, str]] = Counter()
    name = ""
    for index, cell in enumerate(header):
        if coordinate := _coordinate(cell, name):
            name, axis = coordinate
            times[coordinate] += 1  # a second nose_x is about another point of that name
            axes_of.setdefault((name, times[coordinate]), {})[axis] = index
    complete = [(name, axes) for (name, _), axes in axes_of.items() if len(axes) == 3]
    columns = [(axes["x"], axes["y"], axes["z"]) for _, axes in complete]
    used = {column for triple in columns for column in triple}
    others = [index for index in range(len(header)) if index not in used]
    return Points([name for name, _ in complete], columns, others)


def _coordinate(cell: str, last: str) -> tuple[str, str] | None:
    """Return the point and the axis that a cell of a header names; None for any other cell."""
    cell = cell.strip()[:200]
    if cell.lower() in ("x", "y", "z"):
        return (last, cell.lower()) if last else None
    cell = _UNIT.sub("", cell)
    if hit := _AXIS_AFTER.fullmatch(cell):
        return hit["name"], (hit["after"] or hit["glued"]).lower()
    if hit := _AXIS_BEFORE.fullmatch(cell):
        return hit["name"], hit["axis"].lower()
    return None
