from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from eigenwalker.core.trajectories import sampling_rate
from eigenwalker.io.capture_file import CaptureFile
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.read import read_mocap
from eigenwalker.io.readers.vicon_csv import read_vicon_csv


def _csv(walk, *, sep=",", end="\r\n", unit="mm", first=1, title="Trajectories") -> str:
    names = sep.join(f"Anna:{name}{sep}{sep}" for name in walk.marker.values)
    n = walk.sizes["marker"]
    lines = [title, "50", sep * 2 + names, sep.join(["Frame", "Sub Frame", *"XYZ" * n]),
             sep * 2 + sep.join([unit] * 3 * n)]  # fmt: skip
    for i, frame in enumerate(walk.values):
        cells = ["" if np.isnan(v) else f"{v:g}" for v in frame.ravel()]
        lines.append(sep.join([str(first + i), "0", *cells]))
    return end.join(lines) + end


def _read(text: str | bytes, **options):
    content = text if isinstance(text, bytes) else text.encode()
    return read_vicon_csv(CaptureFile(Path("a.csv"), content, **options))


def test_what_was_written_is_read(text_walk):
    walk = _read(_csv(text_walk, first=101))
    np.testing.assert_allclose(walk.values, text_walk.values, atol=0.06)  # six digits
    assert walk.marker.values.tolist() == text_walk.marker.values.tolist()
    assert (walk.attrs["subject"], walk.attrs["unit"]) == ("Anna", "mm")
    assert sampling_rate(walk) == pytest.approx(50)
    assert walk.time.values[0] == pytest.approx(2.0)


def test_other_blocks_do_not_matter(text_walk):
    devices = "Devices\r\n1000\r\n,,Plate,,\r\nFrame,Sub Frame,Fx,Fy\r\n,,N,N\r\n1,0,2,3\r\n\r\n"
    angles = _csv(text_walk, unit="deg", title="Model Outputs")
    for text in (devices + _csv(text_walk), _csv(text_walk) + "\r\n" + angles):
        np.testing.assert_array_equal(_read(text).values, _read(_csv(text_walk)).values)


def test_semicolons_with_decimal_commas_are_understood(text_walk):
    text = _csv(text_walk, sep=";").replace(".", ",")
    np.testing.assert_array_equal(_read(text).values, _read(_csv(text_walk)).values)


def test_unlabelled_points_are_left_out(text_walk):
    walk = _read(_csv(text_walk).replace("Anna:left_wrist", "*113"))
    assert walk.sizes["marker"] == 14
    assert walk.attrs["left_out"] == ["*113"]


def test_lengths_in_metres_are_understood(text_walk):
    walk = _read(_csv(text_walk / 1000, unit="m"))
    np.testing.assert_allclose(walk.values, text_walk.values, atol=0.06)


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("\r\n50\r\n", "\r\n0\r\n", "rate of the block"),
        ("\r\n50\r\n", "\r\n1e9\r\n", "rate of the block"),
        ("\r\n50\r\n", "\r\nfifty\r\n", "rate of the block"),
        ("Sub Frame", "Picture", "Sub Frame"),
        ("\r\n3,0,", "\r\n3,0,7,", "cells in line 8"),
        ("\r\n3,0,", "\r\n3,zero,", "zero"),
        ("\r\n3,0,", "\r\n,0,", "numbered frames"),
        ("\r\n3,0,", "\r\n99999999,0,", "times"),
        (",,mm,mm,mm", ",,m,m,m", "one unit"),
    ],
)
def test_what_is_wrong_is_told(text_walk, old, new, told):
    text = _csv(text_walk)
    assert old in text
    with pytest.raises(UnreadableFile, match=told):
        _read(text.replace(old, new, 1))


def test_angles_alone_are_refused(text_walk):
    with pytest.raises(UnreadableFile, match="tick Trajectories"):
        _read(_csv(text_walk, unit="deg", title="Model Outputs"))


def test_a_real_export_agrees_with_the_c3d_of_the_same_capture(captures: Path):
    table = read_mocap(captures / "pycgm" / "Movement_trial.csv")
    c3d = read_mocap(captures / "pycgm" / "Movement_trial.c3d")
    both = [name for name in table.marker.values if name in c3d.marker.values]
    assert {"LFEO", "RTIO", "PELO"} <= set(both)
    np.testing.assert_allclose(table.time.values, c3d.time.values)
    ours, theirs = (walk.sel(marker=both).values for walk in (table, c3d))
    np.testing.assert_allclose(ours, theirs, atol=0.01)
