"""How pelvis and trunk are turned in the room, as joints tell."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

import numpy as np

SIDES = ("left", "right")
LEAST_MM = 1.0
"""What is shorter has no direction."""


def body_frame(places: Mapping[str, np.ndarray], part: Literal["pelvis", "trunk"]) -> np.ndarray:
    """Return the axes of pelvis or trunk in the room: y from right to left, z up along the spine.

    The pelvis lies along the hips, the trunk along the shoulders; both lean as the way from pelvis
    to sternum does.

    Parameters
    ----------
    places : mapping of str to array of shape (time, 3)
        The joints ``pelvis``, ``sternum``, and hips or shoulders, by name.
    part : {"pelvis", "trunk"}
        Which.

    Returns
    -------
    array of shape (time, 3, 3)
        Rotation matrices, whose columns are forward, left and up; NaN where joints were not seen.

    Examples
    --------
    >>> places = {"pelvis": [[0, 0, 900]], "sternum": [[0, 0, 1400]]}
    >>> places |= {"left_hip": [[-90, 0, 900]], "right_hip": [[90, 0, 900]]}
    >>> places = {name: np.array(place, dtype=float) for name, place in places.items()}
    >>> body_frame(places, "pelvis")[0, :, 0].tolist()
    [0.0, 1.0, 0.0]

    """
    ends = {"pelvis": "hip", "trunk": "shoulder"}[part]
    left, right = (places[f"{side}_{ends}"] for side in SIDES)
    y, up = left - right, places["sternum"] - places["pelvis"]
    x = np.cross(y, up)
    axes = np.stack([x, y, np.cross(x, y)], axis=2)
    lengths = np.linalg.norm(axes, axis=1, keepdims=True)
    known = (lengths > LEAST_MM).all(axis=2, keepdims=True)
    return np.divide(axes, lengths, out=np.full_like(axes, np.nan), where=known) + 0.0
