"""Marker positions over time as a labelled array.

Trajectories are a plain `xarray.DataArray` with dims ``(time, marker, axis)`` in millimetres and
seconds; x points forward, y to the walker's left, z up. Missing samples are NaN.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Sequence

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from eigenwalker.core.arguments import as_floats, check_choice, described

DIMS = ("time", "marker", "axis")
AXES = ("x", "y", "z")
MAX_NAMES = 20
"""Names that a message lists."""
MILLIMETRES = {
    "um": 1e-3,
    "mm": 1.0,
    "cm": 10.0,
    "dm": 100.0,
    "m": 1000.0,
    "in": 25.4,
    "ft": 304.8,
}
"""Millimetres in each unit of a capture."""
LARGEST_MM = 1e12
"""Largest coordinate: a million kilometres, beyond the frame of any capture."""


def label_trajectories(
    values: ArrayLike,
    *,
    markers: Sequence[str],
    rate_hz: float,
    unit: str = "mm",
    start_s: float = 0.0,
) -> xr.DataArray:
    """Return marker positions as trajectories.

    Parameters
    ----------
    values : array of shape (time, marker, axis)
        Positions in `unit`; the axes are x (forward), y (left), z (up). NaN marks a missing sample.
    markers : sequence of str
        One name a marker.
    rate_hz : float
        Frames a second.
    unit : {"um", "mm", "cm", "dm", "m", "in", "ft"}
        Unit of `values`.
    start_s : float
        Time of the first frame in seconds.

    Returns
    -------
    DataArray of shape (time, marker, axis)
        Positions in millimetres.

    Raises
    ------
    ValueError
        If shapes and names do not fit, a value is infinite, or rate or unit make no sense.

    See Also
    --------
    eigenwalker.io.read_mocap : Reads them from files.

    Examples
    --------
    >>> walk = label_trajectories(np.zeros((3, 1, 3)), markers=["head"], rate_hz=100)
    >>> walk.time.values.tolist()
    [0.0, 0.01, 0.02]
    >>> walk.attrs["units"]
    'mm'
    """
    if not np.isfinite(rate_hz) or rate_hz <= 0:
        raise ValueError(f"rate_hz={rate_hz} is no frame rate; give frames a second, above 0.")
    check_choice(unit, sorted(MILLIMETRES), "unit")
    values = as_floats(values, "Positions must be real numbers") * MILLIMETRES[unit]
    if not values.size:
        raise ValueError(f"There are no positions in values of shape {values.shape}.")
    time = start_s + np.arange(len(values) if values.ndim else 0) / rate_hz
    return trajectories_at(time, values, markers)


def trajectories_at(time: ArrayLike, values: ArrayLike, markers: Sequence[str]) -> xr.DataArray:
    """Return positions (time, marker, axis) in mm, at times in seconds, as trajectories."""
    time = as_floats(time, "Times must be real numbers")
    values = as_floats(values, "Positions must be real numbers")
    names = [str(marker) for marker in markers]
    problems: list[str] = []
    if values.shape != (len(time), len(names), 3):
        problems.append(
            f"values have shape {values.shape}, where {len(time)} times and {len(names)} markers "
            f"ask for {(len(time), len(names), 3)}, that is (time, marker, axis)"
        )
    if len(set(names)) < len(names):
        twice = sorted(name for name, count in Counter(names).items() if count > 1)[:MAX_NAMES]
        problems.append(f"marker names must differ from each other, and these come twice: {twice}")
    if not all(names):
        problems.append("a marker has an empty name")
    if np.isinf(values).any():
        problems.append("some values are infinite; mark missing samples by NaN")
    elif (largest := np.abs(values).max(initial=0, where=~np.isnan(values))) > LARGEST_MM:
        problems.append(f"a position of {largest:.4g} mm is none; mark missing samples by NaN")
    if not np.isfinite(time).all():
        problems.append("some times are not finite")
    if problems:
        raise ValueError("These are no trajectories: " + "; ".join(problems) + ".")
    return xr.DataArray(
        values,
        dims=DIMS,
        coords={"time": time, "marker": names, "axis": list(AXES)},
        name="position",
        attrs={"units": "mm"},
    )


def check_trajectories(walk: xr.DataArray, *, complete: bool = False) -> xr.DataArray:
    """Return `walk` with its dims in the usual order if it is trajectories; raise if it is not.

    If they are to be complete, missing samples are refused too.
    """
    if not isinstance(walk, xr.DataArray):  # pyright: ignore[reportUnnecessaryIsInstance] - callers err
        make = "label_trajectories()"
        if isinstance(walk, str | os.PathLike):
            make = "read_mocap()"
        raise TypeError(
            f"Expected trajectories (a DataArray with dims {DIMS}), got {described(walk)}; "
            f"make them with {make}."
        )
    coords = sorted(map(str, walk.coords))  # pyright: ignore[reportUnknownMemberType, reportUnknownArgumentType]
    if set(walk.dims) != set(DIMS) or not set(DIMS) <= set(coords):
        raise ValueError(
            f"Expected trajectories with labelled dims {DIMS}, got dims {walk.dims} with "
            f"coordinates {coords}; make them with label_trajectories()."
        )
    if walk.dims != DIMS:
        walk = walk.transpose(*DIMS)
    if (axes := walk["axis"].values.tolist()) != list(AXES):
        raise ValueError(f"Expected the axes {AXES}, got {axes}.")
    if walk.attrs.get("units", "mm") != "mm":
        raise ValueError(
            f"Expected millimetres, got units={walk.attrs['units']!r}; "
            "convert with label_trajectories(..., unit=...)."
        )
    if walk.dtype != float:
        walk = walk.copy(data=as_floats(walk.values, "Positions must be real numbers"))
    names: list[object] = walk["marker"].values.tolist()
    if len(set(names)) < len(names):
        twice = sorted({str(name) for name in names if names.count(name) > 1})
        raise ValueError(
            f"Markers need names of their own; these come more than once: {twice[:6]}."
        )
    values = walk.values
    if not values.size:
        raise ValueError(f"Expected frames and markers; got shape {values.shape}, which has none.")
    if values.min() >= -LARGEST_MM and values.max() <= LARGEST_MM:
        return walk
    if np.isinf(values).any():
        raise ValueError("Some positions are infinite; mark missing samples by NaN.")
    if (largest := np.nanmax(np.abs(values), initial=0)) > LARGEST_MM:
        raise ValueError(f"A position of {largest:.4g} mm is none; mark missing samples by NaN.")
    if complete and (missing := np.isnan(values).any(axis=(0, 2))).any():
        raise ValueError(
            f"Samples are missing for {walk.marker.values[missing].tolist()}; "
            "fill them first with in_place()."
        )
    return walk


def sampling_rate(walk: xr.DataArray) -> float:
    """Return the frames a second of evenly sampled trajectories."""
    time = walk.time.values
    if len(time) < 2:
        raise ValueError(f"A rate needs two frames or more, got {len(time)}.")
    step = (time[-1] - time[0]) / (len(time) - 1)
    if step <= 0 or np.abs(np.diff(time) - step).max() > 0.01 * step:
        raise ValueError(
            "The frames are not evenly spaced in time; resample them first, "
            "for instance with trajectories.interp(time=...)."
        )
    return float(1 / step)


def missing_markers(walk: xr.DataArray, wanted: Sequence[str]) -> list[str]:
    """Return those of the wanted marker names that the trajectories lack."""
    present = set(walk.marker.values.tolist())
    return [name for name in wanted if name not in present]
