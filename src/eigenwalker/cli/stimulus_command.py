"""``eigenwalker stimulus --trait sex=2 --invert -o stim.json``: a walker, transforms, a view.

``eigenwalker synthesize`` is the same command; without ``-o`` it writes ``walker.mp4``, of whole
strides.

Options may be typed in any order. They are applied in this one: who walks (``--from``, ``--trait``,
``--information``); the body (``--gain``, ``--arm-swing``, ``--conflict``, ``--ellipses``,
``--perturb``); time (``--speed``, ``--start``, ``--reverse``, ``--freeze``, ``--delay``,
``--phase-scramble``, ``--morph-to``); space (``--mirror``, ``--overground``, ``--rotate``,
``--invert``); dots (``--occlude``, ``--show``, ``--scramble``, ``--limb-dots``, ``--blur``); noise
(``--mask``). Any other chain is made in Python, or written into the JSON.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from eigenwalker.cli.options import (
    Elevation,
    KeepSize,
    MappingFile,
    RestPose,
    Seed,
    SkeletonNames,
    StartFrom,
    TraitSteps,
    View,
    WithFlagged,
    is_published,
    load_people,
    option,
    progress_bar,
    sized_people,
    start_capture,
    start_vector,
    trait_axes,
)
from eigenwalker.cli.stimulus_options import (
    check_of_a_file,
    check_sizes,
    check_together,
    named,
    typed_options,
)

if TYPE_CHECKING:
    import numpy as np

    from eigenwalker.analysis.trait_axis import TraitAxis
    from eigenwalker.core.walker import Walker
    from eigenwalker.population.population import Population
    from eigenwalker.stimulus.figure import Figure
    from eigenwalker.stimulus.rig_choices import RigChoices
    from eigenwalker.stimulus.stimulus import Stimulus
    from eigenwalker.study.process_capture import CaptureResult

NO_STIMULUS = "This is no stimulus: "
"""How a stimulus begins to say what is wrong with it; `in_options` names the options."""
Texts = list[str] | None
"""Texts as typed, ``seed=3,keep=structure``, once or several times."""


def stimulus(
    people: Annotated[
        Path | None,
        typer.Argument(
            help="Population (.nc), published walkers (.json, .mat) or a stimulus (.json); left "
            "out, the built-in population."
        ),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o",
            "--output",
            help=".json, .mp4, .webm, .gif, .png, .svg, .csv, .npz, .mat, .py, .html, .bvh, .glb; "
            "a folder for frames. Left out, stim.json (synthesize: walker.mp4).",
        ),
    ] = None,
    trait: TraitSteps = None,
    kind: Annotated[
        str, option("'discriminant' tells the trait best, 'mean_difference' shows it best.")
    ] = "discriminant",
    part: Annotated[
        str, option("What the axis may change: all, structure, dynamics, p1, p1+p2, ...")
    ] = "all",
    components: Annotated[int, option("Eigenwalkers that the axis uses.")] = 10,
    start_from: StartFrom = "average",
    information: Annotated[str, option("'full', 'structure' or 'dynamics' only.")] = "",
    gain: Annotated[Texts, option("Joints that move more: parts=legs,factor=0.5")] = None,
    arm_swing: Annotated[float | None, option("Factor of the arms' swing.")] = None,
    conflict: Annotated[Texts, option("shoulder_width=1.2,hip_sway=2 (Mather, Murdoch)")] = None,
    ellipses: Annotated[Texts, option("shoulder=35/12,hip=15/20 mm (Cutting)")] = None,
    perturb: Annotated[Texts, option("markers=left_knee,amount=0/50/0,frequency=3")] = None,
    speed: Annotated[float | None, option("Playback speed; 1 is its own.")] = None,
    start: Annotated[
        str | None,
        option(
            "Phase of the stride at which it begins, degrees, 0 if left out: the left ankle passes "
            "the right one; or seed=3, one drawn at random."
        ),
    ] = None,
    reverse: Annotated[bool, option("Play backwards.", "--reverse")] = False,
    freeze: Annotated[float | None, option("Stand still as at this second.")] = None,
    delay: Annotated[Texts, option("parts=arms,phase=90: lag behind the rest")] = None,
    phase_scramble: Annotated[str | None, option("seed=3: a clock for each dot")] = None,
    morph_to: Annotated[
        Texts, option("Become the walker of this trait while it is shown: sex=-2; may be repeated.")
    ] = None,
    mirror: Annotated[bool, option("Swap left and right.", "--mirror")] = False,
    overground: Annotated[
        bool, option("Walk forward, not on a treadmill.", "--overground")
    ] = False,
    rotate: Annotated[Texts, option("axis=z,angle=40,speed=0: x, y, z, sight or 1/0/1")] = None,
    invert: Annotated[bool, option("Upside down.", "--invert")] = False,
    occlude: Annotated[str | None, option("Parts to hide: lower_body, left_knee/head")] = None,
    show: Annotated[str | None, option("Parts to show; the others are hidden.")] = None,
    scramble: Annotated[str | None, option("seed=3,keep=structure,directions=horizontal")] = None,
    limb_dots: Annotated[str | None, option("number=8,lifetime=0.1,seed=1 (Beintema)")] = None,
    blur: Annotated[
        str | None,
        option(
            "Blobs of this standard deviation in place of dots: 12px, 0.4deg, or mm on a walker of "
            "usual height; the same for all walkers."
        ),
    ] = None,
    mask: Annotated[Texts, option("kind=scrambled,number=30,seed=2 or signal_to_noise=0.5")] = None,
    view: View = 30.0,
    elevation: Elevation = 0.0,
    eye_distance: Annotated[float | None, option("mm, for a perspective picture.")] = None,
    duration: Annotated[
        float | None, option("Seconds; 4 if left out (synthesize: whole strides).")
    ] = None,
    strides: Annotated[
        int | None, option("Whole strides in place of a duration, so that it loops.")
    ] = None,
    rate: Annotated[float | None, option("Frames a second; 60 if left out.")] = None,
    style: Annotated[str | None, option("'dots', 'sticks' or 'mannequin'.")] = None,
    size: Annotated[str | None, option("Picture in pixels: 512x512")] = None,
    height_deg: Annotated[
        float | None, option("Height of the walker in degrees of visual angle.")
    ] = None,
    dot_deg: Annotated[
        float | None, option("Diameter of dots, degrees; 0.12 with --height-deg.")
    ] = None,
    dot_px: Annotated[
        float | None, option("Diameter of dots, pixels; a fiftieth of the picture if left out.")
    ] = None,
    dot_mm: Annotated[float | None, option("Diameter of dots, mm of the screen.")] = None,
    distance: Annotated[float, option("From the eye to the screen, mm.")] = 570.0,
    px_per_cm: Annotated[float, option("Pixels a centimetre of the screen.")] = 38.0,
    skeleton: SkeletonNames = "plain",
    rest_pose: RestPose = "t",
    in_place: Annotated[
        bool, option("The rig walks on the spot; else it travels.", "--in-place")
    ] = False,
    rig_unit: Annotated[str | None, option("cm (.bvh) or m (.glb), if left out.")] = None,
    up: Annotated[str, option("Axis that points up in .bvh: y or z.")] = "y",
    crowd: Annotated[
        int | None,
        option("So many people, drawn from the population: a .glb, or a folder of .bvh."),
    ] = None,
    seed: Seed = 1,
    keep_size: KeepSize = False,
    with_flagged: WithFlagged = False,
    conditions: Annotated[
        Path | None,
        option("Table, CSV or XLSX: a stimulus a row, an option a column; -o names the folder."),
    ] = None,
    mapping: MappingFile = None,
    *,
    context: typer.Context,
) -> None:
    """Make a walker, say what is done to it and how it is shown, and write it to anything.

    Options act in one order, however they are typed: body, time, space, dots, noise, as listed.
    """
    options = {**locals(), "typed": set(typed_options(context))}
    if conditions is not None:
        from eigenwalker.cli.stimulus_set import write_set

        write_set(context, conditions, output or Path("stimuli"), _made)
        return
    from eigenwalker.cli.stimulus_provenance import walker_line
    from eigenwalker.stimulus.write_stimulus import FILMS, write_stimulus

    film = str(context.info_name).endswith("synthesize")
    output = options["output"] = output or Path("walker.mp4" if film else "stim.json")
    if crowd is not None:
        from eigenwalker.cli.crowd import write_crowd

        check_together(options, output)
        _check_crowd(options, output)
        people_there = load_people(people, with_flagged)
        write_crowd(people_there, output, {**options, "keep_size": True}, _rig_choices(options))
        return
    made, rig = _made(options, film)
    with progress_bar("Writing") as progress:
        path = write_stimulus(made, output, progress=progress, rig=rig)
    names = ", then ".join(step["name"] for step in made.transforms)
    print(walker_line(made.provenance))
    print(f"Transforms: {names or 'none'}; {made.timing.duration_s:g} s")
    if path.suffix.lower() in (".bvh", ".glb"):
        from eigenwalker.stimulus.animation import animated

        print(animated(made, choices=rig, closed=path.suffix.lower() == ".glb"))
    print(f"{'Film' if path.suffix.lower() in FILMS else 'Stimulus'}: {path}")


synthesize = stimulus


def _made(
    options: dict[str, Any],
    film: bool,
    people_of: Callable[[Path | None, bool, bool], Population] = sized_people,
) -> tuple[Stimulus, RigChoices]:
    """The stimulus that options describe, and how its rig is written."""
    from eigenwalker.datasets.bml import looks_like_bml
    from eigenwalker.stimulus.write_stimulus import check_suffix

    output, people, strides = options["output"], options["people"], options["strides"]
    check_suffix(output)
    rig = _rig_choices(options)
    check_together(options, output)
    check_sizes(options)
    if people is not None and people.suffix.lower() == ".json" and not looks_like_bml(people):
        made, population = _of_a_stimulus(options), None
    else:
        population = people_of(people, options["with_flagged"], options["keep_size"])
        options["as_rig"] = output.suffix.lower() in (".bvh", ".glb")
        made = _of_a_population(population, options)
    steps = list(transforms_typed(options, population))
    made = then_typed(made, [step for step in steps if step[0] not in OF_THE_DISPLAY])
    made = _on_screen(made, options)
    made = then_typed(made, [step for step in steps if step[0] in OF_THE_DISPLAY])
    if strides or (film and options["duration"] is None):
        made = made.whole_strides(strides)
    return made, rig


def _rig_choices(options: dict[str, Any]) -> RigChoices:
    """How a rig is written."""
    from eigenwalker.cli.options import check_choice
    from eigenwalker.stimulus.rig_choices import RigChoices

    names = {"skeleton": "skeleton", "rest_pose": "rest_pose", "in_place": "in_place",
             "rig_unit": "unit", "up": "up"}  # fmt: skip
    choices = RigChoices(**{field: options[name] for name, field in names.items()})
    check_choice(choices.skeleton, ("plain", "mixamo", "unreal", "unity"), "--skeleton")
    check_choice(choices.rest_pose, ("t", "a"), "--rest-pose")
    check_choice(choices.unit or "cm", ("cm", "m"), "--rig-unit")
    check_choice(choices.up, ("y", "z"), "--up")
    return choices


def _on_screen(made: Stimulus, options: dict[str, Any]) -> Stimulus:
    """The stimulus with its walker and its dots as large as asked for."""
    from dataclasses import replace

    from eigenwalker.stimulus.dot_size import degrees_in_px, with_dots

    screen = {"viewing_distance_mm": options["distance"], "px_per_cm": options["px_per_cm"]}
    sizes = {name: options[f"dot_{name}"] for name in ("px", "deg", "mm")}
    if (height := options["height_deg"]) is not None:
        high = degrees_in_px(replace(made.display, **screen), height, "height_deg")
        if high > MOST_PX:
            raise ValueError(
                f"--height-deg {height:g} is {high:.0f} px high at this --distance and "
                f"--px-per-cm; expected up to {MOST_PX} px."
            )
        made = made.sized(height, **screen)
    elif sizes["deg"] is not None or sizes["mm"] is not None or "deg" in (options["blur"] or ""):
        made = replace(made, display=replace(made.display, **screen))
    display = with_dots(made.display, **sizes)
    if display.dot_px > MOST_DOT_PX:
        typed = next(f"--dot-{name} {size:g}" for name, size in sizes.items() if size is not None)
        raise ValueError(
            f"{typed} is a dot of {display.dot_px:g} px; expected up to {MOST_DOT_PX}."
        )
    return replace(made, display=display)


def then_typed(made: Stimulus, steps: Iterable[tuple[str, dict[str, Any]]]) -> Stimulus:
    """The stimulus with more transforms; what is wrong with one names its option."""
    for name, parameters in steps:
        try:
            made = made.then(name, **parameters)
        except (ValueError, TypeError) as error:
            if str(error).startswith(NO_STIMULUS):
                raise
            option = named(["show" if "show" in parameters else name])
            raise ValueError(f"{option}: {error}") from error
    return made


MOST_PX, MOST_DOT_PX = 8192, 1000
"""Of pictures and dots, as a stimulus file has them."""


def _check_crowd(options: dict[str, Any], output: Path) -> None:
    """Refuse options that make no crowd, before any work."""
    number = options["crowd"]
    if options["seed"] < 0:
        raise ValueError(f"--seed {options['seed']}: expected a whole number from 0.")
    if not 1 <= number <= MAX_PEOPLE:
        raise ValueError(f"--crowd {number}: expected 1 to {MAX_PEOPLE} people.")
    if output.suffix.lower() not in (".glb", ""):
        raise ValueError(
            f"--crowd writes one .glb, or a folder of .bvh files; {output} is neither."
        )


MAX_PEOPLE = 1000


def _of_a_population(population: Population, options: dict[str, Any]) -> Stimulus:
    """The stimulus before any transform."""
    from eigenwalker.cli.stimulus_provenance import of_a_walker
    from eigenwalker.stimulus.make import make_stimulus

    size = options["size"]
    looks = {"style": options["style"], "rate_hz": options["rate"]}
    looks |= {"size_px": None if size is None else _size(size)}
    return make_stimulus(
        _walker(population, options),
        azimuth_deg=options["view"],
        elevation_deg=options["elevation"],
        eye_distance_mm=options["eye_distance"],
        duration_s=options["duration"],
        provenance={**population.provenance, **of_a_walker(population, options)},
        **{name: value for name, value in looks.items() if value is not None},
    )


def _of_a_stimulus(options: dict[str, Any]) -> Stimulus:
    """The stimulus of a file with another duration, rate or style; its view stays."""
    from dataclasses import replace

    from eigenwalker.cli.stimulus_provenance import of_a_file
    from eigenwalker.stimulus.stimulus import Stimulus

    check_of_a_file(options)
    made = Stimulus.load(options["people"])
    timing = {"duration_s": options["duration"], "rate_hz": options["rate"]}
    timing = {name: value for name, value in timing.items() if value is not None}
    style = {} if options["style"] is None else {"style": options["style"]}
    return replace(
        made,
        timing=replace(made.timing, **timing),
        display=replace(made.display, **style),
        provenance=of_a_file(options["people"], dict(made.provenance)),
    )


def _walker(population: Population, options: dict[str, Any]) -> Walker | Figure:
    from eigenwalker.stimulus.make import with_information

    name = options["start_from"]
    own = None
    if options["as_rig"] and name != "average" and not name.isdecimal():
        if options["information"]:
            raise ValueError("--information is for stimuli; a rig keeps the bones of its capture.")
        own = start_capture(population, name, options["mapping"], joints="full")
        start = population.vector(own.walker)
    else:
        start = start_vector(population, name, options["mapping"])
    vector = moved_along_traits(population, start, options["trait"], options)
    if own is not None:
        return _own_figure(population, own, start, vector)
    if options["trait"] and not options.get("quiet"):
        _print_plausibility(population, vector, is_published(options["people"]))
    if options["information"]:
        return with_information(population, vector, options["information"])
    return population.walker(vector)


def _own_figure(
    population: Population, own: CaptureResult, start: np.ndarray, vector: np.ndarray
) -> Figure:
    """The person of a capture with all its joints and its own bones."""
    import numpy as np

    from eigenwalker.core.skeleton import JOINTS
    from eigenwalker.decomposition.fourier import decompose_fourier
    from eigenwalker.io.writers.rig import EXTRAS
    from eigenwalker.stimulus.captured_body import captured_body
    from eigenwalker.stimulus.figure import Figure

    seen = ~np.isnan(own.walk.values).any(axis=(0, 2))
    names = [str(name) for name in own.walk.marker.values[seen]]
    names = [name for name in names if name in (*JOINTS.markers, *EXTRAS)]
    captured = own.walk.sel(marker=names)
    walker = decompose_fourier(captured, n_harmonics=N_OWN_HARMONICS)
    walk = captured_body(captured, walker, population.walker(start), population.walker(vector))
    print(f"The bones of the capture, {len(names)} points: {', '.join(names[15:]) or 'no feet'}.")
    return Figure(walk, repeat=True)


N_OWN_HARMONICS = 6
"""Of one's own capture: as much of its motion as repeats."""


def moved_along_traits(
    population: Population,
    vector: np.ndarray,
    traits: Texts,
    options: dict[str, Any],
    option: str = "--trait",
) -> np.ndarray:
    """Return features moved along traits, and print how far that is."""
    axis_options: dict[str, Any] = {name: options[name] for name in ("kind", "part")}
    axis_options["n_components"] = options["components"]
    axes = trait_axes(population, traits, option, **axis_options)
    vector = vector + sum(steps * axis.step for axis, steps in axes)
    for axis, steps in [] if options.get("quiet") else axes:
        print(_position_line(population, axis, vector, steps, is_published(options["people"])))
    if (
        axes
        and not options.get("quiet")
        and not (options["keep_size"] or is_published(options["people"]))
    ):
        print("People's size is divided out; --keep-size keeps it.")
    return vector


def _position_line(
    population: Population,
    axis: TraitAxis,
    vector: np.ndarray,
    steps: float,
    published: bool = False,
) -> str:
    contrast = axis.contrast
    pole = contrast.positive if steps >= 0 else contrast.negative
    moved = f"{contrast.trait}: {abs(steps):g} standard deviations towards {pole}"
    if published:
        return f"{moved}, along the published axis."
    place = float(axis.positions(vector[None])[0])
    walkers = axis.positions(population.X[contrast.rows])
    beyond = "beyond all walkers, who reach" if abs(place) > abs(walkers).max() else "walkers reach"
    return f"{moved}, to {place:+.1f}; {beyond} {walkers.min():+.1f} to {walkers.max():+.1f}."


def _print_plausibility(
    population: Population, vector: np.ndarray, published: bool = False
) -> None:
    from eigenwalker.analysis.plausibility import plausibility

    result = plausibility(population, vector)
    limbs = (f"{name} {100 * change:+z.0f} %" for name, change in result.limb_change.items())
    if not published:  # where there are no single walkers to be near to
        print(
            f"Distance from the average walker: {result.position.distance:.1f} times the usual "
            f"({result.position.percentile:.0f} % of the walkers are nearer)."
        )
    print(f"Limbs: {', '.join(limbs)}")


def transforms_typed(
    options: dict[str, Any], population: Population | None
) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield name and parameters of the transforms, in the order of the module's first lines."""
    for name, parameter in ORDER:
        value = options[name]
        if value is None or value is False or value == []:
            continue
        if name == "morph_to":
            assert population is not None
            vector = moved_along_traits(
                population, population.average, value, options, "--morph-to"
            )
            yield "morph", {"walker": population.walker(vector)}
        elif name in ("occlude", "show"):
            yield "occlude", {"parts" if name == "occlude" else "show": value.split("/")}
        elif name == "blur":
            yield name, _blob(value)
        elif name == "arm_swing" and not abs(value) <= MOST_SWING:
            raise ValueError(f"--arm-swing: expected a number up to {MOST_SWING}, got {value:g}.")
        elif name == "start":
            yield name, {"phase_deg": _phase_deg(value)}
        elif parameter is not None:
            yield name, {parameter: value}
        elif value is True:
            yield name, {}
        else:
            for text in [value] if isinstance(value, str) else value:
                yield name, _parameters(name, text)


ORDER: tuple[tuple[str, str | None], ...] = (
    *(("gain", None), ("arm_swing", "factor"), ("conflict", None), ("ellipses", None)),
    *(("perturb", None), ("speed", "factor"), ("start", None), ("reverse", None)),
    *(("freeze", "time_s"), ("delay", None), ("phase_scramble", None), ("morph_to", None)),
    *(("mirror", None), ("overground", None), ("rotate", None), ("invert", None)),
    *(("occlude", None), ("show", None), ("scramble", None), ("limb_dots", None)),
    *(("blur", None), ("mask", None)),
)
"""Options in the order in which they act, and the parameter of those that take one number."""
MOST_SWING = 100
"""As much as `gain` takes."""
OF_THE_DISPLAY = ("blur", "mask")
"""Transforms that go by the size in which the walker is shown."""
SPECIAL_PARAMETERS = {"mask": ("signal_to_noise", "dots_per_m2")} | dict.fromkeys(
    ("gain", "delay", "perturb"), ("parts",)
)
"""Texts of transforms that are not fields of theirs."""


def _parameters(option: str, text: str) -> dict[str, Any]:
    """Return the parameters of ``seed=3,box=400/1500``; a name may lack its unit."""
    from eigenwalker.stimulus.schema import TRANSFORMS

    typed = named([option])
    known = [*TRANSFORMS[option].parameter_names(), *SPECIAL_PARAMETERS.get(option, ())]
    parameters: dict[str, Any] = {}
    for pair in text.split(","):
        name, equals, value = pair.strip().partition("=")
        full = [k for k in known if k == name] or [k for k in known if k.startswith(f"{name}_")]
        if not equals or len(full) != 1:
            raise ValueError(
                f"{typed} {text}: expected name=value, with names among {', '.join(known)}, got "
                f"{pair!r}."
            )
        if full[0] in parameters:
            raise ValueError(f"{typed} {text}: {full[0]} is given twice; give it once.")
        values = [_value(part) for part in value.split("/")]
        several = len(values) > 1 or full[0] in ("markers", "parts")
        parameters[full[0]] = values if several else values[0]
    return parameters


def _blob(text: str) -> dict[str, Any]:
    """Return the size of blobs: ``12px``, ``0.4deg``, or ``20`` mm on a walker of usual height."""
    number = text.lower().removesuffix("px").removesuffix("deg").removesuffix("mm")
    unit = text.lower().removeprefix(number)
    try:
        size = float(number)
    except ValueError:
        size = math.nan
    most = 90 if unit == "deg" else 10_000
    if not 0 < size < most:
        raise ValueError(
            f"--blur {text}: expected a size above 0 and below {most}, as in 12px, 0.4deg or 20mm."
        )
    return {f"sd_{'usual_mm' if unit in ('', 'mm') else unit}": size}


def _phase_deg(text: str) -> float:
    """Return a phase in degrees; of ``seed=3`` one drawn at random."""
    name, equals, seed = text.partition("=")
    if equals and name.strip() == "seed" and seed.strip().isdecimal():
        from eigenwalker.stimulus.random_streams import Purpose, uniforms

        drawn = uniforms(Purpose.START, int(seed), [0], 0, count=1)
        return round(360 * float(drawn.ravel()[0]), 3)
    try:
        return float(text)
    except ValueError:
        raise ValueError(f"--start {text}: expected degrees, or 'seed=3'.") from None


def _value(text: str) -> Any:
    """Return a number, true, false, null, or the word itself."""
    constants = {"true": True, "false": False, "null": None, "none": None}
    if text.lower() in constants:
        return constants[text.lower()]
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text


def _size(text: str) -> tuple[int, int]:
    width, _, height = text.lower().partition("x")
    sizes = [int(side) if side.isdecimal() else 0 for side in (width, height)]
    if not all(16 <= size <= MOST_PX for size in sizes):
        raise ValueError(
            f"--size {text}: expected width and height in pixels, 16 to {MOST_PX}, as in 512x512."
        )
    return sizes[0], sizes[1]
