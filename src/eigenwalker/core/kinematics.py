"""Jointed bodies: the places of joints when bones turn."""

# scipy has no types:
# pyright: reportMissingTypeStubs=false, reportUnknownMemberType=false
from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.spatial.transform import Rotation

from eigenwalker.core.quaternions import product

GRAVITY_MM_S2 = 9810.0


def forward_kinematics(
    parents: Sequence[int], offsets: np.ndarray, rotations: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return positions and orientations in the room of all joints of a tree of bones.

    For each joint: the index of its parent, which comes before it, -1 for a root; its offset in the
    frame of the parent, (joint, 3) or (time, joint, 3); its rotation relative to the parent, unit
    quaternions (x, y, z, w) of shape (time, joint, 4). Positions have the shape (time, joint, 3),
    orientations (time, joint, 4).
    """
    n_frames, n_joints, _ = rotations.shape
    offsets = np.array(np.broadcast_to(offsets, (n_frames, n_joints, 3)))
    positions = np.empty((n_frames, n_joints, 3))
    orientations = rotations / np.linalg.norm(rotations, axis=2, keepdims=True)
    for joint, parent in enumerate(parents):
        if parent < 0:
            positions[:, joint] = offsets[:, joint]
        else:
            turn = Rotation.from_quat(orientations[:, parent])
            positions[:, joint] = positions[:, parent] + turn.apply(offsets[:, joint])
            orientations[:, joint] = product(orientations[:, parent], orientations[:, joint])
    return positions, orientations


def bone_rotations(parents: Sequence[int], rest: np.ndarray, positions: np.ndarray) -> np.ndarray:
    """Return the rotations of a rigid body's joints that bring it nearest to seen positions.

    From the root outwards, each joint turns its bones towards where the next joints were seen from
    its own new place, so errors of length do not add up. A joint that carries one bone turns it the
    shortest way; one that carries several turns them together by least squares.

    `rest` (joint, 3) holds the offset of each joint in the frame of its parent. Where it is zero,
    the joint is at its parent's place, and its parent turns it with what it carries itself.
    Positions are (time, joint, 3), complete; the result is as `forward_kinematics` takes it.
    """
    bones = [_bones_from(joint, parents, rest) for joint in range(len(parents))]
    turns = np.zeros((*positions.shape[:2], 4))
    placed = np.empty_like(positions)
    orientations: list[Rotation] = []
    for joint, parent in enumerate(parents):
        if parent < 0:
            placed[:, joint] = positions[:, joint]
            carried = Rotation.identity(len(positions))
        else:
            carried = orientations[parent]
            placed[:, joint] = placed[:, parent] + carried.apply(rest[joint])
        seen = {
            end: carried.inv().apply(positions[:, end] - placed[:, joint]) for end in bones[joint]
        }
        turn = _turn_bones(bones[joint], seen, len(positions))
        turns[:, joint] = turn.as_quat()
        orientations.append(carried * turn)
    return turns


def _bones_from(joint: int, parents: Sequence[int], rest: np.ndarray) -> dict[int, np.ndarray]:
    """Return the bones that start at a joint's place and turn with it, by their end."""
    bones: dict[int, np.ndarray] = {}
    for child, parent in enumerate(parents):
        if parent == joint:
            same_place = not rest[child].any()
            bones |= _bones_from(child, parents, rest) if same_place else {child: rest[child]}
    return bones


def _turn_bones(
    bones: dict[int, np.ndarray], seen: dict[int, np.ndarray], n_frames: int
) -> Rotation:
    """Return the rotation in each frame that turns bones at rest to where they were seen."""
    if not bones:
        return Rotation.identity(n_frames)
    if len(bones) == 1:
        ((end, bone),) = bones.items()
        return shortest_turn(bone, seen[end])
    ends = list(bones)
    still = np.stack([bones[end] for end in ends])
    moving = np.stack([seen[end] for end in ends], axis=1)
    return rigid_turn(still, moving)


def shortest_turn(start: np.ndarray, end: np.ndarray) -> Rotation:
    """Return the smallest rotations that bring one direction, (3,), into others, (time, 3)."""
    start = start / np.linalg.norm(start)
    length = np.linalg.norm(end, axis=1, keepdims=True)
    end = np.divide(end, length, out=np.tile(start, (len(end), 1)), where=length > 0)
    cosine = end @ start
    quaternions = np.column_stack([np.cross(start, end), 1 + cosine])
    aside = np.cross(start, np.eye(3)[np.abs(start).argmin()])
    quaternions[cosine < -1 + 1e-12] = [*aside, 0.0]  # opposite: half a turn about any normal
    return Rotation.from_quat(quaternions)


def rigid_turn(still: np.ndarray, moving: np.ndarray) -> Rotation:
    """Return the rotations about the origin that bring points over moving ones by least squares.

    Two or more still points (point, 3), and the same (time, point, 3); all frames at once, after
    Kabsch (1976).
    """
    covariance = np.einsum("tpi,pj->tij", moving, still)
    left, _, right = np.linalg.svd(covariance)
    handed = np.sign(np.linalg.det(left @ right))
    left[..., -1] *= handed[:, None]
    return Rotation.from_matrix(left @ right)


def rotate_z(positions: np.ndarray, angle: float | np.ndarray) -> np.ndarray:
    """Return positions (time, marker, axis) turned about the vertical.

    By an angle in radians, one or one a frame, counter-clockwise as seen from above.
    """
    angle = np.reshape(angle, (-1, 1))
    cos, sin = np.cos(angle), np.sin(angle)
    x, y, z = np.moveaxis(positions, 2, 0)
    return np.stack([cos * x - sin * y, sin * x + cos * y, z], axis=2)
