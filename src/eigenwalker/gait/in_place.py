"""A capture of walking as steady strides in place, facing +x."""

from __future__ import annotations

import numpy as np
import xarray as xr
from scipy.spatial.transform import Rotation

from eigenwalker.core.blas_threads import one_blas_thread
from eigenwalker.core.fourier import fit_basis
from eigenwalker.core.kinematics import rotate_z
from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.trajectories import check_trajectories, sampling_rate
from eigenwalker.gait.body_points import find_origin
from eigenwalker.gait.drift import mean_velocity, slow_drift
from eigenwalker.gait.filtering import low_passed
from eigenwalker.gait.gaps import MAX_GAP_S, fill_short_gaps
from eigenwalker.gait.heading import find_heading
from eigenwalker.gait.steady_strides import SteadyStrides, body_relative, find_steady_strides
from eigenwalker.gait.straight_passes import find_straight_pass
from eigenwalker.markers.label_repair import repair_labels

_WHOLE = 0.05
"""Strides that may lack to the next whole number: frames are discrete, frequencies estimates."""

_MAX_ROUNDS = 10

_TRAVELS_MM = 500.0
"""Distance that the middle of all markers travels before a marker at rest is part of the room."""

_STAYS_SHARE = 0.01
"""Share of that distance within which a marker is at rest."""


def in_place(
    trajectories: xr.DataArray,
    *,
    max_gap_s: float = MAX_GAP_S,
    low_pass_hz: float | None = None,
    speed_mm_s: float | None = None,
    heading_deg: float | None = None,
    repair: bool = True,
) -> xr.DataArray:
    """Return the steady strides of a capture as a walk in place, facing +x.

    1. Points of the room, such as the origin of a skeleton, are left out, labels are repaired
       (`repair_labels`) and short gaps filled by cubic splines.
    2. Standing, starting, stopping and turning are left out, and the rest is trimmed to whole
       strides, to the nearest frame. Of a walk there and back the straight pass with most strides
       is taken. A walk with too few straight strides, in a circle or a figure of eight, is unwound:
       each frame is turned back by the slow heading of the body.
    3. Forward progress and slow drift of the body are taken out together, by one regression with
       the harmonics of the stride, which do not change.
    4. The direction of walking is turned to +x. The pelvis (else the middle of the hips, else of
       all markers) is at x = y = 0 in the mean, and z = 0 is the floor: 0.084 of the length of
       thigh and shank below the lowest standing ankle, or, without legs, at the lowest marker.

    Nothing is read from the attributes of the capture.

    Parameters
    ----------
    trajectories : DataArray of shape (time, marker, axis)
        A walk through a room or on a treadmill, in millimetres; any markers. With the usual names
        of joints, facing and standing feet are known, otherwise only the path.
    max_gap_s : float
        Longest gap to be filled, in seconds.
    low_pass_hz : float, optional
        Cut-off in hertz of a low-pass filter for noisy captures; 6 is usual for walking.
    speed_mm_s, heading_deg : float, optional
        Speed in mm/s, and direction in degrees from +x towards +y, of a walk on a treadmill or in
        place, if known; otherwise those of the standing feet. A walk through a room has its own.
    repair : bool
        Whether to repair labels; False for a capture whose labels are repaired already.

    Returns
    -------
    DataArray of shape (time, marker, axis)
        In millimetres, on the clock of the capture; a coordinate ``rotation`` is turned too. The
        coordinate ``speed_mm_s`` is the forward speed, NaN if unknown, which later steps use. The
        ``attrs`` record, beside those of the capture, this speed,
        ``treadmill``, ``heading_deg`` (direction of walking in the capture, from +x towards +y),
        ``feet_deg`` (direction of the standing feet beside it), ``steady_start_s``,
        ``steady_end_s``, ``n_strides``, ``frequency_hz``, ``straight_passes`` (from which the
        strides were chosen: 1 without turns, 0 if unwound), ``unwound_deg`` (range of the heading
        that was taken out), ``climb_mm`` (rise of the body), ``wander_mm`` (root mean square
        distance of its path from a straight line at constant speed), ``filled_samples``,
        ``repairs``, ``still_points`` (of the room) and ``low_pass_hz``.

    Raises
    ------
    ValueError
        If there is less than about a stride, or a gap between the strides is too long to be filled;
        the marker and the times are named.

    See Also
    --------
    eigenwalker.study.process_capture : all steps from a file to a walker.

    References
    ----------
    Troje (2002), methods: walkers on a treadmill, ten strides each.

    Examples
    --------
    Someone whose feet swing about a body that moves along +y at 1.2 m/s:

    >>> time = np.arange(0, 4, 0.01)
    >>> swing = 300 * np.sin(2 * np.pi * 0.9 * time)
    >>> forward = np.stack([swing, -swing, 0 * time], axis=1) + 1200 * time[:, None]
    >>> positions = np.stack([0 * forward, forward, 0 * forward], axis=2)
    >>> capture = ew.label_trajectories(positions, markers=["a", "b", "c"], rate_hz=100)
    >>> walk = in_place(capture)
    >>> round(walk.attrs["speed_mm_s"]), round(walk.attrs["heading_deg"]), walk.attrs["n_strides"]
    (1200, 90, 3)
    """
    walk = _without_still_points(check_trajectories(trajectories))
    rate_hz = sampling_rate(walk)
    if repair:
        walk = repair_labels(walk)
    _refuse_unseen(walk)
    positions, gaps = fill_short_gaps(walk.values, rate_hz, max_gap_s)
    if low_pass_hz is not None:
        positions = low_passed(positions, rate_hz, low_pass_hz)
    names = walk.marker.values.tolist()
    with one_blas_thread():  # on a busy machine 20 times faster
        straight = find_straight_pass(walk, positions, gaps, rate_hz)
        strides = _whole_strides(straight.positions, straight.strides, rate_hz)
        frames = slice(strides.start, strides.stop)
        moving, frequency_hz = straight.positions[frames], strides.frequency_hz
        placed, facts = _placed(moving, names, frequency_hz, rate_hz, speed_mm_s, heading_deg)
    result = walk.isel(time=frames).copy(data=placed)
    heading = straight.heading[frames]
    if "rotation" in result.coords:
        turns = straight.heading[0] - heading - np.deg2rad(facts["heading_deg"])
        result = result.assign_coords(rotation=_turned(result.rotation, turns))
    facts |= {
        "steady_start_s": float(result.time[0]),
        "steady_end_s": float(result.time[-1]),
        "n_strides": round(strides.count(rate_hz)),
        "frequency_hz": frequency_hz,
        "straight_passes": straight.n_passes,
        "unwound_deg": float(np.ptp(np.rad2deg(heading))),
        "filled_samples": int(np.isnan(walk.values[frames]).any(axis=2).sum()),
    }
    if low_pass_hz is not None:
        facts["low_pass_hz"] = float(low_pass_hz)
    return result.assign_coords(speed_mm_s=facts["speed_mm_s"]).assign_attrs(facts)


def _without_still_points(walk: xr.DataArray) -> xr.DataArray:
    """Return a capture without points, other than joints, that stay in the room."""
    if walk.sizes["time"] < 2 or walk.sizes["marker"] < 2:
        return walk
    low, high = (np.where(np.isnan(walk), edge, walk).T for edge in (np.inf, -np.inf))
    extent = (high.max(axis=2) - low.min(axis=2)).max(axis=0)
    seen = ~np.isnan(walk.values).any(axis=(0, 2))
    body = walk.values[:, seen].mean(axis=1) if seen.any() else np.zeros((1, 3))
    travelled = float(np.ptp(body, axis=0).max())
    still = (extent >= 0) & (extent < _STAYS_SHARE * travelled)
    still &= ~np.isin(walk.marker, JOINTS.markers)
    if not travelled > _TRAVELS_MM or not still.any():
        return walk
    return walk.isel(marker=~still).assign_attrs(still_points=walk.marker.values[still].tolist())


def _refuse_unseen(walk: xr.DataArray) -> None:
    unseen = np.isnan(walk.values).any(axis=2).all(axis=0)
    if unseen.any():
        raise ValueError(
            f"The markers {walk.marker.values[unseen].tolist()} were never seen; leave them out, "
            "for instance with trajectories.drop_sel(marker=[...])."
        )


def _whole_strides(positions: np.ndarray, strides: SteadyStrides, rate_hz: float) -> SteadyStrides:
    """Return the middle of steady strides that is a whole number of them.

    Without what was cut, other frames may be steady and strides have another length: repeated
    until nothing changes.
    """
    for _ in range(_MAX_ROUNDS):
        n_strides = max(1, int(strides.count(rate_hz) + _WHOLE))
        n_frames = min(
            round(n_strides * rate_hz / strides.frequency_hz), strides.stop - strides.start
        )
        start = strides.start + (strides.stop - strides.start - n_frames) // 2
        if n_strides < 2:  # too few to measure the frequency again
            return strides._replace(start=start, stop=start + n_frames)
        trimmed = find_steady_strides(body_relative(positions[start : start + n_frames]), rate_hz)
        trimmed = trimmed._replace(start=start + trimmed.start, stop=start + trimmed.stop)
        if trimmed == strides:
            break
        strides = trimmed
    return strides


def _placed(
    positions: np.ndarray,
    markers: list[str],
    frequency_hz: float,
    rate_hz: float,
    speed_mm_s: float | None,
    heading_deg: float | None,
) -> tuple[np.ndarray, dict[str, float | bool]]:
    """Return whole strides without progress and drift, facing +x, about the origin, and facts."""
    cycles = np.arange(len(positions)) * frequency_hz / rate_hz
    path = positions.mean(axis=1)
    drift = slow_drift(path, cycles)
    per_stride = mean_velocity(path, cycles)
    still = positions - drift[:, None]
    heading = find_heading(still, markers, per_stride[:2] * frequency_hz, frequency_hz, rate_hz)
    angle, speed = heading.angle, heading.speed_mm_s
    if heading.treadmill:
        angle = angle if heading_deg is None else np.deg2rad(heading_deg)
        speed = speed if speed_mm_s is None else speed_mm_s
    still = rotate_z(still, -angle)
    still -= find_origin(still, markers)
    facts = {
        "speed_mm_s": float(speed),
        "heading_deg": _degrees(angle),
        "feet_deg": _degrees(heading.feet_angle - angle),
        "treadmill": heading.treadmill,
        "climb_mm": float(per_stride[2] * cycles[-1]),
        "wander_mm": _wander(drift[:, :2], cycles),
    }
    return still, facts


def _wander(drift: np.ndarray, cycles: np.ndarray) -> float:
    """Return the root mean square distance from a straight line walked at constant speed."""
    line = np.column_stack([np.ones(len(cycles)), cycles])
    aside = drift - line @ fit_basis(line, drift)
    return float(np.sqrt(np.einsum("ta,ta->t", aside, aside).mean()))


def _turned(rotation: xr.DataArray, angles: np.ndarray) -> xr.DataArray:
    """Return rotation vectors of shape (time, marker, axis), each frame turned about z."""
    vectors = rotation.values.reshape(-1, 3)
    turns = np.repeat(angles, rotation.shape[1])
    seen = ~np.isnan(vectors).any(axis=1)
    turned = np.full(vectors.shape, np.nan)
    about_z = Rotation.from_euler("z", turns[seen, None])
    turned[seen] = (about_z * Rotation.from_rotvec(vectors[seen])).as_rotvec()
    return rotation.copy(data=turned.reshape(rotation.shape))


def _degrees(angle: float) -> float:
    """Return an angle in degrees from -180 to 180."""
    return float(np.rad2deg(np.arctan2(np.sin(angle), np.cos(angle))))
