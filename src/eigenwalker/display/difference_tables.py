"""Tables of differences drawn: as a picture in order, and as a map (Pražák et al. 2010, fig. 4)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from eigenwalker.display.style import BLUE, GREY, INK, RED, SMALL, new_figure, panels

MOST_NAMED = 45
"""Walks up to which each gets its name; more would stand over each other."""
_LONGEST = 15
_INKS = (BLUE, RED, "#009988", "#AA4499", GREY)
_LOOK = tuple(zip(_INKS * 2, "o^sDv" + "v*PXd", strict=True))
"""Colours and marks of classes; beyond ten they repeat."""


def figure_difference_table(
    table: ArrayLike,
    names: Sequence[str],
    *,
    order: ArrayLike,
    clusters: ArrayLike | None = None,
    unit: str = "",
) -> Figure:
    """Return a table of differences as a picture, dark where walks are alike (fig. 4).

    Parameters
    ----------
    table : array of shape (walk, walk)
        Differences.
    names : sequence of str
        One name a walk.
    order : array of int of shape (walk,)
        Which walk comes first, second and so on.
    clusters : array of int of shape (walk,), optional
        Dashed lines stand where in that order another cluster begins.
    unit : str
        Unit of the differences.

    Returns
    -------
    Figure

    Examples
    --------
    >>> figure = figure_difference_table([[0, 1], [1, 0]], ["a", "b"], order=[1, 0])
    >>> [label.get_text() for label in figure.axes[0].get_yticklabels()]
    ['b', 'a']

    """
    values, order = np.asarray(table, dtype=float), np.asarray(order, dtype=int)
    side = float(np.clip(0.13 * len(order), 2.4, 6.2))
    figure = new_figure(side + 2.1, side + 1.1)
    axes = panels(figure, 1, 1)[0][0]
    drawn = axes.imshow(values[np.ix_(order, order)], cmap="gray", interpolation="nearest")
    if clusters is not None:
        sorted_clusters = np.asarray(clusters)[order]
        for border in np.flatnonzero(np.diff(sorted_clusters)) + 0.5:
            axes.axhline(border, color="#009988", lw=1.0, ls="--")
            axes.axvline(border, color="#009988", lw=1.0, ls="--")
    if len(order) <= MOST_NAMED:
        labels = [short_name(str(names[walk])) for walk in order]
        axes.set_xticks(range(len(order)), labels, rotation=90, parse_math=False)
        axes.set_yticks(range(len(order)), labels, parse_math=False)
    else:
        axes.set_xlabel("Walk, in order")
    scale = figure.colorbar(drawn, ax=axes, fraction=0.046, pad=0.03)
    scale.ax.tick_params(labelsize=SMALL, width=0.6, length=2.5)
    scale.ax.set_title(unit, fontsize=SMALL, color=INK, parse_math=False)
    scale.outline.set_visible(False)  # pyright: ignore[reportCallIssue] - an artist, whatever the stub says
    return figure


def figure_map_of_walks(
    places: ArrayLike, classes: Sequence[str], *, names: Sequence[str] | None = None
) -> Figure:
    """Return walks as points, near each other if they are alike.

    Parameters
    ----------
    places : array of shape (walk, 2)
        As `map_of_walks` gives them.
    classes : sequence of str
        The cluster or label of each walk, told by colour and mark.
    names : sequence of str, optional
        Written beside the points.

    Returns
    -------
    Figure

    Examples
    --------
    >>> figure = figure_map_of_walks([[0, 0], [1, 2]], ["slow", "fast"])
    >>> [text.get_text() for text in figure.legends[0].get_texts()]
    ['fast (1)', 'slow (1)']

    """
    places, of = np.asarray(places, dtype=float), np.asarray(classes)
    figure = new_figure(4.8, 3.9)
    axes = panels(figure, 1, 1)[0][0]
    for number, name in enumerate(np.unique(of)):
        color, mark = _LOOK[number % len(_LOOK)]
        chosen = places[of == name]
        label = f"{name} ({len(chosen)})".replace("$", r"\$")  # words, not mathematics
        axes.scatter(*chosen.T, s=20, c=color, marker=mark, lw=0, alpha=0.85, label=label)
    for place, name in zip(places, names or [], strict=False):
        axes.annotate(
            short_name(name),
            tuple(place),
            xytext=(3, 3),
            textcoords="offset points",
            fontsize=SMALL - 1.5,
            color=GREY,
            parse_math=False,
        )
    figure.legend(
        loc="outside upper left", ncols=4, fontsize=SMALL, frameon=False, handletextpad=0.1
    )
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.12)
    axes.set_xlabel("First dimension")
    axes.set_ylabel("Second dimension")
    return figure


def short_name(name: str) -> str:
    """Return a name that fits beside a picture: what tells files apart is mostly at their ends.

    Examples
    --------
    >>> short_name("dataset-2_walk_normal_001.bvh")
    'datase…rmal_001'

    """
    stem = name.rpartition(".")[0] or name
    if len(stem) <= _LONGEST:
        return stem
    return f"{stem[:6]}\N{HORIZONTAL ELLIPSIS}{stem[-8:]}"
