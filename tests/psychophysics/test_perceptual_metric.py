"""The fitted metric: planted weights found again from answers as the paper gathered them."""

from __future__ import annotations

import io
import itertools

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings, strategies as st
from scipy.optimize import lsq_linear
from scipy.spatial.distance import pdist
from sklearn.utils.estimator_checks import parametrize_with_checks

from eigenwalker.metric import (
    PUBLISHED,
    collinear_groups,
    group_table,
    missing_groups,
    pair_components,
)
from eigenwalker.metric.joint_groups import group_means
from eigenwalker.psychophysics.cross_validation import compare_metrics, goodness, leave_walkers_out
from eigenwalker.psychophysics.fit_to_answers import fit_to_answers
from eigenwalker.psychophysics.perceptual_metric import PerceptualMetric
from eigenwalker.psychophysics.reliability import bootstrap_weights, split_half
from eigenwalker.psychophysics.shape_search import fit_from_random_starts, search_shape
from eigenwalker.psychophysics.trials import count_pairs, share_not_chosen
from eigenwalker.report.metric_fit_report import fit_sentences

N_WALKERS, N_OBSERVERS, N_TRIALS = 21, 29, 63  # P1, P5
PAIRS = list(itertools.combinations(range(N_WALKERS), 2))
PLANTED = np.array(list(PUBLISHED["positions-absolute"].group_weights.values()))


def distances(seed: int, n_groups: int = 8) -> np.ndarray:
    """Mean distances of joint groups in mm, pairs x groups, of walkers with places of their own."""
    rng = np.random.default_rng(seed)
    groups = [
        pdist(rng.normal(scale=40 / np.sqrt(6), size=(N_WALKERS, 3))) for _ in range(n_groups)
    ]
    return np.column_stack(groups)


def answers(
    perceived: np.ndarray, *, seed: int, temperature: float
) -> tuple[np.ndarray, np.ndarray]:
    """How often each observer chose and was shown each pair, in trials of four walkers (P5).

    The pair chosen is that of least perceived difference, with noise of Gumbel's distribution.
    """
    rng = np.random.default_rng(seed)
    at = np.zeros((N_WALKERS, N_WALKERS), dtype=int)
    for row, (i, j) in enumerate(PAIRS):
        at[i, j] = at[j, i] = row
    chosen, shown = np.zeros((2, N_OBSERVERS, len(PAIRS)))
    for observer, _ in itertools.product(range(N_OBSERVERS), range(N_TRIALS)):
        four = rng.choice(N_WALKERS, 4, replace=False)
        six = [at[i, j] for i, j in itertools.combinations(four, 2)]
        felt = perceived[six] + temperature * rng.gumbel(size=6) * -1
        shown[observer, six] += 1
        chosen[observer, six[felt.argmin()]] += 1
    return chosen, shown


@parametrize_with_checks([PerceptualMetric(), PerceptualMetric(fit_constant=False)])
def test_scikit_learn_finds_nothing_amiss(estimator, check):
    check(estimator)


def study(seed: int, temperature: float = 0.1) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A study of the paper's size on planted weights: X, and how often pairs were chosen, shown."""
    X = distances(seed)
    told = X @ PLANTED
    return X, *answers(0.75 * told / told.mean(), seed=seed, temperature=temperature)


@pytest.mark.parametrize("temperature", [0.05, 0.1, 0.2])
def test_planted_weights_are_found_from_as_many_answers_as_the_paper_had(temperature):
    planted = PLANTED / PLANTED.sum()
    within = []
    for seed in range(6):
        X, chosen, shown = study(seed, temperature)
        metric = PerceptualMetric().fit(X, share_not_chosen(chosen.sum(axis=0), shown.sum(axis=0)))
        assert np.corrcoef(metric.relative_weights_, planted)[0, 1] >= 0.95
        fitted = bootstrap_weights(X, chosen, shown, pairs=PAIRS, n_samples=200)
        intervals = fitted.intervals([*range(8)])
        within += [(intervals.relative_low <= planted) & (planted <= intervals.relative_high)]
        assert (intervals.relative_high - intervals.relative_low).mean() < 0.2
    assert np.mean(within) >= 0.95  # intervals of 95 per cent, and wider than need be


def planted_in(X: pd.DataFrame, name: str) -> np.ndarray:
    """Relative weights of a published metric's groups, for the columns of a table."""
    weights = pd.Series(PUBLISHED[name].group_weights)[list(X)].to_numpy()
    return weights / weights.sum()


def nearness(X: pd.DataFrame, y: np.ndarray, planted: np.ndarray) -> float:
    """Correlation of weights that are fitted with those that were planted."""
    return float(np.corrcoef(PerceptualMetric().fit(X, y).relative_weights_, planted)[0, 1])


@pytest.mark.parametrize("by", ["positions", "velocities", "angles"])
def test_planted_weights_are_found_in_tables_made_of_walks(mannequins, by):
    X = group_table(mannequins, f"{by}-absolute")
    planted = planted_in(X, f"{by}-absolute")
    share = X.to_numpy() @ planted
    share /= share.max()
    rng = np.random.default_rng(0)
    drawn = rng.binomial(52, share, size=(8, len(share))) / 52  # a pair is shown 52 times (A31)
    assert np.median([nearness(X, y, planted) for y in drawn]) >= 0.95


@pytest.mark.parametrize(("by", "least"), [("positions", 0.8), ("velocities", 0.75)])
def test_shares_of_trials_level_off_which_blurs_weights_of_groups_that_go_together(
    mannequins, by, least
):
    """Pairs that differ much are never chosen, however much: no weighted sum can follow that."""
    X = group_table(mannequins, f"{by}-absolute")
    planted = planted_in(X, f"{by}-absolute")
    told = X.to_numpy() @ planted
    found, straight = [], []
    for seed in range(4):
        chosen, shown = answers(0.75 * told / told.mean(), seed=seed, temperature=0.1)
        y = share_not_chosen(chosen.sum(axis=0), shown.sum(axis=0))
        found.append(nearness(X, y, planted))
        n = shown.sum(axis=0).round().astype(int)
        drawn = np.random.default_rng(seed).binomial(n, told / told.max())
        straight.append(nearness(X, drawn / n, planted))
    assert least < np.mean(found) < np.mean(straight) - 0.01


def test_with_the_mannequin_s_sternum_for_clavicles_weights_would_be_lost(mannequins):
    points = pair_components(mannequins, metric="positions-absolute")
    X = group_means(points, "positions")
    assert X.corr().loc["clavicle", "upper_arm"] > 0.99
    planted = planted_in(X, "positions-absolute")
    told = X.to_numpy() @ planted
    chosen, shown = answers(0.75 * told / told.mean(), seed=0, temperature=0.1)
    assert nearness(X, share_not_chosen(chosen.sum(axis=0), shown.sum(axis=0)), planted) < 0.6
    table = group_table(mannequins, "positions-absolute")
    assert missing_groups(table) == ["clavicle"]
    assert collinear_groups(table).empty


def test_weights_that_differences_were_made_with_come_back():
    X = distances(5)
    metric = PerceptualMetric().fit(X, 0.2 + X @ PLANTED / 100)
    np.testing.assert_allclose(metric.weights_, PLANTED / 100, atol=1e-12)
    assert metric.constant_ == pytest.approx(0.2)
    assert metric.normalisation_ == pytest.approx(100 / PLANTED.sum())


def test_mean_difference_of_the_paper_s_design_is_five_sixths():
    _, chosen, shown = study(0)
    assert 1 - chosen.sum() / shown.sum() == pytest.approx(5 / 6)  # A31


def test_fit_meets_the_conditions_of_the_one_optimum():
    rng = np.random.default_rng(3)
    X, y = np.exp(rng.normal(size=(210, 8)) * 3), rng.uniform(size=210)
    metric = PerceptualMetric().fit(X, y)
    downhill = X.T @ (y - metric.predict(X)) / np.linalg.norm(X - X.mean(axis=0), axis=0)
    used = metric.weights_ > 0
    assert np.abs(downhill[used]).max(initial=0) < 1e-8
    assert downhill[~used].max(initial=0) < 1e-8


def test_fit_agrees_with_another_solver():
    X, chosen, shown = study(4)
    y = share_not_chosen(chosen.sum(axis=0), shown.sum(axis=0))
    bounds = ([-np.inf, *[0.0] * 8], np.inf)
    peer = lsq_linear(np.column_stack([np.ones(210), X]), y, bounds, tol=1e-14).x
    metric = PerceptualMetric().fit(X, y)
    np.testing.assert_allclose([metric.constant_, *metric.weights_], peer, atol=1e-6)


def test_random_starts_end_at_the_same_optimum():
    X, chosen, shown = study(6)
    y = share_not_chosen(chosen.sum(axis=0), shown.sum(axis=0))
    found = fit_from_random_starts(X, y, n_starts=30, random_state=1)
    ours = goodness(y, PerceptualMetric().fit(X, y).predict(X))["rss"]
    assert ours <= found.rss.min() + 1e-12
    assert found.rss.min() == pytest.approx(ours, rel=1e-6)


@settings(deadline=None, max_examples=30)
@given(st.integers(0, 1000), st.floats(1e-3, 1e3))
def test_units_of_distances_do_not_change_what_is_predicted(seed, unit):
    rng = np.random.default_rng(seed)
    X, y = rng.uniform(size=(30, 4)), rng.uniform(size=30)
    ours, scaled = PerceptualMetric().fit(X, y), PerceptualMetric().fit(X * unit, y)
    np.testing.assert_allclose(scaled.predict(X * unit), ours.predict(X), atol=1e-9)
    np.testing.assert_allclose(scaled.weights_ * unit, ours.weights_, atol=1e-9)


def test_pairs_count_as_often_as_their_weight_says():
    rng = np.random.default_rng(8)
    X, y, times = rng.uniform(size=(30, 3)), rng.uniform(size=30), rng.integers(0, 4, 30)
    weighted = PerceptualMetric().fit(X, y, sample_weight=times)
    repeated = PerceptualMetric().fit(np.repeat(X, times, axis=0), np.repeat(y, times))
    np.testing.assert_allclose(weighted.weights_, repeated.weights_, atol=1e-12)


def test_planted_power_is_found():
    d = distances(9)
    found = search_shape(lambda n: d**n, 0.1 + d**0.3 @ PLANTED / 6, bounds=(0.05, 3))
    assert found.parameter == pytest.approx(0.3, abs=1e-4)
    assert found.rss <= found.tried_rss.min()
    np.testing.assert_allclose(found.weights, PLANTED / 6, atol=1e-4)


def test_planted_scale_of_the_sigmoid_is_found():
    d = distances(10)
    found = search_shape(lambda s: d / (d + s), 0.1 + d / (d + 70) @ PLANTED, bounds=(1, 10_000))
    assert found.parameter == pytest.approx(70, rel=1e-3)


def test_bounds_that_make_no_range_are_refused():
    with pytest.raises(ValueError, match="two numbers above 0"):
        search_shape(lambda n: np.ones((3, 1)), [1, 2, 3], bounds=(0, 1))


def test_no_walker_of_a_pair_is_among_those_fitted_to():
    splits = leave_walkers_out(PAIRS)
    assert sorted(int(out[0]) for _, out in splits) == [*range(210)]
    for fitted_to, (out,) in splits:
        assert not {w for row in fitted_to for w in PAIRS[row]} & set(PAIRS[out])
        assert len(fitted_to) == 19 * 18 // 2


def test_three_walkers_are_too_few_to_leave_two_out():
    with pytest.raises(ValueError, match="four walkers"):
        leave_walkers_out([("a", "b"), ("a", "c"), ("b", "c")])


def test_the_metric_observers_use_predicts_unseen_walkers_better_than_others():
    X, chosen, shown = study(11)
    y = share_not_chosen(chosen.sum(axis=0), shown.sum(axis=0))
    noise = np.random.default_rng(0).uniform(size=(210, 1))
    compared = compare_metrics({"fitted": X, "all alike": X.mean(axis=1), "noise": noise}, y, PAIRS)
    assert compared.cv_pearson.idxmax() == "fitted"
    assert compared.cv_pearson["noise"] < 0.2
    assert compared.cv_rms["fitted"] > compared.rms["fitted"]


def test_unseen_pairs_are_predicted_by_weights_to_which_their_walkers_did_not_contribute():
    X, chosen, shown = study(14)
    y = share_not_chosen(chosen.sum(axis=0), shown.sum(axis=0))
    unseen = np.empty(len(y))
    for row, pair in enumerate(PAIRS):
        others = [index for index, other in enumerate(PAIRS) if not set(pair) & set(other)]
        unseen[row] = PerceptualMetric().fit(X[others], y[others]).predict(X[row : row + 1])[0]
    compared = compare_metrics({"fitted": X}, y, PAIRS).loc["fitted"]
    assert compared.cv_rms == pytest.approx(np.sqrt(np.mean((y - unseen) ** 2)))
    assert compared.cv_pearson == pytest.approx(np.corrcoef(y, unseen)[0, 1])
    assert compared.cv_pearson < compared.pearson


def test_no_metric_is_above_the_noise_ceiling_and_the_true_one_is_near():
    X, chosen, shown = study(12, temperature=0.2)
    truth = -np.exp(-(X @ PLANTED) * 0.75 / (X @ PLANTED).mean() / 0.2)
    y = share_not_chosen(chosen.sum(axis=0), shown.sum(axis=0))
    found = split_half(chosen, shown)
    assert found.halves < found.whole < found.ceiling < 1
    assert np.corrcoef(truth, y)[0, 1] < found.ceiling + 0.02


def test_observers_who_guess_have_no_ceiling():
    _, chosen, shown = study(13, temperature=1e6)
    assert split_half(chosen, shown).ceiling < 0.4


def test_counts_that_cannot_be_are_refused():
    with pytest.raises(ValueError, match="more often than shown"):
        split_half([[3.0], [1.0]], [[2.0], [2.0]])
    with pytest.raises(ValueError, match="1 observer"):
        split_half([[1.0]], [[2.0]])
    with pytest.raises(ValueError, match="X has 3"):
        bootstrap_weights(np.ones((3, 1)), np.ones((2, 4)), np.ones((2, 4)))


@pytest.mark.parametrize("n_walkers", [4, 5])
def test_few_walkers_are_drawn_anew_until_they_make_pairs(n_walkers):
    pairs = list(itertools.combinations(range(n_walkers), 2))
    X = np.random.default_rng(0).uniform(size=(len(pairs), 2))
    shown = np.full((3, len(pairs)), 10)
    chosen = np.random.default_rng(1).integers(0, 10, shown.shape)
    fitted = bootstrap_weights(X, chosen, shown, pairs=pairs, n_samples=300)
    assert fitted.weights.shape == (300, 2)
    assert np.isfinite(fitted.weights).all()
    assert np.isfinite(fitted.constants).all()


def test_too_few_walkers_to_draw_from_are_refused_in_a_sentence():
    with pytest.raises(ValueError, match="four walkers or more"):
        bootstrap_weights([[1.0]], [[1], [2]], [[3], [3]], pairs=[("a", "b")], n_samples=5)


def test_observers_of_opposite_minds_have_no_ceiling():
    found = split_half([[0, 5, 10], [10, 5, 0]], np.full((2, 3), 10))
    assert found == (pytest.approx(-1), 0, 0)


@pytest.mark.parametrize(
    "chosen", [[[5, 5, 5, 0], [5, 5, 5, 0]], [[1, 2, 0, 0], [3, 1, 0, 0]]], ids=["alike", "few"]
)
def test_where_nothing_can_be_correlated_it_is_said(chosen):
    shown = [[10, 10, 10, 0]] * 2 if chosen[0][2] else [[10, 10, 0, 5], [10, 10, 5, 0]]
    with pytest.warns(UserWarning, match="2 observers"):
        found = split_half(chosen, shown)
    assert np.isnan(found).all()


def test_goodness_of_a_constant_has_no_correlation():
    found = goodness([0.1, 0.5], [0.3, 0.3])
    assert np.isnan(found["pearson"])
    assert found["rms"] == pytest.approx(0.2)


def trials(n: int, seed: int = 0) -> pd.DataFrame:
    """Random answers of three observers about six walkers."""
    rng = np.random.default_rng(seed)
    rows = []
    for trial in range(n):
        four = rng.choice([f"w{i}" for i in range(6)], 4, replace=False)
        rows.append([f"o{trial % 3}", *four, *rng.choice(four, 2, replace=False)])
    return pd.DataFrame(rows, columns=["observer", *"abcd", "chosen_1", "chosen_2"])


def test_counts_of_pairs_are_those_of_the_definition():
    answers = trials(60)
    counts = count_pairs(answers)
    assert counts.shown.sum() == 6 * 60
    assert counts.chosen.sum() == 60
    for (first, second), told in counts.differences.items():
        together = [row for row in answers.itertuples() if {first, second} <= set(row[2:6])]
        picked = [row for row in together if {row.chosen_1, row.chosen_2} == {first, second}]
        assert told == pytest.approx(1 - len(picked) / len(together))


def test_numbers_may_stand_for_walkers_where_a_trial_ran_out_of_time_too():
    answers = trials(60)
    columns = [*"abcd", "chosen_1", "chosen_2"]
    numbered = answers.assign(**{name: answers[name].str[1:].astype(int) for name in columns})
    numbered.loc[3, columns[-2:]] = np.nan  # which makes pandas read 1.0 for 1
    counts = count_pairs(numbered, walkers=range(6))
    assert counts.pairs.tolist() == list(itertools.combinations("012345", 2))
    np.testing.assert_array_equal(counts.chosen, count_pairs(answers.drop(3)).chosen)
    as_saved = pd.read_csv(io.StringIO(numbered.to_csv(index=False)), dtype=str)
    np.testing.assert_array_equal(counts.chosen, count_pairs(as_saved, walkers=range(6)).chosen)


def test_a_line_is_told_that_one_can_find_though_trials_ran_out_of_time():
    answers = trials(9)
    answers.loc[[0, 4], "chosen_1"] = None
    answers.loc[6, "a"] = "w9"
    with pytest.raises(ValueError, match="Line 8 of the answers"):
        count_pairs(answers, walkers=[f"w{i}" for i in range(6)])


def test_a_walker_named_twice_is_refused():
    with pytest.raises(ValueError, match=r"\['w1'\] come more than once"):
        count_pairs(trials(5), walkers=["w1", "w0", "w1", "w2"])


def test_each_observer_s_counts_are_their_own():
    answers = trials(60)
    alone = count_pairs(answers[answers.observer == "o1"])
    together = count_pairs(answers)
    row = together.observers.index("o1")
    np.testing.assert_array_equal(alone.chosen[0], together.chosen[row])


def test_pairs_come_in_the_order_of_walkers_asked_for():
    answers, names = trials(60), ["w5", "w0", "w3", "w1", "w4", "w2", "w9"]
    counts = count_pairs(answers, walkers=names)
    assert counts.pairs.tolist() == list(itertools.combinations(names, 2))
    assert counts.differences[("w5", "w0")] == count_pairs(answers).differences[("w0", "w5")]
    assert counts.differences[[pair for pair in counts.pairs if "w9" in pair]].isna().all()
    with pytest.raises(ValueError, match="not among the walkers"):
        count_pairs(answers, walkers=names[1:])


def test_trials_that_ran_out_of_time_do_not_count():
    answers = trials(60)
    silent = answers.assign(chosen_1=answers.chosen_1.where(answers.index > 9))
    left = count_pairs(silent)
    np.testing.assert_array_equal(left.shown, count_pairs(answers[10:]).shown)


def test_order_of_trials_and_of_walkers_in_them_does_not_matter():
    answers = trials(60)
    turned = answers.sample(frac=1, random_state=1).rename(
        columns={"a": "d", "b": "c", "c": "b", "d": "a"}
    )
    swapped = turned.rename(columns={"chosen_1": "chosen_2", "chosen_2": "chosen_1"})
    np.testing.assert_array_equal(count_pairs(swapped).chosen, count_pairs(answers).chosen)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda t: t.drop(columns="d"), r"\['d'\] are missing"),
        (lambda t: t.assign(chosen_1="w9"), "Line 2 of the answers shows"),
        (lambda t: t.assign(chosen_1=t.chosen_2), "cannot be the pair"),
        (lambda t: t.assign(b=t.a), "four different"),
        (lambda t: t[:0], "no answered trial"),
        (lambda t: t.assign(observer=[*"abc", None, "d"]), "Line 5 .* 'observer'"),
        (lambda t: t.assign(c=t.c.where(t.index != 2)), "Line 4 .* 'c'"),
    ],
)
def test_answers_that_cannot_be_are_refused(change, said):
    with pytest.raises(ValueError, match=said):
        count_pairs(change(trials(5)))


def test_pairs_that_were_never_shown_together_are_left_out_of_the_fit_and_it_is_said(mannequins):
    clips = dict(itertools.islice(mannequins.items(), 6))
    renamed = {f"w{i}": clip for i, clip in enumerate(clips.values())}
    answers = trials(80)
    together = (answers[[*"abcd"]].isin(["w0", "w1"])).sum(axis=1) == 2
    with pytest.warns(UserWarning, match="1 of 15 pairs were never shown together, such as w0"):
        found = fit_to_answers(renamed, answers[~together], metric="positions-absolute")
    assert len(found.pairs) == 14
    assert ("w0", "w1") not in found.pairs.index
    assert np.isfinite(found.pairs.drop(columns="expected_unseen")).all(axis=None)


@pytest.mark.parametrize(
    ("liking", "said"),
    [(-6.0, "was the most different pair"), (0.0, "cannot be told from guessing"), (6.0, "")],
)
def test_what_speaks_against_a_fit_is_said(mannequins, liking, said):
    clips = dict(itertools.islice(mannequins.items(), 14))
    renamed = {f"w{i:02d}": clip for i, clip in enumerate(clips.values())}
    apart = pair_components(renamed, metric="positions-absolute").mean(axis=1)
    apart = (liking * apart / apart.std()).to_dict()
    rng = np.random.default_rng(0)
    rows = []
    for trial in range(480):
        four = sorted(rng.permutation(list(renamed))[:4])
        felt = {pair: apart[pair] - rng.gumbel() for pair in itertools.combinations(four, 2)}
        rows.append([f"o{trial % 12}", *four, *min(felt, key=felt.__getitem__)])
    table = pd.DataFrame(rows, columns=["observer", *"abcd", "chosen_1", "chosen_2"])
    found = " ".join(fit_sentences(fit_to_answers(renamed, table, metric="positions-absolute")))
    doubts = ["was the most different pair", "cannot be told from guessing", "too narrow"]
    assert [doubt for doubt in doubts if doubt in found] == ([said] if said else [])
