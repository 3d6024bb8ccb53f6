"""Whose walk each one is."""

from __future__ import annotations

import pandas as pd
import pytest

from eigenwalker.population import Population
from eigenwalker.population.persons import columns_like_persons, person_column
from eigenwalker.simulation import simulate_population


@pytest.mark.parametrize(
    "heading",
    [
        "Person",
        "subject",
        "SubjectID",
        "Subject No.",
        "PARTICIPANT",
        "Proband",
        "vp_nr",
        "patients",
    ],
)
def test_headings_that_name_persons_are_known(heading: str) -> None:
    assert person_column(pd.DataFrame({"sex": ["f", "m"], heading: ["a", "b"]})) == heading


@pytest.mark.parametrize("heading", ["subject_age", "person_height_mm", "trial", "file id", "name"])
def test_headings_that_name_something_else_are_not(heading: str) -> None:
    assert person_column(pd.DataFrame({heading: ["a", "a"]})) is None


def test_a_number_is_a_persons_where_it_repeats() -> None:
    assert person_column(pd.DataFrame({"ID": [1, 1, 2]})) == "ID"
    assert person_column(pd.DataFrame({"ID": [1, 2, 3]})) is None
    assert person_column(pd.DataFrame({"subject": [1, 2, 3], "ID": [1, 1, 2]})) == "ID"
    assert person_column(pd.DataFrame({"ID": [1, 1, 2], "Subject": [1, 1, 2]})) == "Subject"


def test_values_that_repeat_as_persons_do_are_asked_about() -> None:
    who = [f"k{number // 3}" for number in range(30)]
    sex = ["f" if number // 3 % 2 else "m" for number in range(30)]
    traits = pd.DataFrame({"code": who, "sex": sex, "style": ["a", "b", "c"] * 10})
    assert columns_like_persons(traits) == ["code"]


def test_persons_can_be_decided() -> None:
    people = simulate_population(2, 1, seed=1)
    people = Population(people.walkers, people.traits.assign(ID=[7, 7, None], who=["a", "b", "b"]))
    assert people.persons is not None
    assert people.persons.tolist() == ["7", "7", ""]
    chosen = people.with_persons("who").persons
    assert chosen is not None
    assert chosen.tolist() == ["a", "b", "b"]
    for none in (None, "none"):
        nobody = people.with_persons(none).persons
        assert nobody is not None
        assert not any(nobody)
    with pytest.raises(ValueError, match=r"no column 'whom' to name persons; .*'who'"):
        people.with_persons("whom")
