"""Joints that are not where those of people are, by lengths, sides, heights and breadth."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations
from typing import Literal, NamedTuple

import numpy as np
import xarray as xr

from eigenwalker.core.skeleton import JOINTS, LIMBS
from eigenwalker.gait.body_points import SIDES

SEGMENTS = {
    LIMBS["thighs"]: 0.245,
    LIMBS["shanks"]: 0.246,
    LIMBS["upper arms"]: 0.186,
    LIMBS["forearms"]: 0.146,
}
"""Lengths as shares of stature (Winter 2009, fig. 4.1, after Drillis & Contini 1966)."""

TRUNK = 0.288
"""From the middle of the hips to that of the shoulders (same figure: 0.818 less 0.530)."""

LENGTH_FACTOR = 1.5
"""Factor by which a segment may differ. People vary by a few per cent (de Leva 1996, J Biomech
29:1223); the factor is set outside what our captures show, whose points and markers that are called
joints differ by up to 1.37."""

SIDE_FACTOR = 1.25
"""Ratio of left and right that is tolerated: noisy depth cameras reach 1.12."""

BREADTHS = {
    "hip": 0.103,
    "shoulder": 0.2025,
    "knee": 0.09,
    "elbow": 0.28,
    "wrist": 0.29,
    "ankle": 0.065,
}
"""How far left and right are apart across the body, as shares of stature: hips and shoulders as in
`retarget` (ANSUR II), the others as people walk (medians of simulated people)."""

BREADTH_FACTORS = (0.6, 1.5)
"""Range of their geometric mean over `BREADTHS`, set outside what our captures and simulated people
show, 0.66 to 1.32."""

TORSO_FACTORS = (0.65, 1.6)
"""The same of hips and shoulders alone, on which posture tells nothing; shown are 0.71 to 1.51."""

BOTH_FACTORS = (0.8, 1.35), (0.7, 1.42)
"""Ranges of hips and shoulders, and of all, that nobody leaves to the same side: where hips and
shoulders of a skeleton are 0.72 or 1.51 of those of people its other joints are not, and the mean
of all is 0.74 and more or 1.33 and less. In a body that is stretched all are."""

NARROWEST = 0.25
"""Share of `BREADTHS` below which a single breadth counts as this, so that none decides alone."""

CROSSING = 0.05
"""Share of stature by which wrists and ankles may cross over: they swing, feet step narrowly."""

LEAST_TWIST_COSINE = 0.5
"""Cosine of the angle between hips and shoulders, whose twist is 20 degrees at most."""

LEVEL_LINE = 0.85
"""Cosine of the slope of hips and shoulders: those of people slope by some 10 degrees."""

ONE_PLACE = 0.01
"""Share of stature within which two joints are one; the nearest ones of skeletons have 0.04."""

MIDDLE = 0.25
"""Share of the distance of left and right by which pelvis and sternum may be off the middle."""

NEAR_MIDDLE = 0.15
"""Share of stature within which pelvis and sternum are of the middle of hips and shoulders; those
of skeletons reach 0.09."""

LINK_VARIATION = 0.10
"""Coefficient of variation of distances within pelvis and trunk: skeletons and skin stay below
0.04."""

LINK_OF_LIMBS = 3.0
"""The same over the median one of the limbs. Where a noisy camera makes all lengths vary, those of
pelvis and trunk tell nothing of labels: depth cameras reach about 3."""

FRAMES = 200
"""Frames that are looked at."""

_LINKS = [("pelvis", "sternum"), ("sternum", "head")]
_LINKS += [(f"left_{part}", f"right_{part}") for part in ("hip", "shoulder")]
_LINKS += [
    (centre, f"{s}_{p}")
    for centre, p in (("pelvis", "hip"), ("sternum", "shoulder"))
    for s in SIDES
]
_ABOVE = [("head", "sternum"), ("sternum", "pelvis")]
_ABOVE += [
    (upper if upper == "head" else f"{side}_{upper}", f"{side}_{lower}")
    for side in SIDES
    for upper, lower in (
        ("head", "shoulder"),
        ("shoulder", "hip"),
        ("hip", "knee"),
        ("knee", "ankle"),
    )
]


class WrongJoint(NamedTuple):
    """Something that joints of a person cannot be.

    Parameters
    ----------
    kind : str
        ``"length"`` of a segment (value: over what it is in people), ``"unequal"`` segments of left
        and right (ratio), ``"order"`` (the first is not above the second), ``"side"`` (the first is
        not to the left of the second), ``"place"`` (both are in one), ``"middle"`` (the first is
        not between the others), ``"breadth"`` of the body (over that of people), ``"link"``
        (coefficient of variation of a distance); of markers on the skin ``"exchanged"`` (with one
        another) and ``"elsewhere"`` (than in the marker set).
    points : tuple of str
        The joints or markers.
    value : float
        A ratio, without a unit; NaN where the kind has none.

    See Also
    --------
    assess : Looks for them.
    """

    kind: Literal[
        "length",
        "unequal",
        "order",
        "side",
        "place",
        "middle",
        "breadth",
        "link",
        "exchanged",
        "elsewhere",
    ]
    points: tuple[str, ...]
    value: float = float("nan")


def wrong_joints(capture: xr.DataArray) -> tuple[WrongJoint, ...]:
    """Return what those joints of a capture, z up, cannot be that it has and that were seen."""
    present = np.isin(capture.marker.values, JOINTS.markers)
    present &= np.isfinite(capture.values).all(axis=2).any(axis=0)
    names, values = capture.marker.values[present].tolist(), capture.values[:, present]
    values = values[np.isfinite(values).all(axis=(1, 2))]
    values = values[:: max(1, len(values) // FRAMES)]
    if not values.size:
        return ()
    path = dict(zip(names, values.swapaxes(0, 1), strict=True))
    for part in BREADTHS:
        if not {f"left_{part}", f"right_{part}"} <= set(names):
            continue
        path[part] = (path[f"left_{part}"] + path[f"right_{part}"]) / 2
        path[f"{part}s"] = path[f"left_{part}"] - path[f"right_{part}"]
    lengths = {
        (f"{side}_{upper}", f"{side}_{lower}"): (
            _distance(path, f"{side}_{upper}", f"{side}_{lower}"),
            share,
        )
        for (upper, lower), share in SEGMENTS.items()
        for side in SIDES
        if _has(path, f"{side}_{upper}", f"{side}_{lower}")
    }
    if _has(path, "hip", "shoulder"):
        lengths["hip", "shoulder"] = _distance(path, "hip", "shoulder"), TRUNK
    statures = [length / share for length, share in lengths.values()]
    stature = float(np.median(statures)) if statures else np.nan
    if stature <= 0:
        return (WrongJoint("place", ("left_hip", "left_knee")),)
    found = [
        WrongJoint("length", points, length / share / stature)
        for points, (length, share) in lengths.items()
        if not 1 / LENGTH_FACTOR <= length / share / stature <= LENGTH_FACTOR
    ]
    found += _places(path, stature)
    found += _unequal(path)
    found += _sides(path, stature)
    found += [
        WrongJoint("order", pair)
        for pair in _ABOVE
        if _has(path, *pair) and not np.median(path[pair[0]][:, 2] - path[pair[1]][:, 2]) > 0
    ]
    variations = [_variation(path, *points) for points in lengths]
    found += _links(path, float(np.median(variations)) if variations else 0.0)
    return tuple(found)


def _has(path: dict[str, np.ndarray], *points: str) -> bool:
    return all(point in path for point in points)


def _distance(path: dict[str, np.ndarray], one: str, other: str) -> float:
    return float(np.median(np.linalg.norm(path[one] - path[other], axis=1)))


def _places(path: dict[str, np.ndarray], stature: float) -> Iterator[WrongJoint]:
    """Yield joints in one place, and centres that are not in the middle of left and right."""
    for pair in combinations([name for name in JOINTS.markers if name in path], 2):
        if _distance(path, *pair) < ONE_PLACE * stature:
            yield WrongJoint("place", pair)
    for centre, part in (("pelvis", "hip"), ("sternum", "shoulder")):
        if not _has(path, centre, part):
            continue
        across = path[f"{part}s"]
        aside = np.einsum("ta,ta->t", path[centre] - path[part], across)
        aside = abs(np.median(aside / np.einsum("ta,ta->t", across, across).clip(1e-9)))
        if aside > MIDDLE or _distance(path, centre, part) > NEAR_MIDDLE * stature:
            yield WrongJoint("middle", (centre, f"left_{part}", f"right_{part}"))


def _unequal(path: dict[str, np.ndarray]) -> Iterator[WrongJoint]:
    """Yield segments whose left and right differ."""
    for upper, lower in (*SEGMENTS, ("pelvis", "hip"), ("sternum", "shoulder")):
        ends = [
            (upper if upper in ("pelvis", "sternum") else f"{side}_{upper}", f"{side}_{lower}")
            for side in SIDES
        ]
        if not _has(path, *ends[0], *ends[1]):
            continue
        left, right = (_distance(path, *each) for each in ends)
        ratio = max(left, right) / max(min(left, right), 1e-9)
        if ratio > SIDE_FACTOR:
            yield WrongJoint("unequal", tuple(dict.fromkeys([*ends[0], *ends[1]])), ratio)


def _sides(path: dict[str, np.ndarray], stature: float) -> Iterator[WrongJoint]:
    """Yield left joints that are not to the left, lines that are tilted, and a wrong breadth."""
    lines = {part: _unit(path[f"{part}s"]) for part in ("hip", "shoulder") if part in path}
    if not lines:
        return
    if len(lines) == 2 and _cosine(lines["hip"], lines["shoulder"]) < LEAST_TWIST_COSINE:
        left = _left_by_legs(path)
        part = min(lines, key=lambda each: _cosine(lines[each], left))
        yield WrongJoint("side", (f"left_{part}", f"right_{part}"))
        return
    leftward = _unit(np.sum(list(lines.values()), axis=0))
    logs = []
    for part, share in BREADTHS.items():
        if part not in path:
            continue
        across = path[f"{part}s"]
        apart = np.einsum("ta,ta->t", across[:, :2], leftward)
        least = -CROSSING * np.nan_to_num(stature) if part in ("wrist", "ankle") else 0.0
        sloping = np.median(apart / np.linalg.norm(across, axis=1).clip(1e-9)) < LEVEL_LINE
        if np.median(apart) <= least or (part in ("hip", "shoulder") and sloping):
            yield WrongJoint("side", (f"left_{part}", f"right_{part}"))
        logs.append(np.log(max(np.median(apart) / stature / share, NARROWEST)))
    torso, whole = float(np.exp(np.mean(logs[:2]))), float(np.exp(np.mean(logs)))
    if len(lines) == 2 and not TORSO_FACTORS[0] <= torso <= TORSO_FACTORS[1]:
        yield WrongJoint("breadth", (), torso)
    elif len(logs) == len(BREADTHS) and not BREADTH_FACTORS[0] <= whole <= BREADTH_FACTORS[1]:
        yield WrongJoint("breadth", (), whole)
    elif len(logs) == len(BREADTHS):
        (narrow, broad), (narrowest, broadest) = BOTH_FACTORS
        if (torso < narrow and whole < narrowest) or (torso > broad and whole > broadest):
            yield WrongJoint("breadth", (), whole)


def _left_by_legs(path: dict[str, np.ndarray]) -> np.ndarray:
    """Return where left is by the bend of the knees; as hips say where legs are not known.

    The mean of both legs does not depend on which of them is called left.
    """
    if not _has(path, "knee", "ankle"):
        return _unit(path["hips"])
    x, y, _ = (path["knee"] - (path["hip"] + path["ankle"]) / 2).T
    return _unit(np.stack([-y, x], axis=1))


def _unit(line: np.ndarray) -> np.ndarray:
    """Return the horizontal unit vectors of a line."""
    line = line[:, :2]
    return line / np.linalg.norm(line, axis=1, keepdims=True).clip(1e-9)


def _cosine(one: np.ndarray, other: np.ndarray) -> float:
    return float(np.median(np.einsum("ta,ta->t", one, other)))


def _variation(path: dict[str, np.ndarray], one: str, other: str) -> float:
    length = np.linalg.norm(path[one] - path[other], axis=1)
    return float(length.std() / max(length.mean(), 1e-9))


def _links(path: dict[str, np.ndarray], of_limbs: float) -> Iterator[WrongJoint]:
    """Yield distances within pelvis and trunk that do not hold, beside those of limbs."""
    for pair in _LINKS:
        if not _has(path, *pair):
            continue
        variation = _variation(path, *pair)
        if variation > max(LINK_VARIATION, LINK_OF_LIMBS * of_limbs):
            yield WrongJoint("link", pair, variation)
