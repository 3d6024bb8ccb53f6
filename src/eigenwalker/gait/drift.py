"""Progress through the room and wander on the belt: movement slower than a stride."""

from __future__ import annotations

import numpy as np

from eigenwalker.core.fourier import fit_basis, harmonic_basis
from eigenwalker.gait.steady_strides import closing_step

DRIFT_BELOW = 0.4
"""Cycles a stride below which movement of the whole body is drift and not part of the gait."""

ONE_STRIDE = 1.5
"""In fewer strides a line cannot be separated from harmonics; the progress is then what is left
after a stride that closes."""

N_HARMONICS = 4
"""Harmonics of the stride that are fitted together with the drift, which then contains none."""


def mean_velocity(path: np.ndarray, cycles: np.ndarray) -> np.ndarray:
    """Return the velocity (axis,), in mm a stride, of a path that otherwise repeats."""
    if cycles[-1] - cycles[0] < ONE_STRIDE:
        return _velocity_of_one_stride(path, cycles)
    basis = np.column_stack([cycles, harmonic_basis(cycles, N_HARMONICS)])
    return fit_basis(basis, path)[0]


def slow_drift(path: np.ndarray, cycles: np.ndarray) -> np.ndarray:
    """Return the part of a path (time, axis) that is slower than a stride; times are in strides.

    A line and half-waves of less than `DRIFT_BELOW` cycles a stride, regressed together with the
    harmonics of the stride.
    """
    if cycles[-1] - cycles[0] < ONE_STRIDE:
        line = np.multiply.outer(cycles - cycles.mean(), _velocity_of_one_stride(path, cycles))
        return line + path.mean(axis=0)
    n_frames = len(cycles)
    n_strides = cycles[-1] - cycles[0]
    orders = np.arange(1, int(2 * DRIFT_BELOW * n_strides) + 1)
    middles = (np.arange(n_frames) + 0.5) / n_frames
    waves = np.cos(np.pi * np.multiply.outer(middles, orders))
    slow = np.column_stack([np.ones(n_frames), middles - 0.5, waves])
    harmonics = harmonic_basis(cycles, N_HARMONICS)[:, 1:]
    weights = fit_basis(np.column_stack([slow, harmonics]), path)
    return slow @ weights[: slow.shape[1]]


def _velocity_of_one_stride(path: np.ndarray, cycles: np.ndarray) -> np.ndarray:
    """Return the progress in a single stride, at whose end the body moves as at the beginning."""
    progress = path[-1] - path[0] + closing_step(path)
    return progress / (cycles[-1] + cycles[1] - 2 * cycles[0])
