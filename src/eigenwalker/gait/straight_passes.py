"""The straight pass whose strides are taken, or a turning walk made straight."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr

from eigenwalker.core.runs import runs_of_true
from eigenwalker.gait.frequency import NoStrideError
from eigenwalker.gait.gaps import Gap
from eigenwalker.gait.steady_strides import SteadyStrides, body_relative, find_steady_strides
from eigenwalker.gait.turning import STRAIGHT_ON_THE_WHOLE, slow_heading, straight_frames, unwound

FEWEST_STRIDES = 0.9
"""With less than about a stride nothing repeats, and a walk cannot be separated from its drift."""

ENOUGH_STRAIGHT = 2
"""Straight strides that are taken however many more a turning walk has on its curves."""


class StraightPass(NamedTuple):
    """The steady strides of a capture, and its positions in which they go straight on.

    ``positions`` are those of the whole capture, unwound where ``heading`` is not 0: the slow
    heading of each frame in radians. ``n_passes`` counts the straight passes from which the one
    with most strides was taken; it is 1 for a capture without turns and 0 for one that is unwound.
    """

    positions: np.ndarray
    strides: SteadyStrides
    heading: np.ndarray
    n_passes: int


def find_straight_pass(
    walk: xr.DataArray, positions: np.ndarray, gaps: list[Gap], rate_hz: float
) -> StraightPass:
    """Return the steady strides of a capture: straight ones if there are some, else unwound ones.

    Where the heading changes, the straight pass with most strides is taken if it has two or
    more, or half as many as the whole walk with its curves; otherwise the heading is unwound.

    `walk` gives names and times; its positions have short gaps filled, and `gaps` are left. Raises
    ValueError if there is less than about a stride, or a gap between the strides.
    """
    complete = np.atleast_1d(np.isfinite(positions).all(axis=(1, 2)))
    heading = slow_heading(positions, walk.marker.values.tolist(), rate_hz)
    ahead = np.zeros(len(positions))
    if not heading.any():
        strides = _most_strides(walk, positions, gaps, rate_hz, complete)
        return StraightPass(positions, strides, ahead, 1)
    along = unwound(positions, heading)
    curved = _most_strides(walk, along, gaps, rate_hz, complete)
    stride = rate_hz / curved.frequency_hz
    straight = complete & straight_frames(heading, stride)
    try:
        strides = _most_strides(walk, positions, gaps, rate_hz, straight)
    except ValueError:
        return StraightPass(along, curved, heading, 0)
    enough = min(ENOUGH_STRAIGHT, curved.count(rate_hz) / 2)
    turned = np.ptp(heading[strides.start : strides.stop])
    if strides.count(rate_hz) < enough or turned > STRAIGHT_ON_THE_WHOLE:
        return StraightPass(along, curved, heading, 0)
    passes = [stop - start for start, stop in runs_of_true(straight)]
    n_passes = sum(length >= FEWEST_STRIDES * stride for length in passes)
    return StraightPass(positions, strides, ahead, max(1, n_passes))


def _most_strides(
    walk: xr.DataArray,
    positions: np.ndarray,
    gaps: list[Gap],
    rate_hz: float,
    usable: np.ndarray,
) -> SteadyStrides:
    """Return the most steady strides that a run of usable frames holds."""
    runs, problems = [], []
    for start, stop in runs_of_true(usable):
        try:
            run = find_steady_strides(body_relative(positions[start:stop]), rate_hz)
        except ValueError as error:
            problems.append((stop - start, str(error)))
        else:
            if run.count(rate_hz) >= FEWEST_STRIDES:
                runs.append(run._replace(start=start + run.start, stop=start + run.stop))
    if not runs:
        raise NoStrideError(_no_stride(walk, gaps, problems))
    best = max(runs, key=lambda run: run.count(rate_hz))
    seen = np.atleast_1d(np.isfinite(positions).any(axis=(1, 2)))
    if within := _gaps_within(best, runs, gaps, rate_hz, seen):
        raise ValueError(
            f"Gaps in the midst of the walk are too long to be filled: {_listed(walk, within)}. "
            "Fill them where the capture was made, cut the capture before or after them, or leave "
            "the markers out."
        )
    return best


def _gaps_within(
    best: SteadyStrides,
    runs: list[SteadyStrides],
    gaps: list[Gap],
    rate_hz: float,
    seen: np.ndarray,
) -> list[Gap]:
    """Return gaps, however long, that alone separate the best run of strides from another.

    Both runs reach up to such a gap, but for what trimming to whole strides leaves. A body of which
    no marker was seen in the middle of it had left the room between two passes: that is no gap.
    """
    trimmed = 2 * rate_hz / best.frequency_hz
    between = [
        sorted([best.start, best.stop, run.start, run.stop])[1:3] for run in runs if run is not best
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


def _no_stride(walk: xr.DataArray, gaps: list[Gap], problems: list[tuple[int, str]]) -> str:
    if gaps:
        return (
            "No stride is seen whole: the longest stretch in which all markers are there is too "
            f"short, as these are missing: {_listed(walk, gaps)}. Leave out markers that were "
            "hardly seen, or fill their gaps."
        )
    return max(problems)[1] if problems else "No stride repeats here: this is no steady walk."


def _listed(walk: xr.DataArray, gaps: list[Gap], most: int = 5) -> str:
    time = walk.time.values
    longest = sorted(gaps, key=lambda gap: gap.start - gap.stop)[:most]
    named = ", ".join(
        f"{walk.marker.values[gap.marker]} from {time[gap.start]:.2f} to "
        f"{time[gap.stop - 1]:.2f} s (frames {gap.start} to {gap.stop - 1})"
        for gap in longest
    )
    return named + (f" and {len(gaps) - most} more" if len(gaps) > most else "")
