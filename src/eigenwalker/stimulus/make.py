"""Stimuli of walkers and trajectories, in the middle of the picture and as large as it allows."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Literal

import numpy as np
import xarray as xr

from eigenwalker._version import __version__
from eigenwalker.core.arguments import check_choice, check_kind, check_numbers
from eigenwalker.core.walker import Walker
from eigenwalker.plotting.layout import DEFAULT_DURATION_S
from eigenwalker.population.population import Population, check_population
from eigenwalker.stimulus.call_text import call_text, with_call
from eigenwalker.stimulus.dot_size import usual_dot_px, with_dots
from eigenwalker.stimulus.figure import Figure
from eigenwalker.stimulus.schema import Display, Style, Timing, View
from eigenwalker.stimulus.start_phase import beginning_at
from eigenwalker.stimulus.stimulus import Stimulus

FILLED_SHARE = 0.84
"""Share of the picture that figures fill."""
Information = Literal["full", "structure", "dynamics"]


def make_stimulus(
    figures: Walker | xr.DataArray | Figure | Iterable[Walker | xr.DataArray | Figure],
    *,
    azimuth_deg: float = 30.0,
    elevation_deg: float = 0.0,
    eye_distance_mm: float | None = None,
    duration_s: float | None = None,
    rate_hz: float = 60.0,
    style: Style = "dots",
    size_px: tuple[int, int] = (512, 512),
    colour: str = "#ffffff",
    background: str = "#000000",
    dot_px: float | None = None,
    dot_deg: float | None = None,
    dot_mm: float | None = None,
    viewing_distance_mm: float | None = None,
    px_per_cm: float | None = None,
    phase_deg: float | None = 0.0,
    provenance: Mapping[str, str] | None = None,
) -> Stimulus:
    """Return a stimulus of one figure, or of several in one scene, as large as the picture allows.

    Parameters
    ----------
    figures : Walker, DataArray of shape (time, marker, axis) in mm, Figure, or several of them
        What moves. A `Figure` also has a position, a heading and a skeleton.
    azimuth_deg, elevation_deg : float
        The view; an azimuth of 0 is the front, 90 in profile to the right.
    eye_distance_mm : float, optional
        From the eye to the middle of the scene, for a perspective picture.
    duration_s : float, optional
        Left out, 4 for walkers, and as long as the shortest of the trajectories.
    rate_hz : float
        Frames a second of films and tables.
    style : {"dots", "sticks", "mannequin"}
        What is drawn; a mannequin's thickness goes with its height.
    size_px : (width, height)
    colour, background : str
        As in ``"#ffffff"``.
    dot_px, dot_deg, dot_mm : float, optional
        Diameter of dots on the screen, in pixels, degrees of visual angle or millimetres; left out,
        a fiftieth of the picture's shorter side. It does not go with the figures: dots of a short
        walker are as large as those of a tall one. Sticks are 0.6 times as wide.
    viewing_distance_mm, px_per_cm : float, optional
        The screen, for sizes in degrees and millimetres.
    phase_deg : float, optional
        Phase of the stride with which all walkers begin: with 0 the left ankle passes the right one
        on its way forward. With None, and without ankles, each begins with its own first phase.
    provenance : mapping of str to str, optional
        Source, licence, citation; the program's version is added.

    Returns
    -------
    Stimulus

    See Also
    --------
    write_stimulus : Films, pages, tables and scripts of a stimulus.
    with_information : Walkers that show structure only, or dynamics only.

    References
    ----------
    Troje (2002), Methods, experiment: point-light displays on a treadmill, at 0, 30, 90 degrees.

    Examples
    --------
    >>> hop = ew.Walker(["foot"], [[0, 0, 50]], [[[0, 0, 40]]], [1], [0], 1.0)
    >>> shown = make_stimulus(hop, azimuth_deg=0, duration_s=1).then("invert")
    >>> shown.play([0.25]).positions[0, 0].round(6).tolist()
    [0.0, 0.0, 10.0]
    """
    given = dict(locals())
    kinds, expected = (Walker, xr.DataArray, Figure), "walkers, trajectories or figures"
    check_kind(figures, (*kinds, Iterable), expected)
    several = [figures] if isinstance(figures, Walker | xr.DataArray | Figure) else list(figures)
    for item in several:
        check_kind(item, kinds, expected)
    if not -90 <= float(check_numbers(elevation_deg, "elevation_deg")) <= 90:
        raise ValueError(f"elevation_deg={elevation_deg:g} is no elevation; give -90 to 90.")
    given["figures"] = several[0] if len(several) == 1 else several
    whole = [_beginning(item, phase_deg) for item in several]
    if not whole:
        raise ValueError("There is no figure to show; give one or more.")
    if duration_s is None:
        walks = [figure.motion for figure in whole if isinstance(figure.motion, xr.DataArray)]
        duration_s = min(
            (float(np.ptp(walk.time.values)) for walk in walks), default=DEFAULT_DURATION_S
        )
    program = f"eigenwalker {__version__}"
    display = Display(
        width_px=size_px[0],
        height_px=size_px[1],
        px_per_mm=1.0,
        style=style,
        colour=colour,
        background=background,
        viewing_distance_mm=viewing_distance_mm,
        px_per_cm=px_per_cm,
    )
    bare = Stimulus(
        figures=whole,
        view=View(centre_mm=(0, 0, 0), view_deg=azimuth_deg, elevation_deg=elevation_deg),
        timing=Timing(duration_s=duration_s, rate_hz=rate_hz),
        display=with_dots(
            replace(display, dot_px=usual_dot_px(display)), px=dot_px, deg=dot_deg, mm=dot_mm
        ),
        provenance=with_call(
            {**(provenance or {}), "program": program},
            call_text(make_stimulus, given),
        ),
    )
    return _fitted(bare, eye_distance_mm)


def _beginning(item: Walker | xr.DataArray | Figure, phase_deg: float | None) -> Figure:
    """A figure whose walker begins at a phase of the stride."""
    figure = item if isinstance(item, Figure) else Figure(item)
    if phase_deg is None or not isinstance(figure.motion, Walker):
        return figure
    return replace(figure, motion=beginning_at(figure.motion, phase_deg))


def _fitted(bare: Stimulus, eye_distance_mm: float | None) -> Stimulus:
    """Return a stimulus with its figures in the middle of the picture and as large as it allows."""
    low, high = bare.extent()
    middles = np.mean([moving.middle for moving in bare.scene], axis=0)
    middle = np.array([*(low + high) / 2, bare.view.axes[2] @ middles]) @ bare.view.axes
    view = replace(
        bare.view, centre_mm=tuple(middle.round(3).tolist()), eye_distance_mm=eye_distance_mm
    )
    extent = np.maximum(high - low, 100.0)
    if eye_distance_mm is not None:  # what is nearer to the eye reaches farther from the middle
        low, high = replace(bare, view=view).extent()
        seen = 2 * np.maximum(np.abs(low), np.abs(high))
        extent = np.where(np.isfinite(seen), np.maximum(extent, seen), extent)
    room = FILLED_SHARE * np.array([bare.display.width_px, bare.display.height_px])
    scale = float((room / extent).min())
    return replace(bare, view=view, display=replace(bare.display, px_per_mm=scale))


def with_information(
    population: Population, walker: int | np.ndarray, information: Information
) -> Walker:
    """Return a walker with all its information, with its structure only, or its dynamics only.

    ``"structure"`` keeps the mean posture p0; eigenpostures, phases and frequency are the
    population's averages. ``"dynamics"`` keeps eigenpostures, phases and frequency, on the
    population's average posture. Sizes are divided out first, of eigenpostures too, so that all
    walkers are equally tall.

    Parameters
    ----------
    population : Population
        Its averages, without flagged walkers, replace what is not kept.
    walker : int, or array of shape (feature,)
        Number of a walker of the population, or any point of its feature space.
    information : {"full", "structure", "dynamics"}
        What is kept.

    Returns
    -------
    Walker

    See Also
    --------
    make_stimulus : Takes what it returns.

    References
    ----------
    Troje (2002), Methods, experiment, and eq. 12 (size); Mather and Murdoch (1994).

    Examples
    --------
    >>> people = ew.load_population()
    >>> shown = with_information(people, 3, "structure")
    >>> bool(shown.frequency_hz == people.average[people.feature_names.index("frequency_hz")])
    True
    """
    check_population(population)
    same_size = population.size_normalised()
    if isinstance(walker, int | np.integer):
        if not 0 <= walker < len(population):
            raise ValueError(
                f"The population has walkers 0 to {len(population) - 1}, not {walker}."
            )
        own = same_size.X[walker]
    else:
        own = _normalised(population, check_numbers(walker, "walker", "feature"))
    check_choice(information, ("full", "structure", "dynamics"), "information")
    match information:
        case "full":
            return same_size.walker(own)
        case "structure":
            return same_size.walker(same_size.hybrid(structure=own, dynamics=same_size.average))
        case "dynamics":
            return same_size.walker(same_size.hybrid(structure=same_size.average, dynamics=own))


def _normalised(population: Population, vector: np.ndarray) -> np.ndarray:
    """Divide the size out of all postures of a point of the feature space (Troje 2002, eq. 12)."""
    mean = population.average[population.layout.columns("structure")]
    posture = vector[population.layout.columns("structure")]
    size = posture @ mean / (mean @ mean)
    scaled = vector.copy()
    scaled[population.layout.columns("postures")] /= size
    return scaled
