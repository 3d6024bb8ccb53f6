"""Transforms of the body: parts hidden, larger or smaller movements, planted cues."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from eigenwalker.stimulus.moving_dots import Moments, MovingDots, parents_of
from eigenwalker.stimulus.transform_types import (
    Context,
    Degrees,
    Factor,
    Length,
    Markers,
    Millimetres,
    Seconds,
    Transform,
    Vector,
)

SemiAxes = Annotated[tuple[Millimetres, ...], Length(2, 2)]

ARM = ("shoulder", "elbow", "wrist")
LEG = ("hip", "knee", "ankle")


def _both(*parts: str) -> list[str]:
    return [f"{side}_{part}" for side in ("left", "right") for part in parts]


SHOULDER_SWAY = dict.fromkeys(["head", "sternum", *_both(*ARM)], 1.0)
"""How far each dot moves along when the shoulders sway more."""
HIP_SWAY = dict.fromkeys(["pelvis", *_both("hip")], 1.0) | dict.fromkeys(_both("knee"), 0.5)
"""How far each dot moves along when the hips sway more; ankles stand."""


class Occlude(Transform):
    """Hide dots; their motion stays as it is (Kozlowski and Cutting, 1977)."""

    name: Literal["occlude"]
    markers: Markers = Field(description="names of dots")

    def apply(self, moving: MovingDots, context: Context) -> MovingDots:
        hidden = np.array([dot in self.markers for dot in moving.dots])

        def at(time: np.ndarray) -> Moments:
            positions, visible = moving.at(time)
            return Moments(positions, visible & ~hidden)

        return replace(moving, at=at)


class Gain(Transform):
    """Make movements of joints larger or smaller.

    From the root outwards, each joint's position relative to the joint that carries it is scaled
    about its mean over a period; what it carries moves along. With elbows and wrists it is the arm
    swing of Kozlowski and Cutting (1977). Keeps the mean posture, and bone lengths nearly.
    """

    name: Literal["gain"]
    markers: Markers = Field(description="names of dots")
    factor: Factor = Field(description="how much larger the movement")
    axes: Literal["x", "y", "z", "xy", "xz", "yz", "xyz"] = Field("xyz", description="of it")

    def apply(self, moving: MovingDots, context: Context) -> MovingDots:
        parents = parents_of(moving.skeleton)
        factors = np.array([self.factor if axis in self.axes else 1.0 for axis in "xyz"])
        named = [dot in self.markers for dot in moving.dots]
        mean = moving.mean

        def changed(positions: np.ndarray, time: np.ndarray) -> np.ndarray:
            new = np.array(positions)
            for dot, parent in parents.items():
                carried = positions[:, parent] if parent >= 0 else 0.0
                new_carried = new[:, parent] if parent >= 0 else 0.0
                way = positions[:, dot] - carried
                if named[dot]:
                    usual = mean[dot] - (mean[parent] if parent >= 0 else 0.0)
                    way = usual + factors * (way - usual)
                new[:, dot] = new_carried + way
            return new

        return moving.moved(changed)


class Conflict(Transform):
    """Set the widths of shoulders and hips against their sway from side to side.

    All four are factors, of the mean distance between both shoulders (hips) and of the movement to
    the side of their middle; arms, head and trunk (legs) move along. Keeps forward and vertical
    motion. Mather and Murdoch (1994): sway decides.
    """

    name: Literal["conflict"]
    shoulder_width: Factor = Field(1.0, description="factor")
    hip_width: Factor = Field(1.0, description="factor")
    shoulder_sway: Factor = Field(1.0, description="factor")
    hip_sway: Factor = Field(1.0, description="factor")

    def apply(self, moving: MovingDots, context: Context) -> MovingDots:
        dots, mean = moving.dots, moving.mean

        def dot(name: str) -> int:
            return dots.index(name)

        wider = np.zeros(len(dots))
        widths = (("shoulder", ARM, self.shoulder_width), ("hip", LEG, self.hip_width))
        for joint, chain, factor in widths:
            apart = mean[dot(f"left_{joint}"), 1] - mean[dot(f"right_{joint}"), 1]
            for side, sign in (("left", 0.5), ("right", -0.5)):
                for part in chain:
                    if f"{side}_{part}" in dots:
                        wider[dot(f"{side}_{part}")] += sign * (factor - 1) * apart
        sways = [
            (dot("left_" + joint), dot("right_" + joint), factor - 1,
             np.array([along.get(name, 0.0) for name in dots]))
            for joint, factor, along in (
                ("shoulder", self.shoulder_sway, SHOULDER_SWAY), ("hip", self.hip_sway, HIP_SWAY)
            )
        ]  # fmt: skip

        def changed(positions: np.ndarray, time: np.ndarray) -> np.ndarray:
            left = positions[..., 1] + wider
            for one, other, more, along in sways:
                middle = (positions[:, one, 1] + positions[:, other, 1]) / 2
                usual = (mean[one, 1] + mean[other, 1]) / 2
                left = left + (more * (middle - usual))[:, None] * along
            return np.stack([positions[..., 0], left, positions[..., 2]], axis=2)

        return moving.moved(changed)


class Ellipses(Transform):
    """Let shoulders and hips go round ellipses, as in Cutting's synthetic walkers (1978).

    Men are given larger ellipses of the shoulders, women of the hips. The left hip is at ``(a sin
    c, b cos c)`` forward and up from its mean place, ``c = 2 pi t / period + phase``; the right hip
    is half a cycle later, each shoulder opposite to the hip of its side. Limbs move along with the
    joints that they hang on. Keeps motion to the side.
    """

    name: Literal["ellipses"]
    shoulder_mm: SemiAxes = Field(description="semi-axes forward and up")
    hip_mm: SemiAxes = Field(description="semi-axes forward and up")
    phase_deg: Degrees = Field(0.0, description="of the left hip at 0 s")

    def apply(self, moving: MovingDots, context: Context) -> MovingDots:
        dots, mean = moving.dots, moving.mean
        rings = []
        for side, half in (("left", 0.0), ("right", 180.0)):
            for chain, axes, turn in ((ARM, self.shoulder_mm, 180.0), (LEG, self.hip_mm, 0.0)):
                joint = dots.index(f"{side}_{chain[0]}")
                carried = [dots.index(f"{side}_{p}") for p in chain if f"{side}_{p}" in dots]
                rings.append((joint, carried, axes, np.deg2rad(self.phase_deg + half + turn)))

        def changed(positions: np.ndarray, time: np.ndarray) -> np.ndarray:
            new = np.array(positions)
            for joint, carried, (forward, up), ahead in rings:
                cycle = 2 * np.pi * time / moving.period_s + ahead
                x = mean[joint, 0] + forward * np.sin(cycle) - positions[:, joint, 0]
                z = mean[joint, 2] + up * np.cos(cycle) - positions[:, joint, 2]
                new[:, carried] += np.stack([x, 0 * x, z], axis=1)[:, None]
            return new

        return moving.moved(changed)


class Perturb(Transform):
    """Disturb single joints: from start to before end, ``amount sin(2 pi f (t - start) + phase)``.

    A frequency of 0 and a phase of 90 degrees push them aside by the amount. Keeps all other
    joints.
    """

    name: Literal["perturb"]
    markers: Markers = Field(description="names of dots")
    amount_mm: Vector = Field(description="forward, left, up")
    frequency_hz: float = Field(strict=True, ge=0, le=1000, description="of the sine")
    phase_deg: Degrees = Field(0.0, description="of the sine when it begins")
    start_s: Seconds = Field(0.0, description="when it begins")
    end_s: Seconds = Field(1e5, description="when it is over")

    def apply(self, moving: MovingDots, context: Context) -> MovingDots:
        named = np.array([dot in self.markers for dot in moving.dots], dtype=float)
        amount = np.array(self.amount_mm)

        def changed(positions: np.ndarray, time: np.ndarray) -> np.ndarray:
            cycle = 2 * np.pi * self.frequency_hz * (time - self.start_s)
            wave = np.sin(cycle + np.deg2rad(self.phase_deg))
            wave = np.where((time >= self.start_s) & (time < self.end_s), wave, 0.0)
            return positions + wave[:, None, None] * named[:, None] * amount

        return moving.moved(changed)
