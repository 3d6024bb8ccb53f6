from __future__ import annotations

import os
import pickle
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import eigenwalker as ew
from corpus.sound_files import sound_files
from eigenwalker.core.trajectories import sampling_rate
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.read import SUFFIXES, read_mocap
from eigenwalker.io.up_axis_and_unit import UnitGuessed
from eigenwalker.io.write import write_mocap

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
        ("weather.nc", b"\x89HDF\r\n\x1a\n" + bytes(99), "got a NetCDF-4 or HDF5 file"),
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
    assert set(SUFFIXES) >= {".bvh", ".c3d", ".amc"}
    assert ew.read_mocap is read_mocap


def test_defaults_count_only_where_the_file_names_nothing(text_walk, tmp_path: Path):
    values = text_walk.values[20:]
    names = [f"{name}_{axis}" for name in text_walk.marker.values for axis in "xyz"]
    rows = "\n".join(",".join(f"{v:.3f}" for v in frame.ravel()) for frame in values)
    bare, named = tmp_path / "bare.csv", tmp_path / "named.csv"
    bare.write_text(",".join(names) + "\n" + rows + "\n")
    named.write_text("# unit: mm; rate_hz: 50\n" + bare.read_text())
    defaults = {"default_unit": "cm", "default_rate_hz": 25}
    walk = read_mocap(bare, **defaults)
    np.testing.assert_allclose(walk.values, 10 * values, atol=1e-2)
    assert sampling_rate(walk) == pytest.approx(25)
    assert (walk.attrs["unit"], walk.attrs["unit_guessed"]) == ("cm", False)
    walk = read_mocap(named, **defaults)
    np.testing.assert_allclose(walk.values, values, atol=1e-3)
    assert sampling_rate(walk) == pytest.approx(50)
    for wrong in ({"default_unit": "furlong"}, {"default_rate_hz": 0}, {"partial": "some"}):
        with pytest.raises(ValueError, match="is no"):
            read_mocap(named, **wrong)


@pytest.mark.filterwarnings("ignore::eigenwalker.io.UnitGuessed")
@pytest.mark.parametrize("kind", ["bvh", "c3d", "trc", "sto", "qualisys_tsv", "csv"])
def test_the_whole_frames_of_a_cut_file_can_be_kept(kind, tmp_path: Path):
    for number, files in enumerate(sound_files(kind)):
        name, content = next(iter(files.items()))
        path = tmp_path / f"{number}{name}"
        path.write_bytes(content)
        whole = read_mocap(path)
        assert "n_frames_cut" not in read_mocap(path, partial="keep").attrs
        padding = len(content) - len(content.rstrip(b"\0"))
        for end in (len(content) - padding - 4, (2 * len(content)) // 3 + 150):
            path.write_bytes(content[:end])
            with pytest.raises(UnreadableFile, match="cut short"):
                read_mocap(path)
            part = read_mocap(path, partial="keep")
            n_frames = part.sizes["time"]
            assert 0 < n_frames < whole.sizes["time"]
            assert part.attrs["n_frames_cut"] == whole.sizes["time"] - n_frames
            np.testing.assert_array_equal(part.values, whole.values[:n_frames])
    path.write_bytes(content[: (2 * len(content)) // 3 + 150])
    with pytest.raises(UnreadableFile, match='partial="keep"'):
        read_mocap(path)


def test_one_of_several_subjects_can_be_taken(text_walk, tmp_path: Path):
    names = [f"{who}:{name}" for who in ("Anna", "Ben") for name in text_walk.marker.values]
    both = xr.concat([text_walk, text_walk + 1000], dim="marker", coords="minimal")
    path = write_mocap(
        both.assign_coords(marker=names).assign_attrs(units="mm"), tmp_path / "a.csv"
    )
    ben = read_mocap(path, subject="Ben")
    assert ben.marker.values.tolist() == text_walk.marker.values.tolist()
    np.testing.assert_allclose(ben.values, text_walk.values + 1000, atol=0.01)
    assert ben.attrs["subject"] == "Ben"
    with pytest.raises(ValueError, match=r"\['Anna', 'Ben'\]"):
        read_mocap(path, subject="Cleo")
