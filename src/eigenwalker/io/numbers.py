"""Numbers in text: finite, of a size that lengths and angles have, or refused by name."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from eigenwalker.io.errors import AGAIN, UnreadableFile

MOST_DISTANT = 1e9
"""No length, angle or time in a sound file is larger than this."""

_NUMBER = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?", re.ASCII)


def number(word: str, where: str, source: str) -> float:
    """Return the number that a word is.

    Examples
    --------
    >>> number("-1.5e2", "frame 3", "a.amc")
    -150.0
    >>> number("1,5", "frame 3", "a.amc")
    Traceback (most recent call last):
    ...
    eigenwalker.io.errors.UnreadableFile: a.amc: expected a finite number in frame 3, but
    got '1,5'; write numbers with a decimal point.

    """
    value = float(word) if _NUMBER.fullmatch(word) else np.nan
    if not abs(value) < MOST_DISTANT:
        advice = "write numbers with a decimal point" if "," in word else AGAIN
        raise UnreadableFile(source, f"a finite number in {where}", repr(word[:40]), advice)
    return value


def numbers(words: Sequence[str], where: str, source: str) -> np.ndarray:
    """Return the numbers that some words are: array of shape (word,)."""
    return np.array([number(word, where, source) for word in words])
