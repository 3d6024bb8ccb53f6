"""What the eye takes in of a walk: made walkers of known widths, sway and stride."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import eigenwalker as ew
from eigenwalker.gait.appearance import walker_measures

AMPLITUDES = {"lateral": 25.0, "vertical": 18.0, "foot": 280.0}


def made_walker() -> ew.Walker:
    """A body whose shoulders sway 50 mm, whose pelvis bobs 36 mm, and whose stride is 1.12 m."""
    markers = ew.JOINTS.markers
    p0, p = np.zeros((15, 3)), np.zeros((2, 15, 3))
    sides = {"left": 1, "right": -1}
    for part, (aside, height) in {
        "shoulder": (180, 1400),
        "elbow": (250, 1100),
        "hip": (90, 900),
        "ankle": (60, 80),
    }.items():
        for side, sign in sides.items():
            p0[markers.index(f"{side}_{part}")] = 0, sign * aside, height
    p0[markers.index("pelvis")] = 0, 0, 950
    for side, sign in sides.items():
        p[0, markers.index(f"{side}_shoulder"), 1] = AMPLITUDES["lateral"]
        p[0, markers.index(f"{side}_ankle"), 0] = sign * AMPLITUDES["foot"]
    p[1, markers.index("pelvis"), 2] = AMPLITUDES["vertical"]
    return ew.Walker(markers, p0, p, [1, 2], [0, 0], 0.9, speed_mm_s=1008.0)


def test_measures_are_those_the_walker_was_made_with():
    assert walker_measures(made_walker()).to_dict() == pytest.approx(
        {
            "shoulder_width_mm": 360,
            "hip_width_mm": 180,
            "elbow_distance_mm": 500,
            "lateral_sway_mm": 2 * AMPLITUDES["lateral"],
            "vertical_movement_mm": 2 * AMPLITUDES["vertical"],
            "frequency_hz": 0.9,
            "stride_length_mm": 1120,
        },
        abs=0.01,
    )


def test_a_walker_without_a_speed_steps_as_far_as_its_feet_say():
    people = ew.load_population()
    made = people.walker(people.X[3])
    known, told = (walker_measures(each) for each in (made, replace(made, speed_mm_s=np.nan)))
    feet_mm = known["stride_length_mm"] / people.speed_factor
    assert told["stride_length_mm"] == pytest.approx(feet_mm, rel=1e-9)
    own = people.walkers[3]
    assert told["stride_length_mm"] == pytest.approx(
        own.speed_mm_s / own.frequency_hz, rel=0.15
    )  # sines of two harmonics roll over the foot


def test_up_and_down_is_that_of_the_gait_parameters():
    walker = ew.load_population().walkers[20]
    bob = ew.gait.gait_parameters(walker)["pelvis_vertical_range_mm"]
    assert walker_measures(walker)["vertical_movement_mm"] == pytest.approx(bob, abs=0.1)


def test_men_are_wider_at_the_shoulders_and_elbows_than_at_the_hips():
    people = ew.load_population().size_normalised()
    step = ew.trait_axis(people, "sex").step
    she, he = (walker_measures(people.walker(people.average + a * step)) for a in (-3, 3))
    assert he["shoulder_width_mm"] > she["shoulder_width_mm"]
    assert he["elbow_distance_mm"] > she["elbow_distance_mm"]
    assert he["hip_width_mm"] < she["hip_width_mm"]


def test_what_markers_do_not_tell_is_missing():
    hop = ew.Walker(["foot"], [[0, 0, 50]], [[[0, 0, 40]]], [1], [0], 1.0)
    told = walker_measures(hop)
    assert told.drop("frequency_hz").isna().all()
    assert told["frequency_hz"] == 1


def test_without_a_pelvis_the_hips_tell_up_and_down():
    walker = ew.Walker(
        ["left_hip", "right_hip"],
        [[0, 90, 900], [0, -90, 900]],
        [[[0, 0, 30], [0, 0, 10]]],
        [1],
        [0],
        1.0,
    )
    assert walker_measures(walker)["vertical_movement_mm"] == pytest.approx(40)
