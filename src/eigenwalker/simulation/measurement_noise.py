"""What a capture adds to a walk: noise, a belt that drifts, markers lost from sight."""

from __future__ import annotations

import numpy as np

MEAN_GAP_S = 0.05
LONGEST_GAP_S = 0.12


def with_noise(values: np.ndarray, sd_mm: float, chance: np.random.Generator) -> np.ndarray:
    """Return positions with independent noise in each coordinate."""
    if not sd_mm:
        return values
    noise = chance.standard_normal(values.shape)
    noise *= sd_mm
    return np.add(noise, values, out=noise)


def with_drift(values: np.ndarray, time: np.ndarray, mm_s: float) -> np.ndarray:
    """Return positions of someone whom the belt slowly carries forward."""
    if not mm_s:
        return values
    drifted = values.copy()
    drifted[..., 0] += mm_s * time[:, None]
    return drifted


def with_gaps(
    values: np.ndarray, rate_hz: float, share: float, chance: np.random.Generator
) -> np.ndarray:
    """Return positions with a share of the samples missing, in gaps of up to 0.12 s.

    Parameters
    ----------
    values : array of shape (frame, marker, 3)
    rate_hz : float
        Frames a second.
    share : float
        Of all samples; each marker loses its own.
    chance : Generator

    Returns
    -------
    array of shape (frame, marker, 3)
        NaN where missing.

    """
    n_frames, n_markers, _ = values.shape
    holed = values.copy()
    for marker in range(n_markers):
        lost = 0
        while lost < share * n_frames:
            drawn = chance.exponential(MEAN_GAP_S)
            length = 1 + int(min(drawn, LONGEST_GAP_S) * rate_hz)
            start = int(chance.integers(n_frames))
            holed[start : start + length, marker] = np.nan
            lost += length
    return holed
