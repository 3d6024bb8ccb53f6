"""Psychometric functions and agreement, of planted truth and published examples."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from scipy.special import expit

import eigenwalker as ew

NAMES = {"level": "level", "response": "answer", "observer": "who"}
RATINGS = {"rating": "rating", "walker": "walker", "observer": "who"}


def answers(threshold: float = 0.4, width: float = 2.0, *, seed: int = 0, n: int = 20):
    rng = np.random.default_rng(seed)
    level = np.repeat(np.linspace(-2, 2, 11), n)
    share = 0.02 + 0.96 * expit(2 * np.log(19) * (level - threshold) / width)
    return pd.DataFrame(
        {"level": level, "answer": (rng.random(len(level)) < share).astype(int), "who": f"o{seed}"}
    )


def test_curves_are_found_and_an_observer_without_one_stays() -> None:
    table = pd.concat(
        [answers(seed=k) for k in range(3)] + [answers().assign(answer=1, who="same")]
    )
    found = ew.psychometric(table, **NAMES).table.set_index("observer")
    good = found.loc[["o0", "o1", "o2"]]
    assert good["threshold"].tolist() == pytest.approx([0.4] * 3, abs=0.3)
    assert (good["threshold_low"] < good["threshold"]).all()
    assert (good["threshold"] < good["threshold_high"]).all()
    assert (good["width_low"] < good["width"]).all()
    assert (good["width"] < good["width_high"]).all()
    assert not good["extrapolated"].any()
    assert good["p_fit"].min() > 0.001
    assert found["reason"]["same"] == "all 220 answers are 1: no curve"
    assert np.isnan(found["threshold"]["same"])


def test_falling_answers_have_a_negative_width() -> None:
    table = answers()
    up = ew.psychometric(table, **NAMES).table.iloc[0]
    down = ew.psychometric(table.assign(answer=1 - table["answer"]), **NAMES)
    row = down.table.iloc[0]
    assert (row["threshold"], row["width"]) == pytest.approx(
        (up["threshold"], -up["width"]), abs=0.02
    )
    assert row["width_low"] < row["width"] < row["width_high"] < 0
    assert down.curve("o0", [-2, 2])[0] > 0.9 > down.curve("o0", [-2, 2])[1]


def test_threshold_outside_the_levels_is_said_to_be_extrapolated() -> None:
    found = ew.psychometric(answers(2.6, 3.0), **NAMES).table.iloc[0]
    assert found["extrapolated"]
    assert found["threshold"] > 2


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda t: t.assign(answer=3), "Line 2 .* has 3 .* expected 0 or 1"),
        (lambda t: t.assign(level="low"), "Line 2 .* 'low' .* finite number"),
        (lambda t: t.drop(columns="who"), "Columns are missing: observer='who'"),
    ],
)
def test_bad_tables_of_levels_get_one_sentence(change, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        ew.psychometric(change(answers()), **NAMES)


def ratings() -> pd.DataFrame:
    """The example of Shrout & Fleiss (1979), table 2: six targets, four judges."""
    values = [9, 2, 5, 8, 6, 1, 3, 2, 8, 4, 6, 8, 7, 1, 2, 6, 10, 5, 6, 9, 6, 2, 4, 7]
    table = pd.DataFrame({"rating": values, "who": [*"ABCD"] * 6})
    return table.assign(walker=np.repeat(range(6), 4))


def test_agreement_is_that_of_shrout_and_fleiss() -> None:
    found = ew.agreement(ratings(), **RATINGS)
    value = found.coefficients["value"]
    assert value.round(2).tolist() == [0.29, 0.62, 0.71, 0.91, 0.91]
    interval = found.coefficients.loc["ICC(A,1)", ["low", "high"]].astype(float).round(2)
    assert interval.tolist() == [0.02, 0.76]
    interval = found.coefficients.loc["ICC(C,1)", ["low", "high"]].astype(float).round(2)
    assert interval.tolist() == [0.34, 0.95]
    assert found.message == "24 ratings of 6 walkers by 4 observers."
    assert found.walkers["rating"].tolist() == pytest.approx([6, 3, 6.5, 4, 7.5, 4.75])
    assert found.observers["mean"].round(2).tolist() == [7.67, 2.5, 4.33, 6.67]


def test_missing_cells_are_said_and_change_little() -> None:
    rng = np.random.default_rng(0)
    Y = rng.normal(size=(30, 1)) + rng.normal(size=8) * 0.5 + rng.normal(size=(30, 8))
    cells = pd.MultiIndex.from_product([range(30), range(8)], names=["walker", "who"])
    table = cells.to_frame(index=False).assign(rating=Y.ravel())
    whole = ew.agreement(table, **RATINGS)
    part = ew.agreement(table.drop(index=[3, 50, 51, 77]), **RATINGS)
    assert part.n_missing == 4
    assert "4 of 240 cells are missing" in part.message
    rows = ["ICC(A,1)", "ICC(C,k)"]
    assert (part.coefficients["value"] - whole.coefficients["value"])[rows].abs().max() < 0.03


def test_ratings_that_do_not_vary_or_of_one_observer_are_refused() -> None:
    with pytest.raises(ValueError, match="do not vary"):
        ew.agreement(ratings().assign(rating=3), **RATINGS)
    with pytest.raises(ValueError, match="1 observers for 6 walkers"):
        ew.agreement(ratings().query("who == 'A'"), **RATINGS)
