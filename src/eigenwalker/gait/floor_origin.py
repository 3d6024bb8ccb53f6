"""Where the origin of a walk in place lies: under the pelvis, on the floor."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

ANKLE_HEIGHT_OF_LEG = 0.084
"""Height of a standing ankle as a share of thigh and shank (ANSUR II: 0.040 of 0.475 of height)."""

_LOW_SHARE = 0.05
"""Share of frames in which a foot is lower than what counts as its lowest level, against noise."""


def find_origin(positions: np.ndarray, markers: Sequence[str]) -> np.ndarray:
    """Return the point on the floor under the mean pelvis (A15).

    The floor is where the lowest standing ankle is as high above it as ankles are for such legs;
    where legs are not known, it is the level of the lowest marker.

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
