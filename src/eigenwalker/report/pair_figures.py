"""Motion maps of two walks, and the moments at which one can pass into the other."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from eigenwalker.metric.clip_distances import PLAIN, Comparison
from eigenwalker.metric.loops import loop
from eigenwalker.metric.motion_maps import motion_map
from eigenwalker.metric.transitions import find_transitions
from eigenwalker.plotting.difference_maps import MapPicture, figure_maps, picture_of_strides
from eigenwalker.report.blocks import Block, Figure, Table, Text
from eigenwalker.report.words import TABLES, WORDS, figure

SHOWN_S = 4.0
"""Seconds of either walk on a map: a few strides."""
MAP_HZ = 60.0
"""Frames a second of the maps that are drawn."""
WINDOW_S = 1 / 3
"""Seconds over which the map is averaged in which transitions are searched for."""
MAX_TRANSITIONS = 8
_UNITS = {"positions": "mm", "velocities": "mm/s", "angles": "deg"}


def loop_and_pair_maps(comparison: Comparison, names: tuple[str, str]) -> Figure:
    """Return figure 1 of the paper: the self map with its period, the pair map with its path."""
    clip, registration = comparison.a.clip, comparison.registration
    looped = loop(clip)
    start, period = looped.start_s, looped.period_s
    shown = _resample(clip, max(SHOWN_S, start - float(clip.time[0]) + 2 * period))
    blended, marks = "the capture holds one stride, which is closed into a loop", {}
    if looped.n_periods > 1:
        blended = (
            "a period (teal) and the line at 45 degrees along which two periods are blended into a "
            "loop (purple)"
        )
        marks = {
            "path": np.array([[start, start + period], [start + period, start + 2 * period]]),
            "period": (start, start, period, period),
        }
    self_map = _picture(
        motion_map(shown), "the first walk and itself", "mm", (names[0], names[0]), **marks
    )
    pair_map = picture_of_strides(
        registration.map.values,
        registration.map.time_a.values,
        registration.map.time_b.values,
        registration.times,
        "the first walk and the second",
        names=names,
    )
    return figure(figure_maps([self_map, pair_map]), "two maps", names=names, blended=blended)


def component_maps(comparison: Comparison, names: tuple[str, str]) -> Figure:
    """Return figure 6 of the paper: the map of each component."""
    registration = comparison.registration
    second = _aligned(comparison)
    pictures = []
    for by, metric in PLAIN.items():
        cells = motion_map(
            registration.first, second, metric=metric, periodic=registration.periodic
        )
        if by == "angles":
            cells = cells.copy(data=np.rad2deg(cells.values))
        pictures.append(_picture(cells, by, _UNITS[by], names))
    return figure(figure_maps(pictures, n_columns=3), "component maps")


def transitions(comparison: Comparison, names: tuple[str, str]) -> list[Block]:
    """Return the moments at which one walk could pass into the other, on a map and as a table."""
    a, b = (_resample(each.clip, SHOWN_S) for each in (comparison.a, comparison.b))
    found = find_transitions(a, b)
    best = found.head(MAX_TRANSITIONS)
    if not len(best):
        sentence = "There is no moment at which one could pass into the other unseen."
        return [_transitions_figure(a, b, best, "no transitions", names), Text(sentence)]
    which = f"the best {len(best)} of {len(found)} transitions"
    if len(best) == len(found):
        which = "one transition" if len(found) == 1 else f"all {len(found)} transitions"
    terms = WORDS["terms"]["transitions"]
    table = Table(
        TABLES["transitions"].format(which=which),
        ["from first (s)", "into second (s)", "apart (mm)", "turn (deg)", "x (mm)", "y (mm)"],
        [list(map(float, row)) for row in best.to_numpy()],
    )
    return [_transitions_figure(a, b, best, "transitions", names, which), table, Text(terms)]


def _transitions_figure(
    a: xr.DataArray,
    b: xr.DataArray,
    best: pd.DataFrame,
    name: str,
    names: tuple[str, str],
    which: str = "",
) -> Figure:
    picture = _picture(
        motion_map(a, b, align=True, window_s=WINDOW_S),
        f"in the mean of {WINDOW_S:.2g} seconds",
        "mm",
        names,
        marks=best[["time_a", "time_b"]].to_numpy() if len(best) else None,
    )
    return figure(figure_maps([picture]), name, names=names, which=which, n_rings=len(best))


def _picture(
    cells: xr.DataArray, title: str, unit: str, names: tuple[str, str], **marks: Any
) -> MapPicture:
    a, b = cells.time_a.values, cells.time_b.values
    return MapPicture(cells.values, a, b, title, unit, names=names, **marks)


def _aligned(comparison: Comparison) -> xr.DataArray:
    """Return the second walk turned and moved as it was registered on the whole."""
    registration = comparison.registration
    whole = registration.alignment.angles[:1], registration.alignment.shifts[:1]
    turned = type(registration.alignment)(*whole).apply(registration.second.values)
    return registration.second.copy(data=turned)


def _resample(clip: xr.DataArray, length_s: float) -> xr.DataArray:
    """Return the first seconds of a clip at the rate of maps."""
    time = clip.time.values
    n_frames = int(min(time[-1] - time[0], length_s) * MAP_HZ)
    clock = time[0] + np.arange(n_frames) / MAP_HZ
    return clip.drop_vars("rotation", errors="ignore").interp(time=clock)
