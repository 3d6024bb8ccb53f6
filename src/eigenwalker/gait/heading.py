"""The direction in which a walker faces and walks, and the speed of the standing feet."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr

from eigenwalker.core.trajectories import check_trajectories, sampling_rate
from eigenwalker.core.walker import Walker, check_walkers
from eigenwalker.gait.body_points import (
    SIDES,
    facing_by_names,
    legs_of,
    paths_of,
    pelvis_path,
)

STANCE_SHARE = 0.35
"""Share of the cycle in which an ankle is lowest: foot flat, hardly moving on the ground."""

STANDING_BEYOND = 0.7
"""A low ankle stands while it moves with the ground at this share of the median speed or more;
before heel strike it is low as well, but slower."""

STRAIGHT_KNEE_MM = 15.0
"""Knees less far behind hips and ankles are straight; knees of walkers are 50 mm or more in
front."""

LEAST_LIFT_MM = 10.0
"""Lift of an ankle below which it is not known when it stands; feet that shuffle lift more."""

LEAST_PROGRESS_MM = 150.0
"""Progress a stride below which a walker whose feet are not known counts as walking in place: more
than the wander on a treadmill, less than the stride of a slow patient."""

N_MOMENTS = 200
"""Moments at which a walker is sampled."""

_FORWARD_WITHIN = np.cos(np.deg2rad(60))


class Heading(NamedTuple):
    """Direction of the walk and its speed, both in the frame of the capture.

    ``angle`` is measured from +x towards +y, in radians. ``feet_angle`` is the direction of the
    posture and the standing feet, which differs from that of the path by a degree or two.
    """

    angle: float
    feet_angle: float
    speed_mm_s: float
    treadmill: bool


def find_heading(
    positions: np.ndarray,
    markers: Sequence[str],
    progress: np.ndarray,
    frequency_hz: float,
    rate_hz: float,
) -> Heading:
    """Return the direction of walking, the speed, and whether it was on a treadmill.

    In a room both are those of the body's progress; on a treadmill, those of the feet that stand
    on the belt; where feet are not known, hips and shoulders show the direction. Someone who walks
    backwards or sideways still faces +x: the speed along it is then negative, or small.

    Positions (time, marker, axis) are whole strides without progress; `progress` is the horizontal
    velocity that was taken out, in mm/s.
    """
    facing = _facing(positions, markers)
    ground = ground_velocity(positions, markers, rate_hz)
    least = LEAST_PROGRESS_MM * frequency_hz if ground is None else 0.5 * _length(ground)
    treadmill = _length(progress) < least
    by_feet, feet_speed = _forwards(np.zeros(2) if ground is None else -ground, facing)
    if treadmill:
        direction, speed = by_feet, np.nan if ground is None else feet_speed
    else:
        direction, speed = _forwards(progress, facing)
    angle = _angle(direction)
    return Heading(angle, _angle(by_feet) if by_feet.any() else angle, speed, treadmill)


def _forwards(velocity: np.ndarray, facing: np.ndarray | None) -> tuple[np.ndarray, float]:
    """Return the direction of a velocity if the body faces along it, else of the body; speed."""
    speed = _length(velocity)
    if facing is None:
        return velocity, speed
    along = float(facing @ velocity)
    if along >= _FORWARD_WITHIN * speed and speed > 0:
        return velocity, speed
    if along <= -_FORWARD_WITHIN * speed and speed > 0:
        return -velocity, -speed
    return facing, along


def _length(vector: np.ndarray) -> float:
    return float(np.linalg.norm(vector))


def _angle(vector: np.ndarray) -> float:
    return float(np.arctan2(vector[1], vector[0]))


def ground_velocity(
    positions: np.ndarray, markers: Sequence[str], rate_hz: float
) -> np.ndarray | None:
    """Return the horizontal velocity of the low ankles, in mm/s; None without both ankles."""
    ankles = paths_of(positions, markers, [f"{side}_ankle" for side in SIDES])
    if ankles is None:
        return None
    return np.mean([_while_standing(path, rate_hz) for path in ankles.swapaxes(0, 1)], axis=0)


def _while_standing(path: np.ndarray, rate_hz: float) -> np.ndarray:
    velocity = np.gradient(path[:, :2], 1 / rate_hz, axis=0)
    low = path[:, 2] <= np.quantile(path[:, 2], STANCE_SHARE)
    mean = velocity[low].mean(axis=0)
    along = velocity[low] @ mean / max(_length(mean), 1e-9)
    standing = along >= STANDING_BEYOND * np.median(along)
    return velocity[low][standing].mean(axis=0)


def known_speed(walk: xr.DataArray) -> float:
    """Return the speed in mm/s that `in_place` took out of a walk; NaN where it is not known."""
    return float(walk.coords["speed_mm_s"]) if "speed_mm_s" in walk.coords else float("nan")


def goes_backwards(walk: xr.DataArray) -> bool:
    """Return whether a walk that faces +x goes backwards, in place or not.

    Its known speed tells, else its progress less the velocity of its standing feet.
    """
    speed = known_speed(walk)
    if not np.isfinite(speed):
        ankles = walk.reindex(marker=[f"{side}_ankle" for side in SIDES]).sel(axis="z").values
        lifted = np.ptp(ankles, axis=0).min() > LEAST_LIFT_MM  # else nothing tells when it stands
        pelvis = pelvis_path(walk.values, walk.marker.values.tolist())[:, 0]
        progress = (pelvis[-1] - pelvis[0]) / float(walk.time[-1] - walk.time[0])
        speed = stance_speed(walk) + progress if lifted else np.nan
    return bool(speed < 0)


def stance_speed(walk: xr.DataArray) -> float:
    """Return the speed of a walk in place, from the feet that stand on the ground.

    The belt moves backwards as fast as they do. An ankle rolls forward over its standing foot, so
    the result is some 4 % below the speed of the belt (2 to 5 % on simulated walks).

    Parameters
    ----------
    walk : DataArray of shape (time, marker, axis)
        A walk in place, facing +x, in millimetres, with the markers left_ankle and right_ankle.

    Returns
    -------
    float
        Millimetres a second along +x; NaN without both ankles.

    See Also
    --------
    ground_speed : the speed of a walker.

    Examples
    --------
    >>> walk = ew.simulate_walk(seed=1)
    >>> 0.95 < stance_speed(walk) / walk.attrs["speed_mm_s"] < 0.98
    np.True_
    """
    walk = check_trajectories(walk, complete=True)
    ground = ground_velocity(walk.values, walk.marker.values.tolist(), sampling_rate(walk))
    return float("nan") if ground is None else -float(ground[0])


def ground_speed(walker: Walker) -> float:
    """Return the forward speed of a walker: its own, or else that of its standing feet.

    Parameters
    ----------
    walker : Walker
        Its ``speed_mm_s`` is taken where it is known. Otherwise it is sampled at 200 moments evenly
        from 0 to 2 strides. Two harmonics keep standing feet less still: on simulated walkers the
        result is then 87 to 109 % of the true speed.

    Returns
    -------
    float
        Millimetres a second. NaN where the speed is not known and an ankle is missing.

    See Also
    --------
    stance_speed : the speed of a walk in place.

    Examples
    --------
    >>> walker = ew.load_population().walkers[0]
    >>> ground_speed(walker) == walker.speed_mm_s
    True
    """
    check_walkers([walker])
    if np.isfinite(walker.speed_mm_s):
        return walker.speed_mm_s
    return stance_speed(walker.trajectories(np.linspace(0, 2 * walker.period_s, N_MOMENTS)))


def sides_swapped(positions: np.ndarray, markers: Sequence[str]) -> bool:
    """Return whether knees bend backwards if the hips and shoulders called left are on the left."""
    facing, legs = _facing_by_names(positions, markers), legs_of(positions, markers)
    if facing is None or not legs:
        return False
    bends = [leg[:, 1] - (leg[:, 0] + leg[:, 2]) / 2 for leg in legs]
    return bool(facing @ np.mean(bends, axis=(0, 1))[:2] < -STRAIGHT_KNEE_MM)


def _facing(positions: np.ndarray, markers: Sequence[str]) -> np.ndarray | None:
    """Return the mean forward unit vector of the body, by its knees where sides are swapped."""
    facing = _facing_by_names(positions, markers)
    return -facing if facing is not None and sides_swapped(positions, markers) else facing


def _facing_by_names(positions: np.ndarray, markers: Sequence[str]) -> np.ndarray | None:
    facing = facing_by_names(positions, markers)
    if facing is None:
        return None
    mean = facing.mean()
    return np.array([mean.real, mean.imag]) / max(abs(mean), 1e-9)
