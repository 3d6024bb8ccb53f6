"""What each eigenposture does to the body, one by one."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch

from eigenwalker.core.skeleton import LINKS, Skeleton
from eigenwalker.core.walker import Walker, check_walkers
from eigenwalker.plotting.projection import project
from eigenwalker.plotting.style import (
    GREY,
    INK,
    PALE,
    PURPLE,
    SMALL,
    TEAL,
    USUAL,
    bare,
    panel,
)
from eigenwalker.plotting.walkers import HEAD_MM, INCH_MM, draw_body

MOLER = ("stride", "sway", "hop", "bounce")
"""Moler's names of the four postures that ride on sin wt, cos wt, sin 2wt and cos 2wt."""
_ARROW: dict[str, Any] = {
    "arrowstyle": "-|>,head_length=2.5,head_width=1.2",
    "linewidth": 0.7,
    "color": INK,
    "shrinkA": 0,
    "shrinkB": 0,
    "zorder": 4,
}
GAINS = (20, 10, 5, 3, 2, 1)
REACH_MM = 300.0
"""How far a joint may be drawn from its mean place: larger gains are not used."""


def figure_eigenpostures(
    walker: Walker, *, azimuths_deg: Sequence[float] = (0, 90), skeleton: Skeleton = LINKS
) -> Figure:
    """Return the eigenpostures of a walker one by one, over its mean posture.

    Teal is the mean posture plus the eigenposture, with arrows from where the joints are on
    average; purple and dashed is the mean minus it. Small ones are drawn larger, by the factor that
    stands under their names.

    Parameters
    ----------
    walker : Walker
        Its postures are drawn with their amplitudes.
    azimuths_deg : sequence of float
        Views as `project` takes them, from above to below.
    skeleton : Skeleton
        Which markers are joined.

    Returns
    -------
    Figure

    See Also
    --------
    figure_scores, figure_variance : How they move, and how much.

    References
    ----------
    Moler (2016), the four postures: stride, sway, hop and bounce.

    Examples
    --------
    >>> hop = ew.Walker(["head"], [[0, 0, 1600]], [[[0, 0, 12]]], [2], [0], 1.0)
    >>> figure_eigenpostures(hop).axes[0].texts[1].get_text()
    'harmonic 2, 20-fold'
    """
    check_walkers([walker])
    gains = [_gain(posture) for posture in walker.p]
    extremes = [
        (walker.p0 + gain * p, walker.p0 - gain * p)
        for gain, p in zip(gains, walker.p, strict=True)
    ]
    seen = np.concatenate(
        [project(extremes, azimuth_deg=view).reshape(-1, 2) for view in azimuths_deg]
    )
    pitch = 2 * np.abs(seen[:, 0]).max() + 220
    bottom, top = seen[:, 1].min() - 30, seen[:, 1].max() + HEAD_MM
    story = top - bottom + 130
    figure, axes = panel(
        (len(walker.p) * pitch + 100) / INCH_MM, (len(azimuths_deg) * story + 330) / INCH_MM
    )
    bare(axes)
    for column, (plus, minus) in enumerate(extremes):
        for row, view in enumerate(azimuths_deg):
            shown = project([walker.p0, plus, minus], azimuth_deg=view)
            body = {"skeleton": skeleton, "at": (column * pitch, -row * story)}
            _draw_extremes(axes, shown, walker.markers, body)
        harmonic, gain = walker.harmonics[column], gains[column]
        where = (column * pitch, top + 190)
        axes.text(*where, _name(walker, column), fontsize=USUAL, ha="center", color=INK)
        how = f"harmonic {harmonic}" + (f", {gain}-fold" if gain > 1 else "")
        axes.text(where[0], top + 75, how, fontsize=SMALL, ha="center", color=GREY)
    axes.set_xlim(-pitch / 2 - 50, (len(walker.p) - 0.5) * pitch + 50)
    axes.set_ylim(bottom - (len(azimuths_deg) - 1) * story - 10, top + 320)
    return figure


def _gain(posture: np.ndarray) -> int:
    largest = np.linalg.norm(posture, axis=-1).max()
    return next((gain for gain in GAINS if gain * largest <= REACH_MM), 1)


def _name(walker: Walker, component: int) -> str:
    number = str(component + 1)
    if walker.harmonics.tolist()[:4] != [1, 1, 2, 2] or component >= len(MOLER):
        return number
    return f"{number}  {MOLER[component]}"


def _draw_extremes(
    axes: Axes, shown: np.ndarray, markers: Sequence[str], body: dict[str, Any]
) -> None:
    """Mean posture, mean plus and mean minus the eigenposture: `shown` of (3, marker, 2)."""
    mean, plus, minus = shown
    draw_body(axes, mean, markers, color=PALE, width=2.2, dots=False, zorder=0, **body)
    draw_body(axes, minus, markers, color=PURPLE, width=0.8, dots=False, dashes=(0, (3, 2)), **body)
    draw_body(axes, plus, markers, color=TEAL, width=1.1, dots=False, zorder=3, **body)
    for start, end in zip(mean + body["at"], plus + body["at"], strict=True):
        if np.linalg.norm(end - start) > 40:
            axes.add_patch(FancyArrowPatch(tuple(start), tuple(end), **_ARROW))
