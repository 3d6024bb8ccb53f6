"""Dates in the cells of a trait, which spreadsheet programs also make of numbers."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable, Sequence

_MONTH = (
    r"(jan(uary|uar)?|feb(ruary|ruar)?|mar(ch)?|mrz|m(\u00e4|ae)rz?|apr(il)?|may|mai|jun[ei]?"
    r"|jul[yi]?|aug(ust)?|sept?(ember)?|o[ck]t(ober)?|nov(ember)?|de[cz](ember)?)\.?"
)
_TIME = r"\d{1,2}:\d{2}(:\d{2}([.,]\d+)?)?(\s*[ap]m)?"
_DAY = (
    r"\d{4}[-/.]\d{1,2}[-/.]\d{1,2}|\d{1,2}\.\d{1,2}\.(\d{4}|\d{2})?|\d{1,2}/\d{1,2}/(\d{4}|\d{2})"
    rf"|\d{{1,2}}[-/. ]+{_MONTH}([-/. ]+(\d{{4}}|\d{{2}}))?|{_MONTH}[-/. ]+\d{{1,4}}(,? \d{{4}})?"
)
_DATE = re.compile(rf"({_DAY})([T ]+{_TIME})?|{_TIME}", re.IGNORECASE)
_NUMBER = re.compile(r"[+-]?[\d.,]*\d\b.*")


def is_of_dates(cells: Sequence[str], name: str, where: Callable[[int], str]) -> bool:
    """Return whether the known cells of a trait are dates or times, all of them, which is said.

    Raises
    ------
    ValueError
        If there are dates among numbers.
    """
    dates = [at for at, cell in enumerate(cells) if _DATE.fullmatch(cell)]
    if not dates:
        return False
    first = f"{cells[dates[0]]!r} in {where(dates[0])}"
    others = [cell for at, cell in enumerate(cells) if cell and at not in dates]
    if others and sum(map(bool, map(_NUMBER.fullmatch, others))) > len(others) / 2:
        raise ValueError(
            f"The trait {name!r} has numbers, but {len(dates)} dates or times, such as {first}. "
            "Spreadsheet programs make dates of numbers such as 5.3: write the number again, in a "
            "cell formatted as text or number, or leave the cell empty."
        )
    how = "has dates or times" if others else "dates or times"
    warnings.warn(
        f"{name}: {how}, such as {first}; they are kept as text, and are no numbers.", stacklevel=3
    )
    return not others
