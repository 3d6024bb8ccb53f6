"""Shades: the colours of a film's 256 pixel values, for dots and for mannequins."""

from __future__ import annotations

import numpy as np

SPECULAR = 0.1
"""Share of white light that a mannequin's surface reflects, whatever its colour."""
DOTS, EDGES, BRIGHT, FULL = 15, 4, 24, 144
"""Shades of dots' edges; of a mannequin's edges, and how bright; of what it covers wholly."""
FIRST_EDGE = 1 + DOTS
FIRST_FULL = FIRST_EDGE + EDGES * BRIGHT


def shades_between(ground: str, ink: str) -> np.ndarray:
    """Return red, green and blue, 0 to 255, from one colour to another: array of shape (256, 3)."""
    start, end = (np.array(rgb(colour)) for colour in (ground, ink))
    return start + np.linspace(0, 1, 256)[:, None] * (end - start)


def rgb(colour: str) -> tuple[int, int, int]:
    """Return red, green and blue, 0 to 255, of a colour such as ``"#ff8000"``."""
    red, green, blue = (int(colour[i : i + 2], 16) for i in (1, 3, 5))
    return red, green, blue


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


def composite_mannequin(
    canvas: np.ndarray, box: tuple[slice, slice], cover: np.ndarray, light: np.ndarray
) -> None:
    """Put mannequins on a canvas of dots' covers, which gets the numbers of shades, in place.

    In a box of the canvas: the share of each pixel that is covered, and its light times that share.
    """
    before = canvas[box] > 127
    if canvas.any():
        canvas[:] = np.rint(canvas * np.float32(DOTS / 255))
    light = np.clip(light / np.maximum(cover, 1e-6), 0, 1)
    share = np.rint(cover * (EDGES + 1)).astype(np.int16)
    edge = FIRST_EDGE + (share - 1) * BRIGHT + np.rint(light * (BRIGHT - 1)).astype(np.int16)
    full = FIRST_FULL + np.rint(light * (FULL - 1)).astype(np.int16)
    shades = np.where(before, DOTS, np.where(share > EDGES, full, edge))
    np.copyto(canvas[box], shades.astype(np.uint8), where=share > 0)
