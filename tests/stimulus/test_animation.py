"""Figures for animators: read back by hand and by other programs."""

from __future__ import annotations

import json
import struct

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from eigenwalker.core.skeleton import JOINTS
from eigenwalker.datasets.built_in import load_population
from eigenwalker.io.read import read_mocap
from eigenwalker.stimulus.animation import RigChoices, animated
from eigenwalker.stimulus.make import make_stimulus
from eigenwalker.stimulus.stimulus import Stimulus
from eigenwalker.stimulus.write_stimulus import write_stimulus

COMPONENTS = {5126: "<f4", 5123: "<u2"}
SHAPES = {"SCALAR": (), "VEC3": (3,), "VEC4": (4,), "MAT4": (16,)}


@pytest.fixture(scope="module")
def shown() -> Stimulus:
    people = load_population()
    return make_stimulus(people.walker(people.average), duration_s=3)


class Glb:
    """A glTF file, read by the letter of the format."""

    def __init__(self, data: bytes) -> None:
        magic, version, length = struct.unpack_from("<4sII", data)
        assert (magic, version, length) == (b"glTF", 2, len(data))
        size, kind = struct.unpack_from("<I4s", data, 12)
        assert kind == b"JSON"
        self.content = json.loads(data[20 : 20 + size])
        assert data[24 + size : 28 + size] == b"BIN\0"
        self.binary = data[28 + size :]
        self.nodes = self.content["nodes"]

    def array(self, number: int) -> np.ndarray:
        accessor = self.content["accessors"][number]
        view = self.content["bufferViews"][accessor["bufferView"]]
        shape = (accessor["count"], *SHAPES[accessor["type"]])
        start, count = view["byteOffset"], int(np.prod(shape))
        return np.frombuffer(
            self.binary, COMPONENTS[accessor["componentType"]], count, start
        ).reshape(shape)

    def matrices(self, frame: int) -> dict[int, np.ndarray]:
        """Where each node is in the scene at a frame, as matrices."""
        local = {number: dict(node) for number, node in enumerate(self.nodes)}
        animation = self.content["animations"][0]
        for channel in animation["channels"]:
            values = self.array(animation["samplers"][channel["sampler"]]["output"])
            local[channel["target"]["node"]][channel["target"]["path"]] = values[frame]
        placed: dict[int, np.ndarray] = {}

        def place(number: int, above: np.ndarray) -> None:
            matrix = np.eye(4)
            turn = Rotation.from_quat(local[number].get("rotation", [0, 0, 0, 1])).as_matrix()
            matrix[:3, :3] = turn * np.array(local[number].get("scale", [1, 1, 1]))
            matrix[:3, 3] = local[number].get("translation", [0, 0, 0])
            placed[number] = above @ matrix
            for child in local[number].get("children", []):
                place(child, placed[number])

        for root in self.content["scenes"][0]["nodes"]:
            place(root, np.eye(4))
        return placed


def test_a_glb_plays_the_joints_in_metres_y_up_z_forward(shown, tmp_path):
    glb = Glb(write_stimulus(shown, tmp_path / "walk.glb").read_bytes())
    walk = animated(shown).walk
    names = {node["name"]: number for number, node in enumerate(glb.nodes)}
    sampler = glb.content["animations"][0]["samplers"][0]["input"]
    np.testing.assert_allclose(glb.array(sampler), walk.time.values, atol=1e-6)
    for frame in (0, 50, 179):
        placed = glb.matrices(frame)
        for joint in JOINTS.markers:
            x, y, z = walk.sel(marker=joint).values[frame] / 1000
            np.testing.assert_allclose(placed[names[joint]][:3, 3], [y, z, x], atol=2e-5)


def test_bones_of_a_glb_are_constant_and_its_body_follows_them(shown, tmp_path):
    glb = Glb(write_stimulus(shown, tmp_path / "walk.glb").read_bytes())
    channels = glb.content["animations"][0]["channels"]
    moved = [c["target"]["node"] for c in channels if c["target"]["path"] == "translation"]
    assert moved == [2]  # the root alone
    skin = glb.content["skins"][0]
    attributes = glb.content["meshes"][0]["primitives"][0]["attributes"]
    corners = glb.array(attributes["POSITION"])
    corners = np.column_stack([corners, np.ones(len(corners))])
    inverse = glb.array(skin["inverseBindMatrices"]).reshape(-1, 4, 4).transpose(0, 2, 1)
    carriers = glb.array(attributes["JOINTS_0"])[:, 0]
    placed = glb.matrices(30)
    world = np.stack([placed[node] for node in skin["joints"]])
    skinned = np.einsum("cij,cj->ci", (world @ inverse)[carriers], corners)[:, :3]
    walk = animated(shown).walk.values[30][:, [1, 2, 0]] / 1000
    for joint in walk:
        assert np.linalg.norm(skinned - joint, axis=1).min() < 1e-3


def test_standing_feet_stay_where_they_are(shown):
    people = load_population()
    for number in (0, 11, 30):
        slide = animated(make_stimulus(people.walkers[number])).slide
        assert slide.mean_mm_s < 15
        assert slide.mean_mm_s < slide.before_mm_s / 10
    moving = animated(shown)
    travelled = np.ptp(moving.walk.sel(marker="pelvis", axis="x").values) / 3
    assert travelled == pytest.approx(shown.figures[0].motion.speed_mm_s, rel=0.25)


def test_an_inverted_figure_is_left_where_it_is(shown):
    walk = animated(shown.then("invert")).walk
    assert np.abs(walk.sel(marker="pelvis").values[:, :2]).max() < 100


def test_a_bvh_comes_back_with_its_transforms(shown, tmp_path):
    wide = shown.then("arm_swing", factor=1.5)
    path = write_stimulus(wide, tmp_path / "walk.bvh")
    again = read_mocap(path, unit="cm")
    expected = animated(wide).walk
    np.testing.assert_allclose(
        again.sel(marker=list(JOINTS.markers)).values, expected.values, atol=0.02
    )
    assert "Frame Time: 0.0166" in path.read_text()


def test_what_has_no_bones_is_refused(shown, tmp_path):
    dots = shown.then("limb_dots", number=5, lifetime_s=0.1, seed=1)
    with pytest.raises(ValueError, match="lacks"):
        write_stimulus(dots, tmp_path / "walk.glb")


# ---------------------------------------------------------------- rigs

HIPS = {"mixamo": "mixamorig:Hips", "unreal": "pelvis", "unity": "Hips", "plain": "pelvis"}
KNEES = {"mixamo": "mixamorig:LeftLeg", "unreal": "calf_l", "unity": "LeftLowerLeg"}
FEET = {"mixamo": "mixamorig:LeftToeBase", "unreal": "ball_l", "unity": "LeftToes"}


def _bvh(stimulus, path, **choices):
    """A BVH file of a stimulus, its joints and end sites in metres, (time, joint, axis), z up."""
    write_stimulus(stimulus, path, rig=RigChoices(**choices))
    walk = read_mocap(path, unit=choices.get("unit", "cm"))
    return [str(name) for name in walk.marker.values], walk.values / 1000


@pytest.mark.parametrize("skeleton", ["mixamo", "unreal", "unity", "plain"])
@pytest.mark.parametrize("suffix", [".bvh", ".glb"])
def test_rigs_stand_on_the_floor_and_are_where_the_walker_is(shown, tmp_path, skeleton, suffix):
    path = tmp_path / f"walk{suffix}"
    choices = RigChoices(skeleton)
    expected = animated(shown, choices=choices).walk
    knee = KNEES.get(skeleton, "left_knee")
    if suffix == ".bvh":
        names, places = _bvh(shown, path, skeleton=skeleton)
    else:
        write_stimulus(shown, path, rig=choices)
        glb = Glb(path.read_bytes())
        names = [node["name"] for node in glb.nodes][2:]
        matrices = [glb.matrices(frame) for frame in range(len(expected))]
        rows = [[placed[2 + n][[2, 0, 1], 3] for n in range(len(names))] for placed in matrices]
        places = np.array(rows)
    assert places[..., 2].min() == pytest.approx(0, abs=1e-3)
    for joint, name in (("left_knee", knee), ("pelvis", HIPS[skeleton])):
        np.testing.assert_allclose(
            places[:, names.index(name)], expected.sel(marker=joint).values / 1000, atol=5e-5
        )
    ball = places[:, names.index(FEET.get(skeleton, "left_toe"))]
    assert np.quantile(ball[:, 2], 0.3) < 2e-3  # it stands, for more than a third of the time


@pytest.mark.parametrize(("pose", "hand_up"), [("t", 0.0), ("a", -1.0)])
def test_the_rest_pose_stands_on_the_floor(shown, pose, hand_up):
    for skeleton in HIPS:
        rig = animated(shown, choices=RigChoices(skeleton, pose)).rig
        rest = dict(zip(rig.roles, rig.rest_positions, strict=True))
        assert min(place[2] for place in rest.values()) == pytest.approx(0, abs=1e-9)
        for side, sign in (("left", 1), ("right", -1)):
            arm = rest[f"{side}_wrist"] - rest[f"{side}_shoulder"]
            np.testing.assert_allclose(arm[2], hand_up * abs(arm[1]), atol=1e-6)
            assert sign * arm[1] > 300
            hip = rest[f"{side}_hip"] - rest["pelvis"]
            assert sign * hip[1] == pytest.approx(80, abs=5)
            assert hip[2] == pytest.approx(-96, abs=5)
            leg = rest[f"{side}_ankle"] - rest[f"{side}_hip"]
            np.testing.assert_allclose(leg[:2], 0, atol=1e-6)
            assert rest[f"{side}_toe"][0] > rest[f"{side}_ankle"][0] + 80


@pytest.mark.parametrize("in_place", [False, True])
def test_one_stride_is_a_cycle(shown, tmp_path, in_place):
    one = shown.whole_strides(1)
    names, places = _bvh(one, tmp_path / "a.bvh", skeleton="mixamo", in_place=in_place)
    hips = places[:, names.index("mixamorig:Hips")]
    steps = np.diff(places, axis=0)
    speed = animated(one).speed_mm_s / 1000
    forward = 0 if in_place else speed / 60
    seam = places[0] + [len(places) * forward, 0, 0] - places[-1]
    usual = np.linalg.norm(steps, axis=2).max(axis=0)
    assert (np.linalg.norm(seam, axis=1) < 1.1 * usual + 1e-4).all()
    bent = np.linalg.norm(seam - (steps[0] + steps[-1]) / 2, axis=1)
    assert bent.max() < 0.004  # the step over the seam is as the steps beside it
    if not in_place:
        assert np.abs(np.diff(hips[:, 0]) * 60 / speed - 1).max() < 0.1
        assert speed == pytest.approx(shown.figures[0].motion.speed_mm_s / 1000, rel=0.1)
    glb = tmp_path / "a.glb"
    write_stimulus(one, glb, rig=RigChoices("mixamo", in_place=True))
    read = Glb(glb.read_bytes())
    first, last = read.matrices(0), read.matrices(len(places))
    gap = [np.abs(first[node] - last[node]).max() for node in first]
    assert max(gap) < 1e-5


@pytest.mark.parametrize(("unit", "up"), [("m", "y"), ("cm", "z"), ("m", "z")])
def test_unit_and_axis_are_as_chosen(shown, tmp_path, unit, up):
    path = tmp_path / "walk.bvh"
    names, places = _bvh(shown, path, unit=unit, up=up)
    assert read_mocap(path, unit=unit).attrs["up_axis"] == up
    expected = animated(shown).walk.sel(marker="head").values / 1000
    np.testing.assert_allclose(places[:, names.index("head")], expected, atol=1e-4)
    with pytest.raises(ValueError, match="y up, by its standard"):
        write_stimulus(shown, tmp_path / "walk.glb", rig=RigChoices(up="z"))


def test_bones_have_the_axes_of_mixamo(shown):
    rig = animated(shown, choices=RigChoices("mixamo")).rig
    axes = dict(zip(rig.names, rig.axes.transpose(0, 2, 1), strict=True))
    forward, left, up = np.eye(3)
    expected = {
        "Hips": (left, up, forward),
        "LeftArm": (-forward, left, -up),
        "RightForeArm": (forward, -left, -up),
        "LeftUpLeg": (-left, -up, forward),
    }
    for name, directions in expected.items():
        np.testing.assert_allclose(axes[f"mixamorig:{name}"], directions, atol=1e-6)


def test_unknown_rigs_are_refused(shown, tmp_path):
    for choices in (RigChoices("biped"), RigChoices(rest_pose="x")):
        with pytest.raises(ValueError, match="is not known"):
            write_stimulus(shown, tmp_path / "walk.bvh", rig=choices)
