"""Principal components of all walkers but a few, fast and exact: the inside of the jack-knife.

Every fold is standardised again, which changes every number of the covariance, so no cheap update
of the decomposition is exact. Time is saved in three ways: the smaller side of the walkers is
decomposed instead of the walkers; the covariance of a fold is that of all less that of the walkers
left out; and since scores are orthogonal, ``c K = r`` is solved by ``c_i = (u_i . r) / s_i``.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Self

import numpy as np

from eigenwalker.analysis.discriminant_weights import Order, order_of_components
from eigenwalker.analysis.span import Scale, constant_features, divisors, spanned_dimensions

_NUMBERS_AT_ONCE = 2**17
"""Size of the standardised walkers of several folds that fit a processor's cache: a megabyte."""
_WELL_CONDITIONED = 3e-9
"""Least share of the largest eigenvalue at which those of a Gram matrix are trusted: sums are then
within 1e-8 of those by SVD."""


@dataclass(frozen=True, eq=False)
class FoldComponents:
    """Components of the training walkers of a fold, and the scores of the walkers left out.

    `singular_values` (component,) fall; `c` (component, trait) is the discriminant of each trait,
    Troje (2002), eq. 10; `scores` (component, walker) are of the walkers left out.
    """

    singular_values: np.ndarray
    c: np.ndarray
    scores: np.ndarray

    def sums(self, order: Order) -> np.ndarray:
        """Return the sums of eq. 11 of a single trait: shape (component, walker)."""
        return discriminant_sums(self.singular_values[:, None], self.c, self.scores, order)

    def sums_of_traits(self, order: Order) -> Iterator[np.ndarray]:
        """Yield the sums of eq. 11 of each walker left out: shape (component, trait)."""
        for scores in self.scores.T:
            yield discriminant_sums(self.singular_values[:, None], self.c, scores[:, None], order)


def discriminant_sums(
    singular_values: np.ndarray, c: np.ndarray, scores: np.ndarray, order: Order
) -> np.ndarray:
    """Return the sum of Troje (2002), eq. 11, over 1, 2, ... components; shapes broadcast."""
    ranked = order_of_components(c, singular_values, order)
    return np.take_along_axis(c * scores, ranked, axis=0).cumsum(axis=0)


@dataclass(frozen=True, eq=False)
class LeaveOutSVD:
    """The singular value decomposition of walkers without a few of them, for many folds.

    `Y` (walker, feature) are walkers about their mean over the scale of all, `R` (walker, trait)
    targets; `squares`, `cross_products`, `gram` are sums of Y^2, Y'R, Y'Y over all walkers. A
    feature whose range is below `rounding` does not vary.
    """

    Y: np.ndarray
    R: np.ndarray
    rescaled: bool
    rounding: np.ndarray
    squares: np.ndarray
    cross_products: np.ndarray
    gram: np.ndarray | None

    @classmethod
    def of(cls, X: np.ndarray, R: np.ndarray, *, scale: Scale, scale_in_fold: bool) -> Self:
        """Prepare walkers `X` of shape (walker, feature) and targets `R` (walker, trait)."""
        varying = ~constant_features(X)
        scale_of_all = divisors(X, scale)[varying]
        scaled = (X - X.mean(axis=0))[:, varying] / scale_of_all
        Y = scaled - scaled.mean(axis=0)  # the mean of a feature far from 0 is rounded
        rounding = 10 * np.finfo(float).eps * np.abs(X).max() / scale_of_all
        return cls(
            Y=Y,
            R=R,
            rescaled=scale_in_fold and isinstance(scale, str),
            rounding=rounding,
            squares=(Y**2).sum(axis=0),
            cross_products=Y.T @ R,
            gram=Y.T @ Y if len(Y) > Y.shape[1] else None,
        )

    def of_all_walkers(self) -> FoldComponents:
        """Return the components of all walkers, with the scores of the same walkers."""
        return _by_svd(self.Y, self.R, self.Y)

    def training_mean(self, out: np.ndarray) -> np.ndarray:
        """Return the mean target of the training walkers when those of rows `out` are left out."""
        return (self.R.sum(axis=0) - self.R[out].sum(axis=0)) / (len(self.R) - len(out))

    def leaving_out(
        self, folds: Iterable[np.ndarray]
    ) -> Iterator[tuple[np.ndarray, FoldComponents]]:
        """Yield the rows of each fold, and its components; small folds are decomposed together."""
        at_once = max(1, _NUMBERS_AT_ONCE // self.Y.size)
        for outs in _of_equal_size(folds, at_once):
            yield from zip(outs, self._leaving_out(np.array(outs)), strict=True)

    def _leaving_out(self, outs: np.ndarray) -> Iterator[FoldComponents]:
        """Components of folds that leave equally many out: `outs` is (fold, walker)."""
        removed = self.Y[outs]
        total = removed.sum(axis=1)
        n_training = len(self.Y) - outs.shape[1]
        weights = self._inverse_deviations(outs, removed, total)
        left_out = (removed + total[:, None] / n_training) * weights[:, None]
        if self.gram is not None and n_training > self.Y.shape[1]:
            for each in zip(outs, removed, total, weights, left_out, strict=True):
                yield self._by_features(self.gram, *each) or self._by_svd(each[0], *each[2:])
            return
        training = np.ones((len(outs), len(self.Y)), dtype=bool)
        training[np.arange(len(outs))[:, None], outs] = False
        rows = training.nonzero()[1].reshape(len(outs), n_training)
        standardised = self.Y[rows]
        standardised += total[:, None] / n_training
        standardised *= weights[:, None]
        by_walkers = _by_walkers(standardised, self.R[rows], left_out)
        for components, *each in zip(by_walkers, outs, total, weights, left_out, strict=True):
            yield components or self._by_svd(*each)

    def _inverse_deviations(
        self, outs: np.ndarray, removed: np.ndarray, total: np.ndarray
    ) -> np.ndarray:
        """One over the standard deviations of the training walkers; 0 where they do not vary."""
        if not self.rescaled:
            return np.ones_like(total)
        n_training = len(self.Y) - outs.shape[1]
        squares = self.squares - np.einsum("owf,owf->of", removed, removed)
        variance = (squares - total * total / n_training) / (n_training - 1)
        for fold in np.flatnonzero(variance.min(axis=1) < 1e-6):
            cancelled = variance[fold] < 1e-6
            training = np.delete(self.Y[:, cancelled], outs[fold], axis=0)
            varies = np.ptp(training, axis=0) > self.rounding[cancelled]
            variance[fold, cancelled] = np.where(varies, training.var(axis=0, ddof=1), np.inf)
        return 1 / np.sqrt(variance)

    def _by_features(
        self,
        gram: np.ndarray,
        out: np.ndarray,
        removed: np.ndarray,
        total: np.ndarray,
        weights: np.ndarray,
        left_out: np.ndarray,
    ) -> FoldComponents | None:
        """Decompose the features x features side, or None where that would be inexact."""
        n_training = len(self.Y) - len(removed)
        less = np.vstack([removed, total / np.sqrt(n_training)])
        gram = gram - less.T @ less
        gram *= weights
        gram *= weights[:, None]
        eigenvalues, vectors = np.linalg.eigh(gram)
        if not _well_conditioned(eigenvalues):
            return None
        mean = self.training_mean(out)
        cross_products = self.cross_products - removed.T @ self.R[out] + np.outer(total, mean)
        c = vectors.T @ (cross_products * weights[:, None]) / eigenvalues[:, None]
        return FoldComponents(np.sqrt(eigenvalues)[::-1], c[::-1], (vectors.T @ left_out.T)[::-1])

    def _by_svd(
        self, out: np.ndarray, total: np.ndarray, weights: np.ndarray, left_out: np.ndarray
    ) -> FoldComponents:
        """Decompose the training walkers themselves: slower, and exact to the last component."""
        training = np.delete(self.Y, out, axis=0)
        standardised = (training + total / len(training)) * weights
        components = _by_svd(standardised, np.delete(self.R, out, axis=0), left_out)
        if not components.singular_values.size:
            raise ValueError(
                f"Without the walkers of rows {out.tolist()} all others are the same; "
                "there is nothing to tell them apart by."
            )
        return components


def _of_equal_size(folds: Iterable[np.ndarray], at_once: int) -> Iterator[list[np.ndarray]]:
    """Folds that follow each other and leave equally many out, some at a time."""
    batch: list[np.ndarray] = []
    for out in folds:
        if batch and (len(batch) == at_once or len(out) != len(batch[0])):
            yield batch
            batch = []
        batch.append(out)
    yield batch


def _by_walkers(
    standardised: np.ndarray, R: np.ndarray, left_out: np.ndarray
) -> Iterator[FoldComponents | None]:
    """Decompose the walkers x walkers side of each fold; None where that would be inexact."""
    eigenvalues, vectors = np.linalg.eigh(standardised @ standardised.transpose(0, 2, 1))
    traits = vectors.transpose(0, 2, 1) @ R
    scores = vectors.transpose(0, 2, 1) @ (standardised @ left_out.transpose(0, 2, 1))
    for fold, squares in enumerate(eigenvalues):
        # The first and smallest belongs to the mean, which is taken out.
        if not _well_conditioned(squares[1:]):
            yield None
            continue
        singular_values = np.sqrt(squares[:0:-1])
        each = singular_values[:, None]
        yield FoldComponents(
            singular_values, traits[fold, :0:-1] / each, scores[fold, :0:-1] / each
        )


def _well_conditioned(eigenvalues: np.ndarray) -> bool:
    """Whether eigenvalues in ascending order are all well above rounding."""
    return eigenvalues.size > 0 and eigenvalues[0] > _WELL_CONDITIONED * eigenvalues[-1]


def _by_svd(training: np.ndarray, R: np.ndarray, left_out: np.ndarray) -> FoldComponents:
    left, singular_values, axes = np.linalg.svd(training, full_matrices=False)
    n = spanned_dimensions(singular_values, training.shape)
    c = left[:, :n].T @ R / singular_values[:n, None]
    return FoldComponents(singular_values[:n], c, axes[:n] @ left_out.T)
