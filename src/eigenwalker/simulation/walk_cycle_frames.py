"""A person's cycle played over time: joint angles and the path of the pelvis, frame by frame."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from eigenwalker.simulation.cadence import Pace
from eigenwalker.simulation.cycle import Cycle
from eigenwalker.simulation.ground import ankle_to_the_side
from eigenwalker.simulation.norms import basis
from eigenwalker.simulation.posture import SIDES, trunk_turns, turned
from eigenwalker.simulation.prior_curves import LEG_HARMONICS, PELVIS_HARMONICS, trunk_curves
from eigenwalker.simulation.segment_lengths import Body
from eigenwalker.simulation.stride_noise import Strides

Angles = dict[str, np.ndarray]
_LEAST_ELBOW_DEG = 5.0


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
    angles |= _upright(person, strides, angles)
    return angles, pelvis


def _upright(person: Mapping[str, float], strides: Strides, angles: Angles) -> Angles:
    """Trunk and head: the trunk nods twice a stride, the head keeps level and looks ahead."""

    def nod(part: str) -> np.ndarray:
        late = strides.phase - person[f"{part}_nod_lag"]
        return np.radians(person[f"{part}_nod_deg"]) * np.cos(4 * np.pi * late)

    moods = np.radians(strides.moods)
    lean = angles["trunk_obliquity"] + 0.5 * moods[1]
    turning = angles["trunk_rotation"] + moods[2]
    return {
        "trunk_tilt": angles["trunk_tilt"] + nod("trunk") + 0.7 * moods[0],
        "trunk_obliquity": lean,
        "trunk_rotation": turning,
        "head_tilt": np.radians(person["head_tilt_deg"]) - nod("head") + moods[3],
        "head_obliquity": 0.2 * lean,
        "head_rotation": 0.3 * turning,
    }


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
    """An arm is furthest back at the heel strike of its side, and bends as it swings forward.

    Perry: an arc of about 30 degrees; Murray 1967: 24 back, 8 forward; elbow: a range of 29.7
    degrees in 15 adults (Clin Shoulder Elb 2023;26:126).
    """
    leg, side = list(SIDES).index(name), SIDES[name]
    own = strides.phase - cycle.onsets[leg] - person["arm_lag"]
    share = (1 + side * person["arm_asymmetry"] / 2) * (1 + 0.08 * strides.moods[4 + leg])
    swing = -share * np.cos(2 * np.pi * own)
    late = own - person["elbow_lag"]
    bend = -share * np.cos(2 * np.pi * late) + person["elbow_second_share"] * np.cos(
        4 * np.pi * (late - person["elbow_second_lag"])
    )

    def sided(parameter: str) -> float:
        return person[f"{parameter}_deg"] + side * person[f"{parameter}_asymmetry_deg"] / 2

    second = person["arm_second_deg"] * np.cos(4 * np.pi * own)
    bent = sided("elbow_mean") + person["elbow_swing_deg"] * bend + strides.moods[6 + leg]
    curves = {
        "shoulder_flexion": sided("arm_mean") + person["arm_swing_deg"] * swing + second,
        "shoulder_abduction": sided("arm_out") + person["arm_out_swing_deg"] * swing,
        "shoulder_rotation": np.full(len(own), person["arm_in_rotation_deg"]),
        "elbow_flexion": _LEAST_ELBOW_DEG + _softened(bent - _LEAST_ELBOW_DEG),
    }
    return {f"{name}_{joint}": np.radians(curve) for joint, curve in curves.items()}


def _softened(bend: np.ndarray) -> np.ndarray:
    """Keep a bend above 0 without a kink: as it is where large, flattening out below 5 degrees."""
    return 0.5 * (bend + np.sqrt(bend**2 + 5.0**2))
