"""What markers are called: the sets that are known, and how their names are found in a capture."""

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
COMMON = 0.6
"""Share of the names that must begin alike for the beginning to be the name of a subject."""
MOST_STARTS = 20
"""So many beginnings are taken off, as in ``Study_03_Anna_LKNE``."""
LONGEST = 200
"""Letters of a name that count."""

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
    """A marker set or skeleton: which markers give each landmark, joint and extra point."""

    name: str
    landmarks: Mapping[str, str]
    joints: Mapping[str, str]
    extras: Mapping[str, str]

    def share_found(self, names: MarkerNames) -> float:
        """Return for which share of what the set asks for the capture has markers.

        Of a set on the skin, inner markers and joint centres are left out, as most captures do
        without them, and a sacrum where the back of the pelvis has markers of its own.
        """
        asked = {**self.joints, **self.landmarks, **self.extras}
        found = {name for name, entry in asked.items() if names.find(entry)}
        wanted = {name for name in asked if not name.endswith("_inner")}
        if self.landmarks:
            wanted -= set(self.joints) - {"head", "left_wrist", "right_wrist"} - set(self.landmarks)
        backs = {f"{side}_back_waist" for side in SIDES}
        wanted -= {"sacrum"} if backs <= found else backs if "sacrum" in found else set()
        return len(wanted & found) / len(wanted)


@cache
def known_sets() -> tuple[MarkerSet, ...]:
    """Return the marker sets of ``marker_sets.toml``, in the order in which they are tried.

    The last is made of all sets on the skin, for captures that mix them.

    Examples
    --------
    >>> known_sets()[1].landmarks["right_thigh"]
    '{right}THI | {right}THIGH | {right}THL'

    """
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


class Found(NamedTuple):
    """Markers of a capture whose midpoint is what was asked for, and whether as a stand-in.

    ``lacking`` are markers that the capture would need to have it in a better way, for which it
    has others already.
    """

    markers: tuple[str, ...]
    stand_in: bool
    lacking: tuple[str, ...] = ()


class MarkerNames:
    """The marker names of a capture, to be asked in the spelling of a marker set.

    Parameters
    ----------
    names : sequence of str
        As they stand in the capture.

    Examples
    --------
    >>> names = MarkerNames(["Anna:LKNE", "Anna:LWRA", "Anna:LWRB"])
    >>> names.find("{left}KNEE | {left}KNE").markers
    ('Anna:LKNE',)
    >>> names.find("{left}WRA + {left}WRB").markers
    ('Anna:LWRA', 'Anna:LWRB')
    >>> MarkerNames(["mixamorig:LeftUpLeg", "thigh.R"]).find("{right}UpLeg | ~ {right}Thigh")
    Found(markers=('thigh.R',), stand_in=True, lacking=())

    """

    def __init__(self, names: Sequence[str]) -> None:
        self._known: dict[str, str] = {}
        for name, own in zip(names, _without_common_start(names), strict=True):
            for key in (_plain(own), *_side_first(own), *_of_midline(own)):
                self._known.setdefault(key, name)
        self._found: dict[str, Found | None] = {}

    def find(self, entry: str) -> Found | None:
        """Return the markers of the first alternative of an entry that the capture has in full."""
        if entry not in self._found:
            self._found[entry] = self._looked_for(entry)
        return self._found[entry]

    def _looked_for(self, entry: str) -> Found | None:
        lacking: tuple[str, ...] = ()
        for alternative in entry.split("|"):
            words = [word.strip() for word in alternative.strip().removeprefix("~").split("+")]
            hits = [self._find_one(word) for word in words]
            markers = tuple(hit for hit in hits if hit)
            if len(markers) == len(words):
                stand_in = alternative.strip().startswith("~")
                return Found(markers, stand_in, lacking)
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
    """Return the names of a capture, to be asked; captures of one study share what was found."""
    return MarkerNames(names)


def _spelled(word: str) -> str:
    """Return a word of a marker set as captures spell it: ``LKNE`` for ``{left}KNE``."""
    for side in SIDES:
        word = word.replace(f"{{{side}}}", side[0].upper())
    return word


def subjects(names: Sequence[str]) -> list[str]:
    """Return the subjects that stand before the names, as in ``Anna:LKNE``.

    Examples
    --------
    >>> subjects(["Anna:LKNE", "Ben:LKNE", "floor"])
    ['Anna', 'Ben']

    """
    return sorted({name.rpartition(":")[0] for name in names} - {""})


def side_pairs(names: Sequence[str]) -> list[tuple[str, str]]:
    """Return the markers that are called alike but for their side, the left one first.

    Examples
    --------
    >>> side_pairs(["LASI", "RASI", "C7", "Knee_R", "Knee_L", "left_hip", "right_hip"])
    [('LASI', 'RASI'), ('Knee_L', 'Knee_R'), ('left_hip', 'right_hip')]

    """
    return list(_side_pairs(tuple(names)))


@lru_cache(maxsize=8)
def _side_pairs(names: tuple[str, ...]) -> tuple[tuple[str, str], ...]:
    sides: dict[str, dict[str, str]] = {}
    for name, own in zip(names, _without_common_start(names), strict=True):
        keys = _side_first(own)
        if own[:1] in ("l", "r"):
            keys.append(f"{'left' if own[0] == 'l' else 'right'}|{_plain(own[1:])}")
        for side, _, part in (key.partition("|") for key in keys):
            sides.setdefault(part, {}).setdefault(side, name)
    pairs = [(found["left"], found["right"]) for found in sides.values() if len(found) == 2]
    return tuple(dict.fromkeys(pairs))


def numbered(names: Sequence[str]) -> list[str]:
    """Return the names, numbered from the second of the same name on.

    Of names that no person gave, the first `LONGEST` letters stay: arrays of names take for each
    the room of the longest.

    Examples
    --------
    >>> numbered(["head", "hand", "hand"])
    ['head', 'hand', 'hand_2']

    """
    taken: dict[str, int] = {}
    unlike: list[str] = []
    for whole in names:
        new = name = whole[:LONGEST]
        while new in taken:
            taken[name] += 1
            new = f"{name}_{taken[name]}"
        taken[new] = 1
        unlike.append(new)
    return unlike


def repeated(names: Sequence[str]) -> list[str]:
    """Return the names that come more than once.

    Examples
    --------
    >>> repeated(["head", "hand", "hand"])
    ['hand']

    """
    return [name[:LONGEST] for name, count in Counter(names).items() if count > 1]


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


def _without_common_start(names: Sequence[str]) -> list[str]:
    """Return the names without the subject or character that stands before most of them."""
    sides = {"l", "r", *SIDES}
    names = [re.split(r"[:|]", name)[-1].strip()[-LONGEST:] for name in names]
    for _ in range(MOST_STARTS):
        hits = (re.match(r"[^ _.-]+[ _.-]+(?=.)", name) for name in names)
        start, count = next(iter(Counter(hit[0] for hit in hits if hit).most_common(1)), ("", 0))
        if count < COMMON * len(names) or start.rstrip(" _.-").lower() in sides or not start:
            break
        names = [name.removeprefix(start) for name in names]
    return names
