"""How a person gets along: speed, and how far the pelvis moves at that speed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from eigenwalker.simulation.norms import FREE_SPEED
from eigenwalker.simulation.segment_lengths import GRAVITY, Body


@dataclass(frozen=True)
class Pace:
    """How a person gets along: millimetres, seconds, shares of a stride.

    `effort` is the dimensionless speed at which the people of the norm make steps as long.
    """

    stride: float
    frequency: float
    effort: float
    stance: float
    step_width: float
    vertical_range: float
    lateral_range: float

    @property
    def speed(self) -> float:
        """Forward speed in mm/s."""
        return self.stride * self.frequency


def pace_of(person: Mapping[str, float], body: Body) -> Pace:
    """Return a person's pace: speed from stride and cadence, pelvis movement from speed.

    The vertical range grows from 27 mm at 0.7 m/s to 48 mm at 1.6, the lateral one shrinks from
    70 to 39 mm (Orendurff et al. 2004).
    """
    stride = person["stride_share"] * body.height
    speed = stride * person["frequency_hz"]
    faster = (speed / 1000 - 0.7) / 0.9
    # Schwartz et al. (2008): steps of 0.64, 0.76, 0.85 leg lengths at 0.29, 0.43, 0.56.
    effort = FREE_SPEED + (stride / 2 / body.leg - 0.76) / 0.78
    dimensionless = speed / np.sqrt(GRAVITY * body.leg)
    return Pace(
        stride=stride,
        frequency=person["frequency_hz"],
        effort=effort,
        stance=person["stance_share"] - 0.1 * (dimensionless - 0.38),
        step_width=max(person["step_width_mm"], 45.0),
        vertical_range=max(27 + 21 * faster + person["vertical_mm"], 12.0),
        lateral_range=max(70 - 31 * faster + person["lateral_mm"], 10.0),
    )
