"""The stride frequency: known truth, then what must not change it, then one real stride."""

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from eigenwalker.core.trajectories import label_trajectories
from eigenwalker.core.walker import Walker
from eigenwalker.gait.frequency import (
    NoStrideError,
    frequency_of_scores,
    fundamental_frequency,
)
from eigenwalker.simulation.walk import simulate_walk


def some_walker(seed=0, *, n_markers=15, frequency_hz=0.85, second=0.25):
    """A walker of random postures whose second harmonic is smaller than the first."""
    rng = np.random.default_rng(seed)
    size = np.array([100, 90, 100 * second, 90 * second])[:, None, None]
    return Walker(
        [f"m{number}" for number in range(n_markers)],
        rng.normal(size=(n_markers, 3)) * 500,
        rng.normal(size=(4, n_markers, 3)) * size,
        [1, 1, 2, 2],
        rng.uniform(-3, 3, 4),
        frequency_hz,
    )


@settings(max_examples=60, deadline=None)
@given(
    seed=st.integers(0, 10_000),
    n_markers=st.integers(1, 20),
    frequency_hz=st.floats(0.45, 1.5),
    second=st.floats(0.05, 0.6),
    rate_hz=st.sampled_from([25, 30, 60, 100, 120, 250, 1000]),
    n_strides=st.floats(1.7, 9),
    start_s=st.floats(-100, 100),
    away_mm=st.sampled_from([0.0, 1e5]),
)
def test_a_pure_walker_has_the_frequency_it_was_made_with(
    seed, n_markers, frequency_hz, second, rate_hz, n_strides, start_s, away_mm
):
    walker = some_walker(seed, n_markers=n_markers, frequency_hz=frequency_hz, second=second)
    time = start_s + np.arange(int(n_strides / frequency_hz * rate_hz)) / rate_hz
    found = fundamental_frequency(walker.trajectories(time) + away_mm)
    assert found == pytest.approx(frequency_hz, rel=1e-8)


@pytest.mark.parametrize("seed", range(5))
def test_twelve_noisy_seconds_tell_the_frequency_to_a_thousandth_of_a_hertz(seed):
    walk = some_walker(seed, frequency_hz=0.7 + 0.1 * seed).trajectories(np.arange(1440) / 120)
    noise = np.random.default_rng(seed).normal(size=walk.shape)
    assert abs(fundamental_frequency(walk + noise) - (0.7 + 0.1 * seed)) < 1e-4


def test_progress_through_the_room_does_not_matter():
    walk = some_walker().trajectories(np.arange(500) / 120)
    along = walk + 1300 * walk.time.values[:, None, None] * np.array([0, -1, 0.02])
    assert fundamental_frequency(along) == pytest.approx(0.85, abs=1e-9)


def test_slow_wander_on_the_belt_does_not_matter():
    walk = some_walker().trajectories(np.arange(1440) / 120)
    wander = 60 * np.sin(2 * np.pi * 0.08 * walk.time.values)[:, None, None] * np.array([1, 1, 0])
    assert fundamental_frequency(walk + wander) == pytest.approx(0.85, abs=2e-3)


def test_neither_half_nor_double_is_taken_for_a_single_sine():
    time = np.arange(0, 12, 0.01)
    for frequency_hz in np.linspace(0.5, 1.9, 15):
        scores = np.sin(2 * np.pi * frequency_hz * time + 1)[:, None]
        assert frequency_of_scores(scores, 100) == pytest.approx(frequency_hz, rel=1e-9)


def test_a_head_that_bobs_more_than_it_sways_still_walks_at_the_stride_frequency():
    time = np.arange(0, 8, 0.01)
    cycle = 2 * np.pi * 0.9 * time
    head = np.stack([8 * np.sin(2 * cycle + 1), 20 * np.sin(cycle), 30 * np.sin(2 * cycle)], axis=1)
    walk = label_trajectories(head[:, None], markers=["head"], rate_hz=100)
    assert fundamental_frequency(walk) == pytest.approx(0.9, abs=1e-9)


def test_more_harmonics_may_take_part():
    time = np.arange(0, 6, 0.01)
    cycle = 2 * np.pi * 0.8 * time[:, None] * np.arange(1, 5)
    scores = np.sin(cycle + np.arange(4)) @ np.diag([5, 2, 1, 0.5]) @ np.ones((4, 3))
    assert frequency_of_scores(scores, 100, n_harmonics=4) == pytest.approx(0.8, abs=1e-10)


def test_too_little_is_refused_in_a_sentence():
    walk = some_walker().trajectories(np.arange(1440) / 120)
    with pytest.raises(ValueError, match="too short for a stride"):
        fundamental_frequency(walk[:20])
    with pytest.raises(ValueError, match="Nothing moves"):
        fundamental_frequency(walk * 0 + 1e5)
    with pytest.raises(ValueError, match="in_place"):
        fundamental_frequency(walk.where(walk.time > 1))


@pytest.mark.parametrize("rate_hz", [60, 100, 120, 150])
@pytest.mark.parametrize("point", [slice(None), slice(0, 1), slice(2, 3), slice(12, 13)])
def test_repeats_of_a_real_stride_have_its_frequency(captures, rate_hz, point):
    stride = np.loadtxt(captures / "delussanet" / "sample_walker3.txt").reshape(99, 16, 3)[:, point]
    for n_strides in (2, 2.6, 3):
        frames = np.arange(int(n_strides * 99)) % 99
        found = frequency_of_scores(stride[frames].reshape(len(frames), -1), rate_hz)
        assert found == pytest.approx(rate_hz / 99, rel=5e-3)


@pytest.mark.parametrize("share", [0.2, 0.1, 0.05, 0.03])
def test_a_weak_first_harmonic_still_sets_the_stride(share: float) -> None:
    rng = np.random.default_rng(int(1000 * share))
    for _ in range(10):
        stride_hz = rng.uniform(0.6, 1.1)
        time = rng.uniform(0, 3) + np.arange(1440) / 120
        first, second = rng.normal(size=(2, 2, 45))
        first *= 300 * np.sqrt(share) / np.linalg.norm(first)
        second *= 300 * np.sqrt(1 - share) / np.linalg.norm(second)
        turn = 2 * np.pi * stride_hz * time
        values = np.stack([np.sin(turn), np.cos(turn)], axis=1) @ first
        values += np.stack([np.sin(2 * turn), np.cos(2 * turn)], axis=1) @ second
        values += rng.normal(size=values.shape)
        assert frequency_of_scores(values, 120) == pytest.approx(stride_hz, abs=1e-3)


@pytest.mark.parametrize("strides_a_second", [2.1, 2.5, 2.9])
def test_a_sprint_is_not_halved(strides_a_second):
    walk = simulate_walk(seed=1, duration_s=12)
    faster = strides_a_second / walk.attrs["frequency_hz"]
    sprint = walk.assign_coords(time=walk.time.values / faster)
    assert fundamental_frequency(sprint) == pytest.approx(strides_a_second, rel=1e-3)


def test_what_repeats_more_often_than_strides_is_told():
    walk = simulate_walk(seed=1, duration_s=12)
    faster = 3.5 / walk.attrs["frequency_hz"]
    with pytest.raises(NoStrideError, match=r"3.5 times a second"):
        fundamental_frequency(walk.assign_coords(time=walk.time.values / faster))


def test_a_rate_at_which_no_stride_can_be_seen_is_named():
    scores = np.sin(np.arange(240) / 9)[:, None]
    with pytest.raises(NoStrideError, match=r"0\.12 frames a second"):
        frequency_of_scores(scores, 0.12)
