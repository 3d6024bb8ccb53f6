"""Tables of body points: Kinect, MediaPipe, OpenPose, and what else has columns ``nose_x``.

A line of names, then a line a frame. Columns that are no point and no time are passed over. Lines
above that begin with # may name ``unit``, ``up``, ``rate_hz`` and the number of ``frames``.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
import xarray as xr

from eigenwalker.core.trajectories import MILLIMETRES
from eigenwalker.io.capture_file import CaptureFile
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.text_cells import cells, points_of, separator_of
from eigenwalker.io.text_table import TableValues, TextTable, table_trajectories, table_values
from eigenwalker.io.timestamps import TIME_UNITS, counts_frames, parse_rate
from eigenwalker.io.to_trajectories import FileFrame, unit_named, without_zeros
from eigenwalker.io.up_axis_and_unit import Unit, up_axis

MIN_POINTS = 3
"""Fewer are no body."""
KINECT_RATE_HZ = 30.0
_KINDS = {
    "Kinect": {"spinebase", "hipcenter", "spinemid", "shouldercenter"},
    "MediaPipe": {"leftfootindex", "lefteyeinner"},
    "BODY_25": {"midhip"},
}
"""Names of points by which tables of a program are known."""

_TIME = re.compile(
    r"(?:(?:local|unix|epoch|utc|system|camera|frame|host|date)[ _]?)?"
    r"(?P<name>time|timestamps?|stamp|epoch|utc|t|seconds?|milliseconds?)"
    rf"(?:[ _]*[\[(]?(?P<unit>{'|'.join(TIME_UNITS)})[\])]?)?",
    re.IGNORECASE,
)
_NOTE = re.compile(r"(\w+)\s*[:=]\s*([^;,]+)")


def read_skeleton_table(file: CaptureFile) -> xr.DataArray:
    """Return the trajectories of the points in a table with named columns."""
    lines = file.lines
    above = next((at for at, line in enumerate(lines) if line.strip() and line[0] != "#"), 0)
    separator = separator_of(lines[above])
    header, first = header_of(lines, above, separator)
    points = points_of(header)
    if len(points.names) < MIN_POINTS:
        raise _no_points(file, header)
    notes = _notes(lines[:above])
    times = [(at, hit) for at in points.others if (hit := _TIME.fullmatch(header[at]))]
    rows = [line for line in lines[first:] if line.strip(" \t,;")]
    cut_in_line = "frames" in notes and file.content[-1:] not in (b"\n", b"\r")
    table = TextTable(
        points.names,
        points.columns,
        rows[:-1] if cut_in_line and file.keep_partial else rows,
        n_columns=len(header),
        separator=separator,
        first_line=first + 1,
        time_column=times[0][0] if times else None,
        n_frames=_declared_frames(file, notes),
        only_these=True,
    )
    values = table_values(file, table)
    if cut_in_line and not file.keep_partial:
        raise file.error("an end of the last line", "none: the file is cut short")
    if values.time is not None:
        words = (word.lower() for word in times[0][1].group("unit", "name") if word)
        values = replace(values, time_unit=next((w for w in words if w in TIME_UNITS), None))
    return body_trajectories(file, values, points.names, notes)


def body_trajectories(
    file: CaptureFile, values: TableValues, names: Sequence[str], notes: Mapping[str, str]
) -> xr.DataArray:
    """Return the points of a body as trajectories, with what is usual for the program.

    `notes` are ``unit``, ``up`` and ``rate_hz``, as the file names them.
    """
    kind = _kind(names)
    unit = unit_named(notes.get("unit", ""))
    usual = Unit("m", MILLIMETRES["m"], "Kinect's unit") if kind == "Kinect" else None
    if not (file.unit or unit or file.default_unit or usual):
        _refuse_picture(file, values.positions, names)
    positions = without_zeros(values.positions, unless_always=kind != "Kinect")
    time, rate_hz, assumed = values.time, file.rate_hz, {}
    if kind == "Kinect" and time is not None and not values.time_unit and counts_frames(time):
        time = None
    if rate_hz is None and "rate_hz" in notes:
        time, rate_hz = None, parse_rate(notes["rate_hz"], "rate_hz", file)
    elif rate_hz is None and time is None and kind == "Kinect":
        reason = "at which Kinect nominally sees"
        rate_hz, assumed = file.frame_rate(None, usual_hz=KINECT_RATE_HZ, reason=reason)
    elif time is None:
        rate_hz = rate_hz or file.default_rate_hz
    up = notes.get("up") if re.fullmatch("-?[xyz]", notes.get("up", "")) else None
    if time is None and rate_hz is None:
        got = f"{list(names[:3])}"[:120] + " and others, but no time"
        raise file.error("a column time_s", got, "name the rate: read_mocap(..., rate_hz=...)")
    return table_trajectories(
        file,
        replace(values, positions=positions, time=time, attrs={**values.attrs, **assumed}),
        names,
        format_name=kind,
        rate_hz=rate_hz,
        frame=FileFrame(unit, usual, up, "y"),
    )


def header_of(lines: Sequence[str], at: int, separator: str | None) -> tuple[list[str], int]:
    """Return the names of the columns, in a line or two, and the line of the first frame."""
    header = cells(lines[at], separator)
    while len(header) > 1 and not header[-1]:
        header.pop()
    axes = cells(lines[at + 1], separator) if at + 1 < len(lines) else []
    if sum(axis.lower() in ("x", "y", "z") for axis in axes) < 3 * MIN_POINTS:
        return header, at + 1
    together: list[str] = []
    name = ""
    for column, axis in enumerate(axes):
        name = header[column] if column < len(header) and header[column] else name
        together.append(f"{name}_{axis}" if axis.lower() in ("x", "y", "z") else axis or name)
    return together, at + 2


def _no_points(file: CaptureFile, header: Sequence[str]) -> UnreadableFile:
    flat = {cell[:-2].lower() for cell in header if cell[-2:].lower() in ("_x", "_y")}
    if len(flat) >= MIN_POINTS:
        got = f"{header[:2]} and so on, in two dimensions"
        advice = "export the 3D (world) landmarks"
    else:
        got = f"the columns {header[:4]}, which are no positions"
        advice = (
            "take the table of positions from which they come, or put a description beside it "
            "(docs/formats.md)"
        )
    return file.error("columns such as nose_x, nose_y, nose_z", got[:200], advice)


def _notes(lines: Sequence[str]) -> dict[str, str]:
    return {
        key.lower(): value.strip()
        for line in lines[:100]
        for key, value in _NOTE.findall(line[:300])
    }


def _declared_frames(file: CaptureFile, notes: Mapping[str, str]) -> int | None:
    word = notes.get("frames")
    if word is None:
        return None
    if not word.isdecimal() or len(word) > 9:
        raise file.error("a number of frames in its first line", repr(word[:20]))
    return int(word)


def _kind(names: Sequence[str]) -> str:
    plain = {re.sub(r"[^a-z0-9]", "", name.lower()) for name in names}
    return next((kind for kind, own in _KINDS.items() if plain & own), "table of points")


def _refuse_picture(file: CaptureFile, positions: np.ndarray, names: Sequence[str]) -> None:
    flat = positions[..., :2][~np.isnan(positions[..., :2])]
    low, high = np.quantile(flat, (0.01, 0.99)) if flat.size else (0.0, 0.0)
    if low > 0 and high < 1 and up_axis(positions, names) in ("-y", None):
        raise file.error(
            "points in a unit of length",
            "values between 0 and 1, as shares of a picture are",
            "export the world landmarks, in metres",
        )
