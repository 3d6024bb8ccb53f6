"""Mixed ANOVA and Scheffé's test: R's results, published answers, designs done by hand."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.stats import f_oneway, ttest_ind

import eigenwalker as ew

NAMES = {"dv": "dv", "between": "between", "within": "within", "subject": "observer"}


def design(sizes: tuple[int, ...] = (5, 5, 5), n_levels: int = 3, seed: int = 0) -> pd.DataFrame:
    rng = np.random.default_rng(seed)
    group = np.repeat(np.arange(len(sizes)), sizes)
    values = (
        rng.normal(size=(len(group), n_levels)) + rng.normal(size=(len(group), 1)) + group[:, None]
    )
    return pd.DataFrame(
        {
            "observer": np.repeat([f"o{i}" for i in range(len(group))], n_levels),
            "between": np.repeat([f"g{k}" for k in group], n_levels),
            "within": np.tile([f"c{j}" for j in range(n_levels)], len(group)),
            "dv": values.ravel(),
        }
    )


def test_results_are_those_of_afex_and_emmeans(r_results: Path) -> None:
    designs = pd.read_csv(r_results / "mixed_designs.csv")
    anovas = pd.read_csv(r_results / "mixed_anova_afex.csv")
    pairs = pd.read_csv(r_results / "scheffe_emmeans.csv")
    columns = ["F", "df1", "df2", "p", "mauchly_w", "mauchly_p", "eps_gg", "p_gg", "eps_hf", "p_hf"]
    for number, table in designs.groupby("design"):
        stored = anovas[anovas["design"] == number].reset_index()
        found = ew.mixed_anova(table, **NAMES)
        for column in [*columns, "partial_eta2"]:
            there = stored[column].notna()
            if column in ("eps_gg", "p_gg", "eps_hf", "p_hf"):
                there &= stored["eps_gg"] > 0  # R writes 0 where there is no correction
            np.testing.assert_allclose(
                found[column][there], stored[column][there], rtol=1e-9, atol=1e-9, err_msg=column
            )
        tests = ew.scheffe(table, **NAMES)
        expected = pairs[pairs["design"] == number]
        assert (tests["A"] + " - " + tests["B"]).tolist() == expected["contrast"].tolist()
        for ours, theirs in (("difference", "estimate"), ("se", "se"), ("p", "p_scheffe")):
            np.testing.assert_allclose(tests[ours], expected[theirs], rtol=1e-9, atol=1e-9)


def test_published_answers_give_the_published_tests() -> None:
    """Pastukhov (2017); the licence of its data stands beside them."""
    table = pd.read_csv(Path(__file__).with_name("ambiguous_walker_shares.csv"))
    found = ew.mixed_anova(
        table, dv="share", between="Group", within="Condition", subject="Observer"
    )
    assert found["source"].tolist() == ["Group", "Condition", "Group * Condition"]
    assert found["F"].round(3).tolist() == [25.669, 51.586, 12.208]
    assert found[["df1", "df2"]].to_numpy().tolist() == [[1, 34], [3, 102], [3, 102]]
    assert found["eps_gg"].round(4).tolist()[1:] == [0.7641, 0.7641]
    assert found["mauchly_w"].round(4).tolist()[1:] == [0.5215, 0.5215]
    assert found.attrs == {"observers": 36, "observations": 144}


def test_two_groups_and_levels_are_the_known_t_tests() -> None:
    table = design((4, 7), 2)
    found = ew.mixed_anova(table, **NAMES)
    wide = table.pivot(index="observer", columns="within", values="dv")
    group = table.groupby("observer")["between"].first()
    means, gains = wide.mean(axis=1), wide["c0"] - wide["c1"]
    for row, values in ((0, means), (2, gains)):
        t, p = ttest_ind(values[group == "g0"], values[group == "g1"])
        assert found["F"][row] == pytest.approx(t**2)
        assert found["p"][row] == pytest.approx(p)
    assert found.loc[1:, ["eps_gg", "eps_hf"]].to_numpy().tolist() == [[1, 1], [1, 1]]
    assert found["mauchly_w"].isna().all()
    pair = ew.scheffe(table, **NAMES)
    assert pair["F"][0] == pytest.approx(found["F"][1])
    assert pair["p"][0] == pytest.approx(found["p"][1])


def test_group_test_is_the_one_way_anova_of_observers_means() -> None:
    table = design((3, 6, 4), 4)
    means = table.groupby(["between", "observer"])["dv"].mean()
    F = f_oneway(*(means[group] for group in ("g0", "g1", "g2")))[0]
    assert ew.mixed_anova(table, **NAMES)["F"][0] == pytest.approx(F)


def test_equal_groups_give_the_formulas_of_the_paper() -> None:
    """SPEC 2A: sums of squares of Troje (2002), and Scheffé's F with the error of INFO."""
    table = design()
    y = table["dv"].to_numpy().reshape(3, 5, 3)  # group, observer, level
    M, M_k, M_i, M_s, M_ki = y.mean(), y.mean((1, 2)), y.mean((0, 1)), y.mean(2), y.mean(1)
    ss_info = 15 * ((M_i - M) ** 2).sum()
    ss_both = 5 * ((M_ki - M_k[:, None] - M_i + M) ** 2).sum()
    error = ((y - M_ki[:, None] - M_s[..., None] + M_k[:, None, None]) ** 2).sum() / 24
    found = ew.mixed_anova(table, **NAMES)
    assert found["F"][1:].tolist() == pytest.approx([ss_info / 2 / error, ss_both / 4 / error])
    F_s = (M_i[0] - M_i[2]) ** 2 / (error * 2 / 15) / 2
    assert ew.scheffe(table, **NAMES)["F"][1] == pytest.approx(F_s)


def test_order_of_rows_and_answers_one_by_one_do_not_matter() -> None:
    table = design((3, 4), 3)
    once = ew.mixed_anova(table, **NAMES)
    twice = pd.concat([table.assign(dv=table["dv"] - 1), table.assign(dv=table["dv"] + 1)])
    again = ew.mixed_anova(twice.sample(frac=1, random_state=0), **NAMES)
    pd.testing.assert_frame_equal(once, again, rtol=1e-9)
    assert again.attrs["observations"] == 2 * once.attrs["observations"]


def test_scheffe_s_intervals_exclude_zero_exactly_where_p_is_small() -> None:
    table = design((6, 4), 5, seed=3)
    found = ew.scheffe(table.assign(dv=table["dv"] + (table["within"] == "c4") * 2), **NAMES)
    clear = found["p"] < 0.05
    assert 0 < clear.sum() < len(clear)
    assert ((found["low"] > 0) | (found["high"] < 0)).equals(clear)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda t: t.drop(columns="dv"), "Columns are missing: dv='dv'"),
        (lambda t: t.assign(dv=np.where(t.index == 3, np.nan, t["dv"])), "Line 5 .* 'dv'.* finite"),
        (lambda t: t.assign(dv=np.where(t.index == 3, np.inf, t["dv"])), "Line 5 .* finite"),
        (lambda t: t.assign(dv="much"), "Line 2 .*'much'"),
        (lambda t: t.drop(index=4), "Observer 'o1' has no answers at the level 'c1'"),
        (lambda t: t.assign(between=np.where(t.index == 1, "g2", t["between"])), "'o0' is in two"),
        (lambda t: t[t["between"] == "g0"], "All 5 observers are in one group, 'g0'"),
        (lambda t: t[t["within"] == "c0"], "All observations are at one level, 'c0'"),
        (lambda t: t[t["observer"] != "o1"].iloc[9:], "'g0' .* has one observer, 'o4'"),
        (lambda t: t.assign(dv=0.5), "do not differ at all; all 45 cells are 0.5"),
        (lambda t: t.assign(observer=None), "Line 2 .* empty cell in the column 'observer'"),
        (lambda t: t.iloc[:0], "has no rows"),
    ],
)
def test_bad_tables_get_one_sentence(change, message: str) -> None:
    for function in (ew.mixed_anova, ew.scheffe):
        with pytest.raises(ValueError, match=message):
            function(change(design()), **NAMES)


def test_one_column_for_two_things_is_refused() -> None:
    with pytest.raises(ValueError, match="'between' is taken for two things, between and within"):
        ew.mixed_anova(design(), **{**NAMES, "within": "between"})
