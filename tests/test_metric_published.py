from __future__ import annotations

import numpy as np
import pytest

from eigenwalker.metric.groups import BONES
from eigenwalker.metric.published import PUBLISHED, GroupMetric, metric_named
from eigenwalker.skeleton import JOINTS

FIGURE_5 = [
    f"{by}-{shape}"
    for by in ("angles", "positions", "velocities")
    for shape in ("squared", "absolute", "sigmoid")
]


@pytest.mark.parametrize("name", FIGURE_5)
def test_weights_of_each_row_sum_to_one_but_for_rounding_and_one_misprint(name):
    total = sum(PUBLISHED[name].group_weights.values())
    assert total == pytest.approx(1.027 if name == "velocities-sigmoid" else 1, abs=0.0021)


@pytest.mark.parametrize("name", FIGURE_5)
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
    assert metric.left_out(names) == ["hand", "toe"]
    np.testing.assert_allclose(metric.weights_for(names), [0.5, 0.5, 0])


def test_points_that_weigh_nothing_are_refused():
    with pytest.raises(ValueError, match=r"\['hand', 'calf', 'toe'\] alone"):
        PUBLISHED["velocities-absolute"].weights_for(["head"])


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"group_weights": {"knee": 1.0}}, "joint groups"),
        ({"group_weights": {"calf": -1.0}}, "joint groups"),
        ({"group_weights": {"calf": 0.0}}, "above 0"),
        ({"shape": "sigmoid"}, "scale"),
        ({"by": "forces"}, "forces"),
    ],
)
def test_metrics_that_make_no_sense_are_refused(wrong, said):
    fine = {"name": "x", "by": "positions", "shape": "absolute", "group_weights": {"calf": 1.0}}
    with pytest.raises(ValueError, match=said):
        GroupMetric(**fine | wrong)


def test_unknown_names_are_refused_with_those_known():
    with pytest.raises(ValueError, match="positions-sigmoid"):
        metric_named("positions-cubed")


def test_lee_weighs_the_large_joints_alike_and_others_not():
    weights = dict(zip(BONES, PUBLISHED["lee"].weights_for(BONES), strict=True))
    assert weights["left_thigh"] == weights["right_forearm"] == pytest.approx(1 / 8)
    assert weights["head"] == weights["left_hand"] == weights["left_toe"] == 0
