"""Which marks stand for decimals and for thousands in a table: whether 1,503 is 1503 or 1.503."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from functools import cache
from itertools import islice
from typing import NamedTuple

MIN_GROUPED = 20
"""Fewer numbers such as 1.503 are decimals, as nearly all tables have decimal points."""
N_SAMPLED = 2000
"""Rows in which numbers such as 1.503 are looked at."""

APART = ("'", "\u2019", "\u00a0", "\u2009", "\u202f", "_", " ")
"""Marks between thousands that are no decimals anywhere: Swiss, French and SI style, programs'."""


class NumberMarks(NamedTuple):
    """The mark before decimals, and the one between thousands, if there is one."""

    decimal: str = "."
    thousands: str = ""

    def plain(self, text: str) -> str:
        """Return numbers as Python writes them; with marks between thousands, one number."""
        if self.thousands:
            if _grouped(self.thousands).fullmatch(text.strip()):
                text = text.replace(self.thousands, "")
            elif self.decimal == "," and "." in text:
                return text  # a number of another column, such as a time
        return text.replace(",", ".") if self.decimal == "," else text


@cache
def _grouped(mark: str) -> re.Pattern[str]:
    decimal = {",": "[.]", ".": ","}.get(mark, "[.,]")
    mark = re.escape(mark)
    return re.compile(rf"[+-]?[1-9]\d{{0,2}}({mark}\d{{3}})+({decimal}\d*)?", re.ASCII)


_WHOLE = re.compile(r"[+-]?[1-9]\d*", re.ASCII)


def noted(marks: NumberMarks) -> dict[str, str]:
    """Return the attribute that tells of marks between thousands."""
    return {"thousands_mark": marks.thousands} if marks.thousands else {}


def mark_apart(lines: Sequence[str], separator: str | None) -> str:
    """Return the mark of `APART` that may stand between thousands in lines, empty if none does."""
    marks = APART if separator else APART[:-1]
    present = [mark for mark in marks if any(mark in line for line in lines)]
    return next((m for m in present if any(_between(m).search(line) for line in lines)), "")


@cache
def _between(mark: str) -> re.Pattern[str]:
    return re.compile(rf"\d{re.escape(mark)}\d{{3}}(?!\d)", re.ASCII)


def number_marks(
    rows: Iterable[Sequence[str]], *, has_commas: bool, apart: str = ""
) -> NumberMarks:
    """Return the marks in the coordinates of a table; `has_commas` is whether some have a comma.

    A comma or point stands between thousands if three digits follow it in all numbers that have it,
    none of which begins with 0, and whole numbers stand beside them: 503 below 1,503. `apart` is a
    mark of `APART` that the table has: it does so where three digits follow it.
    """
    decimal = "," if has_commas else "."
    if apart:
        rows = list(rows)
        marked = [cell.strip() for row in rows for cell in row if apart in cell.strip()]
        if marked:
            is_mark = all(map(_grouped(apart).fullmatch, marked))
            return NumberMarks(decimal, apart if is_mark else "")
    if has_commas:
        rows = list(rows)
        if _is_grouped(rows, ","):
            return NumberMarks(".", ",")
    if _is_grouped(islice(rows, N_SAMPLED), "."):
        return NumberMarks(",", ".")
    return NumberMarks(decimal)


def _is_grouped(rows: Iterable[Sequence[str]], mark: str) -> bool:
    decimal = "." if mark == "," else ","
    n_marked, beside = 0, False
    for row in rows:
        for cell in row:
            word = cell.strip()
            if mark in word:
                if not _grouped(mark).fullmatch(word):
                    return False
                n_marked += 1
            beside = beside or decimal in word or _WHOLE.fullmatch(word) is not None
    return beside and n_marked >= (1 if mark == "," else MIN_GROUPED)
