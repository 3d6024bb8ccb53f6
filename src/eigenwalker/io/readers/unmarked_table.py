"""Tables that no program marks as its own: a description beside them tells, or their columns."""

from __future__ import annotations

from pathlib import Path

import xarray as xr

from eigenwalker.io.column_names import points_of
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.readers.data3d import looks_like_data3d, read_data3d
from eigenwalker.io.readers.described_table import read_described_table
from eigenwalker.io.readers.skeleton_table import FEWEST_POINTS, header_of, read_skeleton_table
from eigenwalker.io.sniff import beside
from eigenwalker.io.text_table import cells, is_text, lines_of, separator_of
from eigenwalker.io.up_axis_and_unit import Unit

DESCRIPTION = ".toml"


def looks_like_table(content: bytes) -> bool:
    """Return whether a file is text in columns: of numbers, or under a line of names.

    Examples
    --------
    >>> looks_like_table(b"1.5 2.5 3.5"), looks_like_table(b"Dear colleague")
    (True, False)

    """
    if not is_text(content):
        return False
    try:
        lines = lines_of(content[:100_000], "")
    except UnreadableFile:
        return False
    first = next((line for line in lines if line.strip() and line[0] != "#"), "")
    separator = separator_of(first)
    words = cells(first, separator)
    return len(words) > 1 and (
        separator is not None or _numeric(words) or len(points_of(words).names) > 0
    )


def holds_points(beginning: bytes, path: Path) -> bool:
    """Return whether a table is one of points: named so, described beside, or ``data3d``."""
    if not looks_like_table(beginning):
        return False
    if beside(path, DESCRIPTION):
        return True
    lines = [line for line in lines_of(beginning, "")[:100] if line.strip() and line[0] != "#"]
    header, _ = header_of(lines, 0, separator_of(lines[0]))
    numeric = _numeric(cells(lines[0], separator_of(lines[0])))
    return (looks_like_data3d(lines) and numeric) or len(points_of(header).names) >= FEWEST_POINTS


def read_table(
    content: bytes,
    *,
    source: str,
    path: Path,
    unit: Unit | None = None,
    rate_hz: float | None = None,
) -> xr.DataArray:
    """Return where the points of a table are.

    Parameters
    ----------
    content : bytes
        The whole file.
    source : str
        Its name, for messages.
    path : Path
        Where it lies: a file of the same name that ends in ``.toml`` describes it.
    unit : Unit, optional
        Unit of its lengths, where neither table nor description name one.
    rate_hz : float, optional
        Frames a second, where neither table nor description name them.

    Returns
    -------
    DataArray of shape (time, marker, axis)
        In millimetres, z up.

    Raises
    ------
    UnreadableFile
        If nothing tells what its columns are, or it is damaged.

    """
    if description := beside(path, DESCRIPTION):
        return read_described_table(
            content, source=source, description=description, unit=unit, rate_hz=rate_hz
        )
    lines = lines_of(content, source)
    numeric = _numeric(cells(lines[0], separator_of(lines[0])))
    if numeric and looks_like_data3d(lines):
        return read_data3d(content, source=source, unit=unit, rate_hz=rate_hz)
    if numeric:
        raise UnreadableFile(
            source,
            "a line of names above the numbers, or a description beside the file",
            f"{len(cells(lines[0], separator_of(lines[0])))} numbers a line, and neither",
            f"write {path.with_suffix(DESCRIPTION).name} as docs/formats.md shows",
        )
    return read_skeleton_table(content, source=source, unit=unit, rate_hz=rate_hz)


def _numeric(words: list[str]) -> bool:
    """Return whether most words are numbers."""
    plain = [word.replace(",", ".", 1) for word in words if word]
    count = sum(word.lstrip("+-")[:1].isdigit() or word[:1] == "." for word in plain)
    return count > 0.8 * len(plain)
