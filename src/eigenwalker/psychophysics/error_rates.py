"""How often observers misjudge walkers: rates by observer and condition, means of conditions."""

from __future__ import annotations

import numpy as np
import pandas as pd
from scipy.stats import t as t_distribution

from eigenwalker.psychophysics.answer_table import (
    cell_means,
    groups_of,
    levels_of,
    take_columns,
    written,
)


def error_rates(
    table: pd.DataFrame,
    *,
    response: str,
    truth: str,
    observer: str,
    within: str,
    between: str | None = None,
) -> pd.DataFrame:
    r"""Return the share of wrong answers of each observer in each condition.

    Parameters
    ----------
    table : DataFrame
        One row a trial.
    response, truth : str
        Columns of the class answered, such as "male", and of the walker's own. Where the answer is
        empty the trial counts as unanswered, in no rate.
    observer, within : str
        Columns of the observer and of the condition.
    between : str, optional
        Column of the observers' group.

    Returns
    -------
    DataFrame
        A row for each observer and condition that occurs: ``observer``, ``between``, ``within``,
        ``answers``, ``unanswered``, ``errors``, ``error_rate`` (NaN without answers) and
        ``arcsine``, :math:`2 \arcsin \sqrt{rate}`, whose variance depends less on the rate.

    Raises
    ------
    ValueError
        If a column is missing, or an answer is none of the walkers' classes.

    See Also
    --------
    condition_means : Means of the conditions, with intervals.
    mixed_anova : Takes the rates.
    sensitivity : Parts bias from sensitivity.

    References
    ----------
    Troje (2002), fig. 5.

    Examples
    --------
    >>> table = pd.DataFrame(
    ...     {
    ...         "observer": ["Eva"] * 4,
    ...         "info": ["full", "full", "structure", "structure"],
    ...         "sex": ["female", "male", "female", "male"],
    ...         "answer": ["female", "female", "female", "male"],
    ...     }
    ... )
    >>> rates = error_rates(
    ...     table, response="answer", truth="sex", observer="observer", within="info"
    ... )
    >>> rates[["within", "answers", "errors", "error_rate"]].values.tolist()
    [['full', 2, 1, 0.5], ['structure', 2, 0, 0.0]]

    """
    columns = {"response": response, "truth": truth, "observer": observer, "within": within}
    taken = judged(table, **columns, **({"between": between} if between else {}))
    keys = ["observer", *(["between"] if between else []), "within"]
    cells = taken.groupby(keys, observed=True, sort=False)["error"]
    rates = cells.agg(answers="count", shown="size", errors="sum").reset_index()
    rates["unanswered"] = rates.pop("shown") - rates["answers"]
    rates["errors"] = rates["errors"].astype(int)
    rates["error_rate"] = rates["errors"] / rates["answers"].where(rates["answers"] > 0)
    rates["arcsine"] = 2 * np.arcsin(np.sqrt(rates["error_rate"]))
    return rates[[*keys, "answers", "unanswered", "errors", "error_rate", "arcsine"]]


def condition_means(
    table: pd.DataFrame,
    *,
    dv: str,
    between: str,
    within: str,
    subject: str,
    confidence: float = 0.95,
) -> pd.DataFrame:
    r"""Return the mean of each condition in each group, with intervals within observers.

    Before the interval each observer's own mean is replaced by that of the group: conditions are
    compared within observers, and how observers differ altogether does not matter to it. The
    variance that is left is multiplied by b / (b - 1) for b conditions.

    Parameters
    ----------
    table : DataFrame
        One row an observation, as for `mixed_anova`.
    dv, between, within, subject : str
        Columns, as in `mixed_anova`.
    confidence : float
        Of the intervals.

    Returns
    -------
    DataFrame
        A row a group and condition: ``between``, ``within``, ``observers``, ``mean``, ``sd`` over
        observers, ``low`` and ``high`` of the interval within observers, ``low_between`` and
        ``high_between`` of that which takes differences between observers in.

    Raises
    ------
    ValueError
        As `mixed_anova` does.

    See Also
    --------
    error_rates : Makes the table.

    References
    ----------
    Morey (2008), Confidence intervals from normalized data: a correction to Cousineau (2005).

    Examples
    --------
    >>> rates = [0.1, 0.3, 0.2, 0.3, 0.4, 0.5, 0.5, 0.8]
    >>> table = pd.DataFrame({"rate": rates, "info": ["full", "structure"] * 4})
    >>> table["observer"] = np.repeat(["Ada", "Eva", "Ben", "Tom"], 2)
    >>> table["view"] = np.repeat([0, 90], 4)
    >>> means = condition_means(table, dv="rate", between="view", within="info", subject="observer")
    >>> means["mean"].round(2).tolist()
    [0.15, 0.3, 0.45, 0.65]

    """
    columns = {"dv": dv, "between": between, "within": within, "subject": subject}
    taken = take_columns(table, columns, numbers=("dv",))
    means = cell_means(taken)
    group = groups_of(taken, means.index, between)
    rows = []
    for name in levels_of(group):
        values = means[(group == name).to_numpy()]
        n, b = values.shape
        own = values.sub(values.mean(axis=1), axis=0) + values.to_numpy().mean()
        sd_within = own.std(ddof=1) * np.sqrt(b / (b - 1)) if b > 1 else values.std(ddof=1)
        half = t_distribution.isf((1 - confidence) / 2, n - 1) / np.sqrt(n)
        for level in values:
            mean, sd = values[level].mean(), values[level].std(ddof=1)
            within_half = half * sd_within[level]
            rows.append(
                {
                    "between": name,
                    "within": level,
                    "observers": n,
                    "mean": mean,
                    "sd": sd,
                    "low": mean - within_half,
                    "high": mean + within_half,
                    "low_between": mean - half * sd,
                    "high_between": mean + half * sd,
                }
            )
    return pd.DataFrame(rows)


def judged(table: pd.DataFrame, **columns: str) -> pd.DataFrame:
    """Return columns, and ``error``: 1 where the response is not the truth, NaN if unanswered."""
    taken = take_columns(table, columns, empty=("response",))
    classes, answered = set(taken["truth"]), taken["response"].notna()
    foreign = answered & ~taken["response"].isin(classes)
    if foreign.any():
        row = int(foreign.to_numpy().argmax())
        answer = taken["response"].iloc[row]
        raise ValueError(
            f"Line {row + 2} of the table has the answer {written(answer)} in the column "
            f"{columns['response']!r}; expected one of the classes of {columns['truth']!r}, "
            f"{sorted(map(str, classes))[:6]}, or an empty cell where there was no answer. Rename "
            "keys to classes first."
        )
    wrong = taken["response"].astype(object) != taken["truth"].astype(object)
    taken["error"] = wrong.astype(float).where(answered)
    return taken
