"""The look that all figures share: few inks, thin lines, no state of matplotlib's own."""

from __future__ import annotations

import textwrap
from typing import Any

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

NEGATIVE, POSITIVE = "#D55E00", "#2488CC"
"""Of the two classes of a trait, such as women and men, in figures as on pages."""
TEAL, PURPLE = "#009988", "#AA4499"
"""Of two things that are no classes. All four differ under every common colour blindness."""
CLASSES = (NEGATIVE, POSITIVE, TEAL, PURPLE, "#6E6E6E", "#DDAA33", "#882255", "#1A1A1A")
"""Of the classes of a trait in sorted order."""
INK, GREY, PALE = "#1A1A1A", "#6E6E6E", "#C8C8C8"
SMALL, USUAL = 7.0, 8.0
"""Sizes of letters in points."""
LINE = 30
"""Letters in a line of a title."""


def new_figure(width_in: float, height_in: float) -> Figure:
    """Return an empty figure, drawn by Agg, that pyplot knows nothing of."""
    figure = Figure(figsize=(width_in, height_in), layout="constrained", dpi=150)
    FigureCanvasAgg(figure)
    return figure


def panels(figure: Figure, n_rows: int, n_columns: int, **how: Any) -> list[list[Axes]]:
    """Return axes row by row, with thin spines below and at the left, and small letters."""
    axes = figure.subplots(n_rows, n_columns, squeeze=False, **how)
    for each in axes.flat:
        for name, spine in each.spines.items():
            spine.set_visible(name in ("left", "bottom"))
            spine.set_linewidth(0.6)
            spine.set_color(INK)
        each.tick_params(labelsize=SMALL, width=0.6, length=2.5, color=INK, labelcolor=INK)
        each.xaxis.label.set_fontsize(USUAL)
        each.yaxis.label.set_fontsize(USUAL)
    return axes.tolist()


def bare(axes: Axes) -> Axes:
    """Return axes for a picture of a body: equal scales, no frame, no ticks."""
    axes.set_aspect("equal")
    axes.axis("off")
    return axes


def panel(width_in: float, height_in: float) -> tuple[Figure, Axes]:
    """Return a figure of one panel."""
    figure = new_figure(width_in, height_in)
    return figure, panels(figure, 1, 1)[0][0]


def note(axes: Axes, words: str, place: Any, offset: Any, **how: Any) -> None:
    """Write small words at an offset, in points, from a place."""
    look = {"fontsize": SMALL, "color": INK, "textcoords": "offset points", "parse_math": False}
    axes.annotate(words, tuple(place), xytext=tuple(offset), **look | how)


def colour_scale(figure: Figure, drawn: Any, unit: str, **where: Any) -> None:
    """Add a small colour bar with its unit above."""
    scale = figure.colorbar(drawn, **where)
    scale.ax.tick_params(labelsize=SMALL, width=0.6, length=2.5)
    scale.ax.set_title(unit, fontsize=SMALL, color=INK, parse_math=False)
    scale.outline.set_visible(False)  # pyright: ignore[reportCallIssue] - an artist


def head_line(axes: Axes, words: str, *, letter: str = "") -> None:
    """Write a short title at the left over the axes, after a bold letter that names the panel."""
    words = textwrap.fill(words, LINE)
    axes.set_title(words, fontsize=USUAL, loc="left", color=INK, pad=5, parse_math=False)
    if letter:
        how = {"xycoords": "axes fraction", "fontweight": "bold", "va": "bottom"}
        note(axes, letter, (0, 1), (-14, 5), fontsize=USUAL + 1, **how)
