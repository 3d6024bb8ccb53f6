"""Bodies drawn with links, standing still: the 15 joints, and walkers side by side."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from eigenwalker.core.arguments import check_kind, check_numbers
from eigenwalker.core.skeleton import LINKS, Skeleton
from eigenwalker.core.walker import Walker, check_walkers
from eigenwalker.plotting.projection import project
from eigenwalker.plotting.style import GREY, INK, PALE, SMALL, USUAL, bare, panel

HEAD_MM = 95.0
"""Radius of the head that is drawn about the marker of that name."""
INCH_MM = 850.0
"""Millimetres of a body that an inch of a figure shows."""


def draw_body(
    axes: Axes,
    seen: np.ndarray,
    markers: Sequence[str],
    *,
    skeleton: Skeleton = LINKS,
    at: tuple[float, float] = (0.0, 0.0),
    color: str = INK,
    width: float = 1.5,
    dots: bool = True,
    dashes: str | tuple = "-",
    zorder: float = 2.0,
) -> None:
    """Draw a posture as a stick figure, its left limbs paler than its right ones.

    Parameters
    ----------
    axes : matplotlib Axes
        To draw into.
    seen : array of shape (marker, 2)
        The posture in projection, in mm (`project`).
    markers : sequence of str
        Their names.
    skeleton : Skeleton
        Which markers are joined.
    at : pair of float
        Where to draw it, in mm.
    color, width, dots, dashes, zorder
        How lines look: the ink, the width in points, whether joints have dots, the line style of
        matplotlib, and what lies over what.

    See Also
    --------
    project, figure_walkers
    """
    seen = check_numbers(seen, "seen", "marker", "2", missing=True)
    if seen.shape != (len(markers), 2):
        raise ValueError(f"seen has shape {seen.shape}; there are {len(markers)} markers.")
    places = dict(zip(markers, seen + at, strict=True))
    left = {one for one, other in skeleton.pairs if {one, other} <= places.keys()}
    for link in skeleton.segments:
        if not set(link) <= places.keys():
            continue
        ends = np.array([places[marker] for marker in link])
        tone = 0.45 if left & set(link) else 1.0
        axes.plot(
            *ends.T,
            color=_mixed(color, tone),
            lw=width,
            ls=dashes,
            solid_capstyle="round",
            zorder=zorder - (tone < 1),
        )
    for marker, place in places.items():
        if dots and marker != "head":
            ink = _mixed(color, 0.45 if marker in left else 1.0)
            axes.plot(*place, "o", ms=1.9 * width, color=ink, mew=0, zorder=zorder + 0.1)
    if "head" in places:
        head = Circle(tuple(places["head"]), HEAD_MM, fc="white" if dots else "none", ec=color)
        head.set(lw=width, ls=dashes, zorder=zorder)
        axes.add_patch(head)


def _mixed(color: str, share: float) -> tuple[float, ...]:
    """A colour on white, as if it covered a share of it."""
    return tuple(1 - share * (1 - np.array(to_rgb(color))))


def figure_joints(
    walker: Walker, *, azimuths_deg: Sequence[float] = (0, 30, 90), skeleton: Skeleton = LINKS
) -> Figure:
    """Return the joints and links of a walker's mean posture from several sides.

    Names stand beside the joints of the first view.

    Parameters
    ----------
    walker : Walker
        Whose mean posture to draw.
    azimuths_deg : sequence of float
        Views as `project` takes them; 0 is the front.
    skeleton : Skeleton
        Which markers are joined.

    Returns
    -------
    Figure

    See Also
    --------
    figure_walkers : Several walkers side by side.

    References
    ----------
    Troje (2002), fig. 1.

    Examples
    --------
    >>> still = ew.Walker(["head"], [[0, 0, 1600]], [[[0, 0, 0]]], [1], [0], 1.0)
    >>> [text.get_text() for text in figure_joints(still, azimuths_deg=[0]).axes[0].texts]
    ['head', 'front']
    """
    check_walkers([walker])
    pictures = [project(walker.p0, azimuth_deg=view) for view in azimuths_deg]
    reach = max(np.abs(picture[:, 0]).max() for picture in pictures) + HEAD_MM
    pitch, names = 2 * reach + 120, 620.0
    middles = np.arange(len(azimuths_deg)) * pitch + np.where(
        np.arange(len(azimuths_deg)) > 0, names, 0
    )
    right = middles[-1] + reach + (50 if len(middles) > 1 else names)
    top = max(picture[:, 1].max() for picture in pictures) + 1.5 * HEAD_MM
    figure, axes = panel((reach + names + right) / INCH_MM, (top + 230) / INCH_MM)
    bare(axes)
    _name_joints(axes, dict(zip(walker.markers, pictures[0], strict=True)), skeleton, reach)
    for middle, view, picture in zip(middles, azimuths_deg, pictures, strict=True):
        draw_body(axes, picture, walker.markers, skeleton=skeleton, at=(middle, 0))
        axes.text(middle, -170, view_name(view), fontsize=USUAL, ha="center", color=GREY)
    axes.set_xlim(-reach - names, right)
    axes.set_ylim(-230, top)
    return figure


def view_name(azimuth_deg: float) -> str:
    """Return a view in words: front, three-quarter, side, or its angle."""
    names: dict[float, str] = {0: "front", 30: "three-quarter", 90: "side"}
    return names.get(azimuth_deg, f"{azimuth_deg:g}°")


def _name_joints(
    axes: Axes, seen: Mapping[str, np.ndarray], skeleton: Skeleton, reach: float
) -> None:
    """Names of the joints at both sides of a body, joined to them by thin lines."""
    pairs = [pair for pair in skeleton.pairs if set(pair) <= seen.keys()]
    left, right = {one for one, _ in pairs}, {other for _, other in pairs}
    middle = [marker for marker in seen if marker not in left | right]
    for side, members in ((1, left | set(middle[::2])), (-1, right | set(middle[1::2]))):
        named = sorted((seen[marker][1], marker) for marker in members)
        heights = _apart([height for height, _ in named])
        for (height, marker), place in zip(named, heights, strict=True):
            x = seen[marker][0]
            corner, end = side * (reach + 15), side * (reach + 75)
            axes.plot([x, corner, end], [height, height, place], color=PALE, lw=0.6, zorder=0)
            axes.text(
                side * (reach + 90),
                place,
                marker.replace("_", " "),
                fontsize=SMALL,
                color=INK,
                va="center",
                ha="left" if side > 0 else "right",
            )


def _apart(heights: Sequence[float], *, least: float = 95.0) -> np.ndarray:
    """Heights in increasing order, moved until no two are closer than `least`."""
    moved = np.array(heights, dtype=float)
    for _ in range(200):
        short = least - np.diff(moved)
        if (short <= 1e-6).all():
            break
        push = np.maximum(short, 0) / 2
        moved[:-1] -= push
        moved[1:] += push
    return moved


def figure_walkers(
    walkers: Mapping[str, Walker],
    *,
    azimuths_deg: Sequence[float] = (0, 90),
    phase: float = 0.25,
    skeleton: Skeleton = LINKS,
    colors: Sequence[str] = (),
) -> Figure:
    """Return walkers side by side at one scale, each over the paths of its joints.

    For the extremes of a trait, and for Moler's four panels: women, men, and both with their
    difference tripled.

    Parameters
    ----------
    walkers : mapping of str to Walker
        Title of each, and the walker; from left to right.
    azimuths_deg : sequence of float
        Views as `project` takes them, from above to below.
    phase : float
        Share of the stride at which the bodies are drawn, from the moment at which the first phase
        is 0. At a quarter the legs of a walker of a population are furthest apart, the left one in
        front.
    skeleton : Skeleton
        Which markers are joined.
    colors : sequence of str
        Of each walker; black if left out.

    Returns
    -------
    Figure

    See Also
    --------
    write_film : The same, moving.

    Examples
    --------
    >>> people = ew.load_population()
    >>> sex = ew.trait_axis(people, "sex")
    >>> poles = {"woman": people.average - sex.step, "man": people.average + sex.step}
    >>> figure = figure_walkers({name: people.walker(each) for name, each in poles.items()})
    >>> [text.get_text() for text in figure.axes[0].texts]
    ['woman', 'man']
    """
    check_kind(walkers, Mapping, "walkers by title")
    check_walkers(walkers.values())
    strides = {title: _one_stride(walker, phase) for title, walker in walkers.items()}
    if len(colors) not in (0, len(walkers)):
        raise ValueError(f"There are {len(colors)} colours for {len(walkers)} walkers.")
    inks = list(colors) or [INK] * len(walkers)
    pictures = [[project(s, azimuth_deg=view) for s in strides.values()] for view in azimuths_deg]
    seen = np.concatenate([picture.reshape(-1, 2) for row in pictures for picture in row])
    pitch = 2 * np.abs(seen[:, 0]).max() + 160
    bottom, top = seen[:, 1].min() - 40, seen[:, 1].max() + HEAD_MM
    story = top - bottom + 130
    figure, axes = panel(
        (len(walkers) * pitch + 100) / INCH_MM, (len(azimuths_deg) * story + 170) / INCH_MM
    )
    bare(axes)
    for row, shown in enumerate(pictures):
        for column, (picture, walker, ink) in enumerate(
            zip(shown, walkers.values(), inks, strict=True)
        ):
            at = (column * pitch, -row * story)
            paths = picture + at
            axes.plot(*np.moveaxis(paths, -1, 0), color=PALE, lw=0.7, zorder=0.5)
            draw_body(axes, picture[0], walker.markers, skeleton=skeleton, at=at, color=ink)
    for column, title in enumerate(walkers):
        where = (column * pitch, top + 60)
        axes.text(*where, title, fontsize=USUAL, ha="center", color=INK, parse_math=False)
    axes.set_xlim(-pitch / 2 - 50, (len(walkers) - 0.5) * pitch + 50)
    axes.set_ylim(bottom - (len(azimuths_deg) - 1) * story - 10, top + 170)
    return figure


def _one_stride(walker: Walker, phase: float) -> np.ndarray:
    """Positions over one closed stride, array of shape (time, marker, axis)."""
    cycle = phase + np.linspace(0, 1, 61)
    return walker.trajectories(walker.time_origin_s + cycle * walker.period_s).values
