"""Stimulus files: what is written comes back, and what is hostile is refused."""

from __future__ import annotations

import copy
import json

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from eigenwalker.core.trajectories import label_trajectories
from eigenwalker.core.walker import Walker
from eigenwalker.datasets.built_in import load_population
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.stimulus.figure import Figure
from eigenwalker.stimulus.make import make_stimulus
from eigenwalker.stimulus.stimulus import Stimulus
from eigenwalker.stimulus.write_stimulus import write_stimulus


@pytest.fixture(scope="module")
def plain() -> Stimulus:
    people = load_population()
    return make_stimulus(people.walker(people.average), provenance={"licence": "CC BY 4.0"})


def hop() -> Walker:
    return Walker(["foot"], [[0, 0, 50]], [[[0, 0, 40]]], [1], [0], 1.0)


def test_a_plain_walker_is_under_20_kb(plain):
    assert len(plain.to_json().encode()) < 20_000


def test_a_file_comes_back_to_the_bit(plain, tmp_path):
    made = plain.then("scramble", seed=3).then("invert").sized(
        5, viewing_distance_mm=570, px_per_cm=38
    )  # fmt: skip
    path = write_stimulus(made, tmp_path / "stim.json")
    again = Stimulus.load(path)
    assert again.to_json() == made.to_json()
    time = np.linspace(0, 4, 7)
    assert (again.play(time).positions == made.play(time).positions).all()


def test_a_file_says_what_was_done_and_with_what(plain):
    content = plain.then("scramble", seed=3).to_dict()
    assert content["provenance"]["licence"] == "CC BY 4.0"
    assert content["provenance"]["program"].startswith("eigenwalker ")
    assert content["transforms"] == [
        {"name": "scramble", "seed": 3, "keep": "nothing", "directions": "both", "figures": None,
         "box_mm": content["transforms"][0]["box_mm"]}
    ]  # fmt: skip


def test_sampled_trajectories_come_back_with_their_gaps(tmp_path):
    values = np.random.default_rng(0).normal(size=(30, 2, 3), scale=300)
    values[3:7, 1] = np.nan
    walk = label_trajectories(values, markers=["one", "two"], rate_hz=100)
    made = make_stimulus(Figure(walk, repeat=True))
    again = Stimulus.load(write_stimulus(made, tmp_path / "walk.json"))
    np.testing.assert_allclose(again.play().positions, made.play().positions, atol=1e-9)
    assert (again.play().visible == made.play().visible).all()
    np.testing.assert_allclose(made.play([0.02]).positions[0], values[2], atol=1e-6)


WRONG = {
    "no object": [],
    "another format": {"format": "something"},
    "a name nobody knows": {"surprise": 1},
    "another version": {"version": 2},
    "no figures": {"figures": []},
    "a true for a number": {"view": {"centre_mm": [0, 0, 0], "view_deg": True}},
    "a text for a number": {"timing": {"duration_s": "4"}},
    "a duration without end": {"timing": {"duration_s": 1e9}},
    "no duration": {"timing": {"duration_s": 0}},
    "a colour that runs": {"display": {"px_per_mm": 1, "colour": "red;url(x)"}},
    "half a letter": {"provenance": {"source": "\ud800"}},
    "too many words": {"provenance": {str(i): "x" for i in range(31)}},
    "an unknown transform": {"transforms": [{"name": "explode"}]},
    "a transform without a name": {"transforms": [{}]},
    "transforms without end": {"transforms": [{"name": "invert"}] * 65},
    "an unknown parameter": {"transforms": [{"name": "invert", "twice": True}]},
    "a seed below 0": {"transforms": [{"name": "phase_scramble", "seed": -1}]},
    "half a seed": {"transforms": [{"name": "phase_scramble", "seed": 0.5}]},
    "a figure that is not there": {"transforms": [{"name": "invert", "figures": [1]}]},
    "a dot that is not there": {"transforms": [{"name": "occlude", "markers": ["tail"]}]},
    "no speed": {"transforms": [{"name": "speed", "factor": 0}]},
    "an axis of no length": {"transforms": [{"name": "rotate", "axis": [0, 0, 0]}]},
    "clocks upon clocks": {"transforms": [{"name": "phase_scramble", "seed": 1}] * 9},
    "a step back in a morph": {"transforms": [{"name": "morph", "start_s": 2, "end_s": 1}]},
}


@pytest.mark.parametrize("change", WRONG.values(), ids=WRONG)
def test_what_is_wrong_is_refused_in_words(plain, change, tmp_path):
    content = plain.to_dict()
    content = {**content, **change} if isinstance(change, dict) else change
    with pytest.raises(ValueError, match="This is no stimulus: "):
        Stimulus.from_dict(content)
    path = tmp_path / "wrong.json"
    path.write_text(json.dumps(content), encoding="utf-8")
    with pytest.raises(UnreadableFile, match=r"wrong\.json: expected a stimulus"):
        Stimulus.load(path)


@pytest.mark.parametrize(("change", "named"), [
    ({"view": {"centre_mm": [0, 0, 0], "view_deg": True}}, ["view.view_deg", "a number", "True"]),
    ({"timing": {"duration_s": 1e9}}, ["timing.duration_s", "3600", "1000000000"]),
    ({"version": 2}, ["version", "1", "2"]),
    ({"view": {}}, ["view.centre_mm", "none"]),
    ({"surprise": 1}, ["'figures'", "surprise"]),
    ({"figures": []}, ["figures", "1 to 64", "0"]),
    ({"transforms": [{"name": "fold"}]}, ["transforms[0]", "invert", "fold"]),
    ({"transforms": [{"name": "invert", "twice": 1}]}, ["transforms[0] (invert)", "twice"]),
    ({"transforms": [{"name": "rotate", "axis": "q"}]}, ["(rotate).axis", "sight", "'q'"]),
    ({"transforms": [{"name": "occlude", "markers": ["tail"]}]}, ["(occlude)", "tail", "pelvis"]),
    ({"transforms": [{"name": "invert", "figures": [0, 0]}]}, ["(invert).figures", "twice"]),
])  # fmt: skip
def test_a_problem_names_its_place_what_was_expected_and_what_is_there(plain, change, named):
    with pytest.raises(ValueError, match="This is no stimulus: ") as refused:
        Stimulus.from_dict(plain.to_dict() | change)
    assert [part for part in named if part not in str(refused.value)] == []


def test_all_problems_are_named_at_once_and_no_more_than_twenty(plain):
    content = plain.to_dict()
    with pytest.raises(ValueError, match=r"view_deg.*duration_s"):
        Stimulus.from_dict(content | {"view": {"view_deg": "1"}, "timing": {"duration_s": 0}})
    with pytest.raises(ValueError, match=r"transforms\[19\].*and more") as refused:
        Stimulus.from_dict(content | {"transforms": [{"name": "fold"}] * 64})
    assert "transforms[20]" not in str(refused.value)


@pytest.mark.parametrize("change", [
    {f"name {number}": 1 for number in range(200_000)},
    {"transforms": [{}] * 200_000}, {"transforms": [{"name": "occlude", "markers": [1] * 200_000}]},
    {"provenance": {str(number): 1 for number in range(200_000)}},
    {"transforms": [{"name": "freeze", **{str(number): 1 for number in range(200_000)}}]},
], ids=["names", "transforms", "markers", "texts", "parameters"])  # fmt: skip
def test_a_huge_file_is_refused_with_a_short_message(plain, change):
    with pytest.raises(ValueError, match="This is no stimulus: ") as refused:
        Stimulus.from_dict(plain.to_dict() | change)
    assert len(str(refused.value)) < 5000


@pytest.mark.parametrize("figure", [
    {"walker": None}, {"trajectories": {}}, {"segments": [["head", "tail"]]},
    {"pairs": [["head", "pelvis"], ["pelvis", "sternum"]]}, {"segments": [["head", "head"]]},
])  # fmt: skip
def test_a_figure_that_does_not_fit_together_is_refused(plain, figure):
    content = plain.to_dict()
    content["figures"][0] |= figure
    with pytest.raises(ValueError, match=r"figures\[0\]"):
        Stimulus.from_dict(content)


@pytest.mark.parametrize("walker", [
    {"frequency_hz": 0}, {"phases": [0]}, {"p0": [[0, 0, 0]]}, {"harmonics": [1, 1, 2, 2.5]},
    {"markers": ["head"] * 15}, {"p": [[[0, 0]]]}, {"frequency_hz": 1e400},
])  # fmt: skip
def test_a_walker_that_cannot_walk_is_refused(plain, walker):
    content = plain.to_dict()
    content["figures"][0]["walker"] |= walker
    with pytest.raises(ValueError, match="walker"):
        Stimulus.from_dict(content)


@pytest.mark.parametrize("samples", [
    [], [[]], [[[0, 0]]], [[[0, 0, True]]], [[[0, 0, "1"]]], [[[0, 0, 1e9]]], [[[None] * 3]] * 4,
    [[[0, 0, None]]] * 2,     [[[0, 0, 0]], [[0, 0]]], [[[0, 0, 0]]], "walk", [[[0, 0, 10**400]]],
])  # fmt: skip
def test_samples_that_are_none_are_refused(samples):
    figure = {"trajectories": {"markers": ["dot"], "rate_hz": 100, "samples": samples}}
    content = make_stimulus(hop()).to_dict() | {"figures": [figure]}
    with pytest.raises(ValueError, match="samples"):
        Stimulus.from_dict(content)


@pytest.mark.parametrize("text", [
    "", "{", "null", "[" * 100_000, '{"format": NaN}', '{"a": 1, "a": 2}', '{"version": -Infinity}',
    '{"version": ' + "9" * 5000 + "}", "\ufeff", "{}",
])  # fmt: skip
def test_a_text_that_is_no_stimulus_is_refused(text, tmp_path):
    with pytest.raises(ValueError, match="stimulus"):
        Stimulus.from_json(text)
    path = tmp_path / "bad.json"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(UnreadableFile):
        Stimulus.load(path)


def test_bytes_that_are_no_text_are_refused(tmp_path):
    path = tmp_path / "bytes.json"
    path.write_bytes(b"\xff\xfe\x00{")
    with pytest.raises(UnreadableFile, match="UTF-8"):
        Stimulus.load(path)


def test_damaged_files_play_or_are_refused(plain, damaged):
    sound = plain.then("limb_dots", number=5, lifetime_s=0.1, seed=1).to_json().encode()
    for content in damaged(sound, 300):
        try:
            stimulus = Stimulus.from_json(content.decode("utf-8", errors="replace"))
        except ValueError:
            continue
        assert stimulus.play([0.0, 0.5]).positions.shape[0] == 2


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner),
    max_leaves=6,
)


@given(data=st.data(), value=JSON)
@settings(max_examples=200, deadline=None)
def test_any_value_anywhere_is_taken_or_refused(data, value):
    made = make_stimulus(hop()).then("rotate", axis="x", angle_deg=3)
    content = copy.deepcopy(made.to_dict())
    place = content
    while True:
        key = data.draw(st.sampled_from(list(place) if isinstance(place, dict)
                                        else list(range(len(place)))))  # fmt: skip
        if data.draw(st.booleans()) or not isinstance(place[key], dict | list) or not place[key]:
            place[key] = value
            break
        place = place[key]
    try:
        stimulus = Stimulus.from_dict(content)
    except ValueError:
        return
    assert np.isfinite(stimulus.play([0.0, 0.3]).positions).all()


def test_unknown_transforms_and_parts_name_what_is_known(plain):
    with pytest.raises(ValueError, match=r"there are.*invert"):
        plain.then("upside_down")
    with pytest.raises(ValueError, match=r"tail.*there are head"):
        plain.then("occlude", parts="tail")
    with pytest.raises(ValueError, match="speed of this figure is not known"):
        make_stimulus(hop()).then("overground")


def test_a_stimulus_is_not_changed_by_what_comes_after(plain):
    before = plain.to_json()
    plain.then("invert").then("mask", seed=1, number=3)
    assert plain.to_json() == before


def test_a_chain_that_nobody_could_play_in_time_is_refused(plain):
    chain = plain
    for seed in range(4):
        chain = chain.then("phase_scramble", seed=seed)  # 15^5 dots
    with pytest.raises(ValueError, match="its chain computes 11390625 dots for one moment, and no "
                                         "more than 1000000 are shown in time"):  # fmt: skip
        chain.then("phase_scramble", seed=4)
