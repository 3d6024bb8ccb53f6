"""Strides on a common clock, and their registration in phase, heading and place, pair by pair."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr

from eigenwalker.core.quaternions import quaternions_at, vectors_of
from eigenwalker.core.trajectories import trajectories_at
from eigenwalker.metric.clips import Loop
from eigenwalker.metric.frame_metrics import Metric, shape_parameter
from eigenwalker.metric.kernels import SHAPE_CODES, compiled, in_threads, mean_along_path
from eigenwalker.metric.paths import SLOPE_LIMIT, closed_path

CYCLE_FRAMES = 120
"""Frames of a stride on the common clock: about a hundred a second."""

N_HARMONICS = 10
"""Harmonics from which the global shift and heading are computed; above them is noise."""

BAND = CYCLE_FRAMES // 12
"""Frames by which one stride may be ahead of the other along the path. The moment at which a foot
lifts differs between people by less than half of that."""

_N_LEADS = 4 * BAND + 8
"""Leads for which distances are computed. A path needs `4 * BAND + 1`; whole vectors of numbers are
faster than a few fewer."""

_PAIRS = 16
"""Pairs that one thread takes at a time."""


def common_clock(loop: Loop) -> xr.DataArray:
    r"""Return a loop in `CYCLE_FRAMES` frames that begins at a phase given by its own movement.

    Uniform time scaling: every stride gets the same number of frames, its times keep its duration.
    With the Fourier coefficients X of all coordinates it begins at the phase
    :math:`-\tfrac12 \arg \sum X_1^2`, at which the fundamental of all markers together is farthest
    from its mean (one of two such phases, half a stride apart).
    """
    cycle = loop.cycle
    n_frames = cycle.sizes["time"]
    spectrum = np.fft.rfft(cycle.values, axis=0)
    origin = -0.5 * np.angle(np.sum(spectrum[1] ** 2)) if len(spectrum) > 1 else 0.0
    n_coefficients = min((n_frames - 1) // 2, (CYCLE_FRAMES - 1) // 2) + 1
    shifts = np.exp(1j * origin * np.arange(n_coefficients))[:, None, None]
    values = np.fft.irfft(spectrum[:n_coefficients] * shifts, CYCLE_FRAMES, axis=0)
    time = np.arange(CYCLE_FRAMES) * loop.period_s / CYCLE_FRAMES
    result = trajectories_at(time, values * CYCLE_FRAMES / n_frames, cycle.marker.values)
    if "rotation" in cycle.coords:
        phases = (np.arange(CYCLE_FRAMES) / CYCLE_FRAMES + origin / (2 * np.pi)) % 1
        quaternions = quaternions_at(cycle.rotation.values, phases * n_frames, wraps=True)
        result = result.assign_coords(rotation=(cycle.rotation.dims, vectors_of(quaternions)))
    return result.assign_attrs(cycle.attrs)


class RegisteredPairs(NamedTuple):
    """Pairs of cycles (pair, 2), rotations of the second in radians, and closed paths round both.

    `steps` has shape (pair, step, 2), of which each pair uses as many as `lengths` says.
    """

    pairs: np.ndarray
    angles: np.ndarray
    steps: np.ndarray
    lengths: np.ndarray

    def path(self, pair: int) -> np.ndarray:
        """Return the frames of both cycles along the path of a pair, of shape (step, 2)."""
        return self.steps[pair, : self.lengths[pair]].astype(int)


def register_pairs(cycles: np.ndarray, pairs: np.ndarray) -> RegisteredPairs:
    """Return how pairs of cycles (cycle, frame, point, axis) correspond, as in `register_walks`.

    The sums of its second step are correlations, computed from `N_HARMONICS` Fourier coefficients.
    """
    centred = cycles.copy()
    centred[..., :2] -= centred[..., :2].mean(axis=(1, 2), keepdims=True)
    spectra = np.ascontiguousarray(np.fft.rfft(centred, axis=1)[:, : N_HARMONICS + 1])
    single = centred.astype(np.float32)  # half the time; the error is a ten-thousandth of a mm
    registered = RegisteredPairs(
        pairs,
        np.empty(len(pairs)),
        np.empty((len(pairs), 2 * CYCLE_FRAMES + 2, 2), dtype=np.int16),
        np.empty(len(pairs), dtype=np.int64),
    )

    def register(start: int) -> None:
        block = slice(start, start + _PAIRS)
        _register(single, spectra, SLOPE_LIMIT, BAND, *(each[block] for each in registered))

    in_threads(register, range(0, len(pairs), _PAIRS))
    return registered


def mean_distances(points: np.ndarray, registered: RegisteredPairs, metric: Metric) -> np.ndarray:
    """Return means of F(d) along the path of each pair of cycles, of shape (pair, point)."""
    if metric.by == "positions":
        points = points.copy()
        points[..., :2] -= points[..., :2].mean(axis=(1, 2), keepdims=True)
    result = np.empty((len(registered.pairs), points.shape[2]))
    rotate = metric.by != "angles"
    form = SHAPE_CODES[metric.shape], shape_parameter(metric)

    def fill(start: int) -> None:
        block = slice(start, start + _PAIRS)
        _fill_means(points, rotate, *form, result[block], *(each[block] for each in registered))

    in_threads(fill, range(0, len(result), _PAIRS))
    return result


@compiled
def _register(positions, spectra, limit, band, pairs, angles, steps, lengths):
    """Fill in angles, steps and lengths of `RegisteredPairs`.

    positions: (cycle, frame, point, axis); spectra: (cycle, harmonic, point, axis), complex.
    """
    n_frames, n_points = positions.shape[1], positions.shape[2]
    columns = np.empty((n_points, 3, n_frames + _N_LEADS), positions.dtype)
    cost = np.empty((n_frames, _N_LEADS), positions.dtype)
    for p in range(len(pairs)):
        first, second = pairs[p, 0], pairs[p, 1]
        shift, angle = _global_shift(spectra[first], spectra[second], n_frames)
        _lay_out(positions[second], angle, columns)
        _map_near_line(positions[first], columns, (shift - 2 * band) % n_frames, cost)
        path = closed_path(cost, shift, limit, band)
        angles[p] = angle
        lengths[p] = len(path)
        for step in range(len(path)):
            steps[p, step, 0], steps[p, step, 1] = path[step, 0], path[step, 1]


@compiled
def _lay_out(positions, angle, columns):
    """Fill in rotated positions of a cycle as (point, axis, frame), repeated beyond its end."""
    n_frames = positions.shape[0]
    cos, sin = np.float32(np.cos(angle)), np.float32(np.sin(angle))
    for k in range(positions.shape[1]):
        for i in range(n_frames):
            x, y = positions[i, k, 0], positions[i, k, 1]
            columns[k, 0, i] = cos * x - sin * y
            columns[k, 1, i] = sin * x + cos * y
            columns[k, 2, i] = positions[i, k, 2]
    columns[:, :, n_frames:] = columns[:, :, : columns.shape[2] - n_frames]


@compiled
def _map_near_line(rows, columns, start, cost):
    """Fill in summed distances of each frame from those near the corresponding frame."""
    n_frames, n_points, n_leads = rows.shape[0], rows.shape[1], cost.shape[1]
    for i in range(n_frames):
        first = (start + i) % n_frames
        row = cost[i, :n_leads]
        row[:] = 0.0
        for k in range(n_points):
            x, y, z = rows[i, k, 0], rows[i, k, 1], rows[i, k, 2]
            xs, ys, zs = columns[k, 0, first:], columns[k, 1, first:], columns[k, 2, first:]
            for j in range(n_leads):
                dx, dy, dz = x - xs[j], y - ys[j], z - zs[j]
                row[j] += np.sqrt(dx * dx + dy * dy + dz * dz)


@compiled
def _global_shift(a, b, n_frames):
    """Return the shift in frames and rotation of the second cycle, step 2 of `register_walks`."""
    n_harmonics = a.shape[0]
    cross = np.zeros((3, n_harmonics), np.complex128)
    for h in range(n_harmonics):
        once = 1.0 if h == 0 else 2.0
        for k in range(a.shape[1]):
            ax, ay, az = a[h, k, 0], a[h, k, 1], a[h, k, 2]
            bx, by, bz = np.conj(b[h, k, 0]), np.conj(b[h, k, 1]), np.conj(b[h, k, 2])
            cross[0, h] += once * (ax * bx + ay * by)
            cross[1, h] += once * (ay * bx - ax * by)
            cross[2, h] += once * az * bz
    best, shift, angle = -np.inf, 0, 0.0
    for s in range(n_frames):
        dot, cross_product, vertical = 0.0, 0.0, 0.0
        step = np.exp(-2j * np.pi * s / n_frames)
        phase = 1.0 + 0.0j
        for h in range(n_harmonics):
            dot += (cross[0, h] * phase).real
            cross_product += (cross[1, h] * phase).real
            vertical += (cross[2, h] * phase).real
            phase *= step
        agreement = np.sqrt(dot * dot + cross_product * cross_product) + vertical
        if agreement > best:
            best, shift, angle = agreement, s, np.arctan2(cross_product, dot)
    return shift, angle


@compiled
def _fill_means(points, rotate, code, parameter, result, pairs, angles, steps, lengths):
    """Fill in means of F(d), of shape (pair, point); `rotate`: whether points have a heading."""
    for p in range(len(pairs)):
        other = points[pairs[p, 1]].copy()
        if rotate:
            cos, sin = np.cos(angles[p]), np.sin(angles[p])
            for i in range(points.shape[1]):
                for k in range(points.shape[2]):
                    x, y = other[i, k, 0], other[i, k, 1]
                    other[i, k, 0] = cos * x - sin * y
                    other[i, k, 1] = sin * x + cos * y
        path = steps[p, : lengths[p]]
        mean_along_path(path, points[pairs[p, 0]], other, code, parameter, result[p])
