"""Markers on the skin: a full-body set of 38, and how skin moves over the bones below it."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from eigenwalker.core.fourier import harmonic_basis
from eigenwalker.simulation.body import Body
from eigenwalker.simulation.posture import SIDES, Rotations, rotated

Offset = tuple[float, float, float] | np.ndarray

RADIUS_MM = 7.0
SOFT_TISSUE_MM = {
    "head": 0.5,
    "trunk": 2.0,
    "pelvis": 3.0,
    "upper_arm": 4.0,
    "forearm": 2.5,
    "thigh": 8.0,
    "shank": 4.0,
    "foot": 1.0,
}
"""SD of a marker's movement over the bone, each axis, a stride: largest on the thigh.

Recalled after Leardini, Chiari, Della Croce and Cappozzo (2005), Gait Posture 21:212, who report
up to 30 mm from end to end on the thigh and a third of that on the shank.
"""


def skin_markers(
    body: Body,
    positions: Mapping[str, np.ndarray],
    rotations: Mapping[str, Rotations],
    phase: np.ndarray,
    *,
    rng: np.random.Generator,
    soft_tissue: float = 1.0,
) -> dict[str, np.ndarray]:
    """Return the markers of the full-body Plug-in Gait set without RBAK: 38.

    Bony landmarks lie where common joint-centre models expect them (hips: Harrington et al. 2007;
    half a knee's, ankle's and elbow's width and a marker's radius outside the joint), so that
    virtual markers have a truth to be measured against.

    Positions, of joints as of markers, have the shape (frame, 3). Skin moves with the phase of the
    stride, in cycles, in each person and marker in its own way; `soft_tissue` multiplies
    `SOFT_TISSUE_MM`, so that 0 fixes markers to the bones.
    """
    waves = harmonic_basis(phase, 2)[:, [2, 4, 1, 3]]
    markers = {}
    for name, (joint, segment, offset) in _marker_offsets(body).items():
        kind = segment.removeprefix("left_").removeprefix("right_")
        weights = rng.standard_normal((4, 3)) / np.sqrt(2)
        slide = soft_tissue * SOFT_TISSUE_MM[kind] * (waves @ weights)
        at_rest = rotated(np.asarray(offset, dtype=float), rotations[segment])
        markers[name] = positions[joint] + at_rest + slide
    return markers


def _marker_offsets(body: Body) -> dict[str, tuple[str, str, Offset]]:
    """Return joint, segment and offset in the segment of each marker."""
    height = body.height
    spine = (body.hip[1] - 7.3) / 0.33 / 2  # Harrington et al.: hip 0.33 of their distance and 7.3
    sternum = body.sternum
    offsets: dict[str, tuple[str, str, Offset]] = {
        "CLAV": ("pelvis", "trunk", np.add(sternum, (0.053 * height, 0, 0.012 * height))),
        "STRN": ("pelvis", "trunk", np.add(sternum, (0.065 * height, 0, -0.066 * height))),
        "C7": ("pelvis", "trunk", np.add(sternum, (-0.043 * height, 0, 0.050 * height))),
        "T10": ("pelvis", "trunk", np.add(sternum, (-0.063 * height, 0, -0.074 * height))),
    }
    for side, sign in SIDES.items():
        own = _one_side(body, side, spine)
        offsets |= {
            f"{side[0].upper()}{name}": (joint, segment, (x, sign * y, z))
            for name, (joint, segment, (x, y, z)) in own.items()
        }
    return offsets


def _one_side(body: Body, side: str, spine: float) -> dict[str, tuple[str, str, Offset]]:
    """Return the same of one side: forward, outwards, up."""
    share, foot = 0.49 * body.height, body.foot  # of the leg from iliac spine to ankle
    knee, ankle, elbow = (width * share / 2 + RADIUS_MM for width in (0.112, 0.080, 0.076))
    height = body.height
    thigh, shank, upper, fore = (
        f"{side}_{segment}" for segment in ("thigh", "shank", "upper_arm", "forearm")
    )
    return {
        "FHD": ("head", "head", (0.055 * height, 0.040 * height, 0)),
        "BHD": ("head", "head", (-0.055 * height, 0.040 * height, 0)),
        "SHO": (f"{side}_shoulder", "trunk", (0, 0.0132 * height, 0.022 * height + 12)),
        "UPA": (f"{side}_shoulder", upper, (0, 0.030 * height, -0.55 * body.upper_arm)),
        "ELB": (f"{side}_elbow", upper, (0, elbow, 0)),
        "FRM": (f"{side}_elbow", fore, (0, 0.022 * height, -0.45 * body.forearm)),
        "WRA": (f"{side}_wrist", fore, (0.020 * height, 0, 0)),
        "WRB": (f"{side}_wrist", fore, (-0.020 * height, 0, 0)),
        "FIN": (f"{side}_wrist", fore, (0, 0, -0.052 * height)),
        "ASI": ("pelvis", "pelvis", (0.0443 * height, spine, 0)),
        "PSI": ("pelvis", "pelvis", (-0.0443 * height, 0.028 * height, 0)),
        "THI": (f"{side}_hip", thigh, (0, 0.050 * height, -0.60 * body.thigh)),
        "KNE": (f"{side}_knee", thigh, (0, knee, 0)),
        "TIB": (f"{side}_knee", shank, (0, 0.035 * height, -0.50 * body.shank)),
        "ANK": (f"{side}_ankle", shank, (0, ankle, 0)),
        "HEE": (f"{side}_ankle", f"{side}_foot", (-foot.heel - RADIUS_MM, 0, -0.3 * foot.height)),
        "TOE": (f"{side}_ankle", f"{side}_foot", (foot.ball, 0, -0.3 * foot.height)),
    }
