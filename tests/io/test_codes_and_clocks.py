"""What programs write for missing samples, in numbers and as times, is read by what it is."""

from __future__ import annotations

import json
import struct
import warnings
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import eigenwalker as ew
from corpus.sound_files import c3d_file, walk_of
from eigenwalker.io.capture_file import CaptureFile
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.missing_codes import without_codes
from eigenwalker.io.timestamps import on_even_clock
from eigenwalker.io.up_axis_and_unit import UpAxisAssumed

WALK = walk_of(1.0, rate_hz=120)
NAMES = [str(name) for name in WALK.marker.values]


def _table(values=WALK.values, time=None, *, number="{:.2f}", separator=",", head="# unit: mm"):
    time = [f"{each:.4f}" for each in WALK.time.values] if time is None else time
    names = ["time", *(f"{name}_{axis}" for name in NAMES for axis in "xyz")]
    rows = [
        [moment, *(number.format(v) for v in frame.ravel())]
        for moment, frame in zip(time, values, strict=True)
    ]
    lines = [separator.join(row) for row in (names, *rows)]
    return "\n".join([head, *lines]) + "\n"


def _read(tmp_path: Path, content: str | bytes, name: str = "a.csv", **given):
    path = tmp_path / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return ew.read_mocap(path, **given)


@pytest.mark.parametrize("code", ["-3.697314e+28", "#N/A", "-", ".", "inf", "-999999", "9999999"])
def test_codes_are_missing_samples(tmp_path, code):
    lines = _table().splitlines()
    cells = lines[20].split(",")
    cells[4:7] = [code] * 3
    lines[20] = ",".join(cells)
    walk = _read(tmp_path, "\n".join(lines) + "\n")
    assert np.isnan(walk.values).any(axis=2).sum() == 1 + int(
        np.isnan(WALK.values).any(axis=2).sum()
    )
    assert (walk.attrs["up_axis"], walk.attrs["unit"]) == ("z", "mm")


@pytest.mark.parametrize("code", [-999.0, 1000.0])
@pytest.mark.parametrize("share", [0.003, 0.02, 0.3])
def test_codes_are_found_however_often_they_stand(code, share):
    values = WALK.values / 1000
    lost = np.random.default_rng(1).random(values.shape[:2]) < share
    values[lost] = code
    positions, codes = without_codes(values)
    assert codes == [f"{code:g}"]
    assert np.isnan(positions[lost]).all()
    np.testing.assert_array_equal(positions[~lost], values[~lost])


@pytest.mark.parametrize("code", [999.0, -1.0, 9999.0, -99.0, 123.0])
@pytest.mark.parametrize("unit_mm", [1, 1000])
def test_one_number_that_repeats_in_gaps_is_a_code(code, unit_mm):
    values = WALK.values / unit_mm
    values[50:60, 3:5] = code
    positions, codes = without_codes(values)
    assert codes == [f"{code:g}"]
    assert np.isnan(positions[50:60, 3:5]).all()
    np.testing.assert_array_equal(np.delete(positions, [3, 4], 1), np.delete(values, [3, 4], 1))


def test_a_code_in_one_coordinate_is_found_where_it_stays():
    values = WALK.values.copy()
    values[50:60, 3, 0] = 9999
    values[20, 5, 0] = 9999  # which a walk of ten metres passes
    positions, codes = without_codes(values)
    assert codes == ["9999"]
    assert np.isnan(positions).any(axis=2).sum() == 10 + int(np.isnan(values).any(axis=2).sum())


@pytest.mark.filterwarnings("ignore::eigenwalker.io.UnitGuessed")
def test_one_wild_sample_turns_no_frame(tmp_path):
    values = WALK.values.copy()
    values[30, 0] = [2e6, -1e6, 3e6]
    walk = _read(tmp_path, _table(values, head="# table"))
    assert (walk.attrs["up_axis"], walk.attrs["unit"]) == ("z", "mm")


@pytest.mark.parametrize("scale", [1, 1e3, 1e6])
def test_unix_times_are_read(tmp_path, scale):
    time = [f"{(1606735971.123 + each) * scale:.6f}" for each in WALK.time.values]
    walk = _read(tmp_path, _table(time=time))
    assert 1 / np.diff(walk.time.values).mean() == pytest.approx(120, rel=1e-6)
    assert walk.time.values[0] == 0
    assert walk.attrs["clock_start_s"] == pytest.approx(1606735971.123)


@pytest.mark.parametrize("unit", ["s", "ms", "us", "ns"])
@pytest.mark.parametrize("suffix", [".trc", ".sto", ".tsv"])
def test_every_table_reads_unix_times(tmp_path, suffix, unit):
    scale = {"s": 1.0, "ms": 1e3, "us": 1e6, "ns": 1e9}[unit]
    time = [f"{(1606735971.125 + each) * scale:.6f}" for each in WALK.time.values]
    walk = _read(tmp_path, _of_format(suffix, time), f"a{suffix}")
    assert 1 / np.diff(walk.time.values).mean() == pytest.approx(120, rel=1e-6)
    assert walk.attrs["clock_start_s"] == pytest.approx(1606735971.125)
    assert walk.attrs.get("time_unit_guessed", "s") == unit


def _of_format(suffix: str, time: list[str]) -> str:
    """Return the walk as a TRC, STO or Qualisys table of 120 frames a second."""
    n, names = len(NAMES), "\t".join(NAMES)
    head = {
        ".trc": "PathFileType\t4\nDataRate\tNumFrames\tNumMarkers\tUnits\n"
        f"120\t{len(WALK)}\t{n}\tmm\nFrame#\tTime\t" + "\t\t\t".join(NAMES) + "\n"
        "\t\t" + "\t".join(f"{axis}{i + 1}" for i in range(n) for axis in "XYZ"),
        ".sto": f"a\nnRows={len(WALK)}\nnColumns={3 * n + 1}\nUnits=mm\nendheader\ntime\t"
        + "\t".join(f"{name}_t{axis}" for name in NAMES for axis in "xyz"),
        ".tsv": f"NO_OF_FRAMES\t{len(WALK)}\nNO_OF_MARKERS\t{n}\nFREQUENCY\t120\n"
        f"MARKER_NAMES\t{names}\nFrame\tTime\t"
        + "\t".join(f"{name} {axis}" for name in NAMES for axis in "XYZ"),
    }[suffix]
    rows = [
        "\t".join(
            [*([] if suffix == ".sto" else [f"{at + 1}"]), moment, *map("{:.2f}".format, row)]
        )
        for at, (moment, row) in enumerate(
            zip(time, WALK.values.reshape(len(WALK), -1), strict=True)
        )
    ]
    return "\n".join([head, *rows]) + "\n"


@pytest.mark.parametrize("suffix", [".trc", ".tsv"])
@pytest.mark.parametrize("time", ["0", "", "1.60673597e+09"])
def test_times_that_say_nothing_leave_the_declared_rate(tmp_path, suffix, time):
    walk = _read(tmp_path, _of_format(suffix, [time] * len(WALK)), f"a{suffix}")
    assert 1 / np.diff(walk.time.values).mean() == pytest.approx(120, rel=1e-6)


@pytest.mark.parametrize(
    ("rate_hz", "decimals"), [(120, 2), (120, 3), (60, 2), (30, 2), (75, 2), (29.97, 3), (240, 4)]
)
def test_times_of_few_digits_give_the_rate_that_the_whole_column_shows(rate_hz, decimals):
    file = CaptureFile(Path("a.csv"), b"")
    time = np.round(np.arange(400) / rate_hz, decimals)
    even = on_even_clock(file, np.arange(400.0)[:, None, None], time)
    assert even.rate_hz == pytest.approx(rate_hz, rel=1e-5)
    np.testing.assert_array_equal(even.positions.ravel(), np.arange(400))
    assert "rounded" in even.attrs["rate_reason"]


@pytest.mark.parametrize(
    ("step", "rate_hz", "others"),
    [("0.008", 120, "117.6"), ("0.01", 100, "66.67"), ("0.02", 50, "66.67"), ("0.004", 250, "222")],
)
def test_a_step_that_may_be_rounded_is_said(tmp_path, step, rate_hz, others):
    decimals = len(step) - 2
    time = [f"{at * float(step):.{decimals}f}" for at in range(len(WALK))]
    with pytest.warns(ew.io.RateAssumed, match=rf"step of {step} s .* rounded.*{others}"):
        walk = _read(tmp_path, _table(time=time))
    assert 1 / np.diff(walk.time.values).mean() == pytest.approx(rate_hz)
    assert walk.attrs["rate_assumed"]


@pytest.mark.parametrize(
    ("step", "rate_hz"), [("0.0083", 120), ("0.017", 60), ("0.033", 30), ("0.010", 100)]
)
def test_a_step_that_one_rate_has_is_of_that_rate(tmp_path, step, rate_hz):
    decimals = len(step) - 2
    time = [f"{at * float(step):.{decimals}f}" for at in range(len(WALK))]
    walk = _read(tmp_path, _table(time=time))
    assert 1 / np.diff(walk.time.values).mean() == pytest.approx(rate_hz)


def test_times_of_too_few_digits_are_refused_with_the_way_out(tmp_path):
    for time in (["5"] * len(WALK), [f"{each:.0f}" for each in WALK.time.values]):
        with pytest.raises(UnreadableFile, match=r"times that go on.*(none differs|too few digits)"
                           r".*rate_hz="):  # fmt: skip
            _read(tmp_path, _table(time=time))
        assert len(_read(tmp_path, _table(time=time), rate_hz=120)) == len(WALK)


def test_dates_are_read_or_refused_with_the_way_out(tmp_path):
    start = np.datetime64("2022-06-14T23:57:47.000000")
    moments = start + (WALK.time.values * 1e6).astype("timedelta64[us]")
    walk = _read(tmp_path, _table(time=[f"{each}Z" for each in moments]))
    assert 1 / np.diff(walk.time.values).mean() == pytest.approx(120, rel=1e-6)
    dates = ["14/06/2022 11:57 pm"] * len(WALK)
    with pytest.raises(UnreadableFile, match=r"date.*rate_hz="):
        _read(tmp_path, _table(time=dates))
    assert len(_read(tmp_path, _table(time=dates), rate_hz=120)) == len(WALK)


@pytest.mark.parametrize(("mark", "separator"), [(",", "\t"), (",", ";"), (".", "\t")])
def test_marks_between_thousands_are_no_decimals(tmp_path, mark, separator):
    text = _table(number="{:,.0f}", separator=separator)
    walk = _read(tmp_path, text if mark == "," else text.replace(",", "."), default_rate_hz=120)
    np.testing.assert_allclose(walk.values, WALK.values, atol=0.51)
    assert walk.attrs["thousands_mark"] == mark


@pytest.mark.parametrize("mark", ["'", "\u2019", "\u00a0", "\u2009", "\u202f", "_", " "])
@pytest.mark.parametrize(("decimal", "separator"), [(".", ","), (".", "\t"), (",", ";")])
def test_other_marks_between_thousands_are_left_out(tmp_path, mark, decimal, separator):
    grouped = _table(number="{:,.1f}", separator="|").replace(",", mark).replace(".", decimal)
    walk = _read(tmp_path, grouped.replace("|", separator), default_rate_hz=120)
    np.testing.assert_allclose(walk.values, WALK.values, atol=0.051)
    assert walk.attrs["thousands_mark"] == mark


def test_a_mark_that_is_not_between_thousands_is_refused_with_the_way_out(tmp_path):
    content = _table().replace(".", "'", 600)
    with pytest.raises(UnreadableFile, match="decimal point and no other mark"):
        _read(tmp_path, content, default_rate_hz=120)


def test_numbers_of_frames_are_no_times(tmp_path):
    content = _table(time=[f"{number}" for number in range(len(WALK))])
    with pytest.raises(UnreadableFile, match=r"whole steps of 1.*rate_hz="):
        _read(tmp_path, content)
    for given in ({"rate_hz": 120}, {"default_rate_hz": 120}):
        walk = _read(tmp_path, content, **given)
        assert 1 / np.diff(walk.time.values).mean() == pytest.approx(120)
    walk = _read(tmp_path, content.replace("time,", "time_ms,", 1))
    assert 1 / np.diff(walk.time.values).mean() == pytest.approx(1000)


@pytest.mark.parametrize("name", ["time", "time_microseconds", "time_ms", "milliseconds"])
def test_a_unit_of_time_is_named_or_said(tmp_path, name):
    scale = 1e6 if "micro" in name else 1e3
    content = _table(time=[f"{each * scale:.3f}" for each in WALK.time.values])
    walk = _read(tmp_path, content.replace("time,", f"{name},", 1))
    assert 1 / np.diff(walk.time.values).mean() == pytest.approx(120, rel=1e-4)
    assert walk.attrs.get("time_unit_guessed") == ("ms" if name == "time" else None)


def test_three_decimals_behind_commas_stay_decimals(tmp_path):
    walk = _read(tmp_path, _table(WALK.values / 1000, number="{:.3f}", separator=";",
                                  head="# unit: m").replace(".", ","))  # fmt: skip
    np.testing.assert_allclose(walk.values, WALK.values, atol=0.51)


def test_utf_16_and_32_are_read_in_every_format(tmp_path):
    for suffix in (".bvh", ".trc", ".csv"):
        whole = WALK.interpolate_na("time", fill_value="extrapolate")
        path = ew.write_mocap(whole, tmp_path / f"a{suffix}")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            plain = ew.read_mocap(path)
            text = path.read_text()
            for encoding in ("utf-16", "utf-16-le", "utf-16-be", "utf-32", "utf-32-le"):
                path.write_bytes(text.encode(encoding))
                np.testing.assert_array_equal(ew.read_mocap(path).values, plain.values)


def test_a_long_c3d_without_trial_parameters_is_read_whole(tmp_path):
    long = ew.label_trajectories(
        np.tile(WALK.values[:1, :3], (66000, 1, 1)), markers=NAMES[:3], rate_hz=100
    )
    for declared in (65535, 66000 - 65536):
        content = c3d_file(long, n_frames=declared)
        assert len(_read(tmp_path, content, "a.c3d")) == 66000


def test_a_frame_time_that_is_rounded_is_said(tmp_path):
    path = ew.write_mocap(WALK.interpolate_na("time", fill_value="extrapolate"), tmp_path / "a.bvh")
    path.write_text(path.read_text().replace("0.0083333333", "0.008"))
    with pytest.warns(ew.io.RateAssumed, match=r"0\.008 is rounded"):
        walk = ew.read_mocap(path, unit="cm")
    assert 1 / np.diff(walk.time.values).mean() == pytest.approx(120)


def test_half_a_body_stands_on_its_feet_and_that_is_said(tmp_path):
    lower = WALK.sel(
        marker=[name for name in NAMES if name.split("_")[-1] in ("hip", "knee", "ankle")]
    )
    content = {"up": "x", "unit": "mm", "fps": 120, "frames": [
        {str(m): [float(v) for v in p] for m, p in zip(lower.marker.values, frame, strict=True)}
        for frame in np.nan_to_num(lower.values, nan=1.0)
    ]}  # fmt: skip
    content["frames"] = [{"landmarks": frame} for frame in content["frames"]]
    with pytest.warns(UpAxisAssumed, match="names x as upward, but the body stands along z"):
        walk = _read(tmp_path, json.dumps(content), "a.json")
    assert walk.attrs["up_axis"] == "z"


@pytest.mark.parametrize("depth", [500, 1500, 3000, 100_000])
@pytest.mark.parametrize(("opened", "closed"), ["[]", ('{"frames":[', "]}")])
def test_nested_json_is_refused(tmp_path, depth, opened, closed):
    with pytest.raises(UnreadableFile, match="expected"):
        _read(tmp_path, opened * depth + closed * depth, "a.json")


def _sparse_bvh() -> str:
    joints = "JOINT j\n{\nOFFSET 0 1 0\nCHANNELS 0\nEnd Site\n{\nOFFSET 0 0 0\n}\n}\n" * 900
    head = f"HIERARCHY\nROOT a\n{{\nOFFSET 0 0 0\nCHANNELS 1 Xposition\n{joints}}}\n"
    return f"{head}MOTION\nFrames: 20000\nFrame Time: 0.01\n" + "0\n" * 20000


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("a.csv", "," * 1_000_000 + "\n" + "1," * 1_000_000 + "\n"),
        ("a.trc", "PathFileType\t4\n" + "\t" * 1_000_000 + "\n1\n2\n3\n"),
        ("a.json", '{"frames":[' + "[]," * 7_000_000 + "[]]}"),
        ("a.bvh", _sparse_bvh()),
    ],
)
def test_limits_are_checked_before_the_work_is_done(tmp_path, name, content):
    with pytest.raises(UnreadableFile, match="at most"):
        _read(tmp_path, content, name)


def test_a_skeleton_that_few_numbers_move_has_a_limit(tmp_path):
    bones = "".join(
        f"begin\nid {at}\nname b{at}\ndirection 0 1 0\nlength 1\naxis 0 0 0 XYZ\nend\n"
        for at in range(1, 1500)
    )
    (tmp_path / "a.asf").write_text(
        ":version 1.10\n:name a\n:units\nmass 1\nlength 1\nangle deg\n"
        ":root\norder TX TY TZ RX RY RZ\n"
        f"axis XYZ\nposition 0 0 0\norientation 0 0 0\n:bonedata\n{bones}:hierarchy\nbegin\n"
        + "".join(f"{'root' if at == 1 else f'b{at - 1}'} b{at}\n" for at in range(1, 1500))
        + "end\n"
    )
    motion = ":FULLY-SPECIFIED\n:DEGREES\n" + "".join(
        f"{at}\nroot 0 0 0 0 0 0\n" for at in range(1, 3001)
    )
    with pytest.raises(UnreadableFile, match="positions at most"):
        _read(tmp_path, motion, "a.amc")


def test_a_netcdf_file_gives_no_more_than_it_has(tmp_path):
    """Ten thousand variables that lie in one place would be 80 times the file."""
    n = 20_000

    def word(text: str) -> bytes:
        return struct.pack(">i", len(text)) + text.encode().ljust(-(-len(text) // 4) * 4, b"\0")

    dims = struct.pack(">ii", 10, 1) + word("d") + struct.pack(">i", n)
    absent = struct.pack(">ii", 0, 0)
    n_variables = 200
    begin = 8 + len(dims) + 8 + 8 + n_variables * (8 + 8 + 8 + 12)
    variables = b"".join(
        word(f"v{at:03}") + struct.pack(">ii", 1, 0) + absent + struct.pack(">iii", 6, 8 * n, begin)
        for at in range(n_variables)
    )
    head = b"CDF\x01" + struct.pack(">i", 0) + dims + absent
    content = head + struct.pack(">ii", 11, n_variables) + variables + bytes(8 * n)
    with pytest.raises(UnreadableFile, match="damaged"):
        _read(tmp_path, content, "a.nc")


def test_no_message_is_long():
    assert len(str(UnreadableFile("a" * 9999, "b" * 9999, "c" * 9999))) < 1500


def test_codes_in_c3d_files_are_missing(tmp_path):
    coded = WALK.copy(data=np.where(np.isnan(WALK.values), 1.0, WALK.values))
    coded.values[5:9, 2] = -3.697314e28
    walk = _read(tmp_path, c3d_file(coded), "a.c3d")
    assert np.isnan(walk.values).any(axis=2).sum() == 4


def test_an_attribute_does_not_change_the_unit(tmp_path):
    path = ew.write_mocap(WALK, tmp_path / "a.nc")
    dataset = xr.load_dataset(path, engine="scipy")
    dataset.attrs["capture_units"] = "m"
    dataset.to_netcdf(path, engine="scipy")
    with pytest.raises(UnreadableFile, match="capture_units"):
        ew.read_mocap(path)
