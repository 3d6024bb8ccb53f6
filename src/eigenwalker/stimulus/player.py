"""Playing a stimulus: where every dot is at any moment, in the scene and in the picture."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from eigenwalker.core.skeleton import Skeleton
from eigenwalker.plotting.projection import observer_axes
from eigenwalker.stimulus.moving_dots import Moments, Moving, sampled, walking
from eigenwalker.stimulus.transform_context import Stage
from eigenwalker.stimulus.transforms import TRANSFORMS

NEAREST_MM = 1.0
"""Nearer to the eye than this a dot of a perspective picture is not seen."""


class Played(NamedTuple):
    """All dots of a stimulus at several moments.

    Parameters
    ----------
    time : array of shape (time,)
        Seconds from the start of the stimulus.
    dots : tuple of str
        Names of the dots; in one scene several figures may have dots of one name.
    figures : array of int of shape (dot,)
        Number of the figure each dot belongs to; noise masks count on from the last figure.
    positions : array of shape (time, dot, 3)
        Millimetres in the scene, NaN where not known.
    visible : array of bool of shape (time, dot)
    picture : array of shape (time, dot, 2)
        Millimetres to the right of and above the middle of the picture, at the walker's scale.

    """

    time: np.ndarray
    dots: tuple[str, ...]
    figures: np.ndarray
    positions: np.ndarray
    visible: np.ndarray
    picture: np.ndarray


def scene(content: Mapping[str, Any]) -> list[Moving]:
    """Return the figures of a stimulus, transformed and set in the scene, then its masks.

    The chain acts on each figure in the figure's own frame; then the figure is turned by its
    heading and moved to its position. A mask is made from its figure as it is at that place of the
    chain, in the scene, and no later transform changes it.

    Parameters
    ----------
    content : mapping
        As `content.checked` returns it.

    """
    figures = [figure_of(figure) for figure in content["figures"]]
    masks: list[Moving] = []
    for step in content["transforms"]:
        transform = TRANSFORMS[step["name"]]
        parameters = {k: v for k, v in step.items() if k not in ("name", "figures")}
        chosen = range(len(figures)) if step["figures"] is None else step["figures"]
        for number in chosen:
            place = content["figures"][number]
            if step["name"] == "morph":
                parameters["walker"] = _walker(step["walker"], figures[number].skeleton)
            if transform.adds:
                source = _placed(figures[number], place)
                stage = Stage(_observer(content, 0.0), number)
                masks.append(transform.function(source, stage, **parameters))
            else:
                stage = Stage(_observer(content, place["heading_deg"]), number)
                figures[number] = transform.function(figures[number], stage, **parameters)
    placed = [_placed(f, p) for f, p in zip(figures, content["figures"], strict=True)]
    return placed + masks


def play(content: Mapping[str, Any], time: np.ndarray) -> Played:
    """Return all dots of a stimulus at the given seconds."""
    shown = scene(content)
    moments = [moving.at(time) for moving in shown]
    positions = np.concatenate([moment.positions for moment in moments], axis=1)
    visible = np.concatenate([moment.visible for moment in moments], axis=1)
    picture, seen = in_picture(positions, content["view"])
    return Played(
        time,
        tuple(dot for moving in shown for dot in moving.dots),
        np.repeat(np.arange(len(shown)), [len(moving.dots) for moving in shown]),
        positions,
        visible & seen,
        picture,
    )


def in_picture(positions: np.ndarray, view: Mapping[str, Any]) -> tuple[np.ndarray, np.ndarray]:
    """Return where dots are in the picture, and whether they are in front of the eye.

    As `project`, measured from the centre of the view. In perspective, things as far from the eye
    as the centre keep their size.

    Parameters
    ----------
    positions : array of shape (..., 3)
        Millimetres in the scene.
    view : mapping
        The part ``view`` of a stimulus.

    Returns
    -------
    picture : array of shape (..., 2)
        Millimetres to the right of and above the centre.
    seen : array of bool of shape (...)

    """
    axes = observer_axes(view["view_deg"], view["elevation_deg"])
    seen = (positions - np.array(view["centre_mm"])) @ axes.T
    known = np.asarray(~np.isnan(seen).any(axis=-1))
    if view["eye_distance_mm"] is None:
        return seen[..., :2], known
    away = view["eye_distance_mm"] - seen[..., 2]
    before = known & (away >= NEAREST_MM)
    scale = np.where(before, view["eye_distance_mm"] / np.where(before, away, 1.0), np.nan)
    return seen[..., :2] * scale[..., None], before


def _observer(content: Mapping[str, Any], heading_deg: float) -> np.ndarray:
    """The observer's axes in the frame of a figure that is turned to its left by a heading."""
    view = content["view"]
    return observer_axes(view["view_deg"] + heading_deg, view["elevation_deg"])


def figure_of(figure: Mapping[str, Any]) -> Moving:
    """Return a figure of a stimulus as it stands in the file, in its own frame."""
    given = figure["walker"] or figure["trajectories"]
    skeleton = Skeleton(
        tuple(given["markers"]),
        tuple(tuple(link) for link in figure["segments"]),
        tuple(tuple(pair) for pair in figure["pairs"]),
    )
    if figure["walker"] is not None:
        return _walker(given, skeleton)
    return sampled(skeleton, given["samples"], given["rate_hz"], repeat=given["repeat"])


def _walker(walker: Mapping[str, Any], skeleton: Skeleton) -> Moving:
    n_markers = len(walker["markers"])
    if tuple(walker["markers"]) != skeleton.markers:
        skeleton = Skeleton(tuple(walker["markers"]))
    return walking(
        skeleton,
        np.array(walker["p0"], dtype=float),
        np.array(walker["p"], dtype=float).reshape(-1, n_markers, 3),
        np.array(walker["harmonics"], dtype=float),
        np.array(walker["phases"], dtype=float),
        walker["frequency_hz"],
    )


def _placed(moving: Moving, figure: Mapping[str, Any]) -> Moving:
    """A figure turned by its heading and moved to its place in the scene."""
    offset = np.array(figure["position_mm"], dtype=float)
    heading = np.deg2rad(figure["heading_deg"])
    if not offset.any() and heading == 0:
        return moving
    cosine, sine = np.cos(heading), np.sin(heading)
    turn = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])

    def at(time: np.ndarray) -> Moments:
        positions, visible = moving.at(time)
        return Moments(positions @ turn.T + offset, visible)

    return replace(moving, at=at)
