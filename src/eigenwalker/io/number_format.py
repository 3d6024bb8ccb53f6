"""Which marks stand for decimals and for thousands in a table: whether 1,503 is 1503 or 1.503."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from itertools import islice
from typing import NamedTuple

MIN_GROUPED = 20
"""Fewer numbers such as 1.503 are decimals, as nearly all tables have decimal points."""
N_SAMPLED = 2000
"""Rows in which numbers such as 1.503 are looked at."""

_GROUPED = {
    ",": re.compile(r"[+-]?[1-9]\d{0,2}(,\d{3})+(\.\d*)?", re.ASCII),
    ".": re.compile(r"[+-]?[1-9]\d{0,2}(\.\d{3})+(,\d*)?", re.ASCII),
}
_WHOLE = re.compile(r"[+-]?[1-9]\d*", re.ASCII)


class NumberMarks(NamedTuple):
    """The mark before decimals, and the one between thousands, if there is one."""

    decimal: str = "."
    thousands: str = ""

    def plain(self, text: str) -> str:
        """Return numbers as Python writes them."""
        text = text.replace(self.thousands, "") if self.thousands else text
        return text.replace(",", ".") if self.decimal == "," else text


def noted(marks: NumberMarks) -> dict[str, str]:
    """Return the attribute that tells of marks between thousands."""
    return {"thousands_mark": marks.thousands} if marks.thousands else {}


def number_marks(rows: Iterable[Sequence[str]], *, has_commas: bool) -> NumberMarks:
    """Return the marks in the coordinates of a table; `has_commas` is whether some have a comma.

    A mark stands between thousands if three digits follow it in all numbers that have it, none of
    which begins with 0, and whole numbers stand beside them: 503 below 1,503.
    """
    if has_commas:
        rows = list(rows)
        if _is_grouped(rows, ","):
            return NumberMarks(".", ",")
    if _is_grouped(islice(rows, N_SAMPLED), "."):
        return NumberMarks(",", ".")
    return NumberMarks("," if has_commas else ".")


def _is_grouped(rows: Iterable[Sequence[str]], mark: str) -> bool:
    decimal = "." if mark == "," else ","
    n_marked, beside = 0, False
    for row in rows:
        for cell in row:
            word = cell.strip()
            if mark in word:
                if not _GROUPED[mark].fullmatch(word):
                    return False
                n_marked += 1
            beside = beside or decimal in word or _WHOLE.fullmatch(word) is not None
    return beside and n_marked >= (1 if mark == "," else MIN_GROUPED)
