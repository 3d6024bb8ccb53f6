"""Rotations between frames, and between two clips: normalised sums of quaternions."""

# scipy has no types:
# pyright: reportMissingTypeStubs=false, reportUnknownMemberType=false
from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation as Rotation  # pyright: ignore[reportMissingTypeStubs] - SciPy has none


def quaternions_at(vectors: np.ndarray, moments: np.ndarray, *, wraps: bool = False) -> np.ndarray:
    """Return rotations at moments between frames, by the shorter way.

    Rotation vectors have the shape (time, marker, 3), NaN where a marker has none; moments count in
    frames; the result are unit quaternions (moment, marker, 4). If it wraps, the first frame
    follows the last; otherwise the last is held.
    """
    quaternions = np.full((*vectors.shape[:2], 4), np.nan)
    known = np.isfinite(vectors).all(axis=2)
    quaternions[known] = Rotation.from_rotvec(vectors[known]).as_quat()
    n_frames = len(vectors)
    before = moments.astype(int)
    share = (moments - before)[:, None]
    if wraps:
        return between(quaternions[before % n_frames], quaternions[(before + 1) % n_frames], share)
    last = n_frames - 1
    return between(
        quaternions[np.minimum(before, last)], quaternions[np.minimum(before + 1, last)], share
    )


def between(start: np.ndarray, stop: np.ndarray, share: np.ndarray) -> np.ndarray:
    """Return quaternions (time, marker, 4) a share of the shorter way from start to stop."""
    dot = np.einsum("tmq,tmq->tm", start, stop)
    stop = np.where(dot[..., None] < 0, -stop, stop)
    mixed = (1 - share[..., None]) * start + share[..., None] * stop
    return mixed / np.linalg.norm(mixed, axis=2, keepdims=True)


def vectors_of(quaternions: np.ndarray) -> np.ndarray:
    """Return rotation vectors of quaternions; NaN where they are."""
    vectors = np.full((*quaternions.shape[:-1], 3), np.nan)
    known = np.isfinite(quaternions).all(axis=-1)
    vectors[known] = Rotation.from_quat(quaternions[known]).as_rotvec()
    return vectors


def product(left: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Return the rotations `right` followed by `left`, as quaternions (..., x y z w).

    Rotation of SciPy takes ten times as long for a few hundred frames.
    """
    x, y, z, w = np.moveaxis(left, -1, 0)
    a, b, c, d = np.moveaxis(right, -1, 0)
    return np.stack(
        [
            w * a + x * d + y * c - z * b,
            w * b - x * c + y * d + z * a,
            w * c + x * b - y * a + z * d,
            w * d - x * a - y * b - z * c,
        ],
        axis=-1,
    )


def from_euler(order: str, degrees: np.ndarray) -> np.ndarray:
    """Return quaternions (..., x y z w) of turns about the axes of the body, such as "ZXY".

    Examples
    --------
    >>> from_euler("ZX", np.array([90.0, 0.0])).round(3).tolist()
    [0.0, 0.0, 0.707, 0.707]
    """
    half = np.deg2rad(degrees) / 2
    turns = np.zeros((*half.shape, 4))
    turns[..., 3] = np.cos(half)
    for step, axis in enumerate(order):
        turns[..., step, "XYZ".index(axis)] = np.sin(half[..., step])
    result = turns[..., 0, :]
    for step in range(1, len(order)):
        result = product(result, turns[..., step, :])
    return result
