"""The command line for captures that others published: ``eigenwalker data list | fetch NAME``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer(
    no_args_is_help=True,
    rich_markup_mode=None,
    help="Captures that others published: what there is, and how to have it.",
)


@app.command("list")
def list_collections() -> None:
    """List the collections, with size and licence."""
    from eigenwalker.datasets.downloads import collections

    print("name          files       MB  licence       what")
    for name, each in sorted(collections().items()):
        print(f"{name:<13}{len(each.files):>6}{each.size_mb:>9g}  {each.licence:<13} {each.about}")


@app.command()
def fetch(
    name: Annotated[str, typer.Argument(help="A collection, as 'data list' names them.")],
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", help="Folder; left out, one in this user's cache."),
    ] = None,
    accept_licence: Annotated[
        bool, typer.Option("--accept-licence", help="Accept its terms, and do not ask.")
    ] = False,
    base_url: Annotated[
        str | None,
        typer.Option(help="Mirror to take; also in the variable EIGENWALKER_DATA_URL."),
    ] = None,
) -> None:
    """Fetch a collection from where it is published, after its licence is accepted."""
    from rich.console import Console
    from rich.progress import Progress

    from eigenwalker.datasets.downloads import (
        collection_named,
        fetch_captures,
        folder_of,
        missing_files,
    )

    collection = collection_named(name)
    folder = folder_of(name) if output is None else output
    if missing_files(collection, folder):
        print(collection.notice())
        _consent(accept_licence)
        with Progress(console=Console(stderr=True), transient=True) as bar:
            task = bar.add_task("Fetching", total=None)
            fetch_captures(
                name, folder, accept_licence=True, base_url=base_url,
                progress=lambda done, total: bar.update(task, completed=done, total=total),
            )  # fmt: skip
    print(f"{len(collection.files)} files: {folder}")


def _consent(accepted: bool) -> None:
    """Ask whether the terms are accepted, unless that was said already."""
    if accepted:
        return
    if not sys.stdin.isatty():
        raise ValueError("Nobody is there to ask; say --accept-licence if you accept the terms.")
    if not typer.confirm("Do you accept these terms?"):
        raise ValueError("The terms were not accepted, so nothing was fetched.")
