"""``eigenwalker data list | fetch NAME``: captures that others published."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from eigenwalker.cli.options import option, progress_bar

data = typer.Typer(
    no_args_is_help=True,
    rich_markup_mode=None,
    add_completion=False,
    help="Captures that others published: what there is, and how to have it.",
)


@data.command("list")
def list_collections() -> None:
    """List the collections, with size and licence, and walkers that you may have a copy of."""
    from eigenwalker.datasets.downloads import collections, own_copies

    print("name          files       MB  licence       what")
    for name, each in sorted(collections().items()):
        print(f"{name:<13}{len(each.files):>6}{each.size_mb:>9g}  {each.licence:<13} {each.about}")
        print(f"{'':<13}good for {each.good_for}")
    print(
        "\nPublished walkers that are not fetched, for your own copy (cite: eigenwalker cite NAME):"
    )
    for name, each in own_copies().items():
        print(f"{name:<13}{each['file']}: {each['about']}; {each['licence']}")
        print(f"{'':<13}good for {each['good_for']}")
        print(f"{'':<13}{each['use']}")


@data.command()
def fetch(
    name: Annotated[str, typer.Argument(help="A collection, as 'data list' names them.")],
    output: Annotated[
        Path | None, option("Folder; left out, one in this user's cache.", "-o", "--output")
    ] = None,
    accept_licence: Annotated[
        bool, option("Accept its terms, and do not ask.", "--accept-licence")
    ] = False,
    base_url: Annotated[
        str | None, option("Mirror to take; also in the variable EIGENWALKER_DATA_URL.")
    ] = None,
) -> None:
    """Fetch a collection from where it is published, after its licence is accepted."""
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
        _ask_for_consent(accept_licence)
        with progress_bar("Fetching") as progress:
            fetch_captures(name, folder, accept_licence=True, base_url=base_url, progress=progress)
    print(f"{len(collection.files)} files: {folder}")


def _ask_for_consent(accepted: bool) -> None:
    if accepted:
        return
    if not sys.stdin.isatty():
        raise ValueError("Nobody is there to ask; say --accept-licence if you accept the terms.")
    if not typer.confirm("Do you accept these terms?"):
        raise ValueError("The terms were not accepted, so nothing was fetched.")
