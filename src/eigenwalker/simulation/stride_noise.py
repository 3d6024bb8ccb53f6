"""How strides follow each other: a clock, step lengths and placements that vary a little."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from eigenwalker.simulation.cadence import Pace
from eigenwalker.simulation.cycle import Cycle

STEP_CV = 0.015
"""Variation of step length, and with it of step time: 1.5 to 2 per cent in healthy adults."""
STEP_WIDTH_SD_MM = 12.0
"""Variation of foot placement to the side; that of step width is sqrt(2) times as large."""
_PER_STRIDE = 200


@dataclass(frozen=True)
class Strides:
    """The course of a capture, frame by frame.

    Attributes
    ----------
    phase : array of shape (frame,)
        Cycles since the first left heel strike.
    longer : array of shape (side, frame)
        By which share the present step of a leg is longer than usual: constant while it stands.
    body_longer : array of shape (frame,)
        The same for pelvis and trunk, handed over from leg to leg in double support.
    placed : array of shape (side, frame)
        How far to the left of its usual place a foot is, in millimetres.
    wander : array of shape (frame, 2)
        Forward and lateral place of the body on the belt, in millimetres.
    moods : array of shape (stream, frame)
        Smooth unit noise, one stream for each thing that varies from stride to stride.

    """

    phase: np.ndarray
    longer: np.ndarray
    body_longer: np.ndarray
    placed: np.ndarray
    wander: np.ndarray
    moods: np.ndarray


N_STREAMS = 8


def walked_strides(
    time: np.ndarray,
    cycle: Cycle,
    pace: Pace,
    *,
    chance: np.random.Generator,
    variability: float,
    wander_mm: float,
) -> Strides:
    """Return the strides of a walk on a belt of constant speed.

    The body keeps its place on the belt but for a slow wander, so longer steps take longer. A leg
    changes the length of its step in swing only: what stands, stands.

    Parameters
    ----------
    time : array of shape (frame,)
        Seconds.
    cycle, pace
        How the person walks.
    chance : Generator
        Where noise comes from.
    variability : float
        0 for strides that are all alike, 1 for those of healthy adults.
    wander_mm : float
        SD of the slow wander on the belt.

    """
    n_strides = int(np.ceil(time[-1] * pace.frequency * 1.2)) + 3
    wander = wander_mm * slow_noise(chance, time, 4.0, 2).T * [1.0, 0.7]
    steps = STEP_CV * variability * persistent_noise(chance, 2 * n_strides).reshape(n_strides, 2).T
    grid = np.arange((n_strides - 1) * _PER_STRIDE) / _PER_STRIDE - 0.5
    on_grid = _step_lengths(grid, cycle, pace, steps)
    advance = pace.stride * np.cumsum(1 + _handed_over(grid, cycle, pace, on_grid)) / _PER_STRIDE
    advance -= np.interp(0.0, grid, advance)
    belt = pace.speed * time + wander[:, 0]
    even = not (variability or wander_mm)
    phase = pace.frequency * time if even else np.interp(belt - belt[0], advance, grid)
    longer = _step_lengths(phase, cycle, pace, steps)
    return Strides(
        phase=phase,
        longer=longer,
        body_longer=_handed_over(phase, cycle, pace, longer),
        placed=_placed(phase, cycle, pace, wander[:, 1], chance, variability),
        wander=wander,
        moods=variability * slow_noise(chance, phase, 1.5, N_STREAMS),
    )


def _step_lengths(phase: np.ndarray, cycle: Cycle, pace: Pace, steps: np.ndarray) -> np.ndarray:
    """Return by how much the present step of each leg is longer: array of shape (side, ...)."""
    pairs = zip(cycle.onsets, steps, strict=True)
    return np.stack([_held(phase - onset, own, pace.stance) for onset, own in pairs])


def _held(own: np.ndarray, steps: np.ndarray, stance: float) -> np.ndarray:
    """Return what each step of a leg brings: held in stance, changed smoothly in swing."""
    number = np.clip(np.floor(own).astype(int) + 1, 0, len(steps) - 2)
    swing = np.clip((own % 1.0 - stance) / (1 - stance), 0.0, 1.0)
    share = swing**3 * (10 - 15 * swing + 6 * swing**2)
    return steps[number] + share * (steps[number + 1] - steps[number])


def _handed_over(phase: np.ndarray, cycle: Cycle, pace: Pace, longer: np.ndarray) -> np.ndarray:
    """Return the step length of the leg that carries the body, in double support of both."""
    double = pace.stance - 0.5
    loads = []
    for onset in cycle.onsets:
        own = (phase - onset) % 1.0
        ramp = np.clip(np.minimum(own, pace.stance - own) / double, 0.0, 1.0)
        loads.append(ramp**2 * (3 - 2 * ramp) + 1e-9)
    return (loads[0] * longer[0] + loads[1] * longer[1]) / (loads[0] + loads[1])


def _placed(
    phase: np.ndarray, cycle: Cycle, pace: Pace, wander: np.ndarray,
    chance: np.random.Generator, variability: float,
) -> np.ndarray:  # fmt: skip
    """Return how far left of its usual place each foot is: where the body was when it landed."""
    placed = []
    for onset in cycle.onsets:
        strikes = np.arange(-1, int(phase[-1]) + 3) + onset
        there = np.interp(strikes, phase, wander)
        there += STEP_WIDTH_SD_MM * variability * chance.standard_normal(len(strikes))
        placed.append(_held(phase - onset, there, pace.stance))
    return np.stack(placed)


def persistent_noise(chance: np.random.Generator, n: int) -> np.ndarray:
    """Return noise of unit SD whose power falls with frequency, as that of stride times does.

    Examples
    --------
    >>> noise = persistent_noise(np.random.default_rng(0), 4096)
    >>> bool(np.corrcoef(noise[:-1], noise[1:])[0, 1] > 0.3)
    True

    """
    frequency = np.fft.rfftfreq(4 * n)
    weights = np.zeros(len(frequency))
    weights[1:] = frequency[1:] ** -0.4
    spectrum = weights * (chance.standard_normal((2, len(frequency))).T @ [1, 1j])
    return np.fft.irfft(spectrum, 4 * n)[:n] * 2 * n / np.linalg.norm(weights)


def slow_noise(
    chance: np.random.Generator, at: np.ndarray, period: float, n_streams: int
) -> np.ndarray:
    """Return smooth noise of unit SD with nothing faster than one swing a `period`.

    Array of shape (stream, frame).
    """
    span = max(at[-1] - at[0], period) * 1.3
    swings = np.arange(1, max(int(span / period), 1) + 1) / span
    amplitudes = chance.standard_normal((n_streams, 2 * len(swings))) / np.sqrt(len(swings))
    angle = 2 * np.pi * np.outer(swings, at)
    return amplitudes @ np.concatenate([np.cos(angle), np.sin(angle)])
