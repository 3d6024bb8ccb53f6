"""Tables that no program marks as its own: read by a description beside them, or their columns."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import xarray as xr

from eigenwalker.io.capture_file import CaptureFile, is_text, lines_of
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.readers.data3d import looks_like_data3d, read_data3d
from eigenwalker.io.readers.described_table import read_described_table
from eigenwalker.io.readers.skeleton_table import MIN_POINTS, header_of, read_skeleton_table
from eigenwalker.io.text_cells import cells, points_of, separator_of

DESCRIPTION = ".toml"


def looks_like_table(content: bytes) -> bool:
    """Return whether a file is text in columns: of numbers, or under a line of names."""
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
        separator is not None or _are_numbers(words) or len(points_of(words).names) > 0
    )


def holds_points(beginning: bytes, path: Path) -> bool:
    """Return whether a table is one of points: named so, described beside, or ``data3d``."""
    if not looks_like_table(beginning):
        return False
    if find_description(path):
        return True
    lines = [line for line in lines_of(beginning, "")[:100] if line.strip() and line[0] != "#"]
    separator = separator_of(lines[0])
    if _are_numbers(cells(lines[0], separator)) and looks_like_data3d(lines):
        return True
    return len(points_of(header_of(lines, 0, separator)[0]).names) >= MIN_POINTS


def find_description(path: Path) -> Path | None:
    """Return the file of the same name that ends in ``.toml``, if there is one."""
    description = path.with_suffix(DESCRIPTION)
    return description if description != path and description.is_file() else None


def read_table(file: CaptureFile) -> xr.DataArray:
    """Return the trajectories of the points in a table."""
    if description := find_description(file.path):
        return read_described_table(file, description)
    lines = file.lines
    words = cells(lines[0], separator_of(lines[0]))
    if not _are_numbers(words):
        return read_skeleton_table(file)
    if looks_like_data3d(lines):
        return read_data3d(file)
    raise file.error(
        "a line of names above the numbers, or a description beside the file",
        f"{len(words)} numbers a line, and neither",
        f"write {file.path.with_suffix(DESCRIPTION).name} as docs/formats.md shows",
    )


def _are_numbers(words: Sequence[str]) -> bool:
    plain = [word.replace(",", ".", 1) for word in words if word]
    count = sum(word.lstrip("+-")[:1].isdigit() or word[:1] == "." for word in plain)
    return count > 0.8 * len(plain)
