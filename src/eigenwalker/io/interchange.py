"""Trajectories to and from other packages that keep them in xarray: ``movement`` and ``pyomeca``.

Neither needs to be installed, as both use plain xarray objects.
"""

# xarray is not wholly typed, and what other packages hand over is checked:
# pyright: reportUnknownMemberType=false, reportUnnecessaryIsInstance=false
from __future__ import annotations

from collections.abc import Hashable

import numpy as np
import xarray as xr

from eigenwalker.core.arguments import check_choice
from eigenwalker.core.trajectories import (
    AXES,
    MILLIMETRES,
    check_trajectories,
    sampling_rate,
    trajectories_at,
)
from eigenwalker.io.up_axis_and_unit import turn_upright

UPS = ("x", "y", "z", "-x", "-y", "-z")
_KEYPOINTS = ("keypoints", "keypoint")
_INDIVIDUALS = ("individuals", "individual")
_MARKERS = ("axis", "channel", "time")


def to_movement(trajectories: xr.DataArray, *, individual: str = "walker") -> xr.Dataset:
    """Return trajectories as a poses dataset of the package ``movement``.

    Parameters
    ----------
    trajectories : DataArray of shape (time, marker, axis)
        Trajectories in millimetres. Their coordinate ``confidence`` (time, marker) is kept.
    individual : str
        Name of the walker.

    Returns
    -------
    Dataset
        ``position`` (time, space, keypoints, individuals), still in millimetres, z up, which
        ``position.attrs["units"]`` says; ``confidence``, NaN where not known.

    See Also
    --------
    from_movement, to_pyomeca

    Examples
    --------
    >>> walk = ew.label_trajectories(np.zeros((3, 2, 3)), markers=["head", "foot"], rate_hz=50)
    >>> poses = to_movement(walk)
    >>> dict(poses.position.sizes), poses.attrs["fps"]
    ({'time': 3, 'space': 3, 'keypoints': 2, 'individuals': 1}, 50.0)
    """
    walk = check_trajectories(trajectories)
    confidence = np.full(walk.shape[:2], np.nan)
    if "confidence" in walk.coords:
        confidence = walk["confidence"].transpose("time", "marker").values
    dims = ("time", "space", "keypoints", "individuals")
    position = walk.values.transpose(0, 2, 1)[..., None]
    return xr.Dataset(
        {
            "position": (dims, position, {"units": "mm"}),
            "confidence": (("time", "keypoints", "individuals"), confidence[..., None]),
        },
        coords={
            "time": walk.time.values,
            "space": list(AXES),
            "keypoints": walk.marker.values.astype(str),
            "individuals": [individual],
        },
        attrs={
            "source_software": "eigenwalker",
            "ds_type": "poses",
            "fps": round(sampling_rate(walk), 9),
            "time_unit": "seconds",
            "source_file": str(walk.attrs.get("source", "")),
        },
    )


def from_movement(
    poses: xr.Dataset,
    *,
    individual: str | None = None,
    unit: str | None = None,
    up: str = "z",
    rate_hz: float | None = None,
) -> xr.DataArray:
    """Return one individual of a poses dataset of the package ``movement`` as trajectories.

    Parameters
    ----------
    poses : Dataset
        With ``position`` (time, space, keypoints, individuals) in three dimensions.
    individual : str, optional
        The individual to take, if there are several.
    unit : {"um", "mm", "cm", "dm", "m", "in", "ft"}, optional
        Unit of the positions, unless ``position.attrs["units"]`` names it.
    up : {"x", "y", "z", "-x", "-y", "-z"}
        Axis that points up; triangulated videos often have ``"-y"``.
    rate_hz : float, optional
        Frames a second, where the dataset counts time in frames.

    Returns
    -------
    DataArray of shape (time, marker, axis)
        Millimetres, z up; the confidences are its coordinate ``confidence`` (time, marker).

    Raises
    ------
    TypeError, ValueError
        If it is anything else, or person, unit or rate are unknown.

    See Also
    --------
    to_movement, from_pyomeca

    Examples
    --------
    >>> walk = ew.label_trajectories(np.ones((3, 1, 3)), markers=["head"], rate_hz=50)
    >>> from_movement(to_movement(walk)).equals(walk)
    True
    """
    if not isinstance(poses, xr.Dataset) or "position" not in poses:
        raise TypeError(
            "Expected a poses dataset of movement, with a variable 'position'; got "
            f"{type(poses).__name__}."
        )
    position = poses["position"]
    points = _dim(position, _KEYPOINTS)
    people = _dim(position, _INDIVIDUALS)
    if position.sizes.get("space") != 3:
        raise ValueError(
            "Walks are of three dimensions, and this dataset has the space "
            f"{position['space'].values.tolist()}; triangulate the views first."
        )
    person = _one(poses, people, individual)
    position = position.sel({people: person}).transpose("time", points, "space")
    time = _seconds(poses, rate_hz)
    values = _in_millimetres(position, unit, up)
    walk = trajectories_at(time, values, position[points].values.tolist())
    walk.attrs.update(format="movement", source=str(poses.attrs.get("source_file") or ""))
    if "confidence" in poses:
        confidence = poses["confidence"].sel({people: person}).transpose("time", points)
        if bool(confidence.notnull().any()):
            walk = walk.assign_coords(confidence=(("time", "marker"), confidence.values))
    return walk


def to_pyomeca(trajectories: xr.DataArray) -> xr.DataArray:
    """Return trajectories as ``pyomeca.Markers``.

    Parameters
    ----------
    trajectories : DataArray of shape (time, marker, axis)
        Trajectories in millimetres.

    Returns
    -------
    DataArray of shape (axis, channel, time)
        Homogeneous coordinates (x, y, z, ones), in millimetres, z up; attributes ``rate``,
        ``units``, ``first_frame`` and ``last_frame``, counted from 0.

    See Also
    --------
    from_pyomeca, to_movement

    Examples
    --------
    >>> walk = ew.label_trajectories(np.zeros((3, 2, 3)), markers=["head", "foot"], rate_hz=50)
    >>> markers = to_pyomeca(walk)
    >>> markers.dims, markers.shape, markers.attrs["rate"]
    (('axis', 'channel', 'time'), (4, 2, 3), 50.0)
    """
    walk = check_trajectories(trajectories)
    rate_hz = round(sampling_rate(walk), 9)
    first = round(float(walk.time.values[0]) * rate_hz)
    positions = walk.values.transpose(2, 1, 0)
    return xr.DataArray(
        np.concatenate([positions, np.ones_like(positions[:1])]),
        dims=_MARKERS,
        coords={
            "axis": [*AXES, "ones"],
            "channel": walk.marker.values.astype(str),
            "time": walk.time.values,
        },
        name="markers",
        attrs={
            "rate": rate_hz,
            "units": "mm",
            "first_frame": first,
            "last_frame": first + len(walk) - 1,
        },
    )


def from_pyomeca(
    markers: xr.DataArray,
    *,
    unit: str | None = None,
    up: str = "z",
    rate_hz: float | None = None,
) -> xr.DataArray:
    """Return ``pyomeca.Markers`` as trajectories.

    Parameters
    ----------
    markers : DataArray of shape (axis, channel, time)
        Positions, with or without a fourth row of ones.
    unit, up, rate_hz : optional
        As `from_movement` takes them.

    Returns
    -------
    DataArray of shape (time, marker, axis)
        Millimetres, z up.

    Raises
    ------
    TypeError, ValueError
        If it is anything else, or unit or rate are unknown.

    See Also
    --------
    to_pyomeca, from_movement

    Examples
    --------
    >>> walk = ew.label_trajectories(np.ones((3, 1, 3)), markers=["head"], rate_hz=50)
    >>> from_pyomeca(to_pyomeca(walk)).equals(walk)
    True
    """
    if not isinstance(markers, xr.DataArray) or set(markers.dims) != set(_MARKERS):
        raise TypeError(
            f"Expected markers of pyomeca, a DataArray with dims {_MARKERS}; got "
            f"{getattr(markers, 'dims', type(markers).__name__)}."
        )
    if markers.sizes["axis"] not in (3, 4):
        raise ValueError(f"Expected the axes x, y, z and ones; got {markers.sizes['axis']} axes.")
    position = markers.transpose("time", "channel", "axis").isel(axis=slice(3))
    names = (
        position["channel"].values
        if "channel" in position.coords
        else [f"channel_{number}" for number in range(position.sizes["channel"])]
    )
    walk = trajectories_at(
        _seconds(markers, rate_hz), _in_millimetres(position, unit, up), list(names)
    )
    walk.attrs["format"] = "pyomeca"
    return walk


def _dim(position: xr.DataArray, names: tuple[str, ...]) -> Hashable:
    found = [name for name in names if name in position.dims]
    if not found:
        raise ValueError(f"Expected a dim called {names[0]!r}; got {position.dims}.")
    return found[0]


def _one(poses: xr.Dataset, people: Hashable, individual: str | None) -> str:
    known = [str(name) for name in poses[people].values]
    if individual is None and len(known) == 1:
        return known[0]
    if individual not in known:
        raise ValueError(f"individual={individual!r} is not in the dataset; name one of {known}.")
    return individual


def _seconds(data: xr.Dataset | xr.DataArray, rate_hz: float | None) -> np.ndarray:
    in_seconds = "time" in data.coords and data.attrs.get("time_unit", "seconds") == "seconds"
    if in_seconds and rate_hz is None:
        return np.asarray(data["time"].values, dtype=float)
    rate_hz = rate_hz or data.attrs.get("fps") or data.attrs.get("rate")
    if not rate_hz or not np.isfinite(rate_hz) or rate_hz <= 0:
        raise ValueError("The frames have no times in seconds; give rate_hz, frames a second.")
    return np.arange(data.sizes["time"]) / float(rate_hz)


def _in_millimetres(position: xr.DataArray, unit: str | None, up: str) -> np.ndarray:
    unit = unit or position.attrs.get("units")
    if unit not in MILLIMETRES:
        raise ValueError(
            f"The unit of the positions is {unit!r} here; name it: unit= one of "
            f"{sorted(MILLIMETRES)}."
        )
    check_choice(up, UPS, "up")
    return np.asarray(position.values, dtype=float) @ turn_upright(up).T * MILLIMETRES[unit]
