"""The stride of one person as a least-squares problem: what the ground asks of drawn movement.

The unknowns are the Fourier coefficients of thigh, knee and pitch of both feet, the places of
their prints, and the coefficients of the pelvis' path up and ahead.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from copy import copy
from dataclasses import replace

import numpy as np

from eigenwalker.core.fourier import harmonic_basis
from eigenwalker.simulation.body import Body
from eigenwalker.simulation.posture import SIDES, rotated, trunk_rotations
from eigenwalker.simulation.prior_curves import (
    LEG_HARMONICS,
    PELVIS_HARMONICS,
    GaitParameters,
    leg_curves,
    pelvis_paths,
    trunk_curves,
)

_FRAMES = 96
_LEG = 2 * LEG_HARMONICS + 1
_PELVIS = 2 * PELVIS_HARMONICS + 1
_ONE_LEG = 3 * _LEG + 1
"""Unknowns of a leg: three curves and the place of its print."""

_CONTACT_MM = 0.5
_FLAT = (0.10, 0.28)
"""When the whole sole is on the ground, shares of a stride."""
_FLAT_RAD = np.radians(0.7)
_LEAST_KNEE = np.radians(2.5)
_KNEE_RAD = np.radians(0.5)
_CLEARANCE_MM = 16.0
_SPREAD_RAD = np.radians([[1.5], [1.3], [2.3]])
"""How far thigh, knee and pitch may be from what was drawn; higher harmonics less."""
_RISE_MM, _BOB_MM, _AHEAD_MM = 1.2, 0.4, 5.0
"""How far the pelvis may be from it: other harmonics, the second one of its height, fore-aft."""
_ONE = np.ones(2 * _FRAMES)

_Residual = tuple[np.ndarray, dict[str, np.ndarray], np.ndarray, float]


class Ground:
    """What a person's stride should be, and by how much a stride misses it.

    `prior` is what was drawn, `precision` one over its variance (unknown,), `onsets` (side,) the
    heel strikes in strides; `sway` (coefficient,), the pelvis' path to the side, stays as drawn.
    """

    def __init__(self, person: Mapping[str, float], body: Body, gait: GaitParameters) -> None:
        self.body, self.gait = body, gait
        phase = np.arange(_FRAMES) / _FRAMES
        self.onsets = np.array([0.0, 0.5 + person["step_asymmetry"]])
        phases = (phase - self.onsets[:, None]) % 1.0
        self._phase, self._side = phases.ravel(), np.repeat(list(SIDES.values()), _FRAMES)
        self._legs = [harmonic_basis(own, LEG_HARMONICS) for own in phases]
        trunk = harmonic_basis(phase, PELVIS_HARMONICS)
        self._paths = np.concatenate([trunk, trunk])
        self._by = _derivatives(self._legs, self._paths)
        self._yaw = np.radians(person["foot_progression_deg"])
        curves = trunk_curves(person, body, gait)
        rotations = trunk_rotations({name: trunk @ curves[name] for name in curves}, "pelvis")
        ahead, self.sway, rise = pelvis_paths(person, gait)
        self._hips = np.concatenate(
            [rotated(body.hip * [1, side, 1], rotations) for side in SIDES.values()]
        )
        self._hips[:, 1] += np.tile(trunk @ self.sway, 2)
        rise[0] = 0.985 * (body.thigh + body.shank) + body.foot.height - body.hip[2]
        self.prior = self._prior(person, rise, ahead[1:])
        self.precision = _precision()

    def _prior(
        self, person: Mapping[str, float], rise: np.ndarray, ahead: np.ndarray
    ) -> np.ndarray:
        curves = np.array(leg_curves(person, self.gait.effort))
        half = np.radians([person["thigh_asymmetry_deg"], person["knee_asymmetry_deg"]]) / 2
        legs = []
        for side in SIDES.values():
            own = curves.copy()
            own[:2, 0] += side * half
            legs += [*own.ravel(), self._first_print(own)]
        return np.concatenate([legs, rise, ahead])

    def _first_print(self, own: np.ndarray) -> float:
        """Return where the ball of a foot is put at its heel strike if nothing is changed."""
        thigh, knee = (harmonic_basis(np.array([0.0]), LEG_HARMONICS) @ own[:2].T)[0]
        reach = self.body.thigh * np.sin(thigh) + self.body.shank * np.sin(thigh - knee)
        return reach + self.body.foot.ball

    def split(self, unknown: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return curves (side, joint, coefficient), prints (side,), pelvis (axis, coefficient)."""
        legs = unknown[: 2 * _ONE_LEG].reshape(2, -1)
        rise, ahead = np.split(unknown[2 * _ONE_LEG :], [_PELVIS])
        pelvis = np.array([np.concatenate([[0.0], ahead]), np.zeros(_PELVIS), rise])
        return legs[:, :-1].reshape(2, 3, _LEG), legs[:, -1], pelvis

    def with_stride_length(self, length: float) -> Ground:
        """Return the same problem for another length of the stride."""
        other = copy(self)
        other.gait = replace(self.gait, stride_length=length)
        return other

    def linearised(self, unknown: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return all residuals, each divided by its tolerance, and their Jacobian."""
        residuals, blocks = [], []
        for residual, slopes, when, tolerance in self._residuals(unknown):
            rows = np.flatnonzero(when)
            residuals.append(residual[rows] / tolerance)
            block = np.zeros((len(rows), len(self.prior)))
            for name, slope in slopes.items():
                columns, derivative = self._by[name]
                block[:, columns] += (slope[rows] / tolerance)[:, None] * derivative[rows]
            blocks.append(block)
        return np.concatenate(residuals), np.concatenate(blocks)

    def _residuals(self, unknown: np.ndarray) -> Iterator[_Residual]:
        """Yield what the legs miss, its slopes, the frames where it counts, and the tolerance.

        Frames of the left leg, then those of the right one.
        """
        curves, prints, pelvis = self.split(unknown)
        body, foot, phase = self.body, self.body.foot, self._phase
        thigh, knee, pitch = np.concatenate(
            [leg @ waves.T for leg, waves in zip(curves, self._legs, strict=True)], axis=1
        )
        shank = thigh - knee
        forward = body.thigh * np.sin(thigh) + body.shank * np.sin(shank)
        down = body.thigh * np.cos(thigh) + body.shank * np.cos(shank)
        hip = self._hips + self._paths @ pelvis.T
        foot_y = ankle_to_the_side(self._side, self.gait, body, self._yaw, pitch)
        upright = np.sqrt(1 - ((foot_y - hip[:, 1]) / down) ** 2)
        x, z = hip[:, 0] + forward, hip[:, 2] - upright * down
        by_x = {"thigh": down, "knee": -body.shank * np.cos(shank), "ahead": _ONE, "print": -_ONE}
        by_z = {"thigh": upright * forward, "knee": -upright * body.shank * np.sin(shank)}
        by_z["rise"] = _ONE

        stands = phase <= self.gait.stance
        over, rolling = foot.ankle_over_print(pitch)
        along = np.cos(self._yaw)
        belt = np.repeat(prints, _FRAMES) - self.gait.stride_length * phase
        miss_x = x - belt - along * over[:, 0]
        yield miss_x, by_x | {"pitch": -along * rolling[:, 0]}, stands, _CONTACT_MM
        yield z - over[:, 1], by_z | {"pitch": -rolling[:, 1]}, stands, _CONTACT_MM
        yield pitch, {"pitch": _ONE}, (phase > _FLAT[0]) & (phase < _FLAT[1]), _FLAT_RAD
        yield knee - _LEAST_KNEE, {"knee": _ONE}, knee < _LEAST_KNEE, _KNEE_RAD
        sole, swinging = foot.sole_under_ankle(pitch)
        room = _clearance(phase, self.gait.stance)
        for point in range(sole.shape[1]):
            miss = z + sole[:, point, 1] - room
            low = ~stands & (miss < 0)
            yield miss, by_z | {"pitch": swinging[:, point, 1]}, low, 2 * _CONTACT_MM


def _derivatives(legs: list[np.ndarray], paths: np.ndarray) -> dict[str, tuple[slice, np.ndarray]]:
    """Return of angles, print and pelvis the derivatives by the unknowns, in some columns."""
    end = 2 * _ONE_LEG + _PELVIS
    by = {
        "rise": (slice(2 * _ONE_LEG, end), paths),
        "ahead": (slice(end, end + _PELVIS - 1), paths[:, 1:]),
    }
    ones = [np.ones((_FRAMES, 1))] * 2
    for number, name in enumerate(("thigh", "knee", "pitch", "print")):
        first, second = ones if name == "print" else legs
        both = np.zeros((2 * _FRAMES, _ONE_LEG + first.shape[1]))
        both[:_FRAMES, : first.shape[1]], both[_FRAMES:, _ONE_LEG:] = first, second
        by[name] = slice(number * _LEG, number * _LEG + both.shape[1]), both
    return by


def _precision() -> np.ndarray:
    harmonic = np.concatenate([[1], np.repeat(np.arange(1, LEG_HARMONICS + 1), 2)])
    leg = [*(_SPREAD_RAD / harmonic**0.7).ravel(), 100.0]
    harmonic = np.repeat(np.arange(1, PELVIS_HARMONICS + 1), 2)
    rise = np.concatenate([[30.0], _RISE_MM / harmonic])
    rise[3:5] = _BOB_MM
    return np.concatenate([leg, leg, rise, _AHEAD_MM / harmonic]) ** -2.0


def ankle_to_the_side(
    side: int | np.ndarray, gait: GaitParameters, body: Body, yaw: float, pitch: np.ndarray
) -> np.ndarray:
    """Return the lateral place of an ankle: half a step width from the middle.

    It swings about the ball of the foot as the foot, toes out, rolls over it.
    """
    rolled = body.foot.ankle_over_ball(pitch) + body.foot.ball
    return side * (gait.step_width / 2 - np.sin(yaw) * rolled)


def _clearance(phase: np.ndarray, stance: float) -> np.ndarray:
    """Return the least height of the sole in swing, less near toe-off and heel strike."""
    swing = (phase - stance) / (1 - stance)
    return _CLEARANCE_MM * np.clip(np.minimum(swing / 0.15, (1 - swing) / 0.12), 0.0, 1.0)
