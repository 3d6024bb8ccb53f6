"""Columns called after points and axes (``nose_x``, ``Head X, Y, Z``) -> points."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from typing import NamedTuple

_UNIT = re.compile(r"[ _]*[\[(](mm|cm|m)[\])]$|_(mm|cm|m)$")
_AXIS_AFTER = re.compile(
    r"(?P<name>.+?)(?:[ _.:\-\[(]{1,9}[tp]?(?P<after>[xyzXYZ])[\])]?|(?P<glued>[XYZ]))"
)
_AXIS_BEFORE = re.compile(r"(?P<axis>[xyzXYZ])[ _.](?P<name>.+)")


class Column(NamedTuple):
    """A cell of a header: the point that it is about, if any, and the axis."""

    name: str
    axis: str


class Points(NamedTuple):
    """Points of a header, the columns of their x, y and z, and the columns of nothing else."""

    names: list[str]
    columns: list[tuple[int, int, int]]
    others: list[int]


def points_of(header: Sequence[str]) -> Points:
    """Return the points whose three coordinates a header names, in the order of their first.

    Parameters
    ----------
    header : sequence of str
        Cells such as ``nose_x``, ``Head (X)``, ``noseX``, ``x_nose``, ``LASI_tx``; a cell that is
        an axis only belongs to the point named before it.

    Returns
    -------
    Points

    Examples
    --------
    >>> points_of(["time", "Foot Left X", "Y", "Z", "nose_x", "nose_y", "nose_z", "max"])
    Points(names=['Foot Left', 'nose'], columns=[(1, 2, 3), (4, 5, 6)], others=[0, 7])

    """
    found: dict[tuple[str, int], dict[str, int]] = {}
    times: Counter[tuple[str, str]] = Counter()
    last = ""
    for index, cell in enumerate(header):
        column = _column(cell, last)
        if column is not None:
            last = column.name
            times[column] += 1  # the second nose_x is about another point of that name
            found.setdefault((last, times[column]), {})[column.axis] = index
    whole = {name: axes for name, axes in found.items() if len(axes) == 3}
    columns = [(axes["x"], axes["y"], axes["z"]) for axes in whole.values()]
    taken = {column for triple in columns for column in triple}
    others = [index for index in range(len(header)) if index not in taken]
    return Points([name for name, _ in whole], columns, others)


def _column(cell: str, last: str) -> Column | None:
    """Return what a cell of a header is about; None for anything but a coordinate."""
    cell = cell.strip()[:200]
    if cell.lower() in ("x", "y", "z"):
        return Column(last, cell.lower()) if last else None
    cell = _UNIT.sub("", cell)
    if hit := _AXIS_AFTER.fullmatch(cell):
        return Column(hit["name"], (hit["after"] or hit["glued"]).lower())
    if hit := _AXIS_BEFORE.fullmatch(cell):
        return Column(hit["name"], hit["axis"].lower())
    return None
