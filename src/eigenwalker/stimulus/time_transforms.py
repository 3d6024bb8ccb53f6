"""Transforms of time: faster, backwards, elsewhere in the cycle, from one walker to another."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np
from pydantic import Field, field_validator, model_validator

from eigenwalker.stimulus.figure import WalkerPart
from eigenwalker.stimulus.moving_dots import Moments, MovingDots, walking
from eigenwalker.stimulus.random_streams import Purpose, uniforms
from eigenwalker.stimulus.transform_types import (
    Context,
    Degrees,
    Factor,
    Markers,
    Seconds,
    Seed,
    Share,
    Transform,
    problem,
)


class Speed(Transform):
    """Play faster or slower: what was at ``factor t`` is at ``t``.

    Barclay, Cutting and Kozlowski (1978), experiment 2. Below 0 it plays backwards from the start.
    Keeps every dot's path.
    """

    name: Literal["speed"]
    factor: Factor = Field(description="how much faster; not 0")

    @field_validator("factor")
    @classmethod
    def _moves(cls, factor: float) -> float:
        if factor == 0:
            raise problem("a factor of 0 stands still; use freeze")
        return factor

    def apply(self, moving: MovingDots, context: Context) -> MovingDots:
        period_s = moving.period_s / abs(self.factor)
        return replace(moving, at=lambda time: moving.at(time * self.factor), period_s=period_s)


class Reverse(Transform):
    """Play backwards: what was at ``end - t`` is at ``t``.

    With the stimulus' duration for the end it begins where it ended. Keeps every dot's path; twice
    is nothing.
    """

    name: Literal["reverse"]
    end_s: Seconds = Field(description="the moment it begins with")

    def apply(self, moving: MovingDots, context: Context) -> MovingDots:
        return replace(moving, at=lambda time: moving.at(self.end_s - time))


class Start(Transform):
    """Begin elsewhere in the cycle: what was at ``t + phase / 360 * period`` is at ``t``."""

    name: Literal["start"]
    phase_deg: Degrees = Field(description="how far in the cycle it begins")

    def apply(self, moving: MovingDots, context: Context) -> MovingDots:
        later = self.phase_deg / 360 * moving.period_s
        return replace(moving, at=lambda time: moving.at(time + later))


class Freeze(Transform):
    """Stand still as at one moment: the static control of most studies."""

    name: Literal["freeze"]
    time_s: Seconds = Field(0.0, description="the moment shown")

    def apply(self, moving: MovingDots, context: Context) -> MovingDots:
        return replace(moving, at=lambda time: moving.at(np.full(time.shape, self.time_s)))


class PhaseScramble(Transform):
    """Let each dot run on a clock of its own: dot d is shown as at ``t + spread u_d period``.

    u_d is uniform from 0 to below 1, stream (PHASE_SCRAMBLE, seed, d, figure). Keeps each dot's
    path and tempo, breaks what the dots do together.
    """

    name: Literal["phase_scramble"]
    seed: Seed = Field(description="seed of what is drawn at random")
    spread: Share = Field(1.0, description="share of the cycle clocks differ by")

    def apply(self, moving: MovingDots, context: Context) -> MovingDots:
        dots = np.arange(len(moving.dots))
        drawn = uniforms(Purpose.PHASE_SCRAMBLE, self.seed, dots, context.figure, count=1)
        return _shifted(moving, self.spread * drawn.reshape(-1) * moving.period_s)


class Delay(Transform):
    """Let some dots lag: they are shown as at ``t - phase / 360 * period``.

    A perturbation of single joints that keeps their paths and the rest of the body.
    """

    name: Literal["delay"]
    markers: Markers = Field(description="names of dots")
    phase_deg: Degrees = Field(description="share of the cycle they lag")

    def apply(self, moving: MovingDots, context: Context) -> MovingDots:
        lag = self.phase_deg / 360 * moving.period_s
        late = np.array([dot in self.markers for dot in moving.dots])
        return _shifted(moving, np.where(late, -lag, 0.0))


def _shifted(moving: MovingDots, shifts: np.ndarray) -> MovingDots:
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


class Morph(Transform):
    """Pass from the figure into another walker.

    The share of the other grows evenly from 0 at the start to 1 at the end. Both are taken at the
    same phase of their cycles and their places averaged, which averages their Fourier coefficients
    (Troje 2002, WDP); the frequency changes evenly too.
    """

    name: Literal["morph"]
    walker: WalkerPart = Field(description="into whom")
    start_s: Seconds = Field(description="when it begins")
    end_s: Seconds = Field(description="when it has passed, after the start")

    @model_validator(mode="after")
    def _ends_after_its_start(self) -> Morph:
        if not self.end_s > self.start_s:
            raise problem("it must end after it starts")
        return self

    def apply(self, moving: MovingDots, context: Context) -> MovingDots:
        target = walking(self.walker.to_walker(), moving.skeleton)
        order = [target.dots.index(dot) for dot in moving.dots]
        lasts = self.end_s - self.start_s
        own_hz, other_hz = 1 / moving.period_s, 1 / target.period_s

        def at(time: np.ndarray) -> Moments:
            share = np.clip((time - self.start_s) / lasts, 0, 1)
            gathered = share * share * lasts / 2 + np.maximum(time - self.end_s, 0)
            cycles = own_hz * time + (other_hz - own_hz) * gathered
            own = moving.at(cycles * moving.period_s)
            other = target.at(cycles * target.period_s)
            share = share[:, None, None]
            positions = (1 - share) * own.positions + share * other.positions[:, order]
            return Moments(positions, own.visible & other.visible[:, order])

        return replace(moving, at=at)
