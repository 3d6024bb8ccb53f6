"""BVH files: the 15 joints as a skeleton with constant bones that animation programs play.

At rest the body stands in a T, facing forward, legs straight. Where several bones meet, at the
pelvis, the sternum and the ankles, captured bones do not keep their angles to each other as those
of one rigid part would. There each bone has a joint of its own, of no length, called for instance
``sternum_to_head``, that swings it against the others.
"""

from __future__ import annotations

import tomllib
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr

from eigenwalker.core.kinematics import bone_rotations, forward_kinematics
from eigenwalker.core.quaternions import Rotation
from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.trajectories import check_trajectories, missing_markers, sampling_rate
from eigenwalker.io.up_axis_and_unit import turn_upright

Direction = tuple[float, float, float]

UP = (0.0, 0.0, 1.0)
_TOML = files("eigenwalker.io.writers").joinpath("bvh_body.toml").read_text(encoding="utf-8")
BODY: dict[str, tuple[str, Direction]] = {
    joint: (parent, tuple(direction)) for joint, (parent, direction) in tomllib.loads(_TOML).items()
}
"""For each joint but the pelvis its parent, and where it lies from there at rest (x forward)."""
ROOT = "pelvis"
ORDER = "ZXY"
"""Order of the rotation channels, each about the axes as turned by those before it."""


class _Joint(NamedTuple):
    """A joint of the file: the marker whose place it has, and where it lies at rest."""

    name: str
    marker: str
    parent: int
    direction: Direction


@dataclass(frozen=True, eq=False)
class Bones:
    """A body at rest: joints, parents before children, and how they turn."""

    names: tuple[str, ...]
    """Joints of the file, those of no length among them."""
    parents: tuple[int, ...]
    """Index of each joint's parent, -1 for the root."""
    rest: np.ndarray
    """Place of each joint in its parent's frame, shape (joint, 3)."""
    root: np.ndarray
    """Where the root is, shape (time, 3)."""
    rotations: np.ndarray
    """Relative to the parent, unit quaternions x, y, z, w of shape (time, joint, 4)."""


def write_bvh(walk: xr.DataArray, unit: str, up: str, path: Path) -> None:
    """Write a BVH file, which names neither its unit nor its upward axis."""
    del unit
    bones = fit_bones(walk, turn_upright(up))
    turned = Rotation.from_quat(bones.rotations.reshape(-1, 4))
    with warnings.catch_warnings():  # at a gimbal lock one of many equal triples is as good
        warnings.filterwarnings("ignore", message="Gimbal lock")
        angles = turned.as_euler(ORDER, degrees=True)
    angles = np.unwrap(angles.reshape(len(walk), -1), period=360, axis=0)
    with path.open("w", encoding="utf-8", newline="\n") as file:
        file.write("HIERARCHY\n")
        file.writelines(f"{line}\n" for line in _hierarchy(bones, 0))
        file.write(f"MOTION\nFrames: {len(walk)}\nFrame Time: {1 / sampling_rate(walk):.10f}\n")
        np.savetxt(file, np.hstack([bones.root, angles]), fmt="%.6f")


def constant_bones(walk: xr.DataArray) -> xr.DataArray:
    """Return the joints as a body with constant bones has them: what a BVH file plays.

    Each bone has its median length, so joints are off by what their bones change in length: where
    markers slip on the skin some 5 mm (root mean square), 20 mm at most in a sound capture. The two
    harmonics of a walker keep no bone quite constant either: 5 mm again, and up to 41 mm at the
    ankles in mid-swing; with skin movement besides, as in the built-in population, 7 mm and up to
    61 mm.

    Parameters
    ----------
    walk : DataArray of shape (time, marker, axis)
        The 15 joints, and any of those beyond that `virtual_markers` gives, in millimetres.

    Returns
    -------
    DataArray of shape (time, marker, axis)

    Raises
    ------
    ValueError
        If joints are missing, or unknown, or were not seen in some frames.

    See Also
    --------
    write_mocap

    Examples
    --------
    >>> walk = ew.decompose_pca(ew.simulate_walk(seed=1)).trajectories(np.arange(0, 1, 0.01))
    >>> off_mm = np.linalg.norm(constant_bones(walk) - walk, axis=2)
    >>> bool(off_mm.max() < 45), bool(np.sqrt((off_mm**2).mean()) < 8)
    (True, True)
    """
    bones = fit_bones(check_trajectories(walk), np.eye(3))
    offsets = np.tile(bones.rest, (len(walk), 1, 1))
    offsets[:, 0] = bones.root
    placed, _ = forward_kinematics(bones.parents, offsets, bones.rotations)
    order = [bones.names.index(str(name)) for name in walk.marker.values]
    return walk.drop_vars("rotation", errors="ignore").copy(data=placed[:, order])


def fit_bones(walk: xr.DataArray, turn: np.ndarray) -> Bones:
    """Return the body with constant bones that lies over the joints.

    `turn` is the rotation of the frame of `walk` into the one with x forward and z up.
    """
    _check(walk)
    joints = _joints([str(name) for name in walk.marker.values])
    names, markers, parents, directions = zip(*joints, strict=True)
    names_of_walk = [str(name) for name in walk.marker.values]
    places = walk.values[:, [names_of_walk.index(name) for name in markers]]
    lengths = np.median(np.linalg.norm(places - places[:, parents], axis=2), axis=0)
    lengths[0] = 0.0
    rest = lengths[:, None] * (np.array(directions) @ turn)
    return Bones(names, parents, rest, places[:, 0], bone_rotations(parents, rest, places))


def _check(walk: xr.DataArray) -> None:
    lacking = missing_markers(walk, JOINTS.markers)
    unknown = sorted(set(map(str, walk.marker.values)) - {ROOT, *BODY})
    if lacking or unknown:
        raise ValueError(
            "A BVH skeleton is made of the 15 joints, and feet, hands, clavicles and top of the "
            f"head where they are known; these trajectories lack {lacking} and have {unknown} "
            "beyond. Make joints of markers first with virtual_markers()."
        )
    check_trajectories(walk.assign_attrs(units="mm"), complete=True)


def _joints(markers: Sequence[str]) -> list[_Joint]:
    present = [name for name in BODY if name in markers]
    parent_of = {name: _nearest(name, markers) for name in present}
    joints = [_Joint(ROOT, ROOT, -1, UP)]

    def grow(parent: str) -> None:
        children = [name for name in present if parent_of[name] == parent]
        place = len(joints) - 1
        for child in children:
            carrier = place
            if len(children) > 1:
                joints.append(_Joint(f"{parent}_to_{child}", parent, place, UP))
                carrier = len(joints) - 1
            joints.append(_Joint(child, child, carrier, BODY[child][1]))
            grow(child)

    grow(ROOT)
    return joints


def _nearest(joint: str, markers: Sequence[str]) -> str:
    parent = BODY[joint][0]
    return parent if parent in markers else _nearest(parent, markers)


def _hierarchy(bones: Bones, joint: int) -> list[str]:
    children = [child for child, parent in enumerate(bones.parents) if parent == joint]
    offset = " ".join(f"{length:.6f}" for length in bones.rest[joint])
    turns = " ".join(f"{axis}rotation" for axis in ORDER)
    if joint == 0:
        kind, channels = "ROOT", f"CHANNELS 6 Xposition Yposition Zposition {turns}"
    else:
        kind, channels = "JOINT", f"CHANNELS 3 {turns}"
    inside = [line for child in children for line in _hierarchy(bones, child)]
    if not children:
        inside = ["End Site", "{", "\tOFFSET 0.0 0.0 0.0", "}"]
    indented = [f"\t{line}" for line in (f"OFFSET {offset}", channels, *inside)]
    return [f"{kind} {bones.names[joint]}", "{", *indented, "}"]
