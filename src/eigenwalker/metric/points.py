"""What of two clips is compared frame by frame: the points that both have."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from eigenwalker.metric.angles import joint_quaternions
from eigenwalker.metric.frame_metrics import By
from eigenwalker.trajectories import sampling_rate

UNITS: dict[By, str] = {"positions": "mm", "velocities": "mm/s", "angles": "rad"}
"""Unit of the distance of two points."""


def frame_points(clip: xr.DataArray, by: By, *, periodic: bool = False) -> xr.DataArray:
    """Return what of a clip is compared frame by frame.

    Parameters
    ----------
    clip : DataArray of shape (time, marker, axis)
        Trajectories.
    by : {"positions", "velocities", "angles"}
        Velocities are central differences; angles are the rotations of joints.
    periodic : bool
        Whether the first frame follows the last, as in a cycle.

    Returns
    -------
    DataArray of shape (time, point, part)
        Three parts in mm or mm/s, or four of a unit quaternion.

    Examples
    --------
    >>> foot = ew.label_trajectories([[[0, 0, 0]], [[10, 0, 0]]], markers=["foot"], rate_hz=100)
    >>> frame_points(foot, "velocities").values[:, 0, 0].round(6).tolist()
    [1000.0, 1000.0]

    """
    names, values = points_of(clip, by, periodic=periodic)
    return xr.DataArray(
        values,
        dims=("time", "point", "part"),
        coords={"time": clip.time.values, "point": names},
        attrs={"units": UNITS[by]},
    )


def points_of(clip: xr.DataArray, by: By, *, periodic: bool) -> tuple[list[str], np.ndarray]:
    """Return names and values of `frame_points`, unlabelled: in loops over clips labels cost."""
    if by == "angles":
        points = joint_quaternions(clip)
        return points["joint"].values.tolist(), points.values
    names, values = clip["marker"].values.tolist(), clip.values
    if by == "velocities":
        values = _velocities(values, sampling_rate(clip), periodic)
    return names, values


def told_alike(clips: Sequence[xr.DataArray]) -> list[xr.DataArray]:
    """Return clips without their captured rotations, unless all have them.

    What positions tell of a joint's turn is not what was captured of it, so angles are compared
    of one kind only.
    """
    told = ["rotation" in clip.coords for clip in clips]
    if all(told) or not any(told):
        return list(clips)
    return [clip.drop_vars("rotation", errors="ignore") for clip in clips]


def picked(names: list[str], values: np.ndarray, wanted: list[str]) -> np.ndarray:
    """Return the wanted points of an array of shape (time, point, part)."""
    if names == wanted:
        return np.ascontiguousarray(values)
    return values[:, [names.index(name) for name in wanted]]


def _velocities(values: np.ndarray, rate_hz: float, periodic: bool) -> np.ndarray:
    if periodic:
        return (np.roll(values, -1, axis=0) - np.roll(values, 1, axis=0)) * rate_hz / 2
    return np.gradient(values, 1 / rate_hz, axis=0)


def common_names(first: Sequence[str], second: Sequence[str]) -> list[str]:
    """Return the names in both, sorted, so that neither order matters.

    Raises
    ------
    ValueError
        If there are none, or a clip has a name twice.

    """
    for names in (first, second):
        if len(set(names)) < len(names):
            raise ValueError(f"Points need names of their own; some come twice: {_few(names)}.")
    names = sorted({str(name) for name in first} & {str(name) for name in second})
    if not names:
        raise ValueError(
            f"The clips have no points in common: {_few(first)} beside {_few(second)}. "
            "Bring both to the same joints with virtual_markers()."
        )
    return names


def _few(names: Sequence[str], most: int = 6) -> str:
    told = ", ".join(str(name) for name in list(names)[:most])
    return f"[{told}{', ...' if len(names) > most else ''}]"


def common_positions(a: xr.DataArray, b: xr.DataArray) -> tuple[np.ndarray, np.ndarray]:
    """Return positions of the markers that are there in all frames of both clips.

    Raises
    ------
    ValueError
        If there are none.

    """
    names = common_names(a.marker.values, b.marker.values)
    values_a, values_b = a.sel(marker=names).values, b.sel(marker=names).values
    seen = [np.isfinite(values).all(axis=(0, 2)) for values in (values_a, values_b)]
    seen = seen[0] & seen[1]
    if not seen.any():
        raise ValueError(
            "No marker was seen in all frames of both clips, so they cannot be aligned. Fill gaps "
            "first, with in_place() or mend()."
        )
    return values_a[:, seen], values_b[:, seen]
