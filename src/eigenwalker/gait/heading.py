"""Which way a walker faces and walks, and how fast the ground moves under the feet."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

SIDES = ("left", "right")

STANCE_SHARE = 0.25
"""Share of the cycle in which an ankle is lowest: foot flat, when it hardly moves on the ground."""

LEAST_PROGRESS_MM = 150.0
"""Way a stride below which a walker whose feet are not known counts as walking in place: more than
the wander on a treadmill, less than the stride of a slow patient."""

_FORWARD_WITHIN = np.cos(np.deg2rad(60))


class Heading(NamedTuple):
    """Direction of the walk and its speed, both in the frame of the capture."""

    angle: float
    speed_mm_s: float
    treadmill: bool


def find_heading(
    positions: np.ndarray,
    markers: Sequence[str],
    way: np.ndarray,
    frequency_hz: float,
    rate_hz: float,
) -> Heading:
    """Return the direction of walking, the speed, and whether it was on a treadmill.

    Feet that stand on the ground tell how body and ground move against each other, in a room as on a
    belt; without ankles, the progress of the body does. Someone who walks backwards or sideways
    still faces +x: speed along it is then negative, or small.

    Parameters
    ----------
    positions : array of shape (time, marker, axis)
        Whole strides, progress taken out.
    markers : sequence of str
        Their names.
    way : array of shape (2,)
        Horizontal progress a stride that was taken out.
    frequency_hz : float
        Strides a second.
    rate_hz : float
        Frames a second.

    Returns
    -------
    Heading
        The angle in radians from +x towards +y.

    """
    progress = way[:2] * frequency_hz
    ground = ground_velocity(positions, markers, rate_hz)
    if ground is None:
        treadmill = bool(np.hypot(*way[:2]) < LEAST_PROGRESS_MM)
        walking = np.zeros(2) if treadmill else progress
    else:
        treadmill = bool(np.hypot(*progress) < 0.5 * np.hypot(*ground))
        walking = -ground
    facing = _facing(positions, markers)
    speed = float(np.hypot(*walking)) if treadmill else float(np.hypot(*progress))
    if treadmill and ground is None:
        speed = np.nan
    towards = walking
    if facing is not None:
        along = facing @ walking / max(float(np.hypot(*walking)), 1e-9)
        if along < _FORWARD_WITHIN:
            backwards = along < -_FORWARD_WITHIN
            towards = -walking if backwards else facing
            speed *= -1 if backwards else along
    return Heading(float(np.arctan2(towards[1], towards[0])), speed, treadmill)


def ground_velocity(
    positions: np.ndarray, markers: Sequence[str], rate_hz: float
) -> np.ndarray | None:
    """Return the horizontal velocity of the standing feet, in mm/s; None without both ankles.

    Each ankle's mean velocity while it is lowest. Seen from the ankle the ground seems some percent
    slower than it is, as the shank rolls forward over the foot.
    """
    names = list(markers)
    ankles = [f"{side}_ankle" for side in SIDES]
    if not set(ankles) <= set(names):
        return None
    velocities = []
    for ankle in ankles:
        path = positions[:, names.index(ankle)]
        velocity = np.gradient(path[:, :2], 1 / rate_hz, axis=0)
        low = path[:, 2] <= np.quantile(path[:, 2], STANCE_SHARE)
        velocities.append(velocity[low].mean(axis=0))
    return np.mean(velocities, axis=0)


def _facing(positions: np.ndarray, markers: Sequence[str]) -> np.ndarray | None:
    """Return the unit vector forward of the body on the whole, or None if names do not tell.

    Square to the lines through both hips and both shoulders. Knees bend forwards: if they
    do not, left and right have changed names.
    """
    place = {name: index for index, name in enumerate(markers)}
    posture = positions.mean(axis=0)[:, :2]
    pairs = [
        (place[f"left_{part}"], place[f"right_{part}"])
        for part in ("hip", "shoulder")
        if f"left_{part}" in place and f"right_{part}" in place
    ]
    if not pairs:
        return None
    to_left = np.sum([posture[left] - posture[right] for left, right in pairs], axis=0)
    facing = np.array([to_left[1], -to_left[0]]) / max(float(np.hypot(*to_left)), 1e-9)
    legs = [
        [place[f"{side}_{joint}"] for joint in ("hip", "knee", "ankle")]
        for side in SIDES
        if all(f"{side}_{joint}" in place for joint in ("hip", "knee", "ankle"))
    ]
    bend = sum(posture[knee] - (posture[hip] + posture[ankle]) / 2 for hip, knee, ankle in legs)
    return -facing if legs and facing @ bend < 0 else facing
