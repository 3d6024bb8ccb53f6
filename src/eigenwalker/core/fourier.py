"""Harmonics of a stride: their basis, regression on it, and the shift of the time origin.

Coefficients stand in one order everywhere: the constant where there is one, then sin 1, cos 1,
sin 2, cos 2 ...
"""

from __future__ import annotations

from typing import cast

import numpy as np

from eigenwalker.core.arguments import check_numbers


def harmonic_basis(cycles: np.ndarray, n_harmonics: int) -> np.ndarray:
    r"""Return the constant, and sine and cosine of each harmonic, at the given moments.

    .. math:: 1, \sin \omega t, \cos \omega t, \sin 2 \omega t, \cos 2 \omega t, \ldots

    Parameters
    ----------
    cycles : array of shape (time,)
        Time in strides.
    n_harmonics : int
        Number of harmonics.

    Returns
    -------
    array of shape (time, 1 + 2 * harmonic)

    See Also
    --------
    share_explained : How well harmonics describe a movement.

    References
    ----------
    Troje (2002), eq. 15. Troje (2002), The little difference, eq. 1.

    Examples
    --------
    >>> harmonic_basis(np.array([0, 0.25]), 1).round(9).tolist()
    [[1.0, 0.0, 1.0], [1.0, 1.0, 0.0]]
    """
    cycles = check_numbers(cycles, "cycles", "time")
    angles = 2 * np.pi * np.multiply.outer(cycles, np.arange(1, n_harmonics + 1))
    basis = np.ones((len(cycles), 1 + 2 * n_harmonics))
    basis[:, 1::2] = np.sin(angles)
    basis[:, 2::2] = np.cos(angles)
    return basis


def centred_harmonics(n_frames: int, cycles_per_frame: float, n_harmonics: int) -> np.ndarray:
    """Return the harmonic basis of evenly spaced frames, as rows, with time 0 in their middle.

    The shape is (1 + 2 * harmonic, frame). A faster `harmonic_basis`, transposed.
    """
    turn = unit_phasors(2 * np.pi * cycles_per_frame, n_frames)
    rows = np.ones((1 + 2 * n_harmonics, n_frames))
    power = turn
    for harmonic in range(n_harmonics):
        rows[2 * harmonic + 1] = np.imag(power)
        rows[2 * harmonic + 2] = np.real(power)
        power = power * turn
    return rows


def unit_phasors(angle: float, n_frames: int) -> np.ndarray:
    """Return exp(i angle t) for frames t about their middle; few exponentials, many products."""
    within = int(np.sqrt(n_frames)) + 1
    fine = np.exp(1j * angle * np.arange(within))
    coarse = np.exp(1j * angle * (np.arange(0, n_frames, within) - (n_frames - 1) / 2))
    return np.multiply.outer(coarse, fine).ravel()[:n_frames]


def fit_basis(basis: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return the weights with which the columns of a basis explain values best, by QR."""
    q, r = np.linalg.qr(basis)
    return np.linalg.solve(r, q.T @ values)


def fit_harmonics(
    postures: np.ndarray, cycles_per_frame: float, n_harmonics: int = 2
) -> tuple[np.ndarray, float]:
    """Return postures (time, feature) as a Fourier series of a known frequency, by least squares.

    Coefficients of 1, sin 1, cos 1 ... of shape (1 + 2 * harmonic, feature), time counting from the
    middle of the postures; and the sum of squares that is left.
    """
    shifted = postures - postures[0]
    rows = centred_harmonics(len(postures), cycles_per_frame, n_harmonics)
    products = rows @ shifted
    coefficients = cast("np.ndarray", np.linalg.solve(rows @ rows.T, products))
    residual = float(shifted.ravel() @ shifted.ravel() - coefficients.ravel() @ products.ravel())
    coefficients[0] += postures[0]
    return coefficients, max(residual, 0.0)


def share_explained(movement: np.ndarray, cycles: np.ndarray, n_harmonics: int = 2) -> float:
    """Return the share of variance about the mean that harmonics explain, all columns together.

    Parameters
    ----------
    movement : array of shape (time, feature)
        Positions or scores.
    cycles : array of shape (time,)
        Time in strides.
    n_harmonics : int
        Number of harmonics.

    Returns
    -------
    float
        R2: 1 where nothing is left; 0 where nothing moves.

    See Also
    --------
    harmonic_basis

    References
    ----------
    Troje (2002), fig. 3: coefficients of determination of the sine fits.

    Examples
    --------
    >>> cycles = np.linspace(0, 3, 300, endpoint=False)
    >>> movement = np.sin(2 * np.pi * cycles) + np.sin(6 * np.pi * cycles)
    >>> round(share_explained(movement[:, None], cycles, 2), 9)
    0.5
    """
    movement = check_numbers(movement, "movement", "time", "feature", least=2)
    if len(movement) != len(cycles):
        raise ValueError(f"movement has {len(movement)} moments and cycles {len(cycles)}.")
    centred = movement - movement.mean(axis=0)
    basis = harmonic_basis(cycles, n_harmonics)
    residual = centred - basis @ fit_basis(basis, centred)
    total = float(centred.ravel() @ centred.ravel())
    return 1 - float(residual.ravel() @ residual.ravel()) / total if total > 0 else 0.0


def shift_origin(coefficients: np.ndarray, angle: float) -> np.ndarray:
    r"""Return Fourier coefficients on a clock whose zero comes later by an angle of the stride.

    .. math:: \sin h (\omega t + \alpha) = \cos h\alpha \, \sin h \omega t
              + \sin h\alpha \, \cos h \omega t

    Parameters
    ----------
    coefficients : array of shape (2 * harmonic, ...)
        Of sin 1, cos 1, sin 2, cos 2 ..., without the constant.
    angle : float
        How much later the new origin is, in radians of the fundamental; a negative one delays the
        movement. Harmonic h moves h times as far.

    Returns
    -------
    array of shape (2 * harmonic, ...)

    See Also
    --------
    eigenwalker.core.fourier_coefficients : Of a walker.

    References
    ----------
    Troje (2002), eq. 2: the phase of the first component is set to 0.

    Examples
    --------
    A sine, seen from a quarter of a cycle later, is a cosine:

    >>> shift_origin(np.array([1.0, 0.0]), np.pi / 2).round(9).tolist()
    [0.0, 1.0]
    """
    coefficients = check_numbers(coefficients, "coefficients")
    if not coefficients.ndim or not coefficients.size or len(coefficients) % 2:
        raise ValueError(
            "coefficients must be of sin 1, cos 1, sin 2, cos 2 ..., two for each harmonic; got "
            f"shape {coefficients.shape}."
        )
    harmonics = np.arange(1, len(coefficients) // 2 + 1)
    turn = (harmonics * angle).reshape(-1, *[1] * (coefficients.ndim - 1))
    sine, cosine = coefficients[0::2], coefficients[1::2]
    shifted = np.empty_like(coefficients, dtype=float)
    shifted[0::2] = sine * np.cos(turn) - cosine * np.sin(turn)
    shifted[1::2] = sine * np.sin(turn) + cosine * np.cos(turn)
    return shifted
