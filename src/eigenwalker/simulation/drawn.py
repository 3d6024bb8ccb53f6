"""The movement a person was drawn to make: norms, with the person's own parameters applied.

Fourier coefficients of angles in radians, of paths in millimetres.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from eigenwalker.simulation.norms import later, norm_coefficients
from eigenwalker.simulation.pace import Pace

LEG_HARMONICS = 8
PELVIS_HARMONICS = 6


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
    tilt, upright = curve("pelvis_tilt"), np.zeros(2 * PELVIS_HARMONICS + 1)
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


def leg_curves(
    person: Mapping[str, float], effort: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return thigh against the vertical, knee, and pitch of the foot, before the ground is felt."""
    hip, tilt, knee, ankle = (
        np.radians(norm_coefficients(name, effort, LEG_HARMONICS))
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


def pelvis_paths(person: Mapping[str, float], pace: Pace) -> tuple[np.ndarray, np.ndarray]:
    """Return how the pelvis moves to the side and up and down, about its mean.

    Towards the foot that stands, furthest in mid-stance; highest near 30 and 80 per cent of the
    stride (Orendurff et al. 2004).
    """
    side, up = np.zeros(2 * PELVIS_HARMONICS + 1), np.zeros(2 * PELVIS_HARMONICS + 1)
    side[2] = pace.lateral_range / 2
    up[3] = pace.vertical_range / 2
    return later(side, 0.02 + person["sway_lag"]), later(up, 0.30 + person["bob_lag"])
