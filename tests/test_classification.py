"""The main table: what can be told from which part of the walkers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from eigenwalker.classification import INPUTS, N_PANELS, classify, regress
from eigenwalker.jackknife import jackknife_curves
from eigenwalker.population import Population
from eigenwalker.simulation import simulate_population


def planted(part: str, shift: float, seed: int = 0) -> Population:
    """Walkers alike but for noise, men shifted in one part of the features."""
    people = simulate_population(12, 12, seed=seed, sex_effect=0)
    columns = people.layout.columns(part)
    X = people.X.copy()
    men = (people.traits["sex"] == "male").to_numpy()
    X[np.ix_(men, columns)] += shift * X[:, columns].std(axis=0)
    walkers = [people.walker(vector) for vector in X]
    return replace(people, walkers=walkers)


def test_inputs_are_those_of_figure_4_and_of_the_text() -> None:
    assert [each.part for each in INPUTS[:N_PANELS]] == [
        "all", "all", "structure", "dynamics", "p1", "p2", "p3", "p4", "p1+p2+p3"
    ]  # fmt: skip
    assert not INPUTS[0].size_normalised
    assert all(each.size_normalised for each in INPUTS[1:N_PANELS])


def test_an_effect_in_the_structure_is_told_from_it_alone() -> None:
    found = classify(planted("structure", 2.0), "sex", n_permutations=50)
    errors = found.table().set_index("input")["errors"]
    assert errors["structure (p0)"] <= 2
    assert errors[["dynamics", "first eigenposture", "phases alone"]].min() >= 4
    assert found.table().set_index("input")["p"]["structure (p0)"] < 0.05


def test_an_effect_in_the_dynamics_is_told_from_them_alone() -> None:
    errors = classify(planted("dynamics", 2.0), "sex", n_permutations=20).table().set_index("input")
    assert errors["errors"]["dynamics"] <= 2
    assert errors["errors"]["structure (p0)"] >= 4


def test_the_table_says_what_the_curves_say() -> None:
    people = planted("all", 1.0)
    found = classify(people, "sex", n_permutations=20)
    y = np.where(people.traits["sex"] == "male", 1, -1)
    for result, row in zip(found.results, found.table().itertuples(), strict=True):
        source = people.size_normalised() if result.input.size_normalised else people
        curves = jackknife_curves(source.part(result.input.part), y)
        np.testing.assert_array_equal(result.curves.generalisation, curves.generalisation)
        assert row.errors == curves.generalisation.min()
        assert curves.generalisation[row[3] - 1] == row.errors
    missed = found.often_missed(least=1)
    assert missed.is_monotonic_decreasing


def test_a_trait_that_is_a_number_is_regressed() -> None:
    people = simulate_population(20, 20, seed=2)
    table = regress(people, "height").table().set_index("input")
    assert table["correlation"]["everything, with size"] > 0.8
    assert table["correlation"]["frequency alone"] < 0.8
    with pytest.raises(ValueError, match="height_mm is a number"):
        classify(people, "height")
