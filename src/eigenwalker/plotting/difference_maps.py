"""Motion maps drawn, and two walks over each other (Pražák et al. 2010, fig. 1 and 6)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from eigenwalker.core.arguments import check_numbers
from eigenwalker.core.skeleton import LINKS, Skeleton
from eigenwalker.plotting.difference_tables import short_names
from eigenwalker.plotting.projection import project
from eigenwalker.plotting.style import (
    GREY,
    PURPLE,
    SMALL,
    TEAL,
    USUAL,
    bare,
    colour_scale,
    head_line,
    new_figure,
    note,
    panel,
    panels,
)
from eigenwalker.plotting.walkers import HEAD_MM, INCH_MM, draw_body

STEEPEST = 1.6
"""How tall a map may make its row of the figure, for its width."""


@dataclass(frozen=True)
class MapPicture:
    """A motion map and what to draw on it.

    Parameters
    ----------
    values : array of shape (time_a, time_b)
        How different each frame of a is from each of b.
    times_a, times_b : array
        Seconds of the frames.
    title, unit : str
        What is compared, and the unit of the values.
    path : array of shape (step, 2), optional
        Corresponding moments of a and b in seconds, drawn purple.
    period : tuple of float, optional
        Beginnings of a period on a and b, and its lengths, drawn as a teal frame.
    marks : array of shape (moment, 2), optional
        Moments of a and b to mark by a ring.
    names : tuple of str
        What a and b are called.

    See Also
    --------
    figure_maps : Draws them.
    """

    values: np.ndarray
    times_a: np.ndarray
    times_b: np.ndarray
    title: str
    unit: str = ""
    path: np.ndarray | None = None
    period: tuple[float, float, float, float] | None = None
    marks: np.ndarray | None = None
    names: tuple[str, str] = ("first walk", "second walk")


def picture_of_strides(
    values: np.ndarray,
    times_a: np.ndarray,
    times_b: np.ndarray,
    path: np.ndarray,
    title: str,
    *,
    unit: str = "mm",
    names: tuple[str, str] = ("first walk", "second walk"),
) -> MapPicture:
    """Return a map of two strides repeated, so that the path once round both is one line.

    One period is framed, at the beginning of the path.

    Parameters
    ----------
    values : array of shape (time_a, time_b)
        The motion map of two strides.
    times_a, times_b : array of shape (time,)
        Their clocks in seconds.
    path : array of shape (step, 2)
        Corresponding moments of both in seconds, which continue over the seams.
    title, unit, names : str
        What is written above, at the scale, and at the axes.

    Returns
    -------
    MapPicture

    See Also
    --------
    figure_maps : draws it.

    References
    ----------
    Pražák et al. (2010), figure 1.
    """
    values = check_numbers(values, "values", "time_a", "time_b", missing=True)
    times_a = check_numbers(times_a, "times_a", "time", least=2)
    times_b = check_numbers(times_b, "times_b", "time", least=2)
    path = check_numbers(path, "path", "step", "2")
    length_a, length_b = (len(clock) * (clock[1] - clock[0]) for clock in (times_a, times_b))
    lengths = np.array([length_a, length_b])
    path = path - np.floor(path.min(axis=0) / lengths) * lengths
    return MapPicture(
        np.tile(values, (2, 2)),
        np.concatenate([times_a, times_a + length_a]),
        np.concatenate([times_b, times_b + length_b]),
        title,
        unit,
        path=path,
        period=(float(path[0, 0]), float(path[0, 1]), float(length_a), float(length_b)),
        names=names,
    )


def figure_maps(pictures: Sequence[MapPicture], *, n_columns: int = 2) -> Figure:
    """Return motion maps side by side, dark where frames are alike.

    Parameters
    ----------
    pictures : sequence of MapPicture
        Each with a scale of its own.
    n_columns : int
        Maps in a row.

    Returns
    -------
    Figure

    See Also
    --------
    motion_maps : Makes what it shows.

    References
    ----------
    Pražák et al. (2010), fig. 1 and 6.

    Examples
    --------
    >>> t = np.arange(0, 2, 0.1)
    >>> apart = np.abs(np.sin(np.pi * (t[:, None] - t)))
    >>> figure = figure_maps([MapPicture(apart, t, t, "a sine and itself")])
    >>> figure.axes[0].get_title(loc="left")
    'a sine and itself'
    """
    if not pictures:
        raise ValueError("There is no map to draw.")
    n_columns = min(n_columns, len(pictures))
    n_rows = -(-len(pictures) // n_columns)
    wide = 2.7 if n_columns < 3 else 2.2
    rows = [pictures[start : start + n_columns] for start in range(0, len(pictures), n_columns)]
    tall = [0.75 + (wide - 0.8) * min(max(map(_slope, row)), STEEPEST) for row in rows]
    figure = new_figure(0.3 + wide * n_columns, sum(tall))
    laid_out = panels(figure, n_rows, n_columns, height_ratios=tall)
    grid = [axes for row in laid_out for axes in row]
    for axes, picture in zip(grid, pictures, strict=False):
        _draw_map(figure, axes, picture)
    for axes in grid[len(pictures) :]:
        axes.remove()
    return figure


def _slope(picture: MapPicture) -> float:
    """Return the height of a map over its width; a second is as long on both axes."""
    spans = [np.ptp(times) + 1e-9 for times in (picture.times_a, picture.times_b)]
    return float(spans[0] / spans[1])


def _draw_map(figure: Figure, axes: Axes, picture: MapPicture) -> None:
    a, b = (check_numbers(t, "times", "time") for t in (picture.times_a, picture.times_b))
    half_a, half_b = (0.5 * (t[-1] - t[0]) / max(len(t) - 1, 1) for t in (a, b))
    drawn = axes.imshow(
        check_numbers(picture.values, "values", "time_a", "time_b", missing=True),
        cmap="gray",
        origin="lower",
        extent=(b[0] - half_b, b[-1] + half_b, a[0] - half_a, a[-1] + half_a),
        interpolation="nearest",
        aspect="equal",
    )
    if picture.period is not None:
        start_a, start_b, length_a, length_b = picture.period
        axes.add_patch(
            Rectangle((start_b, start_a), length_b, length_a, fc="none", ec=TEAL, lw=1.4)
        )
    if picture.path is not None:
        axes.plot(picture.path[:, 1], picture.path[:, 0], color=PURPLE, lw=1.4)
        axes.set_xlim(b[0] - half_b, b[-1] + half_b)
        axes.set_ylim(a[0] - half_a, a[-1] + half_a)
    if picture.marks is not None:
        axes.plot(
            picture.marks[:, 1], picture.marks[:, 0], "o", mfc="none", mec=PURPLE, ms=5, mew=1.1
        )
    colour_scale(figure, drawn, picture.unit, cax=axes.inset_axes((1.03, 0, 0.05, 1)))
    ordinate, abscissa = short_names(picture.names)
    axes.set_ylabel(f"{ordinate} (s)", parse_math=False)
    axes.set_xlabel(f"{abscissa} (s)", parse_math=False)
    head_line(axes, picture.title)


def figure_two_walks(
    first: np.ndarray,
    second: np.ndarray,
    markers: Sequence[str],
    *,
    names: tuple[str, str] = ("first walk", "second walk"),
    n_moments: int = 5,
    skeleton: Skeleton = LINKS,
) -> Figure:
    """Return two registered walks over each other at moments of their stride, from two sides.

    Parameters
    ----------
    first, second : array of shape (time, marker, axis)
        Corresponding frames of one stride, in mm.
    markers : sequence of str
        Names of the markers.
    names : tuple of str
        What the walks are called.
    n_moments : int
        Evenly spaced moments to draw.
    skeleton : Skeleton
        Which markers are joined.

    Returns
    -------
    Figure
        Seen from the side above, from the front below; the first walk teal, the second purple,
        their left limbs paler.

    See Also
    --------
    compare_walks : Compares what it shows.
    """
    first, second = (
        check_numbers(each, name, "time", "marker", "axis", missing=True)
        for name, each in (("first", first), ("second", second))
    )
    frames = np.linspace(0, len(first), n_moments, endpoint=False).astype(int)
    views = (90.0, 0.0)
    seen = {
        view: [project(walk[frames], azimuth_deg=view) for walk in (first, second)]
        for view in views
    }
    reach = max(np.abs(each[..., 0]).max() for both in seen.values() for each in both) + HEAD_MM
    low = min(each[..., 1].min() for both in seen.values() for each in both)
    top = max(each[..., 1].max() for both in seen.values() for each in both) + 1.5 * HEAD_MM
    pitch, storey = 1.7 * reach, top - low + 150
    width = pitch * (n_moments - 1) + 2 * reach
    figure, axes = panel(width / INCH_MM, (2 * storey + 250) / INCH_MM)
    bare(axes)
    for row, view in enumerate(views):
        for column in range(n_moments):
            for walk, color in zip(seen[view], (TEAL, PURPLE), strict=True):
                look = {"skeleton": skeleton, "color": color, "width": 1.1, "dots": False}
                draw_body(axes, walk[column], markers, at=(column * pitch, -row * storey), **look)
    for column in range(n_moments):
        share = f"{100 * column / n_moments:.0f} %"
        axes.text(column * pitch, low - storey - 90, share, fontsize=SMALL, ha="center", color=GREY)
    for place, (name, color) in enumerate(zip(names, (TEAL, PURPLE), strict=True)):
        offset = (0, 2 + 10 * (1 - place))
        note(axes, name, (0, 1), offset, xycoords="axes fraction", fontsize=USUAL, color=color)
    axes.set_xlim(-reach, (n_moments - 1) * pitch + reach)
    axes.set_ylim(low - storey - 150, top)
    return figure
