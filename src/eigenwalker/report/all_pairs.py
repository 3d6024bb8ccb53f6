"""The report on all pairs of many walks: table, order, clusters, a map, nearest walks."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pandas as pd

from eigenwalker.display.difference_tables import figure_difference_table, figure_map_of_walks
from eigenwalker.folds import Progress
from eigenwalker.metric.clip_distances import pair_components, pair_table
from eigenwalker.metric.difference_structure import (
    clusters_of_walks,
    map_of_walks,
    memberships,
    order_of_walks,
)
from eigenwalker.metric.prepared import Clip
from eigenwalker.metric.published import PUBLISHED
from eigenwalker.report.compared_walks import Walks
from eigenwalker.report.content import Block, Figure, Items, Report, Section, Table, Text
from eigenwalker.report.page import write_report
from eigenwalker.report.two_walks import CITE, SCALE_IS_UNKNOWN

MOST_ROWS = 60
MOST_NAMED_POINTS = 30
TABLE_NAME = "differences.csv"


def table_of(walks: Walks, metric: str, *, progress: Progress | None = None) -> pd.DataFrame:
    """Return the differences of all pairs of walks, by a published metric."""
    if len(walks.clips) < 2:
        raise ValueError(
            f"All pairs need two walks or more; {len(walks.clips)} could be used. "
            + " ".join(f"{name}: {why}" for name, why in list(walks.refused.items())[:3])
        )
    return pair_table(walks.clips, metric=metric, progress=progress)


def nearest_walks(
    query: Clip, walks: Walks, metric: str, *, progress: Progress | None = None
) -> pd.Series:
    """Return the differences of all walks from one, the nearest first.

    Parameters
    ----------
    query : DataArray of shape (time, marker, axis), or PreparedClip
        A walk.
    walks : Walks
        Among which to look.
    metric : str
        Name of a published metric.
    progress : callable, optional
        Called with the number of walks that are done, and of all.

    Returns
    -------
    Series of walks

    """
    chosen = PUBLISHED[metric]
    distances = {}
    for done, (name, clip) in enumerate(walks.clips.items(), start=1):
        points = pair_components({"query": query, "other": clip}, metric=chosen).iloc[0]
        weights = chosen.weights_for([str(point) for point in points.index])
        distances[name] = float(weights @ points.to_numpy())
        if progress is not None:
            progress(done, len(walks.clips))
    return pd.Series(distances, name="distance").sort_values(kind="stable")


def label_table(table: pd.DataFrame, labels: dict[str, str]) -> pd.DataFrame:
    """Return whether walks of a label are nearer to each other than to others.

    Parameters
    ----------
    table : DataFrame of walks by walks
        Differences.
    labels : dict of str to str
        Label of each walk; walks without one are left out.

    Returns
    -------
    DataFrame of labels
        ``walks``; mean differences ``within`` the label (NaN of one walk alone) and to
        ``others``; ``nearest``, the share of its walks whose nearest walk has the same label.

    Examples
    --------
    >>> place = pd.Series({"a": 0.0, "b": 1.0, "c": 9.0, "d": 10.0})
    >>> table = (place.to_frame() @ np.ones((1, 4)) - place.to_numpy()).abs()
    >>> table.columns = place.index
    >>> found = label_table(table, {"a": "slow", "b": "slow", "c": "fast", "d": "fast"})
    >>> found.loc["slow"].tolist()
    [2.0, 1.0, 9.0, 1.0]

    """
    names = [name for name in table.index if name in labels]
    values = table.loc[names, names].to_numpy()
    of = np.array([labels[name] for name in names])
    alone = values + np.diag(np.full(len(values), np.inf))
    nearest = of[alone.argmin(axis=1)]
    rows = {}
    for label in sorted(set(of)):
        mine = of == label
        n = int(mine.sum())
        rows[label] = {
            "walks": n,
            "within": values[np.ix_(mine, mine)].sum() / (n * (n - 1)) if n > 1 else np.nan,
            "others": values[np.ix_(mine, ~mine)].mean() if n < len(of) else np.nan,
            "nearest": float(np.mean(nearest[mine] == label)),
        }
    return pd.DataFrame.from_dict(rows, orient="index")


def write_all_pairs(
    folder: str | Path, table: pd.DataFrame, walks: Walks, metric: str, *, n_clusters: int = 2
) -> Path:
    """Write a report on all pairs, with ``differences.csv`` beside it, and return its page.

    Parameters
    ----------
    folder : path
        Made where it does not exist.
    table : DataFrame of walks by walks
        Differences, as `table_of` gives them.
    walks : Walks
        Which they are.
    metric : str
        Name of the metric.
    n_clusters : int
        Clusters to look for.

    Returns
    -------
    Path

    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    table.to_csv(folder / TABLE_NAME, index_label="walk")
    names = telling_names([str(name) for name in table.index])
    order = order_of_walks(table)
    clusters = clusters_of_walks(table, min(n_clusters, len(names)))
    sections = [
        Section("All pairs", _pictures(table, names, order, clusters, walks)),
        Section("Each walk", [_each_walk(table, names, order, clusters, walks)]),
    ]
    if walks.labels:
        sections.insert(1, Section("Labels", [_labels(table, walks)]))
    if walks.refused:
        refused = [f"{name}: {why}" for name, why in walks.refused.items()]
        sections.append(Section("Not compared", [Items(refused[:MOST_ROWS])]))
    sections.append(Section("How this was done", [Text(_method(metric)), Text(CITE)]))
    lead = " ".join(summary(table, metric))
    return write_report(folder, Report(f"{len(names)} walks compared", lead, sections))


def telling_names(names: list[str]) -> list[str]:
    """Return names without what all of them begin with, up to a separator.

    Examples
    --------
    >>> telling_names(["walk_sad_1.bvh", "walk_happy_2.bvh"])
    ['sad_1.bvh', 'happy_2.bvh']

    """
    shared = os.path.commonprefix(names)  # noqa: RUF071 - letters are what is wanted
    kept = max((shared.rfind(mark) for mark in "/_- "), default=-1) + 1
    return [name[kept:] for name in names]


def summary(table: pd.DataFrame, metric: str) -> list[str]:
    """Return what a table says, in sentences."""
    values = table.to_numpy()
    rows, columns = np.triu_indices(len(values), 1)
    pairs = values[rows, columns]
    least, most = int(pairs.argmin()), int(pairs.argmax())

    def named(pair: int) -> str:
        return f"{table.index[rows[pair]]} and {table.index[columns[pair]]}"

    return [
        f"{len(pairs)} pairs of {len(table)} walks by {metric}: differences of {pairs.min():.3g} "
        f"to {pairs.max():.3g}, median {np.median(pairs):.3g}.",
        f"Most alike are {named(least)}; most different {named(most)}.",
    ]


def _pictures(
    table: pd.DataFrame, names: list[str], order: np.ndarray, clusters: np.ndarray, walks: Walks
) -> list[Block]:
    heat = Figure(
        figure_difference_table(table, names, order=order, clusters=clusters),
        "Differences of all pairs, dark where walks are alike, in the order of the first principal "
        "component of the table's rows; dashed lines part neighbours of different clusters.",
        f"A square grey picture of {len(names)} by {len(names)} differences.",
    )
    classes, told = [f"cluster {each + 1}" for each in clusters], "cluster (k-means on the rows)"
    if walks.labels:
        classes, told = [walks.labels.get(str(name), "none") for name in table.index], "label"
    few = names if len(names) <= MOST_NAMED_POINTS and not walks.labels else None
    places = Figure(
        figure_map_of_walks(map_of_walks(table), classes, names=few),
        "A map on which distances are as near to the differences as two dimensions allow "
        f"(classical scaling), coloured by {told}.",
        f"{len(names)} points in clusters of {np.bincount(clusters).tolist()}.",
    )
    return [heat, places]


def _each_walk(
    table: pd.DataFrame, names: list[str], order: np.ndarray, clusters: np.ndarray, walks: Walks
) -> Table:
    values = table.to_numpy()
    alone = values + np.diag(np.full(len(values), np.inf))
    belongs = memberships(table, clusters)
    rows = []
    for walk in order[:MOST_ROWS]:
        nearest = int(alone[walk].argmin())
        rows.append(
            [
                names[walk],
                walks.labels.get(str(table.index[walk])),
                int(clusters[walk]) + 1,
                f"{100 * belongs[walk, clusters[walk]]:.0f} %",
                names[nearest],
                float(values[walk, nearest]),
                float(values[walk].sum() / (len(values) - 1)),
            ]
        )
    columns = ["walk", "label", "cluster", "belongs", "nearest walk", "distance", "mean of all"]
    if not walks.labels:
        columns.remove("label")
        rows = [[row[0], *row[2:]] for row in rows]
    left = f" (the first {MOST_ROWS} of {len(order)})" if len(order) > MOST_ROWS else ""
    return Table(f"Walks in that order{left}, and the walk nearest to each", columns, rows)


def _labels(table: pd.DataFrame, walks: Walks) -> Table:
    found = label_table(table, walks.labels)
    rows = [
        [
            str(label),
            int(row.walks),
            float(row.within),
            float(row.others),
            f"{100 * row.nearest:.0f} %",
        ]
        for label, row in found.iterrows()
    ]
    return Table(
        "Mean difference from walks of the same label and of others, and how many have one of the "
        "same label as the nearest",
        ["label", "walks", "same label", "others", "nearest is of the label"],
        rows,
    )


def _method(metric: str) -> str:
    return (
        "Walks were brought in place, looped, registered pair by pair in phase, heading and "
        f"place, and compared along the path by the metric {metric}. {SCALE_IS_UNKNOWN}"
    )
