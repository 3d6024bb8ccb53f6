"""Correspondence: planted eigenpostures found again however components come out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from xarray import DataArray

from eigenwalker.core import Walker
from eigenwalker.decomposition import decompose_fourier, decompose_pca
from eigenwalker.population.correspondence import (
    MIN_SIMILARITY,
    correspond,
    correspond_to,
    match_sign_and_order,
    posture_correlations,
)

WHOLE_STRIDES = np.arange(1500) / 120


def walks_of_relatives(walker: Walker, n: int, seed: int, spread: float = 3.0) -> list[DataArray]:
    """Walks of people who differ a little from one, each captured from another moment on."""
    rng = np.random.default_rng(seed)
    walks = []
    for _ in range(n):
        twin = replace(
            walker,
            p0=walker.p0 + rng.normal(scale=20, size=walker.p0.shape),
            p=walker.p + rng.normal(scale=spread, size=walker.p.shape),
        )
        walks.append(twin.trajectories(WHOLE_STRIDES + rng.uniform(0, 3)))
    return walks


def relatives(walker: Walker, n: int, seed: int) -> list[Walker]:
    return [decompose_pca(walk) for walk in walks_of_relatives(walker, n, seed)]


@pytest.mark.parametrize(
    "amplitudes",
    [(600, 300, 150, 100), (600, 300, 105, 100), (600, 305, 300, 100), (600, 150, 300, 100)],
    ids=["apart", "3 and 4 nearly equal", "2 and 3 nearly equal", "2 and 3 crossed"],
)
def test_eigenpostures_mean_the_same_in_all_walkers(orthogonal_walker, amplitudes) -> None:
    planted = orthogonal_walker(1)
    lengths = np.linalg.norm(planted.p.reshape(4, -1), axis=1)
    planted = replace(
        planted, p=planted.p / lengths[:, None, None] * np.c_[[amplitudes]].T[..., None]
    )
    walkers, found = correspond(relatives(planted, 12, seed=2))
    assert not any(found.flags)
    assert found.similarity.min() > 0.95
    assert posture_correlations(np.stack([walker.p for walker in walkers])).min() > 0.95
    assert {tuple(walker.harmonics) for walker in walkers} == {(1, 1, 2, 2)}


def test_sign_and_order_alone_fail_where_components_are_nearly_equal(orthogonal_walker) -> None:
    planted = orthogonal_walker(1)
    lengths = np.linalg.norm(planted.p.reshape(4, -1), axis=1)
    wanted = np.array([600, 300, 105, 100])
    planted = replace(planted, p=planted.p * (wanted / lengths)[:, None, None])
    family = relatives(planted, 12, seed=2)
    as_the_paper = posture_correlations(match_sign_and_order(family))
    together = posture_correlations(np.stack([walker.p for walker in correspond(family)[0]]))
    assert as_the_paper[2] < 0.9 < together[2]
    assert as_the_paper[0] == pytest.approx(together[0], abs=0.01)


@given(seed=st.integers(0, 99))
@settings(max_examples=10, deadline=None)
def test_a_walker_in_correspondence_plays_the_same_movement(orthogonal_walker, seed: int) -> None:
    walks = walks_of_relatives(orthogonal_walker(1), 4, seed)
    together, _ = correspond([decompose_pca(walk) for walk in walks])
    for walk, walker in zip(walks, together, strict=True):
        assert walker.phases[0] == 0
        np.testing.assert_allclose(
            walker.trajectories(walk.time),
            decompose_fourier(walk).trajectories(walk.time),
            atol=1e-6,
        )


def test_correspondence_does_not_depend_on_the_order_of_walkers(orthogonal_walker) -> None:
    family = relatives(orthogonal_walker(3), 7, seed=0)
    forwards, backwards = correspond(family)[0], correspond(family[::-1])[0][::-1]
    for one, other in zip(forwards, backwards, strict=True):
        np.testing.assert_allclose(one.p, other.p, atol=1e-6)
        np.testing.assert_allclose(one.phases, other.phases, atol=1e-6)


def test_correspondence_is_settled_after_one_go(orthogonal_walker) -> None:
    once, found = correspond(relatives(orthogonal_walker(3), 7, seed=0))
    twice, _ = correspond(once)
    for one, other in zip(once, twice, strict=True):
        np.testing.assert_allclose(one.p, other.p, atol=1e-6)
        assert one.time_origin_s == pytest.approx(other.time_origin_s, abs=1e-6)
    alone, similarity, flag = correspond_to(once[2], found.reference)
    np.testing.assert_allclose(alone.p, once[2].p, atol=1e-6)
    np.testing.assert_allclose(similarity, found.similarity[2], atol=1e-6)
    assert not flag


def test_a_stranger_is_flagged_and_shapes_no_average(orthogonal_walker) -> None:
    family = relatives(orthogonal_walker(1), 8, seed=4)
    stranger = decompose_pca(orthogonal_walker(77).trajectories(WHOLE_STRIDES))
    _, among_family = correspond(family)
    _, found = correspond([*family, stranger])
    assert [bool(flag) for flag in found.flags] == [False] * 8 + [True]
    assert found.similarity[-1].min() < MIN_SIMILARITY
    assert "No correspondence: eigenposture" in found.flags[-1]
    np.testing.assert_allclose(found.reference.axes, among_family.reference.axes, atol=1e-6)


def test_walkers_of_the_fourier_form_keep_their_postures(orthogonal_walker) -> None:
    family = [
        decompose_fourier(walker.trajectories(WHOLE_STRIDES))
        for walker in relatives(orthogonal_walker(1), 5, seed=4)
    ]
    together, _ = correspond(family)
    for before, after in zip(family, together, strict=True):
        np.testing.assert_allclose(before.p, after.p, atol=1e-6)


def test_walkers_that_cannot_be_compared_are_refused(orthogonal_walker) -> None:
    walk = orthogonal_walker(1).trajectories(WHOLE_STRIDES)
    with pytest.raises(ValueError, match="decompose all the same way"):
        correspond([decompose_pca(walk), decompose_fourier(walk)])


def test_walkers_that_were_changed_stay_changed(orthogonal_walker) -> None:
    family = relatives(orthogonal_walker(1), 5, seed=4)
    together, found = correspond(family)
    louder = replace(together[0], p=2 * together[0].p)
    again, _ = correspond([louder, *together[1:]])
    loudness = np.linalg.norm(again[0].p) / np.linalg.norm(together[0].p)
    assert loudness == pytest.approx(2)  # its axes may turn a little, as the average changed
    alone, _, _ = correspond_to(louder, found.reference)
    np.testing.assert_allclose(alone.p, louder.p, atol=1e-6)


def test_a_posture_of_hardly_any_movement_flags_nobody(orthogonal_walker) -> None:
    walkers = []
    for seed, walk in enumerate(walks_of_relatives(orthogonal_walker(1), 8, seed=4)):
        noise = np.random.default_rng(seed).normal(scale=2, size=walk.shape)
        noisy = (walk + noise).assign_attrs(units="mm")
        walkers.append(decompose_pca(noisy, n_harmonics=4))
    assert not any(correspond(walkers)[1].flags)
