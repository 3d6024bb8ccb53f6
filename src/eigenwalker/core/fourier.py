"""Regression on a stride's harmonics: what of a movement repeats with every stride."""

from __future__ import annotations

import numpy as np


def harmonic_basis(cycles: np.ndarray, n_harmonics: int) -> np.ndarray:
    """Return 1, sin, cos, sin 2, cos 2 ... at the given moments (WDP2002, eq. 1).

    Parameters
    ----------
    cycles : array of shape (time,)
        Time in strides.
    n_harmonics : int
        Harmonics wanted.

    Returns
    -------
    array of shape (time, 1 + 2 * harmonic)

    Examples
    --------
    >>> harmonic_basis(np.array([0, 0.25]), 1).round(9).tolist()
    [[1.0, 0.0, 1.0], [1.0, 1.0, 0.0]]

    """
    angles = 2 * np.pi * np.multiply.outer(cycles, np.arange(1, n_harmonics + 1))
    basis = np.ones((len(cycles), 1 + 2 * n_harmonics))
    basis[:, 1::2] = np.sin(angles)
    basis[:, 2::2] = np.cos(angles)
    return basis


def regress(basis: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return the weights with which columns of `basis` explain `values` best.

    Through an orthogonal factorisation, so that nearly dependent columns do no harm.
    """
    q, r = np.linalg.qr(basis)
    return np.linalg.solve(r, q.T @ values)


def share_explained(movement: np.ndarray, cycles: np.ndarray, n_harmonics: int = 2) -> float:
    """Return the share of variance about the mean that harmonics explain, all columns together.

    Parameters
    ----------
    movement : array of shape (time, feature)
        Positions or scores.
    cycles : array of shape (time,)
        Time in strides.
    n_harmonics : int
        Harmonics that may explain.

    Returns
    -------
    float
        R2, 1 where nothing is left; 0 where nothing moves.

    Examples
    --------
    >>> cycles = np.linspace(0, 3, 300, endpoint=False)
    >>> movement = np.sin(2 * np.pi * cycles) + np.sin(6 * np.pi * cycles)
    >>> round(share_explained(movement[:, None], cycles, 2), 9)
    0.5

    """
    centred = movement - movement.mean(axis=0)
    basis = harmonic_basis(cycles, n_harmonics)
    residual = centred - basis @ regress(basis, centred)
    total = np.vdot(centred, centred)
    return float(1 - np.vdot(residual, residual) / total) if total > 0 else 0.0
