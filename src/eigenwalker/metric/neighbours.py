"""Which walks are near to each other: to one of them, or within a label."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd

from eigenwalker.core.arguments import check_kind
from eigenwalker.core.progress import Progress, ticked
from eigenwalker.metric.clip_distances import clip_distance
from eigenwalker.metric.clips import Clip
from eigenwalker.metric.frame_metrics import Metric
from eigenwalker.metric.prepared import prepare


def nearest_walks(
    query: Clip,
    walks: Mapping[str, Clip],
    *,
    metric: str | Metric = "positions-sigmoid",
    progress: Progress | None = None,
) -> pd.Series:
    """Return the distances of walks from one walk, the nearest first.

    Parameters
    ----------
    query : DataArray of shape (time, marker, axis), Walker, Loop or PreparedClip
        A walk.
    walks : mapping of str to DataArray, Walker, Loop or PreparedClip
        The walks to search, by name.
    metric : str, FrameMetric or GroupMetric
        What is compared and how, or the name of a published metric (`PUBLISHED`); left out, the
        metric that predicted observers best in Pražák et al. (2010).
    progress : callable, optional
        Called with the number of walks that are done, and of all.

    Returns
    -------
    Series of walks
        Distance in the unit of the metric, by name, ascending.

    See Also
    --------
    pair_table : All from all.
    clip_distance : One pair, and what is computed.

    References
    ----------
    Pražák et al. (2010), eqs. 1 to 3 and section 5.

    Examples
    --------
    >>> walks = {f"walk {seed}": ew.simulate_walk(seed=seed, rate_hz=60) for seed in (1, 2, 3)}
    >>> nearest_walks(walks["walk 2"], walks).index[0]
    'walk 2'
    """
    check_kind(walks, Mapping, "walks by name")
    if not walks:
        raise ValueError("There is no walk to compare with.")
    prepared = prepare(query)
    distances = {
        name: clip_distance(prepared, clip, metric=metric)
        for name, clip in ticked(walks.items(), len(walks), progress)
    }
    return pd.Series(distances, name="distance").sort_values(kind="stable")


def label_table(
    table: pd.DataFrame, labels: Mapping[str, str], *, persons: Mapping[str, str] | None = None
) -> pd.DataFrame:
    """Return whether walks with the same label are nearer to each other than to others.

    Parameters
    ----------
    table : DataFrame of walks by walks
        Distances (`pair_table`).
    labels : mapping of str to str
        Label of each walk; walks without one are left out.
    persons : mapping of str to str, optional
        Whose walk each is. Two walks of a person are not compared: they are alike for who walked,
        whatever their label.

    Returns
    -------
    DataFrame of labels
        ``walks``, their number; the mean distances ``within`` the label and to ``others`` (NaN
        where there are none); ``nearest``, the share of its walks whose nearest walk has the same
        label; and ``by_chance``, the mean share of that label among the walks that could be
        nearest.

    See Also
    --------
    pair_table : Makes the table.
    nearest_walks : The neighbours of one walk.

    Examples
    --------
    >>> place = pd.Series({"a": 0.0, "b": 1.0, "c": 9.0, "d": 10.0})
    >>> table = (place.to_frame() @ np.ones((1, 4)) - place.to_numpy()).abs()
    >>> table.columns = place.index
    >>> labels = label_table(table, {"a": "slow", "b": "slow", "c": "fast", "d": "fast"})
    >>> labels.loc["slow"].tolist()
    [2.0, 1.0, 9.0, 1.0, 0.3333333333333333]
    """
    check_kind(table, pd.DataFrame, "a table of walks by walks, as pair_table() returns it")
    names = [name for name in table.index if name in labels]
    if not names:
        raise ValueError(f"None of the {len(table)} walks of the table has a label.")
    label_of = np.array([labels[name] for name in names])
    compared = pairs_of_persons(names, persons)
    nearest = _nearest(table.loc[names, names].to_numpy(), compared)
    values = np.where(compared, table.loc[names, names].to_numpy(), np.nan)
    rows = {}
    for label in sorted(set(label_of)):
        own = label_of == label
        known = own & (nearest >= 0)
        shares = compared[known][:, own].sum(axis=1) / compared[known].sum(axis=1)
        rows[label] = {
            "walks": int(own.sum()),
            "within": _mean(values[np.ix_(own, own)]),
            "others": _mean(values[np.ix_(own, ~own)]),
            "nearest": _mean(1.0 * own[nearest[known]]),
            "by_chance": _mean(shares),
        }
    return pd.DataFrame.from_dict(rows, orient="index")


def pairs_of_persons(names: Sequence[str], persons: Mapping[str, str] | None) -> np.ndarray:
    """Return which walks are compared, of different persons: bool of shape (walk, walk)."""
    who = np.array([(persons or {}).get(name) or f"\0{row}" for row, name in enumerate(names)])
    return who[:, None] != who


def nearest_of_others(table: pd.DataFrame, persons: Mapping[str, str] | None = None) -> np.ndarray:
    """Return the number of the walk of another person that is nearest to each; -1 for none."""
    return _nearest(table.to_numpy(), pairs_of_persons([str(name) for name in table], persons))


def _nearest(values: np.ndarray, compared: np.ndarray) -> np.ndarray:
    nearest = np.where(compared, values, np.inf).argmin(axis=1)
    return np.where(compared.any(axis=1), nearest, -1)


def _mean(values: np.ndarray) -> float:
    known = values[np.isfinite(values)]
    return float(known.mean()) if known.size else float("nan")
