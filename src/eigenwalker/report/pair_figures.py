"""Motion maps of two walks, and the moments at which one can pass into the other."""

from __future__ import annotations

import numpy as np
import pandas as pd
import xarray as xr

from eigenwalker.metric.clips import Loop
from eigenwalker.metric.comparison import PLAIN, Comparison
from eigenwalker.metric.loops import loop
from eigenwalker.metric.motion_maps import motion_map
from eigenwalker.metric.transitions import find_transitions
from eigenwalker.plotting.difference_maps import MapPicture, figure_maps, picture_of_strides
from eigenwalker.report.blocks import Block, Figure, Table, Text

SHOWN_S = 4.0
"""Seconds of either walk on a map: a few strides."""
MAP_HZ = 60.0
"""Frames a second of the maps that are drawn."""
WINDOW_S = 1 / 3
"""Seconds over which a map is averaged on which transitions are sought."""
MOST_TRANSITIONS = 8
_UNITS = {"positions": "mm", "velocities": "mm/s", "angles": "deg"}


def map_of_loop_and_pair(found: Comparison, names: tuple[str, str]) -> Figure:
    """Return figure 1: the self map with its period, the map of the pair with its path."""
    clip = found.a.clip
    looped = loop(clip)
    blended = (
        "a period (blue) and the line at 45 degrees along which two periods are blended into a "
        "loop (red)"
        if looped.n_periods > 1
        else "the capture holds one stride, which is closed into a loop"
    )
    return Figure(
        figure_maps([_self_picture(clip, looped, names[0]), _pair_picture(found, names)]),
        f"Dark where frames are alike. Left: the walk and itself; {blended}. Right: two strides of "
        "either walk; a period (blue), and the moments that correspond (red).",
        f"Motion map of {names[0]} with itself, and with {names[1]}.",
    )


def _self_picture(clip: xr.DataArray, looped: Loop, name: str) -> MapPicture:
    start, period = looped.start_s, looped.period_s
    shown = _shown(clip, max(SHOWN_S, start - float(clip.time[0]) + 2 * period))
    cells = motion_map(shown)
    line = np.array([[start, start + period], [start + period, start + 2 * period]])
    two = looped.n_periods > 1
    return MapPicture(
        cells.values,
        cells.time_a.values,
        cells.time_b.values,
        "the first walk and itself",
        "mm",
        path=line if two else None,
        period=(start, start, period, period) if two else None,
        names=(name, name),
    )


def _pair_picture(found: Comparison, names: tuple[str, str]) -> MapPicture:
    registered = found.registration
    a, b = (registered.map[clock].values for clock in ("time_a", "time_b"))
    title = "the first walk and the second"
    return picture_of_strides(registered.map.values, a, b, registered.times, title, names=names)


def maps_of_components(found: Comparison, names: tuple[str, str]) -> Figure:
    """Return figure 6: the map of each component."""
    registered = found.registration
    pictures = []
    for by, metric in PLAIN.items():
        cells = motion_map(
            registered.first, _lain_over(found), metric=metric, periodic=registered.periodic
        )
        values = np.rad2deg(cells.values) if by == "angles" else cells.values
        pictures.append(
            MapPicture(
                values,
                cells.time_a.values,
                cells.time_b.values,
                by,
                _UNITS[by],
                names=names,
            )
        )
    return Figure(
        figure_maps(pictures, n_columns=3),
        "A stride of either walk, compared by positions, by velocities and by joint angles: each "
        "has a pattern of its own.",
        "Three motion maps: positions, velocities, angles.",
    )


def _lain_over(found: Comparison) -> xr.DataArray:
    """The second walk turned and moved as it was registered on the whole."""
    registered = found.registration
    whole = registered.alignment.angles[:1], registered.alignment.shifts[:1]
    turned = type(registered.alignment)(*whole).apply(registered.second.values)
    return registered.second.copy(data=turned)


def passing(found: Comparison, names: tuple[str, str]) -> list[Block]:
    """Return the moments at which one walk could pass into the other, on a map and as a table."""
    a, b = _shown(found.a.clip, SHOWN_S), _shown(found.b.clip, SHOWN_S)
    passes = find_transitions(a, b)
    best = passes.head(MOST_TRANSITIONS)
    drawn = _map_of_passes(a, b, best, len(passes), names)
    if not len(best):
        return [drawn, Text("There is no moment at which one could pass into the other unseen.")]
    rows = [list(map(float, row)) for row in best.to_numpy()]
    table = Table(
        f"In the seconds shown: {_of_all(len(best), len(passes))}, and how the second walk is to "
        "be turned and moved",
        ["from first (s)", "into second (s)", "apart (mm)", "turn (deg)", "x (mm)", "y (mm)"],
        rows,
    )
    return [drawn, table]


def _of_all(n_drawn: int, n_found: int) -> str:
    if n_drawn < n_found:
        return f"the best {n_drawn} of {n_found} transitions"
    return "one transition" if n_found == 1 else f"all {n_found} transitions"


def _map_of_passes(
    a: xr.DataArray, b: xr.DataArray, best: pd.DataFrame, n_found: int, names: tuple[str, str]
) -> Figure:
    cells = motion_map(a, b, align=True, window_s=WINDOW_S)
    picture = MapPicture(
        cells.values,
        cells.time_a.values,
        cells.time_b.values,
        f"in the mean of {WINDOW_S:.2g} seconds",
        "mm",
        marks=best[["time_a", "time_b"]].to_numpy() if len(best) else None,
        names=names,
    )
    rings = (
        "Rings mark moments at which one walk can pass into the other and a viewer would hardly "
        "see it: minima of the map that are no more than what moves in a tenth of a second. "
        f"Drawn: {_of_all(len(best), n_found)}."
        if len(best)
        else "Dark where one walk is like the other on the whole."
    )
    alt = f"Motion map of {names[0]} and {names[1]}, with {len(best)} rings."
    return Figure(figure_maps([picture]), rings, alt)


def _shown(clip: xr.DataArray, length_s: float) -> xr.DataArray:
    """The first seconds of a clip at the rate of maps."""
    time = clip.time.values
    n_frames = int(min(time[-1] - time[0], length_s) * MAP_HZ)
    clock = time[0] + np.arange(n_frames) / MAP_HZ
    return clip.drop_vars("rotation", errors="ignore").interp(time=clock)
