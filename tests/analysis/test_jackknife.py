from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from sklearn.model_selection import LeaveOneGroupOut, LeaveOneOut, cross_val_predict
from sklearn.pipeline import make_pipeline

from eigenwalker.analysis import (
    DiscriminantClassifier,
    DiscriminantRegressor,
    WalkerSpace,
    jackknife_curves,
    nested_leave_one_out,
    regression_curves,
)


def population(n_walkers=20, n_features=50, effect=0.5, seed=0):
    """Correlated walkers of whom every other is a man, in features of unlike size."""
    rng = np.random.default_rng(seed)
    r = np.where(np.arange(n_walkers) % 2, 1.0, -1.0)
    mixing = np.eye(n_features) + 0.5 / np.sqrt(n_features) * rng.normal(size=(n_features,) * 2)
    walkers = rng.normal(size=(n_walkers, n_features)) @ mixing
    walkers += effect * r[:, None] * rng.normal(size=n_features)
    return walkers * 10.0 ** rng.integers(-2, 3, n_features) + 50, r


def naive_sums(kept, r_kept, left_out, order="standardised", scale="sd"):
    """Eq. 9 to 11 as one would write them down: sums over 1, 2, ... components."""
    mean = kept.mean(axis=0)
    u = kept.std(axis=0, ddof=1) if scale == "sd" else np.ones_like(mean)
    u[np.ptp(kept, axis=0) == 0] = np.inf
    standardised = (kept - mean) / u
    standardised -= standardised.mean(axis=0)
    _, _, axes = np.linalg.svd(standardised, full_matrices=False)
    axes = axes[: np.linalg.matrix_rank(standardised)]
    K = standardised @ axes.T
    c = np.linalg.lstsq(K, r_kept, rcond=None)[0]
    sd = K.std(axis=0, ddof=1)
    weight = {"standardised": np.abs(c) * sd, "raw": np.abs(c), "variance": sd}[order]
    ranked = np.argsort(-weight, kind="stable")
    k = ((left_out - mean) / u) @ axes.T
    return np.cumsum((c * k)[..., ranked], axis=-1)


def naive_held_out(X, r, **how):
    sums = [
        naive_sums(np.delete(X, j, axis=0), np.delete(r, j), X[j], **how) for j in range(len(X))
    ]
    n_most = max(len(row) for row in sums)
    return np.array([np.pad(row, (0, n_most - len(row)), mode="edge") for row in sums])


@pytest.mark.parametrize("order", ["standardised", "raw", "variance"])
@pytest.mark.parametrize("shape", [(20, 50), (60, 25), (200, 9)])
def test_the_fast_way_equals_the_naive_way(shape, order):
    X, r = population(*shape)
    curves = jackknife_curves(X, r, order=order)
    np.testing.assert_allclose(curves.held_out, naive_held_out(X, r, order=order), atol=1e-8)
    trained = naive_sums(X, r, X, order)[:, : len(curves.n_components)]
    np.testing.assert_allclose(curves.trained, trained, atol=1e-8)


@pytest.mark.parametrize("n_walkers", [25, 26, 27, 28])
def test_with_as_many_walkers_as_features_it_still_does(n_walkers):
    X, r = population(n_walkers, 26, seed=n_walkers)
    naive = naive_held_out(X, r)
    held_out = jackknife_curves(X, r).held_out
    np.testing.assert_allclose(held_out, naive, atol=1e-8 * max(1, np.abs(naive).max()))


@pytest.mark.parametrize("shape", [(20, 50), (60, 25)])
def test_without_standardising_it_does_too(shape):
    X, r = population(*shape)
    X = (X - 50) / X.std(axis=0)
    curves = jackknife_curves(X, r, scale=None)
    np.testing.assert_allclose(curves.held_out, naive_held_out(X, r, scale=None), atol=1e-8)


@pytest.mark.parametrize("shape", [(20, 50), (60, 25)])
def test_nearly_dependent_features_do_not_spoil_it(shape):
    """Eigenvalues over fifteen orders of magnitude, where a Gram matrix keeps no digits."""
    X, r = population(*shape)
    rng = np.random.default_rng(1)
    rank = min(shape) - 5
    X = rng.normal(size=(shape[0], rank)) * np.geomspace(1, 3e-7, rank)
    X = X @ rng.normal(size=(rank, shape[1])) + 0.1 * r[:, None]
    naive = naive_held_out(X, r, order="variance")
    held_out = jackknife_curves(X, r, order="variance").held_out
    np.testing.assert_allclose(held_out, naive, rtol=1e-5, atol=1e-5)


@pytest.mark.parametrize("shape", [(20, 50), (60, 25)])
def test_features_that_hardly_vary_do_not_spoil_it(shape):
    X, r = population(*shape)
    X[:, 3] = 7
    X[:, 4] = 7
    X[2, 4] = 8  # does not vary once walker 2 is left out
    held_out = jackknife_curves(X, r).held_out
    np.testing.assert_allclose(held_out, naive_held_out(X, r), atol=1e-8)


def test_twins_do_not_spoil_it():
    X, r = population(20, 50)
    X[7] = X[5]
    held_out = jackknife_curves(X, r).held_out
    assert held_out.shape[1] == 18
    np.testing.assert_allclose(held_out, naive_held_out(X, r), atol=1e-8)


@pytest.mark.parametrize("n_components", [1, 4, 12])
def test_each_point_is_a_pipeline_left_one_out(n_components):
    X, r = population()
    curves = jackknife_curves(X, r)
    pipeline = make_pipeline(WalkerSpace(), DiscriminantClassifier(n_components))
    sums = cross_val_predict(pipeline, X, r, cv=LeaveOneOut(), method="decision_function")
    np.testing.assert_allclose(curves.held_out[:, n_components - 1], sums, atol=1e-9)
    np.testing.assert_allclose(
        curves.trained[:, n_components - 1], pipeline.fit(X, r).decision_function(X), atol=1e-9
    )
    errors = np.sum(np.sign(sums) != r)
    assert curves.generalisation[n_components - 1] == errors


@pytest.mark.parametrize("shape", [(24, 50), (60, 9)])
def test_persons_are_left_out_with_all_their_trials(shape):
    X, r = population(*shape)
    person = np.random.default_rng(0).integers(0, 6, len(X))
    curves = jackknife_curves(X, r, groups=person)
    pipeline = make_pipeline(WalkerSpace(), DiscriminantClassifier(4))
    sums = cross_val_predict(
        pipeline, X, r, groups=person, cv=LeaveOneGroupOut(), method="decision_function"
    )
    np.testing.assert_allclose(curves.held_out[:, 3], sums, atol=1e-8)


def test_an_intercept_is_fitted_in_each_fold():
    X, _ = population()
    few_men = np.where(np.arange(20) % 4 == 0, 1, -1)
    curves = jackknife_curves(X, few_men, fit_intercept=True)
    pipeline = make_pipeline(WalkerSpace(), DiscriminantClassifier(5, fit_intercept=True))
    sums = cross_val_predict(pipeline, X, few_men, cv=LeaveOneOut(), method="decision_function")
    np.testing.assert_allclose(curves.held_out[:, 4], sums, atol=1e-9)


def test_one_scale_for_all_folds_is_a_space_of_scaled_walkers():
    X, r = population()
    once = jackknife_curves(X, r, scale_in_fold=False)
    by_hand = jackknife_curves(X / X.std(axis=0, ddof=1), r, scale=None)
    np.testing.assert_allclose(once.held_out, by_hand.held_out, atol=1e-9)
    assert not np.allclose(once.held_out, jackknife_curves(X, r).held_out)


def test_a_planted_sex_is_told_and_no_sex_is_not():
    X, r = population(40, 100, effect=3)
    assert jackknife_curves(X, r).fewest_errors == 0
    X, r = population(40, 100, effect=0)
    assert 12 < jackknife_curves(X, r).generalisation.mean() < 28


def test_separation_becomes_full_and_generalisation_does_not():
    curves = jackknife_curves(*population(40, 100, effect=0.05))
    assert curves.separating_n < 20
    assert not curves.separation[curves.separating_n + 5 :].any()
    assert curves.fewest_errors > 0
    assert curves.n_components.tolist() == list(range(1, 39))


def test_a_man_who_walks_like_a_woman_is_missed_by_any_number_of_components():
    X, r = population(40, 100, effect=3)
    r[6] = -r[6]
    curves = jackknife_curves(X, r)
    assert curves.misclassified[6, :20].all()
    assert (curves.confidence[6, :20] < 0).all()
    np.testing.assert_array_equal(curves.misclassified.sum(axis=0), curves.generalisation)
    assert curves.generalisation[curves.best_n - 1] == curves.fewest_errors


def test_classes_may_be_named():
    X, r = population()
    named = jackknife_curves(X, np.where(r > 0, "male", "female"))
    np.testing.assert_array_equal(named.held_out, jackknife_curves(X, r).held_out)


@settings(deadline=None, max_examples=30)
@given(
    factor=st.floats(1e-3, 1e3),
    offset=st.floats(-1e3, 1e3),
    feature=st.integers(0, 29),
    shape=st.sampled_from([(14, 30), (50, 30)]),
)
def test_the_unit_of_a_feature_changes_nothing(factor, offset, feature, shape):
    X, r = population(*shape)
    other = X.copy()
    other[:, feature] = factor * other[:, feature] + offset
    np.testing.assert_allclose(
        jackknife_curves(other, r).held_out, jackknife_curves(X, r).held_out, atol=1e-6
    )


@settings(deadline=None, max_examples=20)
@given(order=st.permutations(range(14)))
def test_the_order_of_walkers_changes_only_theirs(order):
    X, r = population(14, 30)
    curves, permuted = jackknife_curves(X, r), jackknife_curves(X[order], r[order])
    np.testing.assert_allclose(permuted.held_out, curves.held_out[order], atol=1e-8)
    np.testing.assert_array_equal(permuted.separation, curves.separation)


def test_swapping_the_classes_mirrors_the_sums_and_keeps_the_errors():
    X, r = population()
    one, other = jackknife_curves(X, r), jackknife_curves(X, -r)
    np.testing.assert_allclose(one.held_out, -other.held_out, atol=1e-12)
    np.testing.assert_array_equal(one.generalisation, other.generalisation)


def test_progress_is_told_fold_by_fold():
    told = []
    jackknife_curves(*population(), progress=lambda done, total: told.append((done, total)))
    assert told == [(done, 20) for done in range(1, 21)]


def test_a_weight_is_told_of_walkers_left_out():
    X, _ = population(40, 30)
    weight = 70 + (X - X.mean(axis=0)) / X.std(axis=0) @ np.linspace(-1, 1, 30)
    curves = regression_curves(X, weight)
    pipeline = make_pipeline(WalkerSpace(), DiscriminantRegressor(6))
    predicted = cross_val_predict(pipeline, X, weight, cv=LeaveOneOut())
    np.testing.assert_allclose(curves.held_out[:, 5], predicted, rtol=1e-9)
    np.testing.assert_allclose(curves.trained[:, 5], pipeline.fit(X, weight).predict(X), rtol=1e-9)
    assert curves.trained_r2[5] == pytest.approx(pipeline.score(X, weight))
    assert curves.correlation[5] == pytest.approx(np.corrcoef(predicted, weight)[0, 1])
    assert curves.rmse[5] == pytest.approx(np.sqrt(np.mean((predicted - weight) ** 2)))
    assert curves.r2[-1] > 0.99
    assert curves.rmse[curves.best_n - 1] == curves.rmse.min()


def test_no_trait_is_told_no_better_than_by_its_mean():
    X, _ = population(40, 60)
    age = np.random.default_rng(5).normal(30, 5, 40)
    assert regression_curves(X, age).r2[0] < 0.1


X, R = population()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ((X, R[:5]), r"got shapes \(20, 50\) and \(5,\)"),
        ((X, np.ones(20)), "all 20 here are of the class 1.0"),
        ((np.ones((20, 3)), R), "None of 3 features varies"),
        ((np.where(np.eye(20, 50) > 0, np.nan, 1.0) * X, R), r"20 of 20 walkers.*row 0"),
        ((X[:2], R[:2]), "needs 3 walkers"),
        ((X, np.where(R > 0, np.nan, R)), "10 of 20 walkers have no value of the trait"),
        ((np.vstack([np.ones((4, 3)), np.zeros((1, 3))]), R[:5]), r"rows \[4\] all others are"),
    ],
)
def test_what_cannot_be_left_out_is_refused_with_the_reason(arguments, said):
    with pytest.raises(ValueError, match=said):
        jackknife_curves(*arguments)


def test_groups_and_traits_must_fit_the_walkers():
    with pytest.raises(ValueError, match=r"got shape \(3,\)"):
        jackknife_curves(X, R, groups=["a", "b", "c"])
    with pytest.raises(ValueError, match="have no group"):
        jackknife_curves(X, R, groups=[None, *range(19)])
    with pytest.raises(ValueError, match="The trait is 1 for all 20 walkers"):
        regression_curves(X, np.ones(20))


def test_a_class_that_is_one_walker_or_one_person_is_refused():
    walkers = np.random.default_rng(0).normal(size=(12, 5))
    sex = np.array(["woman"] * 11 + ["man"])
    with pytest.raises(ValueError, match=r"one walker \(row 11\) .*the class man"):
        jackknife_curves(walkers, sex)
    sex[6:], person = "man", ["a", "b", "c", "d", "e", "f"] + ["Bo"] * 6
    with pytest.raises(ValueError, match=r"Without Bo .*the class man"):
        jackknife_curves(walkers, sex, groups=person)
    assert jackknife_curves(walkers, sex, groups=[*person[:-1], "Al"]).fewest_errors < 12


def test_two_of_a_class_are_enough_where_others_choose_the_components():
    rng = np.random.default_rng(3)
    sex = np.array([1] * 2 + [-1] * 10)
    walkers = rng.normal(size=(12, 4)) + 8 * sex[:, None] * [1, 0, 0, 0]
    assert nested_leave_one_out(walkers, sex).errors <= 2
