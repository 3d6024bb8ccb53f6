"""BVH files: a skeleton of bones and how its joints turn -> where its joints are."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from scipy.spatial.transform import Rotation

from eigenwalker.core.kinematics import forward_kinematics
from eigenwalker.core.trajectories import label_trajectories
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.readers.bvh_grammar import Joint, parse_bvh
from eigenwalker.io.up_axis_and_unit import Unit, guess_unit, turn_upright, up_axis
from eigenwalker.markers.marker_sets import numbered

MOST_POSITIONS = 100_000_000
"""More joints times frames than this do not fit into memory."""


def looks_like_bvh(content: bytes) -> bool:
    """Return whether a file begins as BVH files do."""
    return content.lstrip(b"\xef\xbb\xbf \t\r\n")[:9].upper() == b"HIERARCHY"


def read_bvh(content: bytes, *, source: str, unit: Unit | None = None) -> xr.DataArray:
    """Return where the joints and end sites of a BVH file are.

    Parameters
    ----------
    content : bytes
        The whole file.
    source : str
        Its name, for messages.
    unit : Unit, optional
        Unit of its lengths; guessed from the height of the body if left out.

    Returns
    -------
    DataArray of shape (time, marker, axis)
        In millimetres, z up. End sites are called ``<joint>_end``. The coordinate ``rotation``
        (time, marker, axis) holds how each joint's own frame is turned in the room, as rotation
        vectors in radians (`scipy.spatial.transform.Rotation.from_rotvec`).

    Raises
    ------
    UnreadableFile
        If the file is no BVH, damaged or cut short.

    """
    joints, motion = parse_bvh(content.decode("utf-8-sig", errors="replace"), source)
    if len(joints) * len(motion.values) > MOST_POSITIONS:
        raise UnreadableFile(
            source,
            "the capture of one person",
            f"{len(joints)} joints in {len(motion.values)} frames",
            "cut it into shorter files",
        )
    positions, orientations = _pose(joints, motion.values)
    names = _names(joints)
    up = up_axis(positions, names)
    turn = turn_upright(up or "y")
    positions = positions @ turn.T
    named = unit is not None
    unit = unit or guess_unit(positions, names, source=source)
    walk = label_trajectories(
        positions * unit.millimetres, markers=names, rate_hz=motion.rate_hz
    ).assign_coords(rotation=(("time", "marker", "axis"), _turned(orientations, turn)))
    walk.attrs.update(
        source=source,
        format="BVH",
        up_axis=up or "y",
        up_axis_known=up is not None,
        unit=unit.name,
        unit_guessed=not named,
        unit_reason=unit.reason,
    )
    return walk


def _names(joints: Sequence[Joint]) -> list[str]:
    """Return the names of the joints; of several people alike, ``1:Hips`` and ``2:Hips``."""
    names = [joint.name for joint in joints]
    roots = np.cumsum([joint.parent < 0 for joint in joints])
    bodies = [
        {joint.name for joint, of in zip(joints, roots, strict=True) if of == root}
        for root in set(roots)
    ]
    if len(bodies) > 1 and set.intersection(*bodies):
        names = [f"{root}:{name}" for root, name in zip(roots, names, strict=True)]
    return numbered(names)


def _pose(joints: Sequence[Joint], values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return positions (time, joint, 3) and orientations (time, joint, 4) of the joints."""
    offsets = np.tile(np.array([joint.offset for joint in joints]), (len(values), 1, 1))
    rotations = np.zeros((len(values), len(joints), 4))
    rotations[..., 3] = 1.0
    moved = np.zeros((len(joints), 3), dtype=bool)
    columns = np.cumsum([0] + [len(joint.channels) for joint in joints])
    same_order: dict[str, list[tuple[int, list[int]]]] = {}
    for index, joint in enumerate(joints):
        turning: list[int] = []
        order = ""
        for column, channel in enumerate(joint.channels, columns[index]):
            if channel.endswith("position"):
                axis = "xyz".index(channel[0])
                offsets[:, index, axis] = values[:, column]
                moved[index, axis] = True
            else:
                turning.append(column)
                order += channel[0].upper()
        if order:
            same_order.setdefault(order, []).append((index, turning))
    for order, members in same_order.items():
        indices = [index for index, _ in members]
        angles = values[:, [turning for _, turning in members]].reshape(-1, len(order))
        turns = Rotation.from_euler(order, angles, degrees=True)
        rotations[:, indices] = turns.as_quat().reshape(len(values), len(indices), 4)
    offsets = _placed(joints, offsets, moved)
    return forward_kinematics([joint.parent for joint in joints], offsets, rotations)


def _placed(joints: Sequence[Joint], offsets: np.ndarray, moved: np.ndarray) -> np.ndarray:
    """Return where joints are in their parents' frames: position channels replace the OFFSET.

    In a few files the channels of joints other than the root are added to it instead, and so are
    nearer to 0 than to the OFFSET.
    """
    rest = np.array([joint.offset for joint in joints])
    inner = moved & (np.array([joint.parent for joint in joints]) >= 0)[:, None]
    channels = np.median(offsets, axis=0)
    if np.abs(channels[inner]).sum() < np.abs(channels - rest)[inner].sum():
        return offsets + np.where(inner, rest, 0.0)
    return offsets


def _turned(orientations: np.ndarray, turn: np.ndarray) -> np.ndarray:
    """Return orientations (x, y, z, w) as rotation vectors in the room turned by a matrix."""
    turned = Rotation.from_matrix(turn) * Rotation.from_quat(orientations.reshape(-1, 4))
    return turned.as_rotvec().reshape(*orientations.shape[:2], 3)
