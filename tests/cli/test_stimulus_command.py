"""``eigenwalker stimulus``, as a person types it."""

from __future__ import annotations

import itertools
import json
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from eigenwalker.io.read import read_mocap
from eigenwalker.markers.virtual_markers import virtual_markers
from eigenwalker.simulation import simulate_walk
from eigenwalker.stimulus import Stimulus


@pytest.fixture
def run(run_command, monkeypatch, tmp_path):
    """Type the options of a stimulus in an empty folder; get exit code, output, and complaint."""
    monkeypatch.chdir(tmp_path)
    return partial(run_command, "stimulus")


def test_options_act_in_one_order_however_they_are_typed(run):
    options = (["--trait", "sex=2"], ["--invert"], ["--scramble", "seed=3"], ["--speed", "1.5"])
    files = []
    for number, order in enumerate(itertools.islice(itertools.permutations(options), 0, 24, 9)):
        code, said, _ = run(*itertools.chain(*order), "-o", f"{number}.json")
        assert code == 0
        assert "speed, then invert, then scramble" in said
        files.append(Path(f"{number}.json").read_text())
    assert len(set(files)) == 1


def test_every_transform_can_be_typed(run):
    code, _, complaint = run(
        *("--from", "3", "--information", "dynamics"),
        *("--gain", "parts=legs,factor=0.5", "--arm-swing", "2", "--conflict", "hip_sway=2"),
        *("--ellipses", "shoulder=35/12,hip=15/20"),
        *("--perturb", "markers=left_knee,amount=0/50/0,frequency=3", "--speed", "2"),
        *("--start", "90", "--reverse", "--freeze", "0.2", "--delay", "parts=arms,phase=90"),
        *("--phase-scramble", "seed=1", "--morph-to", "sex=-2", "--mirror", "--overground"),
        *("--rotate", "axis=1/0/1,angle=10", "--rotate", "axis=sight,angle=180", "--invert"),
        *("--occlude", "head/lower_body", "--scramble", "seed=3,keep=structure"),
        *("--limb-dots", "number=8,lifetime=none,seed=1", "--blur", "20"),
        *("--mask", "kind=scrambled,signal_to_noise=0.5,seed=2"),
        *("--view", "90", "--elevation", "10", "--eye-distance", "3000", "--size", "300x400"),
        *("--duration", "2", "--rate", "50", "--height-deg", "5", "-o", "all.json"),
    )
    assert code == 0, complaint
    content = json.loads(Path("all.json").read_text())
    names = [step["name"] for step in content["transforms"]]
    assert names == [
        *("gain", "gain", "conflict", "ellipses", "perturb", "speed", "start", "reverse"),
        *("freeze", "delay", "phase_scramble", "morph", "mirror", "translate", "rotate"),
        *("rotate", "invert", "occlude", "scramble", "limb_dots", "blur", "mask"),
    ]
    assert content["display"]["width_px"] == 300
    assert content["view"]["eye_distance_mm"] == 3000
    assert content["timing"] == {"duration_s": 2, "rate_hz": 50}
    assert "simulated" in content["provenance"]["source"]


def test_a_stimulus_file_is_taken_further(run):
    assert run("--invert", "--view", "90", "-o", "one.json")[0] == 0
    assert run("one.json", "--mirror", "--duration", "1", "-o", "two.json")[0] == 0
    two = Stimulus.load("two.json")
    assert [step["name"] for step in two.transforms] == ["invert", "mirror"]
    assert (two.view.view_deg, two.timing.duration_s) == (90, 1)
    code, _, complaint = run("one.json", "--trait", "sex=2")
    assert (code, "--trait is for populations" in complaint) == (2, True)


def test_synthesize_is_stimulus_by_another_name(run, run_command):
    words = ("--from", "3", "--trait", "sex=2", "--part", "structure", "--kind", "mean_difference")
    said = {}
    for command in ("stimulus", "synthesize"):
        code, said[command], complaint = run_command(
            command, *words, "--strides", "2", "-o", f"{command}.json"
        )
        assert code == 0, complaint
    assert said["stimulus"].replace("stimulus.json", "synthesize.json") == said["synthesize"]
    assert "sex: 2 standard deviations towards male" in said["stimulus"]
    texts = {Path(f"{command}.json").read_text() for command in said}
    assert len(texts) == 1
    made = Stimulus.from_json(texts.pop())
    assert made.timing.duration_s == pytest.approx(2 / made.figures[0].motion.frequency_hz)


def test_a_figure_for_animators_says_how_still_its_feet_stand(run):
    code, said, _ = run("--duration", "2", "-o", "walk.glb")
    assert code == 0
    assert "Standing feet slide at" in said


def test_a_capture_in_another_style_keeps_its_bones(run, write_c3d, tmp_path):
    walk = simulate_walk(seed=2, duration_s=6, markers="skin", rate_hz=60)
    capture = write_c3d(tmp_path / "own.c3d", walk) or tmp_path / "own.c3d"
    own = virtual_markers(read_mocap(capture), joints="full")
    found = {}
    for steps in ("0", "3"):
        words = ("--from", str(capture), "--trait", f"sex={steps}", "--strides", "1")
        code, said, complaint = run(*words, "-o", f"{steps}.bvh")
        assert code == 0, complaint
        assert "left_toe" in said
        found[steps] = read_mocap(f"{steps}.bvh", unit="cm")
    bones = [("hip", "knee"), ("knee", "ankle"), ("shoulder", "elbow"), ("elbow", "wrist")]
    bones += [("ankle", "toe"), ("wrist", "hand")]
    for side, (one, other) in itertools.product(("left", "right"), bones):
        lengths = [
            float(np.median(np.linalg.norm(np.diff(
                each.sel(marker=[f"{side}_{one}", f"{side}_{other}"]).values, axis=1), axis=2)))
            for each in (own, *found.values())
        ]  # fmt: skip
        assert lengths == pytest.approx([lengths[0]] * 3, rel=0.01, abs=2.5)
    elbows = [each.sel(marker="left_elbow", axis="y").values.mean() for each in found.values()]
    assert elbows[1] - elbows[0] > 10  # arms away from the body: the style is there


@pytest.mark.parametrize(("words", "complaint"), [
    (["--scramble", "sed=3"], "expected name=value"),
    (["--trait", "sex"], "does not say how far"),
    (["--from", "99"], "a walker from 0 to 39"),
    (["--from", "nobody.c3d"], "--from nobody.c3d"),
    (["--information", "some"], "choose 'full', 'structure' or 'dynamics'"),
    (["--size", "big"], "width and height"),
    (["-o", "stim.avi"], "must end in one of"),
    (["--part", "structure"], "give --trait too"),
    (["--strides", "0"], "expected 1 or more"),
    (["--strides", "1", "--duration", "2"], "in place of --duration"),
])  # fmt: skip
def test_what_is_typed_wrong_is_said_in_a_sentence(run, words, complaint):
    code, _, said = run(*words)
    assert code == 2
    assert complaint in said
