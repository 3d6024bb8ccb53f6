"""The neutral mannequin on which walks are compared: its proportions, and how to recognise it."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr

HEIGHT_MM = 1693.0
"""Midway between the mean woman and the mean man of ANSUR II (Gordon et al. 2014)."""

SHARES: Mapping[str, float] = {
    "hip_width": 0.103,
    "hip_below": 0.049,
    "hip_before": 0.017,
    "shoulder_width": 0.2025,
    "spine": 0.240,
    "shoulder_below": 0.008,
    "neck": 0.124,
    "upper_arm": 0.173,
    "forearm": 0.1504,
    "hand": 0.058,
    "thigh": 0.2459,
    "calf": 0.2275,
    "foot": 0.100,
    "ankle_height": 0.0400,
    "toe_height": 0.0120,
}
"""Lengths as shares of height, midway between women and men. From ANSUR II: biacromial breadth,
heights of acromion, trochanter, tibiale and malleolus, acromion-radiale and radiale-stylion,
converted to joint centres as in `simulation` (Bell 1989 for the width of the hips, Harrington 2007
for their place in the pelvis); foot: ankle to ball, from foot length and heel-to-ball length.
Chosen: the hand, to the knuckles; the neck, from sternum to the centre of the head; the height of
the ball of the foot."""

SIDES = ("left", "right")

_RECOGNISED_BY = {
    ("pelvis", "sternum"): "spine",
    ("left_shoulder", "right_shoulder"): "shoulder_width",
    ("left_hip", "right_hip"): "hip_width",
    **{(f"{side}_hip", f"{side}_knee"): "thigh" for side in SIDES},
    **{(f"{side}_knee", f"{side}_ankle"): "calf" for side in SIDES},
}
_TOLERANCE = 0.01
"""Relative difference of lengths: no person has all of them so near to the mannequin's."""


LENGTHS_MM = {part: HEIGHT_MM * share for part, share in SHARES.items()}


def is_mannequin(clip: xr.DataArray) -> bool:
    """Return whether a clip is of the neutral mannequin (`retarget`), by its trunk and legs.

    Parameters
    ----------
    clip : DataArray of shape (time, marker, axis)
        Positions of joints in mm.

    Returns
    -------
    bool
        False if fewer than three lengths can be measured.

    Examples
    --------
    >>> walk = ew.simulate_walk(seed=1, duration_s=2)
    >>> is_mannequin(walk), is_mannequin(ew.metric.retarget(walk))
    (False, True)

    """
    index = {str(name): i for i, name in enumerate(clip.marker.values)}
    ratios = []
    for (start, end), part in _RECOGNISED_BY.items():
        if start in index and end in index:
            link = clip.values[:, index[start]] - clip.values[:, index[end]]
            link = link[np.isfinite(link).all(axis=1)]
            length = np.linalg.norm(link, axis=1).sum() / max(len(link), 1)
            ratios.append(length / LENGTHS_MM[part])
    return len(ratios) >= 3 and float(np.abs(np.subtract(ratios, 1)).max()) <= _TOLERANCE
