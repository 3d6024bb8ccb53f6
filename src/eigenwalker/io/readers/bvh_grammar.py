"""The words and numbers of a BVH file: the skeleton, and the table of its channels.

The grammar is that of Biovision (a HIERARCHY of joints with OFFSET and CHANNELS, then a MOTION
table), read as programs write it: channels in any order and for each joint its own, positions for
joints other than the root, frame times rounded to a few digits.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from eigenwalker.io.errors import AGAIN, UnreadableFile
from eigenwalker.io.timestamps import RATES_HZ

MOST_JOINTS = 2000
"""More joints are no person's skeleton but a damaged file."""
MOST_DISTANT = 1e9
"""No length, angle or time in a sound file is larger than this."""
USUAL_RATES_HZ = (
    *(24, 25, 30, 48, 50, 60, 72, 75, 80, 90, 96, 100, 120, 125, 128, 144, 150, 160, 180, 192),
    *(200, 240, 250, 256, 300, 360, 400, 480, 500, 512, 600, 960, 1000),
    *(24000 / 1001, 30000 / 1001, 60000 / 1001, 120000 / 1001, 240000 / 1001),
)

_NUMBER = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?", re.ASCII)
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


def parse_bvh(text: str, source: str) -> tuple[list[Joint], Motion]:
    """Return the joints of a BVH file, parents before children, and their channels.

    Raises
    ------
    UnreadableFile
        If the text is against the grammar, or holds other frames than it declares.

    """
    head, table = _split(text, source)
    joints = _hierarchy(head, source)
    return joints, _motion(table, sum(len(joint.channels) for joint in joints), source)


def _split(text: str, source: str) -> tuple[str, str]:
    """Return the HIERARCHY and what follows the word MOTION."""
    parts = re.split(r"(?im)^[^\S\n]*MOTION\b", text, maxsplit=1)
    if len(parts) < 2:
        raise UnreadableFile(
            source, "a line MOTION after the skeleton", "none: the file is cut short"
        )
    return parts[0], parts[1]


def _hierarchy(text: str, source: str) -> list[Joint]:
    """Return the joints in the order of their channels, parents before children."""
    words = iter(re.sub(r"([{}])", r" \1 ", text).split())
    joints: list[Joint] = []
    open_joints: list[int] = []
    if next(words, "").upper() != "HIERARCHY":
        raise UnreadableFile(source, "the word HIERARCHY at its beginning", "another")
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
                x, y, z = (_number(next(words, ""), "an OFFSET", source) for _ in range(3))
                joints[open_joints[-1]].offset = (x, y, z)
            case "CHANNELS" if open_joints:
                joints[open_joints[-1]].channels = _channels(words, source)
            case "}" if open_joints:
                open_joints.pop()
            case _:
                raise UnreadableFile(
                    source, "ROOT, JOINT, End Site, OFFSET, CHANNELS or }", repr(word[:40])
                )
        if len(joints) > MOST_JOINTS:
            raise UnreadableFile(
                source, "the skeleton of a person", f"more than {MOST_JOINTS} joints"
            )
    if open_joints or not joints:
        raise UnreadableFile(
            source, "a closed skeleton", f"{len(open_joints)} joints without their }}"
        )
    return joints


def _until_brace(words: Iterator[str]) -> Iterator[str]:
    for word in words:
        if word == "{":
            return
        yield word


def _channels(words: Iterator[str], source: str) -> tuple[str, ...]:
    count = next(words, "")
    if not re.fullmatch(r"\d", count):
        raise UnreadableFile(source, "a number of CHANNELS up to 6", repr(count[:40]))
    channels = tuple(next(words, "") for _ in range(int(count)))
    plain = tuple(channel.lower() for channel in channels)
    unknown = [c for c in plain if not re.fullmatch(r"[xyz](position|rotation)", c)]
    if unknown or len(set(plain)) < len(plain):
        raise UnreadableFile(
            source, "CHANNELS such as Xposition and Zrotation, each once", f"{channels}"
        )
    return plain


def _number(word: str, where: str, source: str) -> float:
    number = float(word) if _NUMBER.fullmatch(word) else np.nan
    if not abs(number) < MOST_DISTANT:
        advice = "write numbers with a decimal point" if "," in word else AGAIN
        raise UnreadableFile(source, f"a finite number in {where}", repr(word[:40]), advice)
    return number


def _motion(text: str, n_channels: int, source: str) -> Motion:
    """Return the table of channels and the rate, declared against delivered."""
    declared = _DECLARED.match(text)
    if not declared:
        raise UnreadableFile(
            source, "the lines 'Frames:' and 'Frame Time:'", repr(text[:60].strip())
        )
    n_frames = int(declared[1])
    step = _number(declared[2], "the frame time", source)
    rows = [row for line in text[declared.end() :].splitlines() if (row := line.split())]
    if len(rows) != n_frames:
        why = "the file is cut short" if len(rows) < n_frames else "the count is wrong"
        raise UnreadableFile(source, f"{n_frames} frames, as it declares", f"{len(rows)}: {why}")
    ragged = [i for i, row in enumerate(rows) if len(row) != n_channels]
    if not n_frames or ragged:
        came = f"{len(rows[ragged[0]])} in frame {ragged[0] + 1}" if ragged else "no frames"
        raise UnreadableFile(source, f"{n_channels} numbers a frame", came)
    if not text[-1].isspace():
        _refuse_cut_number(rows, source)
    if step <= 0:
        raise UnreadableFile(source, "a frame time above 0", declared[2][:40])
    if not RATES_HZ[0] <= 1 / step <= RATES_HZ[1]:
        wanted = f"frames a second between {RATES_HZ[0]:g} and {RATES_HZ[1]:g}"
        came = f"{1 / step:.3g}, by the frame time {declared[2][:40]}"
        raise UnreadableFile(source, wanted, came, "put the frame time right")
    return Motion(_table(rows, source), _rate(declared[2]))


def _refuse_cut_number(rows: list[list[str]], source: str) -> None:
    """Refuse a file whose last number has fewer decimals than all others: it ends within it."""
    decimals = [len(word.partition(".")[2]) for row in rows for word in row]
    if len(set(decimals[:-1])) == 1 and decimals[-1] < decimals[0]:
        raise UnreadableFile(
            source,
            f"{decimals[0]} decimals in each number",
            f"{rows[-1][-1]!r} as the last: the file is cut short",
        )


def _table(rows: list[list[str]], source: str) -> np.ndarray:
    try:
        table = np.array(rows, dtype=float)
    except ValueError:
        table = None
    if not all(word.isascii() and "_" not in word for row in rows for word in row):
        table = None  # numpy takes 1_0 for 10, where it is more likely a damaged 1.0
    if table is None or not (np.abs(table) < MOST_DISTANT).all():
        for row, words in enumerate(rows, 1):
            for word in words:
                _number(word, f"frame {row}", source)
        raise UnreadableFile(source, "numbers", "something else")
    return table


def _rate(written: str) -> float:
    """Return the usual rate whose frame time, rounded as `written`, is the one in the file."""
    step = float(written)
    decimals = len(written.partition(".")[2]) if "e" not in written.lower() else 12
    rounding = max(0.5000001 * 10.0**-decimals, 1e-6 * step)
    near = [rate for rate in USUAL_RATES_HZ if abs(1 / rate - step) <= rounding]
    whole = [rate for rate in near if rate == int(rate)]
    return float(min(whole or near or [1 / step], key=lambda rate: abs(1 / rate - step)))
