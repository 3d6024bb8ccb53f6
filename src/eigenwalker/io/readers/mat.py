"""Captures in MATLAB files: plain arrays, which say nothing of themselves."""

from __future__ import annotations

import io
import os
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import xarray as xr

from eigenwalker.core.axes import FORWARD_LEFT_UP, Layout, axes_matrix, from_rows
from eigenwalker.core.trajectories import DIMS, label_trajectories
from eigenwalker.io.capture_file import read_bytes
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.readers.mat_arrays import mat_arrays_npz
from eigenwalker.io.sandbox import Job, JobError

_MAX_NAMES = 10


def read_mat_arrays(path: str | os.PathLike[str]) -> dict[str, np.ndarray]:
    """Return the arrays of numbers in a MATLAB file by name; fields as ``struct.field``.

    The file (version 4, 5 or 7.3) is read in a process of its own, within 10 s and 1 GiB, as SciPy
    and HDF5 may break down on damaged files.
    """
    path = Path(path)
    read_bytes(path)  # for the message about a file that is not there
    job = Job(mat_arrays_npz, (os.path.abspath(path),))
    try:
        content = job.run()
    except JobError as error:
        message = " ".join(error.message.split())[:300]
        got = {
            "too slow": f"one that takes more than {job.seconds} s to read",
            "too large": f"one that needs more than {job.max_bytes / 2**30:.2g} GiB of memory",
            "failed": f"one on which its reader breaks down (status {error.status})",
        }
        if message:
            got[error.reason] = f"one of which its reader says: {message}"
        raise UnreadableFile(path.name, "a MATLAB file", got[error.reason]) from error
    with np.load(io.BytesIO(content), allow_pickle=False) as arrays:
        return {name[1:]: arrays[name] for name in arrays.files}


def read_mat(
    path: str | os.PathLike[str],
    variable: str | None = None,
    *,
    markers: Sequence[str],
    rate_hz: float,
    unit: str = "mm",
    dims: Sequence[str] = DIMS,
    layout: Layout = "interleaved",
    axes: Sequence[str] = FORWARD_LEFT_UP,
) -> xr.DataArray:
    """Return an array of a MATLAB file as trajectories.

    Parameters
    ----------
    path : str or path
        A MATLAB file.
    variable : str, optional
        Name of the array, ``struct.field`` for one in a struct; may be left out if there is one.
    markers : sequence of str
        One name a marker.
    rate_hz : float
        Frames a second.
    unit : {"um", "mm", "cm", "dm", "m", "in", "ft"}
        Unit of the array.
    dims : sequence of str
        What the dimensions of the array are: ``"time"``, ``"marker"`` and ``"axis"`` in any order,
        or ``"time"`` and ``"column"`` if markers and axes stand in columns.
    layout : {"interleaved", "planar"}
        Whether columns go x y z x y z ... or x x x ... y y y ... z z z.
    axes : sequence of str
        Where the three axes point: ``"forward"``, ``"left"``, ``"up"``, or the opposite of one. For
        a walk through a room, forward is any level direction.

    Returns
    -------
    DataArray of shape (time, marker, axis)
        In millimetres, z up; NaN where a marker was not seen.

    Raises
    ------
    UnreadableFile
        If the file is damaged, or the array is not there or of another shape.
    ValueError
        If an argument makes no sense.

    See Also
    --------
    read_mocap : Reads files that name their markers and rate.

    Examples
    --------
    >>> read_mat("nowhere.mat", "walk", markers=["head"], rate_hz=120)
    Traceback (most recent call last):
    ...
    eigenwalker.io.errors.UnreadableFile: nowhere.mat: expected a file, but got nothing of
    that name in '.'; check the path.
    """
    turn = axes_matrix(axes)
    if sorted(dims) not in (sorted(DIMS), ["column", "time"]):
        raise ValueError(
            f"dims={tuple(dims)} are not known; give {DIMS} in any order, or ('time', 'column')."
        )
    path = Path(path)
    array = _chosen(read_mat_arrays(path), variable, path.name)
    sizes = {"marker": len(markers), "axis": 3, "column": 3 * len(markers)}
    shape = tuple(sizes.get(dim, "time") for dim in dims)
    if array.ndim != len(dims) or any(
        size not in (given, "time") for size, given in zip(shape, array.shape, strict=True)
    ):
        raise UnreadableFile(
            path.name, f"an array of shape {shape}", f"{array.shape}", "check markers and dims"
        )
    if np.isinf(array).any():
        raise UnreadableFile(path.name, "finite numbers", "infinite ones", "mark gaps by NaN")
    if len(dims) == 2:
        positions = from_rows(array if dims[0] == "time" else array.T, layout)
    else:
        positions = array.transpose([list(dims).index(dim) for dim in DIMS])
    walk = label_trajectories(positions @ turn, markers=markers, rate_hz=rate_hz, unit=unit)
    walk.attrs.update(source=path.name, format="MAT", unit=unit, unit_guessed=False)
    return walk


def _chosen(arrays: dict[str, np.ndarray], variable: str | None, source: str) -> np.ndarray:
    name = next(iter(arrays)) if variable is None and len(arrays) == 1 else variable
    if name not in arrays:
        shapes = {key: array.shape for key, array in list(arrays.items())[:_MAX_NAMES]}
        expected = "one array" if variable is None else f"an array {variable!r}"
        raise UnreadableFile(source, expected, f"{shapes}", "name one of them: variable=...")
    return arrays[name]
