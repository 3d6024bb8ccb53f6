"""Maps of weighted, shaped distances between the frames of two clips, as plain arrays."""

from __future__ import annotations

import numpy as np

from eigenwalker.metric.frame_metrics import SHAPES, Shape
from eigenwalker.metric.joint_angles import angle_between
from eigenwalker.metric.kernels import (
    SHAPE_CODES,
    in_threads,
    rows_of_map,
    squares_of_point,
    tangents_of_point,
)

_ROWS = 32
"""Rows of a map that one thread fills at a time."""

EXACT = 4_000_000
"""Distances up to which a map is computed in double precision. Larger maps are in single, in a
third of the time; errors are ten-millionths of the distance of points from their common mean."""

_FEW = 1_000_000
"""Distances below which a second thread costs more than it saves."""


def point_map(
    a: np.ndarray, b: np.ndarray, weights: np.ndarray, *, shape: Shape, parameter: float = 1.0
) -> np.ndarray:
    """Return ``sum_k w_k F(d_k)`` of every frame of one clip with every frame of another.

    Arrays are of shape (frame, point, part): three parts are a position or velocity, four a unit
    quaternion (`angle_between`). Points with a missing part (NaN) in either frame are left out and
    the weights of the others grow; a cell is NaN where no point is left.
    """
    a, b = np.asarray(a, dtype=float), np.asarray(b, dtype=float)
    weighed = weights > 0
    weights = np.asarray(weights, dtype=float)[weighed]
    same = a is b
    a = a[:, weighed]
    b = a if same else b[:, weighed]
    large = len(a) * len(b) * len(weights) > EXACT
    if np.isnan(a).any() or np.isnan(b).any():
        return _map_with_gaps(a, b, weights, shape, parameter, large)
    return _filled(a, b, weights, shape, parameter, large)


def _map_with_gaps(
    a: np.ndarray, b: np.ndarray, weights: np.ndarray, shape: Shape, parameter: float, large: bool
) -> np.ndarray:
    """Fill a map of which each cell is made of the points that both frames have."""
    seen_a, seen_b = (np.atleast_2d(~np.isnan(values).any(axis=2)) for values in (a, b))
    total = np.zeros((len(a), len(b)))
    weight = (seen_a * weights) @ seen_b.T.astype(float)
    for k, w in enumerate(weights):
        rows, columns = np.flatnonzero(seen_a[:, k]), np.flatnonzero(seen_b[:, k])
        if rows.size and columns.size:
            point = a[rows, k : k + 1], b[columns, k : k + 1]
            cells = _filled(*point, np.array([w]), shape, parameter, large)
            total[np.ix_(rows, columns)] += cells
    total *= weights.sum()
    return np.divide(total, weight, out=np.full_like(total, np.nan), where=weight > 1e-12)


def _filled(
    a: np.ndarray, b: np.ndarray, weights: np.ndarray, shape: Shape, parameter: float, large: bool
) -> np.ndarray:
    """Fill a map by blocks of rows; of a clip with itself only half, which is mirrored."""
    if shape == "squared" and a.shape[2] == 3:
        return _squared_map(a, b, weights)
    result = np.empty((len(a), len(b)))
    precision = np.float32 if large else np.float64
    middle = 0.0 if a.shape[2] == 4 else (a.mean(axis=0) + b.mean(axis=0)) / 2
    rows = np.ascontiguousarray(a - middle, dtype=precision)
    columns = np.ascontiguousarray((b - middle).transpose(1, 2, 0), dtype=precision)
    weights, number = weights.astype(precision), np.array([parameter], dtype=precision)
    by_point = shape == "power" or a.shape[2] == 4
    half = a is b

    def fill(start: int) -> None:
        block = slice(start, start + _ROWS)
        first = start if half else 0
        if by_point:
            cells = _point_by_point(rows[block], columns[:, :, first:], weights, shape, parameter)
            result[block, first:] = cells
        else:
            code = SHAPE_CODES[shape]
            rows_of_map(rows[block], columns, weights, code, number, first, result[block])
        if half:
            result[start + _ROWS :, block] = result[block, start + _ROWS :].T

    in_threads(fill, range(0, len(a), _ROWS), few=result.size * len(weights) < _FEW)
    return result


def _squared_map(a: np.ndarray, b: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Fill a map of squared Euclidean distances by one product of matrices."""
    middle = b.mean(axis=0, keepdims=True)
    root = np.sqrt(weights)[:, None]
    x = ((a - middle) * root).reshape(len(a), -1)
    y = x if a is b else ((b - middle) * root).reshape(len(b), -1)
    squared = x @ y.T
    squared *= -2
    squared += np.einsum("ij,ij->i", x, x)[:, None]
    squared += np.einsum("ij,ij->i", y, y)
    if a is b:
        np.fill_diagonal(squared, 0)
    return np.maximum(squared, 0, out=squared)


def _point_by_point(
    rows: np.ndarray, columns: np.ndarray, weights: np.ndarray, shape: Shape, parameter: float
) -> np.ndarray:
    """Return rows of a map of powers or angles, whose functions are faster in numpy."""
    total = np.zeros((len(rows), columns.shape[2]), dtype=rows.dtype)
    cells = np.empty_like(total)
    for k, weight in enumerate(weights):
        if rows.shape[2] == 3:
            squares_of_point(rows[:, k], columns[k], cells)
            np.power(cells, cells.dtype.type(parameter / 2), out=cells)
            total += weight * cells
        else:
            tangents_of_point(rows[:, k], columns[k], cells)
            np.arctan(np.sqrt(cells, out=cells), out=cells)
            total += weight * SHAPES[shape](4 * cells, parameter)
    return total


def point_distances(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the distance of each point from the same point of another clip, (step, point)."""
    return np.linalg.norm(a - b, axis=2) if a.shape[2] == 3 else angle_between(a, b)
