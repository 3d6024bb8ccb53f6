"""``eigenwalker synthesize``: a film of a walker, moved along traits."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from eigenwalker.cli.options import (
    Elevation,
    People,
    StartFrom,
    TraitSteps,
    View,
    WithFlagged,
    check_choice,
    load_people,
    option,
    progress_bar,
    start_vector,
    trait_axes,
)

if TYPE_CHECKING:
    import numpy as np

    from eigenwalker.analysis.trait_axis import TraitAxis
    from eigenwalker.population.population import Population


def synthesize(
    people: People = None,
    trait: TraitSteps = None,
    output: Annotated[Path, option("Film to write: .mp4, .webm or .gif.", "-o", "--output")] = Path(
        "walker.mp4"
    ),
    view: View = 30.0,
    elevation: Elevation = 0.0,
    duration: Annotated[
        float | None, option("Seconds; left out, whole strides of about 4, so that films loop.")
    ] = None,
    style: Annotated[str, option("'dots' or 'sticks'.")] = "dots",
    kind: Annotated[
        str, option("'discriminant' tells the trait best, 'mean_difference' shows it best.")
    ] = "discriminant",
    part: Annotated[
        str, option("What the axis may change: all, structure, dynamics, p1, p1+p2, ...")
    ] = "all",
    components: Annotated[int, option("Eigenwalkers that the axis uses.")] = 10,
    start: StartFrom = "average",
    with_flagged: WithFlagged = False,
) -> None:
    """Film the average walker, or one's own, moved along traits, and say how plausible it is."""
    from eigenwalker.plotting.encoding import FORMATS
    from eigenwalker.plotting.layout import STYLES
    from eigenwalker.plotting.walker_films import write_film

    check_choice(style, STYLES, "--style")
    check_choice(output.suffix.lower(), FORMATS, "the suffix of the film,")
    population = load_people(people, with_flagged)
    axes = trait_axes(population, trait, part=part, n_components=components, kind=kind)
    vector = start_vector(population, start) + sum(steps * axis.step for axis, steps in axes)
    for axis, steps in axes:
        print(_position_line(population, axis, vector, steps))
    walker = population.walker(vector)
    with progress_bar("Filming") as progress:
        write_film(
            walker,
            output,
            duration_s=duration,
            n_strides=max(round(4 * walker.frequency_hz), 1) if duration is None else None,
            azimuth_deg=view,
            elevation_deg=elevation,
            style=style,  # pyright: ignore[reportArgumentType] - checked above
            progress=progress,
        )
    _print_plausibility(population, vector)
    print(f"Film: {output}")


def _position_line(
    population: Population, axis: TraitAxis, vector: np.ndarray, steps: float
) -> str:
    contrast = axis.contrast
    pole = contrast.positive if steps >= 0 else contrast.negative
    place = float(axis.positions(vector[None])[0])
    walkers = axis.positions(population.X[contrast.rows])
    beyond = "beyond all walkers, who reach" if abs(place) > abs(walkers).max() else "walkers reach"
    return (
        f"{contrast.trait}: {abs(steps):g} standard deviations towards {pole}, to {place:+.1f}; "
        f"{beyond} {walkers.min():+.1f} to {walkers.max():+.1f}."
    )


def _print_plausibility(population: Population, vector: np.ndarray) -> None:
    from eigenwalker.analysis.plausibility import plausibility

    result = plausibility(population, vector)
    limbs = (f"{name} {100 * change:+.0f} %" for name, change in result.limb_change.items())
    print(
        f"Distance from the average walker: {result.position.distance:.1f} times the usual "
        f"({result.position.percentile:.0f} % of the walkers are nearer).\n"
        f"Limbs: {', '.join(limbs)}"
    )
