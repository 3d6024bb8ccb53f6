"""``eigenwalker compare``: how different two walks look, or all pairs of many."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from eigenwalker.cli.capture_options import Reading, reads_captures
from eigenwalker.cli.exit_codes import EXIT_PARTIAL
from eigenwalker.cli.option_names import in_options
from eigenwalker.cli.options import (
    Person,
    ReportFolder,
    TraitFromName,
    WithFlagged,
    load_people,
    option,
    progress_bar,
)
from eigenwalker.io.errors import printable

if TYPE_CHECKING:
    import pandas as pd

    from eigenwalker.metric.frame_metrics import GroupMetric
    from eigenwalker.study.walks import CaptureWalk, Walks

MAX_NEAREST = 10
N_CLUSTERS = 2
POPULATION = ".nc"
MAX_WARNINGS = 3
"""Warnings of readers that are printed; those of many files are mostly the same."""
MAX_REASONS = 3
METRIC = (
    "positions-, angles- or velocities- with sigmoid, absolute or squared; lee; kovar; or a file "
    "of weights that a fit to answers wrote."
)
ANSWERS = (
    "CSV of observers' answers (observer, a, b, c, d, chosen_1, chosen_2): fit the metric's "
    "weights to them."
)


@partial(reads_captures, default="default_")
def compare(
    first: Annotated[
        Path,
        typer.Argument(help="A capture; or a folder of captures or a population (.nc): all pairs."),
    ],
    second: Annotated[
        Path | None, typer.Argument(help="The capture to compare the first one with.")
    ] = None,
    output: ReportFolder = None,
    metric: Annotated[str, option(METRIC)] = "positions-sigmoid",
    own_bodies: Annotated[
        bool, option("Leave walks on their own bodies, not on a mannequin.", "--own-bodies")
    ] = False,
    nearest: Annotated[
        Path | None, option("A capture: which walks of the folder or population are nearest to it?")
    ] = None,
    answers: Annotated[Path | None, option(ANSWERS)] = None,
    clusters: Annotated[
        int | None, option("Clusters in the report on all pairs; left out, 2.")
    ] = None,
    trait: Annotated[str | None, option("Trait of a population: are its classes apart?")] = None,
    trait_from_name: TraitFromName = None,
    person: Person = None,
    with_flagged: WithFlagged = False,
    *,
    reading: Reading,
) -> None:
    """Say how different walks look: two of them, all pairs of many, or those nearest to one.

    With --answers, fit the weights of a metric to what observers chose.

    Ends with 1 when some captures of a folder could not be compared.
    """
    given = {"--nearest": nearest, "--answers": answers, "-o": output, "--clusters": clusters}
    given |= {"--trait": trait, "--trait-from-name": trait_from_name, "--person": person}
    given |= {"--with-flagged": with_flagged or None}
    given |= {option: reading[name] for option, name in _OF_CAPTURES.items()}
    options = {name for name, value in given.items() if value not in (None, "refuse")}
    _check_options(first, second, options)
    if clusters is not None and clusters < 1:
        raise ValueError(f"--clusters {clusters}: expected 1 or more.")
    from eigenwalker.psychophysics.weights_file import load_metric

    chosen = load_metric(metric)
    reading["mannequin"] = not own_bodies
    if second is not None:
        _compare_two(first, second, output, chosen, reading)
        return
    query = None if nearest is None else _captured(nearest, reading)
    table = None if answers is None else _answers(answers, chosen)
    walks = _walks(first, reading, trait, trait_from_name, person, with_flagged)
    if nearest is not None and query is not None:
        _print_nearest(nearest, query, walks, chosen)
    elif table is not None:
        _fit(walks, table, output, chosen)
    else:
        _compare_all(walks, output, chosen, clusters)
    _print_left_out(walks)
    if walks.refused:
        raise typer.Exit(EXIT_PARTIAL)


_OF_CAPTURES = {"--unit": "default_unit", "--rate": "default_rate_hz", "--mapping": "mapping",
                "--partial": "partial", "--subject": "subject"}  # fmt: skip
_OF_MANY = {"--with-flagged", *_OF_CAPTURES}


def _check_options(first: Path, second: Path | None, options: set[str]) -> None:
    """Refuse what cannot be done, and options that would be of no use, before any work."""
    if not first.exists():
        raise ValueError(
            f"{first} does not exist; name a capture, a folder of captures or a population "
            f"({POPULATION})."
        )
    if second is not None:
        _check_two(first, second)
        reason = "is about many walks: name one folder or population"
        _refuse(options - {"-o", *_OF_CAPTURES}, reason)
    elif "--nearest" in options:
        reason = "does not go with --nearest, which prints a list"
        _refuse(options - {"--nearest", *_OF_MANY}, reason)
    elif "--answers" in options:
        _refuse(options - {"--answers", "-o", *_OF_MANY}, "does not go with --answers")
    elif "--clusters" in options and "-o" not in options:
        raise ValueError("--clusters are drawn in a report: give a folder for it too, with -o.")
    if first.suffix.lower() == POPULATION and "--nearest" not in options:
        _refuse(options & set(_OF_CAPTURES), "is for captures, not for a population")


def _check_two(first: Path, second: Path) -> None:
    for one, other in ((first, second), (second, first)):
        if one.is_dir() or one.suffix.lower() == POPULATION:
            kind = "folder" if one.is_dir() else "population"
            raise ValueError(
                f"{one} is a {kind}. Name it alone for all pairs; or ask which of its walks are "
                f"nearest to another: eigenwalker compare {one} --nearest {other}"
            )


def _refuse(options: set[str], reason: str) -> None:
    if options:
        raise ValueError(f"{min(options)} {reason}.")


def _compare_two(
    first: Path, second: Path, output: Path | None, metric: GroupMetric, reading: Reading
) -> None:
    from eigenwalker.metric.clip_distances import compare_walks
    from eigenwalker.metric.published import PUBLISHED
    from eigenwalker.report.pair_report import pair_sentences, remark_sentences, write_pair_report
    from eigenwalker.study.reference_pairs import compare_with_references
    from eigenwalker.study.walks import with_common_rotations

    names = _distinct_names(first, second)
    walks = [_captured(path, reading) for path in (first, second)]
    remarks = {name: walk.remark for name, walk in zip(names, walks, strict=True)}
    clips = {name: walk.clip for name, walk in zip(names, walks, strict=True)}
    comparison = compare_walks(*with_common_rotations(clips).values(), metric=metric)
    metrics = {metric.name: metric} if output is None else {**PUBLISHED, metric.name: metric}
    with progress_bar("Simulated people to compare with") as progress:
        result = compare_with_references(
            comparison, list(metrics.values()), mannequin=reading["mannequin"], progress=progress
        )
    print("\n".join(pair_sentences(result, names)))
    _print_remarks(remark_sentences(remarks))
    if output is not None:
        page = write_pair_report(result, output, names=names, remarks=remarks)
        print(f"Report: {page}")


def _compare_all(
    walks: Walks, output: Path | None, metric: GroupMetric, clusters: int | None
) -> None:
    from eigenwalker.metric.neighbours import label_table
    from eigenwalker.metric.pairwise import pair_table
    from eigenwalker.report.pairs_report import (
        TABLE_NAME,
        pairs_sentences,
        persons_compared,
        printed_labels,
        write_pairs_report,
    )

    n_walks = len(walks.clips)
    if clusters is not None and clusters > n_walks:
        raise ValueError(f"--clusters {clusters}: there are {n_walks} walks.")
    if n_walks < 2:
        raise ValueError(
            f"All pairs need two walks or more; {n_walks} could be used. {_left_out(walks)}"
        )
    with progress_bar("Comparing all pairs") as progress:
        table = pair_table(walks.clips, metric=metric, progress=progress)
    print("\n".join(pairs_sentences(table, metric)))
    if walks.labels:
        print(printed_labels(label_table(table, walks.labels, persons=walks.persons)))
    for sentence in persons_compared(walks):
        print(sentence)
    if output is not None:
        n_clusters = clusters or N_CLUSTERS
        page = write_pairs_report(table, walks, output, metric=metric, n_clusters=n_clusters)
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
    with progress_bar("Fitting to answers") as progress:
        fit = fit_to_answers(
            walks.clips, answers, metric=metric.name, others=others, progress=progress
        )
    print("\n".join(fit_sentences(fit)))
    print(weights_side_by_side(fit).to_string(float_format=lambda x: f"{x:.2f}"))
    if output is not None:
        print(f"Report: {write_metric_fit_report(fit, output)}")


def _print_nearest(path: Path, query: CaptureWalk, walks: Walks, metric: GroupMetric) -> None:
    from eigenwalker.metric.neighbours import nearest_walks
    from eigenwalker.report.pair_report import remark_sentences

    if not walks.clips:
        raise ValueError(f"There is no walk to compare with. {_left_out(walks)}")
    with progress_bar("Comparing") as progress:
        distances = nearest_walks(query.clip, walks.clips, metric=metric, progress=progress)
    shown = distances.head(MAX_NEAREST)
    which = "Nearest"
    if len(shown) < len(distances):
        which = f"The {len(shown)} of {len(distances)} walks nearest"
    print(f"{which} to {path.name} by {metric.name}:")
    for name, distance in shown.items():
        print(f"  {distance:8.4g}  {name}")
    _print_remarks(remark_sentences({path.name: query.remark}))


def _captured(path: Path, reading: Reading) -> CaptureWalk:
    """Return the walk of a capture; errors name its file."""
    from eigenwalker.study.walks import walk_of_capture

    if path.is_dir():
        raise ValueError(f"{path} is a folder; name a capture.")
    try:
        with _summarised_warnings():
            walk = walk_of_capture(path, **reading)
        if walk.clip.cycle is None:
            raise ValueError(walk.clip.not_periodic_reason)
    except (ValueError, OSError) as error:
        reason = str(error).strip()
        raise ValueError(reason if path.name in reason else f"{path}: {reason}") from error
    return walk


def _walks(
    source: Path,
    reading: Reading,
    trait: str | None,
    trait_from_name: str | None,
    person: str | None,
    with_flagged: bool,
) -> Walks:
    """Return all walks of a folder or a population."""
    from eigenwalker.study.walks import walks_of_folder, walks_of_population

    if source.is_dir():
        if trait is not None:
            raise ValueError("--trait is for populations; for a folder give --trait-from-name.")
        with _summarised_warnings(), progress_bar("Reading captures") as progress:
            return walks_of_folder(
                source,
                trait_from_name=trait_from_name,
                person=person,
                with_flagged=with_flagged,
                progress=progress,
                **reading,
            )
    if source.suffix.lower() != POPULATION:
        raise ValueError(
            f"{source} is one walk; name a second one, or a folder or population for all pairs."
        )
    if trait_from_name is not None:
        raise ValueError("--trait-from-name is for folders; for a population give --trait.")
    population = load_people(source, with_flagged, person)
    with progress_bar("Looping walks") as progress:
        return walks_of_population(
            population,
            trait=trait,
            mannequin=reading["mannequin"],
            progress=progress,
        )


def _distinct_names(first: Path, second: Path) -> tuple[str, str]:
    """Return the names of two files, with their folders where they would be the same."""
    if first.name != second.name:
        return first.name, second.name
    return str(first), f"{second} (again)" if first == second else str(second)


def _left_out(walks: Walks) -> str:
    """Return why some walks do not count, in sentences; of many refused, the first few."""
    refused = list(walks.refused.items())[:MAX_REASONS]
    sentences = [f"{name}: {reason.strip().rstrip('.')}." for name, reason in refused]
    if walks.flagged:
        name, reason = next(iter(walks.flagged.items()))
        first = reason.partition(". ")[0].rstrip(".")
        sentences.append(f"{len(walks.flagged)} flagged, such as {name}: {first}.")
        sentences.append("With --with-flagged they count too.")
    return " ".join(sentences)


def _print_left_out(walks: Walks) -> None:
    titles: dict[str, Mapping[str, str]] = {
        "not compared": walks.refused,
        "flagged and left out; --with-flagged counts them too": walks.flagged,
        "to be minded": walks.remarks,
    }
    for title, reasons in titles.items():
        if reasons:
            print(f"{len(reasons)} {title}:", file=sys.stderr)
            for name, reason in reasons.items():
                print(f"  {printable(in_options(f'{name}: {reason}'))}", file=sys.stderr)


def _print_remarks(sentences: list[str]) -> None:
    for sentence in sentences:
        print(f"eigenwalker: {in_options(sentence)}", file=sys.stderr)


@contextmanager
def _summarised_warnings() -> Iterator[None]:
    """Print each warning of readers once, of many files the first few, and how to answer them."""
    from eigenwalker.io.capture_file import RateAssumed
    from eigenwalker.io.up_axis_and_unit import UnitGuessed

    with warnings.catch_warnings(record=True) as caught:
        for kind in (RateAssumed, UnitGuessed):
            warnings.simplefilter("always", kind)
        yield
    messages = list(dict.fromkeys(str(each.message).strip() for each in caught))
    more = f"and {len(messages) - MAX_WARNINGS} more warnings."
    _print_remarks(messages[:MAX_WARNINGS] + ([more] if len(messages) > MAX_WARNINGS else []))
