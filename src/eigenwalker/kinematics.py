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
