"""Playing a stimulus: where every dot is at any moment, in the scene and in the picture."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from eigenwalker.plotting.projection import observer_axes
from eigenwalker.stimulus.figure import Figure
from eigenwalker.stimulus.moving_dots import MovingDots
from eigenwalker.stimulus.schema import View
from eigenwalker.stimulus.transform_types import Context, Transform

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
    seen : array of shape (time, dot, 3)
        Millimetres from the centre of the view to the observer's right, up, and towards the
        observer.
    picture : array of shape (time, dot, 2)
        Millimetres to the right of and above the middle of the picture, at the walker's scale.

    See Also
    --------
    eigenwalker.Stimulus.play : Makes it.
    """

    time: np.ndarray
    dots: tuple[str, ...]
    figures: np.ndarray
    positions: np.ndarray
    visible: np.ndarray
    seen: np.ndarray
    picture: np.ndarray


def scene(
    figures: Sequence[Figure], transforms: Sequence[Transform], view: View
) -> tuple[MovingDots, ...]:
    """Return the figures of a stimulus, transformed and set in the scene, then its masks.

    The chain acts on each figure in the figure's own frame; then the figure is turned by its
    heading and moved to its position. A mask is made from its figure as it is at that place of the
    chain, in the scene, and no later transform changes it.
    """
    moving = [figure.moving_dots() for figure in figures]
    masks = []
    for step in transforms:
        for number in range(len(moving)) if step.figures is None else step.figures:
            figure = figures[number]
            if step.adds_dots:
                context = Context(view.axes, number)
                masks.append(step.apply(_placed(moving[number], figure), context))
            else:
                observer = observer_axes(view.view_deg + figure.heading_deg, view.elevation_deg)
                context = Context(observer, number)
                moving[number] = step.apply(moving[number], context)
    return (*map(_placed, moving, figures), *masks)


def play(shown: Sequence[MovingDots], view: View, time: np.ndarray) -> Played:
    """Return all dots of a scene at the given seconds."""
    moments = [moving.at(time) for moving in shown]
    positions = np.concatenate([moment.positions for moment in moments], axis=1)
    visible = np.concatenate([moment.visible for moment in moments], axis=1)
    seen = (positions - np.array(view.centre_mm)) @ view.axes.T
    picture, in_front = in_picture(seen, view.eye_distance_mm)
    return Played(
        time,
        tuple(dot for moving in shown for dot in moving.dots),
        np.repeat(np.arange(len(shown)), [len(moving.dots) for moving in shown]),
        positions,
        visible & in_front,
        seen,
        picture,
    )


def in_picture(seen: np.ndarray, eye_distance_mm: float | None) -> tuple[np.ndarray, np.ndarray]:
    """Return where dots (..., 3) in the observer's axes are in the picture, and which are in front.

    In the picture (..., 2): mm to the right of and above the centre of the view. In perspective,
    things as far from the eye as the centre keep their size; what is behind the eye is NaN.
    """
    known = np.asarray(~np.isnan(seen).any(axis=-1))
    if eye_distance_mm is None:
        return seen[..., :2], known
    away = eye_distance_mm - seen[..., 2]
    in_front = known & (away >= NEAREST_MM)
    scale = np.where(in_front, eye_distance_mm / np.where(in_front, away, 1.0), np.nan)
    return seen[..., :2] * scale[..., None], in_front


def _placed(moving: MovingDots, figure: Figure) -> MovingDots:
    """A figure turned by its heading and moved to its place in the scene."""
    offset = np.array(figure.position_mm, dtype=float)
    heading = np.deg2rad(figure.heading_deg)
    if not offset.any() and heading == 0:
        return moving
    cosine, sine = np.cos(heading), np.sin(heading)
    turn = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    return moving.moved(lambda positions, time: positions @ turn.T + offset)
