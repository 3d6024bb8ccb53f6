"""Scheffé's test of which levels within observers differ."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pandas as pd
from scipy.stats import f as f_distribution

from eigenwalker.psychophysics.answer_table import take_columns
from eigenwalker.psychophysics.mixed_anova import strata_of


def scheffe(
    table: pd.DataFrame,
    *,
    dv: str,
    between: str,
    within: str,
    subject: str,
    confidence: float = 0.95,
) -> pd.DataFrame:
    r"""Return which levels within observers differ, with a level of error for all pairs together.

    For each pair of levels, with d the difference of their means over a groups of n_k observers,
    each group weighing the same, and b levels:

    .. math::
        F_S = \frac{d^2}{MS_{error}\;2 \sum_k (1 / n_k) / a^2} \Big/ (b - 1)

    on b - 1 and (N - a)(b - 1) degrees of freedom, with the error of the factor within.

    Parameters
    ----------
    table : DataFrame
        One row an observation, or several for a cell, which are averaged first.
    dv, between, within, subject : str
        Columns, as in `mixed_anova`.
    confidence : float
        Of the intervals, which hold for all pairs together.

    Returns
    -------
    DataFrame
        A row a pair of levels, ``A`` and ``B`` in order of appearance: ``difference`` (A - B),
        ``se``, ``low``, ``high``, ``F`` (F_S), ``df1``, ``df2`` and ``p``. ``attrs`` say of how
        many ``observers`` and ``observations`` it is.

    Raises
    ------
    ValueError
        As `mixed_anova` does.

    See Also
    --------
    mixed_anova : Whether any levels differ.

    References
    ----------
    Troje (2002), section "Psychophysical experiment"; Scheffé (1953).

    Examples
    --------
    >>> rates = [0.1, 0.3, 0.2, 0.3, 0.4, 0.5, 0.5, 0.8]
    >>> table = pd.DataFrame({"error_rate": rates, "info": ["full", "structure"] * 4})
    >>> table["observer"] = np.repeat(["Ada", "Eva", "Ben", "Tom"], 2)
    >>> table["view"] = np.repeat([0, 90], 4)
    >>> pairs = scheffe(table, dv="error_rate", between="view", within="info", subject="observer")
    >>> pairs[["A", "B", "difference", "p"]].round(3).values.tolist()
    [['full', 'structure', -0.175, 0.089]]

    """
    columns = {"dv": dv, "between": between, "within": within, "subject": subject}
    taken = take_columns(table, columns, numbers=("dv",))
    strata = strata_of(taken, between=between, within=within)
    means = strata.group_means.mean(axis=0)
    mean_square, df2 = strata.error_within / strata.df_within, strata.df_within
    se = np.sqrt(mean_square * 2 * (1 / strata.counts).sum() / len(strata.counts) ** 2)
    levels, df1 = list(strata.means.columns), len(means) - 1
    half = np.sqrt(df1 * f_distribution.isf(1 - confidence, df1, df2)) * se
    rows = []
    for first, second in combinations(range(len(levels)), 2):
        d = means[first] - means[second]
        F = (d / se) ** 2 / df1
        test = {"F": F, "df1": df1, "df2": df2, "p": f_distribution.sf(F, df1, df2)}
        interval = {"low": d - half, "high": d + half}
        pair = {"A": levels[first], "B": levels[second], "difference": d, "se": se}
        rows.append({**pair, **interval, **test})
    result = pd.DataFrame(rows)
    result.attrs = {"observers": len(strata.means), "observations": len(taken)}
    return result
