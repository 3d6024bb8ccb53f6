"""Principal components of all walkers but a few, fast and exact: the inside of the jack-knife.

Every fold standardises anew, and with it changes every number of the covariance, so there is no
cheap update of the decomposition that is exact. What is saved: the smaller side of the walkers is
decomposed instead of the walkers; the covariance of a fold is what its walkers left of that of
all; and since scores are orthogonal, ``c K = r`` is solved by ``c_i = (u_i . r) / s_i``.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Self, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from eigenwalker.analysis.discriminant import (
    Order,
    order_of_components,
    refuse_missing,
    two_classes,
)
from eigenwalker.analysis.walker_space import Scale, constant_features, divisors, spanned_dimensions

_Step = TypeVar("_Step")

_NUMBERS_AT_ONCE = 2**17
"""Walkers of several folds together that still fit a processor's cache: a megabyte."""

_CLEAR = 3e-9
"""Least share of the largest eigenvalue at which those of a Gram matrix are trusted: sums are then
within 1e-8 of those by SVD."""


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

    def level_without(self, out: np.ndarray) -> np.ndarray:
        """Return the mean of each trait over the walkers kept when those of rows `out` are not."""
        return (self.R.sum(axis=0) - self.R[out].sum(axis=0)) / (len(self.R) - len(out))

    def leaving_out(
        self, folds: Iterable[np.ndarray]
    ) -> Iterator[tuple[np.ndarray, FoldComponents]]:
        """Give the rows of each fold, and what the walkers kept make of those left out.

        Small folds are decomposed some at a time, as calls would cost more than the arithmetic.
        """
        at_once = max(1, _NUMBERS_AT_ONCE // self.Y.size)
        for outs in _alike(folds, at_once):
            yield from zip(outs, self._leaving_out(np.array(outs)), strict=True)

    def _leaving_out(self, outs: np.ndarray) -> Iterator[FoldComponents]:
        """Components of folds that leave equally many out: `outs` is (fold, walker)."""
        gone = self.Y[outs]
        total = gone.sum(axis=1)
        n_kept = len(self.Y) - outs.shape[1]
        weights = self._weights_without(outs, gone, total)
        left_out = (gone + total[:, None] / n_kept) * weights[:, None]
        if self.moments is not None and n_kept > self.Y.shape[1]:
            for each in zip(outs, gone, total, weights, left_out, strict=True):
                yield self._by_features(*each) or self._by_svd(each[0], *each[2:])
            return
        kept = np.ones((len(outs), len(self.Y)), dtype=bool)
        kept[np.arange(len(outs))[:, None], outs] = False
        rows = kept.nonzero()[1].reshape(len(outs), n_kept)
        standardised = self.Y[rows]
        standardised += total[:, None] / n_kept
        standardised *= weights[:, None]
        found = _by_walkers(standardised, self.R[rows], left_out)
        for components, *each in zip(found, outs, total, weights, left_out, strict=True):
            yield components or self._by_svd(*each)

    def _weights_without(self, outs: np.ndarray, gone: np.ndarray, total: np.ndarray) -> np.ndarray:
        """One over the standard deviations of the walkers kept; 0 where they do not vary."""
        if not self.rescaled:
            return np.ones_like(total)
        n_kept = len(self.Y) - outs.shape[1]
        squares = self.squares - np.einsum("owf,owf->of", gone, gone) - total * total / n_kept
        variance = squares / (n_kept - 1)
        for fold in np.flatnonzero(variance.min(axis=1) < 1e-6):
            cancelled = variance[fold] < 1e-6
            kept = np.delete(self.Y[:, cancelled], outs[fold], axis=0)
            varies = np.ptp(kept, axis=0) > self.rounding[cancelled]
            variance[fold, cancelled] = np.where(varies, kept.var(axis=0, ddof=1), np.inf)
        return 1 / np.sqrt(variance)

    def _by_features(
        self,
        out: np.ndarray,
        gone: np.ndarray,
        total: np.ndarray,
        weights: np.ndarray,
        left_out: np.ndarray,
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
        level = self.level_without(out)
        agreements = self.agreements - gone.T @ self.R[out] + np.outer(total, level)
        c = vectors.T @ (agreements * weights[:, None]) / eigenvalues[:, None]
        return FoldComponents(np.sqrt(eigenvalues)[::-1], c[::-1], (vectors.T @ left_out.T)[::-1])

    def _by_svd(
        self, out: np.ndarray, total: np.ndarray, weights: np.ndarray, left_out: np.ndarray
    ) -> FoldComponents:
        """Decompose the walkers kept themselves: slower, and exact to the last component."""
        kept = np.delete(self.Y, out, axis=0)
        found = _by_svd(
            (kept + total / len(kept)) * weights, np.delete(self.R, out, axis=0), left_out
        )
        if not found.lengths.size:
            raise ValueError(
                f"Without the walkers of rows {out.tolist()} all others are the same; "
                "there is nothing to tell them apart by."
            )
        return found


def _alike(folds: Iterable[np.ndarray], at_once: int) -> Iterator[list[np.ndarray]]:
    """Folds that follow each other and leave equally many out, some at a time."""
    alike: list[np.ndarray] = []
    for out in folds:
        if alike and (len(alike) == at_once or len(out) != len(alike[0])):
            yield alike
            alike = []
        alike.append(out)
    yield alike


def _by_walkers(
    standardised: np.ndarray, R: np.ndarray, left_out: np.ndarray
) -> Iterator[FoldComponents | None]:
    """Decompose the walkers x walkers side of each fold; None where that would be inexact."""
    eigenvalues, vectors = np.linalg.eigh(standardised @ standardised.transpose(0, 2, 1))
    of_traits = vectors.transpose(0, 2, 1) @ R
    of_walkers = vectors.transpose(0, 2, 1) @ (standardised @ left_out.transpose(0, 2, 1))
    for squares, traits, walkers in zip(eigenvalues, of_traits, of_walkers, strict=True):
        # The first, and smallest, belongs to the mean, which is out.
        if not _clear(squares[1:]):
            yield None
            continue
        lengths = np.sqrt(squares[:0:-1])
        each = lengths[:, None]
        yield FoldComponents(lengths, traits[:0:-1] / each, walkers[:0:-1] / each)


def _clear(eigenvalues: np.ndarray) -> bool:
    """Whether eigenvalues in ascending order are all well above rounding."""
    return eigenvalues.size > 0 and eigenvalues[0] > _CLEAR * eigenvalues[-1]


def _by_svd(kept: np.ndarray, R: np.ndarray, left_out: np.ndarray) -> FoldComponents:
    """Decompose the walkers themselves: slower, and exact to the last component."""
    left, lengths, axes = np.linalg.svd(kept, full_matrices=False)
    n_spanned = spanned_dimensions(lengths, kept.shape)
    left, lengths, axes = left[:, :n_spanned], lengths[:n_spanned], axes[:n_spanned]
    return FoldComponents(lengths, left.T @ R / lengths[:, None], axes @ left_out.T)


def checked_classes(
    X: ArrayLike, y: ArrayLike, groups: ArrayLike | None, least_folds: int = 3
) -> tuple[np.ndarray, np.ndarray, list[np.ndarray]]:
    """Return walkers, r of -1 and +1, and the rows that each fold leaves out, or raise."""
    refuse_missing(y)
    classes = np.asarray(y)
    walkers, folds = checked_walkers(X, classes, groups, least_folds)
    _, which = two_classes(classes)
    return walkers, 2.0 * which - 1, folds


def checked_trait(
    X: ArrayLike, y: ArrayLike, groups: ArrayLike | None, least_folds: int = 3
) -> tuple[np.ndarray, np.ndarray, list[np.ndarray]]:
    """Return walkers, a trait that is a number, and the rows that each fold leaves out, or raise.

    The same as `checked_classes` but for the trait.
    """
    refuse_missing(y)
    trait = np.asarray(y, dtype=float)
    walkers, folds = checked_walkers(X, trait, groups, least_folds)
    if np.ptp(trait) == 0:
        raise ValueError(f"The trait is {trait[0]:g} for all {len(trait)} walkers; it must vary.")
    return walkers, trait, folds


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
