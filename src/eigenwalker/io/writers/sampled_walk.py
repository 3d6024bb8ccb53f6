"""Walks as files hold them: a walker sampled in time, and its forward progress."""

from __future__ import annotations

import numpy as np
import xarray as xr

from eigenwalker.core.trajectories import AXES
from eigenwalker.core.walker import Walker
from eigenwalker.io.to_trajectories import with_coordinate

RATE_HZ = 120.0
"""Frames a second if none are named: those of the captures in Troje (2002)."""
N_STRIDES = 4
MAX_FRAMES = 10_000_000


def sampled_walk(
    walker: Walker,
    *,
    n_strides: int | None = None,
    duration_s: float | None = None,
    rate_hz: float = RATE_HZ,
    overground: bool = False,
) -> xr.DataArray:
    """Return a walker's trajectories from the moment its first phase is 0, which becomes 0 s."""
    if n_strides is not None and duration_s is not None:
        raise ValueError("n_strides and duration_s are both given; give one.")
    if duration_s is None:
        n_strides = N_STRIDES if n_strides is None else n_strides
        duration_s = n_strides * walker.period_s
    if not duration_s > 0 or not rate_hz > 0 or not 2 <= duration_s * rate_hz <= MAX_FRAMES:
        raise ValueError(
            f"{duration_s:g} s at {rate_hz:g} Hz are {duration_s * rate_hz:g} frames; "
            f"choose 2 to {MAX_FRAMES} of them."
        )
    time = np.arange(round(duration_s * rate_hz)) / rate_hz
    walk = with_coordinate(walker.trajectories(walker.time_origin_s + time), "time", time)
    walk.attrs["speed_mm_s"] = walker.speed_mm_s
    return with_progress(walk) if overground else walk


def with_progress(walk: xr.DataArray) -> xr.DataArray:
    """Return trajectories in place as a walk forward with their ``attrs["speed_mm_s"]``."""
    speed = float(walk.attrs.get("speed_mm_s", np.nan))
    if not np.isfinite(speed):
        raise ValueError(
            "overground=True puts forward progress back, but the speed of this walk is not known; "
            "give a Walker its speed_mm_s, or trajectories attrs['speed_mm_s']."
        )
    forward = np.array([axis == AXES[0] for axis in AXES], dtype=float)
    travelled = speed * (walk.time.values - walk.time.values[0])
    return walk.copy(data=walk.values + travelled[:, None, None] * forward)
