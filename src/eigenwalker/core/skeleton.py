"""The markers of a body: their names, segments, left-right pairs and groups."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from importlib.resources import files

Segment = tuple[str, str]

LIMBS = {
    "upper arms": ("shoulder", "elbow"),
    "forearms": ("elbow", "wrist"),
    "thighs": ("hip", "knee"),
    "shanks": ("knee", "ankle"),
}
"""The segments that are single bones, by the joints of one side."""


@dataclass(frozen=True)
class Skeleton:
    """The markers of a body and how they belong together.

    Parameters
    ----------
    markers : tuple of str
        Marker names, in the order in which arrays hold them.
    segments : tuple of pairs of str
        Markers joined by a link of the stick figure.
    pairs : tuple of pairs of str
        Left markers with their right counterparts.
    groups : mapping of str to tuple of str
        Parts of the body, such as ``"arms"``.

    Raises
    ------
    ValueError
        If a name comes twice, or a segment, pair or group names no marker.

    See Also
    --------
    JOINTS : That of walkers.

    Examples
    --------
    >>> leg = Skeleton(("hip", "knee", "ankle"), (("hip", "knee"), ("knee", "ankle")))
    >>> leg.index("ankle")
    2
    """

    markers: tuple[str, ...]
    segments: tuple[Segment, ...] = ()
    pairs: tuple[Segment, ...] = ()
    groups: Mapping[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])

    def __post_init__(self) -> None:
        known = set(self.markers)
        if len(known) < len(self.markers):
            raise ValueError(f"Marker names must differ from each other; got {self.markers}.")
        named = [name for link in (*self.segments, *self.pairs) for name in link]
        named += [name for members in self.groups.values() for name in members]
        if unknown := sorted(set(named) - known):
            raise ValueError(f"The skeleton joins {unknown}, which are not among its markers.")

    def index(self, marker: str) -> int:
        """Return the place of a marker in arrays."""
        return self.markers.index(marker)

    def mirror(self) -> tuple[int, ...]:
        """Return, for each marker, the place of its left-right counterpart.

        Examples
        --------
        >>> Skeleton(("nose", "left_eye", "right_eye"), pairs=(("left_eye", "right_eye"),)).mirror()
        (0, 2, 1)
        """
        partner = dict(self.pairs) | {right: left for left, right in self.pairs}
        return tuple(self.index(partner.get(name, name)) for name in self.markers)

    @property
    def segment_ends(self) -> list[tuple[int, int]]:
        """Numbers of the markers at both ends of each segment."""
        return [(self.index(one), self.index(other)) for one, other in self.segments]

    def restricted_to(self, markers: Iterable[str]) -> Skeleton:
        """Return the part of the skeleton that these markers span, in their order.

        Markers that the skeleton does not know stay, joined to nothing.

        Examples
        --------
        >>> JOINTS.restricted_to(["left_knee", "left_ankle", "toe"]).segments
        (('left_knee', 'left_ankle'),)
        """
        names = tuple(markers)

        def among(links: tuple[Segment, ...]) -> tuple[Segment, ...]:
            return tuple(link for link in links if set(link) <= set(names))

        groups = {
            name: tuple(m for m in members if m in names) for name, members in self.groups.items()
        }
        return Skeleton(names, among(self.segments), among(self.pairs), groups)


_TOML = files("eigenwalker.core").joinpath("skeleton.toml").read_text(encoding="utf-8")
_TABLES = tomllib.loads(_TOML)


def _skeleton(*names: str) -> Skeleton:
    """Return the skeleton of some tables of ``skeleton.toml`` together."""
    tables = [_TABLES[name] for name in names]
    segments, pairs = (
        tuple((one, other) for table in tables for one, other in table[part])
        for part in ("segments", "pairs")
    )
    groups = {name: tuple(members) for name, members in tables[-1].get("groups", {}).items()}
    return Skeleton(tuple(n for table in tables for n in table["markers"]), segments, pairs, groups)


JOINTS = _skeleton("joints")
"""The 15 joints of Troje (2002, fig. 1), in the order of this package."""

LINKS = _skeleton("joints", "feet_and_hands")
"""What pictures join: the 15 joints, and feet and hands where they are known.

Restrict it to the markers at hand: ``LINKS.restricted_to(walker.markers)``.
"""
