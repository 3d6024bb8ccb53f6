"""The report on two walks: how different they are, where, and when one can pass into the other."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from eigenwalker.metric.clip_distances import Comparison
from eigenwalker.metric.frame_metrics import GroupMetric
from eigenwalker.metric.loops import loop
from eigenwalker.plotting.difference_maps import figure_two_walks
from eigenwalker.plotting.fitted_weights import figure_shares
from eigenwalker.report.blocks import Block, Figure, Items, Report, Section, Table, Text
from eigenwalker.report.html_report import write_report
from eigenwalker.report.pair_figures import component_maps, loop_and_pair_maps, transitions
from eigenwalker.report.result_files import made_with, write_blocks
from eigenwalker.report.words import (
    CITE,
    TABLES,
    WORDS,
    body_sentence,
    figure,
    missing_points,
    plain_name,
)
from eigenwalker.study.reference_pairs import ReferenceComparison


def write_pair_report(
    result: ReferenceComparison,
    folder: str | Path,
    *,
    names: tuple[str, str],
    remarks: Mapping[str, str] | None = None,
) -> Path:
    """Write a report on two walks and return its page.

    Parameters
    ----------
    result : ReferenceComparison
        Of walks that repeat, as `compare_with_references` gives it.
    folder : path
        Made where it does not exist; holds ``report.html``.
    names : tuple of str
        What the walks are called.
    remarks : mapping of str to str, optional
        Warnings about the walks, by name.

    Returns
    -------
    Path

    See Also
    --------
    eigenwalker.metric.compare_walks : Makes what the page shows.
    write_metric_fit_report : Of answers of observers.
    """
    comparison = result.comparison
    maps = [loop_and_pair_maps(comparison, names), component_maps(comparison, names)]
    sections = [
        Section("How different", _how_different(result, names)),
        Section("Where", _where(comparison)),
        Section("Motion maps", [*maps, Text(WORDS["terms"]["maps"])]),
        Section("From one walk into the other", transitions(comparison, names)),
        Section("How this was done", [Items(_method(comparison)), made_with(CITE["prazak2010"])]),
    ]
    lead = " ".join([*pair_sentences(result, names), *remark_sentences(remarks or {})])
    report = Report(f"{names[0]} and {names[1]}", lead, sections)
    write_blocks(report, Path(folder))
    return write_report(report, folder)


def pair_sentences(result: ReferenceComparison, names: tuple[str, str]) -> list[str]:
    """Return the main results of a comparison in sentences."""
    comparison = result.comparison
    mean = comparison.groups.mean()
    sentences = [
        _difference(result),
        *_self_differences(result, names),
        f"Joints are {mean.positions_mm:.0f} mm apart in the mean of joint groups, their "
        f"velocities {mean.velocities_mm_s:.0f} mm/s, joint angles {mean.angles_deg:.1f} "
        "degrees.",
    ]
    if comparison.shares.isna().any():
        return [*sentences, "They do not differ in anything that the metric weighs."]
    most = comparison.shares.sort_values(ascending=False)
    parts = [f"{plain_name(g)} {100 * share:.0f} %" for g, share in most.items() if share > 0.005]
    sentences.append(f"Of the difference are {', '.join(parts)}.")
    if comparison.missing_groups:
        groups = ", ".join(map(plain_name, comparison.missing_groups))
        sentences.append(f"The metric weighs {groups} too, which the walks do not show.")
    return sentences


def remark_sentences(remarks: Mapping[str, str]) -> list[str]:
    """Return warnings about walks in sentences."""
    return [f"Mind {name}: {remark.rstrip('.')}." for name, remark in remarks.items() if remark]


def _differ_by_joints(by_joints: float, distance: float) -> bool:
    """Return whether a distance without hands and feet is another number when printed."""
    return abs(by_joints - distance) > 0.005 * distance


def _difference(result: ReferenceComparison) -> str:
    comparison, metric = result.comparison, result.comparison.metric
    name = metric.name if isinstance(metric, GroupMetric) else "distance"
    sentence = f"Difference ({name}): {comparison.distance:.4g}"
    _, by_joints, share_nearer = result.by_metric.reindex([name]).iloc[0]
    if np.isnan(by_joints):
        return f"{sentence}."
    if _differ_by_joints(by_joints, comparison.distance):
        sentence += f"; without hands and feet {by_joints:.4g}"
    return (
        f"{sentence}, more than between {100 * share_nearer:.0f} % of pairs of {result.n_people} "
        "simulated people."
    )


def _self_differences(result: ReferenceComparison, names: tuple[str, str]) -> list[str]:
    """Return how different each walk is from itself, in a sentence."""
    comparison = result.comparison
    if not isinstance(comparison.metric, GroupMetric) or not comparison.distance > 0:
        return []
    known = [
        f"{distance:.3g} ({name})"
        for name, distance in zip(names, result.self_distances, strict=True)
        if np.isfinite(distance)
    ]
    if not known:
        return ["Neither has enough strides to tell how much it differs from itself."]
    sentence = f"First and last strides of one capture differ by {' and '.join(known)}"
    if comparison.distance <= np.nanmax(result.self_distances):
        return [f"{sentence}, which is no less: these two cannot be told apart."]
    return [f"{sentence}."]


def _how_different(result: ReferenceComparison, names: tuple[str, str]) -> list[Block]:
    table = result.by_metric
    differ = any(map(_differ_by_joints, table.by_joints, table.distance))
    columns = ["metric", "distance", "by joints alone", "pairs that differ less"]
    rows = []
    for name, distance, by_joints, share in table.itertuples():
        percentage = None if np.isnan(share) else f"{100 * share:.0f} %"
        rows.append([name, distance, *([by_joints] if differ else []), percentage])
    if not differ:
        columns.remove("by joints alone")
    alone = " by joints alone, without hands and feet, which those have not" if differ else ""
    caption = TABLES["metrics"].format(n_people=result.n_people, alone=alone)
    return [
        _bodies(result.comparison, names),
        Table(caption, columns, rows),
        Items(WORDS["terms"]["pair"]),
        Text(WORDS["metric"]["no_percentage_of_angles"]),
        Text(WORDS["metric"]["scale_is_unknown"]),
    ]


def _bodies(comparison: Comparison, names: tuple[str, str]) -> Figure:
    first, second = comparison.registration.on_common_clock()
    markers = [str(name) for name in first.marker.values]
    drawing = figure_two_walks(first.values, second.values, markers, names=names)
    return figure(drawing, "two walks", names=names)


def _where(comparison: Comparison) -> list[Block]:
    table = Table(
        TABLES["joint groups"],
        ["joint group", "place (mm)", "velocity (mm/s)", "joint angle (degrees)"],
        [[plain_name(group), *map(float, row)] for group, *row in comparison.groups.itertuples()],
    )
    terms = Text(WORDS["terms"]["groups"])
    if comparison.shares.isna().any():
        return [table, terms]
    shares = {str(group): float(share) for group, share in comparison.shares.items()}
    bars = ", ".join(f"{plain_name(g)} {100 * share:.0f} %" for g, share in shares.items())
    return [figure(figure_shares(shares), "shares", bars=bars), table, terms]


def _method(comparison: Comparison) -> list[str]:
    clips = [comparison.a.clip, comparison.b.clip]
    loops = [loop(clip) for clip in clips]
    seams = " and ".join(f"{each.seam_mm:.0f}" for each in loops)
    n_blended = sum(each.n_periods > 1 for each in loops)
    looped = (
        "the one stride that there is closed into a loop",
        "two periods blended into a loop, or the one stride that there is closed",
        "two periods blended into a loop",
    )[n_blended]
    return [
        body_sentence(clips),
        f"The steady strides are brought in place, {looped}, and the loops registered in phase, "
        "heading and place; a path through their motion map tells which moments correspond. The "
        "difference is the mean along that path.",
        f"Seam of the loops: {seams} mm before they were closed.",
        "Angles are of captured rotations, which both captures have."
        if all("rotation" in clip.coords for clip in clips)
        else "Angles are of positions.",
        *missing_points(clips),
        WORDS["metric"]["where_points_sit"],
    ]
