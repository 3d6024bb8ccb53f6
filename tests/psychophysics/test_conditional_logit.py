"""Weights fitted to choices: planted ones come back where shares of choices level off."""

from __future__ import annotations

import itertools

import numpy as np
import pandas as pd
import pytest
from scipy.optimize import minimize
from sklearn.linear_model import LogisticRegression

from eigenwalker.metric import PUBLISHED, group_table
from eigenwalker.psychophysics.conditional_logit import (
    bootstrap_choices,
    choice_probabilities,
    expected_differences,
    fit_choices,
)
from eigenwalker.psychophysics.cross_validation import compare_by_choices, left_out_differences
from eigenwalker.psychophysics.perceptual_metric import PerceptualMetric
from eigenwalker.psychophysics.trials import Trials, count_pairs, read_trials

N_WALKERS, N_OBSERVERS, N_TRIALS = 21, 29, 63  # P1, P5
PAIRS = pd.MultiIndex.from_tuples(itertools.combinations(range(N_WALKERS), 2))


def planted_in(X: pd.DataFrame, name: str) -> np.ndarray:
    weights = pd.Series(PUBLISHED[name].group_weights)[list(X)].to_numpy()
    return weights / weights.sum()


def study(perceived: np.ndarray, *, seed: int, noise: float) -> Trials:
    """Observers pick the least different of six pairs, with noise of Gumbel's distribution."""
    rng = np.random.default_rng(seed)
    at = np.zeros((N_WALKERS, N_WALKERS), dtype=int)
    for row, (i, j) in enumerate(PAIRS):
        at[i, j] = at[j, i] = row
    fours = [rng.choice(N_WALKERS, 4, replace=False) for _ in range(N_OBSERVERS * N_TRIALS)]
    shown = np.array([[at[i, j] for i, j in itertools.combinations(four, 2)] for four in fours])
    felt = perceived[shown] - noise * rng.gumbel(size=shown.shape)
    observer = np.repeat(np.arange(N_OBSERVERS), N_TRIALS)
    return Trials(PAIRS, tuple(range(N_OBSERVERS)), observer, shown, felt.argmin(axis=1))


def by_themselves(n_groups: int, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).uniform(size=(len(PAIRS), n_groups))


@pytest.mark.parametrize("noise", [0.1, 0.5, 1.0])
@pytest.mark.parametrize("by", ["positions", "velocities", "angles"])
def test_weights_planted_in_walks_are_found_from_as_many_choices_as_the_paper_had(
    mannequins, by, noise
):
    X = group_table(mannequins, f"{by}-sigmoid")
    planted = planted_in(X, f"{by}-sigmoid")
    told = X.to_numpy() @ planted
    for seed in range(3):
        trials = study(told / told.std(), seed=seed, noise=noise)
        found = fit_choices(X, trials)
        assert np.corrcoef(found.relative_weights, planted)[0, 1] >= 0.95
        assert found.weights.sum() * told.std() * noise == pytest.approx(1, rel=0.25)


def test_intervals_hold_planted_weights_about_as_often_as_they_say(mannequins):
    X = group_table(mannequins, "positions-sigmoid")
    planted = planted_in(X, "positions-sigmoid")
    told = X.to_numpy() @ planted
    within, apart = [], []
    for seed in range(12):
        trials = study(told / told.std(), seed=seed, noise=0.5)
        sampled = bootstrap_choices(X, trials, n_samples=120, random_state=seed).intervals(
            X.columns
        )
        within.append((sampled.relative_low <= planted) & (planted <= sampled.relative_high))
        apart.append((sampled.relative_high - sampled.relative_low).mean())
    held = np.mean(within, axis=0)
    assert 0.75 <= held[planted > 0].mean() < 1  # of 95 per cent: a little narrow
    assert held[planted == 0].mean() > 0.9
    assert np.mean(apart) < 0.08


def test_choices_are_foretold_where_shares_level_off(mannequins):
    X = group_table(mannequins, "velocities-sigmoid")
    told = X.to_numpy() @ planted_in(X, "velocities-sigmoid")
    trials = study(told / told.std(), seed=1, noise=0.3)
    seen = count_pairs(trials).differences.to_numpy()
    linear = PerceptualMetric().fit(X, seen).predict(X)
    expected = expected_differences(X @ fit_choices(X, trials).weights, trials)
    assert np.corrcoef(seen, expected)[0, 1] > np.corrcoef(seen, linear)[0, 1] + 0.05
    assert np.corrcoef(seen, left_out_differences(X, trials))[0, 1] > 0.93


def test_fit_agrees_with_another_solver():
    X = by_themselves(5)
    trials = study(X @ [3.0, 0, 1, 0, 0.5], seed=2, noise=1.0)
    apart = X[trials.shown] - X[trials.chosen_pairs][:, None]

    def surprise(weights):
        odds = np.exp(-(apart @ weights))
        slope = -(odds[:, :, None] * apart).sum(axis=1) / odds.sum(axis=1)[:, None]
        return np.log(odds.sum(axis=1)).sum(), slope.sum(axis=0)

    peer = minimize(surprise, np.ones(5), jac=True, bounds=[(0, None)] * 5, tol=1e-12)
    found = fit_choices(X, trials)
    assert -found.log_likelihood <= peer.fun + 1e-7
    np.testing.assert_allclose(found.weights, peer.x, atol=2e-3)


def test_of_two_pairs_the_choice_is_a_logistic_regression():
    rng = np.random.default_rng(3)
    X = rng.uniform(size=(len(PAIRS), 3))
    shown = np.array([rng.choice(len(PAIRS), 2, replace=False) for _ in range(2000)])
    more = X[shown[:, 1]] - X[shown[:, 0]]
    first = rng.uniform(size=2000) < 1 / (1 + np.exp(-(more @ [2.0, 1.0, 0.5])))
    trials = Trials(PAIRS, (0,), np.zeros(2000, dtype=int), shown, np.where(first, 0, 1))
    peer = LogisticRegression(C=np.inf, fit_intercept=False, tol=1e-10).fit(more, first)
    np.testing.assert_allclose(fit_choices(X, trials).weights, peer.coef_[0], rtol=1e-4)


def test_units_of_distances_do_not_change_what_is_foretold():
    X = by_themselves(4)
    trials = study(X @ [2.0, 1, 0, 0], seed=4, noise=0.5)
    found, scaled = fit_choices(X, trials), fit_choices(X * [1, 1e3, 1e-3, 50], trials)
    np.testing.assert_allclose(scaled.weights * [1, 1e3, 1e-3, 50], found.weights, atol=1e-5)
    assert scaled.log_likelihood == pytest.approx(found.log_likelihood)


def test_trials_count_as_often_as_said():
    X = by_themselves(3)
    trials = study(X @ [2.0, 1, 0], seed=5, noise=1.0)
    times = np.random.default_rng(0).integers(0, 3, len(trials.chosen))
    repeated = Trials(
        PAIRS,
        trials.observers,
        np.repeat(trials.observer, times),
        np.repeat(trials.shown, times, axis=0),
        np.repeat(trials.chosen, times),
    )
    found, peer = fit_choices(X, trials, counts=times), fit_choices(X, repeated)
    np.testing.assert_allclose(found.weights, peer.weights, atol=1e-6)


def test_expected_differences_are_those_of_many_simulated_choices():
    X = by_themselves(1)
    told = 4 * X[:, 0]
    trials = study(told, seed=6, noise=1.0)
    expected = expected_differences(told, trials)
    n_shown = np.bincount(trials.shown.ravel(), minlength=len(PAIRS))
    assert (1 - expected) @ n_shown == pytest.approx(len(trials.chosen))
    many = [
        study(told, seed=seed, noise=1.0) for seed in range(100, 140)
    ]  # other trials, of the same people
    seen = np.mean([count_pairs(each).differences for each in many], axis=0)
    assert np.abs(seen - expected).mean() < 0.03
    assert np.corrcoef(seen, expected)[0, 1] > 0.95


def test_what_is_unseen_was_not_fitted_to():
    X = by_themselves(3)
    trials = study(X @ [3.0, 1, 0], seed=7, noise=0.5)
    unseen = left_out_differences(X, trials)
    row = PAIRS.get_loc((4, 11))
    there = np.array([{w for pair in shown for w in PAIRS[pair]} for shown in trials.shown])
    others = np.array([not ({4, 11} & walkers) for walkers in there])
    both = (trials.shown == row).any(axis=1)
    weights = fit_choices(X, trials, counts=others.astype(float)).weights
    likely = choice_probabilities(X @ weights, trials.shown[both])
    by_hand = 1 - likely[trials.shown[both] == row].mean()
    assert unseen[row] == pytest.approx(by_hand, abs=1e-6)


def test_the_metric_that_observers_use_foretells_choices_better_than_others():
    X = by_themselves(4)
    trials = study(X @ [5.0, 2, 0, 0], seed=8, noise=0.5)
    tables = {"fitted": X, "all alike": X.mean(axis=1), "noise": by_themselves(1, seed=9)}
    compared = compare_by_choices(tables, trials)
    assert compared.cv_pearson.idxmax() == compared.bits.idxmax() == "fitted"
    assert 0 <= compared.bits["noise"] < 0.05 < compared.bits["all alike"]
    assert compared.bits["all alike"] < compared.bits["fitted"] < np.log2(6)


def test_a_group_that_never_differs_weighs_nothing():
    X = np.column_stack([by_themselves(1)[:, 0], np.full(len(PAIRS), 7.0)])
    found = fit_choices(X, study(3 * X[:, 0], seed=9, noise=0.5))
    assert found.weights[1] == 0
    assert found.weights[0] > 1


def test_observers_who_contradict_every_distance_leave_all_weights_at_0():
    X = by_themselves(2)
    found = fit_choices(X, study(-5 * X.sum(axis=1), seed=10, noise=0.2))
    assert found.weights.tolist() == [0, 0]
    assert found.relative_weights.tolist() == [0, 0]
    assert found.log_likelihood == pytest.approx(-N_OBSERVERS * N_TRIALS * np.log(6))


def test_choices_without_an_exception_leave_the_size_of_weights_open_and_tell_their_ratio():
    X = by_themselves(2)
    trials = study(X @ [1.0, 0.5], seed=11, noise=0.0)
    with pytest.warns(UserWarning, match=r"columns \[0, 1\]"):
        found = fit_choices(X, trials)
    assert np.isfinite(found.weights).all()
    np.testing.assert_allclose(found.relative_weights, [2 / 3, 1 / 3], atol=0.03)


def test_a_group_that_differs_only_in_a_pair_never_chosen_is_told_to_be_open():
    X = by_themselves(2)
    trials = study(3 * X[:, 0], seed=11, noise=1.0)
    never = int(np.setdiff1d(np.arange(len(PAIRS)), trials.chosen_pairs)[0])
    alone = np.zeros(len(PAIRS))
    alone[never] = 1.0
    with pytest.warns(UserWarning, match=r"columns \[1\]"):
        fit_choices(np.column_stack([X[:, 0], alone]), trials)


def test_a_group_that_differs_by_rounding_alone_weighs_nothing():
    X = by_themselves(1)
    rounded = np.where(np.arange(len(PAIRS)) % 2, 0.3, 0.1 + 0.2)
    trials = study(3 * X[:, 0], seed=11, noise=1.0)
    assert fit_choices(np.column_stack([X[:, 0], rounded]), trials).weights[1] == 0


@pytest.mark.parametrize("n_walkers", [4, 5])
def test_few_walkers_leave_none_unseen(n_walkers):
    names = [f"w{i}" for i in range(n_walkers)]
    rng = np.random.default_rng(0)
    fours = [rng.permutation(names)[:4] for _ in range(60)]
    rows = [[f"o{t % 3}", *four, *rng.permutation(four)[:2]] for t, four in enumerate(fours)]
    columns = ["observer", *"abcd", "chosen_1", "chosen_2"]
    trials = read_trials(pd.DataFrame(rows, columns=columns), walkers=names)
    X = rng.uniform(size=(len(trials.pairs), 2))
    assert np.isnan(left_out_differences(X, trials)).all()
    assert np.isnan(compare_by_choices({"fitted": X}, trials).cv_pearson).all()


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"shown": np.array([[0, 210]])}, "names the pairs 0 to 210"),
        ({"shown": np.array([[-1, 3]])}, "names the pairs -1"),
        ({"chosen": np.array([2])}, "chosen goes from 2"),
        ({"chosen": np.array([0.7])}, "chosen must be whole numbers; got 0.7"),
        ({"shown": np.array([[0, 1.7]])}, "shown must be whole numbers; got 1.7"),
        ({"observer": np.array([0, 0])}, "observer has shape"),
    ],
)
def test_trials_that_cannot_be_are_refused(change, said):
    fine = {"observer": np.array([0]), "shown": np.array([[0, 1]]), "chosen": np.array([0])}
    with pytest.raises(ValueError, match=said):
        Trials(PAIRS, ("Eva",), **(fine | change))


def test_read_trials_hold_what_answers_say():
    answers = pd.DataFrame(
        [
            ["Eva", "b", "d", "a", "c", "d", "b"],
            ["Ian", "a", "b", "c", "d", "c", None],
            ["Ian", "d", "c", "b", "a", "a", "d"],
        ],
        columns=["observer", *"abcd", "chosen_1", "chosen_2"],
    )
    trials = read_trials(answers)
    assert [trials.pairs[row] for row in trials.chosen_pairs] == [("b", "d"), ("a", "d")]
    assert [sorted(shown) for shown in trials.shown.tolist()] == [[*range(6)]] * 2
    assert [trials.observers[each] for each in trials.observer] == ["Eva", "Ian"]
    np.testing.assert_array_equal(count_pairs(trials).shown, count_pairs(answers).shown)


@pytest.mark.parametrize(
    ("X", "counts", "said"),
    [
        (np.ones((3, 2)), None, "table of 210 pairs"),
        (np.full((210, 2), np.nan), None, "420 of 420 are missing"),
        (np.ones((210, 2)), np.ones(4), r"got shape \(4,\)"),
        (np.ones((210, 2)), np.zeros(29 * 63), "not all zero"),
    ],
)
def test_what_cannot_be_fitted_is_refused(X, counts, said):
    trials = study(by_themselves(1)[:, 0], seed=12, noise=1.0)
    with pytest.raises(ValueError, match=said):
        fit_choices(X, trials, counts=counts)


def test_one_observer_has_no_intervals():
    X = by_themselves(1)
    trials = study(X[:, 0], seed=13, noise=1.0)
    alone = Trials(PAIRS, ("Eva",), np.zeros(29 * 63, dtype=int), trials.shown, trials.chosen)
    with pytest.raises(ValueError, match="1 observer"):
        bootstrap_choices(X, alone)
