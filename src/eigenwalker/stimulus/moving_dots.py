"""A figure as dots with names whose positions are a function of time."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from eigenwalker.core.skeleton import Skeleton
from eigenwalker.core.walker import Walker

N_SAMPLES = 64
"""Moments of the period over which means are taken: exact up to the 31st harmonic."""


class Moments(NamedTuple):
    """Dots at several moments.

    Parameters
    ----------
    positions : array of shape (time, dot, 3)
        Millimetres in the figure's own frame: x forward, y left, z up. NaN where not known.
    visible : array of bool of shape (time, dot)

    See Also
    --------
    eigenwalker.Stimulus.play : Dots of a whole stimulus.
    """

    positions: np.ndarray
    visible: np.ndarray


@dataclass(frozen=True, eq=False)
class MovingDots:
    """A figure as a function of time.

    Parameters
    ----------
    skeleton : Skeleton
        Names of the dots, which are joined, and which are left-right counterparts.
    at : callable
        Takes seconds, an array of shape (time,), and returns `Moments`.
    period_s : float
        Seconds after which it repeats; of sampled trajectories, how long they last.
    blur_mm, blur_px : float
        Standard deviation of each dot's blob, at the walker's scale or in the picture; 0 for discs.

    See Also
    --------
    Moments : Its dots, played.
    """

    skeleton: Skeleton
    at: Callable[[np.ndarray], Moments]
    period_s: float
    blur_mm: float = 0.0
    blur_px: float = 0.0

    def blob_px(self, px_per_mm: float) -> float:
        """Return the standard deviation of each dot's blob in pixels; 0 for discs."""
        return self.blur_px + self.blur_mm * px_per_mm

    @property
    def dots(self) -> tuple[str, ...]:
        """Names of the dots."""
        return self.skeleton.markers

    def moved(self, change: Callable[[np.ndarray, np.ndarray], np.ndarray]) -> MovingDots:
        """Return dots whose positions are a function of these positions and the time."""

        def at(time: np.ndarray) -> Moments:
            positions, visible = self.at(time)
            return Moments(change(positions, time), visible)

        return replace(self, at=at)

    @property
    def sample_times(self) -> np.ndarray:
        """Sixty-four moments, evenly spaced over the period from 0 s."""
        return np.arange(N_SAMPLES) * self.period_s / N_SAMPLES

    @cached_property
    def mean(self) -> np.ndarray:
        """Mean place of each dot: array of shape (dot, 3).

        Over `sample_times`, without those at which the dot's place is not known.
        """
        positions = self.at(self.sample_times).positions
        known = ~np.isnan(positions)
        total = np.where(known, positions, 0.0).sum(axis=0)
        count = known.sum(axis=0)
        return np.divide(total, count, out=np.full(total.shape, np.nan), where=count > 0)

    @cached_property
    def middle(self) -> np.ndarray:
        """Middle between the smallest and the largest mean place on each axis: array (3,)."""
        seen = self.mean[~np.isnan(self.mean).any(axis=1)]
        return (seen.min(axis=0) + seen.max(axis=0)) / 2 if len(seen) else np.zeros(3)


def parents_of(skeleton: Skeleton) -> dict[int, int]:
    """Return for each marker the one that carries it, from the root outwards, by their numbers.

    The root is ``pelvis``, or the first marker where there is none; its parent is -1, as that of
    markers that nothing joins to it. Markers are reached level by level, segments in their order.
    """
    markers = skeleton.markers
    links = [link for a, b in skeleton.segment_ends for link in ((a, b), (b, a))]
    root = markers.index("pelvis") if "pelvis" in markers else 0
    parents = {root: -1}
    waiting = deque([root])
    while waiting:
        carrier = waiting.popleft()
        for one, other in links:
            if one == carrier and other not in parents:
                parents[other] = carrier
                waiting.append(other)
    return parents | {marker: -1 for marker in range(len(markers)) if marker not in parents}


def walking(walker: Walker, skeleton: Skeleton) -> MovingDots:
    """Return a walker as moving dots; its first phase is 0 at 0 s where the phases say so."""
    if walker.markers != skeleton.markers:
        skeleton = Skeleton(walker.markers)

    def at(time: np.ndarray) -> Moments:
        positions = walker.positions(2 * np.pi * walker.frequency_hz * time)
        return Moments(positions, np.ones(positions.shape[:2], dtype=bool))

    return MovingDots(skeleton, at, walker.period_s)


def sampled(skeleton: Skeleton, samples: np.ndarray, rate_hz: float, *, repeat: bool) -> MovingDots:
    """Return sampled trajectories as a moving figure, a straight line between frames.

    Before the first and after the last frame it holds still, or starts again one frame after the
    last. Between two frames of which one lacks a dot, the dot is not visible.
    """
    n_frames = len(samples)
    missing = np.asarray(np.isnan(samples).any(axis=2))
    known = np.where(missing[..., None], np.nan, samples)

    def at(time: np.ndarray) -> Moments:
        frame = time * rate_hz
        if repeat:
            frame = frame - np.floor(frame / n_frames) * n_frames
        else:
            frame = np.clip(frame, 0, n_frames - 1)
        before = np.minimum(np.floor(frame).astype(int), n_frames - 1)
        after = (before + 1) % n_frames if repeat else np.minimum(before + 1, n_frames - 1)
        after = np.where(frame == before, before, after)
        share = (frame - before)[:, None, None]
        positions = known[before] * (1 - share) + known[after] * share
        return Moments(positions, np.asarray(~np.isnan(positions).any(axis=2)))

    return MovingDots(skeleton, at, (n_frames if repeat else max(n_frames - 1, 1)) / rate_hz)
