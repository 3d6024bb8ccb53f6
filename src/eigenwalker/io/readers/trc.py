"""TRC files: trajectories of markers in rows and columns, as Cortex, OpenSim and Pose2Sim write.

Two lines of keys and their values, a line of names, a line of X1 Y1 Z1 ..., then a line a frame.
Empty cells and 0, 0, 0 exactly mean that a marker was not seen.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import xarray as xr

from eigenwalker.io.capture_file import CaptureFile
from eigenwalker.io.text_cells import cells, points_of
from eigenwalker.io.text_table import (
    TextTable,
    declared_count,
    interleaved,
    table_trajectories,
    table_values,
)
from eigenwalker.io.timestamps import declared_rate
from eigenwalker.io.to_trajectories import FileFrame, unit_named, without_zeros

looks_like_trc = re.compile(rb"[\xef\xbb\xbf\s\"']*PathFileType", re.IGNORECASE).match
_KEYS = ("numframes", "nummarkers")
_N_FRONT = 2  # columns for the number of the frame and its time


def read_trc(file: CaptureFile) -> xr.DataArray:
    """Return the trajectories of the markers in a TRC file; NaN where a marker was not seen."""
    lines = file.lines
    if len(lines) < 5:
        raise file.error("five lines above the first frame", f"{len(lines)} lines")
    separator = "\t" if "\t" in lines[3] else None
    keys = _keys(file, lines, separator)
    n_markers = declared_count(file, keys["nummarkers"], "nummarkers")
    names = _names(file, cells(lines[3], separator)[_N_FRONT:], n_markers)
    axes = lines[4].split()
    first = 5 if axes and re.match(r"[xyz]\d*$", axes[0], re.IGNORECASE) else 4
    table = TextTable(
        names,
        interleaved(n_markers, _N_FRONT),
        [line for line in lines[first:] if line.strip()],
        n_columns=_N_FRONT + 3 * n_markers,
        separator=separator,
        first_line=first + 1,
        time_column=1,
        n_frames=declared_count(file, keys["numframes"], "numframes"),
        short_by=3 if separator else 0,
    )
    values = table_values(file, table)
    last = np.isnan(values.positions[-1, -1])
    if file.content.endswith(b"\t") and last.any() and not last.all():
        raise file.error("three coordinates of the last marker", "fewer: cut short")
    return table_trajectories(
        file,
        replace(values, positions=without_zeros(values.positions)),
        names,
        format_name="TRC",
        rate_hz=declared_rate(file, keys.get("datarate", ""), "DataRate"),
        frame=FileFrame(unit_named(keys.get("units", "")), usual_up="y"),
    )


def _keys(file: CaptureFile, lines: Sequence[str], separator: str | None) -> dict[str, str]:
    between_tabs = [cell for cell in cells(lines[2], "\t") if cell]  # where values may hold blanks
    values = between_tabs if len(between_tabs) > 3 else lines[2].split()
    keys = dict(zip(lines[1].lower().split(), values, strict=False))
    lacking = [key for key in _KEYS if key not in keys]
    head = "".join(cells(lines[3], separator)[:1])
    if lacking or not head.lower().startswith("frame"):
        got = f"a header without {lacking}" if lacking else repr(lines[3][:40])
        raise file.error("NumFrames and NumMarkers, then a line Frame#, Time", got)
    return keys


def _names(file: CaptureFile, words: list[str], n_markers: int) -> list[str]:
    """Return as many names as declared: one a marker, with empty cells behind or not."""
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
    raise file.error(f"the names of {n_markers} markers, as it declares", f"{len(named)} names")
