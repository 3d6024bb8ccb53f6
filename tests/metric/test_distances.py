"""Distances of clips: no matter where and when a walk begins, either way round, zero on itself."""

import warnings
from itertools import combinations

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings, strategies as st
from scipy.spatial.transform import Rotation

import eigenwalker as ew
from eigenwalker.core.trajectories import label_trajectories
from eigenwalker.metric import (
    PUBLISHED,
    FrameMetric,
    clip_components,
    clip_distance,
    compare_walks,
    distances_by_metric,
    group_table,
    pair_components,
    pair_distances,
    pair_table,
    prepare,
    register,
    register_walks,
    step_distances,
)
from eigenwalker.metric.registration import register_prepared
from eigenwalker.simulation.overground import Route
from eigenwalker.simulation.walk import simulate_walk

METRICS = [
    FrameMetric(),
    FrameMetric(shape="squared"),
    FrameMetric(shape="sigmoid", scale=100.0),
    FrameMetric(shape="power", exponent=0.3),
    FrameMetric("velocities"),
    FrameMetric("angles"),
    "positions-sigmoid",
]
BY_METRIC = pytest.mark.parametrize("metric", METRICS, ids=str)


def some_walk(seed, **options):
    options = {"rate_hz": 60.0, "duration_s": 5.0, "truth": False} | options
    return simulate_walk(seed=seed, **options)


def elsewhere(clip, degrees, way):
    turn = Rotation.from_euler("z", degrees, degrees=True).as_matrix()
    return clip.copy(data=clip.values @ turn.T + [*way, 0.0])


def some_action(seed, duration_s=1.2):
    """A hand that reaches out once, and what it hangs on."""
    rng = np.random.default_rng(seed)
    time = np.linspace(0, 1, int(duration_s * 50))
    ends = rng.normal(size=(2, 4, 3)) * 300
    ease = time**2 * (3 - 2 * time)
    values = ends[0] + ease[:, None, None] * (ends[1] - ends[0])
    values[:, :, 2] += 100 * np.sin(np.pi * ease)[:, None] * rng.random(4)
    names = ["hand", "elbow", "shoulder", "head"]
    return label_trajectories(values, markers=names, rate_hz=50)


@pytest.fixture(scope="module")
def two():
    return prepare(some_walk(1)), prepare(some_walk(2))


@BY_METRIC
def test_distances_are_zero_on_themselves_and_the_same_either_way_round(two, metric):
    a, b = two
    assert clip_distance(a, a, metric=metric) == 0
    there, back = clip_distance(a, b, metric=metric), clip_distance(b, a, metric=metric)
    assert there == back > 0


@settings(max_examples=15, deadline=None)
@given(
    start_s=st.floats(0, 1.5),
    degrees=st.floats(-180, 180),
    way=st.tuples(st.floats(-5000, 5000), st.floats(-5000, 5000)),
    metric=st.sampled_from(METRICS),
)
def test_where_and_when_a_walk_begins_does_not_matter(start_s, degrees, way, metric):
    walk, other = some_walk(1), some_walk(2)
    later = elsewhere(walk.isel(time=slice(round(start_s * 60), None)), degrees, way)
    expected = clip_distance(walk, other, metric=metric)
    assert clip_distance(later, other, metric=metric) == pytest.approx(expected, rel=0.02)
    same = clip_distance(walk, later, metric=metric)
    power = not isinstance(metric, str) and metric.shape == "power"
    assert same < (0.3 if power else 0.02) * expected


def test_a_walk_through_the_room_is_near_to_the_same_walk_on_a_belt():
    on_belt, other = some_walk(1, duration_s=8.0), some_walk(2)
    in_room = some_walk(1, duration_s=12.0, route=Route(heading_deg=60))
    assert clip_distance(on_belt, in_room) < 0.15 * clip_distance(on_belt, other)


def test_the_frame_rate_of_a_capture_does_not_matter():
    slow, fast = some_walk(1, rate_hz=25.0), some_walk(1, rate_hz=240.0)
    assert clip_distance(slow, fast) < 0.05 * clip_distance(slow, some_walk(2))


def test_the_distance_is_the_mean_of_the_map_along_the_path(two):
    found = register_prepared(*two)
    assert found.cost == pytest.approx(clip_distance(*two), rel=0.01)
    steps = step_distances(*two)
    assert steps.shape == (len(found.path), 15)
    assert steps.to_numpy().mean() == pytest.approx(found.cost, rel=1e-6)


def test_two_walks_that_differ_by_a_known_way_are_that_far_apart():
    """A head held 90 mm higher, among 15 markers: 6 mm in the mean."""
    walk = some_walk(1)
    stretched = walk.copy()
    stretched.loc[{"marker": "head", "axis": "z"}] += 90
    assert clip_distance(walk, stretched) == pytest.approx(6.0, abs=0.05)
    assert clip_components(walk, stretched)["head"] == pytest.approx(90, abs=0.05)
    squared = FrameMetric(shape="squared", weights={"head": 1})
    assert clip_distance(walk, stretched, metric=squared) == pytest.approx(8100, rel=0.002)


@pytest.fixture(scope="module")
def people():
    return {f"walk {seed}": prepare(some_walk(seed)) for seed in range(6)}


@pytest.mark.parametrize("by", ["positions", "velocities", "angles"])
def test_a_table_holds_the_distance_of_every_pair(people, by):
    metric = FrameMetric(by)
    table = pair_table(people, metric=metric)
    assert list(table) == list(people)
    np.testing.assert_array_equal(table, table.T)
    np.testing.assert_array_equal(np.diagonal(table), 0)
    for first, second in [("walk 0", "walk 3"), ("walk 4", "walk 2")]:
        alone = clip_distance(people[first], people[second], metric=metric)
        assert table.loc[first, second] == pytest.approx(alone, rel=1e-12)


def test_components_weighed_and_summed_are_distances(people):
    components = pair_components(people, metric="positions-absolute")
    assert components.index.to_list() == list(combinations(people, 2))
    weights = PUBLISHED["positions-absolute"].weights_for(list(components))
    distances = pair_distances(people, metric="positions-absolute")
    np.testing.assert_allclose(components.to_numpy() @ weights, distances, rtol=1e-12)


def test_progress_counts_clips_and_pairs():
    calls = []
    walks = {str(seed): some_walk(seed) for seed in range(3)}
    pair_table(walks, progress=lambda done, total: calls.append((done, total)))
    assert calls[-1] == (6, 6)
    assert [done for done, _ in calls] == sorted(done for done, _ in calls)


@pytest.mark.filterwarnings("ignore:All clips are compared from end to end")
@pytest.mark.parametrize("by", ["positions", "velocities"])
def test_actions_that_do_not_repeat_are_compared_from_end_to_end(by):
    a, b = some_action(0), some_action(1)
    metric = FrameMetric(by)
    assert prepare(a).cycle is None
    assert clip_distance(a, a, metric=metric) == pytest.approx(0, abs=1e-6)
    assert clip_distance(a, b, metric=metric) == clip_distance(b, a, metric=metric) > 10
    slower = some_action(0, duration_s=1.5)
    moved = elsewhere(slower, 100, (400, 900))
    if by == "positions":
        assert clip_distance(a, moved) < 0.1 * clip_distance(a, b)
        assert clip_distance(a, b) == pytest.approx(
            register(a, b).distances().to_numpy().mean(), rel=0.05
        )


def test_one_clip_that_does_not_repeat_makes_all_be_compared_from_end_to_end():
    walk = some_walk(1, duration_s=2.0).isel(marker=slice(0, 4))
    names = walk.marker.values.tolist()
    action = some_action(0).assign_coords(marker=names)
    with pytest.warns(UserWarning, match="'action', 'again'.* do not repeat"):
        table = pair_table({"walk": walk, "action": action, "again": action})
    assert table.loc["action", "again"] == pytest.approx(0, abs=1e-6)
    assert table.loc["walk", "action"] > 50


def test_it_is_said_when_no_clip_repeats_and_why():
    with pytest.warns(UserWarning, match=r"'a', 'b'.* do not repeat: .* No strides are compared"):
        clip_distance(some_action(0), some_action(1))


def test_only_that_nothing_repeats_makes_clips_be_compared_from_end_to_end(monkeypatch):
    """Another refusal is none that may be passed over in silence."""

    def refuse(clip):
        raise ValueError("The markers are upside down.")

    monkeypatch.setattr("eigenwalker.metric.prepared.loop", refuse)
    with pytest.raises(ValueError, match="upside down"):
        clip_distance(some_walk(1), some_walk(2))


def test_a_short_gap_is_no_obstacle():
    walk, other = some_walk(1), some_walk(2)
    seen_badly = walk.copy()
    seen_badly[50:54, 3] = np.nan
    assert clip_distance(seen_badly, other) == pytest.approx(clip_distance(walk, other), rel=0.01)


def test_a_marker_that_was_never_seen_is_left_out():
    walk, other = some_walk(1), some_walk(2)
    expected = clip_distance(walk.drop_sel(marker="head"), other)
    assert clip_distance(walk.where(walk.marker != "head"), other) == expected


def test_a_long_gap_is_told_with_its_marker():
    walk = some_walk(1)
    walk[20:280, 3] = np.nan
    with pytest.raises(ValueError, match="left_elbow"):
        clip_distance(walk, some_walk(2))


@pytest.mark.filterwarnings("ignore:All clips are compared from end to end")
@pytest.mark.parametrize(
    ("clips", "message"),
    [
        ({"a": some_action(0)}, "two clips or more"),
        ({"a": some_action(0), "b": some_action(0).isel(time=[0])}, "two frames"),
        (
            {"a": some_action(0), "b": some_action(0).assign_coords(marker=list("wxyz"))},
            "no points in common",
        ),
        ({"a": some_walk(0), "b": some_walk(0).assign_attrs(units="m")}, "Expected millimetres"),
        ({"a": some_walk(0), "b": some_walk(0).where(False)}, "ever seen"),
    ],
)
def test_clips_that_cannot_be_compared_are_refused_with_words(clips, message):
    with pytest.raises(ValueError, match=message):
        pair_table(clips)


def test_a_metric_that_is_not_known_is_refused(two):
    with pytest.raises(ValueError, match="not known"):
        clip_distance(*two, metric="euclid")


@pytest.fixture(scope="module")
def styles(captures):
    """A few walks of each style, ready to be compared."""
    files = sorted((captures / "bandai-namco").glob("*_walk_*_00[1357].bvh"))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return {path.stem: prepare(ew.virtual_markers(ew.read_mocap(path))) for path in files}


def style_of(name):
    return name.split("_")[2]


def nearness(table):
    """Mean distance within styles as a share of that between them."""
    pairs = [(style_of(a) == style_of(b), table.loc[a, b]) for a, b in combinations(table, 2)]
    within, between = ([d for same, d in pairs if same == wanted] for wanted in (True, False))
    return np.mean(within) / np.mean(between)


def test_walks_of_one_style_are_nearer_to_each_other(styles):
    assert nearness(pair_table(styles)) < 0.6
    nearest = pair_table(styles).where(lambda table: table > 0).idxmin()
    right = [style_of(name) == style_of(str(other)) for name, other in nearest.items()]
    assert np.mean(right) > 0.8


def test_two_halves_of_a_real_walk_are_nearer_than_two_people(captures):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        walks = [
            ew.virtual_markers(ew.read_mocap(captures / "cmu" / name))
            for name in ("12_01.bvh", "35_01.amc")
        ]
    walk = walks[0]
    steady = ew.in_place(walk)
    half = (steady.attrs["steady_start_s"] + steady.attrs["steady_end_s"]) / 2
    first, second = walk.sel(time=slice(None, half + 0.7)), walk.sel(time=slice(half - 0.7, None))
    assert clip_distance(first, second) < 0.5 * clip_distance(first, walks[1])


def test_captured_rotations_count_only_where_both_walks_have_them():
    walk, other = some_walk(1), some_walk(2)
    metric = FrameMetric("angles")
    rng = np.random.default_rng(0)
    turning = walk.assign_coords(rotation=(walk.dims, rng.normal(size=walk.shape)))
    expected = clip_distance(walk, other, metric=metric)
    assert clip_distance(turning, other, metric=metric) == pytest.approx(expected, rel=1e-9)
    both = other.assign_coords(rotation=(other.dims, rng.normal(size=other.shape)))
    assert clip_distance(turning, both, metric=metric) > 1.5 * expected


def test_points_that_only_one_clip_has_do_not_matter():
    walk, other = some_walk(1), some_walk(2)
    stray = (walk.isel(marker=[0]) * 0 + [0, 0, -700]).assign_coords(marker=["output"])
    more = xr.concat([walk, stray], "marker", combine_attrs="override")
    assert clip_distance(more, other) == clip_distance(walk, other)


def test_it_is_said_if_bodies_share_few_names():
    walk = some_walk(1)
    names = [
        f"joint {name}" if number > 3 else name for number, name in enumerate(ew.JOINTS.markers)
    ]
    with pytest.warns(UserWarning, match="Only 4 points .* of 15 and 15"):
        clip_distance(walk, some_walk(2).assign_coords(marker=names))


def test_walkers_are_compared_by_the_walks_they_make():
    people = ew.load_population()
    walkers = people.walkers[:3]
    table = pair_table(walkers)
    assert table.index.tolist() == ["0", "1", "2"]
    walks = [w.trajectories(np.arange(0, 3 * w.period_s, 0.01)) for w in walkers]
    assert table.loc["0", "2"] == pytest.approx(clip_distance(walks[0], walks[2]))
    assert clip_distance(walkers[0], walks[0]) == pytest.approx(0, abs=1e-9)


def test_walks_are_registered_alike_whichever_comes_first():
    walk, other = some_walk(1), some_walk(2)
    there, back = register_walks(walk, other), register_walks(other, walk)
    np.testing.assert_array_equal(there.path, back.path[:, ::-1])
    assert there.cost == back.cost


@pytest.mark.filterwarnings("ignore:All clips are compared from end to end")
@pytest.mark.parametrize(("degrees", "way"), [(0, (300.0, 0.0)), (30, (0.0, 0.0)), (200, (50, 9))])
def test_an_action_elsewhere_in_the_room_is_the_same_action(degrees, way):
    time = np.arange(0, 1.5, 1 / 120)
    risen = np.clip((time - 0.4) / 0.6, 0, 1) ** 2
    places = ([0, 0, 1000], [20, 100, 500], [0, -100, 80])
    ways = ([600, 0, 300], [500, 10, 320], [700, 0, 250])
    values = np.stack([np.add(p, risen[:, None] * w) for p, w in zip(places, ways, strict=True)], 1)
    jump = label_trajectories(values, markers=["pelvis", "left_knee", "left_ankle"], rate_hz=120)
    assert clip_distance(jump, elsewhere(jump, degrees, way)) < 1e-9


def test_noise_makes_little_of_velocities():
    walk = some_walk(1, rate_hz=120)
    noise = np.random.default_rng(0).normal(size=walk.shape)
    between = clip_distance(walk, some_walk(2, rate_hz=120), metric=FrameMetric("velocities"))
    assert clip_distance(walk, walk + noise, metric=FrameMetric("velocities")) < 0.15 * between


def test_what_only_one_clip_has_decides_no_table_of_many():
    walks = {name: some_walk(seed) for seed, name in enumerate("abc", start=1)}
    prop = walks["a"].isel(marker=[4]).assign_coords(marker=["prop"]) * 3 + 500
    more = walks | {"a": xr.concat([walks["a"], prop], "marker", combine_attrs="override")}
    for table_of in (
        pair_components,
        lambda clips: group_table(clips, "positions-sigmoid"),
        lambda clips: distances_by_metric(clips, ["kovar", "velocities-absolute"]),
        lambda clips: compare_walks(clips["a"], clips["b"]).groups,
        lambda clips: step_distances(clips["a"], clips["b"]),
    ):
        np.testing.assert_allclose(table_of(more), table_of(walks))


def test_a_walk_with_a_short_gap_can_be_compared_with_what_does_not_repeat():
    walk, time = some_walk(1), np.arange(0, 1.5, 1 / 60)
    holed = walk.copy(deep=True)
    holed.loc[{"marker": "left_wrist"}][50:53] = np.nan
    assert not prepare(holed).clip.isnull().any()
    still = walk.isel(time=slice(None, 40)).mean("time").expand_dims(time=time)
    rising = still.transpose("time", "marker", "axis") + 200 * time[:, None, None] ** 2
    with pytest.warns(UserWarning, match="do not repeat"):
        assert np.isfinite(clip_distance(holed, rising))
