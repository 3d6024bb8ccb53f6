"""What several test modules share: where real captures are, and names for doctests."""

from __future__ import annotations

import hashlib
import os
import shutil
import sys
import tempfile
import threading
import warnings
from collections.abc import Callable, Iterator
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING

import c3d
import numpy as np
import pytest
import xarray as xr
from hypothesis import HealthCheck, settings

from eigenwalker.cli import main as cli
from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.trajectories import sampling_rate
from eigenwalker.core.walker import Form, Walker
from eigenwalker.simulation.walk import simulate_walk

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None

if TYPE_CHECKING:
    from playwright.sync_api import Browser

    from eigenwalker.metric import PreparedClip

_KERNELS = sorted((Path(__file__).parents[1] / "src" / "eigenwalker" / "metric").glob("*.py"))
_CODE = hashlib.sha256(b"".join(path.read_bytes() for path in _KERNELS)).hexdigest()[:16]
_MADE_BY = f"{version('numba')}-{sys.implementation.cache_tag}"
os.environ.setdefault(
    "NUMBA_CACHE_DIR", str(Path(tempfile.gettempdir()) / f"eigenwalker-kernels-{_CODE}-{_MADE_BY}")
)  # numba keeps a function's code when another that it calls, in another file, has changed


def _compile_in_turn() -> None:
    """Let processes that test at the same time compile in turn: the next finds it in the cache."""
    if fcntl is None:
        return
    from numba.core.dispatcher import Dispatcher  # loads numba: after its cache is set

    folder = Path(os.environ["NUMBA_CACHE_DIR"])
    folder.mkdir(parents=True, exist_ok=True)
    file = os.open(folder / "turn", os.O_RDWR | os.O_CREAT)  # open as long as the process lives
    turn, depth = threading.RLock(), [0]
    compile_one = Dispatcher.compile

    def in_turn(self: Dispatcher, signature: object) -> object:
        with turn:
            fcntl.flock(file, fcntl.LOCK_EX)
            depth[0] += 1
            try:
                return compile_one(self, signature)
            finally:
                depth[0] -= 1
                if not depth[0]:
                    fcntl.flock(file, fcntl.LOCK_UN)

    Dispatcher.compile = in_turn


_compile_in_turn()

settings.register_profile("untimed", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("untimed")  # how long an example takes depends on what else runs

_BESIDE = Path(__file__).resolve().parents[2] / "shared" / "data"


@pytest.fixture(scope="session")
def captures() -> Path:
    """Folder of real captures, which are licensed to test with but not to ship."""
    folder = Path(os.environ.get("EIGENWALKER_DATA", _BESIDE))
    if not folder.is_dir():
        pytest.skip(f"no real captures in {folder}; name their folder in EIGENWALKER_DATA")
    return folder


@pytest.fixture(scope="session")
def mannequins() -> dict[str, PreparedClip]:
    """21 of the built-in people, ready to be compared, on the neutral mannequin."""
    from eigenwalker.datasets import load_population
    from eigenwalker.metric import prepare, retarget

    walkers = load_population().walkers[:21]
    walks = [walker.trajectories(np.arange(0, 3 * walker.period_s, 0.01)) for walker in walkers]
    return {f"walker {i}": prepare(retarget(walk)) for i, walk in enumerate(walks)}


@pytest.fixture
def run_command(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Callable[..., tuple[int, str, str]]:
    """Type a command; get its exit code, what it printed, and what it wrote to stderr."""

    def typed(*words: object) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["eigenwalker", *map(str, words)])
        code = 0
        try:
            cli.main()
        except SystemExit as stop:
            code = int(stop.code or 0)
        printed = capsys.readouterr()
        return code, printed.out, printed.err

    return typed


def _orthogonal_walker(
    seed: int = 0, *, frequency_hz: float = 0.8, form: Form = "eigenposture"
) -> Walker:
    """A made-up walker for whom both decompositions must agree (A1).

    Eigenpostures are orthogonal and a quarter cycle apart; the left ankle is ahead in the first.
    """
    rng = np.random.default_rng(seed)
    n_markers = len(JOINTS.markers)
    directions = np.linalg.qr(rng.normal(size=(3 * n_markers, 4)))[0].T
    p = (directions * np.array([600.0, 300, 150, 100])[:, None]).reshape(4, n_markers, 3)
    ahead = p[0, JOINTS.index("left_ankle"), 0] - p[0, JOINTS.index("right_ankle"), 0]
    p[0] *= np.sign(ahead)
    return Walker(
        markers=JOINTS.markers,
        p0=rng.normal(scale=300, size=(n_markers, 3)),
        p=p,
        harmonics=np.array([1, 1, 2, 2]),
        phases=np.array([0, np.pi / 2, 0.3, 0.3 + np.pi / 2]),
        frequency_hz=frequency_hz,
        form=form,
    )


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    """Chromium, one for all tests of a module; its event loop runs as long, and then no more."""
    playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
    found = next(filter(None, map(shutil.which, ("chromium", "chromium-browser"))), None)
    if found is None:
        pytest.skip("chromium is not installed, so nobody visits the page")
    with playwright.sync_playwright() as starting:
        started = starting.chromium.launch(executable_path=found, args=["--no-sandbox"])
        yield started
        started.close()


@pytest.fixture(scope="session")
def orthogonal_walker() -> Callable[..., Walker]:
    """Maker of walkers for whom both decompositions must agree, one a seed."""
    return _orthogonal_walker


def _write_c3d(path: Path, walk: xr.DataArray) -> Path:
    """Write trajectories as a C3D file, by a program that is not ours."""
    writer = c3d.Writer(point_rate=round(sampling_rate(walk)))
    writer.set_point_labels(walk.marker.values.tolist())
    empty = np.zeros((0, 0))
    frames = []
    for posture in walk.values:
        points = np.zeros((len(posture), 5), dtype=np.float32)
        points[:, :3] = np.nan_to_num(posture)
        points[np.isnan(posture).any(axis=1), 3] = -1
        frames.append((points, empty))
    writer.add_frames(frames)
    with path.open("wb") as file, warnings.catch_warnings():
        warnings.filterwarnings("ignore", "No analog data")
        writer.write(file)
    return path


@pytest.fixture(scope="session")
def write_c3d() -> Callable[[Path, xr.DataArray], Path]:
    """Writer of C3D files."""
    return _write_c3d


@pytest.fixture(scope="session")
def text_walk() -> xr.DataArray:
    """A simulated walk of 2 s at 50 Hz, with a gap, to be written in formats of text."""
    walk = simulate_walk(seed=3, duration_s=2.0, rate_hz=50, truth=False)
    walk = xr.DataArray(
        walk.values.round(3),
        dims=walk.dims,
        coords={name: walk[name].values for name in ("time", "marker", "axis")},
        attrs={"units": "mm"},
    )
    walk.values[10:14, 2] = np.nan
    return walk


def _damaged(content: bytes, n: int, seed: int = 0) -> Iterator[bytes]:
    """Files with a few bytes changed, lines doubled or left out, and cut short, seeded."""
    rng = np.random.default_rng(seed)
    letters = b' \t\n,;.0123456789eE-+naifXYZ"#:=[]{}\x00\xff'
    lines = content.split(b"\n")
    for _ in range(n):
        bad = bytearray(content)
        for _ in range(rng.integers(1, 4)):
            at = int(rng.integers(max(len(bad), 1)))
            match rng.integers(5):
                case 0 if bad:
                    bad[min(at, len(bad) - 1)] = letters[rng.integers(len(letters))]
                case 1:
                    del bad[at : at + int(rng.integers(1, 40))]
                case 2:
                    bad[at:at] = lines[rng.integers(len(lines))] + b"\n"
                case 3:
                    bad[at:at] = bytes(rng.choice(list(letters), 5).tolist())
                case _:
                    del bad[at:]
        yield bytes(bad)


@pytest.fixture(scope="session")
def damaged() -> Callable[..., Iterator[bytes]]:
    """Maker of damaged files: their content and how many."""
    return _damaged
