"""Loops over frames and points, compiled by numba and cached on disk, and threads that run them.

What makes them fast: the frames of the second clip are contiguous for every coordinate, inner loops
run over slices from index 0, and divisions do not check for zeros. They release the interpreter
lock, so threads run side by side.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import cache, partial
from typing import Any

import numba
import numpy as np

from eigenwalker.metric.frame_metrics import Shape

_njit = partial(numba.njit, nogil=True, error_model="numpy", fastmath={"contract", "nsz"})


def compiled(function: Callable[..., Any]) -> Callable[..., Any]:
    """Return a function compiled, and cached on disk where there is a folder for that."""
    # without a home, numba would make a folder called "~" where the program runs
    has_folder = "NUMBA_CACHE_DIR" in os.environ or os.path.expanduser("~") != "~"
    try:
        return _njit(cache=has_folder)(function)
    except RuntimeError:  # neither the installation nor a folder of this user can be written
        return _njit(function)


SHAPE_CODES: dict[Shape, int] = {"absolute": 0, "squared": 1, "sigmoid": 2, "power": 3}


@compiled
def rows_of_map(rows, columns, weights, code, parameter, first, result):
    """Fill rows of a map of absolute distances or sigmoids, from a first column on.

    rows: (frame, point, 3); columns: (point, 3, other frame); weights: (point,); parameter: (1,);
    all of the precision of the computation; result: (frame, other frame).
    """
    row = np.empty(columns.shape[2] - first, rows.dtype)
    scale = parameter[0]
    for i in range(rows.shape[0]):
        row[:] = 0.0
        for k in range(rows.shape[1]):
            x, y, z, weight = rows[i, k, 0], rows[i, k, 1], rows[i, k, 2], weights[k]
            xs, ys, zs = columns[k, 0, first:], columns[k, 1, first:], columns[k, 2, first:]
            for j in range(row.size):
                dx, dy, dz = x - xs[j], y - ys[j], z - zs[j]
                distance = np.sqrt(dx * dx + dy * dy + dz * dz)
                row[j] += weight * (distance if code == 0 else distance / (distance + scale))
        result[i, first:] = row


@compiled
def squares_of_point(rows, columns, result):
    """Fill in the squared distances of one point.

    rows: (frame, 3); columns: (3, other frame); result: (frame, other frame).
    """
    xs, ys, zs = columns[0], columns[1], columns[2]
    for i in range(rows.shape[0]):
        row = result[i]
        x, y, z = rows[i, 0], rows[i, 1], rows[i, 2]
        for j in range(row.size):
            dx, dy, dz = x - xs[j], y - ys[j], z - zs[j]
            row[j] = dx * dx + dy * dy + dz * dz


@compiled
def tangents_of_point(rows, columns, result):
    """Fill in the squared tangents of a quarter of the angle between orientations of one bone.

    rows: (frame, 4), quaternions; columns: (4, other frame); result: (frame, other frame).
    """
    ws, xs, ys, zs = columns[0], columns[1], columns[2], columns[3]
    for i in range(rows.shape[0]):
        row = result[i]
        w, x, y, z = rows[i, 0], rows[i, 1], rows[i, 2], rows[i, 3]
        for j in range(row.size):
            dw, dx, dy, dz = w - ws[j], x - xs[j], y - ys[j], z - zs[j]
            sw, sx, sy, sz = w + ws[j], x + xs[j], y + ys[j], z + zs[j]
            minus = dw * dw + dx * dx + dy * dy + dz * dz
            plus = sw * sw + sx * sx + sy * sy + sz * sz
            row[j] = min(minus, plus) / max(minus, plus)


@compiled
def rows_of_aligned_map(rows, columns, weights, code, parameter, moves, result):
    """Fill rows of a map in which every cell has an alignment of its own.

    moves: (4, frame, other frame), the cosine and sine of the rotation and the shifts along x, y.
    """
    n_columns = columns.shape[2]
    distances = np.empty(n_columns)
    for i in range(rows.shape[0]):
        row = result[i, :n_columns]
        row[:] = 0.0
        cos, sin, shift_x, shift_y = moves[0, i, :], moves[1, i, :], moves[2, i, :], moves[3, i, :]
        for k in range(rows.shape[1]):
            x, y, z = rows[i, k, 0], rows[i, k, 1], rows[i, k, 2]
            xs, ys, zs = columns[k, 0, :], columns[k, 1, :], columns[k, 2, :]
            for j in range(n_columns):
                dx = x - (cos[j] * xs[j] - sin[j] * ys[j] + shift_x[j])
                dy = y - (sin[j] * xs[j] + cos[j] * ys[j] + shift_y[j])
                dz = z - zs[j]
                distances[j] = np.sqrt(dx * dx + dy * dy + dz * dz)
            _add_shaped(distances, weights[k], code, parameter, row)


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
    """Fill in the mean of F(d) of each point over the cells of a path.

    path: (step, 2); a, b: (frame, point, part); result: (point,).
    """
    result[:] = 0.0
    distances = np.empty(result.size)
    for step in range(path.shape[0]):
        here, there = a[path[step, 0]], b[path[step, 1]]
        for k in range(distances.size):
            if a.shape[2] == 4:
                distances[k] = _angle_between(here[k], there[k])
            else:
                dx, dy = here[k, 0] - there[k, 0], here[k, 1] - there[k, 1]
                dz = here[k, 2] - there[k, 2]
                distances[k] = np.sqrt(dx * dx + dy * dy + dz * dz)
        _add_shaped(distances, 1.0 / path.shape[0], code, parameter, result)


@compiled
def _angle_between(quaternion, other):
    """Return 2 acos(abs(q.q')) from the squares of q - q' and q + q', exactly 0 for equal ones."""
    minus, plus = 0.0, 0.0
    for part in range(4):
        minus += (quaternion[part] - other[part]) ** 2
        plus += (quaternion[part] + other[part]) ** 2
    return 4 * np.arctan2(np.sqrt(min(minus, plus)), np.sqrt(max(minus, plus)))


@compiled
def diagonal_means(values, half):
    """Return means over windows of 2 * half + 1 cells along the diagonals, shorter at the edges.

    Missing cells (NaN) are left out; a mean of none is NaN.
    """
    n, m = values.shape
    sums = np.zeros((n + 1, m + 1))
    counts = np.zeros((n + 1, m + 1), np.int32)
    for i in range(n):
        above, here, row = sums[i, :m], sums[i + 1, 1:], values[i, :m]
        n_above, n_here = counts[i, :m], counts[i + 1, 1:]
        for j in range(m):
            seen = not np.isnan(row[j])
            here[j] = above[j] + (row[j] if seen else 0.0)
            n_here[j] = n_above[j] + seen
    means = np.empty((n, m))
    for i in range(n):
        for j in range(m):
            before = min(half, min(i, j))
            after = min(half, min(n - 1 - i, m - 1 - j)) + 1
            total = sums[i + after, j + after] - sums[i - before, j - before]
            means[i, j] = total / (counts[i + after, j + after] - counts[i - before, j - before])
    return means


def in_threads(work: Callable[[int], object], starts: range, *, few: bool = False) -> None:
    """Call a function with each number, in threads on all cores."""
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
    return ThreadPoolExecutor(n_threads(), thread_name_prefix="eigenwalker-metric")


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_pool.cache_clear)  # a child has no threads
