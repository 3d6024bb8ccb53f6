"""Directions of axes in words, and the order in which tables write coordinates."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np

from eigenwalker.core.arguments import check_choice

Layout = Literal["planar", "interleaved"]
"""Coordinates of markers one after the other: x x x ... y y y ... z z z, or x y z x y z ..."""

FORWARD_LEFT_UP = ("forward", "left", "up")
"""The frame of this package."""

_AXES = {
    "forward": (0, 1),
    "backward": (0, -1),
    "left": (1, 1),
    "right": (1, -1),
    "up": (2, 1),
    "down": (2, -1),
}


def axes_matrix(axes: Sequence[str]) -> np.ndarray:
    """Return the 3 x 3 matrix that turns positions along these axes into forward, left and up.

    Axes are named by where they point: ``"forward"``, ``"left"``, ``"up"``, or the opposite of one.
    Positions (..., axis) are multiplied by it from the right; its transpose turns them back.
    """
    if len(axes) != 3 or not set(axes) <= set(_AXES) or len({_AXES[axis][0] for axis in axes}) < 3:
        raise ValueError(
            f"axes={tuple(axes)} are no three axes; give where they point, such as "
            f"{FORWARD_LEFT_UP}, out of {list(_AXES)}."
        )
    matrix = np.zeros((3, 3))
    for row, axis in enumerate(axes):
        matrix[row, _AXES[axis][0]] = _AXES[axis][1]
    return matrix


def from_rows(table: np.ndarray, layout: Layout) -> np.ndarray:
    """Return coordinates (..., 3 * marker) as positions (..., marker, axis)."""
    if _known(layout) == "planar":
        return table.reshape(*table.shape[:-1], 3, -1).swapaxes(-1, -2)
    return table.reshape(*table.shape[:-1], -1, 3)


def to_rows(positions: np.ndarray, layout: Layout) -> np.ndarray:
    """Return positions (..., marker, axis) as coordinates (..., 3 * marker)."""
    ordered = positions.swapaxes(-1, -2) if _known(layout) == "planar" else positions
    return ordered.reshape(*positions.shape[:-2], -1)


def _known(layout: str) -> str:
    check_choice(layout, ("planar", "interleaved"), "layout")
    return layout
