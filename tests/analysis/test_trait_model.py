"""Traits of new walkers, and walks that are far from all known."""

from __future__ import annotations

import numpy as np
import pytest

import eigenwalker as ew
from eigenwalker.analysis import classify_several, trait_model
from eigenwalker.population.population import Population
from eigenwalker.simulation import simulate_population


@pytest.fixture(scope="module")
def people() -> Population:
    people = simulate_population(20, 20, seed=2, sex_effect=2)
    kinds = np.where(people.traits["sex"] == "male", "c", np.tile(["a", "b"], 20))
    return Population(people.walkers, people.traits.assign(kind=kinds), people.correspondence)


@pytest.fixture(scope="module")
def new(people: Population) -> np.ndarray:
    others = simulate_population(10, 10, seed=3, sex_effect=2)
    return np.stack([people.vector(walker) for walker in others.walkers])


def test_new_walkers_are_told_as_those_left_out_are(people, new) -> None:
    model = trait_model(people, "sex")
    truth = ["female"] * 10 + ["male"] * 10
    assert (model.predict(new)["prediction"] == truth).mean() > 0.85
    assert model.error < 0.15
    taller = trait_model(people, "height")
    assert taller.is_number
    assert taller.error < people.traits["height_mm"].std()
    assert np.corrcoef(taller.predict(new)["prediction"], truth == np.array("male"))[0, 1] > 0.3


def test_planted_outliers_are_far_and_ordinary_walks_are_not(people, new) -> None:
    model = trait_model(people, "sex")
    ordinary = model.predict(new)
    assert ordinary["far"].sum() <= 2
    assert (ordinary["far"] == (ordinary["typicality"] <= 0.05)).all()
    frequency, structure = (people.layout.columns(part) for part in ("frequency", "p0"))
    fast, odd = new.copy(), new.copy()
    fast[:, frequency] = people.average[frequency] + 3 * people.X[:, frequency].std()
    odd[:, structure] += 4 * (odd[:, structure] - people.average[structure])
    found = model.predict(fast)
    assert found["far"].all()
    assert (found["far_in"] == "frequency").sum() >= 18
    assert model.predict(odd)["far"].mean() > 0.9
    torn = np.random.default_rng(0).permuted(people.X, axis=0)  # no feature goes with another
    assert model.predict(torn)["far"].mean() > 0.3


def test_few_walkers_call_few_ordinary_walks_far(people, new) -> None:
    few = people.select([0, 1, 2, 3, 20, 21, 22, 23])
    model = trait_model(few, "height")
    vectors = np.stack([few.vector(people.walkers[row]) for row in [*range(5, 19), *range(25, 39)]])
    assert model.predict(vectors)["far"].sum() <= 3
    vectors[:, few.layout.columns("frequency")] += (
        6 * few.X[:, few.layout.columns("frequency")].std()
    )
    assert model.predict(vectors)["far"].mean() > 0.9


def test_several_classes_are_told_as_a_whole(people, new) -> None:
    found = classify_several(people, "kind")
    assert found.classes == ("a", "b", "c")
    assert ew.classify(people, "kind").confusion.equals(found.confusion)
    assert found.confusion.to_numpy().sum() == 40
    assert found.errors == 40 - np.diag(found.confusion).sum()
    assert found.confused.loc[0, ["one", "other"]].tolist() == ["a", "b"]  # nothing tells them
    assert found.table().iloc[-1]["errors"] == found.errors
    assert found.confusion.loc["c", "c"] > 15
    model = trait_model(people, "kind")
    assert model.error == found.error
    predicted = model.predict(new)
    assert (predicted["prediction"][10:] == "c").mean() > 0.8
    assert predicted["probability"].between(1 / 3, 1).all()


def test_persons_are_left_out_whole() -> None:
    """Kinds are chance, so that only somebody's other walks can tell of one: alone, they do."""
    people = simulate_population(8, 8, seed=1, sex_effect=0)
    walks = people.select([*range(16)] * 3)
    traits = walks.traits.assign(subject=[*range(16)] * 3, kind=list("abcd") * 12)
    found = classify_several(Population(walks.walkers, traits, walks.correspondence), "kind")
    alone = Population(walks.walkers, traits.assign(person=""), walks.correspondence)
    assert found.n_folds == 16
    assert classify_several(alone, "kind").error < 0.5 < found.error
