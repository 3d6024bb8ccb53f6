"""Who is joined to whom in pictures: the 15 joints, and feet and hands where they are known."""

from eigenwalker.core.skeleton import JOINTS, Skeleton

_SIDES = ("left", "right")
_MORE = ("heel", "toe", "hand")

LINKS = Skeleton(
    markers=(*JOINTS.markers, *(f"{side}_{part}" for side in _SIDES for part in _MORE)),
    segments=(
        *JOINTS.segments,
        *((f"{side}_ankle", f"{side}_heel") for side in _SIDES),
        *((f"{side}_ankle", f"{side}_toe") for side in _SIDES),
        *((f"{side}_heel", f"{side}_toe") for side in _SIDES),
        *((f"{side}_wrist", f"{side}_hand") for side in _SIDES),
    ),
    pairs=(*JOINTS.pairs, *((f"left_{part}", f"right_{part}") for part in _MORE)),
)
"""Restrict it to the markers at hand: ``LINKS.restricted_to(walker.markers)``."""
