"""Acclaim files: a motion (AMC) and, beside it, the skeleton that moves (ASF) -> where bones end.

A bone turns about the axes of its own frame, which the skeleton describes: with C from its ``axis``
and M from its channels, ``R = R_parent C M C^-1``, and it reaches from the end of its parent along
``R (direction * length)`` (Schafer 1995). All turns are about fixed axes, one after the other.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import xarray as xr
from scipy.spatial.transform import Rotation

from eigenwalker.core.kinematics import forward_kinematics
from eigenwalker.core.trajectories import label_trajectories
from eigenwalker.io.assumed_rate import assume_rate
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.readers.acclaim_grammar import Acclaim, Bone, Motion, parse_amc, parse_asf
from eigenwalker.io.sniff import content_of
from eigenwalker.io.up_axis_and_unit import (
    PLAUSIBLE_MM,
    Unit,
    body_height,
    guess_unit,
    turn_upright,
    up_axis,
)
from eigenwalker.markers.marker_sets import numbered

CMU_RATE_HZ = 120.0
"""AMC files tell no rate; the CMU collection, where nearly all of them come from, has this one."""
INCH_MM = 25.4
MOST_POSITIONS = 100_000_000
"""More bones times frames are no capture of a person but a damaged file."""

_FIRST_WORDS = re.compile(rb"(?:\s*#[^\n]*\n)*\s*:([a-z-]+)", re.IGNORECASE)


def looks_like_acclaim(content: bytes) -> bool:
    """Return whether a file begins as motions (AMC) or skeletons (ASF) do."""
    return _first_keyword(content) in _OF_MOTIONS | _OF_SKELETONS


_OF_MOTIONS = {"fully-specified", "degrees", "radians", "samples-per-second"}
_OF_SKELETONS = {"version", "name", "units", "documentation", "root", "bonedata", "hierarchy"}


def _first_keyword(content: bytes) -> str:
    hit = _FIRST_WORDS.match(content[:4096].removeprefix(b"\xef\xbb\xbf"))
    return hit[1].decode().lower() if hit else ""


def read_asf_amc(
    content: bytes,
    *,
    source: str,
    path: Path,
    unit: Unit | None = None,
    rate_hz: float | None = None,
) -> xr.DataArray:
    """Return where the bones of an Acclaim motion end.

    Parameters
    ----------
    content : bytes
        The whole motion (AMC).
    source : str
        Its name, for messages.
    path : Path
        Where it lies: the skeleton is the ASF file beside it of the same name, or of the part of
        the name that tells the subject (35.asf for 35_01.amc), or the only one in the folder.
    unit : Unit, optional
        Unit of lengths; the one that the skeleton tells if left out.
    rate_hz : float, optional
        Frames a second; assumed to be 120, with a warning, where neither this nor the file tells.

    Returns
    -------
    DataArray of shape (time, marker, axis)
        In millimetres, z up. A marker is the end of the bone whose name it has, ``root`` where the
        body hangs. The coordinate ``rotation`` (time, marker, axis) holds how each bone is turned
        in the room from where it is at rest, as rotation vectors in radians.

    Raises
    ------
    UnreadableFile
        If motion or skeleton are damaged or cut short, do not belong together, or there is no one
        skeleton.

    """
    if _first_keyword(content) in _OF_SKELETONS:
        raise UnreadableFile(
            source,
            "a motion (.amc)",
            "the skeleton alone",
            "name the motion, which finds the skeleton beside it",
        )
    motion = parse_amc(_text(content), source)
    beside = find_skeleton(path)
    skeleton = parse_asf(_text(content_of(beside)), beside.name)
    ends, turns = _pose(skeleton, motion, source, beside.name)
    names = numbered([bone.name for bone in skeleton.bones])
    up = up_axis(ends, names)
    turn = turn_upright(up or "y")
    ends = ends @ turn.T
    told = unit or _told_unit(skeleton, ends, names)
    unit = told or guess_unit(ends, names, source=beside.name)
    known_rate = rate_hz or motion.rate_hz
    rate = known_rate or CMU_RATE_HZ
    walk = label_trajectories(ends * unit.millimetres, markers=names, rate_hz=rate)
    turned = (Rotation.from_matrix(turn) * Rotation.from_quat(turns.reshape(-1, 4))).as_rotvec()
    walk = walk.assign_coords(rotation=(walk.dims, turned.reshape(walk.shape)))
    walk.attrs.update(
        source=source,
        format="ASF/AMC",
        skeleton=beside.name,
        up_axis=up or "y",
        up_axis_known=up is not None,
        unit=unit.name,
        unit_guessed=told is None,
        unit_reason=unit.reason,
        rate_assumed=False,
    )
    if known_rate is None:
        reason = "as nearly all motions of this format have it"
        walk.attrs.update(assume_rate(rate, source=source, reason=reason))
    return walk


def _text(content: bytes) -> str:
    return content.decode("utf-8-sig", errors="replace")


def find_skeleton(motion: Path) -> Path:
    """Return the skeleton that lies beside a motion.

    Parameters
    ----------
    motion : Path
        An AMC file.

    Returns
    -------
    Path
        The ASF file of the same name; else the one whose name is the beginning of the motion's;
        else the only one in the folder.

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


def _pose(
    skeleton: Acclaim, motion: Motion, source: str, beside: str
) -> tuple[np.ndarray, np.ndarray]:
    """Return where all bones end and how they are turned, in the frame and unit of the files."""
    bones, channels = skeleton.bones, motion.channels
    known = {bone.name.lower() for bone in bones}
    if strange := sorted(set(channels) - known) or not channels:
        came = f"{strange}, which it lacks" if channels else "none"
        raise UnreadableFile(
            source, f"motions of the bones of {beside}", came, "put its own skeleton beside it"
        )
    n_frames = len(next(iter(channels.values())))
    if n_frames * len(bones) > MOST_POSITIONS:
        raise UnreadableFile(
            source, "the capture of one person", f"{n_frames} frames", "cut it into shorter files"
        )
    degrees = skeleton.degrees if motion.degrees is None else motion.degrees
    turns, moves = [], np.zeros((n_frames, 3))
    for bone in bones:
        values = channels.get(bone.name.lower(), np.zeros((n_frames, len(bone.channels))))
        if values.shape[1] != len(bone.channels):
            raise UnreadableFile(
                source,
                f"{len(bone.channels)} numbers of {bone.name} in each frame, as {beside} says",
                f"{values.shape[1]}",
                "put its own skeleton beside it",
            )
        turns.append(_turns(bone, values, degrees=degrees, axis_degrees=skeleton.degrees))
        for column, channel in enumerate(bone.channels):
            if channel.startswith("t"):
                moves[:, "xyz".index(channel[1])] += values[:, column]
    return _ends(bones, np.stack(turns, axis=1), skeleton.position + moves)


def _turns(bone: Bone, values: np.ndarray, *, degrees: bool, axis_degrees: bool) -> np.ndarray:
    """Return how a bone turns from its parent's turn: quaternions of shape (time, 4).

    What the root's orientation is at rest comes before its motion.
    """
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


def _told_unit(skeleton: Acclaim, ends: np.ndarray, names: list[str]) -> Unit | None:
    """Return the unit of the skeleton: inches over its ``length``, if people are so tall.

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
