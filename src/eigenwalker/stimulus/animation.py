"""A figure of a stimulus for animation: constant bones, and a root that travels."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr

from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.trajectories import label_trajectories
from eigenwalker.io.writers.bvh import constant_bones
from eigenwalker.stimulus.stimulus import Stimulus

ANKLES = ("left_ankle", "right_ankle")
SOFT_MM = 8.0
"""Difference in height of the ankles over which the weight passes from foot to foot."""
MAX_ERROR_MM = 100.0
"""Root mean square by which bones of constant length may miss the dots."""


class FootSlide(NamedTuple):
    """How far a figure's standing feet slide.

    Mean horizontal speed of the standing ankle, how far it travels in a stance on average, and its
    speed with the root at a constant speed, as on a treadmill.
    """

    mean_mm_s: float
    per_stance_mm: float
    before_mm_s: float

    def __str__(self) -> str:
        return (
            f"Standing feet slide at {self.mean_mm_s:.0f} mm/s, {self.per_stance_mm:.0f} mm a "
            f"stance ({self.before_mm_s:.0f} mm/s at constant speed)."
        )


class Animation(NamedTuple):
    """A figure with constant bones that walks over ground: joints (time, marker, axis), mm."""

    walk: xr.DataArray
    slide: FootSlide


def animated(stimulus: Stimulus, *, figure: int = 0, rate_hz: float | None = None) -> Animation:
    """Return a figure as its chain of transforms leaves it, with bones of constant length.

    The root travels so that the standing foot stays where it is: at each moment it moves against
    the velocity of the lower ankle, or of a weighted mean of both while their heights differ by
    less than 8 mm. A figure whose ankles are above its pelvis, as when inverted, does not travel.
    Raises ValueError if the figure lacks joints, or moves as no body with bones does.
    """
    rate_hz = rate_hz or stimulus.timing.rate_hz
    n_frames = max(round(stimulus.timing.duration_s * rate_hz), 2)
    played = stimulus.play(np.arange(n_frames) / rate_hz)
    mine = np.flatnonzero(played.figures == figure)
    names = [played.dots[dot] for dot in mine]
    if lacking := [joint for joint in JOINTS.markers if joint not in names]:
        raise ValueError(
            f"Animation takes a figure with the 15 joints; figure {figure} lacks {lacking}. Leave "
            "out limb dots, or write .csv or .npz."
        )
    keep = [mine[names.index(joint)] for joint in JOINTS.markers]
    seen = label_trajectories(
        played.positions[:, keep], markers=list(JOINTS.markers), rate_hz=rate_hz
    )
    walk = constant_bones(seen)
    error_mm = float(np.sqrt(np.mean(np.sum((walk.values - seen.values) ** 2, axis=2))))
    if error_mm > MAX_ERROR_MM:
        raise ValueError(
            f"This figure does not move as a body with bones: constant ones miss its joints by "
            f"{error_mm:.0f} mm. Leave out what takes the body apart, or write .csv or .npz."
        )
    return _travelling(walk, rate_hz)


def _travelling(walk: xr.DataArray, rate_hz: float) -> Animation:
    """The walk with a root that keeps its standing foot in place."""
    places = walk.values
    ankles = places[:, [JOINTS.index(name) for name in ANKLES]]
    share = 1 / (1 + np.exp(np.clip((ankles[:, 0, 2] - ankles[:, 1, 2]) / SOFT_MM * 4, -50, 50)))
    weights = np.stack([share, 1 - share], axis=1)
    moved = np.diff(ankles[..., :2], axis=0)
    between = (weights[1:] + weights[:-1]) / 2
    step = -np.sum(moved * between[..., None], axis=1)
    if places[:, JOINTS.index("pelvis"), 2].mean() < ankles[..., 2].mean():
        step = np.zeros_like(step)
    path = np.concatenate([np.zeros((1, 2)), np.cumsum(step, axis=0)])
    travelled = places.copy()
    travelled[..., :2] += path[:, None]
    even = moved + step.mean(axis=0)
    slide = _slide(moved + step[:, None], between, rate_hz)
    before = _slide(even, between, rate_hz)
    return Animation(walk.copy(data=travelled), FootSlide(*slide, before[0]))


def _slide(moved: np.ndarray, weights: np.ndarray, rate_hz: float) -> tuple[float, float]:
    """Speed of the foot that stands, and how far it goes in a stance."""
    standing = weights.argmax(axis=1)
    way = np.linalg.norm(moved[np.arange(len(moved)), standing], axis=1)
    n_stances = 1 + np.count_nonzero(np.diff(standing))
    return float(way.mean() * rate_hz), float(way.sum() / n_stances)
