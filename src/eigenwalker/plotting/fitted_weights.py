"""Fitted weights with their intervals, and what they predict beside what was seen."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from eigenwalker.plotting.style import BLUE, GREY, INK, PALE, RED, SMALL, new_figure, panels


def figure_weights(
    names: Sequence[str], fits: Mapping[str, tuple[ArrayLike, ArrayLike, ArrayLike]]
) -> Figure:
    """Return the relative weight of each joint group with its interval, as figure 5 lists them.

    Parameters
    ----------
    names : sequence of str
        Joint groups.
    fits : mapping of str to three arrays of shape (group,)
        One or two fits by what they were fitted to: relative weights and the ends of their
        intervals.

    Returns
    -------
    Figure

    Examples
    --------
    >>> fits = {"shares": ([0.8, 0.2], [0.6, 0.0], [0.9, 0.4])}
    >>> figure = figure_weights(["forearm", "toe"], fits)
    >>> [label.get_text() for label in figure.axes[0].get_yticklabels()]
    ['forearm', 'toe']

    """
    several = len(fits) > 1
    figure = new_figure(4.0, 0.6 + (0.3 if several else 0.22) * len(names) + 0.2 * several)
    axes = panels(figure, 1, 1)[0][0]
    places = np.arange(len(names))
    least = 0.0
    for count, ((name, (weights, low, high)), color) in enumerate(
        zip(fits.items(), (BLUE, RED), strict=False)
    ):
        at = places + (count - (len(fits) - 1) / 2) * 0.3
        axes.hlines(at, low, high, color=color, lw=1.6)
        axes.plot(weights, at, "os"[count], color=color, ms=4.5, label=name)
        least = min(least, np.min(low))
    axes.axvline(0, color=PALE, lw=0.6, zorder=0)
    axes.set_yticks(places, [name.replace("_", " ") for name in names])
    axes.tick_params(axis="y", length=0)
    axes.invert_yaxis()
    axes.set_xlim(left=least - 0.02)
    axes.set_xlabel("Relative weight, with 95 % interval")
    if several:
        figure.legend(loc="outside upper center", ncols=2, fontsize=SMALL, frameon=False)
    return figure


def figure_predictions(observed: ArrayLike, predicted: ArrayLike) -> Figure:
    """Return predicted over perceived differences, a point a pair.

    Parameters
    ----------
    observed, predicted : array of shape (pair,)
        Shares of times that a pair was not chosen, 0 to 1.

    Returns
    -------
    Figure

    Examples
    --------
    >>> figure_predictions([0.7, 0.9], [0.75, 0.85]).axes[0].get_ylabel()
    'Predicted difference'

    """
    observed, predicted = np.asarray(observed, dtype=float), np.asarray(predicted, dtype=float)
    figure = new_figure(3.2, 3.2)
    axes = panels(figure, 1, 1)[0][0]
    ends = [min(observed.min(), predicted.min()), max(observed.max(), predicted.max())]
    axes.plot(ends, ends, color=GREY, lw=0.8, ls="--", zorder=0)
    axes.plot(observed, predicted, "o", ms=3, mfc=BLUE, mec="none", alpha=0.6)
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel("Perceived difference", color=INK)
    axes.set_ylabel("Predicted difference", color=INK)
    return figure
