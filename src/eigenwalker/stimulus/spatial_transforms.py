"""Transforms of places: turned over, mirrored, turned, moved."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from eigenwalker.stimulus.moving_dots import Moments, Moving
from eigenwalker.stimulus.transform_context import Stage

NAMED_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


def invert(moving: Moving, stage: Stage) -> Moving:
    """Turn the figure upside down: ``z`` becomes ``2 m - z``, m being the middle's height.

    Sumi (1984); Barclay, Cutting and Kozlowski (1978), who found the sexes to swap. What walks to
    the right still does. For half a turn in the picture, rotate by 180 degrees about ``"sight"``.
    Keeps horizontal motion, and lengths; twice is nothing.
    """
    double = 2 * moving.middle[2]

    def at(time: np.ndarray) -> Moments:
        positions, visible = moving.at(time)
        return Moments(positions * [1, 1, -1] + [0, 0, double], visible)

    return replace(moving, at=at)


def mirror(moving: Moving, stage: Stage) -> Moving:
    """Swap the sides: ``y`` becomes ``2 m - y``, and what was left is called right.

    Troje (2002) shows views of 30 and -30 degrees as one (J33). Each dot of the left becomes the
    mirror image of its counterpart at the right. Keeps forward and vertical motion; twice is
    nothing.
    """
    double, partner = 2 * moving.middle[1], list(moving.skeleton.mirror())

    def at(time: np.ndarray) -> Moments:
        positions, visible = moving.at(time)
        return Moments(positions[:, partner] * [1, -1, 1] + [0, double, 0], visible[:, partner])

    return replace(moving, at=at)


def rotate(
    moving: Moving,
    stage: Stage,
    *,
    axis: str | Sequence[float],
    angle_deg: float,
    speed_deg_s: float,
) -> Moving:
    """Turn the figure about an axis through its middle, right-handed, standing or on and on.

    The turn at time t is by ``angle + speed t``, by Rodrigues' formula. The axis is ``"x"``
    (forward), ``"y"`` (left), ``"z"`` (up), ``"sight"`` (towards the observer: the picture
    turns, anticlockwise, as Pavlova and Sokolov, 2000, did), or a vector. Keeps all distances.
    """
    if axis == "sight":
        named: Sequence[float] = stage.observer[2].tolist()
    else:
        named = NAMED_AXES[axis] if isinstance(axis, str) else axis
    unit = np.array(named) / np.sqrt(np.sum(np.square(named)))
    middle = moving.middle

    def at(time: np.ndarray) -> Moments:
        positions, visible = moving.at(time)
        angle = np.deg2rad(angle_deg + speed_deg_s * time)[:, None, None]
        arm = positions - middle
        along = (arm @ unit)[..., None] * unit
        turned = (
            arm * np.cos(angle) + np.cross(unit, arm) * np.sin(angle) + along * (1 - np.cos(angle))
        )
        return Moments(turned + middle, visible)

    return replace(moving, at=at)


def resize(moving: Moving, stage: Stage, *, factor: float) -> Moving:
    """Make the figure larger or smaller about the point of the floor below its middle.

    Keeps angles and timing.
    """
    fixed = moving.middle * [1, 1, 0]

    def at(time: np.ndarray) -> Moments:
        positions, visible = moving.at(time)
        return Moments(fixed + factor * (positions - fixed), visible)

    return replace(moving, at=at)


def translate(
    moving: Moving, stage: Stage, *, offset_mm: Sequence[float], velocity_mm_s: Sequence[float]
) -> Moving:
    """Move the figure: ``x + offset + velocity t``.

    With a velocity of (speed, 0, 0) it walks over ground; without this transform it walks on a
    treadmill, as the stimuli of Troje (2002) do. Keeps the motion of the dots against each other.
    """
    offset, velocity = np.array(offset_mm), np.array(velocity_mm_s)

    def at(time: np.ndarray) -> Moments:
        positions, visible = moving.at(time)
        return Moments(positions + offset + velocity * time[:, None, None], visible)

    return replace(moving, at=at)
