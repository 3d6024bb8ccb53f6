"""Walkers as points of the space they span."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from eigenwalker.core.arguments import check_labels, check_numbers
from eigenwalker.plotting.style import CLASSES, INK, PALE, SMALL, note, panel


class Space(Protocol):
    """What scores and a direction are found with: a fitted `WalkerSpace`.

    See Also
    --------
    figure_space : Draws it.
    """

    average_walker_: np.ndarray
    explained_variance_ratio_: np.ndarray

    def transform(self, X: ArrayLike) -> np.ndarray:
        """Return the scores of walkers."""
        ...


def figure_space(
    space: Space,
    X: ArrayLike,
    trait: ArrayLike,
    *,
    trait_name: str,
    step: ArrayLike | None = None,
    poles: tuple[str, str] = ("", ""),
    components: tuple[int, int] = (1, 2),
) -> Figure:
    """Return walkers by their scores on two eigenwalkers, coloured by a trait.

    Parameters
    ----------
    space : WalkerSpace
        Fitted.
    X : array of shape (walker, feature)
        Walkers.
    trait : array of float or str of shape (walker,)
        Words are classes, of which there may be five; numbers get a scale.
    trait_name : str
        With its unit.
    step : array of shape (feature,), optional
        A direction, as `direction` returns it: drawn as a line through the average walker that
        crosses all walkers, however long the step.
    poles : tuple of str
        What the two ends of the line are called, the negative one first; so are classes coloured.
    components : tuple of int
        The eigenwalkers, counted from 1.

    Returns
    -------
    Figure

    See Also
    --------
    trait_axis : The axis that it shows.
    """
    X = check_numbers(X, "X", "walker", "feature")
    across = [component - 1 for component in components]
    scores = space.transform(X)[:, across]
    figure, axes = panel(3.9, 3.2)
    values = check_labels(trait, "trait")
    if len(values) != len(X):
        raise ValueError(f"X has {len(X)} walkers, and trait {len(values)} values.")
    if values.dtype.kind in "OUS":
        _draw_classes(axes, scores, values.astype(str), poles)
        figure.legend(
            loc="outside upper left", ncols=5, fontsize=SMALL, frameon=False, handletextpad=0.1
        )
    else:
        drawn = axes.scatter(*scores.T, c=values.astype(float), cmap="cividis", s=18, lw=0)
        scale = figure.colorbar(drawn, ax=axes, fraction=0.05, pad=0.02)
        scale.set_label(trait_name, fontsize=SMALL, color=INK)
        scale.ax.tick_params(labelsize=SMALL, width=0.6, length=2.5)
        scale.outline.set_visible(False)
    if step is not None:
        moved = space.transform(
            (space.average_walker_ + check_numbers(step, "step", "feature"))[None]
        )[0, across]
        _draw_direction(axes, moved, np.linalg.norm(scores, axis=1).max(), poles)
    axes.axhline(0, color=PALE, lw=0.6, zorder=0)
    axes.axvline(0, color=PALE, lw=0.6, zorder=0)
    axes.margins(0.1)
    axes.set_aspect("equal", adjustable="datalim")
    for axis, component in zip((axes.xaxis, axes.yaxis), components, strict=True):
        share = 100 * space.explained_variance_ratio_[component - 1]
        axis.set_label_text(f"Score on eigenwalker {component} ({share:.0f} % of variance)")
    return figure


_CLASS_LOOK = tuple(zip(CLASSES, "o^sDv", strict=False))


def _draw_classes(
    axes: Axes, scores: np.ndarray, values: np.ndarray, poles: tuple[str, str]
) -> None:
    classes = sorted(set(values))
    if set(poles) <= set(classes):
        classes = [*poles, *(name for name in classes if name not in poles)]
    if len(classes) > len(_CLASS_LOOK):
        raise ValueError(
            f"There are {len(classes)} classes {classes[:6]} ..., more than the "
            f"{len(_CLASS_LOOK)} that can be told apart; draw some of them."
        )
    for name, (color, shape) in zip(classes, _CLASS_LOOK, strict=False):
        axes.scatter(
            *scores[values == name].T, s=18, c=color, marker=shape, lw=0, alpha=0.85, label=name
        )


def _draw_direction(axes: Axes, moved: np.ndarray, length: float, poles: tuple[str, str]) -> None:
    """The line along which a trait changes, through the average walker."""
    way = moved / max(float(np.linalg.norm(moved)), 1e-12)
    ends = np.array([-length, length])[:, None] * way
    arrow = {"arrowstyle": "-|>", "lw": 1.0, "color": INK, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", xy=tuple(ends[1]), xytext=tuple(ends[0]), arrowprops=arrow, zorder=1)
    axes.plot(*1.15 * ends.T, lw=0)  # room for the words
    for words, end, outwards in zip(poles, ends, (-way, way), strict=True):
        ha = "center" if abs(outwards[0]) < 0.4 else "left" if outwards[0] > 0 else "right"
        note(axes, words, end, 5 * outwards, ha=ha, va="center")
