"""Published norms of joint angles, as the sources print them."""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from eigenwalker.core.fourier import harmonic_basis
from eigenwalker.simulation.body import TOE_BEND, Foot
from eigenwalker.simulation.norms import delay, norm_coefficients

FOOT = Foot(heel=70.0, ball=105.0, toe=60.0, height=70.0)
PITCH = np.radians(np.linspace(-25, 75, 101))


def curve(name, speed=0.43):
    return harmonic_basis(np.linspace(0, 1, 100, endpoint=False), 4) @ norm_coefficients(
        name, speed, 4
    )


def test_extremes_are_those_that_schwartz_et_al_print():
    assert curve("hip_flexion")[0] == pytest.approx(36.3, abs=1)
    assert curve("hip_flexion").min() == pytest.approx(-5.7, abs=2)
    assert curve("knee_flexion")[0] == pytest.approx(5.6, abs=1)
    assert curve("knee_flexion").max() == pytest.approx(60.5, abs=3)


def test_joints_move_more_the_faster_one_walks():
    for name in ("hip_flexion", "knee_flexion", "pelvis_rotation"):
        assert np.ptp(curve(name, 0.56)) > np.ptp(curve(name, 0.29))


@given(lag=st.floats(-1, 1), phase=st.floats(0, 1))
def test_a_curve_that_is_late_is_the_same_curve_delay(lag, phase):
    coefficients = norm_coefficients("knee_flexion", 0.43, 4)
    now = harmonic_basis(np.array([phase]), 4) @ delay(coefficients, lag)
    assert now == pytest.approx(harmonic_basis(np.array([phase - lag]), 4) @ coefficients, abs=1e-9)


def test_a_planted_foot_touches_the_ground_and_nothing_of_it_is_below():
    ankle, _ = FOOT.ankle_over_print(PITCH)
    sole, _ = FOOT.sole_under_ankle(PITCH)
    heights = ankle[:, None, 1] + sole[..., 1]
    np.testing.assert_allclose(heights.min(axis=1), 0, atol=1e-9)


def test_a_planted_foot_rolls_without_slipping():
    ankle, _ = FOOT.ankle_over_print(PITCH)
    sole, _ = FOOT.sole_under_ankle(PITCH)
    places = ankle[:, None, 0] + sole[..., 0]
    bearing = {0: PITCH < 0, 1: (PITCH > 0) & (PITCH < TOE_BEND), 2: PITCH > TOE_BEND}
    for point, when in bearing.items():
        assert np.ptp(places[when, point]) < 1e-9


@pytest.mark.parametrize("method", ["ankle_over_print", "sole_under_ankle"])
def test_slopes_of_the_foot_are_its_derivatives(method):
    step = 1e-6
    away = PITCH[(np.abs(PITCH) > 0.01) & (np.abs(PITCH - TOE_BEND) > 0.01)]
    _, slope = getattr(FOOT, method)(away)
    above, below = (getattr(FOOT, method)(away + sign * step)[0] for sign in (1, -1))
    np.testing.assert_allclose(slope, (above - below) / (2 * step), atol=1e-4)
