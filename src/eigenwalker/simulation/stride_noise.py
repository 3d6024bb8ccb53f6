"""How strides follow each other: phase, step lengths and foot placements that vary a little."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from eigenwalker.simulation.cycle import Cycle
from eigenwalker.simulation.prior_curves import GaitParameters

STEP_CV = 0.015
"""Variation of step length, and with it of step time: 1.5 to 2 per cent in healthy adults."""
STEP_WIDTH_SD_MM = 12.0
"""Variation of foot placement to the side; that of step width is sqrt(2) times as large."""
N_STREAMS = 8
_PER_STRIDE = 200


@dataclass(frozen=True)
class Strides:
    """The course of a capture, frame by frame.

    `phase` (frame,) counts cycles from the first left heel strike; by `lengthening` (side, frame) a
    leg's step is longer than usual, by `body_lengthening` (frame,) that of the leg that carries;
    `foot_shift` (side, frame) and `wander` (frame, 2) are places on the belt in mm; `noise`
    (stream, frame) is smooth and of unit SD.
    """

    phase: np.ndarray
    lengthening: np.ndarray
    body_lengthening: np.ndarray
    foot_shift: np.ndarray
    wander: np.ndarray
    noise: np.ndarray


def simulate_strides(
    time: np.ndarray,
    cycle: Cycle,
    gait: GaitParameters,
    *,
    rng: np.random.Generator,
    variability: float,
    wander_mm: float,
) -> Strides:
    """Return the strides of a walk on a belt of constant speed, at times (frame,) in seconds.

    The body keeps its place but for a slow wander, so longer steps take longer.
    """
    n_strides = int(np.ceil(time[-1] * gait.frequency * 1.2)) + 3
    wander = wander_mm * slow_noise(rng, time, 4.0, 2).T * [1.0, 0.7]
    steps = STEP_CV * variability * persistent_noise(rng, 2 * n_strides).reshape(n_strides, 2).T
    grid = np.arange((n_strides - 1) * _PER_STRIDE) / _PER_STRIDE - 0.5
    lengthening = _of_legs(grid, cycle, gait, steps)
    speed = 1 + _of_body(grid, cycle, gait, lengthening)
    advance = gait.stride_length * np.cumsum(speed) / _PER_STRIDE
    advance -= np.interp(0.0, grid, advance)
    belt = gait.speed * time + wander[:, 0]
    even = not (variability or wander_mm)
    phase = gait.frequency * time if even else np.interp(belt - belt[0], advance, grid)
    lengthening = _of_legs(phase, cycle, gait, steps)
    return Strides(
        phase=phase,
        lengthening=lengthening,
        body_lengthening=_of_body(phase, cycle, gait, lengthening),
        foot_shift=_foot_shift(phase, cycle, gait, wander[:, 1], rng, variability),
        wander=wander,
        noise=variability * slow_noise(rng, phase, 1.5, N_STREAMS),
    )


def _of_legs(
    phase: np.ndarray, cycle: Cycle, gait: GaitParameters, steps: np.ndarray
) -> np.ndarray:
    """Return by how much the present step of each leg is longer: array of shape (side, ...)."""
    pairs = zip(cycle.onsets, steps, strict=True)
    return np.stack([_held_in_stance(phase - onset, own, gait.stance) for onset, own in pairs])


def _of_body(
    phase: np.ndarray, cycle: Cycle, gait: GaitParameters, lengthening: np.ndarray
) -> np.ndarray:
    """Return the same for the leg that carries the body, in double support for both."""
    own = (phase - cycle.onsets[:, None]) % 1.0
    ramp = np.clip(np.minimum(own, gait.stance - own) / (gait.stance - 0.5), 0.0, 1.0)
    loads = ramp**2 * (3 - 2 * ramp) + 1e-9
    return (loads * lengthening).sum(axis=0) / loads.sum(axis=0)


def _held_in_stance(own: np.ndarray, steps: np.ndarray, stance: float) -> np.ndarray:
    """Return the value of each step of a leg: constant in stance, changed smoothly in swing."""
    number = np.clip(np.floor(own).astype(int) + 1, 0, len(steps) - 2)
    swing = np.clip((own % 1.0 - stance) / (1 - stance), 0.0, 1.0)
    share = swing**3 * (10 - 15 * swing + 6 * swing**2)
    return steps[number] + share * (steps[number + 1] - steps[number])


def _foot_shift(
    phase: np.ndarray, cycle: Cycle, gait: GaitParameters, wander: np.ndarray,
    rng: np.random.Generator, variability: float,
) -> np.ndarray:  # fmt: skip
    """Return how far left of its usual place each foot is: where the body was when it landed."""
    shifts = []
    for onset in cycle.onsets:
        strikes = np.arange(-1, int(phase[-1]) + 3) + onset
        landed = np.interp(strikes, phase, wander)
        landed += STEP_WIDTH_SD_MM * variability * rng.standard_normal(len(strikes))
        shifts.append(_held_in_stance(phase - onset, landed, gait.stance))
    return np.stack(shifts)


def persistent_noise(rng: np.random.Generator, n: int) -> np.ndarray:
    """Return noise of unit SD whose power falls with frequency, as that of stride times does."""
    frequency = np.fft.rfftfreq(4 * n)
    weights = np.zeros(len(frequency))
    weights[1:] = frequency[1:] ** -0.4
    spectrum = weights * (rng.standard_normal((2, len(frequency))).T @ [1, 1j])
    return np.fft.irfft(spectrum, 4 * n)[:n] * 2 * n / np.linalg.norm(weights)


def slow_noise(
    rng: np.random.Generator, at: np.ndarray, period: float, n_streams: int
) -> np.ndarray:
    """Return smooth noise of unit SD with nothing faster than one swing a `period`.

    Array of shape (stream, frame).
    """
    span = max(at[-1] - at[0], period) * 1.3
    frequencies = np.arange(1, max(int(span / period), 1) + 1) / span
    amplitudes = rng.standard_normal((n_streams, 2 * len(frequencies)))
    amplitudes /= np.sqrt(len(frequencies))
    angle = 2 * np.pi * np.outer(frequencies, at)
    return amplitudes @ np.concatenate([np.cos(angle), np.sin(angle)])
