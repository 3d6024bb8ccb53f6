"""The report on two walks: how different they are, where, and when one can pass into the other."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr

from eigenwalker.datasets import load_population
from eigenwalker.display.difference_maps import (
    MapPicture,
    figure_maps,
    figure_shares,
    figure_two_walks,
    picture_of_strides,
)
from eigenwalker.folds import Progress
from eigenwalker.metric.comparison import PLAIN, Comparison, by_metric, share_nearer
from eigenwalker.metric.loops import Loop, loop
from eigenwalker.metric.motion_maps import motion_map
from eigenwalker.metric.prepared import PreparedClip
from eigenwalker.metric.published import GroupMetric
from eigenwalker.metric.transitions import find_transitions
from eigenwalker.report.compared_walks import Walks, walks_of_population, without_rotations
from eigenwalker.report.content import Block, Figure, Items, Report, Section, Table, Text
from eigenwalker.report.page import write_report

SHOWN_S = 4.0
"""Seconds of either walk on a map: a few strides."""
MAP_HZ = 60.0
"""Frames a second of the maps that are drawn."""
MOST_TRANSITIONS = 8
_UNITS = {"positions": "mm", "velocities": "mm/s", "angles": "rad"}
CITE = (
    "Prazak, M., McDonnell, R., Kavan, L., & O'Sullivan, C. (2010). A perception based metric for "
    "comparing human locomotion. Computer Animation and Social Agents."
)
SCALE_IS_UNKNOWN = (
    "The published weights tell how joint groups compare. The unit in which the paper measured, "
    "and what its normalisation constant does, are not known, so that the number has no scale of "
    "its own and tells no share of observers: compare it with those of other pairs. "
    "PerceptualMetric fits a scale to observers' answers."
)


def reference_pairs(
    metrics: Sequence[str], *, mannequin: bool = True, progress: Progress | None = None
) -> pd.DataFrame:
    """Return the distances of all pairs of the built-in, simulated people by each metric.

    Something to hold a number against: how different people are from each other who all walk at
    their own pace. They are simulated, so it is no norm.

    Parameters
    ----------
    metrics : sequence of str
        Names of published metrics.
    mannequin : bool
        Whether they too are shown on the neutral mannequin.
    progress : callable, optional
        Called with the number of metrics that are done, and of all.

    Returns
    -------
    DataFrame of pairs by metrics

    """
    return by_metric(_simulated_people(mannequin).clips, metrics, progress=progress)


@cache
def _simulated_people(mannequin: bool) -> Walks:
    return walks_of_population(load_population(), mannequin=mannequin)


def write_two_walks(
    folder: str | Path, found: Comparison, names: tuple[str, str], reference: pd.DataFrame
) -> Path:
    """Write a report on two walks and return its page.

    Parameters
    ----------
    folder : path
        Made where it does not exist; holds ``report.html``.
    found : Comparison
        Of walks that repeat.
    names : tuple of str
        What they are called.
    reference : DataFrame of pairs by metrics
        Distances of other pairs, as `reference_pairs` gives them.

    Returns
    -------
    Path

    """
    sections = [
        Section("How different", _how_different(found, names, reference)),
        Section("Where", _where(found, names)),
        Section("Motion maps", [_map_of_loop_and_pair(found, names), _components(found, names)]),
        Section("From one walk into the other", _passing(found, names)),
        Section("How this was done", [Items(_method(found)), Text(CITE)]),
    ]
    title = f"{names[0]} and {names[1]}"
    return write_report(
        folder, Report(title, " ".join(in_words(found, names, reference)), sections)
    )


def in_words(
    found: Comparison, names: tuple[str, str], reference: pd.DataFrame | None = None
) -> list[str]:
    """Return what a comparison says, in sentences.

    Parameters
    ----------
    found : Comparison
    names : tuple of str
        What the walks are called.
    reference : DataFrame of pairs by metrics, optional
        Distances of other pairs.

    """
    name = found.metric.name if isinstance(found.metric, GroupMetric) else "distance"
    number = f"Difference ({name}): {found.distance:.4g}"
    if reference is not None and name in reference and not _by_rotations(found):
        nearer = share_nearer(found.distance, reference[name].to_numpy())
        number += f", more than between {nearer:.0%} of pairs of 40 simulated people".replace(
            "%", " %"
        )
    apart = found.groups.mean()
    said = [
        f"{number}.",
        f"Joints are {apart.positions_mm:.0f} mm apart in the mean of joint groups, their "
        f"velocities {apart.velocities_mm_s:.0f} mm/s, joint angles {apart.angles_deg:.1f} "
        "degrees.",
    ]
    if found.shares.isna().any():
        return [*said, "They do not differ in anything that the metric weighs."]
    most = found.shares.sort_values(ascending=False)
    parts = [f"{_plain(g)} {100 * share:.0f} %" for g, share in most.items() if share > 0.005]
    said.append(f"Of the difference are {', '.join(parts)}.")
    if found.left_out:
        groups = ", ".join(_plain(group) for group in found.left_out)
        said.append(f"The metric weighs {groups} too, which the walks do not show.")
    return said


def _by_rotations(found: Comparison) -> bool:
    """Whether the distance is of captured rotations, which the reference has not."""
    return found.metric.by == "angles" and "rotation" in found.a.clip.coords


def _plain(group: object) -> str:
    return str(group).replace("_", " ")


def _how_different(
    found: Comparison, names: tuple[str, str], reference: pd.DataFrame
) -> list[Block]:
    pair = without_rotations({"a": found.a, "b": found.b})
    ours = by_metric(pair, [str(metric) for metric in reference]).iloc[0]
    rows = [
        [metric, float(value), f"{100 * share_nearer(value, reference[metric].to_numpy()):.0f} %"]
        for metric, value in ours.items()
    ]
    table = Table(
        "The nine metrics of the paper's figure 5, and those of Lee and Kovar, each on a scale of "
        "its own; and the share of pairs of 40 simulated people that differ less. Joint angles are "
        "from positions here, as those people have no captured rotations",
        ["metric", "distance", "pairs that differ less"],
        rows,
    )
    return [_bodies(found, names), table, Text(SCALE_IS_UNKNOWN)]


def _bodies(found: Comparison, names: tuple[str, str]) -> Figure:
    first, second = found.registration.on_common_clock()
    markers = [str(name) for name in first.marker.values]
    return Figure(
        figure_two_walks(first.values, second.values, markers, names=names),
        "Both walks at corresponding moments of the stride, from the side and from the front; left "
        "limbs are paler.",
        f"Stick figures of {names[0]} in blue and {names[1]} in red over each other.",
    )


def _where(found: Comparison, names: tuple[str, str]) -> list[Block]:
    groups = found.groups
    rows = [
        [_plain(group), *map(float, row)]
        for group, row in zip(groups.index, groups.values, strict=True)
    ]
    table = Table(
        "How far each joint group is apart, in the mean of the stride. By place and velocity a "
        "bone is its upper joint: the forearm is the elbow",
        ["joint group", "place (mm)", "velocity (mm/s)", "joint angle (degrees)"],
        rows,
    )
    if found.shares.isna().any():
        return [table]
    shares = {str(group): float(share) for group, share in found.shares.items()}
    drawn = Figure(
        figure_shares(shares),
        "How much each joint group makes of the difference, as the metric weighs it.",
        "Bars: " + ", ".join(f"{_plain(g)} {100 * share:.0f} %" for g, share in shares.items()),
    )
    return [drawn, table]


def _map_of_loop_and_pair(found: Comparison, names: tuple[str, str]) -> Figure:
    """Figure 1: the self map with its period, the map of the pair with the blending line."""
    clip = found.a.clip
    looped = loop(clip)
    return Figure(
        figure_maps([_self_picture(clip, looped, names[0]), _pair_picture(found, names)]),
        "Dark where frames are alike. Left: the walk and itself; a period (blue) and the line at "
        "45 degrees along which two periods are blended into a loop (red). Right: two strides of "
        "either walk; a period (blue), and the moments that correspond (red).",
        f"Motion map of {names[0]} with itself, and with {names[1]}.",
    )


def _self_picture(clip: xr.DataArray, looped: Loop, name: str) -> MapPicture:
    start, period = looped.start_s, looped.period_s
    shown = _shown(clip, max(SHOWN_S, start - float(clip.time[0]) + 2 * period))
    cells = motion_map(shown)
    line = np.array([[start, start + period], [start + period, start + 2 * period]])
    return MapPicture(
        cells.values,
        cells.time_a.values,
        cells.time_b.values,
        "the first walk and itself",
        "mm",
        path=line,
        period=(start, start, period, period),
        names=(name, name),
    )


def _pair_picture(found: Comparison, names: tuple[str, str]) -> MapPicture:
    registered = found.registration
    a, b = (registered.map[clock].values for clock in ("time_a", "time_b"))
    title = "the first walk and the second"
    return picture_of_strides(registered.map.values, a, b, registered.times, title, names=names)


def _components(found: Comparison, names: tuple[str, str]) -> Figure:
    """Figure 6: the map of each component."""
    registered = found.registration
    pictures = []
    for by, metric in PLAIN.items():
        cells = motion_map(registered.first, _lain_over(found), metric=metric)
        values = np.rad2deg(cells.values) if by == "angles" else cells.values
        pictures.append(
            MapPicture(
                values,
                cells.time_a.values,
                cells.time_b.values,
                by,
                "deg" if by == "angles" else _UNITS[by],
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


def _passing(found: Comparison, names: tuple[str, str]) -> list[Block]:
    a, b = _shown(found.a.clip, SHOWN_S), _shown(found.b.clip, SHOWN_S)
    cells = motion_map(a, b, align=True, window_s=1 / 3)
    passes = find_transitions(a, b)
    best = passes.head(MOST_TRANSITIONS)
    marks = best[["time_a", "time_b"]].to_numpy() if len(best) else None
    picture = MapPicture(
        cells.values,
        cells.time_a.values,
        cells.time_b.values,
        "in the mean of a third of a second",
        "mm",
        marks=marks,
        names=names,
    )
    drawn = Figure(
        figure_maps([picture]),
        "Rings mark moments at which one walk can pass into the other and a viewer would hardly "
        "see it: minima of the map that are no more than what moves in a tenth of a second.",
        f"Motion map of {names[0]} and {names[1]}, with {len(best)} rings.",
    )
    if not len(best):
        return [drawn, Text("There is no moment at which one could pass into the other unseen.")]
    rows = [list(map(float, row)) for row in best.to_numpy()]
    table = Table(
        f"The best of {len(passes)} transitions in the seconds shown, and how the second walk is "
        "to be turned and moved",
        ["from first (s)", "into second (s)", "apart (mm)", "turn (deg)", "x (mm)", "y (mm)"],
        rows,
    )
    return [drawn, table]


def _shown(clip: xr.DataArray, length_s: float) -> xr.DataArray:
    """The first seconds of a clip at the rate of maps."""
    time = clip.time.values
    n_frames = int(min(time[-1] - time[0], length_s) * MAP_HZ)
    clock = time[0] + np.arange(n_frames) / MAP_HZ
    return clip.drop_vars("rotation", errors="ignore").interp(time=clock)


def _method(found: Comparison) -> list[str]:
    bodies = (
        "Both walks are shown on a neutral mannequin of fixed proportions, so that only movements "
        "differ."
        if found.a.clip.attrs.get("retargeted")
        else "Each walk has its own body, whose build counts too."
    )
    return [
        bodies,
        "The steady strides are brought in place, two periods blended into a loop, and the loops "
        "registered in phase, heading and place; a path through their motion map tells which "
        "moments correspond. The difference is the mean along that path.",
        f"Seam of the loops: {_seam(found.a):.0f} and {_seam(found.b):.0f} mm before blending.",
        "Joints that one of the walks lacks are left out.",
    ]


def _seam(prepared: PreparedClip) -> float:
    return loop(prepared.clip).seam_mm
