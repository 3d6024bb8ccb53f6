"""Analysis of variance with one factor between observers and one within them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pandas as pd
from scipy.linalg import helmert
from scipy.stats import chi2, f as f_distribution

from eigenwalker.psychophysics.answer_table import (
    cell_means,
    groups_of,
    levels_of,
    take_columns,
    written,
)

_NO_VARIANCE = 1e-20
"""Share of the sum of squares below which observers do not vary but for rounding."""


class Strata(NamedTuple):
    """What all tests of a mixed design are made of."""

    means: pd.DataFrame
    """Mean of each observer (rows) at each level within."""
    group_means: np.ndarray
    """Of shape (group, level)."""
    counts: np.ndarray
    """Observers in each group."""
    contrasts: np.ndarray
    """Orthonormal contrasts of the levels, (level - 1, level)."""
    between_residuals: np.ndarray
    """Each observer's mean less that of the group."""
    within_residuals: np.ndarray
    """Contrasts of each observer less those of the group, (observer, level - 1)."""

    @property
    def df_between(self) -> int:
        """Degrees of freedom of observers within groups."""
        return len(self.means) - len(self.counts)

    @property
    def df_within(self) -> int:
        """Degrees of freedom of the error of the factor within."""
        return self.df_between * len(self.contrasts)

    @property
    def error_within(self) -> float:
        """Sum of squares of the error of the factor within, and of the interaction."""
        return float((self.within_residuals**2).sum())


def mixed_anova(
    table: pd.DataFrame, *, dv: str, between: str, within: str, subject: str
) -> pd.DataFrame:
    r"""Return the analysis of variance of a factor between and a factor within observers.

    Sums of squares are of type III: with groups of unequal size each group's mean counts the same,
    as in R's afex. Tests of the factor within and of the interaction assume that differences
    between levels vary alike (sphericity); Mauchly's test of it stands beside them, with the
    corrections of Greenhouse & Geisser and of Huynh & Feldt, for which both degrees of freedom are
    multiplied by an epsilon. They come from the covariance S of q = b - 1 orthonormal contrasts of
    the b levels, pooled within the a groups of N observers:

    .. math::
        \epsilon_{GG} = \frac{(\mathrm{tr}\,S)^2}{q\,\mathrm{tr}(S^2)}, \qquad
        \epsilon_{HF} = \frac{(N - a + 1)\,q\,\epsilon_{GG} - 2}{q\,(N - a - q\,\epsilon_{GG})}

    The second is as Lecoutre corrected it. It can exceed 1, and counts as 1 in the test.

    Parameters
    ----------
    table : DataFrame
        One row an observation, or several for a cell, which are averaged first.
    dv : str
        Column of the dependent variable, such as an error rate.
    between : str
        Column of the observers' group.
    within : str
        Column of the condition, of which each observer has all levels.
    subject : str
        Column of the observer.

    Returns
    -------
    DataFrame
        Three rows, whose ``source`` is `between`, `within` and ``f"{between} * {within}"``, with
        ``F``, ``df1``, ``df2`` and ``p`` (uncorrected), ``p_gg``, ``p_hf``, ``eps_gg``, ``eps_hf``,
        ``mauchly_w``, ``mauchly_p``, ``partial_eta2`` and ``generalised_eta2``. Of the factor
        between, and of two levels within (where epsilon is 1), no sphericity is reported (NaN).
        ``attrs`` say of how many ``observers`` and ``observations`` it is.

    Raises
    ------
    ValueError
        If a column is missing, or no finite number; an observer is in two groups or lacks a level;
        a group has one observer; there is one group or level; or observers do not vary.

    See Also
    --------
    scheffe : Which levels differ.
    crossed_logistic : Answers one by one, with walkers as a random factor too.

    References
    ----------
    Troje (2002), section "Psychophysical experiment": VIEW between and INFO within observers.
    Greenhouse & Geisser (1959); Huynh & Feldt (1976); Lecoutre (1991); Olejnik & Algina (2003).

    Examples
    --------
    >>> rates = [0.1, 0.3, 0.2, 0.3, 0.4, 0.5, 0.5, 0.8]
    >>> table = pd.DataFrame({"error_rate": rates, "info": ["full", "structure"] * 4})
    >>> table["observer"] = np.repeat(["Ada", "Eva", "Ben", "Tom"], 2)
    >>> table["view"] = np.repeat([0, 90], 4)
    >>> anova = mixed_anova(
    ...     table, dv="error_rate", between="view", within="info", subject="observer"
    ... )
    >>> anova[["source", "F", "df1", "df2"]].round(2).values.tolist()
    [['view', 9.94, 1, 2], ['info', 9.8, 1, 2], ['view * info', 0.2, 1, 2]]

    """
    columns = {"dv": dv, "between": between, "within": within, "subject": subject}
    taken = take_columns(table, columns, numbers=("dv",))
    strata = strata_of(taken, between=between, within=within)
    counts, n_levels = strata.counts, len(strata.contrasts) + 1
    row_means = strata.group_means.mean(axis=1)
    ss_between = n_levels * counts @ (row_means - counts @ row_means / counts.sum()) ** 2
    error_between = n_levels * (strata.between_residuals**2).sum()
    contrasts = strata.group_means @ strata.contrasts.T
    ss_within = (contrasts.mean(axis=0) ** 2).sum() / ((1 / counts).sum() / len(counts) ** 2)
    deviations = contrasts - counts @ contrasts / counts.sum()
    ss_interaction = (counts @ deviations**2).sum()
    error_within, df_within = strata.error_within, strata.df_within
    squares = np.array([ss_between, ss_within, ss_interaction])
    errors = np.array([error_between, error_within, error_within])
    df1 = np.array([1, n_levels - 1, n_levels - 1]) * [len(counts) - 1, 1, len(counts) - 1]
    df2 = np.array([strata.df_between, df_within, df_within])
    F = squares / df1 / (errors / df2)
    epsilon = _epsilons(strata.within_residuals, strata.df_between)
    w, w_p = _mauchly(strata.within_residuals, strata.df_between)
    both = np.array([np.nan, 1, 1])  # the two tests within observers
    corrected = {
        f"p_{name}": both * f_distribution.sf(F, min(eps, 1) * df1, min(eps, 1) * df2)
        for name, eps in epsilon.items()
    }
    result = pd.DataFrame(
        {
            "source": [between, within, f"{between} * {within}"],
            "F": F,
            "df1": df1,
            "df2": df2,
            "p": f_distribution.sf(F, df1, df2),
            **corrected,
            **{f"eps_{name}": both * eps for name, eps in epsilon.items()},
            "mauchly_w": both * w,
            "mauchly_p": both * w_p,
            "partial_eta2": squares / (squares + errors),
            "generalised_eta2": squares / (squares + error_between + error_within),
        }
    )
    result.attrs = {"observers": len(strata.means), "observations": len(taken)}
    return result


def strata_of(taken: pd.DataFrame, *, between: str, within: str) -> Strata:
    """Return the means and residuals of a mixed design, from columns as `take_columns` has them."""
    means = cell_means(taken)
    if means.shape[1] < 2:
        raise ValueError(
            f"All observations are at one level, {written(means.columns[0])}, of {within!r}; "
            "expected two levels or more."
        )
    group = groups_of(taken, means.index, between)
    codes = pd.Categorical(group, categories=levels_of(group)).codes
    members = (codes == np.arange(codes.max() + 1)[:, None]).astype(float)  # group x observer
    counts = members.sum(axis=1)
    values = means.to_numpy()
    group_means = members @ values / counts[:, None]
    residuals = values - group_means[codes]
    contrasts = helmert(means.shape[1])
    within_residuals = residuals @ contrasts.T
    strata = Strata(means, group_means, counts, contrasts, residuals.mean(axis=1), within_residuals)
    total = ((values - values.mean()) ** 2).sum()
    between_error = (strata.between_residuals**2).sum()
    if min(strata.error_within, between_error) <= _NO_VARIANCE * max(total, values.max() ** 2):
        where = "" if total > 0 else f"; all {values.size} cells are {values.flat[0]:g}"
        raise ValueError(
            f"Observers of a group do not differ at all{where}; an ANOVA needs variance between "
            "observers, and between them in the effect of the levels."
        )
    return strata


def _epsilons(residuals: np.ndarray, df: int) -> dict[str, float]:
    """Return Greenhouse & Geisser's and Huynh & Feldt's epsilon, the latter after Lecoutre."""
    q = residuals.shape[1]
    if q == 1:
        return {"gg": 1.0, "hf": 1.0}
    squares = residuals.T @ residuals
    gg = np.trace(squares) ** 2 / (q * (squares**2).sum())
    rest = q * (df - q * gg)
    return {"gg": float(gg), "hf": ((df + 1) * q * gg - 2) / rest if rest > 0 else 1.0}


def _mauchly(residuals: np.ndarray, df: int) -> tuple[float, float]:
    """Return Mauchly's W and its p, by the second-order approximation that R has."""
    q = residuals.shape[1]
    if q == 1 or df < q:
        return np.nan, np.nan
    squares = residuals.T @ residuals
    log_w = np.linalg.slogdet(squares)[1] - q * np.log(np.trace(squares) / q)
    rho = 1 - (2 * q**2 + q + 2) / (6 * q * df)
    # Anderson (1958) has 3 q; R has 3 (q + 1), and its p are the ones that are published
    second = (q + 2) * (q - 1) * (q - 2) * (2 * q**3 + 6 * q**2 + 3 * (q + 1) + 2)
    second /= 288 * (df * q * rho) ** 2
    z, df_chi = -df * rho * log_w, q * (q + 1) / 2 - 1
    first = chi2.sf(z, df_chi)
    return float(np.exp(log_w)), float(first + second * (chi2.sf(z, df_chi + 4) - first))
