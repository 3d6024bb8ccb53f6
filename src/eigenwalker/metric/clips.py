"""What can be compared: trajectories, a walker, a loop or a prepared clip, each taken as a clip."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike
from scipy.interpolate import CubicSpline

from eigenwalker.core.arguments import check_numbers, described
from eigenwalker.core.quaternions import quaternions_at, vectors_of
from eigenwalker.core.trajectories import check_trajectories, sampling_rate, trajectories_at
from eigenwalker.core.walker import Walker

RATE_HZ = 100.0
"""Frames a second at which walkers are played, as the clips of Pražák et al. (2010) were."""

N_STRIDES = 3
"""Strides that a walker makes when it is taken as a clip."""

SAME_RATE = 0.01
"""Relative difference of frame rates up to which two clips count as having the same rate."""


@dataclass(frozen=True, eq=False)
class Loop:
    """One period of a movement, whose last frame is followed by its first.

    Parameters
    ----------
    cycle : DataArray of shape (time, marker, axis)
        Positions in mm over one period, evenly sampled from 0 s.
    period_s : float
        Duration of the period in seconds.
    start_s : float
        Time in the original clip at which the first blended period begins.
    seam_mm : float
        Distance between the two postures that a plain cut would join, mean over markers.
    mismatch_mm : float
        Distance between corresponding postures of both periods, mean over markers and time, which
        blending averages away.
    n_periods : int
        2 if two periods were blended; 1 if the clip holds a single period, whose seam was
        distributed over it.

    See Also
    --------
    eigenwalker.metric.loop : Makes it.

    References
    ----------
    Pražák et al. (2010), section 3 and fig. 1.
    """

    cycle: xr.DataArray
    period_s: float
    start_s: float
    seam_mm: float
    mismatch_mm: float
    n_periods: int

    def __repr__(self) -> str:
        return (
            f"Loop({self.cycle.sizes['time']} frames, {self.cycle.sizes['marker']} markers, period "
            f"{self.period_s:.3f} s, seam {self.seam_mm:.1f} mm)"
        )

    def trajectories(self, time: ArrayLike | xr.DataArray) -> xr.DataArray:
        """Return the repeated loop at any times.

        Parameters
        ----------
        time : array of shape (time,)
            Seconds; 0 is the first frame of the cycle.

        Returns
        -------
        DataArray of shape (time, marker, axis)
            Positions in mm, interpolated by periodic cubic splines.
        """
        time = np.atleast_1d(check_numbers(time, "time"))
        values = positions_at(self.cycle, time, periodic=True)
        return trajectories_at(time, values, self.cycle.marker.values)


@dataclass(frozen=True, eq=False)
class PreparedClip:
    """A clip with its stride on the common clock (`prepare`).

    Parameters
    ----------
    clip : DataArray of shape (time, marker, axis)
        The clip, short gaps filled.
    cycle : DataArray of shape (time, marker, axis), optional
        One stride on the common clock (`common_clock`); None if the clip does not repeat.
    not_periodic_reason : str
        Why there is no stride; empty if there is one.

    See Also
    --------
    prepare : makes it.
    """

    clip: xr.DataArray
    cycle: xr.DataArray | None
    not_periodic_reason: str = ""


Clip = xr.DataArray | Walker | Loop | PreparedClip
"""Everything that can be compared with something else."""

Clips = Mapping[str, Clip] | Sequence[Clip]
"""Clips by name, or in order."""


def as_trajectories(clip: Clip) -> xr.DataArray:
    """Return the trajectories of any clip; of a walker `N_STRIDES` strides, of a loop one cycle."""
    if isinstance(clip, Walker):
        return clip.trajectories(np.arange(0, N_STRIDES * clip.period_s, 1 / RATE_HZ))
    if isinstance(clip, Loop | PreparedClip):
        return clip.cycle if isinstance(clip, Loop) else clip.clip
    return check_trajectories(clip)


def check_clips(clips: Clips) -> Clips:
    """Return clips by name or in order; of a population its walkers."""
    clips = getattr(clips, "walkers", clips)
    if isinstance(clips, str) or not isinstance(clips, Mapping | Sequence):
        raise TypeError(f"Expected clips by name, or a list of them; got {described(clips)}.")
    return clips


def duration_s(clip: xr.DataArray) -> float:
    """Return the seconds that all frames of a clip last, the last frame included."""
    return clip.sizes["time"] / sampling_rate(clip)


def at_one_rate(a: xr.DataArray, b: xr.DataArray) -> tuple[xr.DataArray, xr.DataArray]:
    """Return both clips at the higher of their frame rates."""
    rate_a, rate_b = sampling_rate(a), sampling_rate(b)
    if abs(rate_a / rate_b - 1) <= SAME_RATE:
        return a, b
    return (a, _resampled(b, rate_a)) if rate_a > rate_b else (_resampled(a, rate_b), b)


def _resampled(clip: xr.DataArray, rate_hz: float) -> xr.DataArray:
    time = clip.time.values
    n_frames = int((time[-1] - time[0]) * rate_hz + 1e-6) + 1
    clock = time[0] + np.arange(n_frames) / rate_hz
    result = trajectories_at(clock, positions_at(clip, clock), clip.marker.values)
    if "rotation" in clip.coords:
        frames = (clock - time[0]) * sampling_rate(clip)
        vectors = vectors_of(quaternions_at(clip.rotation.values, frames))
        result = result.assign_coords(rotation=(clip.rotation.dims, vectors))
    return result.assign_attrs(clip.attrs)


def positions_at(clip: xr.DataArray, time: np.ndarray, *, periodic: bool = False) -> np.ndarray:
    """Return positions at any times, by cubic splines; NaN for markers with gaps."""
    values, clock = clip.values, clip.time.values
    if periodic:
        values = np.concatenate([values, values[:1]])
        clock = np.append(clock, clock[0] + duration_s(clip))
        time = clock[0] + (time - clock[0]) % (clock[-1] - clock[0])
    result = np.full((len(time), *values.shape[1:]), np.nan)
    seen = np.isfinite(values).all(axis=(0, 2))
    ends = "periodic" if periodic else "not-a-knot"
    spline = CubicSpline(clock, values[:, seen], bc_type=ends)
    result[:, seen] = spline(np.clip(time, clock[0], clock[-1]))
    return result
