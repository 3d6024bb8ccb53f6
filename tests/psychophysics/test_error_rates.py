"""Rates, sensitivity, rank correlations and the analysis of walkers, where the answer is known."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from scipy.stats import norm, spearmanr, ttest_1samp

import eigenwalker as ew
from eigenwalker.psychophysics import (
    condition_means,
    confidence_correlations,
    error_rates,
    paired_t,
    rank_correlation,
    walker_errors,
)

SEX = {"response": "answer", "truth": "sex"}
ITEMS = {**SEX, "walker": "walker", "within": "info", "observer": "observer"}


@pytest.fixture(scope="module")
def answers() -> pd.DataFrame:
    """12 observers, 20 walkers who are hard to judge by their number, two conditions."""
    rng = np.random.default_rng(0)
    shape = pd.MultiIndex.from_product(
        [range(12), range(20), ["full", "structure"]], names=["observer", "walker", "info"]
    )
    table = shape.to_frame(index=False)
    table["sex"] = np.where(table["walker"] % 2, "male", "female")
    wrong = rng.random(len(table)) < 0.02 + table["walker"] / 25
    other = np.where(table["sex"] == "male", "female", "male")
    table["answer"] = np.where(wrong, other, table["sex"])
    table["view"] = table["observer"] % 3 * 30
    return table


def test_rates_count_answers_errors_and_trials_without_an_answer(answers: pd.DataFrame) -> None:
    table = answers.copy()
    table.loc[[0, 2], "answer"] = None
    rates = error_rates(table, **SEX, observer="observer", within="info", between="view")
    first = rates.iloc[0]
    assert first[["observer", "between", "within"]].tolist() == [0, 0, "full"]
    assert (first["answers"], first["unanswered"]) == (18, 2)
    assert len(rates) == 24
    full = table[(table["observer"] == 0) & (table["info"] == "full") & table["answer"].notna()]
    assert first["errors"] == (full["answer"] != full["sex"]).sum()
    assert first["arcsine"] == pytest.approx(2 * np.arcsin(np.sqrt(first["error_rate"])))


def test_answers_that_are_no_class_are_refused_with_their_line(answers: pd.DataFrame) -> None:
    table = answers.assign(answer=np.where(answers.index == 7, "m", answers["answer"]))
    with pytest.raises(ValueError, match=r"Line 9 .* the answer 'm' .*'female', 'male'"):
        error_rates(table, **SEX, observer="observer", within="info")


def test_intervals_within_observers_are_those_of_the_difference() -> None:
    """Morey (2008): with two conditions they are sqrt(1/2) of the paired difference's interval."""
    rng = np.random.default_rng(1)
    y = rng.normal(size=(2, 9, 2)) + rng.normal(0, 5, size=(2, 9, 1))
    table = pd.DataFrame({"y": y.ravel(), "info": np.tile(["a", "b"], 18)})
    table["who"], table["view"] = np.repeat(range(18), 2), np.repeat([0, 90], 18)
    found = condition_means(table, dv="y", between="view", within="info", subject="who")
    interval = ttest_1samp(y[0, :, 0] - y[0, :, 1], 0).confidence_interval()
    assert (found["high"] - found["low"])[0] == pytest.approx(
        (interval.high - interval.low) / np.sqrt(2)
    )
    assert found["mean"].tolist() == pytest.approx(y.mean(axis=1).ravel().tolist())
    assert (found["high_between"] - found["low_between"] > found["high"] - found["low"]).all()


def test_paired_t_is_that_of_the_differences() -> None:
    y = np.random.default_rng(2).normal(size=(8, 2))
    table = pd.DataFrame({"y": y.ravel(), "info": ["a", "b"] * 8, "who": np.repeat(range(8), 2)})
    columns = {"dv": "y", "within": "info", "subject": "who", "first": "b", "second": "a"}
    expected = ttest_1samp(y[:, 1] - y[:, 0], 0)
    found = paired_t(table, **columns)
    assert (found["t"], found["p"]) == pytest.approx((expected.statistic, expected.pvalue))
    assert (found["df"], found["alternative"], found["observers"]) == (7, "two-sided", 8)
    one = paired_t(table, **columns, alternative="less" if found["t"] < 0 else "greater")
    assert one["p"] == pytest.approx(found["p"] / 2)
    with pytest.raises(ValueError, match="does not vary over 1 observers"):
        paired_t(table.iloc[:2], **columns)


def test_sensitivity_is_the_formula_with_its_correction() -> None:
    table = pd.DataFrame({"sex": ["m"] * 20 + ["f"] * 20, "who": 1})
    table["answer"] = ["m"] * 20 + ["f"] * 15 + ["m"] * 5
    found = ew.sensitivity(table, response="answer", truth="sex", observer="who").iloc[0]
    z_hit, z_false = norm.ppf([20.5 / 21, 5.5 / 21])
    assert found["d_prime"] == pytest.approx(z_hit - z_false)
    assert found["criterion"] == pytest.approx(-(z_hit + z_false) / 2)
    names = {"response": "answer", "truth": "sex", "observer": "who"}
    assert np.isinf(ew.sensitivity(table, **names, correction="none")["d_prime"][0])
    turned = ew.sensitivity(table, **names, signal="f").iloc[0]
    assert turned["d_prime"] == pytest.approx(found["d_prime"])
    assert turned["criterion"] == pytest.approx(-found["criterion"])
    with pytest.raises(ValueError, match="Expected two classes in 'sex'; got 1"):
        ew.sensitivity(table[:5], **names)


def test_critical_correlation_is_the_paper_s() -> None:
    assert round(ew.spearman_critical(40, 0.01), 3) == 0.373
    assert round(ew.spearman_critical(40, 0.01, two_sided=True), 4) == 0.4125  # A22
    with pytest.raises(ValueError, match="alpha"):
        ew.spearman_critical(40, 1.5)


def test_rank_correlation_is_spearman_s_with_exact_p() -> None:
    x, y = [1, 2, 2, 5, 4], [2, 1, 3, 5, 5]
    found = rank_correlation(x, y, n_permutations=20000)
    assert found.rho == pytest.approx(spearmanr(x, y).statistic)
    assert rank_correlation([1, 2, 3, 4], [1, 2, 3, 4]).p == pytest.approx(1 / 24, abs=0.01)
    assert np.isnan(rank_correlation([1, 1, 1], [1, 2, 3]).rho)


def test_walkers_hard_to_judge_come_first(answers: pd.DataFrame) -> None:
    counts = walker_errors(answers, **ITEMS)
    full = counts[counts["within"] == "full"]
    assert full["answers"].tolist() == [12] * 20
    assert spearmanr(full["rank"], full["walker"]).statistic < -0.8
    assert full["rank"].sum() == 210


def test_confidence_agrees_with_positive_sign_and_below_its_ceiling(answers: pd.DataFrame) -> None:
    z = pd.DataFrame({"knows": 20.0 - np.arange(20), "guesses": np.arange(20) * 7 % 20})
    found = confidence_correlations(answers, z, **ITEMS).set_index(["classifier", "within"])
    knows, guesses = found.loc[("knows", "full")], found.loc[("guesses", "full")]
    assert knows["rho"] > 0.7 > abs(guesses["rho"])
    assert knows["p"] < 0.01 < guesses["p"]
    assert knows["ceiling_low"] < knows["ceiling"] < knows["ceiling_high"] <= 1
    assert knows["ceiling"] == pytest.approx(knows["rho"], abs=0.15)
    with pytest.raises(ValueError, match=r"The walkers \['19'\] of the answers"):
        confidence_correlations(answers, z[:-1], **ITEMS)
