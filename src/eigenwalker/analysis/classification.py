"""How well walkers can be told apart from all or some of their features (J fig. 4)."""

from __future__ import annotations

from collections.abc import Sequence, Sized
from dataclasses import dataclass
from itertools import count
from math import comb
from typing import NamedTuple, TypedDict

import numpy as np
import pandas as pd

from eigenwalker.analysis.contrast import Contrast, trait_contrast
from eigenwalker.analysis.jackknife import (
    JackknifeCurves,
    Progress,
    RegressionCurves,
    jackknife_curves,
    regression_curves,
)
from eigenwalker.analysis.validation import (
    NestedErrors,
    NestedRegression,
    nested_leave_one_out,
    nested_regression,
    permutation_test,
    regression_permutation_test,
)
from eigenwalker.population.features import NAMED_PARTS
from eigenwalker.population.population import Population


class Input(NamedTuple):
    """What a classifier is given: a part of the features, with or without size."""

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
"""The panels of fig. 4 of Troje (2002), a to i, and what its text adds (J24)."""
N_PANELS = 9


@dataclass(frozen=True, eq=False)
class InputResult:
    """What a classifier makes of one input.

    Parameters
    ----------
    input : Input
    curves : JackknifeCurves
        Separation and generalisation over the number of components.
    nested : NestedErrors
        Errors when the number of components is chosen without the walker judged (A14).
    p : float
        Share of random labels that reach as few errors on the curve.

    """

    input: Input
    curves: JackknifeCurves
    nested: NestedErrors
    p: float


@dataclass(frozen=True, eq=False)
class Classification:
    """How well two classes of walkers can be told apart.

    Parameters
    ----------
    contrast : Contrast
        The trait and who took part.
    results : tuple of InputResult
        One for each input.
    n_permutations : int
        Random labels that each input was compared with.

    """

    contrast: Contrast
    results: tuple[InputResult, ...]
    n_permutations: int = 0

    def table(self) -> pd.DataFrame:
        """Return the main table: one row an input.

        Returns
        -------
        DataFrame
            ``features``, ``separated at n`` (fewest components that separate all walkers),
            ``best n``, ``errors`` and ``error %`` (left out, at the best n of the curve, as the
            paper reports), ``nested errors`` and ``nested %`` (honest), ``p``.

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

    def table_in_words(self) -> pd.DataFrame:
        """Return the main table as it is printed: "-" where there is nothing, p with its floor."""
        return _in_words(self.table(), self.n_permutations)

    def often_misclassified(self, least: int = 3) -> pd.Series:
        """Return the walkers that several classifiers miss, with how many of them do (J27).

        Returns
        -------
        Series
            Number of inputs that misclassify each walker at their best n, by its row in the
            population, most often missed first.

        """
        missed = sum(
            result.curves.misclassified[:, result.curves.best_n - 1].astype(int)
            for result in self.results[:N_PANELS]
        )
        counts = pd.Series(missed, index=self.contrast.rows, name="inputs that miss it")
        return counts[counts >= least].sort_values(ascending=False, kind="stable")

    @property
    def chance(self) -> str:
        """What to hold the errors against, in a sentence."""
        sizes = [int((self.contrast.y < 0).sum()), int((self.contrast.y > 0).sum())]
        errors = "1 error" if min(sizes) == 1 else f"{min(sizes)} errors"
        said = f"Always answering the more frequent class makes {errors}."
        if sizes[0] == sizes[1]:
            return said
        return (
            f"{said} The classes are of unequal size ({self.contrast.negative} {sizes[0]}, "
            f"{self.contrast.positive} {sizes[1]}), and the discriminant has no constant (eq. 11), "
            "which suits classes of equal size."
        )

    @property
    def many_inputs(self) -> str:
        """What to mind of so many values of p, in a sentence; empty where there is one."""
        return _many_inputs(len(self.results), self.n_permutations)


@dataclass(frozen=True, eq=False)
class RegressionResult:
    """What a regression makes of one input.

    Parameters
    ----------
    input : Input
    curves : RegressionCurves
        How well the trait is told over the number of components.
    nested : NestedRegression
        How well when the number of components is chosen without the walker judged (A14).
    p : float
        Share of random deals of the trait that reach as small an error on the curve.

    """

    input: Input
    curves: RegressionCurves
    nested: NestedRegression
    p: float


@dataclass(frozen=True, eq=False)
class Regression:
    """How well a trait that is a number can be told.

    Parameters
    ----------
    contrast : Contrast
        The trait and who took part.
    results : tuple of RegressionResult
        One for each input.
    n_permutations : int
        Random deals of the trait that each input was compared with.

    """

    contrast: Contrast
    results: tuple[RegressionResult, ...]
    n_permutations: int = 0

    def table(self) -> pd.DataFrame:
        """Return the main table: one row an input.

        Returns
        -------
        DataFrame
            ``best n``, and there, over walkers left out, ``correlation`` of trait and prediction,
            ``R2`` and ``RMSE`` in units of the trait; the same ``nested`` (honest), and ``p``.

        """
        rows = []
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

    def table_in_words(self) -> pd.DataFrame:
        """Return the main table as it is printed: "-" where there is nothing, p with its floor."""
        return _in_words(self.table(), self.n_permutations)

    @property
    def chance(self) -> str:
        """What to hold the errors against, in a sentence."""
        return f"Always answering the mean has an RMSE of {self.contrast.y.std():.3g}."

    @property
    def many_inputs(self) -> str:
        """What to mind of so many values of p, in a sentence; empty where there is one."""
        return _many_inputs(len(self.results), self.n_permutations)


def classify(
    population: Population,
    trait: str,
    *,
    inputs: Sequence[Input] = INPUTS,
    n_permutations: int = 200,
    random_state: int = 0,
    progress: Progress | None = None,
) -> Classification:
    """Return how well a trait of two classes can be told, from everything and from parts.

    Where the population names persons of whom there are several walks, a person's walks are left
    out together.

    Parameters
    ----------
    population : Population
        Its flagged walkers are left out.
    trait : str
        As `contrast` takes it: ``"sex"``, ``"style=feminine:masculine"``.
    inputs : sequence of Input
        What to classify from; parts that the population lacks are passed over.
    n_permutations : int
        Random labels to compare with.
    random_state : int
        Seed of the permutations.
    progress : callable, optional
        Called with the number of steps done and of all: the folds of all inputs.

    Returns
    -------
    Classification

    Raises
    ------
    ValueError
        If the trait is a number, or as `contrast`.

    Examples
    --------
    >>> people = ew.load_population()
    >>> found = classify(people, "sex", inputs=[Input("size alone", "size", False)])
    >>> int(found.table()["errors"].item()) < 20
    True
    >>> found.chance
    'Always answering the more frequent class makes 20 errors.'

    """
    asked = trait_contrast(population, trait)
    if not asked.two_classes:
        raise ValueError(
            f"{asked.trait} is a number; regress on it, or choose two of its values, for instance "
            f"{asked.trait}=1:2."
        )
    tables = _tables(population, asked, inputs)
    left_out: _LeftOut = {"groups": asked.persons, "progress": _steps(asked, tables, progress)}
    deals: _Deals = {"n_permutations": n_permutations, "random_state": random_state}
    results = [
        InputResult(
            input=each,
            curves=jackknife_curves(X, asked.y, **left_out),
            nested=nested_leave_one_out(X, asked.y, **left_out),
            p=permutation_test(X, asked.y, **deals, **left_out).p,
        )
        for each, X in tables.items()
    ]
    return Classification(asked, tuple(results), n_permutations)


def regress(
    population: Population,
    trait: str,
    *,
    inputs: Sequence[Input] = INPUTS,
    n_permutations: int = 200,
    random_state: int = 0,
    progress: Progress | None = None,
) -> Regression:
    """Return how well a trait that is a number can be told, from everything and from parts (W8).

    Parameters
    ----------
    population, trait, inputs, n_permutations, random_state, progress
        As in `classify`.

    Returns
    -------
    Regression

    Raises
    ------
    ValueError
        As `contrast`.

    Examples
    --------
    >>> people = ew.load_population()
    >>> found = regress(people, "height", inputs=[Input("size alone", "size", False)])
    >>> found.table()[["input", "best n", "correlation"]].round(2)
            input  best n  correlation
    0  size alone       1         0.96

    """
    asked = trait_contrast(population, trait)
    tables = _tables(population, asked, inputs)
    left_out: _LeftOut = {"groups": asked.persons, "progress": _steps(asked, tables, progress)}
    deals: _Deals = {"n_permutations": n_permutations, "random_state": random_state}
    results = [
        RegressionResult(
            input=each,
            curves=regression_curves(X, asked.y, **left_out),
            nested=nested_regression(X, asked.y, **left_out),
            p=regression_permutation_test(X, asked.y, **deals, **left_out).p,
        )
        for each, X in tables.items()
    ]
    return Regression(asked, tuple(results), n_permutations)


def _in_words(table: pd.DataFrame, n_permutations: int) -> pd.DataFrame:
    """A table of results as it is read: each cell a string."""
    least = 1 / (1 + n_permutations)

    def p_in_words(p: float) -> str:
        if not n_permutations:
            return "-"
        return f"<= {least:.2g}" if p <= least else f"{p:.2g}"

    def cell(value: object) -> str:
        if value is None or value is pd.NA or value != value:
            return "-"
        return f"{value:.3g}" if isinstance(value, float) else str(value)

    words = pd.DataFrame({name: [cell(value) for value in table[name]] for name in table})
    return words.assign(p=[p_in_words(p) for p in table["p"]])


def _many_inputs(n_inputs: int, n_permutations: int) -> str:
    if n_inputs < 2 or not n_permutations:
        return ""
    return f"There are {n_inputs} inputs: a p of 0.05 somewhere is to be expected by chance."


def _tables(
    population: Population, asked: Contrast, inputs: Sequence[Input]
) -> dict[Input, np.ndarray]:
    """Each input that the population has, with the features it stands for."""
    together = population.select(asked.rows)
    normalised = together.size_normalised()
    return {
        each: (normalised if each.size_normalised else together).part(each.part)
        for each in inputs
        if _has(together, each.part)
    }


def _has(population: Population, part: str) -> bool:
    return set(part.split("+")) <= {*population.layout.blocks, *NAMED_PARTS, "size"}


class _LeftOut(TypedDict):
    groups: np.ndarray | None
    progress: Progress | None


class _Deals(TypedDict):
    n_permutations: int
    random_state: int


def _steps(asked: Contrast, tables: Sized, progress: Progress | None) -> Progress | None:
    """Make one count of the folds of all tables: the curve's, the pairs nested, the test's."""
    if progress is None:
        return None
    n_folds = len(asked.y) if asked.persons is None else len(set(asked.persons))
    total = len(tables) * (2 * n_folds + comb(n_folds, 2))
    done = count(1)
    return lambda _done, _of_one_loop: progress(next(done), total)
