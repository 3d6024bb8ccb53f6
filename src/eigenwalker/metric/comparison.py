"""Two walks compared: how different they are, in which parts of the body, by which metric."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from eigenwalker.metric.clip_distances import clip_components, pair_distances
from eigenwalker.metric.frame_metrics import By, ComparesFrames, FrameMetric
from eigenwalker.metric.group_tables import by_group
from eigenwalker.metric.groups import GROUPS, group_points
from eigenwalker.metric.prepared import (
    Clip,
    Clips,
    PreparedClip,
    on_mannequin,
    prepare_alike,
    registration_of,
)
from eigenwalker.metric.published import PUBLISHED, GroupMetric, metric_named
from eigenwalker.metric.registration import Registration

if TYPE_CHECKING:
    from eigenwalker.core.progress import Progress

PLAIN: Mapping[By, FrameMetric] = {
    by: FrameMetric(by=by) for by in ("positions", "velocities", "angles")
}
"""Mean distances in mm, mm/s and radians, all points alike."""


@dataclass(frozen=True, eq=False)
class Comparison:
    """How two walks differ.

    Parameters
    ----------
    a, b : PreparedClip
        The walks.
    metric : FrameMetric or GroupMetric
        By which they are compared.
    registration : Registration
        Which moments correspond: the path along which all here is measured.
    distance : float
        The mean of the metric along that path.
    shares : Series of groups
        How much each joint group makes of the distance; they sum to 1, and are NaN where it is 0.
    groups : DataFrame of groups by components
        How far each group is apart: ``positions_mm``, ``velocities_mm_s``, ``angles_deg``; NaN
        where it cannot be known. The mannequin has no clavicles (`group_points`).
    left_out : tuple of str
        Groups that the metric weighs and the walks do not show.

    """

    a: PreparedClip
    b: PreparedClip
    metric: ComparesFrames
    registration: Registration
    distance: float
    shares: pd.Series
    groups: pd.DataFrame
    left_out: tuple[str, ...]

    def __repr__(self) -> str:
        most = "none" if self.shares.isna().all() else self.shares.idxmax()
        return f"Comparison(distance {self.distance:.4g}, most by {most})"


def compare_walks(
    a: Clip, b: Clip, *, metric: str | ComparesFrames = "positions-sigmoid"
) -> Comparison:
    """Return how two walks differ.

    Parameters
    ----------
    a, b : DataArray of shape (time, marker, axis), or PreparedClip
        Walks of joints, best from `comparable_walk`.
    metric : str, FrameMetric or GroupMetric
        Left out, the metric that came nearest to observers in Pražák et al. (2010).

    Returns
    -------
    Comparison

    Examples
    --------
    A walk, and the same with the left hand held out:

    >>> walk = ew.simulate_walk(seed=1, rate_hz=60)
    >>> held_out = walk.copy()
    >>> held_out.loc[{"marker": "left_wrist", "axis": "y"}] += 150
    >>> found = compare_walks(walk, held_out, metric="kovar")
    >>> found.shares.idxmax(), found.groups.positions_mm.idxmax()
    ('hand', 'hand')

    """
    a, b = prepare_alike([a, b]).values()
    asked = metric_named(metric)
    components = clip_components(a, b, metric=asked)
    names = [str(name) for name in components.index]
    weighted = pd.Series(asked.weights_for(names) * components.to_numpy(), index=names)
    distance = float(weighted.sum())
    groups = group_points(names, asked.by)
    parts = pd.Series({group: weighted[list(points)].sum() for group, points in groups.items()})
    rest = distance - parts.sum()
    if rest > 1e-9 * max(distance, 1e-300):
        parts["other joints"] = rest
    return Comparison(
        a=a,
        b=b,
        metric=asked,
        registration=registration_of(a, b),
        distance=distance,
        shares=parts / distance if distance > 0 else parts * np.nan,
        groups=_apart(a, b),
        left_out=tuple(asked.left_out(names)) if isinstance(asked, GroupMetric) else (),
    )


def _apart(a: PreparedClip, b: PreparedClip) -> pd.DataFrame:
    columns = {"positions": "positions_mm", "velocities": "velocities_mm_s", "angles": "angles_deg"}
    table = {}
    for by, metric in PLAIN.items():
        points = clip_components(a, b, metric=metric).to_frame().T
        means = by_group(points, by, mannequin=on_mannequin([a, b])).iloc[0]
        table[columns[by]] = np.rad2deg(means) if by == "angles" else means
    found = pd.DataFrame(table)
    return found.loc[[group for group in GROUPS if group in found.index]]


def by_metric(
    clips: Clips,
    metrics: Sequence[str] = tuple(PUBLISHED),
    *,
    progress: Progress | None = None,
) -> pd.DataFrame:
    """Return the distances of all pairs by several published metrics.

    Parameters
    ----------
    clips : mapping of str to DataArray, Walker or PreparedClip, or sequence
        Two or more walks by name.
    metrics : sequence of str
        Names of published metrics; left out, all.
    progress : callable, optional
        Called with the number of metrics that are done, and of all.

    Returns
    -------
    DataFrame of pairs by metrics
        Of each with a scale of its own.

    """
    prepared = prepare_alike(clips)
    columns: dict[str, pd.Series] = {}
    for done, name in enumerate(metrics, start=1):
        columns[name] = pair_distances(prepared, metric=name)
        if progress is not None:
            progress(done, len(metrics))
    return pd.DataFrame(columns)


def share_nearer(distance: float, others: np.ndarray) -> float:
    """Return the share of other distances that are less; of equal ones, half.

    Examples
    --------
    >>> share_nearer(2.0, np.array([1.0, 2.0, 3.0, 4.0]))
    0.375

    """
    return float(np.mean(others < distance) + np.mean(others == distance) / 2)
