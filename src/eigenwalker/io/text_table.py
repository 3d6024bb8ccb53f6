"""The one reader of text tables: what stands in which column -> trajectories.

Each format (TRC, STO, Vicon CSV, Qualisys TSV, tables of points) has a grammar of its own for the
lines above the numbers, in `readers`. Rows, columns, times and counts are the same for all.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
import xarray as xr

from eigenwalker.io.capture_file import CaptureFile
from eigenwalker.io.missing_codes import without_codes
from eigenwalker.io.number_format import N_SAMPLED, noted
from eigenwalker.io.text_cells import cells, cut_number, marks_in, refuse_cut_number, table_of
from eigenwalker.io.timestamps import TIME_UNITS, TimedPositions, clock_in_seconds, on_clock
from eigenwalker.io.to_trajectories import FileFrame, labelled_points, own_name, trajectories_of

_DECIMALS = re.compile(r"-?\d+[.,](\d{1,12})", re.ASCII)
_COUNT = re.compile(r"\d{1,9}", re.ASCII)
_UNLABELLED = re.compile(r"\*\d*|u_?\d+|un(labell?ed|named|identified).*", re.IGNORECASE)


@dataclass(frozen=True)
class TextTable:
    """Lines of numbers, and which columns hold the points."""

    names: Sequence[str]
    columns: Sequence[tuple[int, int, int]]
    """Columns of x, y and z of each point."""
    rows: Sequence[str]
    n_columns: int
    separator: str | None
    first_line: int = 1
    """Number of the first row in the file, for messages."""
    time_column: int | None = None
    n_frames: int | None = None
    """Frames that the file declares."""
    only_these: bool = False
    """Whether other columns may hold anything."""
    short_by: int = 0
    """As `table_of` takes it."""
    ends_file: bool = True
    """Whether the file ends with the table, and so may be cut within it."""


def declared_count(file: CaptureFile, word: str, key: str) -> int:
    """Return the count above 0 that a header gives under a key."""
    count = int(word) if _COUNT.fullmatch(word) else 0
    if not count:
        raise file.error(f"a count above 0 as {key}", repr(word[:40]))
    return count


def interleaved(n_points: int, first: int) -> list[tuple[int, int, int]]:
    """Return the columns of points that stand side by side, x y z x y z ..."""
    return [(first + 3 * i, first + 3 * i + 1, first + 3 * i + 2) for i in range(n_points)]


@dataclass(frozen=True)
class TableValues:
    """Numbers of a table: positions (time, marker, 3), times and their unit, and attributes.

    `time_decimals` is the number of decimals of all times; None where it differs.
    """

    positions: np.ndarray
    time: np.ndarray | None = None
    time_unit: str | None = None
    attrs: Mapping[str, object] = field(default_factory=dict[str, object])
    time_decimals: int | None = None


def table_values(file: CaptureFile, table: TextTable) -> TableValues:
    """Return the positions and times in a table; NaN where a cell is empty."""
    rows = _whole_rows(file, table)
    attrs = {} if table.n_frames is None else file.check_frames(table.n_frames, len(rows))
    coordinates = [column for triple in table.columns for column in triple]
    others: list[int] = []
    if not table.only_these:
        others = sorted({*range(table.n_columns)} - {*coordinates, table.time_column})
    marks = marks_in(rows, table.separator, coordinates)
    values = table_of(
        file,
        rows,
        table.n_columns,
        separator=table.separator,
        first=table.first_line,
        short_by=table.short_by,
        columns=coordinates,
        clock=table.time_column,
        others=others,
        marks=marks,
    )
    if table.ends_file and len(rows) == len(table.rows):
        refuse_cut_number(file, rows)
    n_points = len(table.names)
    return TableValues(
        values[:, : 3 * n_points].reshape(len(values), n_points, 3),
        values[:, -1] if table.time_column is not None else None,
        attrs={**attrs, **noted(marks)},
        time_decimals=_time_decimals(rows, table),
    )


def _time_decimals(rows: Sequence[str], table: TextTable) -> int | None:
    """Return with how many decimals all times are written; None where it differs."""
    if table.time_column is None:
        return None
    times = (cells(row, table.separator)[table.time_column] for row in rows[:N_SAMPLED])
    found = {len(hit[1]) if (hit := _DECIMALS.fullmatch(time)) else None for time in times}
    return found.pop() if len(found) == 1 else None


def _whole_rows(file: CaptureFile, table: TextTable) -> Sequence[str]:
    """Return the lines without the last, if a partial file to be kept may end within it."""
    rows = table.rows
    if not file.keep_partial or table.n_frames is None or not rows:
        return rows
    if file.content.endswith((b"\n", b"\r")):
        return rows
    is_cut = (
        len(rows) < table.n_frames
        or len(cells(rows[-1], table.separator)) < table.n_columns
        or cut_number(file, rows)
    )
    return rows[:-1] if is_cut else rows


def table_trajectories(
    file: CaptureFile,
    values: TableValues,
    names: Sequence[str],
    *,
    format_name: str,
    rate_hz: float | None = None,
    start_s: float = 0.0,
    frame: FileFrame,
) -> xr.DataArray:
    """Return the labelled points of a table as trajectories."""
    positions, codes = without_codes(values.positions)
    clocked = TimedPositions(positions, rate_hz or 0.0, start_s)
    attrs = {**values.attrs, **({"missing_codes": codes} if codes else {})}
    if values.time is not None:
        time, unit, of_clock = clock_in_seconds(file, values.time, values.time_unit, rate_hz)
        decimals = values.time_decimals
        resolution = 0.0 if decimals is None else 10.0**-decimals * TIME_UNITS[unit]
        clocked = on_clock(file, positions, time, rate_hz, resolution_s=resolution)
        attrs = {**attrs, **of_clock, **clocked.attrs}
    positions, names, points = labelled_points(clocked.positions, names, _is_labelled)
    positions[np.isnan(positions).any(axis=2)] = np.nan
    if np.isnan(positions).all():
        got = f"{len(positions)} frames of {len(names)} labelled points that were never seen"
        raise file.error("positions of labelled points", got)
    walk = trajectories_of(
        file,
        positions,
        names,
        format_name=format_name,
        rate_hz=clocked.rate_hz,
        start_s=clocked.start_s,
        frame=frame,
    )
    walk.attrs.update(points, **attrs)
    return walk


def _is_labelled(name: str) -> bool:
    return bool(own_name(name)) and not _UNLABELLED.fullmatch(own_name(name))
