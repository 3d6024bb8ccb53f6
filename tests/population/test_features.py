"""The layout of feature vectors: names, parts, and there and back."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, strategies as st

from eigenwalker.core import JOINTS
from eigenwalker.decomposition import decompose_fourier, decompose_pca
from eigenwalker.population.features import FeatureLayout, circular_mean, wrap_phase

WHOLE_STRIDES = np.arange(1500) / 120


def test_a_walker_has_229_numbers_and_its_fourier_form_226(orthogonal_walker) -> None:
    walk = orthogonal_walker().trajectories(WHOLE_STRIDES)
    assert len(FeatureLayout.of(decompose_pca(walk)).names) == 229  # J11: 5 * 45 + 4
    assert len(FeatureLayout.of(decompose_fourier(walk)).names) == 226  # W3: 5 * 45 + 1


@pytest.mark.parametrize("decompose", [decompose_pca, decompose_fourier])
@pytest.mark.parametrize("n_harmonics", [1, 2, 3])
def test_vector_and_walker_are_each_others_inverse(
    decompose, n_harmonics, orthogonal_walker
) -> None:
    walker = decompose(orthogonal_walker().trajectories(WHOLE_STRIDES), n_harmonics=n_harmonics)
    layout = FeatureLayout.of(walker)
    vector = layout.vector(walker)
    assert vector.shape == (len(layout),)
    again = layout.walker(vector)
    times = np.linspace(0, 3, 20) + walker.time_origin_s
    np.testing.assert_allclose(
        again.trajectories(times - walker.time_origin_s), walker.trajectories(times), atol=1e-9
    )
    np.testing.assert_allclose(layout.vector(again), vector, atol=1e-12)


def test_every_number_stands_where_its_name_says(orthogonal_walker) -> None:
    walker = orthogonal_walker()
    layout = FeatureLayout.of(walker)
    vector, names = layout.vector(walker), layout.names
    at = dict(zip(names, vector, strict=True))
    knee = JOINTS.index("left_knee")
    assert at["p0.left_knee.z"] == walker.p0[knee, 2]
    assert at["p3.left_knee.y"] == walker.p[2, knee, 1]
    assert at["frequency_hz"] == walker.frequency_hz
    assert at["phase4"] == pytest.approx(walker.phases[3])
    assert len(set(names)) == len(names)


def test_parts_are_the_papers() -> None:
    layout = FeatureLayout(JOINTS.markers, (1, 1, 2, 2))
    sizes = {name: len(layout.columns(name)) for name in ("structure", "dynamics", "p1", "phases")}
    assert sizes == {"structure": 45, "dynamics": 184, "p1": 45, "phases": 3}
    everything = np.concatenate([layout.columns("structure"), layout.columns("dynamics")])
    assert sorted(everything) == list(range(229))
    split = np.concatenate([layout.columns("postures"), layout.columns("timing")])  # J45
    assert sorted(split) == list(range(229))
    with pytest.raises(ValueError, match="no part 'p5'"):
        layout.columns("p1+p5")


@given(st.lists(st.floats(-50, 50), min_size=1, max_size=5), st.floats(-3, 3))
def test_wrapping_keeps_the_angle_and_stays_near_the_centre(angles, centre) -> None:
    angles = np.array(angles)
    wrapped = wrap_phase(angles, around=centre)
    np.testing.assert_allclose(np.exp(1j * wrapped), np.exp(1j * angles), atol=1e-9)
    assert (np.abs(wrapped - centre) <= np.pi + 1e-9).all()


def test_the_mean_of_angles_goes_round_the_circle() -> None:
    mean = circular_mean(np.radians([[170.0], [-160.0]]))
    assert np.degrees(mean)[0] % 360 == pytest.approx(185)
