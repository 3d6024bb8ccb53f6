"""Shares of a difference, fitted weights, and predicted beside perceived differences."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from eigenwalker.plotting.style import GREY, INK, PALE, PURPLE, SMALL, TEAL, panel


def figure_weights(
    names: Sequence[str], fits: Mapping[str, tuple[ArrayLike, ArrayLike, ArrayLike]]
) -> Figure:
    """Return the relative weight of each joint group with its interval.

    Of one or two fits by their names: relative weights and the ends of their intervals, (group,),
    as fig. 5 of Pražák et al. (2010) lists them.
    """
    several = len(fits) > 1
    figure, axes = panel(4.0, 0.6 + (0.3 if several else 0.22) * len(names) + 0.2 * several)
    places = np.arange(len(names))
    least = 0.0
    for count, ((name, (weights, low, high)), color) in enumerate(
        zip(fits.items(), (TEAL, PURPLE), strict=False)
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
    """Return predicted over perceived differences, 0 to 1, a point a pair."""
    observed, predicted = np.asarray(observed, dtype=float), np.asarray(predicted, dtype=float)
    figure, axes = panel(3.2, 3.2)
    ends = [min(observed.min(), predicted.min()), max(observed.max(), predicted.max())]
    axes.plot(ends, ends, color=GREY, lw=0.8, ls="--", zorder=0)
    axes.plot(observed, predicted, "o", ms=3, mfc=TEAL, mec="none", alpha=0.6)
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel("Perceived difference", color=INK)
    axes.set_ylabel("Predicted difference", color=INK)
    return figure


def figure_shares(shares: Mapping[str, float]) -> Figure:
    """Return bars of the share of a difference that each part has, 0 to 1, the largest first."""
    ordered = dict(sorted(shares.items(), key=lambda item: -item[1]))
    figure, axes = panel(3.6, 0.6 + 0.2 * len(ordered))
    places = np.arange(len(ordered))
    percent = [100 * share for share in ordered.values()]
    axes.barh(places, percent, height=0.65, color=TEAL)
    for place, value in enumerate(percent):
        axes.text(value, place, f" {value:.0f} %", va="center", fontsize=SMALL, color=INK)
    axes.set_yticks(places, [name.replace("_", " ") for name in ordered])
    axes.invert_yaxis()
    axes.set_xlim(0, 1.15 * max(percent))
    axes.set_xlabel("Share of the difference (%)")
    axes.spines["left"].set_color(PALE)
    axes.tick_params(axis="y", length=0)
    return figure
