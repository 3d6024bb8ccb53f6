"""The main table: what can be told from which part of the walkers."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from eigenwalker.analysis import (
    INPUTS,
    N_PANELS,
    classify,
    jackknife_curves,
    nested_leave_one_out,
    permutation_test,
    regress,
)
from eigenwalker.datasets import load_population
from eigenwalker.population import Population
from eigenwalker.simulation import simulate_population


@cache
def people_alike() -> Population:
    return simulate_population(12, 12, seed=0, sex_effect=0)


def planted(part: str, shift: float) -> Population:
    """Walkers alike but for noise, men shifted in one part of the features."""
    people = people_alike()
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


def test_only_panels_of_the_figure_count_among_the_inputs_that_miss_a_walker() -> None:
    inputs = [INPUTS[2], *INPUTS[N_PANELS:]]  # as where walkers have one harmonic, some are missing
    found = classify(planted("all", 0.0), "sex", inputs=inputs, n_permutations=0)
    assert (
        found.often_misclassified(least=1).tolist() == [1] * found.results[0].curves.fewest_errors
    )


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
    missed = found.often_misclassified(least=1)
    assert missed.is_monotonic_decreasing


def test_a_trait_that_is_a_number_is_regressed() -> None:
    people = load_population()
    table = regress(people, "height", inputs=(INPUTS[0], INPUTS[-1])).table().set_index("input")
    assert table["correlation"]["everything, with size"] > 0.8
    assert table["correlation"]["frequency alone"] < 0.8
    assert table["nested correlation"]["everything, with size"] > 0.8
    assert table["p"]["everything, with size"] < 0.01
    with pytest.raises(ValueError, match="height_mm is a number"):
        classify(people, "height")


def test_a_weight_that_no_walk_shows_is_not_told() -> None:
    people = simulate_population(10, 10, seed=1)
    dealt = np.random.default_rng(3).normal(70, 10, 20)
    people = replace(people, traits=people.traits.assign(weight_kg=dealt))
    found = regress(people, "weight", n_permutations=40, random_state=1)
    table = found.table()
    assert table["p"].median() > 0.1
    assert table["nested R2"].mean() < table["R2"].mean() < 0
    for result, row in zip(found.results, table.to_dict("records"), strict=True):
        source = people.size_normalised() if result.input.size_normalised else people
        X = source.part(result.input.part)
        assert row["nested RMSE"] == nested_leave_one_out(X, dealt).rmse
        null = permutation_test(X, dealt, n_permutations=40, random_state=1)
        assert row["p"] == null.p
    fewer = regress(people, "weight", n_permutations=0).table()
    assert (fewer["p"] == 1).all()


@pytest.mark.parametrize("trait", ["sex", "height"])
@pytest.mark.parametrize("of_persons", [False, True])
def test_progress_goes_on_within_an_input_and_ends_at_all(trait: str, of_persons: bool) -> None:
    people = simulate_population(6, 6, seed=0)
    if of_persons:
        person = [str(row // 2) for row in range(12)]
        people = replace(people, traits=people.traits.assign(person=person))
    tell = classify if trait == "sex" else regress
    told: list[tuple[int, int]] = []
    tell(
        people,
        trait,
        inputs=INPUTS[2:4],
        n_permutations=3,
        progress=lambda done, total: told.append((done, total)),
    )
    n = 6 if of_persons else 12
    total = 2 * (2 * n + n * (n - 1) // 2)
    assert told == [(done, total) for done in range(1, total + 1)]
