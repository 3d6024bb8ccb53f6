"""What people write in the cells of a trait: numbers, classes, and what stands for unknown."""

from __future__ import annotations

import re
import warnings
from collections import Counter
from collections.abc import Callable, Sequence

import numpy as np
import pandas as pd

from eigenwalker.io.text_cells import MISSING
from eigenwalker.study.cell_dates import is_of_dates
from eigenwalker.study.cell_units import check_one_size, in_centimetres, in_one_unit

INFINITE = frozenset(("inf", "+inf", "-inf", "infinity", "-infinity"))
UNIT = "unit"
"""Attribute of a trait of numbers: the unit that its cells name."""
MAX_LETTERS = 60
"""A longer cell is no number."""
UNKNOWN = (MISSING - INFINITE) | frozenset(
    (
        *(
            "unknown",
            "unk",
            "not known",
            "not available",
            "not recorded",
            "no answer",
            "n.a.",
            "k.a.",
        ),
        *(
            "keine angabe",
            "unbekannt",
            "inconnu",
            "desconocido",
            "nd",
            "n.d.",
            "#nv",
            "nil",
            "\u2013",
        ),
    )
)
"""What people write for a value that they do not know, in small letters."""
CODES = frozenset(sign * float("9" * n) for n in (2, 3, 4, 5) for sign in (-1, 1))
"""Numbers of nines, which stand for unknown where no other number is like them."""
ANSWERS = {
    "yes": ("y", "yes", "j", "ja", "oui", "si", "s\u00ed"),
    "no": ("n", "no", "nein", "non"),
}
"""Words for yes and no."""
SEXES = {
    "female": ("f", "female", "w", "woman", "women", "girl", "weiblich", "frau", "femme", "mujer"),
    "male": (
        "m",
        "male",
        "man",
        "men",
        "boy",
        "maennlich",
        "m\u00e4nnlich",
        "mann",
        "homme",
        "hombre",
    ),
}
"""Words for the sexes, which are one class where a trait has several of them."""
WORDS = (SEXES, ANSWERS)
LEAST_NUMBERS = 2 / 3
"""A trait of which this share are numbers is one of numbers."""
MAX_NAMED = 5

_NUMBER = re.compile(
    r"(?P<number>[+-]?inf(?:inity)?|[+-]?(\d[\d.,'\u2019 ]*\d|\d)([eE][+-]?\d+)?|[+-]?[.,]\d+)"
    r"\s*(?P<unit>[^\W\d_][\w./\u00b2]*\.?|%|\u00b0|\"|')?"
)
_POINT = re.compile(
    r"[+-]?\d{1,3}([,'\u2019 ]\d{3})*(\.\d+)?|[+-]?\d*\.?\d+([eE][+-]?\d+)?|[+-]?\d+\."
    r"|[+-]?inf(inity)?"
)
_COMMA = re.compile(r"[+-]?\d{1,3}([.'\u2019 ]\d{3})*(,\d+)?|[+-]?\d*,?\d+")
_EITHER = re.compile(r"[+-]?[1-9]\d{0,2},\d{3}")


def trait_values(
    cells: Sequence[str], name: str, where: Callable[[int], str], *, decimal_comma: bool
) -> pd.Series:
    """Return the values of a trait: numbers where most cells are some, else texts, None if unknown.

    What is guessed is said in warnings, with the first cell (`where`) that it is about.
    """
    texts = [cell.strip() for cell in cells]
    read = in_centimetres(texts, name, where)
    unknown = [text.casefold() in UNKNOWN for text in texts]
    _say_unknown([text for text, out in zip(texts, unknown, strict=True) if out and text], name)
    known = [None if out else text for text, out in zip(texts, unknown, strict=True)]
    of_dates = is_of_dates([text or "" for text in known], name, where)
    parts = [
        None if out else _NUMBER.fullmatch(text[:MAX_LETTERS])
        for text, out in zip(read, unknown, strict=True)
    ]
    n_known, n_numbers = unknown.count(False), sum(part is not None for part in parts)
    plain = sum(part is not None and not part["unit"] for part in parts)
    units = {part["unit"] for part in parts if part and part["unit"]}
    few = n_numbers < LEAST_NUMBERS * n_known
    if of_dates or not n_numbers or few or (not plain and len(units) > 3):
        return in_one_spelling(pd.Series(known, dtype=object, name=name))
    for at, (part, out) in enumerate(zip(parts, unknown, strict=True)):
        if part is None and not out:
            _say(name, f"{texts[at]!r} in {where(at)} is no number, and is taken as unknown")
    numbers = [part["number"].strip() if part else "" for part in parts]
    values = _numbers(numbers, name, where, decimal_comma)
    named = [part and part["unit"] for part in parts]
    values, unit = in_one_unit(values, named, texts, name, where)
    values = _without_codes(values, name)
    check_one_size(values, texts, name, where)
    found = pd.Series(values, name=name)
    found.attrs[UNIT] = unit
    return found


def in_one_spelling(values: pd.Series) -> pd.Series:
    """Return texts in which those that differ in case only are the same, and words for a sex too.

    So are words for yes and for no. The spelling in small letters is taken where there is one, else
    the most frequent one.
    """
    counts = Counter(value for value in values if isinstance(value, str))
    if not counts:
        return values
    families = ({word: one for one, words in each.items() for word in words} for each in WORDS)
    words = next((each for each in families if all(t.casefold() in each for t in counts)), {})
    groups: dict[str, list[str]] = {}
    for text, _ in counts.most_common():
        key = words.get(text.casefold(), text.casefold())
        groups.setdefault(key, []).append(text)
    chosen: dict[str, str] = {}
    for key, several in groups.items():
        if len(several) > 1:
            best = key if key in several or words else several[0]
            chosen |= dict.fromkeys(several, best)
            named = ", ".join(f"{text!r} ({counts[text]})" for text in sorted(several))
            _say(str(values.name), f"{named} are taken as one, {best!r}")
    if words and chosen:  # the other class is called by its word too
        chosen |= {text: key for key, several in groups.items() for text in several}
    spelled = [chosen.get(value, value) if isinstance(value, str) else value for value in values]
    return pd.Series(spelled, index=values.index, dtype=object, name=values.name)


def _say(name: str, sentence: str) -> None:
    warnings.warn(f"{name}: {sentence}.", stacklevel=2)


def _say_unknown(texts: Sequence[str], name: str) -> None:
    words = Counter(text for text in texts if text.casefold() not in ("", "nan", "na"))
    if words:
        named = ", ".join(f"{word!r} ({count})" for word, count in words.most_common(MAX_NAMED))
        _say(name, f"{named} {'is' if len(texts) == 1 else 'are'} taken as unknown")


def _numbers(
    texts: Sequence[str], name: str, where: Callable[[int], str], decimal_comma: bool
) -> np.ndarray:
    """Return numbers with points or with commas before their decimals; NaN where there is none."""
    given = [text for text in texts if text]
    as_points = all(map(_POINT.fullmatch, given))
    as_commas = all(map(_COMMA.fullmatch, given))
    either = [at for at, text in enumerate(texts) if _EITHER.fullmatch(text)]
    has_comma = any("," in text for text in given)
    if as_points and as_commas and either and not decimal_comma:
        text = texts[either[0]]
        one, other = text.replace(",", ""), text.replace(",", ".")
        raise ValueError(
            f"The trait {name!r} has {text!r} in {where(either[0])}, which may be {one} or "
            f"{other}; write it with a decimal point, or without a mark between thousands."
        )
    comma = as_commas and has_comma and (decimal_comma or not as_points)
    values = np.full(len(texts), np.nan)
    for at, text in enumerate(texts):
        ways = [way for way in (comma, not comma) if (_COMMA if way else _POINT).fullmatch(text)]
        if ways:
            plain = re.sub(r"[.'\u2019 ]" if ways[0] else r"[,'\u2019 ]", "", text)
            values[at] = float(plain.replace(",", "."))
        if text and (not ways or ways[0] != comma):
            read = f"taken as {values[at]:g}" if ways else "no number, and is taken as unknown"
            _say(name, f"{text!r} in {where(at)} is {read}")
    return values


def _without_codes(values: np.ndarray, name: str) -> np.ndarray:
    """Return numbers with NaN for codes of nines that no other number is like."""
    for code in np.intersect1d(values, np.array(sorted(CODES))):
        rest = np.abs(values[(values != code) & ~np.isnan(values)])
        others = values[(values != code) & ~np.isnan(values)]
        if rest.size and (
            (code < 0 and others.min() >= 0) or (code > 100 and rest.max() * 2 < code)
        ):
            _say_unknown([f"{code:g}"] * int((values == code).sum()), name)
            values = np.where(values == code, np.nan, values)
    return values
