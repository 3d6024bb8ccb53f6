"""What the eye takes in of a walk, in numbers: widths, sway, elbows, bounce, stride (J32, W11)."""

from __future__ import annotations

import numpy as np
import pandas as pd

from eigenwalker.core.walker import Walker
from eigenwalker.gait.heading import ground_speed

N_SAMPLES = 200
"""Moments at which a walk is looked at."""


def walker_measures(walker: Walker) -> pd.Series:
    """Return what changes visibly between walkers: the numbers that the interactive page shows.

    The qualitative findings of Troje (2002) and of WDP2002 are stated in these: men's shoulders are
    wider than their hips, their elbows further out, their upper bodies sway more. Stance, steps and
    their symmetry are in `gait_parameters`.

    Parameters
    ----------
    walker : Walker
        Of any markers.

    Returns
    -------
    Series
        NaN where the markers are missing.

        ``shoulder_width_mm``, ``hip_width_mm``: distance of left and right in the mean posture.
        ``elbow_distance_mm``: the same of the elbows, sideways (y) only, as arms swing.
        ``lateral_sway_mm``: range over a stride of the place sideways of the middle of the
        shoulders.
        ``vertical_movement_mm``: range over a stride of the height of the pelvis, or of the
        middle of the hips where there is none.
        ``frequency_hz``: strides a second.
        ``stride_length_mm``: speed over frequency. The speed is the walker's own, or else that of
        the feet that stand (`ground_speed`, of 200 moments evenly from 0 to 2 strides). Two
        harmonics hold feet only so still: on simulated walkers it is 87 to 109 % of the true one.

    Examples
    --------
    >>> people = ew.load_population()
    >>> he, she = (walker_measures(people.walkers[row]) for row in (30, 10))
    >>> bool(he["shoulder_width_mm"] > she["shoulder_width_mm"])
    True

    """
    stride = walker.trajectories(np.arange(N_SAMPLES) * walker.period_s / N_SAMPLES).values
    trunk = ("pelvis",) if "pelvis" in walker.markers else ("left_hip", "right_hip")
    apart = {part: _apart(walker, part) for part in ("shoulder", "hip", "elbow")}
    return pd.Series(
        {
            "shoulder_width_mm": float(np.linalg.norm(apart["shoulder"])),
            "hip_width_mm": float(np.linalg.norm(apart["hip"])),
            "elbow_distance_mm": float(apart["elbow"][1]),
            "lateral_sway_mm": _range(walker, stride, ("left_shoulder", "right_shoulder"), axis=1),
            "vertical_movement_mm": _range(walker, stride, trunk, axis=2),
            "frequency_hz": walker.frequency_hz,
            "stride_length_mm": ground_speed(walker) / walker.frequency_hz,
        }
    )


def _apart(walker: Walker, part: str) -> np.ndarray:
    """From the right joint to the left one in the mean posture; NaN where one is missing."""
    sides = [f"{side}_{part}" for side in ("left", "right")]
    if not set(sides) <= set(walker.markers):
        return np.full(3, np.nan)
    left, right = (walker.p0[walker.markers.index(name)] for name in sides)
    return left - right


def _range(walker: Walker, stride: np.ndarray, names: tuple[str, ...], *, axis: int) -> float:
    """How far the middle of some markers moves along an axis over a stride."""
    if not set(names) <= set(walker.markers):
        return float("nan")
    places = [walker.markers.index(name) for name in names]
    return float(np.ptp(stride[:, places, axis].mean(axis=1)))
