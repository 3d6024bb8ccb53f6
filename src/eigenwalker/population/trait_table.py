"""What is known of walkers: one row for each, one column a trait."""

from __future__ import annotations

import re
import warnings
from collections.abc import Mapping
from difflib import get_close_matches
from typing import Any

import numpy as np
import pandas as pd

from eigenwalker.core.arguments import LARGEST, check_kind

_UNITS = (
    *("years?", "yrs?", "y", "months?", "jahren?", "ans", "kg", "g", "lbs?", "pounds?", "mm"),
    *("cm", "m", "in", "inch(?:es)?", "ft", "feet", "hz", "s", "ms", "min", "%", "percent"),
    *("\u00b0", "deg", "degrees", "rad", "m/s", "km/h", "mmhg", "bpm", "kg/m\u00b2", "kg/m2"),
)
_UNIT = "|".join(_UNITS)
_HEADING = re.compile(
    rf"(?P<stem>.*?\w)\s*(?:\[(?P<square>[^\]]*)\]|\((?P<round>[^)]*)\)"
    rf"|(?:\s/\s*|/\s+|,\s+|\s+in\s+)(?P<after>{_UNIT})|_(?P<low>{_UNIT}))\s*",
    re.IGNORECASE,
)


def check_traits(given: Any) -> pd.DataFrame:
    """Return a table of traits, if no number in it is one that statistics cannot be made of."""
    check_kind(given, (pd.DataFrame, Mapping), "a table of traits, one row a walker")
    traits = pd.DataFrame(given).reset_index(drop=True)
    for name in traits.select_dtypes("number"):
        wrong = np.flatnonzero(traits[name].abs() > LARGEST)
        if wrong.size:
            row = int(wrong[0])
            raise ValueError(
                f"The trait {str(name)!r} of row {row + 1} is {traits[name].iloc[row]:g}; give "
                f"numbers up to {LARGEST:g} in size, and leave empty what is not known."
            )
    return traits


def heading_parts(heading: str) -> tuple[str, str]:
    """Return the name and the unit of a trait by its heading: ``Height`` and ``cm``.

    Of ``Height (cm)``, ``Height [cm]``, ``Height / cm``, ``Height in cm`` and ``Height_cm``; the
    unit is empty where the heading names none.
    """
    match = _HEADING.fullmatch(heading.strip())
    if match is None:
        return heading.strip(), ""
    unit = next(
        text
        for text in (match[name] for name in match.groupdict() if name != "stem")
        if text is not None
    ).strip()
    is_unit = match["square"] is not None or re.fullmatch(_UNIT, unit, re.IGNORECASE)
    return match["stem"].strip(), unit if is_unit else ""


def trait_column(traits: pd.DataFrame, name: str) -> str:
    """Return the column of a trait, named in full, without its unit, or in another case.

    Raises
    ------
    ValueError
        If there is none or more than one.
    """
    columns = [str(column) for column in traits]
    if name in columns:
        return name
    parts = {column: tuple(map(_folded, heading_parts(column))) for column in columns}
    whole = [column for column in columns if _folded(column) == _folded(name)]
    stem, unit = map(_folded, heading_parts(name))
    same = [
        column for column in columns if parts[column][0] == stem and unit in ("", parts[column][1])
    ]
    begun = [column for column in columns if _folded(column).startswith(f"{_folded(name)} ")]
    found = whole or same or begun
    if len(found) == 1:
        if not found[0].startswith(name):
            warnings.warn(f"The trait {name!r} is taken to be {found[0]!r}.", stacklevel=2)
        return found[0]
    if found:
        raise ValueError(f"{name!r} may be one of the traits {found}; write which.")
    near = get_close_matches(_folded(name), list(map(_folded, columns)), n=1)
    guess = "".join(f" Did you mean {c!r}?" for c in columns if near == [_folded(c)])
    raise ValueError(f"There is no trait {name!r}; the population has {columns}.{guess}")


def _folded(text: str) -> str:
    return " ".join(text.casefold().replace("_", " ").split())
