"""Spatio-temporal gait parameters, as clinics and textbooks use them."""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np
import pandas as pd
import xarray as xr

from eigenwalker.core.trajectories import check_trajectories
from eigenwalker.core.walker import Walker
from eigenwalker.gait.events import HEEL_STRIKE, TOE_OFF, gait_events
from eigenwalker.gait.frequency import fundamental_frequency
from eigenwalker.gait.heading import SIDES, stance_speed
from eigenwalker.gait.in_place import in_place

_STRIDES_PLAYED = 3
_TRAVELS_MM = 800.0
"""Distance that nobody travels on a treadmill without falling off."""
_FRAMES_A_STRIDE = 200


def gait_parameters(walk: xr.DataArray | Walker, *, speed_mm_s: float | None = None) -> pd.Series:
    """Return the spatio-temporal parameters of a walk.

    Events are those of `gait_events`, with its bias: from ankles alone, stance and double support
    are some 3 and 5 % of the stride too long (simulated walks).

    Parameters
    ----------
    walk : DataArray of shape (time, marker, axis), or Walker
        A walk in place, facing +x, in millimetres. A capture that travels is brought in place
        first (`in_place`); a walker is sampled over three strides.
    speed_mm_s : float, optional
        Speed of the walk. Otherwise it is that of the walker or of the capture that travels, the
        ``attrs["speed_mm_s"]`` that `in_place` writes, or that of the standing feet
        (`stance_speed`).

    Returns
    -------
    Series
        NaN where more strides are needed.

        - ``frequency_hz``, ``stride_time_s``, ``cadence_steps_min``, ``speed_mm_s``,
          ``stride_length_mm``;
        - ``stride_time_cv``: SD over mean, NaN for a walker or less than three strides;
        - ``step_length_left_mm``: along x between the places on the ground of a right heel strike
          and the left one that follows; ``step_length_right_mm``; ``step_width_mm``: along y;
        - ``stance_share_left``, ``stance_share_right``, ``double_support_share``: of the stride;
        - ``step_asymmetry``, ``stance_asymmetry``: left minus right over their mean;
        - ``pelvis_vertical_range_mm``: mean over strides.

    Raises
    ------
    ValueError
        If the ankles are missing or nothing repeats.

    See Also
    --------
    gait_events, walker_measures

    Examples
    --------
    >>> walker = ew.Walker(
    ...     ["pelvis", "left_ankle", "right_ankle"],
    ...     [[0, 0, 900], [0, 60, 80], [0, -60, 80]],
    ...     [[[0, 0, 0], [300, 0, 0], [-300, 0, 0]]],
    ...     [1],
    ...     [0],
    ...     1.0,
    ...     speed_mm_s=1200,
    ... )
    >>> gait_parameters(walker)[["cadence_steps_min", "step_length_left_mm", "step_width_mm"]]
    cadence_steps_min      120.0
    step_length_left_mm    600.0
    step_width_mm          120.0
    dtype: float64

    """
    if isinstance(walk, Walker):
        frequency_hz, speed = walk.frequency_hz, walk.speed_mm_s
        n_frames = _STRIDES_PLAYED * _FRAMES_A_STRIDE
        walk = walk.trajectories(np.arange(n_frames) * walk.period_s / _FRAMES_A_STRIDE)
    else:
        walk = check_trajectories(walk)
        place = walk.mean("marker").sel(axis=["x", "y"])
        if float((place.max("time") - place.min("time")).max()) > _TRAVELS_MM:
            walk = in_place(walk)
        walk = check_trajectories(walk, complete=True)
        frequency_hz = fundamental_frequency(walk)
        speed = walk.attrs.get("speed_mm_s", np.nan)
    events = gait_events(walk)
    speed = float(speed if speed_mm_s is None else speed_mm_s)
    if not np.isfinite(speed):
        speed = stance_speed(walk)
    times = {
        (side, event): events.query("side == @side and event == @event").time_s.to_numpy()
        for side in SIDES
        for event in (HEEL_STRIKE, TOE_OFF)
    }
    steps = _steps(walk, times, speed)
    stance = [
        _stance(times[side, HEEL_STRIKE], times[side, TOE_OFF], frequency_hz) for side in SIDES
    ]
    stride_times = np.concatenate([np.diff(times[side, HEEL_STRIKE]) for side in SIDES])
    return pd.Series(
        {
            "frequency_hz": frequency_hz,
            "cadence_steps_min": 120 * frequency_hz,
            "speed_mm_s": speed,
            "stride_time_s": 1 / frequency_hz,
            "stride_time_cv": _variation(stride_times),
            "stride_length_mm": speed / frequency_hz,
            "step_length_left_mm": steps.left_mm,
            "step_length_right_mm": steps.right_mm,
            "step_width_mm": steps.width_mm,
            "step_asymmetry": _asymmetry(steps.left_mm, steps.right_mm),
            "stance_share_left": stance[0],
            "stance_share_right": stance[1],
            "stance_asymmetry": _asymmetry(*stance),
            "double_support_share": sum(stance) - 1,
            "pelvis_vertical_range_mm": _vertical_range(walk, frequency_hz),
        }
    )


class _Steps(NamedTuple):
    left_mm: float
    right_mm: float
    width_mm: float


def _steps(walk: xr.DataArray, times: dict[tuple[str, str], np.ndarray], speed: float) -> _Steps:
    """Return mean step lengths and width, from the places of the ankles at heel strikes."""
    time = walk.time.values
    strikes = []
    for side in SIDES:
        path = walk.sel(marker=f"{side}_ankle").values
        for moment in times[side, HEEL_STRIKE]:
            forward, sideways = (np.interp(moment, time, path[:, axis]) for axis in (0, 1))
            strikes.append((moment, side, forward + speed * moment, sideways))
    strikes.sort()
    lengths: dict[str, list[float]] = {side: [] for side in SIDES}
    widths = []
    for (_, before, start, there), (_, side, stop, here) in pairwise(strikes):
        if side != before:
            lengths[side].append(stop - start)
            widths.append(here - there if side == "left" else there - here)
    return _Steps(_mean(lengths["left"]), _mean(lengths["right"]), _mean(widths))


def _stance(strikes: np.ndarray, offs: np.ndarray, frequency_hz: float) -> float:
    """Return the mean share of the stride from each heel strike to the toe off that follows."""
    shares = [
        (offs[offs > strike][0] - strike) * frequency_hz
        for strike in strikes
        if (offs > strike).any()
    ]
    return _mean([share for share in shares if share < 1])


def _vertical_range(walk: xr.DataArray, frequency_hz: float) -> float:
    """Return the mean over strides of the vertical range of the pelvis, or of the hips' middle."""
    names = set(walk.marker.values.tolist())
    trunk = ["pelvis"] if "pelvis" in names else ["left_hip", "right_hip"]
    if not set(trunk) <= names:
        return float("nan")
    height = walk.sel(marker=trunk, axis="z").mean("marker").values
    time = walk.time.values
    stride = ((time - time[0]) * frequency_hz + 1e-6).astype(int)
    whole = np.arange(max(1, round((time[-1] - time[0]) * frequency_hz)))
    return _mean([np.ptp(height[stride == number]) for number in whole])


def _variation(values: np.ndarray) -> float:
    return float(values.std(ddof=1) / values.mean()) if len(values) > 2 else float("nan")


def _asymmetry(left: float, right: float) -> float:
    both = left + right
    return 2 * (left - right) / both if both else float("nan")


def _mean(values: list[float]) -> float:
    return float(np.mean(values)) if values else float("nan")
