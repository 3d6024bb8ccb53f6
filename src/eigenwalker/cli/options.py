"""What commands share: options, exit codes, the progress bar, and parsers of what is typed."""

from __future__ import annotations

import math
import os
import re
import sys
from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from eigenwalker.core.wording import reworded

if TYPE_CHECKING:
    import numpy as np
    from rich.progress import Progress, TaskID

    from eigenwalker.analysis.trait_axis import TraitAxis
    from eigenwalker.population.population import Population
    from eigenwalker.study.process_capture import CaptureResult


def option(about: str, *names: str) -> Any:
    """Return an option of a command, with its help text."""
    return typer.Option(*names, help=about)


People = Annotated[
    Path | None,
    typer.Argument(
        help="Population file (.nc), or published walkers (bml_axes.json, walkers.mat); left out, "
        "the built-in simulated population."
    ),
]
WithFlagged = Annotated[bool, option("Count flagged walkers too.", "--with-flagged")]
MappingFile = Annotated[
    Path | None,
    option("Markers with names of your own (TOML; 'info FILE --write-mapping' begins one)."),
]
PopulationFile = Annotated[Path, option("Population file to write (.nc).", "-o", "--output")]
Person = Annotated[
    str | None,
    option("Trait that says who walked, or 'none'; left out, known by its name.", "--person"),
]
ReportFolder = Annotated[Path | None, option("Folder to write a report into.", "-o", "--output")]
TraitFromName = Annotated[
    str | None, option("Pattern with named groups over names: 'walk_(?P<style>[a-z]+)_'.")
]
TraitSteps = Annotated[
    list[str] | None, option("Trait and standard deviations: sex=+3, weight=-2; may be repeated.")
]
StartFrom = Annotated[
    str, option("'average', the number of a walker, or a capture file.", "--from")
]
SkeletonNames = Annotated[
    str, option("Bones of .bvh and .glb: plain, mixamo, unreal or unity.", "--skeleton")
]
RestPose = Annotated[str, option("Its arms at rest: t or a.")]
View = Annotated[float, option("Azimuth in degrees: 0 frontal, 90 profile.")]
Elevation = Annotated[float, option("Degrees above the horizon.")]
KeepSize = Annotated[
    bool,
    option("Keep people's size; otherwise it is divided out, as in Troje (2002).", "--keep-size"),
]
OpenPage = Annotated[bool, option("Open the page if there is a screen.", "--open/--no-open")]
MOST_SDS = 100
Seed = Annotated[int, option("The same seed gives the same people.")]


def load_people(path: Path | None, with_flagged: bool, person: str | None = None) -> Population:
    """Return the population of a file; without one the built-in population, named on stderr.

    Its persons are those of the column `person`; of none, if that is the word.
    """
    from eigenwalker.datasets.built_in import BUILT_IN, load_population

    if path is None:
        print(f"Using {BUILT_IN}.", file=sys.stderr)
    population = load_population(path)
    if person is not None:
        population = population.with_persons(person)
    return population.without_flags() if with_flagged else population


def trait_or_usual(population: Population) -> str:
    """Return the sex, or the first trait that tells walkers apart, which is then said."""
    from eigenwalker.analysis.contrast import SEX, usual_trait

    trait = usual_trait(population)
    if trait != "sex":
        why = "" if trait.casefold() in SEX else "No trait 'sex' tells these walkers apart: "
        print(f"{why}{trait} is told.", file=sys.stderr)
    return trait


def sized_people(path: Path | None, with_flagged: bool, keep_size: bool) -> Population:
    """Return the population that walkers are made of; without their size, unless it is kept."""
    population = load_people(path, with_flagged)
    return population if keep_size or is_published(path) else population.size_normalised()


def is_published(path: Path | None) -> bool:
    """Return whether walkers are those of a publication, which keep the size that they have."""
    return path is not None and path.suffix.lower() in (".json", ".mat")


def parse_trait_steps(text: str, option: str = "--trait") -> tuple[str, float]:
    """Return trait and standard deviations of ``sex=+3`` or ``style=feminine:masculine=2``."""
    trait, _, number = text.rpartition("=")
    try:
        steps = float(number)
    except ValueError:
        steps = math.nan
    several = re.split(r"[\s,;]+", text.strip())
    if len(several) > 1 and all("=" in one for one in several):
        each = " ".join(f"{option} {one}" for one in several)
        raise ValueError(f"{option} {text!r}: expected one trait; write {each}.")
    if not (trait and abs(steps) <= MOST_SDS):
        raise ValueError(
            f"{option} {text!r} does not say how far; write a trait and standard deviations, "
            f"{MOST_SDS} at most: sex=+3."
        )
    return trait, steps


def trait_axes(
    population: Population, texts: Sequence[str] | None, option: str = "--trait", **how: Any
) -> list[tuple[TraitAxis, float]]:
    """Return the axis of each ``--trait``, and the standard deviations along it."""
    steps = [parse_trait_steps(text, option) for text in texts or ()]
    traits = [trait for trait, _ in steps]
    if twice := [trait for trait in traits if traits.count(trait) > 1]:
        raise ValueError(f"{option} {twice[0]} is given twice; give it once.")
    return [(_axis(population, trait, **how), each) for trait, each in steps]


@cache
def _axis(population: Population, trait: str, **axis_options: Any) -> TraitAxis:
    from eigenwalker.analysis.trait_axis import trait_axis

    return trait_axis(population, trait, **axis_options)


def start_vector(population: Population, start: str, mapping: Path | None = None) -> np.ndarray:
    """Return the features of the walker that ``--from`` names."""
    if start == "average":
        return population.average
    if start.isdecimal() and int(start) < len(population):
        return population.X[int(start)]
    return population.vector(start_capture(population, start, mapping).walker)


def start_capture(
    population: Population,
    start: str,
    mapping: Path | None = None,
    *,
    joints: Literal["walker", "full"] = "walker",
) -> CaptureResult:
    """Return what the capture that ``--from`` names gave, decomposed as the population is."""
    if start.isdecimal() or not start or not Path(start).exists():
        raise ValueError(
            f"--from {start}: expected 'average', a walker from 0 to {len(population) - 1}, or a "
            "capture file."
        )
    from eigenwalker.study.messages import flag_of
    from eigenwalker.study.process_capture import process_capture

    first = population.walkers[0]
    try:
        result = process_capture(
            start,
            form=first.form,
            n_harmonics=len(first.harmonics) // 2,
            joints=joints,
            mapping=mapping,
        )
    except ValueError as error:
        literal = start.replace("{", "{{").replace("}", "}}")
        convert = f"eigenwalker convert {literal} walk.c3d"
        how = {"rate_hz": f"{convert} --rate {{value}}", "unit": f"{convert} --unit {{value}}"}
        raise ValueError(reworded(str(error), how)) from error
    if flag := flag_of(result.quality):
        print(f"eigenwalker: {start}: {flag}", file=sys.stderr)
    return result


def check_choice(value: str, known: Collection[str], option: str) -> None:
    """Refuse a value that an option does not know."""
    if value not in known:
        raise ValueError(f"{option} {value!r} is not known; choose from {list(known)}.")


FILE_SUFFIXES = {".csv", ".gif", ".html", ".jpg", ".json", ".mp4", ".nc", ".pdf", ".png", ".svg",
                 ".txt"}  # fmt: skip


def check_folder(output: Path, option: str = "-o") -> None:
    """Refuse an output that is a file, is called like one, or is below one, for a folder."""
    if output.suffix.lower() in FILE_SUFFIXES and not output.exists():
        raise ValueError(f"{option} {output} is called like a file; name a folder to write into.")
    above = next(each for each in (output, *output.absolute().parents) if each.exists())
    if not above.is_dir():
        raise ValueError(f"{option} {output}: expected a folder to write into; {above} is a file.")


def check_output(path: Path, example: str, option: str = "-o") -> None:
    """Refuse, before any work, a file that could not be written, or is called otherwise."""
    if path.suffix.lower() != (suffix := Path(example).suffix):
        raise ValueError(f"{option} {path}: it is written as {suffix}; name it so, as {example}.")
    if not path.parent.is_dir():
        raise ValueError(f"{option} {path}: there is no folder {path.parent}; make it first.")


@contextmanager
def progress_bar(title: str) -> Iterator[Callable[[int, int], None]]:
    """Yield what to call as work is done: the first call shows a bar on stderr, if a terminal.

    It is called with how much is done, and of how much.
    """
    with ExitStack() as shown:

        @cache
        def bar() -> tuple[Progress, TaskID] | None:
            from rich.console import Console
            from rich.progress import Progress

            console = Console(stderr=True)
            if not console.is_terminal:  # a bar not shown still ends a line, by rich below 15
                return None
            progress = shown.enter_context(Progress(console=console, transient=True))
            return progress, progress.add_task(title, total=None)

        def update(done: int, total: int) -> None:
            if (made := bar()) is not None:
                progress, task = made
                progress.update(task, completed=done, total=total)

        yield update


def open_in_browser(address: str) -> None:
    """Open a page where there is a screen to show it on."""
    screen = os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    if screen or sys.platform in ("win32", "darwin"):
        typer.launch(address)
