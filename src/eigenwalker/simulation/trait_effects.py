"""Traits of simulated people, what they do to a walk, and people drawn with them."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np
import pandas as pd

from eigenwalker.simulation.person import PARAMETERS, PEOPLE, check_parameters

Effects = Mapping[str, Mapping[str, float]]

EFFECTS: Effects = MappingProxyType(PEOPLE["effects"])
"""What traits do to parameters, in standard deviations of the parameter."""
TRAITS = ("sex", "age_years", "weight_kg", "height_mm", "happy", "nervous")


def draw_people(
    n_women: int,
    n_men: int,
    *,
    seed: int = 0,
    sex_effect: float = 1.0,
    effects: Effects = EFFECTS,
) -> pd.DataFrame:
    """Return a table of people drawn at random: their traits and the parameters of their walk.

    Every parameter is normal within a sex, about a mean that sex, weight, age and mood shift by
    the stated effects; nobody is further than 2.5 SD from that mean.

    Parameters
    ----------
    n_women, n_men : int
        How many of each; women come first.
    seed : int
        The same seed gives the same people.
    sex_effect : float
        Multiplies all differences between the sexes, of body and of movement: 0 removes them.
    effects : mapping of trait to mapping of parameter to effect size
        In SDs of the parameter: for ``"sex"`` men minus women, in addition to the difference
        in `PARAMETERS`; else for each SD of the trait. ``{}`` switches all these effects off.

    Returns
    -------
    DataFrame of n_women + n_men rows
        The columns `TRAITS`; the other keys of `PARAMETERS`; and the score of each trait in
        the unit of its effects: ``sex_score`` (-0.5 for women, 0.5 for men), ``weight_score``
        (body mass index), ``age_score``, ``happy_score``, ``nervous_score`` in SDs.

    Raises
    ------
    ValueError
        If there are no people, or an effect is of an unknown trait or on an unknown parameter.

    See Also
    --------
    simulate_walk : simulates such a person.
    simulate_population : draws people and makes a population of them.

    Examples
    --------
    >>> people = draw_people(2, 1, seed=3)
    >>> people["sex"].tolist()
    ['female', 'female', 'male']
    """
    _check(n_women, n_men, effects)
    rng = np.random.default_rng(seed)
    n_people = n_women + n_men
    scores, rated = {"sex": np.repeat([-0.5, 0.5], [n_women, n_men])}, {}
    for trait, (mean, sd, lowest, highest) in PEOPLE["scales"].items():
        scores[trait] = np.clip(rng.standard_normal(n_people), lowest, highest)
        rated[trait] = mean + sd * scores[trait]
    own = np.clip(rng.standard_normal((len(PARAMETERS), n_people)), -2.5, 2.5)
    own[list(PARAMETERS).index("body_mass_index")] = scores["weight"]
    amounts = scores | {"sex": sex_effect * scores["sex"]}
    values = {}
    for (name, parameter), score in zip(PARAMETERS.items(), own, strict=True):
        mean = (parameter.female + parameter.male) / 2
        mean = mean + amounts["sex"] * (parameter.male - parameter.female)
        shift = sum(
            amount * effects.get(trait, {}).get(name, 0.0) for trait, amount in amounts.items()
        )
        values[name] = mean + parameter.sd * (score + shift)
    traits = {
        "sex": np.where(scores["sex"] > 0, "male", "female"),
        "age_years": rated["age"],
        "weight_kg": values["body_mass_index"] * (values["height_mm"] / 1000) ** 2,
        "height_mm": values["height_mm"],
        "happy": rated["happy"],
        "nervous": rated["nervous"],
    }
    named = {f"{trait}_score": score for trait, score in scores.items()}
    return pd.DataFrame(traits | {n: v for n, v in values.items() if n not in traits} | named)


def _check(n_women: int, n_men: int, effects: Effects) -> None:
    if min(n_women, n_men) < 0 or n_women + n_men == 0:
        raise ValueError(
            f"n_women={n_women} and n_men={n_men} make no group of people; ask for one or more."
        )
    if unknown := sorted(set(effects) - set(EFFECTS)):
        raise ValueError(f"No trait is called {unknown}; effects are of {sorted(EFFECTS)}.")
    check_parameters(name for sizes in effects.values() for name in sizes)
