"""Markers on the skin: a full-body set of 38, and how skin moves over the bones below it."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from importlib.resources import files

import numpy as np

from eigenwalker.core.fourier import harmonic_basis
from eigenwalker.simulation.body import Body
from eigenwalker.simulation.posture import SIDES, Rotations, rotated

RADIUS_MM = 7.0
_LENGTHS = ("height", "thigh", "shank", "upper_arm", "forearm")
_PLACED = tomllib.loads((files("eigenwalker.simulation") / "skin.toml").read_text(encoding="utf-8"))


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
    ``soft_tissue_mm`` of ``skin.toml``, so that 0 fixes markers to the bones.
    """
    waves = harmonic_basis(phase, 2)[:, [2, 4, 1, 3]]
    lengths, markers = lengths_of(body), {}
    for name, side, joint, segment, place in _placed():
        offset = np.sum([lengths[unit] * np.array(at) for unit, at in place.items()], axis=0)
        weights = rng.standard_normal((4, 3)) / np.sqrt(2)
        slide = soft_tissue * _PLACED["soft_tissue_mm"][segment] * (waves @ weights)
        at_rest = rotated(offset * [1, SIDES.get(side, 1), 1], rotations[_of(side, segment)])
        markers[name] = positions[_of(side, joint)] + at_rest + slide
    return markers


def lengths_of(body: Body) -> dict[str, float]:
    """Return the lengths in which places of markers are given, in millimetres.

    Knees, ankles and elbows: half their width, a share of the leg from iliac spine to ankle, and
    the radius of a marker. Spine: half the distance of the front iliac spines, of which a hip's
    is 0.33, and 7.3 mm more (Harrington et al. 2007).
    """
    foot, leg = body.foot, 0.49 * body.height
    widths = {"knee": 0.112, "ankle": 0.080, "elbow": 0.076}
    return {
        **{name: getattr(body, name) for name in _LENGTHS},
        **{joint: share * leg / 2 + RADIUS_MM for joint, share in widths.items()},
        "mm": 1.0,
        "spine": (body.hip[1] - 7.3) / 0.33 / 2,
        "heel": foot.heel,
        "ball": foot.ball,
        "foot_height": foot.height,
    }


def _placed() -> Iterator[tuple[str, str, str, str, dict[str, list[float]]]]:
    """Yield name, side, joint, segment and offset of each marker."""
    for side, letter in (("", ""), ("left", "L"), ("right", "R")):
        for name, entry in _PLACED["sides" if side else "middle"].items():
            place = {key: value for key, value in entry.items() if key not in ("joint", "segment")}
            yield letter + name, side, entry["joint"], entry["segment"], place


def _of(side: str, part: str) -> str:
    """Return the name of a joint or segment, which has a side unless it is in the middle."""
    return part if part in ("head", "pelvis", "trunk", "sternum") else f"{side}_{part}"
