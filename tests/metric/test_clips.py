"""Every function that takes a clip takes trajectories, a walker, a loop and a prepared clip."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import eigenwalker as ew
from eigenwalker import metric
from eigenwalker.metric.retargeting import is_mannequin

KINDS = {
    "trajectories": lambda walk: walk,
    "walker": ew.decompose_fourier,
    "loop": ew.loop,
    "prepared": metric.prepare,
}
OF_ONE = {
    "joint_quaternions": metric.joint_quaternions,
    "loop": lambda clip: ew.loop(clip).cycle,
    "motion_map": ew.motion_map,
    "find_transitions": metric.find_transitions,
    "prepare": lambda clip: metric.prepare(clip).cycle,
    "prepare_walk": metric.prepare_walk,
    "retarget": metric.retarget,
}
OF_TWO = {
    "clip_components": metric.clip_components,
    "clip_distance": metric.clip_distance,
    "compare_walks": lambda a, b: metric.compare_walks(a, b).groups,
    "motion_map": ew.motion_map,
    "motion_maps": lambda a, b: metric.motion_maps(a, b, groups={"head": ["head"]}),
    "nearest_walks": lambda a, b: metric.nearest_walks(a, {"b": b}),
    "register": lambda a, b: ew.register(a, b, slope_limit=None).distances(),
    "register_walks": lambda a, b: metric.register_walks(a, b).distances(),
    "step_distances": metric.step_distances,
}
OF_MANY = {
    "distances_by_metric": lambda clips: metric.distances_by_metric(clips, ["lee"]),
    "group_table": lambda clips: metric.group_table(clips, "positions-absolute"),
    "pair_components": metric.pair_components,
    "pair_distances": metric.pair_distances,
    "pair_table": metric.pair_table,
}


@pytest.fixture(scope="module")
def walks() -> list[xr.DataArray]:
    captures = [ew.simulate_walk(seed=seed, rate_hz=50, truth=False) for seed in (1, 2)]
    return [ew.in_place(capture) for capture in captures]


def check(result: object) -> None:
    values = np.asarray(result)
    assert values.dtype == float
    assert not values.size or np.isfinite(values).any()


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", OF_ONE)
def test_functions_of_one_clip(walks, kind, name):
    check(OF_ONE[name](KINDS[kind](walks[0])))


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", OF_TWO)
def test_functions_of_two_clips(walks, kind, name):
    check(OF_TWO[name](KINDS[kind](walks[0]), walks[1]))
    check(OF_TWO[name](walks[1], KINDS[kind](walks[0])))


@pytest.mark.parametrize("name", OF_MANY)
def test_functions_of_many_clips(walks, name):
    clips = {kind: of(walk) for kind, of in KINDS.items() for walk in walks[:1]}
    check(OF_MANY[name](clips))


def test_a_smooth_warp_takes_loops_and_walkers(walks):
    loop, walker = ew.loop(walks[0]), ew.decompose_fourier(walks[0])
    assert np.isfinite(metric.register_by_spline(loop, walker, n_pieces=2).cost)


@pytest.mark.parametrize("by", ["positions-sigmoid", "velocities-absolute", "lee"])
def test_loops_and_prepared_clips_are_as_far_apart_as_their_walks(walks, by):
    expected = ew.clip_distance(*walks, metric=by)
    for kind in ("loop", "prepared"):
        clips = [KINDS[kind](walk) for walk in walks]
        assert ew.clip_distance(*clips, metric=by) == expected
        assert ew.clip_distance(walks[0], clips[1], metric=by) == expected


def test_a_walker_is_near_to_its_walk(walks):
    walker = ew.decompose_fourier(walks[0], n_harmonics=4)
    assert ew.clip_distance(walker, walks[0]) < 0.05 * ew.clip_distance(*walks)


def test_points_that_one_loop_lacks_do_not_matter(walks):
    fewer = [walk.drop_sel(marker="head") for walk in walks]
    expected = ew.clip_distance(*fewer)
    found = ew.clip_distance(ew.loop(walks[0]), ew.loop(fewer[1]))
    assert found == pytest.approx(expected, rel=1e-6)


def test_a_loop_is_its_own_loop(walks):
    loop = ew.loop(walks[0])
    assert ew.loop(loop) is loop


def test_maps_of_loops_have_the_velocities_of_cycles(walks):
    loops = [ew.loop(walk) for walk in walks]
    velocities = metric.FrameMetric("velocities")
    found = ew.motion_map(*loops, metric=velocities)
    cycles = [loop.cycle for loop in loops]
    xr.testing.assert_equal(found, ew.motion_map(*cycles, metric=velocities, periodic=True))


def test_what_is_no_clip_is_refused(walks):
    with pytest.raises(TypeError, match="label_trajectories"):
        ew.clip_distance(walks[0], walks[1].values)


@pytest.mark.parametrize("seed", [1, 4])
@pytest.mark.parametrize("strides", [1.3, 6.0])
def test_attributes_do_not_change_loops(seed, strides):
    capture = ew.simulate_walk(
        seed=seed, rate_hz=50, frequency_hz=0.9, duration_s=strides / 0.9, variability=0.5
    )
    for walk in (capture, ew.in_place(capture), metric.retarget(ew.in_place(capture))):
        labelled, bare = ew.loop(walk), ew.loop(walk.drop_attrs())
        assert (labelled.period_s, labelled.start_s) == (bare.period_s, bare.start_s)
        np.testing.assert_array_equal(labelled.cycle, bare.cycle)


def test_attributes_do_not_change_the_groups_of_the_mannequin(walks):
    placed = [metric.retarget(walk) for walk in walks]
    bare = [walk.drop_attrs() for walk in placed]
    for by in ("positions-absolute", "angles-absolute"):
        tables = [metric.group_table(clips, by) for clips in (placed, bare)]
        pd.testing.assert_frame_equal(*tables)
        assert "clavicle" not in tables[0]
    assert not any(is_mannequin(walk) for walk in walks)
