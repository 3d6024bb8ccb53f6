"""A low-pass filter without phase shift, for noisy captures."""

from __future__ import annotations

import numpy as np

from eigenwalker.core.runs import runs_of_true

_ORDER = 2
"""Run in both directions this is the fourth-order filter usual in biomechanics."""

_PASSES_CORRECTION = (np.sqrt(2) - 1) ** (1 / 4)
"""Tangent of the common cut-off of two passes over that of one."""


def low_passed(positions: np.ndarray, rate_hz: float, cut_off_hz: float) -> np.ndarray:
    """Return low-pass filtered positions, with half the power left at the cut-off.

    A Butterworth filter of second order, run forwards and backwards, between the gaps of each
    marker (Winter 2009, Biomechanics and Motor Control of Human Movement, eq. 3.8).
    """
    from scipy.signal import butter, sosfiltfilt  # takes 0.3 s; most captures need no filter

    if not 0 < cut_off_hz < rate_hz / 2:
        raise ValueError(
            f"low_pass_hz={cut_off_hz} is no cut-off for a capture at {rate_hz:.4g} Hz; give one "
            f"above 0 and below {rate_hz / 2:.4g}, for instance 6."
        )
    warped = np.tan(np.pi * cut_off_hz / rate_hz) / _PASSES_CORRECTION
    sections = butter(_ORDER, np.arctan(warped) * rate_hz / np.pi, fs=rate_hz, output="sos")
    settling = int(2 * rate_hz / cut_off_hz)
    smooth = positions.copy()
    for marker in range(positions.shape[1]):
        seen = np.atleast_1d(np.isfinite(positions[:, marker]).all(axis=1))
        for start, stop in runs_of_true(seen):
            if stop - start > 2:
                path = positions[start:stop, marker]
                pad = min(settling, len(path) - 1)
                smooth[start:stop, marker] = sosfiltfilt(sections, path, axis=0, padlen=pad)
    return smooth
