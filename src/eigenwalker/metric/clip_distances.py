"""The distance between two clips, as a number, by points, and by steps of the stride."""

from __future__ import annotations

import pandas as pd

from eigenwalker.metric.clips import Clip
from eigenwalker.metric.frame_metrics import POSITIONS, Metric
from eigenwalker.metric.joint_groups import By
from eigenwalker.metric.pairwise import pair_components, pair_distances
from eigenwalker.metric.prepared import prepare_together
from eigenwalker.metric.registration import register_prepared


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
    a, b, metric
        As in `clip_distance`; the weights of the metric are not used.

    Returns
    -------
    Series of points
        In the unit of F(d).

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
    a, b
        As in `clip_distance`.
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
    return register_prepared(*prepare_together([a, b]).values()).distances(by)
