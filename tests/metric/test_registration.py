"""Registration: planted warps of time, turns and ways found again; paths against brute force."""

from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from scipy.spatial.transform import Rotation

from eigenwalker.core.trajectories import label_trajectories, sampling_rate, trajectories_at
from eigenwalker.core.walker import Walker
from eigenwalker.metric import (
    FrameMetric,
    find_transitions,
    register,
    register_by_spline,
    register_walks,
)
from eigenwalker.metric.paths import least_cost_path
from eigenwalker.simulation.overground import Route
from eigenwalker.simulation.walk import simulate_walk


def some_walker(seed=0, frequency_hz=0.9):
    rng = np.random.default_rng(seed)
    size = np.array([150, 120, 40, 40])[:, None, None]
    return Walker(
        [f"m{number}" for number in range(8)],
        rng.normal(size=(8, 3)) * 400,
        rng.normal(size=(4, 8, 3)) * size,
        [1, 1, 2, 2],
        rng.uniform(-3, 3, 4),
        frequency_hz,
    )


def moved(clip, degrees, way):
    turn = Rotation.from_euler("z", degrees, degrees=True).as_matrix()
    return clip.copy(data=clip.values @ turn.T + [*way, 0.0])


def warp(time, depth=0.12):
    """Time that runs up to a third faster and slower, with the same ends."""
    return time + depth * np.sin(2 * np.pi * time / time[-1])


def warped_pair(seed=0, rate_hz=60, duration_s=2.0):
    walker, time = some_walker(seed), np.arange(0, duration_s, 1 / rate_hz)
    played = walker.trajectories(warp(time)).assign_coords(time=time)
    return walker.trajectories(time), played


def by_brute_force(cost, slope_limit):
    """Least sum of any monotone path from corner to corner, by trying them all."""
    n, m = cost.shape

    @cache
    def best(i, j, held, which):
        if (i, j) == (n - 1, m - 1):
            return cost[i, j]
        ways = [np.inf]
        if i + 1 < n and j + 1 < m:
            ways.append(best(i + 1, j + 1, 0, 0))
        for step, (up, right) in ((1, (1, 0)), (2, (0, 1))):
            again = held + 1 if which == step else 1
            turns = held > 0 and which != step
            if again <= slope_limit and not turns and i + up < n and j + right < m:
                ways.append(best(i + up, j + right, again, step))
        return cost[i, j] + min(ways)

    return best(0, 0, 0, 0)


@settings(max_examples=60, deadline=None)
@given(
    seed=st.integers(0, 10_000), n=st.integers(1, 9), m=st.integers(1, 9), limit=st.integers(1, 4)
)
def test_paths_cost_no_more_than_any_other(seed, n, m, limit):
    cost = np.random.default_rng(seed).random((n, m))
    expected = by_brute_force(cost, limit)
    if np.isinf(expected):
        with pytest.raises(ValueError, match="no path joins"):
            least_cost_path(cost, slope_limit=limit)
    else:
        path = least_cost_path(cost, slope_limit=limit)
        assert cost[tuple(path.T)].sum() == pytest.approx(expected)
        check_path(path, n, m, limit)


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 10_000), n=st.integers(1, 8), m=st.integers(1, 8))
def test_plain_time_warping_is_least_of_all(seed, n, m):
    cost = np.random.default_rng(seed).random((n, m))
    total = np.full((n + 1, m + 1), np.inf)
    total[0, 0] = 0
    for i in range(n):
        for j in range(m):
            before = min(total[i, j], total[i, j + 1], total[i + 1, j])
            total[i + 1, j + 1] = cost[i, j] + before
    path = least_cost_path(cost)
    check_path(path, n, m, max(n, m))
    assert cost[tuple(path.T)].sum() == pytest.approx(total[n, m])


def check_path(path, n, m, limit):
    assert path[0].tolist() == [0, 0]
    assert path[-1].tolist() == [n - 1, m - 1]
    steps = np.diff(path, axis=0)
    assert set(map(tuple, steps.tolist())) <= {(0, 1), (1, 0), (1, 1)}
    for still in (steps[:, 0] == 0, steps[:, 1] == 0):
        runs = np.split(still, np.flatnonzero(np.diff(still)) + 1)
        assert all(len(run) <= limit for run in runs if run.size and run[0])


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("degrees", [0.0, 135.0])
def test_a_planted_warp_turn_and_way_are_found(seed, degrees):
    first, played = warped_pair(seed)
    found = register(first, moved(played, degrees, (1500.0, -700.0)), window_s=0.05)
    np.testing.assert_allclose(found.times[:, 0], warp(found.times[:, 1]), atol=2.5 / 60)
    turns = np.rad2deg(found.alignment.angles) + degrees
    np.testing.assert_allclose((turns + 180) % 360 - 180, 0, atol=3)
    a, b = found.on_common_clock()
    apart = np.linalg.norm(a.values - b.values, axis=2).mean()
    naive = np.linalg.norm(first.values - played.values, axis=2).mean()
    assert apart < 0.12 * naive


def test_registration_is_the_same_either_way_round():
    first, played = warped_pair(1)
    there, back = register(first, played), register(played, first)
    assert there.cost == pytest.approx(back.cost, rel=1e-6)
    assert np.abs(there.path - back.path[:, ::-1]).max() == 0


def test_a_clip_is_registered_to_itself_frame_by_frame():
    first, _ = warped_pair()
    found = register(first, first)
    assert found.cost == pytest.approx(0, abs=1e-4)
    np.testing.assert_array_equal(found.path[:, 0], found.path[:, 1])
    assert found.distances().to_numpy().max() < 1e-6


def test_clips_of_different_frame_rates_are_registered():
    walker = some_walker()
    a = walker.trajectories(np.arange(0, 2, 1 / 30))
    b = walker.trajectories(np.arange(0, 2, 1 / 100))
    found = register(a, b)
    assert sampling_rate(found.first) == pytest.approx(100)
    np.testing.assert_allclose(found.times[:, 0], found.times[:, 1], atol=0.03)


def test_a_slope_limit_keeps_clips_moving():
    """One clip halts for 0.6 s, in which without a limit the other stands still."""
    first, _ = warped_pair()
    frames = np.r_[0:41, np.full(36, 40), 41 : len(first)]
    halting = first.isel(time=frames).assign_coords(time=np.arange(len(frames)) / 60)
    free = register(first, halting, slope_limit=None).path
    assert longest_stand(free) > 20
    limited = register(first, halting, slope_limit=2).path
    check_path(limited, len(first), len(halting), 2)
    assert longest_stand(limited) == 2


def longest_stand(path):
    """Most steps in a row in which the first clip stands still."""
    still = np.diff(path[:, 0]) == 0
    runs = np.split(still, np.flatnonzero(np.diff(still)) + 1)
    return max(len(run) for run in runs if run[0])


def test_walks_are_registered_whatever_their_phase_frequency_heading_and_place():
    slow = simulate_walk(seed=1, frequency_hz=0.75, rate_hz=100, truth=False)
    walker = some_walker(3, frequency_hz=0.75)
    fast = some_walker(3, frequency_hz=1.0)
    a = walker.trajectories(np.arange(0, 8, 0.01))
    b = moved(fast.trajectories(0.37 + np.arange(0, 5, 0.02)), 77.0, (300.0, 100.0))
    found = register_walks(a, b)
    assert found.periodic
    assert found.cost < 2.0
    assert (
        register_walks(a, slow.sel(marker=slow.marker[:8]).assign_coords(marker=a.marker)).cost > 50
    )
    first, second = found.on_common_clock()
    np.testing.assert_allclose(first, second, atol=20)
    assert first.sizes["time"] == 120


def test_a_late_foot_is_found_in_the_path_of_two_strides():
    """One stride dwells where the other hurries: the path leaves the line of 45 degrees."""
    walker = some_walker(2)
    time = np.arange(0, 6, 0.01)
    a = walker.trajectories(time)
    uneven = time + 0.03 * np.sin(2 * np.pi * walker.frequency_hz * time)
    b = walker.trajectories(uneven).assign_coords(time=time)
    found = register_walks(a, b)
    lead = found.times[:, 1] - found.times[:, 0]
    assert np.ptp(lead) == pytest.approx(0.06, abs=0.02)
    assert found.cost < 6


def test_a_smooth_warp_is_found_to_a_fraction_of_a_frame():
    first, played = warped_pair(2, rate_hz=50, duration_s=1.5)
    found = register_by_spline(first, moved(played, 60, (100, 0)), n_pieces=8)
    error = np.abs(found.times[:, 0] - warp(found.times[:, 1]))
    assert error.max() < 0.6 / 50
    assert (np.diff(found.times[:, 1]) > 0).all()
    by_path = register(first, played)
    assert np.abs(by_path.times[:, 0] - warp(by_path.times[:, 1])).max() > error.max()


@pytest.mark.parametrize(
    ("other", "options", "message"),
    [
        (some_walker().trajectories([0.0]), {}, "two frames"),
        (some_walker().trajectories(np.arange(0, 0.1, 0.02)), {}, "no path joins"),
        (some_walker().trajectories([0.0, 0.1, 0.5]), {}, "evenly spaced"),
        (some_walker().trajectories(np.arange(0, 2, 0.02)), {"slope_limit": 0}, "1 or more"),
    ],
)
def test_clips_that_cannot_be_registered_are_refused_with_words(other, options, message):
    with pytest.raises(ValueError, match=message):
        register(warped_pair()[0], other, **options)


def test_gaps_and_strangers_are_refused_with_words():
    first, played = warped_pair()
    lost = played.copy()
    lost[5] = np.nan
    with pytest.raises(ValueError, match="ill gaps"):
        register(first, lost)
    with pytest.raises(ValueError, match="fill gaps"):
        register(first, lost, align=False)
    with pytest.raises(ValueError, match="no points in common"):
        register(first, played.assign_coords(marker=[f"x{i}" for i in range(8)]))
    with pytest.raises(TypeError, match="label_trajectories"):
        register(first, played.values)


def test_a_walk_can_pass_into_itself_a_stride_later_further_along_the_way():
    walk = simulate_walk(
        seed=1, frequency_hz=0.8, duration_s=6, rate_hz=60, route=Route(heading_deg=0), truth=False
    )
    walk = walk.isel(time=slice(90, None))
    found = find_transitions(walk)
    best = found.iloc[0]
    assert abs(best.time_b - best.time_a) == pytest.approx(1.25, abs=0.03)
    stride = walk.attrs["speed_mm_s"] * 1.25
    assert abs(best.shift_x_mm) == pytest.approx(stride, rel=0.03)
    assert abs(best.angle_deg) < 2
    assert (np.diff(found.distance) >= 0).all()


def test_transitions_to_another_walk_are_where_both_have_the_same_phase():
    a = simulate_walk(seed=1, frequency_hz=0.8, duration_s=4, rate_hz=50)
    b = moved(simulate_walk(seed=2, frequency_hz=0.9, duration_s=4, rate_hz=50), 30, (500, 0))
    found = find_transitions(a, b, metric=FrameMetric(shape="squared"), threshold=np.inf)
    phase_a = a.phase.values[np.searchsorted(a.time.values, found.time_a - 1e-9)]
    phase_b = b.phase.values[np.searchsorted(b.time.values, found.time_b - 1e-9)]
    good = found.distance < found.distance.min() * 3
    apart = (phase_a - phase_b + 0.5) % 1 - 0.5
    assert good.any()
    assert np.abs(apart[good]).max() < 0.08
    np.testing.assert_allclose(found.angle_deg[good], -30, atol=12)


@pytest.mark.parametrize("noise_mm", [0.0, 0.5])
def test_a_clip_in_which_nothing_moves_has_no_transitions(noise_mm):
    values = 500.0 + noise_mm * np.random.default_rng(0).normal(size=(100, 4, 3))
    values += np.linspace(0, 800, 100)[:, None, None] * [1, 0.5, 0]  # a statue on wheels
    still = label_trajectories(values, markers=list("abcd"), rate_hz=60)
    with pytest.raises(ValueError, match="no point moves by more than 1 mm"):
        find_transitions(still)
    walking = label_trajectories(values * [1, 1, 2], markers=list("abcd"), rate_hz=60)
    walking.values[:, 0, 2] += 30 * np.sin(np.arange(100) / 5)
    find_transitions(still, walking)


@pytest.mark.parametrize("window_s", [0.1, 1 / 3])
def test_transitions_are_half_a_window_from_each_other_and_from_the_ends(window_s):
    walk = simulate_walk(
        seed=1, frequency_hz=0.9, duration_s=4, rate_hz=50, variability=1.0, noise_mm=2.0
    )
    found = find_transitions(walk, window_s=window_s, threshold=np.inf)
    half_s = round(window_s * 50 / 2) / 50
    moments = found[["time_a", "time_b"]].to_numpy()
    assert len(moments) > 10
    assert moments.min() >= half_s - 1e-9
    assert moments.max() <= walk.time.values[-1] - half_s + 1e-9
    apart = np.abs(moments[:, None] - moments).max(axis=2)
    assert apart[np.triu_indices(len(moments), 1)].min() >= half_s - 1e-9
    assert np.abs(np.diff(moments, axis=1)).min() >= window_s - 1e-9


def test_the_threshold_left_out_is_what_moves_in_a_tenth_of_a_second():
    """Of a clip that moves on at one speed this is that speed times a tenth of a second."""
    time, rng = np.arange(0, 3, 0.02), np.random.default_rng(0)
    places = rng.normal(size=(1, 3, 3)) * 300
    lifted = places + time[:, None, None] * np.array([0, 0, 500.0])  # up: nothing aligns that
    clip = trajectories_at(time, lifted, ["a", "b", "c"])
    found = find_transitions(clip, clip + np.array([0, 0, 1.0]) * 49, window_s=0.1)
    assert found.distance.max() < 50
    higher = find_transitions(clip, clip + np.array([0, 0, 2000.0]), window_s=0.1)
    assert higher.empty


def test_where_nothing_is_alike_there_is_no_transition():
    clips = [some_walker(seed).trajectories(np.arange(0, 2, 0.02)) for seed in (0, 1)]
    found = find_transitions(*clips)
    assert found.empty
    assert list(found) == ["time_a", "time_b", "distance", "angle_deg", "shift_x_mm", "shift_y_mm"]


def test_markers_that_only_one_clip_has_do_not_matter():
    first, played = warped_pair()
    more = np.concatenate([played.values, played.values[:, :1] + 50], axis=1)
    names = [*played.marker.values.tolist(), "extra"]
    extra = trajectories_at(played.time.values, more, names)
    assert register(first, extra).cost == pytest.approx(register(first, played).cost)


@pytest.mark.parametrize("limit", [None, 1, 3, 1000])
def test_a_map_with_missing_cells_has_no_path(limit):
    cost = np.random.default_rng(0).random((40, 50))
    cost[np.random.default_rng(1).random(cost.shape) < 0.2] = np.nan
    with pytest.raises(ValueError, match="missing"):
        least_cost_path(cost, slope_limit=limit)


def test_a_cell_far_off_the_path_does_not_matter_however_large():
    time = np.linspace(0, 1, 60)
    cost = np.abs(np.sin(6 * time)[:, None] - np.sin(6 * time**1.4))
    expected = least_cost_path(cost, slope_limit=3)
    for forbidden in (1e6, 1e12, np.inf):
        cost[0, -1] = forbidden
        np.testing.assert_array_equal(least_cost_path(cost, slope_limit=3), expected)


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 10_000), n=st.integers(1, 8), m=st.integers(1, 8))
def test_paths_through_whole_numbers_with_many_ties_cost_least_too(seed, n, m):
    cost = np.random.default_rng(seed).integers(0, 4, (n, m)).astype(float)
    expected = by_brute_force(cost, 3)
    if np.isfinite(expected):
        path = least_cost_path(cost, slope_limit=3)
        assert cost[tuple(path.T)].sum() == pytest.approx(expected, abs=1e-3)
