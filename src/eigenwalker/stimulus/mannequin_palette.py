"""Mannequins in the shades of a film: 256 of them, for what is bright and what covers little."""

from __future__ import annotations

import numpy as np

from eigenwalker.plotting.encoding import rgb, shades_between
from eigenwalker.stimulus.solids import Lit

VARNISH = 0.1
"""How much of white light a mannequin's surface throws back, whatever its colour."""
DOTS, EDGES, BRIGHT, FULL = 15, 4, 24, 144
"""Shades of dots' edges; of a mannequin's edges, and how bright; of what it covers wholly."""
FIRST_EDGE = 1 + DOTS
FIRST_FULL = FIRST_EDGE + EDGES * BRIGHT


def lit_colour(ink: str) -> np.ndarray:
    """Return red, green and blue, 0 to 255, of a mannequin of this colour in full light."""
    return np.array(rgb(ink)) + VARNISH * (255 - np.array(rgb(ink)))


def wood_shades(ground: str, ink: str) -> np.ndarray:
    """Return the shades of a picture with mannequins: array of shape (256, 3), red, green, blue.

    The ground; dots that cover it more and more; edges, four covers in 24 steps of light; what is
    covered wholly, in 144 steps of light.
    """
    dark = np.array(rgb(ground), dtype=float)
    dots = shades_between(ground, ink)[np.rint(np.linspace(0, 255, DOTS + 1)).astype(int)]
    few = np.linspace(0, 1, BRIGHT)[:, None] * lit_colour(ink)
    edges = [dark + share * (few - dark) for share in np.arange(1, EDGES + 1) / (EDGES + 1)]
    return np.concatenate([dots, *edges, np.linspace(0, 1, FULL)[:, None] * lit_colour(ink)])


def put_wood(canvas: np.ndarray, lit: Lit) -> None:
    """Put mannequins on a canvas of dots' covers, which gets the numbers of shades, in place.

    Parameters
    ----------
    canvas : array of uint8 of shape (row, column)
        How much each pixel is covered with dots, 0 to 255; dots are before mannequins.
    lit : Lit
        The mannequins.

    """
    before = canvas[lit.box] > 127
    if canvas.any():
        canvas[:] = np.rint(canvas * np.float32(DOTS / 255))
    light = np.clip(lit.light / np.maximum(lit.cover, 1e-6), 0, 1)
    share = np.rint(lit.cover * (EDGES + 1)).astype(np.int16)
    edge = FIRST_EDGE + (share - 1) * BRIGHT + np.rint(light * (BRIGHT - 1)).astype(np.int16)
    full = FIRST_FULL + np.rint(light * (FULL - 1)).astype(np.int16)
    wood = np.where(before, DOTS, np.where(share > EDGES, full, edge))
    np.copyto(canvas[lit.box], wood.astype(np.uint8), where=share > 0)
