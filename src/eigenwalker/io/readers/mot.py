"""STO and MOT files of OpenSim: a header that ends in ``endheader``, then columns over time.

Read are those that hold positions in the room, in three columns a point (``LASI_tx``,
``pelvis_X``) or in one of three numbers (``DataType=Vec3``). Joint angles and forces are refused.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np
import xarray as xr

from eigenwalker.core.trajectories import MILLIMETRES
from eigenwalker.io.column_names import points_of
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.text_table import cells, lines_of, refuse_cut_number, separator_of, table_of
from eigenwalker.io.timestamps import on_even_clock
from eigenwalker.io.to_trajectories import as_captured, unit_named
from eigenwalker.io.up_axis_and_unit import Unit

FEWEST_POINTS = 3
"""Fewer are no body: motions of joint angles hold one position, that of the pelvis."""

_NO_POSITION = re.compile(r"force|torque|moment|_v$|_p$|^center_of_mass$", re.IGNORECASE)
_END = re.compile(rb"^[ \t]*endheader[ \t]*\r?$", re.IGNORECASE | re.MULTILINE)
_OTHER = "export marker or body positions (TRC, or BodyKinematics' pos_global)"


def looks_like_mot(content: bytes) -> bool:
    """Return whether a file has the end of an OpenSim header in its beginning."""
    return _END.search(content[:20_000]) is not None


def read_mot(
    content: bytes, *, source: str, unit: Unit | None = None, rate_hz: float | None = None
) -> xr.DataArray:
    """Return where the points of an OpenSim storage file are.

    Parameters
    ----------
    content : bytes
        The whole file.
    source : str
        Its name, for messages.
    unit : Unit, optional
        Unit of its lengths; metres if neither this nor the file names one, as OpenSim has them.
    rate_hz : float, optional
        Frames a second, where the times in the file are wrong.

    Returns
    -------
    DataArray of shape (time, marker, axis)
        In millimetres, z up.

    Raises
    ------
    UnreadableFile
        If the file holds angles or forces, is damaged or cut short.

    """
    lines = lines_of(content, source)
    end = next((at for at, line in enumerate(lines) if line.strip().lower() == "endheader"), None)
    if end is None or end + 1 >= len(lines):
        raise UnreadableFile(source, "a line of names after endheader", "none")
    keys = dict(_key(line) for line in lines[:end] if "=" in line)
    body = [line for line in lines[end + 1 :] if line.strip()]
    separator = separator_of(body[0])
    names = [name for name in cells(body[0], separator) if name]
    if not names or names[0].lower() != "time":
        raise UnreadableFile(source, "a first column called time", repr(body[0][:40]))
    vectors = keys.get("datatype", "double").lower() == "vec3"
    rows = [re.sub(r"[~()\[\],]", " ", line) for line in body[1:]] if vectors else body[1:]
    n_columns = 1 + 3 * (len(names) - 1) if vectors else len(names)
    _check_counts(keys, len(rows), len(names), source)
    table = table_of(
        rows, n_columns, separator=None if vectors else separator, source=source, first=end + 3
    )
    refuse_cut_number(content, rows, source)
    kept, positions = _positions(table, names[1:], vectors, source)
    even = on_even_clock(positions, table[:, 0], source) if rate_hz is None else None
    return as_captured(
        even.positions if even else positions,
        kept,
        rate_hz=rate_hz or (even.rate_hz if even else 0.0),
        source=source,
        format_name="STO",
        unit=unit,
        file_unit=unit_named(keys.get("units", "")),
        usual_unit=Unit("m", MILLIMETRES["m"], "OpenSim's unit"),
        usual_up="y",
        start_s=even.start_s if even else 0.0,
    )


def _key(line: str) -> tuple[str, str]:
    key, _, value = line.partition("=")
    return key.strip().lower(), value.strip()


def _check_counts(keys: dict[str, str], n_rows: int, n_columns: int, source: str) -> None:
    """Refuse a table that is not as large as its header says."""
    for key, came in (("nrows", n_rows), ("ncolumns", n_columns)):
        declared = keys.get(key, keys.get({"nrows": "datarows", "ncolumns": "datacolumns"}[key]))
        if declared is not None and declared != str(came):
            short = declared.isdecimal() and len(declared) < 10 and came < int(declared)
            why = ": the file is cut short" if short else ""
            raise UnreadableFile(source, f"{key}={declared[:20]}, as it declares", f"{came}{why}")


def _positions(
    table: np.ndarray, names: Sequence[str], vectors: bool, source: str
) -> tuple[list[str], np.ndarray]:
    """Return names and positions of the points; refuse tables of other things."""
    if vectors:
        points, columns = list(names), [(3 * i, 3 * i + 1, 3 * i + 2) for i in range(len(names))]
    else:
        points, columns, _ = points_of(names)
    kept = [i for i, name in enumerate(points) if not _NO_POSITION.search(name)]
    if len(kept) < FEWEST_POINTS:
        came = f"{len(kept)} among {len(names)} columns such as {list(names[:4])}"[:200]
        raise UnreadableFile(source, "the positions of several points", came, _OTHER)
    values = table[:, 1:][:, [columns[i] for i in kept]]
    return [points[i] for i in kept], values
