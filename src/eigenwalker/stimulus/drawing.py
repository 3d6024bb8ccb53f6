"""Frames of a stimulus as pixels: discs, sticks, blobs or mannequins."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from eigenwalker.plotting.raster import draw_blobs, draw_discs, draw_lines
from eigenwalker.plotting.shades import composite_mannequin, mannequin_shades, shades_between
from eigenwalker.stimulus.mannequin import Hulls, Mannequin, body_heights, hulls_at, mannequin_of
from eigenwalker.stimulus.player import Played
from eigenwalker.stimulus.solids import Look, draw_hulls
from eigenwalker.stimulus.stimulus import Stimulus

STICK_PER_DOT = 0.6
"""Width of a stick, as a share of the diameter of a dot."""


def places_px(stimulus: Stimulus, played: Played) -> np.ndarray:
    """Return where dots are, pixels from the left and upper edge: array of shape (time, dot, 2)."""
    display = stimulus.display
    middle = np.array([display.width_px, display.height_px]) / 2
    return middle + display.px_per_mm * played.picture * [1, -1]


def drawn_frames(
    stimulus: Stimulus, time: np.ndarray, *, shape: tuple[int, int] | None = None
) -> Iterator[np.ndarray]:
    """Draw frame after frame: arrays of uint8 (row, column), overwritten by the next frame.

    A pixel's number is that of its shade (`drawn_shades`), which for dots and sticks is how much of
    it is covered. Beyond the picture of the stimulus, `shape` is filled with ground.
    """
    display = stimulus.display
    shape = shape or (display.height_px, display.width_px)
    played = stimulus.play(time)
    places = places_px(stimulus, played) - 0.5  # pixels are counted from their centres
    places[~played.visible] = np.nan
    bodies = mannequins(stimulus)
    look = look_of(stimulus, shape)
    canvas = np.zeros(shape, np.uint8)
    for moment, places_now in enumerate(places):
        lit = draw_hulls(hulls_of(stimulus, bodies, played, moment), look) if bodies else None
        canvas.fill(0)
        for number, figure in enumerate(stimulus.scene):
            dots = places_now[played.figures == number]
            if number in bodies:
                continue
            if (sd_px := figure.blob_px(display.px_per_mm)) > 0:
                draw_blobs(canvas, dots, sd_px=sd_px)
                continue
            if display.style == "sticks" and figure.skeleton.segments:
                start, end = np.transpose(figure.skeleton.segment_ends)
                width = max(STICK_PER_DOT * display.dot_px, 1.0)
                draw_lines(canvas, dots[start], dots[end], width=width)
            draw_discs(canvas, dots, radius=display.dot_px / 2)
        if lit is not None:
            composite_mannequin(canvas, *lit)
        yield canvas


def drawn_shades(stimulus: Stimulus) -> np.ndarray:
    """Return the colours of what `drawn_frames` yields: array of shape (256, 3), 0 to 255."""
    shades = mannequin_shades if mannequins(stimulus) else shades_between
    return shades(stimulus.display.background, stimulus.display.colour)


def mannequins(stimulus: Stimulus) -> dict[int, Mannequin]:
    """Return the mannequins among figures by number: masks, limb dots and blobs have no limbs."""
    if stimulus.display.style != "mannequin":
        return {}
    heights = body_heights(stimulus)
    return {
        number: mannequin_of(figure.skeleton, heights[number])
        for number, figure in enumerate(stimulus.scene)
        if figure.skeleton.segments and not figure.blob_px(1)
    }


def hulls_of(
    stimulus: Stimulus, bodies: Mapping[int, Mannequin], played: Played, moment: int
) -> Hulls:
    """Return the pieces of all mannequins at one of the moments played."""
    hulls = []
    for number, body in bodies.items():
        mine = played.figures == number
        seen, visible = played.seen[moment, mine], played.visible[moment, mine]
        hulls.append(hulls_at(body, seen, visible, stimulus.view.eye_distance_mm))
    return Hulls(*(np.concatenate(parts) for parts in zip(*hulls, strict=True)))


def look_of(stimulus: Stimulus, shape: tuple[int, int]) -> Look:
    """Return how hulls of a stimulus are seen in a picture of these rows and columns."""
    display = stimulus.display
    middle = ((display.width_px - 1) / 2, (display.height_px - 1) / 2)
    return Look(shape, display.px_per_mm, middle, stimulus.view.eye_distance_mm)
