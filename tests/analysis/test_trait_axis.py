"""Axes of traits: they lead where they say, by as much as they say."""

from __future__ import annotations

import numpy as np
import pytest

from eigenwalker.analysis import trait_axis
from eigenwalker.analysis.plausibility import LIMBS, plausibility
from eigenwalker.datasets import load_population
from eigenwalker.population import Population


@pytest.fixture(scope="module")
def people() -> Population:
    return load_population()


@pytest.mark.parametrize("kind", ["discriminant", "mean_difference"])
@pytest.mark.parametrize("part", ["all", "structure", "dynamics", "p1+p2"])
@pytest.mark.parametrize("trait", ["sex", "weight"])
def test_one_step_is_one_standard_deviation_of_the_walkers(people, kind, part, trait) -> None:
    axis = trait_axis(people, trait, kind=kind, part=part)
    columns = people.layout.columns(part)

    def told(walkers: np.ndarray) -> np.ndarray:
        return axis.space.transform(walkers[:, columns]) @ axis.discriminant.coef_

    spread = told(people.X).std(ddof=1)
    start = people.X[:1]
    assert told(start + axis.step) - told(start) == pytest.approx(spread)
    elsewhere = np.setdiff1d(np.arange(people.X.shape[1]), columns)
    assert not axis.step[elsewhere].any()


def test_the_positive_pole_is_where_the_heavy_and_the_men_are(people) -> None:
    for trait, values in (
        ("sex", people.traits["sex"] == "male"),
        ("weight", people.traits["weight_kg"]),
    ):
        axis = trait_axis(people, trait)
        told = axis.space.transform(people.X) @ axis.discriminant.coef_
        assert np.corrcoef(told, values.astype(float))[0, 1] > 0.5


def test_any_walker_can_be_made_more_male(people) -> None:
    axis = trait_axis(people, "sex")
    for vector in (people.average, people.X[0], people.X[-1]):
        walker = people.walker(vector + 6 * axis.step)
        assert np.isfinite(walker.trajectories(np.linspace(0, 2, 50)).values).all()


def test_average_is_plausible_and_caricatures_less_and_less(people) -> None:
    axis = trait_axis(people, "sex", kind="mean_difference")
    reports = [plausibility(people, people.average + a * axis.step) for a in (0, 2, 4, 8)]
    assert list(reports[0].limb_change.index) == list(LIMBS)
    np.testing.assert_allclose(reports[0].limb_change, 0, atol=1e-12)
    assert np.all(np.diff([report.position.distance for report in reports]) > 0)
    # Men are taller: every limb grows with the step.
    assert np.all(np.diff([report.limb_change.mean() for report in reports]) > 0)
    assert reports[0].limb_stretch.max() < 0.1


def test_positions_count_standard_deviations_along_the_axis(people) -> None:
    axis = trait_axis(people, "sex")
    positions = axis.positions(people.X)
    assert positions.std(ddof=1) == pytest.approx(1)
    assert positions.mean() == pytest.approx(0, abs=1e-9)
    further = axis.positions(people.X + 2.5 * axis.step)
    np.testing.assert_allclose(further - positions, 2.5)
