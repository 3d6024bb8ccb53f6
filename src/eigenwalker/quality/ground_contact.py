"""How a walk in place stands on its ground: lean, slope, speed, length of strides, and stance."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr

from eigenwalker.core.kinematics import GRAVITY_MM_S2
from eigenwalker.gait.body_points import (
    ANKLE_HEIGHT_OF_LEG,
    SIDES,
    leg_length_mm,
    legs_of,
    paths_of,
)
from eigenwalker.gait.events import events_at
from eigenwalker.gait.heading import known_speed
from eigenwalker.gait.parameters import stance_shares as shares_of

_STANDING_SHARE = 0.25
"""Share of the frames in which an ankle moves backwards most evenly: those of stance."""


class GroundContact(NamedTuple):
    """Fields as in `Quality`."""

    roll_deg: float = float("nan")
    standing_slope: float = float("nan")
    froude: float = float("nan")
    stance_shares: float = float("nan")
    stride_of_leg: float = float("nan")


def ground_contact(walk: xr.DataArray, rate_hz: float) -> GroundContact:
    """Return what the joints of a walk in place show; NaN without hips, knees and ankles."""
    positions, names = walk.values, walk.marker.values.tolist()
    legs = legs_of(positions, names)
    if len(legs) < 2:
        return GroundContact()
    leg_mm = (1 + ANKLE_HEIGHT_OF_LEG) * leg_length_mm(legs)
    frequency_hz, speed = walk.attrs["frequency_hz"], known_speed(walk)
    slope = np.nan if speed < 0 else np.mean([_slope(leg[:, 2], rate_hz) for leg in legs])
    return GroundContact(
        roll_deg=_roll(positions, names),
        standing_slope=float(slope),
        froude=speed**2 / (GRAVITY_MM_S2 * max(leg_mm, 1e-9)),
        stance_shares=sum(shares_of(events_at(walk, frequency_hz), frequency_hz)),
        stride_of_leg=abs(speed) / frequency_hz / max(leg_mm, 1e-9),
    )


def _roll(positions: np.ndarray, names: list[str]) -> float:
    """Return the median of the mean leans of trunk, hips, shoulders and body to the left."""
    parts = {
        part: paths_of(positions, names, [f"{side}_{part}" for side in SIDES])
        for part in ("shoulder", "hip", "ankle")
    }
    leans = []
    for upper, lower in (("shoulder", "hip"), ("hip", "ankle")):
        above, below = parts[upper], parts[lower]
        if above is not None and below is not None:
            _, y, z = (above.mean(axis=1) - below.mean(axis=1)).mean(axis=0)
            leans.append(np.arctan2(y, z))
    for part in ("shoulder", "hip"):
        if (pair := parts[part]) is not None:
            _, y, z = (pair[:, 0] - pair[:, 1]).mean(axis=0)
            leans.append(np.arctan2(-z, y))
    return float(np.degrees(np.median(leans)))


def _slope(ankle: np.ndarray, rate_hz: float) -> float:
    """Return rise over run of an ankle while it moves backwards most evenly."""
    velocity = np.gradient(ankle, 1 / rate_hz, axis=0)
    order = np.argsort(velocity[:, 0])
    backwards = velocity[order, 0]
    backwards = backwards[backwards < 0]
    n = max(3, int(_STANDING_SHARE * len(ankle)))
    if len(backwards) < n:
        return float("nan")
    first = int(np.argmin(backwards[n - 1 :] - backwards[: len(backwards) - n + 1]))
    stance = velocity[order[first : first + n]].mean(axis=0)
    return float(stance[2] / stance[0])
