"""Many simulated people: their captures, and the population these make."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
import pandas as pd
import xarray as xr

from eigenwalker.decomposition import decompose_pca
from eigenwalker.population import Population
from eigenwalker.simulation.traits import EFFECTS, TRAITS, draw_people
from eigenwalker.simulation.walking import simulate_walk


def simulate_captures(
    n_women: int = 20,
    n_men: int = 20,
    *,
    seed: int = 0,
    sex_effect: float = 1.0,
    effects: Mapping[str, Mapping[str, float]] = EFFECTS,
    variability: float = 1.0,
    wander_mm: float = 10.0,
    noise_mm: float = 1.0,
    duration_s: float = 12.0,
    rate_hz: float = 120.0,
) -> Iterator[tuple[xr.DataArray, pd.Series]]:
    """Yield the capture of one drawn person after another, with what is known of the person.

    Parameters
    ----------
    n_women, n_men : int
        How many of each; women come first.
    seed : int
        The same seed gives the same people and captures.
    sex_effect : float
        Multiplies all differences between the sexes.
    effects : mapping of trait to mapping of parameter to effect size
        See `draw_people`.
    variability, wander_mm, noise_mm : float
        See `simulate_walk`.
    duration_s, rate_hz : float
        Length of each capture in seconds, and frames a second.

    Yields
    ------
    capture : DataArray of shape (time, marker, axis)
        Walking in place, as `simulate_walk` returns it.
    person : Series
        Traits and parameters of the person.

    """
    people = draw_people(n_women, n_men, seed=seed, sex_effect=sex_effect, effects=effects)
    seeds = np.random.SeedSequence([seed, len(people)]).spawn(len(people))
    for (_, person), own in zip(people.iterrows(), seeds, strict=True):
        capture = simulate_walk(
            person.to_dict(), seed=own, duration_s=duration_s, rate_hz=rate_hz,
            variability=variability, wander_mm=wander_mm, noise_mm=noise_mm,
        )  # fmt: skip
        yield capture, person


def simulate_population(
    n_women: int = 20,
    n_men: int = 20,
    *,
    seed: int = 0,
    sex_effect: float = 1.0,
    effects: Mapping[str, Mapping[str, float]] = EFFECTS,
) -> Population:
    """Return a population of simulated walkers, every property of which is known.

    Parameters
    ----------
    n_women, n_men : int
        How many of each; women come first.
    seed : int
        The same seed gives the same population.
    sex_effect : float
        Multiplies all differences between the sexes, of body and of movement: 0 removes them.
    effects : mapping of trait to mapping of parameter to effect size
        See `draw_people`.

    Returns
    -------
    Population
        With the traits sex, age_years, weight_kg, height_mm, happy and nervous.

    Examples
    --------
    >>> people = simulate_population(2, 2, seed=1)
    >>> people.X.shape
    (4, 229)

    """
    captures = simulate_captures(
        n_women, n_men, seed=seed, sex_effect=sex_effect, effects=effects
    )
    walkers, rows = [], []
    for capture, person in captures:
        walkers.append(decompose_pca(capture))
        rows.append(person[list(TRAITS)])
    return Population(walkers, pd.DataFrame(rows).reset_index(drop=True).infer_objects())
