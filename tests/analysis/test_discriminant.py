from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from sklearn.linear_model import LinearRegression
from sklearn.model_selection import LeaveOneOut, cross_val_predict
from sklearn.pipeline import make_pipeline
from sklearn.utils.estimator_checks import parametrize_with_checks

from eigenwalker.analysis import (
    DiscriminantClassifier,
    DiscriminantRegressor,
    WalkerSpace,
    jackknife_curves,
)

SEX = np.array(["female", "male"])[np.arange(40) % 2]
R = np.where(SEX == "male", 1.0, -1.0)


def population(seed: int = 0, n_features: int = 60, effect: float = 0.5) -> np.ndarray:
    """Forty correlated walkers, of whom every other is a man, shifted along one direction."""
    rng = np.random.default_rng(seed)
    latent = rng.normal(size=(40, 12)) * np.geomspace(3, 0.3, 12)
    noise = 0.3 * rng.normal(size=(40, n_features))
    shift = rng.normal(size=n_features)
    return latent @ rng.normal(size=(12, n_features)) + noise + effect * R[:, None] * shift


def scores(seed: int = 0) -> np.ndarray:
    return WalkerSpace().fit_transform(population(seed))


@parametrize_with_checks([DiscriminantClassifier(), DiscriminantRegressor()])
def test_scikit_learn_finds_nothing_amiss(estimator, check):
    check(estimator)


def test_c_solves_eq_10_by_least_squares():
    K = scores()[:, :15]
    peer = LinearRegression(fit_intercept=False).fit(K, R)
    classifier = DiscriminantClassifier().fit(K, SEX)
    np.testing.assert_allclose(classifier.coef_, peer.coef_)
    np.testing.assert_allclose(classifier.decision_function(K), peer.predict(K))


def test_an_intercept_is_that_of_linear_regression():
    K = population()[:, :5]
    few_men = np.where(np.arange(40) % 4 == 0, 1, -1)
    peer = LinearRegression().fit(K, few_men)
    classifier = DiscriminantClassifier(fit_intercept=True).fit(K, few_men)
    np.testing.assert_allclose(classifier.decision_function(K), peer.predict(K))


def test_leaving_components_out_equals_fitting_without_them():
    K = scores()
    classifier = DiscriminantClassifier(n_components=4).fit(K, SEX)
    kept = np.flatnonzero(classifier.coef_)
    refit = DiscriminantClassifier().fit(K[:, kept], SEX)
    assert sorted(kept) == sorted(classifier.order_[:4])
    np.testing.assert_allclose(classifier.coef_[kept], refit.coef_)


def test_components_stand_in_order_of_their_correlation_with_the_trait():
    K = scores()
    correlation = [abs(np.corrcoef(k, R)[0, 1]) for k in K.T]
    assert (
        DiscriminantClassifier().fit(K, SEX).order_.tolist()
        == np.argsort(correlation)[::-1].tolist()
    )


def test_raw_order_goes_by_weight_and_variance_order_keeps_that_of_the_space():
    K = scores()
    by_weight = DiscriminantClassifier(order="raw").fit(K, SEX)
    by_variance = DiscriminantClassifier(order="variance").fit(K, SEX)
    assert by_weight.order_.tolist() == np.argsort(-np.abs(by_weight.coef_)).tolist()
    assert by_variance.order_.tolist() == list(range(39))


def test_only_standardised_order_separates_with_as_few_components_as_the_paper():
    """A9: training errors with 4, 8, 12 components; sex shows in the twenty largest of 229."""
    errors = {"raw": [], "variance": [], "standardised": []}
    for seed in range(8):
        rng = np.random.default_rng(seed)
        latent = rng.normal(size=(40, 229))
        latent[:, :20] += 0.35 * R[:, None] * rng.choice([-1, 1], 20)
        walkers = latent / np.arange(1, 230) @ rng.normal(size=(229, 229))
        for order, counts in errors.items():
            counts.append(jackknife_curves(walkers, SEX, order=order).separation[[3, 7, 11]])
    raw, variance, standardised = (np.mean(counts, axis=0) for counts in errors.values())
    assert (raw > 8).all()
    assert (raw > variance).all()
    assert (variance > standardised).all()
    assert standardised[2] < 1


def test_an_intercept_makes_chance_look_worse_than_it_is():
    """A10: errors on walkers left out where sex tells nothing; chance is 20 of 40."""
    errors = {True: [], False: []}
    for seed in range(25):
        walkers = np.random.default_rng(seed).normal(size=(40, 229))
        for fit_intercept, counts in errors.items():
            curves = jackknife_curves(walkers, SEX, fit_intercept=fit_intercept)
            counts.append(curves.generalisation[3])
    assert abs(np.mean(errors[False]) - 20) < 2
    assert np.mean(errors[True]) > np.mean(errors[False]) + 0.5


def test_a_planted_sex_is_told_of_walkers_left_out():
    pipeline = make_pipeline(WalkerSpace(), DiscriminantClassifier(n_components=4))
    guessed = cross_val_predict(pipeline, population(effect=4), SEX, cv=LeaveOneOut())
    assert (guessed == SEX).all()


def test_swapping_the_classes_mirrors_the_discriminant():
    K = scores()
    swapped = np.where(SEX == "male", "female", "male")
    one, other = (DiscriminantClassifier(6).fit(K, sex) for sex in (SEX, swapped))
    np.testing.assert_allclose(one.coef_, -other.coef_)
    np.testing.assert_array_equal(one.order_, other.order_)


def test_a_trait_given_as_text_has_its_second_class_at_the_positive_pole():
    classifier = DiscriminantClassifier(8).fit(scores(), SEX)
    assert (classifier.negative_pole_, classifier.positive_pole_) == ("female", "male")
    sums = classifier.decision_function(scores())
    assert sums[SEX == "male"].mean() > 0 > sums[SEX == "female"].mean()


def test_weight_is_fitted_about_its_mean_and_given_back_with_it():
    K = scores()[:, :10]
    weight = pd.Series(70 + 10 * np.random.default_rng(1).normal(size=40), name="weight_kg")
    regressor = DiscriminantRegressor().fit(K, weight)
    np.testing.assert_allclose(
        regressor.predict(K), LinearRegression().fit(K, weight).predict(K), rtol=1e-10
    )
    assert regressor.predict(np.zeros((1, 10)))[0] == pytest.approx(weight.mean())
    assert regressor.positive_pole_ == "more weight_kg"
    assert DiscriminantRegressor().fit(K, weight.to_numpy()).negative_pole_ == "less"


def test_a_regressor_of_any_columns_is_linear_regression():
    X = population()[:, :8] + 100
    age = X @ np.arange(8) + np.random.default_rng(0).normal(size=40)
    np.testing.assert_allclose(
        DiscriminantRegressor().fit(X, age).predict(X), LinearRegression().fit(X, age).predict(X)
    )


@pytest.mark.parametrize("missing", [np.nan, None])
def test_walkers_without_the_trait_are_named(missing):
    sex = pd.Series(SEX, dtype=object)
    sex[[3, 7]] = missing
    with pytest.raises(ValueError, match=r"2 of 40 walkers have no value.*rows 3, 7"):
        DiscriminantClassifier().fit(scores(), sex)
    weight = np.arange(40.0)
    weight[5] = np.nan
    with pytest.raises(ValueError, match=r"1 of 40 walkers have no value.*rows 5"):
        DiscriminantRegressor().fit(scores(), weight)


@pytest.mark.parametrize(
    ("classifier", "y", "said"),
    [
        (DiscriminantClassifier(), np.arange(40) % 3, r"3 classes \(0, 1, 2\)"),
        (DiscriminantClassifier(), np.repeat("male", 40), "all 40 here are of the class male"),
        (DiscriminantClassifier(n_components=40), SEX, "not among the 1 to 39"),
        (DiscriminantClassifier(order="size"), SEX, "order='size' is not known"),
    ],
)
def test_what_cannot_be_told_apart_is_refused_with_the_reason(classifier, y, said):
    with pytest.raises(ValueError, match=said):
        classifier.fit(scores(), y)
