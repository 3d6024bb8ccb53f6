"""Two clips brought onto one clock and into one place (P4; Kovar & Gleicher 2003)."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
import xarray as xr

from eigenwalker.core.trajectories import sampling_rate, trajectories_at
from eigenwalker.metric.alignment import Alignment, align_steps
from eigenwalker.metric.cycles import CYCLE_FRAMES, common_clock, register_pairs
from eigenwalker.metric.frame_metrics import POSITIONS, By, ComparesFrames
from eigenwalker.metric.loops import loop
from eigenwalker.metric.motion_maps import motion_map
from eigenwalker.metric.paths import SLOPE_LIMIT, least_cost_path
from eigenwalker.metric.point_maps import point_distances
from eigenwalker.metric.points import common_names, common_positions, picked, points_of, told_alike
from eigenwalker.metric.resampling import at_one_rate, length_s, played

WINDOW_S = 0.1
"""Seconds about each frame that decide how it is turned and moved, and over which maps average."""


@dataclass(frozen=True, eq=False)
class Registration:
    """Which moment of one clip corresponds to which of another, and how they lie over each other.

    Parameters
    ----------
    first, second : DataArray of shape (time, marker, axis)
        The clips that were registered, at one frame rate; of walks, a stride of each.
    path : array of int of shape (step, 2)
        Corresponding frames. Of strides the path is closed: it goes once round both.
    times : array of shape (step, 2)
        The same in seconds on the clocks of both clips; those of strides run on over the seam.
    map : DataArray of shape (time_a, time_b)
        The motion map through which the path leads.
    cost : float
        Mean of the map along the path: how different the clips are.
    alignment : Alignment
        For each step, how the second clip is turned about the vertical (`angles`, radians) and
        then moved (`shifts`, mm) to lie over the first.
    periodic : bool
        Whether they are strides, which repeat.

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
        """Return how far each point of one clip is from the same point of the other at each step.

        Parameters
        ----------
        by : {"positions", "velocities", "angles"}
            In mm, mm/s or radians, heading and place removed.

        Returns
        -------
        DataFrame of steps by points
            Points that are missing anywhere are left out.

        """
        clips = told_alike((self.first, self.second))
        points = [points_of(clip, by, periodic=self.periodic) for clip in clips]
        names = common_names(points[0][0], points[1][0])
        a, b = (
            picked(*each, names)[frames] for each, frames in zip(points, self.path.T, strict=True)
        )
        if by != "angles":
            moves = self.alignment.shifts if by == "positions" else 0 * self.alignment.shifts
            b = Alignment(self.alignment.angles, moves).apply(b)
        return pd.DataFrame(point_distances(a, b), columns=names).dropna(axis=1)

    def turned_round(self) -> Registration:
        """Return the same with the second clip first."""
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
        """Return both clips so that corresponding moments come at the same time.

        The common clock goes halfway between theirs. The second clip is turned and moved over the
        first.

        Returns
        -------
        first, second : DataArray of shape (time, marker, axis)
            Of equal times; markers that both have.

        """
        once = [length_s(self.first), length_s(self.second)] if self.periodic else [1.0, 1.0]
        moments = self.times / once  # seconds; of strides, parts of the cycle
        halfway, lead = moments.mean(axis=1), _smooth(moments[:, 1] - moments[:, 0], self.periodic)
        n_frames = max(self.first.sizes["time"], self.second.sizes["time"])
        stop = halfway[0] + 1 if self.periodic else halfway[-1]
        clock = np.linspace(halfway[0], stop, n_frames, endpoint=not self.periodic)
        ahead = np.interp(clock, halfway, lead, period=1 if self.periodic else None) / 2
        names = common_names(self.first.marker.values, self.second.marker.values)
        first = played(self.first.sel(marker=names), (clock - ahead) * once[0], self.periodic)
        second = played(self.second.sel(marker=names), (clock + ahead) * once[1], self.periodic)
        angles = np.interp(clock, halfway, np.unwrap(self.alignment.angles))
        shifts = [np.interp(clock, halfway, along) for along in self.alignment.shifts.T]
        second = Alignment(angles, np.stack(shifts, axis=1)).apply(second)
        time = (clock - clock[0]) * np.mean(once)
        return trajectories_at(time, first, names), trajectories_at(time, second, names)


def register(
    a: xr.DataArray,
    b: xr.DataArray,
    *,
    metric: str | ComparesFrames = POSITIONS,
    window_s: float = WINDOW_S,
    align: bool = True,
    slope_limit: int | None = SLOPE_LIMIT,
) -> Registration:
    """Return which moments of two clips correspond, from beginning to end.

    The registration curve of Kovar & Gleicher (2003): the monotone path of least cost through the
    motion map, in which every pair of frames is aligned in heading and place, with a limit to how
    long one clip may stand still. For clips that hold one action each, begun and ended alike;
    walks that begin at any moment of the stride are for `register_walks`.

    Parameters
    ----------
    a, b : DataArray of shape (time, marker, axis)
        Trajectories. If their frame rates differ, the slower one is interpolated.
    metric : FrameMetric or str
        What is compared; left out, positions, all points weighing the same.
    window_s : float
        Seconds about each frame that decide how it is aligned, and over which the map is averaged.
    align : bool
        Whether heading and place are removed, for every pair of frames on its own.
    slope_limit : int, optional
        Frames in a row that one clip may stand still; None is plain dynamic time warping.

    Returns
    -------
    Registration

    Raises
    ------
    ValueError
        If the clips have no points in common, samples are missing, or no path within the limit of
        slope joins their ends.

    Examples
    --------
    A walk, and the same played 1.25 times slower, turned by 40 degrees, elsewhere in the room:

    >>> from scipy.spatial.transform import Rotation
    >>> walk = ew.simulate_walk(seed=1, duration_s=2, rate_hz=60)
    >>> turn = Rotation.from_euler("z", 40, degrees=True).as_matrix()
    >>> other = walk.copy(data=walk.values @ turn.T + [700, 0, 0])
    >>> slower = other.assign_coords(time=1.25 * walk.time)
    >>> found = register(walk, slower)
    >>> np.rad2deg(found.alignment.angles).mean().round(1)
    np.float64(-40.0)
    >>> first, second = found.on_common_clock()
    >>> bool(np.abs(first - second).max() < 20)
    True

    """
    a, b = at_one_rate(a, b)
    cells = motion_map(a, b, metric=metric, window_s=window_s, align=align)
    unseen = [(~np.isfinite(clip.values.sum(axis=2))).all(axis=-1).any() for clip in (a, b)]
    if any(unseen) or cells.isnull().any():
        raise ValueError(
            "Samples are missing in some frames, so no path leads through their map; fill gaps "
            "first, with in_place() or repair_labels()."
        )
    path = least_cost_path(cells.values, slope_limit=slope_limit)
    half = round(window_s * sampling_rate(a) / 2)
    return Registration(
        first=a,
        second=b,
        path=path,
        times=np.stack([a.time.values[path[:, 0]], b.time.values[path[:, 1]]], axis=1),
        map=cells,
        cost=float(cells.values[path[:, 0], path[:, 1]].mean()),
        alignment=along_path(a, b, path, half) if align else unmoved(len(path)),
        periodic=False,
    )


def along_path(a: xr.DataArray, b: xr.DataArray, path: np.ndarray, half: int) -> Alignment:
    """Return how the second clip lies over the first at each step, from windows of steps."""
    first, second = common_positions(a, b)
    return align_steps(first[path[:, 0]], second[path[:, 1]], half)


def unmoved(n_steps: int) -> Alignment:
    """Return an alignment that turns and moves nothing."""
    return Alignment(np.zeros(n_steps), np.zeros((n_steps, 2)))


def register_walks(a: xr.DataArray, b: xr.DataArray) -> Registration:
    """Return which phases of the strides of two walks correspond.

    Both walks are brought in place and looped (`loop`), and their strides scaled to one clock. Of
    all phases and headings those are found at which they lie nearest on the whole, in closed form;
    from there a closed path, with slope limits, goes once round their map. It keeps within a
    twelfth of the stride of where both go on alike, and leaves that line where what is gained is
    worth the way round.

    Parameters
    ----------
    a, b : DataArray of shape (time, marker, axis)
        Trajectories of walks, which may begin anywhere, at any moment of the stride, and last as
        long as they like.

    Returns
    -------
    Registration
        Of a stride of each, in `CYCLE_FRAMES` frames.

    Raises
    ------
    ValueError
        If a clip does not repeat, or they have no points in common.

    Examples
    --------
    >>> walk = ew.simulate_walk(seed=1, rate_hz=60)
    >>> later = walk.isel(time=slice(45, None))
    >>> other = ew.simulate_walk(seed=2, rate_hz=60)
    >>> register_walks(walk, later).cost < 0.01 * register_walks(walk, other).cost
    True

    """
    return register_strides(*(common_clock(loop(clip)) for clip in (a, b)))


def register_strides(first: xr.DataArray, second: xr.DataArray) -> Registration:
    """Return which phases of two strides on the common clock (`common_clock`) correspond.

    Whichever is named first, the path is the same.
    """
    names = common_names(first.marker.values, second.marker.values)
    first, second = first.sel(marker=names), second.sel(marker=names)
    if first.values.tobytes() > second.values.tobytes():
        return register_strides(second, first).turned_round()
    found = register_pairs(np.stack([first.values, second.values]), np.array([[0, 1]]))
    path = found.path(0)
    turn = Alignment(found.angles, np.zeros((1, 2)))
    way = _middle(first.values) - _middle(turn.apply(second.values))
    over = second.copy(data=Alignment(found.angles, way[None]).apply(second.values))
    cells = motion_map(first, over).assign_coords(time_b=second.time.values)
    steps = np.zeros(len(path), dtype=int)
    return Registration(
        first=first,
        second=second,
        path=path,
        times=_running_on(path, first, second),
        map=cells,
        cost=float(cells.values[path[:, 0], path[:, 1]].mean()),
        alignment=Alignment(found.angles[steps], way[None][steps]),
        periodic=True,
    )


def _middle(values: np.ndarray) -> np.ndarray:
    return values[..., :2].mean(axis=(0, 1))


def _running_on(path: np.ndarray, first: xr.DataArray, second: xr.DataArray) -> np.ndarray:
    """Seconds of each step on both clocks, which run on over the seams."""
    onwards = np.unwrap(path, period=CYCLE_FRAMES, axis=0)
    return onwards * [length_s(first) / CYCLE_FRAMES, length_s(second) / CYCLE_FRAMES]


def _smooth(values: np.ndarray, periodic: bool) -> np.ndarray:
    """Running means, taken twice, which make slopes of the stairs of a path; ends stay."""
    n = len(values)
    half = min(max(SLOPE_LIMIT, n // 24), (n - 1) // 2)
    if periodic:
        values = np.pad(values, 2 * half, mode="wrap")
    steps = np.arange(len(values))
    reach = np.minimum(half, np.minimum(steps, len(values) - 1 - steps))
    for _ in range(2):
        sums = np.concatenate([[0], np.cumsum(values)])
        values = (sums[steps + reach + 1] - sums[steps - reach]) / (2 * reach + 1)
    return values[2 * half : 2 * half + n] if periodic else values
