"""``eigenwalker stimulus``, as a person types it."""

from __future__ import annotations

import hashlib
import itertools
import json
from dataclasses import replace
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
        made = json.loads(Path(f"{number}.json").read_text())
        assert made["provenance"].pop("command").endswith(f"-o {number}.json")
        files.append(json.dumps(made))
    assert len(set(files)) == 1


def test_a_file_says_what_was_done_and_the_terminal_too(run):
    typed = ("--trait", "sex=3", "--information", "structure", "--from", "4", "-o", "one.json")
    _, said, _ = run(*typed)
    assert "sex 3 SD towards male" in said
    assert "structure only, from walker 4 of the population" in said
    about = Stimulus.load("one.json").provenance
    expected = {
        "trait": "sex",
        "standard_deviations": "+3",
        "towards": "male",
        "kind": "discriminant",
        "part": "all",
        "components": "10",
        "adjust": "nothing",
        "information": "structure",
        "started_from": "walker 4 of the population",
        "command": "eigenwalker stimulus " + " ".join(typed),
    }
    assert {name: about[name] for name in expected} == expected
    assert len(about["population_sha256"]) == 64
    assert about["program"].startswith("eigenwalker ")
    _, said, _ = run("one.json", "--invert", "-o", "two.json")
    assert "sex 3 SD towards male" in said
    about = Stimulus.load("two.json").provenance
    assert about["command"].endswith("; then eigenwalker stimulus one.json --invert -o two.json")
    assert about["made_from"].startswith("one.json, sha256 ")


def test_a_population_is_known_by_its_hash(run, run_command):
    run_command("simulate", "--women", "3", "--men", "3", "-o", "people.nc")
    assert run("people.nc", "-o", "one.json")[0] == 0
    about = Stimulus.load("one.json").provenance
    assert about["population"] == about["source"] == "people.nc"
    content = Path("people.nc").read_bytes()
    assert about["population_sha256"] == hashlib.sha256(content).hexdigest()


def test_dots_and_blobs_are_as_large_as_typed_for_all_walkers(run):
    sizes = set()
    for sds in (-3, 3):
        options = ("--trait", f"sex={sds}", "--height-deg", "5", "--blur", "20", "-o", "a.json")
        assert run(*options, "--mask", "number=9,seed=1")[0] == 0
        made = Stimulus.load("a.json")
        blob, mask = made.transforms[-2:]
        box = np.array(mask["box_mm"]) * made.display.px_per_mm
        sizes.add((made.display.dot_px, round(blob["sd_px"], 2), *box.round(1)))
    assert len(sizes) == 1
    assert sizes.pop()[:2] == (4.5365, 2.52)
    for option, px in (("--dot-px 7", 7), ("--dot-deg 0.2", 7.5608), ("--dot-mm 2", 7.6)):
        assert run(*option.split(), "--blur", "0.1deg", "-o", "a.json")[0] == 0
        made = Stimulus.load("a.json")
        assert (made.display.dot_px, made.transforms[0]["sd_px"]) == (px, 3.7804)
    assert run("a.json", "--dot-px", "3", "-o", "b.json")[0] == 0
    assert Stimulus.load("b.json").display.dot_px == 3


def test_a_random_start_is_stated_and_the_same_for_all_walkers(run):
    phases = set()
    for sds in (-3, 3):
        assert run("--trait", f"sex={sds}", "--start", "seed=3", "-o", "a.json")[0] == 0
        phases.add(Stimulus.load("a.json").transforms[0]["phase_deg"])
    assert len(phases) == 1
    assert 0 < phases.pop() < 360
    assert "expected degrees, or 'seed=3'" in run("--start", "random")[2]


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
    made, other = (Stimulus.load(f"{command}.json") for command in said)
    typed = [each.provenance.pop("command") for each in (made, other)]
    assert typed[0].replace("stimulus", "synthesize") == typed[1]
    texts = [replace(each, provenance={}).to_json() for each in (made, other)]
    assert texts[0] == texts[1]
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


def test_a_crowd_is_people_who_differ_and_come_again_with_the_seed(run):
    crowd = ("--crowd", "4", "--skeleton", "unity", "--in-place", "--rate", "30")
    for seed, output in (("1", "a.glb"), ("1", "b.glb"), ("2", "c.glb")):
        code, said, complaint = run(*crowd, "--seed", seed, "-o", output)
        assert code == 0, complaint
        assert "4 people drawn from the population" in said
    first, again, other = (Path(f"{name}.glb").read_bytes() for name in "abc")
    assert first == again
    assert first != other
    size = int.from_bytes(first[12:16], "little")
    content = json.loads(first[20 : 20 + size])
    assert len(content["skins"]) == len(content["animations"]) == 4
    assert run(*crowd, "--seed", "1", "-o", "people/")[0] == 0
    heads = [
        read_mocap(path, unit="cm").sel(marker="Head").values[:, 2].mean()
        for path in sorted(Path("people").glob("*.bvh"))
    ]
    assert len(heads) == 4
    assert np.diff(np.sort(heads)).min() > 1


@pytest.mark.parametrize(("words", "complaint"), [
    (["--scramble", "sed=3"], "expected name=value"),
    (["--trait", "sex"], "does not say how far"),
    (["--from", "99"], "a walker from 0 to 39"),
    (["--from", "nobody.c3d"], "--from nobody.c3d"),
    (["--information", "some"], "--information some is not known"),
    (["--size", "big"], "width and height"),
    (["--size", "3x300"], "16 to 8192"),
    (["--view", "abc"], "'--view': expected a number, got 'abc'"),
    (["--view", "1", "--view", "2"], "'--view': it is given twice"),
    (["--trait", "sex=1", "--components", "1000"], "--components 1000 is more than"),
    (["--trait", "sex=1", "--part", "p1+p1"], "names 'p1' twice"),
    (["--trait", "sex=3,weight=2"], "write --trait sex=3 --trait weight=2"),
    (["--trait", "sex=1", "--trait", "sex=2"], "--trait sex is given twice"),
    (["--elevation", "200"], "--elevation 200 is no elevation"),
    (["--mapping", "names.toml"], "--mapping names markers of a capture"),
    (["--seed", "2"], "--seed is for --crowd"),
    (["--distance", "300"], "--distance is for sizes in degrees"),
    (["--dot-px", "3", "--dot-mm", "1"], "--dot-px and --dot-mm are both given"),
    (["--dot-mm", "900"], "--dot-mm 900 is a dot of 3420 px"),
    (["--height-deg", "179"], "px high at this --distance"),
    (["--gain", "foo=1"], "names among markers, factor, axes, parts, got"),
    (["--scramble", "seed=1,seed=2"], "seed is given twice"),
    (["--mask", "number=3,signal_to_noise=2,seed=1"], "--mask: The number of dots is given as"),
    (["--mask", "dots_per_m2=abc,seed=1"], "--mask: dots_per_m2 must be real numbers"),
    (["--blur", "1e308deg"], "--blur 1e308deg: expected a size above 0 and below 90"),
    (["--show", "nose"], "--show: There is no part 'nose'"),
    (["--freeze", "1e6"], "--freeze: expected a number up to 100000"),
    (["-o", "stim.avi"], "must end in one of"),
    (["--part", "structure"], "give --trait too"),
    (["--strides", "0"], "--strides 0: expected 1 to 1000"),
    (["--crowd", "3", "-o", "crowd.bvh"], "a folder of .bvh files"),
    (["--crowd", "0", "-o", "crowd.glb"], "1 to 1000 people"),
    (["--skeleton", "biped", "-o", "a.bvh"], "choose from"),
    (["--in-place", "-o", "a.json"], "holds no rig"),
    (["--strides", "1", "--duration", "2"], "--strides and --duration are both given"),
    (["--mask", "signal_to_noise=0,seed=1"], "signal_to_noise=0 must be above 0"),
    (["--mask", "dots_per_m2=-1,seed=1"], "dots_per_m2=-1 must be above 0"),
    (["--height-deg", "0"], "--height-deg: expected a number above 0 and below 180, got 0"),
    (["--height-deg", "nan"], "'--height-deg': expected a number, got 'nan'"),
    (["--dot-px", "-1"], "--dot-px: expected a number above 0 and below 1000, got -1"),
    (["--dot-px", "1e6"], "--dot-px: expected a number above 0 and below 1000, got 1e+06"),
    (["--px-per-cm", "0", "--height-deg", "5"], "eigenwalker: --px-per-cm: expected"),
    (["--arm-swing", "nan"], "'--arm-swing': expected a number, got 'nan'"),
    (["--from", ""], "'--from': expected a value, got nothing"),
    (["--crowd", "2", "--seed", "-1", "-o", "crowd.glb"], "--seed -1: expected a whole number"),
])  # fmt: skip
def test_what_is_typed_wrong_is_said_in_a_sentence(run, words, complaint):
    code, _, said = run(*words)
    assert code == 2
    assert complaint in said
