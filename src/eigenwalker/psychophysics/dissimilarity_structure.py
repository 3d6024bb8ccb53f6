"""What a table of differences tells: order, clusters, a map of walks, nearest walks (P7)."""

from __future__ import annotations

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike
from sklearn.cluster import KMeans
from sklearn.decomposition import PCA


def order_of_walks(table: ArrayLike) -> np.ndarray:
    """Return walks in the order of the first principal component of the table's rows (P7).

    Each row is a point in a space of as many dimensions as there are walks; in the paper this order
    tells women from men.

    Parameters
    ----------
    table : array of shape (walk, walk)
        Differences, symmetric.

    Returns
    -------
    array of int of shape (walk,)
        Which walk comes first, second and so on; of the two directions that in which the first
        walk of the table comes in the first half.

    Examples
    --------
    >>> place = np.array([0.0, 2.0, 0.5, 1.5])
    >>> order_of_walks(np.abs(place[:, None] - place)).tolist()
    [0, 2, 3, 1]

    """
    rows = _checked(table)
    scores = PCA(n_components=1, svd_solver="full").fit_transform(rows)[:, 0]
    scores *= -1 if scores[0] > np.median(scores) else 1
    return np.argsort(scores, kind="stable")


def clusters_of_walks(table: ArrayLike, n_clusters: int = 2, *, seed: int = 0) -> np.ndarray:
    """Return to which cluster each walk belongs: k-means on the rows of the table (P7).

    Parameters
    ----------
    table : array of shape (walk, walk)
        Differences, symmetric.
    n_clusters : int
        As in the paper 2, which fell together with the walkers' sex.
    seed : int
        Of the random starts.

    Returns
    -------
    array of int of shape (walk,)
        Numbers from 0, in the order in which `order_of_walks` comes to them.

    Examples
    --------
    >>> place = np.array([0.0, 2.0, 0.5, 1.5])
    >>> clusters_of_walks(np.abs(place[:, None] - place)).tolist()
    [0, 1, 0, 1]

    """
    rows = _checked(table)
    if not 1 <= n_clusters <= len(rows):
        raise ValueError(f"n_clusters={n_clusters}: expected 1 to {len(rows)}, as there are walks.")
    found = KMeans(n_clusters, n_init=20, random_state=seed).fit_predict(rows)  # pyright: ignore[reportArgumentType] - the stub knows the default, a word, alone
    met = pd.unique(found[order_of_walks(rows)])
    return np.argsort(met)[found]


def memberships(table: ArrayLike, clusters: ArrayLike) -> np.ndarray:
    """Return how much each walk belongs to each cluster, as the curves of the paper's figure 3.

    K-means knows whole members only, the figure shows graded ones. As in fuzzy c-means with
    exponent 2 a share goes with 1 over the squared distance from the cluster's middle (A32).

    Parameters
    ----------
    table : array of shape (walk, walk)
        Differences, symmetric.
    clusters : array of int of shape (walk,)
        As `clusters_of_walks` gives them.

    Returns
    -------
    array of shape (walk, cluster)
        Shares; they sum to 1.

    """
    rows, clusters = _checked(table), np.asarray(clusters)
    middles = np.stack([rows[clusters == each].mean(axis=0) for each in range(clusters.max() + 1)])
    away = ((rows[:, None] - middles) ** 2).sum(axis=2)
    near = 1 / np.maximum(away, 1e-12 * max(away.max(), 1e-300))
    return near / near.sum(axis=1, keepdims=True)


def map_of_walks(table: ArrayLike, n_dimensions: int = 2) -> np.ndarray:
    """Return places of walks whose distances are as near as can be to their differences.

    Classical scaling (Torgerson 1952): exact where the differences are distances in a plane.

    Parameters
    ----------
    table : array of shape (walk, walk)
        Differences, symmetric, 0 on the diagonal.
    n_dimensions : int
        Of the map.

    Returns
    -------
    array of shape (walk, n_dimensions)
        Centred; the widest dimension first, signs so that the walk furthest out is positive.

    Examples
    --------
    >>> corners = np.array([[0, 0], [3, 0], [3, 4.0]])
    >>> apart = np.linalg.norm(corners[:, None] - corners, axis=2)
    >>> places = map_of_walks(apart)
    >>> np.allclose(np.linalg.norm(places[:, None] - places, axis=2), apart)
    True

    """
    squared = _checked(table) ** 2
    middle = squared.mean(axis=0)
    products = -0.5 * (squared - middle - middle[:, None] + squared.mean())
    values, vectors = np.linalg.eigh(products)
    widest = np.argsort(-values)[:n_dimensions]
    places = vectors[:, widest] * np.sqrt(np.maximum(values[widest], 0.0))
    signs = np.sign(places[np.abs(places).argmax(axis=0), np.arange(places.shape[1])])
    return places * np.where(signs == 0, 1.0, signs)


def _checked(table: ArrayLike) -> np.ndarray:
    values = np.asarray(table, dtype=float)
    if values.ndim != 2 or values.shape[0] != values.shape[1] or len(values) < 2:
        raise ValueError(
            f"Expected a table of walks by walks, two or more; got shape {values.shape}."
        )
    if not np.isfinite(values).all():
        raise ValueError(
            "Some differences are missing; leave out walks that were never shown together."
        )
    if np.abs(values - values.T).max() > 1e-9 * np.abs(values).max():
        raise ValueError("The table is not symmetric: a, b and b, a are one pair.")
    return values
