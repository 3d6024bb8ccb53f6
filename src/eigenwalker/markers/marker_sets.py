"""Names of markers: the known marker sets, and how their markers are found in a capture."""

from __future__ import annotations

import re
import tomllib
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache, lru_cache
from importlib.resources import files
from typing import NamedTuple

SIDES = ("left", "right")
MEASURED = ("_width_mm", "_leg_length_mm", "_shoulder_offset_mm")
"""Ends of the coordinates that hold what was measured on a person."""
MIN_COMMON = 0.6
"""Share of the names that must begin alike for their prefix to be the name of a subject."""
MAX_PREFIXES = 20
"""Prefixes that are taken off a name, as in ``Study_03_Anna_LKNE``."""
MAX_LENGTH = 200
"""Letters of a name that are used."""

_SIDE_AND_PART = (
    re.compile(r"(?P<side>left|right)[ _.-]*(?P<part>.+)", re.IGNORECASE),
    re.compile(r"(?P<part>.+?)[ _.-]*(?P<side>left|right)", re.IGNORECASE),
    re.compile(r"(?P<side>[lr])[ _.-]+(?P<part>.+)", re.IGNORECASE),
    re.compile(r"(?P<part>.+?)[ _.-]+(?P<side>[lr])", re.IGNORECASE),
    re.compile(r"(?P<side>[lrLR])(?P<part>[A-Z].*)"),
    re.compile(r"(?P<part>.*[a-z])(?P<side>[LR])"),
)
"""LeftThigh, ThighLeft, L_Thigh, thigh.L, lThigh, ThighL."""


@dataclass(frozen=True)
class MarkerSet:
    """A marker set or skeleton: which markers give each landmark, joint and extra point.

    An entry names markers in the spelling of ``marker_sets.toml``: ``{left}KNEE | {left}KNE`` are
    alternatives, ``{left}WRA + {left}WRB`` are two whose midpoint is meant, ``~`` marks a stand-in.
    """

    name: str
    landmarks: Mapping[str, str]
    joints: Mapping[str, str]
    extras: Mapping[str, str]

    def share_found(self, names: MarkerNames) -> float:
        """Return the share of the points of the set for which the capture has markers.

        Of a set on the skin, inner markers and joint centres do not count, as most captures lack
        them, nor does a sacrum where the back of the pelvis has markers of its own.
        """
        entries = {**self.joints, **self.landmarks, **self.extras}
        present = {name for name, entry in entries.items() if names.find(entry)}
        expected = {name for name in entries if not name.endswith("_inner")}
        if self.landmarks:
            expected -= set(self.joints) - {"head", "left_wrist", "right_wrist", *self.landmarks}
        backs = {f"{side}_back_waist" for side in SIDES}
        expected -= {"sacrum"} if backs <= present else backs if "sacrum" in present else set()
        return len(expected & present) / len(expected)


@cache
def known_sets() -> tuple[MarkerSet, ...]:
    """Return the marker sets of ``marker_sets.toml`` and one of all on the skin."""
    text = files("eigenwalker.markers").joinpath("marker_sets.toml").read_text(encoding="utf-8")
    sets = [
        MarkerSet(
            name,
            landmarks=_both_sides(table.get("landmarks", {})),
            joints=_both_sides(table.get("joints", {})),
            extras=_both_sides(table.get("extras", {})),
        )
        for name, table in tomllib.loads(text).items()
    ]
    on_skin = [known for known in sets if known.landmarks]
    mixed = MarkerSet(
        "landmarks of several sets",
        landmarks=_merged([known.landmarks for known in on_skin]),
        joints=_merged([known.joints for known in on_skin]),
        extras=_merged([known.extras for known in on_skin]),
    )
    return (*sets, mixed)


def _merged(entries: Sequence[Mapping[str, str]]) -> dict[str, str]:
    """Return the entries of several sets as one, with the alternatives of all."""
    merged: dict[str, list[str]] = {}
    for name, entry in (item for of_set in entries for item in of_set.items()):
        merged.setdefault(name, []).append(entry)
    return {name: " | ".join(alternatives) for name, alternatives in merged.items()}


def _both_sides(entries: Mapping[str, str]) -> dict[str, str]:
    """Return an entry that is about one side twice, for the left and the right."""
    expanded: dict[str, str] = {}
    for name, entry in entries.items():
        if "{L}" in entry and "{R}" not in entry:
            for side in SIDES:
                expanded[f"{side}_{name}"] = entry.replace("{L}", f"{{{side}}}")
        else:
            expanded[name] = entry.replace("{L}", "{left}").replace("{R}", "{right}")
    return expanded


class MarkerMatch(NamedTuple):
    """Markers whose midpoint a point of a set is; those lacking of a better one."""

    markers: tuple[str, ...]
    stand_in: bool
    lacking: tuple[str, ...] = ()


class MarkerNames:
    """The marker names of a capture, searched by the entries of a marker set."""

    def __init__(self, names: Sequence[str]) -> None:
        self._known: dict[str, str] = {}
        for name, own in zip(names, _without_common_prefix(names), strict=True):
            for key in (_plain(own), *_side_first(own), *_of_midline(own)):
                self._known.setdefault(key, name)
        self._matches: dict[str, MarkerMatch | None] = {}

    def find(self, entry: str) -> MarkerMatch | None:
        """Return the markers of the first alternative of an entry that the capture has in full."""
        if entry not in self._matches:
            self._matches[entry] = self._search(entry)
        return self._matches[entry]

    def _search(self, entry: str) -> MarkerMatch | None:
        lacking: tuple[str, ...] = ()
        for alternative in entry.split("|"):
            words = [word.strip() for word in alternative.strip().removeprefix("~").split("+")]
            hits = [self._find_one(word) for word in words]
            markers = tuple(hit for hit in hits if hit)
            if len(markers) == len(words):
                stand_in = alternative.strip().startswith("~")
                return MarkerMatch(markers, stand_in, lacking)
            if markers and not lacking:
                lacking = tuple(
                    _spelled(word) for word, hit in zip(words, hits, strict=True) if not hit
                )
        return None

    def _find_one(self, word: str) -> str | None:
        side = next((side for side in SIDES if f"{{{side}}}" in word), None)
        if side is None:
            return self._known.get(_plain(word))
        mark = f"{{{side}}}"
        keys = [_plain(word.replace(mark, side[0])), _plain(word.replace(mark, side))]
        if word.startswith(mark):
            keys.insert(0, f"{side}|{_plain(word.removeprefix(mark))}")
        return next((self._known[key] for key in keys if key in self._known), None)


@lru_cache(maxsize=8)
def marker_names(names: tuple[str, ...]) -> MarkerNames:
    """Return the searchable names of a capture; captures of one study share the cache."""
    return MarkerNames(names)


def _spelled(word: str) -> str:
    """Return a word of a marker set in the spelling of captures: ``LKNE`` for ``{left}KNE``."""
    for side in SIDES:
        word = word.replace(f"{{{side}}}", side[0].upper())
    return word


def subjects(names: Sequence[str]) -> list[str]:
    """Return the subjects before the names, such as Anna in ``Anna:LKNE``, sorted."""
    return sorted({name.rpartition(":")[0] for name in names} - {""})


def side_pairs(names: Sequence[str]) -> list[tuple[str, str]]:
    """Return the pairs of markers whose names differ only in their side, the left one first."""
    return list(_side_pairs(tuple(names)))


@lru_cache(maxsize=8)
def _side_pairs(names: tuple[str, ...]) -> tuple[tuple[str, str], ...]:
    sides: dict[str, dict[str, str]] = {}
    for name, own in zip(names, _without_common_prefix(names), strict=True):
        keys = _side_first(own)
        if own[:1] in ("l", "r"):
            keys.append(f"{'left' if own[0] == 'l' else 'right'}|{_plain(own[1:])}")
        for side, _, part in (key.partition("|") for key in keys):
            sides.setdefault(part, {}).setdefault(side, name)
    pairs = [(pair["left"], pair["right"]) for pair in sides.values() if len(pair) == 2]
    return tuple(dict.fromkeys(pairs))


def numbered(names: Sequence[str]) -> list[str]:
    """Return the names cut to `MAX_LENGTH`, the second of a name as ``hand_2``."""
    taken: dict[str, int] = {}
    different: list[str] = []
    for whole in names:
        new = name = whole[:MAX_LENGTH]
        while new in taken:
            taken[name] += 1
            new = f"{name}_{taken[name]}"
        taken[new] = 1
        different.append(new)
    return different


def repeated(names: Sequence[str]) -> list[str]:
    """Return the names that occur more than once."""
    return [name[:MAX_LENGTH] for name, count in Counter(names).items() if count > 1]


def _plain(name: str) -> str:
    return re.sub(r"[^a-z0-9*]", "", name.lower())


def _side_first(name: str) -> list[str]:
    """Return ``left|thigh`` for all ways to say so."""
    hits = [pattern.fullmatch(name.strip()) for pattern in _SIDE_AND_PART]
    sides = {side[0]: side for side in SIDES}
    return [f"{sides[hit['side'][0].lower()]}|{_plain(hit['part'])}" for hit in hits if hit]


def _of_midline(name: str) -> list[str]:
    """Return the part where a name marks it as central, as in C_Head."""
    hit = re.fullmatch(r"[cC][ _.-]+(.+)", name.strip())
    return [_plain(hit[1])] if hit else []


def _without_common_prefix(names: Sequence[str]) -> list[str]:
    """Return the names without the subject or character before most of them."""
    sides = {"l", "r", *SIDES}
    names = [re.split(r"[:|]", name)[-1].strip()[-MAX_LENGTH:] for name in names]
    for _ in range(MAX_PREFIXES):
        hits = (re.match(r"[^ _.-]+[ _.-]+(?=.)", name) for name in names)
        start, count = next(iter(Counter(hit[0] for hit in hits if hit).most_common(1)), ("", 0))
        if count < MIN_COMMON * len(names) or start.rstrip(" _.-").lower() in sides or not start:
            break
        names = [name.removeprefix(start) for name in names]
    return names
