"""The table of perceived differences, and how far it is one of distances."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from eigenwalker.core.arguments import check_numbers
from eigenwalker.psychophysics.trials import Trials, count_pairs


def difference_table(answers: pd.DataFrame | Trials) -> pd.DataFrame:
    r"""Return the table of perceived differences of all walkers.

    .. math:: T_{ij} = 1 - \frac{\text{times chosen}}{\text{times shown together}}

    Parameters
    ----------
    answers : DataFrame or Trials
        One row a trial: ``observer``; the walkers shown, ``a`` to ``d``; and the two chosen,
        ``chosen_1`` and ``chosen_2``.

    Returns
    -------
    DataFrame of shape (walker, walker)
        Symmetric, from 0 to 1, sorted by label; 0 on the diagonal, NaN for pairs never shown
        together. ``attrs`` say of how many ``answers`` and ``observers`` it is.

    Raises
    ------
    ValueError
        As `read_trials` does.

    See Also
    --------
    fit_choice_model : Knows which other pairs each trial showed.
    triangle_inequalities, order_of_walks, clusters_of_walks, map_of_walks : What it looks like.

    References
    ----------
    Pražák et al. (2010), section 4.

    Examples
    --------
    >>> columns = ["observer", "a", "b", "c", "d", "chosen_1", "chosen_2"]
    >>> answers = pd.DataFrame([["Eva", "w1", "w2", "w3", "w4", "w2", "w4"]], columns=columns)
    >>> difference_table(answers).loc["w2"].tolist()
    [1.0, 0.0, 1.0, 0.0]

    """
    counts = count_pairs(answers)
    table = square_table(counts.differences, diagonal=0.0)
    table.attrs = {"answers": int(counts.chosen.sum()), "observers": len(counts.observers)}
    return table


def square_table(values: pd.Series, *, diagonal: float) -> pd.DataFrame:
    """Return values of pairs, in the order of `itertools.combinations`, as a symmetric table."""
    names = sorted({name for pair in values.index for name in pair})
    place = {name: i for i, name in enumerate(names)}
    table = np.full((len(names), len(names)), diagonal)
    for (first, second), value in zip(values.index, values.to_numpy(), strict=True):
        table[place[first], place[second]] = table[place[second], place[first]] = value
    return pd.DataFrame(table, index=names, columns=names)


class TriangleInequalities(NamedTuple):
    """How many triangle inequalities hold, of all and by triples of walkers.

    See Also
    --------
    triangle_inequalities : makes it.
    """

    share: float
    """Of all inequalities, three a triple."""
    share_of_triples: float
    """Of triples of which all three hold."""
    n_triples: int
    """Triples whose three pairs were all shown."""


def triangle_inequalities(table: ArrayLike) -> TriangleInequalities:
    """Return how many triangle inequalities hold in a table of differences.

    Over all triples i < j < k and their three inequalities, such as T_ij <= T_ik + T_kj. Triples
    of which a pair was never shown (NaN) do not count.

    Parameters
    ----------
    table : array of shape (walker, walker)
        Differences, symmetric.

    Returns
    -------
    TriangleInequalities
        NaN where there is no triple.

    See Also
    --------
    difference_table : Makes the table.

    References
    ----------
    Pražák et al. (2010), section 4: 98.6 % hold.

    Examples
    --------
    >>> triangle_inequalities([[0, 1, 3], [1, 0, 1], [3, 1, 0]]).share.round(2)
    np.float64(0.67)

    """
    T = check_numbers(table, "table", "walker", "walker", missing=True)
    if T.shape[0] != T.shape[1]:
        raise ValueError(f"Expected a table of walkers by walkers; got shape {T.shape}.")
    n = len(T)
    holds, whole, triples = 0, 0, 0
    for i in range(n - 2):
        j, k = np.triu_indices(n - i - 1, 1)
        a, b, c = T[i, j + i + 1], T[i, k + i + 1], T[j + i + 1, k + i + 1]
        known = np.isfinite(a + b + c)
        slack = 1e-12
        each = np.stack([a <= b + c + slack, b <= a + c + slack, c <= a + b + slack])[:, known]
        holds, whole = holds + each.sum(), whole + each.all(axis=0).sum()
        triples += int(known.sum())
    if not triples:
        return TriangleInequalities(np.nan, np.nan, 0)
    return TriangleInequalities(holds / (3 * triples), whole / triples, triples)
