"""The report on three classes or more that are told apart as a whole."""

from __future__ import annotations

from pathlib import Path

import matplotlib.figure
import numpy as np

from eigenwalker.analysis.several_classes import SeveralClasses
from eigenwalker.plotting.style import INK, SMALL, USUAL, panel
from eigenwalker.population.population import Population
from eigenwalker.report.blocks import Block, Figure, Items, Report, Section, Table
from eigenwalker.report.html_report import write_report
from eigenwalker.report.result_files import made_with, write_figures, write_json, write_tables
from eigenwalker.study.messages import persons_in_report


def several_classes_sentences(found: SeveralClasses) -> list[str]:
    """Return the main results: error, chance, and which classes are confused most."""
    n, k = len(found.labels), len(found.classes)
    whose = "" if found.persons is None else ", each with all walks of their person"
    sentences = [
        f"{found.errors} of {n} walkers ({100 * found.error:.1f} %) are taken for another of {k} "
        f"classes of {found.trait}, when they are left out{whose}, of all that is learnt and "
        "chosen (nested).",
        f"Guessing misses {100 * found.error_of_guessing:.1f} %; always answering the most "
        f"frequent class {100 * found.error_of_most_frequent:.1f} %. Each class counting the same, "
        f"{100 * found.balanced_error:.1f} % are missed.",
    ]
    confused = found.confused[found.confused["walkers"] > 0].head(3)
    if len(confused):
        pairs = "; ".join(
            f"{one} and {other} ({_walkers(n)}, {100 * share:.0f} % of both)"
            for one, other, n, share in confused.to_numpy().tolist()
        )
        sentences.append(f"Confused most are {pairs}.")
    else:
        sentences.append("No class is taken for another.")
    return sentences


def _walkers(number: int) -> str:
    return f"{number} walker" + "s" * (number != 1)


def several_classes_text(found: SeveralClasses) -> str:
    """Return errors by class, the confusion table and the sentences, to be printed."""
    errors = found.table().to_string(index=False, float_format=lambda number: f"{number:.1f}")
    confusion = found.confusion.rename_axis(columns=None).to_string()
    sentences = "\n".join(several_classes_sentences(found))
    return (
        f"{sentences}\n\n{errors}\n\nWalkers of each class (rows) by what they are taken for "
        f"(columns):\n{confusion}"
    )


def write_several_classes_report(
    found: SeveralClasses, population: Population, folder: str | Path
) -> Path:
    """Write a report on several classes, with its tables and figure beside it; return its page.

    Parameters
    ----------
    found : SeveralClasses
        Of `classify_several`.
    population : Population
        Whose walkers they are.
    folder : path
        Made where it does not exist.

    Returns
    -------
    Path
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    errors, confusion, confused = found.table(), found.confusion, found.confused
    drawn = _figure(found)
    blocks: list[Block] = [
        Table(
            "Walkers left out, by class",
            [str(name) for name in errors],
            [
                [str(name), int(n), int(wrong), f"{share:.1f}", str(most) or None]
                for name, n, wrong, share, most in errors.itertuples(index=False)
            ],
        ),
        Figure(
            drawn,
            "Walkers of each class (rows) by what they are taken for (columns): on the diagonal "
            "those told right. Dark: a large share of the class.",
            f"Table of {len(found.classes)} by {len(found.classes)} classes.",
        ),
    ]
    if confused["walkers"].any():
        blocks.append(
            Table(
                "Pairs of classes, those confused most first: walkers of one taken for the other",
                ["one class", "other class", "walkers", "of both"],
                [
                    [one, other, n, f"{100 * share:.0f} %"]
                    for one, other, n, share in confused.head(12).to_numpy().tolist()
                    if n
                ],
            )
        )
    method = [
        "A walker is predicted by a linear discriminant analysis of scores on the first "
        "eigenwalkers, with one covariance matrix for all classes, each of which counts the same.",
        f"Walkers are left out in {found.n_folds} groups. Standardisation, eigenwalkers and their "
        f"number ({found.chosen_n.min()} to {found.chosen_n.max()}, by five-fold cross-validation) "
        "are found again without them.",
        *persons_in_report(population.traits.iloc[found.rows]),
    ]
    report = Report(
        f"{found.trait[:1].upper()}{found.trait[1:]} from gait: {len(found.classes)} classes",
        " ".join(several_classes_sentences(found)),
        [
            Section("What is taken for what", blocks),
            Section("How this was done", [Items(method)]),
            Section("Made with", [made_with("Fisher (1936), Annals of Eugenics 7:179.")]),
        ],
    )
    facts = {
        "trait": found.trait,
        "error": found.error,
        "balanced_error": found.balanced_error,
        "error_of_guessing": found.error_of_guessing,
        "error_of_most_frequent": found.error_of_most_frequent,
    }
    walkers = population.traits.iloc[found.rows].assign(predicted=found.predicted)
    tables = {"classes": errors, "confusion": confusion.reset_index(), "predictions": walkers}
    write_tables(tables, folder)
    write_json(facts | tables, folder / "results.json")
    write_figures({"confusion": drawn}, folder)
    return write_report(report, folder)


def _figure(found: SeveralClasses) -> matplotlib.figure.Figure:
    table = found.confusion
    n = len(found.classes)
    figure, axes = panel(min(1.6 + 0.55 * n, 7.0), min(1.2 + 0.45 * n, 6.0))
    shares = table.to_numpy() / table.sum(axis=1).to_numpy()[:, None]
    axes.imshow(shares, cmap="Blues", vmin=0, vmax=1, aspect="auto")
    for (row, column), count in np.ndenumerate(table.to_numpy()):
        ink = "white" if shares[row, column] > 0.6 else INK
        axes.text(column, row, str(count), ha="center", va="center", fontsize=USUAL, color=ink)
    axes.set_xticks(range(n), found.classes, rotation=45, ha="right", fontsize=SMALL)
    axes.set_yticks(range(n), found.classes, fontsize=SMALL)
    axes.set_xlabel("taken for")
    axes.set_ylabel(found.trait)
    return figure
