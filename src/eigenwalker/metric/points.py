"""What of two clips is compared frame by frame: the points that both have."""

from __future__ import annotations

import warnings
from collections.abc import Sequence

import numpy as np
import xarray as xr

from eigenwalker.core.trajectories import sampling_rate
from eigenwalker.metric.angles import joint_quaternions
from eigenwalker.metric.frame_metrics import By

UNITS: dict[By, str] = {"positions": "mm", "velocities": "mm/s", "angles": "rad"}
"""Unit of the distance of two points."""


VELOCITY_HARMONICS = 12
"""Harmonics of a stride that count in velocities: some 10 Hz, above which captures of gait are
noise, of which velocities would be made for the most part."""

FEW = 0.5
"""Share of the fewer points of two clips below which it is said how few both have."""


def points_of(clip: xr.DataArray, by: By, *, periodic: bool) -> tuple[list[str], np.ndarray]:
    """Return what of a clip is compared frame by frame, unlabelled, as labels take their time.

    Parameters
    ----------
    clip : DataArray of shape (time, marker, axis)
        Trajectories.
    by : {"positions", "velocities", "angles"}
        Velocities are central differences, of a cycle derivatives of its first
        `VELOCITY_HARMONICS` harmonics; angles are the rotations of joints.
    periodic : bool
        Whether the first frame follows the last, as in a cycle.

    Returns
    -------
    names : list of str
    values : array of shape (time, point, part)
        Three parts in mm or mm/s, or four of a unit quaternion.

    """
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
    if not periodic:
        return np.gradient(values, 1 / rate_hz, axis=0)
    n_frames = len(values)
    kept = min(VELOCITY_HARMONICS, (n_frames - 1) // 2) + 1
    onwards = 2j * np.pi * np.arange(kept) * rate_hz / n_frames
    spectrum = np.fft.rfft(values, axis=0)[:kept]
    return np.fft.irfft(spectrum * onwards[:, None, None], n_frames, axis=0)


def common_names(first: Sequence[str], second: Sequence[str]) -> list[str]:
    """Return the names in both, sorted, so that neither order matters.

    Raises
    ------
    ValueError
        If there are none, or a clip has a name twice.

    """
    for names in (first, second):
        refuse_names_twice(names)
    names = sorted({str(name) for name in first} & {str(name) for name in second})
    if not names:
        raise ValueError(
            f"The clips have no points in common: {_few(first)} beside {_few(second)}. "
            "Bring both to the same joints with virtual_markers()."
        )
    if len(names) < FEW * min(len(first), len(second)):
        warnings.warn(
            f"Only {len(names)} points have the same name in both clips, of {len(first)} and "
            f"{len(second)}, and are compared: {_few(names)}. To compare whole bodies bring both "
            "to the same joints first, with comparable_walk().",
            stacklevel=2,
        )
    return names


def refuse_names_twice(names: Sequence[str]) -> None:
    """Raise a ValueError if points share a name."""
    names = [str(name) for name in names]
    if twice := sorted({name for name in names if names.count(name) > 1}):
        raise ValueError(
            f"Points need names of their own; {_few(twice)} come more than once. Rename them or "
            "leave them out."
        )


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
            "first, with in_place() or repair_labels()."
        )
    return values_a[:, seen], values_b[:, seen]
