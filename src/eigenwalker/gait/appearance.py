"""The visible differences between walkers, in numbers: widths, sway, elbows, bounce, stride."""

from __future__ import annotations

import numpy as np
import pandas as pd

from eigenwalker.core.walker import Walker, check_walkers
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
    check_walkers([walker])
    stride = walker.trajectories(np.arange(N_MOMENTS) * walker.period_s / N_MOMENTS)
    trunk = ["pelvis"] if "pelvis" in walker.markers else ["left_hip", "right_hip"]

    def apart(part: str) -> np.ndarray:
        pair = walker.mean_posture.reindex(marker=[f"left_{part}", f"right_{part}"])
        return pair.values[0] - pair.values[1]

    def span(names: list[str], axis: str) -> float:
        path = stride.reindex(marker=names).sel(axis=axis).mean("marker", skipna=False)
        return float(np.ptp(path.values))

    return pd.Series(
        {
            "shoulder_width_mm": float(np.linalg.norm(apart("shoulder"))),
            "hip_width_mm": float(np.linalg.norm(apart("hip"))),
            "elbow_distance_mm": float(apart("elbow")[1]),
            "lateral_sway_mm": span(["left_shoulder", "right_shoulder"], "y"),
            "vertical_movement_mm": span(trunk, "z"),
            "frequency_hz": walker.frequency_hz,
            "stride_length_mm": ground_speed(walker) / walker.frequency_hz,
        }
    )
