"""``--crowd 50 --seed 1``: many people who walk, in one GLB or as BVH files in a folder."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from eigenwalker.cli.options import progress_bar
from eigenwalker.cli.stimulus_command import moved_along_traits, then_typed, transforms_typed
from eigenwalker.population.draw_people import draw_people
from eigenwalker.stimulus.animation import Animation, animated
from eigenwalker.stimulus.make import make_stimulus
from eigenwalker.stimulus.rig_choices import RigChoices
from eigenwalker.stimulus.write_stimulus import write_animation

if TYPE_CHECKING:
    from eigenwalker.population.population import Population


def write_crowd(
    population: Population, output: Path, options: dict[str, Any], rig: RigChoices
) -> None:
    """Draw people, let each walk from a moment of the stride of its own, and write them."""
    number, seed, rate_hz = options["crowd"], options["seed"], options["rate"] or 60.0
    people = draw_people(population, number, random_state=seed)
    average = population.average
    people = people + moved_along_traits(population, average, options["trait"], options) - average
    phases = np.random.default_rng([seed, 1]).uniform(0, 360, number)
    digits = len(str(number))
    animations: dict[str, Animation] = {}
    with progress_bar("Walking") as progress:
        for index, (vector, phase) in enumerate(zip(people, phases, strict=True)):
            made = make_stimulus(
                population.walker(vector), duration_s=options["duration"], rate_hz=rate_hz
            )
            if options["start"] is None:
                made = made.then("start", phase_deg=float(phase))
            made = then_typed(made, transforms_typed(options, population))
            if options["duration"] is None:
                made = made.whole_strides(options["strides"] or 1)
            closed = output.suffix.lower() == ".glb"
            figure = animated(made, choices=rig, closed=closed)
            animations[f"walker_{index + 1:0{digits}d}"] = figure
            progress(index + 1, number)
    about = {**population.provenance, "crowd": f"{number} people, seed {seed}"}
    if output.suffix:
        write_animation(animations, output, rate_hz=rate_hz, choices=rig, about=about)
    else:
        output.mkdir(exist_ok=True)
        for name, figure in animations.items():
            path = output / f"{name}.bvh"
            write_animation({name: figure}, path, rate_hz=rate_hz, choices=rig)
    slides = [figure.slide.mean_mm_s for figure in animations.values()]
    print(
        f"{number} people drawn from the population, seed {seed}; "
        f"standing feet slide at {max(slides):.0f} mm/s at most."
    )
    print(f"Crowd: {output}")
