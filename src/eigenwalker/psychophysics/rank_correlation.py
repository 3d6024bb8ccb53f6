"""Rank correlations: by permutation, and beside the value that the paper calls critical."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.stats import norm, rankdata

from eigenwalker.core.arguments import check_numbers


class RankCorrelation(NamedTuple):
    """Spearman's correlation, and how often random orders reach it.

    See Also
    --------
    rank_correlation : makes it.
    """

    rho: float
    p: float
    """Share of permutations with a correlation as high (one-sided, as in the paper)."""
    p_two_sided: float
    n: int


def spearman_critical(n: int, alpha: float, *, two_sided: bool = False) -> float:
    r"""Return the rank correlation that the paper calls critical, by the normal approximation.

    .. math:: r = z_{1 - \alpha} / \sqrt{n - 1}

    Parameters
    ----------
    n : int
        Number of pairs of ranks, two or more.
    alpha : float
        Level of the test, between 0 and 1.
    two_sided : bool
        Whether both signs count; in the paper they do not.

    Returns
    -------
    float
        0.373 for 40 walkers and 0.01, as Table 1 has it; 1 at most.

    Raises
    ------
    ValueError
        If `n` is below 2, or `alpha` not between 0 and 1.

    See Also
    --------
    rank_correlation : p by permutation, without the approximation.

    References
    ----------
    Troje (2002), Table 1.

    Examples
    --------
    >>> round(spearman_critical(40, 0.01), 3)
    0.373

    """
    if not n >= 2 or not 0 < alpha < 1:
        raise ValueError(
            f"Expected n of 2 or more and alpha between 0 and 1; got n={n} and alpha={alpha}."
        )
    return min(float(norm.isf(alpha / (2 if two_sided else 1)) / np.sqrt(n - 1)), 1.0)


def rank_correlation(
    x: ArrayLike, y: ArrayLike, *, n_permutations: int = 9999, random_state: int = 0
) -> RankCorrelation:
    """Return Spearman's rank correlation with p by permutation; ties get average ranks.

    Parameters
    ----------
    x, y : array of shape (item,)
        Three or more each.
    n_permutations, random_state : int
        Random orders that y is put in, and their seed.

    Returns
    -------
    RankCorrelation
        ``rho``, ``p`` (as high or higher), ``p_two_sided`` and ``n``; all NaN where x or y does
        not vary.

    Raises
    ------
    ValueError
        If the two differ in length, or hold no finite numbers.

    See Also
    --------
    spearman_critical : The critical value that the paper uses.

    References
    ----------
    Troje (2002), Table 1.

    Examples
    --------
    >>> round(rank_correlation([1, 2, 3, 4, 5, 6], [2, 1, 3, 4, 6, 5]).rho, 3)
    0.886

    """
    x, y = check_numbers(x, "x", "item", least=3), check_numbers(y, "y", "item", least=3)
    if len(x) != len(y):
        raise ValueError(f"Expected as many x as y; got {len(x)} and {len(y)}.")
    a, b = (rankdata(each) - (len(each) + 1) / 2 for each in (x, y))
    scale = np.sqrt((a @ a) * (b @ b))
    if scale == 0:
        return RankCorrelation(np.nan, np.nan, np.nan, len(x))
    rng = np.random.default_rng(random_state)
    orders = rng.permuted(np.tile(b, (n_permutations, 1)), axis=1) @ a / scale
    rho, tiny = float(a @ b / scale), 1e-12
    high = (orders >= rho - tiny).sum() + 1
    both = (np.abs(orders) >= abs(rho) - tiny).sum() + 1
    total = n_permutations + 1
    return RankCorrelation(rho, float(high / total), float(both / total), len(x))
