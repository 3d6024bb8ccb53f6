"""The stride frequency of a walk: the omega of Troje (2002, eq. 2)."""

from __future__ import annotations

import numpy as np
import xarray as xr

from eigenwalker.trajectories import check_trajectories, sampling_rate

BOUNDS_HZ = (0.3, 2.0)
"""Strides a second that are looked for: from the slowest patient to a sprint."""

_COARSE_RATE_HZ = 12.0
"""Enough for the second harmonic of the fastest stride, three times over."""

_OCTAVE = 0.99
"""When about twice a frequency explains this share of what the frequency explains, the lower one
lives on its second harmonic alone: it is half the stride frequency."""

_CONVERGED = 1e-11
"""Relative size of the step to come, if steps go on to shrink as the last one did."""
_MAX_STEPS = 50


def fundamental_frequency(walk: xr.DataArray, *, n_harmonics: int = 2) -> float:
    """Return the stride frequency of a walk.

    The omega of Troje (2002, eq. 2) and of WDP2002 (eq. 1): the frequency whose sines, with their
    harmonics, explain most of the variance of all markers together. Steady progress through the
    room is allowed for.

    Parameters
    ----------
    walk : DataArray of shape (time, marker, axis)
        Trajectories in millimetres, any markers, better two strides or more.
    n_harmonics : int
        Harmonics that take part in the fit.

    Returns
    -------
    float
        Frequency of full strides, two steps each, in hertz.

    Raises
    ------
    ValueError
        If samples are missing, nothing moves, or the capture holds less than a stride.

    Examples
    --------
    >>> time = np.arange(0, 12, 1 / 120)
    >>> foot = np.sin(2 * np.pi * 0.85 * time)[:, None, None] * [200, 0, 0]
    >>> walk = ew.label_trajectories(foot, markers=["left_ankle"], rate_hz=120)
    >>> round(fundamental_frequency(walk), 9)
    0.85

    """
    walk = check_trajectories(walk, complete=True)
    movement = walk.values.reshape(walk.sizes["time"], -1)
    return frequency_of_scores(movement, sampling_rate(walk), n_harmonics=n_harmonics, trend=True)


def frequency_of_scores(
    scores: np.ndarray,
    rate_hz: float,
    *,
    n_harmonics: int = 2,
    bounds_hz: tuple[float, float] = BOUNDS_HZ,
    trend: bool = False,
) -> float:
    """Return the one frequency whose harmonics explain most of all columns together.

    A coarse search over the spectrum of velocities, in which drift weighs little, then variable
    projection: amplitudes and means are solved for at every trial frequency, which leaves a
    problem in one unknown.

    Parameters
    ----------
    scores : array of shape (time, component)
        Scores of principal components, or any other columns, evenly sampled.
    rate_hz : float
        Frames a second.
    n_harmonics : int
        Harmonics that every column may hold in the refinement.
    bounds_hz : pair of float
        Range of the search.
    trend : bool
        Whether each column may also have a constant velocity.

    Returns
    -------
    float
        Strides a second.

    Raises
    ------
    ValueError
        If nothing moves or there is less than about a stride.

    Examples
    --------
    >>> time = np.arange(0, 3, 1 / 50)
    >>> scores = np.stack([np.sin(5 * time), np.cos(10 * time)], axis=1)
    >>> round(2 * np.pi * frequency_of_scores(scores, 50), 9)
    5.0

    """
    n_frames = len(scores)
    if n_harmonics < 1:
        raise ValueError(f"n_harmonics={n_harmonics}; a walk needs 1 or more.")
    lowest = max(bounds_hz[0], _FEWEST_STRIDES * rate_hz / max(n_frames, 1))
    if n_frames < 8 or lowest >= 0.9 * bounds_hz[1]:
        raise ValueError(
            f"{n_frames} frames at {rate_hz:.4g} Hz last {n_frames / rate_hz:.3g} s, too short for "
            f"a stride; give {_FEWEST_STRIDES / bounds_hz[0]:.2g} s or more."
        )
    centred = scores - scores[0]
    centred -= np.full(n_frames, 1 / n_frames) @ centred
    if not np.abs(centred).max() > 1e-9 * max(1.0, np.abs(scores[0]).max()):
        raise ValueError("Nothing moves here, so there is no stride frequency.")
    coarse = _coarse_frequency(centred, rate_hz, (lowest, bounds_hz[1]))
    angle = 2 * np.pi / rate_hz
    return _refined(centred, coarse * angle, n_harmonics, trend=trend) / angle


_FEWEST_STRIDES = 0.9
"""Below about one stride two harmonics fit anything."""


def _coarse_frequency(scores: np.ndarray, rate_hz: float, bounds_hz: tuple[float, float]) -> float:
    """Return the frequency that explains velocities best with two harmonics, on a grid.

    The least-squares spectrum (mean, sines and cosines fitted together) has no leakage, so two
    strides are enough; its normal equations are known in closed form.
    """
    block = max(1, int(rate_hz / _COARSE_RATE_HZ))
    n_frames = len(scores) // block * block
    sums = np.add.reduceat(scores[:n_frames], np.arange(0, n_frames, block), axis=0)
    velocity = sums[1:] - sums[:-1]
    velocity -= (sums[-1] - sums[0]) / len(velocity)
    size = 1 << (4 * len(velocity) - 1).bit_length()
    spacing_hz = rate_hz / block / size
    grid = np.arange(
        max(1, int(np.ceil(bounds_hz[0] / spacing_hz))),
        min(size // 4, int(bounds_hz[1] / spacing_hz)) + 1,
    )
    explained = _explained_by_two_harmonics(velocity, grid, size)
    best = int(explained.argmax())
    about_double = (grid > 1.6 * grid[best]) & (grid < 2.4 * grid[best])
    higher = int(np.where(about_double, explained, 0.0).argmax())
    (offset, top), (higher_offset, higher_top) = (_peak(explained, at) for at in (best, higher))
    if about_double[higher] and higher_top >= _OCTAVE * top:
        best, offset = higher, higher_offset
    return float(grid[best] + offset) * spacing_hz


def _explained_by_two_harmonics(values: np.ndarray, grid: np.ndarray, size: int) -> np.ndarray:
    """Return the sum of squares that mean, first and second harmonic explain, for each of a grid.

    Time runs from the middle, where cosines are orthogonal to sines.
    """
    n = len(values)
    spectrum = np.fft.rfft(values, size, axis=0)
    theta = 2 * np.pi / size * grid

    def sums(harmonic: int) -> tuple[np.ndarray, np.ndarray]:
        turned = spectrum[harmonic * grid] * np.exp(0.5j * (n - 1) * harmonic * theta)[:, None]
        return turned.real, turned.imag

    (cos1, sin1), (cos2, sin2) = sums(1), sums(2)
    d1, d2, d3, d4 = (np.sin(n * h / 2 * theta) / np.sin(h / 2 * theta) for h in (1, 2, 3, 4))
    even = _explained(
        (n + d2) / 2 - d1**2 / n, (d1 + d3) / 2 - d1 * d2 / n, (n + d4) / 2 - d2**2 / n, cos1, cos2
    )
    odd = _explained((n - d2) / 2, (d1 - d3) / 2, (n - d4) / 2, sin1, sin2)
    return even + odd


def _explained(
    g11: np.ndarray, g12: np.ndarray, g22: np.ndarray, b1: np.ndarray, b2: np.ndarray
) -> np.ndarray:
    """Return b' inv(G) b for 2 x 2 normal matrices G, summed over columns."""
    b11, b12, b22 = (np.einsum("fc,fc->f", b, c) for b, c in ((b1, b1), (b1, b2), (b2, b2)))
    return (g22 * b11 - 2 * g12 * b12 + g11 * b22) / (g11 * g22 - g12**2)


def _peak(values: np.ndarray, peak: int) -> tuple[float, float]:
    """Return how far from a peak the top of a parabola through it lies, and how high that is."""
    top = float(values[peak])
    if not 0 < peak < len(values) - 1:
        return 0.0, top
    before, after = float(values[peak - 1]), float(values[peak + 1])
    bend = before - 2 * top + after
    if not (bend < 0 and before <= top >= after):
        return 0.0, top
    return 0.5 * (before - after) / bend, top - (before - after) ** 2 / (8 * bend)


def _refined(scores: np.ndarray, angle: float, n_harmonics: int, *, trend: bool) -> float:
    """Return the angle a frame at which harmonics leave the smallest residual.

    Gauss-Newton steps of the variable projection functional (Golub & Pereyra 1973), from a start
    that is right to a fraction of a cycle.
    """
    n = len(scores)
    reach = np.pi / n
    lowest, highest = angle - reach, angle + reach
    previous = reach
    for _ in range(_MAX_STEPS):
        step = _gauss_newton_step(scores, angle, n_harmonics, trend=trend)
        step = min(max(step, -reach / 2), reach / 2)
        angle = min(max(angle + step, lowest), highest)
        if abs(step) * min(abs(step / previous), 1) < _CONVERGED * angle:
            break
        previous = step
    return angle


def _gauss_newton_step(scores: np.ndarray, angle: float, n_harmonics: int, *, trend: bool) -> float:
    """Return the change of angle that variable projection proposes.

    All sums over frames come from one product of the basis, and of its derivative by the angle,
    with itself and with the data.
    """
    n = len(scores)
    frames = np.arange(n) - (n - 1) / 2
    n_fixed = 2 if trend else 1
    n_basis = n_fixed + 2 * n_harmonics
    rows = np.empty((n_basis + 2 * n_harmonics, n))
    rows[0] = 1
    rows[1] = frames / n
    turning = power = rotations(angle, n)
    for h in range(1, n_harmonics + 1):
        cos, sin = n_fixed + 2 * h - 2, n_fixed + 2 * h - 1
        rows[cos], rows[sin] = np.real(power), np.imag(power)
        np.multiply(rows[sin], -h * frames, out=rows[cos + 2 * n_harmonics])
        np.multiply(rows[cos], h * frames, out=rows[sin + 2 * n_harmonics])
        power = power * turning
    products, with_data = rows @ rows.T, rows @ scores
    inverse = np.linalg.inv(products[:n_basis, :n_basis])
    weights = inverse @ with_data[:n_basis]
    amplitudes = weights[n_fixed:]
    cross = products[:n_basis, n_basis:] @ amplitudes
    gradient = np.vdot(amplitudes, with_data[n_basis:]) - np.vdot(weights, cross)
    curvature = np.vdot(amplitudes, products[n_basis:, n_basis:] @ amplitudes)
    curvature -= np.vdot(cross, inverse @ cross)
    return float(gradient / curvature) if curvature > 0 else 0.0


def rotations(angle: float, n: int) -> np.ndarray:
    """Return exp(i angle t) for n frames t about their middle; few exponentials, many products."""
    within = int(np.sqrt(n)) + 1
    fine = np.exp(1j * angle * np.arange(within))
    coarse = np.exp(1j * angle * (np.arange(0, n, within) - (n - 1) / 2))
    return np.multiply.outer(coarse, fine).ravel()[:n]
