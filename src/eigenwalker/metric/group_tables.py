"""The table that weights are fitted to: pairs of walks by joint groups (Pražák, eqs. 1 to 3)."""

from __future__ import annotations

from collections.abc import Mapping

import pandas as pd

from eigenwalker.folds import Progress
from eigenwalker.metric.clip_distances import pair_components
from eigenwalker.metric.frame_metrics import By, ComparesFrames
from eigenwalker.metric.groups import group_points
from eigenwalker.metric.prepared import Clip, prepare
from eigenwalker.metric.published import metric_named


def group_table(
    clips: Mapping[str, Clip], *metrics: str | ComparesFrames, progress: Progress | None = None
) -> pd.DataFrame:
    """Return how far each joint group of all pairs of walks is apart: the X of `PerceptualMetric`.

    Parameters
    ----------
    clips : mapping of str to DataArray or PreparedClip
        Walks by name, best from `comparable_walk`.
    *metrics : FrameMetric or str
        One or several, of which what is compared and F count; weights do not. With several, such
        as positions and velocities, the fit weighs these components too (P8).
    progress : callable, optional
        Called with the number of clips and pairs that are done, and of all, for each metric.

    Returns
    -------
    DataFrame of pairs by groups
        F(d_k) in the mean along the registered path, and of both sides. Pairs are in the order of
        `itertools.combinations`. Columns are groups (``"forearm"``), or with several metrics
        ``"positions forearm"``; groups that the walks lack are left out.

    Examples
    --------
    >>> walks = {str(seed): ew.simulate_walk(seed=seed, rate_hz=60) for seed in (1, 2, 3)}
    >>> X = group_table(walks, "positions-sigmoid", "velocities-absolute")
    >>> X.shape, X.columns[3], X.columns[-1]
    ((3, 16), 'positions forearm', 'velocities toe')

    """
    asked = [metric_named(metric) for metric in metrics]
    prepared = {name: prepare(clip) for name, clip in clips.items()}
    tables = []
    for metric in asked:
        table = by_group(pair_components(prepared, metric=metric, progress=progress), metric.by)
        tables.append(table if len(asked) == 1 else table.add_prefix(f"{metric.by} "))
    return pd.concat(tables, axis=1)


def by_group(points: pd.DataFrame, by: By) -> pd.DataFrame:
    """Return a table of joint groups from one of points.

    Parameters
    ----------
    points : DataFrame of pairs by points
        Mean F(d) of each point, as `pair_components` gives it.
    by : {"positions", "velocities", "angles"}
        What was compared.

    Returns
    -------
    DataFrame of pairs by groups
        Means over the points that stand for a group, both sides alike; groups that the points
        cannot tell are left out.

    Examples
    --------
    >>> points = pd.DataFrame({"left_knee": [10.0], "right_knee": [20.0], "head": [5.0]})
    >>> by_group(points, "positions").to_dict("records")
    [{'head': 5.0, 'calf': 15.0}]

    """
    groups = group_points([str(name) for name in points.columns], by)
    means = {group: points[list(names)].mean(axis=1) for group, names in groups.items()}
    return pd.DataFrame(means, index=points.index)
