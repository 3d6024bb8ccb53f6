"""How well metrics predict perceived differences of walkers that they were not fitted to."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike
from scipy.stats import rankdata
from sklearn.model_selection import cross_val_predict

from eigenwalker.psychophysics.perceptual_metric import PerceptualMetric


def goodness(observed: ArrayLike, predicted: ArrayLike) -> dict[str, float]:
    """Return how near predictions come to perceived differences of pairs.

    Parameters
    ----------
    observed, predicted : array of shape (pair,)
        Each pair of two walkers once.

    Returns
    -------
    dict
        ``rss``, the sum of squared errors; ``rms``, the root of their mean; ``pearson`` and
        ``spearman`` correlations, NaN if one of the two does not vary or there is no pair.

    References
    ----------
    Pražák et al. (2010), figure 5, whose "difference" can only be twice this ``rss``.

    Examples
    --------
    >>> round(goodness([0.2, 0.4, 0.9], [0.3, 0.4, 0.8])["rss"], 6)
    0.02
    """
    observed, predicted = np.asarray(observed, dtype=float), np.asarray(predicted, dtype=float)
    error = observed - predicted
    if not error.size:
        return {"rss": 0.0, "rms": np.nan, "pearson": np.nan, "spearman": np.nan}
    varies = np.ptp(observed) > 0 and np.ptp(predicted) > 1e-12 * np.abs(predicted).max()
    ranks = [rankdata(observed), rankdata(predicted)]
    return {
        "rss": float(error @ error),
        "rms": float(np.sqrt(np.mean(error**2))),
        "pearson": float(np.corrcoef(observed, predicted)[0, 1]) if varies else np.nan,
        "spearman": float(np.corrcoef(ranks)[0, 1]) if varies else np.nan,
    }


def leave_walkers_out(
    pairs: Sequence[tuple[object, object]],
) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return a split for each pair that leaves out both its walkers, with all pairs they are in.

    Leaving pairs out alone would let a metric know the walkers from their other pairs.

    Parameters
    ----------
    pairs : sequence of pairs
        The two walkers of each pair; four walkers or more.

    Returns
    -------
    list of pairs of arrays
        Rows to fit to, and the one row to predict: scikit-learn's ``cv=leave_walkers_out(pairs)``.

    Examples
    --------
    >>> import itertools
    >>> pairs = list(itertools.combinations("abcd", 2))
    >>> train, test = leave_walkers_out(pairs)[0]
    >>> [pairs[row] for row in train], [pairs[row] for row in test]
    ([('c', 'd')], [('a', 'b')])
    """
    names = np.array([[str(walker) for walker in pair] for pair in pairs])
    splits = []
    for row, pair in enumerate(names):
        train = np.flatnonzero(~np.isin(names, pair).any(axis=1))
        if not train.size:
            a, b = map(str, pair)
            raise ValueError(
                f"Every pair holds the walker {a!r} or {b!r}, so that none is left to fit to; "
                "compare four walkers or more, each with each."
            )
        splits.append((train, np.array([row])))
    return splits


def compare_metrics(
    tables: Mapping[str, ArrayLike], y: ArrayLike, pairs: Sequence[tuple[object, object]]
) -> pd.DataFrame:
    """Return how well several metrics predict the same differences.

    Each table gets the constant and the weights, none below 0, that fit best; a published metric,
    of one column, gets a constant and a factor.

    Parameters
    ----------
    tables : mapping of str to array of shape (pair, column)
        For each metric its distances, or mean F(d_k) of each group.
    y : array of shape (pair,)
        Perceived differences.
    pairs : sequence of pairs
        The two walkers of each pair.

    Returns
    -------
    DataFrame
        Rows are metrics; columns ``n_weights`` (that are not 0), the four of `goodness`, and
        ``cv_rms``, ``cv_pearson``, ``cv_spearman`` of pairs whose two walkers were both left out.

    See Also
    --------
    compare_by_choices : The same by trials.

    References
    ----------
    Pražák et al. (2010), figure 5.
    """
    y = np.asarray(y, dtype=float)
    splits = leave_walkers_out(pairs)
    rows = {}
    for name, table in tables.items():
        X = np.asarray(table, dtype=float).reshape(len(y), -1)
        metric = PerceptualMetric().fit(X, y)
        left_out = goodness(y, np.asarray(cross_val_predict(PerceptualMetric(), X, y, cv=splits)))
        rows[name] = {
            "n_weights": int((metric.weights_ > 0).sum()),
            **goodness(y, metric.predict(X)),
            **{f"cv_{measure}": left_out[measure] for measure in ("rms", "pearson", "spearman")},
        }
    return pd.DataFrame.from_dict(rows, orient="index").rename_axis("metric")
