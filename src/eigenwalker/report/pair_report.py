"""The report on two walks: how different they are, where, and when one can pass into the other."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from eigenwalker.metric.clip_distances import clip_distance
from eigenwalker.metric.clips import Loop
from eigenwalker.metric.comparison import Comparison
from eigenwalker.metric.frame_metrics import GroupMetric
from eigenwalker.metric.loops import loop
from eigenwalker.plotting.difference_maps import figure_two_walks
from eigenwalker.plotting.fitted_weights import figure_shares
from eigenwalker.report.blocks import Block, Figure, Items, Report, Section, Table, Text
from eigenwalker.report.html_report import write_report
from eigenwalker.report.pair_figures import map_of_loop_and_pair, maps_of_components, passing
from eigenwalker.study.reference_pairs import SimulatedPairs, own_spread
from eigenwalker.study.walks import remarks_on

CITE = (
    "Pražák, M., McDonnell, R., Kavan, L., & O'Sullivan, C. (2010). A perception based metric for "
    "comparing human locomotion. Computer Animation and Social Agents."
)
SCALE_IS_UNKNOWN = (
    "The published weights tell how joint groups compare. The unit in which the paper measured, "
    "and what its normalisation constant does, are not known, so that the number has no scale of "
    "its own and tells no share of observers: compare it with those of other pairs. "
    "PerceptualMetric fits a scale to observers' answers."
)


WHERE_POINTS_SIT = (
    "Captures of different marker sets also differ by where their points sit on the body, joint "
    "angles most of all: compare like with like where you can."
)
NO_PERCENTAGE_OF_ANGLES = (
    "Joint angles get no percentage: they depend on where the points of a capture sit, in the "
    "joints, as those of simulated people, or on the skin."
)


def write_two_walks(
    folder: str | Path, found: Comparison, names: tuple[str, str], reference: SimulatedPairs
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
    reference : SimulatedPairs
        By all metrics that the report is to tell.

    Returns
    -------
    Path

    """
    sections = [
        Section("How different", _how_different(found, names, reference)),
        Section("Where", _where(found)),
        Section(
            "Motion maps", [map_of_loop_and_pair(found, names), maps_of_components(found, names)]
        ),
        Section("From one walk into the other", passing(found, names)),
        Section("How this was done", [Items(_method(found)), Text(CITE)]),
    ]
    lead = " ".join([*in_words(found, names, reference), *remarks_on_both(found, names)])
    return write_report(Report(f"{names[0]} and {names[1]}", lead, sections), folder)


def in_words(
    found: Comparison, names: tuple[str, str], reference: SimulatedPairs | None = None
) -> list[str]:
    """Return what a comparison says, in sentences.

    Parameters
    ----------
    found : Comparison
    names : tuple of str
        What the walks are called.
    reference : SimulatedPairs, optional
        Pairs to hold the number against.

    """
    apart = found.groups.mean()
    said = [
        f"{_number(found, reference)}.",
        *_spreads(found, names),
        f"Joints are {apart.positions_mm:.0f} mm apart in the mean of joint groups, their "
        f"velocities {apart.velocities_mm_s:.0f} mm/s, joint angles {apart.angles_deg:.1f} "
        "degrees.",
    ]
    if found.shares.isna().any():
        return [*said, "They do not differ in anything that the metric weighs."]
    most = found.shares.sort_values(ascending=False)
    parts = [f"{in_plain(g)} {100 * share:.0f} %" for g, share in most.items() if share > 0.005]
    said.append(f"Of the difference are {', '.join(parts)}.")
    if found.missing_groups:
        groups = ", ".join(in_plain(group) for group in found.missing_groups)
        said.append(f"The metric weighs {groups} too, which the walks do not show.")
    return said


def remarks_on_both(found: Comparison, names: tuple[str, str]) -> list[str]:
    """Return what is to be known of the two captures, in sentences: flags, and strange bodies."""
    remarks = [remarks_on(each.clip) for each in (found.a, found.b)]
    return [
        f"Mind {name}: {said.rstrip('.')}."
        for name, said in dict(zip(names, remarks, strict=True)).items()
        if said
    ]


def in_plain(group: object) -> str:
    """Return a joint group in words."""
    return str(group).replace("_", " ")


def _number(found: Comparison, reference: SimulatedPairs | None) -> str:
    name = found.metric.name if isinstance(found.metric, GroupMetric) else "distance"
    number = f"Difference ({name}): {found.distance:.4g}"
    placed = None if reference is None else reference.place(found.a, found.b, name)
    if reference is None or placed is None:
        return number
    by_joints, nearer = placed
    if abs(by_joints - found.distance) > 0.005 * found.distance:
        number += f"; without hands and feet {by_joints:.4g}"
    return (
        f"{number}, more than between {100 * nearer:.0f} % of pairs of {reference.n_people} "
        "simulated people"
    )


def _spreads(found: Comparison, names: tuple[str, str]) -> list[str]:
    """Return how different each walk is from itself."""
    if not isinstance(found.metric, GroupMetric) or not found.distance > 0:
        return []
    spreads = [own_spread(each, found.metric) for each in (found.a, found.b)]
    told = [
        f"{spread:.3g} ({name})"
        for name, spread in zip(names, spreads, strict=True)
        if np.isfinite(spread)
    ]
    if not told:
        return ["Neither has strides enough to tell how much it differs from itself."]
    known = f"First and last strides of one capture differ by {' and '.join(told)}"
    if found.distance <= np.nanmax(spreads):
        return [f"{known}, which is no less: these two cannot be told apart."]
    return [f"{known}."]


def _how_different(
    found: Comparison, names: tuple[str, str], reference: SimulatedPairs
) -> list[Block]:
    rows, differ = [], False
    for name, metric in reference.metrics.items():
        distance = clip_distance(found.a, found.b, metric=metric)
        placed = reference.place(found.a, found.b, name)
        by_joints, share = (None, None) if placed is None else placed
        differ |= by_joints is not None and abs(by_joints - distance) > 0.005 * distance
        rows.append([name, distance, by_joints, None if share is None else f"{100 * share:.0f} %"])
    columns = ["metric", "distance", "by joints alone", "pairs that differ less"]
    if not differ:
        columns.pop(2)
        rows = [[row[0], row[1], row[3]] for row in rows]
    alone = " by joints alone, without hands and feet, which those have not" if differ else ""
    table = Table(
        "The nine metrics of the paper's figure 5, and those of Lee and Kovar, each on a scale of "
        f"its own; and the share of pairs of {reference.n_people} simulated people that differ "
        f"less{alone}",
        columns,
        rows,
    )
    return [_bodies(found, names), table, Text(NO_PERCENTAGE_OF_ANGLES), Text(SCALE_IS_UNKNOWN)]


def _bodies(found: Comparison, names: tuple[str, str]) -> Figure:
    first, second = found.registration.on_common_clock()
    markers = [str(name) for name in first.marker.values]
    return Figure(
        figure_two_walks(first.values, second.values, markers, names=names),
        "Both walks at corresponding moments of the stride, from the side and from the front; left "
        "limbs are paler.",
        f"Stick figures of {names[0]} in blue and {names[1]} in red over each other.",
    )


def _where(found: Comparison) -> list[Block]:
    groups = found.groups
    rows = [
        [in_plain(group), *map(float, row)]
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
        "Bars: " + ", ".join(f"{in_plain(g)} {100 * share:.0f} %" for g, share in shares.items()),
    )
    return [drawn, table]


def _method(found: Comparison) -> list[str]:
    bodies = (
        "Both walks are shown on a neutral mannequin of fixed proportions, so that only movements "
        "differ."
        if found.a.clip.attrs.get("retargeted")
        else "Each walk has its own body, whose build counts too."
    )
    loops = [loop(each.clip) for each in (found.a, found.b)]
    seams = " and ".join(f"{each.seam_mm:.0f}" for each in loops)
    said = [
        bodies,
        f"The steady strides are brought in place, {_looped(loops)}, and the loops registered in "
        "phase, heading and place; a path through their motion map tells which moments "
        "correspond. The difference is the mean along that path.",
        f"Seam of the loops: {seams} mm before they were closed.",
        "Angles are of captured rotations, which both captures have."
        if all("rotation" in each.clip.coords for each in (found.a, found.b))
        else "Angles are of positions.",
    ]
    markers = [set(map(str, each.clip.marker.values)) for each in (found.a, found.b)]
    if lacking := sorted(markers[0] ^ markers[1]):
        points = ", ".join(in_plain(name) for name in lacking)
        said.append(f"Left out, as one of the walks lacks them: {points}.")
    return [*said, WHERE_POINTS_SIT]


def _looped(loops: list[Loop]) -> str:
    """Return in words how strides became loops."""
    if all(each.n_periods > 1 for each in loops):
        return "two periods blended into a loop"
    if any(each.n_periods > 1 for each in loops):
        return "two periods blended into a loop, or the one stride that there is closed"
    return "the one stride that there is closed into a loop"
