"""What several test modules share: where real captures are, and names for doctests."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable
from pathlib import Path

import c3d
import numpy as np
import pytest
import xarray as xr

from eigenwalker.skeleton import JOINTS
from eigenwalker.trajectories import sampling_rate
from eigenwalker.walker import Form, Walker

_BESIDE = Path(__file__).resolve().parents[2] / "shared" / "data"


@pytest.fixture(scope="session")
def captures() -> Path:
    """Folder of real captures, which are licensed to test with but not to ship."""
    folder = Path(os.environ.get("EIGENWALKER_DATA", _BESIDE))
    if not folder.is_dir():
        pytest.skip(f"no real captures in {folder}; name their folder in EIGENWALKER_DATA")
    return folder


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
