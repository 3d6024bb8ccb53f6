"""Left and right labels that change places, found from where both markers were before."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

SWAP_MM = 25.0
"""Two markers that change places seem to jump by more than this each; nearer ones are the same."""

CLEARER = 3.0
"""How many times nearer to the expected places the markers are with exchanged labels."""

CLEAR_SIDE_MM = 20.0
"""Mean distance across the body from which on a pair shows which of its markers is on the left."""

TOGETHER = 0.95
"""Share of the frames in which two pairs agree if they change places together."""

RIGID = 0.05
"""Coefficient of variation of the distance of two markers on one rigid part of the body; that of
elbows, which swing against the legs, is 0.05 to 0.1."""

TRAVEL_MM = 1000.0
"""Distance travelled from which on the direction of progress is the front of the body."""


def exchanged_sides(positions: np.ndarray, pairs: Sequence[tuple[int, int]]) -> np.ndarray:
    """Return where the labels of each pair have to be exchanged for both paths to be smooth.

    Either the frames found or all others can be exchanged. The left marker has to be on the side of
    the other left markers. Where all pairs change places, most labels stay as they are, or, if the
    body moves through the room, it has to walk forwards.

    Positions (time, marker, axis) are NaN where a marker was not seen; each pair holds the index of
    a left marker and of its right counterpart. The result has the shape (time, pair).
    """
    exchanged = np.zeros((len(positions), len(pairs)), dtype=bool)
    for number in np.flatnonzero(_within_reach(positions, np.array(pairs))).tolist():
        left, right = pairs[number]
        exchanged[:, number] = _since_exchanged(positions[:, left], positions[:, right])
    swapped = exchanged.any(axis=0)
    if not swapped.any():
        return exchanged
    across = np.stack([positions[:, left] - positions[:, right] for left, right in pairs], axis=1)
    across = (across[..., 0] + 1j * across[..., 1]) * np.where(exchanged, -1, 1)
    across = np.where(np.isfinite(across), across, 0)
    if swapped.all():
        usual = _most_rigid(across).sum(axis=1)
        return exchanged ^ _goes_backwards(positions, usual, exchanged.mean())
    sides = _sides(across[:, swapped], _most_rigid(across[:, ~swapped]).sum(axis=1))
    exchanged[:, swapped] = _decided(exchanged[:, swapped], sides)
    return exchanged


def _within_reach(positions: np.ndarray, pairs: np.ndarray) -> np.ndarray:
    """Return which pairs may change places: their steps together exceed their distance."""
    steps = np.diff(positions, axis=0)
    farthest = np.sqrt(np.einsum("tma,tma->tm", steps, steps).max(axis=0))[pairs].sum(axis=1)
    across = positions[:, pairs[:, 0]] - positions[:, pairs[:, 1]]
    nearest = np.sqrt(np.einsum("tpa,tpa->tp", across, across).min(axis=0))
    return ~(farthest < nearest + SWAP_MM)  # also where markers were not always seen


def _decided(exchanged: np.ndarray, sides: np.ndarray) -> np.ndarray:
    """Return where labels are exchanged, by the side of each pair's left marker.

    A pair with no clear side, such as heels, follows those that change places at the same frames.
    """
    clear = np.abs(sides) > CLEAR_SIDE_MM
    decided = exchanged ^ (clear & (sides < 0))
    for pair in np.flatnonzero(~clear):
        own = exchanged[:, [pair]]
        alike = (decided[:, clear] == own).mean(axis=0)
        same_frames = alike[np.abs(alike - 0.5) > TOGETHER - 0.5]
        decided[:, pair] ^= same_frames[0] < 0.5 if len(same_frames) else own.mean() > 0.5
    return decided


def _since_exchanged(left: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Return where the labels of two markers differ from those in the first frame."""
    exchanged = np.zeros(len(left), dtype=bool)
    frames = np.flatnonzero(np.isfinite(left).all(axis=1) & np.isfinite(right).all(axis=1))
    one, other = left[frames], right[frames]
    straight = _distance(one[1:], one[:-1]) + _distance(other[1:], other[:-1])
    crossed = _distance(one[1:], other[:-1]) + _distance(other[1:], one[:-1])
    for at in (np.flatnonzero(straight - crossed > 2 * SWAP_MM) + 1).tolist():
        here = _expected(one, frames, at), _expected(other, frames, at)
        straight_on = _distance(one[at], here[0]) + _distance(other[at], here[1])
        crossed_over = _distance(one[at], here[1]) + _distance(other[at], here[0])
        if straight_on > CLEARER * crossed_over:
            one[at:], other[at:] = other[at:].copy(), one[at:].copy()
            exchanged[frames[at] :] ^= True
    return exchanged


def _expected(path: np.ndarray, frames: np.ndarray, at: int) -> np.ndarray:
    """Return the next place of a path at the velocity of its last two frames."""
    if at < 2:
        return path[at - 1]
    speed = (path[at - 1] - path[at - 2]) / (frames[at - 1] - frames[at - 2])
    return path[at - 1] + speed * (frames[at] - frames[at - 1])


def _most_rigid(across: np.ndarray) -> np.ndarray:
    """Return the lines across the body that hardly change length: hips, shoulders, head."""
    lengths = np.ma.masked_equal(np.abs(across), 0)
    variation = (lengths.std(axis=0) / lengths.mean(axis=0)).filled(np.inf)
    return across[:, variation <= max(RIGID, variation.min())]


def _sides(across: np.ndarray, usual: np.ndarray) -> np.ndarray:
    """Return how far each pair's left marker is to the left of its right one, in the mean."""
    known = (across != 0) & (usual != 0)[:, None]
    left = np.real(across * np.conj(usual)[:, None]) / np.maximum(np.abs(usual), 1e-9)[:, None]
    return np.where(known, left, 0).sum(axis=0) / np.maximum(known.sum(axis=0), 1)


def _goes_backwards(positions: np.ndarray, across: np.ndarray, share: float) -> bool:
    """Return whether a body walks backwards; in place, whether most labels were exchanged."""
    places = np.ma.masked_invalid(positions[..., 0] + 1j * positions[..., 1])
    steps = np.diff(places.mean(axis=1)).filled(0)
    forwards = -1j * across / np.maximum(np.abs(across), 1e-9)
    progress = float(np.real(steps * np.conj(forwards[1:])).sum())
    return progress < 0 if abs(progress) > TRAVEL_MM else share > 0.5


def _distance(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    return np.linalg.norm(one - other, axis=-1)
