"""Perceived difference from distances of joint groups (Pražák et al. 2010, eq. 1 to 3)."""

from __future__ import annotations

from typing import NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import nnls
from sklearn.base import BaseEstimator, RegressorMixin
from sklearn.utils import Tags
from sklearn.utils.validation import check_is_fitted

from eigenwalker.core.arguments import check_numbers
from eigenwalker.core.sklearn_validation import validate_data


class PerceptualMetric(RegressorMixin, BaseEstimator):
    r"""How different two walks look, as a weighted sum of distances of joint groups.

    .. math:: d(a, b) = c + \sum_k w_k F(d_k), \qquad w_k \ge 0

    F(d_k) is how far joint group k is apart in the mean of the registered frames, and the
    difference d is the share of times that a pair was not chosen as the most similar. For a given F
    the model is linear, so the best weights are exact, by non-negative least squares; the paper's
    1000 random starts end at the same ones. The constant is free: it is the difference of two walks
    that are not the same although their distance is 0.

    Parameters
    ----------
    fit_constant : bool
        Whether there is a constant c; 0 otherwise.

    Attributes
    ----------
    weights_ : array of shape (group,)
        w_k, 0 or more, per unit of the columns of X.
    constant_ : float
        c.
    relative_weights_ : array of shape (group,)
        Weights divided by their sum, as figure 5 has them; all 0 where no group predicts anything.
    normalisation_ : float
        1 over the sum of the weights.

    See Also
    --------
    fit_choices : Weights fitted to the choices themselves; better where shares level off.
    group_table, count_pairs : Make X of walks, and y of observers' answers.

    References
    ----------
    Pražák et al. (2010), eq. 1 to 3, section 5 and figure 5.

    Examples
    --------
    Three groups, of which observers look at the second alone:

    >>> X = [[3.0, 1, 2], [1, 4, 1], [2, 2, 3], [4, 3, 1], [2, 5, 2]]
    >>> y = [0.3, 0.6, 0.4, 0.5, 0.7]
    >>> metric = PerceptualMetric().fit(X, y)
    >>> metric.weights_.round(6).tolist(), round(metric.constant_, 6)
    ([0.0, 0.1, 0.0], 0.2)
    """

    def __init__(self, fit_constant: bool = True) -> None:
        self.fit_constant = fit_constant

    def fit(self, X: ArrayLike, y: ArrayLike, sample_weight: ArrayLike | None = None) -> Self:
        """Find weights and constant.

        Parameters
        ----------
        X : array of shape (pair, group)
            F(d_k), in the mean along the registered path.
        y : array of shape (pair,)
            Perceived differences. A walk and itself is no pair.
        sample_weight : array of shape (pair,), optional
            How much each pair counts, such as how often it was shown; in the paper all the same.

        Returns
        -------
        self
        """
        plain = _is_plain(X, 2) and _is_plain(y, 1) and np.shape(X)[0] == np.shape(y)[0]
        checks = {"skip_check_array": True} if plain else {"dtype": np.float64, "y_numeric": True}
        table, differences = validate_data(self, X, y, **checks)
        self.weights_, self.constant_ = non_negative_fit(
            table,
            differences,
            sample_weight=sample_weight,
            fit_constant=self.fit_constant,
        )
        self.relative_weights_ = relative_weights(self.weights_)
        total = self.weights_.sum()
        self.normalisation_ = float(1 / total) if total > 0 else np.inf
        return self

    def predict(self, X: ArrayLike) -> np.ndarray:
        """Return the perceived difference of each pair, of shape (pair,)."""
        check_is_fitted(self)
        table = validate_data(self, X, dtype=np.float64, reset=False)
        return self.constant_ + table @ self.weights_

    def __sklearn_tags__(self) -> Tags:
        tags = super().__sklearn_tags__()
        if tags.regressor_tags is not None:
            tags.regressor_tags.poor_score = True  # on data that need weights below 0
        return tags


def relative_weights(weights: np.ndarray) -> np.ndarray:
    """Return weights of shape (..., group) divided by their sum; 0 where all are."""
    total = weights.sum(axis=-1, keepdims=True)
    return np.divide(weights, total, out=np.zeros_like(weights), where=total > 0)


def _is_plain(values: ArrayLike, n_dimensions: int) -> bool:
    """Return whether these are finite float64 arrays, which need none of the longer checks."""
    return (
        type(values) is np.ndarray
        and values.dtype == np.float64
        and values.ndim == n_dimensions
        and values.size > 0
        and bool(np.isfinite(values).all())
    )


def _counts(sample_weight: ArrayLike, X: np.ndarray) -> np.ndarray:
    counts = check_numbers(sample_weight, "sample_weight", "pair")
    if len(counts) != len(X) or counts.min() < 0 or not counts.sum() > 0:
        raise ValueError(
            f"sample_weight must be one number for each of {len(X)} pairs, 0 or more and not all "
            f"zero; got shape {counts.shape}, from {counts.min():g} to {counts.max():g}."
        )
    return counts


class Weights(NamedTuple):
    """Weights of the columns, of shape (group,) and per unit of X, and the constant.

    See Also
    --------
    non_negative_fit : makes it.

    References
    ----------
    Pražák et al. (2010), eqs. 1 to 3 and fig. 5.
    """

    weights: np.ndarray
    constant: float


def non_negative_fit(
    X: np.ndarray,
    y: np.ndarray,
    *,
    sample_weight: ArrayLike | None = None,
    fit_constant: bool = True,
) -> Weights:
    r"""Return the weights, none below 0, and the free constant with the least squared error.

    .. math:: \min_{w \ge 0, \, c} \sum_i s_i \Big(y_i - c - \sum_k w_k X_{ik}\Big)^2

    with the sample weights s (1 if left out), and c = 0 without a constant.

    Parameters
    ----------
    X : array of shape (pair, column)
        Mean F(d_k) of each pair of walks.
    y : array of shape (pair,)
        Perceived differences.
    sample_weight : array of shape (pair,), optional
        How much each pair counts; left out, all the same.
    fit_constant : bool
        Whether there is a constant c; 0 otherwise.

    Returns
    -------
    Weights
        w, per unit of the columns of X, and c, in the unit of y.

    See Also
    --------
    PerceptualMetric : The same as an estimator of scikit-learn, which checks what it gets.

    References
    ----------
    Lawson & Hanson (1974), Solving least squares problems, chapter 23. Pražák et al. (2010),
    section 5.

    Examples
    --------
    >>> fit = non_negative_fit(np.array([[0.0], [1.0], [2.0]]), np.array([1.0, 3.0, 5.0]))
    >>> fit.weights.round(6).tolist(), round(fit.constant, 6)
    ([2.0], 1.0)
    """
    X, y = check_numbers(X, "X", "pair", "column"), check_numbers(y, "y", "pair")
    if len(X) != len(y):
        raise ValueError(f"X has {len(X)} pairs, and y {len(y)}.")
    x_mean, y_mean = np.zeros(X.shape[1]), 0.0
    if sample_weight is None:
        if fit_constant:
            x_mean, y_mean = X.sum(axis=0) / len(y), y.sum() / len(y)
        design, target = X - x_mean, y - y_mean
    else:
        sample_weight = _counts(sample_weight, X)
        total, root = sample_weight.sum(), np.sqrt(sample_weight)
        if fit_constant:
            x_mean, y_mean = sample_weight @ X / total, sample_weight @ y / total
        design, target = root[:, None] * (X - x_mean), root * (y - y_mean)
    size = np.sqrt(np.einsum("pk,pk->k", design, design))
    size[size == 0] = 1.0
    weights = nnls(design / size, target)[0] / size
    return Weights(weights, float(y_mean - x_mean @ weights))
