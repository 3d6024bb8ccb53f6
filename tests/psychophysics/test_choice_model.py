"""Dissimilarities from choices of planted truth, and the table by counting."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pandas as pd
import pytest

import eigenwalker as ew
from eigenwalker.psychophysics import read_trials, triangle_inequalities

COLUMNS = ["observer", "a", "b", "c", "d", "chosen_1", "chosen_2"]


def study(n_walkers: int = 10, n_trials: int = 900, seed: int = 0):
    """Return answers to trials of four walkers, and the planted dissimilarities of pairs."""
    rng = np.random.default_rng(seed)
    names = [f"w{i:03d}" for i in range(n_walkers)]
    truth = {pair: rng.normal() for pair in combinations(names, 2)}
    rows = []
    for trial in range(n_trials):
        shown = sorted(rng.choice(names, 4, replace=False).tolist())
        pairs = list(combinations(shown, 2))
        odds = np.exp([-truth[pair] for pair in pairs])
        chosen = pairs[rng.choice(6, p=odds / odds.sum())]
        rows.append([f"o{trial % 9}", *shown, *chosen])
    return pd.DataFrame(rows, columns=COLUMNS), pd.Series(truth)


@pytest.fixture(scope="module")
def fitted():
    answers, truth = study()
    return ew.fit_choice_model(answers), truth - truth.mean()


def test_planted_dissimilarities_are_found_and_lie_in_their_intervals(fitted) -> None:
    model, truth = fitted
    pairs = model.intervals.set_index(["first", "second"])
    assert np.corrcoef(pairs["dissimilarity"], truth)[0, 1] > 0.9
    inside = (pairs["low"] < truth) & (truth < pairs["high"])
    assert inside.mean() > 0.85
    assert model.spread == pytest.approx(1, abs=0.3)
    assert (model.n_answers, len(model.observers)) == (900, 9)
    assert (model.observers["above_guessing"] > 0).all()


def test_table_of_dissimilarities_is_sorted_as_that_of_differences(fitted) -> None:
    model, _ = fitted
    table = ew.difference_table(study()[0])
    assert model.dissimilarities.index.tolist() == table.index.tolist() == sorted(table.index)
    upper = np.triu_indices(10, 1)
    a, b = model.dissimilarities.to_numpy()[upper], table.to_numpy()[upper]
    assert np.corrcoef(a, b)[0, 1] > 0.9
    assert np.diag(table).tolist() == [0.0] * 10


def test_mean_difference_weighted_by_showings_is_five_sixths() -> None:
    """SPEC A31: one of six pairs is chosen each time."""
    answers, _ = study(n_trials=200)
    table = ew.difference_table(answers)
    trials = read_trials(answers)
    shown = np.bincount(trials.shown.ravel(), minlength=45)
    assert np.average(table.to_numpy()[np.triu_indices(10, 1)], weights=shown) == pytest.approx(
        5 / 6
    )
    assert table.attrs == {"answers": 200, "observers": 9}


def test_pairs_never_or_always_chosen_or_never_shown_are_finite_and_named() -> None:
    rows = [["Eva", *"abcd", *"ab"]] * 20 + [["Eva", *"abce", *"ab"]] * 5
    model = ew.fit_choice_model(pd.DataFrame(rows, columns=COLUMNS))
    pairs = model.intervals.set_index(["first", "second"])
    assert np.isfinite(pairs[["dissimilarity", "low", "high"]]).all(axis=None)
    assert pairs["note"]["a", "b"] == "always chosen"
    assert pairs["note"]["a", "c"] == "never chosen"
    assert pairs["note"]["d", "e"] == "never shown together"
    assert pairs["dissimilarity"].idxmin() == ("a", "b")
    assert pairs["se"]["d", "e"] > pairs["se"]["a", "c"]
    assert np.isnan(ew.difference_table(pd.DataFrame(rows, columns=COLUMNS)).loc["d", "e"])


def test_odd_one_out_comes_into_the_same_model() -> None:
    rows = [["Eva", *"abc", "c"]] * 8 + [["Tom", *"abc", "a"]] * 2
    table = pd.DataFrame(rows, columns=["observer", "a", "b", "c", "odd"])
    pairs = ew.fit_choice_model(table).intervals
    assert pairs["chosen"].tolist() == [8, 0, 2]
    assert pairs["dissimilarity"].is_monotonic_increasing is False
    with pytest.raises(ValueError, match=r"Line 2 .* 'd' is the odd one"):
        ew.fit_choice_model(table.assign(odd="d"))
    with pytest.raises(ValueError, match=r"\['c'\] are missing"):
        ew.fit_choice_model(table.drop(columns="c"))


def test_triangle_inequalities_are_those_over_all_triples() -> None:
    places = np.random.default_rng(0).normal(size=(7, 2))
    table = np.linalg.norm(places[:, None] - places, axis=2)
    assert triangle_inequalities(table) == (1.0, 1.0, 35)
    table[0, 1] = table[1, 0] = 100
    found = triangle_inequalities(table)
    assert found.share == pytest.approx(1 - 5 / 105)
    assert found.share_of_triples == pytest.approx(1 - 5 / 35)
    table[0, 1] = table[1, 0] = np.nan
    assert triangle_inequalities(table).n_triples == 30
