"""The traits that a model can change, with numbers rounded as far as page and Python agree."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, get_args

import numpy as np
import pandas as pd

from eigenwalker.analysis.contrast import Contrast, trait_contrast
from eigenwalker.analysis.direction import Kind, direction
from eigenwalker.analysis.span import Span
from eigenwalker.analysis.trait_axis import TraitAxis, axis_within, strongest_span
from eigenwalker.population.features import FeatureLayout
from eigenwalker.population.persons import person_column
from eigenwalker.population.population import Population
from eigenwalker.population.trait_table import heading_parts

MAX_TRAITS = 12
_DECIMALS = 7
"""Of millimetres: the features of a walker add up to within a millionth."""
_TIMING_DECIMALS = 3
"""More decimals for hertz and radians, which limbs of hundreds of mm multiply."""


def model_traits(
    population: Population, traits: Sequence[str] | None = None, *, first: str = ""
) -> list[dict]:
    """Return each trait with its poles, and a step for each part and kind.

    Traits are named as `trait_contrast` takes them; left out, all columns that have an axis, up to
    12, where `first` comes first, in place of its column.
    """
    axes = _Axes(population)
    if traits is not None:
        return [_trait(axes, name) for name in traits]
    models = [_trait(axes, first)] if first else []
    columns = {trait["column"] for trait in models} | {person_column(population.traits)}
    for name in (str(name) for name in population.traits if name not in columns):
        try:
            models.append(_trait(axes, name))
        except ValueError:  # a file name, or the same value for all: no slider
            continue
        if len(models) == MAX_TRAITS:
            break
    return models


class _Axes:
    """Axes of traits; traits with values for the same walkers share a space for each part."""

    def __init__(self, population: Population) -> None:
        self.population = population
        self._spans: dict[tuple[str, bytes], Span] = {}

    def axis(self, contrast: Contrast, part: str) -> TraitAxis:
        columns = self.population.layout.columns(part)
        key = part, contrast.rows.tobytes()
        if key not in self._spans:
            walkers = self.population.X[np.ix_(contrast.rows, columns)]
            self._spans[key] = strongest_span(walkers)
        return axis_within(self._spans[key], self.population, contrast, columns)


def _trait(axes: _Axes, name: str) -> dict[str, Any]:
    population = axes.population
    contrast = trait_contrast(population, name)
    label, unit = _label_and_unit(contrast.trait)
    model = {
        "name": name,
        "column": contrast.trait,
        "label": label,
        "unit": unit,
        "negative": _pole(population, contrast, contrast.negative),
        "positive": _pole(population, contrast, contrast.positive),
        "two_classes": contrast.two_classes,
        "n": len(contrast.rows),
        "steps": _steps(axes, contrast),
        "projection": _projection(axes.axis(contrast, "all"), population.X.shape[1]),
    }
    if contrast.two_classes:
        X, layout = population.X, population.layout
        model["means"] = {
            pole: rounded_vectors(X[contrast.rows[sign * contrast.y > 0]].mean(axis=0), layout)
            for pole, sign in (("negative", -1), ("positive", 1))
        }
    return model


def _pole(population: Population, contrast: Contrast, pole: str) -> str:
    """Return a pole; one that is a number has as many figures as the traits of the walkers."""
    column = population.traits[contrast.trait]
    number = contrast.two_classes and pd.api.types.is_any_real_numeric_dtype(column)
    return f"{float(pole):.6g}" if number else pole


def _label_and_unit(trait: str) -> tuple[str, str]:
    """Return ``weight`` and ``kg`` of ``weight_kg``."""
    stem, unit = heading_parts(trait)
    return stem.replace("_", " ").strip() or trait, unit


def _steps(axes: _Axes, contrast: Contrast) -> dict[str, dict[str, list]]:
    steps: dict[str, dict[str, list]] = {kind: {} for kind in get_args(Kind)}
    layout = axes.population.layout
    parts = [name for name in layout.blocks if name != "p0"]
    for part in ("all", "structure", "dynamics", *parts):
        try:
            axis = axes.axis(contrast, part)
            for kind in get_args(Kind):
                step = direction(axis.space, axis.discriminant, kind=kind)
                steps[kind][part] = rounded_vectors(step, layout, columns=axis.columns, finer=1)
        except ValueError:  # a part that is the same for all, or does not depend on the trait
            continue
    return steps


def _projection(axis: TraitAxis, n_features: int) -> dict[str, Any]:
    """Return the position along the axis as a linear function of a walker's features."""
    offset = float(axis.positions(np.zeros((1, n_features)))[0])
    gradient = axis.positions(np.eye(n_features)) - offset
    return {"offset": significant(offset), "gradient": [significant(each, 9) for each in gradient]}


def rounded_vectors(
    vectors: np.ndarray, layout: FeatureLayout, columns: np.ndarray | None = None, finer: int = 0
) -> list:
    """Return vectors of features (..., feature) as lists, timing with more decimals than postures.

    `columns` are the features that there are, where not all. `finer` adds decimals, for vectors
    that are multiplied before they are added.
    """
    timing = np.isin(np.arange(len(layout)), layout.columns("timing"))
    timing = timing if columns is None else timing[columns]
    posture = np.round(vectors, _DECIMALS + finer)
    fine = np.round(vectors, _DECIMALS + _TIMING_DECIMALS + finer)
    return (np.where(timing, fine, posture) + 0.0).tolist()


def significant(value: float, figures: int = 12) -> float:
    """Return a number with so many significant figures."""
    return float(f"{value:.{figures}g}")
