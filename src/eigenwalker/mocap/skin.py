"""From markers on the skin to the joints under them, one part of the body after the other."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from scipy.spatial.transform import Rotation

from eigenwalker.mocap.joint_centres import (
    HIP_REGRESSIONS,
    MARKER_RADIUS_MM,
    Pelvis,
    across,
    bridged,
    chord,
    pelvis_from_spines,
    unit,
)
from eigenwalker.mocap.marker_names import SIDES, MarkerNames

WIDTH_OF_LEG = {"knee": 0.112, "ankle": 0.080, "elbow": 0.076}
"""Widths of joints as shares of the length of the leg, where nobody measured them."""
SHOULDER_OF_LEG = (0.073, 0.027)
"""How far the shoulder centre is below and inwards of the acromion, as shares of the leg."""
CLEAR_MM = 15.0
"""A marker on thigh or shank nearer than this to the line between the joints shows no plane."""
CLEAR_BEND = 0.2
"""Sine of the angle between upper arm and forearm from which they show a plane."""


@dataclass
class Body:
    """The markers of a capture, and what is known of the person.

    Parameters
    ----------
    points : mapping of str to array of shape (time, 3)
        Markers by the names of the capture.
    names : MarkerNames
        Who finds those names.
    hip_regression : str
        A key of `HIP_REGRESSIONS`.
    widths_mm : mapping of str to float
        Widths by ``"left_knee"`` and so on.
    """

    points: Mapping[str, np.ndarray]
    names: MarkerNames
    hip_regression: str = "harrington"
    widths_mm: Mapping[str, float] = field(default_factory=dict)

    def midpoint(self, entry: str | None) -> np.ndarray | None:
        """Return the point that an entry of a marker set describes, if its markers are there."""
        found = self.names.find(entry) if entry else []
        return _mean([self.points[name] for name in found]) if found else None


def joints_from_skin(
    body: Body, landmarks: Mapping[str, str]
) -> tuple[dict[str, np.ndarray], set[str]]:
    """Return the joints that markers on the skin give, and which of them are approximate.

    Parameters
    ----------
    body : Body
        The capture.
    landmarks : mapping of str to str
        Entries of a marker set, both sides.

    Returns
    -------
    joints : dict of str to array of shape (time, 3)
        Only those for which there are markers.
    approximate : set of str
        Those that rest on a regression or an assumed width.

    """
    skin = {name: body.midpoint(entry) for name, entry in landmarks.items()}
    skin = {name: point for name, point in skin.items() if point is not None}
    joints: dict[str, np.ndarray] = {}
    approximate: set[str] = set()
    _head(skin, joints, approximate)
    _trunk(skin, joints, approximate)
    pelvis = _pelvis(skin, joints, approximate)
    if pelvis is not None:
        leg = _leg_length(skin)
        forward, outward, up = HIP_REGRESSIONS[body.hip_regression](pelvis, leg)
        joints["left_hip"] = pelvis.place(forward, outward, up)
        joints["right_hip"] = pelvis.place(forward, -outward, up)
        approximate |= {"left_hip", "right_hip"}
        for side in SIDES:
            leftward = pelvis.left if side == "left" else -pelvis.left
            _leg(side, skin, joints, approximate, leftward, leg, body.widths_mm)
            _arm(side, skin, joints, approximate, leftward, leg, body.widths_mm)
    for extra in ("toe", "heel", "hand"):
        for side in SIDES:
            if f"{side}_{extra}" in skin:
                joints[f"{side}_{extra}"] = skin[f"{side}_{extra}"]
    return joints, approximate


Points = dict[str, np.ndarray]


def _head(skin: Points, joints: Points, approximate: set[str]) -> None:
    """The centre of the head: amid the four markers of a head band, or of those there are."""
    band = ["left_head_front", "right_head_front", "left_head_back", "right_head_back"]
    there = [name for name in band if name in skin]
    if len(there) == 4:
        points = filled_cluster([skin[name] for name in there])
        joints["head"] = np.mean(points, axis=0)
        return
    diagonals = [(band[0], band[3]), (band[1], band[2])]
    diagonal = next((pair for pair in diagonals if set(pair) <= set(there)), None)
    if diagonal or there:
        joints["head"] = _mean([skin[name] for name in diagonal or there])
        if not diagonal:
            approximate.add("head")
    elif "head" in skin:
        joints["head"] = skin["head"]
        approximate.add("head")


def _trunk(skin: Points, joints: Points, approximate: set[str]) -> None:
    """The point in the trunk below the neck: between clavicles and seventh neck vertebra."""
    pairs = [("clavicle", "c7"), ("left_shoulder", "right_shoulder"), ("clavicle",), ("c7",)]
    for names in pairs:
        if set(names) <= set(skin):
            joints["sternum"] = _mean([skin[name] for name in names])
            if names != pairs[0]:
                approximate.add("sternum")
            return


def _pelvis(skin: Points, joints: Points, approximate: set[str]) -> Pelvis | None:
    """The pelvis from its iliac spines; one of four may be missing, or the back ones a sacrum."""
    spines = {
        name: skin[name]
        for name in (
            *("left_front_waist", "right_front_waist"),
            *("left_back_waist", "right_back_waist"),
            "sacrum",
        )
        if name in skin
    }
    if len(spines) >= 3:
        spines = dict(zip(spines, filled_cluster(list(spines.values())), strict=True))
    left, right = spines.get("left_front_waist"), spines.get("right_front_waist")
    backs = [spines.get("left_back_waist"), spines.get("right_back_waist")]
    back = None
    if backs[0] is not None and backs[1] is not None:
        back = (backs[0] + backs[1]) / 2
        if left is None and right is not None:
            left = _mirrored(right, back, backs[0] - backs[1])
            approximate.add("pelvis")
        elif right is None and left is not None:
            right = _mirrored(left, back, backs[0] - backs[1])
            approximate.add("pelvis")
    elif "sacrum" in spines:
        back = spines["sacrum"]
    elif left is not None and right is not None:
        one = next((point for point in backs if point is not None), None)
        if one is not None:
            back = (one + _mirrored(one, (left + right) / 2, left - right)) / 2
            approximate.add("pelvis")
    if left is None or right is None or back is None:
        return None
    pelvis = pelvis_from_spines(left, right, back)
    joints["pelvis"] = (pelvis.origin + back) / 2
    return pelvis


def _leg(
    side: str,
    skin: Points,
    joints: Points,
    approximate: set[str],
    outward: np.ndarray,
    leg_mm: float,
    widths_mm: Mapping[str, float],
) -> None:
    above = joints[f"{side}_hip"]
    for part, wand in (("knee", "thigh"), ("ankle", "shank")):
        name = f"{side}_{part}"
        if name not in skin:
            return
        marker = skin[name]
        if f"{name}_inner" in skin:
            joints[name] = _mean([marker, skin[f"{name}_inner"]])
        else:
            if f"{side}_{wand}" in skin:
                outward = _plane_of_wand(above, marker, skin[f"{side}_{wand}"], outward)
            width = widths_mm.get(name)
            if width is None:
                width = WIDTH_OF_LEG[part] * leg_mm
                approximate.add(name)
            joints[name] = chord(above, marker, outward, width / 2 + MARKER_RADIUS_MM)
        outward = marker - joints[name]
        above = joints[name]


def _plane_of_wand(
    proximal: np.ndarray, marker: np.ndarray, wand: np.ndarray, outward: np.ndarray
) -> np.ndarray:
    """Return the direction in which a marker on thigh or shank stands off the segment.

    Where it hardly does, it shows no plane, and the direction given counts.
    """
    off = across(wand - proximal, marker - proximal)
    lengths = np.linalg.norm(off, axis=1)
    lengths = lengths[~np.isnan(lengths)]
    if not len(lengths) or np.median(lengths) < CLEAR_MM:
        return outward
    return bridged(unit(off))


def _arm(
    side: str,
    skin: Points,
    joints: Points,
    approximate: set[str],
    outward: np.ndarray,
    leg_mm: float,
    widths_mm: Mapping[str, float],
) -> None:
    wrist = _first(
        _both(skin, f"{side}_wrist_thumb", f"{side}_wrist_little"),
        skin.get(f"{side}_wrist"),
        skin.get(f"{side}_wrist_thumb"),
        skin.get(f"{side}_wrist_little"),
    )
    if wrist is not None:
        joints[f"{side}_wrist"] = wrist
    acromion, elbow = skin.get(f"{side}_shoulder"), skin.get(f"{side}_elbow")
    if acromion is None:
        return
    if "sternum" in joints:
        up = unit(joints["sternum"] - joints["pelvis"])
        below, inwards = (share * leg_mm for share in SHOULDER_OF_LEG)
        joints[f"{side}_shoulder"] = acromion - below * up - inwards * unit(across(outward, up))
        approximate.add(f"{side}_shoulder")
    if elbow is None or f"{side}_shoulder" not in joints:
        return
    shoulder = joints[f"{side}_shoulder"]
    name = f"{side}_elbow"
    if f"{name}_inner" in skin:
        joints[name] = _mean([elbow, skin[f"{name}_inner"]])
        return
    width = widths_mm.get(name)
    if width is None:
        width = WIDTH_OF_LEG["elbow"] * leg_mm
        approximate.add(name)
    if wrist is not None:
        outward = _axis_of_elbow(shoulder, elbow, wrist, outward)
    joints[name] = chord(shoulder, elbow, outward, width / 2 + MARKER_RADIUS_MM)


def _axis_of_elbow(
    shoulder: np.ndarray, elbow: np.ndarray, wrist: np.ndarray, outward: np.ndarray
) -> np.ndarray:
    """Return the outward direction at right angles to upper arm and forearm.

    The elbow bends one way only, so its axis points to the right of the body on both sides.
    """
    axis = np.cross(unit(elbow - shoulder), unit(wrist - elbow))
    axis[np.linalg.norm(axis, axis=1) < CLEAR_BEND] = np.nan
    axis = bridged(axis)
    if np.isnan(axis).all():
        return outward
    inner = np.nansum(axis * outward, axis=1)
    return axis * (1.0 if np.median(inner) > 0 else -1.0)


def _leg_length(skin: Points) -> float:
    """Return the length of the legs from front iliac spine over knee to ankle, in millimetres."""
    lengths = []
    for side in SIDES:
        chain = [skin.get(f"{side}_{part}") for part in ("front_waist", "knee", "ankle")]
        if chain[0] is not None and chain[1] is not None and chain[2] is not None:
            thigh = np.linalg.norm(chain[1] - chain[0], axis=1)
            shank = np.linalg.norm(chain[2] - chain[1], axis=1)
            whole = (thigh + shank)[~np.isnan(thigh + shank)]
            lengths += [float(np.median(whole))] if len(whole) else []
    return float(np.mean(lengths)) if lengths else 880.0


def filled_cluster(points: list[np.ndarray]) -> list[np.ndarray]:
    """Return markers of one rigid part, those missing put where the other three or more say.

    Parameters
    ----------
    points : list of arrays of shape (time, 3)
        Three markers or more; NaN where missing.

    Returns
    -------
    list of arrays of shape (time, 3)
        Without change where fewer than three markers are seen.

    """
    cluster = np.stack(points, axis=1)
    there = ~np.isnan(cluster).any(axis=2)
    whole = there.all(axis=1)
    partly = (there.sum(axis=1) >= 3) & ~whole
    if not whole.any() or not partly.any():
        return points
    complete = cluster[whole]
    for frame in np.flatnonzero(partly):
        nearest = complete[np.abs(np.flatnonzero(whole) - frame).argmin()]
        seen = there[frame]
        centre, target = nearest[seen].mean(axis=0), cluster[frame, seen].mean(axis=0)
        turn, _ = Rotation.align_vectors(cluster[frame, seen] - target, nearest[seen] - centre)
        cluster[frame, ~seen] = turn.apply(nearest[~seen] - centre) + target
    return list(cluster.transpose(1, 0, 2))


def _mean(points: list[np.ndarray]) -> np.ndarray:
    """Return the midpoint of markers; a missing one stands as it did to the others before and after."""
    if len(points) == 2:
        first, second = points
        apart = bridged(second - first)
        points = [
            np.where(np.isnan(first), second - apart, first),
            np.where(np.isnan(second), first + apart, second),
        ]
    return np.mean(points, axis=0)


def _mirrored(point: np.ndarray, middle: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Return a point mirrored in the plane through `middle` at right angles to `normal`."""
    normal = unit(normal)
    return point - 2 * ((point - middle) * normal).sum(axis=1, keepdims=True) * normal


def _both(skin: Points, first: str, second: str) -> np.ndarray | None:
    return _mean([skin[first], skin[second]]) if first in skin and second in skin else None


def _first(*points: np.ndarray | None) -> np.ndarray | None:
    return next((point for point in points if point is not None), None)
