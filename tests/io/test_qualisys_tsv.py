from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from eigenwalker.core.trajectories import sampling_rate
from eigenwalker.io.capture_file import CaptureFile
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.readers.qualisys_tsv import read_qualisys_tsv
from eigenwalker.io.up_axis_and_unit import UnitGuessed


def _tsv(walk, *, in_front=0, header=True, missing="0.000", closed=False) -> str:
    names = walk.marker.values
    lines = [
        f"NO_OF_FRAMES\t{len(walk)}",
        "NO_OF_CAMERAS\t12",
        f"NO_OF_MARKERS\t{len(names)}",
        "FREQUENCY\t50",
        "NO_OF_ANALOG\t0",
        "ANALOG_FREQUENCY\t0",
        "DESCRIPTION\t--",
        "TIME_STAMP\t2022-06-03, 10:47:36.627\t94247.45",
        "DATA_INCLUDED\t3D",
        "EVENT\tstep\t12\t0.24",
        "MARKER_NAMES\t" + "\t".join(names) + "\t",
        "TRAJECTORY_TYPES\t" + "\t".join(["Measured"] * len(names)),
    ]
    if header and in_front:
        front = ["Frame", "Time"][:in_front]
        lines.append("\t".join([*front, *(f"{name} {axis}" for name in names for axis in "XYZ")]))
    for i, frame in enumerate(walk.values):
        cells = [missing if np.isnan(v) else f"{v:.3f}" for v in frame.ravel()]
        lines.append("\t".join([*[str(i + 1), f"{i / 50:.5f}"][:in_front], *cells]))
        lines[-1] += "\t" if closed else ""
    return "\r\n".join(lines) + "\r\n"


def _read(text: str | bytes, **options):
    content = text if isinstance(text, bytes) else text.encode()
    return read_qualisys_tsv(CaptureFile(Path("a.tsv"), content, **options))


@pytest.mark.parametrize("in_front", [0, 1, 2])
@pytest.mark.parametrize("header", [True, False])
@pytest.mark.parametrize("closed", [True, False])
@pytest.mark.parametrize("missing", ["0.000", "", "NULL", "NaN"])
def test_what_was_written_is_read(text_walk, in_front, header, closed, missing):
    text = _tsv(text_walk, in_front=in_front, header=header, closed=closed, missing=missing)
    walk = _read(text)
    np.testing.assert_allclose(walk.values, text_walk.values, atol=1e-3)
    assert walk.marker.values.tolist() == text_walk.marker.values.tolist()
    assert sampling_rate(walk) == pytest.approx(50)
    assert (walk.attrs["unit"], walk.attrs["up_axis"]) == ("mm", "z")


def test_decimal_commas_are_understood(text_walk):
    text = _tsv(text_walk)
    head, table = text[: text.index("TRAJECTORY")], text[text.index("TRAJECTORY") :]
    np.testing.assert_array_equal(_read(head + table.replace(".", ",")).values, _read(text).values)


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("FRAMES\t100", "FRAMES\t101", "cut short"),
        ("FRAMES\t100", "FRAMES\t99", "count is wrong"),
        ("FRAMES\t100", "FRAMES\t999999999", "cut short"),
        ("FRAMES\t100", "FRAMES\tmany", "NO_OF_FRAMES"),
        ("MARKERS\t15", "MARKERS\t16", "names of 16 markers"),
        ("MARKERS\t15", "MARKERS\t999999999", "names of 999999999"),
        ("FREQUENCY\t50", "FREQUENCY\t0", "FREQUENCY"),
        ("FREQUENCY\t50", "FREQUENCY\t1e9", "FREQUENCY"),
        ("FREQUENCY\t50", "FREQUENCY\tfast", "FREQUENCY"),
        ("3D", "6D", "export the 3D data"),
        ("Measured\r\n", "Measured\r\n1\t2\t3\t4\t", "columns more"),
        ("Measured\r\n", "Measured\r\nnine\t", "nine"),
    ],
)
def test_what_is_wrong_is_told(text_walk, old, new, told):
    text = _tsv(text_walk)
    assert old in text
    with pytest.raises(UnreadableFile, match=told):
        _read(text.replace(old, new, 1))


def test_a_table_in_another_unit_than_the_usual_is_guessed_aloud(text_walk):
    with pytest.warns(UnitGuessed):
        walk = _read(_tsv(text_walk / 1000))
    assert (walk.attrs["unit"], walk.attrs["unit_guessed"]) == ("m", True)
