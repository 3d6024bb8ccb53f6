"""Joint angles: known bends come back, from positions and from captured rotations."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings, strategies as st
from scipy.spatial.transform import Rotation

from eigenwalker.core.trajectories import label_trajectories
from eigenwalker.gait.in_place import in_place
from eigenwalker.io.read import read_mocap
from eigenwalker.markers.virtual_markers import virtual_markers
from eigenwalker.metric import angle_between, joint_quaternions
from eigenwalker.metric.comparison_pipeline import with_rotations
from eigenwalker.simulation.walk import simulate_walk


def standing(**places: tuple[float, float, float]) -> xr.DataArray:
    """Someone who stands with arms hanging, but for the joints given."""
    usual = {
        "head": (0, 0, 1600),
        "sternum": (0, 0, 1400),
        "pelvis": (0, 0, 950),
        "left_shoulder": (0, 180, 1400),
        "left_elbow": (0, 180, 1100),
        "left_wrist": (0, 180, 850),
        "left_hip": (0, 90, 900),
        "left_knee": (0, 90, 480),
        "left_ankle": (0, 90, 80),
        "left_toe": (150, 90, 80),
    }
    mirrored = {n.replace("left", "right"): (x, -y, z) for n, (x, y, z) in usual.items()}
    placed = mirrored | usual | places
    values = np.array([[placed[name] for name in placed]] * 2, dtype=float)
    return label_trajectories(values, markers=list(placed), rate_hz=100)


def vector_of(clip: xr.DataArray, joint: str, **how: bool) -> np.ndarray:
    """Rotation vector of a joint in degrees."""
    turn = joint_quaternions(clip, **how).sel(joint=joint).values[0]
    return Rotation.from_quat(turn).as_rotvec(degrees=True)


def test_nothing_is_turned_in_someone_who_stands():
    turns = joint_quaternions(standing())
    np.testing.assert_allclose(np.abs(turns.sel(quaternion="w")), 1, atol=1e-12)
    assert turns.joint.values.tolist()[:3] == ["head", "left_clavicle", "left_upper_arm"]


def test_a_bent_knee_turns_the_calf_about_the_leftward_axis():
    clip = standing(left_ankle=(-400, 90, 480), left_toe=(-400, 90, 330))
    np.testing.assert_allclose(vector_of(clip, "left_calf"), [0, 90, 0], atol=1e-9)
    np.testing.assert_allclose(vector_of(clip, "left_toe"), [0, 0, 0], atol=1e-9)
    np.testing.assert_allclose(vector_of(clip, "left_toe", relative=False), [0, 90, 0], atol=1e-9)


def test_a_bent_elbow_turns_the_forearm_the_other_way():
    clip = standing(left_wrist=(250, 180, 1100))
    np.testing.assert_allclose(vector_of(clip, "left_forearm"), [0, -90, 0], atol=1e-9)


def test_the_plane_of_the_elbow_tells_the_twist_of_the_upper_arm():
    inwards = standing(left_wrist=(0, -70, 1100))  # the forearm points to the right
    twist = vector_of(inwards, "left_upper_arm")
    assert abs(twist[0]) < 1e-9
    assert abs(twist[1]) < 1e-9
    assert -90 < twist[2] < -70  # not all of 90 degrees: as sure as a bend of 90 degrees is


def test_straight_limbs_have_no_twist():
    out = standing(left_elbow=(0, 480, 1400), left_wrist=(0, 730, 1400))
    np.testing.assert_allclose(vector_of(out, "left_upper_arm"), [90, 0, 0], atol=1e-9)


def test_a_leg_that_swings_turns_only_in_the_hip():
    forward = Rotation.from_euler("y", -30, degrees=True)
    hip = np.array([0, 90, 900.0])
    leg = {"left_knee": [0, 90, 480], "left_ankle": [0, 90, 80], "left_toe": [150, 90, 80]}
    moved = {n: tuple(hip + forward.apply(np.array(p) - hip)) for n, p in leg.items()}
    turns = joint_quaternions(standing(**moved))
    angles = angle_between(turns, joint_quaternions(standing()))
    turned = dict(zip(turns.joint.values.tolist(), np.rad2deg(angles[0]), strict=True))
    assert turned.pop("left_thigh") == pytest.approx(30)
    assert max(turned.values()) < 1e-5


@settings(deadline=None, max_examples=15)
@given(st.floats(-3, 3), st.floats(-2000, 2000), st.floats(0.5, 2))
def test_heading_place_and_size_do_not_matter(heading, away, size):
    walk = simulate_walk(seed=2, duration_s=1.0, rate_hz=30)
    turn = Rotation.from_euler("z", heading).as_matrix()
    moved = walk.copy(data=size * walk.values @ turn.T + [away, -away, 0])
    apart = angle_between(joint_quaternions(walk), joint_quaternions(moved))
    np.testing.assert_allclose(apart, 0, atol=1e-6)


def test_what_was_not_seen_is_not_known_and_neither_is_what_hangs_on_it():
    walk = simulate_walk(seed=2, duration_s=1.0, rate_hz=30).copy(deep=True)
    walk.loc[{"marker": "left_elbow"}][3] = np.nan
    turns = joint_quaternions(walk)
    missing = np.isnan(turns).any("quaternion")
    assert {str(turns.joint.values[j]) for _, j in np.argwhere(missing.values)} == {
        "left_upper_arm",
        "left_forearm",
    }
    assert set(np.argwhere(missing.values)[:, 0]) == {3}


def test_bones_that_a_clip_lacks_are_left_out():
    assert "left_toe" not in joint_quaternions(simulate_walk(seed=1, duration_s=1)).joint


def test_someone_without_a_trunk_is_refused():
    walk = simulate_walk(seed=1, duration_s=1).drop_sel(marker=["sternum"])
    with pytest.raises(ValueError, match=r"\['sternum'\] are missing"):
        joint_quaternions(walk)


def test_equal_rotations_are_no_angle_apart_whatever_the_sign():
    q = Rotation.random(20, random_state=1).as_quat()
    np.testing.assert_allclose(angle_between(q, -q), 0, atol=1e-7)
    np.testing.assert_allclose(angle_between(q, q, kind="one_minus_dot"), 0, atol=1e-12)
    np.testing.assert_allclose(angle_between(q, q, kind="as_printed"), 1)  # as A26 says
    with pytest.raises(ValueError, match="one_minus_dot"):
        angle_between(q, q, kind="cosine")  # pyright: ignore[reportArgumentType] - that is the test


def test_angle_is_that_of_scipy():
    a, b = Rotation.random(50, random_state=2), Rotation.random(50, random_state=3)
    apart = (a.inv() * b).magnitude()
    np.testing.assert_allclose(angle_between(a.as_quat(), b.as_quat()), apart, atol=1e-7)


def turned_bodies(walk: xr.DataArray, rest: Rotation) -> xr.DataArray:
    """The walk with rotations of its bones, counted from a rest posture of any kind."""
    turns = joint_quaternions(walk, relative=False)
    rotation = np.full(walk.shape, np.nan)
    starts = {"thigh": "hip", "calf": "knee", "upper_arm": "shoulder", "forearm": "elbow"}
    for side in ("left", "right"):
        for bone, joint in starts.items():
            place = walk.marker.values.tolist().index(f"{side}_{joint}")
            turn = Rotation.from_quat(turns.sel(joint=f"{side}_{bone}").values) * rest
            rotation[:, place] = turn.as_rotvec()
    return walk.assign_coords(rotation=(walk.dims, rotation))


def test_rotations_count_anew_whatever_posture_they_are_counted_from():
    walk = simulate_walk(seed=4, duration_s=2.0, rate_hz=50)
    known = joint_quaternions(walk)
    for seed in range(3):
        other = turned_bodies(walk, Rotation.random(random_state=seed))
        apart = angle_between(joint_quaternions(other), known)
        np.testing.assert_allclose(apart, 0, atol=1e-6)


def test_captured_twist_is_seen_which_positions_do_not_tell():
    walk = turned_bodies(simulate_walk(seed=4, duration_s=2.0, rate_hz=50), Rotation.identity())
    swing = np.deg2rad(10) * np.sin(2 * np.pi * walk.time.values)
    place = walk.marker.values.tolist().index("left_elbow")
    rotation = walk.rotation.values.copy()
    down = Rotation.from_rotvec(swing[:, None] * [0, 0, -1.0])
    rotation[:, place] = (Rotation.from_rotvec(rotation[:, place]) * down).as_rotvec()
    twisted = walk.assign_coords(rotation=(walk.dims, rotation))
    apart = angle_between(joint_quaternions(twisted), joint_quaternions(walk))
    forearm = joint_quaternions(walk).joint.values.tolist().index("left_forearm")
    np.testing.assert_allclose(apart[:, forearm], np.abs(swing), atol=1e-3)
    left_alone = joint_quaternions(twisted, from_positions=True)
    assert left_alone.equals(joint_quaternions(walk, from_positions=True))


@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("bandai-namco/dataset-2_walk_normal_001.bvh", {"unit": "cm"}),
        ("cmu/12_01.bvh", {"unit": "asf"}),
        ("cmu/35_01.amc", {"unit": "asf", "rate_hz": 120}),
    ],
)
def test_positions_and_rotations_of_a_capture_tell_the_same(captures, name, options):
    capture = read_mocap(captures / name, **options)
    walk = in_place(with_rotations(virtual_markers(capture, joints="full"), capture))
    known = np.isfinite(walk.rotation.values).all(axis=(0, 2))
    for bone in ("hip", "knee", "shoulder", "elbow"):
        assert known[walk.marker.values.tolist().index(f"left_{bone}")]
    apart = angle_between(joint_quaternions(walk), joint_quaternions(walk, from_positions=True))
    assert np.rad2deg(np.nanmean(apart)) < 4


def test_a_capture_without_rotations_stays_as_it_is():
    walk = simulate_walk(seed=1, duration_s=1.0)
    assert with_rotations(walk, walk) is walk


def test_of_bodies_that_fit_equally_the_nearest_turns_the_bone(captures):
    """The hand of this capture only turns about the forearm, in which elbow and wrist lie still."""
    capture = read_mocap(captures / "cmu/12_01.bvh", unit="asf")
    joints = with_rotations(virtual_markers(capture, joints="full"), capture)
    bone = joints.rotation.sel(marker="left_elbow").values
    distances = np.linalg.norm(capture - joints.sel(marker="left_elbow"), axis=2).mean(axis=0)
    nearest = capture.marker.values[distances.argmin()]
    np.testing.assert_allclose(bone, capture.rotation.sel(marker=nearest).values)
