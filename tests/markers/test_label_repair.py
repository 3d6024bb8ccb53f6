"""Labels that change sides and markers that flicker are put right, and nothing else is touched."""

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

import eigenwalker as ew
from eigenwalker.markers.label_repair import Repair, repair_labels
from eigenwalker.markers.marker_sets import side_pairs
from eigenwalker.markers.virtual_markers import virtual_markers

RATES_HZ = (25, 60, 250)
LEGS = ("THI", "KNE", "TIB", "ANK", "HEE", "TOE")


@pytest.fixture(scope="module", params=RATES_HZ)
def capture(request):
    return ew.simulate_walk(
        seed=2, duration_s=6, rate_hz=request.param, variability=1, noise_mm=1, markers="skin"
    )


def rate_of(walk):
    return round(1 / float(walk.time[1] - walk.time[0]))


def swapped(walk, parts, first, last):
    """Return a capture with left and right exchanged in a share of its frames."""
    values = walk.values.copy()
    names = walk.marker.values.tolist()
    frames = slice(round(first * len(walk)), round(last * len(walk)))
    for left, right in side_pairs(names):
        if left[1:] in parts or not parts:
            one, other = names.index(left), names.index(right)
            values[frames, one] = walk.values[frames, other]
            values[frames, other] = walk.values[frames, one]
    return walk.copy(data=values)


def test_a_good_capture_stays_as_it_is(capture):
    assert repair_labels(capture) is capture


@pytest.mark.parametrize(
    ("parts", "first", "last"),
    [
        (("KNE",), 0.3, 0.5),
        (("ANK",), 0.55, 1),
        (("ASI",), 0, 0.4),
        (("ASI",), 0, 0.8),
        (("WRA", "WRB", "FIN"), 0.6, 0.9),
        (LEGS, 0.3, 1),
        ((), 0.5, 1),
        ((), 0, 0.3),
    ],
)
def test_sides_that_change_places_are_put_right(capture, parts, first, last):
    found = repair_labels(swapped(capture, parts, first, last))
    np.testing.assert_array_equal(found.values, capture.values)
    n_pairs = len(parts) or len(side_pairs(capture.marker.values.tolist()))
    swaps = found.attrs["repairs"]
    assert len(swaps) == n_pairs
    assert {(swap.kind, swap.first_frame, swap.last_frame) for swap in swaps} == {
        ("swap", round(first * len(capture)), round(last * len(capture)) - 1)
    }
    assert repair_labels(found).attrs == found.attrs


def test_someone_who_gets_along_walks_forwards_whatever_most_labels_say():
    walk = ew.simulate_walk(seed=2, duration_s=6, rate_hz=60, markers="skin")
    path = walk.attrs["speed_mm_s"] * walk.time.values[:, None, None] * [1, 0, 0]
    through = walk.copy(data=walk.values + path)
    found = repair_labels(swapped(through, (), 0.2, 1))
    np.testing.assert_array_equal(found.values, through.values)


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 2**31))
def test_isolated_jumps_are_taken_out_and_only_they(seed):
    rng = np.random.default_rng(seed)
    rate_hz = int(rng.choice([25, 60, 250]))
    walk = ew.simulate_walk(seed=3, duration_s=4, rate_hz=rate_hz, noise_mm=1, truth=False)
    spoilt = walk.values.copy()
    away = np.zeros(spoilt.shape[:2], dtype=bool)
    for marker in rng.choice(15, 4, replace=False):
        start = int(rng.integers(10, len(walk) - 10))
        length = int(rng.integers(1, max(2, 0.08 * rate_hz)))
        way = rng.normal(size=3)
        spoilt[start : start + length, marker] += 250 * way / np.linalg.norm(way)
        away[start : start + length, marker] = True
    found = repair_labels(walk.copy(data=spoilt))
    np.testing.assert_array_equal(np.isnan(found.values).all(axis=2), away)
    np.testing.assert_array_equal(found.values[~away], walk.values[~away])
    assert [repair.kind for repair in found.attrs["repairs"]] == ["flicker"] * 4


def test_a_marker_that_stays_elsewhere_has_jumped(capture):
    values = capture.values.copy()
    knee = capture.marker.values.tolist().index("LKNE")
    values[len(values) // 3 :, knee] += [0, 0, 300]
    found = repair_labels(capture.copy(data=values))
    first = len(values) // 3
    assert found.attrs["repairs"] == (Repair("LKNE", "jump", first, first),)
    np.testing.assert_array_equal(found.values, values)


def test_gaps_are_no_jumps(capture):
    holed = ew.simulate_walk(
        seed=2, duration_s=6, rate_hz=rate_of(capture), noise_mm=1, gap_share=0.05, markers="skin"
    )
    assert repair_labels(holed) is holed


def test_a_walk_comes_out_as_without_wrong_labels(capture):
    spoilt = swapped(capture, LEGS, 0.4, 0.7)
    spoilt.loc[{"marker": "LWRA", "time": capture.time[20]}] += 400
    good = ew.in_place(virtual_markers(capture))
    walk = ew.in_place(virtual_markers(spoilt))
    assert np.abs(walk.values - good.values).max() < 12
    assert ("LKNE", "RKNE") in [(each.marker, each.partner) for each in walk.attrs["repairs"]]
    assert Repair("LWRA", "flicker", 20, 20) in walk.attrs["repairs"]


def test_markers_that_no_joint_comes_from_do_not_matter(capture):
    spoilt = capture.copy()
    spoilt.loc[{"marker": ["LTOE", "LKNE"], "time": capture.time[20]}] += 400
    assert virtual_markers(spoilt).attrs["repairs"] == (Repair("LKNE", "flicker", 20, 20),)
    assert len(virtual_markers(spoilt, joints="full").attrs["repairs"]) == 2


def test_joints_are_repaired_too():
    walk = ew.simulate_walk(seed=4, duration_s=6, rate_hz=100)
    spoilt = walk.copy()
    spoilt.values[300:340, [10, 13]] = walk.values[300:340, [13, 10]]
    np.testing.assert_allclose(ew.in_place(spoilt).values, ew.in_place(walk).values, atol=1e-9)
    swap = Repair("left_knee", "swap", 300, 339, "right_knee")
    assert ew.in_place(spoilt).attrs["repairs"] == (swap,)


@pytest.mark.filterwarnings("ignore")  # the unit is guessed, and read_mocap says so
def test_real_captures_have_nothing_to_repair(captures):
    names = ["cmu/02_01.c3d", "cmu/12_01.bvh", "pycgm/Movement_trial.c3d"]
    files = [captures / name for name in names]
    for path in [*files, *sorted((captures / "bandai-namco").glob("*.bvh"))[::20]]:
        walk = ew.read_mocap(path)
        assert repair_labels(walk) is walk, path.name
