"""Loops: the stride of simulated and real walks, and seams that do not show."""

import warnings

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

import eigenwalker as ew
from eigenwalker.core.trajectories import label_trajectories
from eigenwalker.gait.frequency import NoStrideError
from eigenwalker.metric import FrameMetric, loop, motion_map
from eigenwalker.metric.cycles import CYCLE_FRAMES, common_clock
from eigenwalker.metric.loops import period_of
from eigenwalker.simulation.overground import Route
from eigenwalker.simulation.walk import simulate_walk


@settings(max_examples=12, deadline=None)
@given(
    seed=st.integers(0, 1000),
    frequency_hz=st.floats(0.6, 1.2),
    rate_hz=st.sampled_from([25.0, 30.0, 59.94, 100.0, 120.0, 250.0]),
    duration_s=st.floats(3.6, 9.0),
)
def test_a_simulated_stride_lasts_as_long_as_it_was_made(seed, frequency_hz, rate_hz, duration_s):
    walk = simulate_walk(
        seed=seed, frequency_hz=frequency_hz, rate_hz=rate_hz, duration_s=duration_s, truth=False
    )
    found = loop(walk)
    assert found.period_s == pytest.approx(1 / walk.attrs["frequency_hz"], rel=0.005)
    assert found.seam_mm < 5
    assert abs(found.cycle.sizes["time"] - found.period_s * rate_hz) <= 0.5


@pytest.mark.parametrize("variability", [0.0, 1.0])
def test_a_walk_through_the_room_is_looped_in_place(variability):
    walk = simulate_walk(
        seed=3, route=Route(heading_deg=40), duration_s=10, variability=variability, truth=False
    )
    found = loop(walk)
    assert found.period_s == pytest.approx(
        1 / ew.fundamental_frequency(ew.in_place(walk)), rel=0.01
    )
    pelvis = found.cycle.sel(marker="pelvis")
    assert np.ptp(pelvis.sel(axis="x").values) < 100


def test_the_seam_of_a_loop_does_not_show():
    """From the last frame to the first it is as far as between any two others."""
    walk = simulate_walk(seed=2, variability=1.0, noise_mm=1.0, truth=False)
    found = loop(walk)
    assert found.n_periods == 2
    assert 0 < found.seam_mm < 60
    values = found.cycle.values
    steps = np.linalg.norm(np.roll(values, -1, axis=0) - values, axis=2).mean(axis=1)
    assert steps[-1] < 1.2 * steps[:-1].max()
    velocity = np.roll(values, -1, axis=0) - values
    jolts = np.linalg.norm(np.roll(velocity, -1, axis=0) - velocity, axis=2).mean(axis=1)
    assert max(jolts[-2:]) < 1.5 * np.quantile(jolts[:-2], 0.95)


def test_a_loop_of_an_exact_walk_is_that_walk():
    walk = simulate_walk(seed=5, frequency_hz=0.8, duration_s=6.0, truth=False)
    found = loop(walk, already_in_place=True)
    time = walk.time.values
    played = found.trajectories(time - found.start_s)
    np.testing.assert_allclose(played.values, walk.values, atol=2.0)
    assert found.mismatch_mm < 1


def test_the_period_is_that_of_the_lowest_line_in_the_self_map():
    walk = ew.in_place(simulate_walk(seed=4, rate_hz=60, truth=False))
    cells = motion_map(walk, metric=FrameMetric(shape="squared")).values
    lines = np.array([np.diagonal(cells, lag).mean() for lag in range(len(cells) // 2)])
    lag = 20 + int(lines[20:90].argmin())
    assert abs(loop(walk).period_s * 60 - lag) <= 0.5


def test_a_single_stride_is_closed():
    walk = simulate_walk(seed=1, frequency_hz=1.0, duration_s=1.0, rate_hz=100, truth=False)
    found = loop(walk)
    assert found.n_periods == 1
    assert found.period_s == pytest.approx(1.0, abs=0.011)
    steps = np.linalg.norm(np.roll(found.cycle.values, -1, 0) - found.cycle.values, axis=2)
    assert steps[-1].mean() < 1.2 * steps[:-1].mean(axis=1).max()


def test_any_action_that_repeats_can_be_looped_as_it_is():
    time = np.arange(0, 5, 0.02)
    angles = 2 * np.pi * time / 0.73
    wave = np.stack([200 * np.sin(angles), 100 * np.cos(2 * angles), 1500 + 0 * time], axis=1)
    clip = label_trajectories(wave[:, None], markers=["hand"], rate_hz=50)
    assert loop(clip, already_in_place=True).period_s == pytest.approx(0.73, rel=0.002)


def test_rotations_are_looped_with_their_joints():
    walk = simulate_walk(seed=1, duration_s=5, rate_hz=50, frequency_hz=1.0, truth=False)
    angles = 0.5 * np.sin(2 * np.pi * walk.time.values)
    vectors = np.zeros(walk.shape)
    vectors[:, 3, 1] = angles
    vectors[:, 7] = np.nan
    found = loop(walk.assign_coords(rotation=(walk.dims, vectors)))
    turns = found.cycle.rotation.values
    assert np.isnan(turns[:, 7]).all()
    assert np.ptp(turns[:, 3, 1]) == pytest.approx(1.0, abs=0.01)
    on_clock = common_clock(found)
    assert on_clock.sizes["time"] == CYCLE_FRAMES
    assert np.ptp(on_clock.rotation.values[:, 3, 1]) == pytest.approx(1.0, abs=0.01)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (np.random.default_rng(0).normal(size=(400, 3, 3)) * 100, "Nothing repeats"),
        (np.zeros((400, 3, 3)), "Nothing repeats"),
        (np.arange(400.0)[:, None, None] * np.ones((1, 3, 3)), "Nothing repeats"),
        (np.full((400, 3, 3), np.nan), "missing"),
    ],
)
def test_what_does_not_repeat_is_refused(values, message):
    clip = label_trajectories(values, markers=["a", "b", "c"], rate_hz=100)
    with pytest.raises(ValueError, match=message):
        loop(clip, already_in_place=True)


@pytest.mark.parametrize("noise_mm", [0.0, 0.01])
def test_a_still_clip_is_no_loop(noise_mm):
    still = 500 + noise_mm * np.random.default_rng(0).uniform(size=(600, 3, 3))
    clip = label_trajectories(still, markers=["a", "b", "c"], rate_hz=50)
    with pytest.raises(NoStrideError, match="Nothing repeats"):
        loop(clip, already_in_place=True)


def test_a_point_that_stands_in_the_room_does_not_hide_the_stride():
    """Such as the root of a BVH, from which the walker walks away."""
    walk = simulate_walk(seed=3, route=Route(heading_deg=40), duration_s=8, rate_hz=60, truth=False)
    values = np.concatenate([walk.values, np.zeros((len(walk), 1, 3))], axis=1)
    names = [*walk.marker.values.tolist(), "joint_Root"]
    found = loop(label_trajectories(values, markers=names, rate_hz=60))
    assert found.period_s == pytest.approx(loop(walk).period_s, rel=0.01)


@settings(max_examples=40, deadline=None)
@given(period=st.floats(9, 60), n_periods=st.floats(2.1, 6), phase=st.floats(0, 6))
def test_periods_are_found_to_a_fraction_of_a_frame(period, n_periods, phase):
    angles = 2 * np.pi * np.arange(int(period * n_periods)) / period + phase
    movement = np.stack([np.sin(angles), 0.5 * np.cos(2 * angles), np.cos(angles + 1)], axis=1)
    assert period_of(movement, 15) == pytest.approx(period, rel=0.01)


REAL = [
    *(f"bandai-namco/dataset-2_walk_{style}_003.bvh" for style in ("active", "elderly", "normal")),
    "bandai-namco/dataset-2_walk_exhausted_011.bvh",
    "bandai-namco/dataset-2_walk_exhausted_023.bvh",
    "cmu/02_01.c3d",
    "cmu/07_01.data3d.txt",
    "cmu/12_01.bvh",
    "cmu/35_01.amc",
]


@pytest.mark.parametrize("name", REAL)
def test_real_strides_last_as_long_as_the_model_says(captures, name):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        walk = ew.virtual_markers(ew.read_mocap(captures / name))
    found = loop(walk)
    frequency_hz = ew.fundamental_frequency(ew.in_place(walk))
    assert found.period_s == pytest.approx(1 / frequency_hz, rel=0.01)
    assert found.seam_mm < 70


@pytest.mark.parametrize(("n_frames", "rate_hz"), [(2, 100.0), (7, 100.0), (50, 0.5)])
def test_too_few_frames_are_refused_with_words(n_frames, rate_hz):
    values = np.random.default_rng(0).normal(size=(n_frames, 2, 3))
    clip = label_trajectories(values, markers=["a", "b"], rate_hz=rate_hz)
    with pytest.raises(ValueError, match="too few to see a stride"):
        loop(clip)


def test_a_walk_in_place_gives_the_loop_of_its_capture():
    capture = simulate_walk(seed=6, rate_hz=60, variability=1.0, duration_s=8, truth=False)
    walk = ew.in_place(capture)
    assert loop(walk).start_s == loop(capture).start_s
    np.testing.assert_allclose(loop(walk).cycle, loop(capture).cycle)
    less = walk.isel(time=slice(20, None))
    assert loop(less).period_s == pytest.approx(loop(walk).period_s, rel=0.005)


@pytest.mark.parametrize("share", [0.8, 0.85, 0.9])
@pytest.mark.parametrize("seed", [1, 2])
def test_less_than_a_stride_is_no_loop_wherever_it_begins(seed, share):
    walk = simulate_walk(seed=seed, truth=False)
    n_frames = 120 / walk.attrs["frequency_hz"]
    for start in range(0, 140, 20):
        piece = walk.isel(time=slice(start, start + round(share * n_frames)))
        try:
            found = loop(piece)
        except NoStrideError:
            continue
        assert found.seam_mm > 20  # and it says so


def test_clips_that_do_not_repeat_are_told_so_in_words():
    time = np.arange(0, 1.5, 1 / 120)
    way = np.clip(time / 1.2, 0, 1) ** 2
    values = np.stack([[300 * way, 50 + 0 * way, 900 + 200 * way], [0 * way, 0 * way, 1400 + way]])
    reach = label_trajectories(values.transpose(2, 0, 1), markers=["hand", "head"], rate_hz=120)
    with pytest.raises(NoStrideError) as refused:
        loop(reach)
    assert "operands" not in str(refused.value)


def test_points_of_one_name_are_refused():
    walk = simulate_walk(seed=1, duration_s=3, truth=False)
    twice = walk.isel(marker=[0, 1, 2, 2])
    with pytest.raises(ValueError, match=r"more than once: \['left_shoulder'\]"):
        loop(twice)


def test_skeletons_with_an_origin_have_the_period_of_their_joints(captures):
    for name in ("masculine_008", "active_021", "normal_001"):
        path = captures / "bandai-namco" / f"dataset-2_walk_{name}.bvh"
        capture = ew.read_mocap(path, unit="cm")
        joints = ew.in_place(ew.virtual_markers(capture))
        period = 1 / ew.decompose_fourier(joints).frequency_hz
        assert loop(capture).period_s == pytest.approx(period, rel=0.01)
