"""What an observer sees of a walker: three dimensions onto two."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from eigenwalker.core.arguments import check_numbers


def project(
    positions: ArrayLike,
    *,
    azimuth_deg: float = 0.0,
    elevation_deg: float = 0.0,
    eye_distance_mm: float | None = None,
) -> np.ndarray:
    """Return where an observer sees points of the scene, in two dimensions.

    At an azimuth of 0 the observer faces the walker, whose left is then at the observer's right. A
    positive azimuth turns the walker to its own left: at 90 degrees it walks to the right of the
    picture, at -90 to the left.

    Parameters
    ----------
    positions : array of shape (..., 3)
        Millimetres: x forward, y to the walker's left, z up.
    azimuth_deg : float
        By how much the walker is turned out of the frontal view.
    elevation_deg : float
        Of the observer above the horizontal; 90 looks straight down.
    eye_distance_mm : float, optional
        From the eye to the middle of all points, about which the observer turns, for a perspective
        picture, in which things as far as the middle keep their size. None: orthographic.

    Returns
    -------
    array of shape (..., 2)
        Millimetres to the right and up in the picture. Missing points stay NaN.

    Raises
    ------
    ValueError
        If positions have other than three coordinates, or a point lies beside or behind the eye.

    See Also
    --------
    observer_axes : The axes of the picture.

    References
    ----------
    Troje (2002), Methods, experiment: orthographic, at 0, 30 and 90 degrees.

    Examples
    --------
    The left hand, 300 mm beside the body, in the frontal view and in profile:

    >>> project([0, 300, 1000]).tolist()
    [300.0, 1000.0]
    >>> project([0, 300, 1000], azimuth_deg=90).round(9).tolist()
    [0.0, 1000.0]
    """
    positions = check_numbers(positions, "positions", missing=True)
    if not positions.size or positions.shape[-1] != 3:
        raise ValueError(
            f"Expected positions with x, y, z along the last axis, got {positions.shape}."
        )
    seen = positions @ observer_axes(azimuth_deg, elevation_deg).T
    if eye_distance_mm is None:
        return seen[..., :2]
    return _in_perspective(seen, eye_distance_mm)


def observer_axes(azimuth_deg: float, elevation_deg: float = 0.0) -> np.ndarray:
    """Return the axes of an observer as rows of a rotation matrix.

    Parameters
    ----------
    azimuth_deg, elevation_deg : float
        From where the observer looks: 0 and 0 is the front, azimuth 90 the walker's profile.

    Returns
    -------
    array of shape (3, 3)
        The observer's right, up, and the direction to the observer.

    See Also
    --------
    project : positions as the observer sees them.
    """
    view, elevation = math.radians(azimuth_deg), math.radians(elevation_deg)
    ahead = np.array([math.cos(view), -math.sin(view), 0.0])
    right = np.array([math.sin(view), math.cos(view), 0.0])
    above = np.array([0.0, 0.0, 1.0])
    up = math.cos(elevation) * above - math.sin(elevation) * ahead
    towards = math.cos(elevation) * ahead + math.sin(elevation) * above
    return np.stack([right, up, towards])


def _in_perspective(seen: np.ndarray, eye_distance_mm: float) -> np.ndarray:
    points = seen.reshape(-1, 3)
    middle = (np.nanmin(points, axis=0) + np.nanmax(points, axis=0)) / 2
    offset = seen - middle
    from_eye = eye_distance_mm - offset[..., 2]
    if not (np.isnan(from_eye) | (from_eye > 0)).all():
        raise ValueError(
            f"eye_distance_mm={eye_distance_mm:g} puts the eye among the points; choose more than "
            f"{np.nanmax(offset[..., 2]):.0f}."
        )
    return middle[:2] + offset[..., :2] * (eye_distance_mm / from_eye)[..., None]
