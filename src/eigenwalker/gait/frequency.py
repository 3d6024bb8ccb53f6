"""The stride frequency of a walk: the omega of Troje (2002, eq. 2)."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import xarray as xr

from eigenwalker.core.arguments import check_numbers
from eigenwalker.core.fourier import centred_harmonics, share_explained
from eigenwalker.core.smoothing import parabola_vertex
from eigenwalker.core.trajectories import check_trajectories, sampling_rate


class NoStrideError(ValueError):
    """Nothing in a clip repeats as strides do, or it is too short for one.

    See Also
    --------
    fundamental_frequency : raises it.
    """


BOUNDS_HZ = (0.3, 3.0)
"""Range of strides a second in which the frequency is searched: slowest patient to sprint.
Sprinters take 2.2 to 2.6 (Weyand et al. 2000, J Appl Physiol 89:1991)."""

_COARSE_RATE_HZ = 18.0
"""Half as much again as the second harmonic of the fastest stride needs."""

_OCTAVE = 0.99
"""If about twice a frequency explains this share of what the frequency explains, the lower one
explains with its second harmonic alone: it is half the stride frequency."""

_RIVAL = 0.9
"""The same share on a coarse grid of velocities, from which on the octave is tested."""

_CONVERGED = 1e-6
"""Relative size of the last step. The next would be its square where sines fit exactly, and under a
hundredth of it in real walks."""
_MAX_STEPS = 50


def fundamental_frequency(trajectories: xr.DataArray, *, n_harmonics: int = 2) -> float:
    r"""Return the stride frequency of a walk.

    It is the frequency whose sines, with their harmonics, explain most of the variance of all
    markers together, in addition to a constant velocity of each:

    .. math:: \min_{\omega, p_0, v, a_h, b_h} \sum_t \Big\| p(t) - p_0 - v t - \sum_h
        \big(a_h \sin h \omega t + b_h \cos h \omega t\big) \Big\|^2

    Parameters
    ----------
    trajectories : DataArray of shape (time, marker, axis)
        Positions in millimetres, complete, of any markers, for two strides or more; in place or
        not.
    n_harmonics : int
        Harmonics that take part in the fit.

    Returns
    -------
    float
        Frequency of full strides, two steps each, in hertz.

    Raises
    ------
    ValueError
        If samples are missing; its subclass `NoStrideError` if nothing moves, or the capture holds
        less than a stride.

    See Also
    --------
    frequency_of_scores : the same for scores of principal components.

    References
    ----------
    Troje (2002), eq. 2; WDP2002, eq. 1.

    Examples
    --------
    >>> time = np.arange(0, 12, 1 / 120)
    >>> foot = np.sin(2 * np.pi * 0.85 * time)[:, None, None] * [200, 0, 0]
    >>> walk = ew.label_trajectories(foot, markers=["left_ankle"], rate_hz=120)
    >>> round(fundamental_frequency(walk), 9)
    0.85
    """
    walk = check_trajectories(trajectories, complete=True)
    movement = walk.values.reshape(walk.sizes["time"], -1)
    return frequency_of_scores(movement, sampling_rate(walk), n_harmonics=n_harmonics, trend=True)


def frequency_of_scores(
    scores: np.ndarray, rate_hz: float, *, n_harmonics: int = 2, trend: bool = False
) -> float:
    """Return the frequency whose harmonics explain most of the variance of all columns together.

    A coarse search over the spectrum of velocities, in which drift weighs little, is followed by
    variable projection: at every trial frequency amplitudes and means are solved for, which leaves
    a problem in one unknown.

    Parameters
    ----------
    scores : array of shape (time, component)
        Scores of principal components, or any other columns, evenly sampled.
    rate_hz : float
        Frames a second.
    n_harmonics : int
        Harmonics that every column may hold in the refinement.
    trend : bool
        Whether each column may also have a constant velocity.

    Returns
    -------
    float
        Strides a second.

    Raises
    ------
    NoStrideError
        If nothing moves or there is less than about a stride.

    See Also
    --------
    fundamental_frequency : Of a capture.

    References
    ----------
    Troje (2002), eq. 2. Golub & Pereyra (1973), SIAM J. Numer. Anal. 10, 413-432.

    Examples
    --------
    >>> time = np.arange(0, 3, 1 / 50)
    >>> scores = np.stack([np.sin(5 * time), np.cos(10 * time)], axis=1)
    >>> round(2 * np.pi * frequency_of_scores(scores, 50), 9)
    5.0
    """
    scores = check_numbers(scores, "scores", "time", "component", least=0)
    n_frames = len(scores)
    if n_harmonics < 1:
        raise ValueError(f"n_harmonics={n_harmonics}; a walk needs 1 or more.")
    lowest, highest = BOUNDS_HZ
    if rate_hz < 4 * lowest:
        raise NoStrideError(
            f"At {rate_hz:.3g} frames a second no stride can be seen. If its times are "
            "milliseconds, not seconds, name the rate: read_mocap(..., rate_hz=...)."
        )
    lowest = max(lowest, _FEWEST_STRIDES * rate_hz / max(n_frames, 1))
    if n_frames < 8 or lowest >= 0.9 * highest:
        raise NoStrideError(
            f"The part that could be used lasts {n_frames / rate_hz:.3g} s, too short for "
            f"a stride; give {_FEWEST_STRIDES / BOUNDS_HZ[0]:.2g} s or more."
        )
    least = 1e-9 * max(1.0, np.abs(scores[:1]).max(initial=0))
    centred = scores - np.full(n_frames, 1 / n_frames) @ scores
    if not np.vdot(centred, centred) > n_frames * least**2:
        raise NoStrideError("Nothing moves here but all as one, so there is no stride frequency.")
    block = max(1, int(rate_hz / _COARSE_RATE_HZ))
    n_blocks = n_frames // block
    blocks = np.add.reduceat(centred[: n_blocks * block], np.arange(0, n_blocks * block, block))
    angle = 2 * np.pi / rate_hz
    candidates = _coarse_frequencies(blocks, rate_hz / block, (lowest, highest))
    # Sums of a few frames have the frequency of the sine, so most of the search runs on them.
    angles = [
        _refined(blocks, each * angle * block, n_harmonics, trend, max_steps=1)
        for each in candidates
    ]
    coarse = _of_octaves(blocks, angles)
    found = _refined(centred, coarse / block, n_harmonics, trend)
    frequency_hz = found / angle
    doubled = 2 * frequency_hz
    within = highest < doubled < rate_hz / 4
    if within and _of_octaves(centred, [found, 2 * found]) > found:
        raise NoStrideError(
            f"The movement repeats {doubled:.3g} times a second, more often than strides do "
            f"({BOUNDS_HZ[1]:g} at most); look whether the frame rate of {rate_hz:.4g} Hz is right."
        )
    return frequency_hz


_FEWEST_STRIDES = 0.9
"""Below about one stride two harmonics fit anything."""


def _of_octaves(values: np.ndarray, angles: list[float]) -> float:
    """Return the angle of the stride: only it explains its own first harmonic."""
    chosen, *higher = sorted(angles)
    cycles = np.arange(len(values)) / (2 * np.pi)
    for angle in higher:
        shares = [share_explained(values, cycles * each) for each in (chosen, angle)]
        if shares[1] >= _OCTAVE * shares[0]:
            chosen = angle
    return chosen


def _coarse_frequencies(
    sums: np.ndarray, block_rate_hz: float, bounds_hz: tuple[float, float]
) -> list[float]:
    """Return the frequency that explains velocities best with two harmonics, on a grid.

    About half or twice that frequency is returned too where it explains nearly as much.

    The least-squares spectrum (mean, sines and cosines fitted together) has no leakage, so two
    strides are enough; its normal equations are known in closed form.
    """
    velocity = sums[1:] - sums[:-1]
    velocity -= (sums[-1] - sums[0]) / len(velocity)
    size = 1 << (4 * len(velocity) - 1).bit_length()
    spacing_hz = block_rate_hz / size
    first = max(1, int(np.ceil(bounds_hz[0] / spacing_hz)))
    last = min(size // 4, int(bounds_hz[1] / spacing_hz))
    spectrum = np.fft.rfft(velocity, size, axis=0)
    explained = _explained(spectrum, len(velocity), first, last)
    best = int(explained.argmax())
    offset, top = _peak(explained, best)
    candidates = [(first + best + offset) * spacing_hz]
    for octave in (0.5, 2.0):
        near = slice(
            max(round(0.8 * octave * (first + best)) - first, 0),
            max(round(1.2 * octave * (first + best)) - first + 1, 0),
        )
        if explained[near].size:
            rival = near.start + int(explained[near].argmax())
            rival_offset, rival_top = _peak(explained, rival)
            if rival_top >= _RIVAL * top:
                candidates.append((first + rival + rival_offset) * spacing_hz)
    return candidates


def _explained(spectrum: np.ndarray, n: int, first: int, last: int) -> np.ndarray:
    """Return the squares that mean and two harmonics explain, at the frequencies of a grid."""
    bins, turns, inverses = _normal_equations(n, 2 * (len(spectrum) - 1), first, last)
    turned = spectrum[bins] * turns[..., None]
    explained = np.zeros(turned.shape[1])
    for b, weights in zip((np.real(turned), np.imag(turned)), inverses, strict=True):
        explained += np.einsum("hf,hf->f", weights[:2], np.einsum("hfc,hfc->hf", b, b))
        explained += weights[2] * np.einsum("fc,fc->f", b[0], b[1])
    return explained


@lru_cache(maxsize=16)
def _normal_equations(
    n: int, size: int, first: int, last: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the least squares of mean, first and second harmonic at each frequency of a grid.

    Bins of the spectrum, what turns their time to run from the middle, where cosines are orthogonal
    to sines, and inverses. They depend on the number of samples only, so walks share them.
    """
    grid = np.arange(first, last + 1)
    theta = 2 * np.pi / size * grid
    d1, d2, d3, d4 = (np.sin(n * h / 2 * theta) / np.sin(h / 2 * theta) for h in (1, 2, 3, 4))
    even = _inverse((n + d2) / 2 - d1**2 / n, (d1 + d3) / 2 - d1 * d2 / n, (n + d4) / 2 - d2**2 / n)
    odd = _inverse((n - d2) / 2, (d1 - d3) / 2, (n - d4) / 2)
    turns = np.exp(0.5j * (n - 1) * np.multiply.outer([1, 2], theta))
    return np.multiply.outer([1, 2], grid), turns, np.stack([even, odd])


def _inverse(g11: np.ndarray, g12: np.ndarray, g22: np.ndarray) -> np.ndarray:
    """Return the weights of b1 b1, b2 b2 and b1 b2 in b' inv(G) b, for 2 x 2 matrices G."""
    return np.stack([g22, g11, -2 * g12]) / (g11 * g22 - g12**2)


def _peak(values: np.ndarray, peak: int) -> tuple[float, float]:
    """Return the vertex of the parabola through a peak; at an edge, the peak itself."""
    around = values[max(peak - 1, 0) : peak + 2].tolist()
    if len(around) < 3 or max(around) > around[1]:
        return 0.0, float(values[peak])
    return parabola_vertex(*around)


def _refined(
    scores: np.ndarray, angle: float, n_harmonics: int, trend: bool, max_steps: int = _MAX_STEPS
) -> float:
    """Return the angle a frame with the smallest residual, by Gauss-Newton steps."""
    reach = np.pi / len(scores)
    lowest, highest = angle - reach, angle + reach
    for _ in range(max_steps):
        step = _gauss_newton_step(scores, angle, n_harmonics, trend)
        step = min(max(step, -reach / 2), reach / 2)
        angle = min(max(angle + step, lowest), highest)
        if abs(step) < _CONVERGED * angle:
            break
    return angle


def _gauss_newton_step(scores: np.ndarray, angle: float, n_harmonics: int, trend: bool) -> float:
    """Return the step of the angle, from products of the basis and its derivative with the data."""
    n = len(scores)
    frames = np.arange(n) - (n - 1) / 2
    harmonics = centred_harmonics(n, angle / (2 * np.pi), n_harmonics)[1:]
    slopes = np.empty_like(harmonics)
    faster = np.multiply.outer(np.arange(1, n_harmonics + 1), frames)
    slopes[0::2], slopes[1::2] = faster * harmonics[1::2], -faster * harmonics[0::2]
    fixed = np.stack([np.ones(n), frames / n] if trend else [np.ones(n)])
    rows = np.concatenate([fixed, harmonics, slopes])
    n_fixed, n_basis = len(fixed), len(fixed) + len(harmonics)
    products, with_data = rows @ rows.T, rows @ scores
    inverse = np.linalg.inv(products[:n_basis, :n_basis])
    weights = inverse @ with_data[:n_basis]
    amplitudes = weights[n_fixed:]
    cross = products[:n_basis, n_basis:] @ amplitudes
    gradient = np.vdot(amplitudes, with_data[n_basis:]) - np.vdot(weights, cross)
    curvature = np.vdot(amplitudes, products[n_basis:, n_basis:] @ amplitudes)
    curvature -= np.vdot(cross, inverse @ cross)
    return float(gradient / curvature) if curvature > 0 else 0.0
