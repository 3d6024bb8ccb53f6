"""The words and numbers of a BVH file: the skeleton, and the table of its channels.

The grammar is that of Biovision (a HIERARCHY of joints with OFFSET and CHANNELS, then a MOTION
table), read as programs write it: channels in any order and for each joint its own, positions for
joints other than the root, frame times rounded to a few digits.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from eigenwalker.io.capture_file import CaptureFile
from eigenwalker.io.frame_time import rate_of_step
from eigenwalker.io.text_cells import number, plain_numbers
from eigenwalker.io.timestamps import RATES_HZ

MAX_JOINTS = 2000
"""More joints are no person's skeleton but a damaged file."""
_DECLARED = re.compile(
    r"\s*Frames\s*(?::\s*)?(\d{1,9})\s*Frame\s+Time\s*(?::\s*)?(\S+)", re.IGNORECASE
)


@dataclass
class Joint:
    """A joint or end site as the HIERARCHY describes it."""

    name: str
    parent: int
    offset: tuple[float, float, float] = (0.0, 0.0, 0.0)
    channels: tuple[str, ...] = ()


class Motion(NamedTuple):
    """The table of channels, array (time, channel), and the frames a second."""

    values: np.ndarray
    rate_hz: float


def parse_bvh(file: CaptureFile) -> tuple[list[Joint], Motion, dict[str, object]]:
    """Return the joints of a BVH file, parents before children, and their channels."""
    head, table = _split(file, file.text)
    joints = _hierarchy(file, head)
    motion, attrs = _motion(file, table, sum(len(joint.channels) for joint in joints))
    return joints, motion, attrs


def _split(file: CaptureFile, text: str) -> tuple[str, str]:
    parts = re.split(r"(?im)^[^\S\n]*MOTION\b", text, maxsplit=1)
    if len(parts) < 2:
        raise file.error("a line MOTION after the skeleton", "none: the file is cut short")
    return parts[0], parts[1]


def _hierarchy(file: CaptureFile, text: str) -> list[Joint]:
    words = iter(re.sub(r"([{}])", r" \1 ", text).split())
    joints: list[Joint] = []
    open_joints: list[int] = []
    if next(words, "").upper() != "HIERARCHY":
        raise file.error("the word HIERARCHY at its beginning", "another")
    for word in words:
        match word.upper():
            case "ROOT" | "JOINT" | "END":
                parent = open_joints[-1] if open_joints else -1
                name = " ".join(_until_brace(words)) or "joint"
                if word.upper() == "END" and parent >= 0:
                    name = f"{joints[parent].name}_end"
                joints.append(Joint(name, parent))
                open_joints.append(len(joints) - 1)
            case "OFFSET" if open_joints:
                x, y, z = (number(next(words, ""), "an OFFSET", file) for _ in range(3))
                joints[open_joints[-1]].offset = (x, y, z)
            case "CHANNELS" if open_joints:
                joints[open_joints[-1]].channels = _channels(file, words)
            case "}" if open_joints:
                open_joints.pop()
            case _:
                raise file.error("ROOT, JOINT, End Site, OFFSET, CHANNELS or }", repr(word[:40]))
        if len(joints) > MAX_JOINTS:
            raise file.error("the skeleton of a person", f"more than {MAX_JOINTS} joints")
    if open_joints or not joints:
        raise file.error("a closed skeleton", f"{len(open_joints)} joints without their }}")
    return joints


def _until_brace(words: Iterator[str]) -> Iterator[str]:
    for word in words:
        if word == "{":
            return
        yield word


def _channels(file: CaptureFile, words: Iterator[str]) -> tuple[str, ...]:
    count = next(words, "")
    if not re.fullmatch(r"\d", count):
        raise file.error("a number of CHANNELS up to 6", repr(count[:40]))
    channels = tuple(next(words, "") for _ in range(int(count)))
    plain = tuple(channel.lower() for channel in channels)
    unknown = [c for c in plain if not re.fullmatch(r"[xyz](position|rotation)", c)]
    if unknown or len(set(plain)) < len(plain):
        raise file.error("CHANNELS such as Xposition and Zrotation, each once", f"{channels}")
    return plain


def _motion(file: CaptureFile, text: str, n_channels: int) -> tuple[Motion, dict[str, object]]:
    """Return the table of channels and the rate, declared against delivered."""
    declared = _DECLARED.match(text)
    if not declared:
        raise file.error("the lines 'Frames:' and 'Frame Time:'", repr(text[:60].strip()))
    n_frames = int(declared[1])
    step = number(declared[2], "the frame time", file)
    rows = [line for line in text[declared.end() :].splitlines() if line and not line.isspace()]
    cut = "" if text[-1].isspace() else _cut_number(rows)
    may_be_cut = file.keep_partial and len(rows) <= n_frames and not text.endswith("\n")
    if may_be_cut and rows and (len(rows) < n_frames or len(rows[-1].split()) < n_channels or cut):
        rows.pop()  # the file may end within its last line
    attrs = file.check_frames(n_frames, len(rows))
    if not n_frames:
        raise file.error(f"{n_channels} numbers a frame", "no frames")
    if cut and not attrs:
        expected = "as many decimals in the last number as in all others"
        raise file.error(expected, f"{cut} at its end: the file is cut short")
    if step <= 0:
        raise file.error("a frame time above 0", declared[2][:40])
    if not RATES_HZ[0] <= 1 / step <= RATES_HZ[1]:
        expected = f"frames a second between {RATES_HZ[0]:g} and {RATES_HZ[1]:g}"
        got = f"{1 / step:.3g}, by the frame time {declared[2][:40]}"
        raise file.error(expected, got, "put the frame time right")
    rate_hz, assumed = _rate(file, declared[2])
    return Motion(_table(file, rows, n_channels), rate_hz), {**attrs, **assumed}


def _cut_number(rows: Sequence[str]) -> str:
    """Return the last number if it has fewer decimals than all others: the file ends within it."""
    decimals = [len(word.partition(".")[2]) for row in rows for word in row.split()]
    is_cut = len(set(decimals[:-1])) == 1 and decimals[-1] < decimals[0]
    return repr(rows[-1].split()[-1]) if is_cut else ""


def _table(file: CaptureFile, rows: Sequence[str], n_channels: int) -> np.ndarray:
    table = np.empty((len(rows), n_channels))
    for at, line in enumerate(rows):
        words = line.split()
        if len(words) != n_channels:
            raise file.error(f"{n_channels} numbers a frame", f"{len(words)} in frame {at + 1}")
        row = plain_numbers(words)
        if row is None or np.isnan(row).any():
            row = [number(word, f"frame {at + 1}", file) for word in words]
        table[at] = row
    return table


def _rate(file: CaptureFile, written: str) -> tuple[float, dict[str, object]]:
    """Return the usual rate whose frame time, rounded as `written`, is the one in the file."""
    step = float(written)
    decimals = len(written.partition(".")[2]) if "e" not in written.lower() else 12
    rounding = max(0.5000001 * 10.0**-decimals, 1e-6 * step)
    return rate_of_step(file, step, rounding, f"frame time {written}")
