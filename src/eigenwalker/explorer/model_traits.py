"""The traits that a model can change, as the page needs them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, get_args

import numpy as np
import pandas as pd

from eigenwalker.analysis.contrast import Contrast, trait_contrast
from eigenwalker.analysis.direction import Kind, direction
from eigenwalker.analysis.trait_axis import TraitAxis, axis_within, strongest_space
from eigenwalker.analysis.walker_space import WalkerSpace
from eigenwalker.explorer.rounding import rounded_vectors, significant
from eigenwalker.population.population import Population

MOST_TRAITS = 12
_UNITS = ("years", "kg", "mm", "cm", "m", "Hz", "s")
_TOGETHER = ("all", "structure", "dynamics")


def parts_of(population: Population) -> list[str]:
    """Return the parts of the features that a trait may be told from (J18, J31).

    Examples
    --------
    >>> parts_of(ew.load_population())
    ['all', 'structure', 'dynamics', 'p1', 'p2', 'p3', 'p4', 'frequency', 'phases']

    """
    return [*_TOGETHER, *(name for name in population.layout.blocks if name != "p0")]


def model_traits(
    population: Population, wanted: Sequence[str] | None = None, *, first: str = ""
) -> list[dict]:
    """Return each trait that can be an axis: its poles, and a step for each part and kind.

    Parameters
    ----------
    population : Population
    wanted : sequence of str, optional
        Traits as `contrast` takes them; others are left out. Left out, all columns of the traits
        that have an axis, up to 12.
    first : str
        A trait to begin with, in place of its column: ``"style=feminine:masculine"``.

    Returns
    -------
    list of dict

    Raises
    ------
    ValueError
        If a trait that is wanted has no axis.

    """
    spaces = _Spaces(population)
    if wanted is not None:
        return [_trait(spaces, name) for name in wanted]
    found = [_trait(spaces, first)] if first else []
    begun = {trait["column"] for trait in found}
    for name in (str(name) for name in population.traits if name not in begun):
        try:
            found.append(_trait(spaces, name))
        except ValueError:  # no trait of its own, or the same for everybody: no slider
            continue
        if len(found) == MOST_TRAITS:
            break
    return found


class _Spaces:
    """Axes of traits; traits that are known of the same walkers share a space for each part."""

    def __init__(self, population: Population) -> None:
        self.population = population
        self._found: dict[tuple[str, bytes], WalkerSpace] = {}

    def axis(self, asked: Contrast, part: str) -> TraitAxis:
        columns = self.population.layout.columns(part)
        key = part, asked.rows.tobytes()
        if key not in self._found:
            walkers = self.population.X[np.ix_(asked.rows, columns)]
            self._found[key] = strongest_space(walkers)
        return axis_within(self._found[key], self.population, asked, columns)


def _trait(spaces: _Spaces, name: str) -> dict[str, Any]:
    population = spaces.population
    asked = trait_contrast(population, name)
    whole = spaces.axis(asked, "all")
    label, unit = _label_and_unit(asked)
    model = {
        "name": name,
        "column": asked.trait,
        "label": label,
        "unit": unit,
        "negative": _pole(population, asked, asked.negative),
        "positive": _pole(population, asked, asked.positive),
        "two_classes": asked.two_classes,
        "n": len(asked.rows),
        "steps": _steps(spaces, asked),
        "projection": _projection(whole, population.X.shape[1]),
    }
    if asked.two_classes:
        model["means"] = {
            "negative": _mean(population, asked.rows[asked.y < 0]),
            "positive": _mean(population, asked.rows[asked.y > 0]),
        }
    return model


def _pole(population: Population, asked: Contrast, pole: str) -> str:
    """A pole; one that is a number has as many figures as the traits of the page's walkers."""
    number = asked.two_classes and pd.api.types.is_any_real_numeric_dtype(
        population.traits[asked.trait]
    )
    return f"{float(pole):.6g}" if number else pole


def _mean(population: Population, rows: np.ndarray) -> list[float]:
    return rounded_vectors(population.X[rows].mean(axis=0), population.layout)


def _label_and_unit(asked: Contrast) -> tuple[str, str]:
    """What to call a trait, ``weight`` in ``kg`` of ``weight_kg``."""
    stem, _, unit = asked.trait.rpartition("_")
    return (stem, unit) if stem and unit in _UNITS else (asked.trait.replace("_", " "), "")


def _steps(spaces: _Spaces, asked: Contrast) -> dict[str, dict[str, list]]:
    steps: dict[str, dict[str, list]] = {kind: {} for kind in get_args(Kind)}
    layout = spaces.population.layout
    for part in parts_of(spaces.population):
        try:
            axis = spaces.axis(asked, part)
            for kind in get_args(Kind):
                step = direction(axis.space, axis.discriminant, kind=kind)
                steps[kind][part] = rounded_vectors(step, layout, columns=axis.columns, finer=1)
        except ValueError:  # a part that is the same for everybody, or tells nothing
            continue
    return steps


def _projection(axis: TraitAxis, n_features: int) -> dict[str, Any]:
    """Where a walker lies along the axis, as a linear function of its features."""
    offset = float(axis.positions(np.zeros((1, n_features)))[0])
    gradient = axis.positions(np.eye(n_features)) - offset
    return {"offset": significant(offset), "gradient": [significant(each, 9) for each in gradient]}
