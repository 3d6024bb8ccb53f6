"""Two walks compared: distance, shares and groups are of the one path that is shown."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from eigenwalker.core.trajectories import label_trajectories
from eigenwalker.metric import (
    GROUPS,
    PUBLISHED,
    FrameMetric,
    clip_distance,
    compare_walks,
    distances_by_metric,
    joint_quaternions,
    prepare,
    retarget,
    shaped,
    step_distances,
)
from eigenwalker.metric.points import UNITS
from eigenwalker.metric.registration import register_prepared
from eigenwalker.simulation.walk import simulate_walk


@pytest.fixture(scope="module")
def people():
    walks = [simulate_walk(seed=seed, rate_hz=60, truth=False) for seed in range(4)]
    return {f"walk {i}": prepare(walk) for i, walk in enumerate(walks)}


@pytest.fixture(scope="module")
def two(people):
    return people["walk 1"], people["walk 2"]


def head_aside(walk, degrees):
    """The same walk, head held aside by so many degrees about the way of walking."""
    clip = walk.copy()
    sternum, head = (clip.sel(marker=joint).values for joint in ("sternum", "head"))
    cos, sin = np.cos(np.deg2rad(degrees)), np.sin(np.deg2rad(degrees))
    x, y, z = (head - sternum).T
    aside = np.stack([x, cos * y - sin * z, sin * y + cos * z], axis=1)
    clip.loc[{"marker": "head"}] = sternum + aside
    return clip


@pytest.mark.parametrize("name", PUBLISHED)
def test_what_is_measured_is_measured_along_the_path_that_is_shown(two, name):
    metric = PUBLISHED[name]
    for a, b in (two, two[::-1]):
        found = compare_walks(a, b, metric=name)
        steps = found.registration.distances(metric.by)
        along = shaped(metric, steps.to_numpy()).mean(axis=0)
        expected = along @ metric.weights_for(list(steps))
        assert found.distance == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("name", PUBLISHED)
def test_shares_sum_to_one_and_name_groups(two, name):
    found = compare_walks(*two, metric=name)
    assert found.shares.sum() == pytest.approx(1)
    assert (found.shares >= 0).all()
    assert set(found.shares.index) <= set(GROUPS)
    assert found.distance == pytest.approx(clip_distance(*two, metric=name), rel=1e-12)


def test_joints_of_no_group_are_counted_too(two):
    found = compare_walks(*two, metric=FrameMetric())
    assert found.shares.sum() == pytest.approx(1)
    assert 0 < found.shares["other joints"] < 0.2  # pelvis alone
    assert found.missing_groups == ()


def test_groups_are_told_in_units_one_can_read(two):
    found = compare_walks(*two)
    for by, column, unit in (
        ("positions", "positions_mm", 1.0),
        ("velocities", "velocities_mm_s", 1.0),
        ("angles", "angles_deg", 180 / np.pi),
    ):
        steps = step_distances(*two, by=by).mean()
        thigh = "left_thigh", "right_thigh"
        points = thigh if by == "angles" else [f"{side}_hip" for side in ("left", "right")]
        assert found.groups[column]["thigh"] == pytest.approx(unit * steps[[*points]].mean())
    assert UNITS["angles"] == "rad"


def test_a_head_that_is_held_aside_by_ten_degrees_is_ten_degrees_apart():
    walk = simulate_walk(seed=1, rate_hz=60, truth=False)
    found = compare_walks(walk, head_aside(walk, 10.0), metric="angles-absolute")
    assert found.groups.angles_deg["head"] == pytest.approx(10, abs=0.5)
    assert found.groups.angles_deg.drop("head").max() < 0.5
    assert found.shares.idxmax() == "head"


def test_a_walk_does_not_differ_from_itself(two):
    found = compare_walks(two[0], two[0])
    assert found.distance == 0
    assert found.shares.isna().all()
    assert found.groups.max(axis=None) == 0
    assert repr(found) == "Comparison(distance 0, most by none)"


def test_a_comparison_is_the_same_either_way_round(two):
    there, back = compare_walks(*two), compare_walks(*two[::-1])
    assert there.distance == back.distance
    np.testing.assert_allclose(there.groups, back.groups)
    np.testing.assert_array_equal(there.registration.path, back.registration.path[:, ::-1])
    first, second = back.registration.on_common_clock()
    apart = np.linalg.norm(first - second, axis=2).mean()
    second, first = there.registration.on_common_clock()
    assert apart == pytest.approx(np.linalg.norm(first - second, axis=2).mean(), rel=1e-6)


def test_paths_of_actions_turn_round_with_the_way_they_lie_over_each_other():
    time = np.linspace(0, 1, 50)
    rng = np.random.default_rng(0)
    a, b = (
        label_trajectories(
            rng.normal(size=(1, 4, 3)) * 300 + time[:, None, None] ** 2 * rng.normal(size=3) * 400,
            markers=list("wxyz"),
            rate_hz=50,
        )
        for _ in range(2)
    )
    there = register_prepared(prepare(a), prepare(b))
    back = register_prepared(prepare(b), prepare(a))
    for by in ("positions", "velocities"):
        np.testing.assert_allclose(there.distances(by), back.distances(by), atol=1e-6)
    over = there.alignment.apply(there.second.values[there.path[:, 1]])
    again = there.alignment.inverse().apply(over)
    np.testing.assert_allclose(again, there.second.values[there.path[:, 1]], atol=1e-9)


def test_the_mannequin_has_no_clavicles():
    walks = [retarget(simulate_walk(seed=seed, rate_hz=60, truth=False)) for seed in (1, 2)]
    found = compare_walks(*walks, metric="angles-absolute")
    assert "clavicle" not in found.groups.index
    assert found.missing_groups == ("clavicle",)
    assert "left_clavicle" not in joint_quaternions(walks[0])["joint"]


def test_a_table_of_metrics_holds_the_distance_of_each_pair(people):
    calls = []
    names = ["positions-sigmoid", "angles-squared", "lee"]
    table = distances_by_metric(people, names, progress=lambda *steps: calls.append(steps))
    assert list(table) == names
    assert table.index.tolist() == list(itertools.combinations(people, 2))
    for name in names:
        alone = clip_distance(people["walk 3"], people["walk 0"], metric=name)
        assert table.loc[("walk 0", "walk 3"), name] == pytest.approx(alone, rel=1e-12)
    assert calls == [(1, 3), (2, 3), (3, 3)]
