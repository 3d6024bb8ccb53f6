"""How different two clips are, and all pairs of many (P4)."""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from eigenwalker.metric.frame_metrics import POSITIONS, By, ComparesFrames
from eigenwalker.metric.pairwise import compared_pairs
from eigenwalker.metric.prepared import (
    Clip as Clip,
    Clips,
    PreparedClip as PreparedClip,
    prepare as prepare,
    prepare_alike,
    registration_of as registration_of,
)
from eigenwalker.metric.published import metric_named

if TYPE_CHECKING:
    from eigenwalker.core.progress import Progress


def clip_distance(a: Clip, b: Clip, *, metric: str | ComparesFrames = POSITIONS) -> float:
    """Return how different two clips are: the mean frame distance along their registered path.

    As Pražák et al. (2010) compare walks (P4). Walks are brought in place and looped, their strides
    registered in phase, heading and place (`register_walks`), so it does not matter where and when
    a walk begins. If one of the clips does not repeat, both are registered from end to end
    (`register`). The path is always that of positions; the metric is averaged along it.

    Parameters
    ----------
    a, b : DataArray of shape (time, marker, axis), Walker or PreparedClip
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
    a, b : DataArray of shape (time, marker, axis), Walker or PreparedClip
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
    a, b : DataArray of shape (time, marker, axis), Walker or PreparedClip
    by : {"positions", "velocities", "angles"}
        In mm, mm/s or radians.

    Returns
    -------
    DataFrame of steps by points

    Examples
    --------
    >>> walk, other = (ew.simulate_walk(seed=seed, rate_hz=60) for seed in (1, 2))
    >>> float(step_distances(walk, other)["left_ankle"].max().round()) > 50
    True

    """
    return registration_of(*prepare_alike([a, b]).values()).distances(by)


def pair_table(
    clips: Clips,
    *,
    metric: str | ComparesFrames = POSITIONS,
    progress: Progress | None = None,
) -> pd.DataFrame:
    """Return the clip distances of all pairs.

    Parameters
    ----------
    clips : mapping of str to DataArray, Walker or PreparedClip, or sequence
        Two or more clips by name, or such as ``population.walkers`` in order. Points are compared
        that all have, and if one clip does not repeat, all are registered from end to end, so that
        distances mean the same throughout.
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
    distances = pair_distances(clips, metric=metric, progress=progress)
    names = list(dict.fromkeys(name for pair in distances.index for name in pair))
    table = np.zeros((len(names), len(names)))
    rows, columns = np.triu_indices(len(names), 1)
    table[rows, columns] = table[columns, rows] = distances
    return pd.DataFrame(table, index=names, columns=names)


def pair_distances(
    clips: Clips,
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

    Examples
    --------
    >>> walks = {name: ew.simulate_walk(seed=len(name), rate_hz=60) for name in ("a", "bb", "ccc")}
    >>> pair_distances(walks).index.to_list()
    [('a', 'bb'), ('a', 'ccc'), ('bb', 'ccc')]

    """
    asked = metric_named(metric)
    components = pair_components(clips, metric=asked, progress=progress)
    weights = asked.weights_for(list(components.columns))
    return pd.Series(components.to_numpy() @ weights, index=components.index, name="distance")


def pair_components(
    clips: Clips,
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
    names, values, points = compared_pairs(clips, metric_named(metric), progress)
    index = pd.MultiIndex.from_tuples(combinations(names, 2), names=["first", "second"])
    return pd.DataFrame(values, index=index, columns=points)
