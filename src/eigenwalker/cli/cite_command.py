"""The command ``cite``."""

from __future__ import annotations

from typing import Annotated

import typer

from eigenwalker.datasets.citations import PROGRAM, bibtex


def cite(
    name: Annotated[
        str, typer.Argument(help="A data set; left out, the program and the papers it stands on.")
    ] = PROGRAM,
) -> None:
    """Print what to cite as BibTeX: the program and its papers, or a data set by its name."""
    print(bibtex(name), end="")
