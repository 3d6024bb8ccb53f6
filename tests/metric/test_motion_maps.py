"""Motion maps: against scipy's cdist, what must not change them, and clips that do not fit."""

import os
import select
import signal

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from scipy.spatial.distance import cdist
from scipy.spatial.transform import Rotation

from eigenwalker.core.trajectories import label_trajectories
from eigenwalker.metric import FrameMetric, loop, motion_map, motion_maps, shaped
from eigenwalker.metric.alignment import align_windows
from eigenwalker.metric.cycles import common_clock
from eigenwalker.metric.kernels import diagonal_means
from eigenwalker.metric.point_maps import EXACT, point_distances, point_map
from eigenwalker.metric.points import points_of
from eigenwalker.simulation.walk import simulate_walk

METRICS = [
    FrameMetric(),
    FrameMetric(shape="squared"),
    FrameMetric(shape="sigmoid", scale=80.0),
    FrameMetric(shape="power", exponent=0.3),
]
BY_SHAPE = pytest.mark.parametrize("metric", METRICS, ids=lambda metric: metric.shape)


def some_clip(seed=0, n_frames=20, n_markers=4, *, rate_hz=50, names=None):
    rng = np.random.default_rng(seed)
    values = np.cumsum(rng.normal(size=(n_frames, n_markers, 3)), axis=0) * 30 + 500
    names = names or [f"m{number}" for number in range(n_markers)]
    return label_trajectories(values, markers=names, rate_hz=rate_hz)


def turned(clip, degrees, way=(0.0, 0.0)):
    turn = Rotation.from_euler("z", degrees, degrees=True).as_matrix()
    return clip.copy(data=clip.values @ turn.T + [*way, 0.0])


def by_cdist(a, b, metric, weights):
    return sum(w * shaped(metric, cdist(a[:, k], b[:, k])) for k, w in enumerate(weights) if w > 0)


@BY_SHAPE
@pytest.mark.parametrize("sizes", [(1, 1), (1, 7), (40, 33), (200, 190)])
def test_maps_are_those_of_cdist(metric, sizes):
    rng = np.random.default_rng(sum(sizes))
    a, b = (rng.normal(size=(n, 5, 3)) * 100 + 1e4 for n in sizes)
    weights = np.array([0.5, 0.0, 0.2, 0.2, 0.1])
    found = point_map(a, b, weights, shape=metric.shape, parameter=metric.scale or 0.3)
    expected = by_cdist(a, b, metric, weights)
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-6)


@BY_SHAPE
def test_large_maps_are_off_by_less_than_a_millionth_of_how_far_points_move(metric):
    rng = np.random.default_rng(1)
    a, b = (rng.normal(size=(n, 5, 3)) * 100 + 1e4 for n in (1100, 900))
    assert 5 * len(a) * len(b) > EXACT
    weights = np.full(5, 0.2)
    found = point_map(a, b, weights, shape=metric.shape, parameter=metric.scale or 0.3)
    np.testing.assert_allclose(found, by_cdist(a, b, metric, weights), rtol=2e-6)
    own = point_map(a, a, weights, shape=metric.shape, parameter=metric.scale or 0.3)
    assert np.diagonal(own).max() == 0
    np.testing.assert_allclose(own, own.T, rtol=1e-9)


def test_large_maps_of_orientations_are_exact_to_a_millionth_of_a_radian():
    rng = np.random.default_rng(2)
    a, b = (Rotation.random(n, rng).as_quat()[:, None] for n in (2100, 2000))
    assert len(a) * len(b) > EXACT
    found = point_map(a, b, np.ones(1), shape="absolute")
    expected = 2 * np.arccos(np.minimum(np.abs(a[:, 0] @ b[:, 0].T), 1))
    np.testing.assert_allclose(found, expected, atol=2e-6)


@BY_SHAPE
def test_a_map_of_labelled_clips_weighs_common_markers_alike_whatever_their_order(metric):
    a = some_clip(1, names=["head", "left_knee", "only_a", "pelvis"])
    b = some_clip(2, 30, names=["pelvis", "head", "only_b", "left_knee"])
    names = ["head", "left_knee", "pelvis"]
    values = [clip.sel(marker=names).values for clip in (a, b)]
    found = motion_map(a, b, metric=metric)
    assert found.dims == ("time_a", "time_b")
    np.testing.assert_array_equal(found.time_b, b.time)
    np.testing.assert_allclose(found, by_cdist(*values, metric, np.full(3, 1 / 3)), rtol=1e-9)


@settings(max_examples=25, deadline=None)
@given(
    seed=st.integers(0, 1000),
    metric=st.sampled_from(METRICS),
    by=st.sampled_from(["positions", "velocities"]),
    window_s=st.sampled_from([0.0, 0.1, 3.0]),
    align=st.booleans(),
)
def test_maps_are_symmetric_and_zero_on_themselves(seed, metric, by, window_s, align):
    metric = FrameMetric(by, metric.shape, metric.scale, metric.exponent)
    options = {"metric": metric, "window_s": window_s, "align": align}
    a, b = some_clip(seed), some_clip(seed + 1, 26)
    there, back = motion_map(a, b, **options).values, motion_map(b, a, **options).values
    np.testing.assert_allclose(there, back.T, rtol=1e-8, atol=1e-6)
    itself = motion_map(a, **options).values
    nothing = 1e-3 if metric.shape == "power" else 1e-7
    np.testing.assert_allclose(itself.diagonal(), 0, atol=nothing * max(1, itself.max()))
    np.testing.assert_allclose(itself, motion_map(a, a.copy(), **options), rtol=1e-8, atol=1e-4)


@settings(max_examples=25, deadline=None)
@given(
    degrees=st.floats(-180, 180),
    way=st.tuples(st.floats(-5000, 5000), st.floats(-5000, 5000)),
    by=st.sampled_from(["positions", "velocities"]),
    window_s=st.sampled_from([0.0, 0.2]),
)
def test_an_aligned_map_does_not_know_heading_or_place(degrees, way, by, window_s):
    a, b = some_clip(1), some_clip(2, 25)
    options = {"metric": FrameMetric(by), "window_s": window_s, "align": True}
    expected = motion_map(a, b, **options)
    found = motion_map(a, turned(b, degrees, way), **options)
    np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-5)


@pytest.mark.parametrize("half", [0, 1, 3])
def test_alignment_is_the_best_of_all_turns_and_moves_of_a_window(half):
    """Brute force: of a thousand turns and the moves that suit them, none does better."""
    a, b = some_clip(3, 12).values, some_clip(4, 14).values
    found = align_windows(a, b, half)
    i, j = 6, 7
    windows = a[i - half : i + half + 1], b[j - half : j + half + 1]
    middles = [window.mean(axis=(0, 1)) * [1, 1, 0] for window in windows]
    first, second = (window - middle for window, middle in zip(windows, middles, strict=True))
    turns = Rotation.from_rotvec(np.linspace(-np.pi, np.pi, 1001)[:, None] * [0, 0, 1])
    squares = [np.square(first - second @ turn.as_matrix().T).mean() for turn in turns]
    own = Rotation.from_rotvec([0, 0, found.angles[i, j]]).as_matrix()
    placed = windows[1] @ own.T + [*found.shifts[i, j], 0]
    assert np.square(windows[0] - placed).mean() <= min(squares)
    best = turns[int(np.argmin(squares))].as_rotvec()[2]
    assert abs(np.angle(np.exp(1j * (best - found.angles[i, j])))) < 2 * np.pi / 1000


def test_windows_average_corresponding_frames():
    values = np.random.default_rng(0).normal(size=(9, 11))
    found = diagonal_means(values, 2)
    assert found[4, 6] == pytest.approx(np.mean([values[4 + s, 6 + s] for s in range(-2, 3)]))
    assert found[0, 5] == pytest.approx(np.mean([values[s, 5 + s] for s in range(3)]))
    assert found[8, 10] == pytest.approx(np.mean([values[8 - s, 10 - s] for s in range(3)]))


def test_orientations_are_compared_by_the_angle_between_them():
    rng = np.random.default_rng(0)
    a, b = Rotation.random(6, rng), Rotation.random(5, rng)
    expected = np.array([[(x.inv() * y).magnitude() for y in b] for x in a])
    quaternions = [each.as_quat()[:, None] for each in (a, b)]
    found = point_map(*quaternions, np.ones(1), shape="absolute")
    np.testing.assert_allclose(found, expected, atol=1e-12)
    other_sign = point_map(quaternions[0], -quaternions[1], np.ones(1), shape="absolute")
    np.testing.assert_allclose(other_sign, expected, atol=1e-12)
    assert point_distances(quaternions[0], -quaternions[0]).max() == 0


def test_missing_points_leave_their_weight_to_the_others():
    a, b = some_clip(1), some_clip(2)
    lost = a.copy()
    lost[3, 0] = np.nan
    found = motion_map(lost, b).values
    np.testing.assert_allclose(np.delete(found, 3, 0), np.delete(motion_map(a, b).values, 3, 0))
    rest = motion_map(a.isel(marker=[1, 2, 3]), b.isel(marker=[1, 2, 3])).values
    np.testing.assert_allclose(found[3], rest[3])
    lost[3] = np.nan
    assert np.isnan(motion_map(lost, b).values[3]).all()


@pytest.mark.parametrize("lost_frames", [[3], [0, 7, 8], [*range(4, 12)]])
def test_a_window_is_the_mean_of_those_frames_that_were_seen(lost_frames):
    a, b = some_clip(1), some_clip(2)
    lost = a.copy()
    lost[lost_frames] = np.nan
    cells = motion_map(lost, b).values
    found = motion_map(lost, b, window_s=4 / 50).values
    steps = range(-2, 3)
    for i, j in np.ndindex(cells.shape):
        before, after = min(2, i, j), min(2, len(a) - 1 - i, len(b) - 1 - j)
        window = np.array([cells[i + s, j + s] for s in steps if -before <= s <= after])
        seen = window[np.isfinite(window)]
        expected = seen.mean() if seen.size else np.nan
        np.testing.assert_allclose(found[i, j], expected, rtol=1e-9)
    assert np.isfinite(found).mean() > 0.5


def test_velocities_do_not_know_where_a_clip_is():
    a = some_clip(1)
    metric = FrameMetric("velocities")
    found = motion_map(a, a + np.array([500.0, 20, 3]), metric=metric)
    np.testing.assert_allclose(found, motion_map(a, metric=metric), atol=1e-9)
    assert found.attrs["units"] == "mm/s"


def test_maps_of_groups_add_up_to_that_of_all():
    walk = simulate_walk(seed=1, duration_s=1, rate_hz=40)
    other = simulate_walk(seed=2, duration_s=1, rate_hz=40)
    names = walk.marker.values.tolist()
    groups = {"upper": names[:9], "lower": names[9:], "wings": ["left_wing"]}
    maps = motion_maps(walk, other, groups=groups)
    assert maps.group.values.tolist() == ["upper", "lower"]
    together = (9 * maps[0] + 6 * maps[1]) / 15
    np.testing.assert_allclose(together, motion_map(walk, other), rtol=1e-12)


def test_a_published_metric_goes_by_its_name():
    walk = simulate_walk(seed=1, duration_s=1, rate_hz=30)
    cells = motion_map(walk, metric="positions-sigmoid")
    assert cells.attrs["shape"] == "sigmoid"
    assert 0 < float(cells.max()) < 1


def test_joint_angles_do_not_know_heading_or_place():
    walk = simulate_walk(seed=1, duration_s=1, rate_hz=30)
    metric = FrameMetric("angles")
    expected = motion_map(walk, metric=metric)
    found = motion_map(walk, turned(walk, 70, (300, 100)), metric=metric)
    np.testing.assert_allclose(found, expected, atol=1e-6)


@pytest.mark.parametrize(
    ("other", "options", "message"),
    [
        (some_clip(names=["a", "b", "c", "d"]), {}, "no points in common"),
        (some_clip(rate_hz=30), {"window_s": 0.2}, "needs one rate"),
        (some_clip(), {"window_s": -1}, "give seconds"),
        (some_clip(), {"metric": "euclid"}, "not known"),
        (some_clip().isel(time=slice(0, 0)), {}, "frames"),
        (some_clip().assign_attrs(units="m"), {}, "Expected millimetres"),
        (some_clip().isel(time=[0]), {"metric": FrameMetric("velocities")}, "two frames"),
        (some_clip(), {"metric": FrameMetric(weights={"nose": 1})}, "weighs anything"),
        (some_clip().where(some_clip().marker == "m9"), {"align": True}, "all frames"),
    ],
)
def test_clips_that_do_not_fit_are_refused_with_words(other, options, message):
    with pytest.raises(ValueError, match=message):
        motion_map(some_clip(), other, **options)


@pytest.mark.parametrize(("n_frames", "align"), [(9000, False), (3500, True)])
def test_a_map_that_would_not_fit_into_memory_is_refused(n_frames, align):
    long = label_trajectories(np.zeros((n_frames, 1, 3)), markers=["head"], rate_hz=120)
    with pytest.raises(ValueError, match="every n-th frame"):
        motion_map(long, align=align)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"by": "colour"}, "by='colour'"),
        ({"shape": "cubed"}, "shape='cubed'"),
        ({"shape": "sigmoid", "scale": np.inf}, "is no distance above 0"),
        ({"shape": "sigmoid", "scale": -1}, "is no distance above 0"),
        ({"shape": "power"}, "exponent="),
        ({"weights": {"head": -1}}, "0 or more"),
        ({"weights": {"head": np.nan}}, "0 or more"),
    ],
)
def test_a_metric_that_cannot_be_is_refused(options, message):
    with pytest.raises(ValueError, match=message):
        FrameMetric(**options)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork on this system")
@pytest.mark.filterwarnings("ignore:This process:DeprecationWarning")
def test_maps_are_filled_in_a_forked_process_too():
    """Threads of the parent do not live on in a child, which must not wait for them."""
    a, weights = np.random.default_rng(0).normal(size=(200, 15, 3)), np.full(15, 1 / 15)
    expected = point_map(a, a + 1, weights, shape="absolute").sum()
    reading, writing = os.pipe()
    child = os.fork()
    if not child:
        found = point_map(a, a + 1, weights, shape="absolute").sum()
        os.write(writing, repr(float(found)).encode())
        os._exit(0)
    ready, _, _ = select.select([reading], [], [], 30)
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    assert ready
    assert float(os.read(reading, 100)) == expected
    os.close(reading)
    os.close(writing)


def test_maps_of_cycles_have_the_velocities_of_clip_distances():
    noise = np.random.default_rng(0).normal(size=(120, 15, 3))
    cycles = [common_clock(loop(simulate_walk(seed=seed, truth=False))) + noise for seed in (1, 2)]
    metric = FrameMetric("velocities")
    found = motion_map(*cycles, metric=metric, periodic=True).values
    points = [points_of(cycle, "velocities", periodic=True)[1] for cycle in cycles]
    apart = point_distances(*points).mean(axis=1)
    np.testing.assert_allclose(np.diagonal(found), apart)
    assert np.diagonal(motion_map(*cycles, metric=metric).values).mean() > apart.mean()


def test_a_gap_does_not_change_the_scale_of_a_map():
    rng = np.random.default_rng(0)
    a, b = rng.normal(size=(2, 6, 3, 3))
    whole = point_map(a, b, np.array([2.0, 1.0, 1.0]), shape="absolute")
    a[0] = np.nan
    holed = point_map(a, b, np.array([2.0, 1.0, 1.0]), shape="absolute")
    np.testing.assert_allclose(holed[1:], whole[1:])
