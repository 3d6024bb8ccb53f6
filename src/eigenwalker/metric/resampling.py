"""Clips played at other times: at another frame rate, or on another clock."""

from __future__ import annotations

import numpy as np
import xarray as xr
from scipy.interpolate import CubicSpline

from eigenwalker.core.quaternions import quaternions_at, vectors_of
from eigenwalker.core.trajectories import check_trajectories, sampling_rate, trajectories_at

SAME_RATE = 0.01
"""Relative difference of frame rates up to which as many frames last as long."""


def length_s(clip: xr.DataArray) -> float:
    """Seconds that a clip lasts, its last frame too."""
    return clip.sizes["time"] / sampling_rate(clip)


def at_one_rate(a: xr.DataArray, b: xr.DataArray) -> tuple[xr.DataArray, xr.DataArray]:
    """Return both clips at the higher of their frame rates."""
    a, b = check_trajectories(a), check_trajectories(b)
    rates = sampling_rate(a), sampling_rate(b)
    if abs(rates[0] / rates[1] - 1) <= SAME_RATE:
        return a, b
    if rates[0] > rates[1]:
        return a, _resampled(b, rates[0])
    return _resampled(a, rates[1]), b


def _resampled(clip: xr.DataArray, rate_hz: float) -> xr.DataArray:
    """Return a clip at a higher frame rate, by cubic splines; a marker with gaps stays unseen."""
    time = clip.time.values
    n_frames = int((time[-1] - time[0]) * rate_hz + 1e-6) + 1
    clock = time[0] + np.arange(n_frames) / rate_hz
    result = trajectories_at(clock, played(clip, clock, periodic=False), clip.marker.values)
    if "rotation" in clip.coords:
        moments = (clock - time[0]) * sampling_rate(clip)
        vectors = vectors_of(quaternions_at(clip.rotation.values, moments))
        result = result.assign_coords(rotation=(clip.rotation.dims, vectors))
    return result.assign_attrs(clip.attrs)


def played(clip: xr.DataArray, time: np.ndarray, periodic: bool) -> np.ndarray:
    """Return positions at any times within a clip, or within its endless repetition."""
    values, clock = clip.values, clip.time.values
    if periodic:
        values = np.concatenate([values, values[:1]])
        clock = np.append(clock, clock[0] + length_s(clip))
        time = clock[0] + (time - clock[0]) % (clock[-1] - clock[0])
    result = np.full((len(time), *values.shape[1:]), np.nan)
    seen = np.isfinite(values).all(axis=(0, 2))
    ends = "periodic" if periodic else "not-a-knot"
    spline = CubicSpline(clock, values[:, seen], bc_type=ends)
    result[:, seen] = spline(np.clip(time, clock[0], clock[-1]))
    return result
