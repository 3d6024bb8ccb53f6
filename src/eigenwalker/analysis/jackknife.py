"""How well a discriminant separates walkers, and how well it predicts walkers left out."""

# scipy and scikit-learn have no types:
# pyright: reportMissingTypeStubs=false, reportUnknownMemberType=false
# pyright: reportUnknownVariableType=false, reportUnknownArgumentType=false
from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.stats import ConstantInputWarning, pearsonr
from sklearn.metrics import r2_score, root_mean_squared_error

from eigenwalker.analysis._leave_out import LeaveOutSVD, discriminant_sums
from eigenwalker.analysis._task import Task, class_task, number_task
from eigenwalker.analysis.discriminant_weights import Order
from eigenwalker.analysis.walker_space import Scale
from eigenwalker.core.blas_threads import one_blas_thread
from eigenwalker.core.progress import Progress, ticked


@dataclass(frozen=True, eq=False)
class _Curves:
    y: np.ndarray
    trained: np.ndarray
    held_out: np.ndarray

    @property
    def n_components(self) -> np.ndarray:
        """1, 2, ...: the abscissa of the curves."""
        return np.arange(1, self.held_out.shape[1] + 1)


@dataclass(frozen=True, eq=False)
class JackknifeCurves(_Curves):
    """Errors of a classifier of walkers over the number of its components.

    Parameters
    ----------
    y : array of shape (walker,)
        The classes: -1 or +1.
    trained : array of shape (walker, component)
        The sum of eq. 11 over 1, 2, ... components, for the walkers trained on.
    held_out : array of shape (walker, component)
        The same for each walker left out, by a discriminant trained on the others.

    See Also
    --------
    jackknife_curves : makes them.

    References
    ----------
    Troje (2002), fig. 4.
    """

    @property
    def separation(self) -> np.ndarray:
        """Misclassified walkers among those trained on, for 1, 2, ... components."""
        return (self.y[:, None] * self.trained <= 0).sum(axis=0)

    @property
    def generalisation(self) -> np.ndarray:
        """Misclassified walkers among those left out, for 1, 2, ... components."""
        return self.misclassified.sum(axis=0)

    @property
    def misclassified(self) -> np.ndarray:
        """Which walkers are misclassified when left out: shape (walker, component)."""
        return self.confidence <= 0

    @property
    def confidence(self) -> np.ndarray:
        """Z of eq. 14 of walkers left out: shape (walker, component), above 0 where right."""
        return self.y[:, None] * self.held_out

    @property
    def best_n(self) -> int:
        """Fewest components with the fewest errors on walkers left out.

        It is chosen on the curve itself, so the errors there are too few: see
        `nested_leave_one_out`.
        """
        return int(self.generalisation.argmin()) + 1

    @property
    def fewest_errors(self) -> int:
        """Errors on walkers left out at `best_n`."""
        return int(self.generalisation.min())

    @property
    def separating_n(self) -> int | None:
        """Fewest components that separate all walkers trained on; None if no number does."""
        full = np.flatnonzero(self.separation == 0)
        return int(full[0]) + 1 if full.size else None


@dataclass(frozen=True, eq=False)
class RegressionCurves(_Curves):
    """How well a trait that is a number is predicted, over the number of components.

    Parameters
    ----------
    y : array of shape (walker,)
        The trait.
    trained : array of shape (walker, component)
        Prediction by 1, 2, ... components, for the walkers trained on.
    held_out : array of shape (walker, component)
        The same for each walker left out, by a discriminant trained on the others.

    See Also
    --------
    regression_curves : makes them.

    References
    ----------
    Troje (2002), fig. 4, for a number in place of two classes.
    """

    @property
    def rmse(self) -> np.ndarray:
        """Root mean square error on walkers left out, in units of the trait."""
        rmse = root_mean_squared_error(self._traits, self.held_out, multioutput="raw_values")
        return np.asarray(rmse)

    @property
    def r2(self) -> np.ndarray:
        """Share of variance predicted on walkers left out; below 0 where the mean does better."""
        return np.asarray(r2_score(self._traits, self.held_out, multioutput="raw_values"))

    @property
    def trained_r2(self) -> np.ndarray:
        """Share of variance predicted on walkers trained on."""
        return np.asarray(r2_score(self._traits, self.trained, multioutput="raw_values"))

    @property
    def correlation(self) -> np.ndarray:
        """Correlation of trait and prediction over walkers left out; NaN where all are alike.

        Without any relation it is below 0: leaving a walker out moves the mean of the others away
        from it.
        """
        return np.array([correlation(self.y, column) for column in self.held_out.T])

    @property
    def best_n(self) -> int:
        """Fewest components with the least error on walkers left out.

        It is chosen on the curve itself, so the error there is too small: see
        `nested_leave_one_out`.
        """
        return int(self.rmse.argmin()) + 1

    @property
    def _traits(self) -> np.ndarray:
        return np.broadcast_to(self.y[:, None], self.held_out.shape)


def correlation(a: np.ndarray, b: np.ndarray) -> float:
    """Return Pearson's correlation of two arrays; NaN where one does not vary."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ConstantInputWarning)
        result: Any = pearsonr(a, b)  # scipy is untyped
        return float(result.statistic)


def jackknife_curves(
    X: ArrayLike,
    y: ArrayLike,
    *,
    scale: Scale = "sd",
    order: Order = "standardised",
    fit_intercept: bool = False,
    scale_in_fold: bool = True,
    groups: ArrayLike | None = None,
    progress: Progress | None = None,
) -> JackknifeCurves:
    """Return the separation and generalisation curves of a classifier of walkers.

    Each walker is left out in turn. Average, standardisation, eigenwalkers, discriminant and the
    order of components are found from the others, and the walker is classified by its sum over 1,
    2, ... components. Each number of components equals
    ``make_pipeline(WalkerSpace(), DiscriminantClassifier(n))`` in a leave-one-out cross-validation;
    this is faster.

    Parameters
    ----------
    X : array of shape (walker, feature)
        Walkers, or a part of their features.
    y : array of shape (walker,)
        -1 and +1, or two classes of which the second in sorted order counts as +1.
    scale : {"sd"}, None, or array of shape (feature,)
        What features are divided by, as in `WalkerSpace`.
    order : {"standardised", "raw", "variance"}
        Which components come first: by ``|c_i| sd(k_i)``, ``|c_i|`` or the variance of the scores
        (`DiscriminantClassifier`).
    fit_intercept : bool
        Whether the discriminant has a constant; the paper's has none.
    scale_in_fold : bool
        Whether to standardise again without the walker left out. Standardising once for all lets
        its scale, though not its class, leak into the training.
    groups : array of shape (walker,), optional
        The person of each row: persons with several trials are left out with all of them. Errors
        and means still count rows, so that who walked more often weighs more.
    progress : callable, optional
        Called with the number of folds done and of all folds.

    Returns
    -------
    JackknifeCurves
        Where a fold has fewer components than others (identical walkers), its last sum holds.

    Raises
    ------
    ValueError
        If there are fewer than three walkers or groups, no two classes, no feature that varies,
        missing numbers, or if all walkers of a class would be left out at once.

    See Also
    --------
    regression_curves : The same for a trait that is a number.
    nested_leave_one_out : Errors when the number of components is not chosen on them.

    References
    ----------
    Troje (2002), eq. 9 to 11, "single-elimination jack-knife", fig. 4.

    Examples
    --------
    Twenty walkers whose sex shows in one of thirty features:

    >>> rng = np.random.default_rng(1)
    >>> sex = np.repeat([-1, 1], 10)
    >>> walkers = rng.normal(size=(20, 30))
    >>> walkers[:, 0] += 8 * sex
    >>> curves = jackknife_curves(walkers, sex)
    >>> curves.n_components[:3].tolist(), curves.separation[-1].item()
    ([1, 2, 3], 0)
    >>> curves.fewest_errors < 10
    True
    """
    task = class_task(X, y, groups)
    return JackknifeCurves(
        task.y, *_predictions(task, scale, order, scale_in_fold, progress, fit_intercept)
    )


def regression_curves(
    X: ArrayLike,
    y: ArrayLike,
    *,
    scale: Scale = "sd",
    order: Order = "standardised",
    scale_in_fold: bool = True,
    groups: ArrayLike | None = None,
    progress: Progress | None = None,
) -> RegressionCurves:
    """Return how well a trait that is a number is predicted for walkers left out.

    Each walker is left out in turn, and its trait predicted from the others (`jackknife_curves`),
    with the trait about its mean for r; the mean of the walkers trained on is added.

    Parameters
    ----------
    X : array of shape (walker, feature)
        Walkers, or a part of their features.
    y : array of shape (walker,)
        The trait: age, weight, a rating.
    scale : {"sd"}, None, or array of shape (feature,)
        What features are divided by: each one's standard deviation, nothing, or these.
    order : {"standardised", "raw", "variance"}
        Which components come first: by ``|c_i| sd(k_i)``, ``|c_i|`` or the variance of the scores.
    scale_in_fold : bool
        Whether to standardise again without the walkers left out.
    groups : array of shape (walker,), optional
        The person of each row: all walks of a person are left out together.
    progress : callable, optional
        Called with the number of folds done and of all folds.

    Returns
    -------
    RegressionCurves
        Predictions and errors for 1, 2, ... components, in the unit of the trait.

    Raises
    ------
    ValueError
        If there are fewer than three walkers or groups, no feature or trait that varies, or missing
        numbers.

    See Also
    --------
    jackknife_curves : the same for two classes.

    References
    ----------
    Troje (2002), The little difference.

    Examples
    --------
    >>> walkers = np.random.default_rng(0).normal(size=(30, 3))
    >>> weight_kg = 70 + walkers @ [10, 0, 0]
    >>> curves = regression_curves(walkers, weight_kg)
    >>> curves.best_n, curves.r2[2].round(6)
    (3, np.float64(1.0))
    """
    task = number_task(X, y, groups)
    return RegressionCurves(
        task.y, *_predictions(task, scale, order, scale_in_fold, progress, fit_intercept=True)
    )


def _predictions(
    task: Task,
    scale: Scale,
    order: Order,
    scale_in_fold: bool,
    progress: Progress | None,
    fit_intercept: bool,
) -> tuple[np.ndarray, np.ndarray]:
    """Predictions by 1, 2, ... components, of walkers trained on and left out: each (walker, n)."""
    with one_blas_thread():
        svd = LeaveOutSVD.of(task.X, task.r[:, None], scale=scale, scale_in_fold=scale_in_fold)
        trained = svd.of_all_walkers().sums(order)
        held_out = _held_out_sums(svd, task.folds, order, progress)
    trained = trained[: len(held_out)]
    if fit_intercept:
        means = np.empty(len(task.y))
        for out in task.folds:
            means[out] = svd.training_mean(out)
        trained = trained + task.y.mean()
        held_out = held_out + (task.offset + means)
    return trained.T, held_out.T


def _held_out_sums(
    svd: LeaveOutSVD, folds: Sequence[np.ndarray], order: Order, progress: Progress | None
) -> np.ndarray:
    """Sums of eq. 11 of each walker in its own fold: shape (component, walker)."""
    singular_values, c, scores = np.zeros((3, min(svd.Y.shape), len(svd.Y)))
    n_most = 0
    for out, fold in ticked(svd.leaving_out(folds), len(folds), progress):
        n = len(fold.singular_values)
        singular_values[:n, out] = fold.singular_values[:, None]
        c[:n, out] = fold.c
        scores[:n, out] = fold.scores
        n_most = max(n_most, n)
    return discriminant_sums(singular_values[:n_most], c[:n_most], scores[:n_most], order)
