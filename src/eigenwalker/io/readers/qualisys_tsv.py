"""TSV files of Qualisys Track Manager: lines of keys, then a line a frame, in millimetres.

``0 0 0`` exactly, empty cells and NULL mean that a marker was not seen.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

import xarray as xr

from eigenwalker.io.capture_file import CaptureFile
from eigenwalker.io.text_cells import cells
from eigenwalker.io.text_table import (
    TextTable,
    declared_count,
    interleaved,
    table_trajectories,
    table_values,
)
from eigenwalker.io.timestamps import declared_rate
from eigenwalker.io.to_trajectories import FileFrame, without_zeros
from eigenwalker.io.up_axis_and_unit import Unit

MAX_KEYS = 10_000
"""Lines above the table: a dozen keys and one line an event."""

looks_like_qualisys_tsv = re.compile(
    rb"(?:\xef\xbb\xbf)?\s*NO_OF_(FRAMES|CAMERAS|MARKERS)\b", re.IGNORECASE
).match
_KEY = re.compile(r"[A-Z][A-Z0-9_]+", re.ASCII)


def read_qualisys_tsv(file: CaptureFile) -> xr.DataArray:
    """Return the trajectories of the markers in a Qualisys table; NaN where one was not seen."""
    lines = file.lines
    keys, first = _keys(lines)
    first_of = {key: "".join(values[:1]) for key, values in keys.items()}
    kind = first_of.get("DATA_INCLUDED", "3D")
    if kind.upper() != "3D":
        raise file.error("3D data", repr(kind[:20]), "export the 3D data as TSV")
    if segments := keys.get("SEGMENT_NAMES"):
        got = f"a skeleton export of QTM: {len(segments)} segments"
        raise file.error("3D data of markers", got, "export the 3D data as TSV, or C3D")
    names = keys.get("MARKER_NAMES", [])
    n_markers = declared_count(file, first_of.get("NO_OF_MARKERS", ""), "NO_OF_MARKERS")
    if n_markers != len(names) or not all(names):
        raise file.error(f"the names of {n_markers} markers, as it declares", f"{len(names)} names")
    rows = [line for line in lines[first:] if line.strip()]
    n_frames = declared_count(file, first_of.get("NO_OF_FRAMES", ""), "NO_OF_FRAMES")
    n_front = _columns_in_front(file, lines[first - 1], rows, n_markers)
    table = TextTable(
        names,
        interleaved(n_markers, n_front),
        rows,
        n_columns=n_front + 3 * n_markers,
        separator="\t",
        first_line=first + 1,
        time_column=1 if n_front == 2 else None,
        n_frames=n_frames,
        short_by=3,
    )
    values = table_values(file, table)
    return table_trajectories(
        file,
        replace(values, positions=without_zeros(values.positions)),
        names,
        format_name="Qualisys TSV",
        rate_hz=declared_rate(file, first_of.get("FREQUENCY", ""), "FREQUENCY"),
        frame=FileFrame(None, Unit("mm", 1.0, "Qualisys writes millimetres")),
    )


def _keys(lines: Sequence[str]) -> tuple[dict[str, list[str]], int]:
    keys: dict[str, list[str]] = {}
    for at, line in enumerate(lines[:MAX_KEYS]):
        words = cells(line, "\t")
        key, _, rest = words[0].partition(" ")
        if _KEY.fullmatch(key) and key != "NULL":
            values = [*rest.split(), *words[1:]]
            while values and not values[-1]:
                values.pop()
            keys.setdefault(key, values)
        elif words[0].lower() != "frame" and line.strip():
            return keys, at
    return keys, len(lines)


def _columns_in_front(file: CaptureFile, head: str, rows: Sequence[str], n_markers: int) -> int:
    """Return how many columns stand before the markers: number and time of a frame, or fewer."""
    words = [word.lower() for word in cells(head, "\t")[:2]]
    if words[:1] == ["frame"]:
        return 1 + (words[1:] == ["time"])
    closed = all(row.endswith("\t") for row in rows)
    n_front = max((row.count("\t") for row in rows), default=0) + 1 - closed - 3 * n_markers
    if n_front > 2:
        raise file.error(
            f"three columns for each of {n_markers} markers", f"{n_front} columns more"
        )
    return max(n_front, 0)
