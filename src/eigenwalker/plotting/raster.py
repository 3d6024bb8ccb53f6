"""Dots, lines and words as pixels, with soft edges and places between pixels.

A canvas is an array of uint8 (row, column) of how much each pixel is covered, 0 to 255. Places are
(column, row), counted in pixels from the centre of the pixel at the upper left. Levels are shares
of full cover.
"""

from __future__ import annotations

import math
import warnings

import numpy as np

MAX_PIXELS = 2_000_000
"""Pixels of discs computed at once."""
BLOB_REACH_SD = 3.6
"""Standard deviations beyond which a blob gives less light than an 8-bit pixel shows."""


def draw_discs(
    canvas: np.ndarray,
    centres: np.ndarray,
    *,
    radius: float | np.ndarray,
    level: float | np.ndarray = 1.0,
) -> None:
    """Put discs on a canvas, in place; where things overlap, the fuller cover stays.

    Centres (disc, 2) are columns and rows, NaN for none; radius in pixels and level, the share of
    cover within, are one for all or one a disc.
    """
    centres = np.asarray(centres, dtype=np.float32)
    seen = np.isfinite(centres).all(axis=1)
    if not seen.any():
        return
    radii = np.broadcast_to(np.float32(radius), len(centres))[seen]
    levels = np.broadcast_to(np.float32(level), len(centres))[seen]
    some = max(MAX_PIXELS // (2 * math.ceil(radii.max()) + 3) ** 2, 1)
    for first in range(0, len(radii), some):
        few = slice(first, first + some)
        _draw_few_discs(canvas, centres[seen][few], radii[few], levels[few])


def _draw_few_discs(
    canvas: np.ndarray, centres: np.ndarray, radii: np.ndarray, levels: np.ndarray
) -> None:
    places = np.rint(centres)
    reach = math.ceil(radii.max() + 0.5)
    steps = np.arange(-reach, reach + 1, dtype=np.float32)
    away2 = ((places - centres)[..., None] + steps) ** 2  # (disc, axis, step)
    apart = np.sqrt(away2[:, 1, :, None] + away2[:, 0, None, :])
    inside = np.clip((radii + np.float32(0.5))[:, None, None] - apart, 0, 1)
    patches = np.rint(255 * levels[:, None, None] * inside).astype(np.uint8)
    for (column, row), patch in zip(places.astype(int).tolist(), patches, strict=True):
        _cover(canvas, row - reach, column - reach, patch)


def draw_lines(
    canvas: np.ndarray,
    starts: np.ndarray,
    ends: np.ndarray,
    *,
    width: float,
    level: float | np.ndarray = 1.0,
) -> None:
    """Put straight lines with round ends on a canvas, in place, as `draw_discs` does.

    Starts and ends have shape (line, 2); a line with an end at NaN is left out.
    """
    levels = np.broadcast_to(np.float32(level), len(starts))
    reach = math.ceil(width / 2 + 0.5)
    for start, end, full in zip(starts, ends, levels, strict=True):
        if not (np.isfinite(start).all() and np.isfinite(end).all()):
            continue
        left, top = np.floor(np.minimum(start, end)).astype(int) - reach
        right, bottom = np.ceil(np.maximum(start, end)).astype(int) + reach
        across = np.arange(left, right + 1, dtype=np.float32) - np.float32(start[0])
        down = np.arange(top, bottom + 1, dtype=np.float32)[:, None] - np.float32(start[1])
        along_x, along_y = (np.asarray(end) - start).astype(np.float32)
        length2 = max(along_x**2 + along_y**2, np.float32(1e-12))
        share = np.clip((across * along_x + down * along_y) / length2, 0, 1)
        apart = np.sqrt((across - share * along_x) ** 2 + (down - share * along_y) ** 2)
        shares = full * np.clip(width / 2 + 0.5 - apart, 0, 1)
        _cover(canvas, top, left, np.rint(255 * shares).astype(np.uint8))


def draw_blobs(canvas: np.ndarray, places: np.ndarray, *, sd_px: float) -> None:
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


def _cover(canvas: np.ndarray, top: int, left: int, patch: np.ndarray) -> None:
    n_rows, n_columns = canvas.shape
    rows = slice(max(top, 0), max(min(top + patch.shape[0], n_rows), 0))
    columns = slice(max(left, 0), max(min(left + patch.shape[1], n_columns), 0))
    inside = canvas[rows, columns]
    if inside.size:
        cut = patch[rows.start - top : rows.stop - top, columns.start - left : columns.stop - left]
        np.maximum(inside, cut, out=inside)


def lettering(words: str, *, width: int, height: int, level: float = 1.0) -> np.ndarray:
    """Return a line of words centred on a canvas (height, width); long ones are set smaller."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    dots_an_inch = 72
    figure = Figure(figsize=(width / dots_an_inch, height / dots_an_inch), dpi=dots_an_inch)
    figure.set_facecolor("black")
    canvas = FigureCanvasAgg(figure)
    text = figure.text(0.5, 0.5, words, color="white", ha="center", va="center", parse_math=False)
    text.set_fontsize(height * 0.55)
    with warnings.catch_warnings():
        # A letter that the font lacks is drawn as a box, which says enough.
        warnings.filterwarnings("ignore", message="Glyph .* missing")
        breadth = text.get_window_extent(canvas.get_renderer()).width
        if breadth > 0.94 * width:
            text.set_fontsize(height * 0.55 * 0.94 * width / breadth)
        canvas.draw()
    return np.rint(level * np.asarray(canvas.buffer_rgba())[..., 0]).astype(np.uint8)
