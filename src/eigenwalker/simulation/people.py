"""Many simulated people: their captures, and the population these make."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from joblib import Parallel, delayed

from eigenwalker.core.blas_threads import one_blas_thread
from eigenwalker.core.walker import Walker
from eigenwalker.decomposition.pca import decompose_pca
from eigenwalker.gait.in_place import in_place
from eigenwalker.markers.virtual_markers import virtual_markers
from eigenwalker.population.population import Population
from eigenwalker.simulation.planted_effect import Pattern, plant
from eigenwalker.simulation.provenance import CAPTURE, Recipe
from eigenwalker.simulation.trait_effects import EFFECTS, TRAITS, Effects, draw_people
from eigenwalker.simulation.walk import simulate_walk

_SHARE = 100


def simulate_captures(
    n_women: int = 20,
    n_men: int = 20,
    *,
    seed: int = 0,
    sex_effect: float = 1.0,
    effects: Effects = EFFECTS,
    planted: Mapping[str, Pattern] | None = None,
    **capture: Any,
) -> Iterator[tuple[xr.DataArray, pd.Series]]:
    """Yield the capture of one drawn person after another, with all that is known of the person.

    One capture at a time is in memory, however many there are.

    Parameters
    ----------
    n_women, n_men : int
        How many of each; women come first.
    seed : int
        The same seed gives the same people and captures.
    sex_effect : float
        Multiplies all differences between the sexes, of body and of movement: 0 removes them.
    effects : mapping of trait to mapping of parameter to effect size
        See `draw_people`; ``{}`` for none.
    planted : mapping of trait to Pattern, optional
        Effects in mean posture, movement or frequency themselves, for each unit of the trait's
        score (see `draw_people`: sex counts from -0.5 to 0.5).
    **capture
        How the capture is made, as `simulate_walk` takes it: ``markers="skin"``,
        ``noise_mm=0``. What is left out is `CAPTURE`.

    Yields
    ------
    capture : DataArray of shape (time, marker, axis)
    person : Series
        Traits, parameters and scores, as `draw_people` returns them.

    Examples
    --------
    >>> for capture, person in simulate_captures(1, 1, duration_s=3):
    ...     print(person["sex"], capture.sizes["time"])
    female 360
    male 360

    """
    people = draw_people(n_women, n_men, seed=seed, sex_effect=sex_effect, effects=effects)
    for number in range(len(people)):
        person = people.iloc[number]
        walk = _walked(person, (seed, number), planted or {}, capture)
        yield _planted(walk, person, planted or {}), person


def _walked(
    person: pd.Series, seed: tuple[int, int], planted: Mapping[str, Pattern],
    capture: Mapping[str, Any],
) -> xr.DataArray:  # fmt: skip
    own = {str(name): value for name, value in person.items()}
    own["frequency_hz"] += sum(
        person[f"{trait}_score"] * pattern.frequency_hz for trait, pattern in planted.items()
    )
    return simulate_walk(own, seed=seed, **{**CAPTURE, **capture})


def _planted(walk: xr.DataArray, person: pd.Series, planted: Mapping[str, Pattern]) -> xr.DataArray:
    for trait, pattern in planted.items():
        walk = plant(walk, pattern, person[f"{trait}_score"])
    return walk


def simulate_population(
    n_women: int = 20,
    n_men: int = 20,
    *,
    seed: int = 0,
    sex_effect: float = 1.0,
    effects: Effects = EFFECTS,
    planted: Mapping[str, Pattern] | None = None,
    n_jobs: int = -1,
    **capture: Any,
) -> Population:
    """Return a population of simulated walkers, every property of which is known.

    Each capture is made and goes on as in Troje (2002): 38 markers on the skin, the 15 joints
    found from them, brought in place, decomposed, brought into correspondence.

    Parameters
    ----------
    n_women, n_men, seed, sex_effect, effects, planted, **capture
        See `simulate_captures`; with ``markers="joints"`` the true joints are taken. Effects are
        planted in the 15 joints.
    n_jobs : int
        Processes that share the work of more than a hundred walkers; -1 for one a core.

    Returns
    -------
    Population
        With the traits sex, age_years, weight_kg, height_mm, happy and nervous; `truth_of` tells
        the rest.

    Examples
    --------
    >>> people = simulate_population(2, 2, seed=1)
    >>> people.X.shape
    (4, 229)

    """
    people = draw_people(n_women, n_men, seed=seed, sex_effect=sex_effect, effects=effects)
    planted = dict(planted or {})
    capture = {"markers": "skin", **CAPTURE, **capture}
    recipe = Recipe(n_women, n_men, seed, sex_effect, effects, planted, capture)
    parts = np.array_split(np.arange(len(people)), max(len(people) // _SHARE, 1))
    work = (delayed(_walkers)(people.iloc[part], part, seed, planted, capture) for part in parts)
    found = Parallel(n_jobs=n_jobs if len(parts) > 1 else 1)(work)
    walkers = [walker for some in found or () for walker in some or ()]
    return Population(
        walkers,
        people[list(TRAITS)],
        provenance={
            "simulated": f"{n_women} women and {n_men} men who do not exist, seed {seed}",
            "recipe": recipe.as_text(),
        },
    )


def _walkers(
    people: pd.DataFrame, numbers: np.ndarray, seed: int, planted: Mapping[str, Pattern],
    capture: Mapping[str, Any],
) -> list[Walker]:  # fmt: skip
    """Return the walkers of some of the people; only these leave the process that walked them."""
    making = {"truth": bool(planted), **capture}
    walkers = []
    with one_blas_thread():
        for row, number in enumerate(numbers):
            person = people.iloc[row]
            walk = _walked(person, (seed, int(number)), planted, making)
            if making["markers"] == "skin":
                # Planting needs the phase of each frame, which virtual markers do not carry on.
                walk = virtual_markers(walk).assign_coords(_phase_of(walk))
            walkers.append(decompose_pca(in_place(_planted(walk, person, planted))))
    return walkers


def _phase_of(walk: xr.DataArray) -> dict[str, xr.DataArray]:
    return {"phase": walk["phase"]} if "phase" in walk.coords else {}
