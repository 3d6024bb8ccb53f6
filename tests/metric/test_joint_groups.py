from __future__ import annotations

import pytest

from eigenwalker.core.skeleton import JOINTS
from eigenwalker.metric import BONES, GROUPS, collinear_groups, group_points, group_table
from eigenwalker.simulation.walk import simulate_walk


def test_fifteen_joints_stand_for_all_groups_of_figure_5():
    points = group_points(JOINTS.markers)
    assert tuple(points) == GROUPS
    assert points["upper_arm"] == ("left_shoulder", "right_shoulder")
    assert points["hand"] == ("left_wrist", "right_wrist")
    assert points["toe"] == ("left_ankle", "right_ankle")  # the nearest there is


def test_toes_and_clavicles_are_taken_where_they_were_captured():
    points = group_points([*JOINTS.markers, "left_toe", "right_toe", "left_clavicle"])
    assert points["toe"] == ("left_toe", "right_toe")
    assert points["clavicle"] == ("left_clavicle",)


def test_bones_stand_for_themselves():
    points = group_points(BONES, "angles")
    assert tuple(points) == GROUPS
    assert points["calf"] == ("left_calf", "right_calf")


def test_groups_that_a_capture_lacks_are_left_out():
    assert group_points(["left_knee", "head"]) == {"head": ("head",), "calf": ("left_knee",)}


def test_points_of_no_group_are_refused():
    with pytest.raises(ValueError, match="virtual_markers"):
        group_points(["C7", "T10"])


def test_the_mannequin_s_sternum_does_not_stand_in_for_clavicles():
    names = [*JOINTS.markers, "left_toe", "right_toe"]
    assert tuple(group_points(names, mannequin=True)) == tuple(g for g in GROUPS if g != "clavicle")
    own = group_points([*names, "left_clavicle"], mannequin=True)
    assert own["clavicle"] == ("left_clavicle",)


def test_collinear_groups_are_named():
    walks = {str(seed): simulate_walk(seed=seed, rate_hz=60) for seed in range(8)}
    table = collinear_groups(group_table(walks, "positions-absolute"))
    correlations = table.set_index(["first", "second"]).correlation
    assert 0.95 < correlations["clavicle", "upper_arm"] <= 1  # the sternum is between the shoulders
