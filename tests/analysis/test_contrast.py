"""Traits as a classifier is asked to tell them."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from eigenwalker.analysis import trait_contrast
from eigenwalker.population.population import FLAG, Population
from eigenwalker.simulation import simulate_population


@pytest.fixture(scope="module")
def people() -> Population:
    people = simulate_population(4, 4, seed=1)
    traits = people.traits.assign(
        style=["sad", "happy", "angry", "sad", "happy", "", "sad", "happy"],
        group=[0, 1, 0, 1, 0, 1, 0, 1],
        same="x",
        person=["a", "a", "b", "b", "", "", "c", "c"],
        rating=[1.0, 2, np.nan, 4, 5, 6, 7, 8],
        **{FLAG: ["no walk", *[""] * 7]},
    )
    return Population(people.walkers, traits, people.correspondence)


def test_the_second_class_in_sorted_order_is_the_positive_pole(people) -> None:
    sex = trait_contrast(people, "sex")
    assert (sex.negative, sex.positive, sex.two_classes) == ("female", "male", True)
    assert sex.rows.tolist() == [1, 2, 3, 4, 5, 6, 7]  # walker 0 is flagged
    assert sex.y.tolist() == [-1, -1, -1, 1, 1, 1, 1]
    assert sex.labels.tolist() == ["female"] * 3 + ["male"] * 4


def test_two_of_several_values_can_be_chosen_in_either_order(people) -> None:
    mood = trait_contrast(people, "style=sad:happy")
    assert (mood.negative, mood.positive) == ("sad", "happy")
    assert mood.rows.tolist() == [1, 3, 4, 6, 7]
    np.testing.assert_array_equal(trait_contrast(people, "style=happy:sad").y, -mood.y)


def test_numbers_are_continuous_unless_there_are_two(people) -> None:
    weight = trait_contrast(people, "weight")
    assert weight.trait == "weight_kg"
    assert not weight.two_classes
    assert (weight.negative, weight.positive) == ("light", "heavy")
    np.testing.assert_array_equal(weight.labels, people.traits["weight_kg"][1:])
    assert trait_contrast(people, "group").two_classes
    assert trait_contrast(people, "rating").rows.tolist() == [1, 3, 4, 5, 6, 7]


def test_walks_of_one_person_are_known_to_be(people) -> None:
    persons = trait_contrast(people, "sex").persons
    assert persons is not None
    named = pd.Series(persons)
    assert named[[1, 2]].nunique() == 1  # both of b
    assert named[[3, 4]].nunique() == 2  # nobody knows whose


@pytest.mark.parametrize(
    ("trait", "said"),
    [
        ("beauty", r"no trait 'beauty'; the population has \['sex'"),
        ("flag", "no trait 'flag'"),
        ("style", "3 values.*choose two, for instance style=angry:happy"),
        ("style=sad:merry", "'sad:merry' does not name two values of style"),
        ("style=sad", "does not name two values"),
        ("same", "nothing to tell apart"),
    ],
)
def test_what_cannot_be_told_is_refused_with_what_can(people, trait, said) -> None:
    with pytest.raises(ValueError, match=said):
        trait_contrast(people, trait)


def test_traits_and_classes_are_found_in_another_case_and_without_their_unit(people) -> None:
    traits = people.traits.rename(columns={"sex": "Sex", "weight_kg": "Weight [kg]"})
    traits["Step (cm)"], traits["Step (s)"] = range(8), range(8)
    people = Population(people.walkers, traits, people.correspondence)
    with pytest.warns(UserWarning, match="'sex' is taken to be 'Sex'"):
        assert trait_contrast(people, "sex=MALE:female").positive == "female"
    with pytest.warns(UserWarning, match="is taken"):
        weight = trait_contrast(people, "weight")
    assert (weight.trait, weight.positive) == ("Weight [kg]", "heavy")
    assert trait_contrast(people, "Step (s)").trait == "Step (s)"
    with pytest.raises(ValueError, match=r"may be one of .*'Step \(cm\)', 'Step \(s\)'"):
        trait_contrast(people, "step")
    with pytest.raises(ValueError, match="Did you mean 'Weight"):
        trait_contrast(people, "wieght [kg]")
