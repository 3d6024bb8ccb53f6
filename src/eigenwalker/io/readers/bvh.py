"""BVH files: a skeleton of bones and how its joints turn -> where its joints are."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np
import xarray as xr

from eigenwalker.core.kinematics import forward_kinematics
from eigenwalker.core.quaternions import from_euler
from eigenwalker.io.capture_file import CaptureFile
from eigenwalker.io.readers.bvh_grammar import Joint, parse_bvh
from eigenwalker.io.to_trajectories import FileFrame, trajectories_of
from eigenwalker.markers.marker_sets import numbered

looks_like_bvh = re.compile(rb"(\xef\xbb\xbf)?\s*HIERARCHY", re.IGNORECASE).match


def read_bvh(file: CaptureFile) -> xr.DataArray:
    """Return the trajectories of the joints and end sites of a BVH file.

    End sites are called ``<joint>_end``. The coordinate ``rotation`` holds how each joint's own
    frame is turned in the room.
    """
    joints, motion, attrs = parse_bvh(file)
    file.check_size(len(joints), len(motion.values))
    positions, orientations = _pose(joints, motion.values)
    walk = trajectories_of(
        file,
        positions,
        _names(joints),
        format_name="BVH",
        rate_hz=file.rate_hz or motion.rate_hz,
        frame=FileFrame(usual_up="y"),
        quaternions=orientations,
    )
    return walk.assign_attrs(attrs)


def _names(joints: Sequence[Joint]) -> list[str]:
    """Return the names of the joints; of several people alike, ``1:Hips`` and ``2:Hips``."""
    names = [joint.name for joint in joints]
    roots = np.cumsum([joint.parent < 0 for joint in joints])
    bodies = [
        {joint.name for joint, root in zip(joints, roots, strict=True) if root == number}
        for number in set(roots)
    ]
    if len(bodies) > 1 and bodies[0].intersection(*bodies[1:]):
        names = [f"{root}:{name}" for root, name in zip(roots, names, strict=True)]
    return numbered(names)


def _pose(joints: Sequence[Joint], values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return positions (time, joint, 3) and orientations (time, joint, 4) of the joints."""
    offsets = np.tile(np.array([joint.offset for joint in joints]), (len(values), 1, 1))
    rotations = np.zeros((len(values), len(joints), 4))
    rotations[..., 3] = 1.0
    has_position = np.zeros((len(joints), 3), dtype=bool)
    columns = np.cumsum([0] + [len(joint.channels) for joint in joints])
    same_order: dict[str, list[tuple[int, list[int]]]] = {}
    for index, joint in enumerate(joints):
        angle_columns: list[int] = []
        order = ""
        for column, channel in enumerate(joint.channels, columns[index]):
            if channel.endswith("position"):
                axis = "xyz".index(channel[0])
                offsets[:, index, axis] = values[:, column]
                has_position[index, axis] = True
            else:
                angle_columns.append(column)
                order += channel[0].upper()
        if order:
            same_order.setdefault(order, []).append((index, angle_columns))
    for order, members in same_order.items():
        indices = [index for index, _ in members]
        angles = values[:, [columns for _, columns in members]]
        rotations[:, indices] = from_euler(order, angles)
    offsets = _joint_positions(joints, offsets, has_position)
    return forward_kinematics([joint.parent for joint in joints], offsets, rotations)


def _joint_positions(
    joints: Sequence[Joint], offsets: np.ndarray, has_position: np.ndarray
) -> np.ndarray:
    """Return where joints are in their parents' frames: position channels replace the OFFSET.

    In a few files the channels of joints other than the root are added to it instead, and so are
    nearer to 0 than to the OFFSET.
    """
    rest = np.array([joint.offset for joint in joints])
    inner = has_position & (np.array([joint.parent for joint in joints]) >= 0)[:, None]
    channels = np.median(offsets, axis=0)
    if np.abs(channels[inner]).sum() < np.abs(channels - rest)[inner].sum():
        return offsets + np.where(inner, rest, 0.0)
    return offsets
