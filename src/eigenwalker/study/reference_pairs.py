"""Something to hold a difference against: pairs of simulated people, and a walk and itself."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import pandas as pd
from scipy.stats import percentileofscore

from eigenwalker.core.progress import Progress
from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.trajectories import sampling_rate
from eigenwalker.datasets.built_in import load_population
from eigenwalker.metric.clip_distances import clip_distance
from eigenwalker.metric.clips import PreparedClip
from eigenwalker.metric.frame_metrics import GroupMetric
from eigenwalker.metric.loops import loop
from eigenwalker.metric.pairwise import pair_distances
from eigenwalker.metric.prepared import prepare
from eigenwalker.study.walks import Walks, walks_of_population, without_rotations


@dataclass(frozen=True, eq=False)
class SimulatedPairs:
    """Distances of all pairs of the built-in, simulated people, by several metrics.

    They tell how different people are from each other who all walk at their own pace. They are
    simulated, so it is no norm.

    Parameters
    ----------
    n_people : int
    distances : DataFrame of pairs by metrics
        By name, of joint positions and velocities. Angles are left out: they depend on whether a
        capture is of joints, as that of simulated people, or of points on the skin.
    metrics : dict of str to GroupMetric
        All that were asked for, by name.

    """

    n_people: int
    distances: pd.DataFrame
    metrics: Mapping[str, GroupMetric]

    def place(self, a: PreparedClip, b: PreparedClip, metric: str) -> tuple[float, float] | None:
        """Return how far two walks are apart by joints alone, and the share of pairs nearer.

        Hands, feet and clavicles, which simulated people have not, are left aside, so that like is
        compared with like. None of angles, and of walks that do not differ.
        """
        if metric not in self.distances:
            return None
        a, b = (_joints_alone(clip) for clip in (a, b))
        distance = clip_distance(a, b, metric=self.metrics[metric])
        if not distance > 0:
            return None
        share = percentileofscore(self.distances[metric], distance, kind="mean") / 100
        return distance, float(share)


def simulated_pairs(
    metrics: Sequence[GroupMetric], *, mannequin: bool = True, progress: Progress | None = None
) -> SimulatedPairs:
    """Return the distances of all pairs of simulated people.

    Parameters
    ----------
    metrics : sequence of GroupMetric
        By which.
    mannequin : bool
        Whether they too are shown on the neutral mannequin.
    progress : callable, optional
        Called with the number of metrics that are done, and of all.

    Returns
    -------
    SimulatedPairs

    """
    people = _simulated_people(mannequin).clips
    columns = {}
    for done, metric in enumerate(metrics, start=1):
        if metric.by != "angles":
            columns[metric.name] = pair_distances(people, metric=metric)
        if progress is not None:
            progress(done, len(metrics))
    return SimulatedPairs(len(people), pd.DataFrame(columns), {m.name: m for m in metrics})


@cache
def _simulated_people(mannequin: bool) -> Walks:
    walks = walks_of_population(load_population(), mannequin=mannequin)
    return Walks({name: _joints_alone(clip) for name, clip in walks.clips.items()})


def _joints_alone(prepared: PreparedClip) -> PreparedClip:
    (bare,) = without_rotations({"": prepared}).values()
    keep = [name for name in JOINTS.markers if name in bare.clip.marker.values]
    return replace(
        bare,
        clip=bare.clip.sel(marker=keep),
        cycle=None if bare.cycle is None else bare.cycle.sel(marker=keep),
    )


def own_spread(prepared: PreparedClip, metric: GroupMetric) -> float:
    """Return how different a walk is from itself: the distance of its first and its last strides.

    Halves of the capture where each has two strides or more, single strides where there are fewer;
    NaN where there is but one. A difference of two captures that is no more than this is none.

    Parameters
    ----------
    prepared : PreparedClip
        A walk that repeats.
    metric : GroupMetric
        By which to compare.

    """
    clip = prepared.clip
    stride = loop(clip).period_s * sampling_rate(clip)
    n_strides = int(clip.sizes["time"] / stride + 0.05)
    if n_strides < 2:
        return float("nan")
    each = n_strides // 2 if n_strides >= 4 else 1
    length = min(round(each * stride), clip.sizes["time"] // 2)
    ends = [clip.isel(time=slice(None, length)), clip.isel(time=slice(-length, None))]
    walks = [prepare(end.assign_attrs(n_strides=each)) for end in ends]
    if any(walk.cycle is None for walk in walks):
        return float("nan")
    distance = clip_distance(*walks, metric=metric)
    return distance if np.isfinite(distance) else float("nan")
