"""How well a discriminant separates walkers, and how well it tells new ones (J19 to J24)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from eigenwalker.analysis._leave_out import (
    LeaveOut,
    checked_classes,
    checked_trait,
    discriminant_sums,
)
from eigenwalker.analysis.discriminant import Order
from eigenwalker.analysis.walker_space import Scale
from eigenwalker.core.blas_threads import one_blas_thread
from eigenwalker.core.progress import Progress, ticked


@dataclass(frozen=True, eq=False)
class JackknifeCurves:
    """Errors of a classifier of walkers over the number of its components (J fig. 4).

    Parameters
    ----------
    y : array of shape (walker,)
        r: -1 or +1.
    trained : array of shape (walker, component)
        The sum of eq. 11 over 1, 2, ... components, with all walkers trained on.
    held_out : array of shape (walker, component)
        The same for each walker by what the others taught.

    """

    y: np.ndarray
    trained: np.ndarray
    held_out: np.ndarray

    @property
    def n_components(self) -> np.ndarray:
        """1, 2, ...: the abscissa of the curves."""
        return np.arange(1, self.held_out.shape[1] + 1)

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
        """Which walkers are misclassified when left out: shape (walker, component) (J27)."""
        return self.confidence <= 0

    @property
    def confidence(self) -> np.ndarray:
        """Z of eq. 14 of walkers left out: shape (walker, component), above 0 where right."""
        return self.y[:, None] * self.held_out

    @property
    def best_n(self) -> int:
        """Fewest components with the fewest errors on walkers left out.

        Chosen on the curve itself, so the errors there flatter: see `nested_leave_one_out`.
        """
        return int(self.generalisation.argmin()) + 1

    @property
    def fewest_errors(self) -> int:
        """Errors on walkers left out at `best_n`."""
        return int(self.generalisation.min())

    @property
    def separating_n(self) -> int | None:
        """Fewest components that tell all walkers trained on apart; None if no number does."""
        full = np.flatnonzero(self.separation == 0)
        return int(full[0]) + 1 if full.size else None


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

    Each walker is left out in turn; average, standardisation, eigenwalkers (eq. 9), discriminant
    and the order of components are found from the others, and the walker is classified by its sum
    over 1, 2, ... components (Troje 2002, "single-elimination jack-knife").

    Parameters
    ----------
    X : array of shape (walker, feature)
        Walkers, or a part of their features.
    y : array of shape (walker,)
        -1 and +1, or two classes of which the second in sorted order counts as +1.
    scale : {"sd"}, None, or array of shape (feature,)
        What features are divided by, as in `WalkerSpace`.
    order : {"standardised", "raw", "variance"}
        Which components come first, as in `DiscriminantClassifier`.
    fit_intercept : bool
        As in `DiscriminantClassifier`.
    scale_in_fold : bool
        Whether to standardise anew without the walker left out (A8). Doing it once for all lets
        the scale, though no class, of the walker left out leak in.
    groups : array of shape (walker,), optional
        Who each row is: persons with several trials are left out with all of them.
    progress : callable, optional
        Called with the folds done and all folds.

    Returns
    -------
    JackknifeCurves
        Where a fold has fewer components than others (walkers that are twins), its last sum holds.

    Raises
    ------
    ValueError
        If there are fewer than three walkers or groups, no two classes, no feature that varies,
        or missing numbers.

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
    walkers, r, folds = checked_classes(X, y, groups)
    with one_blas_thread():
        table = LeaveOut.of(walkers, r[:, None], scale=scale, scale_in_fold=scale_in_fold)
        trained = _trained_sums(table, order)
        held_out = _held_out_sums(table, folds, order, progress)
    trained = trained[: len(held_out)]
    if fit_intercept:
        trained = trained + r.mean()
        held_out = held_out + _levels_without(table, folds)
    return JackknifeCurves(y=r, trained=trained.T, held_out=held_out.T)


def _trained_sums(table: LeaveOut, order: Order) -> np.ndarray:
    """Sums of eq. 11 of the walkers trained on: shape (component, walker)."""
    everyone = table.all_kept()
    lengths, c = everyone.lengths[:, None], everyone.c
    return discriminant_sums(lengths, c, everyone.scores, order)


def _held_out_sums(
    table: LeaveOut, folds: Sequence[np.ndarray], order: Order, progress: Progress | None
) -> np.ndarray:
    """Sums of eq. 11 of each walker in its own fold: shape (component, walker)."""
    shape = (min(table.Y.shape), len(table.Y))
    lengths, c, scores = np.zeros((3, *shape))
    n_most = 0
    for out, fold in ticked(table.leaving_out(folds), len(folds), progress):
        n = len(fold.lengths)
        lengths[:n, out] = fold.lengths[:, None]
        c[:n, out] = fold.c
        scores[:n, out] = fold.scores
        n_most = max(n_most, n)
    return discriminant_sums(lengths[:n_most], c[:n_most], scores[:n_most], order)


@dataclass(frozen=True, eq=False)
class RegressionCurves:
    """How well a continuous trait is told, over the number of components (W8).

    Parameters
    ----------
    y : array of shape (walker,)
        The trait.
    trained : array of shape (walker, component)
        As told by 1, 2, ... components of all walkers.
    held_out : array of shape (walker, component)
        As told by the others when the walker is left out.

    """

    y: np.ndarray
    trained: np.ndarray
    held_out: np.ndarray

    @property
    def n_components(self) -> np.ndarray:
        """1, 2, ...: the abscissa of the curves."""
        return np.arange(1, self.held_out.shape[1] + 1)

    @property
    def rmse(self) -> np.ndarray:
        """Root mean square error on walkers left out, in units of the trait."""
        return root_mean_square_error(self.y, self.held_out)

    @property
    def r2(self) -> np.ndarray:
        """Share of variance told on walkers left out; below 0 where the mean tells more."""
        return share_told(self.y, self.held_out)

    @property
    def trained_r2(self) -> np.ndarray:
        """Share of variance told on walkers trained on."""
        return share_told(self.y, self.trained)

    @property
    def correlation(self) -> np.ndarray:
        """Correlation of trait and prediction over walkers left out.

        Chance is below 0: leaving a walker out moves the mean of the others away from it.
        """
        return correlation_with(self.y, self.held_out)

    @property
    def best_n(self) -> int:
        """Fewest components with the least error on walkers left out.

        Chosen on the curve itself, so the error there flatters: see `nested_regression`.
        """
        return int(self.rmse.argmin()) + 1


def root_mean_square_error(y: np.ndarray, predicted: np.ndarray) -> np.ndarray:
    """Return the error of predictions of shape (walker, component), in units of the trait y."""
    return np.sqrt(((predicted - y[:, None]) ** 2).mean(axis=0))


def share_told(y: np.ndarray, predicted: np.ndarray) -> np.ndarray:
    """Return the share of the variance of y that predictions of (walker, component) tell (R2)."""
    return 1 - root_mean_square_error(y, predicted) ** 2 / y.var()


def correlation_with(y: np.ndarray, predicted: np.ndarray) -> np.ndarray:
    """Return how predictions of (walker, component) correlate with y; NaN if they are all alike."""
    about = predicted - predicted.mean(axis=0)
    spread = about.std(axis=0) * y.std()
    product = (about * (y - y.mean())[:, None]).mean(axis=0)
    return np.divide(product, spread, out=np.full(len(spread), np.nan), where=spread > 0)


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
    """Return how well a continuous trait is told of walkers left out (W8).

    As `jackknife_curves`, with the trait about its mean for r; the mean of the walkers trained on
    is given back.

    Parameters
    ----------
    X, scale, order, scale_in_fold, groups, progress
        As in `jackknife_curves`.
    y : array of shape (walker,)
        The trait: age, weight, a rating.

    Returns
    -------
    RegressionCurves

    Raises
    ------
    ValueError
        As `jackknife_curves`, or if the trait does not vary.

    Examples
    --------
    >>> walkers = np.random.default_rng(0).normal(size=(30, 3))
    >>> weight_kg = 70 + walkers @ [10, 0, 0]
    >>> curves = regression_curves(walkers, weight_kg)
    >>> curves.best_n, curves.r2[2].round(6)
    (3, np.float64(1.0))

    """
    walkers, trait, folds = checked_trait(X, y, groups)
    r = trait - trait.mean()
    with one_blas_thread():
        table = LeaveOut.of(walkers, r[:, None], scale=scale, scale_in_fold=scale_in_fold)
        fitted = _trained_sums(table, order)
        predicted = _held_out_sums(table, folds, order, progress)
    level = trait.mean() + _levels_without(table, folds)
    n_components = len(predicted)
    return RegressionCurves(
        y=trait,
        trained=(trait.mean() + fitted[:n_components]).T,
        held_out=(level + predicted).T,
    )


def _levels_without(table: LeaveOut, folds: Sequence[np.ndarray]) -> np.ndarray:
    """Mean of r over the walkers kept when each is left out."""
    levels = np.empty(len(table.R))
    for out in folds:
        levels[out] = table.level_without(out)
    return levels
