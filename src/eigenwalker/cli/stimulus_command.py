"""The command line for stimuli: ``eigenwalker stimulus --trait sex=2 --invert -o stim.json``.

Options may be typed in any order. They are applied in this one: who walks (``--from``, ``--trait``,
``--information``); the body (``--gain``, ``--arm-swing``, ``--conflict``, ``--ellipses``,
``--perturb``); time (``--speed``, ``--start``, ``--reverse``, ``--freeze``, ``--delay``,
``--phase-scramble``, ``--morph-to``); space (``--mirror``, ``--overground``, ``--rotate``,
``--invert``); dots (``--occlude``, ``--show``, ``--scramble``, ``--limb-dots``, ``--blur``); noise
(``--mask``). Any other chain is made in Python, or written into the JSON.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    import numpy as np

    from eigenwalker.core.walker import Walker
    from eigenwalker.population.population import Population
    from eigenwalker.stimulus.stimulus import Stimulus

Pairs = list[str] | None
"""Parameters as typed, ``seed=3,keep=structure``, once or several times."""


def _wish(about: str) -> Any:
    return typer.Option(help=about)


def stimulus(
    people: Annotated[
        Path | None,
        typer.Argument(
            help="Population (.nc) or a stimulus (.json); left out, the built-in population."
        ),
    ] = None,
    output: Annotated[
        Path,
        typer.Option(
            "-o",
            "--output",
            help=".json, .mp4, .webm, .gif, .png, .svg, .csv, .npz, .mat, .py, .html, .bvh, .glb; "
            "a folder for frames.",
        ),
    ] = Path("stim.json"),
    trait: Annotated[Pairs, _wish("Trait and standard deviations: sex=2; may be repeated.")] = None,
    start_from: Annotated[
        str, typer.Option("--from", help="'average', or the number of a walker.")
    ] = "average",
    information: Annotated[str, _wish("'full', 'structure' or 'dynamics' only (J35).")] = "",
    gain: Annotated[Pairs, _wish("Joints that move more: parts=legs,factor=0.5")] = None,
    arm_swing: Annotated[float | None, _wish("Factor of the arms' swing.")] = None,
    conflict: Annotated[Pairs, _wish("shoulder_width=1.2,hip_sway=2 (Mather, Murdoch)")] = None,
    ellipses: Annotated[Pairs, _wish("shoulder=35/12,hip=15/20 mm (Cutting)")] = None,
    perturb: Annotated[Pairs, _wish("markers=left_knee,amount=0/50/0,frequency=3")] = None,
    speed: Annotated[float | None, _wish("Playback speed; 1 is its own.")] = None,
    start: Annotated[float | None, _wish("Starting phase, degrees of the stride.")] = None,
    reverse: Annotated[bool, typer.Option("--reverse", help="Play backwards.")] = False,
    freeze: Annotated[float | None, _wish("Stand still as at this second.")] = None,
    delay: Annotated[Pairs, _wish("parts=arms,phase=90: lag behind the rest")] = None,
    phase_scramble: Annotated[str | None, _wish("seed=3: a clock for each dot")] = None,
    morph_to: Annotated[
        Pairs, _wish("Become the walker of this trait while it is shown: sex=-2; may be repeated.")
    ] = None,
    mirror: Annotated[bool, typer.Option("--mirror", help="Swap left and right.")] = False,
    overground: Annotated[
        bool, typer.Option("--overground", help="Walk forward, not on a treadmill.")
    ] = False,
    rotate: Annotated[Pairs, _wish("axis=z,angle=40,speed=0: x, y, z, sight or 1/0/1")] = None,
    invert: Annotated[bool, typer.Option("--invert", help="Upside down.")] = False,
    occlude: Annotated[str | None, _wish("Parts to hide: lower_body, left_knee/head")] = None,
    show: Annotated[str | None, _wish("Parts to show; the others are hidden.")] = None,
    scramble: Annotated[str | None, _wish("seed=3,keep=structure,directions=horizontal")] = None,
    limb_dots: Annotated[str | None, _wish("number=8,lifetime=0.1,seed=1 (Beintema)")] = None,
    blur: Annotated[float | None, _wish("Blobs of this standard deviation, mm.")] = None,
    mask: Annotated[Pairs, _wish("kind=scrambled,number=30,seed=2 or signal_to_noise=0.5")] = None,
    view: Annotated[float, _wish("Azimuth in degrees: 0 frontal, 90 profile.")] = 30.0,
    elevation: Annotated[float, _wish("Degrees above the horizon.")] = 0.0,
    eye_distance: Annotated[float | None, _wish("mm, for a perspective picture.")] = None,
    duration: Annotated[float | None, _wish("Seconds; 4 if left out.")] = None,
    rate: Annotated[float | None, _wish("Frames a second; 60 if left out.")] = None,
    style: Annotated[str | None, _wish("'dots', 'sticks' or 'mannequin'.")] = None,
    size: Annotated[str | None, _wish("Picture in pixels: 512x512")] = None,
    height_deg: Annotated[
        float | None, _wish("Height of the walker in degrees of visual angle.")
    ] = None,
    distance: Annotated[float, _wish("From the eye to the screen, mm.")] = 570.0,
    px_per_cm: Annotated[float, _wish("Pixels a centimetre of the screen.")] = 38.0,
    with_flagged: Annotated[
        bool, typer.Option("--with-flagged", help="Count flagged walkers too.")
    ] = False,
) -> None:
    """Make a stimulus: a walker, what is done to it, and how it is shown.

    Options act in one order, however they are typed: body, time, space, dots, noise, as listed.
    """
    from eigenwalker.stimulus.write_stimulus import write_stimulus

    asked = dict(locals())
    shown, population = _beginning(asked)
    for name, parameters in _chain(asked, population):
        shown = shown.then(name, **parameters)
    if height_deg is not None:
        shown = shown.sized(height_deg, viewing_distance_mm=distance, px_per_cm=px_per_cm)
    with _bar("Writing") as progress:
        path = write_stimulus(shown, output, progress=progress)
    names = [step["name"] for step in shown.transforms]
    print(f"{', then '.join(names) if names else 'No transforms'}; {shown.timing.duration_s:g} s")
    if path.suffix.lower() in (".bvh", ".glb"):
        from eigenwalker.stimulus.animation import animated

        print(animated(shown).slide)
    print(f"Stimulus: {path}")


def _beginning(asked: dict[str, Any]) -> tuple[Stimulus, Population | None]:
    """The stimulus before any transform, of a file or of a population."""
    from eigenwalker.datasets.built_in import BUILT_IN, load_population
    from eigenwalker.stimulus.make import make_stimulus
    from eigenwalker.stimulus.stimulus import Stimulus

    path = asked["people"]
    if path is not None and path.suffix.lower() == ".json":
        return _shown_anew(Stimulus.load(path), asked), None
    if path is None:
        print(f"Using {BUILT_IN}.", file=sys.stderr)
    population = load_population(path)
    if asked["with_flagged"]:
        population = population.trusting_all()
    walker = _walker(population, asked["start_from"], asked["trait"], asked["information"])
    looks = {"style": asked["style"], "rate_hz": asked["rate"]}
    if asked["size"] is not None:
        looks["size_px"] = _size(asked["size"])
    made = make_stimulus(
        walker,
        view_deg=asked["view"],
        elevation_deg=asked["elevation"],
        eye_distance_mm=asked["eye_distance"],
        duration_s=asked["duration"],
        provenance={"source": BUILT_IN if path is None else path.name, **population.provenance},
        **{name: value for name, value in looks.items() if value is not None},
    )
    return made, population


def _shown_anew(shown: Stimulus, asked: dict[str, Any]) -> Stimulus:
    """A stimulus of a file with another duration, rate or style; its view stays."""
    from dataclasses import replace

    for option in ("trait", "information", "morph_to", "size", "eye_distance"):
        if asked[option]:
            name = option.replace("_", "-")
            raise ValueError(f"--{name} is for populations; {asked['people'].name} is a stimulus.")
    timing, display = shown.timing, shown.display
    if asked["duration"] is not None:
        timing = replace(timing, duration_s=asked["duration"])
    if asked["rate"] is not None:
        timing = replace(timing, rate_hz=asked["rate"])
    if asked["style"] is not None:
        display = replace(display, style=asked["style"])
    return replace(shown, timing=timing, display=display)


def _walker(
    population: Population, start: str, traits: list[str] | None, information: str
) -> Walker:
    from eigenwalker.stimulus.walker_information import with_information

    if start != "average" and not (start.isdigit() and int(start) < len(population)):
        raise ValueError(
            f"--from {start}: expected 'average', or a walker from 0 to {len(population) - 1}."
        )
    vector = population.average if start == "average" else population.X[int(start)]
    vector = _moved(population, vector, traits)
    if information:
        return with_information(population, vector, information)  # pyright: ignore[reportArgumentType] - checked there
    return population.walker(vector)


def _moved(population: Population, vector: np.ndarray, traits: list[str] | None) -> np.ndarray:
    """A walker moved along traits, each as ``sex=+3``."""
    from eigenwalker.analysis.trait_axis import trait_axis

    for wish in traits or []:
        name, _, alpha = wish.rpartition("=")
        try:
            steps = float(alpha)
        except ValueError:
            raise ValueError(
                f"{wish!r} does not say how far; write a trait and standard deviations: sex=+3."
            ) from None
        vector = vector + steps * trait_axis(population, name).step
    return vector


def _chain(
    asked: dict[str, Any], population: Population | None
) -> Iterator[tuple[str, dict[str, Any]]]:
    """The transforms asked for, in the order of the module's first lines."""
    for option, parameter in ORDER:
        value = asked[option]
        if value is None or value is False or value == []:
            continue
        if option == "morph_to":
            assert population is not None
            vector = _moved(population, population.average, value)
            yield "morph", {"walker": population.walker(vector)}
        elif option in ("occlude", "show"):
            key = "parts" if option == "occlude" else "show"
            yield "occlude", {key: value.split("/")}
        elif parameter is not None:
            yield option, {parameter: value}
        elif value is True:
            yield option, {}
        else:
            for text in [value] if isinstance(value, str) else value:
                yield option, _parameters(option, text)


ORDER: tuple[tuple[str, str | None], ...] = (
    *(("gain", None), ("arm_swing", "factor"), ("conflict", None), ("ellipses", None)),
    *(("perturb", None), ("speed", "factor"), ("start", "phase_deg"), ("reverse", None)),
    *(("freeze", "time_s"), ("delay", None), ("phase_scramble", None), ("morph_to", None)),
    *(("mirror", None), ("overground", None), ("rotate", None), ("invert", None)),
    *(("occlude", None), ("show", None), ("scramble", None), ("limb_dots", None)),
    *(("blur", "sd_mm"), ("mask", None)),
)
"""Options in the order in which they act, and the parameter of those that take one number."""
IN_WORDS = ("parts", "signal_to_noise", "dots_per_m2")
"""Names that stand for parameters."""


def _parameters(option: str, text: str) -> dict[str, Any]:
    """Parameters of ``seed=3,box=400/1500``; a name may lack its unit."""
    from eigenwalker.stimulus.transforms import TRANSFORMS

    known = [*TRANSFORMS[option].fields, *IN_WORDS]
    found: dict[str, Any] = {}
    for pair in text.split(","):
        name, equals, value = pair.strip().partition("=")
        full = [k for k in known if k == name] or [k for k in known if k.startswith(f"{name}_")]
        if not equals or len(full) != 1:
            raise ValueError(
                f"--{option.replace('_', '-')} {text}: expected name=value, with names among "
                f"{known}, got {pair!r}."
            )
        found[full[0]] = _value(full[0], value)
    return found


def _value(name: str, text: str) -> Any:
    """A number, true, false, null, a word, or several of them between slashes."""
    parts = [_word(part) for part in text.split("/")]
    several = len(parts) > 1 or name in ("markers", "parts")
    return parts if several else parts[0]


def _word(text: str) -> Any:
    plain = {"true": True, "false": False, "null": None, "none": None}
    if text.lower() in plain:
        return plain[text.lower()]
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text


def _size(text: str) -> tuple[int, int]:
    width, _, height = text.lower().partition("x")
    if not (width.isdigit() and height.isdigit()):
        raise ValueError(f"--size {text}: expected width and height in pixels, as in 512x512.")
    return int(width), int(height)


@contextmanager
def _bar(title: str) -> Iterator[Callable[[int, int], None]]:
    """A progress bar on the error stream, and what to call as work proceeds."""
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task(title, total=None)
        yield lambda done, total: progress.update(task, completed=done, total=total)
