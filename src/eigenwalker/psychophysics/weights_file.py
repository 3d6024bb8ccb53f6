"""Metrics by name, or from a file of weights that were fitted to answers."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pandas as pd

from eigenwalker.core.arguments import check_kind
from eigenwalker.core.atomic_write import write_table
from eigenwalker.metric.frame_metrics import GroupMetric
from eigenwalker.metric.published import PUBLISHED

WEIGHTS_NAME, BY_CHOICES_NAME = "weights.csv", "weights-by-choices.csv"
_COLUMNS = ("group", "weight", "metric")


def save_weights(weights: pd.DataFrame, path: str | Path, *, metric: str) -> Path:
    """Write fitted weights to a file of which `load_metric` makes a metric again.

    Parameters
    ----------
    weights : DataFrame of groups
        With a column ``weight``, such as `MetricFit.by_choices`.
    path : path
        Ends in ``.csv``.
    metric : str
        The published metric whose component and function F were fitted.

    Returns
    -------
    Path

    See Also
    --------
    fit_to_answers, load_metric

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> weights = pd.DataFrame({"weight": [0.2, 0.8]}, index=["head", "forearm"])
    >>> with TemporaryDirectory() as folder:
    ...     path = save_weights(weights, f"{folder}/ours.csv", metric="positions-sigmoid")
    ...     load_metric(path).group_weights
    {'head': 0.2, 'forearm': 0.8}
    """
    check_kind(weights, pd.DataFrame, "a table of groups with a column weight")
    if "weight" not in weights or not len(weights):
        raise ValueError(f"Expected a column weight of one group or more; got {list(weights)}.")
    return write_table(weights.assign(metric=metric), Path(path), index_label="group")


def load_metric(name_or_path: str | Path) -> GroupMetric:
    """Return a published metric by its name, or a fitted one from its file.

    Parameters
    ----------
    name_or_path : str or path
        A name of `PUBLISHED`, or a file that ends in ``.csv``, as `save_weights` and
        ``eigenwalker compare --answers`` write it.

    Returns
    -------
    GroupMetric
        What `clip_distance` and the like take as ``metric=``.

    Raises
    ------
    ValueError
        If there is no such metric, or the file holds none.

    See Also
    --------
    save_weights : Writes the file.

    Examples
    --------
    >>> load_metric("positions-sigmoid").by
    'positions'
    """
    name = str(name_or_path)
    if name in PUBLISHED:
        return PUBLISHED[name]
    if not name.lower().endswith(".csv"):
        raise ValueError(
            f"The metric {name!r} is not known; give one of {list(PUBLISHED)}, or the "
            f"{WEIGHTS_NAME} or {BY_CHOICES_NAME} of a fit to answers."
        )
    try:
        table = pd.read_csv(name)
    except (ValueError, OSError) as error:
        reason = str(getattr(error, "strerror", None) or error).strip()
        raise ValueError(f"The metric {name} could not be read as CSV: {reason}") from error
    if missing := [column for column in _COLUMNS if column not in table]:
        raise ValueError(
            f"{name} holds no fitted metric: it lacks the columns {missing}; expected the "
            f"{WEIGHTS_NAME} or {BY_CHOICES_NAME} that 'eigenwalker compare --answers' writes."
        )
    names = set(map(str, table.metric))
    if len(names) != 1 or not names <= set(PUBLISHED):
        raise ValueError(
            f"{name} names the metrics {sorted(names)}; expected one of {list(PUBLISHED)}."
        )
    published = PUBLISHED[names.pop()]
    weights = pd.to_numeric(table.weight, errors="coerce").to_numpy(dtype=float)
    fitted = dict(zip(map(str, table.group), weights.tolist(), strict=True))
    return replace(published, name=Path(name).stem, group_weights=fitted)
