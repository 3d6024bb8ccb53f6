"""One pipeline from a capture to a walker: each step once, the same walk judged and decomposed."""

import sys

import numpy as np
import pytest

import eigenwalker as ew
from eigenwalker.markers.virtual_markers import virtual_markers
from eigenwalker.quality.assessment import bone_length_variation
from eigenwalker.study import messages
from eigenwalker.study.process_capture import NoWalkError, process_capture


@pytest.fixture(scope="module")
def person():
    return ew.simulate_walk(seed=4, duration_s=6, rate_hz=100, noise_mm=1, markers="skin")


def counted(monkeypatch, module, name):
    """Return a list to which each call of a module's function is added."""
    place, calls = sys.modules[f"eigenwalker.{module}"], []
    function = getattr(place, name)
    monkeypatch.setattr(place, name, lambda *a, **k: (calls.append(a), function(*a, **k))[1])
    return calls


def test_each_step_runs_once(person, monkeypatch):
    in_place = counted(monkeypatch, "study.process_capture", "in_place")
    virtual = counted(monkeypatch, "study.process_capture", "virtual_markers")
    repairs = [
        counted(monkeypatch, module, "repair_labels")
        for module in ("gait.in_place", "markers.virtual_markers", "quality.assessment")
    ]
    process_capture(person)
    assert len(in_place) == len(virtual) == 1
    assert sum(map(len, repairs)) == 1


@pytest.mark.parametrize("low_pass_hz", [None, 6.0])
def test_the_walk_that_is_decomposed_is_judged(person, low_pass_hz):
    result = process_capture(person, form="fourier", low_pass_hz=low_pass_hz)
    walk = ew.in_place(ew.virtual_markers(person), low_pass_hz=low_pass_hz)
    np.testing.assert_allclose(result.walk.values, walk.values, atol=1e-9)
    assert result.quality.r2 == pytest.approx(result.walker.fit.fourier_r2, abs=1e-6)
    assert result.quality.verdict == "use"
    assert result.capture is person


def test_attributes_of_a_capture_change_nothing(person):
    bare = person.drop_attrs()
    one, other = process_capture(person), process_capture(bare)
    np.testing.assert_array_equal(one.walk.values, other.walk.values)
    assert one.walker.speed_mm_s == other.walker.speed_mm_s
    assert one.quality == other.quality


def test_a_file_keeps_the_speed_that_it_states(tmp_path, person):
    walk = ew.in_place(ew.virtual_markers(person), speed_mm_s=1234)
    file = ew.write_mocap(walk, tmp_path / "walk.nc")
    result = process_capture(file)
    assert result.walker.speed_mm_s == 1234
    np.testing.assert_allclose(result.walk.values, walk.sel(time=result.walk.time), atol=1)


def test_repairs_gaps_and_what_is_left_out_are_tables(person):
    spoilt = person.copy()
    spoilt.loc[{"marker": "LKNE", "time": person.time[20]}] += 400
    spoilt.loc[{"marker": "LFHD", "time": person.time[:50]}] = np.nan
    result = process_capture(spoilt)
    assert result.repairs.to_dict("records") == [
        {"marker": "LKNE", "kind": "flicker", "first_frame": 20, "last_frame": 20, "partner": ""}
    ]
    start = result.left_out.query("kind == 'before'")
    assert start["last_frame"].tolist() == [
        int(np.searchsorted(spoilt.time.values, result.walk.time.values[0])) - 1
    ]
    for table in (result.gaps, result.left_out):
        assert list(table) == ["marker", "kind", "first_frame", "last_frame"]


def test_all_joints_have_the_walker_and_the_quality_of_the_fifteen(person):
    full, usual = process_capture(person, joints="full"), process_capture(person)
    assert set(ew.JOINTS.markers) < set(full.walk.marker.values.tolist())
    assert full.walker.markers == usual.walker.markers
    steady = virtual_markers(person).sel(time=full.walk.time.values)
    expected = bone_length_variation(steady)
    assert full.quality.bone_length_variation == pytest.approx(expected, rel=1e-9)


def test_a_capture_without_a_walk_says_what_is_known_of_it(person):
    still = person.copy(data=np.broadcast_to(person.values[:1], person.shape))
    with pytest.raises(NoWalkError, match="moves") as caught:
        process_capture(still)
    assert caught.value.quality.findings == ("no_steady_walk",)
    assert caught.value.quality.verdict == "do not use"


def test_options_of_files_are_refused_for_captures(person):
    with pytest.raises(TypeError, match="rate_hz"):
        process_capture(person, rate_hz=100)


def turned_over(walk):
    return walk.copy(data=walk.values * [1, -1, -1])


def leaning(walk):
    tilt = np.deg2rad(40)
    x, z = walk.values[..., 0], walk.values[..., 2]
    values = walk.values.copy()
    values[..., 0] = np.cos(tilt) * x + np.sin(tilt) * z
    values[..., 2] = np.cos(tilt) * z - np.sin(tilt) * x
    return walk.copy(data=values)


def mirrored(walk):
    return walk.copy(data=walk.values[:, ew.JOINTS.mirror()])


def swapped(walk):
    values = walk.values.copy()
    pair = [walk.marker.values.tolist().index(f"{side}_knee") for side in ("left", "right")]
    values[250:270, pair] = values[250:270, pair[::-1]]
    return walk.copy(data=values)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda walk: walk * 1000, ["measures 1.", " km", "unit of length is wrong"]),
        (lambda walk: walk / 2.54, [" mm", "no small child"]),
        (turned_over, ["head is not above the feet"]),
        (leaning, ["leans by 4"]),
        (mirrored, ["left is called right"]),
        (swapped, ["left_knee and right_knee, frames 250 to 269"]),
        (lambda walk: walk[:130], ["one stride"]),
        (lambda walk: walk[:30], ["No steady walk", "too short"]),
    ],
)
def test_reasons_name_what_was_found(change, words):
    walk = ew.simulate_walk(seed=4, duration_s=6, rate_hz=100, noise_mm=1)
    reasons = messages.flag_of(ew.assess(change(walk)))
    for each in words:
        assert each in reasons
