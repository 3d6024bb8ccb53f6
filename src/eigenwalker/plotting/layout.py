"""Where walkers stand in the picture, moment by moment: from millimetres to pixels."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
import xarray as xr

from eigenwalker.core.skeleton import LINKS, Skeleton
from eigenwalker.core.trajectories import check_trajectories, trajectories_at
from eigenwalker.core.walker import Walker
from eigenwalker.plotting.projection import project
from eigenwalker.plotting.raster import draw_discs, draw_lines, lettering

Style = Literal["dots", "sticks"]
STYLES = ("dots", "sticks")
DOT_SHARE = 0.02
"""Diameter of a dot of the point-light display, as a share of the picture's side.

It does not go with the walker: dots tell nobody's height.
"""
DEFAULT_DURATION_S = 4.0
"""Seconds of a film or stimulus of walkers whose duration is left open."""
STICK_PER_DOT = 0.6
HEAD_PER_DOT = 4.7
"""Diameter of a stick figure's head, drawn about the marker of that name, in dots."""
MARGIN = 0.06
"""Share of the picture's height that stays empty on each side."""
LEAST_MM = 36.0
"""Extent of a picture that shows less."""
SMALLEST_PX = 16
TITLE = 0.08
"""Share of the picture's height that titles take, where there are any."""
FAR_SIDE = 0.55
"""Cover of the left limbs of a stick figure, so that one can tell them from the right ones."""


@dataclass(frozen=True)
class Layout:
    """Walkers side by side, at one scale, with every dot's place in the picture.

    `shape` is (rows, columns), both even; `places` has for each walker columns and rows of its
    markers, an array of shape (time, marker, 2); `titles` has one for each walker, or none.
    """

    shape: tuple[int, int]
    places: tuple[np.ndarray, ...]
    bodies: tuple[Skeleton, ...]
    pixels_per_mm: float
    dot_px: float
    style: Style
    titles: tuple[str, ...] = ()

    def __len__(self) -> int:
        return len(self.places[0])

    def frames(self) -> Iterator[np.ndarray]:
        """Draw frame after frame: arrays of uint8 (row, column), how much a pixel is covered."""
        backdrop = self._backdrop()
        for moment in range(len(self)):
            canvas = backdrop.copy()
            for places, body in zip(self.places, self.bodies, strict=True):
                self._draw(canvas, places[moment], body)
            yield canvas

    def _backdrop(self) -> np.ndarray:
        canvas = np.zeros(self.shape, np.uint8)
        n_rows, n_columns = self.shape
        height = round(TITLE * n_rows)
        edges = np.linspace(0, n_columns, len(self.places) + 1).astype(int)
        for title, left, right in zip(self.titles, edges, edges[1:], strict=False):
            words = lettering(title, width=right - left, height=height, level=0.75)
            canvas[:height, left:right] = words
        return canvas

    def _draw(self, canvas: np.ndarray, places: np.ndarray, body: Skeleton) -> None:
        if self.style == "dots":
            draw_discs(canvas, places, radius=self.dot_px / 2)
            return
        reach = _radii(list(body.markers), self.style, self.dot_px)
        width = max(STICK_PER_DOT * self.dot_px, 1.5)
        left = {marker for marker, _ in body.pairs}
        for level, far in ((FAR_SIDE, True), (1.0, False)):
            ends = [
                (body.index(a), body.index(b))
                for a, b in body.segments
                if bool({a, b} & left) == far
            ]
            if ends:
                start, end = np.transpose(ends)
                draw_lines(canvas, places[start], places[end], width=width, level=level)
        levels = np.where([marker in left for marker in body.markers], FAR_SIDE, 1.0)
        draw_discs(canvas, places, radius=np.maximum(reach, 1.1), level=levels)


def arrange(
    walks: Sequence[xr.DataArray],
    *,
    azimuth_deg: float,
    elevation_deg: float,
    eye_distance_mm: float | None,
    style: Style,
    size_px: int | tuple[int, int],
    titles: Sequence[str],
    skeleton: Skeleton = LINKS,
) -> Layout:
    """Return walks set side by side in a picture that holds all of them all the time.

    Walks have shape (time, marker, axis), mm, NaN where a marker is missing. Each has a panel of
    the same width, is centred in it, and stands at the same height and scale as the others. With
    `size_px` one number, the height, the width is what the walks need.
    """
    if any(np.isnan(walk.values).all() for walk in walks):
        raise ValueError("A capture has no samples at all during the film; nothing can be drawn.")
    views = [
        project(
            walk,
            azimuth_deg=azimuth_deg,
            elevation_deg=elevation_deg,
            eye_distance_mm=eye_distance_mm,
        )
        for walk in walks
    ]
    lows = np.array([np.nanmin(view, axis=(0, 1)) for view in views])
    highs = np.array([np.nanmax(view, axis=(0, 1)) for view in views])
    breadth = max((highs - lows)[:, 0].max(), LEAST_MM)
    bottom, top = lows[:, 1].min(), highs[:, 1].max()
    rise = max(top - bottom, LEAST_MM)
    width, height = _picture_size(size_px, len(walks), breadth, rise, bool(titles))
    panel = width / len(walks)
    dot_px = max(DOT_SHARE * (min(height, panel) if isinstance(size_px, tuple) else height), 2.0)
    below, above = _reach(views, walks, style, dot_px)
    margin = MARGIN * min(height, panel)
    tall = height - margin - (TITLE * height if titles else margin) - (below + above)[1]
    scale = min((panel - 2 * margin - (below + above)[0]) / breadth, tall / rise)
    floor = height - margin - below[1] - (tall - scale * (top - bottom)) / 2
    places = tuple(
        np.stack(
            [
                (index + 0.5) * panel + scale * (view[..., 0] - (low + high)[0] / 2),
                floor - scale * (view[..., 1] - bottom),
            ],
            axis=-1,
        )
        - 0.5
        for index, (view, low, high) in enumerate(zip(views, lows, highs, strict=True))
    )
    bodies = tuple(skeleton.restricted_to(walk.marker.values.tolist()) for walk in walks)
    return Layout((height, width), places, bodies, scale, dot_px, style, tuple(titles))


def _reach(
    views: Sequence[np.ndarray], walks: Sequence[xr.DataArray], style: Style, dot_px: float
) -> tuple[np.ndarray, np.ndarray]:
    """How far what is drawn reaches beyond the lowest and the highest marker on each axis."""
    below, above = np.zeros(2), np.zeros(2)
    for view, walk in zip(views, walks, strict=True):
        radii = _radii(walk.marker.values.tolist(), style, dot_px)
        low, high = np.nanmin(view, axis=0), np.nanmax(view, axis=0)
        below = np.maximum(below, radii[np.nanargmin(low, axis=0)])
        above = np.maximum(above, radii[np.nanargmax(high, axis=0)])
    return below, above


def _radii(markers: list[str], style: Style, dot_px: float) -> np.ndarray:
    """How far what is drawn reaches around each marker, in pixels."""
    if style == "dots":
        return np.full(len(markers), dot_px / 2)
    head = [marker == "head" for marker in markers]
    return np.where(head, HEAD_PER_DOT / 2, 0.75 * STICK_PER_DOT) * dot_px


def _picture_size(
    size_px: int | tuple[int, int], n_panels: int, breadth: float, tall: float, titled: bool
) -> tuple[int, int]:
    """Width and height, both even; a panel is at least half as wide as the picture is tall."""
    smallest = (SMALLEST_PX * n_panels, SMALLEST_PX) if isinstance(size_px, tuple) else SMALLEST_PX
    if np.less(size_px, smallest).any():
        raise ValueError(
            f"size_px={size_px} is too small for {n_panels} walkers; give {smallest} or more."
        )
    if isinstance(size_px, tuple):
        width, height = size_px
    else:
        height = size_px
        filled = 1 - MARGIN - (TITLE if titled else MARGIN)
        panel = max(filled * breadth / tall / (1 - 2 * MARGIN), 0.5) * height
        width = math.ceil(panel * n_panels)
    return 2 * math.ceil(width / 2), 2 * math.ceil(height / 2)


def positions_at(walk: Walker | xr.DataArray, time: np.ndarray) -> xr.DataArray:
    """Return a walker, or a capture of one, at moments of its own clock.

    Between the frames of a capture lies a straight line.
    """
    if isinstance(walk, Walker):
        return walk.trajectories(time)
    walk = check_trajectories(walk)
    clock = walk.time.values
    if time[-1] > clock[-1] + 1e-6:
        raise ValueError(
            f"The capture lasts {np.ptp(clock):.3f} s, and the film asks for "
            f"{time[-1] - clock[0]:.3f} s; ask for a shorter one, or decompose the capture and "
            "film the walker, which goes on for ever."
        )
    columns = [np.interp(time, clock, column) for column in walk.values.reshape(len(clock), -1).T]
    values = np.stack(columns, axis=1).reshape(len(time), *walk.shape[1:])
    return trajectories_at(time, values, walk.marker.values.tolist())
