"""The steady strides of a capture: without standing, starting, turning and stopping."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import numpy as np

from eigenwalker.core.fourier import fit_basis, harmonic_basis, share_explained
from eigenwalker.core.smoothing import running_mean
from eigenwalker.gait.frequency import frequency_of_scores

N_HARMONICS = 3
"""Harmonics of the stride that steadiness is judged against; more would follow any wobble."""

TOLERATED_SHARE = 0.08
"""A half-stride is steady if it departs from the common cycle by less than this share of the
movement's variance: two harmonics then explain 0.92 or more. Real walks reach 0.95 to 0.99."""

BROKEN_SHARE = 0.4
"""Steady strides end at a half-stride that departs by more: a stop, a turn, a stumble."""

TOLERANCE_BESIDE_CORE = 1.5
"""In a capture without a steady stride, this many times the departure of its most regular strides
is tolerated, so that some strides are taken; `assess` then judges them."""

CORE_STRIDES = 2.0
"""Length in strides of the piece from which the search starts."""

MOST_CORES = 60
"""Most pieces among which the most regular one is searched."""

SEARCH_RATE_HZ = 30.0
"""Three times what these harmonics need."""

ONE_STRIDE_WITHIN = 0.25
"""Relative error that the estimated frequency of a single stride may have."""

CLOSED_SHARE = 0.02
"""Squared distance of end and beginning, as a share of the movement's variance, up to which a
recording closes: an eightieth of a stride, or noise of a few millimetres."""

_MAX_ROUNDS = 30

Window = tuple[int, int]
"""First frame of a window, and the first one after it."""


class SteadyStrides(NamedTuple):
    """Frames ``start`` to ``stop`` (not included) and the stride frequency they share."""

    start: int
    stop: int
    frequency_hz: float

    def count(self, rate_hz: float) -> float:
        """Return the number of strides."""
        return (self.stop - self.start) * self.frequency_hz / rate_hz


def body_relative(positions: np.ndarray) -> np.ndarray:
    """Return the movement (time, feature) relative to the middle of all markers."""
    n_frames, n_markers, _ = positions.shape
    if n_markers >= 3:
        return (positions - positions.mean(axis=1, keepdims=True)).reshape(n_frames, -1)
    frames = np.arange(n_frames) - (n_frames - 1) / 2
    columns = positions.reshape(n_frames, -1)
    columns = columns - columns.mean(axis=0)
    return columns - np.multiply.outer(frames, frames @ columns / (frames @ frames))


def find_steady_strides(movement: np.ndarray, rate_hz: float) -> SteadyStrides:
    """Return the longest run of strides that one frequency and one cycle of postures describe.

    Starting from the whole capture, or else from the most regular two strides, the run takes in
    every half-stride that its own cycle predicts and drops those that it does not predict, until
    nothing changes. A capture that is steady throughout is taken whole.

    The movement (time, feature) is that of `body_relative`. Raises `NoStrideError` if nothing
    moves, or for less than a stride.
    """
    block = max(1, int(rate_hz / SEARCH_RATE_HZ))
    n_blocks = len(movement) // block
    coarse = movement[: n_blocks * block].reshape(n_blocks, block, -1).mean(axis=1)
    rate = rate_hz / block
    whole = (0, n_blocks)

    @cache
    def departure(window: Window) -> tuple[np.ndarray, float]:
        return _departure(coarse, rate, window)

    window = _settle(departure, whole, TOLERATED_SHARE)
    if window != whole:
        core, irregularity = _most_regular(coarse, rate, departure(whole)[1])
        tolerated = max(TOLERATED_SHARE, TOLERANCE_BESIDE_CORE * irregularity)
        grown = [_settle(departure, start, tolerated) for start in (whole, core)]
        window = max(core, *grown, key=lambda run: run[1] - run[0])
    start, stop = window[0] * block, window[1] * block
    if window[1] == n_blocks:
        stop = len(movement)
    return SteadyStrides(start, stop, _frequency(movement[start:stop], rate_hz))


def _frequency(movement: np.ndarray, rate_hz: float) -> float:
    """Return strides a second; of a recording that closes after one stride, that of its length."""
    frequency_hz = frequency_of_scores(movement, rate_hz)
    once = abs(len(movement) * frequency_hz / rate_hz - 1) < ONE_STRIDE_WITHIN
    return rate_hz / len(movement) if once and closes(movement) else frequency_hz


def closes(movement: np.ndarray) -> bool:
    """Return whether the last frame of a movement leads to its first."""
    gap = movement[-1] - movement[0] + closing_step(movement)
    variance = movement.var(axis=0).sum()
    return bool(gap @ gap < CLOSED_SHARE * variance)


def closing_step(movement: np.ndarray) -> np.ndarray:
    """Return the step from the last frame to the first of the next stride."""
    return (movement[1] - movement[0] + movement[-1] - movement[-2]) / 2


def _settle(
    departure_from: Callable[[Window], tuple[np.ndarray, float]], window: Window, tolerated: float
) -> Window:
    """Return the window at which taking in and dropping half-strides ends; else an empty one."""
    seen = {window}
    for _ in range(_MAX_ROUNDS):
        departure, stride = departure_from(window)
        smooth = running_mean(departure, max(1, round(stride / 2)))
        broken = smooth > max(BROKEN_SHARE, 2 * tolerated)
        run = _best_run(np.where(broken, -np.inf, tolerated - smooth))
        if run[1] - run[0] < stride:
            return (0, 0)
        if run in seen:
            break
        seen.add(run)
        window = run
    return window


def _departure(movement: np.ndarray, rate_hz: float, window: Window) -> tuple[np.ndarray, float]:
    """Return each frame's departure from the cycle of a window, and the frames of one stride."""
    inside = movement[slice(*window)]
    stride = rate_hz / frequency_of_scores(inside, rate_hz)
    cycles = np.arange(len(movement)) / stride
    basis = harmonic_basis(cycles, N_HARMONICS)
    centre = inside.mean(axis=0)
    weights = fit_basis(basis[slice(*window)], inside - centre)
    residual = movement - centre - basis @ weights
    variance = np.vdot(inside - centre, inside - centre) / len(inside)
    return np.einsum("tf,tf->t", residual, residual) / variance, stride


def _best_run(gain: np.ndarray) -> Window:
    """Return the run of frames with the largest sum of gains."""
    best, best_sum, start, total = (0, 0), -np.inf, 0, 0.0
    for frame, value in enumerate(gain.tolist()):
        if total <= 0:
            start, total = frame, 0.0
        total += value
        if total > best_sum:
            best, best_sum = (start, frame + 1), total
    return best


def _most_regular(movement: np.ndarray, rate_hz: float, stride: float) -> tuple[Window, float]:
    """Return the two strides that repeat best, among those that move much, and their departure."""
    n_frames = len(movement)
    length = min(round(CORE_STRIDES * stride), n_frames)
    n_starts = min(n_frames - length, 4 * (n_frames - length) // length + 1, MOST_CORES - 1) + 1
    starts = np.linspace(0, n_frames - length, n_starts).astype(int).tolist()
    windows = [(start, start + length) for start in starts]
    variances = [float(movement[slice(*window)].var(axis=0).sum()) for window in windows]
    lively = 0.5 * np.quantile(variances, 0.9)
    departures = {
        window: _own_departure(movement[slice(*window)], rate_hz)
        for window, variance in zip(windows, variances, strict=True)
        if variance >= lively
    }
    return min(departures.items(), key=lambda candidate: candidate[1])


def _own_departure(piece: np.ndarray, rate_hz: float) -> float:
    cycles = np.arange(len(piece)) * frequency_of_scores(piece, rate_hz) / rate_hz
    return 1 - share_explained(piece, cycles, N_HARMONICS)
