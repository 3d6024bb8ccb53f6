"""Flicker: samples that are off a marker's path for moments."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.ndimage import median_filter

LONGEST_S = 0.1
"""A marker that is off its path for longer has jumped: nothing tells which place is right."""

SUDDEN_MM = 30.0
SUDDEN_FACTOR = 4.0
"""A sudden step departs from those around it by more than `SUDDEN_MM` and this many times what nine
of ten steps of the marker do; those of real walks reach twice as much."""

_AROUND = 7
"""Steps whose median is the usual one: two of them may be sudden."""

_FEWEST = 8


class Flicker(NamedTuple):
    """Samples off the path, of shape (time, marker), and the frames of each marker's jumps."""

    off_path: np.ndarray
    jumps: list[list[int]]


def find_flicker(positions: np.ndarray, rate_hz: float) -> Flicker:
    """Return which samples of each marker are not part of its path, and where it jumps.

    A marker flickers if it leaves its path by a sudden step and returns by the opposite one within
    `LONGEST_S`; also if it reaches its path only after its first few frames, or leaves it before
    its last. Any other sudden step is a jump. Positions (time, marker, axis) are in millimetres.
    """
    longest = max(1, round(LONGEST_S * rate_hz))
    off_path = np.zeros(positions.shape[:2], dtype=bool)
    jumps: list[list[int]] = [[] for _ in range(positions.shape[1])]
    for marker in np.flatnonzero(~_calm(positions)):
        frames = np.flatnonzero(np.isfinite(positions[:, marker]).all(axis=1))
        if len(frames) >= _FEWEST:
            excursions, jumps[marker] = _excursions(positions[frames, marker], frames, longest)
            for first, last in excursions:
                off_path[frames[first:last], marker] = True
    return Flicker(off_path, jumps)


def _calm(positions: np.ndarray) -> np.ndarray:
    """Return which markers, always seen, have steps too even for any to be sudden."""
    if len(positions) <= _AROUND:
        return np.zeros(positions.shape[1], dtype=bool)
    steps = np.diff(positions, axis=0)
    calm = np.square(steps.max(axis=0) - steps.min(axis=0)).sum(axis=1) <= SUDDEN_MM**2
    calm[~calm] = _calm_around(steps[:, ~calm])
    return calm


def _calm_around(steps: np.ndarray) -> np.ndarray:
    most = least = steps
    for apart in (1, 2, 3):  # 2, 4, then 7 successive steps
        most = np.maximum(most[:-apart], most[apart:])
        least = np.minimum(least[:-apart], least[apart:])
    return np.square(most - least).sum(axis=2).max(axis=0) <= SUDDEN_MM**2


def _excursions(
    path: np.ndarray, frames: np.ndarray, longest: int
) -> tuple[list[tuple[int, int]], list[int]]:
    """Return where a path is left and reached again, and the frames of other sudden steps."""
    steps = np.diff(path, axis=0) / np.diff(frames)[:, None]
    sudden = steps - median_filter(steps, size=(_AROUND, 1), mode="nearest")
    size = np.linalg.norm(sudden, axis=1)
    least = SUDDEN_MM + SUDDEN_FACTOR * np.quantile(size, 0.9)
    places = (np.flatnonzero(size > least) + 1).tolist()
    excursions, jumps = [], []
    while places:
        here, there = places.pop(0), places[0] if places else None
        if there is not None and frames[there - 1] - frames[here] < longest:
            away, back = sudden[here - 1], sudden[there - 1]
            if np.linalg.norm(away + back) < (np.linalg.norm(away) + np.linalg.norm(back)) / 2:
                excursions.append((here, places.pop(0)))
                continue
        if frames[here - 1] - frames[0] < longest:
            excursions.append((0, here))
        elif frames[-1] - frames[here] < longest:
            excursions.append((here, len(frames)))
        else:
            jumps.append(int(frames[here]))
    return excursions, jumps
