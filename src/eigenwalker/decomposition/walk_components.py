"""What both decompositions need of a walk: its principal components, and sines fitted to them.

The two share the stride frequency, which is the only unknown that is not linear, and which is found
on the scores of the components.
"""

# BLAS and LAPACK have no types:
# pyright: reportMissingTypeStubs=false, reportUnknownMemberType=false
# pyright: reportUnknownVariableType=false, reportUnknownArgumentType=false
from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np
import xarray as xr

from eigenwalker.core.arguments import check_numbers
from eigenwalker.core.fourier import centred_harmonics, fit_harmonics, shift_origin
from eigenwalker.core.trajectories import check_trajectories, sampling_rate
from eigenwalker.core.walker import CaptureFit, Form, Walker
from eigenwalker.gait.frequency import frequency_of_scores
from eigenwalker.gait.heading import known_speed

PHASE_REFERENCE = ("left_ankle", "right_ankle")
"""The markers whose distance along x sets the time origin: first minus second rises through 0."""
_N_VARIANCE_SHARES = 10
_FAR_FROM_ORIGIN = 1e3
"""Power over variance above which products about the origin lose too many digits."""


@dataclass(frozen=True, eq=False)
class Eigenpostures:
    """Principal components of postures, and the sines fitted to their scores.

    Parameters
    ----------
    mean : array of shape (feature,)
        Mean posture.
    components : array of shape (component, feature)
        Unit eigenpostures, that of the largest variance first.
    scatter : array of shape (feature, feature)
        Sums of squares and products about the mean; only the lower triangle is filled.
    frequency_hz : float
        Stride frequency.
    harmonics : array of int of shape (component,)
        The harmonic that explains most of each component's scores.
    amplitudes, phases : array of shape (component,)
        Of the sines ``a_i sin(2 pi h_i f t + phi_i)``: amplitudes in the unit of the postures,
        phases in radians, t = 0 in the middle of the postures.
    sine_r2 : array of shape (component,)
        Coefficient of determination of each sine.
    rate_hz : float
        Frames a second.

    See Also
    --------
    eigenpostures_of : makes it.

    References
    ----------
    Troje (2002), eq. 1 and fig. 2.
    """

    mean: np.ndarray
    components: np.ndarray
    scatter: np.ndarray
    frequency_hz: float
    harmonics: np.ndarray
    amplitudes: np.ndarray
    phases: np.ndarray
    sine_r2: np.ndarray
    rate_hz: float


def eigenpostures_of(postures: np.ndarray, rate_hz: float, n_harmonics: int = 2) -> Eigenpostures:
    r"""Return the principal components of postures with sines fitted to their scores.

    The numerical core of both decompositions, on plain arrays.

    .. math:: p(t) = p_0 + \sum_i c_i(t) p_i, \qquad
              c_i(t) \approx a_i \sin(2 \pi h_i f t + \varphi_i)

    with unit p_i, the stride frequency f, and t = 0 in the middle of the postures.

    Parameters
    ----------
    postures : array of shape (time, feature)
        Evenly sampled, in any unit, such as mm; means and amplitudes are in the same unit.
    rate_hz : float
        Frames a second.
    n_harmonics : int
        Multiples of the stride frequency to choose from; there are two components for each.

    Returns
    -------
    Eigenpostures

    See Also
    --------
    decompose_pca, decompose_fourier : The same for a walk, as a `Walker`.
    eigenwalker.gait.frequency_of_scores : How the stride frequency is found.

    References
    ----------
    Troje (2002), Decomposing biological motion, eq. 1 and 2, figs. 2 and 3.
    """
    postures = check_numbers(postures, "postures", "time", "feature", least=2)
    mean, scatter = _mean_and_scatter(postures)
    power, axes = _largest_eigenpairs(scatter, min(2 * n_harmonics, postures.shape[1]))
    scores = postures @ axes
    scores -= mean @ axes
    frequency_hz = frequency_of_scores(scores, rate_hz, n_harmonics=n_harmonics)
    sines = centred_harmonics(len(postures), frequency_hz / rate_hz, n_harmonics)[1:]
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
    """Return the mean, and products about it; about the origin if that is near."""
    from scipy.linalg.blas import dsyrk  # pyright: ignore[reportAttributeAccessIssue] - untyped

    n = len(postures)
    mean = np.full(n, 1 / n) @ postures
    scatter = dsyrk(1.0, postures.T, lower=True)
    power = scatter.trace()
    if power < _FAR_FROM_ORIGIN * (power - n * (mean @ mean)):
        scatter -= np.multiply.outer(mean, n * mean)
        return mean, scatter
    shifted = postures - postures[0]
    offset = np.full(n, 1 / n) @ shifted
    scatter = dsyrk(1.0, shifted.T, lower=True) - n * np.outer(offset, offset)
    return postures[0] + offset, scatter


def _largest_eigenpairs(scatter: np.ndarray, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Largest eigenvalues, and their eigenvectors as columns, of a lower triangle."""
    from scipy.linalg.lapack import dsyevr  # pyright: ignore[reportAttributeAccessIssue] - untyped

    d = len(scatter)
    values, vectors, _, _, failed = dsyevr(scatter, range="I", il=d - n + 1, iu=d, lower=1)
    if failed:
        raise ValueError("The principal components of this walk could not be found.")
    return values[n - 1 :: -1], np.ascontiguousarray(vectors[:, n - 1 :: -1])


def _fit_sines(
    products: np.ndarray, gram: np.ndarray, power: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return harmonic, amplitude, phase and r2 of each score's dominant sine."""
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


@dataclass(frozen=True, eq=False)
class WalkComponents:
    """A walk with its eigenpostures and its Fourier series: the source of a walker of either form.

    Each posture is also a row of `postures` (time, feature). `fourier` holds the coefficients of 1,
    sin 1, cos 1 ..., of shape (1 + 2 * harmonic, feature), time counting from the middle of the
    walk; `fourier_residual` is the sum of squares that they leave.
    """

    walk: xr.DataArray
    postures: np.ndarray
    eigenpostures: Eigenpostures
    fourier: np.ndarray
    fourier_residual: float

    @classmethod
    def of(cls, walk: xr.DataArray, n_harmonics: int) -> Self:
        """Check a walk and find its components."""
        if n_harmonics != int(n_harmonics) or n_harmonics < 1:
            raise ValueError(f"n_harmonics={n_harmonics} must be a whole number, 1 or more.")
        walk = check_trajectories(walk, complete=True)
        if not walk.sizes["marker"]:
            raise ValueError(
                "These trajectories have no markers, so there is nothing to decompose."
            )
        rate_hz = sampling_rate(walk)
        n_frames = walk.sizes["time"]
        if (needed := 4 * n_harmonics + 2) > n_frames:
            raise ValueError(
                f"A walk with {n_harmonics} harmonics needs {needed} frames or more, "
                f"got {n_frames}."
            )
        postures = walk.values.reshape(n_frames, -1)
        eigenpostures = eigenpostures_of(postures, rate_hz, n_harmonics)
        frequency_hz = eigenpostures.frequency_hz
        if n_harmonics * frequency_hz >= rate_hz / 2:
            raise ValueError(
                f"Harmonic {n_harmonics} of {frequency_hz:.2f} Hz is "
                f"{n_harmonics * frequency_hz:.1f} Hz, which {rate_hz:.4g} frames a second cannot "
                f"show; take {int((rate_hz / 2 - 1e-9) / frequency_hz)} harmonics at most."
            )
        fourier, residual = fit_harmonics(postures, frequency_hz / rate_hz, n_harmonics)
        return cls(walk, postures, eigenpostures, fourier, residual)

    @property
    def markers(self) -> tuple[str, ...]:
        """Names of the markers."""
        return tuple(self.walk.marker.values.tolist())

    @property
    def fourier_postures(self) -> np.ndarray:
        """Coefficients of sin 1, cos 1, ... as an array of shape (2 * harmonic, marker, axis)."""
        return self.fourier[1:].reshape(-1, len(self.markers), 3)

    def walker(
        self,
        form: Form,
        *,
        p0: np.ndarray,
        p: np.ndarray,
        harmonics: np.ndarray,
        phases: np.ndarray,
        origin: float,
    ) -> Walker:
        """Return a walker of this walk, whose clock starts `origin` past the middle of the walk."""
        found, time = self.eigenpostures, self.walk.time.values
        period_s = 1 / found.frequency_hz
        middle_s = (time[0] + time[-1]) / 2
        after_start_s = (middle_s + origin / (2 * np.pi) * period_s - time[0]) % period_s
        variance = np.maximum(np.linalg.eigvalsh(found.scatter)[::-1], 0.0)
        total = float(variance.sum()) or 1.0
        residual = self.fourier_residual
        if form == "eigenposture":
            explained = float(found.sine_r2 @ variance[: len(found.sine_r2)])
            residual = max(total - explained, 0.0)
        fit = CaptureFit(
            r2=1 - residual / total,
            fourier_r2=1 - self.fourier_residual / total,
            residual_power=residual / float(np.vdot(self.postures, self.postures)),
            relative_rms=float(np.sqrt(residual / total)),
            variance_share=variance[:_N_VARIANCE_SHARES] / total,
            sine_r2=found.sine_r2,
            fourier=shift_origin(self.fourier_postures, origin),
            eigenpostures=p,
            harmonics=harmonics,
            phases=phases,
            n_strides=len(time) * found.frequency_hz / found.rate_hz,
        )
        return Walker(
            markers=self.markers,
            p0=p0.reshape(-1, 3),
            p=p,
            harmonics=harmonics,
            phases=phases,
            frequency_hz=found.frequency_hz,
            form=form,
            speed_mm_s=known_speed(self.walk),
            time_origin_s=time[0] + after_start_s,
            fit=fit,
        )
