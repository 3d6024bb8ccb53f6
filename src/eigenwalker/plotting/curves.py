"""How well classifiers and regressions do with more and more components (Troje 2002, fig. 4)."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from typing import Any, Protocol

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import ArrayLike

from eigenwalker.plotting.style import (
    INK,
    PALE,
    PURPLE,
    SMALL,
    TEAL,
    USUAL,
    head_line,
    new_figure,
    panels,
)


class Curves(Protocol):
    """Misclassified walkers for 1, 2, ... components, as `jackknife_curves` returns them.

    See Also
    --------
    figure_curves : Draws them.
    """

    @property
    def n_components(self) -> np.ndarray: ...  # noqa: D102 - the class tells
    @property
    def separation(self) -> np.ndarray: ...  # noqa: D102 - the class tells
    @property
    def generalisation(self) -> np.ndarray: ...  # noqa: D102 - the class tells


class TraitCurves(Protocol):
    """Share of a trait's variance explained by 1, 2, ... components, as of `regression_curves`.

    See Also
    --------
    figure_regression_curves : Draws them.
    """

    @property
    def n_components(self) -> np.ndarray: ...  # noqa: D102 - the class tells
    @property
    def trained_r2(self) -> np.ndarray: ...  # noqa: D102 - the class tells
    @property
    def r2(self) -> np.ndarray: ...  # noqa: D102 - the class tells


def figure_curves(
    curves: Mapping[str, Curves], *, n_walkers: int, n_columns: int | None = None
) -> Figure:
    """Return misclassified walkers over the number of components, one panel an input.

    Dashed teal is separation: walkers misclassified by a classifier that was fitted to them too.
    Solid purple is generalisation: walkers misclassified by one that was fitted to all others. The
    axis at the right gives the share of walkers.

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

    See Also
    --------
    figure_regression_curves : The same for a number.

    References
    ----------
    Troje (2002), fig. 4.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> curve = SimpleNamespace(n_components=[1, 2], separation=[9, 4], generalisation=[9, 7])
    >>> figure_curves({"structure": curve}, n_walkers=40).axes[0].get_title(loc="left")
    'structure'
    """
    figure, axes, n_columns = _grid(curves, n_columns)
    for index, (axis, curve) in enumerate(zip(axes, curves.values(), strict=True), start=1):
        misclassified = np.asarray(curve.generalisation)
        _draw(axis, curve.n_components, curve.separation, misclassified)
        best, n = int(np.argmin(misclassified)), curve.n_components
        axis.plot(n[best], misclassified[best], **_RING)
        axis.annotate(f"best: {misclassified[best]:g} at {n[best]}", (0.97, 0.97), **_CORNER)
        _add_percent(axis, n_walkers, named=index % n_columns == 0)
    most = max(np.max([curve.separation, curve.generalisation]) for curve in curves.values())
    axes[0].set_ylim(0, 1.25 * max(most, 1))  # the words at the top stay clear of the curves
    axes[0].yaxis.set_major_locator(MaxNLocator(integer=True, nbins=5))
    _label_axes(figure, "Misclassified walkers", axes[0])
    return figure


def figure_regression_curves(
    curves: Mapping[str, TraitCurves], *, n_columns: int | None = None
) -> Figure:
    """Return the share of a trait's variance explained over the number of components.

    Panels as in `figure_curves`. Dashed teal is separation: R2 of the walkers that a regression was
    fitted to. Solid purple is generalisation: R2 of walkers left out. Below the thin line at 0 the
    mean of all walkers predicts better; a curve that falls far below leaves its panel, and with it
    the ring at its best.

    Parameters
    ----------
    curves : mapping of str to curves
        Title of each panel, such as ``"structure"``, and its curves; in the order of the panels.
    n_columns : int, optional
        Panels side by side; 3 where there are more than 4.

    Returns
    -------
    Figure

    See Also
    --------
    figure_curves : The same for two classes.

    References
    ----------
    Troje (2002, WDP): regression of continuous traits.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> curve = SimpleNamespace(n_components=[1, 2], trained_r2=[0.3, 0.6], r2=[0.2, 0.1])
    >>> figure_regression_curves({"structure": curve}).axes[0].get_title(loc="left")
    'structure'
    """
    figure, axes, _ = _grid(curves, n_columns)
    for axis, curve in zip(axes, curves.values(), strict=True):
        r2 = np.asarray(curve.r2)
        _draw(axis, curve.n_components, curve.trained_r2, r2)
        best, n = int(np.argmax(r2)), curve.n_components
        if r2[best] > _LOWEST_R2:
            axis.plot(n[best], r2[best], **_RING)
        words = f"best: {r2[best]:z.2f} at {n[best]}".replace("-", "\N{MINUS SIGN}")
        axis.annotate(words, (0.97, 0.97), **_CORNER)
        axis.axhline(0, color=PALE, lw=0.8, zorder=0)
    axes[0].set_ylim(_LOWEST_R2, 1.5)
    axes[0].set_yticks([-0.5, 0, 0.5, 1])
    _label_axes(figure, "Share of variance told, $R^2$", axes[0])
    return figure


_LOWEST_R2 = -0.6
"""A regression that overshoots falls without limit; drawing all of it would flatten the rest."""
_CORNER: dict[str, Any] = {
    "xycoords": "axes fraction", "ha": "right", "va": "top", "fontsize": SMALL, "color": PURPLE
}  # fmt: skip
_RING: dict[str, Any] = {
    "marker": "o", "mfc": "white", "mec": PURPLE, "mew": 1.1, "ms": 4.5, "clip_on": False
}  # fmt: skip
"""Where generalisation is best."""


def _grid(titles: Collection[str], n_columns: int | None) -> tuple[Figure, list[Axes], int]:
    """A panel for each title, and how many stand side by side."""
    if not titles:
        raise ValueError("There are no curves to draw; give one or more, by title.")
    n_columns = n_columns or (3 if len(titles) > 4 else len(titles))
    n_rows = math.ceil(len(titles) / n_columns)
    figure = new_figure(max(2.3 * n_columns, 3.2) + 0.3, 1.75 * n_rows + 0.45)
    axes = [axis for row in panels(figure, n_rows, n_columns, sharey=True) for axis in row]
    for index, (axis, title) in enumerate(zip(axes, titles, strict=False)):
        head_line(axis, title, letter=chr(ord("a") + index) if len(titles) > 1 else "")
    for axis in axes[len(titles) :]:
        axis.set_visible(False)
    return figure, axes[: len(titles)], n_columns


def _draw(axis: Axes, n: np.ndarray, separation: np.ndarray, generalisation: np.ndarray) -> None:
    """Both curves over the number of components."""
    axis.plot(n, separation, color=TEAL, lw=1.1, ls=(0, (4, 2)), label="separation")
    axis.plot(n, generalisation, color=PURPLE, lw=1.1, label="generalisation (leave one out)")
    axis.set_xlim(0, n[-1] + 0.5)
    axis.xaxis.set_major_locator(MaxNLocator(integer=True, nbins=5))


def _label_axes(figure: Figure, height: str, axis: Axes) -> None:
    """Say what the axes are, and, by those of a panel, what the lines are."""
    figure.supxlabel("Number of components", fontsize=USUAL, color=INK)
    figure.supylabel(height, fontsize=USUAL, color=INK)
    lines = axis.get_lines()[:2]
    figure.legend(handles=lines, loc="outside upper right", ncols=2, fontsize=SMALL, frameon=False)


def _add_percent(axis: Axes, n_walkers: int, *, named: bool) -> None:
    """The share of walkers at the right of a panel."""

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
