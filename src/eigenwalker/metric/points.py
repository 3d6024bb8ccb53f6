"""What is compared frame by frame: the points that two clips have in common."""

from __future__ import annotations

import warnings
from collections.abc import Sequence

import numpy as np
import xarray as xr

from eigenwalker.core.trajectories import sampling_rate
from eigenwalker.metric.joint_angles import joint_quaternions
from eigenwalker.metric.joint_groups import By

UNITS: dict[By, str] = {"positions": "mm", "velocities": "mm/s", "angles": "rad"}
"""Unit of the distance between two points."""

VELOCITY_HARMONICS = 12
"""Harmonics of a stride in its velocities: up to some 10 Hz, above which captures of gait are
mostly noise, which differentiation amplifies."""

FEW_SHARED = 0.5
"""Share of the points of the smaller clip below which a warning says how few both have."""


def points_of(clip: xr.DataArray, by: By, *, periodic: bool) -> tuple[list[str], np.ndarray]:
    """Return names, and values of shape (time, point, part), of what is compared of a clip.

    Velocities are central differences; of a periodic clip the derivatives of its first
    `VELOCITY_HARMONICS` harmonics. Angles are orientations of bones (`joint_quaternions`), with
    four parts in place of three in mm or mm/s.
    """
    if by == "angles":
        orientations = joint_quaternions(clip)
        return orientations["joint"].values.tolist(), orientations.values
    names, values = clip["marker"].values.tolist(), clip.values
    if by == "velocities":
        values = _velocities(values, sampling_rate(clip), periodic)
    return names, values


def _velocities(values: np.ndarray, rate_hz: float, periodic: bool) -> np.ndarray:
    if not periodic:
        return np.gradient(values, 1 / rate_hz, axis=0)
    n_frames = len(values)
    n_coefficients = min(VELOCITY_HARMONICS, (n_frames - 1) // 2) + 1
    derivative = 2j * np.pi * np.arange(n_coefficients) * rate_hz / n_frames
    spectrum = np.fft.rfft(values, axis=0)[:n_coefficients]
    return np.fft.irfft(spectrum * derivative[:, None, None], n_frames, axis=0)


def match_rotations(clips: Sequence[xr.DataArray]) -> list[xr.DataArray]:
    """Return clips without captured rotations, unless all have some: one kind is compared."""
    captured = ["rotation" in clip.coords for clip in clips]
    if all(captured) or not any(captured):
        return list(clips)
    return [clip.drop_vars("rotation", errors="ignore") for clip in clips]


def select_points(names: list[str], values: np.ndarray, selected: list[str]) -> np.ndarray:
    """Return the selected points of an array of shape (time, point, part)."""
    if names == selected:
        return np.ascontiguousarray(values)
    return values[:, [names.index(name) for name in selected]]


def common_names(first: Sequence[str], second: Sequence[str]) -> list[str]:
    """Return the names in both, sorted, so that neither order matters."""
    names = sorted({str(name) for name in first} & {str(name) for name in second})
    if not names:
        raise ValueError(
            f"The clips have no points in common: {_abbreviated(first)} beside "
            f"{_abbreviated(second)}. Bring both to the same joints with virtual_markers()."
        )
    if len(names) < FEW_SHARED * min(len(first), len(second)):
        warnings.warn(
            f"Only {len(names)} points have the same name in both clips, of {len(first)} and "
            f"{len(second)}, and are compared: {_abbreviated(names)}. To compare whole bodies "
            "bring both to the same joints first, with prepare_walk().",
            stacklevel=2,
        )
    return names


def _abbreviated(names: Sequence[str], n_shown: int = 6) -> str:
    shown = ", ".join(str(name) for name in list(names)[:n_shown])
    return f"[{shown}{', ...' if len(names) > n_shown else ''}]"


def common_positions(a: xr.DataArray, b: xr.DataArray) -> tuple[np.ndarray, np.ndarray]:
    """Return positions of the markers that are seen in all frames of both clips."""
    names = common_names(a.marker.values, b.marker.values)
    values_a, values_b = a.sel(marker=names).values, b.sel(marker=names).values
    seen_a, seen_b = (np.isfinite(values).all(axis=(0, 2)) for values in (values_a, values_b))
    if not (seen_a & seen_b).any():
        raise ValueError(
            "No marker was seen in all frames of both clips, so they cannot be aligned. Fill gaps "
            "first, with in_place() or repair_labels()."
        )
    return values_a[:, seen_a & seen_b], values_b[:, seen_a & seen_b]


def content_ranks(clips: Sequence[np.ndarray]) -> np.ndarray:
    """Return ranks of clips by their values, so that distances do not depend on their order.

    Values are rounded to a thousandth of their unit: last bits of a number decide nothing.
    """
    contents = [(clip.round(3) + 0.0).tobytes() for clip in clips]
    ranks = np.empty(len(contents), dtype=int)
    ranks[sorted(range(len(contents)), key=contents.__getitem__)] = np.arange(len(contents))
    return ranks
