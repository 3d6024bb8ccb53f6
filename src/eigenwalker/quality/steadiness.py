"""How steady the strides of a capture are, and where they lead."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr

from eigenwalker.core.fourier import share_explained
from eigenwalker.gait.steady_strides import body_relative

LEVEL_CLIMB = 0.10
"""Rise over run of a path that is no longer level: the steepest ramps built for wheelchairs have
0.08, stairs 0.5; floors of laboratories that were set up askew 0.02."""

_LIVELY = 0.3
_LEAST_WAY_MM = 300.0


class Steadiness(NamedTuple):
    """What is known of the steady part of a capture; `Quality` says what each number is."""

    n_strides: int = 0
    steady_share: float = 0.0
    straight_passes: int = 0
    unwound_deg: float = 0.0
    frequency_hz: float = np.nan
    speed_mm_s: float = np.nan
    climb: float = np.nan
    climb_mm: float = np.nan
    wander_mm: float = np.nan
    filled_share: float = 0.0
    r2: float = np.nan
    periodicity: float = np.nan
    level: bool = True
    treadmill: bool = False


def steadiness_of(walk: xr.DataArray | None, positions: np.ndarray, rate_hz: float) -> Steadiness:
    """Return what is known of a walk.

    Parameters
    ----------
    walk : DataArray of shape (time, marker, axis) or None
        As `in_place` returns it; None if there is no steady walk.
    positions : array of shape (time, marker, axis)
        Of the whole capture.
    rate_hz : float
        Frames a second.

    """
    if walk is None:
        return Steadiness()
    facts = walk.attrs
    frequency_hz = facts["frequency_hz"]
    movement = walk.values.reshape(len(walk), -1)
    way = np.nanmax([abs(facts["speed_mm_s"]) / frequency_hz, _LEAST_WAY_MM]) * facts["n_strides"]
    climb = facts["climb_mm"] / way
    moving = max(1, _moving_frames(positions, rate_hz / frequency_hz))
    return Steadiness(
        n_strides=int(facts["n_strides"]),
        steady_share=min(1.0, len(walk) / moving),
        straight_passes=facts["straight_passes"],
        unwound_deg=facts["unwound_deg"],
        frequency_hz=frequency_hz,
        speed_mm_s=facts["speed_mm_s"],
        climb=float(climb),
        climb_mm=float(facts["climb_mm"]),
        wander_mm=facts["wander_mm"],
        filled_share=facts["filled_samples"] / (walk.sizes["time"] * walk.sizes["marker"]),
        r2=share_explained(movement, np.arange(len(walk)) * frequency_hz / rate_hz),
        periodicity=_periodicity(movement, round(rate_hz / frequency_hz)),
        level=bool(abs(climb) < LEVEL_CLIMB),
        treadmill=facts["treadmill"],
    )


def _moving_frames(positions: np.ndarray, stride: float) -> int:
    """Return how many frames there are in which the body moves as it does when walking."""
    seen = np.isfinite(positions).all(axis=(0, 2))
    movement = (
        body_relative(positions[:, seen]) if seen.sum() >= 3 else np.empty((len(positions), 0))
    )
    speed = np.linalg.norm(np.diff(movement, axis=0), axis=1)
    kernel = np.ones(max(1, round(stride / 2)))
    lively = np.convolve(speed, kernel, "same") / np.convolve(np.ones(len(speed)), kernel, "same")
    return int((lively > _LIVELY * np.quantile(lively, 0.8)).sum()) if movement.size else 0


def _periodicity(movement: np.ndarray, stride: int) -> float:
    """Return the correlation of all columns together with themselves a stride later."""
    centred = movement - movement.mean(axis=0)
    if len(centred) < 1.5 * stride:
        return float("nan")
    early, late = centred[:-stride], centred[stride:]
    scale = np.sqrt(np.vdot(early, early) * np.vdot(late, late))
    return float(np.vdot(early, late) / scale) if scale > 0 else float("nan")
