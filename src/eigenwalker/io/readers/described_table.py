"""Any table of numbers, with a short description (TOML) of the same name beside it.

``docs/formats.md`` says what a description may hold.
"""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr

from eigenwalker.core.trajectories import MILLIMETRES
from eigenwalker.io.column_names import points_of
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.sniff import content_of
from eigenwalker.io.text_table import cells, lines_of, refuse_cut_number, separator_of, table_of
from eigenwalker.io.timestamps import on_even_clock, rate_of
from eigenwalker.io.to_trajectories import as_captured, unit_named, without_zeros
from eigenwalker.io.up_axis_and_unit import UNITS, Unit

MOST_BYTES = 1_000_000
LAYOUTS = ("interleaved", "planar", "rows")
"""x, y, z of a point side by side; all x, all y, all z; or three lines a frame."""
SEPARATORS = {"tab": "\t", "comma": ",", "semicolon": ";", "blank": None}
_WORDS = {"title": str, "citation": str, "licence": str, "license": str, "comment": str}
_KEYS = _WORDS | {
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


class _Table(NamedTuple):
    """Numbers of a table as points, with the times that stand beside them."""

    names: list[str]
    positions: np.ndarray
    time: np.ndarray | None


def read_described_table(
    content: bytes,
    *,
    source: str,
    description: Path,
    unit: Unit | None = None,
    rate_hz: float | None = None,
) -> xr.DataArray:
    """Return where the points of a table of numbers are, as its description tells.

    Parameters
    ----------
    content : bytes
        The whole table.
    source : str
        Its name, for messages.
    description : Path
        Where its description is.
    unit : Unit, optional
        Unit of its lengths, where the description names none.
    rate_hz : float, optional
        Frames a second, where the description names none.

    Returns
    -------
    DataArray of shape (time, marker, axis)
        In millimetres; x forward and y left where the description tells the axes, z up.

    Raises
    ------
    UnreadableFile
        If the description is no such, or does not fit the table.

    """
    told = _description(description)
    table = _table(content, told, description.name, source)
    positions = without_zeros(table.positions) if told.get("zero_is_missing") else table.positions
    rate_hz = rate_hz or _declared_rate(told, description.name)
    start_s = 0.0
    if table.time is not None:
        positions, rate_hz, start_s = on_even_clock(positions, table.time, source, rate_hz)
    if rate_hz is None:
        raise UnreadableFile(
            description.name, "rate_hz or time_column", "neither", "tell the frames a second"
        )
    axes = _axes(told, description.name)
    walk = as_captured(
        positions if axes is None else positions @ axes.T,
        table.names,
        rate_hz=rate_hz,
        source=source,
        format_name="described table",
        unit=unit,
        file_unit=_unit(told, description.name),
        up=told.get("up") if axes is None else "z",
        start_s=start_s,
    )
    walk.attrs.update(description=description.name)
    walk.attrs.update({key: str(told[key]) for key in _WORDS if key in told})
    if axes is not None:
        walk.attrs["up_axis"] = told["up"]
    return walk


def _description(path: Path) -> dict:
    """Return what a description holds: known keys, each of its kind."""
    try:
        told = tomllib.loads(content_of(path, most_bytes=MOST_BYTES).decode("utf-8-sig"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise UnreadableFile(
            path.name, "a description in TOML", str(error)[:80], "see docs/formats.md"
        ) from error
    except ValueError as error:
        if isinstance(error, UnreadableFile):
            raise
        raise UnreadableFile(path.name, "numbers of a usual size", "longer ones") from error
    unknown = [key for key in told if key not in _KEYS]
    if unknown:
        raise UnreadableFile(
            path.name, f"some of {sorted(_KEYS)}", f"{unknown[:3]}"[:80], "see docs/formats.md"
        )
    for key, value in told.items():
        wanted = (int, float) if _KEYS[key] is float else _KEYS[key]
        if not isinstance(value, wanted) or (isinstance(value, bool) and _KEYS[key] is not bool):
            came = f"{value!r}"[:80]
            raise UnreadableFile(path.name, f"{key} as {_KEYS[key].__name__}", came)
    if told.get("layout", LAYOUTS[0]) not in LAYOUTS:
        raise UnreadableFile(path.name, f"a layout of {LAYOUTS}", repr(told["layout"])[:80])
    if told.get("separator", "tab") not in SEPARATORS:
        came = repr(told["separator"])[:80]
        raise UnreadableFile(path.name, f"a separator of {tuple(SEPARATORS)}", came)
    return told


def _declared_rate(told: dict, name: str) -> float | None:
    return rate_of(f"{told['rate_hz']}", "rate_hz", name) if "rate_hz" in told else None


def _unit(told: dict, name: str) -> Unit | None:
    """Return the unit that a description names, by its name or its length."""
    if "unit_mm" in told:
        length = float(told["unit_mm"])
        if not 1e-9 < length < 1e9:
            raise UnreadableFile(name, "millimetres a unit above 0 as unit_mm", f"{length}")
        return Unit(f"{length:g} mm", length)
    if "unit" not in told:
        return None
    known = UNITS | MILLIMETRES
    unit = unit_named(told["unit"])
    if told["unit"] in known:
        return Unit(told["unit"], known[told["unit"]])
    if unit is None:
        raise UnreadableFile(name, f"a unit of {sorted(known)}", repr(told["unit"])[:40])
    return unit


def _axes(told: dict, name: str) -> np.ndarray | None:
    """Return the matrix that turns a table's axes into forward, left, up.

    Two of them are enough in a right-handed frame; with all three, a left-handed one is told too,
    and comes out as the walk was, not mirrored. None where less is told.
    """
    given: dict[str, np.ndarray] = {}
    for key in ("forward", "left", "up"):
        word = told.get(key, "")
        if key in told and word.lstrip("+-") not in ("x", "y", "z"):
            raise UnreadableFile(name, f"{key} as x, -x, y, -y, z or -z", repr(word)[:40])
        if word:
            sign = -1.0 if word.startswith("-") else 1.0
            given[key] = sign * np.eye(3)["xyz".index(word[-1])]
    if "up" not in given or len(given) < 2:
        return None
    forward = given.get("forward")
    left = given.get("left")
    forward = np.cross(left, given["up"]) if forward is None and left is not None else forward
    left = np.cross(given["up"], forward) if left is None and forward is not None else left
    axes = np.array([forward, left, given["up"]])
    if abs(np.linalg.det(axes)) < 0.5:
        raise UnreadableFile(name, "three different axes", f"{[told.get(key) for key in given]}")
    return axes


def _table(content: bytes, told: dict, name: str, source: str) -> _Table:
    """Return the points of a table, in the layout that its description tells."""
    lines = lines_of(content, source)
    above = told.get("header_lines", 0 if "names" in told else 1)
    skip = told.get("skip_columns", 0)
    if not 0 <= above < len(lines) or not 0 <= skip < 10_000:
        came = f"{above} and {skip}, with {len(lines)} lines in the table"
        raise UnreadableFile(name, "header_lines and skip_columns that leave a table", came)
    rows = [line.strip(" ") for line in lines[above:] if line.strip()]
    separator = separator_of(rows[0]) if rows else None
    if "separator" in told:
        separator = SEPARATORS[told["separator"]]
    names = [str(word) for word in told.get("names", [])]
    n_columns = len(_without_last_empty(cells(rows[0], separator))) if rows else 0
    layout = told.get("layout", LAYOUTS[0])
    if names:
        columns = _columns(len(names), layout, skip, n_columns, name, source)
    else:
        points = points_of(cells(lines[above - 1], separator)) if above else points_of([])
        names, columns = points.names, np.array(points.columns, dtype=int).reshape(-1, 3)
        n_columns = len(_without_last_empty(cells(lines[above - 1], separator)))
        layout = LAYOUTS[0]
    if not names:
        raise UnreadableFile(name, "names of the points, or a header with them", "neither")
    at = told.get("time_column", 0)
    if not 0 <= at <= n_columns or (at and layout == "rows"):
        raise UnreadableFile(name, f"a time_column from 1 to {n_columns}", f"{at}")
    wanted = [*columns.ravel().tolist(), *([at - 1] if at else [])]
    table = table_of(
        rows, n_columns, separator=separator, source=source, first=above + 1, columns=wanted
    )
    refuse_cut_number(content, rows, source)
    time = table[:, -1] if at else None
    table = table[:, : columns.size]
    if layout == "rows":
        if len(table) % 3:
            raise UnreadableFile(source, "three lines a frame", f"{len(table)} lines")
        return _Table(names, table.reshape(-1, 3, len(names)).transpose(0, 2, 1), None)
    return _Table(names, table.reshape(len(table), len(names), 3), time)


def _without_last_empty(words: list[str]) -> list[str]:
    """Return cells without the one behind a separator that ends the line."""
    return words[:-1] if len(words) > 1 and not words[-1] else words


def _columns(
    n_points: int, layout: str, skip: int, n_columns: int, name: str, source: str
) -> np.ndarray:
    """Return the columns of x, y, z of each point; of the one coordinate a line for rows."""
    wanted = skip + (n_points if layout == "rows" else 3 * n_points)
    if n_columns != wanted:
        told = f"{n_points} names" + (f" behind {skip} columns" if skip else "")
        raise UnreadableFile(
            source,
            f"{wanted} columns for the {told} in {name} ({layout})",
            f"{n_columns}",
            "put names, layout or skip_columns right",
        )
    columns = np.arange(skip, wanted)
    if layout == "rows":
        return columns
    return columns.reshape(3, -1).T if layout == "planar" else columns.reshape(-1, 3)
