"""The report on all pairs of many walks: table, order, clusters, a map, nearest walks."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd

from eigenwalker.core.progress import Progress
from eigenwalker.metric.clips import Clip
from eigenwalker.metric.frame_metrics import GroupMetric
from eigenwalker.metric.pairwise import pair_distances, pair_table
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
from eigenwalker.report.blocks import Block, Figure, Items, Report, Section, Table, Text
from eigenwalker.report.html_report import write_report
from eigenwalker.report.pair_report import CITE, SCALE_IS_UNKNOWN, WHERE_POINTS_SIT, in_plain
from eigenwalker.study.walks import Walks

MOST_ROWS = 60
MOST_NAMED_POINTS = 30
TABLE_NAME = "differences.csv"


def table_of(
    walks: Walks, metric: GroupMetric, *, progress: Progress | None = None
) -> pd.DataFrame:
    """Return the differences of all pairs of walks."""
    if len(walks.clips) < 2:
        raise ValueError(
            f"All pairs need two walks or more; {len(walks.clips)} could be used. {left_out(walks)}"
        )
    return pair_table(walks.clips, metric=metric, progress=progress)


def left_out(walks: Walks) -> str:
    """Return why some walks do not count, in words; of many refused, the first few."""
    few = list(walks.refused.items())[:3]
    said = [f"{name}: {why.strip().rstrip('.')}." for name, why in few]
    if walks.flagged:
        name, why = next(iter(walks.flagged.items()))
        first = why.partition(". ")[0].rstrip(".")
        said.append(f"{len(walks.flagged)} flagged, such as {name}: {first}.")
        said.append("With --with-flagged they count too.")
    return " ".join(said)


def nearest_walks(
    query: Clip, walks: Walks, metric: GroupMetric, *, progress: Progress | None = None
) -> pd.Series:
    """Return the differences of all walks from one, the nearest first.

    Parameters
    ----------
    query : DataArray of shape (time, marker, axis), or PreparedClip
        A walk.
    walks : Walks
        Among which to look.
    metric : GroupMetric
        By which.
    progress : callable, optional
        Called with the number of walks that are done, and of all.

    Returns
    -------
    Series of walks

    """
    if not walks.clips:
        raise ValueError(f"There is no walk to compare with. {left_out(walks)}")
    distances = {}
    for done, (name, clip) in enumerate(walks.clips.items(), start=1):
        pair = {"query": query, "other": clip}
        distances[name] = float(pair_distances(pair, metric=metric).iloc[0])
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
        ``others``; ``nearest``, the share of its walks whose nearest walk has the same label; and
        ``by_chance``, what that share would be if labels were dealt out at random.

    Examples
    --------
    >>> place = pd.Series({"a": 0.0, "b": 1.0, "c": 9.0, "d": 10.0})
    >>> table = (place.to_frame() @ np.ones((1, 4)) - place.to_numpy()).abs()
    >>> table.columns = place.index
    >>> found = label_table(table, {"a": "slow", "b": "slow", "c": "fast", "d": "fast"})
    >>> found.loc["slow"].tolist()
    [2.0, 1.0, 9.0, 1.0, 0.3333333333333333]

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
            "by_chance": (n - 1) / max(len(of) - 1, 1),
        }
    return pd.DataFrame.from_dict(rows, orient="index")


def labels_in_words(found: pd.DataFrame) -> str:
    """Return a table of labels to be printed, and what its columns are."""
    table = found.to_string(float_format=lambda number: f"{number:.3g}")
    return (
        f"{table}\nwithin: mean difference from walks of the same kind; others: from all others; "
        "nearest: share of walks whose nearest walk is of their kind; by_chance: that share if "
        "kinds were dealt out at random."
    )


def write_all_pairs(
    folder: str | Path,
    table: pd.DataFrame,
    walks: Walks,
    metric: GroupMetric,
    *,
    n_clusters: int = 2,
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
    metric : GroupMetric
        By which they were compared.
    n_clusters : int
        Clusters to look for, as many as there are walks at most.

    Returns
    -------
    Path

    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    table.to_csv(folder / TABLE_NAME, index_label="walk")
    names = short_names([str(name) for name in table.index])
    order = order_of_walks(table)
    clusters = clusters_of_walks(table, n_clusters)
    sections = [
        Section("All pairs", _pictures(table, names, order, clusters, walks)),
        Section("Each walk", [_each_walk(table, names, order, clusters, walks)]),
    ]
    if walks.labels:
        sections.insert(1, Section("Labels", [_labels(table, walks)]))
    for title, said in (
        ("Not compared", walks.refused),
        ("Flagged, and left out", walks.flagged),
        ("To be minded", walks.remarks),
    ):
        if said:
            sections.append(Section(title, [_listed(said)]))
    sections.append(Section("How this was done", [Items(_method(walks, metric)), Text(CITE)]))
    lead = " ".join(summary(table, metric))
    return write_report(Report(f"{len(names)} walks compared", lead, sections), folder)


def _listed(said: dict[str, str]) -> Items:
    items = [f"{name}: {why}" for name, why in said.items()]
    more = [f"and {len(items) - MOST_ROWS} more"] if len(items) > MOST_ROWS else []
    return Items([*items[:MOST_ROWS], *more])


def summary(table: pd.DataFrame, metric: GroupMetric) -> list[str]:
    """Return what a table says, in sentences."""
    values = table.to_numpy()
    rows, columns = np.triu_indices(len(values), 1)
    pairs = values[rows, columns]
    least, most = int(pairs.argmin()), int(pairs.argmax())

    def named(pair: int) -> str:
        return f"{table.index[rows[pair]]} and {table.index[columns[pair]]}"

    return [
        f"{len(pairs)} pairs of {len(table)} walks by {metric.name}: differences of "
        f"{pairs.min():.3g} to {pairs.max():.3g}, median {np.median(pairs):.3g}.",
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
    belongs = cluster_memberships(table, clusters)
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
    return Table(
        f"Walks in that order{left}, and the walk nearest to each. A walk belongs to its cluster "
        "the more, the nearer it is to the cluster's middle than to the other middles (fuzzy "
        "c-means)",
        columns,
        rows,
    )


def _labels(table: pd.DataFrame, walks: Walks) -> Table:
    found = label_table(table, walks.labels)
    rows = [
        [
            str(label),
            int(row.walks),
            float(row.within),
            float(row.others),
            f"{100 * row.nearest:.0f} %",
            f"{100 * row.by_chance:.0f} %",
        ]
        for label, row in found.iterrows()
    ]
    return Table(
        "Mean difference from walks of the same label and of others, and how many have one of the "
        "same label as the nearest; by chance: how many would if labels were dealt out at random",
        ["label", "walks", "same label", "others", "nearest is of the label", "by chance"],
        rows,
    )


def _method(walks: Walks, metric: GroupMetric) -> list[str]:
    clips = [each.clip for each in walks.clips.values()]
    bodies = (
        "All walks are shown on a neutral mannequin of fixed proportions, so that only movements "
        "differ."
        if all(clip.attrs.get("retargeted") for clip in clips)
        else "Each walk has its own body, whose build counts too."
    )
    every = [set(map(str, clip.marker.values)) for clip in clips]
    lacking = sorted(set.union(*every) - set.intersection(*every))
    points = ", ".join(map(in_plain, lacking))
    said = [f"Left out, as some of the walks lack them: {points}."] if lacking else []
    return [
        bodies,
        "Walks were brought in place, looped, registered pair by pair in phase, heading and "
        f"place, and compared along the path by the metric {metric.name}.",
        *said,
        SCALE_IS_UNKNOWN,
        WHERE_POINTS_SIT,
    ]
