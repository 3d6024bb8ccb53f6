"""Which walkers are misjudged, how reliably, and whether classifiers are unsure of the same."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pandas as pd
from scipy.stats import rankdata

from eigenwalker.core.arguments import check_kind
from eigenwalker.psychophysics.error_rates import judged
from eigenwalker.psychophysics.rank_correlation import rank_correlation, spearman_critical

_SPLITS = 100
_SAMPLES = 200


def walker_errors(
    table: pd.DataFrame,
    *,
    response: str,
    truth: str,
    walker: str,
    within: str,
    observer: str,
) -> pd.DataFrame:
    """Return how often each walker is misjudged in each condition, and its rank.

    Parameters
    ----------
    table : DataFrame
        One row a trial. Those without an answer (empty cells) do not count.
    response, truth, walker, within, observer : str
        Columns of the class answered, the walker's own, the walker, condition and observer.

    Returns
    -------
    DataFrame
        A row for each walker and condition: ``walker``, ``within``, ``truth``, ``answers``,
        ``errors``, ``error_rate``, ``rank`` (1 is misjudged most often; ties get average ranks).

    Raises
    ------
    ValueError
        If a column is missing, an answer is none of the classes, or a walker is of two.

    See Also
    --------
    confidence_correlations : Compares the order with that of classifiers.

    References
    ----------
    Troje (2002), section "Item analysis".

    Examples
    --------
    >>> table = pd.DataFrame({"walker": ["a", "a", "b", "b"], "sex": ["female"] * 2 + ["male"] * 2})
    >>> table["answer"] = ["female", "male", "male", "male"]
    >>> columns = {"response": "answer", "truth": "sex", "walker": "walker"}
    >>> table = table.assign(info="full", observer="Eva")
    >>> walker_errors(table, **columns, within="info", observer="observer")["rank"].tolist()
    [1.0, 2.0]

    """
    columns = {"response": response, "truth": truth, "walker": walker, "within": within}
    return _counts(judged(table, **columns, observer=observer))


def confidence_correlations(
    table: pd.DataFrame,
    confidence: pd.DataFrame,
    *,
    response: str,
    truth: str,
    walker: str,
    within: str,
    observer: str,
    random_state: int = 0,
) -> pd.DataFrame:
    """Return rank correlations of misjudgements with classifiers' confidence, as in Table 1.

    Counts of errors are correlated with -z, so that walkers that are misjudged often and those that
    a classifier is least sure of come first in both: agreement is positive, as printed. The ceiling
    is what the truth itself would reach, the square root of the counts' own reliability: counts of
    random halves of the observers are correlated, and corrected for length (Spearman & Brown).

    Parameters
    ----------
    table : DataFrame
        One row a trial.
    confidence : DataFrame
        A row a walker, a column a classifier: z_j, positive where the walker is classified
        correctly (eq. 14).
    response, truth, walker, within, observer : str
        Columns of the table, as in `walker_errors`.
    random_state : int
        Seed of permutations, halves and resampled walkers.

    Returns
    -------
    DataFrame
        A row for each classifier and condition: ``classifier``, ``within``, ``rho``, ``p`` (by
        permutation, one-sided), ``p_two_sided``, ``walkers``, ``critical`` (one-sided, .01, as the
        paper has it), ``ceiling``, ``ceiling_low`` and ``ceiling_high`` (95 %, over walkers).

    Raises
    ------
    ValueError
        As `walker_errors`, or if walkers of the table have no confidence.

    See Also
    --------
    walker_errors : The counts.
    rank_correlation : One of the correlations.

    References
    ----------
    Troje (2002), eq. 14 and Table 1.

    Examples
    --------
    >>> table = pd.DataFrame({"walker": ["a", "b", "c"] * 2, "sex": "male", "info": "full"})
    >>> table["answer"] = ["female", "male", "male"] * 2
    >>> table["observer"] = ["Ada"] * 3 + ["Eva"] * 3
    >>> z = pd.DataFrame({"size alone": [-1.0, 2.0, 2.5]}, index=["a", "b", "c"])
    >>> table.loc[0, "sex"] = table.loc[3, "sex"] = "female"
    >>> table.loc[[0, 3], "answer"] = "male"
    >>> columns = {"response": "answer", "truth": "sex", "walker": "walker"}
    >>> columns |= {"within": "info", "observer": "observer"}
    >>> confidence_correlations(table, z, **columns)["rho"].round(3).tolist()
    [0.866]

    """
    check_kind(confidence, pd.DataFrame, "a table of walkers by classifiers (a pandas DataFrame)")
    columns = {"response": response, "truth": truth, "walker": walker, "within": within}
    taken = judged(table, **columns, observer=observer)
    counts = _counts(taken)
    names = {str(name): name for name in confidence.index}
    if unknown := sorted({str(name) for name in counts["walker"]} - set(names)):
        raise ValueError(
            f"The walkers {unknown[:6]} of the answers are none of those of the classifiers, "
            f"{list(names)[:6]}; take the population that was shown."
        )
    rows = []
    for level, of_level in counts.groupby("within", observed=True, sort=False):
        shown = of_level[of_level["answers"] > 0]
        rates = shown["error_rate"].to_numpy()
        ceiling = reliability_ceiling(taken[taken["within"] == level], random_state=random_state)
        z = confidence.loc[[names[str(each)] for each in shown["walker"]]]
        for classifier in z:
            found = rank_correlation(rates, -z[classifier].to_numpy(), random_state=random_state)
            rows.append(
                {
                    "classifier": classifier,
                    "within": level,
                    "rho": found.rho,
                    "p": found.p,
                    "p_two_sided": found.p_two_sided,
                    "walkers": found.n,
                    "critical": spearman_critical(found.n, 0.01),
                    "ceiling": ceiling.value,
                    "ceiling_low": ceiling.low,
                    "ceiling_high": ceiling.high,
                }
            )
    return pd.DataFrame(rows)


class Ceiling(NamedTuple):
    """The correlation that the truth itself would reach, and its 95 % interval."""

    value: float
    low: float
    high: float


def reliability_ceiling(taken: pd.DataFrame, *, random_state: int = 0) -> Ceiling:
    """Return the root of the corrected rank correlation of halves of the observers."""
    counted = taken[taken["error"].notna()]
    table = counted.pivot_table(
        index="walker", columns="observer", values="error", aggfunc=["sum", "count"], observed=True
    ).fillna(0)
    errors, answers = table["sum"].to_numpy(), table["count"].to_numpy()
    n_walkers, n_observers = errors.shape
    if n_observers < 2 or n_walkers < 3:
        return Ceiling(np.nan, np.nan, np.nan)
    rng = np.random.default_rng(random_state)
    halves = []
    for _ in range(_SPLITS):
        order = rng.permutation(n_observers)
        parts = order[: n_observers // 2], order[n_observers // 2 : n_observers // 2 * 2]
        sums = [(errors[:, part].sum(axis=1), answers[:, part].sum(axis=1)) for part in parts]
        halves.append([wrong / np.where(n, n, np.nan) for wrong, n in sums])
    draws = rng.integers(0, n_walkers, size=(_SAMPLES, n_walkers))
    rates = np.array(halves)
    value = _root_of_reliability(rates)
    samples = [_root_of_reliability(rates[:20, :, draw]) for draw in draws]
    known = [sample for sample in samples if np.isfinite(sample)]
    if not known:
        return Ceiling(value, np.nan, np.nan)
    return Ceiling(value, *map(float, np.quantile(known, [0.025, 0.975])))


def _root_of_reliability(halves: np.ndarray) -> float:
    """Return sqrt(2r / (1 + r)) of the mean rank correlation r of halves, (split, 2, walker)."""
    seen = np.isfinite(halves).all(axis=(0, 1))
    if seen.sum() < 3:
        return np.nan
    ranks = rankdata(halves[:, :, seen], axis=2)
    ranks -= ranks.mean(axis=2, keepdims=True)
    spread = np.sqrt((ranks**2).sum(axis=2).prod(axis=1))
    products = ranks.prod(axis=1).sum(axis=1)[spread > 0] / spread[spread > 0]
    if not len(products):
        return np.nan
    r = max(float(products.mean()), 0.0)
    return float(np.sqrt(2 * r / (1 + r)))


def _counts(taken: pd.DataFrame) -> pd.DataFrame:
    both = taken.drop_duplicates(["walker", "truth"])["walker"]
    if both.duplicated().any():
        raise ValueError(
            f"The walker {both[both.duplicated()].iloc[0]!r} is of two classes; expected one. "
            "Correct the column of the truth."
        )
    groups = taken.groupby(["walker", "within"], observed=True, sort=False)
    counts = groups.agg(
        truth=("truth", "first"), answers=("error", "count"), errors=("error", "sum")
    )
    counts = counts.reset_index()
    counts["error_rate"] = counts["errors"] / counts["answers"].where(counts["answers"] > 0)
    counts["errors"] = counts["errors"].astype(int)
    rates = counts.groupby("within", observed=True, sort=False)["error_rate"]
    counts["rank"] = rates.rank(ascending=False)
    return counts
