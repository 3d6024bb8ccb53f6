"""Stimuli of walkers and trajectories, in the middle of the picture and as large as it allows."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Literal

import numpy as np
import xarray as xr

from eigenwalker._version import __version__
from eigenwalker.core.walker import Walker
from eigenwalker.plotting.layout import DEFAULT_DURATION_S, DOT_MM
from eigenwalker.plotting.projection import observer_axes
from eigenwalker.population.population import Population
from eigenwalker.stimulus.figure import Figure
from eigenwalker.stimulus.schema import Display, Style, Timing, View
from eigenwalker.stimulus.stimulus import Stimulus

FILLED = 0.84
"""Share of the picture that figures fill where no size is asked for."""
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
    provenance: Mapping[str, str] | None = None,
) -> Stimulus:
    """Return a stimulus of one figure, or of several in one scene, as large as the picture allows.

    Parameters
    ----------
    figures : Walker, trajectories, Figure, or several of them
        Who is seen. A `Figure` says where it stands and how it is joined too.
    azimuth_deg, elevation_deg : float
        From where; 0 is the front, 90 in profile to the right.
    eye_distance_mm : float, optional
        From the eye to the middle of the scene, for a perspective picture.
    duration_s : float, optional
        Left out, 4 for walkers, and what the shortest of the trajectories lasts.
    rate_hz : float
        Frames a second of films and tables.
    style : {"dots", "sticks", "mannequin"}
        What is drawn; a mannequin is as thick as its height has it.
    size_px : (width, height)
        Of the picture.
    colour, background : str
        As in ``"#ffffff"``.
    provenance : mapping of str to str, optional
        Source, licence, citation of what is shown; the program's version is added.

    Returns
    -------
    Stimulus

    Examples
    --------
    >>> hop = ew.Walker(["foot"], [[0, 0, 50]], [[[0, 0, 40]]], [1], [0], 1.0)
    >>> shown = make_stimulus(hop, azimuth_deg=0, duration_s=1).then("invert")
    >>> shown.play([0.25]).positions[0, 0].round(6).tolist()
    [0.0, 0.0, 10.0]

    """
    one = isinstance(figures, Walker | xr.DataArray | Figure)
    given = [figures] if one else list(figures)  # pyright: ignore[reportArgumentType] - several
    whole = [item if isinstance(item, Figure) else Figure(item) for item in given]  # pyright: ignore[reportArgumentType] - the same
    if not whole:
        raise ValueError("There is nobody to show; give one figure or more.")
    if duration_s is None:
        walks = [figure.motion for figure in whole if isinstance(figure.motion, xr.DataArray)]
        duration_s = min(
            (float(np.ptp(walk.time.values)) for walk in walks), default=DEFAULT_DURATION_S
        )
    program = f"eigenwalker {__version__}"
    bare = Stimulus(
        figures=whole,
        view=View((0.0, 0.0, 0.0), azimuth_deg, elevation_deg),
        timing=Timing(duration_s, rate_hz),
        display=Display(1.0, *size_px, style=style, colour=colour, background=background),
        provenance={**(provenance or {}), "program": program},
    )
    return _fitted(bare, eye_distance_mm)


def _fitted(bare: Stimulus, eye_distance_mm: float | None) -> Stimulus:
    """A stimulus with its figures in the middle of the picture and as large as it allows."""
    low, high = bare.extent()
    axes = observer_axes(bare.view.view_deg, bare.view.elevation_deg)
    middles = np.mean([moving.middle for moving in bare.scene], axis=0)
    middle = np.array([*(low + high) / 2, axes[2] @ middles]) @ axes
    view = replace(
        bare.view, centre_mm=tuple(middle.round(3).tolist()), eye_distance_mm=eye_distance_mm
    )
    extent = np.maximum(high - low, 100.0)
    if eye_distance_mm is not None:  # what is nearer to the eye reaches farther from the middle
        low, high = replace(bare, view=view).extent()
        seen = 2 * np.maximum(np.abs(low), np.abs(high))
        extent = np.where(np.isfinite(seen), np.maximum(extent, seen), extent)
    room = FILLED * np.array([bare.display.width_px, bare.display.height_px])
    scale = float((room / extent).min())
    display = replace(bare.display, px_per_mm=scale, dot_px=max(DOT_MM * scale, 2.0))
    return replace(bare, view=view, display=display)


def with_information(
    population: Population, walker: int | np.ndarray, information: Information
) -> Walker:
    """Return a walker as one of the three stimuli of Troje (2002), experiment.

    ``"full"``: all its own. ``"structure"``: its own mean posture p0; eigenpostures, phases and
    frequency are the population's averages. ``"dynamics"``: its own eigenpostures, phases and
    frequency on the population's mean posture (the mean, A16, which is printed without 1/m). Sizes
    are divided out first, of eigenpostures too (eq. 12, A17), so that all are equally tall.

    Parameters
    ----------
    population : Population
        Whose averages stand in. Flagged walkers shape none.
    walker : int, or array of shape (feature,)
        Number of a walker of it, or any point of its feature space.
    information : {"full", "structure", "dynamics"}
        What the stimulus may tell.

    Returns
    -------
    Walker

    Examples
    --------
    >>> people = ew.load_population()
    >>> shown = with_information(people, 3, "structure")
    >>> bool(shown.frequency_hz == people.average[people.feature_names.index("frequency_hz")])
    True

    """
    alike = population.size_normalised()
    if isinstance(walker, int | np.integer):
        if not 0 <= walker < len(population):
            raise ValueError(
                f"The population has walkers 0 to {len(population) - 1}, not {walker}."
            )
        own = alike.X[walker]
    else:
        own = _normalised(population, np.asarray(walker, dtype=float))
    match information:
        case "full":
            return alike.walker(own)
        case "structure":
            return alike.walker(alike.hybrid(structure=own, dynamics=alike.average))
        case "dynamics":
            return alike.walker(alike.hybrid(structure=alike.average, dynamics=own))
    raise ValueError(
        f"information={information!r} is not known; choose 'full', 'structure' or 'dynamics'."
    )


def _normalised(population: Population, vector: np.ndarray) -> np.ndarray:
    """A point of the feature space with its size divided out of all postures (eq. 12)."""
    mean = population.average[population.layout.columns("structure")]
    posture = vector[population.layout.columns("structure")]
    size = posture @ mean / (mean @ mean)
    scaled = vector.copy()
    scaled[population.layout.columns("postures")] /= size
    return scaled
