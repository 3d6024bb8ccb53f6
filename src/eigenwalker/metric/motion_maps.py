"""Motion maps: how different every frame of one clip is from every frame of another (P3)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr

from eigenwalker.core.trajectories import check_trajectories, sampling_rate
from eigenwalker.metric.alignment import align_windows, aligned_map
from eigenwalker.metric.frame_metrics import POSITIONS, ComparesFrames, shape_parameter
from eigenwalker.metric.kernels import diagonal_means
from eigenwalker.metric.point_maps import point_map
from eigenwalker.metric.points import (
    UNITS,
    common_names,
    common_positions,
    picked,
    points_of,
    told_alike,
)
from eigenwalker.metric.published import metric_named
from eigenwalker.metric.resampling import SAME_RATE

MOST_CELLS = 60_000_000
"""Cells of the largest map: half a gigabyte. Two clips of a minute at 120 Hz stay below."""

MOST_ALIGNED_CELLS = MOST_CELLS // 6
"""Aligned maps need several numbers a cell. Two clips of 25 s at 120 Hz stay below."""


def motion_map(
    a: xr.DataArray,
    b: xr.DataArray | None = None,
    *,
    metric: str | ComparesFrames = POSITIONS,
    window_s: float = 0.0,
    align: bool = False,
    periodic: bool = False,
) -> xr.DataArray:
    """Return how different every frame of one clip is from every frame of another.

    The motion map of Pražák et al. (2010, fig. 1 and 6): ``D[i, j] = sum_k w_k F(d_k)``, with d_k
    the distance of point k in frame i of one clip from the same point in frame j of the other.

    Parameters
    ----------
    a : DataArray of shape (time, marker, axis)
        Trajectories. Points are compared that both clips have.
    b : DataArray of shape (time, marker, axis), optional
        The other clip; left out, the clip is compared to itself.
    metric : FrameMetric or str
        What is compared and how, or the name of a published metric; left out, the mean Euclidean
        distance of positions in mm, all points weighing the same.
    window_s : float
        Seconds over which corresponding frames are averaged, fewer at the ends of the clips (P4).
        Both clips must have the same frame rate then.
    align : bool
        Whether the second clip is turned about the vertical and moved along the floor, for every
        cell on its own, so that the points in the window lie nearest to those of the first.
    periodic : bool
        Whether the clips are cycles, such as `loop` gives them, whose first frame follows the last:
        their velocities are those of clip distances then.

    Returns
    -------
    DataArray of shape (time_a, time_b)
        In the unit of F(d). A point that is missing in either frame is left out and the others
        weigh more; a cell is NaN where all are missing. Of more than 4 million distances, such as
        520 x 520 frames of 15 joints, a map is of single precision.

    Raises
    ------
    ValueError
        If the clips have no points in common, or lack what the metric asks for.

    Examples
    --------
    A foot that moves at 1 m/s, seen in two clips half a metre apart:

    >>> foot = [[[0, 0, 0]], [[10, 0, 0]], [[20, 0, 0.0]]]
    >>> a = ew.label_trajectories(foot, markers=["foot"], rate_hz=100)
    >>> motion_map(a, a + np.array([500, 0, 0])).values.tolist()
    [[500.0, 510.0, 520.0], [490.0, 500.0, 510.0], [480.0, 490.0, 500.0]]
    >>> motion_map(a, a + np.array([500, 0, 0]), align=True).values.max()
    np.float64(0.0)

    """
    metric = metric_named(metric)
    clips = _both(a, b, metric, align, periodic)
    half = _half_window(clips.a, clips.b, window_s)
    values = clips.map_of(metric.weights_for(clips.names), metric, half, align)
    return xr.DataArray(
        values,
        dims=("time_a", "time_b"),
        coords=_clocks(clips.a, clips.b),
        name="distance",
        attrs=_about(metric),
    )


def motion_maps(
    a: xr.DataArray,
    b: xr.DataArray | None = None,
    *,
    groups: Mapping[str, Sequence[str]],
    metric: str | ComparesFrames = POSITIONS,
    window_s: float = 0.0,
    align: bool = False,
) -> xr.DataArray:
    """Return a motion map for each group of points, such as thighs or forearms.

    Parameters
    ----------
    a, b, metric, window_s, align
        As in `motion_map`. Of the metric only what is compared and its shape count: points of one
        group weigh the same.
    groups : mapping of str to sequence of str
        The points of each group. A group of which the clips have none is left out.

    Returns
    -------
    DataArray of shape (group, time_a, time_b)

    Raises
    ------
    ValueError
        If no group has points that both clips have.

    Examples
    --------
    >>> walk = ew.simulate_walk(seed=1, duration_s=1, rate_hz=30)
    >>> groups = {"head": ["head"], "wrists": ["left_wrist", "right_wrist"], "toes": ["left_toe"]}
    >>> maps = motion_maps(walk, groups=groups)
    >>> maps.group.values.tolist(), maps.shape
    (['head', 'wrists'], (2, 30, 30))

    """
    metric = metric_named(metric)
    clips = _both(a, b, metric, align)
    half = _half_window(clips.a, clips.b, window_s)
    present = {name: set(points) & set(clips.names) for name, points in groups.items()}
    present = {name: points for name, points in present.items() if points}
    if not present:
        raise ValueError(
            f"No group has points that both clips have. The groups are {dict(groups)}, the points "
            f"of both clips {clips.names}."
        )
    maps = [
        clips.map_of(
            np.array([(name in points) / len(points) for name in clips.names]), metric, half, align
        )
        for points in present.values()
    ]
    return xr.DataArray(
        np.stack(maps),
        dims=("group", "time_a", "time_b"),
        coords={"group": list(present), **_clocks(clips.a, clips.b)},
        name="distance",
        attrs=_about(metric),
    )


class _Both(NamedTuple):
    """Two clips, and as arrays of shape (time, point, part) the points that both have."""

    a: xr.DataArray
    b: xr.DataArray
    names: list[str]
    points_a: np.ndarray
    points_b: np.ndarray

    def map_of(
        self, weights: np.ndarray, metric: ComparesFrames, half: int, align: bool
    ) -> np.ndarray:
        form = {"shape": metric.shape, "parameter": shape_parameter(metric)}
        if align and metric.by != "angles":
            a, b = common_positions(self.a, self.b)
            alignment = align_windows(a, b, half)
            kept = weights > 0
            a, b = _complete(self.points_a[:, kept]), _complete(self.points_b[:, kept])
            moved = metric.by == "positions"
            cells = aligned_map(a, b, alignment, weights[kept], **form, moved=moved)
        else:
            cells = point_map(self.points_a, self.points_b, weights, **form)
        return diagonal_means(cells, half) if half else cells


def _both(
    a: xr.DataArray,
    b: xr.DataArray | None,
    metric: ComparesFrames,
    align: bool,
    periodic: bool = False,
) -> _Both:
    a = check_trajectories(a)
    b = a if b is None else check_trajectories(b)
    n_cells = a.sizes["time"] * b.sizes["time"]
    if not n_cells:
        raise ValueError("A clip without frames has no motion map.")
    most = MOST_ALIGNED_CELLS if align else MOST_CELLS
    if n_cells > most:
        raise ValueError(
            f"A map of {a.sizes['time']} x {b.sizes['time']} frames would hold {n_cells:.2g} "
            f"cells, more than {most:.2g}. Take parts of the clips, or every n-th frame."
        )
    alike = (a, b) if b is a else told_alike((a, b))
    points_a = points_of(alike[0], metric.by, periodic=periodic)
    points_b = points_a if b is a else points_of(alike[1], metric.by, periodic=periodic)
    names = common_names(points_a[0], points_b[0])
    values_a = picked(*points_a, names)
    values_b = values_a if b is a else picked(*points_b, names)
    return _Both(a, b, names, values_a, values_b)


def _complete(values: np.ndarray) -> np.ndarray:
    if np.isnan(values).any():
        raise ValueError(
            "Samples are missing, which an aligned map needs; fill gaps first with in_place(), or "
            "leave the markers out."
        )
    return values


def _half_window(a: xr.DataArray, b: xr.DataArray, window_s: float) -> int:
    if not 0 <= window_s < np.inf:
        raise ValueError(f"window_s={window_s}; give seconds, 0 or more.")
    if window_s == 0:
        return 0
    rates = sampling_rate(a), sampling_rate(b)
    if abs(rates[0] / rates[1] - 1) > SAME_RATE:
        raise ValueError(
            f"The clips have {rates[0]:.6g} and {rates[1]:.6g} frames a second, and a window of "
            "frames needs one rate. Resample one, for instance with trajectories.interp(time=...)."
        )
    return round(window_s * rates[0] / 2)


def _clocks(a: xr.DataArray, b: xr.DataArray) -> dict[str, tuple[str, np.ndarray]]:
    return {"time_a": ("time_a", a.time.values), "time_b": ("time_b", b.time.values)}


def _about(metric: ComparesFrames) -> dict[str, str]:
    unit = UNITS[metric.by]
    power = {"absolute": unit, "squared": f"({unit})^2", "sigmoid": "1"}
    return {
        "units": power.get(metric.shape, f"({unit})^{metric.exponent}"),
        "by": metric.by,
        "shape": metric.shape,
    }
