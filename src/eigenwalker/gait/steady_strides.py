"""Which part of a capture is steady walking: standing, starting, turning and stopping left out."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from eigenwalker.core.fourier import fit_basis, harmonic_basis
from eigenwalker.gait.frequency import frequency_of_scores

N_HARMONICS = 3
"""Harmonics of the stride that steadiness is judged against; more would follow any wobble."""

TOLERATED_SHARE = 0.08
"""A half-stride belongs to the steady part if it departs from it by less than this share of the
movement's variance: two harmonics then explain 0.92 or more. Real walks reach 0.95 to 0.99."""

BROKEN_SHARE = 0.4
"""No steady part goes through a half-stride that departs by more: a stop, a turn, a stumble."""

TOLERANCE_BESIDE_CORE = 1.5
"""In a capture without a steady stride, this many times what its most regular strides depart by is
tolerated, so that something is kept; quality then says what it is worth."""

CORE_STRIDES = 2.0
"""Length of the piece from which a steady part is grown."""

MOST_CORES = 60
"""Pieces among which the most regular is looked for, however long the capture is."""

SEARCH_RATE_HZ = 30.0
"""Enough for the harmonics above, three times over."""

ONE_STRIDE_WITHIN = 0.25
"""How far the estimate of a single stride's frequency may be off."""

CLOSED_SHARE = 0.02
"""Squared distance of end and beginning, as a share of the movement's variance, up to which a
recording closes: an eightieth of a stride, or noise of a few millimetres."""

_MAX_ROUNDS = 30


class SteadyPart(NamedTuple):
    """Frames ``start`` to ``stop`` (not included) and the stride frequency they share."""

    start: int
    stop: int
    frequency_hz: float

    def strides(self, rate_hz: float) -> float:
        """Return how many strides the part holds."""
        return (self.stop - self.start) * self.frequency_hz / rate_hz


def body_relative(positions: np.ndarray) -> np.ndarray:
    """Return movement relative to the body, as columns, in which progress and drift do not show.

    Relative to the middle of all markers; with less than three, to a straight path.
    """
    n_frames, n_markers, _ = positions.shape
    if n_markers >= 3:
        return (positions - positions.mean(axis=1, keepdims=True)).reshape(n_frames, -1)
    frames = np.arange(n_frames) - (n_frames - 1) / 2
    columns = positions.reshape(n_frames, -1)
    columns = columns - columns.mean(axis=0)
    return columns - np.multiply.outer(frames, frames @ columns / (frames @ frames))


def steady_part(movement: np.ndarray, rate_hz: float) -> SteadyPart:
    """Return the longest part that one frequency and one posture cycle describe.

    Starting from the whole, or else from the most regular two strides, the part takes in every
    half-stride that its own cycle, played on, predicts, and gives up those that it does not, until
    nothing changes. An already steady walk is kept whole.

    Parameters
    ----------
    movement : array of shape (time, feature)
        Positions relative to the body, so that progress through the room is out.
    rate_hz : float
        Frames a second.

    Returns
    -------
    SteadyPart

    Raises
    ------
    ValueError
        If nothing moves, or for less than a stride.

    """
    block = max(1, int(rate_hz / SEARCH_RATE_HZ))
    n_blocks = len(movement) // block
    coarse = movement[: n_blocks * block].reshape(n_blocks, block, -1).mean(axis=1)
    rate = rate_hz / block
    whole = (0, n_blocks)
    window = _settle(coarse, rate, whole, TOLERATED_SHARE)
    if window != whole:
        core, irregularity = _most_regular(coarse, rate)
        tolerated = max(TOLERATED_SHARE, TOLERANCE_BESIDE_CORE * irregularity)
        grown = [_settle(coarse, rate, start, tolerated) for start in (whole, core)]
        window = max(core, *grown, key=lambda window: window[1] - window[0])
    start, stop = window[0] * block, window[1] * block
    if window[1] == n_blocks:
        stop = len(movement)
    return SteadyPart(start, stop, _frequency(movement[start:stop], rate_hz))


def _frequency(movement: np.ndarray, rate_hz: float) -> float:
    """Return strides a second; of a recording that closes after one stride, what its length says.

    A single stride tells its frequency badly, unless it goes over into its own beginning.
    """
    frequency_hz = frequency_of_scores(movement, rate_hz)
    once = abs(len(movement) * frequency_hz / rate_hz - 1) < ONE_STRIDE_WITHIN
    return rate_hz / len(movement) if once and closes(movement) else frequency_hz


def closes(movement: np.ndarray) -> bool:
    """Return whether movement goes on, after its last frame, as it began."""
    gap = movement[-1] - movement[0] + closing_step(movement)
    variance = movement.var(axis=0).sum()
    return bool(gap @ gap < CLOSED_SHARE * variance)


def closing_step(movement: np.ndarray) -> np.ndarray:
    """Return the way from the last frame to the first of the next stride."""
    return (movement[1] - movement[0] + movement[-1] - movement[-2]) / 2


def _settle(
    movement: np.ndarray, rate_hz: float, window: tuple[int, int], tolerated: float
) -> tuple[int, int]:
    """Return the window that taking in and giving up half-strides ends at; empty if none is."""
    seen = {window}
    for _ in range(_MAX_ROUNDS):
        departure, frequency = _departure(movement, rate_hz, window)
        stride = rate_hz / frequency
        smooth = _smoothed(departure, max(1, round(stride / 2)))
        broken = smooth > max(BROKEN_SHARE, 2 * tolerated)
        run = _best_run(np.where(broken, -np.inf, tolerated - smooth))
        if run[1] - run[0] < stride:
            return (0, 0)
        if run in seen:
            break
        seen.add(run)
        window = run
    return window


def _departure(
    movement: np.ndarray, rate_hz: float, window: tuple[int, int]
) -> tuple[np.ndarray, float]:
    """Return how far each frame is from the cycle of a window, as a share of its variance."""
    inside = movement[slice(*window)]
    frequency = frequency_of_scores(inside, rate_hz)
    cycles = np.arange(len(movement)) * frequency / rate_hz
    basis = harmonic_basis(cycles, N_HARMONICS)
    centre = inside.mean(axis=0)
    weights = fit_basis(basis[slice(*window)], inside - centre)
    residual = movement - centre - basis @ weights
    variance = np.vdot(inside - centre, inside - centre) / len(inside)
    return np.einsum("tf,tf->t", residual, residual) / variance, frequency


def _smoothed(values: np.ndarray, width: int) -> np.ndarray:
    """Return running means; at the ends over what there is."""
    kernel = np.ones(min(width, len(values)))
    counts = np.convolve(np.ones(len(values)), kernel, "same")
    return np.convolve(values, kernel, "same") / counts


def _best_run(gain: np.ndarray) -> tuple[int, int]:
    """Return the run of frames whose gains add up to most."""
    best, best_sum, start, total = (0, 0), -np.inf, 0, 0.0
    for frame, value in enumerate(gain.tolist()):
        if total <= 0:
            start, total = frame, 0.0
        total += value
        if total > best_sum:
            best, best_sum = (start, frame + 1), total
    return best


def _most_regular(movement: np.ndarray, rate_hz: float) -> tuple[tuple[int, int], float]:
    """Return the two strides that repeat best, among those that move much, and how they depart."""
    n_frames = len(movement)
    length = round(CORE_STRIDES * rate_hz / frequency_of_scores(movement, rate_hz))
    length = min(length, n_frames)
    n_starts = min(n_frames - length, 4 * (n_frames - length) // length + 1, MOST_CORES - 1) + 1
    starts = np.linspace(0, n_frames - length, n_starts).astype(int).tolist()
    windows = [(start, start + length) for start in starts]
    variances = [float(movement[slice(*window)].var(axis=0).sum()) for window in windows]
    lively = 0.5 * np.quantile(variances, 0.9)
    return min(
        (
            (window, float(_departure(movement, rate_hz, window)[0][slice(*window)].mean()))
            for window, variance in zip(windows, variances, strict=True)
            if variance >= lively
        ),
        key=lambda found: found[1],
    )
