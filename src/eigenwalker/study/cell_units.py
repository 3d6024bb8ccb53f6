"""Units in the cells of a trait, and what lengths and masses say of their unit by their size."""

from __future__ import annotations

import re
import warnings
from collections import Counter
from collections.abc import Callable, Sequence

import numpy as np

from eigenwalker.core.trajectories import MILLIMETRES
from eigenwalker.io.to_trajectories import unit_named

FEET = re.compile(
    r"(?P<feet>\d+)\s*(?:['\u2019\u2032]|ft\.?|feet)\s*(?P<inches>\d{1,2}(?:\.\d+)?)?"
    r"\s*(?:\"|''|\u2019\u2019|\u201d|\u2033|in\.?|inch(?:es)?)?",
    re.IGNORECASE,
)
"""Feet and inches, such as 5'9"."""
_CM_OF_INCH = 2.54
_POWERS = (10, 100, 1000)
_ALIKE = 1.6
"""People's heights and weights differ from their median by this factor or less, two in three."""
_MOST_APART = 2.5
_LENGTHS_AND_MASSES = re.compile(
    r"height|length|size|stature|tall|gr(\u00f6|oe?)(\u00df|ss)e|l(\u00e4|ae)nge|taille|altura"
    r"|weight|mass|gewicht|poids|peso|[_([/ ](mm|cm|m|kg|g)\b",
    re.IGNORECASE,
)


def in_centimetres(cells: Sequence[str], name: str, where: Callable[[int], str]) -> list[str]:
    """Return cells with centimetres for feet and inches."""
    texts = list(cells)
    found = {at: match for at, cell in enumerate(cells) if (match := FEET.fullmatch(cell))}
    for at, match in found.items():
        inches = 12 * float(match["feet"]) + float(match["inches"] or 0)
        texts[at] = f"{_CM_OF_INCH * inches:.2f} cm"
    if found:
        at = next(iter(found))
        warnings.warn(
            f"{name}: feet and inches are taken as centimetres, {cells[at]!r} in {where(at)} as "
            f"{texts[at]}.",
            stacklevel=3,
        )
    return texts


def in_one_unit(
    values: np.ndarray,
    units: Sequence[str | None],
    texts: Sequence[str],
    name: str,
    where: Callable[[int], str],
) -> tuple[np.ndarray, str]:
    """Return numbers in the unit of most cells, and that unit, empty if cells name none.

    Lengths are converted, others must be of one.
    """
    counts = Counter(unit.casefold().rstrip(".") for unit in units if unit)
    if not counts:
        return values, ""
    most = counts.most_common(1)[0][0]
    at = next(
        (at for at, unit in enumerate(units) if (unit or "").casefold().rstrip(".") == most), 0
    )
    _say(name, f"numbers of {most!r}, as in {where(at)} ({texts[at]!r}); the unit is left out")
    known, values = unit_named(most), values.copy()
    for at, unit in enumerate(units):
        word = (unit or most).casefold().rstrip(".")
        if np.isnan(values[at]) or word == most or word.removesuffix("s") == most.removesuffix("s"):
            continue
        other = unit_named(word)
        if known is None or other is None:
            raise ValueError(
                f"The trait {name!r} is in {most!r}, but has {texts[at]!r} in {where(at)}; write "
                "all its numbers in one unit."
            )
        values[at] *= MILLIMETRES[other.name] / MILLIMETRES[known.name]
        _say(name, f"{texts[at]!r} in {where(at)} is taken as {values[at]:.6g} {most}")
    return values, most


def check_one_size(
    values: np.ndarray, texts: Sequence[str], name: str, where: Callable[[int], str]
) -> None:
    """Refuse lengths and masses of two units, such as 1.75 beside 1750; say it of other traits.

    They are two clusters of positive numbers, 10, 100 or 1000 times as large as one another.
    """
    order = np.argsort(values)[: int((~np.isnan(values)).sum())]
    ranked = values[order]
    if len(ranked) < 3 or ranked[0] <= 0:
        return
    split = int(np.argmax(ranked[1:] / ranked[:-1])) + 1
    low, high = ranked[:split], ranked[split:]
    factor = np.median(high) / np.median(low)
    power = next((p for p in _POWERS if 1 / _ALIKE < factor / p < _ALIKE), None)
    wide = max(low[-1] / low[0], high[-1] / high[0]) > _MOST_APART
    if power is None or wide or (low[0] == low[-1] and high[0] == high[-1] and len(ranked) > 3):
        return
    small, large = (sorted(part) for part in (order[:split], order[split:]))
    two = (
        f"{texts[small[0]]!r} in {where(small[0])} and {texts[large[0]]!r} in {where(large[0])}"
        f" ({len(small)} numbers like the first, {len(large)} like the second)"
    )
    if _LENGTHS_AND_MASSES.search(name):
        raise ValueError(
            f"The trait {name!r} has numbers of two units, {two}, about {power} times as large; "
            "write all its numbers in one unit."
        )
    _say(name, f"{two} are about {power} times as large; are they in one unit")


def _say(name: str, sentence: str) -> None:
    warnings.warn(f"{name}: {sentence}{'?' if ' are they ' in sentence else '.'}", stacklevel=3)
