"""Tables that Vicon's programs export (ASCII, CSV): blocks of markers and of model outputs.

A block is a line with what it holds, its rate, a line of names (``Anna:LKNE``), a line of axes, a
line of units, and a line a frame; an empty line ends it.
"""

from __future__ import annotations

import re
from typing import NamedTuple

import numpy as np
import xarray as xr

from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.text_table import cells, lines_of, refuse_cut_number, separator_of, table_of
from eigenwalker.io.timestamps import on_even_clock, rate_of
from eigenwalker.io.to_trajectories import as_captured, unit_named
from eigenwalker.io.up_axis_and_unit import Unit

BLOCKS = ("trajectories", "model outputs")
"""The blocks that hold positions; devices, events and joints are passed over."""

_TITLE = re.compile(
    rb'^(?:\xef\xbb\xbf)?[ \t,;"]*(trajectories|model outputs)[ \t,;"]*$', re.I | re.M
)
_HEAD = re.compile(rb'^"?frame"? *[,;\t][ \t]*"?sub\s?frame', re.I | re.M)


class _Block(NamedTuple):
    """Positions of one block with the numbers of their frames."""

    names: list[str]
    positions: np.ndarray
    frames: np.ndarray
    rate_hz: float
    units: set[str]


def looks_like_vicon_csv(content: bytes) -> bool:
    """Return whether a file has the title and the columns of a Vicon export."""
    beginning = content[:2_000_000].replace(b"\r", b"\n")
    return bool(_TITLE.search(beginning) and _HEAD.search(beginning))


def read_vicon_csv(
    content: bytes, *, source: str, unit: Unit | None = None, rate_hz: float | None = None
) -> xr.DataArray:
    """Return where the markers of a Vicon export are.

    Parameters
    ----------
    content : bytes
        The whole file.
    source : str
        Its name, for messages.
    unit : Unit, optional
        Unit of its lengths, where the one in the file is wrong.
    rate_hz : float, optional
        Frames a second, where those in the file are wrong.

    Returns
    -------
    DataArray of shape (time, marker, axis)
        In millimetres, z up, on the clock of the capture: frame 1 is at 0 s. Of model outputs,
        those in lengths are kept, and origins of segments are called as in C3D files (``LFEO``).

    Raises
    ------
    UnreadableFile
        If it holds no positions, is damaged or cut short.

    """
    lines = lines_of(content, source)
    blocks = [
        block
        for at, line in enumerate(lines)
        if line.strip(' \t,;"').lower() in BLOCKS
        and (block := _block(lines, at, content, source, rate_hz))
    ]
    if not blocks:
        raise UnreadableFile(
            source,
            "a block of Trajectories in lengths",
            "none",
            "tick Trajectories when exporting",
        )
    whole = blocks[0]
    for block in blocks[1:]:
        if block.rate_hz == whole.rate_hz and np.array_equal(block.frames, whole.frames):
            whole = whole._replace(
                names=whole.names + block.names,
                positions=np.concatenate([whole.positions, block.positions], axis=1),
                units=whole.units | block.units,
            )
    if len(whole.units) > 1:
        raise UnreadableFile(source, "one unit of length", f"{sorted(whole.units)}")
    even = on_even_clock(whole.positions, (whole.frames - 1) / whole.rate_hz, source, whole.rate_hz)
    return as_captured(
        even.positions,
        whole.names,
        rate_hz=whole.rate_hz,
        source=source,
        format_name="Vicon CSV",
        unit=unit,
        file_unit=unit_named(next(iter(whole.units))),
        start_s=even.start_s,
    )


def _block(
    lines: list[str], at: int, content: bytes, source: str, rate_hz: float | None
) -> _Block | None:
    """Return the block whose title stands on a line; None if nothing in it is a position."""
    if len(lines) < at + 6:
        raise UnreadableFile(source, "six lines in a block or more", f"{len(lines) - at}")
    separator = separator_of(lines[at + 3])
    head = cells(lines[at + 3], separator)
    rate = rate_hz or rate_of(lines[at + 1].strip(' \t,;"'), "rate of the block", source)
    if [word.lower().replace(" ", "") for word in head[:2]] != ["frame", "subframe"]:
        raise UnreadableFile(source, "the columns Frame and Sub Frame", repr(lines[at + 3][:40]))
    while head and not head[-1]:
        head.pop()
    names, units = (cells(lines[at + row], separator) for row in (2, 4))
    columns = _columns(names, head, units)
    rows = []
    for line in lines[at + 5 :]:
        if not line.strip(" \t,;"):
            break
        rows.append(line)
    table = table_of(rows, len(head), separator=separator, source=source, first=at + 6)
    if at + 5 + len(rows) == len(lines):
        refuse_cut_number(content, rows, source)
    frames = table[:, 0] + 0.0
    if not len(rows) or not np.all(np.isfinite(frames)):
        raise UnreadableFile(source, "numbered frames", f"{len(rows)} lines, some without numbers")
    if not columns:
        return None
    return _Block(
        list(columns),
        table[:, [triple for triple, _ in columns.values()]],
        frames,
        rate,
        {unit for _, unit in columns.values()},
    )


def _columns(
    names: list[str], head: list[str], units: list[str]
) -> dict[str, tuple[tuple[int, int, int], str]]:
    """Return for each point its three columns and their unit."""
    found: dict[str, tuple[tuple[int, int, int], str]] = {}
    name = ""
    for at in range(2, len(head) - 2):
        name = names[at] if at < len(names) and names[at] else name
        axes = "".join(head[at : at + 3]).upper()
        measured = {word.lower() for word in units[at : at + 3]}
        if axes not in ("XYZ", "TXTYTZ") or len(measured) != 1 or not name:
            continue
        unit = measured.pop()
        if unit_named(unit):
            label = name + ("O" if axes == "TXTYTZ" else "")
            found.setdefault(label, ((at, at + 1, at + 2), unit))
    return found
