"""Examples run from the first line to the last and write what they say."""

from __future__ import annotations

import re
import runpy
import sys
from pathlib import Path

import pytest

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("plot_*.py"))


@pytest.mark.parametrize("script", EXAMPLES, ids=lambda script: script.stem)
def test_each_example_writes_its_pictures(script, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", [str(script)])
    runpy.run_path(str(script), run_name="__main__")
    promised = set(re.findall(r'"(\w+\.(?:png|gif|mp4))"', script.read_text("utf-8")))
    written = {path.name for path in tmp_path.iterdir()}
    assert promised
    assert written == promised
    assert all((tmp_path / name).stat().st_size > 1000 for name in promised)
