"""A person's cycle over time: joint angles and the path of the pelvis, frame by frame."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from eigenwalker.core.fourier import harmonic_basis
from eigenwalker.simulation.body import Body
from eigenwalker.simulation.cycle import Cycle
from eigenwalker.simulation.ground import ankle_to_the_side
from eigenwalker.simulation.posture import SIDES, rotated, trunk_rotations
from eigenwalker.simulation.prior_curves import (
    LEG_HARMONICS,
    PELVIS_HARMONICS,
    GaitParameters,
    trunk_curves,
)
from eigenwalker.simulation.stride_noise import Strides

Angles = dict[str, np.ndarray]
_LEAST_ELBOW_DEG = 5.0


def walk_cycle_frames(
    person: Mapping[str, float], body: Body, gait: GaitParameters, cycle: Cycle, strides: Strides
) -> tuple[Angles, np.ndarray]:
    """Return joint angles in radians, as `posture.segment_rotations` takes them, and the pelvis.

    Angles have the shape (frame,), the path of the pelvis point has (frame, 3), in millimetres.
    """
    waves = harmonic_basis(strides.phase, PELVIS_HARMONICS)
    angles = {name: waves @ curve for name, curve in trunk_curves(person, body, gait).items()}
    pelvis = waves @ cycle.pelvis.T
    pelvis += strides.body_lengthening[:, None] * (waves @ cycle.pelvis_slope.T)
    pelvis[:, :2] += strides.wander
    angles |= _legs(person, body, gait, cycle, strides, angles, pelvis)
    for name in SIDES:
        angles |= _arm(person, name, strides, cycle)
    angles |= _upright(person, strides, angles)
    return angles, pelvis


def _upright(person: Mapping[str, float], strides: Strides, angles: Angles) -> Angles:
    """Return trunk, which nods twice a stride, and head, which stays level and faces ahead."""

    def nod(part: str) -> np.ndarray:
        late = strides.phase - person[f"{part}_nod_lag"]
        return np.radians(person[f"{part}_nod_deg"]) * np.cos(4 * np.pi * late)

    noise = np.radians(strides.noise)
    lean = angles["trunk_obliquity"] + 0.5 * noise[1]
    turning = angles["trunk_rotation"] + noise[2]
    return {
        "trunk_tilt": angles["trunk_tilt"] + nod("trunk") + 0.7 * noise[0],
        "trunk_obliquity": lean,
        "trunk_rotation": turning,
        "head_tilt": np.radians(person["head_tilt_deg"]) - nod("head") + noise[3],
        "head_obliquity": 0.2 * lean,
        "head_rotation": 0.3 * turning,
    }


def _legs(
    person: Mapping[str, float], body: Body, gait: GaitParameters, cycle: Cycle, strides: Strides,
    angles: Angles, pelvis: np.ndarray,
) -> Angles:  # fmt: skip
    legs = {}
    yaw = np.radians(person["foot_progression_deg"])
    rotations = trunk_rotations(angles, "pelvis")
    for leg, (name, side) in enumerate(SIDES.items()):
        waves = harmonic_basis(strides.phase - cycle.onsets[leg], LEG_HARMONICS)
        thigh, knee, pitch = cycle.legs[leg] @ waves.T + strides.lengthening[leg] * (
            cycle.legs_slope[leg] @ waves.T
        )
        down = body.thigh * np.cos(thigh) + body.shank * np.cos(thigh - knee)
        hip_y = pelvis[:, 1] + rotated(body.hip * [1, side, 1], rotations)[:, 1]
        foot_y = ankle_to_the_side(side, gait, body, yaw, pitch) + strides.foot_shift[leg]
        legs |= {
            f"{name}_thigh": thigh,
            f"{name}_knee_flexion": knee,
            f"{name}_foot_pitch": pitch,
            f"{name}_foot_yaw": np.full(len(thigh), yaw),
            f"{name}_splay": np.arcsin((foot_y - hip_y) / down),
        }
    return legs


def _arm(person: Mapping[str, float], name: str, strides: Strides, cycle: Cycle) -> Angles:
    """Return an arm: furthest back at the heel strike of its side, it bends as it swings forward.

    Perry: an arc of about 30 degrees; Murray 1967: 24 back, 8 forward; elbow: a range of 29.7
    degrees in 15 adults (Clin Shoulder Elb 2023;26:126).
    """
    leg, side = list(SIDES).index(name), SIDES[name]
    own = strides.phase - cycle.onsets[leg] - person["arm_lag"]
    share = (1 + side * person["arm_asymmetry"] / 2) * (1 + 0.08 * strides.noise[4 + leg])
    swing = -share * np.cos(2 * np.pi * own)
    late = own - person["elbow_lag"]
    bend = -share * np.cos(2 * np.pi * late) + person["elbow_second_share"] * np.cos(
        4 * np.pi * (late - person["elbow_second_lag"])
    )

    def sided(parameter: str) -> float:
        return person[f"{parameter}_deg"] + side * person[f"{parameter}_asymmetry_deg"] / 2

    second = person["arm_second_deg"] * np.cos(4 * np.pi * own)
    bent = sided("elbow_mean") + person["elbow_swing_deg"] * bend + strides.noise[6 + leg]
    curves = {
        "shoulder_flexion": sided("arm_mean") + person["arm_swing_deg"] * swing + second,
        "shoulder_abduction": sided("arm_out") + person["arm_out_swing_deg"] * swing,
        "shoulder_rotation": np.full(len(own), person["arm_in_rotation_deg"]),
        "carrying_angle": np.full(len(own), person["carrying_angle_deg"]),
        "elbow_flexion": _LEAST_ELBOW_DEG + _softened(bent - _LEAST_ELBOW_DEG),
    }
    return {f"{name}_{joint}": np.radians(curve) for joint, curve in curves.items()}


def _softened(bend: np.ndarray) -> np.ndarray:
    """Return a bend kept above 0 without a kink: unchanged where large, flat below 5 degrees."""
    return 0.5 * (bend + np.sqrt(bend**2 + 5.0**2))
