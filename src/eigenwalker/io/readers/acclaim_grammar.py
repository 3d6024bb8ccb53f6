"""The words and numbers of Acclaim files: a skeleton (ASF), and how its bones turn (AMC).

The grammar is that of M. Schafer's definition, version 1.10: keywords begin with a colon, commas
and parentheses are blanks, and what follows ``#`` is a comment.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from eigenwalker.io.capture_file import CaptureFile
from eigenwalker.io.text_cells import number, plain_numbers
from eigenwalker.io.timestamps import parse_rate

MAX_BONES = 2000
"""More bones are no person's skeleton but a damaged file."""
ROOT = "root"

_TURNS = {"rx", "ry", "rz"}
_MOVES = {"tx", "ty", "tz"}
_ORDER = re.compile(r"[xyz]{3}")


@dataclass
class Bone:
    """A bone as the skeleton describes it; the root is one of no length."""

    name: str
    parent: int
    """Index of the bone at whose end it begins; -1 for the root."""
    reach: np.ndarray
    """From its beginning to its end when the skeleton is at rest, in the frame of the room."""
    axis: np.ndarray
    """Angles by which its own frame is turned from the room's, in the unit of the file."""
    axis_order: str
    """About which axes of the room, one after the other, such as ``"xyz"``."""
    channels: tuple[str, ...]
    """Numbers a frame in the motion, such as ``("rx", "ry", "rz")``."""


class Acclaim(NamedTuple):
    """A skeleton: its bones, parents first, where its root stands at rest, and its units."""

    bones: list[Bone]
    position: np.ndarray
    length: float | None
    degrees: bool


class Motion(NamedTuple):
    """Channels of each bone, array (time, channel); degrees and rate where the file names them."""

    channels: dict[str, np.ndarray]
    degrees: bool | None
    rate_hz: float | None


_Lines = list[list[str]]


def parse_asf(file: CaptureFile) -> Acclaim:
    """Return the skeleton that an ASF file describes."""
    sections = _sections(file.text)
    for expected in ("root", "bonedata", "hierarchy"):
        if expected not in sections:
            raise file.error(f"a section :{expected} in the skeleton", "none")
    units = {line[0].lower(): line[1] for line in sections.get("units", []) if len(line) > 1}
    entry = {line[0].lower(): line[1:] for line in sections["root"]}
    described = {ROOT: _root(entry, file)}
    for block in _blocks(sections["bonedata"], "bonedata", file):
        bone = _bone(block, file)
        if bone.name.lower() in described:
            raise file.error("each bone once", f"{bone.name!r} twice")
        described[bone.name.lower()] = bone
        if len(described) > MAX_BONES:
            raise file.error("a person's skeleton", f"more than {MAX_BONES} bones")
    (links,) = [*_blocks(sections["hierarchy"], "hierarchy", file)][:1] or [[]]
    length = number(units["length"], "the unit of length", file) if "length" in units else None
    return Acclaim(
        bones=_in_order(described, links, file),
        position=_three(entry.get("position", ["0"] * 3), "the position of the root", file),
        length=length if length and length > 0 else None,
        degrees=not units.get("angle", "deg").lower().startswith("rad"),
    )


def _sections(text: str) -> dict[str, _Lines]:
    sections: dict[str, _Lines] = {}
    lines: _Lines = []
    for line in text.splitlines():
        words = re.sub(r"#.*|[(),]", " ", line).split()
        if words and words[0].startswith(":"):
            lines = sections.setdefault(words[0][1:].lower(), [])
            words = words[1:]
        if words:
            lines.append(words)
    return sections


def _blocks(lines: _Lines, section: str, file: CaptureFile) -> list[_Lines]:
    blocks: list[_Lines] = []
    is_open = False
    for line in lines:
        word = line[0].lower()
        if word == "begin" and not is_open:
            blocks.append([])
        elif word != "end" and is_open:
            blocks[-1].append(line)
        elif word != "end" or not is_open:
            got = " ".join(line)[:40]
            raise file.error(f"begin and end in turn in :{section}", repr(got))
        is_open = word != "end"
    if is_open or not blocks:
        raise file.error(f"blocks with an end in :{section}", "none: it is cut short")
    return blocks


def _root(entry: dict[str, list[str]], file: CaptureFile) -> Bone:
    return Bone(
        name=ROOT,
        parent=-1,
        reach=np.zeros(3),
        axis=_three(entry.get("orientation", ["0"] * 3), "the orientation of the root", file),
        axis_order=_order(entry.get("axis", ["xyz"]), ROOT, file),
        channels=_channels(entry.get("order", []), _MOVES | _TURNS, ROOT, file),
    )


def _bone(block: _Lines, file: CaptureFile) -> Bone:
    entry = {line[0].lower(): line[1:] for line in block}
    name = " ".join(entry.get("name", []))
    lacking = [key for key in ("name", "direction", "length", "axis") if not entry.get(key)]
    if lacking:
        raise file.error(f"{lacking} of each bone", f"none for {name or 'one'!r}")
    direction = _three(entry["direction"], f"the direction of {name}", file)
    norm = np.linalg.norm(direction)
    length = number(entry["length"][0], f"the length of {name}", file)
    if length < 0 or (length > 0 and not 0.9 < norm < 1.1):
        got = f"{length:g} along a direction of length {norm:.3g}"
        expected = f"a length of {name} above 0, along a direction of length 1"
        raise file.error(expected, got)
    return Bone(
        name=name,
        parent=-1,
        reach=direction / norm * length if length else np.zeros(3),
        axis=_three(entry["axis"][:3], f"the axis of {name}", file),
        axis_order=_order(entry["axis"][3:], name, file),
        channels=_channels(entry.get("dof", []), _TURNS, name, file),
    )


def _three(words: Sequence[str], where: str, file: CaptureFile) -> np.ndarray:
    if len(words) != 3:
        raise file.error(f"3 numbers in {where}", f"{len(words)}")
    return np.array([number(word, where, file) for word in words])


def _order(words: Sequence[str], name: str, file: CaptureFile) -> str:
    order = "".join(words).lower() or "xyz"
    if not _ORDER.fullmatch(order) or len(set(order)) < 3:
        raise file.error(f"an order of axes such as XYZ for {name}", repr(order[:40]))
    return order


def _channels(
    words: Sequence[str], known: set[str], name: str, file: CaptureFile
) -> tuple[str, ...]:
    channels = tuple(word.lower() for word in words)
    if not set(channels) <= known or len(set(channels)) < len(channels):
        raise file.error(
            f"each of {sorted(known)} once at most for {name}",
            f"{' '.join(words)[:60]!r}",
            "export positions instead, as C3D",
        )
    return channels


def _in_order(described: dict[str, Bone], links: _Lines, file: CaptureFile) -> list[Bone]:
    parents: dict[str, str] = {}
    for parent, *children in links:
        for name in children:
            if name.lower() in parents or name.lower() == ROOT:
                raise file.error("one parent a bone", f"several for {name!r}")
            parents[name.lower()] = parent.lower()
    if unknown := sorted({*parents, *parents.values()} - set(described)):
        raise file.error("bones of the section :bonedata", f"{unknown}")
    children_of: dict[str, list[str]] = {}
    for name, parent in parents.items():
        children_of.setdefault(parent, []).append(name)
    order = [ROOT]
    for name in order:
        order += children_of.get(name, [])
    if loose := sorted(set(described) - set(order)):
        raise file.error("each bone in the hierarchy", f"none for {loose}")
    places = {name: place for place, name in enumerate(order)}
    for name in order[1:]:
        described[name].parent = places[parents[name]]
    return [described[name] for name in order]


def parse_amc(file: CaptureFile) -> Motion:
    """Return the channels of all bones in an AMC file."""
    keywords: dict[str, list[str]] = {}
    lines: _Lines = []
    for line in file.text.splitlines():
        words = line.split()
        if words and words[0].startswith(":"):
            keywords[words[0][1:].lower()] = words[1:]
        elif words and not words[0].startswith("#"):
            lines.append(words)
    channels = _frames(lines, file)
    if not file.content[-1:].isspace():
        _refuse_cut_number(lines, file)
    rate = keywords.get("samples-per-second")
    return Motion(
        channels=channels,
        degrees=True if "degrees" in keywords else False if "radians" in keywords else None,
        rate_hz=parse_rate(rate[0], "samples-per-second", file) if rate else None,
    )


def _frames(lines: _Lines, file: CaptureFile) -> dict[str, np.ndarray]:
    starts = [i for i, words in enumerate(lines) if len(words) == 1 and words[0].isdecimal()]
    if not starts or starts[0] != 0:
        raise file.error("the number of a frame at its beginning", "none")
    count = [int(lines[start][0][:9]) for start in starts]
    skipped = [frame for frame, later in pairwise(count) if later != frame + 1]
    if skipped:
        raise file.error(f"frame {skipped[0] + 1} after {skipped[0]}", "another")
    size = starts[1] - starts[0] if len(starts) > 1 else len(lines)
    for frame, start, end in zip(count, starts, [*starts[1:], len(lines)], strict=True):
        if end - start != size:
            raise file.error(
                f"{size - 1} bones in each frame",
                f"{end - start - 1} in frame {frame}: the file is cut short or damaged",
            )
    channels: dict[str, np.ndarray] = {}
    for line in range(1, size):
        rows = [lines[start + line] for start in starts]
        name = rows[0][0]
        if name.lower() in channels or any(row[0] != name for row in rows):
            raise file.error(f"{name!r} once in each frame", "another bone in its place")
        channels[name.lower()] = _table([row[1:] for row in rows], name, file)
    return channels


def _table(rows: _Lines, name: str, file: CaptureFile) -> np.ndarray:
    size = len(rows[0])
    ragged = [frame for frame, row in enumerate(rows, 1) if len(row) != size]
    if ragged:
        got = f"{len(rows[ragged[0] - 1])} in its frame no. {ragged[0]}"
        raise file.error(f"{size} numbers of {name} in each frame", got)
    table = plain_numbers([word for row in rows for word in row])
    if table is None or np.isnan(table).any():
        where = [f"{name} in frame no. {frame}" for frame in range(1, len(rows) + 1)]
        table = np.array(
            [[number(word, at, file) for word in row] for row, at in zip(rows, where, strict=True)]
        )
    return table.reshape(len(rows), size)


def _refuse_cut_number(lines: _Lines, file: CaptureFile) -> None:
    """Refuse a file whose last number is shorter than all others of its column: it ends within."""
    column = [len(words[-1]) for words in lines if words[0] == lines[-1][0]]
    if len(column) > 1 and column[-1] < min(column[:-1]):
        got = f"{lines[-1][-1]!r} as the last: the file is cut short"
        raise file.error("the last number as long as others", got)
