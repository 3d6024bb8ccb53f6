"""Markers on the skin that are not where their marker set has them."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass, replace
from functools import cache, lru_cache
from importlib.resources import files
from typing import NamedTuple

import numpy as np
import xarray as xr

from eigenwalker.gait.body_points import SIDES
from eigenwalker.markers.marker_sets import known_sets, marker_names
from eigenwalker.quality.anthropometry import ONE_PLACE, WrongJoint

SHARE_FOUND = 0.6
"""Share of the points of a marker set from which on a capture is said to be of that set."""

ELSEWHERE = -0.5
"""Cosine of the angle between a direction from marker to marker and the one in the table, below
which one of them is elsewhere: on people who walk it is above 0.4, after an exchange below -0.4."""

NEAR = 0.03
"""Share of stature within which markers lie in no direction that could be relied on."""

FAR_OF_ARMS = 0.25
"""The same between an arm and other parts, as arms may be bent and held in many ways."""

FAR_OF_FEET = 0.13
"""The same between the feet, which may be placed in one line or cross over a little."""

RIGID_MM = 30.0
"""SD of a distance within one rigid part: skin moves by up to 30 mm from end to end on the thigh
(Leardini et al. 2005, Gait Posture 21:212); captures show up to 11."""

LENGTH = 0.08
"""By how much such a distance may be off, as a share of stature: captures show up to 0.04."""

BULK = 2.56
"""SDs between the first and the last decile of what is normally distributed."""

EXPLAINED = 0.25
"""Share of the contradictions of two markers that may be left by an exchange that explains them."""

FRAMES = 50
"""Frames that are looked at."""


class _Place(NamedTuple):
    """Where a marker is in the mean of a walk, as a share of stature, and on which parts."""

    position: np.ndarray
    parts: frozenset[str]


@dataclass(frozen=True)
class _Seen:
    """Markers of a capture beside the table; matrices are of shape (marker, marker)."""

    names: list[str]
    expected: np.ndarray
    apart: np.ndarray
    distance: np.ndarray
    variation: np.ndarray
    relied_on: np.ndarray
    rigid: np.ndarray

    def alike(self) -> np.ndarray:
        """Return which pairs of markers are in one place."""
        return (np.linalg.norm(self.expected, axis=2) >= NEAR) & (self.distance < ONE_PLACE)

    def turned(self) -> np.ndarray:
        """Return by how much directions are off, as one less the cosine of the angle."""
        lengths = np.linalg.norm(self.apart, axis=2) * np.linalg.norm(self.expected, axis=2)
        cosine = (self.apart * self.expected).sum(axis=2) / np.maximum(lengths, 1e-9)
        return np.where(self.relied_on, 1 - cosine, 0.0)

    def contradictions(self) -> np.ndarray:
        """Return which pairs of markers contradict the table."""
        lengths = abs(self.distance - np.linalg.norm(self.expected, axis=2))
        stretched = self.rigid & ((self.variation > RIGID_MM) | (lengths > LENGTH))
        return (self.turned() > 1 - ELSEWHERE) | stretched

    def exchanged(self, one: int, other: int) -> _Seen:
        """Return the same with two markers exchanged."""
        order = np.arange(len(self.names))
        order[[one, other]] = other, one
        pairs = np.ix_(order, order)
        moved = {name: getattr(self, name)[pairs] for name in ("apart", "distance", "variation")}
        return replace(self, **moved)

    def without(self, markers: np.ndarray) -> _Seen:
        """Return the same without some markers."""
        others = np.delete(np.arange(len(self.names)), markers)
        pairs = np.ix_(others, others)
        return _Seen(
            [self.names[index] for index in others],
            *(getattr(self, name)[pairs] for name in list(self.__dataclass_fields__)[1:]),
        )


def wrong_markers(capture: xr.DataArray) -> tuple[tuple[WrongJoint, ...], bool]:
    """Return which markers of a known set are elsewhere, and whether the body is mirrored.

    A marker is held to the directions in which the others of its set lie in the mean of a walk, and
    to the distances that do not change within head, trunk, pelvis, and segments of the limbs.
    """
    places = _places(tuple(str(name) for name in capture.marker.values))
    capture = capture[:: max(1, len(capture) // FRAMES)]
    there = np.isfinite(capture.sel(marker=list(places)).values).all(axis=2).mean(axis=0) > 0.5
    places = {name: places[name] for name, seen in zip(places, there, strict=True) if seen}
    if len(places) < len(SIDES) * 3:
        return (), False
    positions = capture.sel(marker=list(places)).values
    seen = _beside_table(positions, places)
    contradictions = seen.contradictions().sum()
    if not contradictions and not seen.alike().any():
        return (), False
    mirrored = {
        name: place._replace(position=place.position * [1, -1, 1]) for name, place in places.items()
    }
    if _beside_table(positions, mirrored).contradictions().sum() < EXPLAINED * contradictions:
        return (), True
    return tuple(_explained(seen)), False


def _explained(seen: _Seen) -> list[WrongJoint]:
    """Return the fewest exchanges and misplaced markers that explain all contradictions."""
    alike = np.argwhere(np.triu(seen.alike()))
    found = [WrongJoint("place", (seen.names[one], seen.names[other])) for one, other in alike]
    seen = seen.without(np.unique(alike))
    while (wrong := seen.contradictions()).any():
        worst = int(wrong.sum(axis=0).argmax())
        ways = {
            other: seen.exchanged(worst, other)
            for other in range(len(seen.names))
            if other != worst
        }
        left = {
            other: (way.contradictions().sum(), way.turned().sum()) for other, way in ways.items()
        }
        other = min(left, key=lambda other: left[other])
        pair = [worst, other]
        if ways[other].contradictions()[pair].sum() <= EXPLAINED * wrong[pair].sum():
            found.append(WrongJoint("exchanged", (seen.names[worst], seen.names[other])))
            seen = ways[other]
        else:
            found.append(WrongJoint("elsewhere", (seen.names[worst],)))
            seen = seen.without(np.array([worst]))
    return found


def _beside_table(positions: np.ndarray, places: dict[str, _Place]) -> _Seen:
    """Return how markers lie to one another, each frame turned to face as the table does."""
    table = np.stack([place.position for place in places.values()])
    seen = np.asarray(np.isfinite(positions).all(axis=2))
    bodies, tables = (_centred(each, seen[..., None]) for each in (positions, table[None]))
    x, y = np.moveaxis(bodies[..., :2], 2, 0)
    facing = ((x + 1j * y) * (tables[..., 0] - 1j * tables[..., 1])).sum(axis=1)
    turned = (x + 1j * y) * np.exp(-1j * np.angle(facing))[:, None]
    bodies = np.stack([turned.real, turned.imag, bodies[..., 2]], axis=2)
    stature = max((bodies * tables).sum() / max((tables**2).sum(), 1e-9), 1e-9)
    both = (seen[:, :, None] & seen[:, None])[..., None]
    apart = np.where(both, bodies[:, :, None] - bodies[:, None], np.nan) / stature
    expected = table[:, None] - table
    parts = [place.parts for place in places.values()]
    rigid = np.array([[bool(one & other) for other in parts] for one in parts])
    lengths = np.linalg.norm(apart, axis=3)
    variation = np.zeros(rigid.shape)
    once = np.triu(rigid, 1)
    ends = np.nanquantile(lengths[:, once], (0.1, 0.9), axis=0)
    variation[once] = stature * (ends[1] - ends[0]) / BULK
    return _Seen(
        list(places),
        expected,
        np.nan_to_num(np.nanmean(apart, axis=0)),
        np.nanmean(lengths, axis=0),
        variation + variation.T,
        np.linalg.norm(expected, axis=2) >= _nearest_of(tuple(parts)),
        rigid,
    )


@lru_cache(maxsize=8)
def _nearest_of(parts: tuple[frozenset[str], ...]) -> np.ndarray:
    return np.array([[_nearest(one, other) for other in parts] for one in parts])


def _centred(positions: np.ndarray, seen: np.ndarray) -> np.ndarray:
    """Return positions about the mean of those seen in each frame; 0 where unseen."""
    positions = np.where(seen, positions, 0.0)
    mean = positions.sum(axis=1, keepdims=True) / np.maximum(seen.sum(axis=1, keepdims=True), 1)
    return np.where(seen, positions - mean, 0.0)


def _nearest(one: frozenset[str], other: frozenset[str]) -> float:
    """Return the distance from which on the direction between two markers is relied on."""
    arms, feet = (
        [{part[:1] for part in parts if part.endswith(kind)} for parts in (one, other)]
        for kind in (("arm", "hand"), "foot")
    )
    free = any(part.endswith(("forearm", "hand")) for part in one | other)
    if free and arms[0] != arms[1]:
        return FAR_OF_ARMS
    return FAR_OF_FEET if all(feet) and feet[0] != feet[1] else NEAR


@lru_cache(maxsize=8)
def _places(names: tuple[str, ...]) -> dict[str, _Place]:
    """Return the places of those markers that are known; none for skeletons and unknown sets."""
    found = marker_names(names)
    on_skin = [each for each in known_sets()[:-1] if each.landmarks]
    used = max(on_skin, key=lambda each: each.share_found(found))
    if used.share_found(found) < SHARE_FOUND:
        return {}
    places: dict[str, _Place] = {}
    table = _table()
    for role, entry in {**used.joints, **used.extras, **used.landmarks}.items():
        side = role.partition("_")[0]
        side = side if side in SIDES else ""
        hit, place = found.find(entry), table["roles"].get(role.removeprefix(f"{side}_"))
        if hit and place:
            places |= dict.fromkeys(hit.markers, _place(place, side))
    for entry, place in table["markers"].items():
        for side in SIDES if "{L}" in entry else ("",):
            if hit := found.find(entry.replace("{L}", f"{{{side}}}")):
                places[hit.markers[0]] = _place(place, side)
    return places


def _place(place: dict[str, list], side: str) -> _Place:
    across = [1, -1, 1] if side == "right" else [1, 1, 1]
    parts = frozenset(f"{side}_{part}".strip("_") for part in place["on"])
    return _Place(np.array(place["at"]) * across, parts)


@cache
def _table() -> dict[str, dict[str, dict[str, list]]]:
    text = files("eigenwalker.quality").joinpath("marker_places.toml").read_text(encoding="utf-8")
    return tomllib.loads(text)
