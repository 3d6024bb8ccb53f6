"""The one number of a shape of F, searched for around exact fits; the paper's random starts."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import minimize, minimize_scalar

from eigenwalker.core.arguments import check_numbers
from eigenwalker.core.blas_threads import one_blas_thread
from eigenwalker.psychophysics.perceptual_metric import Weights, non_negative_fit


class ShapeFit(NamedTuple):
    """The best parameter of a shape, the weights there, and the errors of all values tried.

    Attributes
    ----------
    parameter : float
        The power, or the scale in the unit of d; at a bound it is not determined by the data.
    weights, constant : array of shape (group,), float
        As of `PerceptualMetric`; ``rss`` is their sum of squared errors.
    tried, tried_rss : array of shape (n_grid,)
        The parameters on the grid, and the sum of squared errors of each.

    See Also
    --------
    search_shape : makes it.

    References
    ----------
    Pražák et al. (2010), section 5: powers as F.
    """

    parameter: float
    weights: np.ndarray
    constant: float
    rss: float
    tried: np.ndarray
    tried_rss: np.ndarray


def search_shape(
    columns: Callable[[float], np.ndarray],
    y: ArrayLike,
    *,
    bounds: tuple[float, float],
    n_grid: int = 60,
) -> ShapeFit:
    """Return the power of F, or the scale of its sigmoid, with which the metric fits best.

    Weights are exact for each value tried, so that one number is searched for: on a grid of equal
    ratios, then by Brent's method around the best value of the grid.

    Parameters
    ----------
    columns : callable
        Given a parameter, returns the table of shape (pair, group) of mean F(d_k).
    y : array of shape (pair,)
        Perceived differences.
    bounds : tuple of float
        Least and greatest parameter, above 0.
    n_grid : int
        Values on the grid, 3 or more.

    Returns
    -------
    ShapeFit

    See Also
    --------
    PerceptualMetric : Fitted for each shape.

    References
    ----------
    Pražák et al. (2010), section 5: a power near 0.3 fitted best, but the search over weights and
    power at once did not end reliably.

    Examples
    --------
    >>> d = np.random.default_rng(0).uniform(10, 200, (40, 2))
    >>> y = 0.1 + 0.05 * d[:, 0] ** 0.4
    >>> shape = search_shape(lambda n: d**n, y, bounds=(0.05, 3))
    >>> round(shape.parameter, 4), shape.weights.round(4).tolist()
    (0.4, [0.05, 0.0])
    """
    if not 0 < bounds[0] < bounds[1] < np.inf or n_grid < 3:
        raise ValueError(
            f"bounds={bounds} and n_grid={n_grid}: expected two numbers above 0, the least first, "
            "and 3 values or more."
        )
    y = check_numbers(y, "y", "pair")
    tried = np.geomspace(*bounds, n_grid)
    rss = np.array([_fit(columns(value), y)[1] for value in tried])
    best = int(rss.argmin())
    neighbours = np.log(tried[[max(best - 1, 0), min(best + 1, n_grid - 1)]])
    refined = minimize_scalar(
        lambda log: _fit(columns(np.exp(log)), y)[1],
        bounds=tuple(neighbours),
        method="bounded",
        options={"xatol": 1e-7},
    )
    parameter = float(np.exp(refined.x)) if refined.fun < rss[best] else float(tried[best])
    (weights, constant), error = _fit(columns(parameter), y)
    return ShapeFit(parameter, weights, constant, error, tried, rss)


def _fit(X: np.ndarray, y: np.ndarray) -> tuple[Weights, float]:
    fit = non_negative_fit(X, y)
    residual = y - fit.constant - X @ fit.weights
    return fit, float(residual @ residual)


class RandomStarts(NamedTuple):
    """The best weights that descent reached, of shape (group,), and their constant.

    ``rss``, of shape (start,), is the sum of squared errors that each start ended at.

    See Also
    --------
    fit_from_random_starts : makes it.
    """

    weights: np.ndarray
    constant: float
    rss: np.ndarray


def fit_from_random_starts(
    X: ArrayLike, y: ArrayLike, *, n_starts: int = 1000, random_state: int = 0
) -> RandomStarts:
    """Return the metric fitted as in the paper: gradient descent from random weights.

    For comparison only; `PerceptualMetric` finds the same optimum directly.

    Parameters
    ----------
    X : array of shape (pair, group)
        Mean F(d_k) of each pair of walks.
    y : array of shape (pair,)
        Perceived differences.
    n_starts, random_state : int
        Number of starts, and seed of the random numbers.

    Returns
    -------
    RandomStarts
        The best weights, of shape (group,), per unit of X; their constant; and ``rss``, of shape
        (start,), the sum of squared errors that each start ended at.

    See Also
    --------
    PerceptualMetric : The same optimum, directly.

    References
    ----------
    Pražák et al. (2010), section 5: 1000 random starts.

    Examples
    --------
    >>> X = np.random.default_rng(0).uniform(size=(30, 3))
    >>> y = 0.2 + X @ [0.5, 0.0, 0.1]
    >>> descent = fit_from_random_starts(X, y, n_starts=5)
    >>> descent.weights.round(3).tolist(), round(descent.constant, 3)
    ([0.5, 0.0, 0.1], 0.2)
    """
    X, y = check_numbers(X, "X", "pair", "group"), check_numbers(y, "y", "pair")
    if len(X) != len(y):
        raise ValueError(f"X has {len(X)} pairs, and y {len(y)}.")
    rng = np.random.default_rng(random_state)
    size = np.linalg.norm(X, axis=0)
    size[size == 0] = 1.0
    design = np.column_stack([np.ones(len(y)), X / size])

    def error(constant_and_weights: np.ndarray) -> tuple[float, np.ndarray]:
        residual = design @ constant_and_weights - y
        return float(residual @ residual), 2 * design.T @ residual

    bounds = [(None, None), *[(0, None)] * X.shape[1]]
    options = {"ftol": 1e-15, "gtol": 1e-10, "maxiter": 10_000, "maxfun": 100_000}
    starts = np.linalg.norm(y) * rng.uniform(size=(n_starts, design.shape[1]))
    with one_blas_thread():  # more threads slow so small a problem down
        ends = [minimize(error, at, jac=True, bounds=bounds, options=options) for at in starts]
    best = min(ends, key=lambda end: end.fun).x
    return RandomStarts(best[1:] / size, float(best[0]), np.array([end.fun for end in ends]))
