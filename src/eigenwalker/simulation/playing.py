"""A person's cycle played over time: joint angles and the path of the pelvis, frame by frame."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from eigenwalker.simulation.body import Body
from eigenwalker.simulation.cycle import (
    LEG_HARMONICS,
    PELVIS_HARMONICS,
    Cycle,
    Pace,
    ankle_to_the_side,
    trunk_curves,
)
from eigenwalker.simulation.norms import CURVES_DEG, basis, later
from eigenwalker.simulation.posture import SIDES, trunk_turns, turned
from eigenwalker.simulation.strides import Strides

Angles = dict[str, np.ndarray]


def play(
    person: Mapping[str, float], body: Body, pace: Pace, cycle: Cycle, strides: Strides
) -> tuple[Angles, np.ndarray]:
    """Return joint angles in radians and the path of the pelvis point in millimetres.

    Parameters
    ----------
    person, body, pace, cycle
        Who walks, and how.
    strides : Strides
        Phase, step length and placement of the feet in each frame.

    Returns
    -------
    angles : dict of str to array of shape (frame,)
        As `posture.segment_turns` takes them.
    pelvis : array of shape (frame, 3)

    """
    waves = basis(strides.phase, PELVIS_HARMONICS)
    angles = {name: waves @ curve for name, curve in trunk_curves(person, pace.effort).items()}
    pelvis = waves @ cycle.pelvis.T
    pelvis += strides.body_longer[:, None] * (waves @ cycle.pelvis_longer.T)
    pelvis[:, :2] += strides.wander
    angles |= _legs(person, body, pace, cycle, strides, angles, pelvis)
    for name in SIDES:
        angles |= _arm(person, name, strides, cycle)
    moods = np.radians(strides.moods)
    angles["trunk_tilt"] = angles["trunk_tilt"] + 0.7 * moods[0]
    angles["trunk_obliquity"] = angles["trunk_obliquity"] + 0.5 * moods[1]
    angles["trunk_rotation"] = angles["trunk_rotation"] + 1.0 * moods[2]
    # The head keeps level and looks ahead: it follows the trunk by a part only.
    angles["head_tilt"] = np.radians(person["head_tilt_deg"]) + 1.0 * moods[3]
    angles["head_obliquity"] = 0.2 * angles["trunk_obliquity"]
    angles["head_rotation"] = 0.3 * angles["trunk_rotation"]
    return angles, pelvis


def _legs(
    person: Mapping[str, float], body: Body, pace: Pace, cycle: Cycle, strides: Strides,
    angles: Angles, pelvis: np.ndarray,
) -> Angles:  # fmt: skip
    legs = {}
    yaw = np.radians(person["foot_progression_deg"])
    turns = trunk_turns(angles, "pelvis")
    for leg, (name, side) in enumerate(SIDES.items()):
        waves = basis(strides.phase - cycle.onsets[leg], LEG_HARMONICS)
        thigh, knee, pitch = cycle.legs[leg] @ waves.T + strides.longer[leg] * (
            cycle.legs_longer[leg] @ waves.T
        )
        down = body.thigh * np.cos(thigh) + body.shank * np.cos(thigh - knee)
        hip_y = pelvis[:, 1] + turned(body.hip * [1, side, 1], turns)[:, 1]
        foot_y = ankle_to_the_side(side, pace, body, yaw, pitch) + strides.placed[leg]
        legs |= {
            f"{name}_thigh": thigh,
            f"{name}_knee_flexion": knee,
            f"{name}_foot_pitch": pitch,
            f"{name}_foot_yaw": np.full(len(thigh), yaw),
            f"{name}_splay": np.arcsin((foot_y - hip_y) / down),
        }
    return legs


def _arm(person: Mapping[str, float], name: str, strides: Strides, cycle: Cycle) -> Angles:
    left = name == "left"
    own = strides.phase - cycle.onsets[0 if left else 1]
    uneven = 1 + SIDES[name] * person["arm_asymmetry"] / 2
    share = uneven * (1 + 0.08 * strides.moods[4 if left else 5])
    curves = {}
    for part, lag in (("arm_swing", 0.0), ("elbow_swing", person["elbow_lag"])):
        series = later(CURVES_DEG[part], person["arm_lag"] + lag)
        curves[part] = basis(own, len(series) // 2) @ series * share
    swing, elbow = curves["arm_swing"], curves["elbow_swing"]
    bent = person["elbow_mean_deg"] + person["elbow_swing_deg"] * elbow
    out = person["arm_out_deg"] + person["arm_out_swing_deg"] * swing
    bent = bent + strides.moods[6 if left else 7]
    return {
        f"{name}_shoulder_flexion": np.radians(
            person["arm_mean_deg"] + person["arm_swing_deg"] * swing
        ),
        f"{name}_shoulder_abduction": np.radians(out),
        f"{name}_shoulder_rotation": np.full(
            len(own), np.radians(person["arm_in_rotation_deg"])
        ),
        f"{name}_elbow_flexion": np.radians(np.maximum(bent, 3.0)),
    }
