"""Gaps in the paths of markers: which are short enough to be filled, and where frames are whole."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

MAX_GAP_S = 0.15
"""Longest gap that is filled. A cubic spline is then off by some 5 mm at a swinging ankle (an
eighth of a stride); over twice the time it would be ten times as much."""

_NEIGHBOURS = 12
"""Frames on either side that a spline rests on."""


class Gap(NamedTuple):
    """Frames ``start`` to ``stop`` (not included) in which a marker was not seen."""

    marker: int
    start: int
    stop: int


def runs_of(flags: np.ndarray) -> list[tuple[int, int]]:
    """Return where runs of True start and stop.

    Examples
    --------
    >>> runs_of(np.array([True, False, True, True]))
    [(0, 1), (2, 4)]

    """
    edges = np.flatnonzero(np.diff(np.concatenate([[0], flags.astype(np.int8), [0]])))
    return [(int(start), int(stop)) for start, stop in zip(edges[::2], edges[1::2], strict=True)]


def find_gaps(positions: np.ndarray) -> list[Gap]:
    """Return all gaps in positions of shape (time, marker, axis), in the order of markers."""
    missing = np.atleast_2d(np.isnan(positions).any(axis=2).T)
    return [
        Gap(marker, start, stop)
        for marker, flags in enumerate(missing)
        if flags.any()
        for start, stop in runs_of(flags)
    ]


def fill_short_gaps(
    positions: np.ndarray, rate_hz: float, max_gap_s: float = MAX_GAP_S
) -> tuple[np.ndarray, list[Gap]]:
    """Return positions with short gaps filled by cubic splines, and the gaps that are left.

    Gaps at the ends of the capture are never filled.

    Parameters
    ----------
    positions : array of shape (time, marker, axis)
        NaN where a marker was not seen.
    rate_hz : float
        Frames a second.
    max_gap_s : float
        Longest gap that is filled, in seconds.

    Returns
    -------
    filled : array of shape (time, marker, axis)
    left : list of Gap

    Examples
    --------
    >>> path = np.linspace(0, 30, 31)[:, None, None] * [[1, 0, 0]]
    >>> path[10:12] = np.nan
    >>> filled, left = fill_short_gaps(path, 100)
    >>> filled[10:12, 0, 0].round(9).tolist(), left
    ([10.0, 11.0], [])

    """
    n_frames = len(positions)
    longest = round(max_gap_s * rate_hz)
    gaps = find_gaps(positions)
    short = [
        gap
        for gap in gaps
        if gap.start > 0 and gap.stop < n_frames and gap.stop - gap.start <= longest
    ]
    filled = np.array(positions)
    for gap in short:
        around = slice(max(0, gap.start - _NEIGHBOURS), gap.stop + _NEIGHBOURS)
        seen = np.arange(n_frames)[around]
        seen = seen[~np.isnan(positions[around, gap.marker]).any(axis=1)]
        wanted = np.arange(gap.start, gap.stop)
        filled[wanted, gap.marker] = CubicSpline(seen, positions[seen, gap.marker])(wanted)
    return filled, [gap for gap in gaps if gap not in set(short)]
