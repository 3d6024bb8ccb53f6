"""TSV files of Qualisys Track Manager: lines of keys, then a line a frame, in millimetres.

``0 0 0`` exactly, empty cells and NULL mean that a marker was not seen.
"""

from __future__ import annotations

import re

import xarray as xr

from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.text_table import cells, lines_of, refuse_cut_number, table_of
from eigenwalker.io.timestamps import on_even_clock, rate_of
from eigenwalker.io.to_trajectories import as_captured, without_zeros
from eigenwalker.io.up_axis_and_unit import Unit

MOST_KEYS = 10_000
"""Lines above the table: a dozen keys and one line an event."""

_BEGINNING = re.compile(rb"(?:\xef\xbb\xbf)?\s*NO_OF_(FRAMES|CAMERAS|MARKERS)\b", re.IGNORECASE)
_KEY = re.compile(r"[A-Z][A-Z0-9_]+", re.ASCII)
_COUNT = re.compile(r"\d{1,9}", re.ASCII)


def looks_like_qualisys_tsv(content: bytes) -> bool:
    """Return whether a file begins as Qualisys' tables do."""
    return _BEGINNING.match(content[:200]) is not None


def read_qualisys_tsv(
    content: bytes, *, source: str, unit: Unit | None = None, rate_hz: float | None = None
) -> xr.DataArray:
    """Return where the markers of a Qualisys table are.

    Parameters
    ----------
    content : bytes
        The whole file.
    source : str
        Its name, for messages.
    unit : Unit, optional
        Unit of its lengths, if it is not the millimetre, in which the program writes.
    rate_hz : float, optional
        Frames a second, where those in the file are wrong.

    Returns
    -------
    DataArray of shape (time, marker, axis)
        In millimetres, z up; NaN where a marker was not seen.

    Raises
    ------
    UnreadableFile
        If it holds no 3D data, is damaged or cut short.

    """
    lines = lines_of(content, source)
    keys, first = _keys(lines)
    names = keys.get("MARKER_NAMES", [])
    _check_head(keys, names, source)
    rate = rate_hz or rate_of("".join(keys.get("FREQUENCY", [])[:1]), "FREQUENCY", source)
    rows = [line for line in lines[first:] if line.strip()]
    n_frames = _count(keys, "NO_OF_FRAMES", source)
    if len(rows) != n_frames:
        why = "the file is cut short" if len(rows) < n_frames else "the count is wrong"
        raise UnreadableFile(source, f"{n_frames} frames, as it declares", f"{len(rows)}: {why}")
    in_front = _in_front(lines[first - 1], rows, len(names), source)
    table = table_of(
        rows, in_front + 3 * len(names), separator="\t", source=source, first=first + 1, short_by=3
    )
    refuse_cut_number(content, rows, source)
    positions = without_zeros(table[:, in_front:].reshape(len(table), -1, 3))
    start_s = 0.0
    if in_front == 2 and rate_hz is None:
        positions, rate, start_s = on_even_clock(positions, table[:, 1], source, rate)
    return as_captured(
        positions,
        names,
        rate_hz=rate,
        source=source,
        format_name="Qualisys TSV",
        unit=unit,
        usual_unit=Unit("mm", 1.0, "Qualisys writes millimetres"),
        start_s=start_s,
    )


def _in_front(head: str, rows: list[str], n_markers: int, source: str) -> int:
    """Return how many columns stand before the markers: number and time of a frame, or fewer."""
    words = [word.lower() for word in cells(head, "\t")[:2]]
    if words[:1] == ["frame"]:
        return 1 + (words[1:] == ["time"])
    closed = all(row.endswith("\t") for row in rows)
    in_front = max(row.count("\t") for row in rows) + 1 - closed - 3 * n_markers
    if in_front > 2:
        came = f"{in_front} columns more"
        raise UnreadableFile(source, f"three columns for each of {n_markers} markers", came)
    return max(in_front, 0)


def _keys(lines: list[str]) -> tuple[dict[str, list[str]], int]:
    """Return the keys with their values, and the line on which the table begins."""
    keys: dict[str, list[str]] = {}
    for at, line in enumerate(lines[:MOST_KEYS]):
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


def _check_head(keys: dict[str, list[str]], names: list[str], source: str) -> None:
    kind = "".join(keys.get("DATA_INCLUDED", ["3D"])[:1])
    if kind.upper() != "3D":
        raise UnreadableFile(source, "3D data", repr(kind[:20]), "export the 3D data as TSV")
    n_markers = _count(keys, "NO_OF_MARKERS", source)
    if n_markers != len(names) or not all(names):
        came = f"{len(names)} names"
        raise UnreadableFile(source, f"the names of {n_markers} markers, as it declares", came)


def _count(keys: dict[str, list[str]], key: str, source: str) -> int:
    word = "".join(keys.get(key, [])[:1])
    count = int(word) if _COUNT.fullmatch(word) else 0
    if not count:
        raise UnreadableFile(source, f"a count above 0 as {key}", repr(word[:40]))
    return count
