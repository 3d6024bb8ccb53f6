from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from scipy.spatial.transform import Rotation

from eigenwalker.core.kinematics import (
    bone_rotations,
    forward_kinematics,
    rigid_turn,
    shortest_turn,
)

PARENTS = [-1, 0, 1, 0, 3]


def _body(seed: int, n_frames: int = 4) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    offsets = rng.normal(size=(len(PARENTS), 3))
    turns = Rotation.random(n_frames * len(PARENTS), rng).as_quat()
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


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10**6))
def test_bone_rotations_bring_a_rigid_body_where_it_was_seen(seed):
    rest, turns = _body(seed)
    turns[:, [2, 4]] = [0, 0, 0, 1]  # a last joint carries nothing whose place would tell its turn
    seen, _ = forward_kinematics(PARENTS, rest, turns)
    placed = _placed(rest, seen)
    np.testing.assert_allclose(placed, seen, atol=1e-9)


def test_bone_rotations_pay_for_a_longer_bone_once():
    rest = np.array([[0, 0, 0], [0, 0, -400], [0, 0, -400], [200, 0, 0.0], [100, 0, 0]])
    turns = np.zeros((1, 5, 4))
    turns[..., 3] = 1
    longer = rest.copy()
    longer[1, 2] = -420
    seen, _ = forward_kinematics(PARENTS, longer, turns)
    off = np.linalg.norm(_placed(rest, seen) - seen, axis=2)[0]
    np.testing.assert_allclose(off[1:3], [20, 20], atol=1e-3)
    sideways = seen + np.array([[0, 0, 0], [0, 0, 0], [400, 0, 380], [0, 0, 0], [0, 0, 0]])
    off = np.linalg.norm(_placed(rest, sideways) - sideways, axis=2)[0]
    assert off[1] == pytest.approx(20, abs=0.1)
    assert off[2] < 2, "the bone beyond turns a little and reaches its end"


def test_joints_of_no_length_let_bones_swing_against_each_other():
    parents = [-1, 0, 1, 0, 3]
    rest = np.array([[0, 0, 0], [0, 0, 0], [0, 100, 0], [0, 0, 0], [0, 0, 200.0]])
    seen = np.zeros((1, 5, 3))
    seen[0, 2], seen[0, 4] = [60, 80, 0], [0, 120, 160]
    np.testing.assert_allclose(_placed(rest, seen, parents), seen, atol=1e-9)


def test_the_shortest_turn_turns_no_further_than_the_angle_between():
    rng = np.random.default_rng(5)
    start, ends = rng.normal(size=3), rng.normal(size=(50, 3))
    turn = shortest_turn(start, ends)
    cosine = ends @ start / np.linalg.norm(start) / np.linalg.norm(ends, axis=1)
    np.testing.assert_allclose(turn.magnitude(), np.arccos(cosine), atol=1e-9)
    turned = turn.apply(start) / np.linalg.norm(start)
    np.testing.assert_allclose(turned, ends / np.linalg.norm(ends, axis=1)[:, None], atol=1e-12)


def test_the_shortest_turn_to_the_opposite_or_to_nothing_is_defined():
    turn = shortest_turn(np.array([0, 0, 3.0]), np.array([[0, 0, -2.0], [0, 0, 0], [0, 0, 1]]))
    np.testing.assert_allclose(turn.apply([0, 0, 1]), [[0, 0, -1], [0, 0, 1], [0, 0, 1]])


def test_rigid_turns_are_those_of_scipy():
    rng = np.random.default_rng(6)
    still, moving = rng.normal(size=(4, 3)), rng.normal(size=(10, 4, 3))
    turns = rigid_turn(still, moving)
    for turn, frame in zip(turns, moving, strict=True):
        expected, _ = Rotation.align_vectors(frame, still)
        np.testing.assert_allclose(turn.as_matrix(), expected.as_matrix(), atol=1e-9)


def _placed(rest: np.ndarray, seen: np.ndarray, parents: Sequence[int] = PARENTS) -> np.ndarray:
    offsets = np.tile(rest, (len(seen), 1, 1))
    offsets[:, 0] = seen[:, 0]
    return forward_kinematics(parents, offsets, bone_rotations(parents, rest, seen))[0]
