"""Principal components of all walkers but a few, fast and exact: the inside of the jack-knife.

Every fold standardises anew, and with it changes every number of the covariance, so there is no
cheap update of the decomposition that is exact. What is saved: the smaller side of the walkers is
decomposed instead of the walkers; the covariance of a fold is what its walkers left of that of
all; and since scores are orthogonal, ``c K = r`` is solved by ``c_i = (u_i . r) / s_i``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from functools import cache
from typing import Self, TypeVar

import numpy as np
from numpy.typing import ArrayLike
from threadpoolctl import ThreadpoolController

from eigenwalker.discriminant import Order, order_of_components, refuse_missing, two_classes
from eigenwalker.space import Scale, constant_features, divisors, spanned_dimensions

Progress = Callable[[int, int], object]
"""Called after each step with the number of steps done and of all steps."""

_Step = TypeVar("_Step")

_CLEAR = 1e-9
"""Least share of the largest eigenvalue at which eigenvalues of a Gram matrix are trusted."""


@dataclass(frozen=True, eq=False)
class FoldComponents:
    """Components of the walkers kept, and where the walkers left out lie on them.

    Parameters
    ----------
    lengths : array of shape (component,)
        Singular values of the standardised walkers kept, from the largest to the smallest; their
        scores have the standard deviations ``lengths / sqrt(n - 1)``.
    c : array of shape (component, trait)
        The discriminant of each trait (eq. 10).
    scores : array of shape (component, walker)
        Of the walkers left out.

    """

    lengths: np.ndarray
    c: np.ndarray
    scores: np.ndarray


def discriminant_sums(
    lengths: np.ndarray, c: np.ndarray, scores: np.ndarray, order: Order
) -> np.ndarray:
    """Return the sum of eq. 11 over 1, 2, ... components, the highest contribution first.

    Parameters
    ----------
    lengths, c, scores : arrays of shape (component, ...)
        As in `FoldComponents`; shapes broadcast. A component of which all three are 0 comes last
        and adds nothing.
    order : {"standardised", "raw", "variance"}
        What counts as contribution, as in `DiscriminantClassifier`.

    Returns
    -------
    array of shape (component, ...)

    """
    ranked = order_of_components(c, lengths, order)
    return np.take_along_axis(c * scores, ranked, axis=0).cumsum(axis=0)


@dataclass(frozen=True, eq=False)
class LeaveOut:
    """Walkers made ready to be left out.

    Parameters
    ----------
    Y : array of shape (walker, feature)
        Walkers about their mean, divided by the scale of all; features that vary only.
    R : array of shape (walker, trait)
        What the discriminants are to tell.
    rescaled : bool
        Whether a fold is divided by the standard deviations of its own walkers.
    rounding : array of shape (feature,)
        Standard deviation, in units of Y, below which a feature does not vary.
    squares, agreements : arrays of shape (feature,) and (feature, trait)
        Sums over all walkers of Y^2 and Y'R.
    moments : array of shape (feature, feature) or None
        Y'Y, where folds have more walkers than features.

    """

    Y: np.ndarray
    R: np.ndarray
    rescaled: bool
    rounding: np.ndarray
    squares: np.ndarray
    agreements: np.ndarray
    moments: np.ndarray | None

    @classmethod
    def of(cls, X: np.ndarray, R: np.ndarray, *, scale: Scale, scale_in_fold: bool) -> Self:
        """Return `X` of shape (walker, feature) and `R` of shape (walker, trait) made ready."""
        varying = ~constant_features(X)
        scale_of_all = divisors(X, scale)[varying]
        Y = (X - X.mean(axis=0))[:, varying] / scale_of_all
        Y -= Y.mean(axis=0)  # the mean of a feature far from 0 is rounded
        rounding = 10 * np.finfo(float).eps * np.abs(X).max() / scale_of_all
        return cls(
            Y=Y,
            R=R,
            rescaled=scale_in_fold and isinstance(scale, str),
            rounding=rounding,
            squares=(Y**2).sum(axis=0),
            agreements=Y.T @ R,
            moments=Y.T @ Y if len(Y) > Y.shape[1] else None,
        )

    def all_kept(self) -> FoldComponents:
        """Return the components of all walkers, with the scores of the same walkers."""
        return _by_svd(self.Y, self.R, self.Y)

    def without(self, out: np.ndarray) -> FoldComponents:
        """Return the components of all walkers but those of the rows `out`, and their scores."""
        gone = self.Y[out]
        n_kept = len(self.Y) - len(gone)
        total = gone.sum(axis=0)
        weights = self._weights_without(out, gone, total)
        if self.moments is not None and n_kept > len(weights):
            found = self._by_features(out, gone, total, weights)
            if found is not None:
                return found
        kept = np.ones(len(self.Y), dtype=bool)
        kept[out] = False
        rows = kept.nonzero()[0]
        standardised = self.Y.take(rows, axis=0)
        standardised += total / n_kept
        standardised *= weights
        R, left_out = self.R.take(rows, axis=0), (gone + total / n_kept) * weights
        found = _by_walkers(standardised, R, left_out) if n_kept <= len(weights) else None
        found = found or _by_svd(standardised, R, left_out)
        if not found.lengths.size:
            raise ValueError(
                f"Without the walkers of rows {out.tolist()} all others are the same; "
                "there is nothing to tell them apart by."
            )
        return found

    def _weights_without(self, out: np.ndarray, gone: np.ndarray, total: np.ndarray) -> np.ndarray:
        """One over the standard deviations of the walkers kept; 0 where they do not vary."""
        if not self.rescaled:
            return np.ones(len(total))
        n_kept = len(self.Y) - len(gone)
        squares = self.squares - np.einsum("wf,wf->f", gone, gone) - total * total / n_kept
        variance = squares / (n_kept - 1)
        if variance.min() < 1e-6:
            cancelled = variance < 1e-6
            kept = np.delete(self.Y[:, cancelled], out, axis=0)
            varies = np.ptp(kept, axis=0) > self.rounding[cancelled]
            variance[cancelled] = np.where(varies, kept.var(axis=0, ddof=1), np.inf)
        return 1 / np.sqrt(variance)

    def _by_features(
        self, out: np.ndarray, gone: np.ndarray, total: np.ndarray, weights: np.ndarray
    ) -> FoldComponents | None:
        """Decompose the features x features side, or None where that would be inexact."""
        n_kept = len(self.Y) - len(gone)
        taken = np.vstack([gone, total / np.sqrt(n_kept)])
        moments = self.moments - taken.T @ taken
        moments *= weights
        moments *= weights[:, None]
        eigenvalues, vectors = np.linalg.eigh(moments)
        if not _clear(eigenvalues):
            return None
        level = (self.R.sum(axis=0) - self.R[out].sum(axis=0)) / n_kept
        agreements = self.agreements - gone.T @ self.R[out] + np.outer(total, level)
        c = vectors.T @ (agreements * weights[:, None]) / eigenvalues[:, None]
        scores = vectors.T @ ((gone + total / n_kept) * weights).T
        return FoldComponents(np.sqrt(eigenvalues)[::-1], c[::-1], scores[::-1])


def _by_walkers(
    standardised: np.ndarray, R: np.ndarray, left_out: np.ndarray
) -> FoldComponents | None:
    """Decompose the walkers x walkers side, or None where that would be inexact."""
    eigenvalues, vectors = np.linalg.eigh(standardised @ standardised.T)
    # The smallest one belongs to the mean, which is out.
    eigenvalues, vectors = eigenvalues[1:], vectors[:, 1:]
    if not _clear(eigenvalues):
        return None
    lengths = np.sqrt(eigenvalues)
    c = vectors.T @ R / lengths[:, None]
    scores = vectors.T @ (standardised @ left_out.T) / lengths[:, None]
    return FoldComponents(lengths[::-1], c[::-1], scores[::-1])


def _clear(eigenvalues: np.ndarray) -> bool:
    """Whether eigenvalues in ascending order are all well above rounding."""
    return eigenvalues.size > 0 and eigenvalues[0] > _CLEAR * eigenvalues[-1]


def _by_svd(kept: np.ndarray, R: np.ndarray, left_out: np.ndarray) -> FoldComponents:
    """Decompose the walkers themselves: slower, and exact to the last component."""
    left, lengths, axes = np.linalg.svd(kept, full_matrices=False)
    n_spanned = spanned_dimensions(lengths, kept.shape)
    left, lengths, axes = left[:, :n_spanned], lengths[:n_spanned], axes[:n_spanned]
    return FoldComponents(lengths, left.T @ R / lengths[:, None], axes @ left_out.T)


def one_blas_thread() -> AbstractContextManager[object]:
    """Return a context in which BLAS uses one thread: more would slow such small matrices down."""
    return _thread_pools().limit(limits=1, user_api="blas")


@cache
def _thread_pools() -> ThreadpoolController:
    return ThreadpoolController()  # looks through all loaded libraries, which takes 2 ms


def ticked(steps: Sequence[_Step], progress: Progress | None) -> Iterator[_Step]:
    """Give out steps one by one, and tell how many are done after each."""
    for done, step in enumerate(steps, start=1):
        yield step
        if progress is not None:
            progress(done, len(steps))


def checked_classes(
    X: ArrayLike, y: ArrayLike, groups: ArrayLike | None, least_folds: int = 3
) -> tuple[np.ndarray, np.ndarray, list[np.ndarray]]:
    """Return walkers, r of -1 and +1, and the rows that each fold leaves out, or raise."""
    refuse_missing(y)
    classes = np.asarray(y)
    walkers, folds = checked_walkers(X, classes, groups, least_folds)
    _, which = two_classes(classes)
    return walkers, 2.0 * which - 1, folds


def checked_walkers(
    X: ArrayLike, y: np.ndarray, groups: ArrayLike | None, least_folds: int = 3
) -> tuple[np.ndarray, list[np.ndarray]]:
    """Return walkers and the rows that each fold leaves out, or raise."""
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
    folds = members(group)
    if len(folds) < least_folds:
        raise ValueError(
            f"Leaving out one at a time needs {least_folds} walkers (or groups) or more; "
            f"got {len(folds)}."
        )
    return walkers, folds


def members(group: np.ndarray) -> list[np.ndarray]:
    """Return the rows of each group."""
    _, which = np.unique(group, return_inverse=True)
    order = np.argsort(which, kind="stable")
    return np.split(order, np.flatnonzero(np.diff(which[order])) + 1)
