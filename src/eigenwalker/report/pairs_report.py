"""The report on all pairs of many walks: table, order, clusters, a map, nearest walks."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd

from eigenwalker.core.atomic_write import write_table
from eigenwalker.metric.frame_metrics import GroupMetric
from eigenwalker.metric.neighbours import label_table, nearest_of_others
from eigenwalker.plotting.difference_tables import (
    figure_difference_table,
    figure_map_of_walks,
    short_names,
)
from eigenwalker.psychophysics.dissimilarity_structure import (
    cluster_memberships,
    clusters_of_walks,
    map_of_walks,
    order_of_walks,
)
from eigenwalker.report.blocks import Figure, Items, Report, Section, Table
from eigenwalker.report.html_report import write_report
from eigenwalker.report.result_files import made_with, write_blocks
from eigenwalker.report.words import CITE, TABLES, WORDS, body_sentence, figure, missing_points
from eigenwalker.study.walks import Walks

MAX_ROWS = 60
MAX_NAMED_POINTS = 30
TABLE_NAME = "differences.csv"


def write_pairs_report(
    table: pd.DataFrame,
    walks: Walks,
    folder: str | Path,
    *,
    metric: GroupMetric,
    n_clusters: int = 2,
) -> Path:
    """Write a report on all pairs, with ``differences.csv`` beside it, and return its page.

    Parameters
    ----------
    table : DataFrame of walks by walks
        Differences, as `pair_table` gives them.
    walks : Walks
        Which they are, and what was left out.
    folder : path
        Made where it does not exist.
    metric : GroupMetric
        By which they were compared.
    n_clusters : int
        Clusters to look for, as many as there are walks at most.

    Returns
    -------
    Path

    See Also
    --------
    eigenwalker.study.walks_of_folder, eigenwalker.metric.pair_table

    References
    ----------
    Pražák et al. (2010), section 4, figures 3 and 4.
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    write_table(table, folder / TABLE_NAME, index_label="walk")
    names = short_names([str(name) for name in table.index])
    labels = [walks.labels.get(str(name)) for name in table.index]
    order, clusters = order_of_walks(table), clusters_of_walks(table, n_clusters)
    sections = [
        Section(
            "All pairs",
            [_table_figure(table, names, order, clusters), _map(table, names, clusters, labels)],
        ),
        Section("Each walk", [_each_walk(table, walks, names, order, clusters, labels)]),
    ]
    if walks.labels:
        sections.insert(
            1, Section("Labels", [_labels(label_table(table, walks.labels, persons=walks.persons))])
        )
    for title, reasons in (
        ("Not compared", walks.refused),
        ("Flagged, and left out", walks.flagged),
        ("To be minded", walks.remarks),
    ):
        if reasons:
            sections.append(Section(title, [_items(reasons)]))
    sections.append(
        Section("How this was done", [Items(_method(walks, metric)), made_with(CITE["prazak2010"])])
    )
    lead = " ".join(pairs_sentences(table, metric))
    report = Report(f"{len(names)} walks compared", lead, sections)
    write_blocks(report, Path(folder))
    return write_report(report, folder)


def pairs_sentences(table: pd.DataFrame, metric: GroupMetric) -> list[str]:
    """Return the main results of a table of differences in sentences."""
    first, second = np.triu_indices(len(table), 1)
    pairs = table.to_numpy()[first, second]

    def walks(pair: np.intp) -> str:
        return f"{table.index[first[pair]]} and {table.index[second[pair]]}"

    return [
        f"{len(pairs)} pairs of {len(table)} walks by {metric.name}: differences of "
        f"{pairs.min():.3g} to {pairs.max():.3g}, median {np.median(pairs):.3g}.",
        f"Most alike are {walks(pairs.argmin())}; most different {walks(pairs.argmax())}.",
    ]


def persons_compared(walks: Walks) -> list[str]:
    """Return that walks of one person are not compared, in a sentence; none where none are."""
    n_persons = len(set(walks.persons.values()))
    if n_persons == len(walks.persons):
        return []
    return [
        f"The walks are of {n_persons} persons. Nearest walks, and differences within a label and "
        "from others, leave out walks of the same person, which are alike for who walked."
    ]


def printed_labels(labels: pd.DataFrame) -> str:
    """Return a table of labels (`label_table`) to be printed, and what its columns are."""
    table = labels.to_string(float_format=lambda number: f"{number:.3g}")
    return (
        f"{table}\nwithin: mean difference from walks of the same kind; others: from all others; "
        "nearest: share of walks whose nearest walk is of their kind; by_chance: that share if "
        "kinds were dealt out at random."
    )


def _items(reasons: dict[str, str]) -> Items:
    items = [f"{name}: {reason}" for name, reason in reasons.items()]
    more = [f"and {len(items) - MAX_ROWS} more"] if len(items) > MAX_ROWS else []
    return Items([*items[:MAX_ROWS], *more])


def _table_figure(
    table: pd.DataFrame, names: list[str], order: np.ndarray, clusters: np.ndarray
) -> Figure:
    drawing = figure_difference_table(table, names, order=order, clusters=clusters)
    return figure(drawing, "all pairs", n=len(names))


def _map(
    table: pd.DataFrame, names: list[str], clusters: np.ndarray, labels: list[str | None]
) -> Figure:
    if any(labels):
        classes, colour, shown_names = [label or "none" for label in labels], "label", None
    else:
        classes = [f"cluster {each + 1}" for each in clusters]
        colour = "cluster (k-means on the rows)"
        shown_names = names if len(names) <= MAX_NAMED_POINTS else None
    drawing = figure_map_of_walks(map_of_walks(table), classes, names=shown_names)
    sizes = np.bincount(clusters).tolist()
    return figure(drawing, "map of walks", colour=colour, n=len(names), sizes=sizes)


def _each_walk(
    table: pd.DataFrame,
    walks: Walks,
    names: list[str],
    order: np.ndarray,
    clusters: np.ndarray,
    labels: list[str | None],
) -> Table:
    values = table.to_numpy()
    nearest = nearest_of_others(table, walks.persons)
    membership = cluster_memberships(table, clusters)
    columns = ["walk", "label", "cluster", "belongs", "nearest walk", "distance", "mean of all"]
    rows = [
        [
            names[walk],
            labels[walk],
            int(clusters[walk]) + 1,
            f"{100 * membership[walk, clusters[walk]]:.0f} %",
            names[nearest[walk]] if nearest[walk] >= 0 else None,
            float(values[walk, nearest[walk]]) if nearest[walk] >= 0 else None,
            float(values[walk].sum() / (len(values) - 1)),
        ]
        for walk in order[:MAX_ROWS]
    ]
    if not any(labels):
        columns.remove("label")
        rows = [[name, *rest] for name, _, *rest in rows]
    shown = f" (the first {MAX_ROWS} of {len(order)})" if len(order) > MAX_ROWS else ""
    return Table(TABLES["each walk"].format(shown=shown), columns, rows)


def _labels(labels: pd.DataFrame) -> Table:
    rows = [
        [
            str(label),
            int(row.walks),
            float(row.within),
            float(row.others),
            _percentage(row.nearest),
            _percentage(row.by_chance),
        ]
        for label, row in labels.iterrows()
    ]
    columns = ["label", "walks", "same label", "others", "nearest is of the label", "by chance"]
    return Table(TABLES["labels"], columns, rows)


def _percentage(share: float) -> str | None:
    return None if np.isnan(share) else f"{100 * share:.0f} %"


def _method(walks: Walks, metric: GroupMetric) -> list[str]:
    clips = [each.clip for each in walks.clips.values()]
    return [
        body_sentence(clips),
        "Walks were brought in place, looped, registered pair by pair in phase, heading and "
        f"place, and compared along the path by the metric {metric.name}.",
        *missing_points(clips),
        *persons_compared(walks),
        WORDS["metric"]["scale_is_unknown"],
        WORDS["metric"]["where_points_sit"],
    ]
