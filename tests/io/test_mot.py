from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from eigenwalker.core.trajectories import sampling_rate
from eigenwalker.io.capture_file import CaptureFile
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.readers.mot import read_mot


def _sto(walk, *, suffix="_t{}", vectors=False, head="") -> str:
    """A storage file of OpenSim: y up, metres."""
    values = walk.values[..., [1, 2, 0]] / 1000
    names = walk.marker.values
    columns = names if vectors else [n + suffix.format(a) for n in names for a in "xyz"]
    lines = [
        "markers", "version=1", f"nRows={len(walk)}", f"nColumns={len(columns) + 1}",
        "inDegrees=no", *([head] if head else []), "endheader", "\t".join(["time", *columns]),
    ]  # fmt: skip
    for i, frame in enumerate(values):
        point = ["(" + ",".join(f"{v:.6f}" for v in point) + ")" for point in frame]
        cells = point if vectors else [f"{v:.6f}" for v in frame.ravel()]
        lines.append("\t".join([f"{i / 50:.8f}", *cells]))
    return "\n".join(lines) + "\n"


def _read(text: str | bytes, **options):
    content = text if isinstance(text, bytes) else text.encode()
    return read_mot(CaptureFile(Path("a.sto"), content, **options))


@pytest.mark.parametrize("suffix", ["_t{}", "_{}", "_p{}", ".{}"])
def test_what_was_written_is_read(text_walk, suffix):
    walk = _read(_sto(text_walk, suffix=suffix))
    np.testing.assert_allclose(walk.values, text_walk.values, atol=1e-2)
    assert walk.marker.values.tolist() == text_walk.marker.values.tolist()
    assert sampling_rate(walk) == pytest.approx(50)
    assert (walk.attrs["unit"], walk.attrs["unit_reason"]) == ("m", "OpenSim's unit")


def test_vectors_in_one_column_are_read(text_walk):
    text = _sto(text_walk, vectors=True, head="DataType=Vec3\nUnits=m")
    np.testing.assert_allclose(_read(text).values, text_walk.values, atol=1e-2)


def test_orientations_and_centres_beside_positions_are_left_out(text_walk):
    text = _sto(text_walk).replace("head_t", "center_of_mass_").replace("left_hip_t", "left_hip_O")
    walk = _read(text)
    assert walk.sizes["marker"] == 13


def test_joint_angles_and_forces_are_refused(text_walk):
    angles = "hip\nnRows=2\nnColumns=5\nendheader\ntime pelvis_tx pelvis_ty pelvis_tz knee\n"
    with pytest.raises(UnreadableFile, match="TRC, or BodyKinematics"):
        _read(angles + "0 0 1 0 3\n0.1 0 1 0 4\n")
    forces = _sto(text_walk).replace("_tx", "_force_vx").replace("_ty", "_force_vy")
    with pytest.raises(UnreadableFile, match="positions of several points"):
        _read(forces)


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("nRows=100", "nRows=101", "cut short"),
        ("nRows=100", "nRows=many", "nrows=many"),
        ("nColumns=46", "nColumns=999999999", "cut short"),
        ("endheader", "end", "endheader"),
        ("time\t", "moment\t", "time"),
        ("\n0.04000000\t", "\n0.01000000\t", "times that go on"),
        ("\n0.04000000\t", "\nnan\t", "times that go on"),
        ("\n0.04000000\t", "\n1e8\t", "times"),
    ],
)
def test_what_is_wrong_is_told(text_walk, old, new, told):
    text = _sto(text_walk)
    assert old in text
    with pytest.raises(UnreadableFile, match=told):
        _read(text.replace(old, new, 1))
