"""Files that hold walkers rather than captures: Moler's walkers.mat, matrices in the mm format."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.walker import Walker
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.readers.mat import read_mat_arrays
from eigenwalker.io.walker_tables import (
    BML_RATE_HZ,
    SIN_FIRST,
    on_the_floor,
    walker_from_mm,
    walker_from_table,
)
from eigenwalker.population.population import Population

MOLER_MARKERS = (
    "head",
    *("right_wrist", "right_elbow", "right_shoulder"),
    "sternum",
    *("left_shoulder", "left_elbow", "left_wrist"),
    *("right_ankle", "right_knee", "right_hip"),
    "pelvis",
    *("left_hip", "left_knee", "left_ankle"),
)
"""The 15 points of walkers.mat; the article calls some of them hand, neck and foot."""
MOLER_PERIOD_SAMPLES = 151.5751
"""Samples of a stride (two steps) in walker.m, at 120 Hz."""

_SEXES = {"F": "female", "M": "male"}
_MAX_MM = 1e5


def read_walkers_mat(path: str | os.PathLike[str]) -> Population:
    """Return the two walkers of Moler's walkers.mat: the average woman and the average man.

    The file comes with the article and is not part of this package: bring your own copy.

    Parameters
    ----------
    path : str or path
        The MATLAB file.

    Returns
    -------
    Population of two
        In the Fourier form and the frame and names of this package, the trait ``sex`` being
        ``female`` for F and ``male`` for M. The point that the article calls neck is ``sternum``.
        The article's gender slider is positive for women; axes here are positive for men.

    Raises
    ------
    UnreadableFile
        If it is not such a file. It is read in a separate process, so it cannot
        stop the program.

    See Also
    --------
    read_mm : walkers of any MATLAB file in the BML's mm format.

    References
    ----------
    Moler (2016), The Eigenwalker Model of the Human Gait, Cleve's Corner.

    Examples
    --------
    >>> read_walkers_mat("nowhere.mat")
    Traceback (most recent call last):
    ...
    eigenwalker.io.errors.UnreadableFile: nowhere.mat: expected a file, but got nothing of
    that name in '.'; check the path.
    """
    path = Path(path)
    arrays = read_mat_arrays(path)
    walkers = [
        walker_from_table(
            _plausible(arrays, name, path),
            frequency_hz=BML_RATE_HZ / MOLER_PERIOD_SAMPLES,
            markers=MOLER_MARKERS,
            columns=SIN_FIRST,
            axes=("right", "forward", "up"),
        )
        for name in _SEXES
    ]
    return Population(
        [on_the_floor(walker) for walker in walkers],
        pd.DataFrame({"sex": list(_SEXES.values())}),
        provenance={"source": path.name, "citation": "Moler, C. (2016). Cleve's Corner."},
    )


def _plausible(arrays: dict[str, np.ndarray], name: str, path: Path) -> np.ndarray:
    table = arrays.get(name)
    shape = (3 * len(MOLER_MARKERS), len(SIN_FIRST))
    if table is None or table.shape != shape:
        raise UnreadableFile(
            path.name,
            f"tables F and M of shape {shape}",
            _shapes(arrays),
            "is it Moler's walkers.mat?",
        )
    if not (np.abs(table) < _MAX_MM).all():
        raise UnreadableFile(
            path.name, f"{name} in millimetres", "numbers that are not finite or too large"
        )
    return table


def read_mm(
    path: str | os.PathLike[str],
    *,
    markers: Sequence[str] = JOINTS.markers,
    rate_hz: float = BML_RATE_HZ,
) -> dict[str, Walker]:
    """Return all walkers that a MATLAB file holds in the BML's mm format.

    Parameters
    ----------
    path : str or path
        A MATLAB file with matrices such as 46 x 5, as `walker_from_mm` takes them.
    markers : sequence of str
        One name a marker, in the order of the rows.
    rate_hz : float
        Frames a second of periods and speeds.

    Returns
    -------
    dict of str to Walker
        By the names of the variables, which may differ in their harmonics, so that they are no
        population. The origin is on the floor below the pelvis.

    Raises
    ------
    UnreadableFile
        If the file is damaged or holds none.

    See Also
    --------
    read_walkers_mat : Moler's file, as a population.

    References
    ----------
    Troje (2002), The little difference: Fourier based synthesis of gender-specific
    biological motion, eq. 1.
    """
    path = Path(path)
    arrays = read_mat_arrays(path)
    n_rows = 3 * len(markers) + 1
    walkers: dict[str, Walker] = {}
    for name, array in arrays.items():
        if array.ndim == 2 and len(array) == n_rows and array.shape[1] in (3, 5, 7, 9, 11):
            try:
                walker = walker_from_mm(array, markers=markers, rate_hz=rate_hz)
            except ValueError as error:
                raise UnreadableFile(path.name, f"a walker as {name}", f"{error}") from error
            walkers[name] = on_the_floor(walker)
    if not walkers:
        expected = f"matrices of {n_rows} rows (3 x {len(markers)} markers and one more)"
        raise UnreadableFile(
            path.name, expected, _shapes(arrays), "name the markers: markers=[...]"
        )
    return walkers


def _shapes(arrays: dict[str, np.ndarray]) -> str:
    return str({key: array.shape for key, array in list(arrays.items())[:10]})
