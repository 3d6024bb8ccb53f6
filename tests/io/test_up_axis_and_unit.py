from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, strategies as st

from eigenwalker.io.up_axis_and_unit import (
    PERSON_MM,
    UNITS,
    UnitGuessed,
    guess_unit,
    head_and_feet,
    turn_upright,
    up_axis,
)

AXES = ["x", "y", "z", "-x", "-y", "-z"]


@pytest.mark.parametrize("up", AXES)
def test_turning_is_a_rotation_that_brings_up_to_z(up):
    turn = turn_upright(up)
    direction = np.eye(3)["xyz".index(up[-1])] * (-1 if up.startswith("-") else 1)
    np.testing.assert_array_equal(turn @ direction, [0, 0, 1])
    assert np.linalg.det(turn) == pytest.approx(1)


def test_a_body_that_faces_z_in_a_y_up_frame_faces_x():
    forward, left, up = np.eye(3)[[2, 0, 1]]
    np.testing.assert_array_equal(turn_upright("y") @ np.stack([forward, left, up]).T, np.eye(3))


@pytest.mark.parametrize("up", AXES)
def test_up_is_told_from_head_and_feet(up):
    body = np.array([[[100.0, 200, 1700], [50, 0, 100], [np.nan] * 3]])
    positions = body @ turn_upright(up)
    assert up_axis(positions, ["Anna:LFHD", "Anna:LTOE", "Anna:RTOE"]) == up


@pytest.mark.parametrize(
    ("names", "place"), [(["a", "b"], [0, 0, 1700]), (["Head", "LToe"], [900, 0, 1000])]
)
def test_names_or_postures_that_do_not_tell_leave_up_open(names, place):
    assert up_axis(np.array([[place, [0.0, 0, 0]]]), names) is None


@pytest.mark.parametrize(
    ("high", "low"),
    [
        ("RBHD", "LHEE"),
        ("Head_end", "LeftToeBase"),
        ("mixamorig:HeadTop_End", "LANK"),
        ("C7", "R.Foot"),
    ],
)
def test_heads_and_feet_go_by_many_names(high, low):
    body = np.zeros((2, 3, 3))
    heads, feet = head_and_feet(body, [high, low, "LeftForeArm"])
    assert heads.shape == feet.shape == (2, 1, 3)


@given(st.sampled_from(sorted(UNITS)), st.floats(1200, 2100))
def test_any_adult_is_measured_in_the_unit_written(unit, height_mm):
    body = np.zeros((3, 2, 3))
    body[:, 0, 2] = height_mm / UNITS[unit]
    with pytest.warns(UnitGuessed):
        guessed = guess_unit(body, ["head", "left_toe"], source="a.bvh")
    assert guessed.name == unit
    assert f"{height_mm:.0f} mm" in guessed.reason


def test_a_height_that_is_no_persons_is_told():
    body = np.zeros((3, 2, 3))
    body[:, 0, 2] = 4 * PERSON_MM
    with pytest.warns(UnitGuessed, match="no person"):
        guess_unit(body, ["head", "left_toe"], source="a.bvh")
