"""The mannequin's body: pieces that move with the dots, each the hull of two balls.

``mannequin.json``, which the browser reads too, has their places as weighted means of dots and
their girth in shares of body height.
"""

from __future__ import annotations

import functools
import json
from collections.abc import Iterator, Mapping
from importlib.resources import files
from typing import Any, NamedTuple

import numpy as np

from eigenwalker.core.skeleton import Skeleton
from eigenwalker.stimulus.player import NEAREST_MM
from eigenwalker.stimulus.stimulus import Stimulus

UNSIDED = ("head", "sternum", "pelvis")


class Mannequin(NamedTuple):
    """The pieces of one figure.

    `weights` (piece, 2, dot) of each dot in the centres of a piece's two balls, their radii (piece,
    2), and `tones` (piece,): 1, or less for joints, which are darker.
    """

    weights: np.ndarray
    radii_mm: np.ndarray
    tones: np.ndarray


class Hulls(NamedTuple):
    """Pieces at one moment in the observer's axes (right, up, towards the observer), in mm.

    Centres (piece, 2, 3) of the two balls of each, from the centre of the view; radii (piece, 2).
    """

    middles: np.ndarray
    radii: np.ndarray
    tones: np.ndarray


@functools.cache
def _shape() -> dict[str, Any]:
    text = files("eigenwalker.stimulus").joinpath("mannequin.json").read_text(encoding="utf-8")
    return json.loads(text)


def body_heights(stimulus: Stimulus) -> list[float]:
    """Return the body height of each figure in mm, which sets its mannequin's thickness.

    1.15 times the largest extent of the mean posture on an axis, which for a standing figure is
    from the head's middle to the ankles, before all transforms; times the factors of ``resize``.
    """
    heights = []
    for number, figure in enumerate(stimulus.figures):
        mean = figure.moving_dots().mean
        height = _shape()["body_height"] * float((np.nanmax(mean, 0) - np.nanmin(mean, 0)).max())
        for step in stimulus.transforms:
            if step["name"] == "resize" and number in (step["figures"] or [number]):
                height *= step["factor"]
        heights.append(height)
    return heights


def mannequin_of(skeleton: Skeleton, height_mm: float) -> Mannequin:
    """Return the pieces of a figure: those whose dots it has, and a rod for other segments."""
    known = set(skeleton.markers)
    pieces = [
        piece
        for piece in _sided_pieces()
        if {*piece["from"], *piece["to"]} <= known and piece.get("unless") not in known
    ]
    named = [{*piece["from"], *piece["to"]} for piece in pieces]
    for one, other in skeleton.segments:
        if not any({one, other} <= dots for dots in named):
            radius = _shape()["other_radius"]
            pieces.append({"from": {one: 1}, "to": {other: 1}, "radii": [radius, radius]})
    weights = np.zeros((len(pieces), 2, len(skeleton.markers)))
    for number, piece in enumerate(pieces):
        for end, ball in enumerate((piece["from"], piece["to"])):
            for dot, weight in ball.items():
                weights[number, end, skeleton.index(dot)] = weight
    radii = np.array([[piece["radii"][0], piece["radii"][-1]] for piece in pieces]).reshape(-1, 2)
    return Mannequin(weights, height_mm * radii, np.array([p.get("tone", 1.0) for p in pieces]))


def _sided_pieces() -> Iterator[dict[str, Any]]:
    """All pieces; those that name joints without a side stand for one of each side."""
    for piece in _shape()["pieces"]:
        whole = {"to": piece["from"], **piece}
        left, right = (_of_side(whole, side) for side in ("left_", "right_"))
        yield left
        if right != left:
            yield right


def _of_side(piece: Mapping[str, Any], side: str) -> dict[str, Any]:
    def sided(dot: str) -> str:
        return dot if dot in UNSIDED or dot.startswith(("left_", "right_")) else side + dot

    ends = {end: {sided(d): w for d, w in piece[end].items()} for end in ("from", "to")}
    unless = {"unless": side + piece["unless"]} if "unless" in piece else {}
    return {**piece, **ends, **unless}


def hulls_at(
    mannequin: Mannequin, seen: np.ndarray, visible: np.ndarray, eye_distance_mm: float | None
) -> Hulls:
    """Return the pieces of a figure at one moment that are to be seen.

    Of dots (dot, 3) in the observer's axes, mm from the centre of the view. A piece of which a dot
    is not visible is left out, and one that reaches the observer's eye.
    """
    middles = mannequin.weights @ np.where(visible[:, None], seen, 0.0)
    whole = ~((mannequin.weights != 0) & ~visible).any(axis=(1, 2))
    if eye_distance_mm is not None:
        nearest = eye_distance_mm - NEAREST_MM
        whole &= (middles[..., 2] + mannequin.radii_mm <= nearest).all(axis=1)
    return Hulls(middles[whole], mannequin.radii_mm[whole], mannequin.tones[whole])
