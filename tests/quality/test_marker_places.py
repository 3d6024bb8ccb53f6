"""Exchanged and misplaced markers on the skin are found and named; those of people are not."""

from itertools import combinations, permutations

import numpy as np
import pytest

import eigenwalker as ew
from eigenwalker.io.read import read_mocap
from eigenwalker.quality.marker_places import wrong_markers
from eigenwalker.simulation.walk import simulate_walk

NONE = ((), False)
TELLING = [
    ("LANK", "LTOE"),
    ("LTHI", "RTHI"),
    ("LTIB", "RTIB"),
    ("CLAV", "C7"),
    ("CLAV", "STRN"),
    ("T10", "STRN"),
    ("LASI", "LPSI"),
    ("LASI", "LWRA"),
    ("LSHO", "LUPA"),
    ("LFHD", "RBHD"),
    ("LHEE", "RHEE"),
    ("LKNE", "LTHI"),
    ("LWRA", "RFIN"),
]


@pytest.fixture(scope="module")
def person():
    return simulate_walk(seed=3, markers="skin", duration_s=2, rate_hz=25)


def relabelled(capture, one, other, *, copied=False):
    names = capture.marker.values.tolist()
    i, j = names.index(one), names.index(other)
    values = capture.values.copy()
    values[:, i] = capture.values[:, j]
    if not copied:
        values[:, j] = capture.values[:, i]
    return capture.copy(data=values)


def found(capture):
    return {(each.kind, frozenset(each.points)) for each in wrong_markers(capture)[0]}


@pytest.mark.parametrize("pair", TELLING)
def test_exchanged_markers_are_named(person, pair):
    assert found(relabelled(person, *pair)) == {("exchanged", frozenset(pair))}


def test_every_exchange_is_found(person):
    pairs = list(combinations(person.marker.values.tolist(), 2))[::29]
    assert [pair for pair in pairs if not found(relabelled(person, *pair))] == []


def test_a_marker_in_the_place_of_another_is_found(person):
    pairs = list(permutations(person.marker.values.tolist(), 2))[::47]
    for pair in pairs:
        assert found(relabelled(person, *pair, copied=True)) == {("place", frozenset(pair))}


def test_two_exchanges_are_both_named(person):
    both = relabelled(relabelled(person, "LANK", "LTOE"), "C7", "CLAV")
    assert found(both) == {
        ("exchanged", frozenset({"LANK", "LTOE"})),
        ("exchanged", frozenset({"C7", "CLAV"})),
    }


def test_a_marker_that_lies_elsewhere_is_named(person):
    values = person.values.copy()
    values[:, person.marker.values.tolist().index("LASI"), 0] -= 400
    assert found(person.copy(data=values)) == {("elsewhere", frozenset({"LASI"}))}


def test_the_verdict_names_the_exchanged_markers(person):
    walk = simulate_walk(seed=3, markers="skin", duration_s=6, rate_hz=50)
    exchanged = relabelled(walk, "LTHI", "RTHI")
    for quality in (ew.assess(exchanged), ew.study.process_capture(exchanged).quality):
        assert quality.verdict == "do not use"
        assert {"LTHI and RTHI are exchanged", "RTHI and LTHI are exchanged"} & {
            ew.study.reasons(quality)[0].rstrip(".").partition(": ")[2]
        }
    assert ew.study.process_capture(walk).quality.verdict == "use"


@pytest.mark.parametrize("mirror", [[1, -1, 1], [-1, 1, 1]])
def test_a_mirrored_body_is_told_from_wrong_labels(person, mirror):
    assert wrong_markers(person.copy(data=person.values * mirror)) == ((), True)


@pytest.mark.parametrize(
    "build",
    [
        {"height_mm": 700.0, "frequency_hz": 1.2},
        {"height_mm": 2150.0},
        {"body_mass_index": 50.0},
        {"step_width_mm": 260.0},
        {"step_width_mm": 0.0},
        {"frequency_hz": 0.45},
    ],
)
def test_markers_of_people_of_all_builds_are_in_place(build):
    for seed in (1, 2):
        walk = simulate_walk(seed=seed, markers="skin", duration_s=3, rate_hz=25, **build)
        turned = walk.copy(data=walk.values[..., [1, 0, 2]] * [-1, 1, 1])
        assert wrong_markers(walk) == wrong_markers(turned) == NONE


def test_gaps_and_unknown_names_are_no_wrong_markers(person):
    values = person.values.copy()
    values[::3, ::4] = np.nan
    values[:, 5] = np.nan
    assert wrong_markers(person.copy(data=values)) == NONE
    assert wrong_markers(person.assign_coords(marker=[f"m{i}" for i in range(38)])) == NONE


@pytest.mark.parametrize("name", ["cmu/02_01.c3d", "pycgm/Movement_trial.c3d"])
def test_real_markers_are_in_place_and_their_exchanges_are_found(captures, name):
    capture = read_mocap(captures / name)[::8]
    assert wrong_markers(capture) == NONE
    pairs = [pair for pair in TELLING if {*pair} <= {*capture.marker.values.tolist()}]
    seen = [pair for pair in pairs if np.isfinite(capture.sel(marker=list(pair))).all()]
    assert [pair for pair in seen if not found(relabelled(capture, *pair))] == []
