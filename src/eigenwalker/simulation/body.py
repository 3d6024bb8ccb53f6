"""The body of a simulated person: segment lengths, and feet that roll over heel, ball and toes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

TOE_BEND = np.radians(28)
"""How far toes bend up before the ball leaves the ground."""


@dataclass(frozen=True)
class Body:
    """Segment lengths in millimetres, and places of joints seen from the centre of the pelvis.

    About that point pelvis and trunk turn, so its distance to all their joints stays the same.
    """

    height: float
    thigh: float
    shank: float
    foot: Foot
    hip: np.ndarray
    shoulder: np.ndarray
    sternum: np.ndarray
    neck: np.ndarray
    head: np.ndarray
    upper_arm: float
    forearm: float

    @property
    def leg(self) -> float:
        """Length of the leg from hip to sole."""
        return self.thigh + self.shank + self.foot.height


@dataclass(frozen=True)
class Foot:
    """Distances of heel, ball and toes from the ankle, on level ground, in millimetres.

    Its methods are in the plane of the foot: first coordinate forward, second up. Pitch is in
    radians, positive with the heel up.
    """

    heel: float
    ball: float
    toe: float
    height: float

    def ankle_over_print(self, pitch: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the ankle of a planted foot from the print of its ball, and the slope by pitch.

        The sole rolls about heel, ball, then tip of the toes. Arrays of shape (frame, 2).
        """
        heel, heel_slope = _rotated(pitch, self.heel, self.height)
        ball, ball_slope = _rotated(pitch, -self.ball, self.height)
        toes, toes_slope = _rotated(np.maximum(pitch - TOE_BEND, 0.0), self.toe, 0.0)
        on_heel, on_toes = (pitch < 0)[:, None], (pitch > TOE_BEND)[:, None]
        heel = np.add(heel, [-self.heel - self.ball, 0.0])
        place = np.where(on_heel, heel, ball - toes + np.array([self.toe, 0.0]))
        return place, np.where(on_heel, heel_slope, ball_slope - on_toes * toes_slope)

    def ankle_over_ball(self, pitch: np.ndarray) -> np.ndarray:
        """Return how far the ankle is ahead of the ball: array of shape (frame,)."""
        return self.height * np.sin(pitch) - self.ball * np.cos(pitch)

    def sole_under_ankle(self, pitch: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return heel, ball and tip of the toes from the ankle, and their slopes by pitch.

        Arrays of shape (frame, 3, 2).
        """
        heel, heel_slope = _rotated(pitch, -self.heel, -self.height)
        ball, ball_slope = _rotated(pitch, self.ball, -self.height)
        toes, toes_slope = _rotated(pitch - np.clip(pitch, 0.0, TOE_BEND), self.toe, 0.0)
        rigid = ((pitch <= 0) | (pitch >= TOE_BEND))[:, None]
        return (
            np.stack([heel, ball, ball + toes], axis=1),
            np.stack([heel_slope, ball_slope, ball_slope + rigid * toes_slope], axis=1),
        )


def _rotated(pitch: np.ndarray, forward: float, up: float) -> tuple[np.ndarray, np.ndarray]:
    """Return a point of the foot from the ankle, and its derivative by pitch."""
    cos, sin = np.cos(pitch), np.sin(pitch)
    ahead, above = forward * cos + up * sin, up * cos - forward * sin
    return np.stack([ahead, above], axis=1), np.stack([above, -ahead], axis=1)


def body_of(person: Mapping[str, float]) -> Body:
    """Return the body that a person's parameters describe.

    Shares of height are those of ANSUR II (see `PARAMETERS`). The hips lie where Harrington et al.
    (2007, J Biomech 40:595) find them in a pelvis 240 mm wide and 150 mm deep, seen from its
    centre. From memory, without a source: the sternum point, in the upper chest midway between
    clavicles and back, lies 0.008 of height above the shoulders, the ankle 0.042 ahead of the
    heel's contact.
    """
    height = person["height_mm"]

    def share(segment: str) -> float:
        return height * person[f"{segment}_share"]

    pelvis = share("thigh") + share("shank") + share("ankle") + 0.049 * height
    neck = 0.045 * height + share("trunk") - pelvis
    return Body(
        height=height,
        thigh=share("thigh"),
        shank=share("shank"),
        foot=Foot(
            heel=0.042 * height,
            ball=0.745 * share("foot") - 0.050 * height,
            toe=0.24 * share("foot"),
            height=share("ankle"),
        ),
        hip=np.array([0.017 * height, share("hip") / 2, -0.049 * height]),
        shoulder=np.array([0.0, share("shoulder") / 2, share("trunk") - pelvis]),
        sternum=np.array([-0.004 * height, 0.0, 0.008 * height + share("trunk") - pelvis]),
        neck=np.array([-0.015 * height, 0.0, neck]),
        head=np.array([0.035 * height, 0.0, share("head") - pelvis - neck]),
        upper_arm=share("upper_arm"),
        forearm=share("forearm"),
    )
