"""BVH files: a rig and how it moves, as animation programs play it.

At rest the body stands on the floor. Bones have the axes of the room at rest, so the rest pose is
in the offsets alone.
"""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import xarray as xr

from eigenwalker.core.quaternions import Rotation
from eigenwalker.core.trajectories import MILLIMETRES, check_trajectories, sampling_rate
from eigenwalker.io.up_axis_and_unit import turn_upright
from eigenwalker.io.writers.rig import Rig, fit_rig

ORDER = "ZXY"
"""Order of the rotation channels, each about the axes as turned by those before it."""


def write_bvh(
    walk: xr.DataArray,
    unit: str,
    up: str,
    path: Path,
    *,
    skeleton: str = "plain",
    rest_pose: str = "t",
) -> None:
    """Write trajectories as a BVH file, which names neither its unit nor its upward axis."""
    places = walk.values @ turn_upright(up).T * MILLIMETRES[unit]
    rigid = constant_bones(walk.copy(data=places).assign_attrs(units="mm"))
    rig = fit_rig(rigid, skeleton, rest_pose)
    write_rig(rig, path, rate_hz=sampling_rate(walk), unit=unit, up=up)


def write_rig(rig: Rig, path: Path, *, rate_hz: float, unit: str = "cm", up: str = "y") -> None:
    """Write a rig as a BVH file."""
    turn, length = turn_upright(up), MILLIMETRES[unit]
    quaternions = rig.rotations
    quaternions = np.concatenate([quaternions[..., :3] @ turn, quaternions[..., 3:]], axis=-1)
    turned = Rotation.from_quat(quaternions.reshape(-1, 4))
    with warnings.catch_warnings():  # at a gimbal lock one of many equal triples is as good
        warnings.filterwarnings("ignore", message="Gimbal lock")
        angles = turned.as_euler(ORDER, degrees=True).reshape((*quaternions.shape[:2], 3))
    angles = np.unwrap(angles, period=360, axis=0)
    columns: list[np.ndarray] = []
    lines = _hierarchy(rig, rig.rest @ turn / length, 0)
    for joint, name in enumerate(rig.names):
        if joint in rig.moves:
            columns.append(rig.moves[joint] @ turn / length)
        if not _is_end(name):
            columns.append(angles[:, joint])
    with path.open("w", encoding="utf-8", newline="\n") as file:
        file.write("HIERARCHY\n")
        file.writelines(f"{line}\n" for line in lines)
        file.write(f"MOTION\nFrames: {len(quaternions)}\nFrame Time: {1 / rate_hz:.10f}\n")
        np.savetxt(file, np.hstack(columns), fmt="%.6f")


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
    rigid = check_trajectories(walk).drop_vars("rotation", errors="ignore")
    for _ in range(2):  # of the rest, which is an average, the first fit leaves 0.02 mm
        rig = fit_rig(rigid)
        order = [rig.roles.index(str(name)) for name in walk.marker.values]
        rigid = rigid.copy(data=rig.positions[:, order])
    return rigid


def _is_end(name: str) -> bool:
    """Whether it is an end site: no name, or that of a tip which Mixamo makes a joint."""
    return not name or name.endswith("_End")


def _hierarchy(rig: Rig, rest: np.ndarray, joint: int) -> list[str]:
    children = [child for child, parent in enumerate(rig.parents) if parent == joint]
    offset = f"OFFSET {' '.join(f'{length:.6f}' for length in rest[joint])}"
    if _is_end(rig.names[joint]):
        return ["End Site", "{", f"\t{offset}", "}"]
    turns = " ".join(f"{axis}rotation" for axis in ORDER)
    channels = f"CHANNELS 3 {turns}"
    if joint in rig.moves:
        channels = f"CHANNELS 6 Xposition Yposition Zposition {turns}"
    inside = [line for child in children for line in _hierarchy(rig, rest, child)]
    if not children:
        inside = ["End Site", "{", "\tOFFSET 0.0 0.0 0.0", "}"]
    indented = [f"\t{line}" for line in (offset, channels, *inside)]
    return [f"{'JOINT' if joint else 'ROOT'} {rig.names[joint]}", "{", *indented, "}"]
