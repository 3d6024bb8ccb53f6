"""The report on a metric fitted to observers' answers: its weights, and what they are worth."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.spatial.distance import pdist
from scipy.stats import chi2
from sklearn.model_selection import cross_val_predict

from eigenwalker.analysis.walker_space import WalkerSpace
from eigenwalker.core.progress import Progress
from eigenwalker.metric.comparison import by_metric
from eigenwalker.metric.group_tables import group_table
from eigenwalker.metric.published import PUBLISHED
from eigenwalker.plotting.fitted_weights import figure_predictions, figure_weights
from eigenwalker.psychophysics.choice_prediction import compare_by_choices, unseen_differences
from eigenwalker.psychophysics.conditional_logit import (
    bootstrap_choices,
    expected_differences,
    fit_choices,
)
from eigenwalker.psychophysics.cross_validation import compare_metrics, leave_walkers_out
from eigenwalker.psychophysics.perceptual_metric import PerceptualMetric
from eigenwalker.psychophysics.reliability import (
    Bootstrap,
    Reliability,
    bootstrap_weights,
    split_half,
)
from eigenwalker.psychophysics.trials import PairCounts, as_name, count_pairs, read_trials
from eigenwalker.psychophysics.weights_file import BY_CHOICES_NAME, WEIGHTS_NAME, write_weights
from eigenwalker.report.blocks import Figure, Items, Report, Section, Table, Text
from eigenwalker.report.html_report import write_report
from eigenwalker.report.pair_report import CITE, in_plain
from eigenwalker.study.walks import Walks

FITTED, AS_PUBLISHED = "fitted to these answers", ", as published"
FEW_OBSERVERS = 10
"""Below so many, intervals from drawing observers hold planted weights much too seldom."""
AGREED = 0.3
"""Correlation of halves of the observers above which they are of one mind about something."""
PAIRS_NAME, COMPARED_NAME = "pairs.csv", "metrics.csv"


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
    weights, by_choices : DataFrame of groups
        Weights fitted to shares and to choices: ``weight``, ``relative`` and the columns of
        `Bootstrap.intervals`.
    pairs : DataFrame of pairs
        ``shown``, ``difference``, ``predicted``, and ``unseen``: predicted by weights to which
        neither walker of the pair had contributed; ``expected`` and ``expected_unseen``, the same
        by weights fitted to choices.
    compared : DataFrame of metrics
        As `compare_metrics` gives it, and ``choices_`` before the columns of `compare_by_choices`.
    reliability : Reliability
        Of the answers.
    n_silent : int
        Trials without an answer.

    """

    name: str
    model: PerceptualMetric
    counts: PairCounts
    weights: pd.DataFrame
    by_choices: pd.DataFrame
    pairs: pd.DataFrame
    compared: pd.DataFrame
    reliability: Reliability
    n_silent: int = 0


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
        Called with what is done and what there is to do: pairs, then samples, then metrics.

    Raises
    ------
    ValueError
        If answers name walks that are not there, or no pair was shown. Pairs that were never shown
        together are left out, with a warning.

    """
    names = list(walks.clips)
    trials = read_trials(_named_as(answers, names), walkers=names)
    counts = count_pairs(trials)
    y = counts.differences.to_numpy()
    kept = np.isfinite(y)
    if not kept.all():
        first, second = counts.pairs[int(kept.argmin())]
        warnings.warn(
            f"{(~kept).sum()} of {len(y)} pairs were never shown together, such as {first} and "
            f"{second}; they are left out of the fit.",
            stacklevel=2,
        )
    table = group_table(walks.clips, metric, progress=progress)
    published = by_metric(walks.clips, list(PUBLISHED))
    others = {name + AS_PUBLISHED: published[name].to_numpy() for name in PUBLISHED}
    tables = {FITTED: table.to_numpy(), **others}
    if walks.vectors:
        vectors = np.stack([walks.vectors[name] for name in names])
        tables["distance in walker space"] = pdist(WalkerSpace().fit_transform(vectors))
    X, y, pairs = table[kept], y[kept], counts.pairs[kept].tolist()
    chosen, shown = counts.chosen[:, kept], counts.shown[:, kept]
    model = PerceptualMetric().fit(X, y)
    to_choices = fit_choices(table, trials)
    by_shares = compare_metrics({name: each[kept] for name, each in tables.items()}, y, pairs)
    return FittedMetric(
        name=metric,
        model=model,
        counts=counts,
        weights=_with_intervals(
            list(X.columns), model.weights_, bootstrap_weights(X, chosen, shown, pairs=pairs)
        ),
        by_choices=_with_intervals(
            list(X.columns), to_choices.weights, bootstrap_choices(table, trials, progress=progress)
        ),
        pairs=pd.DataFrame(
            {
                "shown": shown.sum(axis=0),
                "difference": y,
                "predicted": model.predict(X),
                "unseen": cross_val_predict(PerceptualMetric(), X, y, cv=leave_walkers_out(pairs)),
                "expected": expected_differences(table @ to_choices.weights, trials)[kept],
                "expected_unseen": unseen_differences(table, trials)[kept],
            },
            index=counts.pairs[kept],
        ),
        compared=by_shares.join(
            compare_by_choices(tables, trials, progress=progress).add_prefix("choices_")
        ),
        reliability=split_half(chosen, shown),
        n_silent=len(answers) - len(trials.chosen),
    )


def _with_intervals(groups: list[str], weights: np.ndarray, sampled: Bootstrap) -> pd.DataFrame:
    total = weights.sum()
    relative = weights / total if total > 0 else weights
    table = pd.DataFrame({"weight": weights, "relative": relative}, index=groups)
    return table.join(sampled.intervals(groups)).rename_axis("group")


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
    fitted = _of_fitted(found)
    others = found.compared.drop(index=FITTED)
    silent = f" ({found.n_silent} more trials had none)" if found.n_silent else ""
    n_observers = len(found.counts.observers)
    said = [
        f"{n_observers} observers, {found.counts.chosen.sum():.0f} answers{silent}, "
        f"{len(found.pairs)} pairs.",
        f"Fitted to the choices, relative weights are: {_shares_in_words(found.by_choices)}. They "
        f"predict the differences of these pairs with r = {fitted['choices_pearson']:.2f}, "
        f"{_of_unseen(fitted['choices_cv_pearson'])}.",
        f"Fitted to the differences, as in the paper: {_shares_in_words(found.weights)}, constant "
        f"{found.model.constant_:.2f}; r = {fitted['pearson']:.2f}, "
        f"{_of_unseen(fitted['cv_pearson'])}.",
        f"Halves of the observers agree with r = {found.reliability.halves:.2f}, so that no fit to "
        f"the differences can be expected above {found.reliability.ceiling:.2f}.",
    ]
    best = others.choices_cv_pearson
    if best.notna().any():
        said.append(
            f"Of the others, {str(best.idxmax()).removesuffix(AS_PUBLISHED)} predicts choices "
            f"best, r = {best.max():.2f} unseen."
        )
    return said + _doubts(found)


def _of_fitted(found: FittedMetric) -> dict[str, float]:
    return {str(name): float(found.compared[name][FITTED]) for name in found.compared}


def _doubts(found: FittedMetric) -> list[str]:
    """Return what speaks against trusting the weights, in sentences; nothing if nothing does."""
    fitted, doubts = _of_fitted(found), []
    n_trials, n_groups = found.counts.chosen.sum(), len(found.by_choices)
    gain = 2 * n_trials * fitted["choices_bits"] * np.log(2)
    tells_nothing = gain < chi2.ppf(0.95, n_groups)
    if tells_nothing and found.reliability.halves > AGREED:
        doubts.append(
            "Observers agree with each other, but these distances tell nothing of what they chose: "
            "was the most different pair to be chosen? This fit takes it for the most similar one."
        )
    elif tells_nothing:
        doubts.append("These answers cannot be told from guessing, so the weights say nothing.")
    if len(found.counts.observers) < FEW_OBSERVERS:
        doubts.append(
            f"With {len(found.counts.observers)} observers the intervals are too narrow: they rest "
            "on how observers differ."
        )
    return doubts


def _of_unseen(correlation: float) -> str:
    if np.isnan(correlation):
        return "of unseen walkers unknown, as there are too few"
    return f"of pairs of walkers they have not seen with r = {correlation:.2f}"


def weights_side_by_side(found: FittedMetric) -> pd.DataFrame:
    """Return relative weights and their intervals, fitted to choices and to differences."""
    columns = {"relative": "weight", "relative_low": "low", "relative_high": "high"}
    sides = {"choices": found.by_choices, "differences": found.weights}
    return pd.concat(
        {name: each[list(columns)].rename(columns=columns) for name, each in sides.items()}, axis=1
    )


def _shares_in_words(weights: pd.DataFrame) -> str:
    most = weights.relative.sort_values(ascending=False)
    parts = [f"{in_plain(group)} {share:.2f}" for group, share in most.items() if share >= 0.005]
    return ", ".join(parts) if parts else "none, as no joint group tells anything"


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
    write_weights(folder / BY_CHOICES_NAME, found.by_choices, found.name)
    found.pairs.to_csv(folder / PAIRS_NAME)
    found.compared.to_csv(folder / COMPARED_NAME)
    sections = [
        Section(
            "Weights",
            [
                _weights_drawn(found),
                _weights_table("choices", found.name, found.by_choices),
                _weights_table("differences", found.name, found.weights),
            ],
        ),
        Section("Predictions", [*_predictions(found), *_compared(found)]),
        Section("How this was done", [Items(_method(found)), Text(CITE)]),
    ]
    lead = " ".join(in_words(found))
    return write_report(folder, Report("A metric fitted to answers", lead, sections))


def _weights_drawn(found: FittedMetric) -> Figure:
    names = [str(group) for group in found.weights.index]
    fits = {"fitted to choices": found.by_choices, "fitted to differences": found.weights}
    return Figure(
        figure_weights(
            names,
            {
                name: (each.relative, each.relative_low, each.relative_high)
                for name, each in fits.items()
            },
        ),
        "How much each joint group weighs, relative to the others; lines hold 95 of 100 samples, "
        "of other observers for choices, of other observers and walkers for differences.",
        "; ".join(f"{name}: {_shares_in_words(each)}" for name, each in fits.items()),
    )


def _weights_table(what: str, name: str, weights: pd.DataFrame) -> Table:
    rows = [
        [
            in_plain(group),
            float(row.weight),
            float(row.relative),
            f"{row.relative_low:.2f} to {row.relative_high:.2f}",
            f"{100 * row.share_zero:.0f} %",
        ]
        for group, row in weights.iterrows()
    ]
    columns = ["joint group", "weight", "relative", "95 % interval", "samples in which it is 0"]
    return Table(f"Weights of {name}, fitted to {what}", columns, rows)


def _predictions(found: FittedMetric) -> list[Figure]:
    return [
        Figure(
            figure_predictions(found.pairs.difference[known], predicted[known]),
            f"Each pair as observers saw it, and as weights fitted to {what} predict it that know "
            "neither of its two walkers.",
            f"{int(known.sum())} points about a diagonal.",
        )
        for what, predicted in (
            ("choices", found.pairs.expected_unseen),
            ("differences", found.pairs.unseen),
        )
        if (known := predicted.notna()).any()
    ]


def _compared(found: FittedMetric) -> list[Table]:
    return [
        _compared_by(
            found.compared,
            f"Metrics compared, each with the {what}; unseen are pairs neither of whose walkers "
            "was fitted to",
            columns,
        )
        for what, columns in (
            (
                "factor or weights that fit the choices best",
                {
                    "choices_n_weights": "weights",
                    "choices_bits": "bits above guessing",
                    "choices_pearson": "r",
                    "choices_cv_pearson": "r, unseen",
                },
            ),
            (
                "constant and the factor or weights that fit the differences best",
                {
                    "n_weights": "weights",
                    "rss": "sum of squares",
                    "pearson": "r",
                    "cv_pearson": "r, unseen",
                    "cv_rms": "error, unseen",
                },
            ),
        )
    ]


def _compared_by(compared: pd.DataFrame, title: str, columns: dict[str, str]) -> Table:
    order = next(column for column in columns if column.endswith("cv_pearson"))
    rows = [
        [str(name), int(row.iloc[0]), *map(float, row.iloc[1:])]
        for name, row in compared.sort_values(order, ascending=False)[list(columns)].iterrows()
    ]
    return Table(title, ["metric", *columns.values()], rows)


def _method(found: FittedMetric) -> list[str]:
    return [
        "The perceived difference of a pair is the share of times it was shown and not chosen as "
        "the most similar.",
        f"Component and function are those of {found.name}; no weight is below 0.",
        "Fitted to choices, weights make the pairs chosen most likely, if a pair's odds against "
        "another shown beside it fall as e to the power of their distances' difference. This "
        "likelihood has one maximum. Intervals are of 1000 samples of observers.",
        "Fitted to differences, as in the paper, weights and a free constant are the least "
        "squares, of which there is one. Shares of choices level off where walks differ much, and "
        "no sum of distances does; weights of groups that go together then get mixed up. "
        "Intervals are of 1000 samples of observers and walkers.",
        "Unseen are pairs of walkers to whose other pairs no weight was fitted. For choices none "
        "of the trials counted that showed one of the two. For differences other pairs' shares "
        "come in part from such trials.",
        "What no fit to the differences can be expected to exceed is the square root of their "
        "reliability (split-half, Spearman and Brown). Choices are predicted knowing what else was "
        "shown, which differences do not, so that they can be predicted better.",
    ]
