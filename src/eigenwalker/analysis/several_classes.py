"""Three classes or more told apart as a whole: errors, the confusion table, chance."""

# scipy has no types:
# pyright: reportMissingTypeStubs=false, reportUnknownVariableType=false
from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import combinations

import numpy as np
import pandas as pd
from scipy.special import softmax

from eigenwalker.analysis.contrast import class_labels
from eigenwalker.analysis.walker_space import WalkerSpace
from eigenwalker.core.blas_threads import one_blas_thread
from eigenwalker.core.progress import Progress, ticked
from eigenwalker.population.population import Population

COMPONENTS = (2, 3, 4, 6, 8, 11, 16, 22, 32, 45)
"""Numbers of eigenwalkers among which one is chosen."""
MOST_FOLDS = 50
"""Persons up to which each is left out alone; beyond, they are left out in so many groups."""
_INNER_FOLDS = 5


@dataclass(frozen=True, eq=False)
class SeveralClasses:
    """How well three classes or more are told apart.

    Parameters
    ----------
    trait : str
    classes : tuple of str
        In sorted order.
    rows : array of int of shape (walker,)
        The walkers of the population.
    labels, predicted : array of str of shape (walker,)
        The class of each, and what is predicted of it when it is left out, with all walks of its
        person; the number of eigenwalkers is chosen without it, too.
    chosen_n : array of int of shape (walker,)
        That number.
    persons : array of shape (walker,), or None
        As in `Contrast`.
    n_folds : int
        Groups of persons, or walkers, that were left out in turn.

    See Also
    --------
    classify_several : Makes it.

    References
    ----------
    Troje (2002), eq. 9 to 11, for each pair of classes.
    """

    trait: str
    classes: tuple[str, ...]
    rows: np.ndarray
    labels: np.ndarray
    predicted: np.ndarray
    chosen_n: np.ndarray
    persons: np.ndarray | None
    n_folds: int

    @property
    def errors(self) -> int:
        """Walkers misclassified."""
        return int((self.labels != self.predicted).sum())

    @property
    def error(self) -> float:
        """Share of walkers misclassified."""
        return self.errors / len(self.labels)

    @property
    def balanced_error(self) -> float:
        """Mean over classes of the share misclassified: each class counts the same."""
        return float(np.mean(1 - np.diag(self.confusion) / self.confusion.sum(axis=1)))

    @property
    def error_of_guessing(self) -> float:
        """Share misclassified if one class of K is drawn at random each time: 1 - 1/K."""
        return 1 - 1 / len(self.classes)

    @property
    def error_of_most_frequent(self) -> float:
        """Share misclassified if the most frequent class is always answered."""
        return 1 - float(self.confusion.sum(axis=1).max()) / len(self.labels)

    @property
    def confusion(self) -> pd.DataFrame:
        """Number of walkers of each class (rows) that are taken for each class (columns)."""
        table = pd.crosstab(pd.Series(self.labels), pd.Series(self.predicted))
        table = table.reindex(index=list(self.classes), columns=list(self.classes), fill_value=0)
        return table.rename_axis(index=self.trait, columns="taken for")

    @property
    def confused(self) -> pd.DataFrame:
        """Pairs of classes by how often walkers of one are taken for the other, the most first.

        Columns ``one``, ``other``, ``walkers``, and ``share`` of the walkers of both.
        """
        table, names = self.confusion.to_numpy(), self.classes
        rows = [
            (names[i], names[j], int(table[i, j] + table[j, i]), int(table[[i, j]].sum()))
            for i, j in combinations(range(len(names)), 2)
        ]
        pairs = pd.DataFrame(rows, columns=["one", "other", "walkers", "share"])
        pairs["share"] = pairs["walkers"] / pairs["share"]
        return pairs.sort_values("share", ascending=False, kind="stable", ignore_index=True)

    def table(self) -> pd.DataFrame:
        """Return of each class ``walkers``, ``errors``, ``error %``, and what it is ``taken for``.

        The last row is of all.
        """
        counts = self.confusion.to_numpy()
        rows: list[tuple[str, int, int, float, str]] = []
        for row, name in enumerate(self.classes):
            n, right = int(counts[row].sum()), int(counts[row, row])
            wrong = np.where(np.arange(len(counts)) == row, 0, counts[row])
            most = self.classes[int(wrong.argmax())] if wrong.any() else ""
            rows.append((name, n, n - right, 100 * (n - right) / n if n else np.nan, most))
        rows.append(("all", len(self.labels), self.errors, 100 * self.error, ""))
        heads = [self.trait, "walkers", "errors", "error %", "mostly taken for"]
        return pd.DataFrame(rows, columns=heads)

    def _repr_html_(self) -> str:
        """Errors and the confusion table, for notebooks."""
        form = "{:.3g}".format
        tables = (self.table().to_html(index=False, float_format=form), self.confusion.to_html())
        return "".join(tables)


def classify_several(
    population: Population,
    trait: str,
    *,
    progress: Progress | None = None,
) -> SeveralClasses:
    """Return how well all classes of a trait are told apart at once.

    Walkers left out are predicted by a linear discriminant analysis of their scores on the first n
    eigenwalkers, with a covariance matrix that all classes share, and classes that count the same.
    n is chosen by five-fold cross-validation of the others.

    Parameters
    ----------
    population : Population
        Its flagged walkers are left out; all walks of a person are left out together.
    trait : str
        A column of the traits, or some of its values: ``"style=active:elderly:normal"``.
    progress : callable, optional
        Called with the number of folds done and of all.

    Returns
    -------
    SeveralClasses

    Raises
    ------
    ValueError
        If there is no such trait, or a class has less than two walkers or persons.

    See Also
    --------
    classify : Two classes, as in Troje (2002).

    References
    ----------
    Fisher (1936), Annals of Eugenics 7:179; Rao (1948), J. R. Stat. Soc. B 10:159.

    Examples
    --------
    >>> people = ew.simulate_population(10, 10, seed=1)
    >>> tall = people.traits["height_mm"].rank().gt(10).map({False: "short", True: "tall"})
    >>> kinds = people.traits["sex"].where(tall.eq("tall"), "short")
    >>> people = ew.Population(people.walkers, people.traits.assign(kind=kinds))
    >>> classify_several(people, "kind").confusion.sum(axis=1).tolist()
    [2, 8, 10]
    """
    column, rows, labels, persons = class_labels(population, trait)
    X = population.X[rows]
    groups = np.arange(len(labels)) if persons is None else persons
    n_persons = pd.Series(groups).groupby(labels).nunique()
    if n_persons.min() < 2:
        raise ValueError(
            f"The class {n_persons.idxmin()} of {column} has one walker or person; each "
            "needs two or more, so that one can be left out."
        )
    folds = list(_folds(labels, groups, min(len(set(groups)), MOST_FOLDS)))
    predicted, chosen_n = np.empty(len(labels), dtype=object), np.zeros(len(labels), dtype=int)
    with one_blas_thread():
        for train, out in ticked(folds, len(folds), progress):
            n = _best_n(X[train], labels[train], groups[train])
            chosen_n[out] = n
            predicted[out] = SharedCovariance.fit(X[train], labels[train], n).predict(X[out])
    return SeveralClasses(
        column,
        tuple(sorted(set(labels))),
        rows,
        labels,
        predicted.astype(str),
        chosen_n,
        persons,
        len(folds),
    )


@dataclass(frozen=True, eq=False)
class SharedCovariance:
    """A linear discriminant analysis of the scores on the first n eigenwalkers."""

    space: WalkerSpace
    classes: np.ndarray
    weights: np.ndarray
    constants: np.ndarray

    @classmethod
    def fit(cls, X: np.ndarray, labels: np.ndarray, n: int) -> SharedCovariance:
        """Return the analysis of walkers X of shape (walker, feature)."""
        space = WalkerSpace().fit(X)
        return cls(space, *_analysis(space.transform(X)[:, :n], labels))

    def predict(self, X: np.ndarray) -> np.ndarray:
        """Return the class of each walker."""
        return self.classes[self._sums(X).argmax(axis=1)]

    def probabilities(self, X: np.ndarray) -> np.ndarray:
        """Return probabilities of shape (walker, class), if the analysis' normal model holds."""
        return softmax(self._sums(X), axis=1)

    def _sums(self, X: np.ndarray) -> np.ndarray:
        return self.space.transform(X)[:, : len(self.weights)] @ self.weights + self.constants


def chosen_components(X: np.ndarray, labels: np.ndarray, persons: np.ndarray | None) -> int:
    """Return the number of eigenwalkers that five-fold cross-validation chooses."""
    return _best_n(X, labels, np.arange(len(labels)) if persons is None else persons)


def _best_n(X: np.ndarray, labels: np.ndarray, groups: np.ndarray) -> int:
    errors = np.zeros(len(COMPONENTS))
    for train, out in _folds(labels, groups, min(len(set(groups)), _INNER_FOLDS)):
        space = WalkerSpace().fit(X[train])
        known, new = space.transform(X[train]), space.transform(X[out])
        for which, n in enumerate(COMPONENTS):
            classes, weights, constants = _analysis(known[:, :n], labels[train])
            sums = new[:, : len(weights)] @ weights + constants
            errors[which] += (classes[sums.argmax(axis=1)] != labels[out]).sum()
    return COMPONENTS[int(errors.argmin())]


def _analysis(scores: np.ndarray, labels: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return classes, weights of shape (component, class) and constants of linear discriminants."""
    classes, which = np.unique(labels, return_inverse=True)
    n = max(1, min(scores.shape[1], len(labels) - len(classes)))
    scores = scores[:, :n]
    means = np.stack([scores[which == each].mean(axis=0) for each in range(len(classes))])
    within = scores - means[which]
    covariance = within.T @ within / max(len(labels) - len(classes), 1)
    weights = np.linalg.pinv(covariance, hermitian=True) @ means.T
    return classes, weights, -0.5 * (means * weights.T).sum(axis=1)


def _folds(
    labels: np.ndarray, groups: np.ndarray, n_folds: int
) -> Iterable[tuple[np.ndarray, np.ndarray]]:
    """Return rows to learn from and rows left out, with all walks of a person in one of them."""
    _, group = np.unique(groups, return_inverse=True)
    if n_folds == group.max() + 1:
        for each in range(n_folds):
            yield np.flatnonzero(group != each), np.flatnonzero(group == each)
        return
    _, which = np.unique(labels, return_inverse=True)
    # Strata by hand: persons of each class in turn, so that small classes are in every fold.
    first = pd.Series(which).groupby(group).first().sort_values(kind="stable")
    fold_of = pd.Series(np.arange(len(first)) % n_folds, index=first.index).sort_index()
    fold = fold_of.to_numpy()[group]
    for each in range(n_folds):
        yield np.flatnonzero(fold != each), np.flatnonzero(fold == each)
