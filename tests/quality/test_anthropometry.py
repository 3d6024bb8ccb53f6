"""Joints that no person has are found, and people of all builds are none of these."""

from itertools import combinations

import numpy as np
import pytest
import xarray as xr

import eigenwalker as ew
from eigenwalker.io.read import read_mocap
from eigenwalker.markers.virtual_markers import virtual_markers
from eigenwalker.quality.anthropometry import wrong_joints
from eigenwalker.quality.assessment import bone_length_variation
from eigenwalker.simulation.walk import simulate_walk

JOINTS = list(ew.JOINTS.markers)
PAIRS = list(combinations(range(15), 2))


@pytest.fixture(scope="module")
def person():
    return simulate_walk(seed=4, duration_s=3, rate_hz=30)


def is_wrong(walk):
    return bool(wrong_joints(walk)) or max(bone_length_variation(walk).values()) > 0.05


def exchanged(walk, one, other):
    values = walk.values.copy()
    values[:, [one, other]] = walk.values[:, [other, one]]
    return walk.copy(data=values)


def stretched(walk, start, end, factor, beyond=()):
    values, place = walk.values.copy(), JOINTS.index
    further = (factor - 1) * (values[:, place(end)] - values[:, place(start)])
    for name in (end, *beyond):
        values[:, place(name)] += further
    return walk.copy(data=values)


def kinds(walk):
    return {each.kind for each in wrong_joints(walk)}


def test_every_exchange_of_two_joints_is_found(person):
    assert [pair for pair in PAIRS if not is_wrong(exchanged(person, *pair))] == []


def test_every_joint_that_is_put_where_another_is_is_found(person):
    for one, other in PAIRS:
        for target, source in ((one, other), (other, one)):
            values = person.values.copy()
            values[:, target] = values[:, source]
            assert "place" in kinds(person.copy(data=values)), (JOINTS[target], JOINTS[source])


@pytest.mark.parametrize("factor", [0.1, 0.5, 2.0])
@pytest.mark.parametrize(
    ("start", "end", "beyond"),
    [
        ("left_hip", "left_knee", ["left_ankle"]),
        ("right_knee", "right_ankle", []),
        ("left_shoulder", "left_elbow", ["left_wrist"]),
        ("right_elbow", "right_wrist", []),
    ],
)
def test_segments_of_wrong_length_are_found(person, factor, start, end, beyond):
    found = wrong_joints(stretched(person, start, end, factor, beyond))
    assert any(each.kind == "length" and each.points == (start, end) for each in found)
    assert any(each.kind == "unequal" for each in found)


def test_both_shanks_of_wrong_length_are_found(person):
    for factor in (0.1, 2.0):
        both = person
        for side in ("left", "right"):
            both = stretched(both, f"{side}_knee", f"{side}_ankle", factor)
        assert kinds(both) >= {"length"}


def test_a_body_twice_or_half_as_broad_is_found(person):
    for factor in (0.5, 2.0):
        assert "breadth" in kinds(person.copy(data=person.values * [1, factor, 1]))


@pytest.mark.parametrize(("torso", "factor"), [(1.4, 0.55), (0.75, 1.8)])
def test_skeletons_that_are_broad_or_narrow_themselves_are_found_once_stretched(
    person, torso, factor
):
    """Where hips and shoulders alone could be those of a skeleton of the other kind."""
    skeleton = person.copy(deep=True)
    for part in ("hip", "shoulder"):
        skeleton.loc[{"marker": [f"left_{part}", f"right_{part}"], "axis": "y"}] *= torso
    assert "breadth" not in kinds(skeleton)
    stretched_whole = skeleton * xr.DataArray([1, factor, 1], dims="axis")
    assert "breadth" in kinds(stretched_whole)


def test_a_camera_that_makes_all_lengths_vary_tells_nothing_of_links(person):
    noise = np.random.default_rng(0).normal(0, 30, person.shape)
    assert "link" not in kinds(person + noise)
    assert "link" in kinds(exchanged(person, JOINTS.index("sternum"), JOINTS.index("left_wrist")))


@pytest.mark.parametrize(
    "build",
    [
        {"height_mm": 1000.0, "frequency_hz": 1.2},
        {"height_mm": 2150.0},
        {"body_mass_index": 50.0},
        {"body_mass_index": 14.0},
        {"step_width_mm": 260.0},
        {"step_width_mm": 10.0},
    ],
)
def test_people_of_all_builds_have_their_joints_in_place(build):
    for seed in (1, 2):
        walk = simulate_walk(seed=seed, duration_s=3, rate_hz=30, **build)
        assert wrong_joints(walk) == ()


def test_the_ends_of_the_built_in_people_have_their_joints_in_place():
    people = ew.load_population()
    space = ew.WalkerSpace().fit(people.X)
    sd = space.transform(people.X).std(axis=0)
    for component in range(4):
        for sign in (-3, 3):
            scores = np.zeros(len(sd))
            scores[component] = sign * sd[component]
            walker = people.walker(space.inverse_transform(scores[None])[0])
            assert wrong_joints(walker.trajectories(np.arange(0, 2, 1 / 30))) == ()


def test_markers_that_are_no_joints_are_not_judged():
    assert wrong_joints(simulate_walk(seed=1, duration_s=2, markers="skin")) == ()


@pytest.mark.parametrize("lacking", ["sternum", "head", "left_wrist", "right_shoulder"])
def test_joints_are_judged_where_others_are_missing(person, lacking):
    assert wrong_joints(person.sel(marker=person.marker != lacking)) == ()
    short = stretched(person, "right_knee", "right_ankle", 0.003)
    found = wrong_joints(short.sel(marker=short.marker != lacking))
    assert {("right_knee", "right_ankle")} <= {each.points for each in found}


def test_joints_that_were_never_seen_hide_no_others(person):
    values = stretched(person, "right_knee", "right_ankle", 0.003).values.copy()
    values[:, JOINTS.index("sternum")] = np.nan
    assert "length" in kinds(person.copy(data=values))


@pytest.mark.parametrize("part", ["hip", "shoulder"])
def test_the_exchanged_pair_is_named(person, part):
    places = [JOINTS.index(f"{side}_{part}") for side in ("left", "right")]
    walk = exchanged(person, *places)
    quality = ew.assess(walk)
    assert ("side", (f"left_{part}", f"right_{part}")) in {
        (each.kind, each.points) for each in quality.wrong_joints
    }
    assert "wrong_joints" in quality.findings
    assert "sides_swapped" not in quality.findings


def test_a_mirrored_capture_is_named_as_one(person):
    mirrored = ew.assess(person.copy(data=person.values * [1, -1, 1]))
    assert "sides_swapped" in mirrored.findings


@pytest.mark.parametrize(
    "attrs", [{"repairs": "x"}, {"rebuilt": 3}, {"n_frames_cut": "3"}, {"repeated": 2.5}]
)
def test_attributes_of_others_change_no_verdict(person, attrs):
    assert ew.assess(person.assign_attrs(attrs)).verdict == ew.assess(person).verdict


@pytest.mark.parametrize(
    ("name", "unit"),
    [("02_01.c3d", "mm"), ("07_01.data3d.txt", "asf"), ("12_01.bvh", "asf"), ("35_01.amc", "asf")],
)
def test_real_joints_are_in_place_and_their_exchanges_are_found(captures, name, unit):
    capture = read_mocap(captures / "cmu" / name, unit=unit, rate_hz=120)
    joints = virtual_markers(capture)[::8]
    assert wrong_joints(joints) == ()
    missed = [pair for pair in PAIRS if not is_wrong(exchanged(joints, *pair))]
    assert [(JOINTS[one], JOINTS[other]) for one, other in missed] == []
