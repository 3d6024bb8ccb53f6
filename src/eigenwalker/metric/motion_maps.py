"""Motion maps: distances of every frame of one clip from every frame of another."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr

from eigenwalker.core.trajectories import sampling_rate
from eigenwalker.metric.alignment import align_windows, aligned_map
from eigenwalker.metric.clips import SAME_RATE, Clip, Loop, as_trajectories
from eigenwalker.metric.frame_metrics import POSITIONS, Metric, shape_parameter
from eigenwalker.metric.kernels import diagonal_means
from eigenwalker.metric.point_maps import point_map
from eigenwalker.metric.points import (
    UNITS,
    common_names,
    common_positions,
    match_rotations,
    points_of,
    select_points,
)
from eigenwalker.metric.published import metric_named

MAX_CELLS = 60_000_000
"""Cells of the largest map: half a gigabyte. Two clips of a minute at 120 Hz stay below."""

MAX_ALIGNED_CELLS = MAX_CELLS // 6
"""Aligned maps need several numbers for each cell. Two clips of 25 s at 120 Hz stay below."""


def motion_map(
    a: Clip,
    b: Clip | None = None,
    *,
    metric: str | Metric = POSITIONS,
    window_s: float = 0.0,
    align: bool = False,
    periodic: bool | None = None,
) -> xr.DataArray:
    r"""Return the distance of every frame of one clip from every frame of another.

    .. math:: D(i, j) = \sum_k w_k F(d_k(i, j))

    with :math:`d_k` the distance of point k in frame i of one clip from the same point in frame j
    of the other (`FrameMetric`). With a window of :math:`2h + 1` frames the map is averaged along
    its diagonals, over :math:`D(i + s, j + s)` for :math:`s = -h \ldots h`.

    Parameters
    ----------
    a, b : DataArray of shape (time, marker, axis), Walker, Loop or PreparedClip
        Clips; points are compared that both have. Without b, a is compared with itself.
    metric : str, FrameMetric or GroupMetric
        What is compared and how, or the name of a published metric; left out, the mean Euclidean
        distance of positions in mm, all points with the same weight.
    window_s : float
        Length of the window in seconds, shorter at the ends of the clips. Both clips must have the
        same frame rate then.
    align : bool
        Whether the second clip is rotated about the vertical and translated along the floor, for
        each cell on its own, so that the points in the window lie nearest to those of the first.
    periodic : bool, optional
        Whether the first frame of a clip follows its last, for velocities; left out, in a `Loop`.

    Returns
    -------
    DataArray of shape (time_a, time_b)
        In the unit of F(d). A point that is missing in either frame is left out and the weights of
        the others grow; a cell is NaN where all are missing. Maps of more than 4 million
        distances, such as 520 x 520 frames of 15 joints, are computed in single precision.

    Raises
    ------
    ValueError
        If the clips have no points in common, or lack what the metric needs.

    See Also
    --------
    motion_maps : One map for each group of points.
    find_transitions : Where one clip can pass into the other.

    References
    ----------
    Pražák et al. (2010), eqs. 1 to 3, figs. 1 and 6; Kovar, Gleicher & Pighin (2002), section 3.1.

    Examples
    --------
    A foot that moves at 1 m/s, in two clips half a metre apart:

    >>> foot = [[[0, 0, 0]], [[10, 0, 0]], [[20, 0, 0.0]]]
    >>> a = ew.label_trajectories(foot, markers=["foot"], rate_hz=100)
    >>> motion_map(a, a + np.array([500, 0, 0])).values.tolist()
    [[500.0, 510.0, 520.0], [490.0, 500.0, 510.0], [480.0, 490.0, 500.0]]
    """
    metric = metric_named(metric)
    clips = _clip_pair(a, b, metric, align, periodic)
    weights = {"all": metric.weights_for(clips.names)}
    return clips.maps(weights, metric, window_s, align)[0].drop_vars("group")


def motion_maps(
    a: Clip,
    b: Clip | None = None,
    *,
    groups: Mapping[str, Sequence[str]],
    metric: str | Metric = POSITIONS,
    window_s: float = 0.0,
    align: bool = False,
) -> xr.DataArray:
    """Return a motion map for each group of points, such as thighs or forearms.

    Parameters
    ----------
    a, b : DataArray of shape (time, marker, axis) in mm, Walker, Loop or PreparedClip
        Clips; points are compared that both have. Without b, a is compared with itself.
    groups : mapping of str to sequence of str
        The points of each group, which have the same weight. Groups without points in both clips
        are left out.
    metric : str, FrameMetric or GroupMetric
        What is compared and how (F), or the name of a published metric; its weights are not used.
        Left out, positions in mm.
    window_s : float
        Seconds over which each map is averaged along its diagonals.
    align : bool
        Whether the second clip is turned and moved along the floor for each cell on its own.

    Returns
    -------
    DataArray of shape (group, time_a, time_b)
        In the unit of F(d): the mean over the points of a group; NaN where all are missing.

    See Also
    --------
    motion_map : All points in one, and how windows and alignment are computed.

    References
    ----------
    Pražák et al. (2010), fig. 6.

    Examples
    --------
    >>> walk = ew.simulate_walk(seed=1, duration_s=1, rate_hz=30)
    >>> groups = {"head": ["head"], "wrists": ["left_wrist", "right_wrist"], "toes": ["left_toe"]}
    >>> maps = motion_maps(walk, groups=groups)
    >>> maps.group.values.tolist(), maps.shape
    (['head', 'wrists'], (2, 30, 30))
    """
    metric = metric_named(metric)
    clips = _clip_pair(a, b, metric, align)
    members = {name: set(points) & set(clips.names) for name, points in groups.items()}
    members = {name: points for name, points in members.items() if points}
    if not members:
        raise ValueError(
            f"No group has points that both clips have. The groups are {dict(groups)}, the points "
            f"of both clips {clips.names}."
        )
    weights = {
        group: np.array([(name in points) / len(points) for name in clips.names])
        for group, points in members.items()
    }
    return clips.maps(weights, metric, window_s, align)


class _ClipPair(NamedTuple):
    """Two clips, and their common points as arrays of shape (time, point, part)."""

    a: xr.DataArray
    b: xr.DataArray
    names: list[str]
    points_a: np.ndarray
    points_b: np.ndarray

    def maps(
        self, weights: Mapping[str, np.ndarray], metric: Metric, window_s: float, align: bool
    ) -> xr.DataArray:
        half = _half_window(self.a, self.b, window_s)
        values = [self._map_of(each, metric, half, align) for each in weights.values()]
        times = {"time_a": self.a.time.values, "time_b": self.b.time.values}
        return xr.DataArray(
            values[0][None] if len(values) == 1 else np.stack(values),
            dims=("group", "time_a", "time_b"),
            coords={"group": list(weights), **times},
            name="distance",
            attrs=_description(metric),
        )

    def _map_of(self, weights: np.ndarray, metric: Metric, half: int, align: bool) -> np.ndarray:
        form = {"shape": metric.shape, "parameter": shape_parameter(metric)}
        if not align or metric.by == "angles":
            cells = point_map(self.points_a, self.points_b, weights, **form)
        else:
            alignment = align_windows(*common_positions(self.a, self.b), half)
            weighed = weights > 0
            a, b = _complete(self.points_a[:, weighed]), _complete(self.points_b[:, weighed])
            translate = metric.by == "positions"
            cells = aligned_map(a, b, alignment, weights[weighed], translate=translate, **form)
        return diagonal_means(cells, half) if half else cells


def _clip_pair(
    a: Clip, b: Clip | None, metric: Metric, align: bool, periodic: bool | None = None
) -> _ClipPair:
    b = a if b is None else b
    wraps = [isinstance(clip, Loop) if periodic is None else periodic for clip in (a, b)]
    a, b = (as_trajectories(a),) * 2 if b is a else (as_trajectories(a), as_trajectories(b))
    n_cells = a.sizes["time"] * b.sizes["time"]
    if not n_cells:
        raise ValueError("A clip without frames has no motion map.")
    limit = MAX_ALIGNED_CELLS if align else MAX_CELLS
    if n_cells > limit:
        raise ValueError(
            f"A map of {a.sizes['time']} x {b.sizes['time']} frames would hold {n_cells:.2g} "
            f"cells, more than {limit:.2g}. Take parts of the clips, or every n-th frame."
        )
    alike = (a, b) if b is a else match_rotations((a, b))
    points_a = points_of(alike[0], metric.by, periodic=wraps[0])
    points_b = points_a if b is a else points_of(alike[1], metric.by, periodic=wraps[1])
    names = common_names(points_a[0], points_b[0])
    values_a = select_points(*points_a, names)
    values_b = values_a if b is a else select_points(*points_b, names)
    return _ClipPair(a, b, names, values_a, values_b)


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


def _description(metric: Metric) -> dict[str, str]:
    unit = UNITS[metric.by]
    units = {"absolute": unit, "squared": f"({unit})^2", "sigmoid": "1"}
    return {
        "units": units.get(metric.shape, f"({unit})^{metric.exponent}"),
        "by": metric.by,
        "shape": metric.shape,
    }
