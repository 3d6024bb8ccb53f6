"""Any table of numbers, with a short description (TOML) of the same name beside it.

``docs/formats.md`` lists what a description may hold.
"""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from eigenwalker.core.trajectories import MILLIMETRES
from eigenwalker.io.capture_file import CaptureFile, as_utf8, read_bytes
from eigenwalker.io.number_format import noted
from eigenwalker.io.readers.data3d import positions_of_rows
from eigenwalker.io.text_cells import (
    cells,
    marks_in,
    points_of,
    refuse_cut_number,
    separator_of,
    table_of,
)
from eigenwalker.io.text_table import TableValues, table_trajectories
from eigenwalker.io.timestamps import parse_rate
from eigenwalker.io.to_trajectories import FileFrame, unit_named, without_zeros
from eigenwalker.io.up_axis_and_unit import UNITS, Unit

MAX_BYTES = 1_000_000
LAYOUTS = ("interleaved", "planar", "rows")
"""x, y, z of a point side by side; all x, all y, all z; or three lines a frame."""
SEPARATORS = {"tab": "\t", "comma": ",", "semicolon": ";", "blank": None}
_WORDS = ("title", "citation", "licence", "license", "comment")
_KEYS: dict[str, type] = dict.fromkeys(_WORDS, str) | {
    "names": list,
    "rate_hz": float,
    "unit": str,
    "unit_mm": float,
    "forward": str,
    "left": str,
    "up": str,
    "layout": str,
    "separator": str,
    "header_lines": int,
    "skip_columns": int,
    "time_column": int,
    "zero_is_missing": bool,
}


class _Description(dict[str, Any]):
    """What a description holds, and its file."""

    file: CaptureFile


def read_described_table(file: CaptureFile, description: Path) -> xr.DataArray:
    """Return the trajectories of the points in a table of numbers, by its description."""
    described = _read_description(description)
    names, values = _table(file, described)
    positions = values.positions
    if described.get("zero_is_missing"):
        positions = without_zeros(positions)
    rate_hz = file.rate_hz
    if rate_hz is None and "rate_hz" in described:
        rate_hz = parse_rate(f"{described['rate_hz']}", "rate_hz", described.file)
    if rate_hz is None and values.time is None:
        rate_hz = file.default_rate_hz
        if rate_hz is None:
            expected = "rate_hz or time_column"
            raise described.file.error(expected, "neither", "add the frames a second")
    axes = _axes(described)
    walk = table_trajectories(
        file,
        replace(values, positions=positions if axes is None else positions @ axes.T),
        names,
        format_name="described table",
        rate_hz=rate_hz,
        frame=FileFrame(
            _unit(described), up=described.get("up") if axes is None else "z", up_is_sure=True
        ),
    )
    walk.attrs.update(description=described.file.name)
    walk.attrs.update({key: str(described[key]) for key in _WORDS if key in described})
    if axes is not None:
        walk.attrs["up_axis"] = described["up"]
    return walk


def _read_description(path: Path) -> _Description:
    """Return what a description holds: known keys, each of its type."""
    see = "see docs/formats.md"
    described = _Description()
    described.file = CaptureFile(path, as_utf8(read_bytes(path, max_bytes=MAX_BYTES)))
    try:
        described.update(tomllib.loads(described.file.content.decode("utf-8-sig")))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise described.file.error("a description in TOML", str(error)[:80], see) from error
    except ValueError as error:
        raise described.file.error("numbers of a usual size", "longer ones") from error
    if unknown := [key for key in described if key not in _KEYS]:
        raise described.file.error(f"some of {sorted(_KEYS)}", f"{unknown[:3]}"[:80], see)
    for key, value in described.items():
        wanted = (int, float) if _KEYS[key] is float else _KEYS[key]
        if not isinstance(value, wanted) or (isinstance(value, bool) and _KEYS[key] is not bool):
            raise described.file.error(f"{key} as {_KEYS[key].__name__}", f"{value!r}"[:80])
    for key, choices in (("layout", LAYOUTS), ("separator", tuple(SEPARATORS))):
        if described.get(key, choices[0]) not in choices:
            raise described.file.error(f"a {key} of {choices}", repr(described[key])[:80])
    return described


def _unit(described: _Description) -> Unit | None:
    if "unit_mm" in described:
        length = float(described["unit_mm"])
        if not 1e-9 < length < 1e9:
            raise described.file.error("millimetres a unit above 0 as unit_mm", f"{length}")
        return Unit(f"{length:g} mm", length)
    if "unit" not in described:
        return None
    known = UNITS | MILLIMETRES
    name = described["unit"]
    unit = Unit(name, known[name]) if name in known else unit_named(name)
    if unit is None:
        raise described.file.error(f"a unit of {sorted(known)}", repr(name)[:40])
    return unit


def _axes(described: _Description) -> np.ndarray | None:
    """Return the matrix that turns a table's axes into forward, left, up.

    Two of them are enough in a right-handed frame. Three may also name a left-handed one, from
    which the walk comes out as it was, not mirrored. None where less is named.
    """
    given: dict[str, np.ndarray] = {}
    for key in ("forward", "left", "up"):
        word = described.get(key, "")
        if key in described and word.lstrip("+-") not in ("x", "y", "z"):
            raise described.file.error(f"{key} as x, -x, y, -y, z or -z", repr(word)[:40])
        if word:
            sign = -1.0 if word.startswith("-") else 1.0
            given[key] = sign * np.eye(3)["xyz".index(word[-1])]
    if "up" not in given or len(given) < 2:
        return None
    if "forward" not in given:
        given["forward"] = np.cross(given["left"], given["up"])
    elif "left" not in given:
        given["left"] = np.cross(given["up"], given["forward"])
    axes = np.array([given["forward"], given["left"], given["up"]])
    if abs(np.linalg.det(axes)) < 0.5:
        words = [described[key] for key in ("forward", "left", "up") if key in described]
        raise described.file.error("three different axes", f"{words}")
    return axes


def _table(file: CaptureFile, described: _Description) -> tuple[list[str], TableValues]:
    lines = file.lines
    n_above: int = described.get("header_lines", 0 if "names" in described else 1)
    skip: int = described.get("skip_columns", 0)
    if not 0 <= n_above < len(lines) or not 0 <= skip < 10_000:
        got = f"{n_above} and {skip}, with {len(lines)} lines in the table"
        raise described.file.error("header_lines and skip_columns that leave a table", got)
    rows = [line.strip(" ") for line in lines[n_above:] if line.strip()]
    separator = separator_of(rows[0]) if rows else None
    if "separator" in described:
        separator = SEPARATORS[described["separator"]]
    names = [str(word) for word in described.get("names", [])]
    layout = described.get("layout", LAYOUTS[0])
    head = _without_last_empty(cells(rows[0], separator)) if rows else []
    if names:
        columns = _columns(file, described, names, layout, skip, len(head))
    else:
        layout = LAYOUTS[0]
        head = _without_last_empty(cells(lines[n_above - 1], separator))
        names, points, _ = points_of(head if n_above else [])
        columns = np.array(points, dtype=int).ravel()
    if not names:
        raise described.file.error("names of the points, or a header with them", "neither")
    at = described.get("time_column", 0)
    if not 0 <= at <= len(head) or (at and layout == "rows"):
        raise described.file.error(f"a time_column from 1 to {len(head)}", f"{at}")
    marks = marks_in(rows, separator, columns.tolist())
    values = table_of(
        file,
        rows,
        len(head),
        separator=separator,
        first=n_above + 1,
        columns=columns.tolist(),
        clock=at - 1 if at else None,
        marks=marks,
    )
    refuse_cut_number(file, rows)
    if layout == "rows":
        return names, TableValues(positions_of_rows(file, values), attrs=noted(marks))
    time = values[:, -1] if at else None
    positions = values[:, : columns.size].reshape(len(values), -1, 3)
    return names, TableValues(positions, time, attrs=noted(marks))


def _without_last_empty(words: list[str]) -> list[str]:
    return words[:-1] if len(words) > 1 and not words[-1] else words


def _columns(
    file: CaptureFile,
    described: _Description,
    names: Sequence[str],
    layout: str,
    skip: int,
    n_columns: int,
) -> np.ndarray:
    """Return the columns of x, y, z of each point; of the one coordinate a line for rows."""
    n_points = len(names)
    wanted = skip + (n_points if layout == "rows" else 3 * n_points)
    if n_columns != wanted:
        for_what = f"{n_points} names" + (f" behind {skip} columns" if skip else "")
        raise file.error(
            f"{wanted} columns for the {for_what} in {described.file.name} ({layout})",
            f"{n_columns}",
            "put names, layout or skip_columns right",
        )
    columns = np.arange(skip, wanted)
    return columns.reshape(3, -1).T.ravel() if layout == "planar" else columns
