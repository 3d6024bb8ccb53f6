from __future__ import annotations

import os
import pickle
from pathlib import Path

import pytest

import eigenwalker as ew
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.read import FORMATS, read_mocap
from eigenwalker.io.up_axis_and_unit import UnitGuessed

BVH = b"""HIERARCHY
ROOT Hips
{
  OFFSET 0 0 0
  CHANNELS 3 Xposition Yposition Zposition
  End Site
  {
    OFFSET 0 60 0
  }
}
MOTION
Frames: 1
Frame Time: 0.01
0 95 0
"""


def test_the_content_decides_whatever_the_suffix(tmp_path: Path):
    path = tmp_path / "walk.c3d"
    path.write_bytes(BVH)
    walk = read_mocap(path, unit="cm")
    assert (walk.attrs["format"], walk.attrs["source"]) == ("BVH", "walk.c3d")
    assert walk.attrs["unit_reason"] == "named by the caller"
    assert read_mocap(str(path), unit="m").values.max() == 100 * walk.values.max()


def test_a_guessed_unit_is_warned_of_by_a_name_that_can_be_silenced(tmp_path: Path):
    path = tmp_path / "walk.bvh"
    path.write_bytes(BVH)
    with pytest.warns(UnitGuessed, match=r"read_mocap\(\.\.\., unit='"):
        walk = read_mocap(path)
    assert walk.attrs["unit_guessed"]
    assert "measures" in walk.attrs["unit_reason"]


@pytest.mark.parametrize(
    ("name", "content", "told"),
    [
        ("empty.bvh", b"", "empty"),
        ("prose.bvh", b"Dear colleague", "BVH file, as it is called"),
        ("prose.c3d", b"Dear colleague", "C3D file, as it is called"),
        ("table.trc", b"Dear colleague", "TRC file, as it is called"),
        ("table.csv", b"Dear colleague", "a capture .* or a table of points"),
        ("walk.amc", b"Dear colleague", "expected an ASF/AMC file, as it is called"),
        ("diary.txt", b"hello this is my", 'text that begins with "hello this is my"; export'),
        ("weather.nc", b"\x89HDF\r\n\x1a\n" + bytes(99), "got a NetCDF-4 or HDF5 file; export"),
        ("prose.doc", b"Dear colleague", "export it as one of these"),
        ("bytes", bytes(range(256)), "BVH, C3D"),
    ],
)
def test_a_file_of_another_kind_is_refused(tmp_path: Path, name, content, told):
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(UnreadableFile, match=told) as refusal:
        read_mocap(path)
    assert str(refusal.value).startswith(f"{name}: expected ")


def test_what_is_no_file_is_refused(tmp_path: Path):
    with pytest.raises(UnreadableFile, match="a folder"):
        read_mocap(tmp_path)
    with pytest.raises(UnreadableFile, match="nothing of that name"):
        read_mocap(tmp_path / "nowhere.bvh")


@pytest.mark.skipif(os.name == "nt", reason="Windows has no such files")
def test_a_device_is_refused():
    with pytest.raises(UnreadableFile, match="device"):
        read_mocap(os.devnull)


def test_a_file_that_may_not_be_opened_is_refused(tmp_path: Path, monkeypatch):
    path = tmp_path / "walk.bvh"
    path.write_bytes(BVH)

    def refuse(_path: Path) -> bytes:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "read_bytes", refuse)
    with pytest.raises(UnreadableFile, match="Permission denied"):
        read_mocap(path)


def test_an_unknown_unit_is_no_fault_of_the_file(tmp_path: Path):
    path = tmp_path / "walk.bvh"
    path.write_bytes(BVH)
    with pytest.raises(ValueError, match="furlong") as refusal:
        read_mocap(path, unit="furlong")
    assert not isinstance(refusal.value, UnreadableFile)


def test_the_error_travels_between_processes():
    error = UnreadableFile("a.bvh", "this", "that", "do so")
    again = pickle.loads(pickle.dumps(error))
    assert str(again) == str(error) == "a.bvh: expected this, but got that; do so."


def test_every_format_has_its_place_in_the_table():
    assert {form.suffix for form in FORMATS} >= {".bvh", ".c3d", ".amc"}
    assert ew.read_mocap is read_mocap
