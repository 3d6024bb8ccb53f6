"""ASF/AMC: poses worked out by hand, an independent chain of matrices, a real walk, damage."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import eigenwalker as ew
from eigenwalker.core.trajectories import sampling_rate
from eigenwalker.io.capture_file import CaptureFile, RateAssumed
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.read import read_mocap
from eigenwalker.io.readers.acclaim_grammar import parse_amc, parse_asf
from eigenwalker.io.readers.asf_amc import find_skeleton
from eigenwalker.io.up_axis_and_unit import UnitGuessed
from eigenwalker.markers.virtual_markers import virtual_markers

ASF = """# a body of four bones
:version 1.10
:name tiny
:units
  mass 1.0
  length 0.45
  angle deg
:documentation
   (bones hang, the foot points forward)
:root
   order TX TY TZ RX RY RZ
   axis XYZ
   position 0 0 0
   orientation 0 0 0
:bonedata
  begin
     id 1
     name head
     direction 0 1 0
     length 12
     axis 0 0 0 XYZ
    dof rx ry rz
    limits (-20.0 45.0)
           (-30.0 30.0)
           (-30.0 30.0)
  end
  begin
     id 2
     name lfemur
     direction 0 -1 0
     length 8
     axis 0 0 0 XYZ
    dof rx ry rz
  end
  begin
     id 3
     name ltibia
     direction 0 -1 0
     length 8
     axis 0 90 0 XYZ
    dof rx
  end
  begin
     id 4
     name lfoot
     direction 0 0 1
     length 2
     axis 0 0 0 XYZ
  end
:hierarchy
  begin
    root head lfemur
    lfemur ltibia
    ltibia lfoot
  end
"""
AMC = """#!OML:ASF tiny.ASF
:FULLY-SPECIFIED
:DEGREES
1
root 1.00 17.00 3.00 0.00 0.00 0.00
head 0.00 0.00 0.00
lfemur 0.00 0.00 0.00
ltibia 0.00
2
root 1.00 17.00 4.00 0.00 90.00 0.00
head 0.00 0.00 0.00
lfemur -90.00 0.00 0.00
ltibia 90.00
"""
MM = 25.4 / 0.45


def _write(folder: Path, *, asf: str | None = ASF, amc: str = AMC) -> Path:
    if asf is not None:
        (folder / "07.asf").write_text(asf)
    path = folder / "07_01.amc"
    path.write_text(amc)
    return path


def _read(folder: Path, *, asf: str | None = ASF, amc: str = AMC, **options):
    return read_mocap(_write(folder, asf=asf, amc=amc), **{"rate_hz": 120, **options})


def test_positions_are_those_worked_out_by_hand(tmp_path):
    walk = _read(tmp_path)
    assert walk.marker.values.tolist() == ["root", "head", "lfemur", "ltibia", "lfoot"]
    # A y-up body that faces z: forward z is x, left x is y, up y is z.
    np.testing.assert_allclose(
        walk.values[0] / MM,
        [[3, 1, 17], [3, 1, 29], [3, 1, 9], [3, 1, 1], [5, 1, 1]],
        atol=1e-9,
    )
    # It turned to its left and so faces y; the thigh is level. The shank's own x axis, by its axis
    # entry, points backward at rest (-z of the file): turning about it moves the shank sidewards,
    # from y (along the thigh) to up.
    np.testing.assert_allclose(
        walk.values[1, :3] / MM, [[4, 1, 17], [4, 1, 29], [4, 9, 17]], atol=1e-9
    )
    shank = (walk.values[1, 3] - walk.values[1, 2]) / MM
    np.testing.assert_allclose(np.linalg.norm(shank), 8)
    np.testing.assert_allclose(shank, [8, 0, 0], atol=1e-9)


def test_orientations_and_positions_tell_the_same_in_the_turned_room(tmp_path):
    walk = _read(tmp_path)
    for bone, parent, rest in (("ltibia", "lfemur", [0, -8, 0]), ("lfoot", "ltibia", [0, 0, 2])):
        turn = Rotation.from_rotvec(walk["rotation"].sel(marker=bone).values)
        reach = walk.sel(marker=bone).values - walk.sel(marker=parent).values
        np.testing.assert_allclose(turn.apply(rest) * MM, reach, atol=1e-9)


def test_what_is_told_and_what_is_assumed_is_said(tmp_path):
    with pytest.warns(RateAssumed, match=r"07_01\.amc names no frame rate; 120"):
        walk = _read(tmp_path, rate_hz=None)
    assert sampling_rate(walk) == pytest.approx(120)
    told = {"format": "ASF/AMC", "skeleton": "07.asf", "unit": "asf", "unit_guessed": False}
    assert told.items() <= walk.attrs.items()
    assert walk.attrs["rate_assumed"]
    named = _read(tmp_path, rate_hz=60)
    assert sampling_rate(named) == pytest.approx(60)
    assert not named.attrs["rate_assumed"]
    in_file = AMC.replace(":DEGREES", ":DEGREES\n:SAMPLES-PER-SECOND 100")
    assert sampling_rate(_read(tmp_path, amc=in_file, rate_hz=None)) == pytest.approx(100)


def test_lengths_are_inches_over_the_unit_of_the_skeleton_or_named_or_guessed(tmp_path):
    tall = _read(tmp_path).sel(marker="head", axis="z").values[0]
    inches = ASF.replace("length 0.45", "length 0.5")
    assert _read(tmp_path, asf=inches).sel(marker="head", axis="z").values[0] == pytest.approx(
        tall * 0.9
    )
    named = _read(tmp_path, unit="in").sel(marker="head", axis="z").values[0]
    assert named == pytest.approx(29 * 25.4)
    for other in ("length 1000.0", "", "length 0"):
        with pytest.warns(UnitGuessed, match=r"07\.asf names no unit"):
            guessed = _read(tmp_path, asf=ASF.replace("length 0.45", other))
        assert guessed.attrs["unit_guessed"]
        assert guessed.sel(marker="head", axis="z").values[0] == pytest.approx(tall)


def test_angles_may_be_radians_in_either_file(tmp_path):
    expected = _read(tmp_path).values
    radians = AMC.replace("90.00", f"{np.pi / 2!r}").replace(":DEGREES\n", "")
    turned = ASF.replace("angle deg", "angle rad").replace("axis 0 90 0", f"axis 0 {np.pi / 2} 0")
    np.testing.assert_allclose(_read(tmp_path, asf=turned, amc=radians).values, expected)
    np.testing.assert_allclose(_read(tmp_path, asf=turned).values, expected)
    said = radians.replace(":FULLY", ":RADIANS\n:FULLY")
    np.testing.assert_allclose(_read(tmp_path, amc=said).values, expected)


def test_blanks_comments_and_case_do_not_matter(tmp_path):
    expected = _read(tmp_path).values
    spread = ASF.replace("direction 0 -1 0", "direction (0, -1, 0) # down").replace("\n", "\r\n")
    np.testing.assert_array_equal(_read(tmp_path, asf=spread).values, expected)
    shouted = AMC.replace("lfemur", "LFEMUR").replace("\n", "\n\n").replace(" ", "\t")
    np.testing.assert_array_equal(_read(tmp_path, amc=shouted).values, expected)
    np.testing.assert_array_equal(_read(tmp_path, amc=AMC.strip()).values, expected)


def test_a_bone_that_the_motion_leaves_out_stays_as_it_rests(tmp_path):
    still = "\n".join(line for line in AMC.splitlines() if not line.startswith("head")) + "\n"
    np.testing.assert_array_equal(_read(tmp_path, amc=still).values, _read(tmp_path).values)


def _by_matrices(asf: str, amc: str, frame: int) -> dict[str, np.ndarray]:
    """Positions by the textbook chain of 4 x 4 matrices, one bone after the other."""

    def turn(letters: str, degrees) -> np.ndarray:
        whole = np.eye(4)
        for letter, angle in zip(letters, np.radians(degrees), strict=True):
            c, s = np.cos(angle), np.sin(angle)
            i, j = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[letter]
            one = np.eye(4)
            one[i, i] = one[j, j] = c
            one[i, j], one[j, i] = -s, s
            whole = one @ whole
        return whole

    def shift(by) -> np.ndarray:
        moved = np.eye(4)
        moved[:3, 3] = by
        return moved

    skeleton = parse_asf(CaptureFile(Path("a"), asf.encode()))
    motion = parse_amc(CaptureFile(Path("b"), amc.encode()))
    world: list[np.ndarray] = []
    ends = {}
    for bone in skeleton.bones:
        values = motion.channels.get(bone.name.lower())
        values = np.zeros(0) if values is None else values[frame]
        letters = "".join(channel[1] for channel in bone.channels if channel[0] == "r")
        angles = values[len(values) - len(letters) :]
        own = turn(bone.axis_order, bone.axis)
        if bone.parent < 0:
            start = shift(values[:3]) @ turn(letters, angles)
        else:
            parent = skeleton.bones[bone.parent]
            local = own @ turn(letters[: len(angles)], angles) @ np.linalg.inv(own)
            start = world[bone.parent] @ shift(parent.reach) @ local
        world.append(start)
        ends[bone.name] = (start @ shift(bone.reach))[:3, 3]
    return ends


def test_a_real_walk_agrees_with_a_chain_of_matrices(captures: Path):
    asf = (captures / "cmu" / "35.asf").read_text()
    amc = (captures / "cmu" / "35_01.amc").read_text()
    walk = read_mocap(captures / "cmu" / "35_01.amc", rate_hz=120)
    assert walk.shape == (358, 31, 3)
    for frame in (0, 100, 357):
        for name, (x, y, z) in _by_matrices(asf, amc, frame).items():
            ours = walk.sel(marker=name).values[frame] / MM
            np.testing.assert_allclose(ours, [z, x, y], atol=1e-9)


def test_a_real_walk_is_one_of_a_grown_person(captures: Path):
    walk = read_mocap(captures / "cmu" / "35_01.amc", rate_hz=120)
    joints = virtual_markers(walk, joints="full")
    assert joints.attrs["marker_set"] == "skeleton of Acclaim (ASF)"
    assert joints.attrs["approximate"] == []
    assert {"left_toe", "right_hand", "head_top"} <= set(joints.marker.values.tolist())

    def length(one: str, other: str) -> float:
        between = joints.sel(marker=one).values - joints.sel(marker=other).values
        return float(np.linalg.norm(between, axis=1).mean())

    for side in ("left", "right"):
        assert 380 < length(f"{side}_hip", f"{side}_knee") < 480
        assert 380 < length(f"{side}_knee", f"{side}_ankle") < 480
        assert 250 < length(f"{side}_shoulder", f"{side}_elbow") < 330
        assert 180 < length(f"{side}_elbow", f"{side}_wrist") < 280
    joints = virtual_markers(walk)
    in_place = ew.in_place(joints)
    walker = ew.decompose_fourier(in_place)
    assert walker.fit is not None
    assert walker.fit.r2 > 0.98
    assert ew.decompose_fourier(in_place, n_harmonics=3).fit.r2 > 0.988
    assert 0.85 < walker.frequency_hz < 0.95
    assert 1200 < in_place.attrs["speed_mm_s"] < 1400


@pytest.mark.parametrize(
    ("present", "motion", "taken"),
    [
        (["35.asf", "36.asf"], "35_01.amc", "35.asf"),
        (["3.asf", "35.asf"], "35_01.amc", "35.asf"),
        (["35.asf", "35_01.asf"], "35_01.amc", "35_01.asf"),
        (["HDM_bd.ASF", "HDM_b.asf"], "HDM_bd_01-01_01_120.amc", "HDM_bd.ASF"),
        (["somebody.asf"], "35_01.amc", "somebody.asf"),
        (["35.asf"], "35.amc", "35.asf"),
    ],
)
def test_the_skeleton_is_found_beside_the_motion(tmp_path, present, motion, taken):
    for name in present:
        (tmp_path / name).write_text(ASF)
    assert find_skeleton(tmp_path / motion).name == taken


def test_a_skeleton_that_is_not_there_is_asked_for(tmp_path):
    with pytest.raises(UnreadableFile, match=r"but got none; copy its skeleton .* 07_01\.asf"):
        _read(tmp_path, asf=None)
    for name in ("08.asf", "09.asf"):
        (tmp_path / name).write_text(ASF)
    with pytest.raises(UnreadableFile, match=r"2 of other names; name its skeleton 07_01\.asf"):
        _read(tmp_path, asf=None)


def test_a_skeleton_alone_asks_for_the_motion(tmp_path):
    _write(tmp_path)
    with pytest.raises(UnreadableFile, match=r"07\.asf: expected a motion .* skeleton alone"):
        read_mocap(tmp_path / "07.asf")


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("length 12", "length twelve", "length of head"),
        ("length 12", "length -1", "length of head"),
        ("length 12", "", "'length'"),
        ("direction 0 1 0", "direction 0 1", "direction of head"),
        ("direction 0 1 0", "direction 0 0 0", "along a direction"),
        ("direction 0 1 0", "direction 0 nan 0", "direction of head"),
        ("axis 0 90 0 XYZ", "axis 0 90 0 XXZ", "order of axes"),
        ("axis 0 90 0 XYZ", "axis 0 90", "axis of ltibia"),
        ("dof rx ry rz\n    limits", "dof rx ry tz\n    limits", "C3D"),
        ("order TX TY TZ RX RY RZ", "order TX TY TZ RX RY RX", "once at most for root"),
        ("name lfoot", "name head", "twice"),
        ("lfemur ltibia", "lfemur ltibia head", "several for 'head'"),
        ("lfemur ltibia", "lfemur lshank", "lshank"),
        ("    ltibia lfoot\n", "", "none for .'lfoot'"),
        ("root head lfemur\n", "lfoot lfemur\n    root head\n", "hierarchy"),
        (":hierarchy", "", "hierarchy"),
        (":bonedata", "", "bonedata"),
        ("ltibia lfoot\n  end", "ltibia lfoot", "cut short"),
        ("length 0.45", "length much", "unit of length"),
    ],
)
def test_what_is_wrong_with_a_skeleton_is_told(tmp_path, old, new, told):
    assert old in ASF
    with pytest.raises(UnreadableFile, match=told) as refusal:
        _read(tmp_path, asf=ASF.replace(old, new))
    assert str(refusal.value).startswith("07.asf: expected ")


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("17.00 4.00", "nan 4.00", "root in frame no. 2"),
        ("17.00 4.00", "17,00 4.00", "decimal point"),
        ("17.00 4.00", "1e300 4.00", "root in frame no. 2"),
        ("17.00 4.00", "17.00", "5 in its frame no. 2"),
        ("\n2\n", "\n3\n", "frame 2 after 1"),
        ("\n2\n", "\n", "each frame|another bone"),
        ("\n1\n", "\n", "number of a frame"),
        ("lfemur -90", "rfemur -90", "'lfemur' once"),
        ("lfemur", "lthigh", "lthigh"),
        ("ltibia 0.00\n", "", "frame 2"),
        ("ltibia 90.00", "ltibia 9", "last number"),
        (":DEGREES", ":DEGREES\n:SAMPLES-PER-SECOND 0", "samples-per-second"),
    ],
)
def test_what_is_wrong_with_a_motion_is_told(tmp_path, old, new, told):
    assert old in AMC
    amc = AMC.replace(old, new)
    amc = amc.strip() if "last" in told else amc
    with pytest.raises(UnreadableFile, match=told) as refusal:
        _read(tmp_path, amc=amc, rate_hz=None)
    assert str(refusal.value).startswith("07_01.amc: expected ")


def test_a_skeleton_with_other_freedoms_is_refused(tmp_path):
    with pytest.raises(UnreadableFile, match="3 numbers of ltibia"):
        _read(tmp_path, asf=ASF.replace("dof rx\n", "dof rx ry rz\n"))


def test_files_cut_within_a_frame_are_refused(tmp_path):
    second = AMC.index("\n2\n") + 3
    for length in range(second, len(AMC) - 2):
        with pytest.raises(UnreadableFile):
            _read(tmp_path, amc=AMC[:length])
    for length in range(0, len(ASF) - 5, 7):
        with pytest.raises(UnreadableFile):
            _read(tmp_path, asf=ASF[:length])


def test_damaged_files_end_in_data_or_the_one_error(tmp_path):
    rng = np.random.default_rng(0)
    letters = np.frombuffer(b":#begindo \n 0123456789.eE-+naifx(),", dtype=np.uint8)
    outcomes = set()
    for number in range(400):
        texts = {"asf": ASF, "amc": AMC}
        name = ("asf", "amc")[number % 2]
        damaged = bytearray(texts[name].encode())
        for _ in range(rng.integers(1, 4)):
            at = int(rng.integers(len(damaged)))
            if rng.random() < 0.5:
                damaged[at] = int(rng.choice(letters))
            else:
                del damaged[at : at + int(rng.integers(1, 30))]
        texts[name] = damaged.decode()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UnitGuessed)
            try:
                walk = _read(tmp_path, **texts)
            except UnreadableFile:
                outcomes.add("refused")
            else:
                assert np.isfinite(walk.values).all()
                outcomes.add("read")
    assert outcomes == {"read", "refused"}
