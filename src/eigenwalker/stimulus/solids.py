"""Hulls of two balls as pixels, in three dimensions, with soft light and soft edges.

For each pixel and hull, the distance of the line of sight from the hull's outline gives how much of
the pixel is covered, and the point where it first meets the hull gives the brightness.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from eigenwalker.stimulus.mannequin import Hulls
from eigenwalker.stimulus.player import NEAREST_MM

LIGHT = np.array([-0.44, 0.67, 0.6]) / np.sqrt(0.44**2 + 0.67**2 + 0.6**2)
"""Where the light comes from, seen by the observer: right, up, towards the observer."""
SHADOW, EDGE = 0.34, 0.8
"""Light in the deepest shadow, and share of light where the surface turns away."""
Pixels = np.ndarray | np.float32
MAX_PIXELS = 1_000_000
"""Pixels of a hull computed at once."""
TIE_MM = 1e-3
"""Balls nearer to each other than this are one."""
TINY = 1e-6


class Lit(NamedTuple):
    """Mannequins as pixels.

    Rows and columns of the picture that they are in; there the share of each pixel that is covered,
    and how bright it is, 0 to 1, times that share.
    """

    box: tuple[slice, slice]
    cover: np.ndarray
    light: np.ndarray


class Look(NamedTuple):
    """The picture: rows and columns, pixels a mm, where its middle is, and how far the eye is."""

    shape: tuple[int, int]
    px_per_mm: float
    middle_px: tuple[float, float]
    eye_mm: float | None


class _Sight(NamedTuple):
    """Lines of sight against one hull; each an array of pixels, or one number for all.

    Beside the line of sight, ball ``share`` of the way from one to the other is ``u - share long``
    back along the hull's axis and ``v`` off it; towards the observer it is ``near + share nearer``.
    `light` has the light's parts along the axis, off it, and towards the observer.
    """

    u: np.ndarray
    v: np.ndarray
    long: Pixels
    near: Pixels
    nearer: Pixels
    px_per_mm: Pixels
    light: tuple[Pixels, Pixels, Pixels]


def draw_hulls(hulls: Hulls, look: Look) -> Lit:
    """Return hulls as an observer sees them, nearer ones before farther ones."""
    boxes = [_box(*piece, look) for piece in zip(hulls.middles, hulls.radii, strict=True)]
    whole = _around([box for box in boxes if box is not None])
    size = [side.stop - side.start for side in whole]
    cover, light = np.zeros(size, np.float32), np.zeros(size, np.float32)
    depth = np.full(size, -np.inf, np.float32)
    for piece in np.argsort(hulls.middles[..., 2].mean(axis=1)):
        for box in _bands(boxes[piece]):
            x, y = _picture(box, look)
            beside, near, shade = _seen(hulls.middles[piece], hulls.radii[piece], x, y, look)
            rows, columns = (
                slice(side.start - corner.start, side.stop - corner.start)
                for side, corner in zip(box, whole, strict=True)
            )
            part = (rows, columns)
            # Where pieces cut into each other the passage is as soft as an edge.
            before = np.clip((near - depth[part]) * look.px_per_mm + 0.5, 0, 1)
            covered = np.clip(beside + 0.5, 0, 1) * before
            left = 1 - covered
            cover[part] = covered + left * cover[part]
            light[part] = covered * (hulls.tones[piece] * shade) + left * light[part]
            depth[part] = np.where(covered > 0.5, near, depth[part])
    return Lit(whole, cover, light)


def _bands(box: tuple[slice, slice] | None) -> Iterator[tuple[slice, slice]]:
    """Parts of a box, one above the other, of so many pixels that memory holds them."""
    if box is None:
        return
    rows, columns = box
    step = max(MAX_PIXELS // (columns.stop - columns.start), 1)
    for first in range(rows.start, rows.stop, step):
        yield slice(first, min(first + step, rows.stop)), columns


def brightness(lit: np.ndarray, facing: np.ndarray) -> np.ndarray:
    """Return the brightness of surfaces whose normals have these cosines with light and sight."""
    soft = 0.5 + 0.5 * lit
    return (SHADOW + (1 - SHADOW) * soft**2) * (EDGE + (1 - EDGE) * facing)


def _around(boxes: list[tuple[slice, slice]]) -> tuple[slice, slice]:
    """The least box around boxes."""
    rows, columns = (
        slice(
            min((box[axis].start for box in boxes), default=0),
            max((box[axis].stop for box in boxes), default=0),
        )
        for axis in (0, 1)
    )
    return rows, columns


def _box(ends: np.ndarray, radii: np.ndarray, look: Look) -> tuple[slice, slice] | None:
    """Rows and columns in which a hull may be seen; none, if it is beside the picture."""
    sides = []
    for axis, (size, middle) in enumerate(zip(look.shape[::-1], look.middle_px, strict=True)):
        low, high = (_reach(ends[:, [axis, 2]], sign * radii, look.eye_mm) for sign in (-1, 1))
        edges = look.px_per_mm * np.array([low.min(), high.max()])
        first, last = np.sort(edges if axis == 0 else -edges) + middle + [-1.5, 1.5]
        start, stop = max(int(np.floor(max(first, 0))), 0), int(np.ceil(min(last, size - 1))) + 1
        if start >= stop:
            return None
        sides.append(slice(start, stop))
    return sides[1], sides[0]


def _reach(places: np.ndarray, radii: np.ndarray, eye_mm: float | None) -> np.ndarray:
    """How far balls reach to one side in the picture, in mm: places are beside and towards."""
    if eye_mm is None:
        return places[:, 0] + radii
    away = eye_mm - places[:, 1]
    apart = np.maximum(np.hypot(places[:, 0], away), np.abs(radii) + TINY)
    angle = np.arctan2(places[:, 0], away) + np.arcsin(radii / apart)
    return eye_mm * np.tan(np.clip(angle, -1.57, 1.57))


def _picture(box: tuple[slice, slice], look: Look) -> tuple[np.ndarray, np.ndarray]:
    """Where pixels are in the picture: mm to the right of its middle, and above it."""
    rows, columns = (np.arange(side.start, side.stop, dtype=np.float32) for side in box)
    right, down = columns - look.middle_px[0], rows - look.middle_px[1]
    return right[None, :] / look.px_per_mm, -down[:, None] / look.px_per_mm


def _seen(
    ends: np.ndarray, radii: np.ndarray, x: np.ndarray, y: np.ndarray, look: Look
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """How far within the hull's outline pixels are (px), how near what is seen is, how bright."""
    start, way = ends[0], ends[1] - ends[0]
    if np.sqrt(way @ way) < TIE_MM:
        way = np.array([TIE_MM, 0, 0])
    if look.eye_mm is None:
        sight = _level(start, way, x, y, look.px_per_mm)
    else:
        sight = _from_eye(start, way, x, y, look.px_per_mm, look.eye_mm)
    radius, wider = radii[0], radii[1] - radii[0]
    beside = _within(sight, radius, wider) * sight.px_per_mm
    share = _first_met(sight, radius, wider)
    along, girth2 = sight.u - share * sight.long, (radius + share * wider) ** 2
    off2 = along**2 + sight.v**2
    towards = np.sqrt(np.maximum(girth2 - off2, 0))
    normal = np.sqrt(np.maximum(girth2, off2))
    lit = (along * sight.light[0] + sight.v * sight.light[1] + towards * sight.light[2]) / normal
    shade = brightness(lit, towards / normal)
    return beside, sight.near + share * sight.nearer + towards, shade


def _level(
    start: np.ndarray, way: np.ndarray, x: np.ndarray, y: np.ndarray, px_per_mm: float
) -> _Sight:
    """Lines of sight that are all parallel."""
    long = np.float32(max(np.hypot(way[0], way[1]), TIE_MM))
    ahead = way[:2] / long if long > TIE_MM else np.array([1.0, 0.0])
    right, up = x - np.float32(start[0]), y - np.float32(start[1])
    one, other = (np.float32(part) for part in ahead)
    return _Sight(
        u=right * one + up * other,
        v=up * one - right * other,
        long=long,
        near=np.float32(start[2]),
        nearer=np.float32(way[2]),
        px_per_mm=np.float32(px_per_mm),
        light=(
            np.float32(ahead @ LIGHT[:2]),
            np.float32(ahead @ [LIGHT[1], -LIGHT[0]]),
            np.float32(LIGHT[2]),
        ),
    )


def _from_eye(
    start: np.ndarray,
    way: np.ndarray,
    x: np.ndarray,
    y: np.ndarray,
    px_per_mm: float,
    eye_mm: float,
) -> _Sight:
    """Lines of sight that all come from the eye."""
    far = np.sqrt(x**2 + y**2 + eye_mm**2)

    def along(vector: np.ndarray) -> np.ndarray:
        """Part of a vector along each line of sight."""
        return (vector[0] * x + vector[1] * y - vector[2] * eye_mm) / far

    from_eye = start - [0.0, 0.0, eye_mm]
    away, farther, lit = along(from_eye), along(way), along(LIGHT)
    long = np.sqrt(np.maximum(way @ way - farther**2, TIE_MM**2))
    return _Sight(
        u=(away * farther - from_eye @ way) / long,
        v=-along(np.cross(from_eye, way)) / long,
        long=long,
        near=-away,
        nearer=-farther,
        px_per_mm=px_per_mm * far / np.maximum(away, NEAREST_MM),
        light=((LIGHT @ way - farther * lit) / long, along(np.cross(LIGHT, way)) / long, -lit),
    )


def _within(sight: _Sight, radius: float, wider: float) -> np.ndarray:
    """How far within the outline a line of sight passes, in mm; negative outside.

    The outline of balls that become wider evenly: that ball is nearest to a line whose radius the
    tangent on both touches.
    """
    flat2 = sight.long**2 - wider**2
    lean = wider / np.sqrt(np.maximum(flat2, TINY))
    share = np.clip((sight.u + np.abs(sight.v) * lean) / sight.long, 0, 1)
    share = np.where(flat2 > TINY, share, float(wider > 0))
    return radius + share * wider - np.hypot(sight.u - share * sight.long, sight.v)


def _first_met(sight: _Sight, radius: float, wider: float) -> np.ndarray:
    """The share of the way between both balls of the ball that a line of sight meets first.

    With Q the square of half a line's length within a ball, a quadratic in the share, the nearest
    of all points ``near + share nearer + sqrt(Q)`` is where that is stationary, or at an end.
    """
    flat2 = sight.long**2 - wider**2
    safe = np.where(np.abs(flat2) > TINY, flat2, TINY)
    middle = (radius * wider + sight.u * sight.long) / safe
    most = radius**2 - sight.u**2 - sight.v**2 + middle**2 * safe
    below = safe * (safe + sight.nearer**2)
    ratio = most / np.where(np.abs(below) > TINY, below, TINY)
    share = middle + np.sign(safe) * sight.nearer * np.sqrt(np.maximum(ratio, 0))
    share = np.clip(share, 0, 1)
    if np.min(flat2) > TINY:
        return share
    # One outline lies within the other: it is stationary there, or nearest at an end.
    shares = np.stack(np.broadcast_arrays(share, 0.0, 1.0))
    fronts = np.stack([_front(sight, radius, wider, end) for end in shares])
    nearest = np.take_along_axis(shares, fronts.argmax(axis=0)[None], axis=0)[0]
    nested = np.where(np.isfinite(fronts).any(axis=0), nearest, float(wider > 0))
    return np.where(flat2 > TINY, share, nested)


def _front(sight: _Sight, radius: float, wider: float, share: np.ndarray) -> np.ndarray:
    """How near the front of a ball is; minus infinity where a line of sight misses it."""
    half2 = (radius + share * wider) ** 2 - (sight.u - share * sight.long) ** 2 - sight.v**2
    front = sight.near + share * sight.nearer + np.sqrt(np.maximum(half2, 0))
    return np.where(half2 >= 0, front, -np.inf)
