"""Some dozens of spoilt files of each format; ``tests/fuzz/mutate.py`` makes as many as wanted."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

MUTATE = Path(__file__).parents[1] / "fuzz" / "mutate.py"

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="limits of processes are Linux'")


@pytest.mark.parametrize(("door", "count"), [("read", 80), ("info", 4)])
def test_spoilt_files_end_in_data_or_in_the_one_error(tmp_path, door, count) -> None:
    words = ["--count", str(count), "--seed", "11", "--door", door, "--keep", str(tmp_path)]
    told = subprocess.run([sys.executable, MUTATE, *words], capture_output=True, text=True)
    assert told.returncode == 0, told.stdout + told.stderr
    assert told.stdout.count("refused") >= 13
    assert not list(tmp_path.iterdir())
