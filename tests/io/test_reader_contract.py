"""What all readers keep to, whatever the format: one walk comes out of every file that holds it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
import xarray as xr

from corpus.sound_files import KINDS, RATE_HZ, Files, sound_files, walk_of
from eigenwalker.core.trajectories import sampling_rate
from eigenwalker.io.capture_file import CaptureFile
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.read import READERS, SUFFIXES, is_capture, read_mocap

pytestmark = pytest.mark.filterwarnings(
    "ignore::eigenwalker.io.UnitGuessed", "ignore::eigenwalker.io.RateAssumed"
)


class Kind(NamedTuple):
    """What a reader must say of the files of `sound_files`, and how exact it must be."""

    reader: str
    unit: str
    up: str
    atol_mm: float = 0.01
    gap: bool = True
    """Whether the missing samples are in the files, or were filled before."""
    declares_frames: bool = True
    declares_rate: bool = True
    turned: bool = False
    """Whether the frame of the file is turned about the vertical."""
    names: dict[str, str] = {}  # noqa: RUF012 - read only
    """Names of markers in the file that are other than those of the joints."""


KINECT = {"pelvis": "SpineBase", "sternum": "SpineShoulder", "head": "Head"} | {
    f"{side}_{part}": part.title() + side.title()
    for side in ("left", "right")
    for part in ("shoulder", "elbow", "wrist", "hip", "knee", "ankle")
}
CONTRACT = {
    "c3d": Kind("C3D", "mm", "z", 0.06),
    "bvh": Kind("BVH", "cm", "y", 70, gap=False),
    "trc": Kind("TRC", "mm", "y", gap=False),
    "sto": Kind("STO/MOT", "m", "y"),
    "vicon_csv": Kind("Vicon CSV", "mm", "z", declares_frames=False),
    "qualisys_tsv": Kind("Qualisys TSV", "mm", "z"),
    "pose_json": Kind("JSON", "m", "-y", 0.02, declares_frames=False, turned=True),
    "csv": Kind("table", "mm", "z", gap=False),
    "kinect": Kind("table", "m", "y", declares_frames=False, names=KINECT),
    "data3d": Kind("table", "asf", "y", gap=False, declares_frames=False, declares_rate=False),
    "described": Kind("table", "mm", "z", declares_frames=False),
    "netcdf": Kind("NetCDF", "mm", "z", gap=False),
}
FILES = [
    pytest.param(kind, files, id=f"{kind}-{number}")
    for kind in CONTRACT
    for number, files in enumerate(sound_files(kind))
]
of_all_files = pytest.mark.parametrize(("kind", "files"), FILES)


def _write(folder: Path, files: Files) -> Path:
    for name, content in files.items():
        (folder / name).write_bytes(content)
    return folder / next(iter(files))


def _content(files: Files) -> bytes:
    return next(iter(files.values()))


def _joints(kind: str, walk: xr.DataArray) -> tuple[np.ndarray, np.ndarray]:
    """Return the joints as read, and as written where they are in the file."""
    names = CONTRACT[kind].names
    truth = walk_of()
    if not walk.isnull().any():
        truth = truth.interpolate_na("time", fill_value="extrapolate")
    present = set(walk.marker.values.tolist())
    joints = [name for name in truth.marker.values if names.get(name, name) in present]
    assert len(joints) >= 12
    return (
        walk.sel(marker=[names.get(name, name) for name in joints]).values,
        truth.sel(marker=joints).values,
    )


def test_every_kind_of_file_that_is_read_is_held_to_the_contract():
    assert set(CONTRACT) == set(KINDS) - {"mat", "population", "bml", "amc", "stimulus"}
    assert {kind.reader for kind in CONTRACT.values()} | {"ASF/AMC"} == {r.name for r in READERS}


@of_all_files
def test_the_same_walk_comes_out(kind, files, tmp_path):
    walk = read_mocap(_write(tmp_path, files))
    ours, truth = _joints(kind, walk)
    atol = CONTRACT[kind].atol_mm
    if CONTRACT[kind].turned:
        np.testing.assert_allclose(ours[..., 2], truth[..., 2], atol=atol)
        ours, truth = (np.diff(values, axis=1) for values in (ours, truth))
        ours, truth = (np.linalg.norm(values, axis=2) for values in (ours, truth))
    np.testing.assert_allclose(ours, truth, atol=atol)


@of_all_files
def test_trajectories_are_in_millimetres_with_what_the_file_had_in_the_attributes(
    kind, files, tmp_path
):
    path = _write(tmp_path, files)
    walk = read_mocap(path)
    expected = CONTRACT[kind]
    assert walk.dims == ("time", "marker", "axis")
    assert walk.axis.values.tolist() == ["x", "y", "z"]
    assert len(set(walk.marker.values.tolist())) == walk.sizes["marker"]
    assert walk.attrs["units"] == "mm"
    assert (walk.attrs["source"], walk.attrs["unit"]) == (path.name, expected.unit)
    assert (walk.attrs["up_axis"], walk.attrs["up_axis_known"]) == (expected.up, True)
    if expected.declares_rate:
        assert sampling_rate(walk) == pytest.approx(RATE_HZ)


@of_all_files
def test_what_was_not_seen_is_missing_in_all_three_axes(kind, files, tmp_path, request):
    missing = np.isnan(read_mocap(_write(tmp_path, files)).values)
    np.testing.assert_array_equal(missing.any(axis=2), missing.all(axis=2))
    by_our_writer = request.node.callspec.id == "c3d-0"
    assert missing.any() == (CONTRACT[kind].gap and not by_our_writer)


@of_all_files
def test_unit_and_rate_of_the_caller_replace_those_of_the_file(kind, files, tmp_path):
    path = _write(tmp_path, files)
    walk, tenfold = read_mocap(path, unit="mm"), read_mocap(path, unit="cm", rate_hz=10)
    np.testing.assert_allclose(tenfold.values, 10 * walk.values, rtol=1e-9)
    assert sampling_rate(tenfold) == pytest.approx(10)
    assert (tenfold.attrs["unit"], tenfold.attrs["unit_guessed"]) == ("cm", False)


@of_all_files
def test_defaults_do_not_replace_what_the_file_names(kind, files, tmp_path):
    path = _write(tmp_path, files)
    walk, other = read_mocap(path), read_mocap(path, default_unit="in", default_rate_hz=10)
    named = not walk.attrs["unit_reason"]
    assert other.attrs["unit"] == (walk.attrs["unit"] if named else "in")
    assert sampling_rate(other) == pytest.approx(RATE_HZ if CONTRACT[kind].declares_rate else 10)


@of_all_files
def test_the_content_decides_who_reads(kind, files, tmp_path):
    content = _content(files)
    first = next(reader for reader in READERS if reader.looks_like(content))
    assert first.name == CONTRACT[kind].reader
    path = _write(tmp_path, files)
    assert path.suffix in first.suffixes
    assert is_capture(path)


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("BVH", b"\xef\xbb\xbf\r\n hierarchy\nROOT"),
        ("ASF/AMC", b"\xef\xbb\xbf# note\r\n#\r\n:degrees\r\n1\r\n"),
        ("ASF/AMC", b":version 1.10\n:name skeleton\n"),
        ("TRC", b"\xef\xbb\xbfPathFileType\t4"),
        ("STO/MOT", b"a\nendheader\r\ntime"),
        ("Vicon CSV", b"\r\n\r\nTrajectories\r\n50\r\n,,head,,\r\nFrame,Sub Frame,X,Y,Z\r\n"),
        ("Qualisys TSV", b"\xef\xbb\xbfNO_OF_FRAMES\t3"),
        ("table", b"time\tnose_x\n"),
    ],
)
def test_marks_blanks_and_ends_of_lines_before_the_first_word_do_not_matter(name, content):
    assert next(reader.name for reader in READERS if reader.looks_like(content)) == name


NO_CAPTURES = [
    *(b"", b"\x00\x01", b"Dear colleague", b"ROOT Hips", b"path to a file", b"42", b"#" * 5000),
    *(b"the endheader is missing", b": a colon", b":other\n", b"\xef\xbb\xbf"),
]


@pytest.mark.parametrize("reader", READERS, ids=lambda reader: reader.name)
def test_other_content_looks_like_no_format(reader):
    assert not any(reader.looks_like(content) for content in NO_CAPTURES)


@of_all_files
def test_a_file_cut_anywhere_is_refused_if_it_declares_its_frames(kind, files, tmp_path):
    if not CONTRACT[kind].declares_frames:
        pytest.skip("its files do not say how many frames they have")
    path = _write(tmp_path, files)
    content = _content(files).rstrip(b"\0\r\n")
    cut = [content[:end] for end in range(1, len(content) - 1, max(len(content) // 100, 1))]
    reader = next(reader for reader in READERS if reader.looks_like(content))
    assert set(_outcomes(reader.read, path, cut)) == {"refused"}


@pytest.mark.parametrize("kind", sorted({*CONTRACT, "amc"} - {"c3d", "netcdf"}))
def test_damaged_files_end_in_data_or_the_one_error(kind, damaged, tmp_path):
    outcomes: set[str] = set()
    for files in sound_files(kind, walk_of(0.3)):
        path = _write(tmp_path, files)
        reader = next(reader for reader in READERS if reader.looks_like(_content(files)))
        outcomes |= set(_outcomes(reader.read, path, damaged(_content(files), 300)))
    assert outcomes == {"read", "refused"}


def _outcomes(read, path: Path, contents: Iterable[bytes]) -> Iterator[str]:
    for content in contents:
        try:
            walk = read(CaptureFile(path, content))
        except UnreadableFile as error:
            refusal = str(error)
            names_file = refusal.startswith((f"{path.name}: expected ", f"{path.stem}.toml: "))
            yield "refused" if names_file else refusal
        else:
            yield "infinite" if np.isinf(walk.values).any() else "read"


def test_suffixes_are_those_of_the_readers():
    assert set(SUFFIXES) == {suffix for reader in READERS for suffix in reader.suffixes}
