"""Captures whose points sit so that the neutral mannequin does not walk as the person did."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr

from eigenwalker.metric.retargeting import SHARES

WIDE_HIPS = 1.5
"""Hip ratio above which hips must be points on the skin."""


class RetargetingWarnings(NamedTuple):
    """Whether legs cross on the mannequin only; hips beside shoulders, over the mannequin's."""

    legs_cross: bool
    hip_ratio: float


def retargeting_warnings(own: xr.DataArray, shown: xr.DataArray) -> RetargetingWarnings:
    """Compare a walk of joints in place on its own body with the same on the mannequin.

    >>> own = ew.in_place(ew.simulate_walk(seed=1))
    >>> skin = own.copy()
    >>> skin.loc[{"marker": "left_hip", "axis": "y"}] += 150
    >>> [bool(retargeting_warnings(walk, own).hip_ratio > WIDE_HIPS) for walk in (own, skin)]
    [False, True]
    """
    usual = SHARES["hip_width"] / SHARES["shoulder_width"]
    return RetargetingWarnings(
        legs_cross=bool(np.sign(_width(own, "ankle")) != np.sign(_width(shown, "ankle"))),
        hip_ratio=abs(_width(own, "hip") / _width(own, "shoulder")) / usual,
    )


def _width(walk: xr.DataArray, joint: str) -> float:
    """Return how far the left joint is to the left of the right one, on average."""
    left, right = (walk.sel(marker=f"{side}_{joint}", axis="y") for side in ("left", "right"))
    return float((left - right).mean())
