"""What is predicted of walkers left out, classes or numbers, and how predictions are scored."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from eigenwalker.analysis._leave_out import LeaveOutSVD
from eigenwalker.analysis.discriminant import refuse_missing, two_classes
from eigenwalker.analysis.walker_space import Scale, constant_features


@dataclass(frozen=True, eq=False)
class Task:
    """Walkers, the trait to predict for each, the rows of each fold, and the scoring.

    `y` is -1 and +1 for two classes, else the trait; `offset` is taken off it before the
    discriminant is solved for, and added to predictions. ``losses(sums, r, training_mean)`` is the
    loss of sums of eq. 11, of shape (component, ...), for ``r = y - offset`` and its mean over the
    walkers trained on; ``error(losses, R)`` the error of losses summed over all walkers, for each
    column of R.
    """

    X: np.ndarray
    y: np.ndarray
    offset: float
    folds: list[np.ndarray]
    losses: Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray]
    error: Callable[[np.ndarray, np.ndarray], np.ndarray]

    @property
    def r(self) -> np.ndarray:
        """What the discriminant is solved for (eq. 10)."""
        return self.y - self.offset

    def leave_out_svd(self, R: np.ndarray, scale: Scale, scale_in_fold: bool) -> LeaveOutSVD:
        """Return the walkers prepared for leaving out, with targets R of shape (walker, trait)."""
        return LeaveOutSVD.of(self.X, R, scale=scale, scale_in_fold=scale_in_fold)


def class_task(
    X: ArrayLike, y: ArrayLike, groups: ArrayLike | None, *, least_folds: int = 3
) -> Task:
    """Return the task of telling two classes apart; raise if it cannot be done."""
    refuse_missing(y)
    classes = np.asarray(y)
    walkers, folds = _walkers_and_folds(X, classes, groups, least_folds)
    _, which = two_classes(classes)
    return Task(walkers, 2.0 * which - 1, 0.0, folds, _misclassified, lambda losses, _: losses)


def number_task(
    X: ArrayLike, y: ArrayLike, groups: ArrayLike | None, *, least_folds: int = 3
) -> Task:
    """Return the task of predicting a trait that is a number; raise if it cannot be done."""
    refuse_missing(y)
    trait = np.asarray(y, dtype=float)
    walkers, folds = _walkers_and_folds(X, trait, groups, least_folds)
    if np.ptp(trait) == 0:
        raise ValueError(f"The trait is {trait[0]:g} for all {len(trait)} walkers; it must vary.")
    return Task(walkers, trait, trait.mean(), folds, _squared_errors, _standardised_rmse)


def _misclassified(sums: np.ndarray, r: np.ndarray, _mean: np.ndarray) -> np.ndarray:
    return r * sums <= 0


def _squared_errors(sums: np.ndarray, r: np.ndarray, training_mean: np.ndarray) -> np.ndarray:
    return (training_mean + sums - r) ** 2


def _standardised_rmse(losses: np.ndarray, R: np.ndarray) -> np.ndarray:
    """Root mean square errors in standard deviations of each trait."""
    return np.sqrt(losses / len(R)) / R.std(axis=0)


def _walkers_and_folds(
    X: ArrayLike, y: np.ndarray, groups: ArrayLike | None, least_folds: int
) -> tuple[np.ndarray, list[np.ndarray]]:
    walkers = np.asarray(X, dtype=float)
    if walkers.ndim != 2 or y.shape != walkers.shape[:1]:
        raise ValueError(
            f"X must be (walker, feature) and y (walker,); got shapes {walkers.shape} "
            f"and {y.shape}."
        )
    incomplete = np.flatnonzero(~np.isfinite(walkers).all(axis=1))
    if incomplete.size:
        raise ValueError(
            f"{incomplete.size} of {len(walkers)} walkers have features that are no finite numbers "
            f"(first: row {incomplete[0]}); leave them out of X and y."
        )
    if constant_features(walkers).all():
        raise ValueError(
            f"None of {walkers.shape[1]} features varies over {len(walkers)} walkers; "
            "there is nothing to tell them apart by."
        )
    if groups is not None:
        refuse_missing(groups, "group")
    group = np.arange(len(walkers)) if groups is None else np.asarray(groups)
    if group.shape != y.shape:
        raise ValueError(
            f"groups must say who each of the {len(y)} walkers is; got shape {group.shape}."
        )
    folds = rows_of_groups(group)
    if len(folds) < least_folds:
        raise ValueError(
            f"Leaving out one at a time needs {least_folds} walkers (or groups) or more; "
            f"got {len(folds)}."
        )
    return walkers, folds


def rows_of_groups(group: np.ndarray) -> list[np.ndarray]:
    """Return the rows of each group."""
    _, which = np.unique(group, return_inverse=True)
    order = np.argsort(which, kind="stable")
    return np.split(order, np.flatnonzero(np.diff(which[order])) + 1)
