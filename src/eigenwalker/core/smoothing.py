"""Extrema between samples."""

# scipy has no types:
# pyright: reportMissingTypeStubs=false, reportUnknownVariableType=false
from __future__ import annotations

import numpy as np


def parabola_vertex(before: float, here: float, after: float) -> tuple[float, float]:
    """Return where the parabola through an extreme sample and its neighbours has its vertex.

    In samples from the middle one, and its value; those of the middle sample on a straight line.
    """
    curvature = before - 2 * here + after
    if curvature == 0:
        return 0.0, here
    return 0.5 * (before - after) / curvature, here - (before - after) ** 2 / (8 * curvature)


def running_mean(values: np.ndarray, width: int) -> np.ndarray:
    """Return means over `width` samples around each one; at both ends over those there are.

    Examples
    --------
    >>> running_mean(np.array([0.0, 3.0, 6.0, 9.0]), 3).tolist()
    [1.5, 3.0, 6.0, 7.5]
    """
    from scipy.ndimage import uniform_filter1d

    width = min(width, len(values))
    counts = uniform_filter1d(np.ones(len(values)), width, mode="constant")
    return uniform_filter1d(values, width, mode="constant") / counts
