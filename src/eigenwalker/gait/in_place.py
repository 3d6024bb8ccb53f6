"""A capture of walking as a steady walk in place, facing +x."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy.spatial.transform import Rotation

from eigenwalker.core.blas_threads import one_blas_thread
from eigenwalker.core.fourier import fit_basis
from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.trajectories import check_trajectories, sampling_rate
from eigenwalker.gait.drift import mean_velocity, slow_drift
from eigenwalker.gait.filtering import low_passed
from eigenwalker.gait.floor_origin import find_origin
from eigenwalker.gait.gaps import MAX_GAP_S, Gap, fill_short_gaps
from eigenwalker.gait.heading import find_heading
from eigenwalker.gait.steady_strides import SteadyPart, body_relative, steady_part
from eigenwalker.gait.straight_passes import Passage, find_passage
from eigenwalker.markers.label_repair import mend
from eigenwalker.markers.marker_sets import side_pairs

_WHOLE = 0.05
"""Strides that may lack to the next whole number: frames are discrete, frequencies estimates."""

_MAX_ROUNDS = 10

_TRAVELS_MM = 500.0
"""Way that the middle of all markers must go before one that stays is none of the body."""

_STAYS_SHARE = 0.01
"""Share of that way within which a marker stays where it is."""


def in_place(
    walk: xr.DataArray, *, max_gap_s: float = MAX_GAP_S, low_pass_hz: float | None = None
) -> xr.DataArray:
    """Return the steady strides of a capture as a walk in place, facing +x.

    Points that stay where they are while the others go through the room, such as the origin of a
    skeleton, are left out. Left and right markers that change places are put right, and samples
    that are elsewhere for moments are taken out (`mend`). Short gaps are filled by cubic splines.
    Standing, starting, stopping and turning are left out, and what is kept is trimmed to a whole
    number of strides, to the nearest frame. Of a walk there and back the straight pass with most
    strides is taken; a walk with too few straight strides, round in a circle or in a figure of
    eight, is unwound: each frame is seen from the body, whose slow heading is taken out.

    The direction of walking is turned to +x. Forward progress and slow
    drift of the body are taken out together, by regression beside the harmonics of the stride,
    which they therefore do not touch. The pelvis (else the middle of the hips, else of all markers)
    is at x = y = 0 in the mean, and z = 0 is the floor: where the lowest standing ankle is as high
    above it as ankles are for such legs (0.084 of thigh and shank), or, where legs are not known,
    the level of the lowest marker.

    Parameters
    ----------
    walk : DataArray of shape (time, marker, axis)
        Trajectories of someone who walks, in a room or on a treadmill; any markers. With the
        joints' usual names, facing and standing feet are known, otherwise only the way travelled.
    max_gap_s : float
        Longest gap to be filled, in seconds.
    low_pass_hz : float, optional
        Cut-off of a low-pass filter (`low_passed`), for noisy captures; 6 Hz is usual for walking.
        Left out, nothing is filtered.

    Returns
    -------
    DataArray of shape (time, marker, axis)
        In millimetres, on the clock of the capture. A coordinate ``rotation`` is turned too.
        ``attrs`` tell ``speed_mm_s`` (NaN if it cannot be known; what the attributes of a walk in
        place already state is kept), ``heading_deg`` (direction of walking in the capture, from
        +x towards +y), ``feet_deg`` (the direction that standing feet alone would tell, beside it),
        ``straight_passes`` (from how many the strides were chosen; 1 without turns, 0 if unwound),
        ``unwound_deg`` (how far the heading changed that was taken out),
        ``treadmill``, ``steady_start_s``, ``steady_end_s``, ``n_strides``, ``frequency_hz``,
        ``climb_mm`` (how far the body rose), ``wander_mm`` (how far it was, on the whole, from a
        straight line at constant speed), ``filled_samples``, and ``low_pass_hz`` where a filter
        was asked for, and ``still_points``, names of points of the room, where there were some.

    Raises
    ------
    ValueError
        If there is less than about a stride, or a gap in the midst of it is too long to be filled;
        the marker and the times are named.

    Examples
    --------
    Someone whose feet swing about a body that goes along +y at 1.2 m/s:

    >>> time = np.arange(0, 4, 0.01)
    >>> swing = 300 * np.sin(2 * np.pi * 0.9 * time)
    >>> forward = np.stack([swing, -swing, 0 * time], axis=1) + 1200 * time[:, None]
    >>> positions = np.stack([0 * forward, forward, 0 * forward], axis=2)
    >>> capture = ew.label_trajectories(positions, markers=["a", "b", "c"], rate_hz=100)
    >>> walk = in_place(capture)
    >>> round(walk.attrs["speed_mm_s"]), round(walk.attrs["heading_deg"]), walk.attrs["n_strides"]
    (1200, 90, 3)

    """
    walk = _of_the_body(check_trajectories(walk))
    rate_hz = sampling_rate(walk)
    walk = mend(walk, side_pairs(walk.marker.values.tolist()), rate_hz)
    positions, gaps = fill_short_gaps(walk.values, rate_hz, max_gap_s)
    _refuse_unseen(walk, gaps)
    filtered = {}
    if low_pass_hz is not None:
        positions = low_passed(positions, rate_hz, low_pass_hz)
        filtered = {"low_pass_hz": float(low_pass_hz)}
    names = walk.marker.values.tolist()
    with one_blas_thread():  # on a busy machine 20 times faster
        passage = find_passage(walk, positions, gaps, rate_hz)
        part = _whole_strides(passage.positions, passage.part, rate_hz)
        passage = passage._replace(part=part)
        kept = slice(part.start, part.stop)
        placed = _placed(
            passage.positions[kept], names, part.frequency_hz, rate_hz, walk.attrs.get("feet_deg")
        )
    result = walk.isel(time=kept).copy(data=placed.positions)
    if "rotation" in result.coords:
        turns = passage.heading[0] - passage.heading[kept] - placed.angle
        result = result.assign_coords(rotation=_turned(result.rotation, turns))
    filled = np.isnan(walk.values[kept]).any(axis=2).sum()
    return result.assign_attrs(
        _facts(walk, placed, passage, rate_hz) | filtered,
        filled_samples=int(filled) + int(walk.attrs.get("filled_samples", 0)),
    )


def _of_the_body(walk: xr.DataArray) -> xr.DataArray:
    """Return a capture without points that stay in the room while the others go through it.

    A joint that stays is none of these: something is wrong with it, which `assess` is to find.
    """
    if walk.sizes["time"] < 2 or walk.sizes["marker"] < 2:
        return walk
    low, high = (np.where(np.isnan(walk), edge, walk).T for edge in (np.inf, -np.inf))
    way = (high.max(axis=2) - low.min(axis=2)).max(axis=0)
    seen = ~np.isnan(walk.values).any(axis=(0, 2))
    body = walk.values[:, seen].mean(axis=1) if seen.any() else np.zeros((1, 3))
    travelled = float(np.ptp(body, axis=0).max())
    still = (way >= 0) & (way < _STAYS_SHARE * travelled) & ~np.isin(walk.marker, JOINTS.markers)
    if not travelled > _TRAVELS_MM or not still.any():
        return walk
    names = walk.marker.values[still].tolist()
    return walk.isel(marker=~still).assign_attrs(still_points=", ".join(names))


def _refuse_unseen(walk: xr.DataArray, gaps: list[Gap]) -> None:
    n_frames = walk.sizes["time"]
    unseen = [gap.marker for gap in gaps if gap.stop - gap.start == n_frames]
    if unseen:
        raise ValueError(
            f"The markers {walk.marker.values[unseen].tolist()} were never seen; leave them out, "
            "for instance with trajectories.drop_sel(marker=[...])."
        )


def _whole_strides(positions: np.ndarray, part: SteadyPart, rate_hz: float) -> SteadyPart:
    """Return the middle of a steady part that holds a whole number of its own strides.

    What is cut may change what is steady and how long a stride is: repeated until it holds.
    """
    for _ in range(_MAX_ROUNDS):
        n_strides = max(1, int(part.strides(rate_hz) + _WHOLE))
        n_frames = min(round(n_strides * rate_hz / part.frequency_hz), part.stop - part.start)
        start = part.start + (part.stop - part.start - n_frames) // 2
        if n_strides < 2:  # too little to measure a frequency anew
            return part._replace(start=start, stop=start + n_frames)
        found = steady_part(body_relative(positions[start : start + n_frames]), rate_hz)
        found = found._replace(start=start + found.start, stop=start + found.stop)
        if found == part:
            break
        part = found
    return part


class _Placed(NamedTuple):
    positions: np.ndarray
    angle: float
    feet_angle: float
    speed_mm_s: float
    treadmill: bool
    climb_mm: float
    wander_mm: float


def _placed(
    positions: np.ndarray,
    markers: list[str],
    frequency_hz: float,
    rate_hz: float,
    feet_deg: float | None,
) -> _Placed:
    """Return whole strides with progress and drift taken out, turned to +x, about the origin.

    A walk in place that was turned before knows by how much its feet then differed from its path.
    """
    cycles = np.arange(len(positions)) * frequency_hz / rate_hz
    path = positions.mean(axis=1)
    drift = slow_drift(path, cycles)
    way = mean_velocity(path, cycles)
    still = positions - drift[:, None]
    heading = find_heading(still, markers, way[:2] * frequency_hz, frequency_hz, rate_hz)
    angle = heading.angle
    if heading.treadmill and feet_deg is not None:
        angle -= np.deg2rad(feet_deg)
    still = still @ Rotation.from_euler("z", -angle).as_matrix().T
    still -= find_origin(still, markers)
    return _Placed(
        still,
        angle=angle,
        feet_angle=heading.feet_angle - angle,
        speed_mm_s=heading.speed_mm_s,
        treadmill=heading.treadmill,
        climb_mm=float(way[2] * cycles[-1]),
        wander_mm=_wander(drift[:, :2], cycles),
    )


def _wander(drift: np.ndarray, cycles: np.ndarray) -> float:
    """Return the root mean square of the way from a straight line walked at constant speed."""
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


def _facts(
    walk: xr.DataArray, placed: _Placed, passage: Passage, rate_hz: float
) -> dict[str, float | bool | int]:
    """Return what is known of the walk; what its attributes state of it in place stays."""
    time, part = walk.time.values, passage.part
    turned = np.ptp(np.rad2deg(passage.heading[part.start : part.stop]))
    before = walk.attrs if placed.treadmill else {}
    speed = before.get("speed_mm_s", np.nan)
    return {
        "speed_mm_s": float(speed if np.isfinite(speed) else placed.speed_mm_s),
        "heading_deg": _degrees(placed.angle + np.deg2rad(before.get("heading_deg", 0.0))),
        "feet_deg": _degrees(placed.feet_angle),
        "treadmill": bool(before.get("treadmill", placed.treadmill)),
        "steady_start_s": float(time[part.start]),
        "steady_end_s": float(time[part.stop - 1]),
        "n_strides": round(part.strides(rate_hz)),
        "frequency_hz": part.frequency_hz,
        "climb_mm": placed.climb_mm + float(before.get("climb_mm", 0.0)),
        "straight_passes": int(before.get("straight_passes", passage.straight_passes)),
        "unwound_deg": float(before.get("unwound_deg", turned)),
        "wander_mm": float(np.hypot(placed.wander_mm, before.get("wander_mm", 0.0))),
    }


def _degrees(angle: float) -> float:
    """Return an angle in degrees from -180 to 180."""
    return float(np.rad2deg(np.arctan2(np.sin(angle), np.cos(angle))))
