"""Transforms of time: faster, backwards, elsewhere in the cycle, from one walker to another."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from eigenwalker.stimulus.moving_dots import Moments, Moving
from eigenwalker.stimulus.random_streams import Purpose, uniforms
from eigenwalker.stimulus.transform_context import Stage


def speed(moving: Moving, stage: Stage, *, factor: float) -> Moving:
    """Play faster or slower: what was at ``factor t`` is at ``t``.

    Barclay, Cutting and Kozlowski (1978), experiment 2. Below 0 it plays backwards from the start.
    Keeps every dot's path.
    """
    return replace(
        moving, at=lambda time: moving.at(time * factor), period_s=moving.period_s / abs(factor)
    )


def reverse(moving: Moving, stage: Stage, *, end_s: float) -> Moving:
    """Play backwards: what was at ``end - t`` is at ``t``.

    With the stimulus' duration for the end it begins where it ended. Keeps every dot's path; twice
    is nothing.
    """
    return replace(moving, at=lambda time: moving.at(end_s - time))


def start(moving: Moving, stage: Stage, *, phase_deg: float) -> Moving:
    """Begin elsewhere in the cycle: what was at ``t + phase / 360 * period`` is at ``t``."""
    later = phase_deg / 360 * moving.period_s
    return replace(moving, at=lambda time: moving.at(time + later))


def freeze(moving: Moving, stage: Stage, *, time_s: float) -> Moving:
    """Stand still as at one moment: the static control of most studies."""
    return replace(moving, at=lambda time: moving.at(np.full(time.shape, time_s)))


def phase_scramble(moving: Moving, stage: Stage, *, seed: int, spread: float) -> Moving:
    """Let each dot run on a clock of its own: dot d is shown as at ``t + spread u_d period``.

    u_d is uniform from 0 to below 1, stream (PHASE_SCRAMBLE, seed, d, figure). Keeps each dot's
    path and tempo, breaks what the dots do together.
    """
    dots = np.arange(len(moving.dots))
    drawn = uniforms(Purpose.PHASE_SCRAMBLE, seed, dots, stage.figure, count=1).reshape(-1)
    return _shifted(moving, spread * drawn * moving.period_s)


def delay(moving: Moving, stage: Stage, *, markers: Sequence[str], phase_deg: float) -> Moving:
    """Let some dots lag: they are shown as at ``t - phase / 360 * period``.

    A perturbation of single joints that keeps their paths and the rest of the body.
    """
    lag = phase_deg / 360 * moving.period_s
    return _shifted(moving, np.array([-lag if dot in markers else 0.0 for dot in moving.dots]))


def _shifted(moving: Moving, shifts: np.ndarray) -> Moving:
    """A figure of which each dot runs ahead by a time of its own."""
    same = {shift: np.flatnonzero(shifts == shift) for shift in np.unique(shifts)}

    def at(time: np.ndarray) -> Moments:
        positions = np.empty((len(time), len(shifts), 3))
        visible = np.empty((len(time), len(shifts)), dtype=bool)
        for shift, dots in same.items():
            there = moving.at(time + shift)
            positions[:, dots] = there.positions[:, dots]
            visible[:, dots] = there.visible[:, dots]
        return Moments(positions, visible)

    return replace(moving, at=at)


def morph(moving: Moving, stage: Stage, *, walker: Moving, start_s: float, end_s: float) -> Moving:
    """Pass from the figure into another walker.

    The share w of the other grows from 0 at the start to 1 at the end, evenly. Both are taken at
    the same phase of their cycles and their places averaged, ``(1 - w) a + w b``, which is the
    average of their Fourier coefficients (WDP2002); the frequency ``(1 - w) f_a + w f_b`` passes
    evenly too, so that the phase in cycles is ``f_a t + (f_b - f_a) W(t)``, W being the integral of
    w. Before the start and after the end each is as it is by itself but for the phase.
    """
    order = [walker.dots.index(dot) for dot in moving.dots]
    lasts = end_s - start_s
    own_hz, other_hz = 1 / moving.period_s, 1 / walker.period_s

    def at(time: np.ndarray) -> Moments:
        share = np.clip((time - start_s) / lasts, 0, 1)
        gathered = share * share * lasts / 2 + np.maximum(time - end_s, 0)
        cycles = own_hz * time + (other_hz - own_hz) * gathered
        own = moving.at(cycles * moving.period_s)
        other = walker.at(cycles * walker.period_s)
        share = share[:, None, None]
        positions = (1 - share) * own.positions + share * other.positions[:, order]
        return Moments(positions, own.visible & other.visible[:, order])

    return replace(moving, at=at)
