"""All pairs of many clips, compared point by point."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from functools import reduce
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
import xarray as xr

from eigenwalker.metric.cycles import mean_distances, register_pairs
from eigenwalker.metric.frame_metrics import By, ComparesFrames, shaped
from eigenwalker.metric.points import common_names, picked, points_of, told_alike
from eigenwalker.metric.prepared import Clips, PreparedClip, prepare_alike
from eigenwalker.metric.registration import register

if TYPE_CHECKING:
    from eigenwalker.core.progress import Progress

_AT_ONCE = 4096
"""Pairs whose paths are kept in memory at a time."""


def compared_pairs(
    clips: Clips, metric: ComparesFrames, progress: Progress | None
) -> tuple[list[str], np.ndarray, list[str]]:
    """Return names of clips, means of F(d) along the paths of all pairs, and names of points.

    Parameters
    ----------
    clips : mapping of str to DataArray, Walker or PreparedClip, or sequence
        Two or more. If one does not repeat, all are registered from end to end.
    metric : FrameMetric
        Of which what is compared and F count.
    progress : callable, optional
        Called with the number of clips and pairs that are done, and of all.

    """
    if len(clips) < 2:
        raise ValueError(f"Pairs need two clips or more; got {len(clips)}.")
    steps = _Steps(progress, len(clips))
    prepared = prepare_alike(clips, done=lambda: steps.forward(1))
    pairs = np.array(list(combinations(range(len(clips)), 2)))
    still = [name for name, clip in prepared.items() if clip.cycle is None]
    if still:
        _tell_of_actions(still, prepared)
    means = _of_actions if still else _of_strides
    return list(prepared), *means(list(prepared.values()), pairs, metric, steps)


def _tell_of_actions(still: list[str], prepared: Mapping[str, PreparedClip]) -> None:
    """Warn that not strides are compared, but clips from beginning to end."""
    rest = len(prepared) - len(still)
    advice = "Leave them out to compare strides." if rest >= 2 else "No strides are compared."
    warnings.warn(
        f"All clips are compared from end to end, as {still[:6]} do not repeat: "
        f"{prepared[still[0]].complaint} {advice}",
        stacklevel=4,
    )


class _Steps:
    """Tells how many clips and pairs are done."""

    def __init__(self, progress: Progress | None, n_clips: int) -> None:
        self._progress, self._done = progress, 0
        self._total = n_clips + n_clips * (n_clips - 1) // 2

    def forward(self, steps: int) -> None:
        self._done += steps
        if self._progress is not None:
            self._progress(self._done, self._total)


def _of_strides(
    clips: list[PreparedClip], pairs: np.ndarray, metric: ComparesFrames, steps: _Steps
) -> tuple[np.ndarray, list[str]]:
    """Components of all pairs of strides, each pair in an order that its contents decide."""
    cycles = [clip.cycle for clip in clips if clip.cycle is not None]
    names, compared = _stacked(cycles, metric.by)
    positions = compared if metric.by == "positions" else _stacked(cycles, "positions")[1]
    known = np.flatnonzero(np.isfinite(compared).all(axis=(0, 1, 3)))
    if not known.size:
        raise ValueError(f"Of the {metric.by} of {names} none is known throughout all clips.")
    compared = np.ascontiguousarray(compared[:, :, known])
    ordered = _in_order_of_contents([cycle.tobytes() for cycle in positions], pairs)
    parts = []
    for start in range(0, len(pairs), _AT_ONCE):
        found = register_pairs(positions, ordered[start : start + _AT_ONCE])
        parts.append(mean_distances(compared, found, metric))
        steps.forward(len(found.pairs))
    return np.concatenate(parts), [names[index] for index in known]


def _of_actions(
    clips: list[PreparedClip], pairs: np.ndarray, metric: ComparesFrames, steps: _Steps
) -> tuple[np.ndarray, list[str]]:
    """Components of all pairs of clips from beginning to end."""
    contents = [clip.clip.values.tobytes() for clip in clips]
    rows = []
    for first, second in _in_order_of_contents(contents, pairs):
        found = register(clips[first].clip, clips[second].clip)
        apart = found.distances(metric.by)
        means = shaped(metric, apart.to_numpy()).mean(axis=0)
        rows.append(dict(zip(apart.columns, means, strict=True)))
        steps.forward(1)
    table = pd.DataFrame(rows).dropna(axis=1)
    return table.to_numpy(), list(table.columns)


def _in_order_of_contents(contents: list[bytes], pairs: np.ndarray) -> np.ndarray:
    """Return pairs so turned that it does not matter which clip of a pair was named first."""
    rank = np.empty(len(contents), dtype=int)
    rank[sorted(range(len(contents)), key=contents.__getitem__)] = np.arange(len(contents))
    turned = rank[pairs[:, 0]] > rank[pairs[:, 1]]
    return np.where(turned[:, None], pairs[:, ::-1], pairs)


def _stacked(cycles: list[xr.DataArray], by: By) -> tuple[list[str], np.ndarray]:
    """Points that all cycles have, and their values of shape (cycle, frame, point, part)."""
    points = [points_of(cycle, by, periodic=True) for cycle in told_alike(cycles)]
    names = reduce(common_names, [each for each, _ in points])
    return names, np.stack([picked(*each, names) for each in points])
