"""The model behind Troje's web demonstration: a mean walker, and steps along four axes."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.walker import Walker
from eigenwalker.io.capture_file import read_bytes
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.walker_tables import (
    BML_RATE_HZ,
    SIN_FIRST,
    on_the_floor,
    walker_from_mm,
)
from eigenwalker.population.population import Population

POSITIVE_POLES = {"sex": "male", "weight": "heavy", "nervous": "nervous", "happy": "happy"}
"""The axes and their positive poles."""
_KEYS = {"sex": "gender", "weight": "weight", "nervous": "nervous", "happy": "happy"}
_MEAN_KEY = "walker"
_N_ROWS = 3 * len(JOINTS.markers) + 1
_N_NUMBERS = _N_ROWS * len(SIN_FIRST)
_MAX_BYTES = 10**7
_MAX_MM = 1e5
_CITATION = "Troje, N. F. (2002). The little difference. Dynamic Perception, 115-120."


@dataclass(frozen=True, eq=False)
class BmlModel:
    """A mean walker and axes of traits, as tables.

    Parameters
    ----------
    mean : array of shape (46, 5)
        Rows: 15 x, 15 y, 15 z in millimetres, and a last one with frames a stride at 120 Hz (first
        column) and speed in millimetres a frame (third). Columns: mean, sin 1, cos 1, sin 2,
        cos 2.
    axes : mapping of str to array of shape (46, 5)
        For each trait what one standard deviation adds to the mean, towards its positive pole
        (male, heavy, nervous, happy).

    See Also
    --------
    read_bml_axes : reads one.

    References
    ----------
    Troje (2002), The little difference: Fourier based synthesis of gender-specific
    biological motion, and its demonstration on the web.

    Examples
    --------
    >>> model = ew.datasets.BmlModel(np.ones((46, 5)), {"sex": np.full((46, 5), 0.5)})
    >>> model.table(sex=2)[0, 0].item()
    2.0
    """

    mean: np.ndarray
    axes: Mapping[str, np.ndarray]

    def table(self, **z: float) -> np.ndarray:
        """Return ``mean + b * sex + w * weight + n * nervous + h * happy``, of shape (46, 5).

        Each number is standard deviations along its axis; those left out are 0. The demonstration
        goes from -6 to 6.
        """
        if unknown := sorted(set(z) - set(self.axes)):
            raise ValueError(f"There are no axes {unknown}; there are {list(self.axes)}.")
        return self.mean + sum((score * self.axes[name] for name, score in z.items()), np.zeros(1))

    def walker(self, **z: float) -> Walker:
        """Return the walker at a place on the axes: ``model.walker(sex=3, happy=-2)``.

        It has the 15 joints, in the Fourier form, and the frequency and speed of the table; the
        origin is on the floor below its pelvis.
        """
        sine, cosine = SIN_FIRST.index("sin1"), SIN_FIRST.index("cos1")
        mm = self.table(**z)
        mm[:-1] = mm[:-1, [0, cosine, sine, cosine + 2, sine + 2]]
        return on_the_floor(walker_from_mm(mm, rate_hz=BML_RATE_HZ))

    def population(self, *, source: str = "the BML tables") -> Population:
        """Return the mean walker and walkers on either side of it along each axis.

        A step along a trait of this population is one standard deviation along the axis of that
        name, so that all commands and pages that take a population show the published axes. Sex has
        two walkers, ``female`` and ``male``; the others have three, -1, 0 and 1.
        """
        walkers = [self.walker()]
        traits: list[dict[str, Any]] = [dict.fromkeys(set(self.axes) - {"sex"}, 0.0)]
        for axis in self.axes:
            # As many as make the standard deviation of the walkers that differ in the trait 1.
            far = np.sqrt(0.5) if axis == "sex" else 1.0
            for sign, sex in ((-1, "female"), (1, "male")):
                walkers.append(self.walker(**{axis: sign * far}))
                traits.append({axis: sex if axis == "sex" else float(sign)})
        table = pd.DataFrame(traits, columns=list(self.axes))
        return Population(walkers, table, provenance={"source": source, "citation": _CITATION})


def read_bml_axes(path: str | os.PathLike[str]) -> BmlModel:
    """Return the mean walker and the axes of a file of the published BML tables.

    Parameters
    ----------
    path : str or path
        A JSON file with lists of 230 numbers called walker, gender, weight, nervous and happy (some
        of the axes may be left out), as BioMotionLab2Blender has them; at any depth.

    Returns
    -------
    BmlModel

    Raises
    ------
    UnreadableFile
        If the file is damaged or holds no such tables.

    See Also
    --------
    read_walkers_mat : the same kind of table from MATLAB.

    References
    ----------
    Troje (2002), The little difference: Fourier based synthesis of gender-specific
    biological motion, and its demonstration on the web.

    Examples
    --------
    >>> read_bml_axes("nowhere.json")
    Traceback (most recent call last):
    ...
    eigenwalker.io.errors.UnreadableFile: nowhere.json: expected a file, but got nothing of
    that name in '.'; check the path.
    """
    path = Path(path)
    try:
        content = json.loads(read_bytes(path, max_bytes=_MAX_BYTES), parse_int=float)
    except (ValueError, RecursionError) as error:
        if isinstance(error, UnreadableFile):
            raise
        raise UnreadableFile(path.name, "a JSON file", f"an error: {error}") from error
    tables = _tables(content)
    if tables is None:
        raise UnreadableFile(
            path.name,
            f"published walkers, with a list {_MEAN_KEY!r} of {_N_NUMBERS} numbers",
            "JSON of another kind",
            "name such a file, or a population (.nc)",
        )
    axes = {axis: _table(tables[key], key, path) for axis, key in _KEYS.items() if key in tables}
    model = BmlModel(_table(tables[_MEAN_KEY], _MEAN_KEY, path), axes)
    try:
        model.walker()
    except ValueError as error:
        raise UnreadableFile(path.name, "a mean walker that can walk", f"{error}") from error
    return model


def looks_like_bml(path: Path) -> bool:
    """Whether a file is JSON with the tables, in which the mean walker is a list of numbers."""
    if path.suffix.lower() != ".json" or not path.is_file():
        return False
    with path.open("rb") as file:
        return re.search(rb'"walker"\s*:\s*\[\s*[-\d]', file.read(_MAX_BYTES)) is not None


def _tables(content: Any) -> dict[str, Any] | None:
    """Return the first object, at any depth, that holds the mean walker."""
    waiting = [content]
    for item in waiting:
        if isinstance(item, dict):
            if isinstance(item.get(_MEAN_KEY), list):
                return item
            waiting += item.values()
    return None


def _table(numbers: Any, key: str, path: Path) -> np.ndarray:
    complete = isinstance(numbers, list) and len(numbers) == _N_NUMBERS
    if not complete or not all(isinstance(number, float) for number in numbers):
        got = f"{len(numbers)}, or others" if isinstance(numbers, list) else "something else"
        raise UnreadableFile(path.name, f"{_N_NUMBERS} numbers as {key!r}", got)
    table = np.array(numbers, dtype=float).reshape(len(SIN_FIRST), _N_ROWS).T
    if not (np.abs(table) < _MAX_MM).all():
        raise UnreadableFile(path.name, f"{key!r} in millimetres", "numbers that are too large")
    return table
