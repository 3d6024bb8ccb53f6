"""The command line: each command a short walk through the package.

Nothing heavy is imported before a command runs, so that ``--help`` answers at once.
"""

from __future__ import annotations

import json
import math
import sys
import textwrap
import warnings
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TypeVar

import typer

from eigenwalker.cli import (
    compare_command as cli_compare,
    data_commands as cli_data,
    serve_command as cli_serve,
    stimulus_command as cli_stimulus,
)

if TYPE_CHECKING:
    import numpy as np

    from eigenwalker.analysis.classification import Classification, Regression
    from eigenwalker.analysis.trait_axis import TraitAxis
    from eigenwalker.population.population import Population

app = typer.Typer(
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    no_args_is_help=True,
    add_completion=False,
    context_settings={"help_option_names": ["-h", "--help"]},
    help="How people walk: from captures to a model, classifiers, and walkers of any trait.",
)
app.add_typer(cli_data.app, name="data")
app.command()(cli_serve.serve)
app.command()(cli_compare.compare)
app.command()(cli_stimulus.stimulus)

T = TypeVar("T")
SOME_REFUSED = 1
FAILED = 2
LONGEST_NAME = 24
"""Letters up to which entries of a list are written one after the other."""
INTERRUPTED = 130
INDEX = "index.html"

People = Annotated[
    Path | None,
    typer.Argument(help="Population file (.nc); left out, the built-in simulated population."),
]
Folder = Annotated[Path, typer.Option("-o", "--output", help="Folder to write into.")]
Kind = Annotated[
    str, typer.Option(help="'discriminant' tells the trait best, 'mean_difference' shows it best.")
]
Unit = Annotated[
    str | None, typer.Option(help="Unit of length, for files that name none: mm, cm, m, in, asf.")
]
Rate = Annotated[float | None, typer.Option(help="Frames a second, for files that name none.")]
Part = Annotated[
    str, typer.Option(help="What the axis may change: all, structure, dynamics, p1, p1+p2, ...")
]


WithFlagged = Annotated[bool, typer.Option("--with-flagged", help="Count flagged walkers too.")]


def main() -> None:
    """Run the command line; what goes wrong is said in a sentence, not in a traceback."""
    warnings.showwarning = _say_warning
    try:
        app()
    except (ValueError, OSError) as error:
        print(f"eigenwalker: {error}", file=sys.stderr)
        sys.exit(FAILED)


def _say_warning(message: Warning | str, *_: object, **__: object) -> None:
    print(f"eigenwalker: {message}", file=sys.stderr)


@app.callback(invoke_without_command=True)
def _version(
    version: Annotated[bool, typer.Option("--version", help="Say the version and end.")] = False,
) -> None:
    if version:
        from eigenwalker._version import __version__

        print(f"eigenwalker {__version__}")
        raise typer.Exit


@app.command()
def demo(
    people: People = None,
    output: Folder = Path("eigenwalker-demo"),
    trait: Annotated[str, typer.Option(help="Trait of two classes to tell.")] = "sex",
    open_page: Annotated[
        bool, typer.Option("--open/--no-open", help="Open the page if there is a screen.")
    ] = True,
    with_flagged: WithFlagged = False,
) -> None:
    """Run the main job, and write a page on which anyone can play with what was found.

    index.html holds the walkers, report.html beside it what tells the trait from gait; both work
    from the disk, without a network.
    """
    from eigenwalker.datasets.built_in import built_in_capture
    from eigenwalker.explorer.interactive_page import interactive_page
    from eigenwalker.explorer.model import page_model
    from eigenwalker.report.blocks import Link
    from eigenwalker.report.classification_report import write_main_job

    population = _population(people, with_flagged)
    with _bar("Classifying and filming") as progress:
        page, found = write_main_job(
            output,
            population,
            trait,
            example=built_in_capture() if people is None else None,
            beside=Link("Play with these walkers", INDEX),
            progress=progress,
        )
    model = page_model(population, first=trait, **cli_serve.model_names(people))
    index = page.with_name(INDEX)
    index.write_text(interactive_page(model, report=page.name), encoding="utf-8")
    _print_results(found)
    print(f"Report: {page}")
    print(f"Page to play with: {index}")
    if open_page and cli_serve.has_screen():
        typer.launch(str(index))


@app.command()
def info(
    file: Annotated[Path, typer.Argument(help="A capture, or a population file (.nc).")],
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
    unit: Unit = None,
    rate: Rate = None,
) -> None:
    """Say what is in a file, and what is wrong with it."""
    from eigenwalker.study.inspect import inspect_file
    from eigenwalker.study.messages import in_words

    facts = inspect_file(file, unit=unit, rate_hz=rate)
    if as_json:
        print(json.dumps(facts, indent=2, ensure_ascii=False, allow_nan=False))
        return
    told = in_words(facts)
    width = max(len(name) for name in told) + 2
    for name, value in told.items():
        print(f"{name:<{width}}{_laid_out(value, width)}")


@app.command()
def convert(
    capture: Annotated[Path, typer.Argument(help="A capture, of any format that is read.")],
    output: Annotated[Path, typer.Argument(help="File to write: .bvh, .c3d, .csv, .nc or .trc.")],
    joints: Annotated[
        bool, typer.Option("--joints", help="Write joints, not markers; .bvh always holds joints.")
    ] = False,
    unit: Annotated[
        str | None, typer.Option(help="Unit of the capture, where it names none: mm, cm, m, ...")
    ] = None,
) -> None:
    """Write a capture in another format."""
    from eigenwalker.io.read import read_mocap
    from eigenwalker.io.write import write_mocap
    from eigenwalker.markers.virtual_markers import virtual_markers

    walk = read_mocap(capture, unit=unit)
    if joints or output.suffix.lower() == ".bvh":
        walk = virtual_markers(walk, joints="full")
    print(f"Written: {write_mocap(walk, output)}")


@app.command()
def fit(
    folder: Annotated[Path, typer.Argument(help="Folder of captures, searched with subfolders.")],
    output: Annotated[Path, typer.Option("-o", "--output", help="Population file to write (.nc).")],
    traits: Annotated[
        Path | None,
        typer.Option(help="CSV with a column 'file' (relative to FOLDER) and the traits."),
    ] = None,
    trait_from_name: Annotated[
        str | None,
        typer.Option(help="Pattern with named groups over names: 'walk_(?P<style>[a-z]+)_'."),
    ] = None,
    form: Annotated[
        str, typer.Option(help="'eigenposture' (J) or 'fourier' (W).")
    ] = "eigenposture",
    harmonics: Annotated[int, typer.Option(help="Multiples of the stride frequency.")] = 2,
    low_pass: Annotated[
        float | None, typer.Option(help="Cut-off in Hz of a low-pass filter, for noisy captures.")
    ] = None,
    jobs: Annotated[int, typer.Option(help="Processes; -1 for all cores.")] = -1,
    unit: Unit = None,
    rate: Rate = None,
    table: Annotated[
        Path | None, typer.Option(help="CSV to write all into that is known of each capture.")
    ] = None,
    fresh: Annotated[
        bool, typer.Option("--fresh", help="Read all anew, also what an interrupted run has read.")
    ] = False,
) -> None:
    """Make a population of a folder of captures.

    Ends with 0 when all captures were read, 1 when some were refused, 2 when nothing could be used,
    130 when it was interrupted; the same command then goes on where it stopped.
    """
    from eigenwalker.study.fit_folder import fit_folder
    from eigenwalker.study.summary import summary_of
    from eigenwalker.study.walker_from_file import DECOMPOSE

    _one_of(form, DECOMPOSE, "--form")
    if not output.parent.is_dir():
        raise ValueError(f"There is no folder {output.parent} to write {output.name} into.")
    _population_path(output)
    journal = output.with_name(f"{output.name}.part")
    if fresh:
        journal.unlink(missing_ok=True)
    with _going_on(journal), _bar("Reading captures") as progress:
        study = fit_folder(
            folder,
            traits=traits,
            trait_from_name=trait_from_name,
            form=form,  # pyright: ignore[reportArgumentType] - one of the two by now
            n_harmonics=harmonics,
            unit=unit,
            rate_hz=rate,
            low_pass_hz=low_pass,
            n_jobs=jobs,
            journal=journal,
            progress=progress,
        )
    if table is not None:
        study.files.to_csv(table, index=False)
    for status in ("flagged", "refused"):
        chosen = study.files[study.files["status"] == status]
        if len(chosen):
            print(f"{len(chosen)} {status}:")
            print("".join(f"  {row.file}: {row.reason}\n" for row in chosen.itertuples()))
    if study.unlisted:
        shown = ", ".join(study.unlisted[:5]) + (", ..." if len(study.unlisted) > 5 else "")
        print(f"{len(study.unlisted)} captures of the folder are not in the table: {shown}")
    if study.population is None:
        print(f"No capture of {len(study.files)} could be used.", file=sys.stderr)
        raise typer.Exit(FAILED)
    study.population.save(output)
    journal.unlink(missing_ok=True)
    read = study.files[study.files["status"] != "refused"]
    print(
        f"{len(read)} of {len(study.files)} captures read, "
        f"{(read['status'] == 'flagged').sum()} of them flagged. Medians (and ranges):"
    )
    for name, told in summary_of(study.files).items():
        print(f"  {name + ':':<23}{told}")
    if "units" in study.population.provenance:
        print(f"Units were {study.population.provenance['units']}.")
    print(f"Population: {output}")
    if len(study.refused):
        raise typer.Exit(SOME_REFUSED)


@app.command()
def classify(
    people: People = None,
    trait: Annotated[
        str, typer.Option(help="Trait to tell: sex, weight_kg, style=feminine:masculine.")
    ] = "sex",
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="Folder to write a report into.")
    ] = None,
    permutations: Annotated[
        int, typer.Option(help="Random deals of the trait to compare with.")
    ] = 200,
    with_flagged: WithFlagged = False,
) -> None:
    """Tell a trait from gait: separation, jack-knife, nested jack-knife, permutation test."""
    from eigenwalker.analysis import classification
    from eigenwalker.analysis.contrast import contrast
    from eigenwalker.report.classification_report import write_main_job

    population = _population(people, with_flagged)
    asked = contrast(population, trait)
    page = None
    with _bar("Classifying") as progress:
        if output is not None:
            page, found = write_main_job(
                output, population, trait, n_permutations=permutations, progress=progress
            )
        else:
            tell = classification.classify if asked.two_classes else classification.regress
            found = tell(population, trait, n_permutations=permutations, progress=progress)
    print(f"{asked.trait}: {asked.negative} to {asked.positive}, {len(asked.rows)} walkers")
    _print_results(found)
    if page is not None:
        print(f"Report: {page}")


@app.command()
def synthesize(
    people: People = None,
    trait: Annotated[
        list[str] | None,
        typer.Option(help="Trait and standard deviations: sex=+3, weight=-2; may be repeated."),
    ] = None,
    output: Annotated[
        Path, typer.Option("-o", "--output", help="Film to write: .mp4, .webm or .gif.")
    ] = Path("walker.mp4"),
    view: Annotated[float, typer.Option(help="Azimuth in degrees: 0 frontal, 90 profile.")] = 30.0,
    elevation: Annotated[float, typer.Option(help="Degrees above the horizon.")] = 0.0,
    duration: Annotated[
        float | None,
        typer.Option(help="Seconds; left out, whole strides of about 4, so that films loop."),
    ] = None,
    style: Annotated[str, typer.Option(help="'dots' or 'sticks'.")] = "dots",
    kind: Kind = "discriminant",
    part: Part = "all",
    components: Annotated[int, typer.Option(help="Eigenwalkers that the axis uses.")] = 10,
    start: Annotated[
        str, typer.Option("--from", help="'average', the number of a walker, or a capture file.")
    ] = "average",
    with_flagged: WithFlagged = False,
) -> None:
    """Film the average walker, or one's own, moved along traits, and say how plausible it is."""
    import numpy as np

    from eigenwalker.analysis.trait_axis import trait_axis
    from eigenwalker.plotting.encoding import FORMATS
    from eigenwalker.plotting.layout import STYLES
    from eigenwalker.plotting.walker_films import write_film

    wishes = [_wish(each) for each in trait or []]
    _one_of(style, STYLES, "--style")
    _one_of(output.suffix.lower(), FORMATS, "the suffix of the film,")
    population = _population(people, with_flagged)
    vector = _start(population, start)
    axes = [
        trait_axis(population, name, part=part, n_components=components, kind=kind)  # pyright: ignore[reportArgumentType] - checked there
        for name, _ in wishes
    ]
    for axis, (_, alpha) in zip(axes, wishes, strict=True):
        vector = vector + alpha * axis.step
    for axis, (_, alpha) in zip(axes, wishes, strict=True):
        print(_along_in_words(population, axis, vector, alpha))
    walker = population.walker(np.asarray(vector))
    with _bar("Filming") as progress:
        write_film(
            walker,
            output,
            duration_s=duration,
            n_strides=max(round(4 * walker.frequency_hz), 1) if duration is None else None,
            view_deg=view,
            elevation_deg=elevation,
            style=style,  # pyright: ignore[reportArgumentType] - checked there
            progress=progress,
        )
    _print_plausibility(population, vector)
    print(f"Film: {output}")


@app.command()
def simulate(
    output: Annotated[Path, typer.Option("-o", "--output", help="Population file to write (.nc).")],
    women: Annotated[int, typer.Option(help="How many women.")] = 20,
    men: Annotated[int, typer.Option(help="How many men.")] = 20,
    seed: Annotated[int, typer.Option(help="The same seed gives the same people.")] = 0,
    sex_effect: Annotated[
        float, typer.Option(help="Multiplies all differences between the sexes; 0 removes them.")
    ] = 1.0,
    captures: Annotated[
        Path | None,
        typer.Option(help="Folder to write raw captures into, with traits.csv and truth.csv."),
    ] = None,
    captures_as: Annotated[
        str, typer.Option(help="Format of the captures: c3d, trc or csv.")
    ] = "c3d",
) -> None:
    """Simulate walkers of known truth, and the raw captures of a whole study to rehearse with."""
    from eigenwalker.simulation.captures import write_captures
    from eigenwalker.simulation.people import simulate_captures, simulate_population

    _population_path(output)
    with _bar("Simulating") as progress:
        population = simulate_population(women, men, seed=seed, sex_effect=sex_effect)
        population.save(output)
        print(f"Population: {output} ({len(population)} walkers)")
        if captures is not None:
            walks = simulate_captures(women, men, seed=seed, sex_effect=sex_effect, markers="skin")
            table = write_captures(
                _counted(walks, women + men, progress), captures, format=captures_as
            )
            print(f"Captures: {captures}; who is who: {table}")


@contextmanager
def _going_on(journal: Path) -> Iterator[None]:
    """Say what was kept when work is interrupted, and how to go on."""
    if journal.is_file():
        said = "Going on where an earlier run stopped; --fresh starts anew."
        print(said, file=sys.stderr)
    try:
        yield
    except KeyboardInterrupt:
        kept = f"What was read is kept in {journal}. " if journal.is_file() else ""
        how = "The same command goes on where it stopped; with --fresh it starts anew."
        print(f"eigenwalker: interrupted. {kept}{how}", file=sys.stderr)
        raise typer.Exit(INTERRUPTED) from None


def _population_path(path: Path) -> None:
    if path.suffix != ".nc":
        raise ValueError(f"{path}: a population is written as .nc; name it for instance people.nc.")
    if not path.parent.is_dir():
        raise ValueError(f"{path}: there is no folder {path.parent} to write into; make it first.")


def _counted(things: Iterable[T], total: int, progress: Callable[[int, int], None]) -> Iterator[T]:
    for done, thing in enumerate(things, start=1):
        yield thing
        progress(done, total)


def _population(path: Path | None, with_flagged: bool) -> Population:
    from eigenwalker.datasets.built_in import BUILT_IN, load_population

    if path is None:
        print(f"Using {BUILT_IN}.", file=sys.stderr)
    population = load_population(path)
    return population.trusting_all() if with_flagged else population


def _start(population: Population, start: str) -> np.ndarray:
    if start == "average":
        return population.average
    if start.isdigit():
        if int(start) >= len(population):
            raise ValueError(
                f"--from {start}: the population has walkers 0 to {len(population) - 1}."
            )
        return population.X[int(start)]
    from eigenwalker.study.walker_from_file import walker_from_file

    first = population.walkers[0]
    n_harmonics = len(first.harmonics) // 2
    walker, facts = walker_from_file(start, form=first.form, n_harmonics=n_harmonics)
    if facts["flag"]:
        print(f"eigenwalker: {start}: {facts['flag']}", file=sys.stderr)
    return population.vector(walker)


def _wish(wish: str) -> tuple[str, float]:
    """The trait and the standard deviations of ``sex=+3`` or ``style=feminine:masculine=2``."""
    name, _, alpha = wish.rpartition("=")
    try:
        if not math.isfinite(float(alpha)):
            raise ValueError
        return name, float(alpha)
    except ValueError:
        raise ValueError(
            f"{wish!r} does not say how far; write a trait and standard deviations: sex=+3."
        ) from None


def _along_in_words(
    population: Population, axis: TraitAxis, vector: np.ndarray, alpha: float
) -> str:
    asked = axis.contrast
    pole = asked.positive if alpha >= 0 else asked.negative
    place = float(axis.positions(vector[None])[0])
    others = axis.positions(population.X[asked.rows])
    beyond = "beyond all walkers, who reach" if abs(place) > abs(others).max() else "walkers reach"
    return (
        f"{asked.trait}: {abs(alpha):g} standard deviations towards {pole}, to {place:+.1f}; "
        f"{beyond} {others.min():+.1f} to {others.max():+.1f}."
    )


def _print_plausibility(population: Population, vector: np.ndarray) -> None:
    from eigenwalker.analysis.plausibility import plausibility

    found = plausibility(population, vector)
    print(
        f"Distance from the average walker: {found.position.distance:.1f} times the usual "
        f"({found.position.percentile:.0f} % of the walkers are nearer)."
    )
    print(
        "Limbs: "
        + ", ".join(f"{name} {100 * change:+.0f} %" for name, change in found.limb_change.items())
    )


def _print_results(found: Classification | Regression) -> None:
    print(found.table_in_words().to_string(index=False))
    print(f"\n{found.chance}")
    if found.many_inputs:
        print(found.many_inputs)


def _laid_out(value: str | list[str], indent: int) -> str:
    """A fact in words; what is short runs on, sentences stand on lines of their own."""
    if isinstance(value, str):
        return value
    lines = value
    if all(len(entry) <= LONGEST_NAME for entry in value):
        lines = textwrap.wrap(", ".join(value), 100 - indent)
    return f"\n{' ' * indent}".join(lines)


def _one_of(value: str, known: object, option: str) -> None:
    names = list(known)  # pyright: ignore[reportArgumentType] - any collection
    if value not in names:
        raise ValueError(f"{option} {value!r} is not known; choose from {names}.")


@contextmanager
def _bar(title: str) -> Iterator[Callable[[int, int], None]]:
    """A progress bar on the error stream, and what to call as work proceeds."""
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task(title, total=None)

        def advance(done: int, total: int) -> None:
            progress.update(task, completed=done, total=total)

        yield advance
