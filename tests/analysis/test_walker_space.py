from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, strategies as st
from sklearn.decomposition import PCA
from sklearn.preprocessing import StandardScaler
from sklearn.utils.estimator_checks import parametrize_with_checks

from eigenwalker.analysis import WalkerSpace


def walkers(n_walkers: int = 12, n_features: int = 20, seed: int = 0) -> np.ndarray:
    """Walkers whose features are of unlike size, and correlated."""
    rng = np.random.default_rng(seed)
    mixing = np.eye(n_features) + 0.3 * rng.normal(size=(n_features, n_features))
    units = 10.0 ** rng.integers(-2, 3, n_features)
    return (rng.normal(size=(n_walkers, n_features)) @ mixing + 5) * units


@parametrize_with_checks([WalkerSpace()])
def test_scikit_learn_finds_nothing_amiss(estimator, check):
    check(estimator)


def test_average_and_eigenwalkers_add_up_to_every_walker():
    W = walkers()
    space = WalkerSpace().fit(W)
    K = space.transform(W)
    np.testing.assert_allclose(space.average_walker_ + K @ space.eigenwalkers_, W, rtol=1e-10)
    np.testing.assert_allclose(space.inverse_transform(K), W, rtol=1e-10)


def test_forty_walkers_span_thirty_nine_dimensions():
    assert len(WalkerSpace().fit(walkers(40, 229)).eigenwalkers_) == 39
    assert len(WalkerSpace().fit(walkers(40, 8)).eigenwalkers_) == 8


@pytest.mark.parametrize("shape", [(12, 20), (40, 7), (9, 9)])
def test_scores_and_variances_are_those_of_scikit_learn(shape):
    W = walkers(*shape)
    n = min(shape[0] - 1, shape[1])
    peer = PCA(n).fit(StandardScaler().fit_transform(W))
    to_ddof_1 = np.sqrt((len(W) - 1) / len(W))
    peer_scores = peer.transform(StandardScaler().fit_transform(W)) * to_ddof_1
    space = WalkerSpace().fit(W)
    scores = space.transform(W)
    np.testing.assert_allclose(np.abs(scores), np.abs(peer_scores), atol=1e-9)
    np.testing.assert_allclose(space.explained_variance_, scores.var(axis=0, ddof=1))
    np.testing.assert_allclose(
        space.explained_variance_ratio_, peer.explained_variance_ratio_, rtol=1e-9
    )
    axes = space.eigenwalkers_ / space.scale_
    np.testing.assert_allclose(np.abs(axes), np.abs(peer.components_), atol=1e-9)


def test_two_planted_ways_of_differing_are_found():
    rng = np.random.default_rng(3)
    truth = np.linalg.qr(rng.normal(size=(30, 2)))[0].T
    W = 100 + rng.normal(size=(50, 2)) * [9, 4] @ truth + 0.01 * rng.normal(size=(50, 30))
    space = WalkerSpace(n_components=2, scale=None).fit(W)
    agreement = np.abs(np.sum(space.eigenwalkers_ * truth, axis=1))
    cosines = np.linalg.svd(space.eigenwalkers_ @ truth.T, compute_uv=False)
    assert (cosines > 0.99999).all()
    assert (agreement > 0.9).all()


@given(
    feature=st.integers(0, 19),
    factor=st.floats(1e-3, 1e3),
    offset=st.floats(-1e3, 1e3),
)
def test_the_unit_of_a_feature_does_not_matter_once_standardised(feature, factor, offset):
    W = walkers()
    other = W.copy()
    other[:, feature] = factor * W[:, feature] + offset
    space, other_space = WalkerSpace().fit(W), WalkerSpace().fit(other)
    np.testing.assert_allclose(other_space.transform(other), space.transform(W), atol=1e-6)
    np.testing.assert_allclose(
        other_space.eigenwalkers_[:, feature], factor * space.eigenwalkers_[:, feature], rtol=1e-4
    )


@given(order=st.permutations(range(12)))
def test_the_order_of_walkers_does_not_matter(order):
    W = walkers()
    scores = WalkerSpace().fit(W).transform(W)
    np.testing.assert_allclose(
        WalkerSpace().fit(W[order]).transform(W[order]), scores[order], atol=1e-8
    )


def test_a_feature_that_does_not_vary_stays_at_its_mean():
    W = walkers()
    W[:, 3] = 7.0
    W[:, 4] = 1e-14 * np.arange(12)  # zero but for rounding, as where the pelvis is put at 0
    space = WalkerSpace().fit(W)
    assert space.scale_[3:5].tolist() == [1, 1]
    assert not space.eigenwalkers_[:, 3:5].any()
    assert space.inverse_transform(np.full((1, 11), 9.0))[0, 3] == 7.0


def test_divisors_of_ones_own_weigh_blocks():
    W = walkers()
    blocks = np.repeat([2.0, 50.0], 10)
    given_blocks = WalkerSpace(scale=blocks).fit(W)
    by_hand = WalkerSpace(scale=None).fit(W / blocks)
    np.testing.assert_allclose(given_blocks.transform(W), by_hand.transform(W / blocks))
    np.testing.assert_allclose(given_blocks.eigenwalkers_, by_hand.eigenwalkers_ * blocks)


def test_scores_carry_names():
    space = WalkerSpace(n_components=2).set_output(transform="pandas")
    assert list(space.fit_transform(walkers()).columns) == ["eigenwalker1", "eigenwalker2"]


@pytest.mark.parametrize(
    ("space", "W", "said"),
    [
        (WalkerSpace(n_components=12), walkers(), "not among the 1 to 11 that 12 walkers"),
        (WalkerSpace(), np.ones((5, 4)), "All 5 walkers are the same"),
        (WalkerSpace(scale="var"), walkers(), "scale='var' is unknown"),
        (WalkerSpace(scale=[1.0, 2.0]), walkers(), "one divisor above 0 for each of 20"),
        (WalkerSpace(scale=np.zeros(20)), walkers(), "least value 0"),
    ],
)
def test_what_cannot_span_a_space_is_refused_with_the_reason(space, W, said):
    with pytest.raises(ValueError, match=said):
        space.fit(W)


def test_twins_span_no_dimension_of_their_own():
    W = walkers()
    W[5] = W[4]
    assert len(WalkerSpace().fit(W).eigenwalkers_) == 10


def test_scores_of_another_space_are_refused():
    with pytest.raises(ValueError, match=r"\(walker, 11\)"):
        WalkerSpace().fit(walkers()).inverse_transform(np.zeros((1, 4)))
