"""A walk as a small drawing that moves by itself: SVG, for notebooks and pages without a script."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

import numpy as np

VIEW_DEG = 40.0
"""Turned out of the frontal view so far that both the swing of the legs and the shoulders show."""
N_FRAMES = 24
"""Drawings a stride; the browser goes evenly from one to the next."""
_MARGIN = 8.0
_DOT = 7.0


def stride_svg(
    positions: np.ndarray,
    *,
    period_s: float,
    segments: Sequence[tuple[int, int]] = (),
    height_px: int = 200,
    label: str = "A walker",
) -> str:
    """Return positions over one period as SVG that plays them for ever, dots over pale sticks.

    Positions (time, marker, 3) are in millimetres, evenly over one period, whose end is left out.
    """
    places, width = _places_px(np.asarray(positions, dtype=float), height_px)
    sticks = [_path(frame, segments) for frame in places]
    dots = ["".join(f"M{x:.1f} {y:.1f}h0" for x, y in frame) for frame in places]
    drawn = _moving(sticks, period_s, width=2.5, opacity=0.35) if segments else ""
    drawn += _moving(dots, period_s, width=_DOT, opacity=1)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" role="img" aria-label="{escape(label)}" '
        f'width="{width:.0f}" height="{height_px}" viewBox="0 0 {width:.1f} {height_px}" '
        f'fill="none" stroke="currentColor" stroke-linecap="round">{drawn}</svg>'
    )


def _places_px(positions: np.ndarray, height_px: int) -> tuple[np.ndarray, float]:
    view = np.deg2rad(VIEW_DEG)
    right = positions[..., 0] * np.sin(view) + positions[..., 1] * np.cos(view)
    seen = np.stack([right, -positions[..., 2]], axis=-1)
    low, high = seen.min(axis=(0, 1)), seen.max(axis=(0, 1))
    scale = (height_px - 2 * _MARGIN) / max(*(high - low), 1e-9)
    width = float((high - low)[0] * scale) + 2 * _MARGIN
    middle = np.array([width, height_px]) / 2
    return middle + scale * (seen - (low + high) / 2), width


def _path(frame: np.ndarray, segments: Sequence[tuple[int, int]]) -> str:
    ends = [(frame[one], frame[other]) for one, other in segments]
    return "".join(f"M{a[0]:.1f} {a[1]:.1f}L{b[0]:.1f} {b[1]:.1f}" for a, b in ends)


def _moving(paths: list[str], period_s: float, *, width: float, opacity: float) -> str:
    values = ";".join([*paths, paths[0]])
    return (
        f'<path d="{paths[0]}" stroke-width="{width}" stroke-opacity="{opacity}">'
        f'<animate attributeName="d" dur="{period_s:.4f}s" repeatCount="indefinite" '
        f'values="{values}"/></path>'
    )


def html_table(rows: Sequence[Sequence[str]], *, title: str) -> str:
    """Return a small table for a notebook; its cells are HTML already."""
    lines = "".join(
        "<tr>"
        + "".join(f'<td style="text-align:left;padding:1px 12px 1px 0">{cell}</td>' for cell in row)
        + "</tr>"
        for row in rows
    )
    head = f'<caption style="text-align:left;font-weight:600">{escape(title)}</caption>'
    return f'<table style="border-collapse:collapse">{head}<tbody>{lines}</tbody></table>'


def beside(drawing: str, words: str) -> str:
    """Return a drawing and words side by side, for a notebook."""
    style = "display:flex;gap:20px;align-items:center;flex-wrap:wrap"
    return f'<div style="{style}"><div>{drawing}</div><div>{words}</div></div>'
