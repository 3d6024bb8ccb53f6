"""Where joints are inside the body, from markers on the skin.

Hip centres by regression on the size of the pelvis, knees, ankles and elbows as midpoints of inner
and outer markers or, where there are no inner ones, by the chord function of Plug-in Gait (Davis,
Ounpuu, Tyburski and Gage 1991, Hum Mov Sci 10:575).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

MARKER_RADIUS_MM = 7.0


@dataclass(frozen=True)
class Pelvis:
    """Axes and size of the pelvis in each frame."""

    origin: np.ndarray
    """Midpoint of the front iliac spines, shape (time, 3)."""
    axes: np.ndarray
    """Directions forward, left and up in rows, shape (time, 3, 3)."""
    width_mm: float
    """Distance of the front iliac spines."""
    depth_mm: float
    """Distance of their midpoint to that of the back ones."""

    def place(self, forward: float, left: float, up: float) -> np.ndarray:
        """Return a point that is fixed in the pelvis, array of shape (time, 3)."""
        return self.origin + np.array([forward, left, up]) @ self.axes


def pelvis_from_spines(left: np.ndarray, right: np.ndarray, back: np.ndarray) -> Pelvis:
    """Return the pelvis from its front iliac spines and the middle of the back ones."""
    origin = (left + right) / 2
    leftward = unit(left - right)
    forward = unit(across(origin - back, leftward))
    axes = np.stack([forward, leftward, np.cross(forward, leftward)], axis=1)
    return Pelvis(origin, axes, _length(left - right), _length(origin - back))


def harrington(pelvis: Pelvis, _leg_length_mm: float) -> tuple[float, float, float]:
    """Return the hip centre by Harrington et al. (2007), J Biomech 40:595, table 4.

    Millimetres forward of, outwards from and above the midpoint of the front iliac spines.
    """
    return (
        -0.24 * pelvis.depth_mm - 9.9,
        0.33 * pelvis.width_mm + 7.3,
        -0.30 * pelvis.width_mm - 10.9,
    )


def bell(pelvis: Pelvis, _leg_length_mm: float) -> tuple[float, float, float]:
    """Return the hip centre by Bell, Brand and Pedersen (1990), J Biomech 23:617."""
    return -0.19 * pelvis.width_mm, 0.36 * pelvis.width_mm, -0.30 * pelvis.width_mm


def davis(pelvis: Pelvis, leg_length_mm: float) -> tuple[float, float, float]:
    """Return the hip centre by Davis et al. (1991), as Plug-in Gait computes it."""
    theta, beta = 0.500, 0.314
    depth = 0.1288 * leg_length_mm - 48.56 + MARKER_RADIUS_MM
    distance = 0.115 * leg_length_mm - 15.3
    return (
        distance * np.cos(theta) * np.sin(beta) - depth * np.cos(beta),
        pelvis.width_mm / 2 - distance * np.sin(theta),
        -distance * np.cos(theta) * np.cos(beta) - depth * np.sin(beta),
    )


HIP_REGRESSIONS: dict[str, Callable[[Pelvis, float], tuple[float, float, float]]] = {
    "harrington": harrington,
    "bell": bell,
    "davis": davis,
}


def chord(
    proximal: np.ndarray, marker: np.ndarray, outward: np.ndarray, offset_mm: float
) -> np.ndarray:
    """Return the joint centre of a hinge, `offset_mm` inwards of the marker on its skin.

    In the plane of the joint above, the marker and `outward`; the segment is square to the offset.
    """
    segment = marker - proximal
    length = np.linalg.norm(segment, axis=1, keepdims=True)
    with np.errstate(invalid="ignore", divide="ignore"):
        sine = np.minimum(offset_mm / length, 1.0)
        back = segment / length * offset_mm * sine
    inward = -unit(across(outward, segment)) * offset_mm * np.sqrt(1 - sine**2)
    return marker - back + inward


def unit(vectors: np.ndarray) -> np.ndarray:
    """Return vectors of length 1, NaN where they had none."""
    length = np.sqrt(np.einsum("...a,...a->...", vectors, vectors))[..., None]
    return vectors / np.where(length > 0, length, np.nan)


def across(vectors: np.ndarray, axes: np.ndarray) -> np.ndarray:
    """Return the part of vectors at right angles to axes."""
    axes = unit(axes)
    return vectors - np.einsum("...a,...a->...", vectors, axes)[..., None] * axes


def bridged(vectors: np.ndarray) -> np.ndarray:
    """Return slowly changing vectors with missing frames interpolated, and held at the ends."""
    missing = np.isnan(vectors)
    if not missing.any():
        return vectors
    there = ~missing.any(axis=1)
    if not there.any():
        return vectors
    frames = np.arange(len(vectors))
    filled = [np.interp(frames, frames[there], column[there]) for column in vectors.T]
    return np.stack(filled, axis=1)


def _length(vectors: np.ndarray) -> float:
    lengths = np.linalg.norm(vectors, axis=1)
    lengths = lengths[~np.isnan(lengths)]
    return float(np.median(lengths)) if len(lengths) else np.nan
