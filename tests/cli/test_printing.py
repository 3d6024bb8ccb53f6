"""What cannot be printed is lost, and nothing else: no population, and no traceback."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from eigenwalker import JOINTS
from eigenwalker.core.wording import reworded
from eigenwalker.population import Population
from eigenwalker.simulation import simulate_walk

COMMAND = [sys.executable, "-m", "eigenwalker"]
pytestmark = pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full here")


@pytest.fixture(scope="module")
def folder(tmp_path_factory, write_c3d) -> Path:
    folder = tmp_path_factory.mktemp("captures")
    write_c3d(folder / "M\u00fcller_\u0436.c3d", simulate_walk(seed=1, duration_s=5))
    if sys.platform == "linux":
        (folder / os.fsdecode(b"no_letter_\xff.c3d")).write_bytes(b"no capture")
    return folder


@pytest.mark.parametrize("printed_to", ["a terminal of ASCII", "a full disk", "a closed pipe"])
def test_the_population_is_saved_whatever_becomes_of_what_is_printed(
    folder, tmp_path, printed_to
) -> None:
    outputs = ("-o", str(tmp_path / "a.nc"), "--table", str(tmp_path / "a.csv"))
    command = [*COMMAND, "fit", str(folder), *outputs, "--jobs", "1"]
    with Path("/dev/full").open("w") as full:
        reading, writing = os.pipe()
        os.close(reading)
        stdout = {"a full disk": full, "a closed pipe": writing}.get(printed_to, subprocess.PIPE)
        fit = subprocess.run(
            command,
            stdout=stdout,
            stderr=subprocess.PIPE,
            check=False,
            env=os.environ | {"PYTHONIOENCODING": "ascii"},
        )
        os.close(writing)
    assert len(Population.load(tmp_path / "a.nc")) == 1
    assert len((tmp_path / "a.csv").read_text("utf-8").splitlines()) > 1
    assert fit.returncode == len(list(folder.iterdir())) - 1
    lost = b"eigenwalker: not all could be printed: No space left on device.\n"
    assert fit.stderr == (lost if printed_to == "a full disk" else b"")
    if fit.stdout:
        assert b"no_letter_\\ufffd.c3d: expected" in fit.stdout


def test_a_command_that_only_prints_fails_where_it_cannot(tmp_path) -> None:
    with Path("/dev/full").open("w") as full:
        code = subprocess.run([*COMMAND, "data", "list"], stdout=full, check=False).returncode
    assert code == 2


@pytest.mark.parametrize(
    ("sentence", "here"),
    [
        ("Name it: read_mocap(..., rate_hz=...).", "Name it: --rate 30."),
        (
            "Name it to be sure: read_mocap(..., rate_hz=29.97).",
            "Name it to be sure: --rate 29.97.",
        ),
        ("Read it with unit=... and go on.", "Read it with --unit mm and go on."),
        ("unit='furlong' is not known.", "--unit furlong is not known."),
        (
            "take read_mocap(..., subject='Anna B')",
            "take in Python, read_mocap(..., subject='Anna B')",
        ),
        ("sex=+3 and rate_hz_of=3", "sex=+3 and rate_hz_of=3"),
    ],
)
def test_arguments_are_named_as_options(sentence, here) -> None:
    assert reworded(sentence, {"rate_hz": "--rate {value}", "unit": "--unit {value}"}) == here


def test_a_command_names_its_own_options(tmp_path, run_command) -> None:
    table = tmp_path / "walk.csv"
    names = [f"{joint}_{axis}" for joint in JOINTS.markers for axis in "xyz"]
    table.write_text(",".join(names) + "\n" + ",".join("1" * 45) + "\n")
    for command in (["info", table], ["convert", table, tmp_path / "walk.c3d"]):
        code, _, errors = run_command(*command)
        assert (code, "--rate" in errors, "rate_hz" in errors) == (2, True, False), errors
    code, _, errors = run_command("stimulus", "--from", table, "-o", tmp_path / "a.json")
    assert (code, f"eigenwalker convert {table} walk.c3d --rate" in errors) == (2, True), errors
    braces = table.rename(tmp_path / "a{1}.csv")
    _, _, errors = run_command("stimulus", "--from", braces, "-o", tmp_path / "a.json")
    assert f"eigenwalker convert {braces} walk.c3d --rate" in errors
    _, _, errors = run_command("stimulus", "--size", "3x300", "-o", tmp_path / "a.json")
    assert "--size 3x300: expected width and height in pixels, 16 to 8192" in errors
    _, _, errors = run_command("stimulus", "--limb-dots", "seed=-1", "-o", tmp_path / "a.json")
    assert "--limb-dots seed: expected a number from 0, got -1" in errors
    _, _, errors = run_command("simulate", "--women", -3, "-o", tmp_path / "a.nc")
    assert "--women -3 and --men 20 make no group" in errors
