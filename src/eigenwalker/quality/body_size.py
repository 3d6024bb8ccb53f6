"""How tall a body is, and how constant its limbs are."""

from __future__ import annotations

import numpy as np
import xarray as xr

from eigenwalker.io.up_axis_and_unit import body_height, head_and_feet

LIMBS = tuple(
    (f"{side}_{upper}", f"{side}_{lower}")
    for side in ("left", "right")
    for upper, lower in (
        ("hip", "knee"),
        ("knee", "ankle"),
        ("shoulder", "elbow"),
        ("elbow", "wrist"),
    )
)
"""The segments that are single bones."""


def height_of(positions: np.ndarray, names: list[str]) -> float | None:
    """Return how tall a body is, NaN if its head is not above its feet; None if that is unknown."""
    if not all(np.isfinite(part).any() for part in head_and_feet(positions, names)):
        return None
    return body_height(positions, names)


def lean_of(positions: np.ndarray, names: list[str]) -> float:
    """Return by how many degrees the line from feet to head is off upright; NaN if unknown.

    Examples
    --------
    >>> round(lean_of(np.array([[[0.0, 0, 0], [1000, 0, 1000]]]), ["left_ankle", "head"]), 6)
    45.0

    """
    head, feet = head_and_feet(positions, names)
    if not head.shape[1] or not feet.shape[1]:
        return float("nan")
    rises = head.mean(axis=1) - feet.mean(axis=1)
    rises = rises[np.isfinite(rises).all(axis=1)]
    if not len(rises):
        return float("nan")
    rise = np.median(rises, axis=0)
    return float(np.degrees(np.arctan2(np.hypot(rise[0], rise[1]), rise[2])))


def bone_length_variation(capture: xr.DataArray) -> dict[tuple[str, str], float]:
    """Return the coefficient of variation of each limb's length.

    Examples
    --------
    >>> walk = ew.simulate_walk(seed=1, duration_s=2)
    >>> max(bone_length_variation(walk).values()) < 1e-9
    True

    """
    place = {name: index for index, name in enumerate(capture.marker.values.tolist())}
    found = {}
    for upper, lower in LIMBS:
        if upper in place and lower in place:
            bone = capture.values[:, place[upper]] - capture.values[:, place[lower]]
            length = np.linalg.norm(bone[np.isfinite(bone).all(axis=1)], axis=1)
            if len(length) and length.mean() > 0:
                found[upper, lower] = float(length.std() / length.mean())
    return found
