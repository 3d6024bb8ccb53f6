"""Frames of a stimulus as pixels: discs, sticks, blobs or mannequins."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping

import numpy as np

from eigenwalker.core.skeleton import Skeleton
from eigenwalker.plotting.encoding import rgb, shades_between
from eigenwalker.plotting.raster import draw_discs, draw_lines
from eigenwalker.stimulus.mannequin import Hulls, Mannequin, body_heights, hulls_at, mannequin_of
from eigenwalker.stimulus.player import Played
from eigenwalker.stimulus.solids import Lit, Look, draw_hulls
from eigenwalker.stimulus.stimulus import Stimulus

STICK_PER_DOT = 0.6
"""Width of a stick beside the diameter of a dot."""
BLOB_REACH_SD = 3.6
"""Standard deviations beyond which a blob gives less light than an 8-bit pixel shows."""

SPECULAR = 0.1
"""Share of white light that a mannequin's surface reflects, whatever its colour."""
DOTS, EDGES, BRIGHT, FULL = 15, 4, 24, 144
"""Shades of dots' edges; of a mannequin's edges, and how bright; of what it covers wholly."""
FIRST_EDGE = 1 + DOTS
FIRST_FULL = FIRST_EDGE + EDGES * BRIGHT


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
    played = stimulus.play(time)
    places = places_px(stimulus, played) - 0.5  # pixels are counted from their centres
    places[~played.visible] = np.nan
    figures = stimulus.scene
    shape = shape or (stimulus.display.height_px, stimulus.display.width_px)
    canvas = np.zeros(shape, np.uint8)
    ends = np.cumsum([0, *(len(figure.dots) for figure in figures)])
    groups = [slice(a, b) for a, b in itertools.pairwise(ends)]
    bodies = mannequins(stimulus)
    for moment, places_now in enumerate(places):
        canvas.fill(0)
        for number, (figure, dots) in enumerate(zip(figures, groups, strict=True)):
            if number in bodies:
                continue
            if figure.blur_mm > 0:
                _draw_blobs(canvas, places_now[dots], figure.blur_mm * stimulus.display.px_per_mm)
                continue
            if stimulus.display.style == "sticks" and figure.skeleton.segments:
                _draw_sticks(canvas, places_now[dots], figure.skeleton, stimulus.display.dot_px)
            draw_discs(canvas, places_now[dots], radius=stimulus.display.dot_px / 2)
        if bodies:
            hulls = hulls_of(stimulus, bodies, played, moment)
            composite_mannequin(canvas, draw_hulls(hulls, look_of(stimulus, shape)))
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
        if figure.skeleton.segments and figure.blur_mm == 0
    }


def hulls_of(
    stimulus: Stimulus, bodies: Mapping[int, Mannequin], played: Played, moment: int
) -> Hulls:
    """Return the pieces of all mannequins at one of the moments played."""
    hulls = []
    for number, body in bodies.items():
        mine = played.figures == number
        places, visible = played.positions[moment, mine], played.visible[moment, mine]
        hulls.append(hulls_at(body, places, visible, stimulus.view))
    return Hulls(*(np.concatenate(parts) for parts in zip(*hulls, strict=True)))


def look_of(stimulus: Stimulus, shape: tuple[int, int]) -> Look:
    """Return how hulls of a stimulus are seen in a picture of these rows and columns."""
    display = stimulus.display
    middle = ((display.width_px - 1) / 2, (display.height_px - 1) / 2)
    return Look(shape, display.px_per_mm, middle, stimulus.view.eye_distance_mm)


def _draw_sticks(canvas: np.ndarray, places: np.ndarray, skeleton: Skeleton, dot_px: float) -> None:
    pairs = [(skeleton.index(one), skeleton.index(other)) for one, other in skeleton.segments]
    start, end = np.transpose(pairs)
    draw_lines(canvas, places[start], places[end], width=max(STICK_PER_DOT * dot_px, 1.0))


def _draw_blobs(canvas: np.ndarray, places: np.ndarray, sd_px: float) -> None:
    """Add up the light of Gaussian blobs, 1 at most, and keep what is brighter than before."""
    light = np.zeros(canvas.shape, np.float32)
    rows, columns = (np.arange(size, dtype=np.float32) for size in canvas.shape)
    reach = BLOB_REACH_SD * sd_px
    for x, y in places[np.isfinite(places).all(axis=1)]:
        down, along = (
            slice(*np.clip([place - reach, place + reach + 1], 0, None).astype(int))
            for place in (y, x)
        )
        tall = np.exp(-((rows[down] - y) ** 2) / (2 * sd_px**2))
        wide = np.exp(-((columns[along] - x) ** 2) / (2 * sd_px**2))
        light[down, along] += tall[:, None] * wide
    np.maximum(canvas, np.rint(255 * np.minimum(light, 1)).astype(np.uint8), out=canvas)


def lit_colour(ink: str) -> np.ndarray:
    """Return red, green and blue, 0 to 255, of a mannequin of this colour in full light."""
    return np.array(rgb(ink)) + SPECULAR * (255 - np.array(rgb(ink)))


def mannequin_shades(ground: str, ink: str) -> np.ndarray:
    """Return the shades of a picture with mannequins: array of shape (256, 3), red, green, blue.

    The ground; dots that cover it more and more; edges, four covers in 24 steps of light; what is
    covered wholly, in 144 steps of light.
    """
    dark = np.array(rgb(ground), dtype=float)
    dots = shades_between(ground, ink)[np.rint(np.linspace(0, 255, DOTS + 1)).astype(int)]
    few = np.linspace(0, 1, BRIGHT)[:, None] * lit_colour(ink)
    edges = [dark + share * (few - dark) for share in np.arange(1, EDGES + 1) / (EDGES + 1)]
    return np.concatenate([dots, *edges, np.linspace(0, 1, FULL)[:, None] * lit_colour(ink)])


def composite_mannequin(canvas: np.ndarray, lit: Lit) -> None:
    """Put mannequins on a canvas of dots' covers, which gets the numbers of shades, in place."""
    before = canvas[lit.box] > 127
    if canvas.any():
        canvas[:] = np.rint(canvas * np.float32(DOTS / 255))
    light = np.clip(lit.light / np.maximum(lit.cover, 1e-6), 0, 1)
    share = np.rint(lit.cover * (EDGES + 1)).astype(np.int16)
    edge = FIRST_EDGE + (share - 1) * BRIGHT + np.rint(light * (BRIGHT - 1)).astype(np.int16)
    full = FIRST_FULL + np.rint(light * (FULL - 1)).astype(np.int16)
    shades = np.where(before, DOTS, np.where(share > EDGES, full, edge))
    np.copyto(canvas[lit.box], shades.astype(np.uint8), where=share > 0)
