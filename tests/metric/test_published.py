from __future__ import annotations

import numpy as np
import pytest

from eigenwalker.core.skeleton import JOINTS
from eigenwalker.metric import BONES, FIGURE_5, PUBLISHED, GroupMetric
from eigenwalker.metric.published import metric_named

ROWS = [
    f"{by}-{shape}"
    for by in ("angles", "positions", "velocities")
    for shape in ("squared", "absolute", "sigmoid")
]


PRINTED = """
angles squared         23.335 0.508  659.272 0.000 0.000 0.006 0.000   -   0.669 0.325   -
angles absolute        18.448 0.324   19.537 0.041 0.003 0.061 0.000   -   0.622 0.273   -
angles sigmoid         18.004 0.312   20.016 0.039 0.008 0.076 0.000   -   0.614 0.263   -
positions squared      17.117 0.290  206.509 0.062 0.000 0.551 0.181 0.000 0.000 0.050 0.156
positions absolute     13.423 0.069    9.909 0.020 0.000 0.362 0.429 0.000 0.000 0.000 0.189
positions sigmoid      13.264 0.059   10.375 0.015 0.000 0.344 0.455 0.000 0.000 0.000 0.184
velocities squared     25.779 0.431 1914.283 0.000 0.000 0.000 0.000 0.605 0.000 0.298 0.098
velocities absolute    22.039 0.193   36.885 0.000 0.000 0.000 0.000 0.551 0.000 0.298 0.151
velocities sigmoid     21.993 0.189   36.532 0.000 0.000 0.000 0.000 0.564 0.000 0.306 0.157
"""
"""Figure 5 of the paper: difference, constant, normalisation constant, and the weights of head,
clavicle, upper arm, forearm, hand, thigh, calf and toe. ("Euclid" is squared, "manh" absolute.)"""
COLUMNS = ("head", "clavicle", "upper_arm", "forearm", "hand", "thigh", "calf", "toe")


@pytest.mark.parametrize("line", PRINTED.strip().splitlines())
def test_each_row_is_that_of_the_paper(line):
    by, shape, *numbers = line.split()
    difference, constant, normalisation, *weights = (
        0.0 if number == "-" else float(number) for number in numbers
    )
    metric = PUBLISHED[f"{by}-{shape}"]
    assert (metric.by, metric.shape) == (by, shape)
    assert metric.group_weights == dict(zip(COLUMNS, weights, strict=True))
    printed = FIGURE_5[by, shape]
    assert printed[:3] == (difference, constant, normalisation)


def test_groups_weigh_the_same_in_the_manner_of_kovar():
    names = [*JOINTS.markers, "left_toe", "right_toe"]
    weights = dict(zip(names, PUBLISHED["kovar"].weights_for(names), strict=True))
    assert weights["head"] == 2 * weights["left_elbow"] == weights["sternum"] == 1 / 8
    assert weights["pelvis"] == weights["left_ankle"] == 0


@pytest.mark.parametrize("name", ROWS)
def test_weights_of_each_row_sum_to_one_but_for_rounding_and_one_misprint(name):
    total = sum(PUBLISHED[name].group_weights.values())
    assert total == pytest.approx(1.027 if name == "velocities-sigmoid" else 1, abs=0.0021)


@pytest.mark.parametrize("name", ROWS)
def test_each_row_weighs_points_of_a_walker(name):
    metric = PUBLISHED[name]
    names = BONES if metric.by == "angles" else JOINTS.markers
    weights = dict(zip(names, metric.weights_for(names), strict=True))
    assert sum(weights.values()) == pytest.approx(1)
    sided = [name for name in names if name.startswith("left_")]
    assert all(weights[each] == weights[each.replace("left", "right")] for each in sided)


def test_elbows_are_what_matters_most_in_the_best_metric():
    metric = PUBLISHED["positions-sigmoid"]
    weights = dict(zip(JOINTS.markers, metric.weights_for(JOINTS.markers), strict=True))
    assert max(weights, key=weights.__getitem__) == "left_elbow"
    assert weights["left_elbow"] == pytest.approx(0.455 / 0.998 / 2)


def test_left_and_right_share_a_weight_and_one_side_alone_takes_it():
    metric = GroupMetric("mine", "positions", "absolute", {"calf": 1.0, "head": 1.0})
    np.testing.assert_allclose(metric.weights_for(["left_knee", "head"]), [0.5, 0.5])
    both = metric.weights_for(["left_knee", "right_knee", "head", "pelvis"])
    np.testing.assert_allclose(both, [0.25, 0.25, 0.5, 0])


def test_what_a_clip_lacks_is_said_and_its_weight_falls_to_others():
    metric = PUBLISHED["velocities-absolute"]  # hand, calf and toe
    names = ["left_knee", "right_knee", "left_hip"]
    assert metric.missing_groups(names) == ["hand", "toe"]
    np.testing.assert_allclose(metric.weights_for(names), [0.5, 0.5, 0])


def test_points_that_weigh_nothing_are_refused():
    with pytest.raises(ValueError, match=r"\['hand', 'calf', 'toe'\] alone"):
        PUBLISHED["velocities-absolute"].weights_for(["head"])


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"group_weights": {"knee": 1.0}}, "joint groups"),
        ({"group_weights": {"calf": -1.0}}, "joint groups"),
        ({"group_weights": {"calf": 0.0}}, "above 0"),
        ({"shape": "sigmoid", "scale": 0.0}, "scale"),
        ({"by": "forces"}, "forces"),
    ],
)
def test_metrics_that_make_no_sense_are_refused(wrong, message):
    fine = {"name": "x", "by": "positions", "shape": "absolute", "group_weights": {"calf": 1.0}}
    with pytest.raises(ValueError, match=message):
        GroupMetric(**fine | wrong)


def test_unknown_names_are_refused_with_those_known():
    with pytest.raises(ValueError, match="positions-sigmoid"):
        metric_named("positions-cubed")


def test_lee_weighs_the_large_joints_alike_and_others_not():
    weights = dict(zip(BONES, PUBLISHED["lee"].weights_for(BONES), strict=True))
    assert weights["left_thigh"] == weights["right_forearm"] == pytest.approx(1 / 8)
    assert weights["head"] == weights["left_hand"] == weights["left_toe"] == 0
