"""The BML model: a made-up one played by hand, the published one looked at, damaged files."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest

from eigenwalker.analysis import trait_axis
from eigenwalker.core import JOINTS, Walker
from eigenwalker.datasets.bml import POSITIVE_POLES, BmlModel, read_bml_axes
from eigenwalker.gait import gait_parameters
from eigenwalker.gait.heading import stance_speed
from eigenwalker.io import UnreadableFile

POINTS = [
    *("head", "sternum"),
    *("left_shoulder", "left_elbow", "left_wrist"),
    *("right_shoulder", "right_elbow", "right_wrist"),
    *("pelvis", "left_hip", "left_knee", "left_ankle", "right_hip", "right_knee", "right_ankle"),
]


def _blocks(seed: int, frames: float, speed: float, scale: float) -> np.ndarray:
    blocks = np.random.default_rng(seed).normal(scale=scale, size=(5, 46))
    blocks[:, 45] = frames, 0, speed, 0, 0
    return blocks


@pytest.fixture
def made_up() -> dict[str, np.ndarray]:
    return {"walker": _blocks(0, 126, 11, 300), "gender": _blocks(1, -1, 0.3, 5)}


def _write(folder: Path, blocks: dict) -> Path:
    numbers = {key: np.ravel(value).tolist() for key, value in blocks.items()}
    path = folder / "axes.json"
    path.write_text(json.dumps({"note": "made up", "tables": {"raw": numbers}}))
    return path


def test_a_walker_is_the_mean_and_so_many_steps_along_the_axes(tmp_path, made_up):
    model = read_bml_axes(_write(tmp_path, made_up))
    walker = model.walker(sex=-2)
    blocks = made_up["walker"] - 2 * made_up["gender"]
    assert walker.frequency_hz == pytest.approx(120 / blocks[0, 45])
    assert walker.speed_mm_s == pytest.approx(120 * blocks[2, 45])
    time = np.linspace(0, 1, 20)
    angle = 2 * np.pi * walker.frequency_hz * time[:, None]
    by_hand = blocks[0] + np.sin(angle) * blocks[1] + np.cos(angle) * blocks[2]
    by_hand = by_hand + np.sin(2 * angle) * blocks[3] + np.cos(2 * angle) * blocks[4]
    points = by_hand[:, :45].reshape(20, 3, 15).swapaxes(1, 2)
    walk = walker.trajectories(time).sel(marker=POINTS).values
    np.testing.assert_allclose(walk - walk[:, :1], points - points[:, :1], atol=1e-9)
    assert walker.markers == JOINTS.markers


def test_axes_that_are_not_there_are_refused(tmp_path, made_up):
    model = read_bml_axes(_write(tmp_path, made_up))
    assert list(model.axes) == ["sex"]
    with pytest.raises(ValueError, match=r"no axes \['age'\]; there are \['sex'\]"):
        model.walker(age=1)
    with pytest.raises(ValueError, match="period"):
        model.walker(sex=200)


@pytest.fixture(scope="module")
def published(captures: Path) -> BmlModel:
    return read_bml_axes(captures / "bmlwalker" / "bml_axes.json")


def _apart(walker: Walker, part: str) -> float:
    left, right = (walker.mean_posture.sel(marker=f"{side}_{part}") for side in ("left", "right"))
    return float((left - right).sel(axis="y"))


def test_the_published_mean_walks_forward_as_people_do(published: BmlModel):
    assert set(published.axes) == set(POSITIVE_POLES)
    walker = published.walker()
    assert walker.frequency_hz == pytest.approx(120 / 126.03, rel=1e-4)
    assert walker.speed_mm_s == pytest.approx(1356, abs=1)
    walk = walker.trajectories(np.linspace(0, 2 * walker.period_s, 400))
    # Ankles roll forward over standing feet, so their speed is a little less than the ground's.
    assert 0.9 < stance_speed(walk) / walker.speed_mm_s < 1
    assert 0.58 < gait_parameters(walker)["stance_share_left"] < 0.65
    assert 1500 < walker.mean_posture.sel(marker="head", axis="z") < 1700
    assert 60 < walk.sel(marker="left_ankle", axis="z").min() < 100


def test_plus_on_the_sex_axis_is_male_and_the_others_go_where_they_say(published: BmlModel):
    for z in (-6, 6):
        sign = np.sign(z)
        man, mean = published.walker(sex=z), published.walker()
        assert sign * (_apart(man, "shoulder") - _apart(mean, "shoulder")) > 20
        assert sign * (_apart(man, "hip") - _apart(mean, "hip")) < -40
        assert sign * (_apart(published.walker(weight=z), "elbow") - _apart(mean, "elbow")) > 50
        assert sign * (published.walker(happy=z).speed_mm_s - mean.speed_mm_s) > 100
        assert sign * (published.walker(nervous=z).frequency_hz - mean.frequency_hz) > 0.05


@pytest.mark.parametrize(
    ("content", "told"),
    [
        ("", "empty file"),
        ("{", "a JSON file"),
        ("[" * 100_000, "a JSON file"),
        ("{}", "a list 'walker' of 230 numbers"),
        ('{"walker": 5}', "a list 'walker'"),
        ('{"walker": [1, 2]}', "230 numbers as 'walker'"),
        (json.dumps({"walker": ["1"] * 230}), "230 numbers as 'walker'"),
        (json.dumps({"walker": [True] * 230}), "230 numbers as 'walker'"),
        (json.dumps({"walker": [float("nan")] * 230}), "millimetres"),
        (json.dumps({"walker": [1e300] * 230}), "millimetres"),
        (json.dumps({"walker": [10**400] * 230}), "millimetres"),
        (json.dumps({"walker": [1.0] * 230, "gender": [1.0]}), "as 'gender'"),
    ],
)
def test_files_that_hold_no_such_tables_are_refused(tmp_path, content, told):
    path = tmp_path / "axes.json"
    path.write_text(content)
    with pytest.raises(UnreadableFile, match=told):
        read_bml_axes(path)


def test_damaged_files_end_in_a_model_or_the_one_error(tmp_path, made_up):
    rng = np.random.default_rng(0)
    path = _write(tmp_path, made_up)
    whole = path.read_bytes()
    outcomes = set()
    for _ in range(300):
        damaged = bytearray(whole)
        for at in rng.integers(len(whole), size=2):
            damaged[at] = rng.choice(list(b'0123456789.,eE-"[]{} \xff'))
        path.write_bytes(bytes(damaged))
        try:
            model = read_bml_axes(path)
        except UnreadableFile:
            outcomes.add("refused")
        else:
            assert np.isfinite(model.mean).all()
            outcomes.add("read")
    assert outcomes == {"read", "refused"}


@pytest.mark.parametrize("place", [{"sex": 3}, {"happy": -2}, {"weight": 1.5, "nervous": 2}])
def test_steps_along_traits_of_its_population_are_those_of_the_tables(published, place):
    people = published.population()
    steps = [trait_axis(people, name).step * far for name, far in place.items()]
    walker, exact = people.walker(people.average + sum(steps)), published.walker(**place)
    cycle = 2 * np.pi * np.arange(100) / 100
    mm = walker.positions(cycle + np.pi / 2)  # strides of a population begin a quarter later
    pelvis = JOINTS.index("pelvis")
    above_floor_mm = (exact.p0 - walker.p0)[pelvis]
    np.testing.assert_allclose(mm + above_floor_mm, exact.positions(cycle), atol=0.1)
    assert walker.frequency_hz == pytest.approx(exact.frequency_hz, rel=0.02)


def test_tables_are_walkers_to_every_command_and_no_stimulus(tmp_path, made_up, run_command):
    tables = _write(tmp_path, made_up)
    code, said, _ = run_command("stimulus", tables, "--trait", "sex=2", "-o", tmp_path / "s.json")
    assert (code, "sex: 2 standard deviations towards male, along the published axis." in said) == (
        0,
        True,
    )
    assert "times the usual" not in said  # there are no single walkers
    assert "Walker: sex 2 SD towards male, published axis, part all" in said
    code, said, _ = run_command("info", tables)
    assert code == 0
    assert re.search(r"kind +population", said)
    assert run_command("stimulus", tmp_path / "s.json", "-o", tmp_path / "s.svg")[0] == 0
    code, said, _ = run_command("demo", tables, "-o", tmp_path / "page", "--no-open")
    assert (code, "walkers are too few to tell sex from gait" in said) == (0, True)
    assert [path.name for path in (tmp_path / "page").glob("[!.]*")] == ["index.html"]
