"""The movement a person was drawn to make: norms, with the person's own parameters applied.

Fourier coefficients of angles in radians, of paths in millimetres.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from eigenwalker.simulation.cadence import Pace
from eigenwalker.simulation.norms import basis, later, norm_coefficients
from eigenwalker.simulation.segment_lengths import GRAVITY

LEG_HARMONICS = 8
PELVIS_HARMONICS = 6


def _in_swing() -> np.ndarray:
    """Return what keeps of a curve what it does in swing: square, of shape (coefficient,).

    It fades in from half of the stride to its middle of swing, and out until the next heel strike.
    """
    phase = np.arange(4 * LEG_HARMONICS) / (4 * LEG_HARMONICS)
    waves = basis(phase, LEG_HARMONICS)
    share = np.where(phase > 0.5, np.sin(2 * np.pi * phase) ** 2, 0.0)
    return np.linalg.pinv(waves) @ (share[:, None] * waves)


_SWUNG = _in_swing()


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
    knee = later(_SWUNG @ knee * (person["knee_swing_factor"] - 1) + knee, person["knee_lag"])
    thigh[0] += np.radians(person["thigh_deg"])
    knee[0] += np.radians(person["knee_deg"])
    return thigh, knee, knee - thigh - ankle


def pelvis_paths(person: Mapping[str, float], pace: Pace) -> np.ndarray:
    """Return how the pelvis moves ahead, to the side and up, about its mean: (axis, coefficient).

    Towards the foot that stands, furthest in mid-stance; highest near 30 and 80 per cent of the
    stride (Orendurff et al. 2004). Ahead it is slowest where it is highest, as height is paid for
    with speed (Cavagna, Heglund & Taylor 1977: the two energies go up and down by as much).
    """
    ahead, side, up = np.zeros((3, 2 * PELVIS_HARMONICS + 1))
    side[2] = pace.lateral_range / 2
    up[3] = pace.vertical_range / 2
    ahead[3] = GRAVITY * up[3] / pace.speed / (4 * np.pi * pace.frequency)
    highest = 0.30 + person["bob_lag"]
    return np.array(
        [later(ahead, highest - 0.125), later(side, 0.02 + person["sway_lag"]), later(up, highest)]
    )
