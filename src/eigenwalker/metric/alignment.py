"""Where one posture has to turn and move to lie over another: heading and place removed.

The closed form of Kovar, Gleicher & Pighin (2002, section 3.1): of all turns about the vertical and
moves along the floor, those that bring the points of a window of frames nearest to the points of
another, by least squares.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from eigenwalker.metric.frame_metrics import Shape
from eigenwalker.metric.kernels import SHAPE_CODES, diagonal_means, rows_of_aligned_map
from eigenwalker.metric.threads import in_threads

_ROWS = 32


class Alignment(NamedTuple):
    """Turns about z in radians, then moves along x and y in mm, of the second clip onto the first.

    Of shape (frame, other frame) and (frame, other frame, 2) for all pairs of frames; of shape
    (step,) and (step, 2) along a path.
    """

    angles: np.ndarray
    shifts: np.ndarray

    def apply(self, positions: np.ndarray) -> np.ndarray:
        """Return positions of shape (step, marker, axis), turned and moved step by step."""
        cos, sin = np.cos(self.angles)[:, None], np.sin(self.angles)[:, None]
        x, y, z = np.moveaxis(positions, 2, 0)
        turned = np.stack([cos * x - sin * y, sin * x + cos * y, z], axis=2)
        turned[..., :2] += self.shifts[:, None]
        return turned

    def inverse(self) -> Alignment:
        """Return what brings the first clip over the second, along a path."""
        moves = np.concatenate([self.shifts, 0 * self.shifts[:, :1]], axis=1)[:, None]
        back = Alignment(-self.angles, 0 * self.shifts)
        return Alignment(-self.angles, -back.apply(moves)[:, 0, :2])


def align_windows(a: np.ndarray, b: np.ndarray, half: int = 0) -> Alignment:
    """Return how each window of frames of one clip is brought over each window of another.

    Parameters
    ----------
    a, b : array of shape (frame, point, axis)
        Positions, none missing.
    half : int
        Frames of the window on either side of each frame; fewer at the ends of the clips.

    Returns
    -------
    Alignment
        For every pair of frames.

    Examples
    --------
    >>> posture = np.array([[[0.0, 0, 0], [100, 0, 0]]])
    >>> turned = np.array([[[50.0, 0, 0], [50, 100, 0]]])
    >>> found = align_windows(posture, turned)
    >>> np.rad2deg(found.angles).round(6).tolist(), found.shifts.round(6).tolist()
    ([[-90.0]], [[[0.0, 50.0]]])

    """
    n_points = a.shape[1]
    middle_a, middle_b = (values[..., :2].mean(axis=(0, 1)) for values in (a, b))
    (xa, ya), (xb, yb) = _horizontal(a, middle_a), _horizontal(b, middle_b)
    along = xa @ xb.T + ya @ yb.T
    across = ya @ xb.T - xa @ yb.T
    ones = np.ones_like(along)
    means = [xa.mean(1)[:, None] * ones, ya.mean(1)[:, None] * ones]
    means += [xb.mean(1) * ones, yb.mean(1) * ones]
    if half:
        along, across = diagonal_means(along, half), diagonal_means(across, half)
        means = [diagonal_means(mean, half) for mean in means]
    return _closed_form([*means, along / n_points, across / n_points], middle_a, middle_b)


def _closed_form(means: list[np.ndarray], middle_a: np.ndarray, middle_b: np.ndarray) -> Alignment:
    """Turn and move from means over points of x, y, x', y', x x' + y y' and y x' - x y'."""
    mean_xa, mean_ya, mean_xb, mean_yb, along, across = means
    along = along - (mean_xa * mean_xb + mean_ya * mean_yb)
    across = across - (mean_ya * mean_xb - mean_xa * mean_yb)
    angles = np.arctan2(across, along)
    cos, sin = np.cos(angles), np.sin(angles)
    x, y = mean_xb + middle_b[0], mean_yb + middle_b[1]
    shift_x = mean_xa + middle_a[0] - (cos * x - sin * y)
    shift_y = mean_ya + middle_a[1] - (sin * x + cos * y)
    return Alignment(angles, np.stack([shift_x, shift_y], axis=-1))


def align_steps(a: np.ndarray, b: np.ndarray, half: int = 0) -> Alignment:
    """Return how the frames of one clip are brought over those of another, step by step.

    Parameters
    ----------
    a, b : array of shape (step, point, axis)
        Positions that correspond to each other, none missing.
    half : int
        Steps on either side that count too; fewer at the ends.

    Returns
    -------
    Alignment
        One turn and move a step.

    Examples
    --------
    >>> posture = np.array([[[0.0, 0, 0], [100, 0, 0]]])
    >>> found = align_steps(posture, posture + np.array([30.0, 0, 0]))
    >>> found.angles.tolist(), found.shifts.tolist()
    ([0.0], [[-30.0, 0.0]])

    """
    middle_a, middle_b = (values[..., :2].mean(axis=(0, 1)) for values in (a, b))
    (xa, ya), (xb, yb) = _horizontal(a, middle_a), _horizontal(b, middle_b)
    means = [values.mean(axis=1) for values in (xa, ya, xb, yb)]
    means += [(xa * xb + ya * yb).mean(axis=1), (ya * xb - xa * yb).mean(axis=1)]
    sums = np.concatenate([np.zeros((1, 6)), np.cumsum(np.stack(means, axis=1), axis=0)])
    steps = np.arange(len(a))
    first, stop = np.maximum(steps - half, 0), np.minimum(steps + half + 1, len(a))
    windows = (sums[stop] - sums[first]) / (stop - first)[:, None]
    return _closed_form(list(windows.T), middle_a, middle_b)


def _horizontal(values: np.ndarray, middle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return values[..., 0] - middle[0], values[..., 1] - middle[1]


def aligned_map(
    a: np.ndarray,
    b: np.ndarray,
    alignment: Alignment,
    weights: np.ndarray,
    *,
    shape: Shape,
    parameter: float = 1.0,
    moved: bool = True,
) -> np.ndarray:
    """Return ``sum_k w_k F(d_k)`` of all pairs of frames, the second clip aligned to the first.

    Parameters
    ----------
    a, b : array of shape (frame, point, axis)
        Positions or velocities, none missing.
    alignment : Alignment
        For every pair of frames.
    weights : array of shape (point,)
    shape, parameter
        F, as in `point_map`.
    moved : bool
        Whether points move as well as turn: positions do, velocities do not.

    Returns
    -------
    array of shape (frame, other frame)

    """
    rows, columns = np.ascontiguousarray(a), np.ascontiguousarray(b.transpose(1, 2, 0))
    turns = np.zeros((4, len(a), len(b)))
    np.cos(alignment.angles, out=turns[0])
    np.sin(alignment.angles, out=turns[1])
    if moved:
        turns[2:] = np.moveaxis(alignment.shifts, 2, 0)
    result = np.empty((len(a), len(b)))

    def fill(start: int) -> None:
        block = slice(start, start + _ROWS)
        rows_of_aligned_map(
            rows[block],
            columns,
            weights,
            SHAPE_CODES[shape],
            parameter,
            np.ascontiguousarray(turns[:, block]),
            result[block],
        )

    in_threads(fill, range(0, len(a), _ROWS), few=result.size < 10_000)
    return result
