"""The command line for differences: ``eigenwalker compare A B``, or all pairs of a folder."""

from __future__ import annotations

import re
import sys
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    import pandas as pd

    from eigenwalker.metric.clips import PreparedClip
    from eigenwalker.metric.frame_metrics import GroupMetric
    from eigenwalker.study.walks import Walks

SOME_REFUSED = 1
MOST_NEAREST = 10
N_CLUSTERS = 2
POPULATION = ".nc"
MOST_SAID = 3
"""Warnings of readers that are told; of many files most say the same."""
OF_FILES = (".csv", ".gif", ".html", ".jpg", ".json", ".mp4", ".nc", ".pdf", ".png", ".svg", ".txt")
AS_OPTIONS = (
    (r"read_mocap\(\.\.\., unit='?([^')]+)'?\)", r"--unit \1"),
    (r"read_mocap\(\.\.\., rate_hz='?([^')]+)'?\)", r"--rate \1"),
)
"""What readers advise in Python, as one types it here."""


def compare(
    first: Annotated[
        Path,
        typer.Argument(help="A capture; or a folder of captures or a population (.nc): all pairs."),
    ],
    second: Annotated[
        Path | None, typer.Argument(help="The capture to compare the first one with.")
    ] = None,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="Folder to write a report into.")
    ] = None,
    metric: Annotated[
        str,
        typer.Option(
            help="positions-, angles- or velocities- with sigmoid, absolute or squared; lee; "
            "kovar; or a file of weights that a fit to answers wrote."
        ),
    ] = "positions-sigmoid",
    own_bodies: Annotated[
        bool,
        typer.Option("--own-bodies", help="Leave walks on their own bodies, not on a mannequin."),
    ] = False,
    nearest: Annotated[
        Path | None,
        typer.Option(help="A capture: which walks of the folder or population are nearest to it?"),
    ] = None,
    answers: Annotated[
        Path | None,
        typer.Option(
            help="CSV of observers' answers (observer, a, b, c, d, chosen_1, chosen_2): fit the "
            "metric's weights to them."
        ),
    ] = None,
    clusters: Annotated[
        int | None, typer.Option(help="Clusters in the report on all pairs; left out, 2.")
    ] = None,
    trait: Annotated[
        str | None, typer.Option(help="Trait of a population: are its classes apart?")
    ] = None,
    trait_from_name: Annotated[
        str | None,
        typer.Option(help="The same for a folder, of names: 'walk_(?P<style>[a-z]+)_'."),
    ] = None,
    with_flagged: Annotated[
        bool, typer.Option("--with-flagged", help="Count flagged walks among many too.")
    ] = False,
    unit: Annotated[
        str | None,
        typer.Option(help="Unit of length, for files that name none: mm, cm, m, in, asf."),
    ] = None,
    rate: Annotated[
        float | None, typer.Option(help="Frames a second, for files that name none.")
    ] = None,
) -> None:
    """Say how different walks look: two of them, all pairs of many, or those nearest to one.

    With --answers, fit the weights of a metric to what observers chose.

    Ends with 1 when some captures of a folder could not be compared.
    """
    given = {
        "--nearest": nearest is not None,
        "--answers": answers is not None,
        "-o": output is not None,
        "--clusters": clusters is not None,
        "--trait": trait is not None,
        "--trait-from-name": trait_from_name is not None,
        "--with-flagged": with_flagged,
        "--unit": unit is not None,
        "--rate": rate is not None,
    }
    _refuse_at_the_door(first, second, output, given)
    if clusters is not None and clusters < 1:
        raise ValueError(f"--clusters {clusters}: expected 1 or more.")
    from eigenwalker.psychophysics.weights_file import load_metric

    chosen = load_metric(metric)
    told = {"mannequin": not own_bodies, "unit": unit, "rate_hz": rate}
    if second is not None:
        _compare_two(first, second, output, chosen, told)
        return
    labels = {"trait": trait, "trait_from_name": trait_from_name, "with_flagged": with_flagged}
    if nearest is not None:
        query = _prepared(nearest, told)
        walks = _walks(first, told, labels)
        _print_nearest(nearest, query, walks, chosen)
    elif answers is not None:
        table = _answers(answers, chosen)
        walks = _walks(first, told, labels)
        _fit(walks, table, output, chosen)
    else:
        walks = _walks(first, told, labels)
        _compare_all(walks, output, chosen, clusters)
    _say_what_is_left_out(walks)
    if walks.refused:
        raise typer.Exit(SOME_REFUSED)


def _refuse_at_the_door(
    first: Path, second: Path | None, output: Path | None, given: dict[str, bool]
) -> None:
    """Refuse what cannot be done, and options that would be of no use, before any work."""
    if not first.exists():
        raise ValueError(
            f"{first} does not exist; name a capture, a folder of captures or a population "
            f"({POPULATION})."
        )
    if second is not None:
        _refuse_many(first, second)
        _refuse(
            given, {"-o", "--unit", "--rate"}, "is about many walks: name one folder or population"
        )
    elif given["--nearest"]:
        allowed = {"--nearest", "--with-flagged", "--unit", "--rate"}
        _refuse(given, allowed, "does not go with --nearest, which prints a list")
    elif given["--answers"]:
        allowed = {"--answers", "-o", "--with-flagged", "--unit", "--rate"}
        _refuse(given, allowed, "does not go with --answers")
    elif given["--clusters"] and not given["-o"]:
        raise ValueError("--clusters are drawn in a report: give a folder for it too, with -o.")
    if first.suffix.lower() == POPULATION and not given["--nearest"]:
        _refuse(given, set(given) - {"--unit", "--rate"}, "is for captures, not for a population")
    if output is None:
        return
    above = next(each for each in (output, *output.absolute().parents) if each.exists())
    if not above.is_dir():
        raise ValueError(f"-o {output}: {above} is a file; name a folder to write a report into.")
    if output.suffix.lower() in OF_FILES and not output.exists():
        raise ValueError(
            f"-o {output} is called like a file; name a folder. The report with its pictures, "
            "and tables as CSV, are written into it."
        )


def _refuse_many(first: Path, second: Path) -> None:
    for one, other in ((first, second), (second, first)):
        if one.is_dir() or one.suffix.lower() == POPULATION:
            kind = "folder" if one.is_dir() else "population"
            raise ValueError(
                f"{one} is a {kind}. Name it alone for all pairs; or ask which of its walks are "
                f"nearest to another: eigenwalker compare {one} --nearest {other}"
            )


def _refuse(given: dict[str, bool], allowed: set[str], why: str) -> None:
    for option, is_given in given.items():
        if is_given and option not in allowed:
            raise ValueError(f"{option} {why}.")


def _say_what_is_left_out(walks: Walks) -> None:
    for many, said in (
        ("not compared", walks.refused),
        ("flagged and left out; --with-flagged counts them too", walks.flagged),
        ("to be minded", walks.remarks),
    ):
        if said:
            lines = [f"{len(said)} {many}:", *(f"  {name}: {why}" for name, why in said.items())]
            print("\n".join(lines), file=sys.stderr)


def _compare_two(
    first: Path, second: Path, output: Path | None, metric: GroupMetric, told: dict
) -> None:
    from eigenwalker.metric.comparison import compare_walks
    from eigenwalker.metric.published import PUBLISHED
    from eigenwalker.report.pair_report import in_words, remarks_on_both, write_two_walks
    from eigenwalker.study.reference_pairs import simulated_pairs
    from eigenwalker.study.walks import with_like_rotations

    names = _apart(first, second)
    a, b = with_like_rotations({"a": _prepared(first, told), "b": _prepared(second, told)}).values()
    found = compare_walks(a, b, metric=metric)
    asked = {metric.name: metric} if output is None else {**PUBLISHED, metric.name: metric}
    with _bar("Simulated people to compare with") as progress:
        reference = simulated_pairs(
            list(asked.values()), mannequin=told["mannequin"], progress=progress
        )
    print("\n".join(in_words(found, names, reference)))
    for remark in remarks_on_both(found, names):
        print(f"eigenwalker: {remark}", file=sys.stderr)
    if output is not None:
        print(f"Report: {write_two_walks(output, found, names, reference)}")


def _compare_all(
    walks: Walks, output: Path | None, metric: GroupMetric, clusters: int | None
) -> None:
    from eigenwalker.report.pairs_report import (
        TABLE_NAME,
        label_table,
        labels_in_words,
        summary,
        table_of,
        write_all_pairs,
    )

    if clusters is not None and clusters > len(walks.clips):
        raise ValueError(f"--clusters {clusters}: there are {len(walks.clips)} walks.")
    with _bar("Comparing all pairs") as progress:
        table = table_of(walks, metric, progress=progress)
    print("\n".join(summary(table, metric)))
    if walks.labels:
        print(labels_in_words(label_table(table, walks.labels)))
    if output is not None:
        page = write_all_pairs(output, table, walks, metric, n_clusters=clusters or N_CLUSTERS)
        print(f"Table: {output / TABLE_NAME}\nReport: {page}")


def _answers(path: Path, metric: GroupMetric) -> pd.DataFrame:
    """Return observers' answers; refused before any walk is read if they cannot be fitted to."""
    from eigenwalker.metric.published import PUBLISHED
    from eigenwalker.psychophysics.trials import read_answers

    if metric.name not in PUBLISHED:
        raise ValueError("--answers finds weights of its own: name a published --metric.")
    table = read_answers(path)
    if table.observer.nunique() < 2:
        raise ValueError(
            f"The answers {path} are of {table.observer.nunique()} observer; intervals come from "
            "how two or more differ. In Python, ew.psychophysics.fit_choices takes one observer."
        )
    return table


def _fit(walks: Walks, answers: pd.DataFrame, output: Path | None, metric: GroupMetric) -> None:
    from eigenwalker.psychophysics.fit_to_answers import fit_to_answers
    from eigenwalker.report.metric_fit_report import (
        fit_sentences,
        weights_side_by_side,
        write_metric_fit_report,
    )
    from eigenwalker.study.walks import walker_space_distances

    others = {"distance in walker space": walker_space_distances(walks)} if walks.vectors else {}
    with _bar("Fitting to answers") as progress:
        fit = fit_to_answers(
            walks.clips, answers, metric=metric.name, others=others, progress=progress
        )
    print("\n".join(fit_sentences(fit)))
    print(weights_side_by_side(fit).to_string(float_format=lambda x: f"{x:.2f}"))
    if output is not None:
        print(f"Report: {write_metric_fit_report(fit, output)}")


def _print_nearest(path: Path, query: PreparedClip, walks: Walks, metric: GroupMetric) -> None:
    from eigenwalker.report.pairs_report import nearest_walks
    from eigenwalker.study.walks import remarks_on

    with _bar("Comparing") as progress:
        found = nearest_walks(query, walks, metric, progress=progress)
    shown = found.head(MOST_NEAREST)
    which = (
        f"The {len(shown)} of {len(found)} walks nearest" if len(shown) < len(found) else "Nearest"
    )
    print(f"{which} to {path.name} by {metric.name}:")
    for name, distance in shown.items():
        print(f"  {distance:8.4g}  {name}")
    if remark := remarks_on(query.clip):
        print(f"eigenwalker: Mind {path.name}: {remark}", file=sys.stderr)


def _prepared(path: Path, told: dict) -> PreparedClip:
    from eigenwalker.study.walks import repeating, walk_of_capture

    if path.is_dir():
        raise ValueError(f"{path} is a folder; name a capture.")
    try:
        with _told_as_options():
            return repeating(walk_of_capture(path, **told))
    except (ValueError, OSError) as error:
        said = _as_options(str(error))
        raise ValueError(said if path.name in said else f"{path}: {said}") from error


def _walks(source: Path, told: dict, labels: dict) -> Walks:
    from eigenwalker.study.walks import walks_of_folder, walks_of_population

    if source.is_dir():
        if labels.pop("trait") is not None:
            raise ValueError("--trait is for populations; for a folder give --trait-from-name.")
        with _told_as_options(), _bar("Reading captures") as progress:
            return walks_of_folder(source, progress=progress, **labels, **told)
    if source.suffix.lower() != POPULATION:
        raise ValueError(
            f"{source} is one walk; name a second one, or a folder or population for all pairs."
        )
    if labels["trait_from_name"] is not None:
        raise ValueError("--trait-from-name is for folders; for a population give --trait.")
    from eigenwalker.datasets.built_in import load_population

    population = load_population(source)
    if labels["with_flagged"]:
        population = population.without_flags()
    with _bar("Looping walks") as progress:
        return walks_of_population(
            population, trait=labels["trait"], mannequin=told["mannequin"], progress=progress
        )


def _apart(first: Path, second: Path) -> tuple[str, str]:
    """Names of two files, with their folders where they would be the same."""
    if first.name != second.name:
        return first.name, second.name
    return str(first), f"{second} (again)" if first == second else str(second)


@contextmanager
def _told_as_options() -> Iterator[None]:
    """Say what readers warn of in words of this command line, of many files the first few."""
    from eigenwalker.io.capture_file import RateAssumed
    from eigenwalker.io.up_axis_and_unit import UnitGuessed

    with warnings.catch_warnings(record=True) as caught:
        for kind in (RateAssumed, UnitGuessed):
            warnings.simplefilter("always", kind)
        yield
    said = list(dict.fromkeys(_as_options(str(each.message)) for each in caught))
    for words in said[:MOST_SAID]:
        print(f"eigenwalker: {words}", file=sys.stderr)
    if len(said) > MOST_SAID:
        print(f"eigenwalker: and {len(said) - MOST_SAID} more warnings.", file=sys.stderr)


def _as_options(words: str) -> str:
    for python, option in AS_OPTIONS:
        words = re.sub(python, option, words)
    return words.strip()


@contextmanager
def _bar(title: str) -> Iterator[Callable[[int, int], None]]:
    """A progress bar on the error stream, and what to call as work proceeds."""
    from rich.console import Console
    from rich.progress import Progress

    console = Console(stderr=True)
    with Progress(console=console, transient=True, disable=not console.is_terminal) as progress:
        task = progress.add_task(title, total=None)
        yield lambda done, total: progress.update(task, completed=done, total=total)
