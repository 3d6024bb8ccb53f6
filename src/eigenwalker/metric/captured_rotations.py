"""Captured rotations of bones, found again behind the joints that were made of a capture."""

from __future__ import annotations

import numpy as np
import xarray as xr
from scipy.spatial.transform import Rotation

from eigenwalker.core.trajectories import DIMS
from eigenwalker.metric.angles import BONE

RIGID_MM = 1.0
"""How much a point may move, root mean square, in the frame of a body it is part of."""


def with_rotations(joints: xr.DataArray, capture: xr.DataArray) -> xr.DataArray:
    """Return joints with the rotations that were captured of their bones.

    A bone turns as the body of the capture in whose frame both its ends stay where they are; names
    and rest postures, which every format has of its own, do not matter.

    Parameters
    ----------
    joints : DataArray of shape (time, marker, axis)
        What `virtual_markers` made of the capture.
    capture : DataArray of shape (time, marker, axis)
        As `read_mocap` gives it, on the same clock.

    Returns
    -------
    DataArray of shape (time, marker, axis)
        With a coordinate ``rotation``, rotation vectors in the room of the bone that begins at each
        joint (of the head at the head; NaN for joints at which none is known); as it came if
        the capture has no rotations, or none of a bone.

    Examples
    --------
    >>> walk = ew.simulate_walk(seed=1, duration_s=1)
    >>> "rotation" in with_rotations(walk, walk).coords
    False

    """
    if "rotation" not in capture.coords or capture.sizes["time"] != joints.sizes["time"]:
        return joints
    bodies = _bodies(capture)
    place = {str(name): joints.values[:, i] for i, name in enumerate(joints.marker.values)}
    rotation = np.full(joints.shape, np.nan)
    for index, joint in enumerate(place):
        ends = _ends(joint, place)
        if ends is not None:
            rotation[:, index] = _turn_of(bodies, *ends)
    if np.isnan(rotation).all():
        return joints
    return joints.assign_coords(rotation=(DIMS, rotation))


def _ends(joint: str, place: dict[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray] | None:
    """Return both ends of the bone whose rotation is kept at a joint."""
    if joint == "head":
        return place["head"], place["head"]
    if joint.endswith("_clavicle"):
        return place[joint], place[joint.replace("clavicle", "shoulder")]
    for bone in BONE.values():
        if bone.start == joint and joint != "sternum" and bone.end in place:
            return place[bone.start], place[bone.end]
    return None


def _bodies(capture: xr.DataArray) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return positions and rotation vectors of what has a rotation throughout."""
    turns = capture.rotation.transpose(*DIMS).values
    return [
        (capture.values[:, i], turns[:, i])
        for i in range(capture.sizes["marker"])
        if np.isfinite(turns[:, i]).all() and np.isfinite(capture.values[:, i]).all()
    ]


def _turn_of(
    bodies: list[tuple[np.ndarray, np.ndarray]], start: np.ndarray, end: np.ndarray
) -> np.ndarray:
    """Return how the body turns that both points are parts of; NaN if there is none."""
    best, turned = RIGID_MM, np.full_like(start, np.nan)
    for place, turns in bodies:
        into = Rotation.from_rotvec(turns).inv()
        moved = [into.apply(point - place).std(axis=0) for point in (start, end)]
        worst = float(np.sqrt(np.max(np.sum(np.square(moved), axis=1))))
        if worst < best:
            best, turned = worst, turns
    return turned
