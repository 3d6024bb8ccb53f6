"""Walks that turn: the slow heading of the body, and the walk unwound to a straight one."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from eigenwalker.core.kinematics import rotate_z
from eigenwalker.gait.body_points import facing_by_names
from eigenwalker.gait.steady_strides import find_steady_strides

TURNED = np.deg2rad(25)
"""A capture in which the heading changes by less is straight: in 175 acted straight walks it
changes by 6 degrees, at most 15."""

STRAIGHT_A_STRIDE = np.deg2rad(15)
"""Change of heading within a stride that makes it part of a turn."""

STRAIGHT_ON_THE_WHOLE = np.deg2rad(12)
"""Change of heading over all straight strides of a pass that is still straight."""

FLIPPED = np.deg2rad(60)
"""Nobody turns so far from one frame to the next: the heading is then unknown."""

FEWEST_MARKERS = 6
"""Without names, fewer markers swing too much to show the direction that a body faces."""

_ROUNDS = 10


def slow_heading(positions: np.ndarray, markers: Sequence[str], rate_hz: float) -> np.ndarray:
    """Return the direction (time,) that the body faces, in radians, averaged over a stride.

    Square to hips and shoulders, or, without these names, the turn that brings the markers nearest
    to their mean posture; all 0 where it is unknown or hardly changes.
    """
    straight = np.zeros(len(positions))
    facing = _facing(positions, list(markers))
    seen = np.isfinite(facing)
    if seen.sum() < 2:
        return straight
    frames = np.arange(len(positions))
    angle = np.interp(frames, frames[seen], np.unwrap(np.angle(facing[seen])))
    if np.ptp(angle) < TURNED or np.abs(np.diff(angle)).max() > FLIPPED:
        return straight
    whole = np.isfinite(positions).all(axis=(0, 2))
    if not whole.any():
        return straight
    relative = positions[:, whole] - positions[:, whole].mean(axis=1, keepdims=True)
    movement = rotate_z(relative, -angle).reshape(len(positions), -1)
    try:
        stride = rate_hz / find_steady_strides(movement, rate_hz).frequency_hz
    except ValueError:
        return straight
    heading = _mean_over(angle, round(stride))
    return heading if np.ptp(heading) >= TURNED else straight


def unwound(positions: np.ndarray, heading: np.ndarray) -> np.ndarray:
    """Return a walk whose body and steps are turned back by its slow heading.

    Where a marker is missing in a frame, all are missing in the result.
    """
    turn = heading[0] - heading
    centre = positions.mean(axis=1, keepdims=True)
    steps = np.nan_to_num(np.diff(centre, axis=0))
    path = np.cumsum(rotate_z(steps, (turn[1:] + turn[:-1]) / 2), axis=0)
    path = np.concatenate([np.zeros((1, 1, 3)), path]) + np.nan_to_num(centre[:1])
    return rotate_z(positions - centre, turn) + path


def straight_frames(heading: np.ndarray, stride: float) -> np.ndarray:
    """Return which frames belong to straight passes; `stride` is the frames of one stride."""
    return np.abs(np.gradient(heading)) * stride < STRAIGHT_A_STRIDE


def _facing(positions: np.ndarray, names: list[str]) -> np.ndarray:
    """Return the horizontal direction that the body faces in each frame, as a complex number."""
    facing = facing_by_names(positions, names)
    if facing is not None:
        return facing
    flat = positions[..., 0] + 1j * positions[..., 1]
    flat = flat[:, np.isfinite(flat).all(axis=0)]
    if flat.shape[1] < FEWEST_MARKERS:
        return np.full(len(positions), np.nan + 0j)
    flat = flat - flat.mean(axis=1, keepdims=True)
    posture = flat[len(flat) // 2]
    for _ in range(_ROUNDS):
        turn = flat @ posture.conj()
        posture = (flat * np.exp(-1j * np.angle(turn))[:, None]).mean(axis=0)
    return flat @ posture.conj()


def _mean_over(values: np.ndarray, width: int) -> np.ndarray:
    """Return running means over `width` frames, extrapolated linearly at both ends."""
    width = max(1, min(width, len(values) // 2))
    inner = np.convolve(values, np.full(width, 1 / width), "valid")
    first = (width - 1) / 2
    frames = np.arange(len(values))
    reach = min(width, len(inner) - 1)
    slopes = (inner[reach] - inner[0]) / reach, (inner[-1] - inner[-1 - reach]) / reach
    smooth = np.interp(frames, first + np.arange(len(inner)), inner)
    last = first + len(inner) - 1
    smooth += np.minimum(frames - first, 0) * slopes[0] + np.maximum(frames - last, 0) * slopes[1]
    return smooth
