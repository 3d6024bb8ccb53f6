"""The distance between two clips: as a number, by points, by steps and by joint groups."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd

from eigenwalker.metric.clips import Clip, PreparedClip
from eigenwalker.metric.frame_metrics import POSITIONS, FrameMetric, GroupMetric, Metric
from eigenwalker.metric.joint_groups import GROUPS, By, group_means, group_points
from eigenwalker.metric.pairwise import pair_components, pair_distances
from eigenwalker.metric.prepared import prepare_together
from eigenwalker.metric.published import metric_named
from eigenwalker.metric.registration import Registration, register_prepared
from eigenwalker.metric.retargeting import is_mannequin


def clip_distance(a: Clip, b: Clip, *, metric: str | Metric = POSITIONS) -> float:
    r"""Return the distance between two clips: the mean frame distance along their registered path.

    .. math:: d(a, b) = \frac{1}{|P|} \sum_{(i, j) \in P} D(i, j)

    with D the metric (`FrameMetric`). Walks are brought in place and looped, and their strides
    registered in phase, heading and place (`register_walks`), so that it does not matter where and
    when a walk begins. If a clip does not repeat, both are registered from end to end (`register`).
    The path P is always that of positions.

    Parameters
    ----------
    a, b : DataArray of shape (time, marker, axis), Walker, Loop or PreparedClip
        Clips, of which the points that both have are compared.
    metric : str, FrameMetric or GroupMetric
        What is compared and how, or the name of a published metric; left out, the mean Euclidean
        distance of positions in mm, all points with the same weight.

    Returns
    -------
    float
        In the unit of the metric; 0 for a clip and itself; symmetric.

    Raises
    ------
    ValueError
        If the clips have no points in common, or lack what the metric needs.

    See Also
    --------
    clip_components, compare_walks : Where the clips differ.
    pair_table : All pairs of many clips.

    References
    ----------
    Pražák et al. (2010), section 2 and eqs. 1 to 3.

    Examples
    --------
    >>> walk, other = (ew.simulate_walk(seed=seed, rate_hz=60) for seed in (1, 2))
    >>> clip_distance(walk, other) == clip_distance(other, walk) > 20
    True
    """
    return float(pair_distances({"a": a, "b": b}, metric=metric).iloc[0])


def clip_components(a: Clip, b: Clip, *, metric: str | Metric = POSITIONS) -> pd.Series:
    """Return the distance between two clips for each point: the mean of F(d_k) along their path.

    Parameters
    ----------
    a, b : DataArray of shape (time, marker, axis) in mm, Walker, Loop or PreparedClip
        Clips, of which the points that both have are compared.
    metric : str, FrameMetric or GroupMetric
        What is compared and how (F), or the name of a published metric (`PUBLISHED`); its weights
        are not used. Left out, positions in mm.

    Returns
    -------
    Series of points
        In the unit of F(d): the clip distance is the sum of these times the weights.

    See Also
    --------
    clip_distance : The sum.
    step_distances : Each moment.

    References
    ----------
    Pražák et al. (2010), eqs. 1 to 3.

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
    """Return the distance between two clips for each point and each step of their path.

    Parameters
    ----------
    a, b : DataArray of shape (time, marker, axis) in mm, Walker, Loop or PreparedClip
        Clips, of which the points that both have are compared.
    by : {"positions", "velocities", "angles"}
        What is compared.

    Returns
    -------
    DataFrame of steps by points
        Distance d_k in mm, mm/s or radians at each step (i, j) of the path on which the clips are
        registered, always by their positions.

    See Also
    --------
    clip_components : The means over the path.
    motion_map : All frames with all.

    References
    ----------
    Pražák et al. (2010), section 2 and eqs. 1 to 3.

    Examples
    --------
    >>> walk, other = (ew.simulate_walk(seed=seed, rate_hz=60) for seed in (1, 2))
    >>> float(step_distances(walk, other)["left_ankle"].max().round()) > 50
    True
    """
    return register_prepared(*prepare_together([a, b]).values()).distances(by)


PLAIN: Mapping[By, FrameMetric] = {
    by: FrameMetric(by=by) for by in ("positions", "velocities", "angles")
}
"""Mean distances in mm, mm/s and radians, all points with the same weight."""


@dataclass(frozen=True, eq=False)
class Comparison:
    """How two walks differ.

    Parameters
    ----------
    a, b : PreparedClip
        The walks.
    metric : FrameMetric or GroupMetric
    registration : Registration
        Corresponding moments: the path along which everything here is measured.
    distance : float
        Mean of the metric along that path.
    shares : Series of groups
        Share of each joint group in the distance; they sum to 1, and are NaN where it is 0.
    groups : DataFrame of groups by components
        Distance of each group: ``positions_mm``, ``velocities_mm_s``, ``angles_deg``; NaN where it
        is unknown. The mannequin has no clavicles (`group_points`).
    missing_groups : tuple of str
        Groups with a weight in the metric and no points in the walks.

    See Also
    --------
    compare_walks : makes it.
    """

    a: PreparedClip
    b: PreparedClip
    metric: Metric
    registration: Registration
    distance: float
    shares: pd.Series
    groups: pd.DataFrame
    missing_groups: tuple[str, ...]

    def _repr_html_(self) -> str:
        """The distance, and a table of joint groups, for notebooks."""
        table = self.groups.assign(share=self.shares.reindex(self.groups.index))
        html = table.to_html(escape=True, float_format="{:.3g}".format, na_rep="")
        return f"<p>Distance {self.distance:.4g}</p>{html}"

    def __repr__(self) -> str:
        most = "none" if self.shares.isna().all() else self.shares.idxmax()
        return f"Comparison(distance {self.distance:.4g}, most by {most})"


def compare_walks(a: Clip, b: Clip, *, metric: str | Metric = "positions-sigmoid") -> Comparison:
    r"""Return how two walks differ: how much, and in which joint groups.

    The share of a group g in the distance is
    :math:`\sum_{k \in g} w_k \overline{F(d_k)} \,/\, \sum_k w_k \overline{F(d_k)}`, with means
    along the path of `clip_distance`.

    Parameters
    ----------
    a, b : DataArray of shape (time, marker, axis), Walker, Loop or PreparedClip
        Walks of joints, best from `prepare_walk`.
    metric : str, FrameMetric or GroupMetric
        Left out, the metric that predicted observers best in Pražák et al. (2010).

    Returns
    -------
    Comparison

    See Also
    --------
    clip_distance : The distance alone.
    prepare_walk : Makes a walk of a capture.

    References
    ----------
    Pražák et al. (2010), eqs. 1 to 3 and fig. 5.

    Examples
    --------
    A walk, and the same with the left hand held out:

    >>> walk = ew.simulate_walk(seed=1, rate_hz=60)
    >>> held_out = walk.copy()
    >>> held_out.loc[{"marker": "left_wrist", "axis": "y"}] += 150
    >>> comparison = compare_walks(walk, held_out, metric="kovar")
    >>> comparison.shares.idxmax(), comparison.groups.positions_mm.idxmax()
    ('hand', 'hand')
    """
    a, b = prepare_together([a, b]).values()
    metric = metric_named(metric)
    components = clip_components(a, b, metric=metric)
    names = [str(name) for name in components.index]
    weighted = pd.Series(metric.weights_for(names) * components.to_numpy(), index=names)
    distance = float(weighted.sum())
    groups = group_points(names, metric.by)
    parts = pd.Series({group: weighted[list(points)].sum() for group, points in groups.items()})
    rest = distance - parts.sum()
    if rest > 1e-9 * max(distance, 1e-300):
        parts["other joints"] = rest
    return Comparison(
        a=a,
        b=b,
        metric=metric,
        registration=register_prepared(a, b),
        distance=distance,
        shares=parts / distance if distance > 0 else parts * np.nan,
        groups=_group_distances(a, b),
        missing_groups=(
            tuple(metric.missing_groups(names)) if isinstance(metric, GroupMetric) else ()
        ),
    )


def _group_distances(a: PreparedClip, b: PreparedClip) -> pd.DataFrame:
    columns = {"positions": "positions_mm", "velocities": "velocities_mm_s", "angles": "angles_deg"}
    mannequin = is_mannequin(a.clip) or is_mannequin(b.clip)
    table = {}
    for by, metric in PLAIN.items():
        points = clip_components(a, b, metric=metric).to_frame().T
        means = group_means(points, by, mannequin=mannequin).iloc[0]
        table[columns[by]] = np.rad2deg(means) if by == "angles" else means
    groups = pd.DataFrame(table)
    return groups.loc[[group for group in GROUPS if group in groups.index]]
