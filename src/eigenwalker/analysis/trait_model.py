"""A trait of new walkers, predicted by all that are known, with the error to expect."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
import pandas as pd

from eigenwalker.analysis.contrast import has_several_classes, trait_contrast
from eigenwalker.analysis.discriminant import DiscriminantClassifier, DiscriminantRegressor
from eigenwalker.analysis.jackknife import jackknife_curves, regression_curves
from eigenwalker.analysis.oddness import Oddness
from eigenwalker.analysis.several_classes import (
    SeveralClasses,
    SharedCovariance,
    chosen_components,
    classify_several,
)
from eigenwalker.analysis.validation import NestedPredictions, nested_leave_one_out
from eigenwalker.analysis.walker_space import WalkerSpace
from eigenwalker.core.progress import Progress
from eigenwalker.population.population import Population


class _Predictor(Protocol):
    def predict(self, X: np.ndarray) -> np.ndarray: ...


@dataclass(frozen=True, eq=False)
class TraitModel:
    """What predicts a trait of new walkers.

    Parameters
    ----------
    trait : str
        Its column.
    population : Population
        Of whom it was learnt.
    rows : array of int of shape (walker,)
        Those learnt from.
    predictor : object
        With a method ``predict``, of arrays of shape (walker, feature).
    validation : NestedPredictions or SeveralClasses
        Walkers that were left out, with all walks of their person, when the number of components
        was chosen, too.
    poles : tuple of str
        The two classes; empty otherwise.
    oddness : Oddness
        How far walks are from those learnt from.

    See Also
    --------
    trait_model : Makes it.

    References
    ----------
    Troje (2002), eq. 9 to 11.
    """

    trait: str
    population: Population
    rows: np.ndarray
    predictor: _Predictor
    validation: NestedPredictions | SeveralClasses
    poles: tuple[str, ...]
    oddness: Oddness

    @property
    def is_number(self) -> bool:
        """Whether the trait is a number, not a class."""
        return not self.poles and isinstance(self.validation, NestedPredictions)

    @property
    def error(self) -> float:
        """Share of walkers left out that are misclassified; RMSE of a number, in its unit."""
        if isinstance(self.validation, SeveralClasses):
            return self.validation.error
        if self.is_number:
            return self.validation.rmse
        return self.validation.errors / len(self.rows)

    def predict(self, vectors: np.ndarray) -> pd.DataFrame:
        """Return what is predicted of walkers, and whether they are far from those known.

        Parameters
        ----------
        vectors : array of shape (walker, feature)
            As `Population.vector` returns them.

        Returns
        -------
        DataFrame
            ``prediction``; ``sum``, of eq. 11, for two classes: their walkers are about -1 and +1,
            and 0 is undecided; ``probability`` of the class among several, if scores are normally
            distributed. ``distance``, ``typicality``, ``far`` and ``far_in`` as `Oddness.of` tells.
        """
        vectors = np.atleast_2d(np.asarray(vectors, dtype=float))
        table = pd.DataFrame({"prediction": self._predictions(vectors)})
        if len(self.poles) == 2:
            table["sum"] = self.predictor.predict(vectors)
        elif isinstance(self.predictor, SharedCovariance):
            table["probability"] = self.predictor.probabilities(vectors).max(axis=1)
        return table.join(self.oddness.of(vectors))

    def _predictions(self, vectors: np.ndarray) -> np.ndarray:
        predicted = self.predictor.predict(vectors)
        return np.where(predicted > 0, *self.poles[::-1]) if self.poles else predicted


def trait_model(
    population: Population, trait: str, *, progress: Progress | None = None
) -> TraitModel:
    """Return what predicts a trait of new walkers: two classes, several, or a number.

    Two classes and numbers are predicted by Troje's discriminant of all features, size with them,
    with the number of components that the jack-knife of all walkers chooses; several classes as in
    `classify_several`. The error to expect is that of walkers left out of all of it.

    Parameters
    ----------
    population : Population
        To learn from; its flagged walkers are left out.
    trait : str
        As `trait_contrast` takes it, or of several classes.
    progress : callable, optional
        Called with the number of steps done and of all.

    Returns
    -------
    TraitModel

    Raises
    ------
    ValueError
        If there is no such trait, or too few walkers have it.

    See Also
    --------
    classify, regress, classify_several : how well a trait is told from parts of the features.

    References
    ----------
    Troje (2002), eq. 10 and 11.

    Examples
    --------
    >>> people = ew.load_population()
    >>> model = trait_model(people, "sex")
    >>> model.predict(people.X[7:8])["prediction"].tolist()
    ['female']
    >>> model.predict(people.average + 6 * (people.X[7:8] - people.average))["far"].tolist()
    [True]
    """
    if has_several_classes(population, trait):
        found = classify_several(population, trait, progress=progress)
        X, labels = population.X[found.rows], found.labels
        n = chosen_components(X, labels, found.persons)
        predictor = SharedCovariance.fit(X, labels, n)
        oddness = Oddness.learnt(population.select(found.rows), found.persons)
        return TraitModel(found.trait, population, found.rows, predictor, found, (), oddness)
    contrast = trait_contrast(population, trait)
    walkers, y, persons = population.X[contrast.rows], contrast.y, contrast.persons
    nested = nested_leave_one_out(walkers, y, groups=persons, progress=progress)
    curves_of = jackknife_curves if contrast.two_classes else regression_curves
    n = curves_of(walkers, y, groups=persons).best_n
    predictor = _Sums(walkers, y, n, contrast.two_classes)
    poles = (contrast.negative, contrast.positive) if contrast.two_classes else ()
    oddness = Oddness.learnt(population.select(contrast.rows), persons)
    return TraitModel(contrast.trait, population, contrast.rows, predictor, nested, poles, oddness)


class _Sums:
    """The sum of eq. 11 of walkers, or the number that the regression predicts."""

    def __init__(self, X: np.ndarray, y: np.ndarray, n_components: int, classes: bool) -> None:
        self._space = WalkerSpace().fit(X)
        scores = self._space.transform(X)
        if classes:
            classifier = DiscriminantClassifier(n_components=n_components).fit(scores, y)
            self._predict = classifier.decision_function
        else:
            self._predict = DiscriminantRegressor(n_components=n_components).fit(scores, y).predict

    def predict(self, X: np.ndarray) -> np.ndarray:
        return self._predict(self._space.transform(X))
