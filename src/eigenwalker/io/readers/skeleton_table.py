"""Tables of body points: Kinect, MediaPipe, OpenPose, and what else has columns ``nose_x``.

A line of names, then a line a frame. Columns that are no point and no time are passed over. Lines
above that begin with # may tell ``unit``, ``up``, ``rate_hz`` and the number of ``frames``.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr

from eigenwalker.core.trajectories import MILLIMETRES
from eigenwalker.io.assumed_rate import assume_rate
from eigenwalker.io.column_names import points_of
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.text_table import cells, lines_of, refuse_cut_number, separator_of, table_of
from eigenwalker.io.timestamps import on_even_clock, rate_of
from eigenwalker.io.to_trajectories import as_captured, unit_named
from eigenwalker.io.up_axis_and_unit import Unit, up_axis

FEWEST_POINTS = 3
"""Fewer are no body."""
KINECT_RATE_HZ = 30.0
_KINECT = {"spinebase", "hipcenter", "spinemid", "shouldercenter"}
_MEDIAPIPE = {"leftfootindex", "lefteyeinner"}
_BODY_25 = {"midhip"}

_TIME = re.compile(
    r"(?:time|timestamps?|t|seconds?|milliseconds?)"
    r"(?:[ _]*[\[(]?(?P<unit>s|sec|seconds?|ms|us|µs)[\])]?)?",
    re.IGNORECASE,
)
_TIME_UNITS = {"s": 1.0, "m": 1e-3, "u": 1e-6, "µ": 1e-6}
_NOTE = re.compile(r"(\w+)\s*[:=]\s*([^;,]+)")
_DESCRIBE = "put a description beside it (docs/formats.md)"


class Skeleton(NamedTuple):
    """Points of a body over time, and what their file tells of them."""

    names: list[str]
    positions: np.ndarray
    time: np.ndarray | None
    notes: dict[str, str]


def read_skeleton_table(
    content: bytes, *, source: str, unit: Unit | None = None, rate_hz: float | None = None
) -> xr.DataArray:
    """Return where the points of a table with named columns are.

    Parameters
    ----------
    content : bytes
        The whole file.
    source : str
        Its name, for messages.
    unit : Unit, optional
        Unit of its lengths. If left out, it is the one the file names, the metre for Kinect, or
        the one in which the body is as tall as people are.
    rate_hz : float, optional
        Frames a second, for tables without a column of times. Kinect's usual 30 are assumed, with
        a warning; others are refused.

    Returns
    -------
    DataArray of shape (time, marker, axis)
        In millimetres, z up. Points at 0, 0, 0 in some frames are missing there.

    Raises
    ------
    UnreadableFile
        If columns name no points, or in two dimensions only, or it is damaged.

    """
    lines = lines_of(content, source)
    head = next((at for at, line in enumerate(lines) if line.strip() and line[0] != "#"), 0)
    separator = separator_of(lines[head])
    header, first = header_of(lines, head, separator)
    points = points_of(header)
    if len(points.names) < FEWEST_POINTS:
        raise _no_points(header, source)
    rows = [line for line in lines[first:] if line.strip(" \t,;")]
    clock = next(((at, hit) for at in points.others if (hit := _TIME.fullmatch(header[at]))), None)
    wanted = [column for triple in points.columns for column in triple]
    table = table_of(
        rows,
        len(header),
        separator=separator,
        source=source,
        first=first + 1,
        columns=[*wanted, clock[0]] if clock else wanted,
    )
    refuse_cut_number(content, rows, source)
    notes = _notes(lines[:head])
    _check_frames(notes, len(rows), content, source)
    skeleton = Skeleton(
        points.names,
        table[:, : len(wanted)].reshape(len(table), -1, 3),
        _seconds(table[:, -1], clock[1]["unit"]) if clock else None,
        notes,
    )
    return trajectories_of(skeleton, source=source, unit=unit, rate_hz=rate_hz)


def trajectories_of(
    skeleton: Skeleton, *, source: str, unit: Unit | None, rate_hz: float | None
) -> xr.DataArray:
    """Return the points of a body as trajectories, with what is known of its kind.

    Parameters
    ----------
    skeleton : Skeleton
        Points, times and notes of a file.
    source : str
        Name of the file, for messages.
    unit : Unit, optional
        Unit that the caller names.
    rate_hz : float, optional
        Frames a second that the caller names.

    Returns
    -------
    DataArray of shape (time, marker, axis)

    """
    names, positions, time, notes = skeleton
    kind = _kind(names)
    noted = unit_named(notes.get("unit", ""))
    usual = Unit("m", MILLIMETRES["m"], "Kinect's unit") if kind == "Kinect" else None
    if not (unit or noted or usual):
        _refuse_image(positions, names, source)
    positions = _without_some_zeros(positions, always=kind == "Kinect")
    start_s, assumed = 0.0, {}
    if rate_hz is None and "rate_hz" in notes:
        rate_hz = rate_of(notes["rate_hz"], "rate_hz", source)
    elif rate_hz is None and time is not None:
        positions, rate_hz, start_s = on_even_clock(positions, time, source)
    elif rate_hz is None and kind == "Kinect":
        rate_hz = KINECT_RATE_HZ
        assumed = assume_rate(rate_hz, source=source, reason="at which Kinect nominally sees")
    if rate_hz is None:
        raise UnreadableFile(
            source,
            "a column time_s",
            f"{names[:3]}"[:120] + " and others, but no time",
            "name the rate: read_mocap(..., rate_hz=...)",
        )
    walk = as_captured(
        positions,
        names,
        rate_hz=rate_hz,
        source=source,
        format_name=kind,
        unit=unit,
        file_unit=noted,
        usual_unit=usual,
        up=notes.get("up") if re.fullmatch("-?[xyz]", notes.get("up", "")) else None,
        usual_up="y",
        start_s=start_s,
    )
    walk.attrs.update(assumed)
    return walk


def header_of(lines: list[str], at: int, separator: str | None) -> tuple[list[str], int]:
    """Return the names of the columns and the line of the first frame.

    Names may stand in one line and x, y, z in the next.
    """
    header = cells(lines[at], separator)
    while len(header) > 1 and not header[-1]:
        header.pop()
    axes = cells(lines[at + 1], separator) if at + 1 < len(lines) else []
    if sum(axis.lower() in ("x", "y", "z") for axis in axes) < 3 * FEWEST_POINTS:
        return header, at + 1
    together: list[str] = []
    name = ""
    for column, axis in enumerate(axes):
        name = header[column] if column < len(header) and header[column] else name
        together.append(f"{name}_{axis}" if axis.lower() in ("x", "y", "z") else axis or name)
    return together, at + 2


def _no_points(header: list[str], source: str) -> UnreadableFile:
    """Return what to say of a table whose columns are no points in space."""
    flat = {cell[:-2].lower() for cell in header if cell[-2:].lower() in ("_x", "_y")}
    if len(flat) >= FEWEST_POINTS:
        came = f"{header[:2]} and so on, in two dimensions"
        advice = "export the 3D (world) landmarks"
    else:
        came = f"the columns {header[:4]}, which are no positions"
        advice = f"take the table of positions from which they come, or {_DESCRIBE}"
    return UnreadableFile(source, "columns such as nose_x, nose_y, nose_z", came[:200], advice)


def _seconds(time: np.ndarray, unit: str | None) -> np.ndarray:
    """Return times in seconds; without a unit, steps of 1 and more are milliseconds."""
    if unit:
        return time * _TIME_UNITS[unit[0].lower()]
    steps = np.diff(time)
    return time * 1e-3 if len(steps) and np.median(steps) >= 1 else time


def _notes(lines: Sequence[str]) -> dict[str, str]:
    return {
        key.lower(): value.strip()
        for line in lines[:100]
        for key, value in _NOTE.findall(line[:300])
    }


def _check_frames(notes: dict[str, str], n_rows: int, content: bytes, source: str) -> None:
    """Refuse a table that has not the frames that a note above it counts (``frames: 120``)."""
    declared = notes.get("frames")
    if declared is None:
        return
    if declared != str(n_rows):
        came = f"{n_rows}: the file is cut short, or the count is wrong"
        raise UnreadableFile(source, f"{declared[:20]} frames, as it declares", came)
    if content[-1:] not in (b"\n", b"\r"):
        raise UnreadableFile(source, "an end of the last line", "none: the file is cut short")


def _kind(names: Sequence[str]) -> str:
    plain = {re.sub(r"[^a-z0-9]", "", name.lower()) for name in names}
    for kind, marks in (("Kinect", _KINECT), ("MediaPipe", _MEDIAPIPE), ("BODY_25", _BODY_25)):
        if plain & marks:
            return kind
    return "table of points"


def _refuse_image(positions: np.ndarray, names: Sequence[str], source: str) -> None:
    """Refuse landmarks in shares of a picture: between 0 and 1, with y downwards."""
    flat = positions[..., :2][~np.isnan(positions[..., :2])]
    low, high = np.quantile(flat, (0.01, 0.99)) if flat.size else (0.0, 0.0)
    if low > 0 and high < 1 and up_axis(positions, names) in ("-y", None):
        raise UnreadableFile(
            source,
            "points in a unit of length",
            "values between 0 and 1, as shares of a picture are",
            "export the world landmarks, in metres",
        )


def _without_some_zeros(positions: np.ndarray, *, always: bool) -> np.ndarray:
    """Return positions with NaN for a point at 0, 0, 0 exactly, unless it is always there."""
    at_zero = (positions == 0).all(axis=2)
    missing = at_zero if always else at_zero & ~at_zero.all(axis=0)
    return np.where(missing[..., None], np.nan, positions)
