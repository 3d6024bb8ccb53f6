"""Errors that allow for the choice of n components: nested leave-one-out, a permutation test."""

# scipy and scikit-learn have no types:
# pyright: reportMissingTypeStubs=false, reportUnknownMemberType=false
# pyright: reportUnknownVariableType=false, reportUnknownArgumentType=false
from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import ArrayLike
from sklearn.metrics import r2_score, root_mean_squared_error

from eigenwalker.analysis._leave_out import LeaveOutSVD
from eigenwalker.analysis._task import rows_of_groups, task_of
from eigenwalker.analysis.discriminant_weights import Order
from eigenwalker.analysis.jackknife import correlation
from eigenwalker.analysis.walker_space import Scale
from eigenwalker.core.arguments import generator
from eigenwalker.core.blas_threads import one_blas_thread
from eigenwalker.core.progress import Progress, ticked

MOST_PERMUTATIONS = 100_000
RandomState = int | np.random.Generator | None


@dataclass(frozen=True, eq=False)
class NestedPredictions:
    """Predictions with a number of components that is chosen without the walker predicted.

    Parameters
    ----------
    y : array of shape (walker,)
        -1 and +1 for two classes, else the trait.
    held_out : array of shape (walker,)
        Prediction for each walker left out: the sum of eq. 11 for two classes, else the trait.
    chosen_n : array of int of shape (walker,)
        The number of components chosen by the jack-knife of the others.

    See Also
    --------
    nested_leave_one_out : makes them.
    """

    y: np.ndarray
    held_out: np.ndarray
    chosen_n: np.ndarray

    @property
    def misclassified(self) -> np.ndarray:
        """Which walkers are misclassified, of two classes: bool of shape (walker,)."""
        return self.y * self.held_out <= 0

    @property
    def errors(self) -> int:
        """Number of walkers misclassified, of two classes."""
        return int(self.misclassified.sum())

    @property
    def rmse(self) -> float:
        """Root mean square error of a trait that is a number, in its units."""
        return float(root_mean_squared_error(self.y, self.held_out))

    @property
    def r2(self) -> float:
        """Share of variance predicted; below 0 where the mean of all walkers does better."""
        return float(r2_score(self.y, self.held_out))

    @property
    def correlation(self) -> float:
        """Correlation of trait and prediction; see `RegressionCurves.correlation`."""
        return correlation(self.y, self.held_out)


def nested_leave_one_out(
    X: ArrayLike,
    y: ArrayLike,
    *,
    scale: Scale = "sd",
    order: Order = "standardised",
    scale_in_fold: bool = True,
    groups: ArrayLike | None = None,
    progress: Progress | None = None,
) -> NestedPredictions:
    """Return predictions for walkers left out of choosing the number of components, too.

    The least error of a generalisation curve is too small, since the number of components was
    chosen for it. Here a jack-knife of the other walkers chooses the number for each walker left
    out: the one with the fewest errors or the least root mean square error, and the smallest of
    equally good ones.

    Parameters
    ----------
    X : array of shape (walker, feature)
        Walkers, or a part of their features.
    y : array of shape (walker,)
        Two classes: text, or numbers of two values. Or else a trait that is a number.
    scale : {"sd"}, None, or array of shape (feature,)
        What features are divided by: each one's standard deviation, nothing, or these.
    order : {"standardised", "raw", "variance"}
        Which components come first: by ``|c_i| sd(k_i)``, ``|c_i|`` or the variance of the scores.
    scale_in_fold : bool
        Whether to standardise again without the walkers left out.
    groups : array of shape (walker,), optional
        The person of each row: all walks of a person are left out together.
    progress : callable, optional
        Called with the number of pairs of walkers that are done, and of all. Every pair is left out
        once, so n walkers take n (n + 1) / 2 folds.

    Returns
    -------
    NestedPredictions
        A prediction for each walker, and with how many components.

    Raises
    ------
    ValueError
        If there are fewer than four walkers or groups, no feature or trait that varies, missing
        numbers, or if all walkers of a class would be left out at once.

    Notes
    -----
    A pair of persons who are all of a class does not count when the number is chosen.

    See Also
    --------
    permutation_test : How often a permuted trait is predicted as well.

    References
    ----------
    Troje (2002), eq. 11, chooses n on the curve itself; here n is chosen without the walker.

    Examples
    --------
    >>> rng = np.random.default_rng(0)
    >>> sex = np.repeat([-1, 1], 10)
    >>> walkers = rng.normal(size=(20, 3)) + 5 * sex[:, None]
    >>> nested_leave_one_out(walkers, sex).errors
    0
    """
    task = task_of(X, y, groups, least_folds=4)
    folds = task.folds
    pairs = list(combinations(range(len(folds)), 2))
    both = (np.concatenate([folds[first], folds[second]]) for first, second in pairs)
    predictions, chosen_n = np.zeros(len(task.y)), np.zeros(len(task.y), dtype=int)
    with one_blas_thread():
        svd = LeaveOutSVD.of(task.X, task.r[:, None], scale=scale, scale_in_fold=scale_in_fold)
        losses_of_others = np.zeros((len(folds), min(svd.Y.shape)))
        steps = ticked(svd.leaving_out(both), len(pairs), progress)
        for (first, second), (out, fold) in zip(pairs, steps, strict=True):
            if not task.keeps_both(out):
                continue  # one class cannot be told from nothing
            losses = task.losses(fold.sums(order), task.r[out], svd.training_mean(out))
            of_first = len(folds[first])
            _add(losses[:, of_first:].sum(axis=1), losses_of_others[first])
            _add(losses[:, :of_first].sum(axis=1), losses_of_others[second])
        for losses, (out, fold) in zip(losses_of_others, svd.leaving_out(folds), strict=True):
            sums = fold.sums(order)
            n = min(int(losses.argmin()) + 1, len(sums))
            chosen_n[out], predictions[out] = n, sums[n - 1]
            if task.is_number:
                predictions[out] += task.offset + svd.training_mean(out)
    return NestedPredictions(task.y, predictions, chosen_n)


def _add(losses: np.ndarray, total: np.ndarray) -> None:
    """Add losses over 1, 2, ... components to a total; where a fold has no more, its last holds."""
    total[: len(losses)] += losses
    total[len(losses) :] += losses[-1]


@dataclass(frozen=True, eq=False)
class PermutationTest:
    """The least error of a generalisation curve, and those of permuted traits.

    Parameters
    ----------
    least_error : float
        Of the trait as it is: misclassified walkers, or, of a trait that is a number, the root mean
        square error in standard deviations of the trait.
    null : array of shape (permutation,)
        The same of each permuted trait.

    See Also
    --------
    permutation_test : makes it.
    """

    least_error: float
    null: np.ndarray

    @property
    def p(self) -> float:
        """Probability of as small an error; the trait as it is counts as a permutation."""
        as_small = self.null <= self.least_error * (1 + 1e-9)  # equal permutations may be rounded
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
    """Return how often a randomly permuted trait is predicted as well as the true one.

    The statistic is the least error of the generalisation curve over all numbers of components:
    misclassified walkers, or the root mean square error in standard deviations of the trait. It is
    chosen in the same way for each permutation, so choosing it is no advantage.

    Parameters
    ----------
    X : array of shape (walker, feature)
        Walkers, or a part of their features.
    y : array of shape (walker,)
        Two classes: text, or numbers of two values. Or else a trait that is a number.
    n_permutations : int
        Number of permutations.
    random_state : int or numpy.random.Generator
        Seed of the permutations, or their generator.
    scale : {"sd"}, None, or array of shape (feature,)
        What features are divided by: each one's standard deviation, nothing, or these.
    order : {"standardised", "raw", "variance"}
        Which components come first: by ``|c_i| sd(k_i)``, ``|c_i|`` or the variance of the scores.
    scale_in_fold : bool
        Whether to standardise again without the walkers left out.
    groups : array of shape (walker,), optional
        The person of each row: all walks of a person are left out together, and the trait is
        permuted among persons where it is constant within each, and within persons otherwise.
    progress : callable, optional
        Called with the number of folds done and of all folds.

    Returns
    -------
    PermutationTest
        The error, those of the permutations, and p.

    See Also
    --------
    nested_leave_one_out : errors when n is chosen without the walker.

    References
    ----------
    Ojala & Garriga (2010), Journal of Machine Learning Research 11:1833.

    Examples
    --------
    >>> sex = np.repeat([-1, 1], 10)
    >>> walkers = np.random.default_rng(0).normal(size=(20, 3)) + 5 * sex[:, None]
    >>> permutation_test(walkers, sex, n_permutations=199).p < 0.05
    True
    """
    task = task_of(X, y, groups)
    R = _permuted_labels(task.r, groups, n_permutations, random_state)
    with one_blas_thread():
        svd = LeaveOutSVD.of(task.X, R, scale=scale, scale_in_fold=scale_in_fold)
        total = np.zeros((min(svd.Y.shape), R.shape[1]))
        for out, fold in ticked(svd.leaving_out(task.folds), len(task.folds), progress):
            training_mean = svd.training_mean(out)
            for walker, sums in zip(out, fold.sums_of_traits(order), strict=True):
                _add(task.losses(sums, R[walker], training_mean), total)
    errors = task.error(total.min(axis=0), R)
    return PermutationTest(least_error=float(errors[0]), null=errors[1:])


def _permuted_labels(
    r: np.ndarray, groups: ArrayLike | None, n_permutations: int, random_state: RandomState
) -> np.ndarray:
    """Targets as they are, then in random orders: shape (walker, 1 + permutation)."""
    if not 0 <= n_permutations <= MOST_PERMUTATIONS:
        few = "few" if n_permutations < 0 else "many"
        raise ValueError(
            f"n_permutations={n_permutations} is too {few}; give 0 to {MOST_PERMUTATIONS}."
        )
    rng = generator(random_state)
    _, first, group = np.unique(
        np.arange(len(r)) if groups is None else np.asarray(groups),
        return_index=True,
        return_inverse=True,
    )
    of_group = r[first]
    if (of_group[group] == r).all():
        permuted = rng.permuted(np.tile(of_group[:, None], n_permutations), axis=0)[group]
    else:
        permuted = np.tile(r[:, None], n_permutations)
        for rows in rows_of_groups(group):
            permuted[rows] = rng.permuted(permuted[rows], axis=0)
    return np.column_stack([r, permuted])
