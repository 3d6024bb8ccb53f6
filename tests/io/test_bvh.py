from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from scipy.spatial.transform import Rotation

from eigenwalker.core.trajectories import sampling_rate
from eigenwalker.io.capture_file import CaptureFile
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.read import read_mocap
from eigenwalker.io.readers.bvh import read_bvh
from eigenwalker.io.up_axis_and_unit import UNITS, Unit, UnitGuessed

CM = Unit("cm", 10.0)
BODY = """HIERARCHY
ROOT Hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Head
  {
    OFFSET 0 60 0
    CHANNELS 3 Yrotation Zrotation Xrotation
    End Site
    {
      OFFSET 0 20 0
    }
  }
  JOINT LeftFoot
  {
    OFFSET 10 -90 0
    CHANNELS 1 Xrotation
    End Site
    {
      OFFSET 0 0 15
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.0333333
"""
ROWS = """1.00 95.00 3.00 0.00 0.00 0.00 0.00 0.00 0.00 0.00
1.00 95.00 4.00 0.00 0.00 90.00 0.00 90.00 0.00 -90.00
"""


def _read(text: str, unit: Unit | None = CM):
    return read_bvh(CaptureFile(Path("a.bvh"), text.encode(), unit=unit))


def test_positions_are_those_worked_out_by_hand():
    walk = _read(BODY + ROWS)
    assert walk.marker.values.tolist() == ["Hips", "Head", "Head_end", "LeftFoot", "LeftFoot_end"]
    # A y-up body that faces z: forward z is x, left x is y, up y is z.
    np.testing.assert_allclose(
        walk.values[0],
        [[30, 10, 950], [30, 10, 1550], [30, 10, 1750], [30, 110, 50], [180, 110, 50]],
    )
    # Turned to its left, so that it faces y; the head leans to its right, the toes point up.
    np.testing.assert_allclose(
        walk.values[1],
        [[40, 10, 950], [40, 10, 1550], [240, 10, 1550], [-60, 10, 50], [-60, 10, 200]],
        atol=1e-9,
    )


def test_rotations_are_those_of_the_joints_in_the_turned_room():
    walk = _read(BODY + ROWS)
    turns = Rotation.from_rotvec(walk["rotation"].sel(marker="Hips").values)
    forward, left, up = ([0, 0, 1], [1, 0, 0], [0, 1, 0])  # of the Hips in their own frame
    np.testing.assert_allclose(turns[0].apply([forward, left, up]), np.eye(3), atol=1e-9)
    np.testing.assert_allclose(
        turns[1].apply([forward, left, up]), [[0, 1, 0], [-1, 0, 0], [0, 0, 1]], atol=1e-9
    )


def test_end_sites_reach_along_the_rotation_of_their_joint():
    walk = _read(BODY + ROWS)
    foot = Rotation.from_rotvec(walk["rotation"].sel(marker="LeftFoot").values)
    reach = walk.sel(marker="LeftFoot_end").values - walk.sel(marker="LeftFoot").values
    np.testing.assert_allclose(foot.apply([0, 0, 150]), reach, atol=1e-9)


@pytest.mark.parametrize(
    ("written", "rate"),
    [
        ("0.0333333", 30),
        ("0.033333", 30),
        ("0.033", 30),
        (".0083333", 120),
        ("0.008333", 120),
        ("0.00833", 120),
        ("0.0083333337679505348", 120),
        ("0.01", 100),
        ("0.005", 200),
        ("0.016667", 60),
        ("0.017", 60),
        ("0.0333667", 30000 / 1001),
        ("0.04", 25),
        ("1e-2", 100),
        ("0.0142857", 1 / 0.0142857),
    ],
)
def test_rounded_frame_times_give_the_rate_that_was_meant(written, rate):
    walk = _read(BODY.replace("0.0333333", written) + ROWS)
    assert sampling_rate(walk) == pytest.approx(rate, rel=1e-9)


def test_positions_of_inner_joints_replace_their_offset():
    text = (BODY + ROWS).replace(
        "CHANNELS 3 Yrotation Zrotation Xrotation",
        "CHANNELS 6 Xposition Yposition Zposition Yrotation Zrotation Xrotation",
    )
    text = text.replace("0.00 0.00 0.00 0.00\n", "0 62 0 0 0 0 0\n").replace(
        "0.00 90.00 0.00 -90.00\n", "0 62 0 0 90 0 -90\n"
    )
    walk = _read(text)
    np.testing.assert_allclose(walk.sel(marker="Head").values[:, 2], 1570)


def test_positions_of_inner_joints_near_zero_add_to_their_offset():
    text = (BODY + ROWS).replace(
        "CHANNELS 3 Yrotation Zrotation Xrotation",
        "CHANNELS 6 Xposition Yposition Zposition Yrotation Zrotation Xrotation",
    )
    text = text.replace("0.00 0.00 0.00 0.00\n", "0 2 0 0 0 0 0\n").replace(
        "0.00 90.00 0.00 -90.00\n", "0 2 0 0 90 0 -90\n"
    )
    walk = _read(text)
    np.testing.assert_allclose(walk.sel(marker="Head").values[:, 2], 1570)


@pytest.mark.parametrize("order", ["XYZ", "ZYX", "YXZ", "ZXY", "YZX", "XZY"])
def test_channels_turn_in_the_order_in_which_they_stand(order):
    channels = " ".join(f"{axis}rotation" for axis in order)
    text = BODY.replace("Zrotation Xrotation Yrotation", channels)
    row = "0 95 0 20 -35 50 0 0 0 0\n"
    walk = _read(text + row + row)
    turn = Rotation.from_euler(order, [20, -35, 50], degrees=True)
    x, y, z = turn.apply([0, 60, 0])
    expected = np.array([z, x, y + 95]) * 10
    np.testing.assert_allclose(walk.sel(marker="Head").values[0], expected, atol=1e-9)


@pytest.mark.parametrize(
    ("rows", "up"), [("0 0 95 0 90 0 0 0 0 0\n", "z"), ("0 -95 0 180 0 0 0 0 0 0\n", "-y")]
)
def test_up_is_where_the_head_is(rows, up):
    walk = _read(BODY + rows + rows)
    assert walk.attrs["up_axis"] == up
    heights = walk.sel(marker=["LeftFoot", "Head"]).values[0, :, 2]
    np.testing.assert_allclose(heights, [50, 1550], atol=1e-9)


@settings(max_examples=30, deadline=None)
@given(st.tuples(*[st.floats(-170, 170)] * 3))
def test_orientations_and_positions_tell_the_same_in_the_turned_room(angles):
    row = "0 95 0 0 0 0 {} {} {} 0\n".format(*angles)
    walk = _read(BODY + row + row)
    turn = Rotation.from_rotvec(walk["rotation"].sel(marker="Head").values[0])
    reach = walk.sel(marker="Head_end").values[0] - walk.sel(marker="Head").values[0]
    np.testing.assert_allclose(turn.apply([0, 200, 0]), reach, atol=1e-9)


@pytest.mark.parametrize("name", sorted(UNITS))
def test_the_unit_is_told_from_the_height_of_the_body(name):
    factor = 10 / UNITS[name]
    rows = f"0 {95 * factor} 0 0 0 0 0 0 0 0\n" * 2
    body = BODY
    for length in (60, 20, 10, -90, 15):
        body = body.replace(f" {length} ", f" {length * factor} ").replace(
            f" {length}\n", f" {length * factor}\n"
        )
    with pytest.warns(UnitGuessed, match=r"a\.bvh names no unit"):
        walk = _read(body + rows, unit=None)
    assert walk.attrs["unit"] == name
    assert walk.attrs["unit_guessed"]
    assert walk.sel(marker="Head").values[0, 2] == pytest.approx(1550)


def test_a_named_unit_is_no_guess():
    assert not _read(BODY + ROWS).attrs["unit_guessed"]


def test_text_between_words_does_not_matter():
    spread = (BODY + ROWS).replace("{", "\n\n{\n").replace("  ", "\t").replace("\n", "\r\n")
    together = BODY.replace("\n", " ").replace("MOTION", "\nMOTION").replace(" Frame ", "\nFrame ")
    for text in (spread, "\ufeff" + BODY + ROWS, together + "\n" + ROWS, BODY + ROWS.strip() + " "):
        np.testing.assert_array_equal(_read(text).values, _read(BODY + ROWS).values)


def test_joints_of_the_same_name_are_numbered():
    walk = _read((BODY + ROWS).replace("JOINT LeftFoot", "JOINT Head"))
    assert walk.marker.values.tolist() == ["Hips", "Head", "Head_end", "Head_2", "Head_end_2"]


def test_several_people_keep_their_joints_apart():
    head, table = BODY.split("MOTION")
    body = head.removeprefix("HIERARCHY\n")
    row = ROWS.splitlines()[0]
    walk = _read(f"{head}{body}MOTION{table}{row} {row}\n{row} {row}\n")
    names = ["Hips", "Head", "Head_end", "LeftFoot", "LeftFoot_end"]
    assert walk.marker.values.tolist() == [f"{who}:{name}" for who in (1, 2) for name in names]


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("Frames: 2", "Frames: 3", "3 frames"),
        ("Frames: 2", "Frames: 1", "1 frames"),
        ("Frames: 2", "Frames: 999999999", "cut short"),
        ("Frames: 2", "Frames: 99999999999999999999", "Frames"),
        ("Frames: 2", "Frames: -2", "Frames"),
        ("Frames: 2", "Frames: two", "Frames"),
        ("0.0333333", "0", "frame time"),
        ("0.0333333", "-1", "frame time"),
        ("0.0333333", "nan", "frame time"),
        ("95.00 3.00", "95.00", "9 in frame 1"),
        ("95.00 3.00", "95.00 3.00 3.00", "11 in frame 1"),
        ("95.00 4.00", "95.00 nan", "frame 2"),
        ("95.00 4.00", "95.00 inf", "frame 2"),
        ("95.00 4.00", "95.00 1e300", "frame 2"),
        ("95.00 4.00", "95,00 4,00", "decimal point"),
        ("95.00 4.00", "95.00 four", "four"),
        ("95.00 4.00", "95.00 1_0", "1_0"),
        ("OFFSET 0 60 0", "OFFSET 0 sixty 0", "OFFSET"),
        ("OFFSET 0 60 0", "OFFSET 0 60", "OFFSET"),
        ("CHANNELS 1 Xrotation", "CHANNELS 1 Wrotation", "Wrotation"),
        ("CHANNELS 1 Xrotation", "CHANNELS 99999999 Xrotation", "CHANNELS"),
        ("Zrotation Xrotation Yrotation", "Zrotation Xrotation Zrotation", "each once"),
        ("ROOT", "TREE", "TREE"),
        ("MOTION", "", "MOTION"),
        ("}\nMOTION", "MOTION", "closed"),
        ("HIERARCHY", "", "HIERARCHY"),
    ],
)
def test_what_is_wrong_with_a_file_is_told(old, new, told):
    with pytest.raises(UnreadableFile, match=told) as refusal:
        _read((BODY + ROWS).replace(old, new))
    assert str(refusal.value).startswith("a.bvh: expected ")


def test_deep_nesting_and_too_many_joints_are_refused_at_once():
    deep = "HIERARCHY\nROOT a\n{\n" + "JOINT b\n{\n" * 100_000
    for text in (deep, deep + "}" * 100_001 + "\nMOTION\nFrames: 1\nFrame Time: 1\n"):
        with pytest.raises(UnreadableFile):
            _read(text)


CAPTURES = ["cmu/12_01.bvh", "bandai-namco/dataset-2_walk_active_001.bvh"]


@pytest.mark.parametrize("name", CAPTURES)
def test_real_captures_agree_with_bvhio(captures: Path, name):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PendingDeprecationWarning)  # of the vectors it imports
        import bvhio
    path = captures / name
    walk = read_bvh(CaptureFile(path, path.read_bytes(), unit=CM))
    body = bvhio.readAsHierarchy(str(path))
    for frame in (0, 40, walk.sizes["time"] - 1):
        body.loadPose(frame)
        for joint, _, _ in body.layout():
            if joint.Name in walk.marker.values:
                x, y, z = np.array(joint.PositionWorld)
                ours = walk.sel(marker=joint.Name).values[frame] / 10
                np.testing.assert_allclose(ours, [z, x, y], atol=1e-3)


def test_real_captures_have_the_units_and_rates_of_their_readme(captures: Path):
    expected = {CAPTURES[0]: ("asf", 120), CAPTURES[1]: ("cm", 30)}
    for name, (unit, rate) in expected.items():
        with pytest.warns(UnitGuessed):
            walk = read_mocap(captures / name)
        assert (walk.attrs["unit"], walk.attrs["up_axis"]) == (unit, "y")
        assert sampling_rate(walk) == pytest.approx(rate)


def test_real_captures_cut_short_are_refused(captures: Path):
    whole = (captures / CAPTURES[1]).read_bytes()
    for percent in range(1, 100, 3):
        with pytest.raises(UnreadableFile):
            read_bvh(CaptureFile(Path("a.bvh"), whole[: len(whole) * percent // 100], unit=CM))
