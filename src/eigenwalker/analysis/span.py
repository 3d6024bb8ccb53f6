"""Principal axes of standardised walkers, in numbers: what `WalkerSpace` and `trait_axis` fit."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

Scale = str | None | ArrayLike


class Span(NamedTuple):
    """What walkers span, with the meanings of the attributes of `WalkerSpace`."""

    average_walker: np.ndarray
    scale: np.ndarray
    eigenwalkers: np.ndarray
    variances: np.ndarray

    def scores(self, walkers: np.ndarray) -> np.ndarray:
        """Return the scores K (walker, component) of walkers (walker, feature): eq. 8."""
        axes = self.eigenwalkers / self.scale
        return ((walkers - self.average_walker) / self.scale) @ axes.T

    def strongest(self, n_components: int) -> Span:
        """Return the span of the first few eigenwalkers, or of all where there are fewer."""
        used = slice(n_components)
        return self._replace(eigenwalkers=self.eigenwalkers[used], variances=self.variances[used])


def span_of(walkers: np.ndarray, scale: Scale = "sd") -> Span:
    """Return what walkers (walker, feature) span; raise a ValueError if they are the same."""
    average, scales = walkers.mean(axis=0), divisors(walkers, scale)
    standardised = (walkers - average) / scales
    constant = constant_features(walkers)
    standardised[:, constant] = 0
    # Once more, since the rounded mean of a feature far from 0 would look like variance.
    standardised -= standardised.mean(axis=0)
    singular_values, axes = _principal_axes(standardised)
    if not len(axes):
        raise ValueError(
            f"All {len(walkers)} walkers are the same in all {walkers.shape[1]} features; "
            "a space needs walkers that differ."
        )
    axes[:, constant] = 0
    variances = singular_values**2 / (len(walkers) - 1)
    return Span(average, scales, axes * scales, variances)  # eq. 7


def divisors(X: np.ndarray, scale: Scale) -> np.ndarray:
    """Return what each feature is divided by before PCA: u of Troje (2002), eq. 4.

    Above 0 everywhere; 1 for a feature that does not vary.
    """
    n_features = int(X.shape[1])
    if scale is None:
        return np.ones(n_features)
    if isinstance(scale, str):
        if scale != "sd":
            raise ValueError(
                f"scale={scale!r} is unknown; give 'sd', None, or one divisor a feature."
            )
        return np.where(constant_features(X), 1.0, X.std(axis=0, ddof=1))
    given = np.array(scale, dtype=float)
    if given.shape != (n_features,) or not (np.isfinite(given).all() and (given > 0).all()):
        raise ValueError(
            f"scale must be one divisor above 0 for each of {n_features} features; "
            f"got an array of shape {given.shape} with least value {given.min(initial=np.inf):.4g}."
        )
    return given


def constant_features(X: np.ndarray) -> np.ndarray:
    """Return which features do not vary, up to rounding of the largest number in the table.

    A feature that is zero by construction, such as the mean position of the pelvis, is some 1e-14
    mm in floating point; standardising would enlarge that to a unit.
    """
    rounding = 10 * np.finfo(float).eps * np.abs(X).max(initial=0)
    return np.less_equal(np.ptp(X, axis=0), rounding)


def _principal_axes(standardised: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Singular values and axes (component, feature), signs fixed, as many as the walkers span."""
    _, singular_values, axes = np.linalg.svd(standardised, full_matrices=False)
    n_spanned = spanned_dimensions(singular_values, standardised.shape)
    singular_values, axes = singular_values[:n_spanned], axes[:n_spanned]
    weights = np.abs(axes)
    nearly_strongest = weights >= (1 - 1e-6) * weights.max(axis=1, keepdims=True, initial=0)
    strongest = nearly_strongest.argmax(axis=1)[:, None]
    return singular_values, axes * np.sign(np.take_along_axis(axes, strongest, axis=1))


def spanned_dimensions(singular_values: np.ndarray, shape: tuple[int, ...]) -> int:
    """Return how many dimensions walkers span about their mean.

    Singular values of the centred walkers above rounding, as in `numpy.linalg.matrix_rank`, and one
    less than there are walkers at most; `shape` holds the numbers of walkers and features.
    """
    rounding = singular_values.max(initial=0) * max(shape) * np.finfo(float).eps
    return min(int((singular_values > rounding).sum()), shape[0] - 1)
