"""``eigenwalker plugin one.json two.json -o FOLDER``: the jsPsych plugin, and a page to edit."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from eigenwalker.cli.options import check_folder, option

if TYPE_CHECKING:
    from eigenwalker.stimulus.stimulus import Stimulus


def plugin(
    stimuli: Annotated[
        list[Path] | None,
        typer.Argument(help="Stimulus files (.json); left out, an example of four walkers."),
    ] = None,
    output: Annotated[Path, option("Folder to write.", "-o", "--output")] = Path("plugin"),
    force: Annotated[
        bool, option("Replace an index.html that was edited, and other files.", "--force")
    ] = False,
) -> None:
    """Write the jsPsych plugin and a page that shows stimuli and asks about them.

    It needs no network and no Node: open index.html, or put the folder on any web server.
    """
    from eigenwalker.stimulus.plugin_folder import PAGE, write_plugin

    check_folder(output)
    shown = _read(stimuli) if stimuli else _example()
    keep = write_plugin(shown, output, force=force)
    print(f"{len(shown)} stimuli: {', '.join(shown)}")
    if keep:
        print(f"{output / PAGE} was edited and is left as it is; --force replaces it.")
    print(f"Open {output / PAGE}; the answers are saved from its last page as CSV.")


def _read(paths: list[Path]) -> dict[str, Stimulus]:
    from eigenwalker.stimulus.stimulus import Stimulus

    if missing := [str(path) for path in paths if not path.is_file()]:
        raise ValueError(f"There are no such stimulus files: {', '.join(missing)}.")
    names = [path.stem for path in paths]
    if twice := sorted({name for name in names if names.count(name) > 1}):
        raise ValueError(
            f"Several stimuli are called {twice}; their names tell them apart in data."
        )
    return {path.stem: Stimulus.load(path) for path in paths}


def _example() -> dict[str, Stimulus]:
    """Two women and two men, weak and strong, all of one size."""
    from eigenwalker.analysis.trait_axis import trait_axis
    from eigenwalker.datasets.built_in import BUILT_IN, load_population
    from eigenwalker.stimulus.make import make_stimulus, with_information

    people = load_population()
    axis = trait_axis(people, "sex")
    made = {}
    for steps in (-3, -1, 1, 3):
        walker = with_information(people, people.average + steps * axis.step, "full")
        about = {"population": BUILT_IN, "trait": "sex", "standard_deviations": f"{steps:+d}"}
        shown = make_stimulus(walker, duration_s=2, provenance={**people.provenance, **about})
        made[f"{'woman' if steps < 0 else 'man'}_{abs(steps)}"] = shown
    return made
