"""The tables of the classification say what they hold, in words and units."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import eigenwalker as ew
from eigenwalker.analysis.classification import INPUTS, classify
from eigenwalker.population.population import Population
from eigenwalker.report.classification_tables import (
    chance_sentence,
    gait_table,
    missed_table,
    multiple_inputs_sentence,
    people_gait_table,
    permutation_sentence,
    person_sentences,
    plausibility_table,
    printed_results,
    results_table,
)


@pytest.fixture(scope="module")
def people() -> Population:
    return ew.simulate_population(6, 6, seed=1)


def test_the_gait_table_has_units_and_no_noise(people) -> None:
    average = people.walker(people.average)
    table = gait_table({"average": average, "again": average})
    rows = {row[0]: row[1] for row in table.rows}
    assert rows["pelvis, vertical range (mm)"] == f"{ew.gait.gait_parameters(average).iloc[-1]:.0f}"
    assert rows["steps a minute"] == f"{120 * average.frequency_hz:.0f}"
    assert not any("_" in str(name) for name in rows)
    assert not any("-0.0" in (row[1], row[2]) or "-0" in (row[1], row[2]) for row in table.rows)


def test_a_body_without_pelvis_has_no_row_for_it(people) -> None:
    average = people.walker(people.average)
    feet = ["left_ankle", "right_ankle"]
    kept = [average.markers.index(name) for name in feet]
    legs = replace(average, markers=tuple(feet), p0=average.p0[kept], p=average.p[:, kept])
    assert not any("pelvis" in str(row[0]) for row in gait_table({"legs": legs}).rows)


@pytest.mark.parametrize(("foot", "bias"), [("heel", "3 and 5 %"), ("toe", "7 and 14 %")])
def test_how_much_too_long_stance_comes_out_is_said_for_the_points_there_are(people, foot, bias):
    walker = people.walkers[0]
    ankles = [walker.markers.index(f"{side}_ankle") for side in ("left", "right")]
    markers = (*walker.markers, f"left_{foot}", f"right_{foot}")
    p0, p = (np.concatenate([a, a[..., ankles, :]], axis=-2) for a in (walker.p0, walker.p))
    footed = replace(walker, markers=markers, p0=p0, p=p)
    contrast = SimpleNamespace(two_classes=False)
    study = SimpleNamespace(result=SimpleNamespace(contrast=contrast), contrast_walkers=[footed])
    assert bias in people_gait_table(study).caption


def test_limbs_of_the_average_are_unchanged_without_a_sign(people) -> None:
    large = people.average.copy()
    lengths = people.layout.columns("p0+p1+p2+p3+p4")
    large[lengths] *= 1.2
    found = {
        "average": ew.analysis.plausibility(people, people.average),
        "small": ew.analysis.plausibility(people, 0.999 * people.average),
        "large": ew.analysis.plausibility(people, large),
    }
    average, small, larger = plausibility_table(found).rows
    assert set(average[2:]) == {"0 %"}
    assert set(small[2:]) == {"0 %"}
    assert set(larger[2:]) == {"+20 %"}


def test_missed_walkers_are_named_with_their_class(people) -> None:
    sex = np.random.default_rng(0).permutation(people.traits["sex"].to_numpy())
    people = replace(people, traits=people.traits.assign(sex=sex))
    found = classify(people, "sex", inputs=INPUTS[:4], n_permutations=0)
    table = missed_table(ew.analysis.study_trait(people, found))
    assert table is not None
    row = int(found.often_misclassified().index[0])
    assert table.rows[0][0] == f"walker {row} ({sex[row]})"
    files = [f"{n}.c3d" if n else "" for n in range(12)]
    named = replace(people, traits=people.traits.assign(file=files))
    assert named.names[:2] == ["walker 0", "1.c3d"]
    assert results_table(ew.analysis.study_trait(people, found)).columns[0] == "input"


def test_the_printed_table_says_where_p_ends_and_what_is_missing() -> None:
    people = ew.simulate_population(12, 12, seed=0, sex_effect=3)
    found = classify(people, "sex", inputs=[INPUTS[2], INPUTS[11]], n_permutations=19)
    words = printed_results(found).set_index("input")
    assert words["p"]["structure (p0)"] == "<= 0.05"
    assert words["separated at n"]["frequency alone"] == "-"
    assert found.table()["p"].min() == 1 / 20
    assert "2 inputs" in multiple_inputs_sentence(found)
    assert "unequal" not in chance_sentence(found)


def test_classes_of_unequal_size_are_mentioned() -> None:
    people = ew.simulate_population(12, 12, seed=0, sex_effect=3).select(np.arange(3, 24))
    found = classify(people, "sex", inputs=INPUTS[9:10], n_permutations=0)
    assert "(female 9, male 12), and the discriminant has no constant" in chance_sentence(found)
    assert printed_results(found)["p"].tolist() == ["-"]
    assert multiple_inputs_sentence(found) == ""


def test_what_p_permutes_and_who_walked_are_said() -> None:
    people = ew.simulate_population(6, 6, seed=0)
    traits = people.traits.assign(
        file=[f"{row}.c3d" for row in range(12)],
        Subject=[row // 2 for row in range(12)],
        foot=["left", "right"] * 6,
    )
    people = ew.Population(people.walkers, traits)
    sex, foot = (
        classify(people, trait, inputs=INPUTS[9:10], n_permutations=9) for trait in ("sex", "foot")
    )
    assert "among persons" in permutation_sentence(sex)
    assert printed_results(sex).columns[3] == "p"
    assert "within each person, as 6 of 6" in permutation_sentence(foot)
    assert printed_results(foot).columns[3] == "p within persons"
    said = " ".join(person_sentences(sex.contrast, traits))
    assert said.startswith("12 walks are of 6 persons, as the trait 'Subject' says")
    unknown = person_sentences(sex.contrast, traits.drop(columns="Subject"))
    assert unknown[0].startswith("No trait is known to say who walked")
