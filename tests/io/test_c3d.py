from __future__ import annotations

import io
import struct
from pathlib import Path

import c3d
import ezc3d
import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from eigenwalker.core.trajectories import sampling_rate
from eigenwalker.io.capture_file import CaptureFile
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.readers.c3d import read_c3d
from eigenwalker.io.up_axis_and_unit import Unit, UnitGuessed, UpAxisAssumed

LABELS = ["LFHD", "LASI", "LTOE"]
MACHINES = {"Intel": 84, "DEC": 85, "MIPS": 86}


def _points(n_frames: int = 5) -> np.ndarray:
    walk = np.zeros((n_frames, 3, 3))
    walk[..., 0] = 10.0 * np.arange(n_frames)[:, None]
    walk[..., 1] = [100, 120, 110]
    walk[..., 2] = [1700, 1000, 50]
    return walk


class Machine:
    """Numbers as one of the three machines writes them."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.order = ">" if name == "MIPS" else "<"

    def words(self, *numbers: int) -> bytes:
        return struct.pack(f"{self.order}{len(numbers)}H", *numbers)

    def floats(self, numbers) -> bytes:
        values = np.asarray(numbers, dtype=float).ravel()
        if self.name != "DEC":
            return values.astype(f"{self.order}f4").tobytes()
        halves = (4 * values).astype("<f4").view("<u2").reshape(-1, 2)
        return np.ascontiguousarray(halves[:, ::-1]).tobytes()


def _parameter(machine: Machine, group: int, name: str, kind: int, shape, raw: bytes) -> bytes:
    body = struct.pack(f"bB{len(shape)}B", kind, len(shape), *shape) + raw + b"\0"
    return struct.pack("bb", len(name), group) + name.encode() + machine.words(len(body) + 2) + body


def _texts(machine: Machine, group: int, name: str, texts, width: int = 8) -> bytes:
    raw = "".join(text.ljust(width) for text in texts).encode("latin-1")
    return _parameter(machine, group, name, -1, (width, len(texts)), raw)


def _file(
    points: np.ndarray,
    labels=LABELS,
    *,
    machine: str = "Intel",
    scale: float = -0.1,
    unit: str = "mm",
    rate: float = 100.0,
    missing: np.ndarray | None = None,
    analog: int = 0,
    extra=(),
    first: int = 1,
    padded: bool = True,
) -> bytes:
    """Return a C3D file as the manual describes it, written without the package under test."""
    write = Machine(machine)
    n_frames, n_points, _ = points.shape
    parameters = [
        struct.pack("bb", 5, -1) + b"POINT" + write.words(3) + b"\0",
        struct.pack("bb", 5, -2) + b"TRIAL" + write.words(3) + b"\0",
        _parameter(write, 1, "USED", 2, (), write.words(n_points)),
        _parameter(write, 1, "FRAMES", 2, (), write.words(min(n_frames, 65535))),
        _parameter(write, 1, "SCALE", 4, (), write.floats([scale])),
        _parameter(write, 1, "RATE", 4, (), write.floats([rate])),
        _texts(write, 1, "LABELS", labels, width=max(8, *map(len, labels))),
        *([_texts(write, 1, "UNITS", [unit], width=4)] if unit else []),
        *extra,
    ]
    body = b"".join(parameters) + b"\0\0"
    blocks = -(-(4 + len(body)) // 512)
    section = bytes([1, 0x50, blocks, MACHINES[machine]]) + body
    section = section.ljust(blocks * 512, b"\0")
    last = first + n_frames - 1
    header = bytes([2, 0x50]) + write.words(n_points, analog, first, min(last, 65535), 0)
    header += write.floats([scale]) + write.words(2 + blocks, 1) + write.floats([rate])
    residual = np.zeros((n_frames, n_points, 1))
    if missing is not None:
        residual[missing] = -1
    samples = points if scale < 0 else np.rint(points / scale)
    table = np.concatenate([np.nan_to_num(samples), residual], axis=2).reshape(n_frames, -1)
    table = np.concatenate([table, np.full((n_frames, analog), 7.0)], axis=1)
    data = write.floats(table) if scale < 0 else table.astype(f"{write.order}i2").tobytes()
    whole = header.ljust(512, b"\0") + section + data
    return whole.ljust(-(-len(whole) // 512) * 512, b"\0") if padded else whole


def _read(content: bytes, unit: Unit | None = None):
    return read_c3d(CaptureFile(Path("a.c3d"), content, unit=unit))


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize("scale", [-0.1, 0.1])
def test_what_was_written_is_read_from_every_machine(machine, scale):
    points = _points()
    missing = np.zeros((5, 3), dtype=bool)
    missing[2, 1] = True
    walk = _read(_file(points, machine=machine, scale=scale, missing=missing, analog=6))
    expected = np.where(missing[..., None], np.nan, points)
    np.testing.assert_allclose(walk.values, expected, rtol=1e-6)
    assert walk.marker.values.tolist() == LABELS
    assert sampling_rate(walk) == pytest.approx(100)


@pytest.mark.filterwarnings("ignore::UserWarning:c3d")  # on parameters that are not needed
@pytest.mark.parametrize("machine", MACHINES)
def test_the_test_files_are_such_as_another_reader_reads(machine):
    points = _points()
    reader = c3d.Reader(io.BytesIO(_file(points, machine=machine)))
    np.testing.assert_allclose([p[:, :3] for _, p, _ in reader.read_frames()], points, rtol=1e-6)


@pytest.mark.filterwarnings("ignore::UserWarning:c3d")  # on parameters that are not needed
@settings(max_examples=25, deadline=None)
@given(st.integers(1, 40), st.integers(1, 12), st.integers(0, 10**6))
def test_files_of_the_c3d_package_come_back(n_frames, n_points, seed):
    rng = np.random.default_rng(seed)
    points = rng.uniform(-3000, 3000, size=(n_frames, n_points, 3)).astype(np.float32)
    missing = rng.random((n_frames, n_points)) < 0.2
    writer = c3d.Writer(point_rate=120)
    writer.set_point_labels([f"M{i}" for i in range(n_points)])
    for frame, gone in zip(points, missing, strict=True):
        residual = np.where(gone, -1.0, 0.0)[:, None]
        writer.add_frames((np.hstack([frame, residual, 0 * residual]), np.zeros((0, 0))))
    handle = io.BytesIO()
    writer.write(handle)
    walk = _read(handle.getvalue())
    order = {"x": (1, 2, 0), "y": (2, 0, 1), "z": (0, 1, 2)}[walk.attrs["up_axis"][-1]]
    assert walk.attrs["up_axis"] == "z"
    np.testing.assert_array_equal(np.isnan(walk.values[..., 0]), missing)
    np.testing.assert_array_equal(walk.values[~missing], points[~missing][:, order])


def test_nan_in_the_samples_is_missing_and_infinity_is_refused():
    content = bytearray(_file(_points()))
    data = content.index(struct.pack("<f", 1700.0))
    content[data : data + 4] = struct.pack("<f", np.nan)
    walk = _read(bytes(content))
    assert np.isnan(walk.values[0, 0]).all()
    assert np.isnan(walk.values).sum() == 3
    for absurd in (np.inf, -np.inf, 1e30):
        content[data : data + 4] = struct.pack("<f", absurd)
        with pytest.raises(UnreadableFile, match="finite"):
            _read(bytes(content))


def test_a_marker_that_jumps_to_the_very_origin_was_not_seen():
    points = _points()
    points[3, 2] = 0
    points[:, 1] = 0
    walk = _read(_file(points))
    assert np.isnan(walk.values[3, 2]).all()
    assert not np.isnan(walk.values[:, 1]).any()


@pytest.mark.parametrize("padded", [True, False])
def test_a_file_cut_anywhere_before_its_last_sample_is_refused(padded):
    whole = _file(_points(30), padded=padded)
    samples = 30 * 3 * 4 * 4
    end = len(_file(_points(30), padded=False))
    for length in [*range(0, end - samples, 37), *range(end - samples, end, 7), end - 1]:
        with pytest.raises(UnreadableFile):
            _read(whole[:length])
    assert _read(whole[:end]).sizes["time"] == 30


def test_frames_are_counted_where_the_header_cannot():
    points = np.repeat(_points(1), 66000, axis=0)
    extra = [
        _parameter(Machine("Intel"), 2, "ACTUAL_START_FIELD", 2, (2,), struct.pack("<I", 1)),
        _parameter(Machine("Intel"), 2, "ACTUAL_END_FIELD", 2, (2,), struct.pack("<I", 66000)),
    ]
    whole = _file(points, scale=0.1, extra=extra)
    assert _read(whole).sizes["time"] == 66000
    with pytest.raises(UnreadableFile, match="66000 frames"):
        _read(whole[:-2048])


def test_where_counts_differ_the_length_of_the_file_decides():
    machine = Machine("Intel")
    stale = [
        _parameter(machine, 2, "ACTUAL_START_FIELD", 2, (2,), machine.words(1, 0)),
        _parameter(machine, 2, "ACTUAL_END_FIELD", 2, (2,), machine.words(900, 0)),
    ]
    assert _read(_file(_points(40), extra=stale)).sizes["time"] == 40


def test_the_clock_is_that_of_the_capture():
    walk = _read(_file(_points(), first=51))
    assert walk.time.values[0] == pytest.approx(0.5)


@pytest.mark.filterwarnings("ignore::UserWarning:c3d")  # on parameters that are not needed
def test_a_parameter_given_twice_counts_once():
    machine = Machine("Intel")
    again = [_texts(machine, 1, "LABELS", ["X", "Y", "Z"]), _texts(machine, 1, "UNITS", ["m"])]
    with pytest.raises(KeyError):
        c3d.Reader(io.BytesIO(_file(_points(), extra=again)))
    walk = _read(_file(_points(), extra=again))
    assert walk.marker.values.tolist() == LABELS
    np.testing.assert_allclose(walk.values, _points())


def test_names_lose_blanks_and_their_one_subject():
    walk = _read(_file(_points(), ["Anna:LFHD ", "Anna:l asis  ", "Anna:LTOE"]))
    assert walk.marker.values.tolist() == ["LFHD", "l asis", "LTOE"]
    assert walk.attrs["subject"] == "Anna"
    two = ["Anna:LFHD", "Ben:LFHD", "Ben:LTOE"]
    assert _read(_file(_points(), two)).marker.values.tolist() == two


def test_repeated_names_are_numbered():
    walk = _read(_file(_points(), ["LFHD", "LFHD", "LTOE"]))
    assert walk.marker.values.tolist() == ["LFHD", "LFHD_2", "LTOE"]


def test_what_is_no_marker_is_left_out_and_told():
    points = np.repeat(_points(), 3, axis=1)
    labels = ["LFHD", "*127", "", "LKneeAngles", "Weird", "LHipPower", "U_12", "LTOE", "Triangle"]
    listed = [_texts(Machine("Intel"), 1, "ANGLES", ["Weird"])]
    walk = _read(_file(points, labels, extra=listed))
    assert walk.marker.values.tolist() == ["LFHD", "LTOE", "Triangle"]
    assert walk.attrs["left_out"] == ["*127", "", "LKneeAngles", "Weird", "LHipPower", "U_12"]
    with pytest.raises(UnreadableFile, match="unlabelled"):
        _read(_file(_points(), ["*1", "*2", ""]))


def test_labels_go_on_in_further_parameters():
    machine = Machine("Intel")
    more = [_texts(machine, 1, "LABELS2", ["RTOE", "RASI"])]
    points = np.concatenate([_points(), _points()[:, :2] + 5], axis=1)
    walk = _read(_file(points, extra=more))
    assert walk.marker.values.tolist() == [*LABELS, "RTOE", "RASI"]


@pytest.mark.parametrize(
    ("unit", "factor"), [("mm", 1), ("cm", 10), ("m", 1000), ("in", 25.4), ("METERS", 1000)]
)
def test_units_become_millimetres(unit, factor):
    named = [_texts(Machine("Intel"), 1, "UNITS", [unit])]
    walk = _read(_file(_points() / factor, unit="", extra=named))
    np.testing.assert_allclose(walk.values, _points(), rtol=1e-5)
    assert not walk.attrs["unit_guessed"]


def test_a_file_without_a_unit_is_told_by_the_height_of_the_body():
    with pytest.warns(UnitGuessed):
        walk = _read(_file(_points() / 1000, unit=""))
    np.testing.assert_allclose(walk.values, _points(), rtol=1e-5)
    assert walk.attrs["unit"] == "m"
    assert _read(_file(_points() / 1000), Unit("m", 1000.0)).values.max() == pytest.approx(1700)


def test_the_body_tells_up_and_else_the_screen_of_the_file():
    machine = Machine("Intel")
    turned = _points()[..., [1, 2, 0]]  # what was z is y now
    wrong = [_texts(machine, 1, "Y_SCREEN", ["+Z"], width=2)]
    with pytest.warns(UpAxisAssumed, match="names z as upward, but the body stands along y"):
        walk = _read(_file(turned, extra=wrong))
    assert walk.attrs["up_axis"] == "y"
    np.testing.assert_allclose(walk.values, _points())
    nameless = ["a", "b", "c"]
    screen = [_texts(machine, 1, "Y_SCREEN", ["+Y"], width=2)]
    assert _read(_file(turned, nameless, extra=screen)).attrs["up_axis"] == "y"
    walk = _read(_file(_points(), nameless))
    assert (walk.attrs["up_axis"], walk.attrs["up_axis_known"]) == ("z", False)


def test_what_was_measured_on_the_subject_goes_along():
    machine = Machine("Intel")
    extra = [
        struct.pack("bb", 10, -3) + b"PROCESSING" + machine.words(3) + b"\0",
        _parameter(machine, 3, "LKNEEWIDTH", 4, (1,), machine.floats([104.0])),
        _parameter(machine, 3, "RKNEEWIDTH", 4, (1,), machine.floats([0.0])),
    ]
    attrs = _read(_file(_points(), extra=extra)).attrs
    assert attrs["left_knee_width_mm"] == 104
    assert "right_knee_width_mm" not in attrs


@pytest.mark.parametrize(
    ("at", "new", "told"),
    [
        (0, b"\0", "header"),
        (0, b"\xff", "cut short"),
        (2, b"\x09", "points"),
        (2, b"\0\0", "points"),
        (12, struct.pack("<f", 0.1), "scale"),
        (12, struct.pack("<f", np.nan), "scale"),
        (20, struct.pack("<f", 50.0), "rate"),
        (16, b"\xff\x7f", "cut short"),
        (512 + 3, b"\x57", "84 to 86"),
    ],
)
def test_what_is_wrong_with_a_file_is_told(at, new, told):
    content = bytearray(_file(_points()))
    content[at : at + len(new)] = new
    with pytest.raises(UnreadableFile, match=told) as refusal:
        _read(bytes(content))
    assert str(refusal.value).startswith("a.c3d: expected ")


def test_damaged_files_end_in_data_or_the_one_error():
    rng = np.random.default_rng(0)
    for machine in MACHINES:
        whole = _file(_points(), machine=machine)
        outcomes = set()
        for number in range(300):
            damaged = bytearray(whole)
            for _ in range(rng.integers(1, 6)):
                at = int(rng.integers((24, 700, len(damaged))[number % 3]))
                damaged[at] = rng.integers(256)
            try:
                walk = read_c3d(CaptureFile(Path("a.c3d"), bytes(damaged), unit=Unit("mm", 1.0)))
            except UnreadableFile:
                outcomes.add("refused")
            else:
                assert not np.isinf(walk.values).any()
                outcomes.add("read")
        assert outcomes == {"read", "refused"}


CAPTURES = ["cmu/02_01.c3d", "pycgm/Movement_trial.c3d", "pycgm/Static_trial.c3d"]


@pytest.mark.parametrize("name", CAPTURES)
def test_real_captures_agree_with_ezc3d(captures: Path, name):
    walk = _read((captures / name).read_bytes())
    other = ezc3d.c3d(str(captures / name))
    labels = [
        label.rpartition(":")[2].strip()
        for label in other["parameters"]["POINT"]["LABELS"]["value"]
    ]
    points = other["data"]["points"][:3].transpose(2, 1, 0)
    indices = [labels.index(marker) for marker in walk.marker.values]
    np.testing.assert_allclose(walk.values, points[:, indices], atol=1e-3)
    assert sampling_rate(walk) == pytest.approx(120)


def test_real_captures_cut_short_are_refused(captures: Path):
    for name in CAPTURES[:2]:
        whole = (captures / name).read_bytes()
        for percent in range(100):
            with pytest.raises(UnreadableFile):
                _read(whole[: len(whole) * percent // 100])


def test_the_stairs_capture_holds_more_than_markers(captures: Path):
    walk = _read((captures / CAPTURES[1]).read_bytes())
    assert len(walk.attrs["left_out"]) == 122
    assert {"LKneeAngles", "*127", "RHipPower"} <= set(walk.attrs["left_out"])
    assert {"LASI", "LFEP"} <= set(walk.marker.values)
    assert walk.attrs["left_knee_width_mm"] == 144
