"""Errors that no choice has flattered: nested leave-one-out and a permutation test (A14)."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import ArrayLike

from eigenwalker.discriminant import Order
from eigenwalker.folds import (
    FoldComponents,
    LeaveOut,
    Progress,
    checked_classes,
    discriminant_sums,
    members,
    one_blas_thread,
    ticked,
)
from eigenwalker.space import Scale


@dataclass(frozen=True, eq=False)
class NestedErrors:
    """Errors of a classifier whose number of components was chosen without the walker judged.

    Parameters
    ----------
    missed : array of bool of shape (walker,)
        Which walkers are misclassified.
    chosen_n : array of int of shape (walker,)
        The number of components chosen by the jack-knife of the others.

    """

    missed: np.ndarray
    chosen_n: np.ndarray

    @property
    def errors(self) -> int:
        """Number of walkers misclassified."""
        return int(self.missed.sum())


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
        n (n + 1) / 2 folds.

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
    inner_errors = np.zeros((len(folds), min(walkers.shape)))
    missed, chosen_n = np.zeros(len(r), dtype=bool), np.zeros(len(r), dtype=int)
    pairs = list(combinations(range(len(folds)), 2))
    with one_blas_thread():
        table = LeaveOut.of(walkers, r[:, None], scale=scale, scale_in_fold=scale_in_fold)
        both = (np.concatenate([folds[first], folds[second]]) for first, second in pairs)
        steps = ticked(table.leaving_out(both), len(pairs), progress)
        for (first, second), (out, fold) in zip(pairs, steps, strict=True):
            wrong = _misses(fold, table.R[out, 0], order)
            n, of_first = len(wrong), len(folds[first])
            inner_errors[first, :n] += wrong[:, of_first:].sum(axis=1)
            inner_errors[second, :n] += wrong[:, :of_first].sum(axis=1)
            inner_errors[[first, second], n:] = np.inf
        for errors, (out, fold) in zip(inner_errors, table.leaving_out(folds), strict=True):
            chosen_n[out] = errors.argmin() + 1
            missed[out] = _misses(fold, table.R[out, 0], order)[errors.argmin()]
    return NestedErrors(missed=missed, chosen_n=chosen_n)


def _misses(fold: FoldComponents, r: np.ndarray, order: Order) -> np.ndarray:
    """Which of the walkers left out are misclassified: shape (component, walker)."""
    return r * discriminant_sums(fold.lengths[:, None], fold.c, fold.scores, order) <= 0


@dataclass(frozen=True, eq=False)
class PermutationTest:
    """The fewest errors of a generalisation curve, beside those of meaningless classes.

    Parameters
    ----------
    fewest_errors : int
        Of the classes as they are.
    null : array of int of shape (permutation,)
        Of classes dealt out anew.

    """

    fewest_errors: int
    null: np.ndarray

    @property
    def p(self) -> float:
        """Chance of as few errors as found, the classes as they are counted among the deals."""
        return (1 + int((self.null <= self.fewest_errors).sum())) / (1 + len(self.null))


def permutation_test(
    X: ArrayLike,
    y: ArrayLike,
    *,
    n_permutations: int = 1000,
    seed: int = 0,
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
    seed : int
        Of the deals.

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
    deals = _dealt_anew(r, groups, n_permutations, np.random.default_rng(seed))
    traits = np.column_stack([r, deals])
    errors = np.zeros((min(walkers.shape), traits.shape[1]), dtype=int)
    with one_blas_thread():
        table = LeaveOut.of(walkers, traits, scale=scale, scale_in_fold=scale_in_fold)
        for out, fold in ticked(table.leaving_out(folds), len(folds), progress):
            for walker, scores in zip(out, fold.scores.T, strict=True):
                sums = discriminant_sums(fold.lengths[:, None], fold.c, scores[:, None], order)
                wrong = traits[walker] * sums <= 0
                errors[: len(wrong)] += wrong
                errors[len(wrong) :] += wrong[-1]
    fewest = errors.min(axis=0)
    return PermutationTest(fewest_errors=int(fewest[0]), null=fewest[1:])


def _dealt_anew(
    r: np.ndarray, groups: ArrayLike | None, n_permutations: int, rng: np.random.Generator
) -> np.ndarray:
    """Classes in random order: shape (walker, permutation)."""
    if groups is None:
        return rng.permuted(np.tile(r[:, None], n_permutations), axis=0)
    _, first, group = np.unique(np.asarray(groups), return_index=True, return_inverse=True)
    of_group = r[first]
    if (of_group[group] == r).all():
        return rng.permuted(np.tile(of_group[:, None], n_permutations), axis=0)[group]
    dealt = np.tile(r[:, None], n_permutations)
    for rows in members(group):
        dealt[rows] = rng.permuted(dealt[rows], axis=0)
    return dealt
