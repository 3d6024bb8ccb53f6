"""Fitted weights with their intervals, and what they predict beside what was seen."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from eigenwalker.display.style import BLUE, GREY, INK, PALE, new_figure, panels


def figure_weights(
    names: Sequence[str], weights: ArrayLike, low: ArrayLike, high: ArrayLike
) -> Figure:
    """Return the relative weight of each joint group with its interval, as figure 5 lists them.

    Parameters
    ----------
    names : sequence of str
        Joint groups.
    weights, low, high : array of shape (group,)
        Relative weights and the ends of their intervals.

    Returns
    -------
    Figure

    Examples
    --------
    >>> figure = figure_weights(["forearm", "toe"], [0.8, 0.2], [0.6, 0.0], [0.9, 0.4])
    >>> [label.get_text() for label in figure.axes[0].get_yticklabels()]
    ['forearm', 'toe']

    """
    weights, low, high = (np.asarray(each, dtype=float) for each in (weights, low, high))
    figure = new_figure(4.0, 0.6 + 0.22 * len(names))
    axes = panels(figure, 1, 1)[0][0]
    places = np.arange(len(names))
    axes.hlines(places, low, high, color=BLUE, lw=1.6)
    axes.plot(weights, places, "o", color=BLUE, ms=4.5)
    axes.axvline(0, color=PALE, lw=0.6, zorder=0)
    axes.set_yticks(places, [name.replace("_", " ") for name in names])
    axes.tick_params(axis="y", length=0)
    axes.invert_yaxis()
    axes.set_xlim(left=min(0.0, low.min()) - 0.02)
    axes.set_xlabel("Relative weight, with 95 % interval")
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
