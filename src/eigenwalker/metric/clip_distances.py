"""How different two clips are, and all pairs of many (P4)."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from functools import reduce
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
import xarray as xr

from eigenwalker.gait.gaps import fill_short_gaps
from eigenwalker.metric.cycles import common_clock, mean_distances, register_pairs
from eigenwalker.metric.frame_metrics import POSITIONS, By, ComparesFrames, shaped
from eigenwalker.metric.loops import loop
from eigenwalker.metric.motion_maps import common_names, picked, points_of
from eigenwalker.metric.published import metric_named
from eigenwalker.metric.registration import Registration, register, register_strides
from eigenwalker.trajectories import check_trajectories, sampling_rate

if TYPE_CHECKING:
    from eigenwalker.folds import Progress  # which loads scikit-learn

_AT_ONCE = 4096
"""Pairs whose paths are kept in memory at a time."""


@dataclass(frozen=True, eq=False)
class PreparedClip:
    """A clip made ready to be compared with many others, by several metrics.

    Parameters
    ----------
    clip : DataArray of shape (time, marker, axis)
        As it was, short gaps filled.
    cycle : DataArray of shape (time, marker, axis), optional
        One stride of it on the common clock; None if it does not repeat.
    complaint : str
        Why there is no stride.

    """

    clip: xr.DataArray
    cycle: xr.DataArray | None
    complaint: str = ""


Clip = xr.DataArray | PreparedClip


def prepare(clip: Clip) -> PreparedClip:
    """Return a clip made ready to be compared.

    Parameters
    ----------
    clip : DataArray of shape (time, marker, axis), or PreparedClip
        Markers that were never seen are left out.

    Returns
    -------
    PreparedClip

    Raises
    ------
    ValueError
        If it is one frame, or has gaps that are too long to be filled.

    Examples
    --------
    >>> prepare(ew.simulate_walk(seed=1)).cycle.sizes["time"]
    120

    """
    if isinstance(clip, PreparedClip):
        return clip
    clip = check_trajectories(clip)
    rate_hz = sampling_rate(clip)
    if np.isnan(clip.values[0]).any():
        clip = clip.dropna("marker", how="all")
    if not clip.sizes["marker"]:
        raise ValueError("No marker of this clip was ever seen, so there is nothing to compare.")
    try:
        return PreparedClip(clip, common_clock(loop(clip)))
    except ValueError as error:
        filled, gaps = fill_short_gaps(clip.values, rate_hz)
        if gaps:
            raise
        return PreparedClip(clip.copy(data=filled), None, str(error))


def clip_distance(a: Clip, b: Clip, *, metric: str | ComparesFrames = POSITIONS) -> float:
    """Return how different two clips are: the mean frame distance along their registered path.

    As Pražák et al. (2010) compare walks (P4). Walks are brought in place and looped, their strides
    registered in phase, heading and place (`register_walks`), so it does not matter where and when
    a walk begins. If one of the clips does not repeat, both are registered from end to end
    (`register`). The path is always that of positions; the metric is averaged along it.

    Parameters
    ----------
    a, b : DataArray of shape (time, marker, axis), or PreparedClip
        Trajectories; points are compared that both have.
    metric : FrameMetric or str
        What is compared and how, or the name of a published metric; left out, the mean Euclidean
        distance of positions in mm, all points weighing the same.

    Returns
    -------
    float
        In the unit of the metric; 0 for a clip and itself, and the same either way round.

    Raises
    ------
    ValueError
        If the clips have no points in common, or lack what the metric asks for.

    Examples
    --------
    >>> walk, other = (ew.simulate_walk(seed=seed, rate_hz=60) for seed in (1, 2))
    >>> clip_distance(walk, walk)
    0.0
    >>> clip_distance(walk, other) == clip_distance(other, walk) > 20
    True

    """
    return float(pair_distances({"a": a, "b": b}, metric=metric).iloc[0])


def clip_components(a: Clip, b: Clip, *, metric: str | ComparesFrames = POSITIONS) -> pd.Series:
    """Return how different each point of two clips is: the mean of F(d_k) along their path.

    Parameters
    ----------
    a, b : DataArray of shape (time, marker, axis), or PreparedClip
    metric : FrameMetric or str
        Of which what is compared and F count; its weights do not.

    Returns
    -------
    Series of points

    Examples
    --------
    >>> walk = ew.simulate_walk(seed=1, rate_hz=60)
    >>> held_out = walk.copy()
    >>> held_out.loc[{"marker": "left_wrist", "axis": "y"}] += 150
    >>> clip_components(walk, held_out).idxmax()
    'left_wrist'

    """
    return pair_components({"a": a, "b": b}, metric=metric).iloc[0]


def step_distances(a: Clip, b: Clip, *, by: By = "positions") -> pd.DataFrame:
    """Return how far each point of two clips is apart at each step of their path.

    Parameters
    ----------
    a, b : DataArray of shape (time, marker, axis), or PreparedClip
    by : {"positions", "velocities", "angles"}
        In mm, mm/s or radians.

    Returns
    -------
    DataFrame of steps by points

    """
    return registration_of(prepare(a), prepare(b)).distances(by)


def registration_of(a: PreparedClip, b: PreparedClip) -> Registration:
    """Return how two prepared clips are registered: as strides if both repeat, else end to end."""
    if a.cycle is None or b.cycle is None:
        return register(a.clip, b.clip)
    return register_strides(a.cycle, b.cycle)


def pair_table(
    clips: Mapping[str, Clip],
    *,
    metric: str | ComparesFrames = POSITIONS,
    progress: Progress | None = None,
) -> pd.DataFrame:
    """Return the clip distances of all pairs.

    Parameters
    ----------
    clips : mapping of str to DataArray or PreparedClip
        Two or more clips by name. Points are compared that all have, and if one clip does not
        repeat, all are registered from end to end, so that distances mean the same throughout.
    metric : FrameMetric or str
        As in `clip_distance`.
    progress : callable, optional
        Called with the number of clips and pairs that are done, and of all.

    Returns
    -------
    DataFrame of clips by clips
        Symmetric, 0 on the diagonal.

    Examples
    --------
    >>> walks = {f"walk {seed}": ew.simulate_walk(seed=seed, rate_hz=60) for seed in (1, 2, 3)}
    >>> table = pair_table(walks)
    >>> table.shape, bool((table == table.T).all(axis=None))
    ((3, 3), True)

    """
    names = list(clips)
    distances = pair_distances(clips, metric=metric, progress=progress).to_numpy()
    table = np.zeros((len(names), len(names)))
    rows, columns = np.triu_indices(len(names), 1)
    table[rows, columns] = table[columns, rows] = distances
    return pd.DataFrame(table, index=names, columns=names)


def pair_distances(
    clips: Mapping[str, Clip],
    *,
    metric: str | ComparesFrames = POSITIONS,
    progress: Progress | None = None,
) -> pd.Series:
    """Return the clip distances of all pairs, as one column.

    Parameters
    ----------
    clips, metric, progress
        As in `pair_table`.

    Returns
    -------
    Series of pairs
        In the order of `itertools.combinations`.

    """
    asked = metric_named(metric)
    components = pair_components(clips, metric=asked, progress=progress)
    weights = asked.weights_for(list(components.columns))
    return pd.Series(components.to_numpy() @ weights, index=components.index, name="distance")


def pair_components(
    clips: Mapping[str, Clip],
    *,
    metric: str | ComparesFrames = POSITIONS,
    progress: Progress | None = None,
) -> pd.DataFrame:
    """Return for all pairs of clips how different each point is: the mean of F(d_k) (P8).

    A weighted sum of the columns is a clip distance, which makes them the X that weights are
    fitted to.

    Parameters
    ----------
    clips, progress
        As in `pair_table`.
    metric : FrameMetric or str
        Of which what is compared and F count; its weights do not.

    Returns
    -------
    DataFrame of pairs by points
        Pairs in the order of `itertools.combinations`.

    Examples
    --------
    >>> walks = {f"walk {seed}": ew.simulate_walk(seed=seed, rate_hz=60) for seed in (1, 2, 3)}
    >>> pair_components(walks).shape
    (3, 15)

    """
    asked = metric_named(metric)
    if len(clips) < 2:
        raise ValueError(f"Pairs need two clips or more; got {list(clips)}.")
    steps = _Steps(progress, len(clips))
    prepared = {name: steps.after(prepare(clip)) for name, clip in clips.items()}
    pairs = np.array(list(combinations(range(len(clips)), 2)))
    if still := [name for name, clip in prepared.items() if clip.cycle is None]:
        _tell_of_actions(still, prepared)
    if not still:
        values, points = _of_strides(list(prepared.values()), pairs, asked, steps)
    else:
        values, points = _of_actions(list(prepared.values()), pairs, asked, steps)
    index = pd.MultiIndex.from_tuples(combinations(clips, 2), names=["first", "second"])
    return pd.DataFrame(values, index=index, columns=points)


def _tell_of_actions(still: list[str], prepared: Mapping[str, PreparedClip]) -> None:
    """Warn where clips that repeat are compared like those that do not."""
    if len(still) < len(prepared):
        warnings.warn(
            f"All clips are compared from end to end, as {still[:6]} do not repeat: "
            f"{prepared[still[0]].complaint} Leave them out to compare strides.",
            stacklevel=3,
        )


class _Steps:
    """Tells how many clips and pairs are done."""

    def __init__(self, progress: Progress | None, n_clips: int) -> None:
        self._progress, self._done = progress, 0
        self._total = n_clips + n_clips * (n_clips - 1) // 2

    def forward(self, steps: int) -> None:
        self._done += steps
        if self._progress is not None:
            self._progress(self._done, self._total)

    def after(self, clip: PreparedClip) -> PreparedClip:
        self.forward(1)
        return clip


def _of_strides(
    clips: list[PreparedClip], pairs: np.ndarray, metric: ComparesFrames, steps: _Steps
) -> tuple[np.ndarray, list[str]]:
    """Components of all pairs of strides, each pair in an order that its contents decide."""
    cycles = [clip.cycle for clip in clips if clip.cycle is not None]
    names, compared = _stacked(cycles, metric.by)
    positions = compared if metric.by == "positions" else _stacked(cycles, "positions")[1]
    known = np.flatnonzero(np.isfinite(compared).all(axis=(0, 1, 3)))
    if not known.size:
        raise ValueError(f"Of the {metric.by} of {names} none is known throughout all clips.")
    compared = np.ascontiguousarray(compared[:, :, known])
    ordered = _in_order_of_contents([cycle.tobytes() for cycle in positions], pairs)
    parts = []
    for start in range(0, len(pairs), _AT_ONCE):
        found = register_pairs(positions, ordered[start : start + _AT_ONCE])
        parts.append(mean_distances(compared, found, metric))
        steps.forward(len(found.pairs))
    return np.concatenate(parts), [names[index] for index in known]


def _of_actions(
    clips: list[PreparedClip], pairs: np.ndarray, metric: ComparesFrames, steps: _Steps
) -> tuple[np.ndarray, list[str]]:
    """Components of all pairs of clips from beginning to end."""
    contents = [clip.clip.values.tobytes() for clip in clips]
    rows = []
    for first, second in _in_order_of_contents(contents, pairs):
        found = register(clips[first].clip, clips[second].clip)
        apart = found.distances(metric.by)
        means = shaped(metric, apart.to_numpy()).mean(axis=0)
        rows.append(dict(zip(apart.columns, means, strict=True)))
        steps.forward(1)
    table = pd.DataFrame(rows).dropna(axis=1)
    return table.to_numpy(), list(table.columns)


def _in_order_of_contents(contents: list[bytes], pairs: np.ndarray) -> np.ndarray:
    """Return pairs so turned that it does not matter which clip of a pair was named first."""
    rank = np.empty(len(contents), dtype=int)
    rank[sorted(range(len(contents)), key=contents.__getitem__)] = np.arange(len(contents))
    turned = rank[pairs[:, 0]] > rank[pairs[:, 1]]
    return np.where(turned[:, None], pairs[:, ::-1], pairs)


def _stacked(cycles: list[xr.DataArray], by: By) -> tuple[list[str], np.ndarray]:
    """Points that all cycles have, and their values of shape (cycle, frame, point, part)."""
    points = [points_of(cycle, by, periodic=True) for cycle in cycles]
    names = reduce(common_names, [each for each, _ in points])
    return names, np.stack([picked(*each, names) for each in points])
