"""What is predicted of walkers left out, classes or numbers, and how predictions are scored."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from eigenwalker.analysis.discriminant import refuse_missing, two_classes
from eigenwalker.analysis.span import constant_features
from eigenwalker.core.arguments import check_labels, check_numbers


@dataclass(frozen=True, eq=False)
class Task:
    """Walkers X (walker, feature), the trait y to predict, and the rows that each fold leaves out.

    The trait is -1 and +1 for two classes; or else it is a number, predicted about its mean.
    """

    X: np.ndarray
    y: np.ndarray
    folds: list[np.ndarray]
    is_number: bool

    @property
    def offset(self) -> float:
        """Taken off the trait before the discriminant is solved for, and added to predictions."""
        return float(self.y.mean()) if self.is_number else 0.0

    def keeps_both(self, out: np.ndarray) -> bool:
        """Return whether both classes are left without the rows `out`; a number always is."""
        left = np.delete(self.y, out)
        return self.is_number or bool((left > 0).any() and (left < 0).any())

    @property
    def r(self) -> np.ndarray:
        """What the discriminant is solved for: Troje (2002), eq. 10."""
        return self.y - self.offset

    def losses(self, sums: np.ndarray, r: np.ndarray, training_mean: np.ndarray) -> np.ndarray:
        """Return the loss of sums of eq. 11, of shape (component, ...)."""
        return (training_mean + sums - r) ** 2 if self.is_number else r * sums <= 0

    def error(self, losses: np.ndarray, R: np.ndarray) -> np.ndarray:
        """Return misclassified walkers, or the RMSE in SDs of the trait, of losses summed up."""
        return np.sqrt(losses / len(R)) / R.std(axis=0) if self.is_number else losses


def task_of(X: ArrayLike, y: ArrayLike, groups: ArrayLike | None, *, least_folds: int = 3) -> Task:
    """Return the task that a trait stands for: classes if it is text or has two values."""
    values = pd.Series(check_labels(y, "y"))
    is_number = pd.api.types.is_numeric_dtype(values) and values.nunique() != 2
    return (number_task if is_number else class_task)(X, y, groups, least_folds=least_folds)


def class_task(
    X: ArrayLike, y: ArrayLike, groups: ArrayLike | None, *, least_folds: int = 3
) -> Task:
    """Return the task of telling two classes apart; raise if it cannot be done."""
    classes = check_labels(y, "y")
    refuse_missing(classes)
    walkers, folds = _walkers_and_folds(X, classes, groups, least_folds)
    names, which = two_classes(classes)
    task = Task(walkers, 2.0 * which - 1, folds, is_number=False)
    for out in folds:
        if task.keeps_both(out):
            continue
        who = f"one walker (row {out[0]})" if groups is None else f"{np.asarray(groups)[out[0]]}"
        alone = names[0] if (np.delete(task.y, out) > 0).any() else names[1]
        raise ValueError(
            f"Without {who} no walker of the class {alone} is left to learn from. Each class needs "
            "two walkers or more, of two persons or more."
        )
    return task


def number_task(
    X: ArrayLike, y: ArrayLike, groups: ArrayLike | None, *, least_folds: int = 3
) -> Task:
    """Return the task of predicting a trait that is a number; raise if it cannot be done."""
    refuse_missing(check_labels(y, "y"))
    trait = check_numbers(y, "y", "walker")
    walkers, folds = _walkers_and_folds(X, trait, groups, least_folds)
    if np.ptp(trait) == 0:
        raise ValueError(f"The trait is {trait[0]:g} for all {len(trait)} walkers; it must vary.")
    return Task(walkers, trait, folds, is_number=True)


def _walkers_and_folds(
    X: ArrayLike, y: np.ndarray, groups: ArrayLike | None, least_folds: int
) -> tuple[np.ndarray, list[np.ndarray]]:
    walkers = check_numbers(X, "X", "walker", "feature", missing=True)
    if y.shape != walkers.shape[:1]:
        raise ValueError(
            f"X must be (walker, feature) and y (walker,); got shapes {walkers.shape} "
            f"and {y.shape}."
        )
    missing = np.argwhere(np.isnan(walkers))
    if missing.size:
        row, column = missing[0]
        raise ValueError(
            f"{len(np.unique(missing[:, 0]))} of {len(walkers)} walkers have features that are "
            f"missing (NaN; first: row {row}, column {column}); leave them out of X and y."
        )
    if constant_features(walkers).all():
        raise ValueError(
            f"None of {walkers.shape[1]} features varies over {len(walkers)} walkers; "
            "there is nothing to tell them apart by."
        )
    if groups is not None:
        refuse_missing(check_labels(groups, "groups"), "group")
    group = np.arange(len(walkers)) if groups is None else check_labels(groups, "groups")
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
