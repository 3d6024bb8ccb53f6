"""Tables of differences drawn: as a picture in order, and as a map (Pražák et al. 2010, fig. 4)."""

from __future__ import annotations

import os
from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from eigenwalker.plotting.style import CLASSES, GREY, SMALL, TEAL, colour_scale, note, panel

MAX_NAMED = 45
"""Walks up to which each is named; more names would overlap."""
_LONGEST = 15
_MARKS = "o^sDvPX>*"
MAX_CLASSES = len(CLASSES) * len(_MARKS)
"""Classes that have a colour and a mark of their own."""


def figure_difference_table(
    table: ArrayLike,
    names: Sequence[str],
    *,
    order: ArrayLike,
    clusters: ArrayLike | None = None,
    unit: str = "",
) -> Figure:
    """Return a table of differences (walk, walk) as a picture, dark where walks are alike.

    `order` has the number of the first walk, the second and so on; a dashed line stands where in
    that order another of `clusters` (walk,) begins.
    """
    values, order = np.asarray(table, dtype=float), np.asarray(order, dtype=int)
    side = float(np.clip(0.13 * len(order), 2.4, 6.2))
    figure, axes = panel(side + 2.1, side + 1.1)
    drawn = axes.imshow(values[np.ix_(order, order)], cmap="gray", interpolation="nearest")
    if clusters is not None:
        sorted_clusters = np.asarray(clusters)[order]
        for border in np.flatnonzero(np.diff(sorted_clusters)) + 0.5:
            axes.axhline(border, color=TEAL, lw=1.0, ls="--")
            axes.axvline(border, color=TEAL, lw=1.0, ls="--")
    if len(order) <= MAX_NAMED:
        short = short_names(names)
        labels = [short[walk] for walk in order]
        axes.set_xticks(range(len(order)), labels, rotation=90, parse_math=False)
        axes.set_yticks(range(len(order)), labels, parse_math=False)
    else:
        axes.set_xlabel("Walk, in order")
    colour_scale(figure, drawn, unit, ax=axes, fraction=0.046, pad=0.03)
    return figure


def figure_map_of_walks(
    places: ArrayLike, classes: Sequence[str], *, names: Sequence[str] | None = None
) -> Figure:
    """Return walks as points (walk, 2), near each other if they are alike, as `map_of_walks` gives.

    Their classes, up to `MAX_CLASSES`, have colours and marks; names are written beside them.
    """
    places, of = np.asarray(places, dtype=float), np.asarray(classes)
    figure, axes = panel(4.8, 3.9)
    for number, name in enumerate(np.unique(of)):
        color, mark = CLASSES[number % len(CLASSES)], _MARKS[number % len(_MARKS)]
        chosen = places[of == name]
        label = f"{name} ({len(chosen)})".replace("$", r"\$")  # words, not mathematics
        axes.scatter(*chosen.T, s=20, c=color, marker=mark, lw=0, alpha=0.85, label=label)
    for place, name in zip(places, short_names(names or []), strict=False):
        note(axes, name, place, (3, 3), fontsize=SMALL - 1.5, color=GREY)
    figure.legend(
        loc="outside upper left", ncols=4, fontsize=SMALL, frameon=False, handletextpad=0.1
    )
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.12)
    axes.set_xlabel("First dimension")
    axes.set_ylabel("Second dimension")
    return figure


def short_names(names: Sequence[str]) -> list[str]:
    """Return names that fit beside a picture, different ones as long as the names are different.

    Of long names, the words that all begin and end with are left out; what is still long becomes
    its beginning and its end, and gets a number where these are the same for two names.
    """
    names = [str(name) for name in names]
    stems = [name.rpartition(".")[0] or name for name in names]
    if max(map(len, stems), default=0) > _LONGEST:
        stems = _without_shared(stems)
    if len(set(stems)) < len(set(names)):
        stems = names
    for longest in range(_LONGEST, 2 * _LONGEST):
        short = [_elided(stem, longest) for stem in stems]
        if len(set(short)) == len(set(names)):
            return short
    return [f"{n}: {_elided(stem, _LONGEST)}" for n, stem in enumerate(stems, start=1)]


def _without_shared(names: list[str]) -> list[str]:
    """Return names without the words that all of them begin with, and end with."""
    if len(set(names)) < 2:
        return names
    start = _words_shared(names)
    end = _words_shared([name[start:][::-1] for name in names])
    middles = [name[start : len(name) - end] for name in names]
    return middles if all(middles) else names


def _words_shared(names: list[str]) -> int:
    """Return how many letters of whole words, with the separator after them, all begin with."""
    shared = os.path.commonprefix(names)  # noqa: RUF071 - letters are what is wanted
    return max(shared.rfind(mark) for mark in "/_- ") + 1


def _elided(name: str, longest: int) -> str:
    if len(name) <= longest:
        return name
    head = max(longest - 9, longest // 2 - 1)
    return f"{name[:head]}\N{HORIZONTAL ELLIPSIS}{name[head + 1 - longest :]}"
