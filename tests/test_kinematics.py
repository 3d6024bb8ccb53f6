from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from eigenwalker.kinematics import forward_kinematics

PARENTS = [-1, 0, 1, 0, 3]


def _body(seed: int, n_frames: int = 4) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    offsets = rng.normal(size=(len(PARENTS), 3))
    turns = Rotation.random(n_frames * len(PARENTS), rng=rng).as_quat()
    return offsets, turns.reshape(n_frames, len(PARENTS), 4)


def test_unturned_joints_are_where_their_offsets_add_up():
    offsets, turns = _body(0)
    turns[:] = [0, 0, 0, 1]
    positions, orientations = forward_kinematics(PARENTS, offsets, turns)
    np.testing.assert_allclose(positions[2, 2], offsets[[0, 1, 2]].sum(axis=0))
    np.testing.assert_allclose(orientations, turns)


def test_a_turned_root_carries_all_joints_round_it():
    offsets, turns = _body(1)
    before, _ = forward_kinematics(PARENTS, offsets, turns)
    quarter = Rotation.from_euler("z", 90, degrees=True)
    turns[:, 0] = (quarter * Rotation.from_quat(turns[:, 0])).as_quat()
    after, _ = forward_kinematics(PARENTS, offsets, turns)
    for frame in range(len(turns)):
        expected = quarter.apply(before[frame] - before[frame, 0]) + before[frame, 0]
        np.testing.assert_allclose(after[frame], expected, atol=1e-12)


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10**6))
def test_bones_keep_their_lengths(seed):
    offsets, turns = _body(seed)
    positions, _ = forward_kinematics(PARENTS, offsets, turns)
    for joint, parent in enumerate(PARENTS):
        if parent >= 0:
            lengths = np.linalg.norm(positions[:, joint] - positions[:, parent], axis=1)
            np.testing.assert_allclose(lengths, np.linalg.norm(offsets[joint]))


def test_orientation_turns_what_is_fixed_in_a_joint():
    offsets, turns = _body(2)
    positions, orientations = forward_kinematics(PARENTS, offsets, turns)
    reach = Rotation.from_quat(orientations[:, 3]).apply(offsets[4])
    np.testing.assert_allclose(positions[:, 4], positions[:, 3] + reach, atol=1e-12)


def test_offsets_may_change_over_time():
    offsets, turns = _body(3)
    moving = np.tile(offsets, (len(turns), 1, 1))
    moving[:, 0] += np.arange(len(turns))[:, None]
    still, _ = forward_kinematics(PARENTS, offsets, turns)
    moved, _ = forward_kinematics(PARENTS, moving, turns)
    expected = still + np.arange(len(turns))[:, None, None]
    np.testing.assert_allclose(moved, expected, atol=1e-12)
