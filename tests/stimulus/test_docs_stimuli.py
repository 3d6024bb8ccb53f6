"""Every line of docs/stimuli.md runs."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest

from eigenwalker.datasets.built_in import load_population
from eigenwalker.stimulus.make import make_stimulus
from eigenwalker.stimulus.schema import TRANSFORMS

PAGE = (Path(__file__).parents[2] / "docs" / "stimuli.md").read_text(encoding="utf-8")
LINES = re.findall(r"`(\.then\([^`]*\))`", PAGE)


@pytest.mark.parametrize("line", LINES)
def test_the_line_of_each_transform_runs(line):
    people = load_population()
    shown = make_stimulus(people.walkers[0])
    made = eval(f"shown{line}", {"shown": shown, "other": people.walkers[25]})
    assert made.play([0.0, 0.5]).positions.shape[0] == 2


def test_every_transform_has_a_line():
    named = set(re.findall(r'\.then\("(\w+)"', PAGE))
    assert named - {"overground", "arm_swing"} == set(TRANSFORMS)


def test_the_first_lines_run(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code = PAGE.split("```python")[1].split("```")[0]
    exec(code, {})
    assert Path("stim.mp4").stat().st_size > 0


def test_commands_run(tmp_path, monkeypatch, run_command):
    monkeypatch.chdir(tmp_path)
    load_population().save("people.nc")
    for block in PAGE.split("```sh")[1:]:
        for command in block.split("```")[0].replace("\\\n", " ").strip().splitlines():
            code, _, errors = run_command(*shlex.split(command)[1:])
            assert code == 0, errors
