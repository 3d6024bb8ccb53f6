"""Smoothing of noisy captures: a low-pass filter that shifts nothing in time."""

from __future__ import annotations

import numpy as np

from eigenwalker.gait.gaps import runs_of

_ORDER = 2
"""Forth and back this is the fourth-order filter usual in biomechanics (Winter 2009, ch. 3.4)."""

_PASSES_CORRECTION = (np.sqrt(2) - 1) ** (1 / 4)
"""Two passes let less through at the cut-off of one; this makes it the cut-off of both."""


def low_passed(positions: np.ndarray, rate_hz: float, cut_off_hz: float) -> np.ndarray:
    """Return positions without what is faster than a cut-off, at which half the power is left.

    A Butterworth filter of second order, run forth and back (Winter 2009, Biomechanics and Motor
    Control of Human Movement, eq. 3.8).

    Parameters
    ----------
    positions : array of shape (time, marker, axis)
        NaN where missing; each marker is filtered between its gaps.
    rate_hz : float
        Frames a second.
    cut_off_hz : float
        Below half the rate; 6 Hz is usual for walking.

    Returns
    -------
    array of shape (time, marker, axis)

    Raises
    ------
    ValueError
        If the cut-off is not between 0 and half the rate.

    Examples
    --------
    >>> time = np.arange(0, 4, 0.01)
    >>> fast = np.sin(2 * np.pi * 6 * time)[:, None, None] * [[1, 0, 0]]
    >>> left = low_passed(fast, 100, 6.0)[100:300]
    >>> round(float(left.max() ** 2), 2)
    0.5

    """
    from scipy.signal import butter, sosfiltfilt  # takes 0.3 s, and most captures need no filter

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
        for start, stop in runs_of(seen):
            if stop - start > 2:
                path = positions[start:stop, marker]
                pad = min(settling, len(path) - 1)
                smooth[start:stop, marker] = sosfiltfilt(sections, path, axis=0, padlen=pad)
    return smooth
