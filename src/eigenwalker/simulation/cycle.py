"""One stride, solved: the joint angles nearest to a person's draw whose feet hold the ground.

A person asks for a step length, a step width and a range of vertical and lateral movement, and
has joint angles drawn about published norms. Both cannot be had at once. The cycle that walks is
the most probable one: Gauss-Newton finds the least change of the drawn angles, in units of what
people differ by, for which the planted feet stay where they are, the swinging ones clear the
ground, and the pelvis moves as asked.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from eigenwalker.simulation.body import GRAVITY, Body, body_of
from eigenwalker.simulation.norms import FREE_SPEED, basis, norm_coefficients

LEG_HARMONICS = 8
PELVIS_HARMONICS = 6
SIDES = (1, -1)
"""Left and right, as the sign of their lateral axis."""

_CONTACT_MM = 0.5
_LEAST_KNEE = np.radians(3.0)
_FRAMES = 120
_ITERATIONS = 10
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
        step_width=max(person["step_width_mm"], 20.0),
        vertical_range=max(27 + 21 * faster + person["vertical_mm"], 12.0),
        lateral_range=max(70 - 31 * faster + person["lateral_mm"], 10.0),
    )


@dataclass(frozen=True)
class Cycle:
    """Fourier coefficients of one stride: angles in radians, the pelvis' path in millimetres.

    `thigh`, `knee`, `pitch` have shape (side, coefficient) over the side's own phase, which is 0
    at its heel strike; `pelvis` has shape (axis, coefficient) over the left side's phase.
    """

    thigh: np.ndarray
    knee: np.ndarray
    pitch: np.ndarray
    prints: np.ndarray
    pelvis: np.ndarray
    onsets: np.ndarray


def trunk_curves(person: Mapping[str, float], speed: float) -> dict[str, np.ndarray]:
    """Return Fourier coefficients, in radians, of pelvis and thorax against the room."""
    n = PELVIS_HARMONICS

    def curve(name: str, factor: float = 1.0) -> np.ndarray:
        return np.radians(norm_coefficients(name, speed, n)) * factor

    pelvis_turn = curve("pelvis_rotation", person["pelvis_rotation_factor"])
    pelvis_list = curve("pelvis_obliquity", person["obliquity_factor"])
    tilt = curve("pelvis_tilt")
    tilt[0] += np.radians(person["pelvis_tilt_deg"])
    # Thorax against the room: the norms of trunk on pelvis and of the pelvis added up, so that a
    # person's trunk does not copy what is particular about the pelvis.
    lean = (curve("trunk_obliquity") + curve("pelvis_obliquity")) * person["trunk_lean_factor"]
    turn = curve("trunk_rotation", person["trunk_rotation_factor"]) + 0.5 * (
        pelvis_turn + curve("pelvis_rotation")
    )
    upright = np.zeros(2 * n + 1)
    upright[0] = np.radians(person["trunk_tilt_deg"])
    return {
        "pelvis_tilt": tilt,
        "pelvis_obliquity": pelvis_list,
        "pelvis_rotation": pelvis_turn,
        "trunk_tilt": upright,
        "trunk_obliquity": lean,
        "trunk_rotation": turn,
    }


def turned(vector: np.ndarray, tilt: np.ndarray, listing: np.ndarray, turn: np.ndarray):
    """Return a vector turned by tilt (about y), then obliquity (about x), then rotation (-z)."""
    x, y, z = vector
    x, z = x * np.cos(tilt) + z * np.sin(tilt), z * np.cos(tilt) - x * np.sin(tilt)
    y, z = y * np.cos(listing) - z * np.sin(listing), z * np.cos(listing) + y * np.sin(listing)
    x, y = x * np.cos(turn) + y * np.sin(turn), y * np.cos(turn) - x * np.sin(turn)
    return np.stack([x, y, z], axis=-1)


def solve_cycle(person: Mapping[str, float], *, stride_factor: float = 1.0) -> Cycle:
    """Return the stride that a person walks.

    Parameters
    ----------
    person : mapping
        Parameters of `traits.PARAMETERS`.
    stride_factor : float
        Makes the stride longer or shorter than the person's own.

    Returns
    -------
    Cycle

    """
    body = body_of(person)
    pace = pace_of(person, body)
    problem = _Problem(person, body, pace, pace.stride * stride_factor)
    unknown = problem.prior.copy()
    for _ in range(_ITERATIONS):
        residual, slopes = problem.linearised(unknown)
        pull = problem.precision * (problem.prior - unknown)
        normal = slopes.T @ slopes + np.diag(problem.precision)
        unknown = unknown + np.linalg.solve(normal, pull - slopes.T @ residual)
    return problem.cycle(unknown)


class _Problem:
    """What the feet ask for, and what the person was drawn to do."""

    def __init__(
        self, person: Mapping[str, float], body: Body, pace: Pace, stride: float
    ) -> None:
        self.body, self.pace, self.stride = body, pace, stride
        phase = np.arange(_FRAMES) / _FRAMES
        self.onsets = np.array([0.0, 0.5 + person["step_asymmetry"]])
        self.phases = (phase - self.onsets[:, None]) % 1.0
        self.legs = [basis(own, LEG_HARMONICS) for own in self.phases]
        self.trunk = basis(phase, PELVIS_HARMONICS)
        self.yaw = np.radians(person["foot_progression_deg"])
        curves = trunk_curves(person, pace.effort)
        angles = [
            self.trunk @ curves[f"pelvis_{name}"] for name in ("tilt", "obliquity", "rotation")
        ]
        self.hips = [turned(body.hip * [1, side, 1], *angles) for side in SIDES]
        self.sway = _sway(pace)
        self.prior, self.precision = self._prior(person)

    def _prior(self, person: Mapping[str, float]) -> tuple[np.ndarray, np.ndarray]:
        thigh, knee, pitch = _drawn_legs(person, self.pace.effort)
        harmonic = np.concatenate([[0], np.repeat(np.arange(1, LEG_HARMONICS + 1), 2)])
        legs, leg_sds = [], []
        for leg, side in enumerate(SIDES):
            half = np.radians([person["thigh_asymmetry_deg"], person["knee_asymmetry_deg"]]) / 2
            own = np.array([thigh, knee, pitch])
            own[:2, 0] += side * half
            legs += [*own.ravel(), self._first_print(own, leg)]
            spread = np.radians(np.array([[1.5], [2.0], [3.0]]) / np.maximum(harmonic, 1) ** 0.7)
            leg_sds += [*spread.ravel(), 100.0]
        pelvis_harmonic = np.repeat(np.arange(1, PELVIS_HARMONICS + 1), 2)
        height = 0.985 * (self.body.thigh + self.body.shank) + self.body.foot.height
        rise = np.zeros(_PELVIS)
        rise[0] = height - self.body.hip[2]
        top = 4 * np.pi * 0.30  # highest at 30 and 80 per cent (Orendurff et al. 2004)
        rise[3:5] = self.pace.vertical_range / 2 * np.array([np.cos(top), np.sin(top)])
        rise_sd = np.concatenate([[30.0], 2.0 / pelvis_harmonic])
        ahead_sd = 4.0 / pelvis_harmonic
        prior = np.concatenate([legs, rise, np.zeros(_PELVIS - 1)])
        return prior, np.concatenate([leg_sds, rise_sd, ahead_sd]) ** -2.0

    def _first_print(self, own: np.ndarray, leg: int) -> float:
        """Where the ball of a foot comes to stand at its heel strike if nothing is changed."""
        thigh, knee = (basis(np.array([0.0]), LEG_HARMONICS) @ own[:2].T)[0]
        reach = self.body.thigh * np.sin(thigh) + self.body.shank * np.sin(thigh - knee)
        return reach + self.body.foot.ball

    def split(self, unknown: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Return leg curves (side, joint, coefficient), prints, rise and advance of the pelvis."""
        legs = unknown[: 2 * (3 * _LEG + 1)].reshape(2, -1)
        rest = unknown[2 * (3 * _LEG + 1) :]
        ahead = np.concatenate([[0.0], rest[_PELVIS:]])
        return legs[:, :-1].reshape(2, 3, _LEG), legs[:, -1], rest[:_PELVIS], ahead

    def cycle(self, unknown: np.ndarray) -> Cycle:
        legs, prints, rise, ahead = self.split(unknown)
        return Cycle(
            thigh=legs[:, 0],
            knee=legs[:, 1],
            pitch=legs[:, 2],
            prints=prints,
            pelvis=np.array([ahead, self.sway, rise]),
            onsets=self.onsets,
        )

    def linearised(self, unknown: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return all residuals, each divided by its tolerance, and their derivatives."""
        parts = [self._leg(unknown, leg) for leg in range(2)]
        return (
            np.concatenate([residual for residual, _ in parts]),
            np.concatenate([slopes for _, slopes in parts]),
        )

    def _leg(self, unknown: np.ndarray, leg: int) -> tuple[np.ndarray, np.ndarray]:
        """Return what a leg misses, in tolerances, and its derivatives."""
        curves, prints, rise, ahead = self.split(unknown)
        body, waves, own = self.body, self.legs[leg], self.phases[leg]
        thigh, knee, pitch = curves[leg] @ waves.T
        shank = thigh - knee
        over, over_slope = body.foot.ankle_over_print(pitch)
        forward = body.thigh * np.sin(thigh) + body.shank * np.sin(shank)
        down = body.thigh * np.cos(thigh) + body.shank * np.cos(shank)
        hip = self.hips[leg] + self.trunk @ np.stack([ahead, self.sway, rise], axis=1)
        upright = np.cos(splay(SIDES[leg], self.pace, body, self.yaw, pitch, hip[:, 1], down))

        x, z = hip[:, 0] + forward, hip[:, 2] - upright * down
        along = np.cos(self.yaw)
        print_x = prints[leg] - self.stride * own
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


def splay(
    side: int, pace: Pace, body: Body, yaw: float, pitch: np.ndarray,
    hip_y: np.ndarray, down: np.ndarray,
) -> np.ndarray:  # fmt: skip
    """Return how far the plane of a leg leans sideways for its foot to keep the step width.

    Radians about x; the ankle swings about the ball as the foot, toes out, rolls over it.
    """
    rolled = body.foot.ankle_over_ball(pitch) + body.foot.ball
    ankle_y = side * (pace.step_width / 2 - np.sin(yaw) * rolled)
    return np.arcsin((ankle_y - hip_y) / down)


def _clearance(own: np.ndarray, stance: float) -> np.ndarray:
    """Least height of the sole in swing: 14 mm but just after toe-off and before heel strike."""
    swing = (own - stance) / (1 - stance)
    return 14.0 * np.clip(np.minimum(swing / 0.15, (1 - swing) / 0.12), 0.0, 1.0)


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
    knee[1:] *= person["knee_swing_factor"]
    thigh[0] += np.radians(person["thigh_deg"])
    knee[0] += np.radians(person["knee_deg"])
    return thigh, knee, knee - thigh - ankle
