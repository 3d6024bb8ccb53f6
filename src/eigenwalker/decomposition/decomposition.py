"""One walk taken apart: eigenpostures (Troje 2002) or a Fourier series (WDP2002, Moler 2016).

Both give the same `Walker`, ``p(t) = p0 + sum_i p_i sin(h_i w t + phi_i)``. The eigenposture form
finds the postures by principal components and leaves the phases free; the Fourier form fixes the
phases at 0 and a quarter cycle and finds the postures by regression. The two share the stride
frequency, which is the only thing that is not linear.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy.linalg.blas import dsyrk  # pyright: ignore[reportAttributeAccessIssue] - untyped
from scipy.linalg.lapack import dsyevr  # pyright: ignore[reportAttributeAccessIssue] - untyped

from eigenwalker.core.trajectories import check_trajectories, sampling_rate
from eigenwalker.core.walker import CaptureFit, Form, Walker, shift_origin
from eigenwalker.gait.frequency import frequency_of_centred, rotations

PHASE_REFERENCE = ("left_ankle", "right_ankle")
"""The markers whose distance along x sets the time origin: first minus second rises through 0."""
_SHARES_KEPT = 10
_ROUNDING = 1e-9
_FAR = 1e3
"""Power over variance above which products about the origin lose too many digits."""


class Eigenpostures(NamedTuple):
    """Principal components of postures, and the sines fitted to their scores (J5 to J8)."""

    mean: np.ndarray
    components: np.ndarray
    scatter: np.ndarray
    frequency_hz: float
    harmonics: np.ndarray
    amplitudes: np.ndarray
    phases: np.ndarray
    sine_r2: np.ndarray
    rate_hz: float


def decompose_pca(walk: xr.DataArray, *, n_harmonics: int = 2) -> Walker:
    """Return the eigenpostures of a walk and the sines they ride on.

    Troje (2002), eq. 1 to 3 (J5 to J11): principal components of the postures, two for each
    harmonic; a sine of the stride frequency or of the multiple that explains most, fitted to the
    scores of each; amplitudes multiplied into the eigenpostures; the phase of the first set to 0.

    The sign of the first eigenposture is the one in which the left ankle is ahead of the right
    where its sine is positive (its largest entry is positive where there are no ankles); the
    others have the sign that puts their phase between 0 and pi. Which eigenposture of one walker
    corresponds to which of another is settled by `Population`.

    Parameters
    ----------
    walk : DataArray of shape (time, marker, axis)
        Steady walking in place, such as `in_place` returns; millimetres, no missing samples.
    n_harmonics : int
        Multiples of the stride frequency to allow; there are two eigenpostures for each.

    Returns
    -------
    Walker
        With ``walker.fit`` telling how well it explains the walk.

    Examples
    --------
    >>> time = np.arange(0, 10, 0.01)
    >>> swing = np.sin(2 * np.pi * time)[:, None, None] * [[200, 0, 0], [-200, 0, 0]]
    >>> lift = np.cos(4 * np.pi * time)[:, None, None] * [[0, 0, 30], [0, 0, 30]]
    >>> feet = ["left_ankle", "right_ankle"]
    >>> walk = ew.label_trajectories(swing + lift, markers=feet, rate_hz=100)
    >>> walker = decompose_pca(walk)
    >>> round(walker.frequency_hz, 6), walker.harmonics[:2].tolist()
    (1.0, [1, 2])
    >>> walker.eigenpostures.sel(component=1, axis="x").values.round(6).tolist()
    [200.0, -200.0]

    """
    walk, postures, rate_hz = _postures(walk, n_harmonics)
    found = _checked(eigenpostures_of(postures, rate_hz, n_harmonics), n_harmonics)
    markers = walk.marker.values.tolist()
    p = (found.amplitudes[:, None] * found.components).reshape(-1, len(markers), 3)
    phases = found.phases.copy()
    if is_negative(p[0], markers):
        p[0], phases[0] = -p[0], phases[0] + np.pi
    origin = -phases[0] / found.harmonics[0]
    phases, turned = _half_turn(phases + found.harmonics * origin)
    p[turned] *= -1
    fourier, fourier_residual = fourier_of(postures, found.frequency_hz / rate_hz, n_harmonics)
    return _walker(
        walk,
        postures,
        found,
        form="eigenposture",
        origin=origin,
        fourier=fourier,
        fourier_residual=fourier_residual,
        p0=found.mean,
        p=p,
        harmonics=found.harmonics,
        phases=phases,
    )


def decompose_fourier(
    walk: xr.DataArray,
    *,
    n_harmonics: int = 2,
    phase_ref: tuple[str, str] = PHASE_REFERENCE,
) -> Walker:
    """Return a walk as a Fourier series with vectors for coefficients.

    WDP2002, eq. 1, Troje (2002), eq. 15, and Moler (2016), by least squares (W2, J43, M2); postures
    ``p1`` to ``p4`` are the coefficients of sin 1, cos 1, sin 2, cos 2. The papers state no time
    origin, which walkers must share if they are to be compared: here the fundamental of left minus
    right ankle along the walking direction is a pure sine (A4).

    Parameters
    ----------
    walk : DataArray of shape (time, marker, axis)
        Steady walking in place, such as `in_place` returns; millimetres, no missing samples.
    n_harmonics : int
        Harmonics to take.
    phase_ref : pair of str
        Markers whose distance along x sets the origin. Where the walk lacks them, the largest
        axis of the ellipse on which the fundamental moves all markers does.

    Returns
    -------
    Walker
        With ``walker.fit`` telling how well it explains the walk.

    Examples
    --------
    >>> time = np.arange(0, 10, 0.01)
    >>> foot = np.cos(2 * np.pi * time)[:, None, None] * [[200, 0, 0]]
    >>> walk = ew.label_trajectories(foot, markers=["foot"], rate_hz=100)
    >>> walker = decompose_fourier(walk, n_harmonics=1)
    >>> walker.eigenpostures.sel(component=1, axis="x").values.round(6).tolist()
    [200.0]
    >>> round(walker.time_origin_s, 6)
    0.75

    """
    walk, postures, rate_hz = _postures(walk, n_harmonics)
    found = _checked(eigenpostures_of(postures, rate_hz, n_harmonics), n_harmonics)
    markers = walk.marker.values.tolist()
    # The mean posture is regressed too: over broken strides it is not the average of frames.
    fourier, residual = fourier_of(postures, found.frequency_hz / rate_hz, n_harmonics)
    coefficients = fourier[1:].reshape(2 * n_harmonics, len(markers), 3)
    origin = origin_angle(coefficients, markers, phase_ref)
    return _walker(
        walk,
        postures,
        found,
        form="fourier",
        origin=origin,
        fourier=fourier,
        fourier_residual=residual,
        p0=fourier[0],
        p=shift_origin(coefficients, origin),
        harmonics=np.repeat(np.arange(1, n_harmonics + 1), 2),
        phases=np.tile([0.0, np.pi / 2], n_harmonics),
    )


def eigenpostures_of(postures: np.ndarray, rate_hz: float, n_harmonics: int = 2) -> Eigenpostures:
    """Return the principal components of postures with sines fitted to their scores (J5 to J8).

    The numerical core of both decompositions, on plain arrays.

    Parameters
    ----------
    postures : array of shape (time, feature)
        Evenly sampled.
    rate_hz : float
        Frames a second.
    n_harmonics : int
        Multiples of the stride frequency to choose from.

    Returns
    -------
    Eigenpostures
        Phases count from the middle of the postures; components are rows of unit length; of the
        scatter (sums of squares and products about the mean) only the lower triangle is filled.

    """
    n_features = postures.shape[1]
    n_components = min(2 * n_harmonics, n_features)
    mean, scatter = _mean_and_scatter(postures)
    power, axes = _largest_eigenpairs(scatter, n_components)
    scores = postures @ axes
    scores -= mean @ axes
    frequency_hz = frequency_of_centred(scores, rate_hz, n_harmonics=n_harmonics)

    sines = _sines(len(postures), frequency_hz / rate_hz, n_harmonics)[1:]
    harmonics, amplitudes, phases, sine_r2 = _fit_sines(
        sines @ scores, sines @ sines.T, np.maximum(power, 0.0)
    )
    return Eigenpostures(
        mean=mean,
        components=axes.T,
        scatter=scatter,
        frequency_hz=frequency_hz,
        harmonics=harmonics,
        amplitudes=amplitudes,
        phases=phases,
        sine_r2=sine_r2,
        rate_hz=rate_hz,
    )


def _mean_and_scatter(postures: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Mean, and sums of squares and products about it (lower triangle).

    Products about the origin are quicker; where the postures are so far from it that subtracting
    their mean's would cost digits, they are taken about the first posture.
    """
    n = len(postures)
    mean = np.full(n, 1 / n) @ postures
    scatter = dsyrk(1.0, postures.T, lower=True)
    power = scatter.trace()
    if power < _FAR * (power - n * (mean @ mean)):
        scatter -= np.multiply.outer(mean, n * mean)
        return mean, scatter
    shifted = postures - postures[0]
    offset = np.full(n, 1 / n) @ shifted
    scatter = dsyrk(1.0, shifted.T, lower=True) - n * np.outer(offset, offset)
    return postures[0] + offset, scatter


def _largest_eigenpairs(scatter: np.ndarray, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Largest eigenvalues, and their eigenvectors as columns, of a lower triangle."""
    d = len(scatter)
    values, vectors, _, _, failed = dsyevr(scatter, range="I", il=d - n + 1, iu=d, lower=1)
    if failed:
        raise ValueError("The principal components of this walk could not be found.")
    return values[n - 1 :: -1], np.ascontiguousarray(vectors[:, n - 1 :: -1])


def fourier_of(
    postures: np.ndarray, cycles_per_frame: float, n_harmonics: int = 2
) -> tuple[np.ndarray, float]:
    """Return postures as a Fourier series of a known frequency, by least squares (W2, M2).

    Parameters
    ----------
    postures : array of shape (time, feature)
        Evenly sampled.
    cycles_per_frame : float
        Stride frequency over frame rate.
    n_harmonics : int
        Harmonics to take.

    Returns
    -------
    coefficients : array of shape (1 + 2 * harmonic, feature)
        Of 1, sin 1, cos 1, sin 2, cos 2 ..., time counting from the middle of the postures.
    residual : float
        Sum of squares left over.

    """
    shifted = postures - postures[0]
    design = _sines(len(postures), cycles_per_frame, n_harmonics)
    products = design @ shifted
    coefficients = np.linalg.solve(design @ design.T, products)
    residual = float(np.vdot(shifted, shifted) - np.vdot(coefficients, products))
    coefficients[0] += postures[0]
    return coefficients, max(residual, 0.0)


def _sines(n_frames: int, cycles_per_frame: float, n_harmonics: int) -> np.ndarray:
    """Rows 1, sin 1, cos 1, sin 2, cos 2 ... on a clock with its zero in the middle."""
    turn = rotations(2 * np.pi * cycles_per_frame, n_frames)
    rows = np.empty((1 + 2 * n_harmonics, n_frames))
    rows[0] = 1
    power = turn
    for harmonic in range(n_harmonics):
        rows[2 * harmonic + 1] = np.imag(power)
        rows[2 * harmonic + 2] = np.real(power)
        power = power * turn
    return rows


def _fit_sines(
    products: np.ndarray, gram: np.ndarray, power: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Fit each score's dominant harmonic, c_i(t) = a_i sin(h_i w t + psi_i) with a_i > 0 (J8).

    From the products of the sines with the scores and with one another, and the scores' squares.
    """
    sine, cosine = slice(0, None, 2), slice(1, None, 2)
    ss, cc = gram.diagonal()[sine, None], gram.diagonal()[cosine, None]
    sc = gram.diagonal(1)[sine, None]
    with_sine, with_cosine = products[sine], products[cosine]
    determinant = ss * cc - sc**2
    on_sine = (cc * with_sine - sc * with_cosine) / determinant
    on_cosine = (ss * with_cosine - sc * with_sine) / determinant
    explained = on_sine * with_sine + on_cosine * with_cosine
    best, each = explained.argmax(axis=0), np.arange(products.shape[1])
    a, b = on_sine[best, each], on_cosine[best, each]
    r2 = explained[best, each] / np.where(power > 0, power, 1)
    return best + 1, np.hypot(a, b), np.arctan2(b, a), r2


def _postures(walk: xr.DataArray, n_harmonics: int) -> tuple[xr.DataArray, np.ndarray, float]:
    """Check what came, once, and lay each posture out as a row (J4)."""
    if n_harmonics != int(n_harmonics) or n_harmonics < 1:
        raise ValueError(f"n_harmonics={n_harmonics} must be a whole number, 1 or more.")
    walk = check_trajectories(walk, complete=True)
    if not walk.sizes["marker"]:
        raise ValueError("These trajectories hold no markers, so there is nothing to take apart.")
    rate_hz = sampling_rate(walk)
    if (needed := 4 * n_harmonics + 2) > len(walk.time):
        raise ValueError(
            f"A walk with {n_harmonics} harmonics needs {needed} frames or more, "
            f"got {len(walk.time)}."
        )
    return walk, walk.values.reshape(len(walk.time), -1), rate_hz


def _checked(found: Eigenpostures, n_harmonics: int) -> Eigenpostures:
    """Refuse harmonics that this many frames a second cannot show."""
    highest_hz = n_harmonics * found.frequency_hz
    if highest_hz >= found.rate_hz / 2:
        raise ValueError(
            f"Harmonic {n_harmonics} of {found.frequency_hz:.2f} Hz is {highest_hz:.1f} Hz, which "
            f"{found.rate_hz:.4g} frames a second cannot show; take "
            f"{int((found.rate_hz / 2 - 1e-9) / found.frequency_hz)} harmonics at most."
        )
    return found


def _half_turn(phases: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Phases taken into [0, pi), and which of them changed sign for it.

    The first phase, 0 by its making, keeps its sign whatever the rounding.
    """
    phases = (phases + _ROUNDING) % (2 * np.pi) - _ROUNDING
    phases[0] = 0.0
    turned = phases >= np.pi - _ROUNDING
    return np.where(turned, phases - np.pi, phases), turned


def is_negative(posture: np.ndarray, markers: Sequence[str]) -> bool:
    """Return whether a first eigenposture has to change its sign (A4).

    It is positive where the left ankle is ahead of the right; where there are no ankles, where its
    largest entry is positive.
    """
    left, right = PHASE_REFERENCE
    if left in markers and right in markers:
        names = list(markers)
        ahead = posture[names.index(left), 0] - posture[names.index(right), 0]
        if ahead != 0:
            return bool(ahead < 0)
    return bool(posture.flat[np.abs(posture).argmax()] < 0)


def origin_angle(
    coefficients: np.ndarray,
    markers: Sequence[str],
    phase_ref: tuple[str, str] = PHASE_REFERENCE,
) -> float:
    """Return the angle of the stride at which the reference rises through zero (A4).

    Parameters
    ----------
    coefficients : array of shape (2 * harmonic, marker, axis)
        Of sin 1, cos 1, sin 2, cos 2 ...
    markers : sequence of str
    phase_ref : pair of str
        See `decompose_fourier`.

    Returns
    -------
    float
        Radians of the fundamental.

    """
    if set(phase_ref) <= set(markers):
        first, second = (list(markers).index(name) for name in phase_ref)
        sine, cosine = coefficients[:2, first, 0] - coefficients[:2, second, 0]
    else:
        plane = coefficients[:2].reshape(2, -1)
        scores, _, axes = np.linalg.svd(plane, full_matrices=False)
        sine, cosine = scores[:, 0] * np.sign(axes[0, np.abs(axes[0]).argmax()])
    return float(-np.arctan2(cosine, sine))


def _walker(
    walk: xr.DataArray,
    postures: np.ndarray,
    found: Eigenpostures,
    *,
    form: Form,
    origin: float,
    fourier: np.ndarray,
    fourier_residual: float,
    p0: np.ndarray,
    p: np.ndarray,
    harmonics: np.ndarray,
    phases: np.ndarray,
) -> Walker:
    """Gather a walker whose clock starts at an angle of the stride past the middle of the walk."""
    time = walk.time.values
    n_markers = walk.sizes["marker"]
    period_s = 1 / found.frequency_hz
    middle_s = (time[0] + time[-1]) / 2
    after_start_s = (middle_s + origin / (2 * np.pi) * period_s - time[0]) % period_s
    variance = np.maximum(np.linalg.eigvalsh(found.scatter)[::-1], 0.0)
    total = float(variance.sum()) or 1.0
    unexplained = total - float(found.sine_r2 @ variance[: len(found.sine_r2)])
    residual = fourier_residual if form == "fourier" else max(unexplained, 0.0)
    fit = CaptureFit(
        r2=1 - residual / total,
        fourier_r2=1 - fourier_residual / total,
        residual_power=residual / float(np.vdot(postures, postures)),
        relative_rms=float(np.sqrt(residual / total)),
        variance_share=variance[:_SHARES_KEPT] / total,
        sine_r2=found.sine_r2,
        fourier=shift_origin(fourier[1:].reshape(-1, n_markers, 3), origin),
        eigenpostures=p,
        harmonics=harmonics,
        phases=phases,
        n_strides=len(time) * found.frequency_hz / found.rate_hz,
    )
    return Walker(
        markers=tuple(walk.marker.values.tolist()),
        p0=p0.reshape(n_markers, 3),
        p=p,
        harmonics=harmonics,
        phases=phases,
        frequency_hz=found.frequency_hz,
        form=form,
        speed_mm_s=walk.attrs.get("speed_mm_s", float("nan")),
        time_origin_s=time[0] + after_start_s,
        fit=fit,
    )
