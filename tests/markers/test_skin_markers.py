from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from scipy.spatial.transform import Rotation

from eigenwalker.markers.skin_markers import filled_cluster, midpoint

PELVIS = np.array([[0.0, 120, 0], [0, -120, 0], [-150, 40, 10], [-150, -40, 10]])


def _moving(n_frames: int = 8, seed: int = 0) -> np.ndarray:
    """Return a rigid part that turns a little and goes its way, array (time, marker, 3)."""
    rng = np.random.default_rng(seed)
    turns = Rotation.from_rotvec(np.linspace(0, 0.3, n_frames)[:, None] * rng.normal(size=3))
    places = np.linspace(0, 500, n_frames)[:, None] * [1, 0, 0]
    return np.stack([turns.apply(point) for point in PELVIS], axis=1) + places[:, None]


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 3), st.integers(0, 10**6))
def test_one_of_four_is_put_where_the_other_three_say(gone, seed):
    whole = _moving(seed=seed)
    lacking = whole.copy()
    lacking[3:6, gone] = np.nan
    filled = np.stack(filled_cluster(list(lacking.transpose(1, 0, 2))), axis=1)
    np.testing.assert_allclose(filled, whole, atol=1e-6)


def test_two_that_are_far_apart_are_nearly_enough():
    whole = _moving()
    lacking = whole.copy()
    lacking[4, [0, 2]] = np.nan
    filled = np.stack(filled_cluster(list(lacking.transpose(1, 0, 2))), axis=1)
    assert np.linalg.norm(filled - whole, axis=2).max() < 15


@pytest.mark.parametrize("seen", [[2, 3], [0], []])
def test_too_few_markers_leave_the_others_missing(seen):
    lacking = _moving()
    gone = [marker for marker in range(4) if marker not in seen]
    lacking[4, gone] = np.nan
    filled = np.stack(filled_cluster(list(lacking.transpose(1, 0, 2))), axis=1)
    np.testing.assert_array_equal(np.isnan(filled), np.isnan(lacking))


def test_markers_never_seen_together_stay_as_they_are():
    lacking = _moving()
    lacking[:4, 0], lacking[4:, 1] = np.nan, np.nan
    filled = np.stack(filled_cluster(list(lacking.transpose(1, 0, 2))), axis=1)
    np.testing.assert_array_equal(filled, lacking)


def test_markers_in_one_place_or_line_do_no_harm():
    for shape in (np.zeros((4, 3)), np.arange(12.0).reshape(4, 3)):
        points = np.tile(shape, (5, 1, 1))
        points[2, 1] = np.nan
        filled = np.stack(filled_cluster(list(points.transpose(1, 0, 2))), axis=1)
        assert np.isfinite(filled[2]).all() == bool(shape.any())


def test_the_midpoint_of_two_survives_the_loss_of_one():
    first, second = _moving()[:, :2].transpose(1, 0, 2)
    whole = midpoint([first, second])
    np.testing.assert_allclose(whole, (first + second) / 2)
    lacking = second.copy()
    lacking[3:5] = np.nan
    assert np.linalg.norm(midpoint([first, lacking]) - whole, axis=1).max() < 2
    assert np.isnan(midpoint([np.full_like(first, np.nan), second])).all()
