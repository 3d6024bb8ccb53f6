"""The linear discriminant ``c K = r`` of two classes, or of a trait that is a number."""

# scikit-learn has no types:
# pyright: reportMissingTypeStubs=false, reportUnknownMemberType=false
# pyright: reportUnknownVariableType=false, reportUnknownArgumentType=false
from __future__ import annotations

from typing import Self

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike
from sklearn.base import BaseEstimator, ClassifierMixin, RegressorMixin
from sklearn.utils import Tags
from sklearn.utils.multiclass import check_classification_targets
from sklearn.utils.validation import check_is_fitted

from eigenwalker.analysis.discriminant_weights import Order, discriminant_weights
from eigenwalker.core.sklearn_validation import validate_data


class _Discriminant(BaseEstimator):
    n_components: int | None
    order: Order

    def _fit_traits(self, K: np.ndarray, r: np.ndarray, *, centred: bool) -> None:
        """Solve ``c K = r`` by least squares and use the components that contribute most."""
        fitted = discriminant_weights(
            K, r, centred=centred, n_components=self._n_used(K.shape[1]), order=self.order
        )
        self.coef_, self.intercept_, self.order_, self.spread_, self.pattern_ = fitted

    def _n_used(self, n_columns: int) -> int:
        if self.n_components is None:
            return n_columns
        if not 1 <= self.n_components <= n_columns:
            raise ValueError(
                f"n_components={self.n_components} is not among the 1 to {n_columns} that scores "
                f"with {n_columns} columns offer."
            )
        return self.n_components

    def _projections(self, X: ArrayLike) -> np.ndarray:
        check_is_fitted(self)
        K = validate_data(self, X, dtype=np.float64, reset=False)
        return K @ self.coef_ + self.intercept_


class DiscriminantClassifier(ClassifierMixin, _Discriminant):
    r"""Tells two classes of walkers apart by a weighted sum of their scores.

    .. math:: c K = r, \quad r_j = \pm 1

    The discriminant c is the least-squares solution. Components are sorted by their contribution to
    it, the first n are used, and the sign of a walker's sum is its class. Put a `WalkerSpace`
    first: ``make_pipeline(WalkerSpace(), DiscriminantClassifier(n_components=4))``.

    Scores of a `WalkerSpace` are orthogonal, so leaving components out equals fitting again without
    them. On other columns c is the solution of least norm, and components are left out of it.

    Parameters
    ----------
    n_components : int, optional
        Components to use, those that contribute most first; all if not given.
    order : {"standardised", "raw", "variance"}
        Contribution: ``|c_i| sd(k_i)``, which goes with the correlation of score and class;
        ``|c_i|``, which favours components that hardly vary; or the variance of the scores, which
        leaves the order of the eigenwalkers.
    fit_intercept : bool
        Whether to fit a constant too. The paper has none; with one, leaving a walker out tilts the
        constant towards the other class, and walkers without any effect are misclassified more
        often than by chance.

    Attributes
    ----------
    classes_ : array of shape (2,)
        The classes in sorted order: r is -1 for the first and +1 for the second.
    positive_pole_, negative_pole_ : str
        Names of the two ends of the discriminant: the second class, and the first.
    coef_ : array of shape (column,)
        The discriminant c, 0 where a component is left out.
    intercept_ : float
        0 unless fitted.
    order_ : array of int of shape (column,)
        Columns of K from the highest contribution to the lowest.
    spread_ : float
        Standard deviation (ddof 1) of c K over the walkers fitted on.
    class_means_ : array of shape (2, column)
        Mean scores of either class.
    pattern_ : array of shape (column,)
        cov(K) c within the components used: what varies along with c.

    See Also
    --------
    DiscriminantRegressor : For a trait that is a number.
    jackknife_curves : Errors for every number of components.

    References
    ----------
    Troje (2002), Decomposing biological motion, eq. 10, 11 and 14.

    Examples
    --------
    >>> scores = [[-2, 1], [-1, -1], [1, -1], [2, 1]]
    >>> classifier = DiscriminantClassifier(n_components=1)
    >>> classifier.fit(scores, ["female", "female", "male", "male"]).positive_pole_
    'male'
    >>> classifier.coef_.round(2).tolist(), classifier.predict([[3, 0]]).tolist()
    ([0.6, 0.0], ['male'])
    """

    def __init__(
        self,
        n_components: int | None = None,
        order: Order = "standardised",
        fit_intercept: bool = False,
    ) -> None:
        self.n_components = n_components
        self.order = order
        self.fit_intercept = fit_intercept

    def fit(self, X: ArrayLike, y: ArrayLike) -> Self:
        """Fit the discriminant.

        Parameters
        ----------
        X : array of shape (walker, column)
            Scores of a `WalkerSpace`.
        y : array of shape (walker,)
            Two classes, named or numbered.

        Raises
        ------
        ValueError
            If y has missing values or does not hold two classes, or if there are fewer columns
            than `n_components`.
        """
        refuse_missing(y)
        K, traits = validate_data(self, X, y, dtype=np.float64, ensure_min_samples=2)
        check_classification_targets(traits)
        self.classes_, which = two_classes(traits)
        self.negative_pole_, self.positive_pole_ = (str(name) for name in self.classes_)
        self._fit_traits(K, 2.0 * which - 1, centred=self.fit_intercept)
        self.class_means_ = np.array([K[which == 0].mean(axis=0), K[which == 1].mean(axis=0)])
        return self

    def decision_function(self, X: ArrayLike) -> np.ndarray:
        """Return the sum of eq. 11 of each walker; times r it is the confidence z of eq. 14."""
        return self._projections(X)

    def predict(self, X: ArrayLike) -> np.ndarray:
        """Return the class of each walker (eq. 11)."""
        positive = self.decision_function(X) > 0
        return self.classes_[positive.astype(int)]

    def __sklearn_tags__(self) -> Tags:
        tags = super().__sklearn_tags__()
        tags.classifier_tags.multi_class = False
        return tags


class DiscriminantRegressor(RegressorMixin, _Discriminant):
    """Predicts a trait that is a number (age, weight, a rating) by a weighted sum of scores.

    The discriminant c is the least-squares solution of ``c K = r`` (eq. 10), with r_j the trait of
    walker j minus the mean trait. A prediction is the walker's sum ``c k`` plus that mean.

    Parameters
    ----------
    n_components : int, optional
        Components to use, those that contribute most first; all if not given.
    order : {"standardised", "raw", "variance"}
        Contribution: ``|c_i| sd(k_i)``, which goes with the correlation of score and trait;
        ``|c_i|``; or the variance of the scores.

    Attributes
    ----------
    positive_pole_, negative_pole_ : str
        "more" and "less" of the trait, with its name where y is a named pandas Series.
    coef_ : array of shape (column,)
        The discriminant c, in the unit of the trait, 0 where a component is left out.
    intercept_ : float
        Prediction at scores of 0, in the unit of the trait.
    order_ : array of int of shape (column,)
        Columns of K from the highest contribution to the lowest.
    spread_ : float
        Standard deviation (ddof 1) of c K over the walkers fitted on.
    pattern_ : array of shape (column,)
        cov(K) c within the components used: what varies along with c.

    See Also
    --------
    DiscriminantClassifier : For a trait of two classes.
    regression_curves : Errors for every number of components.

    References
    ----------
    Troje (2002), Decomposing biological motion, eq. 10, with the trait in place of +1 and -1; Troje
    (2002), The little difference.

    Examples
    --------
    >>> weight_kg = [50, 60, 70, 80]
    >>> regressor = DiscriminantRegressor(n_components=1)
    >>> regressor.fit([[-3, 1], [-1, -1], [1, -1], [3, 1]], weight_kg).predict([[5, 0]]).round(6)
    array([90.])
    """

    def __init__(self, n_components: int | None = None, order: Order = "standardised") -> None:
        self.n_components = n_components
        self.order = order

    def fit(self, X: ArrayLike, y: ArrayLike) -> Self:
        """Fit the discriminant.

        Parameters
        ----------
        X : array of shape (walker, column)
            Scores of a `WalkerSpace`.
        y : array of shape (walker,)
            The trait.

        Raises
        ------
        ValueError
            If y has missing values, or if there are fewer columns than `n_components`.
        """
        refuse_missing(y)
        trait = getattr(y, "name", None)
        K, r = validate_data(self, X, y, dtype=np.float64, ensure_min_samples=2, y_numeric=True)
        self.positive_pole_, self.negative_pole_ = (
            more if trait is None else f"{more} {trait}" for more in ("more", "less")
        )
        self._fit_traits(K, np.asarray(r, dtype=float), centred=True)
        return self

    def predict(self, X: ArrayLike) -> np.ndarray:
        """Return the trait of each walker, in its own units."""
        return self._projections(X)


def two_classes(y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the two classes in sorted order, and 0 or 1, the positive pole, for each walker."""
    classes, which = np.unique(y, return_inverse=True)
    if len(classes) > 2:
        named = ", ".join(str(name) for name in classes[:5]) + (", ..." if len(classes) > 5 else "")
        raise ValueError(
            f"Only binary classification is supported. The trait has {len(classes)} classes "
            f"({named}): choose two, or use DiscriminantRegressor if it is a number."
        )
    if len(classes) < 2:
        raise ValueError(
            f"A discriminant needs walkers of two classes; all {len(y)} here are "
            f"of the class {classes[0]}."
        )
    return classes, which


def refuse_missing(y: ArrayLike, what: str = "value of the trait") -> None:
    """Raise a ValueError that says which walkers lack what they should have."""
    missing = np.flatnonzero(pd.isna(np.asarray(y, dtype=object)))
    if y is not None and missing.size:  # pyright: ignore[reportUnnecessaryComparison] - sklearn's
        rows = ", ".join(str(row) for row in missing[:10]) + (", ..." if missing.size > 10 else "")
        raise ValueError(
            f"{missing.size} of {len(np.asarray(y, dtype=object))} walkers have no {what} "
            f"(rows {rows}); leave them out of X and y."
        )
