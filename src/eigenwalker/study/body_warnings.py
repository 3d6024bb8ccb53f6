"""Captures whose points sit so that the neutral mannequin does not walk as the person did."""

from __future__ import annotations

import numpy as np
import xarray as xr

from eigenwalker.metric.mannequin import SHARES

WIDE_HIPS = 1.5
"""How much wider hips may be, beside shoulders, than those of the mannequin."""


def strangeness(own: xr.DataArray, shown: xr.DataArray) -> str:
    """Return in words why a walk is not itself on the mannequin; empty if it is.

    Parameters
    ----------
    own : DataArray of shape (time, marker, axis)
        A walk of joints in place on its own body, facing +x.
    shown : DataArray of shape (time, marker, axis)
        The same on the mannequin (`retarget`).

    Examples
    --------
    >>> own = ew.in_place(ew.simulate_walk(seed=1))
    >>> strangeness(own, own)
    ''
    >>> skin = own.copy()
    >>> skin.loc[{"marker": "left_hip", "axis": "y"}] += 150
    >>> strangeness(skin, own).startswith("its hips are")
    True

    """
    said = []
    if np.sign(_apart(own, "ankle")) != np.sign(_apart(shown, "ankle")):
        said.append("its legs cross on the mannequin, as they did not in the capture")
    usual = SHARES["hip_width"] / SHARES["shoulder_width"]
    wide = abs(_apart(own, "hip") / _apart(own, "shoulder")) / usual
    if wide > WIDE_HIPS:
        said.append(
            f"its hips are {wide:.1f} times as wide beside its shoulders as joints are, so they "
            "are points on the skin"
        )
    return ", and ".join(said)


def _apart(walk: xr.DataArray, joint: str) -> float:
    """Return how far the left joint is to the left of the right one, in the mean."""
    left, right = (walk.sel(marker=f"{side}_{joint}", axis="y") for side in ("left", "right"))
    return float((left - right).mean())
