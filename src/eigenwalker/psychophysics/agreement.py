"""How alike observers rate the same walkers: intraclass correlations and Cronbach's alpha."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy.stats import f as f_distribution, t as t_distribution

from eigenwalker.psychophysics.answer_table import take_columns

NAMES = {
    "ICC(A,1)": "two-way random effects, absolute agreement, single rater",
    "ICC(A,k)": "two-way random effects, absolute agreement, mean of k raters",
    "ICC(C,1)": "two-way mixed effects, consistency, single rater",
    "ICC(C,k)": "two-way mixed effects, consistency, mean of k raters",
    "alpha": "Cronbach's alpha, of the raters as items",
}


@dataclass(frozen=True, eq=False)
class Agreement:
    """How alike observers rate walkers.

    Parameters
    ----------
    coefficients : DataFrame
        Indexed by name (``ICC(A,1)``, ``ICC(A,k)``, ``ICC(C,1)``, ``ICC(C,k)``, ``alpha``):
        ``meaning``, ``value``, ``low`` and ``high``.
    walkers : DataFrame
        A row a walker: ``rating`` (mean over observers), ``low``, ``high``, ``observers``.
    observers : DataFrame
        A row an observer's use of the scale: ``ratings``, ``mean``, ``sd``, ``lowest``,
        ``highest``, and ``with_others``: correlation with the mean of the others.
    n_ratings, n_missing : int
        Ratings, and cells of walker and observer without one.
    message : str
        Of how many ratings it is, and what was done where cells are missing.

    See Also
    --------
    agreement : makes it.
    """

    coefficients: pd.DataFrame
    walkers: pd.DataFrame
    observers: pd.DataFrame
    n_ratings: int
    n_missing: int
    message: str


def agreement(
    table: pd.DataFrame, *, rating: str, walker: str, observer: str, confidence: float = 0.95
) -> Agreement:
    r"""Return how alike observers rate walkers.

    From the mean squares of n walkers (R), k observers (C) and their residuals (E):

    .. math::
        ICC(A,1) = \frac{MS_R - MS_E}{MS_R + (k - 1) MS_E + \frac{k}{n} (MS_C - MS_E)}, \qquad
        ICC(C,1) = \frac{MS_R - MS_E}{MS_R + (k - 1) MS_E}

    Absolute agreement counts it as an error that one observer rates higher than another,
    consistency does not; "k" is of the mean of all observers, which an axis is fitted to.

    Parameters
    ----------
    table : DataFrame
        One row a rating; several of one observer for one walker are averaged first.
    rating, walker, observer : str
        Columns. Trials without a rating (empty cells) count as missing.
    confidence : float
        Of the intervals.

    Returns
    -------
    Agreement
        Where cells are missing, mean squares come from the two-way model of the cells there are,
        and k is the number of ratings that a walker has in effect; `message` says so. Cronbach's
        alpha is ICC(C,k), and NaN with missing cells.

    Raises
    ------
    ValueError
        If a column is missing, a rating is no finite number, there are fewer than two observers or
        three walkers, or the ratings do not vary.

    See Also
    --------
    eigenwalker.trait_axis : The axis of mean ratings.

    References
    ----------
    McGraw & Wong (1996), Forming inferences about some intraclass correlation coefficients;
    Shrout & Fleiss (1979); WDP2002, eq. 5, for the ratings.

    Examples
    --------
    >>> ratings = [9, 2, 5, 8, 6, 1, 3, 2, 8, 4, 6, 8, 7, 1, 2, 6, 10, 5, 6, 9, 6, 2, 4, 7]
    >>> table = pd.DataFrame({"happy": ratings, "observer": [*"ABCD"] * 6})
    >>> table["walker"] = np.repeat(range(6), 4)
    >>> found = agreement(table, rating="happy", walker="walker", observer="observer")
    >>> found.coefficients["value"].round(2).tolist()
    [0.29, 0.62, 0.71, 0.91, 0.91]

    """
    columns = {"rating": rating, "walker": walker, "observer": observer}
    taken = take_columns(table, columns, empty=("rating",))
    given = taken[taken["rating"].notna()]
    given = take_columns(given, {each: each for each in columns}, numbers=("rating",))
    cells = given.pivot_table(
        index="walker", columns="observer", values="rating", observed=True, sort=False
    )
    Y = cells.to_numpy()
    n, k = Y.shape
    if k < 2 or n < 3:
        raise ValueError(
            f"There are ratings of {k} observers for {n} walkers; agreement needs two observers "
            "and "
            "three walkers or more."
        )
    there = np.isfinite(Y)
    squares = _mean_squares(Y, there)
    n_missing = int((~there).sum())
    found = _coefficients(squares, n, confidence)
    found["alpha"] = found["ICC(C,k)"] if not n_missing else (np.nan, np.nan, np.nan)
    coefficients = pd.DataFrame.from_dict(found, "index", columns=["value", "low", "high"])
    coefficients.insert(0, "meaning", [NAMES[name] for name in coefficients.index])
    coefficients.index.name = "coefficient"
    message = f"{int(there.sum())} ratings of {n} walkers by {k} observers"
    if len(given) > there.sum():
        message += f", means of {len(given)} answers"
    if n_missing:
        message += (
            f"; {n_missing} of {n * k} cells are missing: the two-way model is fitted to those "
            "there "
            f"are, and k is {squares.k:.3g}, the ratings that a walker has in effect"
        )
    return Agreement(
        coefficients,
        _walkers(cells, confidence),
        _observers(cells),
        int(there.sum()),
        n_missing,
        message + ".",
    )


@dataclass(frozen=True)
class _MeanSquares:
    rows: float
    columns: float
    error: float
    k: float
    df_error: int


def _mean_squares(Y: np.ndarray, there: np.ndarray) -> _MeanSquares:
    """Return mean squares of the two-way model; of missing cells, of those that there are."""
    n, k = Y.shape
    row, column = np.nonzero(there)
    y = Y[there]
    R, C = np.eye(n)[row], np.eye(k)[column]

    def left(values: np.ndarray, out: np.ndarray) -> np.ndarray:
        return values - out @ np.linalg.lstsq(out, values, rcond=None)[0]

    both = np.hstack([R, C])
    residual = left(y, both)
    df = len(y) - np.linalg.matrix_rank(both)
    sums = float(residual @ residual)
    if df < 1 or np.ptp(y) == 0:
        raise ValueError(
            "The ratings do not vary, or no walker is rated by several observers; agreement needs "
            "ratings that differ, of the same walkers by several observers."
        )
    error = sums / df
    of_rows, of_columns = left(R, C), left(C, R)
    rows = (float(left(y, C) @ left(y, C)) - sums) / (n - 1)
    columns = (float(left(y, R) @ left(y, R)) - sums) / (k - 1)
    each_row, each_column = (of_rows * R).sum() / (n - 1), (of_columns * C).sum() / (k - 1)
    columns = error + (columns - error) * n / each_column  # as if every observer rated all
    return _MeanSquares(rows, columns, error, float(each_row), int(df))


def _coefficients(
    squares: _MeanSquares, n: int, confidence: float
) -> dict[str, tuple[float, float, float]]:
    R, C, E, k, df = squares.rows, squares.columns, squares.error, squares.k, squares.df_error
    tail = (1 - confidence) / 2
    E = max(E, 1e-12 * R)
    F = R / E
    low = F / f_distribution.isf(tail, n - 1, df)
    high = F * f_distribution.isf(tail, df, n - 1)
    single = [(each - 1) / (each + k - 1) for each in (F, low, high)]
    mean = [1 - 1 / each if each > 0 else -np.inf for each in (F, low, high)]
    r = (R - E) / (R + (k - 1) * E + k / n * (C - E))
    a, b = k * r / (n * (1 - r)), 1 + k * r * (n - 1) / (n * (1 - r))
    v = (a * C + b * E) ** 2 / ((a * C) ** 2 / (k - 1) + (b * E) ** 2 / df)
    rest = k * C + (k * n - k - n) * E
    F_low, F_high = f_distribution.isf(tail, n - 1, v), f_distribution.isf(tail, v, n - 1)
    absolute = [r, n * (R - F_low * E) / (F_low * rest + n * R)]
    absolute.append(n * (F_high * R - E) / (rest + n * F_high * R))
    stepped = [k * each / (1 + (k - 1) * each) for each in absolute]
    both = {"ICC(A,1)": absolute, "ICC(A,k)": stepped, "ICC(C,1)": single, "ICC(C,k)": mean}
    return {name: (float(x), float(y), float(z)) for name, (x, y, z) in both.items()}


def _walkers(cells: pd.DataFrame, confidence: float) -> pd.DataFrame:
    n = cells.notna().sum(axis=1)
    half = t_distribution.isf((1 - confidence) / 2, (n - 1).clip(lower=1))
    half = half * cells.std(axis=1, ddof=1) / np.sqrt(n)
    mean = cells.mean(axis=1)
    return pd.DataFrame({"rating": mean, "low": mean - half, "high": mean + half, "observers": n})


def _observers(cells: pd.DataFrame) -> pd.DataFrame:
    rows = {}
    for name in cells:
        own, others = cells[name], cells.drop(columns=name).mean(axis=1)
        both = own.notna() & others.notna()
        vary = both.sum() > 2 and own[both].std() > 0 and others[both].std() > 0
        rows[name] = {
            "ratings": int(own.notna().sum()),
            "mean": own.mean(),
            "sd": own.std(),
            "lowest": own.min(),
            "highest": own.max(),
            "with_others": own[both].corr(others[both]) if vary else np.nan,
        }
    return pd.DataFrame.from_dict(rows, "index").rename_axis("observer")
