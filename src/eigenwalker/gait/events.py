"""When feet meet and leave the ground, found from their paths beside the pelvis."""

from __future__ import annotations

import numpy as np
import pandas as pd
import xarray as xr

from eigenwalker.core.trajectories import check_trajectories
from eigenwalker.gait.frequency import fundamental_frequency
from eigenwalker.gait.heading import SIDES

HEEL_STRIKE = "heel strike"
TOE_OFF = "toe off"

_SEPARATION = 0.3
"""Share of a stride around an event in which no other of its kind happens on the same foot."""


def gait_events(walk: xr.DataArray) -> pd.DataFrame:
    """Return heel strikes and toe offs of a walk.

    The coordinate method of Zeni et al. (2008, Gait & Posture 27:710): a foot strikes the ground
    when it is furthest in front of the pelvis and leaves it when it is furthest behind. Heels
    and toes are taken where they are there, as ``left_heel`` and ``left_toe``, otherwise the ankle,
    which turns back before the foot does: on simulated walks it strikes 5 % of the stride too early
    (4.4 to 5.7 % from person to person) and leaves 2 % too early (1 to 4 %).

    Parameters
    ----------
    walk : DataArray of shape (time, marker, axis)
        A walk that faces +x, best in place, with the markers left_ankle and right_ankle.

    Returns
    -------
    DataFrame
        One row an event, in the order of time: ``time_s``, between frames by a parabola; ``side``;
        ``event``, "heel strike" or "toe off"; ``marker`` that told it.

    Raises
    ------
    ValueError
        If the ankles are missing or nothing repeats.

    Examples
    --------
    >>> walker = ew.Walker(
    ...     ["pelvis", "left_ankle", "right_ankle"],
    ...     [[0, 0, 900], [0, 90, 80], [0, -90, 80]],
    ...     [[[0, 0, 0], [300, 0, 0], [-300, 0, 0]]],
    ...     [1],
    ...     [0],
    ...     1.0,
    ... )
    >>> gait_events(walker.trajectories(np.arange(0, 1, 0.01)))[["time_s", "side", "event"]]
       time_s   side        event
    0    0.25   left  heel strike
    1    0.25  right      toe off
    2    0.75   left      toe off
    3    0.75  right  heel strike

    """
    walk = check_trajectories(walk, complete=True)
    place = {name: index for index, name in enumerate(walk.marker.values.tolist())}
    if lacking := [f"{side}_ankle" for side in SIDES if f"{side}_ankle" not in place]:
        raise ValueError(
            f"Events are found from the ankles, and {lacking} are missing from "
            f"{sorted(place)}; map the markers with virtual_markers()."
        )
    frequency_hz = fundamental_frequency(walk)
    forward = walk.values[:, :, 0] - _pelvis(walk.values, place)[:, :1]
    time = walk.time.values
    apart = max(1, round(_SEPARATION / frequency_hz / np.diff(time).mean()))
    found = [
        (moment, side, event, marker)
        for side in SIDES
        for event, sign, point in ((HEEL_STRIKE, 1, "heel"), (TOE_OFF, -1, "toe"))
        for marker in [f"{side}_{point}" if f"{side}_{point}" in place else f"{side}_ankle"]
        for moment in _tops(sign * forward[:, place[marker]], time, apart)
    ]
    return pd.DataFrame(sorted(found), columns=["time_s", "side", "event", "marker"])


def _pelvis(positions: np.ndarray, place: dict[str, int]) -> np.ndarray:
    """Return the path of the pelvis, else of the middle of the hips, else of all markers."""
    for names in (["pelvis"], ["left_hip", "right_hip"]):
        if set(names) <= set(place):
            return positions[:, [place[name] for name in names]].mean(axis=1)
    return positions.mean(axis=1)


def _tops(values: np.ndarray, time: np.ndarray, apart: int) -> list[float]:
    """Return the times of maxima that are the highest within so many frames on either side."""
    found = []
    for frame in range(1, len(values) - 1):
        around = values[max(0, frame - apart) : frame + apart + 1]
        if values[frame] == around.max() and values[frame] > values[frame - 1]:
            before, top, after = values[frame - 1 : frame + 2]
            bend = before - 2 * top + after
            shift = 0.5 * (before - after) / bend if bend < 0 else 0.0
            found.append(float(time[frame] + shift * (time[frame + 1] - time[frame])))
    return found
