"""Strides on a common clock: when they begin no longer matters, nor where and how fast they are."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr

from eigenwalker.core.quaternions import quaternions_at, vectors_of
from eigenwalker.core.trajectories import trajectories_at
from eigenwalker.metric.frame_metrics import ComparesFrames, shape_parameter
from eigenwalker.metric.kernels import SHAPE_CODES, compiled, mean_along_path
from eigenwalker.metric.loops import Loop
from eigenwalker.metric.paths import SLOPE_LIMIT, closed_path
from eigenwalker.metric.threads import in_threads

CYCLE_FRAMES = 120
"""Frames of a stride on the common clock: about a hundred a second."""

N_HARMONICS = 10
"""Harmonics that decide how cycles are turned and shifted on the whole; above them is noise."""

BAND = CYCLE_FRAMES // 12
"""Frames by which one stride may be ahead of the other in passing. When a foot lifts differs
between people by less than half of that."""

_LEADS = 4 * BAND + 8
"""Frames ahead for which distances are at hand, of which a path needs `4 * BAND + 1`: whole vectors
of numbers are quicker than a few less."""

_PAIRS = 16
"""Pairs that one thread takes at a time."""


def common_clock(loop: Loop) -> xr.DataArray:
    """Return a cycle at `CYCLE_FRAMES` evenly spaced phases, beginning where its own movement says.

    Uniform scaling: all strides get the same number of frames, time keeps the seconds they took.
    They begin where the fundamental, all markers together, is furthest from its middle; of the two
    such moments either.

    Parameters
    ----------
    loop : Loop
        A seamless cycle.

    Returns
    -------
    DataArray of shape (time, marker, axis)

    Examples
    --------
    >>> from eigenwalker.metric.loops import loop
    >>> cycle = common_clock(loop(ew.simulate_walk(seed=1, frequency_hz=0.8)))
    >>> cycle.sizes["time"], round(float(cycle.time[-1]) * 120 / 119, 2)
    (120, 1.25)

    """
    cycle = loop.cycle
    n_frames = cycle.sizes["time"]
    spectrum = np.fft.rfft(cycle.values, axis=0)
    origin = -0.5 * np.angle(np.sum(spectrum[1] ** 2)) if len(spectrum) > 1 else 0.0
    kept = min((n_frames - 1) // 2, (CYCLE_FRAMES - 1) // 2) + 1
    turns = np.exp(1j * origin * np.arange(kept))[:, None, None]
    values = np.fft.irfft(spectrum[:kept] * turns, CYCLE_FRAMES, axis=0) * CYCLE_FRAMES / n_frames
    time = np.arange(CYCLE_FRAMES) * loop.period_s / CYCLE_FRAMES
    result = trajectories_at(time, values, cycle.marker.values).assign_attrs(cycle.attrs)
    if "rotation" in cycle.coords:
        phases = (np.arange(CYCLE_FRAMES) / CYCLE_FRAMES + origin / (2 * np.pi)) % 1
        turns = quaternions_at(cycle.rotation.values, phases * n_frames, wraps=True)
        result = result.assign_coords(rotation=(cycle.rotation.dims, vectors_of(turns)))
    return result


class Registered(NamedTuple):
    """Pairs of cycles, registered: how the second is turned, and the closed path round both."""

    pairs: np.ndarray
    angles: np.ndarray
    steps: np.ndarray
    lengths: np.ndarray

    def path(self, pair: int) -> np.ndarray:
        """Return the frames of both cycles along the path, of shape (step, 2)."""
        return self.steps[pair, : self.lengths[pair]].astype(int)


def register_pairs(cycles: np.ndarray, pairs: np.ndarray) -> Registered:
    """Return how pairs of cycles lie over each other in phase, heading and place.

    Parameters
    ----------
    cycles : array of shape (cycle, frame, point, axis)
        Strides on the common clock.
    pairs : array of int of shape (pair, 2)
        Which with which.

    Returns
    -------
    Registered

    """
    centred = cycles.copy()
    centred[..., :2] -= centred[..., :2].mean(axis=(1, 2), keepdims=True)
    spectra = np.ascontiguousarray(np.fft.rfft(centred, axis=1)[:, : N_HARMONICS + 1])
    single = centred.astype(np.float32)  # half the time, and off by a ten-thousandth of a mm
    found = Registered(
        pairs,
        np.empty(len(pairs)),
        np.empty((len(pairs), 2 * CYCLE_FRAMES + 2, 2), dtype=np.int16),
        np.empty(len(pairs), dtype=np.int64),
    )

    def register(start: int) -> None:
        some = slice(start, start + _PAIRS)
        _register(single, spectra, SLOPE_LIMIT, BAND, *(each[some] for each in found))

    in_threads(register, range(0, len(pairs), _PAIRS))
    return found


def mean_distances(points: np.ndarray, found: Registered, metric: ComparesFrames) -> np.ndarray:
    """Return for each pair of cycles, and each point, the mean of F(d) along their path.

    Parameters
    ----------
    points : array of shape (cycle, frame, point, part)
        What is compared: positions, velocities or orientations.
    found : Registered
        How the cycles lie over each other.
    metric : FrameMetric
        Of which what is compared and F count.

    Returns
    -------
    array of shape (pair, point)

    """
    if metric.by == "positions":
        points = points.copy()
        points[..., :2] -= points[..., :2].mean(axis=(1, 2), keepdims=True)
    result = np.empty((len(found.pairs), points.shape[2]))
    form = SHAPE_CODES[metric.shape], shape_parameter(metric)

    def fill(start: int) -> None:
        some = slice(start, start + _PAIRS)
        _fill_means(points, metric.by != "angles", *form, result[some], *(e[some] for e in found))

    in_threads(fill, range(0, len(found.pairs), _PAIRS))
    return result


@compiled
def _register(positions, spectra, limit, band, pairs, angles, steps, lengths):
    """Fill in angles, steps and lengths of pairs, as in `Registered`.

    positions: (cycle, frame, point, axis); spectra: (cycle, harmonic, point, axis), complex.
    """
    n_frames, n_points = positions.shape[1], positions.shape[2]
    columns = np.empty((n_points, 3, n_frames + _LEADS), positions.dtype)
    cost = np.empty((n_frames, _LEADS), positions.dtype)
    for p in range(len(pairs)):
        first, second = pairs[p, 0], pairs[p, 1]
        shift, angle = _on_the_whole(spectra[first], spectra[second], n_frames)
        _lay_out(positions[second], angle, columns)
        _map_near_line(positions[first], columns, (shift - 2 * band) % n_frames, cost)
        path = closed_path(cost, shift, limit, band)
        angles[p] = angle
        lengths[p] = len(path)
        for step in range(len(path)):
            steps[p, step, 0], steps[p, step, 1] = path[step, 0], path[step, 1]


@compiled
def _lay_out(positions, angle, columns):
    """Fill in turned positions of a cycle as (point, axis, frame), beyond its end begun again."""
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
    """Fill in mean distances of each frame from those about the frame that corresponds to it."""
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
def _on_the_whole(a, b, n_frames):
    """Shift in frames and turn of the second cycle at which it is nearest to the first.

    The closed form of Kovar, Gleicher & Pighin (2002) for all frames at once, at every shift: the
    sums over frames are correlations, which the spectra give.
    """
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
    best, shift, turn = -np.inf, 0, 0.0
    for s in range(n_frames):
        along, across, upright = 0.0, 0.0, 0.0
        step = np.exp(-2j * np.pi * s / n_frames)
        phase = 1.0 + 0.0j
        for h in range(n_harmonics):
            along += (cross[0, h] * phase).real
            across += (cross[1, h] * phase).real
            upright += (cross[2, h] * phase).real
            phase *= step
        agreement = np.sqrt(along * along + across * across) + upright
        if agreement > best:
            best, shift, turn = agreement, s, np.arctan2(across, along)
    return shift, turn


@compiled
def _fill_means(points, turns, code, parameter, result, pairs, angles, steps, lengths):
    """Fill in means of F(d), of shape (pair, point); `turns` says whether points turn with us."""
    n_frames, n_points = points.shape[1], points.shape[2]
    for p in range(len(pairs)):
        other = points[pairs[p, 1]].copy()
        if turns:
            cos, sin = np.cos(angles[p]), np.sin(angles[p])
            for i in range(n_frames):
                for k in range(n_points):
                    x, y = other[i, k, 0], other[i, k, 1]
                    other[i, k, 0] = cos * x - sin * y
                    other[i, k, 1] = sin * x + cos * y
        path = steps[p, : lengths[p]]
        mean_along_path(path, points[pairs[p, 0]], other, code, parameter, result[p])
