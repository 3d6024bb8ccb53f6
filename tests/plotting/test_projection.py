"""Projection: what is where in the picture."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, strategies as st
from hypothesis.extra.numpy import arrays

from eigenwalker.plotting.projection import observer_axes, project

points = arrays(float, (4, 5, 3), elements=st.floats(-2000, 2000))
angles = st.floats(-360, 360)
elevations = st.floats(-90, 90)
NOSE, LEFT_HAND, CROWN = [100.0, 0, 1600], [0, 300.0, 900], [0, 0, 1750.0]


def test_from_the_front_the_left_hand_is_at_the_right_of_the_picture():
    assert project(LEFT_HAND).tolist() == [300, 900]
    assert project(NOSE).tolist() == [0, 1600]


def test_at_90_degrees_the_walker_walks_to_the_right_and_at_minus_90_to_the_left():
    np.testing.assert_allclose(project(NOSE, azimuth_deg=90), [100, 1600], atol=1e-9)
    np.testing.assert_allclose(project(NOSE, azimuth_deg=-90), [-100, 1600], atol=1e-9)


def test_at_30_degrees_the_walker_has_turned_a_third_of_the_way_to_the_right_of_the_picture():
    np.testing.assert_allclose(project([1000.0, 0, 0], azimuth_deg=30), [500, 0], atol=1e-9)


def test_from_straight_above_a_walker_that_comes_towards_the_observer_points_down():
    np.testing.assert_allclose(project(NOSE, elevation_deg=90), [0, -100], atol=1e-9)
    np.testing.assert_allclose(project(CROWN, elevation_deg=90), [0, 0], atol=1e-9)


@given(angles, elevations)
def test_the_axes_of_the_observer_are_a_rotation(azimuth_deg, elevation_deg):
    axes = observer_axes(azimuth_deg, elevation_deg)
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(axes) == pytest.approx(1)


@given(points, points, angles, elevations)
def test_orthographic_projection_is_linear(a, b, azimuth_deg, elevation_deg):
    def seen(positions):
        return project(positions, azimuth_deg=azimuth_deg, elevation_deg=elevation_deg)

    np.testing.assert_allclose(seen(2 * a - b), 2 * seen(a) - seen(b), atol=1e-8)


@given(points, angles)
def test_turning_the_walker_to_its_left_is_turning_the_view(positions, azimuth_deg):
    angle = np.deg2rad(azimuth_deg)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    turned = np.concatenate([positions[..., :2] @ turn.T, positions[..., 2:]], axis=-1)
    np.testing.assert_allclose(
        project(turned), project(positions, azimuth_deg=azimuth_deg), atol=1e-8
    )


@given(points, angles, elevations)
def test_perspective_from_far_away_is_orthographic(positions, azimuth_deg, elevation_deg):
    far = project(
        positions, azimuth_deg=azimuth_deg, elevation_deg=elevation_deg, eye_distance_mm=1e12
    )
    near = project(positions, azimuth_deg=azimuth_deg, elevation_deg=elevation_deg)
    np.testing.assert_allclose(far, near, atol=1e-3)


def test_in_perspective_what_is_nearer_is_larger_in_proportion():
    square = np.array([[500.0, y, z] for y in (-100, 100) for z in (0, 200)])
    seen = project(np.concatenate([square, square - [1000, 0, 0]]), eye_distance_mm=2000)
    near, far = np.ptp(seen[:4], axis=0), np.ptp(seen[4:], axis=0)
    np.testing.assert_allclose(near / far, 2500 / 1500)


def test_an_eye_among_the_points_is_refused_with_a_distance_that_would_do():
    with pytest.raises(ValueError, match=r"eye_distance_mm=100 puts the eye .* more than 500"):
        project([[500.0, 0, 0], [-500.0, 0, 0]], eye_distance_mm=100)


def test_missing_points_stay_missing():
    seen = project([[np.nan] * 3, NOSE], eye_distance_mm=3000)
    assert np.isnan(seen[0]).all()
    assert np.isfinite(seen[1]).all()


def test_positions_without_three_coordinates_are_refused():
    with pytest.raises(ValueError, match="x, y, z"):
        project(np.zeros((4, 2)))
