"""The origin of a walk in place: under the pelvis, on the floor."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from eigenwalker.gait.body_points import legs_of, pelvis_path

ANKLE_HEIGHT_OF_LEG = 0.084
"""Height of a standing ankle as a share of thigh and shank (ANSUR II: 0.040 of 0.475 of height)."""

_LOW_SHARE = 0.05
"""Quantile of the heights of a foot that counts as its lowest level; lower ones may be noise."""


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
    bones = [np.linalg.norm(np.diff(leg, axis=1), axis=2).mean(axis=0).sum() for leg in legs]
    lowest = min(np.quantile(leg[:, 2, 2], _LOW_SHARE) for leg in legs)
    return float(lowest - ANKLE_HEIGHT_OF_LEG * np.mean(bones))
