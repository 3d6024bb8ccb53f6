"""Tables that no program marks as its own: named points, data3d text, described tables, JSON."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path

import numpy as np
import pytest

import eigenwalker as ew
from eigenwalker.core.trajectories import sampling_rate
from eigenwalker.io.capture_file import CaptureFile, RateAssumed
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.read import READERS, is_capture, read_mocap
from eigenwalker.io.readers.pose_json import BODY_25, MEDIAPIPE, holds_poses
from eigenwalker.io.readers.skeleton_table import read_skeleton_table
from eigenwalker.io.readers.unmarked_table import looks_like_table
from eigenwalker.io.timestamps import on_even_clock
from eigenwalker.io.up_axis_and_unit import UnitGuessed

quietly = pytest.mark.filterwarnings(
    "ignore::eigenwalker.io.UnitGuessed", "ignore::eigenwalker.io.RateAssumed"
)
V2 = {"sternum": "SpineShoulder", "pelvis": "SpineBase", "head": "Head"}
V1 = {"sternum": "ShoulderCenter", "pelvis": "HipCenter", "head": "Head"}


def _y_up(walk) -> np.ndarray:
    return walk.values[..., [1, 2, 0]] / 1000


def _csv(names, values, *, style="{}_{}", rate=50.0, time="time_s", sep=",", head="") -> str:
    columns = [style.format(name, axis) for name in names for axis in "xyz"]
    lines = [sep.join([*([time] if time else []), *columns])]
    step = 1000 / rate if time and "ms" in time else 1 / rate
    for i, frame in enumerate(values):
        cells = ["" if np.isnan(v) else f"{v:.6f}" for v in frame.ravel()]
        lines.append(sep.join([*([f"{i * step:.4f}"] if time else []), *cells]))
    return head + "\n".join(lines) + "\n"


def _mediapipe(walk) -> np.ndarray:
    """The 33 landmarks of someone whose joints are known: metres, y down, hips in the origin."""
    places = {name: i for i, name in enumerate(walk.marker.values)}
    values = np.zeros((len(walk), 33, 3))
    for at, name in enumerate(MEDIAPIPE):
        side, _, part = name.partition("_")
        joint = name if name in places else {
            "pinky": f"{side}_wrist", "index": f"{side}_wrist", "thumb": f"{side}_wrist",
            "heel": f"{side}_ankle", "foot_index": f"{side}_ankle",
        }.get(part, "head")  # fmt: skip
        values[:, at] = walk.values[:, places[joint]]
    hips = walk.sel(marker=["left_hip", "right_hip"]).values.mean(axis=1, keepdims=True)
    values = (values - hips) / 1000
    return np.stack([-values[..., 1], -values[..., 2], values[..., 0]], axis=-1)


def _read(tmp_path: Path, text: str, name="a.csv", **options):
    path = tmp_path / name
    path.write_text(text, encoding="utf-8", newline="")
    return read_mocap(path, **options)


@quietly
@pytest.mark.parametrize("style", ["{}_{}", "{} {}", "{}.{}", "{}({})", "{}_{}_m", "{}:{}"])
@pytest.mark.parametrize(
    ("time", "sep"), [("time_s", ","), ("time (ms)", ";"), ("Timestamp", "\t")]
)
def test_tables_of_named_points_are_read(text_walk, tmp_path, style, time, sep):
    text = _csv(text_walk.marker.values, _y_up(text_walk), style=style, time=time, sep=sep)
    walk = _read(tmp_path, text)
    np.testing.assert_allclose(walk.values, text_walk.values, atol=1e-2)
    assert walk.marker.values.tolist() == text_walk.marker.values.tolist()
    assert sampling_rate(walk) == pytest.approx(50)


@pytest.mark.parametrize("names", [V1, V2])
@pytest.mark.parametrize("order", ["{part}{side}", "{side}{part}"])
def test_kinect_tables_give_the_joints_they_were_made_of(text_walk, tmp_path, names, order):
    called = [
        names.get(name)
        or order.format(side=name.split("_")[0].title(), part=name.split("_")[1].title())
        for name in text_walk.marker.values
    ]
    text = _csv(called, _y_up(text_walk), style="{} {}", time="", sep=", ")
    with pytest.warns(RateAssumed, match="30"):
        walk = _read(tmp_path, text)
    assert (walk.attrs["format"], walk.attrs["unit"]) == ("Kinect", "m")
    assert sampling_rate(walk) == pytest.approx(30)
    joints = ew.virtual_markers(_read(tmp_path, text, rate_hz=50))
    assert joints.attrs["marker_set"] == "Kinect"
    assert joints.attrs["approximate"] == []
    np.testing.assert_allclose(joints.values[20:], text_walk.values[20:], atol=1e-2)


@quietly
def test_mediapipe_landmarks_give_the_joints(text_walk, tmp_path):
    whole = text_walk.isel(time=slice(20, None))
    text = _csv(MEDIAPIPE, _mediapipe(whole), rate=50)
    walk = _read(tmp_path, text)
    assert (walk.attrs["format"], walk.attrs["up_axis"]) == ("MediaPipe", "-y")
    joints = ew.virtual_markers(walk)
    assert joints.attrs["marker_set"] == "pose estimation (MediaPipe, BODY_25)"
    assert joints.attrs["approximate"] == ["sternum", "pelvis"]
    # The person stays right-handed: the left is at the left of where it walks to.
    truth = whole.sel(marker=["left_hip", "right_hip", "left_ankle"]).values
    found = joints.sel(marker=["left_hip", "right_hip", "left_ankle"]).values
    np.testing.assert_allclose(
        np.linalg.norm(np.diff(found, axis=1), axis=2),
        np.linalg.norm(np.diff(truth, axis=1), axis=2),
        atol=0.1,
    )
    assert not ew.assess(joints).sides_swapped


@quietly
def test_body_25_names_give_the_joints(text_walk, tmp_path):
    values = np.zeros((len(text_walk), 25, 3))
    own = {"Neck": "sternum", "MidHip": "pelvis"}
    for at, name in enumerate(BODY_25):
        joint = own.get(name) or {"R": "right_", "L": "left_"}.get(name[0], "") + name[1:].lower()
        known = joint if joint in text_walk.marker.values else "head"
        values[:, at] = text_walk.sel(marker=known).values
    values = values[..., [1, 2, 0]] / 1000
    joints = ew.virtual_markers(_read(tmp_path, _csv(BODY_25, values)))
    np.testing.assert_allclose(
        joints.sel(marker=["left_knee", "right_wrist", "pelvis"]).values,
        text_walk.sel(marker=["left_knee", "right_wrist", "pelvis"]).values,
        atol=1e-2,
    )


@quietly
def test_theia_segments_give_the_joints(text_walk, tmp_path):
    parts = {"hip": "thigh", "knee": "shank", "ankle": "foot", "shoulder": "uarm",
             "elbow": "larm", "wrist": "hand"}  # fmt: skip
    names = []
    for name in text_walk.marker.values:
        side, _, joint = name.partition("_")
        names.append(f"{side[0]}_{parts[joint]}_4X4" if joint else f"{name}_4X4")
    joints = ew.virtual_markers(_read(tmp_path, _csv(names, _y_up(text_walk))))
    assert joints.attrs["marker_set"] == "Theia segments"
    assert {"sternum", "pelvis"} <= set(joints.attrs["approximate"])
    np.testing.assert_allclose(
        joints.sel(marker="left_knee").values, text_walk.sel(marker="left_knee").values, atol=1e-2
    )


@pytest.mark.parametrize("style", ["frames", "named", "records", "columns", "lists", "openpose"])
@quietly
def test_json_layouts_are_read(text_walk, tmp_path, style):
    whole = text_walk.isel(time=slice(20, None))
    values = np.round(_mediapipe(whole), 6)
    rows = values.tolist()
    points = [[dict(zip("xyz", p, strict=True), visibility=1) for p in frame] for frame in rows]
    named = [dict(zip(MEDIAPIPE, frame, strict=True)) for frame in rows]
    records = [
        {f"{name}_{axis}": p[k] for name, p in frame.items() for k, axis in enumerate("xyz")}
        for frame in named
    ]
    document: object = {
        "frames": {"fps": 50, "frames": [{"pose_world_landmarks": frame} for frame in points]},
        "named": [{"time": i / 50, "landmarks": frame} for i, frame in enumerate(named)],
        "records": [{"time_ms": 20 * i, **frame} for i, frame in enumerate(records)],
        "columns": {key: [frame[key] for frame in records] for key in records[0]},
        "lists": {"rate_hz": 50, "unit": "m", "names": list(MEDIAPIPE), "frames": rows},
        "openpose": {
            "fps": 50,
            "frames": [
                {"people": [{"pose_keypoints_3d": [x for p in f[:25] for x in [*p, 1]]}]}
                for f in rows
            ],
        },
    }[style]
    walk = _read(
        tmp_path, json.dumps(document), "a.json", rate_hz=50 if style == "columns" else None
    )
    assert sampling_rate(walk) == pytest.approx(50)
    expected = BODY_25 if style == "openpose" else MEDIAPIPE
    assert walk.marker.values.tolist() == list(expected)
    if style != "openpose":
        assert walk.attrs["up_axis"] == "-y"
        np.testing.assert_allclose(walk.values[..., 2], -values[..., 1] * 1000, atol=1e-6)


@pytest.mark.parametrize(
    ("document", "told"),
    [
        ("{", "JSON"),
        ("[" * 100_000, "JSON"),
        ("[]", "list of frames"),
        ("{}", "list of frames"),
        ('{"frames": 3}', "list of frames|points"),
        ('[{"people": [{"pose_keypoints_2d": [1, 2, 3]}]}]', "3D points"),
        ('[{"people": [{}, {}]}]', "one person"),
        ('[[[1, 2, 3], [1, 2, 3], [1, 2, "a"]]]', "finite number"),
        ("[[[1, 2, 3], [1, 2, 3], [1, 2, Infinity]]]", "finite number"),
        ("[[[1, 2, 3], [1, 2, 3], [1, 2, 1e99]]]", "finite number"),
        ("[[[1, 2, 3], [1, 2, 3], [1, 2]]]", "points x, y, z"),
        ("[[[1, 2, 3], [1, 2, 3], [1, 2, 4]]]", "names of the 3 points"),
        ('{"names": ["a"], "frames": [[[1, 2, 3], [1, 2, 3], [1, 2, 4]]]}', "3 names"),
        ('{"names": [[], 2, 3], "fps": true, "frames": [[[1,2,3],[1,2,3],[1,2,4]]]}', "frames"),
    ],
)
def test_json_of_other_things_is_refused(tmp_path, document, told):
    with pytest.raises(UnreadableFile, match=told):
        _read(tmp_path, document, "a.json")


def test_landmarks_of_a_picture_are_refused(text_walk, tmp_path):
    values = _mediapipe(text_walk.isel(time=slice(20, None))) / 2.5 + 0.5
    with pytest.raises(UnreadableFile, match="world landmarks"):
        _read(tmp_path, _csv(MEDIAPIPE, values))
    flat = "time," + ",".join(f"{name}_{axis}" for name in MEDIAPIPE for axis in "xy")
    with pytest.raises(UnreadableFile, match="two dimensions"):
        _read(tmp_path, flat + "\n" + ",".join(["0.1"] * 67) + "\n")


def test_a_table_without_times_is_refused_unless_the_rate_is_named(text_walk, tmp_path):
    text = _csv(text_walk.marker.values, text_walk.values, time="", head="# unit: mm; up: z\n")
    with pytest.raises(UnreadableFile, match=r"read_mocap\(\.\.\., rate_hz="):
        _read(tmp_path, text)
    walk = _read(tmp_path, text, rate_hz=50)
    np.testing.assert_allclose(walk.values, text_walk.values, atol=1e-3)


@quietly
def test_frames_left_out_and_times_that_jitter_are_put_on_an_even_clock(text_walk):
    values = text_walk.values[20:]
    time = np.arange(80) / 50
    file = CaptureFile(Path("a.csv"), b"")
    left_out = np.delete(np.arange(80), [30, 31])
    even = on_even_clock(file, values[left_out], time[left_out])
    assert even.rate_hz == 50
    assert np.isnan(even.positions[30:32]).all()
    np.testing.assert_array_equal(even.positions[32:], values[32:])
    rng = np.random.default_rng(0)
    late = time + np.append(0, rng.uniform(-0.004, 0.004, 79))
    moved = np.stack([np.interp(late, time, v) for v in values.reshape(80, -1).T], axis=1)
    even = on_even_clock(file, moved.reshape(values.shape), late)
    assert even.rate_hz == pytest.approx(50, rel=5e-3)
    assert np.nanmedian(np.abs(even.positions[:78] - values[:78])) < 2


@quietly
def test_data3d_text_gives_its_13_points(text_walk, tmp_path):
    order = [0, *range(2, 8), *range(9, 15)]  # all but sternum and pelvis
    whole = text_walk.isel(time=slice(20, None), marker=order)
    centred = _y_up(whole - whole.mean(dim="marker")) * 1000 / (25.4 / 0.45)
    lines = [" ".join(f"{v:.6f}" for v in row) + " " for frame in centred for row in frame.T]
    walk = _read(tmp_path, "\n".join(lines), "a.data3d.txt", rate_hz=50)
    assert walk.attrs["format"] == "data3d"
    np.testing.assert_allclose(walk.values, (whole - whole.mean(dim="marker")).values, atol=1e-2)
    joints = ew.virtual_markers(walk)
    assert {"sternum", "pelvis"} <= set(joints.attrs["approximate"])
    for bad, told in (
        (lines[:-1], "three lines a frame"),
        (lines[1:] + lines[:1], "heights that fall"),
    ):
        with pytest.raises(UnreadableFile, match=told):
            _read(tmp_path, "\n".join(bad), "a.data3d.txt", rate_hz=50)


def _described(text_walk, layout: str) -> str:
    """x backwards, y up, z to the left: left-handed; in units of 2 cm."""
    values = np.nan_to_num(text_walk.values[..., [0, 2, 1]] * [-1, 1, 1] / 20)
    rows = {
        "interleaved": values.reshape(len(values), -1),
        "planar": values.transpose(0, 2, 1).reshape(len(values), -1),
        "rows": values.transpose(0, 2, 1).reshape(-1, values.shape[1]),
    }[layout]
    return "\n".join(" ".join(f"{v:.7f}" for v in row) for row in rows) + "\n"


@pytest.mark.parametrize("layout", ["interleaved", "planar", "rows"])
def test_any_table_with_a_description_beside_it_is_read(text_walk, tmp_path, layout):
    (tmp_path / "a.toml").write_text(
        f'title = "Walk"\nnames = {json.dumps(text_walk.marker.values.tolist())}\nrate_hz = 50\n'
        f'unit_mm = 20.0\nforward = "-x"\nleft = "z"\nup = "y"\nlayout = "{layout}"\n'
        "zero_is_missing = true\n"
    )
    walk = _read(tmp_path, _described(text_walk, layout), "a.txt")
    np.testing.assert_allclose(walk.values, text_walk.values, atol=1e-4)
    assert (walk.attrs["description"], walk.attrs["title"]) == ("a.toml", "Walk")
    assert not walk.attrs["unit_guessed"]
    assert is_capture(tmp_path / "a.txt")


def test_a_description_can_complete_a_table_that_has_names(text_walk, tmp_path):
    (tmp_path / "a.toml").write_text('rate_hz = 50\nunit = "mm"\nup = "z"\n')
    text = _csv(text_walk.marker.values, text_walk.values, time="", sep=";").replace(".", ",")
    np.testing.assert_allclose(_read(tmp_path, text).values, text_walk.values, atol=1e-4)
    (tmp_path / "a.toml").write_text('time_column = 1\nunit = "mm"\n')
    text = _csv(text_walk.marker.values, text_walk.values)
    assert sampling_rate(_read(tmp_path, text)) == pytest.approx(50)


@pytest.mark.parametrize(
    ("told", "message"),
    [
        ("rate_hz = 0", "rate_hz"),
        ("rate_hz = 1e9", "rate_hz"),
        ("rate_hz = nan", "rate_hz"),
        ('rate_hz = "fast"', "rate_hz as float"),
        ("rate_hz = true", "rate_hz as float"),
        ("rate = 50", "rate"),
        ("rate_hz 50", "TOML"),
        ("a = " + "[" * 10_000, "TOML"),
        ("rate_hz = " + "9" * 5000, "a.toml"),
        ("", "rate_hz or time_column"),
        ('rate_hz = 50\nunit = "furlong"', "furlong"),
        ("rate_hz = 50\nunit_mm = -1", "unit_mm"),
        ('rate_hz = 50\nup = "w"', "up as x"),
        ('rate_hz = 50\nup = "x"\nforward = "-x"', "different axes"),
        ('rate_hz = 50\nlayout = "spiral"', "layout"),
        ('rate_hz = 50\nseparator = "|"', "separator"),
        ("rate_hz = 50\nskip_columns = 1", "columns for the"),
        ("rate_hz = 50\nskip_columns = -1", "leave a table"),
        ("rate_hz = 50\nheader_lines = 999999999", "leave a table"),
        ("rate_hz = 50\ntime_column = 99999", "time_column"),
    ],
)
def test_what_is_wrong_with_a_description_is_told(text_walk, tmp_path, told, message):
    names = f"names = {json.dumps(text_walk.marker.values.tolist())}\n"
    (tmp_path / "a.toml").write_text(names + told + "\n")
    with pytest.raises(UnreadableFile, match=message):
        _read(tmp_path, _described(text_walk, "interleaved"), "a.txt")


def test_numbers_without_names_ask_for_a_description(text_walk, tmp_path):
    with pytest.raises(UnreadableFile, match=r"write a\.toml as docs/formats\.md shows"):
        _read(tmp_path, _described(text_walk, "interleaved"), "a.txt")


def test_damaged_descriptions_end_in_data_or_the_one_error(text_walk, damaged, tmp_path):
    names = json.dumps(text_walk.marker.values.tolist())
    told = f"names = {names}\nrate_hz = 50\nunit_mm = 20.0\nforward = '-x'\nleft = 'z'\nup = 'y'\n"
    (tmp_path / "a.txt").write_text(_described(text_walk.isel(time=slice(9)), "interleaved"))
    outcomes = set()
    for content in damaged(told.encode(), 200):
        (tmp_path / "a.toml").write_bytes(content)
        try:
            outcomes.add(read_mocap(tmp_path / "a.txt", unit="mm").attrs["format"])
        except UnreadableFile:
            outcomes.add("refused")
    assert outcomes == {"described table", "refused"}


def test_in_a_folder_only_tables_of_points_are_meant_as_captures(text_walk, tmp_path):
    files = {
        "walk.csv": (_csv(text_walk.marker.values, text_walk.values), True),
        "people.csv": ("file,sex,weight_kg\nwalk.csv,male,80\n", False),
        "heights.csv": ("Height M 1,Height Cm 1,Height Ft 1\n1.6,160,5.2\n", False),
        "notes.txt": ("Dear colleague, here are the walks.\n", False),
        "poses.json": ('{"frames": [{"landmarks": []}]}', True),
        "settings.json": ('{"colour": 3}', False),
        "broken.trc": ("no", True),
        "film.mp4": ("no", False),
    }
    for name, (text, meant) in files.items():
        (tmp_path / name).write_text(text)
        assert is_capture(tmp_path / name) == meant, name
    assert not is_capture(tmp_path)
    assert not holds_poses(b"", tmp_path)


def test_what_a_table_begins_with():
    assert looks_like_table(b"\xef\xbb\xbf1,5;2,5;3,5\r\n")
    for content in (b"", b"\x00\x01", b"Dear colleague", b"42"):
        assert not looks_like_table(content)
    assert {reader.name for reader in READERS} >= {
        "TRC",
        "STO/MOT",
        "Vicon CSV",
        "Qualisys TSV",
        "table",
    }


@quietly
def test_real_kinect_captures_are_read_and_not_recommended(captures: Path):
    names = sorted(path.name for path in (captures / "kinect").glob("*GeometricPositions*"))
    for name in names[::7]:
        walk = read_mocap(captures / "kinect" / name)
        assert (walk.sizes["marker"], walk.attrs["up_axis"]) == (18, "y")
        joints = ew.virtual_markers(walk)
        assert joints.attrs["marker_set"] == "Kinect"
        quality = ew.assess(joints)
        assert quality.verdict in ("use with care", "do not use")
        assert not quality.sides_swapped
        head, ankle = (joints.sel(marker=name).values for name in ("head", "left_ankle"))
        assert 1200 < np.nanmedian(np.linalg.norm(head - ankle, axis=1)) < 1800


def test_derived_numbers_beside_kinect_captures_are_refused_helpfully(captures: Path):
    path = captures / "kinect" / "subject10_Seq_1_Gen_M_Height_N.csv"
    with pytest.raises(UnreadableFile, match="take the table of positions from which they come"):
        read_mocap(path)
    assert not is_capture(path)


def test_the_real_data3d_text_is_a_walk(captures: Path):
    with pytest.warns(RateAssumed, match="120"):
        walk = read_mocap(captures / "cmu" / "07_01.data3d.txt")
    assert walk.shape == (316, 13, 3)
    joints = ew.virtual_markers(walk)
    quality = ew.assess(joints)
    assert not quality.sides_swapped
    assert quality.r2 > 0.97
    assert quality.frequency_hz == pytest.approx(0.89, abs=0.05)


def test_the_sample_walker_is_read_as_its_description_tells(captures: Path, tmp_path):
    text = (Path(__file__).parents[2] / "docs" / "sample_walker3.toml").read_text()
    (tmp_path / "sample_walker3.toml").write_text(text)
    source = captures / "delussanet" / "sample_walker3.txt"
    (tmp_path / "sample_walker3.txt").write_bytes(source.read_bytes())
    walk = read_mocap(tmp_path / "sample_walker3.txt")
    assert walk.shape == (99, 16, 3)
    numbers = np.loadtxt(source).reshape(99, 16, 3) / 100
    np.testing.assert_allclose(walk.values[..., 0], numbers[..., 0])
    np.testing.assert_allclose(walk.values[..., 2], numbers[..., 1])
    np.testing.assert_allclose(walk.values[..., 1], -numbers[..., 2])
    joints = ew.virtual_markers(walk)
    left, right = (joints.sel(marker=f"{side}_hip").values for side in ("left", "right"))
    assert (left[:, 1] > right[:, 1]).all()
    assert not ew.assess(joints).sides_swapped


def test_unit_guesses_of_tables_are_warned_of(text_walk, tmp_path):
    with pytest.warns(UnitGuessed):
        _read(tmp_path, _csv(text_walk.marker.values, _y_up(text_walk)))
    text = _csv(text_walk.marker.values, _y_up(text_walk)).encode()
    walk = read_skeleton_table(CaptureFile(Path("a.csv"), b"# unit: m\n" + text))
    assert not walk.attrs["unit_guessed"]


def test_the_example_in_the_documentation_is_the_description_that_is_tested():
    docs = Path(__file__).parents[2] / "docs"
    told = tomllib.loads((docs / "sample_walker3.toml").read_text())
    text = (docs / "formats.md").read_text()
    shown = text[text.index("```toml") + 7 :]
    assert tomllib.loads(shown[: shown.index("```")]) == told


@quietly
@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("a.csv", b"a_x," * 100_000 + b"\n1"),
        ("a.csv", b"# " + b"a" * 500_000 + b"\nb,c\n1,2"),
        ("a.csv", b"a" * 500_000 + b"_x,b\n1,2"),
        ("a.csv", b"," * 500_000),
        ("a.json", b'[{"' + b"keypoints" * 50_000),
        ("a.tsv", b" " * 500_000),
        ("a.tsv", b"NO_OF_FRAMES\t1\nMARKER_NAMES" + b"\ta" * 100_000 + b"\n1"),
        ("a.sto", b"endheader\n" + b"time," + b"a_x," * 100_000 + b"\n1"),
        ("a.trc", b"PathFileType\n" + b"NumFrames " * 50_000 + b"\n1 " * 50_000),
        ("a.txt", b"1 " * 500_000),
    ],
)
def test_wide_and_repeated_text_is_refused_at_once(tmp_path, name, content):
    (tmp_path / name).write_bytes(content)
    is_capture(tmp_path / name)
    with pytest.raises(UnreadableFile) as refusal:
        read_mocap(tmp_path / name)
    assert len(str(refusal.value)) < 1000
