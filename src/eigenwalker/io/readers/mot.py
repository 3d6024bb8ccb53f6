"""STO and MOT files of OpenSim: a header that ends in ``endheader``, then columns over time.

Read are files that hold positions in the room, in three columns a point (``LASI_tx``,
``pelvis_X``) or in one of three numbers (``DataType=Vec3``). Joint angles and forces are refused.
"""

from __future__ import annotations

import re

import xarray as xr

from eigenwalker.core.trajectories import MILLIMETRES
from eigenwalker.io.capture_file import CaptureFile
from eigenwalker.io.text_cells import cells, points_of, separator_of
from eigenwalker.io.text_table import TextTable, interleaved, table_trajectories, table_values
from eigenwalker.io.to_trajectories import FileFrame, unit_named
from eigenwalker.io.up_axis_and_unit import Unit

OPENSIM_UNIT = Unit("m", MILLIMETRES["m"], "OpenSim's unit")
MIN_POINTS = 3
"""Fewer are no body: motions of joint angles hold one position, that of the pelvis."""

_NO_POSITION = re.compile(r"force|torque|moment|_v$|_p$|^center_of_mass$", re.IGNORECASE)
_END = re.compile(rb"^[ \t]*endheader[ \t]*\r?$", re.IGNORECASE | re.MULTILINE)
_ADVICE = "export marker or body positions (TRC, or BodyKinematics' pos_global)"


def looks_like_mot(content: bytes) -> bool:
    """Return whether a file has the end of an OpenSim header in its beginning."""
    return _END.search(content[:20_000]) is not None


def read_mot(file: CaptureFile) -> xr.DataArray:
    """Return the trajectories of the points in an OpenSim storage file."""
    lines = file.lines
    end = next((at for at, line in enumerate(lines) if line.strip().lower() == "endheader"), None)
    if end is None or end + 1 >= len(lines):
        raise file.error("a line of names after endheader", "none")
    keys = {
        key.strip().lower(): value.strip()
        for key, equals, value in (line.partition("=") for line in lines[:end])
        if equals
    }
    body = [line for line in lines[end + 1 :] if line.strip()]
    separator = separator_of(body[0])
    head = [name for name in cells(body[0], separator) if name]
    if not head or head[0].lower() != "time":
        raise file.error("a first column called time", repr(body[0][:40]))
    vectors = keys.get("datatype", "double").lower() == "vec3"
    names = head[1:] if vectors else points_of(head).names
    columns = interleaved(len(names), 1) if vectors else points_of(head).columns
    points = [i for i, name in enumerate(names) if not _NO_POSITION.search(name)]
    if len(points) < MIN_POINTS:
        got = f"{len(points)} among {len(head) - 1} columns such as {head[1:5]}"[:200]
        raise file.error("the positions of several points", got, _ADVICE)
    _count(file, keys, ("ncolumns", "datacolumns"), len(head))
    table = TextTable(
        [names[i] for i in points],
        [columns[i] for i in points],
        [_without_brackets(line) for line in body[1:]] if vectors else body[1:],
        n_columns=1 + 3 * len(names) if vectors else len(head),
        separator=None if vectors else separator,
        first_line=end + 3,
        time_column=0,
        n_frames=_count(file, keys, ("nrows", "datarows")),
    )
    return table_trajectories(
        file,
        table_values(file, table),
        table.names,
        format_name="STO",
        frame=FileFrame(unit_named(keys.get("units", "")), OPENSIM_UNIT, None, "y"),
    )


def _without_brackets(line: str) -> str:
    return " ".join(re.sub(r"[~()\[\],]", " ", line).split())


def _count(
    file: CaptureFile, keys: dict[str, str], spellings: tuple[str, str], n: int | None = None
) -> int | None:
    """Return a count that the header declares, if any; refuse another than `n`."""
    key = next((key for key in spellings if key in keys), None)
    if key is None:
        return None
    word = keys[key]
    declared = int(word) if word.isdecimal() and len(word) < 10 else None
    if declared is None or n not in (None, declared):
        reason = ": the file is cut short" if declared and n and n < declared else ""
        got = "another number" if n is None else f"{n}{reason}"
        raise file.error(f"{spellings[0]}={word[:20]}, as it declares", got)
    return declared
