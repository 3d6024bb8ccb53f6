"""One stride, solved: the joint angles nearest to a person's draw whose feet hold the ground.

A person asks for a step length, a step width and a range of vertical and lateral movement, and
has joint angles drawn about published norms. Both cannot be had at once. The cycle that walks is
the most probable one: Gauss-Newton finds the least change of the drawn angles, in units of what
people differ by, for which the planted feet stay where they are, the swinging ones clear the
ground, and the pelvis moves as asked.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from eigenwalker.simulation.body import GRAVITY, Body, body_of
from eigenwalker.simulation.norms import FREE_SPEED, basis, later, norm_coefficients
from eigenwalker.simulation.posture import SIDES, trunk_turns, turned

LEG_HARMONICS = 8
PELVIS_HARMONICS = 6
_CONTACT_MM = 0.5
_LEAST_KNEE = np.radians(3.0)
_FRAMES = 120
_MOST_STEPS = 30
_ENOUGH = 1.0
_LEG = 2 * LEG_HARMONICS + 1
_PELVIS = 2 * PELVIS_HARMONICS + 1


@dataclass(frozen=True)
class Pace:
    """How a person gets along; `effort` is the dimensionless speed at which steps are as long."""

    stride: float
    frequency: float
    effort: float
    stance: float
    step_width: float
    vertical_range: float
    lateral_range: float

    @property
    def speed(self) -> float:
        """Forward speed in mm/s."""
        return self.stride * self.frequency


def pace_of(person: Mapping[str, float], body: Body) -> Pace:
    """Return a person's pace: speed from stride and cadence, pelvis movement from speed.

    The vertical range grows from 27 mm at 0.7 m/s to 48 mm at 1.6, the lateral one shrinks from
    70 to 39 mm (Orendurff et al. 2004).
    """
    stride = person["stride_share"] * body.height
    speed = stride * person["frequency_hz"]
    faster = (speed / 1000 - 0.7) / 0.9
    # Schwartz et al. (2008): steps of 0.64, 0.76, 0.85 leg lengths at 0.29, 0.43, 0.56.
    effort = FREE_SPEED + (stride / 2 / body.leg - 0.76) / 0.78
    dimensionless = speed / np.sqrt(GRAVITY * body.leg)
    return Pace(
        stride=stride,
        frequency=person["frequency_hz"],
        effort=effort,
        stance=person["stance_share"] - 0.1 * (dimensionless - 0.38),
        step_width=max(person["step_width_mm"], 45.0),
        vertical_range=max(27 + 21 * faster + person["vertical_mm"], 12.0),
        lateral_range=max(70 - 31 * faster + person["lateral_mm"], 10.0),
    )


@dataclass(frozen=True)
class Cycle:
    """Fourier coefficients of one stride: angles in radians, the pelvis' path in millimetres.

    `legs` has shape (side, joint, coefficient) for thigh, knee and pitch of the foot over the
    side's own phase, which is 0 at its heel strike (at phase `onsets` of the left side); `pelvis`
    has shape (axis, coefficient) over the left side's phase. `legs_longer` and `pelvis_longer`
    are what is added for each unit by which a step is longer than the person's own.
    """

    legs: np.ndarray
    pelvis: np.ndarray
    legs_longer: np.ndarray
    pelvis_longer: np.ndarray
    onsets: np.ndarray


def trunk_curves(person: Mapping[str, float], effort: float) -> dict[str, np.ndarray]:
    """Return Fourier coefficients, in radians, of pelvis and trunk against the room.

    The trunk's are the norms of trunk on pelvis and of the pelvis added up: a person's trunk does
    not copy what is particular about the pelvis but for half of its rotation.
    """

    def curve(name: str, factor: str | None = None, lag: str | None = None) -> np.ndarray:
        norm = np.radians(norm_coefficients(name, effort, PELVIS_HARMONICS))
        return later(norm * (person[factor] if factor else 1), person[lag] if lag else 0)

    listing = curve("pelvis_obliquity", "obliquity_factor", "obliquity_lag")
    rotation = curve("pelvis_rotation", "pelvis_rotation_factor", "pelvis_rotation_lag")
    lean = curve("trunk_obliquity") + curve("pelvis_obliquity")
    turning = curve("trunk_rotation", "trunk_rotation_factor", "trunk_rotation_lag")
    tilt, upright = curve("pelvis_tilt"), np.zeros(_PELVIS)
    tilt[0] += np.radians(person["pelvis_tilt_deg"])
    upright[0] = np.radians(person["trunk_tilt_deg"])
    return {
        "pelvis_tilt": tilt,
        "pelvis_obliquity": listing,
        "pelvis_rotation": rotation,
        "trunk_tilt": upright,
        "trunk_obliquity": later(lean * person["trunk_lean_factor"], person["trunk_lean_lag"]),
        "trunk_rotation": turning + 0.5 * (rotation + curve("pelvis_rotation")),
    }


def solve_cycle(person: Mapping[str, float]) -> Cycle:
    """Return the stride that a person walks.

    Parameters
    ----------
    person : mapping
        Parameters of `traits.PARAMETERS`.

    Returns
    -------
    Cycle

    """
    body = body_of(person)
    pace = pace_of(person, body)
    own = _Problem(person, body, pace)
    best = _least_change(own, own.prior)
    slope = _change_with_stride(
        own, _Problem(person, body, replace(pace, stride=2 * pace.stride)), best
    )
    legs, _, pelvis = own.split(best)
    legs_slope, _, pelvis_slope = own.split(slope)
    sway = np.array([np.zeros(_PELVIS), own.sway, np.zeros(_PELVIS)])
    return Cycle(legs, pelvis + sway, legs_slope, pelvis_slope, own.onsets)


def _least_change(problem: _Problem, unknown: np.ndarray) -> np.ndarray:
    """Return the most probable cycle: Gauss-Newton, its steps shortened where they overshoot."""

    def cost(residual: np.ndarray, unknown: np.ndarray) -> float:
        return float(residual @ residual + problem.precision @ (unknown - problem.prior) ** 2)

    residual, slopes = problem.linearised(unknown)
    now = cost(residual, unknown)
    for _ in range(_MOST_STEPS):
        pull = problem.precision * (problem.prior - unknown) - slopes.T @ residual
        step = np.linalg.solve(slopes.T @ slopes + np.diag(problem.precision), pull)
        for _ in range(6):
            residual, slopes = problem.linearised(unknown + step)
            then = cost(residual, unknown + step)
            if then < now:
                break
            step = 0.4 * step
        else:
            return unknown
        unknown, gain, now = unknown + step, now - then, then
        if gain < _ENOUGH:
            break
    return unknown


def _change_with_stride(own: _Problem, doubled: _Problem, best: np.ndarray) -> np.ndarray:
    """Return how the solution moves for each unit by which the stride is longer.

    Residuals are linear in the stride, so one solution of the linearised problem tells.
    """
    residual, slopes = own.linearised(best)
    missed, _ = doubled.linearised(best)
    normal = slopes.T @ slopes + np.diag(own.precision)
    return np.linalg.solve(normal, slopes.T @ (residual - missed))


class _Problem:
    """What the feet ask for, and what the person was drawn to do."""

    def __init__(self, person: Mapping[str, float], body: Body, pace: Pace) -> None:
        self.body, self.pace = body, pace
        phase = np.arange(_FRAMES) / _FRAMES
        self.onsets = np.array([0.0, 0.5 + person["step_asymmetry"]])
        self.phases = (phase - self.onsets[:, None]) % 1.0
        self.legs = [basis(own, LEG_HARMONICS) for own in self.phases]
        self.trunk = basis(phase, PELVIS_HARMONICS)
        self.yaw = np.radians(person["foot_progression_deg"])
        curves = trunk_curves(person, pace.effort)
        turns = trunk_turns({name: self.trunk @ curve for name, curve in curves.items()}, "pelvis")
        self.hips = [turned(body.hip * [1, side, 1], turns) for side in SIDES.values()]
        self.sway = later(_sway(pace), person["sway_lag"])
        self.prior, self.precision = self._prior(person)

    def _prior(self, person: Mapping[str, float]) -> tuple[np.ndarray, np.ndarray]:
        thigh, knee, pitch = _drawn_legs(person, self.pace.effort)
        harmonic = np.concatenate([[0], np.repeat(np.arange(1, LEG_HARMONICS + 1), 2)])
        legs, leg_sds = [], []
        for side in SIDES.values():
            half = np.radians([person["thigh_asymmetry_deg"], person["knee_asymmetry_deg"]]) / 2
            own = np.array([thigh, knee, pitch])
            own[:2, 0] += side * half
            legs += [*own.ravel(), self._first_print(own)]
            spread = np.radians(np.array([[1.5], [2.0], [3.0]]) / np.maximum(harmonic, 1) ** 0.7)
            leg_sds += [*spread.ravel(), 100.0]
        pelvis_harmonic = np.repeat(np.arange(1, PELVIS_HARMONICS + 1), 2)
        height = 0.985 * (self.body.thigh + self.body.shank) + self.body.foot.height
        rise = np.zeros(_PELVIS)
        rise[0] = height - self.body.hip[2]
        top = (
            4 * np.pi * (0.30 + person["bob_lag"])
        )  # highest at 30 and 80 per cent (Orendurff et al. 2004)
        rise[3:5] = self.pace.vertical_range / 2 * np.array([np.cos(top), np.sin(top)])
        rise_sd = np.concatenate([[30.0], 1.2 / pelvis_harmonic])
        rise_sd[3:5] = 0.5
        ahead_sd = 4.0 / pelvis_harmonic
        prior = np.concatenate([legs, rise, np.zeros(_PELVIS - 1)])
        return prior, np.concatenate([leg_sds, rise_sd, ahead_sd]) ** -2.0

    def _first_print(self, own: np.ndarray) -> float:
        """Where the ball of a foot comes to stand at its heel strike if nothing is changed."""
        thigh, knee = (basis(np.array([0.0]), LEG_HARMONICS) @ own[:2].T)[0]
        reach = self.body.thigh * np.sin(thigh) + self.body.shank * np.sin(thigh - knee)
        return reach + self.body.foot.ball

    def split(self, unknown: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return leg curves (side, joint, coefficient), prints (side,), pelvis (axis, ...)."""
        legs = unknown[: 2 * (3 * _LEG + 1)].reshape(2, -1)
        rise, ahead = np.split(unknown[2 * (3 * _LEG + 1) :], [_PELVIS])
        pelvis = np.array([np.concatenate([[0.0], ahead]), np.zeros(_PELVIS), rise])
        return legs[:, :-1].reshape(2, 3, _LEG), legs[:, -1], pelvis

    def linearised(self, unknown: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return all residuals, each divided by its tolerance, and their derivatives."""
        parts = [self._leg(unknown, leg) for leg in range(2)]
        return (
            np.concatenate([residual for residual, _ in parts]),
            np.concatenate([slopes for _, slopes in parts]),
        )

    def _leg(self, unknown: np.ndarray, leg: int) -> tuple[np.ndarray, np.ndarray]:
        """Return what a leg misses, in tolerances, and its derivatives."""
        curves, prints, pelvis = self.split(unknown)
        body, waves, own = self.body, self.legs[leg], self.phases[leg]
        thigh, knee, pitch = curves[leg] @ waves.T
        shank = thigh - knee
        over, over_slope = body.foot.ankle_over_print(pitch)
        forward = body.thigh * np.sin(thigh) + body.shank * np.sin(shank)
        down = body.thigh * np.cos(thigh) + body.shank * np.cos(shank)
        hip = self.hips[leg] + self.trunk @ pelvis.T
        hip[:, 1] += self.trunk @ self.sway
        side = list(SIDES.values())[leg]
        foot_y = ankle_to_the_side(side, self.pace, body, self.yaw, pitch)
        upright = np.cos(np.arcsin((foot_y - hip[:, 1]) / down))

        x, z = hip[:, 0] + forward, hip[:, 2] - upright * down
        along = np.cos(self.yaw)
        print_x = prints[leg] - self.pace.stride * own
        columns = _Columns(leg, waves, self.trunk, len(unknown))
        x_slopes = columns(
            thigh=down, knee=-body.shank * np.cos(shank), pitch=-along * over_slope[:, 0],
            ahead=1.0, print_=-1.0,
        )  # fmt: skip
        z_slopes = columns(
            thigh=upright * forward, knee=-upright * body.shank * np.sin(shank),
            pitch=0.0, rise=1.0,
        )  # fmt: skip

        stands = own <= self.pace.stance
        flat = (own > 0.10) & (own < 0.28)
        bent = knee < _LEAST_KNEE
        rows = [
            ((x - print_x - along * over[:, 0]), x_slopes, stands, _CONTACT_MM),
            (z - over[:, 1], z_slopes - columns(pitch=over_slope[:, 1]), stands, _CONTACT_MM),
            (pitch, columns(pitch=1.0), flat, np.radians(0.7)),
            (knee - _LEAST_KNEE, columns(knee=1.0), bent, np.radians(0.5)),
        ]
        sole, sole_slope = body.foot.sole_under_ankle(pitch)
        room = _clearance(own, self.pace.stance)
        for point in range(3):
            miss = z + sole[:, point, 1] - room
            slopes = z_slopes + columns(pitch=sole_slope[:, point, 1])
            rows.append((miss, slopes, ~stands & (miss < 0), 2 * _CONTACT_MM))
        return (
            np.concatenate([miss[held] / tolerance for miss, _, held, tolerance in rows]),
            np.concatenate([slope[held] / tolerance for _, slope, held, tolerance in rows]),
        )


class _Columns:
    """Puts derivatives by a leg's angles and the pelvis' path where the unknowns stand."""

    def __init__(self, leg: int, waves: np.ndarray, trunk: np.ndarray, n_unknown: int) -> None:
        self.waves, self.trunk, self.n_unknown = waves, trunk, n_unknown
        first = leg * (3 * _LEG + 1)
        self.angles = {
            name: slice(first + i * _LEG, first + (i + 1) * _LEG)
            for i, name in enumerate(("thigh", "knee", "pitch"))
        }
        self.print_ = first + 3 * _LEG
        pelvis = 2 * (3 * _LEG + 1)
        self.rise = slice(pelvis, pelvis + _PELVIS)
        self.ahead = slice(pelvis + _PELVIS, n_unknown)

    def __call__(
        self, *, rise: float = 0.0, ahead: float = 0.0, print_: float = 0.0,
        **angles: np.ndarray | float,
    ) -> np.ndarray:  # fmt: skip
        slopes = np.zeros((len(self.waves), self.n_unknown))
        for name, slope in angles.items():
            slopes[:, self.angles[name]] = np.reshape(slope, (-1, 1)) * self.waves
        slopes[:, self.rise] = rise * self.trunk
        slopes[:, self.ahead] = ahead * self.trunk[:, 1:]
        slopes[:, self.print_] = print_
        return slopes


def ankle_to_the_side(
    side: int, pace: Pace, body: Body, yaw: float, pitch: np.ndarray
) -> np.ndarray:
    """Return the lateral place of an ankle: half a step width from the middle.

    It swings about the ball of the foot as the foot, toes out, rolls over it.
    """
    rolled = body.foot.ankle_over_ball(pitch) + body.foot.ball
    return side * (pace.step_width / 2 - np.sin(yaw) * rolled)


def _clearance(own: np.ndarray, stance: float) -> np.ndarray:
    """Least height of the sole in swing: 16 mm but just after toe-off and before heel strike."""
    swing = (own - stance) / (1 - stance)
    return 16.0 * np.clip(np.minimum(swing / 0.15, (1 - swing) / 0.12), 0.0, 1.0)


def _sway(pace: Pace) -> np.ndarray:
    """The pelvis' lateral path: towards the stance foot, furthest in mid-stance."""
    curve = np.zeros(_PELVIS)
    lag = 2 * np.pi * 0.02
    curve[1:3] = pace.lateral_range / 2 * np.array([-np.sin(lag), np.cos(lag)])
    return curve


def _drawn_legs(
    person: Mapping[str, float], speed: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Thigh against the vertical, knee, and pitch of the foot as drawn, before the ground."""
    hip, tilt, knee, ankle = (
        np.radians(norm_coefficients(name, speed, LEG_HARMONICS))
        for name in ("hip_flexion", "pelvis_tilt", "knee_flexion", "ankle_dorsiflexion")
    )
    thigh = hip - tilt
    straight = knee[0] + knee[1::2].sum()  # at heel strike; the factor scales what is beyond
    knee *= person["knee_swing_factor"]
    knee[0] += straight * (1 - person["knee_swing_factor"])
    knee = later(knee, person["knee_lag"])
    thigh[0] += np.radians(person["thigh_deg"])
    knee[0] += np.radians(person["knee_deg"])
    return thigh, knee, knee - thigh - ankle
