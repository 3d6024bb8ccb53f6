"""The space that walkers span: standardised principal components."""

# scikit-learn has no types:
# pyright: reportMissingTypeStubs=false, reportUnknownMemberType=false
# pyright: reportUnknownVariableType=false, reportUnknownArgumentType=false
from __future__ import annotations

from typing import Self

import numpy as np
from numpy.typing import ArrayLike
from sklearn.base import BaseEstimator, ClassNamePrefixFeaturesOutMixin, TransformerMixin
from sklearn.utils.validation import check_is_fitted

from eigenwalker.analysis.span import Scale, Span, span_of
from eigenwalker.core.arguments import check_numbers
from eigenwalker.core.sklearn_validation import validate_data


class WalkerSpace(ClassNamePrefixFeaturesOutMixin, TransformerMixin, BaseEstimator):
    r"""The space that walkers span: an average walker and eigenwalkers to add to it.

    .. math:: W = W_0 + V K, \quad V = \mathrm{diag}(u) V'

    Walkers are standardised by u, since their features are millimetres, hertz and radians, and then
    decomposed: V' are the unit eigenvectors of the covariance of the standardised walkers.
    `transform` returns the scores K, `inverse_transform` the walkers.

    Parameters
    ----------
    n_components : int, optional
        Eigenwalkers to use, those of most variance first; all that the walkers span if not given.
    scale : {"sd"}, None, or array of shape (feature,)
        What each feature is divided by before the decomposition: its standard deviation over the
        walkers (Decomposing biological motion), nothing (The little difference), or given divisors.

    Attributes
    ----------
    average_walker_ : array of shape (feature,)
        The mean walker w_0.
    scale_ : array of shape (feature,)
        The divisors u. Standard deviations have ddof 1. A feature that does not vary, up to
        rounding of the largest number in the table, is divided by 1 and stays at its mean.
    eigenwalkers_ : array of shape (component, feature)
        Row i is column i of V, in units of the features, so it can be added to a walker directly.
        The sign is arbitrary; here the standardised feature with the largest weight is positive.
    explained_variance_ : array of shape (component,)
        Variance of the scores over the walkers (ddof 1).
    explained_variance_ratio_ : array of shape (component,)
        The same as a share of the variance of all standardised features.

    See Also
    --------
    DiscriminantClassifier, DiscriminantRegressor : Predict a trait from the scores.

    References
    ----------
    Troje (2002), Decomposing biological motion, eq. 4 to 8. Troje (2002), The little difference.

    Examples
    --------
    Walkers that differ in one way only, larger or smaller in both features together:

    >>> walkers = np.array([[9, 90], [10, 100], [11, 110]])
    >>> space = WalkerSpace().fit(walkers)
    >>> space.average_walker_.tolist(), space.eigenwalkers_.round(3).tolist()
    ([10.0, 100.0], [[0.707, 7.071]])
    >>> space.transform([[12, 120]]).round(3).tolist()
    [[2.828]]
    >>> space.inverse_transform([[2 * 2**0.5]]).round(6).tolist()
    [[12.0, 120.0]]
    """

    def __init__(self, n_components: int | None = None, scale: Scale = "sd") -> None:
        self.n_components = n_components
        self.scale = scale

    def fit(self, X: ArrayLike, y: object = None) -> Self:
        """Fit the average walker and the eigenwalkers.

        Parameters
        ----------
        X : array of shape (walker, feature)
            At least two walkers that differ.
        y : None
            Ignored.

        Raises
        ------
        ValueError
            If the walkers are all the same, if they do not span `n_components` dimensions, or if
            `scale` is none of the above.
        """
        W: np.ndarray = validate_data(self, X, dtype=np.float64, ensure_min_samples=2)
        span = span_of(W, self.scale)
        used = span.strongest(self._n_used(len(span.variances), W.shape))
        self.average_walker_, self.scale_ = used.average_walker, used.scale
        self.eigenwalkers_, self.explained_variance_ = used.eigenwalkers, used.variances
        self.explained_variance_ratio_ = used.variances / span.variances.sum()
        return self

    def _n_used(self, n_spanned: int, shape: tuple[int, int]) -> int:
        if self.n_components is None:
            return n_spanned
        if not 1 <= self.n_components <= n_spanned:
            raise ValueError(
                f"n_components={self.n_components} is not among the 1 to {n_spanned} that "
                f"{shape[0]} walkers with {shape[1]} features span."
            )
        return self.n_components

    def transform(self, X: ArrayLike) -> np.ndarray:
        """Return the scores K (walker, component) of walkers (walker, feature): eq. 8."""
        check_is_fitted(self)
        W = validate_data(self, X, dtype=np.float64, reset=False)
        span = Span(self.average_walker_, self.scale_, self.eigenwalkers_, self.explained_variance_)
        return span.scores(W)

    def inverse_transform(self, K: ArrayLike) -> np.ndarray:
        """Return the walkers (walker, feature) of scores (walker, component): eq. 6."""
        check_is_fitted(self)
        scores = check_numbers(K, "K", least=0)
        if scores.ndim != 2 or scores.shape[1] != len(self.eigenwalkers_):
            raise ValueError(
                f"Scores must have shape (walker, {len(self.eigenwalkers_)}), one column an "
                f"eigenwalker; got {scores.shape}."
            )
        return self.average_walker_ + scores @ self.eigenwalkers_

    def get_feature_names_out(self, input_features: ArrayLike | None = None) -> np.ndarray:
        """Return "eigenwalker1", "eigenwalker2" ... as names of the scores."""
        n_scores = len(super().get_feature_names_out(input_features))
        return np.array([f"eigenwalker{i + 1}" for i in range(n_scores)], dtype=object)

    @property
    def _n_features_out(self) -> int:
        return len(self.eigenwalkers_)
