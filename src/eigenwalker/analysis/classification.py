"""How well a trait is predicted from all or some of the features of walkers."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import count
from math import comb
from typing import Any, Generic, NamedTuple, TypeVar

import numpy as np
import pandas as pd

from eigenwalker.analysis.contrast import Contrast, has_several_classes, trait_contrast
from eigenwalker.analysis.jackknife import (
    JackknifeCurves,
    RegressionCurves,
    jackknife_curves,
    regression_curves,
)
from eigenwalker.analysis.several_classes import SeveralClasses, classify_several
from eigenwalker.analysis.validation import (
    NestedPredictions,
    RandomState,
    nested_leave_one_out,
    permutation_test,
)
from eigenwalker.core.progress import Progress
from eigenwalker.population.features import NAMED_PARTS
from eigenwalker.population.population import Population

_Curves = TypeVar("_Curves", JackknifeCurves, RegressionCurves)


class Input(NamedTuple):
    """What a classifier is given: a part of the features, with or without size.

    See `Population.part` for the names of parts.

    See Also
    --------
    eigenwalker.Population.part : Names of the parts.
    classify : Studies every input.

    References
    ----------
    Troje (2002), fig. 4.
    """

    title: str
    part: str
    size_normalised: bool = True


INPUTS = (
    Input("everything, with size", "all", size_normalised=False),
    Input("everything, size divided out", "all"),
    Input("structure (p0)", "structure"),
    Input("dynamics", "dynamics"),
    Input("first eigenposture", "p1"),
    Input("second eigenposture", "p2"),
    Input("third eigenposture", "p3"),
    Input("fourth eigenposture", "p4"),
    Input("first three eigenpostures", "p1+p2+p3"),
    Input("size alone", "size", size_normalised=False),
    Input("phases alone", "phases"),
    Input("frequency alone", "frequency"),
)
"""The panels a to i of fig. 4 of Troje (2002), and what its text adds."""
N_PANELS = 9
"""How many of them are panels of the figure."""


@dataclass(frozen=True, eq=False)
class InputResult(Generic[_Curves]):
    """How well a trait is predicted from one input.

    Parameters
    ----------
    input : Input
    curves : JackknifeCurves or RegressionCurves
        Over the number of components.
    nested : NestedPredictions
        When the number of components is chosen without the walker predicted.
    p : float
        Share of permuted traits that reach as small an error on the curve. Permuted among persons,
        or within each, where they have several values (`Contrast.varies_within_persons`).

    See Also
    --------
    classify, regress : make them.

    References
    ----------
    Troje (2002), fig. 4.
    """

    input: Input
    curves: _Curves
    nested: NestedPredictions
    p: float


def results_of_panels(results: Sequence[InputResult[_Curves]]) -> list[InputResult[_Curves]]:
    """Return the results of panels of the figure, without those of what its text adds."""
    return [result for result in results if result.input not in INPUTS[N_PANELS:]]


@dataclass(frozen=True, eq=False)
class Classification:
    """How well two classes of walkers can be told apart.

    Parameters
    ----------
    contrast : Contrast
        The trait and its walkers.
    results : tuple of InputResult
        One for each input.
    n_permutations : int
        Permuted traits that each input was compared with.
    random_state : str
        Seed of the permutations; "generator" if one was given.

    See Also
    --------
    classify : makes it.

    References
    ----------
    Troje (2002), eq. 9 to 11 and fig. 4.
    """

    contrast: Contrast
    results: tuple[InputResult[JackknifeCurves], ...]
    n_permutations: int = 0
    random_state: str = "0"

    def _repr_html_(self) -> str:
        """The table of results, for notebooks."""
        return self.table().to_html(index=False, escape=True, float_format="{:.3g}".format)

    def table(self) -> pd.DataFrame:
        """Return the results as a table of one row an input.

        Returns
        -------
        DataFrame
            ``input``, ``separated at n`` (fewest components that separate all walkers), ``best n``,
            ``errors`` and ``error %`` (left out, at the best n of the curve, as the paper reports),
            ``nested errors`` and ``nested %`` (n chosen without the walker), ``p``.
        """
        n_walkers = len(self.contrast.rows)
        rows = [
            {
                "input": result.input.title,
                "separated at n": result.curves.separating_n,
                "best n": result.curves.best_n,
                "errors": result.curves.fewest_errors,
                "error %": 100 * result.curves.fewest_errors / n_walkers,
                "nested errors": result.nested.errors,
                "nested %": 100 * result.nested.errors / n_walkers,
                "p": result.p,
            }
            for result in self.results
        ]
        return pd.DataFrame(rows).astype({"separated at n": "Int64"})

    def often_misclassified(self, least: int = 3) -> pd.Series:
        """Return the walkers that several inputs misclassify, with the number of inputs.

        Parameters
        ----------
        least : int
            Inputs, out of the panels of fig. 4, that misclassify a walker at their best n.

        Returns
        -------
        Series
            Number of inputs, by the walker's row in the population, the most first.
        """
        n_inputs = sum(
            result.curves.misclassified[:, result.curves.best_n - 1].astype(int)
            for result in results_of_panels(self.results)
        )
        counts = pd.Series(n_inputs, index=self.contrast.rows, name="inputs that misclassify it")
        return counts[counts >= least].sort_values(ascending=False, kind="stable")


@dataclass(frozen=True, eq=False)
class Regression:
    """How well a trait that is a number can be predicted.

    Parameters
    ----------
    contrast : Contrast
        The trait and its walkers.
    results : tuple of InputResult
        One for each input.
    n_permutations : int
        Permuted traits that each input was compared with.
    random_state : str
        Seed of the permutations; "generator" if one was given.

    See Also
    --------
    regress : makes it.

    References
    ----------
    Troje (2002), eq. 9 to 11, for a number in place of two classes.
    """

    contrast: Contrast
    results: tuple[InputResult[RegressionCurves], ...]
    n_permutations: int = 0
    random_state: str = "0"

    def _repr_html_(self) -> str:
        """The table of results, for notebooks."""
        return self.table().to_html(index=False, escape=True, float_format="{:.3g}".format)

    def table(self) -> pd.DataFrame:
        """Return the results as a table of one row an input.

        Returns
        -------
        DataFrame
            ``input``, ``best n``, and there, over walkers left out, ``correlation`` of trait and
            prediction, ``R2`` and ``RMSE`` in units of the trait; the same ``nested`` (n chosen
            without the walker), ``p``.
        """
        rows: list[dict[str, object]] = []
        for result in self.results:
            curves, nested, best = result.curves, result.nested, result.curves.best_n - 1
            rows.append(
                {
                    "input": result.input.title,
                    "best n": curves.best_n,
                    "correlation": curves.correlation[best],
                    "R2": curves.r2[best],
                    "RMSE": curves.rmse[best],
                    "nested correlation": nested.correlation,
                    "nested R2": nested.r2,
                    "nested RMSE": nested.rmse,
                    "p": result.p,
                }
            )
        return pd.DataFrame(rows)


def classify(
    population: Population,
    trait: str,
    *,
    inputs: Sequence[Input] = INPUTS,
    n_permutations: int = 200,
    random_state: RandomState = 0,
    progress: Progress | None = None,
) -> Classification | SeveralClasses:
    """Return how well classes can be told apart: two from everything and from parts, more at once.

    Where the population names persons with several walks, a person's walks are left out together;
    errors count walks.

    Parameters
    ----------
    population : Population
        Its flagged walkers are left out.
    trait : str
        A trait of two classes, ``"sex"``, or two of its classes, ``"style=feminine:masculine"``.
        One of more classes, ``"style"``, is classified as `classify_several` does, with which
        classes are confused, from everything and without permutations.
    inputs : sequence of Input
        What to classify from; parts that the population lacks are skipped.
    n_permutations : int
        Permuted traits to compare with, of two classes.
    random_state : int or numpy.random.Generator
        Seed of the permutations, or their generator.
    progress : callable, optional
        Called with the number of steps done and of all steps: the folds of all inputs.

    Returns
    -------
    Classification or SeveralClasses

    Raises
    ------
    ValueError
        If the trait is a number, or as `trait_contrast`.

    See Also
    --------
    regress : The same for a trait that is a number.
    jackknife_curves, nested_leave_one_out, permutation_test : What is done for each input.

    References
    ----------
    Troje (2002), eq. 9 to 11 and fig. 4.

    Examples
    --------
    >>> people = ew.load_population()
    >>> found = classify(people, "sex", inputs=[Input("size alone", "size", False)])
    >>> int(found.table()["errors"].item()) < 20
    True
    """
    if has_several_classes(population, trait):
        return classify_several(population, trait, progress=progress)
    contrast = trait_contrast(population, trait)
    if not contrast.two_classes:
        raise ValueError(
            f"{contrast.trait} is a number; regress on it, or choose two of its values, for "
            f"instance {contrast.trait}=1:2."
        )
    results = _results(
        jackknife_curves, population, contrast, inputs, n_permutations, random_state, progress
    )
    return Classification(contrast, results, n_permutations, seed_text(random_state))


def regress(
    population: Population,
    trait: str,
    *,
    inputs: Sequence[Input] = INPUTS,
    n_permutations: int = 200,
    random_state: RandomState = 0,
    progress: Progress | None = None,
) -> Regression:
    """Return how well a trait that is a number is predicted, from everything and from parts.

    Parameters
    ----------
    population : Population
        Its flagged walkers are left out.
    trait : str
        A trait that is a number, ``"weight"``.
    inputs : sequence of Input
        What to predict from; parts that the population lacks are skipped.
    n_permutations : int
        Permuted traits to compare with.
    random_state : int or numpy.random.Generator
        Seed of the permutations, or their generator.
    progress : callable, optional
        Called with the number of steps done and of all steps: the folds of all inputs.

    Returns
    -------
    Regression

    Raises
    ------
    ValueError
        If the trait has two classes, or as `trait_contrast`.

    See Also
    --------
    regression_curves, nested_leave_one_out, permutation_test : What is done for each input.

    References
    ----------
    Troje (2002), The little difference.

    Examples
    --------
    >>> people = ew.load_population()
    >>> found = regress(people, "height", inputs=[Input("size alone", "size", False)])
    >>> found.table()[["input", "best n", "correlation"]].round(2)
            input  best n  correlation
    0  size alone       1         0.97
    """
    contrast = trait_contrast(population, trait)
    if contrast.two_classes:
        raise ValueError(f"{contrast.trait} has two classes, not a range of values; classify it.")
    results = _results(
        regression_curves, population, contrast, inputs, n_permutations, random_state, progress
    )
    return Regression(contrast, results, n_permutations, seed_text(random_state))


def seed_text(random_state: RandomState) -> str:
    """Return a seed as it is written in a report."""
    return "generator" if isinstance(random_state, np.random.Generator) else str(random_state)


def _results(
    curves_of: Callable[..., _Curves],
    population: Population,
    contrast: Contrast,
    inputs: Sequence[Input],
    n_permutations: int,
    random_state: RandomState,
    progress: Progress | None,
) -> tuple[InputResult[_Curves], ...]:
    tables, y = _tables(population, contrast, inputs), contrast.y
    folds: dict[str, Any] = {
        "groups": contrast.persons,
        "progress": _one_count(contrast, len(tables), progress),
    }
    permutations: dict[str, Any] = {"n_permutations": n_permutations, "random_state": random_state}
    return tuple(
        InputResult(
            each,
            curves_of(X, y, **folds),
            nested_leave_one_out(X, y, **folds),
            permutation_test(X, y, **permutations, **folds).p,
        )
        for each, X in tables.items()
    )


def _tables(
    population: Population, contrast: Contrast, inputs: Sequence[Input]
) -> Mapping[Input, np.ndarray]:
    """Each input that the population has, with its features of shape (walker, feature)."""
    walkers = population.select(contrast.rows)
    normalised = walkers.size_normalised()
    parts = {*walkers.layout.blocks, *NAMED_PARTS, "size"}
    return {
        each: (normalised if each.size_normalised else walkers).part(each.part)
        for each in inputs
        if set(each.part.split("+")) <= parts
    }


def _one_count(contrast: Contrast, n_tables: int, progress: Progress | None) -> Progress | None:
    """Count the folds of all tables together: those of curve and test, and the nested pairs."""
    if progress is None:
        return None
    n_folds = len(contrast.y) if contrast.persons is None else len(set(contrast.persons))
    total = n_tables * (2 * n_folds + comb(n_folds, 2))
    done = count(1)
    return lambda _done, _of_one_loop: progress(next(done), total)
