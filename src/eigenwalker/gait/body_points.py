"""Points of a body by the names of its joints: their paths, the pelvis, the direction it faces."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

SIDES = ("left", "right")


def paths_of(
    positions: np.ndarray, markers: Sequence[str], names: Sequence[str]
) -> np.ndarray | None:
    """Return the paths of some markers, of shape (time, name, axis); None if one is missing."""
    place = {name: index for index, name in enumerate(markers)}
    if not set(names) <= set(place):
        return None
    return positions[:, [place[name] for name in names]]


def pelvis_path(positions: np.ndarray, markers: Sequence[str]) -> np.ndarray:
    """Return the path of the pelvis, else of the middle of the hips, else of all markers."""
    for names in (["pelvis"], ["left_hip", "right_hip"]):
        if (paths := paths_of(positions, markers, names)) is not None:
            return paths.mean(axis=1)
    return positions.mean(axis=1)


def legs_of(positions: np.ndarray, markers: Sequence[str]) -> list[np.ndarray]:
    """Return hip, knee and ankle of each leg that is known, of shape (time, 3, axis)."""
    names = [[f"{side}_{joint}" for joint in ("hip", "knee", "ankle")] for side in SIDES]
    legs = (paths_of(positions, markers, each) for each in names)
    return [leg for leg in legs if leg is not None]


def facing_by_names(positions: np.ndarray, markers: Sequence[str]) -> np.ndarray | None:
    """Return the horizontal direction that a body faces in each frame, as complex numbers x + iy.

    Square to the lines through both hips and both shoulders; None without these names.
    """
    names = [[f"{side}_{part}" for side in SIDES] for part in ("hip", "shoulder")]
    pairs = [pair for each in names if (pair := paths_of(positions, markers, each)) is not None]
    if not pairs:
        return None
    x, y, _ = np.sum([pair[:, 0] - pair[:, 1] for pair in pairs], axis=0).T
    return y - 1j * x
