"""``eigenwalker parameters``: the gait parameters of all captures of a folder, as a table."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from eigenwalker.cli.capture_options import Jobs, LowPass, Reading, TraitsTable, reads_captures
from eigenwalker.cli.exit_codes import EXIT_FAILED, EXIT_PARTIAL
from eigenwalker.cli.option_names import in_options
from eigenwalker.cli.options import (
    Person,
    TraitFromName,
    WithFlagged,
    check_output,
    option,
    progress_bar,
)
from eigenwalker.io.errors import printable


@reads_captures
def parameters(
    folder: Annotated[Path, typer.Argument(help="Folder of captures, searched with subfolders.")],
    output: Annotated[Path, option("Table to write (.csv).", "-o", "--output")],
    traits: TraitsTable = None,
    trait_from_name: TraitFromName = None,
    person: Person = None,
    with_flagged: WithFlagged = False,
    low_pass: LowPass = None,
    jobs: Jobs = -1,
    *,
    reading: Reading,
) -> None:
    """Measure cadence, speed, steps, strides, stance, swing and double support of each capture.

    Beside the table NAME.csv: NAME-persons.csv, mean and SD by person; NAME-codebook.csv, units and
    meanings; NAME.json, all three; NAME.html, a page; NAME.svg and NAME.pdf, its figure.

    Ends with 0 when all captures were read, 1 when some were refused, 2 when nothing could be used.
    """
    from eigenwalker.core.atomic_write import write_table
    from eigenwalker.population.persons import persons_of
    from eigenwalker.report.parameters_report import write_parameters_report
    from eigenwalker.report.result_files import write_json
    from eigenwalker.study.parameter_table import parameter_table

    check_output(output, "parameters.csv")
    with progress_bar("Measuring") as progress:
        table = parameter_table(
            folder,
            traits=traits,
            trait_from_name=trait_from_name,
            person=person,
            with_flagged=with_flagged,
            low_pass_hz=low_pass,
            n_jobs=jobs,
            progress=progress,
            **reading,
        )
    stem = output.with_suffix("")
    tables = {"files": table.files, "persons": table.persons, "codebook": table.codebook}
    write_table(table.files, output, index=False)
    for name in ("persons", "codebook"):
        write_table(tables[name], stem.with_name(f"{stem.name}-{name}.csv"), index=False)
    write_json(tables, stem.with_name(f"{stem.name}.json"))
    counts = table.files["status"].value_counts()
    for status in ("flagged", "refused"):
        for row in table.files[table.files["status"] == status].itertuples():
            reason = str(row.reason).removeprefix(f"{row.file}: ")
            print(f"{status}: {printable(in_options(f'{row.file}: {reason}'))}", file=sys.stderr)
    n_read = len(table.files) - counts.get("refused", 0)
    who = "capture" if persons_of(table.files) is None else "person"
    counted = (
        f"{n_read} of {len(table.files)} captures measured, {counts.get('flagged', 0)} of them "
        f"flagged{'' if with_flagged else ' and left out of means'}."
    )
    print(f"{counted}\nMeans and SDs are of each {who}.")
    page = write_parameters_report(
        table,
        stem.with_name(f"{stem.name}.html"),
        title=f"Gait parameters of {folder.resolve().name}",
        results=[counted],
        with_flagged=with_flagged,
    )
    print(f"Table: {output}\nBy person, codebook, all as JSON: {stem}-persons.csv, ", end="")
    print(f"{stem}-codebook.csv, {stem}.json\nPage, figure: {page}, {stem}.svg, {stem}.pdf")
    if not n_read:
        raise typer.Exit(EXIT_FAILED)
    if n_read < len(table.files):
        raise typer.Exit(EXIT_PARTIAL)
