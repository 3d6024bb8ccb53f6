from __future__ import annotations

import numpy as np
import pytest

from eigenwalker.jackknife import jackknife_curves
from eigenwalker.validation import nested_leave_one_out, permutation_test


def population(n_walkers=14, n_features=30, effect=0.5, seed=0):
    rng = np.random.default_rng(seed)
    r = np.where(np.arange(n_walkers) % 2, 1.0, -1.0)
    walkers = rng.normal(size=(n_walkers, n_features))
    return walkers + effect * r[:, None] * rng.normal(size=n_features), r


@pytest.mark.parametrize("shape", [(14, 30), (24, 6)])
def test_the_number_of_components_is_that_of_a_jackknife_of_the_others(shape):
    X, r = population(*shape)
    nested = nested_leave_one_out(X, r)
    sums = jackknife_curves(X, r).held_out
    for walker in range(len(X)):
        inner = jackknife_curves(np.delete(X, walker, axis=0), np.delete(r, walker))
        assert nested.chosen_n[walker] == inner.best_n
        assert nested.missed[walker] == (r[walker] * sums[walker, inner.best_n - 1] <= 0)
    assert nested.errors == nested.missed.sum()


def test_persons_are_nested_with_all_their_trials():
    X, r = population(20, 30)
    person = np.repeat(np.arange(5), 4)
    nested = nested_leave_one_out(X, r, groups=person)
    for each in range(5):
        others = person != each
        inner = jackknife_curves(X[others], r[others], groups=person[others])
        assert (nested.chosen_n[~others] == inner.best_n).all()


def test_twins_are_nested_too():
    X, r = population()
    X[3] = X[1]
    assert (nested_leave_one_out(X, r).chosen_n >= 1).all()


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


@pytest.mark.parametrize("shape", [(14, 30), (24, 6)])
def test_each_deal_is_a_jackknife_of_its_own(shape):
    X, r = population(*shape)
    test = permutation_test(X, r, n_permutations=5, seed=3)
    deals = np.random.default_rng(3).permuted(np.tile(r[:, None], 5), axis=0)
    assert test.fewest_errors == jackknife_curves(X, r).fewest_errors
    assert test.null.tolist() == [jackknife_curves(X, deal).fewest_errors for deal in deals.T]


def test_a_planted_sex_is_no_accident_and_no_sex_is():
    assert permutation_test(*population(20, 40, effect=3), n_permutations=99).p < 0.03
    p = [permutation_test(*population(16, 20, 0, seed), n_permutations=49).p for seed in range(20)]
    assert 0.3 < np.mean(p) < 0.8


def test_a_seed_fixes_the_deals():
    X, r = population()
    one, same, other = (permutation_test(X, r, n_permutations=50, seed=s) for s in (1, 1, 2))
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
