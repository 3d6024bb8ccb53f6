"""``eigenwalker fit`` and ``eigenwalker simulate``: a population, of captures or of nobody."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from eigenwalker.cli.capture_options import Jobs, LowPass, Reading, TraitsTable, reads_captures
from eigenwalker.cli.exit_codes import EXIT_FAILED, EXIT_INTERRUPTED, EXIT_PARTIAL
from eigenwalker.cli.option_names import in_options
from eigenwalker.cli.options import (
    Person,
    PopulationFile,
    Seed,
    TraitFromName,
    check_choice,
    check_output,
    option,
    progress_bar,
)
from eigenwalker.io.errors import printable

if TYPE_CHECKING:
    from eigenwalker.study.fit_folder import Study


@reads_captures
def fit(
    folder: Annotated[Path, typer.Argument(help="Folder of captures, searched with subfolders.")],
    output: PopulationFile,
    traits: TraitsTable = None,
    trait_from_name: TraitFromName = None,
    form: Annotated[
        str, option("'eigenposture' (Troje 2002) or 'fourier' (WDP2002).")
    ] = "eigenposture",
    harmonics: Annotated[int, option("Multiples of the stride frequency.")] = 2,
    low_pass: LowPass = None,
    jobs: Jobs = -1,
    person: Person = None,
    table: Annotated[
        Path | None, option("CSV to write all into that is known of each capture.")
    ] = None,
    fresh: Annotated[
        bool, option("Read all again, also what an interrupted run has read.", "--fresh")
    ] = False,
    *,
    reading: Reading,
) -> None:
    """Make a population of a folder of captures.

    Ends with 0 when all captures were read, 1 when some were refused, 2 when nothing could be used,
    130 when it was interrupted; the same command then goes on where it stopped.
    """
    from eigenwalker.core.atomic_write import write_table
    from eigenwalker.study.fit_folder import fit_folder
    from eigenwalker.study.process_capture import DECOMPOSE

    check_choice(form, DECOMPOSE, "--form")
    check_output(output, "people.nc")
    if table is not None:
        check_output(table, "captures.csv", "--table")
    checkpoint = output.with_name(f"{output.name}.part")
    if fresh:
        checkpoint.unlink(missing_ok=True)
    with _resumable(checkpoint), progress_bar("Reading captures") as progress:
        study = fit_folder(
            folder,
            traits=traits,
            trait_from_name=trait_from_name,
            form=form,  # pyright: ignore[reportArgumentType] - checked above
            n_harmonics=harmonics,
            person=person,
            low_pass_hz=low_pass,
            n_jobs=jobs,
            checkpoint=checkpoint,
            progress=progress,
            **reading,
        )
    if study.population is not None:
        study.population.save(output)
        checkpoint.unlink(missing_ok=True)
    if table is not None:
        write_table(study.files, table, index=False)
    if study.n_resumed:
        resumed = f"{study.n_resumed} of {len(study.files)} captures were read by an earlier run"
        print(f"{resumed}, which was interrupted; --fresh reads all again.", file=sys.stderr)
    _print_problems(study)
    if study.population is None:
        print(f"No capture of {len(study.files)} could be used.", file=sys.stderr)
        raise typer.Exit(EXIT_FAILED)
    _print_summary(study, output)
    if len(study.refused):
        raise typer.Exit(EXIT_PARTIAL)


@contextmanager
def _resumable(checkpoint: Path) -> Iterator[None]:
    """Say, when work is interrupted, where it is kept and how to go on."""
    try:
        yield
    except KeyboardInterrupt:
        where = f"What was read is kept in {checkpoint}. " if checkpoint.is_file() else ""
        how = "The same command goes on where it stopped; with --fresh it begins again."
        print(f"eigenwalker: interrupted. {where}{how}", file=sys.stderr)
        raise typer.Exit(EXIT_INTERRUPTED) from None


def _print_problems(study: Study) -> None:
    for status in ("flagged", "refused"):
        files = study.files[study.files["status"] == status]
        if len(files):
            print(f"{len(files)} {status}:")
            for row in files.itertuples():
                print(f"  {printable(in_options(f'{row.file}: {row.reason}'))}")
            print()
    if study.unlisted:
        names = ", ".join(study.unlisted[:5]) + (", ..." if len(study.unlisted) > 5 else "")
        print(
            f"{len(study.unlisted)} captures of the folder are not in the table:", printable(names)
        )


def _print_summary(study: Study, output: Path) -> None:
    from eigenwalker.study.messages import (
        persons_in_words,
        summary_in_words,
        traits_in_words,
    )

    assert study.population is not None
    read = study.files[study.files["status"] != "refused"]
    print(
        f"{len(read)} of {len(study.files)} captures read, "
        f"{(read['status'] == 'flagged').sum()} of them flagged. Medians (and ranges):"
    )
    for name, value in summary_in_words(study.files).items():
        print(f"  {name + ':':<23}{value}")
    if traits := traits_in_words(study.population.traits):
        print("Traits:")
        for line in traits:
            print(f"  {printable(line)}")
    for sentence in persons_in_words(study.population.traits):
        print(in_options(sentence))
    for assumed in ("units", "rates"):
        if assumed in study.population.provenance:
            print(f"{assumed.capitalize()} were {study.population.provenance[assumed]}.")
    print(f"Population: {output}")


def simulate(
    output: PopulationFile,
    women: Annotated[int, option("How many women.")] = 20,
    men: Annotated[int, option("How many men.")] = 20,
    seed: Seed = 0,
    sex_effect: Annotated[
        float, option("Multiplies all differences between the sexes; 0 removes them.")
    ] = 1.0,
    captures: Annotated[
        Path | None, option("Folder to write raw captures into, with traits.csv and truth.csv.")
    ] = None,
    captures_as: Annotated[str, option("Format of the captures: c3d, trc or csv.")] = "c3d",
) -> None:
    """Simulate walkers of known truth, and the raw captures of a whole study to rehearse with."""
    from eigenwalker.core.progress import ticked
    from eigenwalker.simulation.people import (
        simulate_captures,
        simulate_population,
        write_captures,
    )

    check_output(output, "people.nc")
    check_choice(captures_as, ("c3d", "trc", "csv"), "--captures-as")
    if captures is None and captures_as != "c3d":
        raise ValueError("--captures-as is for --captures FOLDER; give it too.")
    people = {"n_women": women, "n_men": men, "seed": seed, "sex_effect": sex_effect}
    with progress_bar("Simulating") as progress:
        population = simulate_population(**people)
        population.save(output)
        print(f"Population: {output} ({len(population)} walkers)")
        if captures is not None:
            walks = ticked(simulate_captures(**people, markers="skin"), women + men, progress)
            table = write_captures(walks, captures, format=captures_as)
            print(f"Captures: {captures}; who is who: {table}")
