"""Mannequins as drawings: outlines of hulls, shaded across, the farther before the nearer."""

from __future__ import annotations

import numpy as np

from eigenwalker.stimulus.mannequin import Hulls
from eigenwalker.stimulus.mannequin_palette import lit_colour
from eigenwalker.stimulus.solids import LIGHT, Look, brightness

ACROSS = np.linspace(-1, 1, 9)
"""Places across a hull, from edge to edge, where its shade is worked out."""


def svg_hulls(hulls: Hulls, look: Look, ink: str) -> list[str]:
    """Return elements of SVG that draw hulls: for each a gradient and a path.

    Outlines are those of discs as large as the balls are seen, and what lies between; lights are
    those of hulls that lie across the line of sight. Joints are drawn before the limbs they join.
    """
    lines = []
    nearness = hulls.middles[..., 2].mean(axis=1) - np.where(hulls.tones < 1, hulls.radii[:, 0], 0)
    for number, piece in enumerate(np.argsort(nearness)):
        away = np.inf if look.eye_mm is None else look.eye_mm - hulls.middles[piece, :, 2]
        scale = look.px_per_mm * np.broadcast_to(
            1.0 if look.eye_mm is None else look.eye_mm / away, 2
        )
        middles = look.middle_px + scale[:, None] * hulls.middles[piece, :, :2] * [1, -1]
        radii = scale * hulls.radii[piece]
        lines += [
            _gradient(number, middles, float(radii.max()), hulls.tones[piece] * lit_colour(ink)),
            f'<path class="wood" d="{_outline(middles, radii)}" fill="url(#wood{number})"/>',
        ]
    return lines


def _outline(middles: np.ndarray, radii: np.ndarray) -> str:
    """Two discs and what lies between them, as a path."""
    x, y = middles[1] - middles[0]
    apart = float(np.hypot(x, y))
    if apart <= abs(radii[0] - radii[1]):
        larger = int(radii[1] > radii[0])
        (left, top), radius = middles[larger], radii[larger]
        arc = f"a {radius:.3f} {radius:.3f} 0 1 0"
        return f"M {left - radius:.3f} {top:.3f} {arc} {2 * radius:.3f} 0 {arc} {-2 * radius:.3f} 0"
    u, v = x / apart, y / apart
    cosine = (radii[0] - radii[1]) / apart
    sine = np.sqrt(1 - cosine**2)
    sides = np.array([[u * cosine - v * s, v * cosine + u * s] for s in (sine, -sine)])
    corners = middles[:, None] + radii[:, None, None] * sides
    large = [int(cosine > 0), int(cosine < 0)]
    points = [f"{left:.3f} {top:.3f}" for left, top in corners.reshape(4, 2)]
    return (
        f"M {points[0]} A {radii[0]:.3f} {radii[0]:.3f} 0 {large[0]} 1 {points[1]} "
        f"L {points[3]} A {radii[1]:.3f} {radii[1]:.3f} 0 {large[1]} 1 {points[2]} Z"
    )


def _gradient(number: int, middles: np.ndarray, radius: float, colour: np.ndarray) -> str:
    """How bright a hull is across its width; of a ball, from the light away."""
    way = middles[1] - middles[0]
    across = np.array([-way[1], way[0]]) if way.any() else np.array([LIGHT[0], -LIGHT[1]])
    across = radius * across / np.hypot(*across)
    middle = middles.mean(axis=0)
    normals = np.stack([*(ACROSS * part / radius for part in across), np.sqrt(1 - ACROSS**2)], 1)
    lights = brightness(normals @ [LIGHT[0], -LIGHT[1], LIGHT[2]], normals[:, 2])
    stops = "".join(
        f'<stop offset="{(place + 1) / 2:.4f}" stop-color="rgb({red:.0f},{green:.0f},{blue:.0f})"/>'
        for place, (red, green, blue) in zip(ACROSS, lights[:, None] * colour, strict=True)
    )
    ends = zip(("x1", "y1", "x2", "y2"), (*(middle - across), *(middle + across)), strict=True)
    places = " ".join(f'{name}="{place:.3f}"' for name, place in ends)
    return (
        f'<linearGradient id="wood{number}" gradientUnits="userSpaceOnUse" {places}>'
        f"{stops}</linearGradient>"
    )
