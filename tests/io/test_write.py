"""What is written is there when read back, by us and by programs that are not ours."""

from __future__ import annotations

import warnings
from pathlib import Path

import ezc3d
import numpy as np
import pandas as pd
import pytest
import xarray as xr

import eigenwalker as ew
from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.trajectories import MILLIMETRES, sampling_rate
from eigenwalker.io.capture_file import CaptureFile
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.read import read_mocap
from eigenwalker.io.readers.netcdf import read_netcdf
from eigenwalker.io.write import FORMATS, write_mocap
from eigenwalker.io.writers.bvh import constant_bones

RATE_HZ = 120


@pytest.fixture(scope="module")
def walker() -> ew.Walker:
    return ew.load_population().walkers[0]


@pytest.fixture(scope="module")
def walk(walker) -> xr.DataArray:
    """Two strides of a walker, away from the origin, from 0.5 s on."""
    time = 0.5 + np.arange(0, 2 * walker.period_s, 1 / RATE_HZ)
    away = np.array([700.0, -300, 20])
    return walker.trajectories(time) + away


@pytest.fixture(scope="module")
def gappy(walk) -> xr.DataArray:
    values = np.array(walk.values)
    values[3:7, 2] = np.nan
    values[:, 9] = np.nan
    return walk.copy(data=values)


def _turned(walk: xr.DataArray, up: str) -> np.ndarray:
    """Positions with y up: the body faces z, its left is x."""
    return walk.values[..., [1, 2, 0]] if up == "y" else walk.values


# ---------------------------------------------------------------- read back by others


@pytest.mark.parametrize(("unit", "up"), [("mm", "z"), ("m", "y"), ("cm", "z")])
def test_c3d_is_what_ezc3d_reads(gappy, tmp_path: Path, unit, up):
    path = write_mocap(gappy, tmp_path / "walk.c3d", unit=unit, up=up)
    other = ezc3d.c3d(str(path))
    point = other["parameters"]["POINT"]
    points = other["data"]["points"][:3].transpose(2, 1, 0) * MILLIMETRES[unit]
    np.testing.assert_allclose(points, _turned(gappy, up), atol=1e-3)
    assert point["LABELS"]["value"] == list(JOINTS.markers)
    assert (point["UNITS"]["value"], point["RATE"]["value"]) == ([unit], [RATE_HZ])
    assert point["Y_SCREEN"]["value"] == [f"+{up.upper()}"]
    assert other["header"]["points"]["first_frame"] == 60  # counted from 0: half a second


@pytest.mark.parametrize(("unit", "up"), [("cm", "y"), ("m", "z")])
def test_bvh_is_what_bvhio_plays(walk, tmp_path: Path, unit, up):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PendingDeprecationWarning)  # of the vectors it imports
        import bvhio
    path = write_mocap(walk, tmp_path / "walk.bvh", unit=unit, up=up)
    body = bvhio.readAsHierarchy(str(path))
    bones = constant_bones(walk)
    expected = bones.copy(data=_turned(bones, up) / MILLIMETRES[unit])
    for frame in (0, 17, len(walk) - 1):
        body.loadPose(frame)
        places = {joint.Name: np.array(joint.PositionWorld) for joint, _, _ in body.layout()}
        found = [places[name] for name in JOINTS.markers]
        np.testing.assert_allclose(
            found, expected.values[frame], atol=0.02 / MILLIMETRES[unit], err_msg=f"frame {frame}"
        )


@pytest.mark.parametrize(("unit", "up"), [("mm", "y"), ("m", "z")])
def test_trc_is_what_pandas_reads(gappy, tmp_path: Path, unit, up):
    path = write_mocap(gappy, tmp_path / "walk.trc", unit=unit, up=up)
    head = pd.read_csv(path, sep="\t", skiprows=1, nrows=1).iloc[0]
    assert (head["DataRate"], head["Units"]) == (RATE_HZ, unit)
    assert (head["NumFrames"], head["NumMarkers"]) == gappy.shape[:2]
    names = path.read_text().splitlines()[3].split("\t")
    assert names[2::3] == list(JOINTS.markers)
    table = pd.read_csv(path, sep="\t", skiprows=6, header=None).to_numpy()
    np.testing.assert_allclose(table[:, 1], gappy.time, atol=1e-8)
    positions = table[:, 2:].reshape(gappy.shape) * MILLIMETRES[unit]
    np.testing.assert_allclose(positions, _turned(gappy, up), atol=1e-4)


@pytest.mark.parametrize(("unit", "up"), [("mm", "z"), ("cm", "y")])
def test_csv_is_what_pandas_reads(gappy, tmp_path: Path, unit, up):
    path = write_mocap(gappy, tmp_path / "walk.csv", unit=unit, up=up)
    title = f"# eigenwalker trajectories; unit: {unit}; up: {up}; frames: {len(gappy)}\n"
    assert path.read_text().startswith(title)
    table = pd.read_csv(path, comment="#")
    assert table.columns[:4].tolist() == ["time_s", "head_x", "head_y", "head_z"]
    np.testing.assert_allclose(table["time_s"], gappy.time, atol=1e-8)
    positions = table.iloc[:, 1:].to_numpy().reshape(gappy.shape) * MILLIMETRES[unit]
    np.testing.assert_allclose(positions, _turned(gappy, up), atol=1e-4)


def test_netcdf_is_what_xarray_reads(gappy, tmp_path: Path):
    path = write_mocap(gappy, tmp_path / "walk.nc")
    with xr.open_dataset(path) as opened:
        dataset = opened.load()
    xr.testing.assert_allclose(dataset["position"].drop_attrs(), gappy.drop_attrs(), atol=0)
    assert dataset["position"].attrs == {"units": "mm"}
    assert sampling_rate(dataset["position"]) == pytest.approx(RATE_HZ)


# ---------------------------------------------------------------- read back by us


def test_c3d_comes_back_on_its_clock(gappy, tmp_path: Path):
    again = read_mocap(write_mocap(gappy, tmp_path / "walk.c3d"))
    np.testing.assert_allclose(again.values, gappy.values, atol=1e-3)
    np.testing.assert_allclose(again.time, gappy.time, atol=1e-9)
    assert not again.attrs["unit_guessed"]


@pytest.mark.parametrize("suffix", [".csv", ".trc"])
@pytest.mark.parametrize(("unit", "up"), [("mm", "z"), ("m", "y")])
def test_tables_come_back(gappy, tmp_path: Path, suffix, unit, up):
    again = read_mocap(write_mocap(gappy, tmp_path / f"walk{suffix}", unit=unit, up=up))
    np.testing.assert_allclose(again.sel(marker=gappy.marker), gappy, atol=1e-4)
    np.testing.assert_allclose(again.time, gappy.time, atol=1e-6)
    assert (again.attrs["unit"], again.attrs["up_axis"]) == (unit, up)
    assert not again.attrs["unit_guessed"]


@pytest.mark.parametrize("up", ["y", "z"])
def test_bvh_comes_back_as_the_body_with_constant_bones(walk, tmp_path: Path, up):
    path = write_mocap(walk, tmp_path / "walk.bvh", up=up)
    again = read_mocap(path, unit="cm").sel(marker=list(JOINTS.markers))
    np.testing.assert_allclose(again.values, constant_bones(walk).values, atol=0.02)
    assert (again.attrs["up_axis"], sampling_rate(again)) == (up, pytest.approx(RATE_HZ))


def test_netcdf_comes_back_with_rotations_and_where_it_came_from(walk, tmp_path: Path):
    bvh = write_mocap(walk, tmp_path / "walk.bvh")
    first = read_mocap(bvh, unit="cm")
    again = read_mocap(write_mocap(first, tmp_path / "walk.nc"))
    xr.testing.assert_equal(again.drop_attrs(), first.drop_attrs())
    np.testing.assert_array_equal(again["rotation"].values, first["rotation"].values)
    assert (again.attrs["source"], again.attrs["original_source"]) == ("walk.nc", "walk.bvh")


def test_netcdf_cut_short_or_of_another_kind_is_refused(walk, tmp_path: Path):
    whole = write_mocap(walk[:4], tmp_path / "walk.nc").read_bytes()
    for percent in range(1, 100):
        with pytest.raises(UnreadableFile):
            read_netcdf(CaptureFile(Path("walk.nc"), whole[: len(whole) * percent // 100]))
    xr.Dataset({"a": 1.0}).to_netcdf(tmp_path / "other.nc", engine="scipy")
    with pytest.raises(UnreadableFile, match="label_trajectories"):
        read_mocap(tmp_path / "other.nc")


def test_damaged_netcdf_ends_in_data_or_in_the_one_error(walk, tmp_path: Path):
    whole = write_mocap(walk[:4], tmp_path / "walk.nc").read_bytes()
    rng = np.random.default_rng(0)
    for _ in range(300):
        damaged = bytearray(whole)
        for at in rng.integers(0, len(whole) if rng.random() < 0.3 else 900, rng.integers(1, 8)):
            damaged[at] = rng.integers(256)
        try:
            read_netcdf(CaptureFile(Path("walk.nc"), bytes(damaged)))
        except UnreadableFile:
            continue


def test_names_in_any_script_survive(tmp_path: Path):
    names = ["Kopf µ", "頭", "left_knee"]
    walk = ew.label_trajectories(np.ones((3, 3, 3)), markers=names, rate_hz=50)
    for suffix in (".c3d", ".nc"):
        again = read_mocap(write_mocap(walk, tmp_path / f"walk{suffix}"))
        assert again.marker.values.tolist() == names


# ---------------------------------------------------------------- bones


def test_a_body_whose_bones_are_constant_is_kept_as_it_is(walk):
    rigid = constant_bones(walk)
    np.testing.assert_allclose(constant_bones(rigid).values, rigid.values, atol=1e-6)


@pytest.mark.parametrize("heading", [0.0, 1.0, np.pi, 4.0])
def test_bones_do_not_mind_where_the_walker_faces(walk, heading):
    turn = np.array(
        [
            [np.cos(heading), -np.sin(heading), 0],
            [np.sin(heading), np.cos(heading), 0],
            [0, 0, 1.0],
        ]
    )
    turned = walk.copy(data=walk.values @ turn.T)
    off = constant_bones(turned) - turned
    np.testing.assert_allclose(
        np.linalg.norm(off, axis=2), np.linalg.norm(constant_bones(walk) - walk, axis=2), atol=1e-6
    )


def test_walkers_of_two_harmonics_lie_near_a_body_with_constant_bones():
    # The true joints: what skin adds as it moves over the bones is no matter of the writer.
    for walker in ew.simulate_population(5, 5, seed=0, markers="joints").walkers:
        walk = walker.trajectories(np.arange(0, walker.period_s, 0.02))
        off = np.linalg.norm(constant_bones(walk) - walk, axis=2)
        assert off.max() < 45
        assert np.sqrt((off**2).mean()) < 8


@pytest.mark.parametrize(
    ("name", "most", "rms"),
    [
        ("cmu/02_01.c3d", 25, 6.1),
        ("cmu/12_01.bvh", 3, 0.2),
        ("bandai-namco/dataset-2_walk_active_001.bvh", 6.2, 1.5),
    ],
)
@pytest.mark.filterwarnings("ignore::eigenwalker.io.up_axis_and_unit.UnitGuessed")
def test_real_captures_lie_near_a_body_with_constant_bones(captures: Path, name, most, rms):
    for joints in ("walker", "full"):
        walk = ew.virtual_markers(read_mocap(captures / name), joints=joints)
        off = np.linalg.norm(constant_bones(walk) - walk, axis=2)
        assert off.max() < most
        assert np.sqrt((off**2).mean()) < rms


@pytest.mark.filterwarnings("ignore::eigenwalker.io.up_axis_and_unit.UnitGuessed")
def test_real_captures_with_feet_and_hands_become_bvh(captures: Path, tmp_path: Path):
    walk = ew.virtual_markers(read_mocap(captures / "cmu/02_01.c3d"), joints="full")
    again = read_mocap(write_mocap(walk, tmp_path / "walk.bvh"))
    back = ew.virtual_markers(again, joints="full")
    assert set(walk.marker.values) <= set(back.marker.values)
    back = back.sel(marker=walk.marker.values)
    expected = constant_bones(walk).sel(marker=back.marker.values)
    np.testing.assert_allclose(back.values, expected.values, atol=0.02)


@pytest.mark.parametrize("suffix", [".c3d", ".nc"])
def test_real_captures_keep_all_markers_and_gaps(captures: Path, tmp_path: Path, suffix):
    walk = read_mocap(captures / "pycgm/Movement_trial.c3d")
    again = read_mocap(write_mocap(walk, tmp_path / f"walk{suffix}"))
    assert again.marker.values.tolist() == walk.marker.values.tolist()
    np.testing.assert_allclose(again.values, walk.values, atol=2e-3)


# ---------------------------------------------------------------- walkers


def test_walkers_walk_for_as_many_strides_as_asked(walker, tmp_path: Path):
    again = read_mocap(write_mocap(walker, tmp_path / "a.c3d", n_strides=3, rate_hz=100))
    assert (len(again), sampling_rate(again)) == (round(300 * walker.period_s), pytest.approx(100))
    np.testing.assert_allclose(
        again.values, walker.trajectories(walker.time_origin_s + again.time).values, atol=1e-3
    )
    assert len(read_mocap(write_mocap(walker, tmp_path / "b.nc", duration_s=1.5))) == 180


def test_walkers_walk_on_the_spot_or_get_on(walker, tmp_path: Path):
    still = read_mocap(write_mocap(walker, tmp_path / "a.nc"))
    gone = read_mocap(write_mocap(walker, tmp_path / "b.nc", overground=True))
    travelled = (gone - still).values
    expected = walker.speed_mm_s * still.time.values
    np.testing.assert_allclose(travelled[..., 0], np.tile(expected[:, None], 15), atol=1e-9)
    assert not travelled[..., 1:].any()


def test_captures_put_in_place_get_their_progress_back(tmp_path: Path):
    walk = ew.simulate_walk(seed=3)
    assert "speed_mm_s" in walk.attrs
    gone = read_mocap(write_mocap(walk, tmp_path / "a.nc", overground=True))
    last = (gone - walk).values[-1, :, 0]
    np.testing.assert_allclose(last, walk.attrs["speed_mm_s"] * np.ptp(walk.time.values))


# ---------------------------------------------------------------- refusals


def test_a_file_appears_whole_or_not_at_all(walk, tmp_path: Path, monkeypatch):
    path = write_mocap(walk, tmp_path / "walk.csv")
    before = path.read_bytes()

    def breaks(_walk, _unit, _up, path: Path) -> None:
        path.write_text("half a f")
        raise OSError("No space left on device")

    monkeypatch.setitem(FORMATS, ".csv", FORMATS[".csv"]._replace(write=breaks))
    with pytest.raises(OSError, match="No space left"):
        write_mocap(walk, path)
    assert path.read_bytes() == before
    assert [each.name for each in tmp_path.iterdir()] == ["walk.csv"]


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ({"unit": "furlong"}, "furlong"),
        ({"up": "x"}, "'y' or 'z'"),
        ({"n_strides": 2}, "for walkers"),
        ({"overground": True}, "speed of this walk is not known"),
    ],
)
def test_choices_that_make_no_sense_are_refused(walk, tmp_path: Path, options, told):
    with pytest.raises(ValueError, match=told):
        write_mocap(walk, tmp_path / "walk.csv", **options)
    assert not list(tmp_path.iterdir())


def test_walkers_are_refused_times_that_make_no_sense(walker, tmp_path: Path):
    for options, told in (
        ({"n_strides": 2, "duration_s": 1}, "give one"),
        ({"n_strides": 0}, "frames"),
        ({"duration_s": np.nan}, "frames"),
        ({"duration_s": 1e9}, "frames"),
        ({"rate_hz": -1}, "frames"),
    ):
        with pytest.raises(ValueError, match=told):
            write_mocap(walker, tmp_path / "walk.csv", **options)


def test_unknown_suffixes_and_folders_are_refused(walk, tmp_path: Path):
    with pytest.raises(ValueError, match=r"must end in one of \['.bvh', '.c3d'"):
        write_mocap(walk, tmp_path / "walk.fbx")
    with pytest.raises(FileNotFoundError, match="make it first"):
        write_mocap(walk, tmp_path / "no" / "walk.c3d")


def test_what_a_format_cannot_hold_is_refused(walk, gappy, tmp_path: Path):
    with pytest.raises(ValueError, match="Samples are missing"):
        write_mocap(gappy, tmp_path / "walk.bvh")
    with pytest.raises(ValueError, match=r"lack \['pelvis'\]"):
        write_mocap(walk.drop_sel(marker="pelvis"), tmp_path / "walk.bvh")
    other = walk.assign_coords(marker=[*JOINTS.markers[:-1], "LANK"])
    with pytest.raises(ValueError, match=r"virtual_markers\(\)"):
        write_mocap(other, tmp_path / "walk.bvh")
    with pytest.raises(ValueError, match="millimetres, z up"):
        write_mocap(walk, tmp_path / "walk.nc", unit="cm")
    many = ew.label_trajectories(
        np.zeros((2, 300, 3)), markers=[f"m{n}" for n in range(300)], rate_hz=50
    )
    with pytest.raises(ValueError, match="255 markers at most"):
        write_mocap(many, tmp_path / "walk.c3d")
    with pytest.raises(ValueError, match="rename the markers"):
        write_mocap(walk.assign_coords(marker=["a\tb", *JOINTS.markers[1:]]), tmp_path / "walk.trc")


# ---------------------------------------------------------------- the command line


def test_convert_writes_markers_or_joints(captures: Path, tmp_path: Path, run_command):
    capture = captures / "cmu/02_01.c3d"
    for words in (["walk.nc"], ["joints.nc", "--joints"], ["walk.bvh"]):
        output, *options = words
        code, printed, _ = run_command("convert", capture, tmp_path / output, *options)
        assert (code, "Written: " in printed) == (0, True)
    markers, joints = (read_mocap(tmp_path / name) for name in ("walk.nc", "joints.nc"))
    assert {"LFHD", "LTOE"} <= set(markers.marker.values)
    assert {*JOINTS.markers, "left_toe"} <= set(joints.marker.values)
    bones = read_mocap(tmp_path / "walk.bvh", unit="cm").sel(marker=joints.marker.values)
    assert np.abs(bones.values - joints.values).max() < 25


def test_the_name_in_a_trc_file_is_that_of_the_file(walk, tmp_path: Path):
    path = write_mocap(walk, tmp_path / "walk.trc")
    assert path.read_text().splitlines()[0].split("\t")[3] == "walk.trc"
