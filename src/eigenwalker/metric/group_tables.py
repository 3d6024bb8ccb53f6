"""The table that weights are fitted to: pairs of walks by joint groups (Pražák, eqs. 1 to 3)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from eigenwalker.metric.clip_distances import pair_components
from eigenwalker.metric.frame_metrics import By, ComparesFrames
from eigenwalker.metric.groups import GROUPS, group_points
from eigenwalker.metric.prepared import Clips, on_mannequin, prepare_alike
from eigenwalker.metric.published import metric_named

if TYPE_CHECKING:
    from eigenwalker.core.progress import Progress

ALIKE = 0.95
"""Correlation above which two columns of a table can hardly be told apart by a fit."""


def group_table(
    clips: Clips, *metrics: str | ComparesFrames, progress: Progress | None = None
) -> pd.DataFrame:
    """Return how far each joint group of all pairs of walks is apart: the X of `PerceptualMetric`.

    Parameters
    ----------
    clips : mapping of str to DataArray, Walker or PreparedClip, or sequence
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
        ``"positions forearm"``; ``attrs["left_out"]`` names those of groups that the walks do not
        show, among them the clavicles of the mannequin, whose shoulders sit on its sternum.
        ``attrs["alike"]`` lists columns that correlate above `ALIKE`, as (column, column,
        correlation): a fit can give the weight of one to the other, and knows only their sum.

    Examples
    --------
    >>> walks = {str(seed): ew.simulate_walk(seed=seed, rate_hz=60) for seed in (1, 2, 3)}
    >>> X = group_table(walks, "positions-sigmoid", "velocities-absolute")
    >>> X.shape, X.columns[3], X.columns[-1]
    ((3, 16), 'positions forearm', 'velocities toe')
    >>> neutral = {name: ew.metric.retarget(walk) for name, walk in walks.items()}
    >>> group_table(neutral, "positions-absolute").attrs["left_out"]
    ['clavicle']

    """
    if not metrics:
        raise ValueError("Name what to compare by: group_table(clips, 'positions-sigmoid').")
    asked = [metric_named(metric) for metric in metrics]
    prepared = prepare_alike(clips)
    mannequin = on_mannequin(prepared.values())
    tables, left_out = [], []
    for metric in asked:
        points = pair_components(prepared, metric=metric, progress=progress)
        table = by_group(points, metric.by, mannequin=mannequin)
        prefix = "" if len(asked) == 1 else f"{metric.by} "
        left_out += [prefix + group for group in GROUPS if group not in table]
        tables.append(table.add_prefix(prefix))
    found = pd.concat(tables, axis=1)
    found.attrs = {"left_out": left_out, "alike": _alike(found)}
    return found


def _alike(table: pd.DataFrame) -> list[tuple[str, str, float]]:
    """Return pairs of columns that correlate above `ALIKE`; of fewer than three rows, none."""
    varied = table.loc[:, np.ptp(table.to_numpy(), axis=0) > 0]
    if len(varied) < 3 or varied.shape[1] < 2:
        return []
    together = np.corrcoef(varied.to_numpy(), rowvar=False)
    rows, columns = np.nonzero(np.triu(together > ALIKE, 1))
    names = [str(name) for name in varied]
    return [
        (names[row], names[column], float(together[row, column]))
        for row, column in zip(rows, columns, strict=True)
    ]


def by_group(points: pd.DataFrame, by: By, *, mannequin: bool = False) -> pd.DataFrame:
    """Return a table of joint groups from one of points.

    Parameters
    ----------
    points : DataFrame of pairs by points
        Mean F(d) of each point, as `pair_components` gives it.
    by : {"positions", "velocities", "angles"}
        What was compared.
    mannequin : bool
        As in `group_points`.

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
    groups = group_points([str(name) for name in points.columns], by, mannequin=mannequin)
    means = {group: points[list(names)].mean(axis=1) for group, names in groups.items()}
    return pd.DataFrame(means, index=points.index)
