"""Feet that stand: when, how fast the body then travels, and legs that keep them in place."""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np

LOW_MM = 15.0
"""Height above its lowest at which the ball of a foot may stand."""
STILL = 0.5
"""Most speed of a standing ball over the ground, as a share of the body's."""
MIN_STANCE_S, MAX_GAP_S = 0.12, 0.07
STRETCHED = 0.9995
"""How far a leg may be stretched, as a share of its length."""


class Contacts(NamedTuple):
    """When the balls of both feet stand, (time, foot), and the body's speed then, (2,), mm/s."""

    standing: np.ndarray
    velocity: np.ndarray


def find_contacts(balls: np.ndarray, rate_hz: float) -> Contacts:
    """Return when balls of feet (time, foot, 3) stand, of a body that walks in place or forward."""
    moved = np.gradient(balls[..., :2], 1 / rate_hz, axis=0)
    low = balls[..., 2] < np.quantile(balls[..., 2], 0.05, axis=0) + LOW_MM
    standing, velocity = low, -np.median(moved[low], axis=0)
    for _ in range(3):
        over_ground = np.linalg.norm(moved + velocity, axis=2)
        standing = low & (over_ground < STILL * np.linalg.norm(velocity) + 100)
        standing = np.stack([_steady(foot, rate_hz) for foot in standing.T], axis=1)
        if standing.any(axis=0).all():  # both feet count alike
            velocity = -np.mean([moved[:, f][standing[:, f]].mean(axis=0) for f in (0, 1)], axis=0)
    return Contacts(standing, velocity)


def runs_of(standing: np.ndarray) -> list[tuple[int, int]]:
    """Return first frames of runs, and the frames after their last."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], standing.astype(int), [0]])))
    return list(zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True))


def _steady(standing: np.ndarray, rate_hz: float) -> np.ndarray:
    """Close short gaps in a foot's stances, then leave out short ones."""
    closed = standing.copy()
    for first, end in runs_of(~standing):
        if first > 0 and end < len(standing) and end - first <= MAX_GAP_S * rate_hz:
            closed[first:end] = True
    for first, end in runs_of(closed):
        if end - first < MIN_STANCE_S * rate_hz:
            closed[first:end] = False
    return closed


def plant(ball: np.ndarray, standing: np.ndarray, low_mm: float) -> np.ndarray:
    """Return how a foot must be moved, (time, 3), so that its ball stays in place while it stands.

    `ball` (time, 3) is where it is over the ground. Between stances it comes smoothly from one
    correction to the next.
    """
    shift = np.zeros_like(ball)
    runs = runs_of(standing)
    for first, end in runs:
        place = np.array([*ball[first:end, :2].mean(axis=0), low_mm])
        shift[first:end] = place - ball[first:end]
    for (_, before), (after, _) in pairwise(runs):
        share = np.arange(1, after - before + 1)[:, None] / (after - before + 1)
        smooth = share * share * (3 - 2 * share)
        shift[before:after] = shift[before - 1] * (1 - smooth) + shift[after] * smooth
    if runs:
        shift[: runs[0][0]] = shift[runs[0][0]]
        shift[runs[-1][1] :] = shift[runs[-1][1] - 1]
    return shift


def bent_leg(
    hip: np.ndarray, knee: np.ndarray, ankle: np.ndarray, target: np.ndarray, forward: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return knee and ankle (time, 3) of a leg that reaches for a target with its own bones.

    The knee stays on the side of the leg on which it was.
    """
    thigh = np.linalg.norm(knee - hip, axis=1, keepdims=True)
    shank = np.linalg.norm(ankle - knee, axis=1, keepdims=True)
    way = target - hip
    length = np.linalg.norm(way, axis=1, keepdims=True)
    along = way / length
    reach = np.clip(length, np.abs(thigh - shank) + 1, STRETCHED * (thigh + shank))
    aside = knee - hip + thigh / 20 * forward  # which decides where the leg is straight
    aside = aside - along * np.sum(aside * along, axis=1, keepdims=True)
    aside = aside / np.linalg.norm(aside, axis=1, keepdims=True)
    ahead = (thigh**2 - shank**2 + reach**2) / (2 * reach)
    out = np.sqrt(np.maximum(thigh**2 - ahead**2, 0))
    return hip + along * ahead + aside * out, hip + along * reach
