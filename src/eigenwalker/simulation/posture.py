"""Where the joints of a body are when its segments are turned: closed-form forward kinematics."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from eigenwalker.simulation.body import TOE_BEND, Body

SIDES = {"left": 1, "right": -1}
"""Each side with the sign of its lateral axis."""


class Rotation(NamedTuple):
    """A rotation about an axis of the room, frame by frame: cosine and sine of its angle."""

    axis: int
    cos: np.ndarray
    sin: np.ndarray


def rotation(axis: str, angle: np.ndarray) -> Rotation:
    """Return a right-handed rotation about x, y or z by an angle in radians."""
    return Rotation("xyz".index(axis), np.cos(angle), np.sin(angle))


Rotations = tuple[Rotation, ...]


def rotated(vector: np.ndarray, rotations: Rotations) -> np.ndarray:
    """Return a vector of a segment after the rotations, one after the other: shape (frame, 3)."""
    parts = list(vector)
    for axis, cos, sin in rotations:
        a, b = (axis + 1) % 3, (axis + 2) % 3
        parts[a], parts[b] = cos * parts[a] - sin * parts[b], sin * parts[a] + cos * parts[b]
    place = np.empty((len(rotations[0].cos), 3))
    place[:, 0], place[:, 1], place[:, 2] = parts
    return place


def trunk_rotations(angles: Mapping[str, np.ndarray], part: str) -> Rotations:
    """Return the rotations of pelvis, trunk or head in the room: tilt, obliquity, rotation."""
    return (
        rotation("y", angles[f"{part}_tilt"]),
        rotation("x", angles[f"{part}_obliquity"]),
        rotation("z", -angles[f"{part}_rotation"]),
    )


def segment_rotations(angles: Mapping[str, np.ndarray]) -> dict[str, Rotations]:
    """Return how each segment stands in the room, from the angles of `walk_cycle_frames`.

    The thigh is against the vertical in the plane of the leg, of which ``splay`` is the slope.
    """
    rotations = {part: trunk_rotations(angles, part) for part in ("pelvis", "trunk", "head")}
    for name, side in SIDES.items():
        own = {key.removeprefix(f"{name}_"): a for key, a in angles.items() if key.startswith(name)}
        splay, yaw = rotation("x", own["splay"]), rotation("z", -side * own["foot_yaw"])
        pitch = own["foot_pitch"]
        rotations[f"{name}_thigh"] = (rotation("y", -own["thigh"]), splay)
        rotations[f"{name}_shank"] = (rotation("y", own["knee_flexion"] - own["thigh"]), splay)
        rotations[f"{name}_foot"] = (rotation("y", pitch), yaw)
        rotations[f"{name}_toes"] = (rotation("y", pitch - np.clip(pitch, 0.0, TOE_BEND)), yaw)
        upper = (
            rotation("z", -side * own["shoulder_rotation"]),
            rotation("x", side * own["shoulder_abduction"]),
            rotation("y", -own["shoulder_flexion"]),
            *rotations["trunk"],
        )
        rotations[f"{name}_upper_arm"] = upper
        rotations[f"{name}_forearm"] = (
            rotation("x", side * own["carrying_angle"]),
            rotation("y", -own["elbow_flexion"]),
            *upper,
        )
    return rotations


def joint_positions(
    body: Body, rotations: Mapping[str, Rotations], pelvis: np.ndarray
) -> dict[str, np.ndarray]:
    """Return joints, heels, balls and tips of the toes from the path of the pelvis, (frame, 3)."""
    places = {"pelvis": pelvis}

    def put(joint: str, parent: str, segment: str, offset: np.ndarray | tuple) -> None:
        places[joint] = places[parent] + rotated(
            np.asarray(offset, dtype=float), rotations[segment]
        )

    put("sternum", "pelvis", "trunk", body.sternum)
    put("neck", "pelvis", "trunk", body.neck)
    put("head", "neck", "head", body.head)
    for name, side in SIDES.items():
        mirrored, foot = np.array([1, side, 1]), body.foot
        put(f"{name}_hip", "pelvis", "pelvis", body.hip * mirrored)
        put(f"{name}_knee", f"{name}_hip", f"{name}_thigh", (0, 0, -body.thigh))
        put(f"{name}_ankle", f"{name}_knee", f"{name}_shank", (0, 0, -body.shank))
        put(f"{name}_heel", f"{name}_ankle", f"{name}_foot", (-foot.heel, 0, -foot.height))
        put(f"{name}_ball", f"{name}_ankle", f"{name}_foot", (foot.ball, 0, -foot.height))
        put(f"{name}_toe", f"{name}_ball", f"{name}_toes", (foot.toe, 0, 0))
        put(f"{name}_shoulder", "pelvis", "trunk", body.shoulder * mirrored)
        put(f"{name}_elbow", f"{name}_shoulder", f"{name}_upper_arm", (0, 0, -body.upper_arm))
        put(f"{name}_wrist", f"{name}_elbow", f"{name}_forearm", (0, 0, -body.forearm))
    return places
