"""The body of a simulated person: lengths of its segments."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from eigenwalker.simulation.foot import Foot

GRAVITY = 9810.0
"""mm/s2."""


@dataclass(frozen=True)
class Body:
    """Segment lengths in millimetres, and places of joints in the frame of pelvis and trunk.

    The pelvis point, centre of the pelvis, lies above the middle between the hips; the trunk turns
    about it, so that its distance to all joints of pelvis and trunk stays the same.
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


def body_of(person: Mapping[str, float]) -> Body:
    """Return the body that a person's parameters describe.

    Shares of height are ANSUR's (see `traits.PARAMETERS`). The hips lie where Harrington et al.
    (2007, J Biomech 40:595) find them in a pelvis 240 mm wide and 150 mm deep, seen from its
    centre. Recalled, not looked up: the sternum point, in the upper chest amid clavicles and back,
    lies 0.008 of height above the shoulders, the ankle 0.042 ahead of the heel's contact.
    """
    height = person["height_mm"]

    def of(share: str) -> float:
        return height * person[share]

    legs = of("thigh_share") + of("shank_share") + of("ankle_share")
    pelvis = legs + 0.049 * height
    neck = 0.045 * height + of("trunk_share") - pelvis
    return Body(
        height=height,
        thigh=of("thigh_share"),
        shank=of("shank_share"),
        foot=Foot(
            heel=0.042 * height,
            ball=0.745 * of("foot_share") - 0.050 * height,
            toe=0.24 * of("foot_share"),
            height=of("ankle_share"),
        ),
        hip=np.array([0.017 * height, of("hip_share") / 2, -0.049 * height]),
        shoulder=np.array([0.0, of("shoulder_share") / 2, of("trunk_share") - pelvis]),
        sternum=np.array([-0.004 * height, 0.0, 0.008 * height + of("trunk_share") - pelvis]),
        neck=np.array([-0.015 * height, 0.0, neck]),
        head=np.array([0.035 * height, 0.0, of("head_share") - pelvis - neck]),
        upper_arm=of("upper_arm_share"),
        forearm=of("forearm_share"),
    )
