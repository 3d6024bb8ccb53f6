"""The size of dots on a screen: a constant of the display, whoever is shown on it.

Dots that grew with the figure would tell a short walker from a tall one, and so women from men.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from eigenwalker.plotting.layout import DOT_SHARE
from eigenwalker.stimulus.schema import Display

SMALLEST_PX = 2.0
DOT_DEG = 0.12
"""Visual angle of a dot where the size of the walker is stated in degrees, and nothing else is."""
USUAL_HEIGHT_MM = 1500.0
"""From the lowest to the highest dot of a usual walker; what is drawn "on its scale" goes by it."""


def usual_dot_px(display: Display) -> float:
    """Return the diameter of dots for whose size nobody asked: a fiftieth of the picture."""
    return round(max(DOT_SHARE * min(display.width_px, display.height_px), SMALLEST_PX), 4)


def with_dots(
    display: Display, *, px: float | None = None, deg: float | None = None, mm: float | None = None
) -> Display:
    """Return a display whose dots have one of these diameters; with none, the display itself."""
    given = {"dot_px": px, "dot_deg": deg, "dot_mm": mm}
    given = {name: size for name, size in given.items() if size is not None}
    if len(given) > 1:
        raise ValueError(f"The size of dots is given as {list(given)}; give one of them.")
    if px is not None:
        return replace(display, dot_px=float(px))
    if deg is not None:
        return replace(display, dot_px=round(degrees_in_px(display, deg, "dot_deg"), 4))
    if mm is not None:
        return replace(display, dot_px=round(mm * _screen(display, "dot_mm")[1] / 10, 4))
    return display


def degrees_in_px(display: Display, angle_deg: float, name: str) -> float:
    """Return how many pixels a visual angle is in the middle of the screen of a display."""
    distance_mm, px_per_cm = _screen(display, name)
    return float(2 * distance_mm * np.tan(np.deg2rad(angle_deg) / 2) * px_per_cm / 10)


def _screen(display: Display, name: str) -> tuple[float, float]:
    """Viewing distance and pixels a centimetre, without which an angle is no number of pixels."""
    if display.viewing_distance_mm is None or display.px_per_cm is None:
        raise ValueError(f"{name} needs the screen: give viewing_distance_mm and px_per_cm too.")
    return display.viewing_distance_mm, display.px_per_cm
