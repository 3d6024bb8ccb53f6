"""TRC files: tracks of markers in rows and columns, as Cortex, OpenSim and Pose2Sim write them.

Two lines of keys and their values, a line of names, a line of X1 Y1 Z1 ..., then a line a frame.
Empty cells and 0, 0, 0 exactly mean that a marker was not seen.
"""

from __future__ import annotations

import re
from typing import NamedTuple

import numpy as np
import xarray as xr

from eigenwalker.io.column_names import points_of
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.text_table import cells, lines_of, refuse_cut_number, table_of
from eigenwalker.io.timestamps import on_even_clock, rate_of
from eigenwalker.io.to_trajectories import as_captured, unit_named, without_zeros
from eigenwalker.io.up_axis_and_unit import Unit

_KEYS = ("numframes", "nummarkers")
_COUNT = re.compile(r"\d{1,9}", re.ASCII)
_IN_FRONT = 2  # columns for the number of the frame and its time


class _Head(NamedTuple):
    """What stands above the table, and the line on which that begins."""

    values: dict[str, str]
    names: list[str]
    tabs: bool
    first: int


def looks_like_trc(content: bytes) -> bool:
    """Return whether a file begins as TRC files do."""
    return content.lstrip(b"\xef\xbb\xbf \t\r\n\"'")[:12].lower() == b"pathfiletype"


def read_trc(
    content: bytes, *, source: str, unit: Unit | None = None, rate_hz: float | None = None
) -> xr.DataArray:
    """Return where the markers of a TRC file are.

    Parameters
    ----------
    content : bytes
        The whole file.
    source : str
        Its name, for messages.
    unit : Unit, optional
        Unit of its lengths, where the file names none or the wrong one.
    rate_hz : float, optional
        Frames a second, where the file names the wrong ones.

    Returns
    -------
    DataArray of shape (time, marker, axis)
        In millimetres, z up; NaN where a marker was not seen.

    Raises
    ------
    UnreadableFile
        If the file is no TRC, damaged or cut short.

    """
    lines = lines_of(content, source)
    head = _head(lines, source)
    rows = [line for line in lines[head.first :] if line.strip()]
    n_frames = _count(head.values, "numframes", source)
    if len(rows) != n_frames:
        why = "the file is cut short" if len(rows) < n_frames else "the count is wrong"
        raise UnreadableFile(source, f"{n_frames} frames, as it declares", f"{len(rows)}: {why}")
    table = table_of(
        rows,
        _IN_FRONT + 3 * len(head.names),
        separator="\t" if head.tabs else None,
        source=source,
        first=head.first + 1,
        short_by=3 if head.tabs else 0,
    )
    refuse_cut_number(content, rows, source)
    if content[-1:] == b"\t" and len(set(np.isnan(table[-1, -3:]).tolist())) > 1:
        raise UnreadableFile(source, "three coordinates of the last marker", "fewer: cut short")
    positions = without_zeros(table[:, _IN_FRONT:].reshape(len(table), -1, 3))
    time = table[:, 1]
    if rate_hz is None:
        rate = rate_of(head.values.get("datarate", ""), "DataRate", source)
        even = on_even_clock(positions, time, source, rate)
        positions, rate_hz, start_s = even
    else:
        start_s = 0.0
    return as_captured(
        positions,
        head.names,
        rate_hz=rate_hz,
        source=source,
        format_name="TRC",
        unit=unit,
        file_unit=unit_named(head.values.get("units", "")),
        usual_up="y",
        start_s=start_s,
    )


def _head(lines: list[str], source: str) -> _Head:
    """Return keys and names; the table begins after the line of X1 Y1 Z1, if there is one."""
    if len(lines) < 5:
        raise UnreadableFile(source, "five lines above the first frame", f"{len(lines)} lines")
    tabs = "\t" in lines[3]
    keys = [key.lower() for key in lines[1].split()]
    values = dict(zip(keys, _values(lines[2]), strict=False))
    lacking = [key for key in _KEYS if key not in values]
    names = cells(lines[3], "\t" if tabs else None)
    if lacking or not re.match(r"frame", names[0] if names else "", re.IGNORECASE):
        came = f"a header without {lacking}" if lacking else repr(lines[3][:40])
        raise UnreadableFile(source, "NumFrames and NumMarkers, then a line Frame#, Time", came)
    n_markers = _count(values, "nummarkers", source)
    axes = lines[4].split()
    first = 5 if axes and re.match(r"[xyz]\d*$", axes[0], re.IGNORECASE) else 4
    return _Head(values, _names(names[_IN_FRONT:], n_markers, source), tabs, first)


def _values(line: str) -> list[str]:
    """Return the values of the keys; between tabs they may hold blanks."""
    between_tabs = [cell for cell in cells(line, "\t") if cell]
    return between_tabs if len(between_tabs) > 3 else line.split()


def _count(values: dict[str, str], key: str, source: str) -> int:
    word = values[key]
    count = int(word) if _COUNT.fullmatch(word) else 0
    if not count:
        raise UnreadableFile(source, f"a count above 0 as {key}", repr(word[:40]))
    return count


def _names(words: list[str], n_markers: int, source: str) -> list[str]:
    """Return as many names as declared: one a marker, with empty cells behind or not.

    Some programs name each coordinate, and some leave markers without names.
    """
    named = [word for word in words if word]
    if len(named) == n_markers:
        return named
    points = points_of(words)
    if len(points.names) == n_markers and len(named) == 3 * n_markers:
        return points.names
    if len(named) < n_markers <= len(words):
        in_place = [words[at] if at < len(words) else "" for at in range(0, 3 * n_markers, 3)]
        if named == [name for name in in_place if name]:
            return in_place
    raise UnreadableFile(
        source, f"the names of {n_markers} markers, as it declares", f"{len(named)} names"
    )
