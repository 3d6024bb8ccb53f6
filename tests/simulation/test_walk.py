"""A simulated walk walks: rigid bones, feet that hold the ground, and a truth to test against."""

import itertools

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings, strategies as st

from eigenwalker.core import JOINTS
from eigenwalker.gait import fundamental_frequency, gait_events, in_place
from eigenwalker.markers import virtual_markers
from eigenwalker.simulation import (
    PARAMETERS,
    TOE_BEND,
    Route,
    average_person,
    draw_people,
    simulate_walk,
    true_events,
)

BONES = [
    *(("sternum", "pelvis"), ("left_hip", "right_hip")),
    *((f"{s}_{a}", f"{s}_{b}") for s in ("left", "right") for a, b in (
        ("hip", "knee"), ("knee", "ankle"), ("shoulder", "elbow"), ("elbow", "wrist"),
    )),
    *((f"{s}_shoulder", "sternum") for s in ("left", "right")),
    *((f"{s}_hip", "pelvis") for s in ("left", "right")),
]  # fmt: skip


@pytest.fixture(scope="module")
def people():
    return [dict(person) for _, person in draw_people(5, 5, seed=8).iterrows()]


def at(walk, marker):
    return walk.sel(marker=marker).values


def lengths(walk, bone):
    return np.linalg.norm(at(walk, bone[0]) - at(walk, bone[1]), axis=1)


def test_bones_are_rigid_even_when_strides_vary(people):
    for person in people:
        walk = simulate_walk(person, variability=1, wander_mm=10)
        assert max(np.ptp(lengths(walk, bone)) for bone in BONES) < 0.1


def test_left_and_right_legs_are_alike_in_length(people):
    walk = simulate_walk(people[0])
    for part in (("hip", "knee"), ("knee", "ankle"), ("elbow", "wrist")):
        left, right = (lengths(walk, [f"{s}_{p}" for p in part])[0] for s in ("left", "right"))
        assert left == pytest.approx(right, abs=0.1)


def soles(walk, side):
    """Heel, ball and toes on the belt, where each of them bears the foot, stance by stance."""
    belt = np.outer(walk.attrs["speed_mm_s"] * walk["time"].values, [1, 0, 0])
    pitch = np.radians(walk[f"{side}_foot_pitch_deg"].values)
    bears = {
        "heel": pitch <= 0,
        "ball": (pitch >= 0) & (pitch <= TOE_BEND),
        "toe": pitch > TOE_BEND,
    }
    stance = walk[f"{side}_stance"].values
    number = np.cumsum(np.diff(stance.astype(int), prepend=0) == 1)
    for which in range(number.min() + 1, number.max()):
        for point, bearing in bears.items():
            here = stance & bearing & (number == which)
            if here.sum() > 2:
                yield at(walk, f"{side}_{point}")[here] + belt[here]


def test_feet_stay_where_they_stand(people):
    slips, heights = [], []
    for seed, person in enumerate(people):
        walk = simulate_walk(person, seed=seed, markers="full", variability=1, wander_mm=10)
        planted = [sole for side in ("left", "right") for sole in soles(walk, side)]
        slips.append(max(np.hypot(*np.ptp(sole[:, :2], axis=0)) for sole in planted))
        heights.append(max(np.abs(sole[:, 2]).max() for sole in planted))
    assert np.median(slips) < 5
    assert max(slips) < 10
    assert max(heights) < 10


def test_swinging_feet_clear_the_ground(people):
    for seed, person in enumerate(people):
        walk = simulate_walk(person, seed=seed, markers="full", variability=1)
        for side in ("left", "right"):
            own = (walk["phase"].values - (side == "right") * walk.attrs["right_onset"]) % 1.0
            swing = (own - walk.attrs["stance_of_stride"]) / (1 - walk.attrs["stance_of_stride"])
            mid = (swing > 0.25) & (swing < 0.8)
            lowest = min(at(walk, f"{side}_{p}")[mid, 2].min() for p in ("heel", "ball", "toe"))
            assert lowest >= 10


def test_no_knee_or_elbow_bends_backwards(people):
    for seed, person in enumerate(people):
        walk = simulate_walk(person, seed=seed, variability=1)
        for side in ("left", "right"):
            assert walk[f"{side}_knee_flexion_deg"].min() > 0
            assert walk[f"{side}_elbow_flexion_deg"].min() > 0


def test_left_and_right_are_half_a_stride_apart(people):
    for person in people:
        walk = simulate_walk(person, frequency_hz=1.0, rate_hz=100, duration_s=4)
        left, right = (at(walk, f"{s}_ankle") - at(walk, "pelvis") for s in ("left", "right"))
        later = np.roll(right, -50, axis=0)
        assert np.sqrt(np.mean((left - later)[:, [0, 2]] ** 2)) < 25
        assert abs(walk.attrs["right_onset"] - 0.5) < 0.02


def test_arms_swing_against_the_legs_of_their_side(people):
    for person in people:
        walk = simulate_walk(person)
        for side in ("left", "right"):
            wrist = at(walk, f"{side}_wrist")[:, 0]
            ankle = at(walk, f"{side}_ankle")[:, 0]
            assert np.corrcoef(wrist, ankle)[0, 1] < -0.5


def test_the_pelvis_rises_twice_a_stride_and_the_head_keeps_steady():
    walk = simulate_walk(average_person(), frequency_hz=1.0, rate_hz=100, duration_s=10)
    spectrum = np.abs(np.fft.rfft(at(walk, "pelvis")[:, 2]))[1:]
    assert spectrum.argmax() + 1 == 20
    assert np.ptp(at(walk, "head")[:, 2]) < 60
    assert np.ptp(at(walk, "head")[:, 1]) < 80


def test_knees_and_ankles_bend_as_far_as_published(people):
    """Schwartz, Rozumalski & Trost 2008, with their SDs between people."""
    found = []
    for person in people:
        walk = simulate_walk(person, duration_s=3)
        stride = walk.isel(time=walk["phase"].values < 1)
        knee, ankle = (
            stride[f"left_{joint}_deg"].values for joint in ("knee_flexion", "ankle_dorsiflexion")
        )
        half = len(knee) // 2
        found.append([knee[0], knee[:half].max(), knee.max(), ankle[:half].max(), ankle.min()])
    published, spread = [5.6, 20.0, 60.5, 12.8, -22.0], [4.7, 4.3, 4.8, 3.6, 7.4]
    assert (np.abs(np.mean(found, axis=0) - published) < spread).all()


@settings(max_examples=15, deadline=None)
@given(st.lists(st.floats(-2, 2), min_size=len(PARAMETERS), max_size=len(PARAMETERS)))
def test_anybody_can_walk(scores):
    pairs = zip(PARAMETERS.items(), scores, strict=True)
    person = {n: (p.female + p.male) / 2 + score * p.sd for (n, p), score in pairs}
    walk = simulate_walk(person, markers="full", duration_s=3)
    assert walk["left_knee_flexion_deg"].min() > 0
    assert walk.sel(axis="z").min() > -12
    assert np.ptp(lengths(walk, ("left_knee", "left_ankle"))) < 0.1


def test_the_same_seed_gives_the_same_walk():
    first, again, other = (simulate_walk(seed=s, variability=1) for s in (3, 3, 4))
    np.testing.assert_array_equal(first.values, again.values)
    assert np.abs(first.values - other.values).max() > 10


def test_noise_and_gaps_change_nothing_else():
    clean = simulate_walk(seed=3, variability=1)
    noisy = simulate_walk(seed=3, variability=1, noise_mm=2.0, gap_share=0.05)
    missing = np.isnan(noisy.values).any(axis=2)
    assert 0.03 < missing.mean() < 0.07
    assert np.nanstd(noisy.values - clean.values) == pytest.approx(2.0, rel=0.05)
    np.testing.assert_array_equal(noisy["phase"], clean["phase"])


def test_the_stride_frequency_is_the_one_asked_for():
    walk = simulate_walk(seed=2, frequency_hz=0.87, noise_mm=1)
    assert walk.attrs["frequency_hz"] == pytest.approx(0.87)
    assert fundamental_frequency(walk) == pytest.approx(0.87, abs=1e-3)


def test_strides_vary_as_asked():
    steady = true_events(simulate_walk(average_person(), duration_s=60))
    varied = true_events(simulate_walk(average_person(), duration_s=60, variability=1))

    def cv(events):
        strikes = events.query("side == 'left' and event == 'heel_strike'")["time_s"]
        return np.diff(strikes).std() / np.diff(strikes).mean()

    assert cv(steady) < 1e-6
    assert 0.006 < cv(varied) < 0.03


def test_events_are_where_feet_touch_and_leave():
    walk = simulate_walk(seed=5, duration_s=5)
    events = true_events(walk)
    stance = walk["left_stance"].values
    begins = walk["time"].values[1:][np.diff(stance.astype(int)) == 1]
    strikes = events.query("side == 'left' and event == 'heel_strike'")["time_s"]
    np.testing.assert_allclose(begins, strikes[strikes > 0], atol=1 / 120)


def test_true_events_merge_with_estimated_ones():
    walk = simulate_walk(seed=5, duration_s=5, markers="full")
    true, estimated = true_events(walk), gait_events(walk)
    assert list(true) == list(estimated)
    both = pd.merge_asof(
        true.query("0.3 < time_s < 4.7"), estimated.rename(columns={"time_s": "estimated_s"}),
        left_on="time_s", right_on="estimated_s", by=["side", "event", "marker"],
        direction="nearest",
    )  # fmt: skip
    assert len(both) > 12
    assert (both["time_s"] - both["estimated_s"]).abs().max() < 0.06


def test_a_walk_over_ground_is_brought_back_in_place():
    route = Route(standing_s=1.5, heading_deg=30)
    walk = simulate_walk(seed=1, route=route, variability=1, noise_mm=1)
    assert np.ptp(at(walk, "pelvis")[:150], axis=0).max() < 30
    placed = in_place(walk)
    assert placed.attrs["speed_mm_s"] == pytest.approx(walk.attrs["speed_mm_s"], rel=0.02)
    assert placed.attrs["heading_deg"] == pytest.approx(30, abs=2)


def test_one_can_walk_a_bend():
    walk = simulate_walk(seed=1, route=Route(turning_deg_s=10), duration_s=9)
    across = at(walk, "left_hip") - at(walk, "right_hip")
    facing = np.degrees(np.unwrap(np.arctan2(-across[:, 0], across[:, 1])))
    assert facing[-1] - facing[0] == pytest.approx(90, abs=15)
    assert max(np.ptp(lengths(walk, bone)) for bone in BONES) < 0.1


def test_a_drifting_belt_carries_the_walker_away():
    walk = simulate_walk(seed=1, drift_mm_s=20) - simulate_walk(seed=1)
    assert walk.isel(time=-1, axis=0).values == pytest.approx(20 * 1439 / 120)


def test_markers_on_the_skin_tell_where_the_joints_are():
    joints = simulate_walk(seed=4, duration_s=3)
    skin = simulate_walk(seed=4, duration_s=3, markers="skin")
    assert skin.sizes["marker"] == 38
    miss = np.linalg.norm(virtual_markers(skin).values - joints.values, axis=2).mean(axis=0)
    near = dict(zip(JOINTS.markers, miss, strict=True))
    assert max(near[name] for name in ("head", "sternum", "pelvis", "left_wrist")) < 8
    assert max(miss) < 40


def test_skin_moves_over_the_bones_unless_glued():
    loose, glued = (
        simulate_walk(seed=4, duration_s=3, markers="skin", soft_tissue=s) for s in (1, 0)
    )
    assert np.ptp(lengths(glued, ("LTHI", "LKNE"))) < 0.1
    assert np.ptp(lengths(loose, ("LTHI", "LKNE"))) > 3
    assert np.ptp(lengths(glued, ("LASI", "RASI"))) < 0.1


def test_what_cannot_be_walked_is_refused():
    with pytest.raises(ValueError, match="no \\['armswing'\\]"):
        simulate_walk(armswing=3)
    with pytest.raises(ValueError, match=r"gap_share=1\.5 must be from 0 to below 1"):
        simulate_walk(gap_share=1.5)
    with pytest.raises(ValueError, match="markers='all' is not known"):
        simulate_walk(markers="all")
    with pytest.raises(ValueError, match="sex='man' is not known"):
        simulate_walk(sex="man")


def test_one_can_ask_for_a_woman_or_a_man():
    for sex in ("female", "male"):
        assert {simulate_walk(seed=s, sex=sex, duration_s=1).attrs["sex"] for s in range(4)} == {
            sex
        }


def curves(walk):
    """Thigh, knee, upper arm and elbow over a stride that begins with the foot furthest ahead."""
    found = {}
    for side in ("left", "right"):

        def rise(above, below, side=side):
            bone = at(walk, f"{side}_{below}") - at(walk, f"{side}_{above}")
            return np.degrees(np.arctan2(bone[:, 0], -bone[:, 2])), bone

        ahead = (at(walk, f"{side}_ankle") - at(walk, "pelvis"))[:, 0]
        time, period = walk["time"].values, 1 / fundamental_frequency(walk)
        reach = round(0.3 * period / (time[1] - time[0]))
        peaks = [
            i for i in range(1, len(ahead) - 1)
            if ahead[i] == ahead[max(0, i - reach) : i + reach + 1].max()
        ]  # fmt: skip
        thigh, shank = rise("hip", "knee")[0], rise("knee", "ankle")[0]
        arm, upper = rise("shoulder", "elbow")
        _, fore = rise("elbow", "wrist")
        norms = np.linalg.norm(upper, axis=1) * np.linalg.norm(fore, axis=1)
        elbow = np.degrees(np.arccos(np.clip((upper * fore).sum(axis=1) / norms, -1, 1)))
        joints = {"thigh": thigh, "knee": thigh - shank, "arm": arm, "elbow": elbow}
        for name, curve in joints.items():
            for first, last in itertools.pairwise(peaks):
                at_shares = np.linspace(time[first], time[last], 50)
                found.setdefault(name, []).append(np.interp(at_shares, time, curve))
    return {name: np.mean(strides, axis=0) for name, strides in found.items()}


def test_joints_turn_as_in_real_level_walks(captures):
    from eigenwalker.io.read import read_mocap

    def walked(paths):
        walks = [curves(in_place(virtual_markers(read_mocap(path)))) for path in paths]
        return {joint: np.mean([one[joint] for one in walks], axis=0) for joint in walks[0]}

    normal = sorted((captures / "bandai-namco").rglob("*normal*.bvh"))[::4]
    level = sorted((captures / "cmu").glob("*_01.*"))
    with np.errstate(all="ignore"), pytest.warns():
        sets = [walked(paths) for paths in (normal, level)]
    simulated = [curves(simulate_walk(seed=seed, duration_s=6)) for seed in range(40)]
    for joint in ("thigh", "knee", "arm", "elbow"):
        real = np.mean([one[joint] for one in sets], axis=0)
        miss = np.mean([one[joint] for one in simulated], axis=0) - real
        assert np.std(miss) < 6, joint
        assert np.sqrt(np.mean(miss**2)) < 10, joint
