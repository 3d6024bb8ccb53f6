"""Events and gait parameters against what was put into simulated walks."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from eigenwalker.core.walker import Walker
from eigenwalker.gait.events import gait_events
from eigenwalker.gait.heading import goes_backwards
from eigenwalker.gait.in_place import in_place
from eigenwalker.gait.parameters import gait_parameters
from eigenwalker.io.read import read_mocap
from eigenwalker.markers.virtual_markers import virtual_markers
from eigenwalker.simulation.walk import simulate_walk


@pytest.fixture(scope="module")
def walks():
    return [simulate_walk(seed=seed, duration_s=5, rate_hz=120) for seed in range(4)]


def legs(**changes):
    """Two feet that swing 300 mm to and fro and a pelvis that bobs twice a stride."""
    facts = {
        "markers": ["pelvis", "left_ankle", "right_ankle"],
        "p0": [[0, 0, 900], [0, 60, 80], [0, -60, 80]],
        "p": [
            [[0, 0, 0], [300, 0, 0], [-300, 0, 0]],
            [[0, 0, 20], [0, 0, 0], [0, 0, 0]],
        ],
        "harmonics": [1, 2],
        "phases": [0, 0.4],
        "frequency_hz": 0.9,
        "speed_mm_s": 1080.0,
    }
    return Walker(**(facts | changes))


def test_feet_strike_in_front_and_leave_behind():
    walker = legs()
    events = gait_events(walker.trajectories(np.arange(0, 3, 0.01)))
    strikes = events.query("side == 'left' and event == 'heel_strike'").time_s
    np.testing.assert_allclose(strikes, (np.arange(3) + 0.25) / 0.9, atol=1e-4)
    np.testing.assert_array_equal(events.time_s, np.sort(events.time_s))


def test_heels_and_toes_are_preferred_to_ankles():
    walk = legs().trajectories(np.arange(0, 3, 0.01))
    later = walk.sel(marker=["left_ankle"]).assign_coords(marker=["left_heel"]).shift(time=5)
    toe = walk.sel(marker=["left_ankle"]).assign_coords(marker=["left_toe"])
    both = np.concatenate([walk.values, later.values, toe.values], axis=1)[5:]
    full = walk.copy(deep=True)[5:]
    full = full.reindex(marker=[*walk.marker.values, "left_heel", "left_toe"]).copy(data=both)
    events = gait_events(full)
    told = events.groupby(["side", "event"]).marker.first()
    assert told["left", "heel_strike"] == "left_heel"
    assert told["left", "toe_off"] == "left_toe"
    assert told["right", "toe_off"] == "right_ankle"
    plain = gait_events(walk)
    late = [
        table.query("side == 'left' and event == 'heel_strike'").time_s.to_numpy()
        for table in (events, plain)
    ]
    assert late[0][0] - late[1][0] == pytest.approx(0.05, abs=1e-3)


def test_events_of_ankles_are_as_early_as_stated(walks):
    early = {"heel_strike": [], "toe_off": []}
    for walk in walks:
        found = gait_events(walk)
        for side in ("left", "right"):
            change = np.diff(walk[f"{side}_stance"].values.astype(int))
            for event, step in (("heel_strike", 1), ("toe_off", -1)):
                truth = walk.time.values[1:][change == step]
                times = found.query("side == @side and event == @event").time_s.to_numpy()
                ahead = truth[None] - times[:, None]
                nearest = np.abs(ahead).min(axis=1) < 0.2
                ahead = ahead[np.arange(len(times)), np.abs(ahead).argmin(axis=1)][nearest]
                early[event] += (ahead * walk.attrs["frequency_hz"]).tolist()
    assert np.mean(early["heel_strike"]) == pytest.approx(0.05, abs=0.015)
    assert np.mean(early["toe_off"]) == pytest.approx(0.02, abs=0.015)


def test_parameters_of_a_walker_are_those_it_was_made_with():
    told = gait_parameters(legs())
    assert told.cadence_steps_min == pytest.approx(108)
    assert told.stride_length_mm == pytest.approx(1200)
    assert told.step_length_left_mm == pytest.approx(600, abs=0.1)
    assert told.step_width_mm == pytest.approx(120)
    assert told.pelvis_vertical_range_mm == pytest.approx(40, abs=0.1)
    assert told.stance_share_left == pytest.approx(0.5, abs=1e-3)
    assert told.double_support_share == pytest.approx(0, abs=1e-3)
    assert told.step_asymmetry == pytest.approx(0, abs=1e-3)


def test_an_early_foot_makes_its_step_short():
    """The left foot strikes 5 % of a stride early: its step is shorter, the right one longer."""
    swing = np.array([[0, 0, 0], [300, 0, 0], [0, 0, 0]])
    other = np.array([[0, 0, 0], [0, 0, 0], [-300, 0, 0]])
    told = gait_parameters(legs(p=[swing, other], harmonics=[1, 1], phases=[2 * np.pi * 0.05, 0.0]))
    assert told.step_length_left_mm == pytest.approx(600 - 0.05 * 1200, abs=0.5)
    assert told.step_length_right_mm == pytest.approx(600 + 0.05 * 1200, abs=0.5)
    assert told.step_asymmetry == pytest.approx(-0.2, abs=1e-3)


def test_simulated_people_walk_as_they_were_told(walks):
    for walk in walks:
        truth = walk.attrs
        assert gait_parameters(walk).speed_mm_s == pytest.approx(truth["speed_mm_s"], rel=0.06)
        told = gait_parameters(walk, speed_mm_s=truth["speed_mm_s"])
        assert told.frequency_hz == pytest.approx(truth["frequency_hz"], abs=1e-3)
        assert told.stride_length_mm == pytest.approx(
            told.step_length_left_mm + told.step_length_right_mm, rel=1e-3
        )
        assert told.step_width_mm == pytest.approx(truth["step_width_mm"], abs=12)
        stance = (told.stance_share_left + told.stance_share_right) / 2
        assert stance == pytest.approx(truth["stance_share"] + 0.03, abs=0.025)


def test_uneven_strides_show_in_their_variation():
    even = gait_parameters(simulate_walk(seed=3, duration_s=12))
    uneven = gait_parameters(in_place(simulate_walk(seed=3, duration_s=12, variability=1.0)))
    assert even.stride_time_cv < 0.002 < 0.005 < uneven.stride_time_cv < 0.05


def test_walks_without_ankles_are_refused(walks):
    with pytest.raises(ValueError, match="virtual_markers"):
        gait_parameters(walks[0].drop_sel(marker=["left_ankle"]))


def test_what_too_few_strides_cannot_tell_is_nan(walks):
    told = gait_parameters(walks[0][:160])
    assert np.isnan(told.stride_time_cv)
    assert told.cadence_steps_min > 60


def test_a_capture_that_travels_has_the_parameters_of_its_walk_in_place(captures) -> None:
    joints = virtual_markers(read_mocap(captures / "cmu" / "02_01.c3d"))
    pd.testing.assert_series_equal(gait_parameters(joints), gait_parameters(in_place(joints)))


@pytest.mark.parametrize("travels", [False, True])
def test_a_walk_that_is_played_backwards_has_the_shares_of_the_forward_one(travels):
    walk = simulate_walk(seed=3, duration_s=8)
    if travels:
        progress = walk.attrs["speed_mm_s"] * walk.time.values
        walk = walk.copy(data=walk.values + np.multiply.outer(progress, [1, 0, 0])[:, None])
    forwards = gait_parameters(walk)
    backwards = gait_parameters(walk[::-1].assign_coords(time=walk.time.values))
    assert backwards.speed_mm_s == pytest.approx(-forwards.speed_mm_s, rel=1e-3)
    for name in ("stance_share_left", "double_support_share", "stride_length_mm"):
        assert backwards[name] == pytest.approx(forwards[name], rel=0.02)
    assert backwards.step_length_left_mm > 0.45 * backwards.stride_length_mm
    assert 0 < backwards.double_support_share < 1


def test_a_flat_walk_has_steps_without_width_and_its_own_speed():
    walk = simulate_walk(seed=3, duration_s=8)
    flat = in_place(walk.copy(data=walk.values * [1, 0, 1]))
    told = gait_parameters(flat)
    assert flat.attrs["heading_deg"] == pytest.approx(0, abs=1e-6)
    assert told.speed_mm_s == pytest.approx(walk.attrs["speed_mm_s"], rel=0.06)
    assert told.step_width_mm == pytest.approx(0, abs=1e-6)
    assert abs(told.step_asymmetry) < 0.1


def test_a_walk_that_travels_without_a_known_speed_has_the_same_events(walks):
    walk = walks[0].drop_vars("speed_mm_s", errors="ignore")
    speed = walks[0].attrs["speed_mm_s"]
    there = walk + xr.DataArray([speed, 0, 0], dims="axis") * (walk.time - walk.time[0])
    there = there.transpose(*walk.dims).assign_attrs(walk.attrs)
    expected = gait_events(walks[0])
    for same in (walk, there):
        found = gait_events(same)
        assert found["event"].tolist() == expected["event"].tolist()
        np.testing.assert_allclose(found["time_s"], expected["time_s"], atol=1e-6)
    reversed_values = there.values[::-1]
    assert goes_backwards(there.copy(data=reversed_values))
    assert goes_backwards(walk.copy(data=walk.values[::-1]))
