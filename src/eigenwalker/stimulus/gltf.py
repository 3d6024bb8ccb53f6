"""glTF 2.0 binary (.glb): skeletons with simple bodies, animated, for browsers and game engines.

Metres, y up, facing z. Each joint has its own axes, y along its bone, as Mixamo has them.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from eigenwalker._version import __version__
from eigenwalker.core.quaternions import Rotation
from eigenwalker.core.trajectories import MILLIMETRES
from eigenwalker.io.up_axis_and_unit import turn_upright
from eigenwalker.io.writers.rig import Rig

FLOAT, SHORT, VERTICES = 5126, 5123, 34962
MAGIC, JSON_CHUNK, BINARY_CHUNK = 0x46546C67, 0x4E4F534A, 0x004E4942
ASIDE_M, BEHIND_M = 1.0, 2.0
"""From one figure of a crowd to the next, and from row to row."""
THICK = 0.09
"""Half the thickness of a bone, as a share of its length."""


class _Buffer:
    """Arrays one after the other, and how glTF finds them."""

    def __init__(self) -> None:
        self.data = bytearray()
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []

    def put(
        self,
        values: np.ndarray,
        kind: str,
        component: int = FLOAT,
        *,
        limits: bool = False,
        vertices: bool = False,
    ) -> int:
        code = {FLOAT: "<f4", SHORT: "<u2"}[component]
        raw = np.ascontiguousarray(values, dtype=code)
        self.data += b"\0" * (-len(self.data) % 4)
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": raw.nbytes}
        if vertices:
            view["target"] = VERTICES
        accessor = {
            "bufferView": len(self.views),
            "componentType": component,
            "count": len(raw),
            "type": kind,
        }
        if limits:
            flat = raw.reshape(len(raw), -1)
            accessor |= {"min": flat.min(axis=0).tolist(), "max": flat.max(axis=0).tolist()}
        self.data += raw.tobytes()
        self.views.append(view)
        self.accessors.append(accessor)
        return len(self.accessors) - 1


def write_glb(
    rigs: Mapping[str, Rig],
    path: Path,
    *,
    rate_hz: float,
    unit: str = "m",
    about: Mapping[str, str] | None = None,
) -> None:
    """Write rigs as skeletons with bodies, side by side, each with its animation.

    In centimetres, skeletons stand under a node that scales them to the metres of glTF.
    """
    buffer = _Buffer()
    content: dict[str, Any] = {
        "asset": {
            "version": "2.0",
            "generator": f"eigenwalker {__version__}",
            **({"extras": dict(about)} if about else {}),
        },
        "scene": 0,
        "scenes": [{"nodes": []}],
        "nodes": [],
        "meshes": [],
        "materials": [
            {
                "name": "body",
                "pbrMetallicRoughness": {
                    "baseColorFactor": [0.8, 0.8, 0.8, 1],
                    "metallicFactor": 0,
                    "roughnessFactor": 0.9,
                },
            }
        ],
        "skins": [],
        "animations": [],
    }
    for number, (name, rig) in enumerate(rigs.items()):
        row, column = divmod(number, int(np.ceil(np.sqrt(len(rigs)))))
        aside = np.array([-column * ASIDE_M, 0.0, -row * BEHIND_M])
        _add_figure(content, buffer, name, _in_gltf(rig, unit), rate_hz, unit, aside)
    content |= {
        "buffers": [{"byteLength": len(buffer.data)}],
        "bufferViews": buffer.views,
        "accessors": buffer.accessors,
    }
    path.write_bytes(_binary(content, bytes(buffer.data)))


class _Bones(NamedTuple):
    """A rig in the frame and unit of glTF, with each joint's own axes."""

    names: list[str]
    parents: tuple[int, ...]
    places: np.ndarray
    axes: np.ndarray
    offsets: np.ndarray
    moves: dict[int, np.ndarray]
    rotations: np.ndarray


def _in_gltf(rig: Rig, unit: str) -> _Bones:
    turn, length = turn_upright("y"), MILLIMETRES[unit]
    rest, places = rig.rest @ turn / length, rig.rest_positions @ turn / length
    axes = turn.T @ rig.axes  # columns
    parents = rig.parents
    offsets = np.stack(
        [rest[j] if parent < 0 else axes[parent].T @ rest[j] for j, parent in enumerate(parents)]
    )
    moves = {
        joint: way @ turn / length @ (axes[parents[joint]] if parents[joint] >= 0 else np.eye(3))
        for joint, way in rig.moves.items()
    }
    rotations = rig.oriented_rotations.copy()
    rotations[:, 0] = _of_root(rig, axes)
    names = [name or f"{rig.names[parents[joint]]}_end" for joint, name in enumerate(rig.names)]
    return _Bones(names, parents, places, axes, offsets, moves, rotations)


def _of_root(rig: Rig, axes: np.ndarray) -> np.ndarray:
    """Return how the root turns in the frame of glTF."""
    turn = turn_upright("y")
    matrices = turn.T @ Rotation.from_quat(rig.turns[:, 0]).as_matrix() @ turn
    return Rotation.from_matrix(matrices @ axes[0]).as_quat()


def _add_figure(
    content: dict[str, Any],
    buffer: _Buffer,
    name: str,
    bones: _Bones,
    rate_hz: float,
    unit: str,
    aside: np.ndarray,
) -> None:
    """Add a figure: a node that places it, its body, its joints, and its animation."""
    nodes = content["nodes"]
    holder, first = len(nodes), len(nodes) + 2
    scale = MILLIMETRES[unit] / 1000
    nodes.append({"name": name, "children": [first]})
    if scale != 1:
        nodes[holder]["scale"] = [scale] * 3
    if aside.any():
        nodes[holder]["translation"] = aside.tolist()
    nodes.append(
        {"name": f"{name} body", "mesh": len(content["meshes"]), "skin": len(content["skins"])}
    )
    nodes += _joints(bones, first)
    content["scenes"][0]["nodes"] += [holder, holder + 1]
    content["meshes"].append({"name": f"{name} body", "primitives": [_body(bones, buffer)]})
    content["skins"].append(_skin(bones, buffer, first))
    content["animations"].append(_animation(bones, buffer, first, name, rate_hz))


def _joints(bones: _Bones, first: int) -> list[dict[str, Any]]:
    nodes = []
    for joint, name in enumerate(bones.names):
        children = [first + c for c, parent in enumerate(bones.parents) if parent == joint]
        own = bones.axes[joint]
        if bones.parents[joint] >= 0:
            own = bones.axes[bones.parents[joint]].T @ own
        node = {
            "name": name,
            "translation": bones.offsets[joint].tolist(),
            "rotation": Rotation.from_matrix(own).as_quat().tolist(),
        }
        nodes.append({**node, **({"children": children} if children else {})})
    return nodes


def _animation(
    bones: _Bones, buffer: _Buffer, first: int, name: str, rate_hz: float
) -> dict[str, Any]:
    times = buffer.put(np.arange(len(bones.rotations)) / rate_hz, "SCALAR", limits=True)
    samplers, channels = [], []

    def channel(joint: int, path: str, values: np.ndarray, kind: str) -> None:
        output = buffer.put(values, kind)
        channels.append({"sampler": len(samplers), "target": {"node": first + joint, "path": path}})
        samplers.append({"input": times, "output": output, "interpolation": "LINEAR"})

    for joint, way in bones.moves.items():
        channel(joint, "translation", way, "VEC3")
    for joint in range(len(bones.names)):
        channel(joint, "rotation", _steady(_unit(bones.rotations[:, joint])), "VEC4")
    return {"name": name, "samplers": samplers, "channels": channels}


def _unit(turns: np.ndarray) -> np.ndarray:
    return turns / np.linalg.norm(turns, axis=-1, keepdims=True)


def _steady(turns: np.ndarray) -> np.ndarray:
    """Quaternions without jumps between q and -q, which are one rotation."""
    same = np.sum(turns[1:] * turns[:-1], axis=1) >= 0
    signs = np.cumprod(np.where(same, 1.0, -1.0))
    return turns * np.concatenate([[1.0], signs])[:, None]


def _skin(bones: _Bones, buffer: _Buffer, first: int) -> dict[str, Any]:
    """The joints that carry the body, and the way from rest into each joint's frame."""
    inverse = np.tile(np.eye(4), (len(bones.names), 1, 1))
    inverse[:, :3, :3] = bones.axes.transpose(0, 2, 1)
    inverse[:, :3, 3] = -np.einsum("jki,jk->ji", bones.axes, bones.places)
    columns = inverse.transpose(0, 2, 1).reshape(-1, 16)  # glTF writes column after column
    return {
        "joints": [first + joint for joint in range(len(bones.names))],
        "skeleton": first,
        "inverseBindMatrices": buffer.put(columns, "MAT4"),
    }


def _body(bones: _Bones, buffer: _Buffer) -> dict[str, Any]:
    """An octahedron along each bone, carried by the joint it begins at."""
    rest = bones.places
    corners, carriers = [], []
    for joint, parent in enumerate(bones.parents):
        bone = rest[joint] - rest[parent] if parent >= 0 else np.zeros(3)
        length = np.linalg.norm(bone)
        if length == 0 or {joint, parent} <= set(bones.moves):
            continue
        along = bone / length
        aside = np.cross(along, np.eye(3)[np.abs(along).argmin()])
        aside *= THICK * length / np.linalg.norm(aside)
        across = np.cross(along, aside)
        start, end = rest[parent], rest[joint]
        ring = [start + 0.2 * bone + way for way in (aside, across, -aside, -across)]
        for here, there in zip(ring, [*ring[1:], ring[0]], strict=True):
            corners += [start, there, here, end, here, there]
        carriers += [parent] * 24
    places = np.array(corners)
    sides = np.cross(places[1::3] - places[::3], places[2::3] - places[::3])
    normals = np.repeat(sides / np.linalg.norm(sides, axis=1, keepdims=True), 3, axis=0)
    joints = np.zeros((len(carriers), 4))
    joints[:, 0] = carriers
    attributes = {
        "POSITION": buffer.put(places, "VEC3", limits=True, vertices=True),
        "NORMAL": buffer.put(normals, "VEC3", vertices=True),
        "JOINTS_0": buffer.put(joints, "VEC4", SHORT, vertices=True),
        "WEIGHTS_0": buffer.put(np.tile([1.0, 0, 0, 0], (len(carriers), 1)), "VEC4", vertices=True),
    }
    return {"attributes": attributes, "material": 0, "mode": 4}


def _binary(content: dict[str, Any], data: bytes) -> bytes:
    words = json.dumps(content, separators=(",", ":"), allow_nan=False).encode()
    words += b" " * (-len(words) % 4)
    data += b"\0" * (-len(data) % 4)
    length = 12 + 8 + len(words) + 8 + len(data)
    return b"".join(
        [
            struct.pack("<III", MAGIC, 2, length),
            struct.pack("<II", len(words), JSON_CHUNK),
            words,
            struct.pack("<II", len(data), BINARY_CHUNK),
            data,
        ]
    )
