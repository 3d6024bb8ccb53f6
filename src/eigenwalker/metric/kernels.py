"""Maps of weighted, shaped distances between the frames of two clips, as fast as the machine goes.

Compiled once by numba and kept on disk. What makes the loops fast: the frames of the second clip
lie side by side for every coordinate, inner loops run over slices from their beginning, and a
division does not look for zeros. Row blocks go to threads, which the kernels let run side by side.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import cache

import numba
import numpy as np

from eigenwalker.metric.frame_metrics import Shape

compiled = numba.njit(nogil=True, cache=True, error_model="numpy", fastmath={"contract", "nsz"})

_ROWS = 32
"""Rows that one thread takes at a time."""

_FEW = 200_000
"""Distances below which a second thread costs more than it brings."""


def point_map(
    a: np.ndarray, b: np.ndarray, weights: np.ndarray, *, shape: Shape, parameter: float = 1.0
) -> np.ndarray:
    """Return ``sum_k w_k F(d_k)`` of every frame of one clip with every frame of another.

    Parameters
    ----------
    a : array of shape (frame, point, part)
        Three parts are a place or velocity and compared by their Euclidean distance, four a unit
        quaternion and compared by the angle between orientations, 2 acos(min(1, abs(q.q'))) (A26).
    b : array of shape (other frame, point, part)
    weights : array of shape (point,)
    shape : {"absolute", "squared", "sigmoid", "power"}
        F.
    parameter : float
        Scale of the sigmoid, exponent of the power.

    Returns
    -------
    array of shape (frame, other frame)
        Points with a missing part (NaN) in either frame are left out and the others weigh more;
        NaN where nothing is left.

    Examples
    --------
    >>> a = np.array([[[0.0, 0, 0], [0, 0, 0]]])
    >>> b = np.array([[[3.0, 4, 0], [0, 0, 1]]])
    >>> point_map(a, b, np.array([0.5, 0.5]), shape="absolute").tolist()
    [[3.0]]

    """
    a, b = np.asarray(a, dtype=float), np.asarray(b, dtype=float)
    same = a is b
    kept = weights > 0
    a, weights = a[:, kept], np.asarray(weights, dtype=float)[kept]
    b = a if same else b[:, kept]
    missing = np.isnan(a).any() or np.isnan(b).any()
    if shape == "squared" and a.shape[-1] == 3 and not missing:
        return _squared_map(a, b, weights)
    if missing:
        return _map_with_gaps(a, b, weights, shape, parameter)
    return _filled(a, b, weights, shape, parameter)


def _squared_map(a: np.ndarray, b: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Squared Euclidean distances by one product of matrices, about a common middle."""
    middle = b.mean(axis=0, keepdims=True) if len(b) else np.zeros((1, *b.shape[1:]))
    root = np.sqrt(weights)[:, None]
    x = ((a - middle) * root).reshape(len(a), -1)
    y = ((b - middle) * root).reshape(len(b), -1)
    squared = x @ (-2 * y.T)
    squared += np.einsum("ij,ij->i", x, x)[:, None]
    squared += np.einsum("ij,ij->i", y, y)
    return np.maximum(squared, 0, out=squared)


def _map_with_gaps(
    a: np.ndarray, b: np.ndarray, weights: np.ndarray, shape: Shape, parameter: float
) -> np.ndarray:
    """Map in which each cell is made of the points that both frames have."""
    seen_a, seen_b = (np.atleast_2d(~np.isnan(values).any(axis=2)) for values in (a, b))
    total = np.zeros((len(a), len(b)))
    weight = (seen_a * weights) @ seen_b.T.astype(float)
    for k, w in enumerate(weights):
        rows, columns = np.flatnonzero(seen_a[:, k]), np.flatnonzero(seen_b[:, k])
        part = _filled(a[rows, k : k + 1], b[columns, k : k + 1], np.array([w]), shape, parameter)
        total[np.ix_(rows, columns)] += part
    return np.divide(total, weight, out=np.full_like(total, np.nan), where=weight > 1e-12)


def _filled(
    a: np.ndarray, b: np.ndarray, weights: np.ndarray, shape: Shape, parameter: float
) -> np.ndarray:
    """Fill a map by blocks of rows; of a clip with itself half of them, which is mirrored."""
    rows, columns = np.ascontiguousarray(a), np.ascontiguousarray(b.transpose(1, 2, 0))
    fill_rows = _powers if shape == "power" else rows_of_map
    half = a is b
    result = np.empty((len(a), len(b)))

    def fill(start: int) -> None:
        block = slice(start, start + _ROWS)
        first = start if half else 0
        fill_rows(
            rows[block], columns, weights, SHAPE_CODES[shape], parameter, first, result[block]
        )
        if half:
            result[start + _ROWS :, block] = result[block, start + _ROWS :].T

    in_threads(fill, range(0, len(a), _ROWS), few=result.size * len(weights) < _FEW)
    return result


def _powers(
    rows: np.ndarray,
    columns: np.ndarray,
    weights: np.ndarray,
    _code: int,
    exponent: float,
    first: int,
    result: np.ndarray,
) -> None:
    """Fill rows of a map with shape "power": numpy knows a faster power than numba does."""
    result[:, first:] = 0
    one, distances = np.ones(1), np.zeros_like(result)
    for k, weight in enumerate(weights):
        point = slice(k, k + 1)
        rows_of_map(rows[:, point].copy(), columns[point], one, 0, 1.0, first, distances)
        result[:, first:] += weight * distances[:, first:] ** exponent


def point_distances(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return how far each point of one clip is from the same point of another, frame by frame.

    Parameters
    ----------
    a, b : array of shape (step, point, part)
        As for `point_map`.

    Returns
    -------
    array of shape (step, point)

    Examples
    --------
    >>> point_distances(np.array([[[1.0, 0, 0, 0]]]), np.array([[[0, 1.0, 0, 0]]])).round(6)
    array([[3.141593]])

    """
    apart = np.linalg.norm(a - b, axis=2)
    if a.shape[2] == 3:
        return apart
    together = np.linalg.norm(a + b, axis=2)
    return 4 * np.arctan2(np.minimum(apart, together), np.maximum(apart, together))


def in_threads(work: Callable[[int], object], starts: range, *, few: bool = False) -> None:
    """Call a function that lets other threads run with each number, over all cores."""
    if few or len(starts) < 2 or n_threads() < 2:
        for start in starts:
            work(start)
    else:
        for _ in _pool().map(work, starts):
            pass


def n_threads() -> int:
    """Return how many cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@cache
def _pool() -> ThreadPoolExecutor:
    return ThreadPoolExecutor(n_threads(), thread_name_prefix="eigenwalker-maps")


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_pool.cache_clear)  # threads do not live on in a child


SHAPE_CODES: dict[Shape, int] = {"absolute": 0, "squared": 1, "sigmoid": 2, "power": 3}


@compiled
def rows_of_map(rows, columns, weights, code, parameter, first, result):
    """Fill rows of a map from a first column on.

    rows: (frame, point, part); columns: (point, part, other frame); result: (frame, other frame).
    """
    n_columns = columns.shape[2] - first
    distances = np.empty(n_columns, result.dtype)
    for i in range(rows.shape[0]):
        row = result[i, first:]
        row[:] = 0.0
        for k in range(rows.shape[1]):
            if rows.shape[2] == 4:
                _angles(rows[i, k], columns[k], first, distances)
                _add_shaped(distances, weights[k], code, parameter, row)
                continue
            x, y, z, weight = rows[i, k, 0], rows[i, k, 1], rows[i, k, 2], weights[k]
            xs, ys, zs = columns[k, 0, first:], columns[k, 1, first:], columns[k, 2, first:]
            if code == 0:  # the usual shape in one pass
                for j in range(n_columns):
                    dx, dy, dz = x - xs[j], y - ys[j], z - zs[j]
                    row[j] += weight * np.sqrt(dx * dx + dy * dy + dz * dz)
            else:
                for j in range(n_columns):
                    dx, dy, dz = x - xs[j], y - ys[j], z - zs[j]
                    distances[j] = np.sqrt(dx * dx + dy * dy + dz * dz)
                _add_shaped(distances, weight, code, parameter, row)


@compiled
def rows_of_aligned_map(rows, columns, weights, code, parameter, turns, result):
    """Fill rows of a map in which every cell turns and moves the second clip in its own way.

    turns: (4, frame, other frame), that is cosine and sine of the turn and the way along x and y.
    """
    n_columns = columns.shape[2]
    distances = np.empty(n_columns)
    for i in range(rows.shape[0]):
        row = result[i, :n_columns]
        row[:] = 0.0
        cos, sin, along, aside = turns[0, i, :], turns[1, i, :], turns[2, i, :], turns[3, i, :]
        for k in range(rows.shape[1]):
            x, y, z = rows[i, k, 0], rows[i, k, 1], rows[i, k, 2]
            xs, ys, zs = columns[k, 0, :], columns[k, 1, :], columns[k, 2, :]
            for j in range(n_columns):
                dx = x - (cos[j] * xs[j] - sin[j] * ys[j] + along[j])
                dy = y - (sin[j] * xs[j] + cos[j] * ys[j] + aside[j])
                dz = z - zs[j]
                distances[j] = np.sqrt(dx * dx + dy * dy + dz * dz)
            _add_shaped(distances, weights[k], code, parameter, row)


@compiled
def _angles(turn, columns, first, distances):
    for j in range(distances.size):
        apart, together = 0.0, 0.0
        for part in range(4):
            other = columns[part, first + j]
            apart += (turn[part] - other) ** 2
            together += (turn[part] + other) ** 2
        distances[j] = angle_between(apart, together)


@compiled
def angle_between(apart, together):
    """Return 2 acos(abs(q.q')) from the squares of q - q' and q + q', exactly 0 for equal ones."""
    return 4 * np.arctan2(np.sqrt(min(apart, together)), np.sqrt(max(apart, together)))


@compiled
def _add_shaped(distances, weight, code, parameter, row):
    if code == 0:
        for j in range(row.size):
            row[j] += weight * distances[j]
    elif code == 1:
        for j in range(row.size):
            row[j] += weight * distances[j] * distances[j]
    elif code == 2:
        for j in range(row.size):
            row[j] += weight * distances[j] / (distances[j] + parameter)
    else:
        for j in range(row.size):
            row[j] += weight * distances[j] ** parameter


@compiled
def mean_along_path(path, a, b, code, parameter, result):
    """Fill in, for each point, the mean of F(d) over the cells of a path.

    path: (step, 2); a, b: (frame, point, part); result: (point,).
    """
    result[:] = 0.0
    n_points, n_parts = a.shape[1], a.shape[2]
    distances = np.empty(n_points)
    for step in range(path.shape[0]):
        places, others = a[path[step, 0]], b[path[step, 1]]
        for k in range(n_points):
            apart, together = 0.0, 0.0
            for part in range(n_parts):
                apart += (places[k, part] - others[k, part]) ** 2
                together += (places[k, part] + others[k, part]) ** 2
            distances[k] = np.sqrt(apart) if n_parts == 3 else angle_between(apart, together)
        _add_shaped(distances, 1.0 / path.shape[0], code, parameter, result)


@compiled
def diagonal_means(values, half):
    """Return means over windows of 2 * half + 1 cells along the diagonals, shorter at the edges."""
    n, m = values.shape
    sums = np.zeros((n + 1, m + 1))
    for i in range(n):
        above, below, row = sums[i, :m], sums[i + 1, 1:], values[i, :m]
        for j in range(m):
            below[j] = above[j] + row[j]
    means = np.empty((n, m))
    for i in range(n):
        for j in range(m):
            before = min(half, min(i, j))
            after = min(half, min(n - 1 - i, m - 1 - j)) + 1
            total = sums[i + after, j + after] - sums[i - before, j - before]
            means[i, j] = total / (before + after)
    return means
