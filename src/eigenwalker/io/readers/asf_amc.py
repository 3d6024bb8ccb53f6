"""Acclaim files: a motion (AMC) and, beside it, the skeleton that moves (ASF) -> where bones end.

A bone turns about the axes of its own frame, which the skeleton describes: with C from its ``axis``
and M from its channels, ``R = R_parent C M C^-1``, and it reaches from the end of its parent along
``R (direction * length)`` (Schafer 1995). All turns are about fixed axes, one after the other.
"""

# SciPy is not typed:
# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import xarray as xr

from eigenwalker.core.kinematics import forward_kinematics
from eigenwalker.core.quaternions import Rotation
from eigenwalker.io.capture_file import CaptureFile, as_utf8, read_bytes
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.readers.acclaim_grammar import Acclaim, Bone, Motion, parse_amc, parse_asf
from eigenwalker.io.to_trajectories import FileFrame, trajectories_of
from eigenwalker.io.up_axis_and_unit import (
    PLAUSIBLE_MM,
    Unit,
    body_height,
    turn_upright,
    up_axis,
)
from eigenwalker.markers.marker_sets import numbered

CMU_RATE_HZ = 120.0
"""AMC files name no rate; the CMU collection, where nearly all of them come from, has this one."""
INCH_MM = 25.4

_FIRST_WORDS = rb"(?:\xef\xbb\xbf)?(?:\s*#[^\n]*\n)*\s*:"
_OF_SKELETONS = rb"(version|name|units|documentation|root|bonedata|hierarchy)(?![a-z-])"
_OF_MOTIONS = rb"(fully-specified|degrees|radians|samples-per-second)(?![a-z-])"


def looks_like_acclaim(content: bytes) -> bool:
    """Return whether a file begins as motions (AMC) or skeletons (ASF) do."""
    return _begins_with(_OF_MOTIONS, content) or _begins_with(_OF_SKELETONS, content)


def _begins_with(keyword: bytes, content: bytes) -> bool:
    return re.match(_FIRST_WORDS + keyword, content[:4096], re.IGNORECASE) is not None


def read_asf_amc(file: CaptureFile) -> xr.DataArray:
    """Return the trajectories of the ends of the bones in an Acclaim motion.

    The coordinate ``rotation`` holds how each bone is turned in the room from where it is at rest.
    """
    if _begins_with(_OF_SKELETONS, file.content):
        advice = "name the motion, which finds the skeleton beside it"
        raise file.error("a motion (.amc)", "the skeleton alone", advice)
    motion = parse_amc(file)
    beside = find_skeleton(file.path)
    skeleton = parse_asf(CaptureFile(beside, as_utf8(read_bytes(beside))))
    ends, orientations = _pose(file, skeleton, motion, beside.name)
    names = numbered([bone.name for bone in skeleton.bones])
    up = up_axis(ends, names)
    reason = "as nearly all motions of this format have it"
    rate_hz, assumed = file.frame_rate(motion.rate_hz, usual_hz=CMU_RATE_HZ, reason=reason)
    usual_unit = _usual_unit(skeleton, ends @ turn_upright(up or "y").T, names)
    walk = trajectories_of(
        file,
        ends,
        names,
        format_name="ASF/AMC",
        rate_hz=rate_hz,
        frame=FileFrame(None, usual_unit, up, "y"),
        quaternions=orientations,
        unit_source=beside.name,
    )
    return walk.assign_attrs({"skeleton": beside.name, "rate_assumed": False, **assumed})


def find_skeleton(motion: Path) -> Path:
    """Return the skeleton that lies beside a motion.

    It is the ASF file of the same name; else the one whose name is the beginning of the motion's
    (35.asf for 35_01.amc); else the only one in the folder.
    """
    asfs = sorted(file for file in motion.parent.iterdir() if file.suffix.lower() == ".asf")
    stem = motion.stem.casefold()
    by_name = [
        file for file in asfs if re.match(re.escape(file.stem.casefold()) + r"(?![a-z0-9])", stem)
    ]
    if by_name:
        return max(by_name, key=lambda file: len(file.stem))
    if len(asfs) == 1:
        return asfs[0]
    same = f"{motion.stem}.asf"
    raise UnreadableFile(
        motion.name,
        "the skeleton (.asf) beside the motion",
        f"{len(asfs)} of other names" if asfs else "none",
        f"name its skeleton {same}" if asfs else f"copy its skeleton into the folder, as {same}",
    )


def skeleton_beside(motion: Path) -> Path | None:
    """Return the skeleton that lies beside a motion; None for other files, or if there is none."""
    try:
        return find_skeleton(motion) if motion.suffix.lower() == ".amc" else None
    except UnreadableFile:
        return None


def _pose(
    file: CaptureFile, skeleton: Acclaim, motion: Motion, beside: str
) -> tuple[np.ndarray, np.ndarray]:
    """Return ends and orientations of all bones, in the frame and unit of the files."""
    own_skeleton = "put its own skeleton beside it"
    bones, channels = skeleton.bones, motion.channels
    unknown = sorted(set(channels) - {bone.name.lower() for bone in bones})
    if unknown or not channels:
        got = f"{unknown}, which it lacks" if channels else "none"
        raise file.error(f"motions of the bones of {beside}", got, own_skeleton)
    n_frames = len(next(iter(channels.values())))
    file.check_size(len(bones), n_frames)
    degrees = skeleton.degrees if motion.degrees is None else motion.degrees
    turns: list[np.ndarray] = []
    root = np.tile(skeleton.position, (n_frames, 1))
    for bone in bones:
        n_channels = len(bone.channels)
        values = channels.get(bone.name.lower(), np.zeros((n_frames, n_channels)))
        if values.shape[1] != n_channels:
            expected = f"{n_channels} numbers of {bone.name} in each frame, as {beside} says"
            raise file.error(expected, f"{values.shape[1]}", own_skeleton)
        turns.append(_turns(bone, values, degrees=degrees, axis_degrees=skeleton.degrees))
        for column, channel in enumerate(bone.channels):
            if channel.startswith("t"):
                root[:, "xyz".index(channel[1])] += values[:, column]
    return _ends(bones, np.stack(turns, axis=1), root)


def _turns(bone: Bone, values: np.ndarray, *, degrees: bool, axis_degrees: bool) -> np.ndarray:
    """Return how a bone turns from its parent's turn: quaternions of shape (time, 4)."""
    own = Rotation.from_euler(bone.axis_order, bone.axis, degrees=axis_degrees)
    turning = [column for column, channel in enumerate(bone.channels) if channel.startswith("r")]
    moved = Rotation.identity(len(values))
    if turning:
        order = "".join(bone.channels[column][1] for column in turning)
        moved = Rotation.from_euler(order, values[:, turning], degrees=degrees)
    return (moved * own if bone.parent < 0 else own * moved * own.inv()).as_quat()


def _ends(bones: list[Bone], turns: np.ndarray, root: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return ends and orientations of bones, each a joint where it begins and a point at its end.

    Bone i is joint 2 i, which turns at the end of its parent, and point 2 i + 1, which does not.
    """
    n_frames, n_bones, _ = turns.shape
    parents = [n for i, bone in enumerate(bones) for n in (2 * max(bone.parent, -1) + 1, 2 * i)]
    offsets = np.zeros((n_frames, 2 * n_bones, 3))
    offsets[:, 0] = root
    offsets[:, 1::2] = [bone.reach for bone in bones]
    rotations = np.zeros((n_frames, 2 * n_bones, 4))
    rotations[..., 3] = 1
    rotations[:, 0::2] = turns
    positions, orientations = forward_kinematics(parents, offsets, rotations)
    return positions[:, 1::2], orientations[:, 1::2]


def _usual_unit(skeleton: Acclaim, ends: np.ndarray, names: Sequence[str]) -> Unit | None:
    """Return inches over the ``length`` of the skeleton, if people are as tall then.

    By Acclaim's definition that is a factor of no unit, and inches are a custom (of the CMU
    collection, with 0.45).
    """
    if skeleton.length is None:
        return None
    millimetres = INCH_MM / skeleton.length
    if not PLAUSIBLE_MM[0] <= body_height(ends, names) * millimetres <= PLAUSIBLE_MM[1]:
        return None
    name = "asf" if skeleton.length == 0.45 else f"in/{skeleton.length:g}"
    reason = f"the skeleton says length {skeleton.length:g}, which is inches over that"
    return Unit(name, millimetres, reason)
