"""Transforms of the body: parts hidden, larger or smaller movements, planted cues."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from eigenwalker.stimulus.moving_dots import Moments, Moving, outward
from eigenwalker.stimulus.transform_context import Stage

SHOULDER_SWAY = {
    **dict.fromkeys(("head", "sternum"), 1.0),
    **{
        f"{side}_{joint}": 1.0
        for side in ("left", "right")
        for joint in ("shoulder", "elbow", "wrist")
    },
}
"""How far each dot goes along when the shoulders sway more."""
HIP_SWAY = {
    "pelvis": 1.0,
    **{f"{side}_hip": 1.0 for side in ("left", "right")},
    **{f"{side}_knee": 0.5 for side in ("left", "right")},
}
"""How far each dot goes along when the hips sway more; ankles stand."""
ARM = ("shoulder", "elbow", "wrist")
LEG = ("hip", "knee", "ankle")


def occlude(moving: Moving, stage: Stage, *, markers: Sequence[str]) -> Moving:
    """Hide dots; their motion stays as it is (Kozlowski and Cutting, 1977)."""
    hidden = np.array([dot in markers for dot in moving.dots])

    def at(time: np.ndarray) -> Moments:
        positions, visible = moving.at(time)
        return Moments(positions, visible & ~hidden)

    return replace(moving, at=at)


def gain(
    moving: Moving, stage: Stage, *, markers: Sequence[str], factor: float, axes: str
) -> Moving:
    """Make movements of joints larger or smaller.

    From the root outwards, the way from the joint that carries it is r(t) with the mean m over a
    period; for the named joints it becomes ``m + factor (r - m)`` on the named axes, and what they
    carry goes along. With elbows and wrists it is the arm swing of Kozlowski and Cutting (1977).
    Keeps the mean posture; bones do not keep their lengths exactly.
    """
    parents, order = moving.parents, outward(moving.parents)
    factors = np.array([factor if axis in axes else 1.0 for axis in "xyz"])
    named = [dot in markers for dot in moving.dots]
    mean = moving.mean

    def at(time: np.ndarray) -> Moments:
        positions, visible = moving.at(time)
        changed = np.array(positions)
        for dot in order:
            parent = parents[dot]
            carried = positions[:, parent] if parent >= 0 else 0.0
            new_carried = changed[:, parent] if parent >= 0 else 0.0
            way = positions[:, dot] - carried
            if named[dot]:
                usual = mean[dot] - (mean[parent] if parent >= 0 else 0.0)
                way = usual + factors * (way - usual)
            changed[:, dot] = new_carried + way
        return Moments(changed, visible)

    return replace(moving, at=at)


def conflict(
    moving: Moving,
    stage: Stage,
    *,
    shoulder_width: float,
    hip_width: float,
    shoulder_sway: float,
    hip_sway: float,
) -> Moving:
    """Set the widths of shoulders and hips against their sway from side to side.

    Mather and Murdoch (1994), who found sway to win. All four are factors. The mean distance to the
    left between both shoulders (hips) is multiplied by the width, half of the change on each side,
    and the arm (leg) goes along. The movement to the left of the middle between both shoulders
    (hips) about its mean is multiplied by the sway; head, sternum and arms (pelvis, and knees by
    half) go along. Keeps forward and vertical motion.
    """
    dots, mean = moving.dots, moving.mean

    def dot(name: str) -> int:
        return dots.index(name)

    wider = np.zeros(len(dots))
    for joint, chain, factor in (("shoulder", ARM, shoulder_width), ("hip", LEG, hip_width)):
        apart = mean[dot(f"left_{joint}"), 1] - mean[dot(f"right_{joint}"), 1]
        for side, sign in (("left", 0.5), ("right", -0.5)):
            for part in chain:
                if f"{side}_{part}" in dots:
                    wider[dot(f"{side}_{part}")] += sign * (factor - 1) * apart
    sways = [
        (dot("left_" + joint), dot("right_" + joint), factor - 1,
         np.array([along.get(name, 0.0) for name in dots]))
        for joint, factor, along in (
            ("shoulder", shoulder_sway, SHOULDER_SWAY), ("hip", hip_sway, HIP_SWAY)
        )
    ]  # fmt: skip

    def at(time: np.ndarray) -> Moments:
        positions, visible = moving.at(time)
        left = positions[..., 1] + wider
        for one, other, more, along in sways:
            middle = (positions[:, one, 1] + positions[:, other, 1]) / 2
            usual = (mean[one, 1] + mean[other, 1]) / 2
            left = left + (more * (middle - usual))[:, None] * along
        changed = np.stack([positions[..., 0], left, positions[..., 2]], axis=2)
        return Moments(changed, visible)

    return replace(moving, at=at)


def ellipses(
    moving: Moving,
    stage: Stage,
    *,
    shoulder_mm: Sequence[float],
    hip_mm: Sequence[float],
    phase_deg: float,
) -> Moving:
    """Let shoulders and hips go round ellipses, as in Cutting's synthetic walkers.

    Cutting (1978): men are given larger ellipses of the shoulders, women of the hips. About its
    mean place the left hip is at ``(a sin c, b cos c)`` forward and up, with
    ``c = 2 pi t / period + phase``; the right hip is half a cycle later, and each shoulder opposite
    to the hip of its side. The semi-axes a (forward) and b (up) are those given. What hung on the
    joint goes along: elbow and wrist, knee and ankle. Keeps motion to the side, and the limbs'
    motion against the joints they hang on.
    """
    dots, mean = moving.dots, moving.mean
    rings = []
    for side, half in (("left", 0.0), ("right", 180.0)):
        for chain, axes, turn in ((ARM, shoulder_mm, 180.0), (LEG, hip_mm, 0.0)):
            joint = dots.index(f"{side}_{chain[0]}")
            carried = [dots.index(f"{side}_{p}") for p in chain if f"{side}_{p}" in dots]
            rings.append((joint, carried, axes, np.deg2rad(phase_deg + half + turn)))

    def at(time: np.ndarray) -> Moments:
        positions, visible = moving.at(time)
        changed = np.array(positions)
        for joint, carried, (forward, up), ahead in rings:
            cycle = 2 * np.pi * time / moving.period_s + ahead
            x = mean[joint, 0] + forward * np.sin(cycle) - positions[:, joint, 0]
            z = mean[joint, 2] + up * np.cos(cycle) - positions[:, joint, 2]
            changed[:, carried] += np.stack([x, 0 * x, z], axis=1)[:, None]
        return Moments(changed, visible)

    return replace(moving, at=at)


def perturb(
    moving: Moving,
    stage: Stage,
    *,
    markers: Sequence[str],
    amount_mm: Sequence[float],
    frequency_hz: float,
    phase_deg: float,
    start_s: float,
    end_s: float,
) -> Moving:
    """Disturb single joints: from start to before end, ``amount sin(2 pi f (t - start) + phase)``.

    A frequency of 0 and a phase of 90 degrees push them aside by the amount. Keeps all other
    joints.
    """
    named = np.array([dot in markers for dot in moving.dots], dtype=float)
    amount = np.array(amount_mm)

    def at(time: np.ndarray) -> Moments:
        positions, visible = moving.at(time)
        wave = np.sin(2 * np.pi * frequency_hz * (time - start_s) + np.deg2rad(phase_deg))
        wave = np.where((time >= start_s) & (time < end_s), wave, 0.0)
        return Moments(positions + wave[:, None, None] * named[:, None] * amount, visible)

    return replace(moving, at=at)
