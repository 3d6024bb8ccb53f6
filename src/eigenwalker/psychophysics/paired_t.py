"""The paired t test of two conditions within observers."""

from __future__ import annotations

from typing import Literal

import pandas as pd
from scipy.stats import ttest_rel

from eigenwalker.psychophysics.answer_table import cell_means, take_columns


def paired_t(
    table: pd.DataFrame,
    *,
    dv: str,
    within: str,
    subject: str,
    first: object,
    second: object,
    alternative: Literal["two-sided", "less", "greater"] = "two-sided",
    confidence: float = 0.95,
) -> pd.Series:
    """Return the paired t test of two conditions, with the sidedness that was taken.

    Parameters
    ----------
    table : DataFrame
        One row an observation, or several for a cell, which are averaged first; of one group, if
        only that is asked about.
    dv, within, subject : str
        Columns of the dependent variable, the condition and the observer.
    first, second : object
        The two conditions; differences are first - second.
    alternative : {"two-sided", "less", "greater"}
        What the difference is expected to be.
    confidence : float
        Of the two-sided interval of the difference.

    Returns
    -------
    Series
        ``difference`` (of the means), ``low``, ``high``, ``t``, ``df``, ``p``, ``alternative``,
        ``d_z`` (difference in standard deviations of the differences) and ``observers``.

    Raises
    ------
    ValueError
        If a condition does not occur, an observer lacks one, there are fewer than two observers,
        or all have the same difference.

    See Also
    --------
    scheffe : All pairs of conditions at once.

    References
    ----------
    Troje (2002), section "Psychophysical experiment": full against structure in frontal view.

    Examples
    --------
    >>> table = pd.DataFrame({"rate": [0.2, 0.3, 0.1, 0.4], "info": ["full", "structure"] * 2})
    >>> table["observer"] = ["Ada", "Ada", "Eva", "Eva"]
    >>> conditions = {"first": "structure", "second": "full"}
    >>> test = paired_t(table, dv="rate", within="info", subject="observer", **conditions)
    >>> print(f"t({test['df']}) = {test['t']:.2f}")
    t(1) = 2.00

    """
    taken = take_columns(table, {"dv": dv, "within": within, "subject": subject}, numbers=("dv",))
    levels = taken["within"].unique().tolist()
    if first == second or not {first, second} <= set(levels):
        raise ValueError(
            f"Expected two different levels of {within!r}, of {levels[:20]}; got {first!r} and "
            f"{second!r}."
        )
    means = cell_means(taken[taken["within"].isin([first, second])])
    gains = means[first] - means[second]
    if len(gains) < 2 or gains.std() <= 1e-12 * abs(gains).max():
        raise ValueError(
            f"The difference of {first!r} and {second!r} does not vary over {len(gains)} "
            "observers; a t test needs two or more who differ."
        )
    test = ttest_rel(means[first], means[second], alternative=alternative)
    both = ttest_rel(means[first], means[second]).confidence_interval(confidence)
    found = {"difference": gains.mean(), "low": both.low, "high": both.high, "t": test.statistic}
    found |= {"df": int(test.df), "p": test.pvalue, "alternative": alternative}
    return pd.Series({**found, "d_z": gains.mean() / gains.std(), "observers": len(gains)})
