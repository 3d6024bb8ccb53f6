"""The table that weights are fitted to: pairs of walks by joint groups (Pražák et al. 2010)."""

from __future__ import annotations

import numpy as np
import pandas as pd

from eigenwalker.core.arguments import check_kind
from eigenwalker.core.progress import Progress
from eigenwalker.metric.clips import Clips
from eigenwalker.metric.frame_metrics import Metric
from eigenwalker.metric.joint_groups import GROUPS, group_means
from eigenwalker.metric.pairwise import pair_components
from eigenwalker.metric.prepared import prepare_together
from eigenwalker.metric.published import metric_named
from eigenwalker.metric.retargeting import is_mannequin

COLLINEAR = 0.95
"""Correlation above which a fit can hardly separate the weights of two columns."""


def group_table(
    clips: Clips, *metrics: str | Metric, progress: Progress | None = None
) -> pd.DataFrame:
    """Return the distance of all pairs of walks by joint groups: the X of `PerceptualMetric`.

    Parameters
    ----------
    clips : mapping of str to clip, or sequence of clips
        Two or more walks, best from `prepare_walk` (else DataArray of shape (time, marker, axis) in
        mm, Walker or Loop), by name or in order. The points that all have are compared.
    *metrics : str, FrameMetric or GroupMetric
        One or several; their weights are not used. With several, such as positions and velocities,
        a fit weighs these components too.
    progress : callable, optional
        Called with the number of clips and pairs that are done, and of all.

    Returns
    -------
    DataFrame of pairs by groups
        Mean of F(d_k) along the registered path and over both sides; pairs in the order of
        `itertools.combinations`. Columns are groups (``"forearm"``), or with several metrics
        ``"positions forearm"``. Groups without points are left out, among them the clavicles of
        the mannequin, whose shoulders are fixed to its sternum.

    See Also
    --------
    pair_components : The same by points.
    missing_groups : What the table lacks.

    References
    ----------
    Pražák et al. (2010), eqs. 1 to 3 and section 5.

    Examples
    --------
    >>> walks = {str(seed): ew.simulate_walk(seed=seed, rate_hz=60) for seed in (1, 2, 3)}
    >>> X = group_table(walks, "positions-sigmoid", "velocities-absolute")
    >>> X.shape, X.columns[3], X.columns[-1]
    ((3, 16), 'positions forearm', 'velocities toe')
    """
    if not metrics:
        raise ValueError("Name what to compare by: group_table(clips, 'positions-sigmoid').")
    prepared = prepare_together(clips)
    mannequin = any(is_mannequin(clip.clip) for clip in prepared.values())
    tables = []
    for metric in map(metric_named, metrics):
        points = pair_components(prepared, metric=metric, progress=progress)
        table = group_means(points, metric.by, mannequin=mannequin)
        tables.append(table.add_prefix("" if len(metrics) == 1 else f"{metric.by} "))
    return pd.concat(tables, axis=1)


def missing_groups(table: pd.DataFrame) -> list[str]:
    """Return the joint groups that a table of groups lacks, named like its columns.

    Parameters
    ----------
    table : DataFrame of pairs by groups
        From `group_table`.

    Returns
    -------
    list of str

    See Also
    --------
    group_table : Makes the table.

    Examples
    --------
    >>> missing_groups(pd.DataFrame(columns=[group for group in GROUPS if group != "toe"]))
    ['toe']
    """
    check_kind(table, pd.DataFrame, "a table of pairs by groups, as group_table() returns it")
    prefixes = dict.fromkeys(str(name).rpartition(" ")[0] for name in table.columns)
    names = [f"{prefix} {group}".strip() for prefix in prefixes for group in GROUPS]
    return [name for name in names if name not in table.columns]


def collinear_groups(table: pd.DataFrame) -> pd.DataFrame:
    """Return pairs of columns so alike that a fit hardly tells their two weights apart.

    Parameters
    ----------
    table : DataFrame of pairs by groups
        From `group_table`, of three pairs or more.

    Returns
    -------
    DataFrame
        Columns ``first``, ``second`` and ``correlation`` (Pearson, over pairs of walks), where that
        is above 0.95 (`COLLINEAR`).

    See Also
    --------
    eigenwalker.psychophysics.bootstrap_weights : Intervals of the weights.

    Examples
    --------
    >>> table = pd.DataFrame({"thigh": [1.0, 2, 3], "calf": [2.0, 4, 6], "toe": [5.0, 1, 2]})
    >>> collinear_groups(table).round(6).values.tolist()
    [['thigh', 'calf', 1.0]]
    """
    check_kind(table, pd.DataFrame, "a table of pairs by groups, as group_table() returns it")
    if not len(table):
        raise ValueError("The table has no pairs.")
    varied = table.loc[:, np.ptp(table.to_numpy(), axis=0) > 0]
    rows: list[tuple[str, str, float]] = []
    if len(varied) >= 3 and varied.shape[1] >= 2:
        correlations = np.corrcoef(varied.to_numpy(), rowvar=False)
        rows = [
            (str(varied.columns[i]), str(varied.columns[j]), float(correlations[i, j]))
            for i, j in np.argwhere(np.triu(correlations > COLLINEAR, 1))
        ]
    return pd.DataFrame(rows, columns=["first", "second", "correlation"])
