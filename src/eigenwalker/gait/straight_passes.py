"""Which strides of a capture are taken: a straight pass, or a turning walk made straight."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr

from eigenwalker.gait.frequency import NoStrideError
from eigenwalker.gait.gaps import Gap, runs_of
from eigenwalker.gait.steady_strides import SteadyPart, body_relative, steady_part
from eigenwalker.gait.turning import STRAIGHT_ON_THE_WHOLE, slow_heading, straight_frames, unwound

FEWEST_STRIDES = 0.9
"""Below about one stride nothing repeats, and a walk cannot be told from its drift."""

ENOUGH_STRAIGHT = 2
"""Straight strides that are taken however many more a turning walk has on its curves."""


class Passage(NamedTuple):
    """The steady part of a capture, and how its heading was dealt with.

    ``positions`` are those of the whole capture, made straight where ``heading`` is not 0, the
    slow heading of each frame in radians. ``straight_passes`` counts the passes from which the
    one with most strides was taken; it is 1 for a capture without turns and 0 where the heading
    was unwound.
    """

    positions: np.ndarray
    part: SteadyPart
    heading: np.ndarray
    straight_passes: int


def find_passage(
    walk: xr.DataArray, positions: np.ndarray, gaps: list[Gap], rate_hz: float
) -> Passage:
    """Return the steady strides of a capture: straight ones if there are some, else unwound ones.

    Where the heading changes, the straight pass with most strides is taken if it has two or
    more, or half as many as the whole walk with its curves; otherwise the heading is unwound.

    Parameters
    ----------
    walk : DataArray of shape (time, marker, axis)
        The capture, for its names and times.
    positions : array of shape (time, marker, axis)
        Its positions, short gaps filled.
    gaps : list of Gap
        Gaps that are left.
    rate_hz : float
        Frames a second.

    Returns
    -------
    Passage

    Raises
    ------
    ValueError
        If there is less than about a stride, or a gap in the midst of it.

    """
    complete = np.atleast_1d(np.isfinite(positions).all(axis=(1, 2)))
    heading = slow_heading(positions, walk.marker.values.tolist(), rate_hz)
    ahead = np.zeros(len(positions))
    if not heading.any():
        part = _steady_run(walk, positions, gaps, rate_hz, complete)
        return Passage(positions, part, ahead, 1)
    along = unwound(positions, heading)
    curved = _steady_run(walk, along, gaps, rate_hz, complete)
    stride = rate_hz / curved.frequency_hz
    straight = complete & straight_frames(heading, stride)
    try:
        part = _steady_run(walk, positions, gaps, rate_hz, straight)
    except ValueError:
        return Passage(along, curved, heading, 0)
    wanted = min(ENOUGH_STRAIGHT, curved.strides(rate_hz) / 2)
    turned = np.ptp(heading[part.start : part.stop])
    if part.strides(rate_hz) < wanted or turned > STRAIGHT_ON_THE_WHOLE:
        return Passage(along, curved, heading, 0)
    passes = [stop - start for start, stop in runs_of(straight)]
    n_passes = sum(length >= FEWEST_STRIDES * stride for length in passes)
    return Passage(positions, part, ahead, max(1, n_passes))


def _steady_run(
    walk: xr.DataArray,
    positions: np.ndarray,
    gaps: list[Gap],
    rate_hz: float,
    usable: np.ndarray,
) -> SteadyPart:
    """Return the steady part with most strides among the runs of frames that can be used."""
    parts, complaints = [], []
    for start, stop in runs_of(usable):
        try:
            part = steady_part(body_relative(positions[start:stop]), rate_hz)
        except ValueError as error:
            complaints.append((stop - start, str(error)))
        else:
            parts.append(part._replace(start=start + part.start, stop=start + part.stop))
    parts = [part for part in parts if part.strides(rate_hz) >= FEWEST_STRIDES]
    if not parts:
        raise NoStrideError(_no_stride(walk, gaps, complaints))
    best = max(parts, key=lambda part: part.strides(rate_hz))
    seen = np.atleast_1d(np.isfinite(positions).any(axis=(1, 2)))
    if within := _gaps_within(best, parts, gaps, rate_hz, seen):
        raise ValueError(
            f"Gaps in the midst of the walk are too long to be filled: {_told(walk, within)}. Fill "
            "them where the capture was made, cut the capture before or after them, or leave "
            "the markers out."
        )
    return best


def _gaps_within(
    best: SteadyPart,
    parts: list[SteadyPart],
    gaps: list[Gap],
    rate_hz: float,
    seen: np.ndarray,
) -> list[Gap]:
    """Return gaps that alone part the best steady part from another, however long they are.

    Both parts reach up to such a gap, but for what trimming to whole strides leaves. Who was not
    seen at all in the middle of it had left the room between two passes, which is no gap.
    """
    trimmed = 2 * rate_hz / best.frequency_hz
    between = [
        sorted([best.start, best.stop, part.start, part.stop])[1:3]
        for part in parts
        if part is not best
    ]
    return [
        gap
        for gap in gaps
        if seen[(gap.start + gap.stop) // 2]
        and any(
            low - 1 <= gap.start
            and gap.stop <= high + 1
            and (high - low) - (gap.stop - gap.start) < trimmed
            for low, high in between
        )
    ]


def _no_stride(walk: xr.DataArray, gaps: list[Gap], complaints: list[tuple[int, str]]) -> str:
    if gaps:
        return (
            "No stride is seen whole: the longest stretch in which all markers are there is too "
            f"short, as these are missing: {_told(walk, gaps)}. Leave out markers that were "
            "hardly seen, or fill their gaps."
        )
    return max(complaints)[1] if complaints else "No stride repeats here: this is no steady walk."


def _told(walk: xr.DataArray, gaps: list[Gap], most: int = 5) -> str:
    time = walk.time.values
    told = [
        f"{walk.marker.values[gap.marker]} from {time[gap.start]:.2f} to "
        f"{time[gap.stop - 1]:.2f} s (frames {gap.start} to {gap.stop - 1})"
        for gap in sorted(gaps, key=lambda gap: gap.start - gap.stop)[:most]
    ]
    return ", ".join(told) + (f" and {len(gaps) - most} more" if len(gaps) > most else "")
