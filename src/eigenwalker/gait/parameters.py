"""Spatio-temporal gait parameters, as clinics and textbooks use them."""

from __future__ import annotations

import numpy as np
import pandas as pd
import xarray as xr

from eigenwalker.core.trajectories import check_trajectories
from eigenwalker.core.walker import Walker
from eigenwalker.gait.body_points import SIDES
from eigenwalker.gait.events import HEEL_STRIKE, TOE_OFF, gait_events
from eigenwalker.gait.frequency import fundamental_frequency
from eigenwalker.gait.heading import known_speed, stance_speed
from eigenwalker.gait.in_place import in_place

_STRIDES_PLAYED = 3
_TRAVELS_MM = 800.0
"""Distance that nobody travels on a treadmill without falling off."""
_FRAMES_A_STRIDE = 200


def gait_parameters(walk: xr.DataArray | Walker, *, speed_mm_s: float | None = None) -> pd.Series:
    """Return the spatio-temporal parameters of a walk.

    Events are those of `gait_events`, with its bias: from ankles alone, stance and double support
    are some 3 and 5 % of the stride too long, with toes some 7 and 14 % (simulated walks).

    Parameters
    ----------
    walk : DataArray of shape (time, marker, axis), or Walker
        A walk in place, facing +x, in millimetres. A capture that travels is brought in place
        first (`in_place`); a walker is sampled over three strides.
    speed_mm_s : float, optional
        Speed of the walk. Otherwise it is that of the walker or of the capture that travels, the
        coordinate ``speed_mm_s`` that `in_place` gives a walk, or that of the standing feet
        (`stance_speed`).

    Returns
    -------
    Series
        NaN where more strides are needed.

        - ``frequency_hz``, ``stride_time_s``, ``cadence_steps_min``; ``speed_mm_s``, negative of
          who walks backwards; ``stride_length_mm``;
        - ``stride_time_cv``: SD over mean, NaN for a walker or less than three strides;
        - ``step_length_left_mm``: along x between the places on the ground of a right heel strike
          and the left one that follows, in the direction of travel; ``step_length_right_mm``;
          ``step_width_mm``: along y;
        - ``stance_share_left``, ``stance_share_right``, ``swing_share_left``,
          ``swing_share_right``, ``double_support_share``: of the stride; double
          support is 0 where at moments no foot stands, as in running;
        - ``step_asymmetry``, ``stance_asymmetry``: left minus right over their mean, NaN where one
          of them is not above 0;
        - ``pelvis_vertical_range_mm``: mean over strides.

    Raises
    ------
    ValueError
        If the ankles are missing or nothing repeats.

    See Also
    --------
    gait_events, walker_measures

    References
    ----------
    Perry & Burnfield (2010), Gait analysis, chapter 1: stride, step, stance, double support.

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
        speed = known_speed(walk)
    speed = float(speed if speed_mm_s is None else speed_mm_s)
    if not np.isfinite(speed):
        speed = stance_speed(walk)
    else:
        walk = walk.assign_coords(speed_mm_s=speed)
    events = gait_events(walk)
    stance = stance_shares(events, frequency_hz)
    strikes = [_times(events, side, HEEL_STRIKE) for side in SIDES]
    left_mm, right_mm, width_mm = _steps(walk, events[events["event"] == HEEL_STRIKE], speed)
    return pd.Series(
        {
            "frequency_hz": frequency_hz,
            "cadence_steps_min": 120 * frequency_hz,
            "speed_mm_s": speed,
            "stride_time_s": 1 / frequency_hz,
            "stride_time_cv": _variation(np.concatenate([np.diff(each) for each in strikes])),
            "stride_length_mm": abs(speed) / frequency_hz,
            "step_length_left_mm": left_mm,
            "step_length_right_mm": right_mm,
            "step_width_mm": width_mm,
            "step_asymmetry": _asymmetry(left_mm, right_mm),
            "stance_share_left": stance[0],
            "stance_share_right": stance[1],
            "stance_asymmetry": _asymmetry(*stance),
            "swing_share_left": 1 - stance[0],
            "swing_share_right": 1 - stance[1],
            "double_support_share": float(np.maximum(sum(stance) - 1, 0)),
            "pelvis_vertical_range_mm": _vertical_range(walk, frequency_hz),
        }
    )


def _steps(walk: xr.DataArray, strikes: pd.DataFrame, speed: float) -> tuple[float, float, float]:
    """Return mean lengths of left and right steps and mean width, in mm, from heel strikes."""
    side, moments = strikes["side"].to_numpy(), strikes["time_s"].to_numpy()
    ankles = {name: walk.sel(marker=f"{name}_ankle").values for name in SIDES}
    x, y = (
        [
            np.interp(moment, walk.time.values, ankles[name][:, axis])
            for name, moment in zip(side, moments, strict=True)
        ]
        for axis in (0, 1)
    )
    forward = np.diff(x + speed * moments) * np.copysign(1, speed)
    to_left = np.diff(y)
    left, is_step = side[1:] == "left", side[1:] != side[:-1]
    width_mm = _mean(np.where(left, to_left, -to_left)[is_step])
    return _mean(forward[is_step & left]), _mean(forward[is_step & ~left]), width_mm


def stance_shares(events: pd.DataFrame, frequency_hz: float) -> tuple[float, float]:
    """Return the mean shares of the stride from heel strike to toe off, left and right."""
    left, right = (
        _stance(_times(events, side, HEEL_STRIKE), _times(events, side, TOE_OFF), frequency_hz)
        for side in SIDES
    )
    return left, right


def _times(events: pd.DataFrame, side: str, event: str) -> np.ndarray:
    return events["time_s"][(events["side"] == side) & (events["event"] == event)].to_numpy()


def _stance(strikes: np.ndarray, offs: np.ndarray, frequency_hz: float) -> float:
    next_off = np.searchsorted(offs, strikes, side="right")
    known = next_off < len(offs)
    shares = (offs[next_off[known]] - strikes[known]) * frequency_hz
    return _mean(shares[shares < 1])


def _vertical_range(walk: xr.DataArray, frequency_hz: float) -> float:
    """Return the mean over strides of the vertical range of the pelvis, or of the hips' middle."""
    trunk = ["pelvis"] if "pelvis" in walk.marker else ["left_hip", "right_hip"]
    height = walk.reindex(marker=trunk).sel(axis="z").mean("marker", skipna=False).values
    time = walk.time.values
    stride = ((time - time[0]) * frequency_hz + 1e-6).astype(int)
    whole = np.arange(max(1, round((time[-1] - time[0]) * frequency_hz)))
    return _mean(np.array([np.ptp(height[stride == number]) for number in whole]))


def _variation(values: np.ndarray) -> float:
    return float(values.std(ddof=1) / values.mean()) if len(values) > 2 else float("nan")


def _asymmetry(left: float, right: float) -> float:
    return 2 * (left - right) / (left + right) if left > 0 and right > 0 else float("nan")


def _mean(values: np.ndarray) -> float:
    return float(values.mean()) if len(values) else float("nan")
