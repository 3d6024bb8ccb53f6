"""What a person was drawn to do before the ground constrains it: speed, and curves from norms.

Fourier coefficients of angles in radians, of paths in millimetres.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from eigenwalker.core.fourier import harmonic_basis
from eigenwalker.core.kinematics import GRAVITY_MM_S2
from eigenwalker.simulation.body import Body
from eigenwalker.simulation.norms import FREE_SPEED, delay, norm_coefficients

LEG_HARMONICS = 8
PELVIS_HARMONICS = 6
_LEG_MM = 869.0
"""Leg of `average_person`."""


@dataclass(frozen=True)
class GaitParameters:
    """How a person gets along: millimetres, hertz, shares of a stride.

    `effort` is the dimensionless speed at which the people of the norm make steps as long.
    """

    stride_length: float
    frequency: float
    effort: float
    stance: float
    step_width: float
    vertical_range: float
    lateral_range: float

    @property
    def speed(self) -> float:
        """Forward speed in mm/s."""
        return self.stride_length * self.frequency


def gait_parameters(person: Mapping[str, float], body: Body) -> GaitParameters:
    """Return speed from stride length and cadence, and pelvis movement from speed.

    The vertical range grows from 27 mm at 0.7 m/s to 48 mm at 1.6, the lateral one shrinks from
    70 to 39 mm (Orendurff et al. 2004), both in bodies of average size: larger ones move by as
    much more, at speeds that rise with the root of the leg (dynamic similarity, Alexander 1989).
    A negative lateral range is a path away from the foot that stands.
    """
    stride_length = person["stride_share"] * body.height
    speed = stride_length * person["frequency_hz"]
    size = body.leg / _LEG_MM
    faster = (speed / 1000 / np.sqrt(size) - 0.7) / 0.9
    # Schwartz et al. (2008): steps of 0.64, 0.76, 0.85 leg lengths at 0.29, 0.43, 0.56.
    effort = FREE_SPEED + (stride_length / 2 / body.leg - 0.76) / 0.78
    dimensionless = speed / np.sqrt(GRAVITY_MM_S2 * body.leg)
    return GaitParameters(
        stride_length=stride_length,
        frequency=person["frequency_hz"],
        effort=effort,
        stance=person["stance_share"] - 0.1 * (dimensionless - 0.38),
        step_width=max(person["step_width_mm"], 45.0),
        vertical_range=max(size * (27 + 21 * faster) + person["vertical_mm"], 12.0),
        lateral_range=size * (70 - 31 * faster) + person["lateral_mm"],
    )


def _swing_filter() -> np.ndarray:
    """Return the matrix that keeps of a curve what it does in swing: (coefficient, coefficient).

    It fades in from half of the stride to the middle of swing, and out until the next heel strike.
    """
    phase = np.arange(4 * LEG_HARMONICS) / (4 * LEG_HARMONICS)
    waves = harmonic_basis(phase, LEG_HARMONICS)
    share = np.where(phase > 0.5, np.sin(2 * np.pi * phase) ** 2, 0.0)
    return np.linalg.pinv(waves) @ (share[:, None] * waves)


_SWING_FILTER = _swing_filter()


def trunk_curves(
    person: Mapping[str, float], body: Body, gait: GaitParameters
) -> dict[str, np.ndarray]:
    """Return Fourier coefficients, in radians, of pelvis and trunk against the room.

    The trunk's are the norms of trunk on pelvis and of the pelvis added up: a person's trunk does
    not copy what is particular about the pelvis but for half of its rotation. It leans against the
    pelvis' path to the side, so that shoulders sway by what they were drawn to, whatever hips do.
    """
    effort = gait.effort

    def curve(name: str, factor: str | None = None, lag: str | None = None) -> np.ndarray:
        norm = np.radians(norm_coefficients(name, effort, PELVIS_HARMONICS))
        return delay(norm * (person[factor] if factor else 1), person[lag] if lag else 0)

    rotation = curve("pelvis_rotation", "pelvis_rotation_factor", "pelvis_rotation_lag")
    lean = curve("trunk_obliquity") + curve("pelvis_obliquity")
    twist = curve("trunk_rotation", "trunk_rotation_factor", "trunk_rotation_lag")
    pelvis_tilt, trunk_tilt = curve("pelvis_tilt"), np.zeros(2 * PELVIS_HARMONICS + 1)
    pelvis_tilt[0] += np.radians(person["pelvis_tilt_deg"])
    trunk_tilt[0] = np.radians(person["trunk_tilt_deg"])
    own_lean = delay(lean * person["trunk_lean_factor"], person["trunk_lean_lag"])
    against = pelvis_paths(person, gait)[1] / body.shoulder[2]
    return {
        "pelvis_tilt": pelvis_tilt,
        "pelvis_obliquity": curve("pelvis_obliquity", "obliquity_factor", "obliquity_lag"),
        "pelvis_rotation": rotation,
        "trunk_tilt": trunk_tilt,
        "trunk_obliquity": own_lean + against,
        "trunk_rotation": twist + 0.5 * (rotation + curve("pelvis_rotation")),
    }


def leg_curves(
    person: Mapping[str, float], effort: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return thigh against the vertical, knee flexion, and pitch of the foot."""
    hip, tilt, knee, ankle = (
        np.radians(norm_coefficients(name, effort, LEG_HARMONICS))
        for name in ("hip_flexion", "pelvis_tilt", "knee_flexion", "ankle_dorsiflexion")
    )
    thigh = hip - tilt
    knee = delay(
        _SWING_FILTER @ knee * (person["knee_swing_factor"] - 1) + knee, person["knee_lag"]
    )
    thigh[0] += np.radians(person["thigh_deg"])
    knee[0] += np.radians(person["knee_deg"])
    return thigh, knee, knee - thigh - ankle


def pelvis_paths(person: Mapping[str, float], gait: GaitParameters) -> np.ndarray:
    """Return how the pelvis moves ahead, to the side and up, about its mean: (axis, coefficient).

    Towards the foot that stands, furthest in mid-stance; highest near 30 and 80 per cent of the
    stride (Orendurff et al. 2004). Ahead it is slowest where it is highest, as height is paid for
    with speed (Cavagna, Heglund & Taylor 1977: the two energies go up and down by as much).
    """
    ahead, side, up = np.zeros((3, 2 * PELVIS_HARMONICS + 1))
    side[1] = gait.lateral_range / 2
    up[4] = gait.vertical_range / 2
    ahead[4] = GRAVITY_MM_S2 * up[4] / gait.speed / (4 * np.pi * gait.frequency)
    highest = 0.30 + person["bob_lag"]
    lags = highest - 0.125, 0.02 + person["sway_lag"], highest
    return np.array([delay(path, lag) for path, lag in zip((ahead, side, up), lags, strict=True)])
