"""The structure of a table of differences: order, clusters and a map of walks."""

from __future__ import annotations

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike
from sklearn.cluster import KMeans
from sklearn.decomposition import PCA

from eigenwalker.core.arguments import check_numbers, check_whole


def order_of_walks(table: ArrayLike) -> np.ndarray:
    """Return walks in the order of the first principal component of the table's rows.

    In the paper this order tells women from men.

    Parameters
    ----------
    table : array of shape (walk, walk)
        Differences, symmetric.

    Returns
    -------
    array of int of shape (walk,)
        Which walk comes first, second and so on; of the two directions that in which the first
        walk of the table comes in the first half.

    See Also
    --------
    map_of_walks, clusters_of_walks : Other views of the table.

    References
    ----------
    Pražák et al. (2010), section 4 and figure 4.

    Examples
    --------
    >>> place = np.array([0.0, 2.0, 0.5, 1.5])
    >>> order_of_walks(np.abs(place[:, None] - place)).tolist()
    [0, 2, 3, 1]
    """
    rows = _check_table(table)
    scores = PCA(n_components=1, svd_solver="full").fit_transform(rows)[:, 0]
    scores *= -1 if scores[0] > np.median(scores) else 1
    return np.argsort(scores, kind="stable")


def clusters_of_walks(
    table: ArrayLike, n_clusters: int = 2, *, random_state: int = 0
) -> np.ndarray:
    """Return the cluster of each walk: k-means on the rows of the table.

    Parameters
    ----------
    table : array of shape (walk, walk)
        Differences, symmetric.
    n_clusters : int
        How many to look for; 2 in the paper, which agreed with the walkers' sex.
    random_state : int
        Seed of the random starts.

    Returns
    -------
    array of int of shape (walk,)
        Numbers from 0, in the order in which `order_of_walks` comes to them.

    See Also
    --------
    cluster_memberships : How much each walk belongs to each.
    order_of_walks : The order of their numbers.

    References
    ----------
    Pražák et al. (2010), section 4 and figure 3.

    Examples
    --------
    >>> place = np.array([0.0, 2.0, 0.5, 1.5])
    >>> clusters_of_walks(np.abs(place[:, None] - place)).tolist()
    [0, 1, 0, 1]
    """
    rows = _check_table(table)
    if not 1 <= n_clusters <= len(rows):
        raise ValueError(f"n_clusters={n_clusters}: expected 1 to {len(rows)}, as there are walks.")
    clusters = KMeans(n_clusters, n_init=20, random_state=random_state).fit_predict(rows)  # pyright: ignore[reportArgumentType] - the stub knows the default, a word, alone
    in_order = pd.unique(clusters[order_of_walks(rows)])
    return np.argsort(in_order)[clusters]


def cluster_memberships(table: ArrayLike, clusters: ArrayLike) -> np.ndarray:
    """Return how much each walk belongs to each cluster, as the curves of the paper's figure 3.

    As in fuzzy c-means with exponent 2, a share is proportional to 1 over the squared distance from
    the cluster's centre.

    Parameters
    ----------
    table : array of shape (walk, walk)
        Differences, symmetric.
    clusters : array of int of shape (walk,)
        Number of each walk's cluster, from 0 (`clusters_of_walks`).

    Returns
    -------
    array of shape (walk, cluster)
        Shares; they sum to 1.

    See Also
    --------
    clusters_of_walks : Makes the clusters.

    References
    ----------
    Pražák et al. (2010), figure 3.

    Examples
    --------
    >>> place = np.array([0.0, 2.0, 0.5, 1.5])
    >>> table = np.abs(place[:, None] - place)
    >>> cluster_memberships(table, clusters_of_walks(table))[0].round(3).tolist()
    [0.971, 0.029]
    """
    rows, clusters = _check_table(table), check_whole(clusters, "clusters", "walk")
    if clusters.shape != (len(rows),) or not np.isin(np.arange(clusters.max() + 1), clusters).all():
        raise ValueError(
            f"clusters must number the cluster of each of {len(rows)} walks, from 0; got "
            f"{clusters.tolist()[:20]}."
        )
    centres = np.stack([rows[clusters == each].mean(axis=0) for each in range(clusters.max() + 1)])
    squared = ((rows[:, None] - centres) ** 2).sum(axis=2)
    nearness = 1 / np.maximum(squared, 1e-12 * max(squared.max(), 1e-300))
    return nearness / nearness.sum(axis=1, keepdims=True)


def map_of_walks(table: ArrayLike, n_dimensions: int = 2) -> np.ndarray:
    r"""Return positions of walks whose distances are as near as possible to their differences.

    Classical scaling: the leading eigenvectors of the doubly centred squares of the table D, times
    the roots of their eigenvalues:

    .. math:: B = -\tfrac{1}{2} J D^{(2)} J, \qquad J = I - \tfrac{1}{n} 1 1^T

    Parameters
    ----------
    table : array of shape (walk, walk)
        Differences, symmetric, 0 on the diagonal.
    n_dimensions : int
        Dimensions of the map.

    Returns
    -------
    array of shape (walk, n_dimensions)
        Centred; the widest dimension first, signs so that the walk furthest out is positive.

    See Also
    --------
    order_of_walks, clusters_of_walks : Other views of the table.

    References
    ----------
    Torgerson (1952), Multidimensional scaling: I. Theory and method.

    Examples
    --------
    >>> corners = np.array([[0, 0], [3, 0], [3, 4.0]])
    >>> table = np.linalg.norm(corners[:, None] - corners, axis=2)
    >>> points = map_of_walks(table)
    >>> np.allclose(np.linalg.norm(points[:, None] - points, axis=2), table)
    True
    """
    squared = _check_table(table) ** 2
    mean = squared.mean(axis=0)
    products = -0.5 * (squared - mean - mean[:, None] + squared.mean())
    values, vectors = np.linalg.eigh(products)
    widest = np.argsort(-values)[:n_dimensions]
    points = vectors[:, widest] * np.sqrt(np.maximum(values[widest], 0.0))
    signs = np.sign(points[np.abs(points).argmax(axis=0), np.arange(points.shape[1])])
    return points * np.where(signs == 0, 1.0, signs)


def _check_table(table: ArrayLike) -> np.ndarray:
    values = check_numbers(table, "The table", "walk", "walk", least=2, missing=True)
    if values.shape[0] != values.shape[1]:
        raise ValueError(f"Expected a table of walks by walks; got shape {values.shape}.")
    if np.isnan(values).any():
        raise ValueError(
            "Some differences are missing; leave out walks that were never shown together."
        )
    if np.abs(values - values.T).max() > 1e-9 * np.abs(values).max():
        raise ValueError("The table is not symmetric: a, b and b, a are one pair.")
    return values
