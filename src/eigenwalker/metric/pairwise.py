"""All pairs of many clips: their distances as a table, a column, or by points."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping, Sequence
from functools import reduce
from itertools import combinations

import numpy as np
import pandas as pd
import xarray as xr

from eigenwalker.core.progress import Progress, ticked
from eigenwalker.metric.clips import Clips, PreparedClip, check_clips
from eigenwalker.metric.cycles import mean_distances, register_pairs
from eigenwalker.metric.frame_metrics import POSITIONS, Metric, shaped
from eigenwalker.metric.joint_groups import By
from eigenwalker.metric.points import (
    common_names,
    content_ranks,
    match_rotations,
    points_of,
    select_points,
)
from eigenwalker.metric.prepared import prepare_together
from eigenwalker.metric.published import PUBLISHED, metric_named
from eigenwalker.metric.registration import register

_BATCH = 4096
"""Pairs whose paths are in memory at a time."""


def pair_table(
    clips: Clips, *, metric: str | Metric = POSITIONS, progress: Progress | None = None
) -> pd.DataFrame:
    """Return the clip distances of all pairs as a square table.

    Parameters
    ----------
    clips : mapping of str to clip, or sequence of clips
        Two or more clips (DataArray of shape (time, marker, axis), Walker, Loop or PreparedClip) by
        name, or in order, such as ``population.walkers``. The points that all have are compared. If
        one clip does not repeat, all are registered from end to end.
    metric : str, FrameMetric or GroupMetric
        What is compared and how, or the name of a published metric (`PUBLISHED`); left out, the
        mean Euclidean distance of positions in mm, all points with the same weight.
    progress : callable, optional
        Called with the number of clips and pairs that are done, and of all.

    Returns
    -------
    DataFrame of clips by clips
        In the unit of the metric; symmetric, 0 on the diagonal.

    See Also
    --------
    pair_components, group_table : The same by points and joint groups.
    nearest_walks, label_table : Which walks are near to each other.

    References
    ----------
    Pražák et al. (2010), section 4 and fig. 4.

    Examples
    --------
    >>> walks = {f"walk {seed}": ew.simulate_walk(seed=seed, rate_hz=60) for seed in (1, 2, 3)}
    >>> table = pair_table(walks)
    >>> table.shape, bool((table == table.T).all(axis=None))
    ((3, 3), True)
    """
    distances = pair_distances(clips, metric=metric, progress=progress)
    names = list(dict.fromkeys(name for pair in distances.index for name in pair))
    table = np.zeros((len(names), len(names)))
    rows, columns = np.triu_indices(len(names), 1)
    table[rows, columns] = table[columns, rows] = distances
    return pd.DataFrame(table, index=names, columns=names)


def pair_distances(
    clips: Clips, *, metric: str | Metric = POSITIONS, progress: Progress | None = None
) -> pd.Series:
    """Return the clip distances of all pairs as one column.

    Parameters
    ----------
    clips : mapping of str to clip, or sequence of clips
        Two or more clips (DataArray of shape (time, marker, axis) in mm, Walker, Loop or
        PreparedClip), by name or in order. The points that all have are compared.
    metric : str, FrameMetric or GroupMetric
        What is compared and how, or the name of a published metric (`PUBLISHED`); left out, the
        mean Euclidean distance of positions in mm, all points with the same weight.
    progress : callable, optional
        Called with the number of clips and pairs that are done, and of all.

    Returns
    -------
    Series of pairs
        In the unit of the metric: the mean of D along the path on which two clips are registered;
        pairs of names in the order of `itertools.combinations`.

    See Also
    --------
    pair_table : The same as a square.
    clip_distance : One pair, and what is computed.

    References
    ----------
    Pražák et al. (2010), section 2 and eqs. 1 to 3.

    Examples
    --------
    >>> walks = {name: ew.simulate_walk(seed=len(name), rate_hz=60) for name in ("a", "bb", "ccc")}
    >>> pair_distances(walks).index.to_list()
    [('a', 'bb'), ('a', 'ccc'), ('bb', 'ccc')]
    """
    metric = metric_named(metric)
    components = pair_components(clips, metric=metric, progress=progress)
    weights = metric.weights_for(list(components.columns))
    return pd.Series(components.to_numpy() @ weights, index=components.index, name="distance")


def distances_by_metric(
    clips: Clips,
    metrics: Sequence[str] = tuple(PUBLISHED),
    *,
    progress: Progress | None = None,
) -> pd.DataFrame:
    """Return the clip distances of all pairs by several published metrics.

    Parameters
    ----------
    clips : mapping of str to clip, or sequence of clips
        Two or more clips (DataArray of shape (time, marker, axis) in mm, Walker, Loop or
        PreparedClip), by name or in order. The points that all have are compared.
    metrics : sequence of str
        Names in `PUBLISHED`; left out, all.
    progress : callable, optional
        Called with the number of metrics that are done, and of all.

    Returns
    -------
    DataFrame of pairs by metrics
        Each in its own unit: compare columns by their ranks. Pairs of names in the order of
        `itertools.combinations`.

    See Also
    --------
    pair_distances : One metric, also of one's own.
    PUBLISHED : The metrics, with their papers.

    References
    ----------
    Pražák et al. (2010), section 5, which compares such metrics with observers.

    Examples
    --------
    >>> walks = [ew.simulate_walk(seed=seed, rate_hz=60) for seed in (1, 2)]
    >>> distances_by_metric(walks, ["kovar", "lee"]).columns.to_list()
    ['kovar', 'lee']
    """
    prepared = prepare_together(clips)
    names = ticked(metrics, len(metrics), progress)
    return pd.DataFrame({name: pair_distances(prepared, metric=name) for name in names})


def pair_components(
    clips: Clips, *, metric: str | Metric = POSITIONS, progress: Progress | None = None
) -> pd.DataFrame:
    r"""Return the distance of all pairs of clips for each point: the mean of F(d_k).

    A clip distance is a weighted sum of the columns,
    :math:`d(a, b) = \sum_k w_k \overline{F(d_k)}`.

    Parameters
    ----------
    clips : mapping of str to clip, or sequence of clips
        Two or more clips (DataArray of shape (time, marker, axis) in mm, Walker, Loop or
        PreparedClip), by name or in order. The points that all have are compared.
    metric : str, FrameMetric or GroupMetric
        What is compared and how (F), or the name of a published metric (`PUBLISHED`); its weights
        are not used. Left out, positions in mm.
    progress : callable, optional
        Called with the number of clips and pairs that are done, and of all.

    Returns
    -------
    DataFrame of pairs by points
        In the unit of F(d). Pairs of names in the order of `itertools.combinations`; points that
        are known in all clips.

    See Also
    --------
    pair_distances : With the weights.
    group_table : By joint groups.

    References
    ----------
    Pražák et al. (2010), eqs. 1 to 3.

    Examples
    --------
    >>> walks = {f"walk {seed}": ew.simulate_walk(seed=seed, rate_hz=60) for seed in (1, 2, 3)}
    >>> pair_components(walks).shape
    (3, 15)
    """
    if len(check_clips(clips)) < 2:
        raise ValueError(f"Pairs need two clips or more; got {len(clips)}.")
    n_steps = len(clips) + len(clips) * (len(clips) - 1) // 2
    n_done = 0

    def done(steps: int = 1) -> None:
        nonlocal n_done
        n_done += steps
        if progress is not None:
            progress(n_done, n_steps)

    prepared = prepare_together(clips, done=done)
    not_periodic = [name for name, clip in prepared.items() if clip.cycle is None]
    if not_periodic:
        _warn_of_actions(not_periodic, prepared)
    components = _components_of_actions if not_periodic else _components_of_strides
    pairs = np.array(list(combinations(range(len(prepared)), 2)))
    values, points = components(list(prepared.values()), pairs, metric_named(metric), done)
    index = pd.MultiIndex.from_tuples(combinations(prepared, 2), names=["first", "second"])
    return pd.DataFrame(values, index=index, columns=points)


def _warn_of_actions(not_periodic: list[str], prepared: Mapping[str, PreparedClip]) -> None:
    rest = len(prepared) - len(not_periodic)
    advice = "Leave them out to compare strides." if rest >= 2 else "No strides are compared."
    warnings.warn(
        f"All clips are compared from end to end, as {not_periodic[:6]} do not repeat: "
        f"{prepared[not_periodic[0]].not_periodic_reason} {advice}",
        stacklevel=3,
    )


def _components_of_strides(
    clips: list[PreparedClip], pairs: np.ndarray, metric: Metric, done: Callable[[int], None]
) -> tuple[np.ndarray, list[str]]:
    cycles = [clip.cycle for clip in clips if clip.cycle is not None]
    names, compared = _stacked(cycles, metric.by)
    positions = compared if metric.by == "positions" else _stacked(cycles, "positions")[1]
    known = np.flatnonzero(np.isfinite(compared).all(axis=(0, 1, 3)))
    if not known.size:
        raise ValueError(f"Of the {metric.by} of {names} none is known throughout all clips.")
    compared = np.ascontiguousarray(compared[:, :, known])
    ordered = _ordered_pairs(list(positions), pairs)
    means = []
    for start in range(0, len(pairs), _BATCH):
        registered = register_pairs(positions, ordered[start : start + _BATCH])
        means.append(mean_distances(compared, registered, metric))
        done(len(registered.pairs))
    return np.concatenate(means), [names[index] for index in known]


def _components_of_actions(
    clips: list[PreparedClip], pairs: np.ndarray, metric: Metric, done: Callable[[int], None]
) -> tuple[np.ndarray, list[str]]:
    rows = []
    for first, second in _ordered_pairs([clip.clip.values for clip in clips], pairs):
        distances = register(clips[first].clip, clips[second].clip).distances(metric.by)
        means = shaped(metric, distances.to_numpy()).mean(axis=0)
        rows.append(dict(zip(distances.columns, means, strict=True)))
        done(1)
    table = pd.DataFrame(rows).dropna(axis=1)
    return table.to_numpy(), list(table.columns)


def _ordered_pairs(clips: Sequence[np.ndarray], pairs: np.ndarray) -> np.ndarray:
    """Return pairs with the clip of lower rank first, so that distances are symmetric."""
    ranks = content_ranks(clips)[pairs]
    return np.where((ranks[:, 0] > ranks[:, 1])[:, None], pairs[:, ::-1], pairs)


def _stacked(cycles: list[xr.DataArray], by: By) -> tuple[list[str], np.ndarray]:
    """Return the common points of all cycles, and values of shape (cycle, frame, point, part)."""
    points = [points_of(cycle, by, periodic=True) for cycle in match_rotations(cycles)]
    names = reduce(common_names, [each for each, _ in points])
    return names, np.stack([select_points(*each, names) for each in points])
