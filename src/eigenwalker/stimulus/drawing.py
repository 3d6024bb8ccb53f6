"""Frames of a stimulus as pixels: discs, sticks or blobs."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from eigenwalker.display.raster import draw_discs, draw_lines
from eigenwalker.skeleton import Skeleton
from eigenwalker.stimulus.playing import Played, scene

if TYPE_CHECKING:
    from eigenwalker.stimulus.stimulus import Stimulus

STICK = 0.6
"""Width of a stick beside the diameter of a dot."""
LOST_SD = 3.6
"""Standard deviations beyond which a blob gives less light than an 8-bit pixel shows."""


def places_px(stimulus: Stimulus, played: Played) -> np.ndarray:
    """Return where dots are in the picture, in pixels from its left and its upper edge.

    Returns
    -------
    array of shape (time, dot, 2)

    """
    display = stimulus.display
    middle = np.array([display.width_px, display.height_px]) / 2
    return middle + display.px_per_mm * played.picture * [1, -1]


def drawn_frames(
    stimulus: Stimulus, time: np.ndarray, *, shape: tuple[int, int] | None = None
) -> Iterator[np.ndarray]:
    """Draw frame after frame.

    Parameters
    ----------
    stimulus : Stimulus
        What is shown.
    time : array of shape (time,)
        Seconds.
    shape : tuple of int, optional
        Rows and columns; left out, those of the stimulus. What is beyond its picture is ground.

    Yields
    ------
    array of uint8 of shape (row, column)
        How much each pixel is covered; overwritten by the next frame.

    """
    if stimulus.display.style == "mannequin":
        raise ValueError(
            "The mannequin is drawn in the browser; for a film choose the style 'dots' or 'sticks'."
        )
    played = stimulus.play(time)
    places = places_px(stimulus, played) - 0.5  # pixels are counted from their centres
    places[~played.visible] = np.nan
    figures = scene(stimulus.content)
    shape = shape or (stimulus.display.height_px, stimulus.display.width_px)
    canvas = np.zeros(shape, np.uint8)
    ends = np.cumsum([0, *(len(figure.dots) for figure in figures)])
    groups = [slice(a, b) for a, b in itertools.pairwise(ends)]
    for places_now in places:
        canvas.fill(0)
        for figure, dots in zip(figures, groups, strict=True):
            if figure.blur_mm > 0:
                _draw_blobs(canvas, places_now[dots], figure.blur_mm * stimulus.display.px_per_mm)
                continue
            if stimulus.display.style == "sticks" and figure.skeleton.segments:
                _draw_sticks(canvas, places_now[dots], figure.skeleton, stimulus.display.dot_px)
            draw_discs(canvas, places_now[dots], radius=stimulus.display.dot_px / 2)
        yield canvas


def _draw_sticks(canvas: np.ndarray, places: np.ndarray, skeleton: Skeleton, dot_px: float) -> None:
    pairs = [(skeleton.index(one), skeleton.index(other)) for one, other in skeleton.segments]
    start, end = np.transpose(pairs)
    draw_lines(canvas, places[start], places[end], width=max(STICK * dot_px, 1.0))


def _draw_blobs(canvas: np.ndarray, places: np.ndarray, sd_px: float) -> None:
    """Add up the light of Gaussian blobs, 1 at most, and keep what is brighter than before."""
    light = np.zeros(canvas.shape, np.float32)
    rows, columns = (np.arange(size, dtype=np.float32) for size in canvas.shape)
    for x, y in places[np.isfinite(places).all(axis=1)]:
        down = slice(*np.clip([y - LOST_SD * sd_px, y + LOST_SD * sd_px + 1], 0, None).astype(int))
        along = slice(*np.clip([x - LOST_SD * sd_px, x + LOST_SD * sd_px + 1], 0, None).astype(int))
        tall = np.exp(-((rows[down] - y) ** 2) / (2 * sd_px**2))
        wide = np.exp(-((columns[along] - x) ** 2) / (2 * sd_px**2))
        light[down, along] += tall[:, None] * wide
    np.maximum(canvas, np.rint(255 * np.minimum(light, 1)).astype(np.uint8), out=canvas)
