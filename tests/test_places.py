"""The package works where neither its own folder nor a home or a cache can be written."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import eigenwalker as ew
from eigenwalker.datasets import fetch_captures

USES = """
import eigenwalker as ew
walk = ew.simulate_walk(seed=1, duration_s=4, rate_hz=30)
walker = ew.decompose_pca(ew.in_place(walk))
people = ew.load_population()
ew.trait_axis(people, "sex")
ew.plotting.figure_walkers({"walker": walker}).savefig("walker.png")
ew.plotting.write_film(walker, "walker.gif", duration_s=0.1, size_px=32)
people.select(range(3)).save("people.nc")
print(ew.metric.motion_map(walk[:20]).shape)
"""


@pytest.fixture
def nowhere(tmp_path: Path) -> dict[str, str]:
    """Environment of a copied package in which files stand where folders would be written."""
    package = Path(ew.__file__).parent
    copy = shutil.copytree(
        package, tmp_path / "site" / package.name, ignore=shutil.ignore_patterns("__pycache__")
    )
    for folder in [copy, *(path for path in copy.rglob("*") if path.is_dir())]:
        (folder / "__pycache__").touch()  # root may write what is read-only
    kept = {
        name: value
        for name, value in os.environ.items()
        if name in ("PATH", "SYSTEMROOT", "TEMP", "LANG")
    }
    return kept | {"PYTHONPATH": str(copy.parent), "HOME": os.devnull}


def test_a_read_only_installation_without_home_and_cache_works(nowhere, tmp_path):
    done = subprocess.run(
        [sys.executable, "-c", USES], env=nowhere, cwd=tmp_path, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout == "(20, 20)\n"
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "people.nc",
        "site",
        "walker.gif",
        "walker.png",
    ]


def test_without_a_home_captures_need_a_folder(monkeypatch):
    monkeypatch.setattr("pooch.os_cache", lambda name: Path("~/.cache", name))  # of an unknown user
    with pytest.raises(ValueError, match="no home"):
        fetch_captures("cmu", accept_licence=True)


def test_a_cache_that_cannot_be_made_is_named(monkeypatch):
    monkeypatch.setenv("HOME", os.devnull)
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    with pytest.raises(OSError, match=r"cannot be made .*; name another one"):
        fetch_captures("cmu", accept_licence=True)
