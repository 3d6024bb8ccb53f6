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
from eigenwalker.stimulus.animation import animated
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
    corners = np.column_stack([glb.array(attributes["POSITION"]), np.ones(24 * 14)])
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
        assert slide.mean_mm_s < 60
        assert slide.mean_mm_s < slide.before_mm_s / 3
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
