"""The origin of a walk in place: under the pelvis, on the floor."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

ANKLE_HEIGHT_OF_LEG = 0.084
"""Height of a standing ankle as a share of thigh and shank (ANSUR II: 0.040 of 0.475 of height)."""

_LOW_SHARE = 0.05
"""Quantile of the heights of a foot that counts as its lowest level; lower ones may be noise."""


def find_origin(positions: np.ndarray, markers: Sequence[str]) -> np.ndarray:
    """Return the point on the floor under the mean pelvis.

    The floor is `ANKLE_HEIGHT_OF_LEG` of the length of thigh and shank below the lowest standing
    ankle; where legs are not known, at the level of the lowest marker.

    Parameters
    ----------
    positions : array of shape (time, marker, axis)
        Whole strides in place.
    markers : sequence of str
        Their names.

    Returns
    -------
    array of shape (axis,)

    """
    place = {name: index for index, name in enumerate(markers)}
    for names in (["pelvis"], ["left_hip", "right_hip"], list(markers)):
        if set(names) <= set(place):
            centre = positions[:, [place[name] for name in names]].mean(axis=(0, 1))
            break
    return np.array([centre[0], centre[1], _floor(positions, place)])


def _floor(positions: np.ndarray, place: dict[str, int]) -> float:
    legs = [
        [positions[:, place[f"{side}_{joint}"]] for joint in ("hip", "knee", "ankle")]
        for side in ("left", "right")
        if {f"{side}_hip", f"{side}_knee", f"{side}_ankle"} <= set(place)
    ]
    if not legs:
        return float(np.quantile(positions[:, :, 2].min(axis=1), _LOW_SHARE))
    lengths = [
        np.linalg.norm(hip - knee, axis=1).mean() + np.linalg.norm(knee - ankle, axis=1).mean()
        for hip, knee, ankle in legs
    ]
    lowest = min(np.quantile(ankle[:, 2], _LOW_SHARE) for _, _, ankle in legs)
    return float(lowest - ANKLE_HEIGHT_OF_LEG * np.mean(lengths))
