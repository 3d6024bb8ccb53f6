"""References for a difference: pairs of simulated people, and a walk compared with itself."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import pandas as pd
from scipy.stats import percentileofscore

from eigenwalker.core.progress import Progress, ticked
from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.trajectories import sampling_rate
from eigenwalker.datasets.built_in import load_population
from eigenwalker.metric.clip_distances import Comparison, clip_distance
from eigenwalker.metric.clips import PreparedClip
from eigenwalker.metric.frame_metrics import GroupMetric
from eigenwalker.metric.loops import loop
from eigenwalker.metric.pairwise import pair_distances
from eigenwalker.metric.prepared import prepare
from eigenwalker.study.walks import walks_of_population, without_rotations


@dataclass(frozen=True, eq=False)
class ReferenceComparison:
    """A comparison of two walks, with reference distances.

    ``self_distances`` tell how far each walk is from itself (`self_distance`). The rows of
    ``by_metric`` are metrics; its columns are the ``distance`` of the two walks; ``by_joints``, the
    same by the 15 joints alone, and ``share_nearer``, the share of pairs of ``n_people`` simulated
    people that differ less: both NaN by angles, and for walks that do not differ.

    See Also
    --------
    compare_with_references : makes it.
    """

    comparison: Comparison
    self_distances: tuple[float, float]
    by_metric: pd.DataFrame
    n_people: int

    def _repr_html_(self) -> str:
        """The comparison, and a table of metrics, for notebooks."""
        table = self.by_metric.to_html(escape=True, float_format="{:.3g}".format, na_rep="")
        return f"{self.comparison._repr_html_()}{table}"


def compare_with_references(
    comparison: Comparison,
    metrics: Sequence[GroupMetric],
    *,
    mannequin: bool = True,
    progress: Progress | None = None,
) -> ReferenceComparison:
    """Return a comparison with two references: simulated people, and each walk and itself.

    Simulated people have no hands, feet and clavicles, so these are left out when walks are
    compared with them. Metrics of joint angles are not compared with simulated people:
    angles depend on whether a capture holds joints, as simulated ones do, or points on the skin.

    Parameters
    ----------
    comparison : Comparison
        Of two walks in mm, prepared (`compare_walks`).
    metrics : sequence of GroupMetric
        By which; that of the comparison is among them.
    mannequin : bool
        Whether the walks are shown on the neutral mannequin, and simulated people are to be.
    progress : callable, optional
        Called with the number of metrics that are done, and of all.

    Returns
    -------
    ReferenceComparison

    See Also
    --------
    self_distance, simulated_distances : The two references.

    Examples
    --------
    >>> a, b = (ew.metric.prepare_walk(ew.simulate_walk(seed=seed)) for seed in (1, 2))
    >>> comparison = ew.metric.compare_walks(a, b)
    >>> metrics = [ew.metric.PUBLISHED["positions-sigmoid"]]
    >>> result = compare_with_references(comparison, metrics)
    >>> 0 < result.by_metric.share_nearer.item() < 1, max(result.self_distances) < 0.001
    (True, True)
    """
    pairs = simulated_distances(metrics, mannequin=mannequin, progress=progress)
    a, b = comparison.a, comparison.b
    bare_a, bare_b = (_joints_alone(clip) for clip in (a, b))
    rows = {}
    for metric in metrics:
        by_joints = share = np.nan
        if metric.name in pairs:
            distance = clip_distance(bare_a, bare_b, metric=metric)
            if distance > 0:
                by_joints = distance
                share = percentileofscore(pairs[metric.name], distance, kind="mean") / 100
        rows[metric.name] = {
            "distance": clip_distance(a, b, metric=metric),
            "by_joints": by_joints,
            "share_nearer": share,
        }
    metric = comparison.metric
    own = (np.nan, np.nan)
    if isinstance(metric, GroupMetric) and comparison.distance > 0:
        own = (self_distance(a, metric=metric), self_distance(b, metric=metric))
    table = pd.DataFrame.from_dict(rows, orient="index")
    return ReferenceComparison(comparison, own, table, len(_simulated_people(mannequin)))


def simulated_distances(
    metrics: Sequence[GroupMetric], *, mannequin: bool = True, progress: Progress | None = None
) -> pd.DataFrame:
    """Return the distances of all pairs of the built-in, simulated people.

    They tell how different people are who all walk at their own pace; as they are simulated, it is
    no norm.

    Parameters
    ----------
    metrics : sequence of GroupMetric
        By which; those of angles are left out.
    mannequin : bool
        Whether to bring them to the neutral mannequin (`retarget`).
    progress : callable, optional
        Called with the number of metrics that are done, and of all.

    Returns
    -------
    DataFrame of pairs by metrics
        Each in the metric's own unit; pairs of names in the order of `itertools.combinations`.

    See Also
    --------
    compare_with_references : Two walks beside these.
    pair_distances : The same of any walks.

    References
    ----------
    Pražák et al. (2010), eqs. 1 to 3.
    """
    people = _simulated_people(mannequin)
    return pd.DataFrame(
        {
            metric.name: pair_distances(people, metric=metric)
            for metric in ticked(metrics, len(metrics), progress)
            if metric.by != "angles"
        }
    )


@cache
def _simulated_people(mannequin: bool) -> dict[str, PreparedClip]:
    walks = walks_of_population(load_population(), mannequin=mannequin)
    return {name: _joints_alone(clip) for name, clip in walks.clips.items()}


def _joints_alone(prepared: PreparedClip) -> PreparedClip:
    bare = without_rotations(prepared)
    markers = [name for name in JOINTS.markers if name in bare.clip.marker.values]
    return replace(
        bare,
        clip=bare.clip.sel(marker=markers),
        cycle=None if bare.cycle is None else bare.cycle.sel(marker=markers),
    )


def self_distance(prepared: PreparedClip, *, metric: GroupMetric) -> float:
    """Return how different a walk is from itself: the distance of its first and last strides.

    Halves of the capture where each has two strides or more, single strides where there are fewer;
    NaN where there is only one. Two captures that differ by no more cannot be told apart.

    Parameters
    ----------
    prepared : PreparedClip
        A walk that repeats.
    metric : GroupMetric
        By which to compare.

    Returns
    -------
    float
        In units of the metric.

    See Also
    --------
    compare_with_references : Shows it beside a comparison.

    References
    ----------
    Pražák et al. (2010), section 2.
    """
    clip = prepared.clip
    n_frames = clip.sizes["time"]
    stride = loop(clip).period_s * sampling_rate(clip)
    n_strides = int(n_frames / stride + 0.05)
    if n_strides < 2:
        return float("nan")
    length = min(round((n_strides // 2 if n_strides >= 4 else 1) * stride), n_frames // 2)
    first, last = (
        prepare(clip.isel(time=part)) for part in (slice(length), slice(n_frames - length, None))
    )
    if first.cycle is None or last.cycle is None:
        return float("nan")
    distance = clip_distance(first, last, metric=metric)
    return distance if np.isfinite(distance) else float("nan")
