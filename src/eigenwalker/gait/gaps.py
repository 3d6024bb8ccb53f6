"""Gaps in the paths of markers, and splines through the short ones."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from eigenwalker.core.runs import runs_of_true

MAX_GAP_S = 0.15
"""Longest gap that is filled. A cubic spline is then off by some 5 mm at a swinging ankle (an
eighth of a stride); over twice the time it would be ten times as much."""

_NEIGHBOURS = 12
"""Frames on either side that a spline passes through."""


class Gap(NamedTuple):
    """Frames ``start`` to ``stop`` (not included) in which a marker (its index) was not seen."""

    marker: int
    start: int
    stop: int


def find_gaps(positions: np.ndarray) -> list[Gap]:
    """Return all gaps in positions of shape (time, marker, axis), in the order of markers."""
    missing = np.atleast_2d(np.isnan(positions).any(axis=2))
    return [
        Gap(marker, start, stop)
        for marker in np.flatnonzero(missing.any(axis=0)).tolist()
        for start, stop in runs_of_true(missing[:, marker])
    ]


def fill_short_gaps(
    positions: np.ndarray, rate_hz: float, max_gap_s: float = MAX_GAP_S
) -> tuple[np.ndarray, list[Gap]]:
    """Return positions with short inner gaps filled by cubic splines, and other gaps."""
    n_frames = len(positions)
    longest = round(max_gap_s * rate_hz)
    filled, left = np.array(positions), []
    for gap in find_gaps(positions):
        if gap.start == 0 or gap.stop == n_frames or gap.stop - gap.start > longest:
            left.append(gap)
            continue
        around = np.arange(max(0, gap.start - _NEIGHBOURS), min(gap.stop + _NEIGHBOURS, n_frames))
        seen = around[~np.isnan(positions[around, gap.marker]).any(axis=1)]
        missing = np.arange(gap.start, gap.stop)
        filled[missing, gap.marker] = CubicSpline(seen, positions[seen, gap.marker])(missing)
    return filled, left
