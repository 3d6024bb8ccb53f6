from __future__ import annotations

import numpy as np
import pytest

from eigenwalker.analysis import (
    jackknife_curves,
    nested_leave_one_out,
    permutation_test,
    regression_curves,
)


def population(n_walkers=14, n_features=30, effect=0.5, seed=0):
    rng = np.random.default_rng(seed)
    r = np.where(np.arange(n_walkers) % 2, 1.0, -1.0)
    walkers = rng.normal(size=(n_walkers, n_features))
    return walkers + effect * r[:, None] * rng.normal(size=n_features), r


def heavy_population(n_walkers=14, n_features=30, effect=1.0, seed=0):
    """Walkers, and a weight in kg that goes with their first three features, or with none."""
    rng = np.random.default_rng(seed)
    walkers = rng.normal(size=(n_walkers, n_features))
    told = 10 * effect * walkers[:, :3].sum(axis=1)
    return walkers, 70 + told + rng.normal(0, 5, n_walkers)


UNLIKE = np.repeat(np.arange(6), [1, 5, 2, 4, 3, 5])
"""Persons of unlike many walks, so that folds have unlike many components."""


@pytest.mark.parametrize("shape", [(14, 30), (24, 6)])
def test_the_number_of_components_is_that_of_a_jackknife_of_the_others(shape):
    X, r = population(*shape)
    nested = nested_leave_one_out(X, r)
    sums = jackknife_curves(X, r).held_out
    for walker in range(len(X)):
        inner = jackknife_curves(np.delete(X, walker, axis=0), np.delete(r, walker))
        assert nested.chosen_n[walker] == inner.best_n
        assert nested.misclassified[walker] == (r[walker] * sums[walker, inner.best_n - 1] <= 0)
    assert nested.errors == nested.misclassified.sum()


def test_persons_are_nested_with_all_their_trials():
    X, r = population(20, 30)
    person = np.repeat(np.arange(5), 4)
    nested = nested_leave_one_out(X, r, groups=person)
    for each in range(5):
        others = person != each
        inner = jackknife_curves(X[others], r[others], groups=person[others])
        assert (nested.chosen_n[~others] == inner.best_n).all()


@pytest.mark.parametrize("n_features", [5, 30])
def test_persons_of_unlike_many_trials_choose_as_a_jackknife_of_the_others(n_features):
    X, r = population(20, n_features, effect=0.3)
    weight = 70 + 5 * X[:, 0] + X[:, 1] ** 2
    chosen_of_sex = nested_leave_one_out(X, r, groups=UNLIKE).chosen_n
    chosen_of_weight = nested_leave_one_out(X, weight, groups=UNLIKE).chosen_n
    for each in range(6):
        others = each != UNLIKE
        sex = jackknife_curves(X[others], r[others], groups=UNLIKE[others])
        assert (chosen_of_sex[~others] == sex.best_n).all()
        told = regression_curves(X[others], weight[others], groups=UNLIKE[others])
        assert (chosen_of_weight[~others] == told.best_n).all()


@pytest.mark.parametrize("order", ["standardised", "variance"])
@pytest.mark.parametrize("shape", [(14, 30), (24, 6)])
def test_a_weight_is_nested_as_by_a_jackknife_of_the_others(shape, order):
    X, weight = heavy_population(*shape)
    nested = nested_leave_one_out(X, weight, order=order)
    predicted = regression_curves(X, weight, order=order).held_out
    for walker in range(len(X)):
        others = np.arange(len(X)) != walker
        inner = regression_curves(X[others], weight[others], order=order)
        assert nested.chosen_n[walker] == inner.best_n
        expected = predicted[walker, inner.best_n - 1]
        assert nested.held_out[walker] == pytest.approx(expected, rel=1e-9)
    errors = nested.held_out - weight
    assert nested.rmse == pytest.approx(np.sqrt(np.mean(errors**2)))
    assert nested.r2 == pytest.approx(1 - np.mean(errors**2) / np.var(weight))
    assert nested.correlation == pytest.approx(np.corrcoef(nested.held_out, weight)[0, 1])


def test_a_planted_weight_survives_nesting_and_chance_is_told_no_better_than_by_its_mean():
    assert nested_leave_one_out(*heavy_population(30, 6, effect=2)).r2 > 0.8
    chance = [nested_leave_one_out(*heavy_population(20, 40, 0, seed)) for seed in range(12)]
    assert np.mean([each.r2 for each in chance]) < 0
    assert abs(np.mean([each.correlation for each in chance])) < 0.25


def test_the_best_of_a_regression_curve_flatters_where_nesting_does_not():
    chance = [heavy_population(20, 40, effect=0, seed=seed) for seed in range(12)]
    best = np.mean([regression_curves(*each).r2.max() for each in chance])
    nested = np.mean([nested_leave_one_out(*each).r2 for each in chance])
    assert best > nested + 0.1


def test_twins_are_nested_too():
    X, r = population()
    X[3] = X[1]
    assert (nested_leave_one_out(X, r).chosen_n >= 1).all()
    assert np.isfinite(nested_leave_one_out(X, X[:, 0]).held_out).all()


def test_a_planted_sex_survives_nesting_and_chance_is_no_better_than_chance():
    assert nested_leave_one_out(*population(20, 40, effect=3)).errors == 0
    shares = [nested_leave_one_out(*population(20, 40, 0, seed)).errors / 20 for seed in range(12)]
    assert 0.4 < np.mean(shares) < 0.65


def test_the_best_of_a_curve_flatters_where_nesting_does_not():
    chance = [population(20, 40, effect=0, seed=seed) for seed in range(12)]
    best = np.mean([jackknife_curves(*each).fewest_errors for each in chance])
    nested = np.mean([nested_leave_one_out(*each).errors for each in chance])
    assert best < nested - 2


def test_progress_is_told_pair_by_pair():
    told = []
    nested_leave_one_out(*population(), progress=lambda done, total: told.append((done, total)))
    assert told[-1] == (91, 91)
    nested_leave_one_out(
        *heavy_population(), progress=lambda done, total: told.append((done, total))
    )
    assert told[91:] == told[:91]


@pytest.mark.parametrize("shape", [(14, 30), (24, 6)])
def test_each_deal_is_a_jackknife_of_its_own(shape):
    X, r = population(*shape)
    test = permutation_test(X, r, n_permutations=5, random_state=3)
    deals = np.random.default_rng(3).permuted(np.tile(r[:, None], 5), axis=0)
    assert test.least_error == jackknife_curves(X, r).fewest_errors
    assert test.null.tolist() == [jackknife_curves(X, deal).fewest_errors for deal in deals.T]


@pytest.mark.parametrize("shape", [(14, 30), (24, 6)])
def test_each_deal_of_weights_is_a_jackknife_of_its_own(shape):
    X, weight = heavy_population(*shape)
    test = permutation_test(X, weight, n_permutations=5, random_state=3)
    deals = np.random.default_rng(3).permuted(np.tile(weight[:, None], 5), axis=0)
    least = [regression_curves(X, deal).rmse.min() for deal in (weight, *deals.T)]
    np.testing.assert_allclose([test.least_error, *test.null], least / weight.std(), rtol=1e-9)


def test_weights_are_dealt_to_persons_whole():
    """Persons of unlike many walks change the spread of a deal, so errors are in its SDs."""
    X, _ = heavy_population(20, 30)
    of_person = np.array([50.0, 60, 70, 80, 95, 120])
    weight = of_person[UNLIKE]
    test = permutation_test(X, weight, groups=UNLIKE, n_permutations=4, random_state=3)
    deals = np.random.default_rng(3).permuted(np.tile(of_person[:, None], 4), axis=0)[UNLIKE]
    least = [
        np.sqrt(1 - regression_curves(X, deal, groups=UNLIKE).r2.max())
        for deal in (weight, *deals.T)
    ]
    np.testing.assert_allclose([test.least_error, *test.null], least, rtol=1e-9)


def test_a_planted_weight_is_no_accident_and_no_weight_is():
    planted = heavy_population(30, 6, effect=2)
    assert permutation_test(*planted, n_permutations=99).p == 0.01
    p = [
        permutation_test(*heavy_population(14, 20, 0, seed), n_permutations=49).p
        for seed in range(40)
    ]
    assert 0.35 < np.mean(p) < 0.65
    assert np.mean(np.array(p) <= 0.1) < 0.25


def test_a_deal_that_changes_nothing_counts_as_good_as_the_truth():
    X, weight = heavy_population(4, 6)
    test = permutation_test(X, weight, n_permutations=200)
    deals = np.random.default_rng(0).permuted(np.tile(weight[:, None], 200), axis=0)
    same = (deals == weight[:, None]).all(axis=0)
    assert same.any()
    np.testing.assert_allclose(test.null[same], test.least_error, rtol=1e-9)
    assert test.p >= (1 + same.sum()) / 201


def test_a_planted_sex_is_no_accident_and_no_sex_is():
    assert permutation_test(*population(20, 40, effect=3), n_permutations=99).p < 0.03
    p = [permutation_test(*population(16, 20, 0, seed), n_permutations=49).p for seed in range(20)]
    assert 0.3 < np.mean(p) < 0.8


def test_a_seed_fixes_the_deals():
    X, r = population()
    deals = [permutation_test(X, r, n_permutations=50, random_state=each) for each in (1, 1, 2)]
    one, same, other = deals
    assert one.null.tolist() == same.null.tolist() != other.null.tolist()


def test_people_keep_one_class_where_they_had_one():
    """Trials of one person are alike, so dealing to trials would make anything significant."""
    rng = np.random.default_rng(0)
    person = np.repeat(np.arange(10), 6)
    walkers = 3 * rng.normal(size=(10, 20))[person] + 0.1 * rng.normal(size=(60, 20))
    sex = np.where(person % 2, 1, -1)
    by_person = permutation_test(walkers, sex, groups=person, n_permutations=99)
    assert by_person.p > 0.05


def test_people_keep_their_share_of_classes_where_they_had_both():
    X, r = population(20, 40, effect=3)
    person = np.repeat(np.arange(5), 4)
    assert permutation_test(X, r, groups=person, n_permutations=99).p < 0.05


def test_pairs_need_four_walkers():
    X, r = population()
    with pytest.raises(ValueError, match="needs 4 walkers"):
        nested_leave_one_out(X[:3], r[:3])
    with pytest.raises(ValueError, match="needs 4 walkers"):
        nested_leave_one_out(X[:3], X[:3, 0])


def test_a_weight_that_is_the_same_for_all_is_refused():
    X, _ = heavy_population()
    for validate in (nested_leave_one_out, permutation_test):
        with pytest.raises(ValueError, match="The trait is 70 for all 14 walkers"):
            validate(X, np.full(14, 70.0))


def test_the_class_that_is_lost_with_a_group_is_named():
    X, _ = population(8)
    with pytest.raises(ValueError, match="Without A no walker of the class m is left"):
        nested_leave_one_out(X, list("fmmfffff"), groups=list("AAABCDEF"))


def test_a_number_of_permutations_below_zero_is_refused():
    y = np.repeat([-1, 1], 4)
    X = np.random.default_rng(0).normal(size=(8, 2))
    with pytest.raises(ValueError, match="n_permutations=-3"):
        permutation_test(X, y, n_permutations=-3)
