from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.spatial.transform import Rotation

from eigenwalker.markers.joint_centres import HIP_REGRESSIONS, bridged, chord, pelvis_from_spines


def _pelvis(turn: Rotation | None = None):
    turn = turn or Rotation.identity()
    spines = np.array([[0.0, 120, 1000], [0, -120, 1000], [-150, 0, 1000]])
    return pelvis_from_spines(*[turn.apply(point)[None] for point in spines])


def test_the_axes_of_a_level_pelvis_are_those_of_the_room():
    pelvis = _pelvis()
    np.testing.assert_allclose(pelvis.axes[0], np.eye(3), atol=1e-12)
    assert (pelvis.width_mm, pelvis.depth_mm) == (240, 150)


@given(st.integers(0, 10**6))
def test_points_of_the_pelvis_turn_with_it(seed):
    turn = Rotation.random(None, seed)
    still, turned = _pelvis().place(-50, 80, -90), _pelvis(turn).place(-50, 80, -90)
    np.testing.assert_allclose(turned, turn.apply(still), atol=1e-9)


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        # Worked out from the printed equations for a width of 240, a depth of 150, a leg of 900.
        ("harrington", (-45.9, 86.5, -82.9)),
        ("bell", (-45.6, 86.4, -72.0)),
        ("davis", (-46.8, 77.7, -96.6)),
    ],
)
def test_hip_centres_are_those_of_the_printed_equations(name, expected):
    np.testing.assert_allclose(HIP_REGRESSIONS[name](_pelvis(), 900.0), expected, atol=0.1)


@given(st.integers(0, 10**6), st.floats(20, 90))
def test_the_chord_function_gives_a_right_angle_at_the_centre(seed, offset):
    rng = np.random.default_rng(seed)
    proximal, outward = rng.normal(size=(2, 5, 3)) * 50
    marker = proximal + rng.normal(size=(5, 3)) * 20 + [0, 0, -400]
    centre = chord(proximal, marker, outward, offset)
    to_marker, to_proximal = marker - centre, proximal - centre
    np.testing.assert_allclose(np.linalg.norm(to_marker, axis=1), offset)
    np.testing.assert_allclose((to_marker * to_proximal).sum(axis=1), 0, atol=1e-6)
    normal = np.cross(marker - proximal, outward)
    np.testing.assert_allclose((to_marker * normal).sum(axis=1), 0, atol=1e-4)


def test_a_marker_outwards_of_the_joint_gives_the_joint_inwards():
    knee = chord(np.array([[0.0, 0, 400]]), np.array([[0.0, 60, 0]]), np.array([[0.0, 1, 0]]), 60.0)
    np.testing.assert_allclose(knee, 0, atol=1e-9)


def test_missing_samples_stay_missing_in_the_chord_function():
    proximal = np.array([[0.0, 0, 400]] * 3)
    marker = np.array([[0.0, 60, 0]] * 3)
    proximal[1], marker[2] = np.nan, np.nan
    knee = chord(proximal, marker, np.array([[0.0, 1, 0]] * 3), 60.0)
    assert np.isnan(knee).all(axis=1).tolist() == [False, True, True]


def test_gaps_are_bridged_and_ends_held():
    vectors = np.full((6, 3), np.nan)
    vectors[1], vectors[4] = 1.0, 4.0
    np.testing.assert_allclose(bridged(vectors)[:, 0], [1, 1, 2, 3, 4, 4])
    assert np.isnan(bridged(np.full((3, 3), np.nan))).all()
