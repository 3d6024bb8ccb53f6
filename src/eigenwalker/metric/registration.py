"""Registration: corresponding moments of two clips (Kovar & Gleicher 2003)."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
import xarray as xr

from eigenwalker.core.trajectories import sampling_rate, trajectories_at
from eigenwalker.metric.alignment import Alignment, align_steps, horizontal_mean, window_means
from eigenwalker.metric.clips import (
    Clip,
    PreparedClip,
    as_trajectories,
    at_one_rate,
    duration_s,
    positions_at,
)
from eigenwalker.metric.cycles import CYCLE_FRAMES, common_clock, register_pairs
from eigenwalker.metric.frame_metrics import POSITIONS, Metric
from eigenwalker.metric.joint_groups import By
from eigenwalker.metric.loops import loop
from eigenwalker.metric.motion_maps import motion_map
from eigenwalker.metric.paths import SLOPE_LIMIT, least_cost_path
from eigenwalker.metric.point_maps import point_distances
from eigenwalker.metric.points import (
    common_names,
    common_positions,
    content_ranks,
    match_rotations,
    points_of,
    select_points,
)

WINDOW_S = 0.1
"""Seconds about each frame from which it is aligned, and over which the map is averaged."""


@dataclass(frozen=True, eq=False)
class Registration:
    """Which moments of two clips correspond, and how the second is laid over the first.

    Parameters
    ----------
    first, second : DataArray of shape (time, marker, axis)
        The registered clips in mm, at one frame rate; of walks, one stride of each.
    path : array of int of shape (step, 2)
        Corresponding frames. Of strides the path is closed: it goes once round both.
    times : array of shape (step, 2)
        The same in seconds on the clocks of both clips; those of strides continue over the seam.
    map : DataArray of shape (time_a, time_b)
        The motion map through which the path leads.
    cost : float
        Mean of the map along the path: the distance between the clips.
    alignment : Alignment
        For each step, how the second clip is rotated and translated to lie over the first.
    periodic : bool
        Whether they are strides, which repeat.

    See Also
    --------
    register, register_by_spline, register_walks : Make it.

    References
    ----------
    Kovar & Gleicher (2003), Flexible automatic motion blending with registration curves, section 3.
    """

    first: xr.DataArray
    second: xr.DataArray
    path: np.ndarray
    times: np.ndarray
    map: xr.DataArray
    cost: float
    alignment: Alignment
    periodic: bool

    def __repr__(self) -> str:
        turn = np.rad2deg(self.alignment.angles)
        return (
            f"Registration({self.first.sizes['time']} with {self.second.sizes['time']} frames, "
            f"{len(self.path)} steps, cost {self.cost:.4g} {self.map.attrs['units']}, turned by "
            f"{turn.min():.0f} to {turn.max():.0f} degrees)"
        )

    def distances(self, by: By = "positions") -> pd.DataFrame:
        """Return the distance between the aligned clips for each step of the path and each point.

        By "positions" in mm, "velocities" in mm/s or "angles" in radians; points that are missing
        anywhere are left out.
        """
        clips = match_rotations((self.first, self.second))
        points = [points_of(clip, by, periodic=self.periodic) for clip in clips]
        names = common_names(points[0][0], points[1][0])
        a, b = (
            select_points(*each, names)[frames]
            for each, frames in zip(points, self.path.T, strict=True)
        )
        if by != "angles":
            shifts = self.alignment.shifts if by == "positions" else 0 * self.alignment.shifts
            b = Alignment(self.alignment.angles, shifts).apply(b)
        return pd.DataFrame(point_distances(a, b), columns=names).dropna(axis=1)

    def swapped(self) -> Registration:
        """Return the same registration with the second clip first."""
        cells = self.map.rename(time_a="time_b", time_b="time_a").transpose("time_a", "time_b")
        return replace(
            self,
            first=self.second,
            second=self.first,
            path=self.path[:, ::-1],
            times=self.times[:, ::-1],
            map=cells,
            alignment=self.alignment.inverse(),
        )

    def on_common_clock(self) -> tuple[xr.DataArray, xr.DataArray]:
        """Return both clips, the second aligned, with corresponding moments at the same times.

        The common clock is the mean of both clocks. The lead of the second clip along the path is
        smoothed, as a path is made of stairs. Both are of shape (time, marker, axis), with the
        markers that both have.
        """
        unit = [duration_s(self.first), duration_s(self.second)] if self.periodic else [1.0, 1.0]
        moments = self.times / unit  # seconds; of strides, parts of the cycle
        halfway, lead = (
            moments.mean(axis=1),
            _smoothed(moments[:, 1] - moments[:, 0], self.periodic),
        )
        n_frames = max(self.first.sizes["time"], self.second.sizes["time"])
        stop = halfway[0] + 1 if self.periodic else halfway[-1]
        clock = np.linspace(halfway[0], stop, n_frames, endpoint=not self.periodic)
        ahead = np.interp(clock, halfway, lead, period=1 if self.periodic else None) / 2
        names = common_names(self.first.marker.values, self.second.marker.values)
        first, second = (
            positions_at(clip.sel(marker=names), moment * length, periodic=self.periodic)
            for clip, moment, length in zip(
                (self.first, self.second), (clock - ahead, clock + ahead), unit, strict=True
            )
        )
        angles = np.interp(clock, halfway, np.unwrap(self.alignment.angles))
        shifts = [np.interp(clock, halfway, along) for along in self.alignment.shifts.T]
        second = Alignment(angles, np.stack(shifts, axis=1)).apply(second)
        time = (clock - clock[0]) * np.mean(unit)
        return trajectories_at(time, first, names), trajectories_at(time, second, names)


def _smoothed(values: np.ndarray, periodic: bool) -> np.ndarray:
    """Return running means, taken twice, whose windows shrink towards the ends."""
    n = len(values)
    half = min(max(SLOPE_LIMIT, n // 24), (n - 1) // 2)
    if periodic:
        values = np.pad(values, 2 * half, mode="wrap")
    steps = np.arange(len(values))
    reach = np.minimum(half, np.minimum(steps, len(values) - 1 - steps))
    for _ in range(2):
        values = window_means(values, steps - reach, steps + reach + 1)
    return values[2 * half : 2 * half + n] if periodic else values


def register(
    a: Clip,
    b: Clip,
    *,
    metric: str | Metric = POSITIONS,
    window_s: float = WINDOW_S,
    align: bool = True,
    slope_limit: int | None = SLOPE_LIMIT,
) -> Registration:
    """Return which moments of two clips correspond, from beginning to end.

    The registration curve of Kovar & Gleicher (2003) for two clips: the path of least cost
    (`least_cost_path`) from the first frames to the last through the motion map (`motion_map`), in
    which each pair of frames is aligned in heading and place over a window. For clips of one
    action each, with the same beginning and end.

    Parameters
    ----------
    a, b : DataArray of shape (time, marker, axis), Walker, Loop or PreparedClip
        Clips. If their frame rates differ, the slower one is interpolated.
    metric : str, FrameMetric or GroupMetric
        What is compared; left out, positions, all points with the same weight.
    window_s : float
        Seconds about each frame from which it is aligned, and over which the map is averaged.
    align : bool
        Whether heading and place are removed, for each pair of frames on its own.
    slope_limit : int, optional
        Frames in succession for which one clip may be held; None is plain dynamic time warping.

    Returns
    -------
    Registration

    Raises
    ------
    ValueError
        If the clips have no points in common, samples are missing, or no path within the limit
        joins their ends.

    See Also
    --------
    register_walks : For walks that begin at any phase of the stride.
    register_by_spline : By a smooth warp of time.

    References
    ----------
    Kovar & Gleicher (2003), Flexible automatic motion blending with registration curves, section 3.

    Examples
    --------
    A walk, and the same 1.25 times slower and elsewhere in the room:

    >>> walk = ew.simulate_walk(seed=1, duration_s=2, rate_hz=60)
    >>> slower = (walk + np.array([700, 0, 0])).assign_coords(time=1.25 * walk.time)
    >>> first, second = register(walk, slower).on_common_clock()
    >>> bool(np.abs(first - second).max() < 20)
    True
    """
    a, b = at_one_rate(as_trajectories(a), as_trajectories(b))
    cells = motion_map(a, b, metric=metric, window_s=window_s, align=align)
    unseen = [(~np.isfinite(clip.values.sum(axis=2))).all(axis=-1).any() for clip in (a, b)]
    if any(unseen) or cells.isnull().any():
        raise ValueError(
            "Samples are missing in some frames, so no path leads through their map; fill gaps "
            "first, with in_place() or repair_labels()."
        )
    path = least_cost_path(cells.values, slope_limit=slope_limit)
    alignment = Alignment(np.zeros(len(path)), np.zeros((len(path), 2)))
    if align:
        first, second = common_positions(a, b)
        half = round(window_s * sampling_rate(a) / 2)
        alignment = align_steps(first[path[:, 0]], second[path[:, 1]], half)
    return Registration(
        first=a,
        second=b,
        path=path,
        times=np.stack([a.time.values[path[:, 0]], b.time.values[path[:, 1]]], axis=1),
        map=cells,
        cost=float(cells.values[path[:, 0], path[:, 1]].mean()),
        alignment=alignment,
        periodic=False,
    )


def register_walks(a: Clip, b: Clip) -> Registration:
    r"""Return which phases of the strides of two walks correspond.

    1. Both walks become loops (`loop`) of 120 frames, i = 0 ... 119, with equal duration, about
       their mean position on the floor.
    2. The second is shifted in phase by :math:`s^*` frames and rotated about the vertical by
       :math:`\theta`, which minimise the summed squared distance of all points. With sums over
       frames and points of both cycles,

       .. math::

           A(s) &= \sum x_i x'_{i+s} + y_i y'_{i+s}, \quad
           B(s) = \sum y_i x'_{i+s} - x_i y'_{i+s}, \quad
           C(s) = \sum z_i z'_{i+s}, \\
           s^* &= \arg\max_s \sqrt{A(s)^2 + B(s)^2} + C(s), \qquad
           \theta = \arctan \frac{B(s^*)}{A(s^*)}

    3. The path is the closed monotone path once round the map of mean distances with the least sum
       (`least_cost_path`), with at most 3 held frames in succession, and at most 10 frames (a
       twelfth of the stride) ahead of or behind :math:`i + s^*`.

    Parameters
    ----------
    a, b : DataArray of shape (time, marker, axis), Walker, Loop or PreparedClip
        Walks that begin at any phase of the stride, of any duration, heading and place.

    Returns
    -------
    Registration
        Of one stride of each. The path is the same whichever walk comes first.

    See Also
    --------
    register : Of clips that do not repeat.

    References
    ----------
    Pražák et al. (2010), section 2; Kovar & Gleicher (2003), section 3; Kovar, Gleicher & Pighin
    (2002), section 3.1.

    Examples
    --------
    >>> walk, other = (ew.simulate_walk(seed=seed, rate_hz=60) for seed in (1, 2))
    >>> later = walk.isel(time=slice(45, None))
    >>> register_walks(walk, later).cost < 0.01 * register_walks(walk, other).cost
    True
    """
    return register_strides(_stride(a), _stride(b))


def _stride(clip: Clip) -> xr.DataArray:
    if isinstance(clip, PreparedClip) and clip.cycle is not None:
        return clip.cycle
    return common_clock(loop(clip))


def register_prepared(a: PreparedClip, b: PreparedClip) -> Registration:
    """Return how two prepared clips are registered: as strides if both repeat, else end to end."""
    if a.cycle is not None and b.cycle is not None:
        return register_strides(a.cycle, b.cycle)
    if _is_swapped(a.clip, b.clip):
        return register(b.clip, a.clip).swapped()
    return register(a.clip, b.clip)


def _is_swapped(a: xr.DataArray, b: xr.DataArray) -> bool:
    rank_a, rank_b = content_ranks([a.values, b.values])
    return bool(rank_a > rank_b)


def register_strides(first: xr.DataArray, second: xr.DataArray) -> Registration:
    """Return which phases of two strides on the common clock correspond; symmetric."""
    names = common_names(first.marker.values, second.marker.values)
    first, second = first.sel(marker=names), second.sel(marker=names)
    if _is_swapped(first, second):
        return register_strides(second, first).swapped()
    registered = register_pairs(np.stack([first.values, second.values]), np.array([[0, 1]]))
    path = registered.path(0)
    rotated = Alignment(registered.angles, np.zeros((1, 2))).apply(second.values)
    shift = horizontal_mean(first.values) - horizontal_mean(rotated)
    aligned = Alignment(registered.angles, shift[None]).apply(second.values)
    cells = motion_map(first, second.copy(data=aligned))
    steps = np.zeros(len(path), dtype=int)
    frames = np.unwrap(path, period=CYCLE_FRAMES, axis=0)
    return Registration(
        first=first,
        second=second,
        path=path,
        times=frames * [duration_s(first) / CYCLE_FRAMES, duration_s(second) / CYCLE_FRAMES],
        map=cells,
        cost=float(cells.values[path[:, 0], path[:, 1]].mean()),
        alignment=Alignment(registered.angles[steps], shift[None][steps]),
        periodic=True,
    )
