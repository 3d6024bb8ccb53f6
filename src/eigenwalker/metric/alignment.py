"""Alignment of postures in heading and place, in closed form (Kovar, Gleicher & Pighin 2002)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from eigenwalker.core.kinematics import rotate_z
from eigenwalker.metric.frame_metrics import Shape
from eigenwalker.metric.kernels import SHAPE_CODES, diagonal_means, in_threads, rows_of_aligned_map

_ROWS = 32
"""Rows of a map that one thread fills at a time."""


class Alignment(NamedTuple):
    """Rotations about the vertical and then translations that lay one clip over another.

    Parameters
    ----------
    angles : array of shape (step,) or (frame, other frame)
        Radians, counter-clockwise seen from above.
    shifts : array of shape (step, 2) or (frame, other frame, 2)
        Translations along x and y in mm.

    See Also
    --------
    Registration : holds it.

    References
    ----------
    Pražák et al. (2010), section 3: registration curves.
    """

    angles: np.ndarray
    shifts: np.ndarray

    def apply(self, positions: np.ndarray) -> np.ndarray:
        """Return positions of shape (step, marker, axis), rotated and translated step by step."""
        rotated = rotate_z(positions, self.angles)
        rotated[..., :2] += self.shifts[:, None]
        return rotated

    def inverse(self) -> Alignment:
        """Return the alignment that lays the first clip over the second, along a path."""
        shifts = np.concatenate([self.shifts, 0 * self.shifts[:, :1]], axis=1)[:, None]
        return Alignment(-self.angles, -rotate_z(shifts, -self.angles)[:, 0, :2])


def align_windows(a: np.ndarray, b: np.ndarray, half: int = 0) -> Alignment:
    r"""Return how each window of frames of one clip is laid over each window of another.

    The rotation and shift that minimise the summed squared distance between the points of both
    windows (Kovar, Gleicher & Pighin 2002, section 3.1), with means over all points and frames of
    the windows, and primes for the second clip:

    .. math::

        \theta = \arctan\frac
        {\langle y x' - x y' \rangle - \langle y \rangle\langle x' \rangle
        + \langle x \rangle\langle y' \rangle}
        {\langle x x' + y y' \rangle - \langle x \rangle\langle x' \rangle
        - \langle y \rangle\langle y' \rangle}, \quad
        s = \langle (x, y) \rangle - R_\theta\, \langle (x', y') \rangle

    Positions are of shape (frame, point, axis); windows have `half` frames on either side.
    """
    n_points = a.shape[1]
    middle_a, middle_b = horizontal_mean(a), horizontal_mean(b)
    (xa, ya), (xb, yb) = _horizontal(a, middle_a), _horizontal(b, middle_b)
    dots = xa @ xb.T + ya @ yb.T
    crosses = ya @ xb.T - xa @ yb.T
    ones = np.ones_like(dots)
    means = [xa.mean(1)[:, None] * ones, ya.mean(1)[:, None] * ones]
    means += [xb.mean(1) * ones, yb.mean(1) * ones]
    if half:
        dots, crosses = diagonal_means(dots, half), diagonal_means(crosses, half)
        means = [diagonal_means(mean, half) for mean in means]
    return _closed_form([*means, dots / n_points, crosses / n_points], middle_a, middle_b)


def align_steps(a: np.ndarray, b: np.ndarray, half: int = 0) -> Alignment:
    """Return how corresponding positions of shape (step, point, axis) are aligned step by step."""
    middle_a, middle_b = horizontal_mean(a), horizontal_mean(b)
    (xa, ya), (xb, yb) = _horizontal(a, middle_a), _horizontal(b, middle_b)
    means = [values.mean(axis=1) for values in (xa, ya, xb, yb)]
    means += [(xa * xb + ya * yb).mean(axis=1), (ya * xb - xa * yb).mean(axis=1)]
    steps = np.arange(len(a))
    first, stop = np.maximum(steps - half, 0), np.minimum(steps + half + 1, len(a))
    windows = window_means(np.stack(means, axis=1), first, stop)
    return _closed_form(list(windows.T), middle_a, middle_b)


def window_means(values: np.ndarray, first: np.ndarray, stop: np.ndarray) -> np.ndarray:
    """Return means over the rows from each `first` up to each `stop`, not included."""
    sums = np.concatenate([np.zeros((1, *values.shape[1:])), np.cumsum(values, axis=0)])
    return ((sums[stop] - sums[first]).T / (stop - first)).T


def horizontal_mean(values: np.ndarray) -> np.ndarray:
    """Return the mean x and y of all points and frames."""
    return values[..., :2].mean(axis=(0, 1))


def _horizontal(values: np.ndarray, middle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return values[..., 0] - middle[0], values[..., 1] - middle[1]


def _closed_form(means: list[np.ndarray], middle_a: np.ndarray, middle_b: np.ndarray) -> Alignment:
    """Return the alignment from the means of x, y, x', y', x x' + y y' and y x' - x y'."""
    mean_xa, mean_ya, mean_xb, mean_yb, dots, crosses = means
    dots = dots - (mean_xa * mean_xb + mean_ya * mean_yb)
    crosses = crosses - (mean_ya * mean_xb - mean_xa * mean_yb)
    angles = np.arctan2(crosses, dots)
    cos, sin = np.cos(angles), np.sin(angles)
    x, y = mean_xb + middle_b[0], mean_yb + middle_b[1]
    shift_x = mean_xa + middle_a[0] - (cos * x - sin * y)
    shift_y = mean_ya + middle_a[1] - (sin * x + cos * y)
    return Alignment(angles, np.stack([shift_x, shift_y], axis=-1))


def aligned_map(
    a: np.ndarray,
    b: np.ndarray,
    alignment: Alignment,
    weights: np.ndarray,
    *,
    shape: Shape,
    parameter: float = 1.0,
    translate: bool = True,
) -> np.ndarray:
    """Return ``sum_k w_k F(d_k)`` of all pairs of frames, the second clip aligned to the first.

    Positions, or velocities, which are only rotated, are of shape (frame, point, axis).
    """
    rows, columns = np.ascontiguousarray(a), np.ascontiguousarray(b.transpose(1, 2, 0))
    moves = np.zeros((4, len(a), len(b)))
    np.cos(alignment.angles, out=moves[0])
    np.sin(alignment.angles, out=moves[1])
    if translate:
        moves[2:] = np.moveaxis(alignment.shifts, 2, 0)
    result = np.empty((len(a), len(b)))
    form = SHAPE_CODES[shape], parameter

    def fill(start: int) -> None:
        block = slice(start, start + _ROWS)
        own = np.ascontiguousarray(moves[:, block])
        rows_of_aligned_map(rows[block], columns, weights, *form, own, result[block])

    in_threads(fill, range(0, len(a), _ROWS), few=result.size < 10_000)
    return result
