"""Answers with observers and walkers as crossed random factors, against lme4 and planted truth."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.special import expit

import eigenwalker as ew
from eigenwalker.psychophysics.crossed_likelihood import CrossedLikelihood, Effects

NAMES = {"response": "error", "observer": "observer", "walker": "walker"}


def study(seed: int = 0, info: float = 1.0, *, n_observers: int = 12, n_walkers: int = 15):
    rng = np.random.default_rng(seed)
    cells = pd.MultiIndex.from_product(
        [range(n_observers), range(n_walkers), ["full", "structure"]],
        names=["observer", "walker", "info"],
    )
    table = cells.to_frame(index=False)
    table["view"] = table["observer"] % 2 * 90
    of_observer, of_walker = rng.normal(0, 0.5, n_observers), rng.normal(0, 0.9, n_walkers)
    eta = -1 + info * (table["info"] == "structure") + of_observer[table["observer"]]
    rate = expit(eta + of_walker[table["walker"]])
    return table.assign(error=(rng.random(len(table)) < rate).astype(int))


@pytest.fixture(scope="module")
def fitted():
    return ew.crossed_logistic(study(), fixed="view * info", **NAMES)


def test_estimates_are_those_of_lme4(r_results: Path) -> None:
    for number in (0, 3):
        table = pd.read_csv(r_results / f"glmm_{number}.csv")
        stored = pd.read_csv(r_results / f"glmm_{number}_lme4.csv", index_col="name")
        found = ew.crossed_logistic(table, fixed="view * info", **NAMES)
        expected = stored[stored["se"].notna()]
        assert found.coefficients.index.tolist() == expected.index.tolist()
        off = (found.coefficients["estimate"] - expected["est"]) / expected["se"]
        assert off.abs().max() < 0.01
        np.testing.assert_allclose(found.coefficients["se"], expected["se"], rtol=0.01)
        for name, sd in found.standard_deviations.items():
            assert sd == pytest.approx(stored["est"][f"sd_{name}"], rel=1e-3)


def test_gradient_is_that_of_the_likelihood() -> None:
    rng = np.random.default_rng(0)
    cells = np.array([(o, w, i) for o in range(5) for w in range(4) for i in range(2)])
    slots = np.stack([0 * cells[:, 2], 1 + cells[:, 2]], axis=1)
    answers = rng.integers(1, 4, len(cells)).astype(float)
    ones = rng.binomial(answers.astype(int), 0.4).astype(float)
    X = np.stack([np.ones(len(cells)), cells[:, 2]], axis=1)
    effects = [Effects(cells[:, k], n, slots, 3) for k, n in ((0, 5), (1, 4))]
    likelihood = CrossedLikelihood(X, ones, answers, *effects)
    place = np.array([-0.3, 0.4, 0.5, 0.3, 0.7, 0.2])
    numeric = [
        (likelihood.deviance(*np.split(place + step, [2]))[0])
        - likelihood.deviance(*np.split(place - step, [2]))[0]
        for step in 1e-5 * np.eye(6)
    ]
    gradient = likelihood.deviance(*np.split(place, [2]))[1]
    np.testing.assert_allclose(gradient, np.array(numeric) / 2e-5, rtol=1e-3, atol=1e-3)


def test_planted_effect_is_found_and_absent_ones_are_not(fitted) -> None:
    tests = fitted.tests.set_index("term")
    assert tests["p"]["info"] < 0.01 < min(tests["p"]["view"], tests["p"]["view:info"])
    row = fitted.coefficients.loc["infostructure"]
    assert row["low"] < 1 < row["high"]
    assert fitted.by_condition.standard_deviations.index.tolist() == [
        *("observer", "observer:info", "walker", "walker:info")
    ]
    assert fitted.largest is fitted.by_condition
    assert (fitted.n_answers, fitted.n_observers, fitted.n_walkers) == (360, 12, 15)


def test_predicted_rates_are_near_the_rates_and_inside_their_intervals(fitted) -> None:
    counted = study().groupby(["view", "info"])["error"].mean()
    rates = fitted.rates.set_index(["view", "info"])
    assert (rates["rate"] - counted).abs().max() < 0.05
    assert ((rates["low"] < rates["rate"]) & (rates["rate"] < rates["high"])).all()
    assert rates["answers"].tolist() == [90] * 4


def test_walkers_beyond_chance_are_those_misjudged_most(fitted) -> None:
    walkers = fitted.walkers
    counted = study().groupby("walker")["error"].sum()
    assert walkers["ones"].tolist() == counted[walkers["walker"]].tolist()
    assert walkers["effect"].is_monotonic_decreasing
    assert walkers["ones"].corr(walkers["effect"]) > 0.95


def test_script_for_r_names_the_same_models(fitted) -> None:
    script = fitted.r_script()
    assert "glmer(error ~ view + info + view:info + (1 | observer) + (1 | walker), d" in script
    assert "(1 | observer:info) + (1 | walker) + (1 | walker:info)" in script


def test_separated_answers_give_no_numbers_but_the_largest_model_that_has_some() -> None:
    table = study()
    table.loc[(table["info"] == "structure") & (table["view"] == 90), "error"] = 1
    found = ew.crossed_logistic(table, fixed="view * info", **NAMES)
    assert not found.converged
    assert found.coefficients["estimate"].isna().all()
    assert "All 90 answers at view 90, info structure are 1" in found.intercepts.reason
    assert found.largest is not None
    assert found.largest.formula == "error ~ view + info + (1 | observer) + (1 | walker)"
    assert found.largest.coefficients["se"].notna().all()


def test_an_observer_who_always_says_the_same_does_no_harm() -> None:
    table = study()
    table.loc[table["observer"] == 3, "error"] = 0
    found = ew.crossed_logistic(table, fixed="info", **NAMES)
    assert found.converged
    assert found.coefficients["se"].between(0.1, 1).all()


def test_answers_that_are_empty_are_counted() -> None:
    table = study().astype({"error": float})
    table.loc[:9, "error"] = np.nan
    found = ew.crossed_logistic(table, fixed="info", **NAMES)
    assert (found.n_answers, found.n_unanswered) == (350, 10)


@pytest.mark.parametrize(
    ("change", "fixed", "message"),
    [
        (lambda t: t.assign(error=2), "info", "Line 2 .* has 2 .* expected 0 or 1"),
        (lambda t: t.assign(error=0), "info", "All 360 answers in 'error' are 0"),
        (lambda t: t, "info ^ 2", "no formula of factors"),
        (lambda t: t, "information", "Columns are missing"),
        (lambda t: t[t["info"] == "full"], "info", "'info' has one level, 'full'"),
        (lambda t: t[t["observer"] == 1], "info", "There are 1 observers"),
        (lambda t: t[t["walker"] < 2], "info", "There are 2 walkers"),
        (lambda t: t.assign(view=t["observer"]), "view", "12 observers in 12 groups"),
        (
            lambda t: t[(t["view"] == 0) | (t["info"] == "full")],
            "view * info",
            r"no answers at \{'view': 90, 'info': 'structure'\}",
        ),
    ],
)
def test_bad_tables_get_one_sentence(change, fixed: str, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        ew.crossed_logistic(change(study()), fixed=fixed, **NAMES)
