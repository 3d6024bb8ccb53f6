"""The README's Python runs as it stands there."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from eigenwalker.simulation.people import simulate_captures

README = Path(__file__).resolve().parents[1] / "README.md"
BLOCKS = re.findall(r"^```python\n(.*?)^```", README.read_text(), re.DOTALL | re.MULTILINE)


@pytest.mark.parametrize("block", BLOCKS, ids=lambda block: block.splitlines()[-1][:40])
def test_the_readmes_python_runs(block, tmp_path, monkeypatch, write_c3d) -> None:
    monkeypatch.chdir(tmp_path)
    write_c3d(tmp_path / "walk_01.c3d", next(simulate_captures(1, 0, seed=1))[0])
    exec(compile("import eigenwalker as ew\n" + block, "README.md", "exec"), {})


def test_the_two_commands_stand_at_the_top() -> None:
    top = README.read_text()[:1500]
    assert "make demo" in top
    assert "make test" in top
