"""The report on a metric fitted to observers' answers: its weights, and what they are worth."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike
from scipy.spatial.distance import pdist
from sklearn.model_selection import cross_val_predict

from eigenwalker.display.fitted_weights import figure_predictions, figure_weights
from eigenwalker.folds import Progress
from eigenwalker.metric.answers import PairCounts, as_name, count_pairs
from eigenwalker.metric.comparison import by_metric
from eigenwalker.metric.fit_quality import compare_metrics, leave_walkers_out
from eigenwalker.metric.group_tables import group_table
from eigenwalker.metric.observers import Reliability, bootstrap_weights, split_half
from eigenwalker.metric.perceptual import PerceptualMetric
from eigenwalker.metric.published import PUBLISHED
from eigenwalker.report.compared_walks import Walks
from eigenwalker.report.content import Figure, Items, Report, Section, Table, Text
from eigenwalker.report.metric_files import WEIGHTS_NAME, write_weights
from eigenwalker.report.page import write_report
from eigenwalker.report.two_walks import CITE, in_plain
from eigenwalker.space import WalkerSpace

FITTED = "fitted to these answers"
PAIRS_NAME = "pairs.csv"


@dataclass(frozen=True, eq=False)
class FittedMetric:
    """A metric fitted to answers, and what is known about the fit.

    Parameters
    ----------
    name : str
        The published metric whose components and function F were taken.
    model : PerceptualMetric
        Fitted.
    counts : PairCounts
        The answers.
    weights : DataFrame of groups
        ``weight``, ``relative`` and the columns of `Bootstrap.intervals`.
    pairs : DataFrame of pairs
        ``shown``, ``difference``, ``predicted``, and ``unseen``: predicted by weights to which
        neither walker of the pair had contributed.
    compared : DataFrame of metrics
        As `compare_metrics` gives it.
    reliability : Reliability
        Of the answers.

    """

    name: str
    model: PerceptualMetric
    counts: PairCounts
    weights: pd.DataFrame
    pairs: pd.DataFrame
    compared: pd.DataFrame
    reliability: Reliability


def fit_answers(
    walks: Walks,
    answers: pd.DataFrame,
    metric: str,
    *,
    progress: Progress | None = None,
) -> FittedMetric:
    """Return the metric that predicts observers' answers best.

    Parameters
    ----------
    walks : Walks
        What observers saw, five walks or more.
    answers : DataFrame
        As `count_pairs` takes it; walks are called by their names, by these without a suffix, or
        by their number in a population.
    metric : str
        Name of the published metric whose component and function F to take.
    progress : callable, optional
        Called with the number of clips and pairs that are done, and of all.

    Raises
    ------
    ValueError
        If answers name walks that are not there, or no pair was shown. Pairs that were never shown
        together are left out, with a warning.

    """
    names = list(walks.clips)
    counts = count_pairs(_named_as(answers, names), walkers=names)
    y = counts.differences.to_numpy()
    kept = np.isfinite(y)
    if not kept.any():
        raise ValueError("No two of these walks were shown together in an answered trial.")
    if not kept.all():
        first, second = counts.pairs[int(kept.argmin())]
        warnings.warn(
            f"{(~kept).sum()} of {len(y)} pairs were never shown together, such as {first} and "
            f"{second}; they are left out of the fit.",
            stacklevel=2,
        )
    X = group_table(walks.clips, metric, progress=progress)[kept]
    y, pairs = y[kept], counts.pairs[kept].tolist()
    chosen, shown = counts.chosen[:, kept], counts.shown[:, kept]
    model = PerceptualMetric().fit(X, y)
    sampled = bootstrap_weights(X, chosen, shown, pairs=pairs)
    published = by_metric(walks.clips, list(PUBLISHED))[kept]
    others = {f"{name}, as published": published[name] for name in PUBLISHED}
    tables: dict[str, ArrayLike] = {FITTED: X, **others}
    if walks.vectors:
        vectors = np.stack([walks.vectors[name] for name in names])
        tables["distance in walker space"] = pdist(WalkerSpace().fit_transform(vectors))[kept]
    weights = pd.DataFrame(
        {"weight": model.weights_, "relative": model.relative_weights_}, index=X.columns
    )
    unseen = cross_val_predict(PerceptualMetric(), X, y, cv=leave_walkers_out(pairs))
    return FittedMetric(
        name=metric,
        model=model,
        counts=counts,
        weights=weights.join(sampled.intervals(X.columns)).rename_axis("group"),
        pairs=pd.DataFrame(
            {
                "shown": shown.sum(axis=0),
                "difference": y,
                "predicted": model.predict(X),
                "unseen": unseen,
            },
            index=counts.pairs[kept],
        ),
        compared=compare_metrics(tables, y, pairs),
        reliability=split_half(chosen, shown),
    )


def _named_as(answers: pd.DataFrame, names: list[str]) -> pd.DataFrame:
    """Return answers with walks called by their full names, where they are called by stems."""
    stems = [Path(name).stem for name in names]
    full = {stem: name for stem, name in zip(stems, names, strict=True) if stems.count(stem) == 1}
    full |= {name.removeprefix("walker "): name for name in names}
    full |= {name: name for name in names}
    columns = [c for c in ("a", "b", "c", "d", "chosen_1", "chosen_2") if c in answers]
    renamed = answers[columns].map(lambda said: full.get(as_name(said), said))
    return answers.assign(**{str(column): renamed[column] for column in columns})


def in_words(found: FittedMetric) -> list[str]:
    """Return what a fit says, in sentences."""
    fitted = found.compared.loc[FITTED]
    most = found.weights.relative.sort_values(ascending=False)
    parts = [f"{in_plain(g)} {share:.2f}" for g, share in most.items() if share >= 0.005]
    weighed = ", ".join(parts) if parts else "nothing: no joint group tells anything"
    others = found.compared.drop(index=FITTED).cv_pearson
    said = [
        f"{len(found.counts.observers)} observers, {found.counts.chosen.sum():.0f} answers, "
        f"{len(found.pairs)} pairs. Halves of the observers agree with r = "
        f"{found.reliability.halves:.2f}; no metric can be expected above "
        f"{found.reliability.ceiling:.2f}.",
        f"Relative weights: {weighed}. Constant {found.model.constant_:.2f}.",
        f"It predicts these pairs with r = {fitted.pearson:.2f}, pairs of walkers it has not seen "
        f"with r = {fitted.cv_pearson:.2f}.",
    ]
    if others.notna().any():
        said.append(f"Best of the others is {others.idxmax()}, r = {others.max():.2f}.")
    return said


def write_fitted_metric(folder: str | Path, found: FittedMetric) -> Path:
    """Write a report on a fitted metric, with its weights and pairs as CSV; return its page.

    Parameters
    ----------
    folder : path
        Made where it does not exist.
    found : FittedMetric

    Returns
    -------
    Path

    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    write_weights(folder / WEIGHTS_NAME, found.weights, found.name)
    found.pairs.to_csv(folder / PAIRS_NAME)
    sections = [
        Section("Weights", [_weights_drawn(found), _weights_table(found)]),
        Section("Predictions", [_predictions(found), _compared(found)]),
        Section("How this was done", [Items(_method(found)), Text(CITE)]),
    ]
    lead = " ".join(in_words(found))
    return write_report(folder, Report("A metric fitted to answers", lead, sections))


def _weights_drawn(found: FittedMetric) -> Figure:
    table = found.weights
    names = [str(group) for group in table.index]
    return Figure(
        figure_weights(names, table.relative, table.relative_low, table.relative_high),
        "How much each joint group weighs, relative to the others; lines hold 95 of 100 samples of "
        "other observers and walkers.",
        "; ".join(f"{in_plain(group)} {row.relative:.2f}" for group, row in table.iterrows()),
    )


def _weights_table(found: FittedMetric) -> Table:
    rows = [
        [
            in_plain(group),
            float(row.weight),
            float(row.relative),
            f"{row.relative_low:.2f} to {row.relative_high:.2f}",
            f"{100 * row.share_zero:.0f} %",
        ]
        for group, row in found.weights.iterrows()
    ]
    columns = ["joint group", "weight", "relative", "95 % interval", "samples in which it is 0"]
    return Table(f"Weights of {found.name}, fitted", columns, rows)


def _predictions(found: FittedMetric) -> Figure:
    return Figure(
        figure_predictions(found.pairs.difference, found.pairs.unseen),
        "Each pair as observers saw it, and as weights predict it that were fitted without its two "
        "walkers.",
        f"{len(found.pairs)} points about a diagonal.",
    )


def _compared(found: FittedMetric) -> Table:
    ordered = found.compared.sort_values("cv_pearson", ascending=False)
    rows = [
        [
            str(name),
            int(row.n_weights),
            *map(float, row[["rss", "pearson", "cv_pearson", "cv_rms"]]),
        ]
        for name, row in ordered.iterrows()
    ]
    return Table(
        "Metrics compared, each with the constant and the factor or weights that fit best; the "
        "last two columns are of pairs neither of whose walkers was fitted to",
        ["metric", "weights", "sum of squares", "r", "r, unseen", "error, unseen"],
        rows,
    )


def _method(found: FittedMetric) -> list[str]:
    return [
        "The perceived difference of a pair is the share of times it was shown and not chosen as "
        "the most similar.",
        f"Component and function are those of {found.name}; weights, none below 0, and a free "
        "constant are the least squares, which is one solution for certain.",
        "Intervals are of 1000 samples of observers and walkers, drawn with replacement. Joints "
        "that go together, such as sternum and shoulders, can take each other's weight: their sum "
        "is surer than either.",
        "Pairs that are called unseen are of walkers to whose other pairs no weight was fitted. "
        "But a trial shows four walkers, so that other pairs' differences come in part from trials "
        "that showed these walkers too.",
        "The ceiling is the square root of the answers' reliability (split-half, Spearman and "
        "Brown).",
    ]
