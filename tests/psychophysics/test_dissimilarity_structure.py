"""Order, clusters and map of walks, as a table of differences tells them."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.distance import pdist, squareform
from sklearn.metrics import adjusted_rand_score

from eigenwalker.psychophysics.dissimilarity_structure import (
    cluster_memberships,
    clusters_of_walks,
    map_of_walks,
    order_of_walks,
)

KIND = np.repeat([0, 1], [14, 7])  # P1


def table(seed: int = 0, apart: float = 4.0) -> np.ndarray:
    """Differences of 14 and 7 walks of two kinds."""
    rng = np.random.default_rng(seed)
    places = rng.normal(size=(21, 5))
    places[:, 0] += apart * KIND
    return squareform(pdist(places))


def test_first_component_parts_two_kinds_of_walks():
    order = KIND[order_of_walks(table())]
    assert order.tolist() == sorted(order, reverse=bool(order[0]))


def test_clusters_are_the_kinds():
    found = clusters_of_walks(table())
    assert adjusted_rand_score(KIND, found) == 1
    assert found[order_of_walks(table())][0] == 0


def test_memberships_are_shares_and_the_highest_is_the_cluster_s():
    values = table(apart=2.0)
    found = clusters_of_walks(values)
    shares = cluster_memberships(values, found)
    np.testing.assert_allclose(shares.sum(axis=1), 1)
    assert np.mean(shares.argmax(axis=1) == found) > 0.9


def test_memberships_go_with_one_over_the_squared_distance():
    values, found = table(apart=2.0), KIND
    middles = [values[each == KIND].mean(axis=0) for each in (0, 1)]
    for row, shares in zip(values, cluster_memberships(values, found), strict=True):
        away = [np.linalg.norm(row - middle) for middle in middles]
        assert shares[0] / shares[1] == pytest.approx((away[1] / away[0]) ** 2)


def test_map_of_points_in_a_plane_keeps_their_distances():
    places = np.random.default_rng(1).normal(size=(12, 2)) * [3, 1]
    apart = squareform(pdist(places))
    np.testing.assert_allclose(squareform(pdist(map_of_walks(apart))), apart, atol=1e-9)


def test_walks_in_another_order_give_the_same_map():
    values, shuffled = table(), np.random.default_rng(2).permutation(21)
    again = map_of_walks(values[np.ix_(shuffled, shuffled)])
    np.testing.assert_allclose(again, map_of_walks(values)[shuffled], atol=1e-9)


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        (np.zeros((3, 2)), "walks by walks"),
        (np.array([[0, 1.0], [2, 0]]), "not symmetric"),
        (np.array([[0, np.nan], [np.nan, 0]]), "missing"),
    ],
)
def test_tables_that_are_none_are_refused(wrong, said):
    with pytest.raises(ValueError, match=said):
        order_of_walks(wrong)


def test_clusters_are_numbered_by_whole_numbers():
    with pytest.raises(ValueError, match="clusters must be whole numbers"):
        cluster_memberships(table(), np.linspace(0, 1, len(table())))


def test_more_clusters_than_walks_are_refused():
    with pytest.raises(ValueError, match="n_clusters=3"):
        clusters_of_walks([[0, 1], [1, 0]], 3)
