"""Tables that Vicon's programs export (ASCII, CSV): blocks of markers and of model outputs.

A block is a line with what it holds, its rate, a line of names (``Anna:LKNE``), a line of axes, a
line of units, and a line a frame; an empty line ends it.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr

from eigenwalker.io.capture_file import CaptureFile
from eigenwalker.io.text_cells import cells, separator_of
from eigenwalker.io.text_table import TableValues, TextTable, table_trajectories, table_values
from eigenwalker.io.timestamps import declared_rate, on_even_clock
from eigenwalker.io.to_trajectories import FileFrame, unit_named

BLOCKS = ("trajectories", "model outputs")
"""The blocks that hold positions; devices, events and joints are passed over."""

MAX_BLOCKS = 100
_TITLE = re.compile(
    rb'^(?:\xef\xbb\xbf)?[ \t,;"]*(trajectories|model outputs)[ \t,;"]*$', re.I | re.M
)
_HEAD = re.compile(rb'^"?frame"? *[,;\t][ \t]*"?sub\s?frame', re.I | re.M)
_EDGES = ' \t,;"'


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


def read_vicon_csv(file: CaptureFile) -> xr.DataArray:
    """Return the trajectories of the markers in a Vicon export.

    Frame 1 of the capture is at 0 s. Of model outputs, those in units of length are taken, and
    origins of segments are called as in C3D files (``LFEO``).
    """
    lines = file.lines
    starts = [at for at, line in enumerate(lines) if line.strip(_EDGES).lower() in BLOCKS]
    if len(starts) > MAX_BLOCKS:
        advice = "export the markers alone"
        raise file.error(f"{MAX_BLOCKS} blocks at most", f"{len(starts)}", advice)
    blocks = [block for at in starts if (block := _block(file, lines, at))]
    if not blocks:
        wanted = "a block of Trajectories in lengths"
        raise file.error(wanted, "none", "tick Trajectories when exporting")
    whole = blocks[0]
    same = [
        block
        for block in blocks
        if block.rate_hz == whole.rate_hz and np.array_equal(block.frames, whole.frames)
    ]
    units = set[str]().union(*(block.units for block in same))
    if len(units) > 1:
        raise file.error("one unit of length", f"{sorted(units)}")
    positions = np.concatenate([block.positions for block in same], axis=1)
    time = (whole.frames - 1) / whole.rate_hz
    even = on_even_clock(file, positions, time, whole.rate_hz)
    return table_trajectories(
        file,
        TableValues(even.positions),
        [name for block in same for name in block.names],
        format_name="Vicon CSV",
        rate_hz=whole.rate_hz,
        start_s=even.start_s,
        frame=FileFrame(unit_named(units.pop())),
    )


def _block(file: CaptureFile, lines: Sequence[str], at: int) -> _Block | None:
    """Return the block whose title stands on a line; None if nothing in it is a position."""
    if len(lines) < at + 6:
        raise file.error("six lines in a block or more", f"{len(lines) - at}")
    separator = separator_of(lines[at + 3])
    names, head, units = (cells(lines[at + row], separator) for row in (2, 3, 4))
    rate_hz = declared_rate(file, lines[at + 1].strip(_EDGES), "rate of the block")
    if [word.lower().replace(" ", "") for word in head[:2]] != ["frame", "subframe"]:
        raise file.error("the columns Frame and Sub Frame", repr(lines[at + 3][:40]))
    while head and not head[-1]:
        head.pop()
    points = _points(names, head, units)
    end = next((i for i in range(at + 5, len(lines)) if not lines[i].strip(" \t,;")), len(lines))
    table = TextTable(
        list(points),
        [columns for columns, _ in points.values()],
        lines[at + 5 : end],
        n_columns=len(head),
        separator=separator,
        first_line=at + 6,
        time_column=0,
        ends_file=end == len(lines),
    )
    values = table_values(file, table)
    if values.time is None or not np.all(np.isfinite(values.time)):
        got = f"{len(table.rows)} lines, some without numbers"
        raise file.error("numbered frames", got)
    if not points:
        return None
    in_units = {unit for _, unit in points.values()}
    return _Block(list(points), values.positions, values.time + 0.0, rate_hz, in_units)


def _points(
    names: Sequence[str], head: Sequence[str], units: Sequence[str]
) -> dict[str, tuple[tuple[int, int, int], str]]:
    points: dict[str, tuple[tuple[int, int, int], str]] = {}
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
            points.setdefault(label, ((at, at + 1, at + 2), unit))
    return points
