"""Decompositions against known truth, scikit-learn, and one real stride."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings, strategies as st
from sklearn.decomposition import PCA

from eigenwalker.core import JOINTS, Walker, label_trajectories
from eigenwalker.decomposition import decompose_fourier, decompose_pca

WHOLE_STRIDES = np.arange(1500) / 120
"""Ten strides of 0.8 Hz, 150 frames each."""


def any_walker(seed: int, n_harmonics: int = 2) -> Walker:
    """A walker of the Fourier form whose postures are neither orthogonal nor ordered."""
    rng = np.random.default_rng(seed)
    harmonics = np.repeat(np.arange(1, n_harmonics + 1), 2)
    p = rng.normal(size=(2 * n_harmonics, 15, 3)) * (60 / harmonics**2)[:, None, None]
    p[0, JOINTS.index("left_ankle"), 0] = 200
    p[1, JOINTS.index("left_ankle"), 0] = p[1, JOINTS.index("right_ankle"), 0] = 10
    p[0, JOINTS.index("right_ankle"), 0] = -200
    return Walker(
        markers=JOINTS.markers,
        p0=rng.normal(size=(15, 3)) * 300,
        p=p,
        harmonics=harmonics,
        phases=np.tile([0, np.pi / 2], n_harmonics),
        frequency_hz=rng.uniform(0.6, 1.2),
        form="fourier",
    )


def assert_same(found: Walker, planted: Walker, atol: float = 1e-9) -> None:
    for name in ("p0", "p", "harmonics", "phases", "frequency_hz"):
        np.testing.assert_allclose(
            getattr(found, name), getattr(planted, name), atol=atol, rtol=0, err_msg=name
        )


@pytest.mark.parametrize("n_harmonics", [1, 2, 4])
@given(seed=st.integers(0, 999), start_s=st.floats(-20, 20), length_s=st.floats(6, 14))
@settings(max_examples=15, deadline=None)
def test_fourier_decomposition_inverts_synthesis(
    n_harmonics: int, seed: int, start_s: float, length_s: float
) -> None:
    planted = any_walker(seed, n_harmonics)
    time = start_s + np.arange(0, length_s, 1 / 120)
    found = decompose_fourier(planted.trajectories(time), n_harmonics=n_harmonics)
    assert_same(found, planted)
    np.testing.assert_allclose(
        found.trajectories(time), planted.trajectories(time), atol=1e-9, rtol=0
    )


@given(seed=st.integers(0, 999))
@settings(max_examples=15, deadline=None)
def test_pca_decomposition_inverts_synthesis(orthogonal_walker, seed: int) -> None:
    planted = orthogonal_walker(seed)
    walk = planted.trajectories(WHOLE_STRIDES)
    found = decompose_pca(walk)
    assert_same(found, planted)
    np.testing.assert_allclose(found.trajectories(walk.time), walk, atol=1e-9, rtol=0)
    assert found.fit is not None
    np.testing.assert_allclose(found.fit.sine_r2, 1)


def test_both_decompositions_agree_on_orthogonal_postures(orthogonal_walker) -> None:
    walk = orthogonal_walker().trajectories(WHOLE_STRIDES)
    by_pca, by_fourier = decompose_pca(walk), decompose_fourier(walk)
    times = np.linspace(0, 3, 50)
    np.testing.assert_allclose(by_pca.trajectories(times), by_fourier.trajectories(times))


def test_components_are_those_of_scikit_learn(orthogonal_walker) -> None:
    walk = orthogonal_walker().trajectories(np.arange(0, 12, 1 / 120))
    noise = np.random.default_rng(1).normal(scale=5, size=walk.shape)
    walk = label_trajectories(walk + noise + 1e4, markers=JOINTS.markers, rate_hz=120)
    walker = decompose_pca(walk)
    oracle = PCA(4).fit(walk.values.reshape(len(walk.time), -1))
    units = walker.p.reshape(4, -1) / np.linalg.norm(walker.p.reshape(4, -1), axis=1)[:, None]
    np.testing.assert_allclose(np.abs(np.sum(units * oracle.components_, axis=1)), 1)
    np.testing.assert_allclose(walker.p0.ravel(), oracle.mean_)
    assert walker.fit is not None
    np.testing.assert_allclose(walker.fit.variance_share[:4], oracle.explained_variance_ratio_)


def test_shares_are_those_of_the_residual() -> None:
    planted = any_walker(3)
    time = np.arange(0, 11, 1 / 100)
    noise = np.random.default_rng(0).normal(scale=10, size=(len(time), 15, 3))
    walk = planted.trajectories(time) + noise
    walk.attrs["units"] = "mm"
    for decompose in (decompose_pca, decompose_fourier):
        walker = decompose(walk)
        residual = ((walk - walker.trajectories(time)) ** 2).sum().item()
        total = ((walk - walk.mean("time")) ** 2).sum().item()
        assert walker.fit is not None
        assert walker.fit.r2 == pytest.approx(1 - residual / total, abs=1e-3)
        assert walker.fit.relative_rms == pytest.approx(np.sqrt(1 - walker.fit.r2))
        assert walker.fit.residual_power == pytest.approx(
            residual / (walk**2).sum().item(), rel=2e-2
        )


@pytest.mark.parametrize("decompose", [decompose_pca, decompose_fourier])
def test_a_later_clock_changes_the_time_origin_alone(decompose, orthogonal_walker) -> None:
    walk = orthogonal_walker(5).trajectories(WHOLE_STRIDES)
    early, late = decompose(walk), decompose(walk.assign_coords(time=walk.time + 3.21))
    assert_same(late, early)
    assert late.time_origin_s == pytest.approx(early.time_origin_s + 3.21)


@pytest.mark.parametrize("decompose", [decompose_pca, decompose_fourier])
@given(dropped=st.integers(1, 149))
@settings(max_examples=10, deadline=None)
def test_a_capture_that_starts_later_changes_the_time_origin_alone(
    decompose, orthogonal_walker, dropped: int
) -> None:
    planted = orthogonal_walker(5)
    late = decompose(planted.trajectories(WHOLE_STRIDES + dropped / 120))
    assert_same(late, decompose(planted.trajectories(WHOLE_STRIDES)))
    cycles = (late.time_origin_s - planted.time_origin_s) * planted.frequency_hz
    if decompose is decompose_pca:
        assert cycles == pytest.approx(round(cycles), abs=1e-9)


@pytest.mark.parametrize("decompose", [decompose_pca, decompose_fourier])
def test_a_mirrored_walk_gives_the_mirrored_walker_half_a_stride_later(
    decompose, orthogonal_walker
) -> None:
    planted = orthogonal_walker(7)
    walk = planted.trajectories(WHOLE_STRIDES)
    flip = np.array([1, -1, 1])
    order = list(JOINTS.mirror())
    mirrored = xr.DataArray(walk.values[:, order] * flip, walk.coords, walk.dims, attrs=walk.attrs)
    walker, twin = decompose(walk), decompose(mirrored)
    signs = (-1.0) ** walker.harmonics
    expected = replace(
        walker,
        p0=walker.p0[order] * flip,
        p=walker.p[:, order] * flip * signs[:, None, None],
    )
    assert_same(twin, expected)
    half = (twin.time_origin_s - walker.time_origin_s) * walker.frequency_hz
    assert half % 1 == pytest.approx(0.5)


def test_dominant_harmonics_are_told_when_they_cross(orthogonal_walker) -> None:
    planted = orthogonal_walker()
    stronger = planted.p * np.array([1, 0.3, 2.5, 1])[:, None, None]
    walk = replace(planted, p=stronger).trajectories(WHOLE_STRIDES)
    assert decompose_pca(walk).harmonics.tolist() == [1, 2, 2, 1]


def test_any_markers_decompose_at_any_number_of_harmonics() -> None:
    time = np.arange(0, 8, 0.01)
    ball = np.column_stack([9 * np.sin(6 * time), 3 * np.cos(12 * time), np.cos(18 * time)])
    walk = label_trajectories(ball[:, None] * 10, markers=["ball"], rate_hz=100)
    walker = decompose_fourier(walk, n_harmonics=3)
    assert walker.fit is not None
    assert walker.fit.r2 == pytest.approx(1)
    assert decompose_pca(walk, n_harmonics=3).p.shape == (3, 1, 3)


def test_missing_samples_are_refused_by_name() -> None:
    values = np.random.default_rng(0).normal(size=(100, 2, 3))
    values[5, 1] = np.nan
    walk = label_trajectories(values, markers=["head", "left_knee"], rate_hz=100)
    with pytest.raises(ValueError, match=r"left_knee.*in_place"):
        decompose_pca(walk)


def test_one_real_stride_in_place(captures) -> None:
    """The issue's bound, on a real stride, in the axes of the project, three times over."""
    values = np.loadtxt(captures / "delussanet" / "sample_walker3.txt").reshape(99, 16, 3)
    x, up, lateral = np.moveaxis(values, -1, 0)
    stride = np.stack([x, -lateral, up], axis=-1) * 1e-5
    walk = label_trajectories(
        np.tile(stride, (3, 1, 1)), markers=[f"point {i}" for i in range(16)], rate_hz=99, unit="m"
    )
    by_fourier, by_pca = decompose_fourier(walk), decompose_pca(walk)
    assert by_fourier.fit is not None
    assert by_pca.fit is not None
    assert by_fourier.frequency_hz == pytest.approx(1, abs=1e-3)
    assert by_fourier.fit.r2 > 0.995
    assert by_pca.fit.variance_share[:4].sum() > 0.996


@pytest.mark.parametrize(
    ("n_harmonics", "said"), [(0, "1 or more"), (1.5, "whole number"), (20, "harmonics at most")]
)
def test_harmonics_that_cannot_be_are_refused(orthogonal_walker, n_harmonics, said) -> None:
    walk = orthogonal_walker().trajectories(np.arange(0, 12, 1 / 25))
    for decompose in (decompose_pca, decompose_fourier):
        with pytest.raises(ValueError, match=said):
            decompose(walk, n_harmonics=n_harmonics)
