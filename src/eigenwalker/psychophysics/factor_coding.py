"""Fixed effects of factors and their interactions as columns of a design matrix."""

from __future__ import annotations

import re
from itertools import combinations, product
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

from eigenwalker.psychophysics.answer_table import levels_of

Term = tuple[str, ...]
"""Names of the factors of a main effect (one) or an interaction."""


class Coding(NamedTuple):
    """Columns of a design matrix, their names, and the term of each; () is the intercept."""

    X: np.ndarray
    names: list[str]
    terms: list[Term]


def terms_of(formula: str) -> list[Term]:
    """Return the terms of "view * info" or "view + info + view:info", main effects first."""
    found: dict[Term, None] = {}
    for part in formula.split("+"):
        factors = [name.strip() for name in part.split("*")]
        together = [tuple(name.strip() for name in factor.split(":")) for factor in factors]
        for size in range(1, len(together) + 1):
            for some in combinations(together, size):
                found[tuple(dict.fromkeys(name for term in some for name in term))] = None
    names = [name for term in found for name in term]
    if not all(names) or any(re.search(r"[()^|~-]", name) for name in names):
        raise ValueError(
            f"fixed={formula!r} is no formula of factors; write one such as 'view * info' or "
            "'view + info'."
        )
    return sorted(found, key=len)


def code_factors(table: pd.DataFrame, terms: list[Term], *, sums: bool = False) -> Coding:
    """Return treatment-coded columns, in R's order and by its names, or columns that sum to 0."""
    single = {name: _levels(table[name], sums=sums) for term in terms for name in term}
    columns, names = [np.ones(len(table))], ["(Intercept)"]
    owners: list[Term] = [()]
    for term in terms:
        for choice in product(*(single[name] for name in reversed(term))):
            parts = choice[::-1]
            columns.append(np.prod([column for _, column in parts], axis=0))
            named = zip(term, parts, strict=True)
            names.append(":".join(f"{name}{level}" for name, (level, _) in named))
            owners.append(term)
    return Coding(np.stack(columns, axis=1), names, owners)


def level_text(level: Any) -> str:
    """Return a level as R would write it: 30 for 30.0."""
    return f"{level:g}" if isinstance(level, float) else str(level)


def _levels(column: pd.Series, *, sums: bool) -> list[tuple[str, np.ndarray]]:
    levels = levels_of(column)
    if len(levels) < 2:
        raise ValueError(
            f"The factor {column.name!r} has one level, {levels[0]!r}; expected two or more. Leave "
            "it out of the formula."
        )
    values = column.to_numpy()
    last = (values == levels[-1]).astype(float)
    if sums:
        return [(level_text(each), (values == each) - last) for each in levels[:-1]]
    return [(level_text(each), (values == each).astype(float)) for each in levels[1:]]
