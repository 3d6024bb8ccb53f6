from __future__ import annotations

import numpy as np
import pytest

import eigenwalker as ew
from eigenwalker.analysis import (
    DiscriminantClassifier,
    DiscriminantRegressor,
    WalkerSpace,
    direction,
    position_in_space,
)

N_MEN = 14
SEX = np.repeat(["female", "male"], [40 - N_MEN, N_MEN])
R = np.where(SEX == "male", 1.0, -1.0)


def population(seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Walkers, and the direction along which men were moved."""
    rng = np.random.default_rng(seed)
    shift = rng.normal(size=50)
    latent = rng.normal(size=(40, 8)) @ rng.normal(size=(8, 50))
    return 50 + latent + 0.2 * rng.normal(size=(40, 50)) + 0.8 * R[:, None] * shift, shift


WALKERS, SHIFT = population()
SPACE = WalkerSpace().fit(WALKERS)
SCORES = SPACE.transform(WALKERS)
SEXES = DiscriminantClassifier(n_components=10).fit(SCORES, SEX)


def sums(walkers: np.ndarray) -> np.ndarray:
    return SEXES.decision_function(SPACE.transform(np.atleast_2d(walkers)))


def class_sums() -> np.ndarray:
    return np.array([sums(WALKERS[sex == SEX]).mean() for sex in ("female", "male")])


@pytest.mark.parametrize("kind", ["discriminant", "mean_difference"])
def test_one_step_is_one_standard_deviation_of_the_walkers(kind):
    step = direction(SPACE, SEXES, kind=kind)
    moved = sums(SPACE.average_walker_ + 6 * step) - sums(SPACE.average_walker_)
    assert moved[0] == pytest.approx(6 * sums(WALKERS).std(ddof=1))


@pytest.mark.parametrize("kind", ["discriminant", "mean_difference"])
def test_a_step_makes_any_walker_more_male_by_as_much(kind):
    step = direction(SPACE, SEXES, kind=kind)
    np.testing.assert_allclose(
        sums(WALKERS + 2 * step) - sums(WALKERS), 2 * SEXES.spread_, rtol=1e-9
    )


@pytest.mark.parametrize("kind", ["discriminant", "mean_difference"])
def test_two_steps_of_class_means_lead_from_one_class_to_the_other(kind):
    step = direction(SPACE, SEXES, kind=kind, units="classmean")
    moved = sums(SPACE.average_walker_ + 2 * step) - sums(SPACE.average_walker_)
    assert moved[0] == pytest.approx(np.diff(class_sums())[0])


def test_raw_units_are_eq_13_as_printed():
    np.testing.assert_allclose(
        direction(SPACE, SEXES, units="raw"), SPACE.eigenwalkers_.T @ SEXES.coef_
    )


def test_sd_units_are_those_of_a12():
    c = SEXES.coef_
    by_hand = (SCORES @ c).std(ddof=1) / (c @ c) * SPACE.eigenwalkers_.T @ c
    np.testing.assert_allclose(direction(SPACE, SEXES), by_hand)


@pytest.mark.parametrize("n_components", [3, 10, 39])
def test_the_pattern_is_the_difference_of_class_means(n_components):
    """A13: proportional for any class sizes, the factor being 2 m_M m_F / (m (m - 1))."""
    sexes = DiscriminantClassifier(n_components).fit(SCORES, SEX)
    kept = sexes.order_[:n_components]
    difference = SCORES[SEX == "male"].mean(axis=0) - SCORES[SEX == "female"].mean(axis=0)
    within_kept = difference[kept] @ SPACE.eigenwalkers_[kept]
    factor = 2 * N_MEN * (40 - N_MEN) / (40 * 39)
    np.testing.assert_allclose(
        direction(SPACE, sexes, kind="mean_difference", units="raw"),
        factor * within_kept,
        atol=1e-9,
    )
    np.testing.assert_allclose(
        direction(SPACE, sexes, kind="mean_difference", units="classmean"),
        within_kept / 2,
        atol=1e-9,
    )


def test_with_all_components_the_pattern_leads_from_the_mean_woman_to_the_mean_man():
    """Moler's (M - F) / 2."""
    sexes = DiscriminantClassifier().fit(SCORES, SEX)
    men, women = (WALKERS[sex == SEX].mean(axis=0) for sex in ("male", "female"))
    step = direction(SPACE, sexes, kind="mean_difference", units="classmean")
    np.testing.assert_allclose(step, (men - women) / 2, atol=1e-9)


def test_a_planted_difference_shows_in_the_pattern_rather_than_in_the_filter():
    def likeness(kind):
        # A large population, so that chance does not blur the means.
        rng = np.random.default_rng(0)
        r = np.where(np.arange(4000) % 2, 1.0, -1.0)
        latent = rng.normal(size=(4000, 8)) @ rng.normal(size=(8, 50))
        walkers = latent + 0.2 * rng.normal(size=(4000, 50)) + 0.8 * r[:, None] * SHIFT
        space = WalkerSpace(scale=None).fit(walkers)
        sexes = DiscriminantClassifier().fit(space.transform(walkers), r)
        step = direction(space, sexes, kind=kind)
        return step @ SHIFT / np.linalg.norm(step) / np.linalg.norm(SHIFT)

    assert likeness("mean_difference") > 0.99
    assert likeness("discriminant") < 0.99


def test_swapping_the_classes_turns_the_direction_round():
    swapped = np.where(SEX == "male", "a man", "b woman")
    others = DiscriminantClassifier(n_components=10).fit(SCORES, swapped)
    assert others.positive_pole_ == "b woman"
    np.testing.assert_allclose(direction(SPACE, others), -direction(SPACE, SEXES), atol=1e-9)


@pytest.mark.parametrize("kind", ["discriminant", "mean_difference"])
def test_a_continuous_trait_has_a_direction_too(kind):
    weight = 70 + WALKERS @ np.linspace(-1, 1, 50)
    heavy = DiscriminantRegressor(n_components=5).fit(SCORES, weight)
    step = direction(SPACE, heavy, kind=kind)
    heavier = heavy.predict(SPACE.transform((SPACE.average_walker_ + 3 * step)[None]))[0]
    assert heavier - weight.mean() == pytest.approx(3 * heavy.predict(SCORES).std(ddof=1))


def test_what_gives_no_direction_is_refused_with_the_reason():
    with pytest.raises(ValueError, match="has 39 eigenwalkers"):
        direction(SPACE, DiscriminantClassifier().fit(SCORES[:, :5], SEX))
    with pytest.raises(ValueError, match="kind='normal' is not known"):
        direction(SPACE, SEXES, kind="normal")
    with pytest.raises(ValueError, match="a continuous trait has none"):
        direction(SPACE, DiscriminantRegressor().fit(SCORES, R), units="classmean")
    with pytest.raises(ValueError, match="same for all walkers"):
        direction(SPACE, DiscriminantRegressor().fit(SCORES, np.ones(40)))


def test_usual_walkers_lie_at_a_distance_of_one():
    distances = [position_in_space(SPACE, walker).distance for walker in WALKERS]
    assert np.sqrt(np.mean(np.square(distances))) == pytest.approx(np.sqrt(39 / 40))


def test_position_counts_standard_deviations_on_each_eigenwalker():
    space = WalkerSpace(n_components=5).fit(WALKERS)
    sd = np.sqrt(space.explained_variance_)
    report = position_in_space(
        space, space.inverse_transform([[3 * sd[0], 0, 0, -4 * sd[3], 0]])[0]
    )
    np.testing.assert_allclose(report.z_scores, [3, 0, 0, -4, 0], atol=1e-9)
    assert report.mahalanobis == pytest.approx(5)
    assert report.outside == pytest.approx(0, abs=1e-12)


def test_a_way_of_differing_that_walkers_never_showed_lies_outside():
    unseen = np.random.default_rng(9).normal(size=50)
    axes = SPACE.eigenwalkers_ / SPACE.scale_
    unseen -= axes.T @ (axes @ unseen)
    assert position_in_space(SPACE, SPACE.average_walker_ + unseen * SPACE.scale_).outside == (
        pytest.approx(1)
    )
    assert position_in_space(SPACE, SPACE.average_walker_).outside == 0


def test_caricatures_grow_less_plausible_with_alpha():
    step = direction(SPACE, SEXES)
    reports = [
        position_in_space(SPACE, SPACE.average_walker_ + alpha * step, walkers=WALKERS)
        for alpha in (0, 2, 6, 12)
    ]
    assert reports[0].percentile == 0
    assert reports[-1].percentile == 100
    assert np.all(np.diff([report.distance for report in reports]) > 0)
    assert np.isnan(position_in_space(SPACE, WALKERS[0]).percentile)


def test_a_vector_of_another_length_is_refused():
    with pytest.raises(ValueError, match="a vector of 50 features"):
        position_in_space(SPACE, np.zeros(49))


def test_other_things_are_refused_by_what_they_are():
    population = ew.load_population()
    space = ew.WalkerSpace().fit(population.X)
    for call, words in (
        (lambda: ew.direction(3, 4), "Expected a fitted WalkerSpace, got"),
        (
            lambda: ew.direction(space, ew.DiscriminantClassifier()),
            "Expected a fitted Disc",
        ),
        (lambda: ew.classify(population, 3), "Expected the name of a trait, got"),
        (lambda: ew.analysis.study_trait(population, "sex"), "Expected what classify or regress"),
    ):
        with pytest.raises(TypeError, match=words):
            call()
