"""Gait parameters of many walks: a point a walk, beside mean and standard deviation."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from eigenwalker.core.arguments import check_kind, check_numbers
from eigenwalker.plotting.style import CLASSES, INK, SMALL, head_line, new_figure, panels

_REACH = 0.22
"""How far points of a group lie apart, across; groups are 1 apart."""


def figure_parameters(values: Mapping[str, ArrayLike], *, groups: Sequence[str] = ()) -> Figure:
    """Return a panel for each gait parameter with a point a walk, mean and standard deviation.

    Parameters
    ----------
    values : mapping of str to array of shape (walk,)
        Title of each panel, with its unit, and the parameter of each walk; NaN where unknown.
    groups : sequence of str of shape (walk,)
        The group of each walk, such as its sex; all walks are one if left out.

    Returns
    -------
    Figure

    See Also
    --------
    eigenwalker.gait.gait_parameters : Measures them.

    Examples
    --------
    >>> figure = figure_parameters({"speed (m/s)": [1.1, 1.3]}, groups=["woman", "man"])
    >>> [label.get_text() for label in figure.axes[0].get_xticklabels()]
    ['man', 'woman']
    """
    check_kind(values, Mapping, "parameters by title")
    columns = {
        title: check_numbers(column, f"the values of {title}", "walk", missing=True)
        for title, column in values.items()
    }
    lengths = {len(column) for column in columns.values()} | ({len(groups)} if groups else set())
    if len(lengths) != 1:
        raise ValueError(
            f"Parameters and groups are of as many walks; they are of {sorted(lengths)}."
        )
    of = np.asarray(groups or ["all"] * lengths.pop(), dtype=str)
    names = sorted(set(of))
    if len(names) > len(CLASSES):
        raise ValueError(f"There are {len(names)} groups, more than the {len(CLASSES)} colours.")
    inks = dict(zip(names, CLASSES if len(names) > 1 else [INK], strict=False))
    n_columns = min(3, len(columns))
    n_rows = math.ceil(len(columns) / n_columns)
    figure = new_figure(1.8 * n_columns, 1.7 * n_rows)
    axes = [each for row in panels(figure, n_rows, n_columns) for each in row]
    for each, (title, column) in zip(axes, columns.items(), strict=False):
        head_line(each, title)
        for place, name in enumerate(names):
            _draw_group(each, column[of == name], place, inks[name])
        each.set_xticks(range(len(names)), names, fontsize=SMALL, parse_math=False)
        each.set_xlim(-0.6, len(names) - 0.4)
    for each in axes[len(columns) :]:
        each.set_visible(False)
    return figure


def _draw_group(axes: Axes, values: np.ndarray, place: int, ink: str) -> None:
    """Draw points beside each other, as they come, and mean and standard deviation after them."""
    known = values[np.isfinite(values)]
    if not len(known):
        return
    across = place - 0.1 + _REACH * np.linspace(-1, 1, len(known)) * (len(known) > 1)
    axes.plot(across, known, "o", ms=2.6, mfc=ink, mec="none", alpha=0.6)
    spread = known.std(ddof=1) if len(known) > 1 else 0.0
    look = {"fmt": "_", "ms": 7, "color": INK, "elinewidth": 0.9, "capsize": 2}
    axes.errorbar(place + 0.3, known.mean(), spread, **look)
