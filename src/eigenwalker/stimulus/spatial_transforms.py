"""Transforms of places: turned over, mirrored, turned, moved."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np
from pydantic import Field, field_validator

from eigenwalker.stimulus.moving_dots import Moments, MovingDots
from eigenwalker.stimulus.transform_types import Context, Degrees, Transform, Vector, problem


class Invert(Transform):
    """Turn the figure upside down: ``z`` becomes ``2 m - z``, m being the middle's height.

    Sumi (1984); Barclay, Cutting and Kozlowski (1978): the sexes swap. What walks to the right
    still does. For half a turn in the picture, rotate by 180 degrees about ``"sight"``.
    """

    name: Literal["invert"]

    def apply(self, moving: MovingDots, context: Context) -> MovingDots:
        double = 2 * moving.middle[2]
        return moving.moved(lambda positions, time: positions * [1, 1, -1] + [0, 0, double])


class Mirror(Transform):
    """Swap the sides: ``y`` becomes ``2 m - y``, and what was left is called right.

    Troje (2002) shows views of 30 and -30 degrees as one. Keeps forward and vertical motion.
    """

    name: Literal["mirror"]

    def apply(self, moving: MovingDots, context: Context) -> MovingDots:
        double, partner = 2 * moving.middle[1], list(moving.skeleton.mirror())

        def at(time: np.ndarray) -> Moments:
            positions, visible = moving.at(time)
            return Moments(positions[:, partner] * [1, -1, 1] + [0, double, 0], visible[:, partner])

        return replace(moving, at=at)


class Rotate(Transform):
    """Turn the figure about an axis through its middle, right-handed, standing or on and on.

    By ``angle + speed t``, about ``"x"`` (forward), ``"y"`` (left), ``"z"`` (up), ``"sight"``
    (towards the observer, as Pavlova and Sokolov, 2000, did), or a vector. Keeps all distances.
    """

    name: Literal["rotate"]
    axis: Literal["x", "y", "z", "sight"] | Vector = Field(
        "z", description="named axis, or a vector of 3 numbers"
    )
    angle_deg: Degrees = Field(0.0, description="by how much, right-handed")
    speed_deg_s: float = Field(
        0.0, strict=True, ge=-1e4, le=1e4, description="how fast it turns on"
    )

    @field_validator("axis")
    @classmethod
    def _has_length(cls, axis: str | tuple[float, ...]) -> str | tuple[float, ...]:
        if not isinstance(axis, str) and not any(axis):
            raise problem("an axis needs a length above 0")
        return axis

    def apply(self, moving: MovingDots, context: Context) -> MovingDots:
        named = {"sight": context.observer[2], **dict(zip("xyz", np.eye(3), strict=True))}
        axis = np.array(named[self.axis] if isinstance(self.axis, str) else self.axis)
        unit = axis / np.sqrt(np.sum(axis**2))
        middle = moving.middle

        def turned(positions: np.ndarray, time: np.ndarray) -> np.ndarray:
            angle = np.deg2rad(self.angle_deg + self.speed_deg_s * time)[:, None, None]
            arm = positions - middle
            along = (arm @ unit)[..., None] * unit
            cosine, sine = np.cos(angle), np.sin(angle)
            return arm * cosine + np.cross(unit, arm) * sine + along * (1 - cosine) + middle

        return moving.moved(turned)


class Resize(Transform):
    """Make the figure larger or smaller about the point of the floor below its middle.

    Keeps angles and timing.
    """

    name: Literal["resize"]
    factor: float = Field(strict=True, gt=0, le=100, description="how much larger")

    def apply(self, moving: MovingDots, context: Context) -> MovingDots:
        fixed = moving.middle * [1, 1, 0]
        return moving.moved(lambda positions, time: fixed + self.factor * (positions - fixed))


class Translate(Transform):
    """Move the figure: ``x + offset + velocity t``.

    With a velocity of (speed, 0, 0) it walks over ground; without this transform it walks on a
    treadmill, as the stimuli of Troje (2002) do. Keeps the motion of the dots against each other.
    """

    name: Literal["translate"]
    offset_mm: Vector = Field((0.0, 0.0, 0.0), description="forward, left, up")
    velocity_mm_s: Vector = Field((0.0, 0.0, 0.0), description="forward, left, up")

    def apply(self, moving: MovingDots, context: Context) -> MovingDots:
        offset, velocity = np.array(self.offset_mm), np.array(self.velocity_mm_s)
        return moving.moved(
            lambda positions, time: positions + offset + velocity * time[:, None, None]
        )
