"""From markers on the skin to the joints under them, one part of the body after the other."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.spatial.transform import Rotation

from eigenwalker.markers.joint_centres import (
    HIP_REGRESSIONS,
    MARKER_RADIUS_MM,
    Pelvis,
    across,
    bridged,
    chord,
    pelvis_from_spines,
    unit,
)
from eigenwalker.markers.label_repair import Rebuilt
from eigenwalker.markers.marker_sets import SIDES

Points = dict[str, np.ndarray]
"""Points by name, each an array of shape (time, 3) in millimetres."""

WIDTH_OF_LEG = {"knee": 0.112, "ankle": 0.080, "elbow": 0.076}
"""Widths of joints as shares of the leg, where they were not measured (after ANSUR II, 2014)."""
SHOULDER_OF_LEG = (0.043, 0.027)
"""How far the shoulder centre is below and inwards of the acromion, as shares of the leg."""
SHOULDERS_TO_STERNUM = 0.15
"""How far the sternum is along the line from the middle of the acromia to the pelvis."""
HEAD_OF_LEG = 0.18
"""How far the head's centre is above the middle between seventh cervical vertebra and clavicles, as
a share of the leg (ANSUR II, 2014: tragion 0.926, cervicale 0.863, suprasternale 0.815 of height).
"""
CLEAR_MM = 15.0
"""A marker on thigh or shank nearer than this to the line between the joints shows no plane."""
CLEAR_BEND = 0.2
"""Sine of the angle between upper arm and forearm from which on they show a plane."""
LEG_MM = 880.0


@dataclass(frozen=True)
class Measures:
    """The hip regression to use, and lengths that were measured on the person.

    Lengths have names such as ``"left_knee_width"`` or ``"left_leg_length"``.
    """

    hip_regression: str
    lengths_mm: Mapping[str, float] = field(default_factory=dict)


def joints_from_skin(skin: Points, measures: Measures) -> tuple[Points, set[str], list[Rebuilt]]:
    """Return the joints that markers on the skin give, which are approximate, and what is rebuilt.

    `skin` has landmarks by the names of ``marker_sets.toml``, and joints that are known otherwise
    (wrists). Approximate are joints that rest on a regression, an assumed width or a stand-in.
    """
    body = _Body(dict(skin), measures)
    pelvis = body.pelvis()
    if pelvis is not None:
        body.trunk()
        body.hips(pelvis)
        for side, outward in (("left", pelvis.axes[:, 1]), ("right", -pelvis.axes[:, 1])):
            body.leg(side, outward)
            body.arm(side, outward)
    return body.joints, body.approximate, body.rebuilt


class _Body:
    """The joints found so far; each method finds those of one part of the body."""

    def __init__(self, skin: Points, measures: Measures) -> None:
        self.skin = skin
        self.measures = measures
        self.joints: Points = {}
        self.approximate: set[str] = set()
        self.rebuilt: list[Rebuilt] = []
        self.leg_mm = _leg_length(skin, measures.lengths_mm)

    def trunk(self) -> None:
        """The sternum: behind the notch between the clavicles, halfway to the spine."""
        self._fill(("clavicle", "breastbone", "c7", "t10"))
        front, back = self.skin.get("clavicle"), self._midpoint("c7", "t10")
        shoulders = self._midpoint("left_shoulder", "right_shoulder")
        if front is not None and back is not None:
            self.joints["sternum"] = (front + back) / 2
        elif shoulders is not None:
            below = SHOULDERS_TO_STERNUM * (self.joints["pelvis"] - shoulders)
            self.joints["sternum"] = shoulders + below
            self.approximate.add("sternum")
        self._head()

    def _head(self) -> None:
        """The head, where it has no markers: above the root of the neck, as if it never nodded."""
        neck = self._midpoint("c7", "clavicle")
        if "head" in self.skin or neck is None:
            return
        self.joints["head"] = neck + np.array([0, 0, HEAD_OF_LEG * self.leg_mm])
        self.approximate.add("head")
        self.rebuilt.append(Rebuilt("head", "above neck"))

    def pelvis(self) -> Pelvis | None:
        """The pelvis from its iliac spines; one may be missing, the back ones be one sacrum."""
        self._fill((*_FRONT, *_BACK, "sacrum"))
        backs = self._midpoint(*_BACK)
        back = self.skin.get("sacrum") if backs is None else backs
        self._mirror_missing(_FRONT, back, _BACK)
        if back is None:
            self._mirror_missing(_BACK, self._midpoint(*_FRONT), _FRONT)
            back = self._midpoint(*_BACK)
        if back is None or not set(_FRONT) <= set(self.skin):
            return None
        pelvis = pelvis_from_spines(self.skin[_FRONT[0]], self.skin[_FRONT[1]], back)
        self.joints["pelvis"] = (pelvis.origin + back) / 2
        return pelvis

    def hips(self, pelvis: Pelvis) -> None:
        """The hip centres, by regression."""
        regression = HIP_REGRESSIONS[self.measures.hip_regression]
        forward, outward, up = regression(pelvis, self.leg_mm)
        self.joints["left_hip"] = pelvis.place(forward, outward, up)
        self.joints["right_hip"] = pelvis.place(forward, -outward, up)
        self.approximate |= {"left_hip", "right_hip"}

    def leg(self, side: str, outward: np.ndarray) -> None:
        """Knee and ankle, each inwards of its marker at right angles to the segment above."""
        above = self.joints[f"{side}_hip"]
        for part, wand in (("knee", "thigh"), ("ankle", "shank")):
            name = f"{side}_{part}"
            if name not in self.skin:
                return
            if f"{side}_{wand}" in self.skin:
                wand_marker = self.skin[f"{side}_{wand}"]
                outward = _plane_of_wand(above, self.skin[name], wand_marker, outward)
            self._inwards_of_marker(name, above, outward)
            above, outward = self.joints[name], self.skin[name] - self.joints[name]

    def arm(self, side: str, outward: np.ndarray) -> None:
        """Shoulder under the acromion, elbow at right angles to the plane in which it bends."""
        shoulder, elbow, wrist = (f"{side}_{part}" for part in ("shoulder", "elbow", "wrist"))
        if shoulder not in self.skin or "sternum" not in self.joints:
            return
        up = unit(self.joints["sternum"] - self.joints["pelvis"])
        below, inwards = (share * self.leg_mm for share in SHOULDER_OF_LEG)
        below = self.measures.lengths_mm.get(f"{side}_shoulder_offset", below) + MARKER_RADIUS_MM
        self.joints[shoulder] = (
            self.skin[shoulder] - below * up - inwards * unit(across(outward, up))
        )
        self.approximate.add(shoulder)
        if elbow not in self.skin:
            return
        if wrist in self.skin:
            outward = _axis_of_elbow(
                self.joints[shoulder], self.skin[elbow], self.skin[wrist], outward
            )
        self._inwards_of_marker(elbow, self.joints[shoulder], outward)

    def _inwards_of_marker(self, name: str, above: np.ndarray, outward: np.ndarray) -> None:
        """Find the centre of a hinge, midway between both markers, else by the chord function."""
        centre = self._midpoint(name, f"{name}_inner")
        if centre is None:
            width = self.measures.lengths_mm.get(f"{name}_width")
            if width is None:
                width = WIDTH_OF_LEG[name.partition("_")[2]] * self.leg_mm
                self.approximate.add(name)
            marker = self.skin[name]
            centre = chord(above, marker, outward, width / 2 + MARKER_RADIUS_MM)
            centre = marker + bridged(centre - marker)
        self.joints[name] = centre

    def _midpoint(self, *names: str) -> np.ndarray | None:
        there = [self.skin[name] for name in names if name in self.skin]
        return midpoint(there) if len(there) == len(names) else None

    def _fill(self, names: Sequence[str]) -> None:
        there = [name for name in names if name in self.skin]
        filled = filled_cluster([self.skin[name] for name in there])
        self.skin.update(zip(there, filled, strict=True))

    def _mirror_missing(
        self, pair: tuple[str, str], middle: np.ndarray | None, axis: tuple[str, str]
    ) -> None:
        """Put the missing one of a pair where the mirror of the other is, across the body."""
        present = [name for name in pair if name in self.skin]
        if middle is None or len(present) != 1 or not set(axis) <= set(self.skin):
            return
        normal = unit(self.skin[axis[0]] - self.skin[axis[1]])
        point = self.skin[present[0]]
        across_it = ((point - middle) * normal).sum(axis=1, keepdims=True) * normal
        gone = pair[1 - pair.index(present[0])]
        self.skin[gone] = point - 2 * across_it
        self.approximate.add("pelvis")
        self.rebuilt.append(Rebuilt(gone, "mirrored", (present[0],)))


_FRONT = ("left_front_waist", "right_front_waist")
_BACK = ("left_back_waist", "right_back_waist")


def _plane_of_wand(
    proximal: np.ndarray, marker: np.ndarray, wand: np.ndarray, outward: np.ndarray
) -> np.ndarray:
    """Return the direction in which a marker on thigh or shank stands off the segment.

    Where it hardly does, it shows no plane, and the direction given counts. Where the marker is
    missing, it stands off as before and after.
    """
    off = across(wand - proximal, marker - proximal)
    lengths = np.linalg.norm(off, axis=1)
    lengths = lengths[~np.isnan(lengths)]
    if not len(lengths) or np.median(lengths) < CLEAR_MM:
        return outward
    return bridged(unit(off))


def _axis_of_elbow(
    shoulder: np.ndarray, elbow: np.ndarray, wrist: np.ndarray, outward: np.ndarray
) -> np.ndarray:
    """Return the outward direction square to upper arm and forearm, where they bend."""
    axis = np.cross(unit(elbow - shoulder), unit(wrist - elbow))
    axis[np.linalg.norm(axis, axis=1) < CLEAR_BEND] = np.nan
    axis = bridged(axis)
    if np.isnan(axis).all():
        return outward
    return axis * (1.0 if np.nansum(axis * outward) > 0 else -1.0)


def _leg_length(skin: Points, lengths_mm: Mapping[str, float]) -> float:
    """Return the length of the legs as measured, or from front iliac spine over knee to ankle."""
    lengths = [
        length for side in SIDES if (length := lengths_mm.get(f"{side}_leg_length")) is not None
    ]
    for side in SIDES if not lengths else ():
        chain = [skin.get(f"{side}_{part}") for part in ("front_waist", "knee", "ankle")]
        if chain[0] is not None and chain[1] is not None and chain[2] is not None:
            thigh = np.linalg.norm(chain[1] - chain[0], axis=1)
            whole = thigh + np.linalg.norm(chain[2] - chain[1], axis=1)
            lengths += [float(np.nanmedian(whole))] if not np.isnan(whole).all() else []
    return float(np.mean(lengths)) if lengths else LEG_MM


def midpoint(points: Sequence[np.ndarray]) -> np.ndarray:
    """Return the midpoint of markers that move together; a missing one is put where others say."""
    if not any(np.isnan(point).any() for point in points):
        return sum(points[1:], points[0]) / len(points)
    if len(points) == 2:
        first, second = points
        apart = bridged(second - first)
        points = [
            np.where(np.isnan(first), second - apart, first),
            np.where(np.isnan(second), first + apart, second),
        ]
    return np.mean(filled_cluster(points), axis=0)


def filled_cluster(points: Sequence[np.ndarray]) -> list[np.ndarray]:
    """Return markers of one rigid part, those missing put where the others say.

    Each frame is compared with the nearest one in which all are seen. Two markers are enough if
    they are far apart; the part is then turned as little as they allow.
    """
    if len(points) < 3 or not any(np.isnan(point).any() for point in points):
        return list(points)
    cluster = np.stack(list(points), axis=1)
    there = np.asarray(~np.isnan(cluster).any(axis=2))
    count = there.sum(axis=1)
    whole = np.flatnonzero(count == len(points))
    for frame in np.flatnonzero((count >= 2) & (count < len(points))) if len(whole) else ():
        model = cluster[whole[np.abs(whole - frame).argmin()]]
        seen = there[frame]
        before, now = model[seen], cluster[frame, seen]
        size = np.linalg.norm(model[:, None] - model, axis=2).max()
        if np.linalg.norm(before - before[0], axis=1).max() <= size / 3:
            continue
        with warnings.catch_warnings():
            # Markers in one line leave the turn about it open; the smallest is taken.
            warnings.filterwarnings("ignore", "Optimal rotation is not uniquely", UserWarning)
            turn = Rotation.align_vectors(now[1:] - now[0], before[1:] - before[0])[0]
        cluster[frame, ~seen] = turn.apply(model[~seen] - before.mean(axis=0)) + now.mean(axis=0)
    return list(cluster.transpose(1, 0, 2))
