"""Errors that no choice has flattered: nested leave-one-out and a permutation test (A14)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import ArrayLike

from eigenwalker.analysis._leave_out import (
    LeaveOut,
    checked_classes,
    checked_trait,
    discriminant_sums,
    members,
)
from eigenwalker.analysis.discriminant import Order
from eigenwalker.analysis.jackknife import correlation_with, root_mean_square_error, share_told
from eigenwalker.analysis.walker_space import Scale
from eigenwalker.core.blas_threads import one_blas_thread
from eigenwalker.core.progress import Progress, ticked

RandomState = int | np.random.Generator | None

_Loss = Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray]
"""What sums of eq. 11 of shape (component, ...) cost, given r and the mean r of those kept."""


@dataclass(frozen=True, eq=False)
class NestedErrors:
    """Errors of a classifier whose number of components was chosen without the walker judged.

    Parameters
    ----------
    misclassified : array of bool of shape (walker,)
        Which walkers are misclassified.
    chosen_n : array of int of shape (walker,)
        The number of components chosen by the jack-knife of the others.

    """

    misclassified: np.ndarray
    chosen_n: np.ndarray

    @property
    def errors(self) -> int:
        """Number of walkers misclassified."""
        return int(self.misclassified.sum())


@dataclass(frozen=True, eq=False)
class NestedRegression:
    """A continuous trait, told with a number of components chosen without the walker judged.

    Parameters
    ----------
    y : array of shape (walker,)
        The trait.
    held_out : array of shape (walker,)
        As told by the others.
    chosen_n : array of int of shape (walker,)
        The number of components chosen by the jack-knife of the others.

    """

    y: np.ndarray
    held_out: np.ndarray
    chosen_n: np.ndarray

    @property
    def rmse(self) -> float:
        """Root mean square error, in units of the trait."""
        return float(root_mean_square_error(self.y, self.held_out[:, None])[0])

    @property
    def r2(self) -> float:
        """Share of variance told; below 0 where the mean of all walkers tells more."""
        return float(share_told(self.y, self.held_out[:, None])[0])

    @property
    def correlation(self) -> float:
        """Correlation of trait and prediction; chance is below 0, as in `RegressionCurves`."""
        return float(correlation_with(self.y, self.held_out[:, None])[0])


def nested_leave_one_out(
    X: ArrayLike,
    y: ArrayLike,
    *,
    scale: Scale = "sd",
    order: Order = "standardised",
    scale_in_fold: bool = True,
    groups: ArrayLike | None = None,
    progress: Progress | None = None,
) -> NestedErrors:
    """Return the errors on walkers left out when they have no say in the number of components.

    The least of a generalisation curve flatters, since the number of components was picked for it.
    Here a jack-knife of the other walkers picks the number for each walker left out (A14); of
    equally good ones the fewest.

    Parameters
    ----------
    X, y, scale, order, scale_in_fold, groups, progress
        As in `jackknife_curves`. Every pair of walkers is left out once, so n walkers take
        n (n + 1) / 2 folds; `progress` is told of the pairs.

    Returns
    -------
    NestedErrors

    Examples
    --------
    >>> rng = np.random.default_rng(0)
    >>> sex = np.repeat([-1, 1], 10)
    >>> walkers = rng.normal(size=(20, 3)) + 5 * sex[:, None]
    >>> nested_leave_one_out(walkers, sex).errors
    0

    """
    walkers, r, folds = checked_classes(X, y, groups, least_folds=4)
    with one_blas_thread():
        table = LeaveOut.of(walkers, r[:, None], scale=scale, scale_in_fold=scale_in_fold)
        sums, chosen_n = _nested(table, folds, order, _misses, progress)
    return NestedErrors(misclassified=r * sums <= 0, chosen_n=chosen_n)


def nested_regression(
    X: ArrayLike,
    y: ArrayLike,
    *,
    scale: Scale = "sd",
    order: Order = "standardised",
    scale_in_fold: bool = True,
    groups: ArrayLike | None = None,
    progress: Progress | None = None,
) -> NestedRegression:
    """Return how well a trait is told of walkers with no say in the number of components (W8).

    As `nested_leave_one_out`: for each walker left out the number with the least root mean square
    error in a jack-knife of the others is taken (A14).

    Parameters
    ----------
    X, y, scale, order, scale_in_fold, groups, progress
        As in `regression_curves` and `nested_leave_one_out`.

    Returns
    -------
    NestedRegression

    Examples
    --------
    >>> walkers = np.random.default_rng(0).normal(size=(30, 3))
    >>> weight_kg = 70 + walkers @ [10, 0, 0]
    >>> nested = nested_regression(walkers, weight_kg)
    >>> round(nested.r2, 6), set(nested.chosen_n.tolist())
    (1.0, {3})

    """
    walkers, trait, folds = checked_trait(X, y, groups, least_folds=4)
    r = (trait - trait.mean())[:, None]
    with one_blas_thread():
        table = LeaveOut.of(walkers, r, scale=scale, scale_in_fold=scale_in_fold)
        sums, chosen_n = _nested(table, folds, order, _squared_errors, progress)
    for out in folds:
        sums[out] += trait.mean() + table.level_without(out)
    return NestedRegression(y=trait, held_out=sums, chosen_n=chosen_n)


def _nested(
    table: LeaveOut,
    folds: Sequence[np.ndarray],
    order: Order,
    loss: _Loss,
    progress: Progress | None,
) -> tuple[np.ndarray, np.ndarray]:
    """Sum of eq. 11 of each walker over the components that the others chose, and their number."""
    inner = np.zeros((len(folds), min(table.Y.shape)))
    pairs = list(combinations(range(len(folds)), 2))
    both = (np.concatenate([folds[first], folds[second]]) for first, second in pairs)
    steps = ticked(table.leaving_out(both), len(pairs), progress)
    for (first, second), (out, fold) in zip(pairs, steps, strict=True):
        sums = discriminant_sums(fold.lengths[:, None], fold.c, fold.scores, order)
        losses = loss(sums, table.R[out, 0], table.level_without(out))
        of_first = len(folds[first])
        _add(losses[:, of_first:].sum(axis=1), inner[first])
        _add(losses[:, :of_first].sum(axis=1), inner[second])
    chosen_sums, chosen_n = np.zeros(len(table.R)), np.zeros(len(table.R), dtype=int)
    for losses, (out, fold) in zip(inner, table.leaving_out(folds), strict=True):
        sums = discriminant_sums(fold.lengths[:, None], fold.c, fold.scores, order)
        chosen_n[out] = min(losses.argmin() + 1, len(sums))
        chosen_sums[out] = sums[chosen_n[out[0]] - 1]
    return chosen_sums, chosen_n


def _add(losses: np.ndarray, total: np.ndarray) -> None:
    """Add losses over 1, 2, ... components to a total; where a fold has no more, its last holds."""
    total[: len(losses)] += losses
    total[len(losses) :] += losses[-1]


def _misses(sums: np.ndarray, r: np.ndarray, _level: np.ndarray) -> np.ndarray:
    """Count a walker as missed whose sum has not the sign of its r."""
    return r * sums <= 0


def _squared_errors(sums: np.ndarray, r: np.ndarray, level: np.ndarray) -> np.ndarray:
    """Return the squared error of r as told by the sums and the mean of the walkers kept."""
    return (level + sums - r) ** 2


@dataclass(frozen=True, eq=False)
class PermutationTest:
    """The least error of a generalisation curve, beside those of meaningless traits.

    Parameters
    ----------
    least_error : float
        Of the trait as it is: misclassified walkers, or, of a continuous trait, the root mean
        square error in standard deviations of the trait.
    null : array of shape (permutation,)
        Of the trait dealt out anew.

    """

    least_error: float
    null: np.ndarray

    @property
    def p(self) -> float:
        """Chance of as small an error as found, the trait as it is counted among the deals."""
        as_small = self.null <= self.least_error * (1 + 1e-9)  # the same deal may be rounded
        return (1 + int(as_small.sum())) / (1 + len(self.null))


def permutation_test(
    X: ArrayLike,
    y: ArrayLike,
    *,
    n_permutations: int = 1000,
    random_state: RandomState = 0,
    scale: Scale = "sd",
    order: Order = "standardised",
    scale_in_fold: bool = True,
    groups: ArrayLike | None = None,
    progress: Progress | None = None,
) -> PermutationTest:
    """Return how often classes dealt out at random reach as few errors as the true ones.

    The statistic is the least of the generalisation curve over all numbers of components, and it is
    picked from each deal in the same way, so that picking it is no advantage (A14).

    Parameters
    ----------
    X, y, scale, order, scale_in_fold, groups, progress
        As in `jackknife_curves`. With `groups`, classes are dealt to whole groups where each group
        is of one class, and within groups otherwise.
    n_permutations : int
        Deals.
    random_state : int or numpy.random.Generator
        Seed of the permutations, or their generator.

    Returns
    -------
    PermutationTest

    Examples
    --------
    >>> sex = np.repeat([-1, 1], 10)
    >>> walkers = np.random.default_rng(0).normal(size=(20, 3)) + 5 * sex[:, None]
    >>> permutation_test(walkers, sex, n_permutations=199).p < 0.05
    True

    """
    walkers, r, folds = checked_classes(X, y, groups)
    deals = _dealt_anew(r, groups, n_permutations, np.random.default_rng(random_state))
    with one_blas_thread():
        table = LeaveOut.of(walkers, deals, scale=scale, scale_in_fold=scale_in_fold)
        errors = _least_losses(table, folds, order, _misses, progress)
    return PermutationTest(least_error=float(errors[0]), null=errors[1:])


def regression_permutation_test(
    X: ArrayLike,
    y: ArrayLike,
    *,
    n_permutations: int = 1000,
    random_state: RandomState = 0,
    scale: Scale = "sd",
    order: Order = "standardised",
    scale_in_fold: bool = True,
    groups: ArrayLike | None = None,
    progress: Progress | None = None,
) -> PermutationTest:
    """Return how often a trait dealt out at random is told as well as the true one (W8).

    As `permutation_test`, of the least root mean square error over all numbers of components. It is
    in standard deviations, since these change where a trait is dealt to groups of unlike size.

    Parameters
    ----------
    X, y, scale, order, scale_in_fold, groups, progress
        As in `regression_curves`. With `groups`, values are dealt to whole groups where each group
        has one value, and within groups otherwise.
    n_permutations, random_state
        As in `permutation_test`.

    Returns
    -------
    PermutationTest

    Examples
    --------
    >>> walkers = np.random.default_rng(0).normal(size=(20, 3))
    >>> weight_kg = 70 + walkers @ [10, 0, 0]
    >>> regression_permutation_test(walkers, weight_kg, n_permutations=199).p
    0.005

    """
    walkers, trait, folds = checked_trait(X, y, groups)
    r = trait - trait.mean()
    deals = _dealt_anew(r, groups, n_permutations, np.random.default_rng(random_state))
    with one_blas_thread():
        table = LeaveOut.of(walkers, deals, scale=scale, scale_in_fold=scale_in_fold)
        squares = _least_losses(table, folds, order, _squared_errors, progress)
    errors = np.sqrt(squares / len(r)) / deals.std(axis=0)
    return PermutationTest(least_error=float(errors[0]), null=errors[1:])


def _least_losses(
    table: LeaveOut,
    folds: Sequence[np.ndarray],
    order: Order,
    loss: _Loss,
    progress: Progress | None,
) -> np.ndarray:
    """Loss over all walkers left out with the number of components that is best for each trait."""
    total = np.zeros((min(table.Y.shape), table.R.shape[1]))
    for out, fold in ticked(table.leaving_out(folds), len(folds), progress):
        level = table.level_without(out)
        for walker, scores in zip(out, fold.scores.T, strict=True):
            sums = discriminant_sums(fold.lengths[:, None], fold.c, scores[:, None], order)
            _add(loss(sums, table.R[walker], level), total)
    return total.min(axis=0)


def _dealt_anew(
    r: np.ndarray, groups: ArrayLike | None, n_permutations: int, rng: np.random.Generator
) -> np.ndarray:
    """Give r as it is, then in random orders: shape (walker, 1 + permutation)."""
    _, first, group = np.unique(
        np.arange(len(r)) if groups is None else np.asarray(groups),
        return_index=True,
        return_inverse=True,
    )
    of_group = r[first]
    if (of_group[group] == r).all():
        dealt = rng.permuted(np.tile(of_group[:, None], n_permutations), axis=0)[group]
    else:
        dealt = np.tile(r[:, None], n_permutations)
        for rows in members(group):
            dealt[rows] = rng.permuted(dealt[rows], axis=0)
    return np.column_stack([r, dealt])
