"""Points of a body by the names of its joints: paths, pelvis, facing, origin on the floor."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

SIDES = ("left", "right")

FLAT = 0.03
"""Thickness of a body over its length below which a capture has two dimensions: skeletons of real
captures reach 0.15 and more."""

COHERENT = 0.5
"""Mean of directions over their mean length: of a body seen from the side, left minus right changes
its sign with every step."""

ANKLE_HEIGHT_OF_LEG = 0.084
"""Height of a standing ankle as a share of thigh and shank (ANSUR II: 0.040 of 0.475 of height)."""

_LOW_SHARE = 0.05
"""Quantile of the heights of a foot that counts as its lowest level; lower ones may be noise."""


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


def leg_length_mm(legs: Sequence[np.ndarray]) -> float:
    """Return the mean length of thigh and shank together."""
    bones = [np.linalg.norm(np.diff(leg, axis=1), axis=2).mean(axis=0).sum() for leg in legs]
    return float(np.mean(bones))


def facing_by_names(positions: np.ndarray, markers: Sequence[str]) -> np.ndarray | None:
    """Return the direction x + iy square to hips and shoulders in each frame; None if unknown."""
    names = [[f"{side}_{part}" for side in SIDES] for part in ("hip", "shoulder")]
    pairs = [pair for each in names if (pair := paths_of(positions, markers, each)) is not None]
    if not pairs:
        return None
    x, y, _ = np.sum([pair[:, 0] - pair[:, 1] for pair in pairs], axis=0).T
    facing = y - 1j * x
    known = facing[np.isfinite(facing)]
    coherent = abs(known.sum()) >= COHERENT * np.abs(known).sum()
    return facing if coherent or thickness(positions) > FLAT else None


def thickness(positions: np.ndarray) -> float:
    """Return the SD of a body along its shortest axis over that along its longest; or NaN."""
    seen = positions[np.isfinite(positions).all(axis=(1, 2))]
    if not seen.size:
        return float("nan")
    centred = (seen - seen.mean(axis=1, keepdims=True)).reshape(-1, 3)
    least, _, most = np.linalg.eigvalsh(centred.T @ centred)
    return float(np.sqrt(max(least, 0) / most)) if most > 0 else float("nan")


def find_origin(positions: np.ndarray, markers: Sequence[str]) -> np.ndarray:
    """Return the point on the floor under the mean pelvis.

    The floor is `ANKLE_HEIGHT_OF_LEG` of the length of thigh and shank below the lowest standing
    ankle; where legs are not known, at the level of the lowest marker.
    """
    x, y, _ = pelvis_path(positions, markers).mean(axis=0)
    return np.array([x, y, _floor(positions, markers)])


def _floor(positions: np.ndarray, markers: Sequence[str]) -> float:
    legs = legs_of(positions, markers)
    if not legs:
        return float(np.quantile(positions[:, :, 2].min(axis=1), _LOW_SHARE))
    lowest = min(np.quantile(leg[:, 2, 2], _LOW_SHARE) for leg in legs)
    return float(lowest - ANKLE_HEIGHT_OF_LEG * leg_length_mm(legs))
