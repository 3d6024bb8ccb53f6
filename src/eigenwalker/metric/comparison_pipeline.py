"""From a capture to a walk that can be compared: joints, in place, on the neutral mannequin."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from scipy.spatial.transform import Rotation

from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.trajectories import DIMS, sampling_rate
from eigenwalker.gait.gaps import MAX_GAP_S, find_gaps
from eigenwalker.gait.in_place import in_place
from eigenwalker.markers.virtual_markers import virtual_markers
from eigenwalker.metric.clips import Clip, as_trajectories
from eigenwalker.metric.joint_angles import SKELETON_BONES
from eigenwalker.metric.retargeting import retarget

RIGID_MM = 1.0
"""Standard deviation of a point in the frame of a body up to which it is a part of that body."""


def prepare_walk(capture: Clip, *, mannequin: bool = True) -> xr.DataArray:
    """Return the steady strides of a capture as a walk that can be compared with others.

    1. The joints of its markers, with feet, hands and captured rotations (`virtual_markers`).
    2. The steady strides in place, facing +x (`in_place`).
    3. The neutral mannequin (`retarget`), so that differences are of movement and not of build.

    Parameters
    ----------
    capture : DataArray of shape (time, marker, axis), Walker, Loop or PreparedClip
        A capture of markers or joints, from `read_mocap`, or any clip of joints.
    mannequin : bool
        Whether to show the walk on the mannequin rather than on its own body.

    Returns
    -------
    DataArray of shape (time, marker, axis)
        Positions in mm. ``attrs["hidden_markers"]`` names hands, feet and the like that were
        hidden for too long and are left out.

    See Also
    --------
    prepare : Of any clip, as it is.

    References
    ----------
    Pražák et al. (2010), section 3.

    Examples
    --------
    >>> "left_toe" in prepare_walk(ew.simulate_walk(seed=1, markers="skin")).marker
    True
    """
    walk = in_place(full_joints(capture))
    return retarget(walk) if mannequin else walk


def full_joints(capture: Clip, mapping: Any = None) -> xr.DataArray:
    """Return the joints of a capture with feet, hands and captured rotations."""
    capture = as_trajectories(capture)
    joints = with_rotations(virtual_markers(capture, joints="full", mapping=mapping), capture)
    longest = MAX_GAP_S * sampling_rate(joints) if len(joints) > 1 else 0
    gaps = [gap for gap in find_gaps(joints.values) if gap.stop - gap.start > longest]
    hidden = sorted({str(joints.marker.values[gap.marker]) for gap in gaps} - {*JOINTS.markers})
    return joints.drop_sel(marker=hidden).assign_attrs(hidden_markers=hidden)


def with_rotations(joints: xr.DataArray, capture: xr.DataArray) -> xr.DataArray:
    """Return joints with the captured rotations of their bones as a coordinate ``rotation``.

    These are rotation vectors in the frame of the room of the bone that begins at each joint (of
    the head at the head), NaN where none is known. A bone turns like the body of the capture in
    whose frame both its ends stay most nearly fixed (`RIGID_MM`); names and rest postures, which
    differ between formats, do not matter. Joints and capture have one clock.
    """
    if "rotation" not in capture.coords or capture.sizes["time"] != joints.sizes["time"]:
        return joints
    bodies = _bodies(capture)
    place = {str(name): joints.values[:, i] for i, name in enumerate(joints.marker.values)}
    rotation = np.full(joints.shape, np.nan)
    for index, joint in enumerate(place):
        if ends := _bone_at(joint, place):
            rotation[:, index] = _rotation_of(bodies, *ends)
    if np.isnan(rotation).all():
        return joints
    return joints.assign_coords(rotation=(DIMS, rotation))


def _bone_at(joint: str, place: dict[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray] | None:
    """Return both ends of the bone whose rotation is stored at a joint."""
    if joint == "head":
        return place["head"], place["head"]
    if joint.endswith("_clavicle"):
        return place[joint], place[joint.replace("clavicle", "shoulder")]
    for bone in SKELETON_BONES.values():
        if bone.start == joint and joint != "sternum" and bone.end in place:
            return place[bone.start], place[bone.end]
    return None


def _bodies(capture: xr.DataArray) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return positions and rotation vectors of the markers that have both in all frames."""
    rotation = capture.rotation.transpose(*DIMS).values
    known = np.isfinite(rotation).all(axis=(0, 2)) & np.isfinite(capture.values).all(axis=(0, 2))
    return [(capture.values[:, i], rotation[:, i]) for i in np.flatnonzero(known)]


def _rotation_of(
    bodies: list[tuple[np.ndarray, np.ndarray]], start: np.ndarray, end: np.ndarray
) -> np.ndarray:
    """Return the rotation of the body that both points are parts of; NaN if there is none.

    Of bodies that fit equally, such as a forearm and a hand that only turns about it, the one that
    begins nearest to the bone is taken.
    """
    best, rotation = (RIGID_MM, 0.0), np.full_like(start, np.nan)
    for place, vectors in bodies:
        into_body = Rotation.from_rotvec(vectors).inv()
        spread = [into_body.apply(point - place).std(axis=0) for point in (start, end)]
        worst = float(np.linalg.norm(spread, axis=1).max())
        fit = round(worst, 3), float(np.linalg.norm(place - start, axis=1).mean())
        if fit < best:
            best, rotation = fit, vectors
    return rotation
