"""What is true of a simulated population: who was drawn, and what traits do to its features."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from eigenwalker.core.blas_threads import one_blas_thread
from eigenwalker.decomposition.pca import decompose_pca
from eigenwalker.gait.in_place import in_place
from eigenwalker.population.population import Population, check_population
from eigenwalker.simulation.person import PARAMETERS
from eigenwalker.simulation.planted_effect import PlantedEffect, add_effect
from eigenwalker.simulation.provenance import KEY, read_provenance
from eigenwalker.simulation.trait_effects import EFFECTS, Effects, draw_people, frequency_exponent
from eigenwalker.simulation.walk import simulate_walk


@dataclass(frozen=True)
class Truth:
    """What is true of a simulated population.

    Attributes
    ----------
    people : DataFrame, one row for each walker
        Traits, the parameters drawn for each person, and what each trait amounts to
        (``sex_score`` and so on, see `draw_people`).
    effects : DataFrame of shape (parameter, trait)
        What one unit of a trait's score adds to a parameter, in SDs of the parameter within a
        sex. That of sex holds the differences of the means too.
    planted : mapping of trait to PlantedEffect
        Effects planted in mean posture, movement or frequency themselves.
    capture : mapping of str to value
        How everyone was captured, as `simulate_walk` takes it: markers, noise, wander, variability.
    seeds : list of pairs of int
        The seed of each walker's capture: ``simulate_walk(truth.people.iloc[0],
        seed=truth.seeds[0], **truth.capture)`` is that of the first, before effects were planted,
        with the joint angles, phase and stance of each frame; `true_events` of it gives the moments
        at which its feet strike and leave the ground.

    See Also
    --------
    truth_of : gives it.
    """

    people: pd.DataFrame
    effects: pd.DataFrame
    planted: Mapping[str, PlantedEffect]
    capture: Mapping[str, Any]
    seeds: list[tuple[int, int]]


def truth_of(population: Population) -> Truth:
    """Return the truth about a population that `simulate_population` made.

    The population carries, through files and selections, how everyone was drawn, so that all can
    be drawn again; which walker is which is found by their traits.

    Parameters
    ----------
    population : Population
        Simulated; any selection of its walkers.

    Returns
    -------
    Truth

    Raises
    ------
    ValueError
        If the population was not simulated, or not by this version of the program.

    See Also
    --------
    true_direction : what a trait does to the features.

    Examples
    --------
    >>> truth = truth_of(ew.simulate_population(2, 2, seed=1))
    >>> truth.people["arm_swing_deg"].round().tolist()
    [14.0, 18.0, 6.0, 14.0]
    >>> bool(truth.effects.loc["obliquity_factor", "sex"] < 0)
    True
    """
    check_population(population)
    if KEY not in population.provenance:
        raise ValueError(
            "This population was not simulated, so its truth is unknown; "
            "make one with simulate_population()."
        )
    try:
        settings, planted, capture = read_provenance(population.provenance[KEY])
        people = draw_people(**settings)
    except (AttributeError, KeyError, TypeError, ValueError, RecursionError) as error:
        raise ValueError(
            f"The population's entry {KEY!r}, of which its people are simulated again, is "
            f"damaged ({error}); make the population again with simulate_population()."
        ) from error
    rows = _same_rows(people, population.traits)
    return Truth(
        people=people.iloc[rows].reset_index(drop=True),
        effects=_effect_table(**settings),
        planted=planted,
        capture=capture,
        seeds=[(settings["seed"], row) for row in rows],
    )


def true_direction(population: Population, trait: str, *, n_people: int = 100) -> np.ndarray:
    """Return what a trait truly does to the features of a simulated population.

    Some of the people are simulated twice, without noise: with one unit less of the trait, and with
    one unit more; for sex, half a unit. Smaller steps would make the direction less sure, as the
    solved stride does not change evenly with every parameter.

    Parameters
    ----------
    population : Population
        As `simulate_population` made it, or any selection of it.
    trait : str
        A key of `EFFECTS`.
    n_people : int
        How many people to average over; they are taken evenly from the population. What a trait
        does differs from person to person: the direction of a small effect over 12 people has a
        cosine of 0.87 with that over 40, over 100 one of 0.98 with that over all.

    Returns
    -------
    array of shape (feature,)
        Change of the features for one unit of the trait's score: for sex, men less women; for
        the others, one SD.

    Raises
    ------
    ValueError
        If the trait is unknown, or the population was not simulated.

    See Also
    --------
    simulate_population : Plants the effects.
    truth_of : What is true of each person.

    References
    ----------
    Troje (2002), eq. 10: what the direction of a discriminant estimates.

    Examples
    --------
    >>> people = ew.simulate_population(2, 2, seed=1)
    >>> nervous = true_direction(people, "nervous", n_people=2)
    >>> bool(nervous[people.feature_names.index("frequency_hz")] > 0)
    True
    """
    if trait not in EFFECTS:
        raise ValueError(f"trait={trait!r} is not known; effects are of {sorted(EFFECTS)}.")
    truth = truth_of(population)
    effect = truth.planted.get(trait, PlantedEffect())
    steps = truth.effects[trait] * [parameter.sd for parameter in PARAMETERS.values()]
    steps["frequency_hz"] += effect.frequency_hz
    rows = np.linspace(0, len(truth.people) - 1, min(n_people, len(truth.people))).round()
    own = truth.people.iloc[rows.astype(int)][list(PARAMETERS)]

    def walked(person: pd.Series, amount: float) -> np.ndarray:
        walk = add_effect(simulate_walk((person + amount * steps).to_dict()), effect, amount)
        walk = in_place(walk)
        return population.vector(decompose_pca(walk))

    step = 0.5 if trait == "sex" else 1.0
    with one_blas_thread():
        apart = [walked(p, step) - walked(p, -step) for _, p in own.iterrows()]
    return np.mean(apart, axis=0) / (2 * step)


def _same_rows(people: pd.DataFrame, traits: pd.DataFrame) -> list[int]:
    known = ["height_mm", "weight_kg", "happy", "nervous"]
    number = {key: row for row, key in enumerate(people[known].itertuples(index=False, name=None))}
    rows = [number.get(key, -1) for key in traits[known].itertuples(index=False, name=None)]
    if -1 in rows:
        raise ValueError(
            "These walkers are not those that this version draws for this population; "
            "read its truth with the version that simulated it, or simulate it again."
        )
    return rows


def _effect_table(
    effects: Effects, sex_effect: float, over_ground: bool = False, **_drawn: object
) -> pd.DataFrame:
    table = pd.DataFrame(0.0, index=list(PARAMETERS), columns=list(EFFECTS))
    for trait, sizes in effects.items():
        table.loc[list(sizes), trait] = list(sizes.values())
    table["sex"] += [(p.male - p.female) / p.sd for p in PARAMETERS.values()]
    heights, frequency = PARAMETERS["height_mm"], PARAMETERS["frequency_hz"]
    taller = (heights.male / heights.female) ** frequency_exponent(over_ground) - 1
    table.loc["frequency_hz", "sex"] += taller * frequency.male / frequency.sd
    table["sex"] *= sex_effect
    return table
