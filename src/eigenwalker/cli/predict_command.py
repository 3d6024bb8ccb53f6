"""``eigenwalker predict``: the class or value of a trait for new captures."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from eigenwalker.cli.capture_options import Jobs, Reading, reads_captures
from eigenwalker.cli.exit_codes import EXIT_FAILED, EXIT_PARTIAL
from eigenwalker.cli.option_names import in_options
from eigenwalker.cli.options import (
    Person,
    WithFlagged,
    check_output,
    load_people,
    option,
    progress_bar,
    trait_or_usual,
)
from eigenwalker.io.errors import printable

if TYPE_CHECKING:
    import pandas as pd


MEANINGS = {
    "sum": (
        "sum: below 0 it speaks for one class, above for the other; walkers learnt from have about "
        "-1 and +1."
    ),
    "probability": "probability: of this class among the classes, if the walk is of one of them.",
    "distance": (
        "distance: to the nearest walker learnt from, in standard deviations (RMS of all features)"
        "; 'far' is said of about 5 % of ordinary walks."
    ),
}
"""Columns of the table that is printed, in words."""


@reads_captures
def predict(
    people: Annotated[Path, typer.Argument(help="Population file to learn from (.nc).")],
    files: Annotated[list[Path], typer.Argument(help="New captures, or folders of them.")],
    trait: Annotated[
        str | None,
        option(
            "Trait to tell: sex, weight_kg, style, style=feminine:masculine; left out, the sex, or "
            "the first."
        ),
    ] = None,
    output: Annotated[
        Path | None, option("Table to write (.csv); a .json beside it.", "-o", "--output")
    ] = None,
    person_from_name: Annotated[
        str | None, option("Pattern over names of new files: '(?P<person>S[0-9]+)_'.")
    ] = None,
    person: Person = None,
    with_flagged: WithFlagged = False,
    jobs: Jobs = -1,
    *,
    reading: Reading,
) -> None:
    """Tell a trait of new captures, with the error to expect and a warning of unusual walks.

    Ends with 0 when all captures were read, 1 when some were refused, 2 when nothing could be used.
    """
    from eigenwalker.core.atomic_write import write_table
    from eigenwalker.report.result_files import write_json
    from eigenwalker.study.messages import error_to_expect
    from eigenwalker.study.predict_captures import predict_captures

    if output is not None:
        check_output(output, "predictions.csv")
    population = load_people(people, with_flagged, person)
    trait = trait or trait_or_usual(population)
    with progress_bar("Predicting") as progress:
        found = predict_captures(
            population,
            trait,
            files,
            trait_from_name=person_from_name,
            n_jobs=jobs,
            progress=progress,
            **reading,
        )
    table, model = found.table, found.model
    sentence = error_to_expect(model)
    shown = table.drop(columns=["reason", "error", "typicality"], errors="ignore")
    shown = shown.rename(columns={"person_known": "learnt from"})
    shown["far"] = ["far" if far is True else "" for far in table.get("far", [""] * len(table))]
    text = shown.to_string(index=False, na_rep="-", float_format=lambda number: f"{number:.3g}")
    legend = [meaning for column, meaning in MEANINGS.items() if shown.get(column) is not None]
    print("\n".join([printable(text), "", *legend, sentence]))
    _warn(table)
    if output is not None:
        write_table(table, output, index=False)
        facts = {"trait": model.trait, "error": model.error, "error_in_words": sentence}
        write_json(facts | {"predictions": table}, output.with_suffix(".json"))
        print(f"Table: {output}; as JSON: {output.with_suffix('.json')}")
    n_refused = int((table["status"] == "refused").sum())
    if n_refused:
        raise typer.Exit(EXIT_FAILED if n_refused == len(table) else EXIT_PARTIAL)


def _warn(table: pd.DataFrame) -> None:
    """Say what speaks against predictions: walks far from all known, flags, persons known."""
    from eigenwalker.study.predict_captures import ITSELF

    for row in table.itertuples():
        if row.reason:
            reason = str(row.reason).removeprefix(f"{Path(str(row.file)).name}: ")
            line = printable(in_options(f"{row.file}: {reason}"))
            print(f"{row.status}: {line}", file=sys.stderr)
    far = [str(row.file) for row in table.itertuples() if getattr(row, "far", False) is True]
    if far:
        names = printable(", ".join(far))
        print(
            f"eigenwalker: far from all walkers learnt from, so that neither prediction nor error "
            f"can be relied on: {names}.",
            file=sys.stderr,
        )
    itself = table["person_known"] == ITSELF
    if itself.any():
        names = printable(", ".join(table.loc[itself, "file"].astype(str)))
        print(
            f"eigenwalker: themselves among the walkers learnt from, so that what is predicted of "
            f"them says nothing of new walks: {names}.",
            file=sys.stderr,
        )
    known = table[(table["person_known"] != "") & ~itself]
    if len(known):
        who = printable(", ".join(f"{row.file} ({row.person_known})" for row in known.itertuples()))
        print(
            f"eigenwalker: learnt from the same people, so that the error to expect of new people "
            f"is not that of these: {who}.",
            file=sys.stderr,
        )
