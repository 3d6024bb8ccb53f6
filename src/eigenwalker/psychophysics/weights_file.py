"""Metrics by name, or from the file of weights that a fit to answers leaves."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from eigenwalker.metric.published import PUBLISHED, GroupMetric

WEIGHTS_NAME, BY_CHOICES_NAME = "weights.csv", "weights-by-choices.csv"
_COLUMNS = ("group", "weight", "metric")


def write_weights(path: Path, weights: pd.DataFrame, metric: str) -> None:
    """Write fitted weights so that `metric_of` finds the metric in the file again.

    Parameters
    ----------
    path : path
    weights : DataFrame of groups
        With a column ``weight``.
    metric : str
        The published metric whose component and function F were fitted.

    """
    weights.assign(metric=metric).to_csv(path, index_label="group")


def metric_of(told: str) -> GroupMetric:
    """Return a published metric by its name, or a fitted one from its file.

    Parameters
    ----------
    told : str
        A name of `PUBLISHED`, or a path that ends in ``.csv``, such as the
        ``weights-by-choices.csv`` of
        ``eigenwalker compare --answers``.

    Raises
    ------
    ValueError
        If there is no such metric, or the file holds none.

    Examples
    --------
    >>> metric_of("positions-sigmoid").by
    'positions'

    """
    if told in PUBLISHED:
        return PUBLISHED[told]
    if not told.lower().endswith(".csv"):
        raise ValueError(
            f"The metric {told!r} is not known; give one of {list(PUBLISHED)}, or the "
            f"{WEIGHTS_NAME} or {BY_CHOICES_NAME} of a fit to answers."
        )
    return _fitted(Path(told))


def _fitted(path: Path) -> GroupMetric:
    try:
        table = pd.read_csv(path)
    except (ValueError, OSError) as error:
        why = str(getattr(error, "strerror", None) or error).strip()
        raise ValueError(f"The metric {path} could not be read as CSV: {why}") from error
    if lacking := [column for column in _COLUMNS if column not in table]:
        raise ValueError(
            f"{path} holds no fitted metric: it lacks the columns {lacking}; expected the "
            f"{WEIGHTS_NAME} or {BY_CHOICES_NAME} that 'eigenwalker compare --answers' writes."
        )
    names = set(map(str, table.metric))
    if len(names) != 1 or not names <= set(PUBLISHED):
        raise ValueError(
            f"{path} names the metrics {sorted(names)}; expected one of {list(PUBLISHED)}."
        )
    published = PUBLISHED[names.pop()]
    weights = pd.to_numeric(table.weight, errors="coerce").to_numpy(dtype=float)
    return GroupMetric(
        path.stem,
        published.by,
        published.shape,
        dict(zip(map(str, table.group), weights.tolist(), strict=True)),
        scale=published.scale,
        exponent=published.exponent,
    )
