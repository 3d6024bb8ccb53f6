from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from eigenwalker.core.trajectories import sampling_rate
from eigenwalker.io.capture_file import CaptureFile
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.readers.trc import read_trc
from eigenwalker.io.up_axis_and_unit import UnitGuessed


def _trc(walk, *, unit="mm", rate="50.00", decimals=5, sep="\t", end="\n", names=None) -> str:
    """A TRC file with y up, as the room of most of them is."""
    length = {"mm": 1.0, "m": 1000.0, "cm": 10.0, "": 1.0}[unit]
    names = list(names or walk.marker.values)
    values = walk.values[..., [1, 2, 0]] / length
    head = [
        sep.join(["PathFileType", "4", "(X/Y/Z)", "walk.trc"]),
        sep.join(["DataRate", "CameraRate", "NumFrames", "NumMarkers", "Units", "OrigDataRate"]),
        sep.join([rate, rate, str(len(walk)), str(len(names)), unit, rate]),
        sep.join(["Frame#", "Time", *(f"{name}{sep}{sep}" for name in names)]).rstrip(),
        sep * 2 + sep.join(f"{a}{i + 1}" for i in range(len(names)) for a in "XYZ"),
        "",
    ]
    for i, frame in enumerate(values):
        cells = ["" if np.isnan(v) else f"{v:.{decimals}f}" for v in frame.ravel()]
        head.append(sep.join([str(i + 1), f"{i / 50:.3f}", *cells]))
    return end.join(head) + end


def _read(text: str | bytes, **options):
    content = text if isinstance(text, bytes) else text.encode()
    return read_trc(CaptureFile(Path("a.trc"), content, **options))


@pytest.mark.parametrize("unit", ["mm", "cm", "m"])
def test_what_was_written_is_read(text_walk, unit):
    walk = _read(_trc(text_walk, unit=unit, decimals=7))
    np.testing.assert_allclose(walk.values, text_walk.values, atol=1e-3)
    assert np.isnan(walk.values[10:14, 2]).all()
    assert walk.marker.values.tolist() == text_walk.marker.values.tolist()
    assert sampling_rate(walk) == pytest.approx(50)
    attrs = walk.attrs
    assert (attrs["up_axis"], attrs["unit"], attrs["unit_guessed"]) == ("y", unit, False)


def test_ends_of_lines_marks_decimal_commas_and_quotes_do_not_matter(text_walk):
    plain = _trc(text_walk)
    for text in (
        "\ufeff" + plain,
        plain.replace("\n", "\r\n"),
        plain.replace(".", ",").replace("walk,trc", "walk.trc"),
        "\n".join(line.rstrip() for line in plain.split("\n")),  # ends of gaps cut off
        plain.rstrip("\n"),
        plain.replace("head", '"head"'),
    ):
        np.testing.assert_array_equal(_read(text).values, _read(plain).values)


def test_blanks_between_cells_do_where_nothing_is_missing(text_walk):
    whole = text_walk.isel(time=slice(20, None))
    text = _trc(whole, sep="\t").replace("\t", " ")
    np.testing.assert_allclose(_read(text).values, whole.values, atol=1e-4)


def test_zero_in_all_three_is_missing(text_walk):
    gone = text_walk.copy(deep=True)
    gone.values[5, 3] = 0.0
    walk = _read(_trc(gone))
    assert np.isnan(walk.values[5, 3]).all()


def test_names_of_each_coordinate_and_unnamed_markers_are_understood(text_walk):
    plain = _trc(text_walk)
    old = plain.split("\n")[3]
    names = text_walk.marker.values
    each = "\t".join(["Frame#", "Time", *(f"{name}_{axis}" for name in names for axis in "xyz")])
    np.testing.assert_array_equal(_read(plain.replace(old, each)).values, _read(plain).values)
    unnamed = _read(plain.replace("left_wrist\t", "\t"))
    assert "left_wrist" not in unnamed.marker.values
    assert unnamed.sizes["marker"] == 14


def test_frames_left_out_are_missing(text_walk):
    lines = _trc(text_walk).replace("\t100\t15\t", "\t97\t15\t").split("\n")
    del lines[46:49]
    walk = _read("\n".join(lines))
    assert walk.sizes["time"] == 100
    assert np.isnan(walk.values[40:43]).all()
    np.testing.assert_allclose(walk.values[43:], text_walk.values[43:], atol=1e-4)


def test_times_of_few_decimals_are_no_other_rate(text_walk):
    lines = _trc(text_walk, rate="120.0").split("\n")
    for i in range(100):
        cells = lines[6 + i].split("\t")
        cells[1] = f"{i / 120:.2f}"
        lines[6 + i] = "\t".join(cells)
    assert sampling_rate(_read("\n".join(lines))) == pytest.approx(120)


def test_a_file_without_a_unit_is_guessed_aloud(text_walk):
    with pytest.warns(UnitGuessed):
        walk = _read(_trc(text_walk, unit="").replace("\t100\t15\t\t", "\t100\t15\t?\t"))
    assert (walk.attrs["unit"], walk.attrs["unit_guessed"]) == ("mm", True)


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("\t100\t15\t", "\t101\t15\t", "cut short"),
        ("\t100\t15\t", "\t99\t15\t", "count is wrong"),
        ("\t100\t15\t", "\t999999999\t15\t", "999999999 frames"),
        ("\t100\t15\t", "\t0\t15\t", "numframes"),
        ("\t100\t15\t", "\t100\t16\t", "50 cells"),
        ("\t100\t15\t", "\t100\t999999999\t", "names of 999999999"),
        ("50.00\t50.00", "0\t50.00", "frames a second"),
        ("50.00\t50.00", "1e9\t50.00", "frames a second"),
        ("50.00\t50.00", "fast\t50.00", "frames a second"),
        ("50.00\t50.00", "nan\t50.00", "frames a second"),
        ("50.00\t50.00", "100.0\t50.00", "100 frames a second, as it declares"),
        ("Frame#", "Picture", "Frame#"),
        ("NumFrames", "Pictures", "numframes"),
        ("\n3\t0.040\t", "\n3\t0.040\tinf\t", "cells"),
        ("\n3\t0.040\t", "\n3\tnoon\t", "noon"),
    ],
)
def test_what_is_wrong_is_told(text_walk, old, new, told):
    text = _trc(text_walk)
    assert old in text
    with pytest.raises(UnreadableFile, match=told) as refusal:
        _read(text.replace(old, new, 1))
    assert str(refusal.value).startswith("a.trc: expected ")


def test_a_rate_by_the_caller_replaces_a_wrong_one(text_walk):
    walk = _read(_trc(text_walk).replace("50.00\t50.00", "0\t50.00"), rate_hz=60)
    assert sampling_rate(walk) == pytest.approx(60)


def test_a_wide_header_over_many_short_lines_allocates_nothing():
    names = "\t\t\t".join(["m"] * 20_000)
    head = "PathFileType\nDataRate NumFrames NumMarkers Units\n50 20000 20000 mm\n"
    text = f"{head}Frame#\tTime\t{names}\n\t\tX1\n" + "1\t0\n" * 20_000
    with pytest.raises(UnreadableFile, match="cells"):
        _read(text)
