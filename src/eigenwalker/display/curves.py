"""How well classifiers do with more and more components (J fig. 4)."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Protocol

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import ArrayLike

from eigenwalker.display.style import BLUE, INK, RED, SMALL, USUAL, head_line, new_figure, panels


class Curves(Protocol):
    """Misclassified walkers for 1, 2, ... components, as `jackknife_curves` returns them."""

    @property
    def n_components(self) -> np.ndarray: ...  # noqa: D102 - the class tells
    @property
    def separation(self) -> np.ndarray: ...  # noqa: D102 - the class tells
    @property
    def generalisation(self) -> np.ndarray: ...  # noqa: D102 - the class tells


def figure_curves(
    curves: Mapping[str, Curves], *, n_walkers: int, n_columns: int | None = None
) -> Figure:
    """Return misclassified walkers over the number of components, one panel an input (J fig. 4).

    Dashed blue is separation: walkers that a classifier misses although it was fitted to them.
    Solid red is generalisation: walkers that a classifier fitted to all others misses. The axis at
    the right gives the share of walkers (A18).

    Parameters
    ----------
    curves : mapping of str to curves
        Title of each panel, such as ``"structure"``, and its curves; in the order of the panels.
    n_walkers : int
        How many walkers there are, which is 100 %.
    n_columns : int, optional
        Panels side by side; 3 where there are more than 4.

    Returns
    -------
    Figure

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> curve = SimpleNamespace(n_components=[1, 2], separation=[9, 4], generalisation=[9, 7])
    >>> figure_curves({"structure": curve}, n_walkers=40).axes[0].get_title(loc="left")
    'structure'

    """
    if not curves:
        raise ValueError("There are no curves to draw; give one or more, by title.")
    n_columns = n_columns or (3 if len(curves) > 4 else len(curves))
    n_rows = math.ceil(len(curves) / n_columns)
    figure = new_figure(max(2.3 * n_columns, 3.2) + 0.3, 1.75 * n_rows + 0.45)
    grid = panels(figure, n_rows, n_columns, sharey=True)
    axes = [axis for row in grid for axis in row]
    for index, (axis, (title, curve)) in enumerate(zip(axes, curves.items(), strict=False)):
        _draw(axis, curve)
        _add_percent(axis, n_walkers, named=(index + 1) % n_columns == 0)
        head_line(axis, title, letter=chr(ord("a") + index) if len(curves) > 1 else "")
    for axis in axes[len(curves) :]:
        axis.set_visible(False)
    most = max(np.max([curve.separation, curve.generalisation]) for curve in curves.values())
    axes[0].set_ylim(0, 1.25 * max(most, 1))  # the words at the top stay clear of the curves
    axes[0].yaxis.set_major_locator(MaxNLocator(integer=True, nbins=5))
    figure.supxlabel("Number of components", fontsize=USUAL, color=INK)
    figure.supylabel("Misclassified walkers", fontsize=USUAL, color=INK)
    lines = axes[0].get_lines()[:2]
    figure.legend(handles=lines, loc="outside upper right", ncols=2, fontsize=SMALL, frameon=False)
    return figure


_CORNER = {"ha": "right", "va": "top", "fontsize": SMALL, "color": RED}


def _draw(axis: Axes, curve: Curves) -> None:
    """Both curves, and a ring where generalisation is best."""
    n = np.asarray(curve.n_components)
    missed = np.asarray(curve.generalisation)
    axis.plot(n, curve.separation, color=BLUE, lw=1.1, ls=(0, (4, 2)), label="separation")
    axis.plot(n, missed, color=RED, lw=1.1, label="generalisation (leave one out)")
    best = int(np.argmin(missed))
    axis.plot(n[best], missed[best], "o", mfc="white", mec=RED, mew=1.1, ms=4.5, clip_on=False)
    words = f"best: {missed[best]:g} at {n[best]}"
    axis.text(0.97, 0.97, words, transform=axis.transAxes, **_CORNER)
    axis.set_xlim(0, n[-1] + 0.5)
    axis.xaxis.set_major_locator(MaxNLocator(integer=True, nbins=5))


def _add_percent(axis: Axes, n_walkers: int, *, named: bool) -> None:
    """The share of walkers at the right of a panel (A18)."""

    def share(count: ArrayLike) -> np.ndarray:
        return 100 * np.asarray(count) / n_walkers

    def count(share: ArrayLike) -> np.ndarray:
        return np.asarray(share) * n_walkers / 100

    percent = axis.secondary_yaxis("right", functions=(share, count))
    percent.tick_params(
        labelsize=SMALL, width=0.6, length=2.5, color=INK, labelcolor=INK, labelright=named
    )
    percent.spines["right"].set_linewidth(0.6)
    if named:
        percent.set_ylabel("% of walkers", fontsize=USUAL, color=INK)
