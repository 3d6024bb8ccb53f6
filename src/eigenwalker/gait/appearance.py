"""The visible differences between walkers, in numbers: widths, sway, elbows, bounce, stride."""

from __future__ import annotations

import numpy as np
import pandas as pd

from eigenwalker.core.walker import Walker
from eigenwalker.gait.heading import N_MOMENTS, ground_speed


def walker_measures(walker: Walker) -> pd.Series:
    """Return the measures of a walker that the interactive page shows.

    The qualitative findings of Troje (2002) and of WDP2002 are stated in these: men's shoulders are
    wider than their hips, their elbows further out, and their upper bodies sway more.

    Parameters
    ----------
    walker : Walker
        With any markers.

    Returns
    -------
    Series
        NaN where the markers are missing.

        - ``shoulder_width_mm``, ``hip_width_mm``: distance of left and right in the mean posture;
          ``elbow_distance_mm``: that of the elbows along y only, as arms swing;
        - ``lateral_sway_mm``: range over a stride of y of the middle of the shoulders;
        - ``vertical_movement_mm``: range over a stride of the height of the pelvis, or else of the
          middle of the hips;
        - ``frequency_hz``: strides a second;
        - ``stride_length_mm``: speed (`ground_speed`) over frequency.

    See Also
    --------
    ground_speed
    gait_parameters : steps, stance and their symmetry.

    References
    ----------
    Troje (2002), fig. 6 and p. 381. WDP2002: Troje (2002), Little man or big woman.

    Examples
    --------
    >>> people = ew.load_population()
    >>> he, she = (walker_measures(people.walkers[row]) for row in (30, 10))
    >>> bool(he["shoulder_width_mm"] > she["shoulder_width_mm"])
    True

    """
    stride = walker.trajectories(np.arange(N_MOMENTS) * walker.period_s / N_MOMENTS).values
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
    """Return the vector from the right joint to the left one in the mean posture, or NaN."""
    sides = [f"{side}_{part}" for side in ("left", "right")]
    if not set(sides) <= set(walker.markers):
        return np.full(3, np.nan)
    left, right = (walker.p0[walker.markers.index(name)] for name in sides)
    return left - right


def _range(walker: Walker, stride: np.ndarray, names: tuple[str, ...], *, axis: int) -> float:
    """Return the range of the middle of some markers along an axis over a stride, or NaN."""
    if not set(names) <= set(walker.markers):
        return float("nan")
    places = [walker.markers.index(name) for name in names]
    return float(np.ptp(stride[:, places, axis].mean(axis=1)))
