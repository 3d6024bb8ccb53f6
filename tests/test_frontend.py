"""The browser's side of the project, tested with its own tools where Node is installed."""

from __future__ import annotations

import shutil
import subprocess
from importlib.resources import files
from pathlib import Path

import pytest

FRONTEND = Path(__file__).parents[1] / "frontend"
NPM = shutil.which("npm")
OLDEST_NODE = (20, 19)


def npm(*command: str) -> subprocess.CompletedProcess[str]:
    assert NPM is not None
    return subprocess.run(
        [NPM, *command], cwd=FRONTEND, capture_output=True, text=True, timeout=300, check=False
    )


@pytest.fixture(scope="module")
def installed() -> None:
    """The packages of the lock file, or a skip where they cannot be had."""
    if not FRONTEND.exists() or NPM is None:
        pytest.skip("Node is not installed, so the browser's side is not tested")
    version = subprocess.run(
        ["node", "--version"], capture_output=True, text=True, check=True
    ).stdout
    if tuple(map(int, version.strip().lstrip("v").split(".")[:2])) < OLDEST_NODE:
        pytest.skip(f"Node {version.strip()} is too old to test the browser's side")
    if not (FRONTEND / "node_modules" / "vitest").exists():
        answer = npm("ci")
        if answer.returncode:
            pytest.skip(f"npm could not fetch packages: {answer.stderr.strip()[-200:]}")


@pytest.mark.usefixtures("installed")
def test_the_browser_agrees_with_python_and_passes_its_own_tests():
    answer = npm("test")
    assert answer.returncode == 0, answer.stdout[-4000:] + answer.stderr[-1000:]


@pytest.mark.usefixtures("installed")
@pytest.mark.parametrize(
    "name",
    [
        *("player.html", "interactive.html", "experiment.html"),
        *("mannequin.js", "widget.js", "plugin-walker.js"),
    ],
)
def test_the_pages_of_the_package_are_built_from_these_sources(tmp_path: Path, name: str):
    mode = name.partition(".")[0]
    answer = npm("exec", "--", "vite", "build", "--mode", mode, "--outDir", str(tmp_path))
    assert answer.returncode == 0, answer.stdout + answer.stderr
    page = files("eigenwalker.stimulus").joinpath("built", name)
    built = (tmp_path / name).read_text(encoding="utf-8")
    assert page.read_text(encoding="utf-8") == built, "run 'npm run build' in frontend/"


def test_the_lock_file_names_no_registry():
    lock = FRONTEND / "package-lock.json"
    if not lock.exists():
        pytest.skip("the browser's side is not here")
    text = lock.read_text(encoding="utf-8")
    assert "://registry" not in text
    assert '"resolved"' not in text
