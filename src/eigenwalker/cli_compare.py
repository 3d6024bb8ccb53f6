"""The command line for differences: ``eigenwalker compare A B``, or all pairs of a folder."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from eigenwalker.metric.prepared import PreparedClip
    from eigenwalker.report.compared_walks import Walks

SOME_REFUSED = 1
MOST_NEAREST = 10


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
            help="positions-, angles- or velocities- with sigmoid, absolute or squared; lee; kovar."
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
    clusters: Annotated[int, typer.Option(help="Clusters among all pairs.")] = 2,
    trait: Annotated[
        str | None, typer.Option(help="Trait of a population: are its classes apart?")
    ] = None,
    trait_from_name: Annotated[
        str | None,
        typer.Option(help="The same for a folder, of names: 'walk_(?P<style>[a-z]+)_'."),
    ] = None,
    with_flagged: Annotated[
        bool, typer.Option("--with-flagged", help="Count flagged walkers of a population too.")
    ] = False,
    unit: Annotated[
        str | None, typer.Option(help="Unit of length, for files that name none: mm, cm, m, asf.")
    ] = None,
    rate: Annotated[
        float | None, typer.Option(help="Frames a second, for files that name none.")
    ] = None,
) -> None:
    """Say how different walks look: two of them, all pairs of many, or those nearest to one.

    With --answers, fit the weights of a metric to what observers chose.

    Ends with 1 when some captures of a folder could not be compared.
    """
    from eigenwalker.metric.published import metric_named

    metric_named(metric)
    told = {"mannequin": not own_bodies, "unit": unit, "rate_hz": rate}
    if second is not None:
        if nearest is not None or answers is not None:
            raise ValueError(
                "--nearest and --answers are about many walks: name one folder or population."
            )
        _compare_two(first, second, output, metric, told)
        return
    labels = {"trait": trait, "trait_from_name": trait_from_name, "with_flagged": with_flagged}
    walks = _walks(first, told, labels)
    if nearest is not None:
        _print_nearest(nearest, walks, metric, told)
    elif answers is not None:
        _fit(walks, answers, output, metric)
    else:
        _compare_all(walks, output, metric, clusters)
    if walks.refused:
        print(f"{len(walks.refused)} not compared:", file=sys.stderr)
        print("".join(f"  {name}: {why}\n" for name, why in walks.refused.items()), file=sys.stderr)
        raise typer.Exit(SOME_REFUSED if first.is_dir() else 0)


def _compare_two(first: Path, second: Path, output: Path | None, metric: str, told: dict) -> None:
    from eigenwalker.metric.comparison import compare_walks
    from eigenwalker.metric.published import PUBLISHED
    from eigenwalker.report.compared_walks import with_like_rotations
    from eigenwalker.report.two_walks import in_words, reference_pairs, write_two_walks

    names = _apart(first, second)
    a, b = with_like_rotations({"a": _prepared(first, told), "b": _prepared(second, told)}).values()
    found = compare_walks(a, b, metric=metric)
    with _bar("Simulated people to compare with") as progress:
        reference = reference_pairs(
            [metric] if output is None else list(PUBLISHED),
            mannequin=told["mannequin"],
            progress=progress,
        )
    print("\n".join(in_words(found, names, reference)))
    if output is not None:
        print(f"Report: {write_two_walks(output, found, names, reference)}")


def _compare_all(walks: Walks, output: Path | None, metric: str, clusters: int) -> None:
    from eigenwalker.report.all_pairs import (
        TABLE_NAME,
        label_table,
        summary,
        table_of,
        write_all_pairs,
    )

    with _bar("Comparing all pairs") as progress:
        table = table_of(walks, metric, progress=progress)
    print("\n".join(summary(table, metric)))
    if walks.labels:
        print(label_table(table, walks.labels).to_string(float_format=lambda x: f"{x:.3g}"))
    if output is not None:
        page = write_all_pairs(output, table, walks, metric, n_clusters=clusters)
        print(f"Table: {output / TABLE_NAME}\nReport: {page}")


def _fit(walks: Walks, answers: Path, output: Path | None, metric: str) -> None:
    import pandas as pd

    from eigenwalker.report.fitted_metric import fit_answers, in_words, write_fitted_metric

    try:
        table = pd.read_csv(answers, dtype=str)
    except (ValueError, OSError) as error:
        raise ValueError(f"The answers {answers} could not be read as CSV: {error}") from error
    with _bar("Comparing all pairs") as progress:
        found = fit_answers(walks, table, metric, progress=progress)
    print("\n".join(in_words(found)))
    print(found.weights.to_string(float_format=lambda x: f"{x:.3g}"))
    if output is not None:
        print(f"Report: {write_fitted_metric(output, found)}")


def _print_nearest(query: Path, walks: Walks, metric: str, told: dict) -> None:
    from eigenwalker.report.all_pairs import nearest_walks

    prepared = _prepared(query, told)
    with _bar("Comparing") as progress:
        found = nearest_walks(prepared, walks, metric, progress=progress)
    print(f"Nearest to {query.name} by {metric}:")
    for name, distance in found.head(MOST_NEAREST).items():
        print(f"  {distance:8.4g}  {name}")


def _prepared(path: Path, told: dict) -> PreparedClip:
    from eigenwalker.report.compared_walks import repeating, walk_of_capture

    if path.is_dir():
        raise ValueError(f"{path} is a folder; name a capture, or one folder alone for all pairs.")
    return repeating(walk_of_capture(path, **told))


def _walks(source: Path, told: dict, labels: dict) -> Walks:
    from eigenwalker.report.compared_walks import walks_of_folder, walks_of_population

    if source.is_dir():
        if labels["trait"] is not None:
            raise ValueError("--trait is for populations; for a folder give --trait-from-name.")
        with _bar("Reading captures") as progress:
            return walks_of_folder(
                source, trait_from_name=labels["trait_from_name"], progress=progress, **told
            )
    if source.suffix.lower() != ".nc":
        raise ValueError(
            f"{source} is one walk; name a second one, or a folder or population for all pairs."
        )
    from eigenwalker.datasets import load_population

    population = load_population(source)
    if labels["with_flagged"]:
        population = population.trusting_all()
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
def _bar(title: str) -> Iterator[Callable[[int, int], None]]:
    """A progress bar on the error stream, and what to call as work proceeds."""
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task(title, total=None)
        yield lambda done, total: progress.update(task, completed=done, total=total)
