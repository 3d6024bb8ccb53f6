"""Every command of docs/animation.md runs as it stands."""

from __future__ import annotations

import shlex
from pathlib import Path

import pytest

PAGE = (Path(__file__).parents[2] / "docs" / "animation.md").read_text(encoding="utf-8")
BLOCKS = [block.split("```")[0].strip() for block in PAGE.split("```sh")[1:]]


@pytest.mark.parametrize("block", BLOCKS)
def test_commands_run(block, tmp_path, monkeypatch, run_command):
    monkeypatch.chdir(tmp_path)
    for command in block.splitlines():
        words = shlex.split(command)[1:]
        code, _, errors = run_command(*words)
        assert code == 0, errors
        assert Path(words[words.index("-o") + 1]).exists()
