"""Simulated people: drawn as asked, and what was planted in them is found again."""

import numpy as np
import pandas as pd
import pytest

from eigenwalker.analysis import jackknife_curves
from eigenwalker.datasets import load_population
from eigenwalker.decomposition import decompose_pca
from eigenwalker.gait import in_place
from eigenwalker.io import read_mocap
from eigenwalker.markers import virtual_markers
from eigenwalker.simulation import (
    EFFECTS,
    PARAMETERS,
    TRAITS,
    PlantedEffect,
    add_effect,
    draw_people,
    random_effect,
    simulate_captures,
    simulate_population,
    simulate_walk,
    true_direction,
    truth_of,
    write_captures,
)

SHORT = {"duration_s": 6.0}


def cosine(a, b):
    return a @ b / np.linalg.norm(a) / np.linalg.norm(b)


def sexes(people):
    return np.where(people.traits["sex"] == "male", 1, -1)


def mean_difference(people, part="all"):
    features = people.part(part)
    sign = sexes(people)
    return features[sign > 0].mean(axis=0) - features[sign < 0].mean(axis=0)


def test_the_same_seed_draws_the_same_people():
    pd.testing.assert_frame_equal(draw_people(3, 3, seed=5), draw_people(3, 3, seed=5))
    assert not draw_people(3, 3, seed=5).equals(draw_people(3, 3, seed=6))


def test_people_have_the_published_means_and_spreads():
    people = draw_people(4000, 4000, seed=1, effects={})
    for name, parameter in PARAMETERS.items():
        women = people.loc[people["sex"] == "female", name]
        assert women.mean() == pytest.approx(parameter.female, abs=0.08 * parameter.sd)
        assert women.std() == pytest.approx(parameter.sd, rel=0.08)


def test_without_sex_effect_women_and_men_are_drawn_alike():
    people = draw_people(2000, 2000, seed=2, sex_effect=0)
    spread = people[list(PARAMETERS)].std() * np.sqrt(1 / 1000)
    means = people.groupby("sex")[list(PARAMETERS)].mean()
    assert ((means.loc["male"] - means.loc["female"]).abs() < 4.5 * spread).all()


def test_the_sex_effect_scales_all_differences():
    none, one, two = (draw_people(4, 4, seed=2, sex_effect=size) for size in (0, 1, 2))
    names = list(PARAMETERS)
    np.testing.assert_allclose(two[names] - none[names], 2 * (one[names] - none[names]), rtol=0.03)
    assert np.abs(one["shoulder_share"] - none["shoulder_share"]).min() > 0


def test_each_effect_can_be_set_and_turned_off():
    off = draw_people(4, 4, seed=2, effects={})
    only = draw_people(4, 4, seed=2, effects={"happy": {"arm_swing_deg": 0.5}})
    change = only[list(PARAMETERS)] - off[list(PARAMETERS)]
    assert change.columns[(change != 0).any()].tolist() == ["arm_swing_deg"]
    expected = 0.5 * off["happy_score"] * PARAMETERS["arm_swing_deg"].sd
    np.testing.assert_allclose(change["arm_swing_deg"], expected)


def test_effects_of_or_on_something_unknown_are_refused():
    with pytest.raises(ValueError, match="No trait is called"):
        draw_people(1, 1, effects={"anger": {}})
    with pytest.raises(ValueError, match=r"no \['elbows'\]"):
        draw_people(1, 1, effects={"happy": {"elbows": 1}})
    with pytest.raises(ValueError, match="make no group of people"):
        draw_people(0, 0)


@pytest.fixture(scope="module")
def population():
    return simulate_population(6, 6, seed=3, **SHORT)


def test_a_population_has_its_traits_and_no_flags(population):
    assert set(TRAITS) <= set(population.traits)
    assert population.X.shape == (12, 229)
    assert not population.flagged.any()


def test_the_truth_travels_with_the_population(population, tmp_path):
    population.save(tmp_path / "people.nc")
    some = load_population(tmp_path / "people.nc").select([7, 2])
    truth = truth_of(some)
    drawn = draw_people(6, 6, seed=3)
    pd.testing.assert_frame_equal(truth.people, drawn.iloc[[7, 2]].reset_index(drop=True))
    assert truth.effects.loc["obliquity_factor", "sex"] == EFFECTS["sex"]["obliquity_factor"]


def test_the_capture_of_each_walker_can_be_made_again_with_its_truth(population, tmp_path):
    population.save(tmp_path / "people.nc")
    some = load_population(tmp_path / "people.nc").select([9, 4])
    truth = truth_of(some)
    walks = [
        simulate_walk(dict(person), seed=seed, **truth.capture)
        for (_, person), seed in zip(truth.people.iterrows(), truth.seeds, strict=True)
    ]
    again = [decompose_pca(in_place(virtual_markers(walk))) for walk in walks]
    for walker, walk, same in zip(some.walkers, walks, again, strict=True):
        assert some.vector(same) == pytest.approx(some.vector(walker), abs=1e-6)
        assert walk.attrs["noise_mm"] == truth.capture["noise_mm"] == 1.0
        assert walk["left_knee_flexion_deg"].max() > 40


def test_nobody_knows_the_truth_of_real_people(population):
    from dataclasses import replace

    with pytest.raises(ValueError, match="not simulated"):
        truth_of(replace(population, provenance={}))


def test_parallel_work_gives_the_same_population(monkeypatch, population):
    from eigenwalker.simulation import people

    monkeypatch.setattr(people, "_PER_TASK", 6)
    again = simulate_population(6, 6, seed=3, n_jobs=2, **SHORT)
    np.testing.assert_allclose(again.X, population.X, atol=1e-9)


@pytest.fixture(scope="module")
def nobody_differs():
    return {"n_women": 12, "n_men": 12, "seed": 4, "sex_effect": 0, "effects": {}, **SHORT}


@pytest.mark.parametrize(("part", "other"), [("structure", "dynamics"), ("dynamics", "structure")])
def test_an_effect_planted_in_one_part_is_invisible_to_the_other(nobody_differs, part, other):
    plain = simulate_population(**nobody_differs)
    effect = random_effect(part, size_mm=8, seed=1)
    planted = simulate_population(planted={"sex": effect}, **nobody_differs)
    spread = plain.part(other).std(axis=0)
    seen = np.abs(planted.part(other) - plain.part(other))
    assert np.median(seen[:, spread > 0.1] / spread[spread > 0.1]) < 0.02
    changed = mean_difference(planted, part) - mean_difference(plain, part)
    assert np.abs(changed).max() > 4


def test_a_planted_effect_is_found_by_the_mean_difference():
    effect = random_effect("structure", size_mm=15, seed=2)
    people = simulate_population(
        30, 30, seed=6, sex_effect=0, effects={}, planted={"sex": effect}, **SHORT
    )
    expected = effect.structure - effect.structure[8] * [1, 1, 0]  # in place: from the pelvis
    found = mean_difference(people, "p0").reshape(15, 3)
    assert cosine(found.ravel(), expected.ravel()) > 0.9
    assert truth_of(people).planted["sex"].structure == pytest.approx(effect.structure)


def test_the_true_direction_is_found_by_the_mean_difference():
    people = simulate_population(40, 40, seed=7, **SHORT)
    spread = people.X.std(axis=0)
    told = spread > 0.02  # the pelvis is over the origin by construction
    truth = true_direction(people, "sex", n_people=6)[told] / spread[told]
    assert cosine(mean_difference(people)[told] / spread[told], truth) > 0.8


def test_the_jackknife_is_at_chance_when_nothing_was_planted():
    people = simulate_population(20, 20, seed=9, sex_effect=0, effects={}, **SHORT)
    curves = jackknife_curves(people.X, sexes(people))
    assert 0.3 < np.mean(curves.generalisation[:15]) / 40 < 0.7


def test_the_sexes_differ_as_the_papers_say():
    women, men = draw_people(300, 0, seed=1), draw_people(0, 300, seed=1)
    difference = men[list(PARAMETERS)].mean() - women[list(PARAMETERS)].mean()
    assert difference["shoulder_share"] > 0 > difference["hip_share"]
    assert difference["arm_out_deg"] > 0  # J32: elbows further out
    assert difference["trunk_lean_factor"] > 0  # J32: more lateral sway of the upper body
    assert abs(difference["frequency_hz"]) < 0.02  # J26


def test_planted_effects_are_of_the_fifteen_joints():
    with pytest.raises(ValueError, match="structure of shape"):
        PlantedEffect(structure=np.zeros((3, 3)))
    with pytest.raises(ValueError, match="of the 15 joints"):
        add_effect(simulate_walk(markers="skin", duration_s=2), PlantedEffect(), 1.0)
    with pytest.raises(ValueError, match="part='p0' is not known"):
        random_effect("p0", size_mm=1)


@pytest.mark.parametrize("format", ["c3d", "trc", "csv"])
def test_captures_are_written_with_a_table_and_read_again(tmp_path, format):
    captures = {"n_women": 1, "n_men": 1, "seed": 2, "markers": "skin", "duration_s": 3}
    made = simulate_captures(gap_share=0.02, **captures)
    table = write_captures(made, tmp_path / "new", format=format)
    traits = pd.read_csv(table)
    assert list(traits) == ["file", *TRAITS]
    expected, _ = next(simulate_captures(gap_share=0.02, **captures))
    read = read_mocap(table.parent / traits["file"][0])
    assert read.marker.values.tolist() == expected.marker.values.tolist()
    np.testing.assert_allclose(read.values, expected.values, atol=1e-3)
    with pytest.raises(ValueError, match="format='mot' is not known"):
        write_captures([], tmp_path, format="mot")
