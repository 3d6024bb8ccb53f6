"""Transitions from one walk to another: the edges of a motion graph (Kovar et al. 2002)."""

from __future__ import annotations

import numpy as np
import pandas as pd
import xarray as xr
from scipy.ndimage import minimum_filter

from eigenwalker.core.trajectories import sampling_rate
from eigenwalker.metric.alignment import align_steps
from eigenwalker.metric.clips import Clip, as_trajectories
from eigenwalker.metric.frame_metrics import POSITIONS, Metric
from eigenwalker.metric.motion_maps import motion_map
from eigenwalker.metric.points import common_positions

WINDOW_S = 1 / 3
"""Seconds over which clips are blended in Kovar, Gleicher & Pighin (2002)."""

UNNOTICED_S = 0.1
"""A jump no larger than the movement in this time is assumed to be hardly noticed."""

STILL_MM = 1.0
"""Root mean square movement of points, travel over the ground taken out, below which nothing moves:
markers at rest jitter by less, people who stand sway by more."""


def find_transitions(
    a: Clip,
    b: Clip | None = None,
    *,
    metric: str | Metric = POSITIONS,
    window_s: float = WINDOW_S,
    threshold: float | None = None,
) -> pd.DataFrame:
    """Return the moments at which one clip can pass into another.

    Local minima of the motion map (`motion_map`, each pair of frames aligned and averaged over a
    window) below a threshold; of minima less than half a window from each other in both clips the
    lowest, and none within half a window of an end, where one could not blend. Bodies of different
    build differ at all moments: bring both to the mannequin first (`retarget`).

    Parameters
    ----------
    a, b : DataArray of shape (time, marker, axis), Walker, Loop or PreparedClip
        The clip that is left, and the one that is entered, at the same frame rate. Without b, the
        same clip, of which moments less than `window_s` apart are no transitions.
    metric : str, FrameMetric or GroupMetric
        What is compared and how, or the name of a published metric (`PUBLISHED`); left out, the
        mean Euclidean distance of positions in mm, all points with the same weight.
    window_s : float
        Seconds over which the map is averaged: as long as one would blend.
    threshold : float, optional
        Largest distance, in the unit of the metric. Left out, the mean distance of frames
        `UNNOTICED_S` apart within the clips.

    Returns
    -------
    DataFrame
        The best first. Columns ``time_a``, ``time_b`` (s), ``distance``, and how the second clip is
        rotated about the vertical and then translated: ``angle_deg``, ``shift_x_mm``,
        ``shift_y_mm``.

    Raises
    ------
    ValueError
        If nothing moves in either clip, so that each moment is like every other.

    See Also
    --------
    motion_map : The map of which these are minima.

    References
    ----------
    Kovar, Gleicher & Pighin (2002), Motion graphs, section 3.

    Examples
    --------
    The best moment to pass from a walk into itself is one stride later:

    >>> walk = ew.simulate_walk(seed=1, frequency_hz=1.0, duration_s=4, rate_hz=50)
    >>> best = find_transitions(walk).iloc[0]
    >>> round(abs(best.time_a - best.time_b), 2) % 1
    np.float64(0.0)
    """
    a = as_trajectories(a)
    other = a if b is None else as_trajectories(b)
    rate_hz = sampling_rate(a)
    positions = common_positions(a, other)
    if all(_movement_mm(each) < STILL_MM for each in positions):
        raise ValueError(
            "Expected a clip in which somebody moves, got one in which no point moves by more than "
            f"{STILL_MM:g} mm, but for travel of the whole: each moment is like every other, and "
            "there are no transitions to choose from."
        )
    cells = motion_map(a, other, metric=metric, window_s=window_s, align=True).values
    if b is None:
        cells = np.where(_far_apart(len(cells), window_s * rate_hz), cells, np.inf)
    if threshold is None:
        threshold = float(np.mean([_unnoticed(clip, metric, window_s) for clip in (a, other)]))
    half = round(window_s * rate_hz / 2)
    frames = _separate_minima(cells, threshold, half)
    rows = [_alignment_at(*positions, i, j, half) for i, j in frames.tolist()]
    moves = np.reshape(rows, (len(rows), 3))
    return pd.DataFrame(
        {
            "time_a": a.time.values[frames[:, 0]],
            "time_b": other.time.values[frames[:, 1]],
            "distance": cells[tuple(frames.T)],
            "angle_deg": np.rad2deg(moves[:, 0]),
            "shift_x_mm": moves[:, 1],
            "shift_y_mm": moves[:, 2],
        }
    )


def _movement_mm(positions: np.ndarray) -> float:
    """Return how far points move about their mean places, travel over the ground taken out."""
    about = positions - positions.mean(axis=1, keepdims=True) * [1, 1, 0]
    return float(np.sqrt(np.mean((about - about.mean(axis=0)) ** 2)))


def _separate_minima(cells: np.ndarray, threshold: float, half: int) -> np.ndarray:
    """Return local minima, the lowest first, none of them within half a window of a lower one."""
    n, m = cells.shape
    inside = np.full(cells.shape, np.inf)
    inner = slice(half, max(n - half, 0)), slice(half, max(m - half, 0))
    inside[inner] = np.where(np.isfinite(cells[inner]), cells[inner], np.inf)
    lowest = (cells == minimum_filter(cells, size=3, mode="nearest")) & (inside <= threshold)
    frames = np.argwhere(lowest & np.isfinite(inside))
    frames = frames[np.argsort(cells[tuple(frames.T)], kind="stable")]
    near, reach = np.zeros(cells.shape, dtype=bool), max(half, 1)
    minima: list[tuple[int, int]] = []
    for i, j in frames.tolist():  # many where nothing moves
        if not near[i, j]:
            minima.append((i, j))
            near[max(i - reach + 1, 0) : i + reach, max(j - reach + 1, 0) : j + reach] = True
    return np.reshape(minima, (len(minima), 2)).astype(int)


def _far_apart(n_frames: int, least: float) -> np.ndarray:
    frames = np.arange(n_frames)
    return np.abs(frames[:, None] - frames) >= max(least, 1)


def _unnoticed(clip: xr.DataArray, metric: str | Metric, window_s: float) -> float:
    """Return the mean distance of frames `UNNOTICED_S` apart, averaged as in the map."""
    lag = max(1, round(UNNOTICED_S * sampling_rate(clip)))
    cells = motion_map(clip, metric=metric, window_s=window_s, align=True).values
    return float(np.mean(np.diagonal(cells, lag))) if len(cells) > lag else 0.0


def _alignment_at(a: np.ndarray, b: np.ndarray, i: int, j: int, half: int) -> list[float]:
    before = min(half, i, j)
    after = min(half, len(a) - 1 - i, len(b) - 1 - j)
    length = before + after + 1
    windows = a[i - before : i + after + 1], b[j - before : j + after + 1]
    alignment = align_steps(*windows, length)
    return [float(alignment.angles[0]), *alignment.shifts[0].tolist()]
