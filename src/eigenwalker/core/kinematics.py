"""Jointed bodies: where joints are when bones turn."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.spatial.transform import Rotation


def forward_kinematics(
    parents: Sequence[int], offsets: np.ndarray, rotations: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return positions and orientations in the room of all joints of a tree of bones.

    Parameters
    ----------
    parents : sequence of int
        For each joint the index of its parent, which must come before it; -1 for a root.
    offsets : array of shape (joint, 3) or (time, joint, 3)
        Place of each joint in the frame of its parent (of the room, for a root), constant for rigid
        bones.
    rotations : array of shape (time, joint, 4)
        Rotation of each joint relative to its parent, unit quaternions (x, y, z, w).

    Returns
    -------
    positions : array of shape (time, joint, 3)
        In the unit of `offsets`.
    orientations : array of shape (time, joint, 4)
        Quaternions (x, y, z, w) that turn each joint's own frame into the room's.

    Examples
    --------
    A forearm bent by 90 degrees at the elbow:

    >>> bend = Rotation.from_euler("y", [[0], [-90]], degrees=True).as_quat()[None]
    >>> positions, _ = forward_kinematics(
    ...     [-1, 0, 1],
    ...     np.array([[0, 0, 0], [0, 0, -300], [0, 0, -250.0]]),
    ...     np.concatenate([bend, bend[:, :1]], axis=1),
    ... )
    >>> positions[0, 2].round().tolist()
    [250.0, 0.0, -300.0]

    """
    n_frames, n_joints, _ = rotations.shape
    offsets = np.array(np.broadcast_to(offsets, (n_frames, n_joints, 3)))
    positions = np.empty((n_frames, n_joints, 3))
    orientations: list[Rotation] = []
    for joint, parent in enumerate(parents):
        turn = Rotation.from_quat(rotations[:, joint])
        if parent < 0:
            positions[:, joint] = offsets[:, joint]
            orientations.append(turn)
        else:
            positions[:, joint] = positions[:, parent] + orientations[parent].apply(
                offsets[:, joint]
            )
            orientations.append(orientations[parent] * turn)
    return positions, np.stack([turn.as_quat() for turn in orientations], axis=1)


def bone_rotations(parents: Sequence[int], rest: np.ndarray, positions: np.ndarray) -> np.ndarray:
    """Return how the joints of a body with constant bones turn to lie over given positions.

    From the root outwards, each joint turns its bones towards where the next joints were seen from
    where it has come to be itself, so that a bone of another length than the captured one costs its
    difference once and no joint further out pays for it again. A joint that carries one bone turns
    it the shortest way; one that carries several turns them together, as a rigid part, by least
    squares. About the axis of a single bone nothing is known, and nothing turns.

    Parameters
    ----------
    parents : sequence of int
        For each joint the index of its parent, which must come before it; -1 for the root.
    rest : array of shape (joint, 3)
        Place of each joint in the frame of its parent when nothing is turned. Where it is zero, the
        joint is at its parent's place, and its parent turns it with what it carries itself.
    positions : array of shape (time, joint, 3)
        Where the joints were seen, in the unit of `rest`; none missing.

    Returns
    -------
    array of shape (time, joint, 4)
        Rotation of each joint relative to its parent, unit quaternions (x, y, z, w), as
        `forward_kinematics` takes them.

    Examples
    --------
    An arm that hung down is seen held forward:

    >>> rest = np.array([[0, 0, 0], [0, 0, -300.0]])
    >>> seen = np.array([[[0, 0, 1400], [310, 0, 1400.0]]])
    >>> turns = bone_rotations([-1, 0], rest, seen)
    >>> held, _ = forward_kinematics([-1, 0], rest, turns)
    >>> held[0, 1].round(6).tolist()
    [300.0, 0.0, 0.0]

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
    """Return the bones that begin at the place of a joint and are carried by it, by their end."""
    bones: dict[int, np.ndarray] = {}
    for child, parent in enumerate(parents):
        if parent == joint:
            same_place = not rest[child].any()
            bones |= _bones_from(child, parents, rest) if same_place else {child: rest[child]}
    return bones


def _turn_bones(
    bones: dict[int, np.ndarray], seen: dict[int, np.ndarray], n_frames: int
) -> Rotation:
    """Return the turn in each frame that takes bones at rest to where they were seen."""
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
    """Return the smallest rotations that bring one direction into others.

    Parameters
    ----------
    start : array of shape (3,)
        Any length above 0.
    end : array of shape (time, 3)
        Of zero length where there is nothing to turn to; then nothing turns.

    Returns
    -------
    Rotation
        One a row of `end`.

    Examples
    --------
    >>> turn = shortest_turn(np.array([0, 0, 2.0]), np.array([[5.0, 0, 0], [0, 0, -1]]))
    >>> turn.magnitude().round(6).tolist()
    [1.570796, 3.141593]

    """
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

    Kabsch (1976), for all frames at once.

    Parameters
    ----------
    still : array of shape (point, 3)
        Two or more.
    moving : array of shape (time, point, 3)
        The same points, frame by frame.

    Returns
    -------
    Rotation
        One a frame.

    Examples
    --------
    >>> still = np.array([[100.0, 0, 0], [0, 50, 0]])
    >>> turn = rigid_turn(still, np.array([[[0, 100.0, 0], [-50, 0, 0]]]))
    >>> turn.as_rotvec(degrees=True).round(6).tolist()
    [[0.0, 0.0, 90.0]]

    """
    covariance = np.einsum("tpi,pj->tij", moving, still)
    left, _, right = np.linalg.svd(covariance)
    handed = np.sign(np.linalg.det(left @ right))
    left[..., -1] *= handed[:, None]
    return Rotation.from_matrix(left @ right)


def rotate_z(positions: np.ndarray, angle: float | np.ndarray) -> np.ndarray:
    """Return positions turned about the vertical, counter-clockwise as seen from above.

    Parameters
    ----------
    positions : array of shape (time, marker, axis)
        x, y and z.
    angle : float or array of shape (time,)
        Radians, one for all frames or one a frame.

    Returns
    -------
    array of shape (time, marker, axis)

    Examples
    --------
    >>> rotate_z(np.array([[[1.0, 0, 5]]]), np.pi / 2).round(9).tolist()
    [[[0.0, 1.0, 5.0]]]

    """
    angle = np.reshape(angle, (-1, 1))
    cos, sin = np.cos(angle), np.sin(angle)
    x, y, z = np.moveaxis(positions, 2, 0)
    return np.stack([cos * x - sin * y, sin * x + cos * y, z], axis=2)
