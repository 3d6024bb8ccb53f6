"""The report on a metric fitted to observers' answers: its weights, and what they are worth."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
from scipy.stats import chi2

from eigenwalker.core.atomic_write import write_table
from eigenwalker.plotting.fitted_weights import figure_predictions, figure_weights
from eigenwalker.psychophysics.fit_to_answers import AS_PUBLISHED, FITTED, MetricFit
from eigenwalker.psychophysics.weights_file import BY_CHOICES_NAME, WEIGHTS_NAME, save_weights
from eigenwalker.report.blocks import Block, Figure, Items, Report, Section, Table, Text
from eigenwalker.report.html_report import write_report
from eigenwalker.report.result_files import write_blocks
from eigenwalker.report.words import CITE, TABLES, WORDS, figure, plain_name

FEW_OBSERVERS = 10
"""With fewer, intervals from resampled observers contain the true weights much too rarely."""
AGREEMENT = 0.3
"""Correlation of halves of the observers above which they agree about something."""
PAIRS_NAME, COMPARED_NAME = "pairs.csv", "metrics.csv"


def fit_sentences(fit: MetricFit) -> list[str]:
    """Return the main results of a fit, and doubts about it, in sentences."""
    fitted = {str(name): float(fit.compared[name][FITTED]) for name in fit.compared}
    unanswered = f" ({fit.n_unanswered} more trials had none)" if fit.n_unanswered else ""
    sentences = [
        f"{len(fit.counts.observers)} observers, {fit.counts.chosen.sum():.0f} answers{unanswered},"
        f" {len(fit.pairs)} pairs.",
        f"Fitted to the choices, relative weights are: {_shares(fit.by_choices)}. They predict "
        f"the differences of these pairs with r = {fitted['choices_pearson']:.2f}, "
        f"{_unseen(fitted['choices_cv_pearson'])}.",
        f"Fitted to the differences, as in the paper: {_shares(fit.weights)}, constant "
        f"{fit.model.constant_:.2f}; r = {fitted['pearson']:.2f}, "
        f"{_unseen(fitted['cv_pearson'])}.",
        f"Halves of the observers agree with r = {fit.reliability.halves:.2f}, so that no fit to "
        f"the differences can be expected above {fit.reliability.ceiling:.2f}.",
    ]
    others = fit.compared.drop(index=FITTED).choices_cv_pearson
    if others.notna().any():
        sentences.append(
            f"Of the others, {str(others.idxmax()).removesuffix(AS_PUBLISHED)} predicts choices "
            f"best, r = {others.max():.2f} unseen."
        )
    return sentences + _doubts(fit, fitted["choices_bits"])


def _doubts(fit: MetricFit, bits: float) -> list[str]:
    """Return reasons not to trust the weights, in sentences; nothing if there are none."""
    doubts = []
    n_observers = len(fit.counts.observers)
    likelihood_ratio = 2 * fit.counts.chosen.sum() * bits * np.log(2)
    if likelihood_ratio < chi2.ppf(0.95, len(fit.by_choices)):
        doubts.append(
            "Observers agree with each other, but these distances do not predict what they chose: "
            "was the most different pair to be chosen? This fit takes it for the most similar one."
            if fit.reliability.halves > AGREEMENT
            else "These answers cannot be told from guessing, so the weights say nothing."
        )
    if n_observers < FEW_OBSERVERS:
        doubts.append(
            f"With {n_observers} observers the intervals are too narrow: they rest on how "
            "observers differ."
        )
    return doubts


def _unseen(correlation: float) -> str:
    if np.isnan(correlation):
        return "of unseen walkers unknown, as there are too few"
    return f"of pairs of walkers they have not seen with r = {correlation:.2f}"


def _shares(weights: pd.DataFrame) -> str:
    in_order = weights.relative.sort_values(ascending=False)
    parts = [
        f"{plain_name(name)} {share:.2f}" for name, share in in_order.items() if share >= 0.005
    ]
    return ", ".join(parts) if parts else "none, as no joint group predicts anything"


def weights_side_by_side(fit: MetricFit) -> pd.DataFrame:
    """Return relative weights and their intervals, fitted to choices and to differences."""
    columns = {"relative": "weight", "relative_low": "low", "relative_high": "high"}
    sides = {"choices": fit.by_choices, "differences": fit.weights}
    return pd.concat(
        {name: each[list(columns)].rename(columns=columns) for name, each in sides.items()}, axis=1
    )


def write_metric_fit_report(fit: MetricFit, folder: str | Path) -> Path:
    """Write a report on a fitted metric, with its weights and pairs as CSV; return its page.

    Parameters
    ----------
    fit : MetricFit
        As `fit_to_answers` gives it.
    folder : path
        Made where it does not exist; holds ``report.html`` and four tables.

    Returns
    -------
    Path

    See Also
    --------
    eigenwalker.psychophysics.fit_to_answers : Makes what the page shows.
    write_pair_report : Of two walks.
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    save_weights(fit.weights, folder / WEIGHTS_NAME, metric=fit.name)
    save_weights(fit.by_choices, folder / BY_CHOICES_NAME, metric=fit.name)
    write_table(fit.pairs, folder / PAIRS_NAME)
    write_table(fit.compared, folder / COMPARED_NAME)
    weights: list[Block] = [_weights_figure(fit)]
    for target, table in (("choices", fit.by_choices), ("differences", fit.weights)):
        weights.append(_weights_table(f"Weights of {fit.name}, fitted to {target}", table))
    method = [text.format(metric=fit.name) for text in WORDS["metric"]["fit"]]
    sections = [
        Section("Weights", weights),
        Section("Predictions", [*_predictions(fit), *_comparisons(fit.compared)]),
        Section("How this was done", [Items(method), Text(CITE["prazak2010"])]),
    ]
    lead = " ".join(fit_sentences(fit))
    report = Report("A metric fitted to answers", lead, sections)
    write_blocks(report, Path(folder))
    return write_report(report, folder)


def _weights_figure(fit: MetricFit) -> Figure:
    fits = {"fitted to choices": fit.by_choices, "fitted to differences": fit.weights}
    bars = {
        name: (each.relative, each.relative_low, each.relative_high) for name, each in fits.items()
    }
    drawing = figure_weights([str(group) for group in fit.weights.index], bars)
    shares = "; ".join(f"{name}: {_shares(each)}" for name, each in fits.items())
    return figure(drawing, "weights", shares=shares)


def _weights_table(caption: str, weights: pd.DataFrame) -> Table:
    rows = [
        [
            plain_name(group),
            float(row.weight),
            float(row.relative),
            f"{row.relative_low:.2f} to {row.relative_high:.2f}",
            f"{100 * row.share_zero:.0f} %",
        ]
        for group, row in weights.iterrows()
    ]
    columns = ["joint group", "weight", "relative", "95 % interval", "samples in which it is 0"]
    return Table(caption, columns, rows)


def _predictions(fit: MetricFit) -> list[Figure]:
    predictions = {"choices": fit.pairs.expected_unseen, "differences": fit.pairs.unseen}
    return [
        figure(
            figure_predictions(fit.pairs.difference[known], predicted[known]),
            "predictions",
            target=target,
            n=int(known.sum()),
        )
        for target, predicted in predictions.items()
        if (known := predicted.notna()).any()
    ]


def _comparisons(compared: pd.DataFrame) -> list[Table]:
    tables = []
    for given, columns in WORDS["metric"]["compared"].items():
        best_first = next(column for column in columns if column.endswith("cv_pearson"))
        rows = [
            [str(name), int(row.iloc[0]), *map(float, row.iloc[1:])]
            for name, row in compared.sort_values(best_first, ascending=False)[
                list(columns)
            ].iterrows()
        ]
        caption = TABLES["compared"].format(given=given)
        tables.append(Table(caption, ["metric", *columns.values()], rows))
    return tables
