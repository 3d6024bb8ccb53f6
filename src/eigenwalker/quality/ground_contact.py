"""How a walk in place stands on its ground: lean, slope, speed, stance, and bend of the knees."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr

from eigenwalker.core.fourier import fit_basis, harmonic_basis
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

GRAVITY_MM_S2 = 9810.0

LOADING_BEND_DEG = 4.0
"""Bend of the knee that counts as one under load: in forward walking the mean curve has some 20
degrees at 14 per cent of the stride (Schwartz et al. 2008, J Biomech 41:1639)."""

_N_HARMONICS = 5
_FEWEST_FRAMES = 4 * _N_HARMONICS + 2
"""Twice what the harmonics need."""
_STANDING_SHARE = 0.25
"""Share of the frames in which an ankle moves backwards most evenly: those of stance."""


class GroundContact(NamedTuple):
    """Fields as in `Quality`."""

    roll_deg: float = float("nan")
    standing_slope: float = float("nan")
    froude: float = float("nan")
    stance_shares: float = float("nan")
    knees_bend_under_load: bool = False


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
        knees_bend_under_load=all(_bends_under_load(leg, frequency_hz / rate_hz) for leg in legs),
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


def _bends_under_load(leg: np.ndarray, strides_a_frame: float) -> bool:
    """Return whether a knee has a second wave of flexion a stride, beside that of the swing."""
    if len(leg) < _FEWEST_FRAMES:
        return False
    thigh, shank = np.diff(leg, axis=1).swapaxes(0, 1)
    lengths = np.linalg.norm(thigh, axis=1) * np.linalg.norm(shank, axis=1)
    cosine = np.einsum("ta,ta->t", thigh, shank) / np.maximum(lengths, 1e-9)
    flexion = np.degrees(np.arccos(np.clip(cosine, -1, 1)))
    weights = fit_basis(
        harmonic_basis(np.arange(len(leg)) * strides_a_frame, _N_HARMONICS), flexion
    )
    cycle = harmonic_basis(np.arange(100) / 100, _N_HARMONICS) @ weights
    cycle = np.roll(cycle, -int(cycle.argmax()))
    rises = cycle[1:-1] > np.maximum(cycle[:-2], cycle[2:])
    peaks = np.flatnonzero(rises) + 1
    return any(
        cycle[peak] - max(cycle[:peak].min(), cycle[peak:].min()) > LOADING_BEND_DEG
        for peak in peaks
    )
