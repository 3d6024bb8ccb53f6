"""glTF 2.0 binary (.glb): a skeleton with a simple body, animated, for browsers and game engines.

The skeleton is in centimetres, y up, facing z, under a node that scales it by 0.01, since glTF
counts in metres.
"""

from __future__ import annotations

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from eigenwalker._version import __version__
from eigenwalker.io.up_axis_and_unit import turn_upright
from eigenwalker.io.writers.bvh import Bones, fit_bones

FLOAT, SHORT, VERTICES = 5126, 5123, 34962
MAGIC, JSON_CHUNK, BINARY_CHUNK = 0x46546C67, 0x4E4F534A, 0x004E4942
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


def write_glb(walk: xr.DataArray, path: Path, *, about: dict[str, str] | None = None) -> None:
    """Write the 15 joints of a walk (time, marker, axis), mm, as an animated skeleton."""
    turn = turn_upright("y")
    bones = fit_bones(walk.copy(data=walk.values @ turn / 10), turn)
    buffer = _Buffer()
    first = 2  # the nodes before the joints: what scales them, and the body
    nodes: list[dict[str, Any]] = [
        {"name": "walker", "scale": [0.01] * 3, "children": [first]},
        {"name": "body", "mesh": 0, "skin": 0},
        *_joints(bones, first),
    ]
    times = buffer.put(walk.time.values - walk.time.values[0], "SCALAR", limits=True)
    content = {
        "asset": {
            "version": "2.0",
            "generator": f"eigenwalker {__version__}",
            **({"extras": about} if about else {}),
        },
        "scene": 0,
        "scenes": [{"nodes": [0, 1]}],
        "nodes": nodes,
        "meshes": [{"name": "body", "primitives": [_body(bones, buffer)]}],
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
        "skins": [_skin(bones, buffer, first)],
        "animations": [_animation(bones, buffer, times, first)],
        "buffers": [{"byteLength": len(buffer.data)}],
        "bufferViews": buffer.views,
        "accessors": buffer.accessors,
    }
    path.write_bytes(_binary(content, bytes(buffer.data)))


def _joints(bones: Bones, first: int) -> list[dict[str, Any]]:
    nodes = []
    for joint, name in enumerate(bones.names):
        children = [first + c for c, parent in enumerate(bones.parents) if parent == joint]
        place = bones.root[0] if joint == 0 else bones.rest[joint]
        node = {
            "name": name,
            "translation": place.tolist(),
            "rotation": _unit(bones.rotations[0, joint]).tolist(),
        }
        nodes.append({**node, **({"children": children} if children else {})})
    return nodes


def _animation(bones: Bones, buffer: _Buffer, times: int, first: int) -> dict[str, Any]:
    samplers, channels = [], []

    def channel(joint: int, path: str, values: np.ndarray, kind: str) -> None:
        output = buffer.put(values, kind)
        channels.append({"sampler": len(samplers), "target": {"node": first + joint, "path": path}})
        samplers.append({"input": times, "output": output, "interpolation": "LINEAR"})

    channel(0, "translation", bones.root, "VEC3")
    for joint in range(len(bones.names)):
        turns = _unit(bones.rotations[:, joint])
        if np.ptp(turns, axis=0).max() > 1e-9:
            channel(joint, "rotation", _steady(turns), "VEC4")
    return {"name": "walk", "samplers": samplers, "channels": channels}


def _unit(turns: np.ndarray) -> np.ndarray:
    return turns / np.linalg.norm(turns, axis=-1, keepdims=True)


def _steady(turns: np.ndarray) -> np.ndarray:
    """Quaternions without jumps between q and -q, which are one rotation."""
    same = np.sum(turns[1:] * turns[:-1], axis=1) >= 0
    signs = np.cumprod(np.where(same, 1.0, -1.0))
    return turns * np.concatenate([[1.0], signs])[:, None]


def _skin(bones: Bones, buffer: _Buffer, first: int) -> dict[str, Any]:
    """The joints that carry the body, and the way from rest into each joint's frame."""
    inverse = np.tile(np.eye(4), (len(bones.names), 1, 1))
    inverse[:, :3, 3] = -_at_rest(bones)
    columns = inverse.transpose(0, 2, 1).reshape(-1, 16)  # glTF writes column after column
    return {
        "joints": [first + joint for joint in range(len(bones.names))],
        "skeleton": first,
        "inverseBindMatrices": buffer.put(columns, "MAT4"),
    }


def _at_rest(bones: Bones) -> np.ndarray:
    """Places of the joints at rest, the root at the origin."""
    places = np.zeros((len(bones.names), 3))
    for joint, parent in enumerate(bones.parents):
        if parent >= 0:
            places[joint] = places[parent] + bones.rest[joint]
    return places


def _body(bones: Bones, buffer: _Buffer) -> dict[str, Any]:
    """An octahedron along each bone, carried by the joint it begins at."""
    rest = _at_rest(bones)
    corners, carriers = [], []
    for joint, parent in enumerate(bones.parents):
        bone = bones.rest[joint]
        length = np.linalg.norm(bone)
        if parent < 0 or length == 0:
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
