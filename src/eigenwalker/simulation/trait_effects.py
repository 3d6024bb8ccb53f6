"""Traits of simulated people, what they do to a walk, and people drawn with them."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np
import pandas as pd

from eigenwalker.core.arguments import generator
from eigenwalker.simulation.person import PARAMETERS, PEOPLE, average_person, check_parameters

Effects = Mapping[str, Mapping[str, float]]

EFFECTS: Effects = MappingProxyType(PEOPLE["effects"])
"""What traits do to parameters, in standard deviations of the parameter."""
TRAITS = ("sex", "age_years", "weight_kg", "height_mm", "happy", "nervous")


MOST_PEOPLE = 1_000_000
MOST_EFFECT = 100


def draw_people(
    n_women: int,
    n_men: int,
    *,
    seed: int = 0,
    sex_effect: float = 1.0,
    effects: Effects = EFFECTS,
    over_ground: bool = False,
    balanced: bool = False,
) -> pd.DataFrame:
    """Return a table of people drawn at random: their traits and the parameters of their walk.

    Every parameter is normal within a sex, about a mean that sex, weight, age and mood shift by
    the stated effects; nobody is further than 2.5 SD from that mean, or with `balanced`, which
    rescales what was drawn, than about 3 SD.

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
    over_ground : bool
        Whether they walk over ground, where stride frequency falls with the root of height (the
        pendulum law), rather than on a belt, where it hardly does, and hips move less to the side.
    balanced : bool
        Whether chance is taken out of the effects: body mass index, height, age and moods are then
        unrelated to each other, and what is drawn for a person is unrelated to them, and to sex
        where that has an effect. So a few people show every effect at its size. Studies of chance
        need people drawn without it.

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

    References
    ----------
    Alexander (1989), Physiological Reviews 69:1199 (the pendulum); ``docs/simulation.md``.

    Examples
    --------
    >>> people = draw_people(2, 1, seed=3)
    >>> people["sex"].tolist()
    ['female', 'female', 'male']
    """
    _check(n_women, n_men, sex_effect, effects)
    rng = generator(seed, "seed")
    n_people = n_women + n_men
    scores, rated = {"sex": np.repeat([-0.5, 0.5], [n_women, n_men])}, {}
    for trait, (_, _, lowest, highest) in PEOPLE["scales"].items():
        scores[trait] = np.clip(rng.standard_normal(n_people), lowest, highest)
    own = np.clip(rng.standard_normal((len(PARAMETERS), n_people)), -2.5, 2.5)
    if balanced:
        scores, own = _balanced(scores, own, effects)
    for trait, (mean, sd, _, _) in PEOPLE["scales"].items():
        rated[trait] = mean + sd * scores[trait]
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
    taller = values["height_mm"] / average_person()["height_mm"]
    values["frequency_hz"] *= taller ** frequency_exponent(over_ground)
    for name, more in PEOPLE["over_ground"].items():
        values[name] += more * over_ground
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


def frequency_exponent(over_ground: bool) -> float:
    """Return the power of height with which stride frequency goes.

    Over ground that of a pendulum (Alexander 1989). On a belt that by which the women and men of
    Troje (2002) differ, at their mean heights.
    """
    if over_ground:
        return -0.5
    frequency, height = PEOPLE["belt"]["frequency_hz"], PARAMETERS["height_mm"]
    slower = np.log(frequency["male"] / frequency["female"])
    return float(slower / np.log(height.male / height.female))


def _balanced(
    scores: Mapping[str, np.ndarray], own: np.ndarray, effects: Effects
) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """Return scores and what is drawn for each parameter (parameter, person) freed of chance.

    Residuals of regression on the traits, with unit SD. On sex only height, frequency and what it
    has an effect on: classifiers of people who differ in nothing by chance do too well.
    """
    n_people, names, balanced = own.shape[1], list(PARAMETERS), dict(scores)
    if n_people < (least := len(scores) + 4):
        raise ValueError(f"{n_people} people are too few to balance; draw {least} or more.")
    known = [np.ones(n_people), scores["age"]]

    def freed(drawn: np.ndarray, of_sex: bool) -> np.ndarray:
        design = np.column_stack([*known, scores["sex"]] if of_sex else known)
        left = drawn - (design @ np.linalg.lstsq(design, drawn.T, rcond=None)[0]).T
        return left / left.std(axis=-1, keepdims=True)

    for trait in ("weight", "happy", "nervous"):
        balanced[trait] = freed(scores[trait], of_sex=True)
        known.append(balanced[trait])
    height, frequency = names.index("height_mm"), names.index("frequency_hz")
    known.append(freed(own[height], of_sex=True))
    rest = freed(own, of_sex=False)
    touched = [frequency, *(names.index(name) for name in effects.get("sex", ()))]
    rest[touched] = freed(own[touched], of_sex=True)
    rest[height] = known[-1]
    return balanced, rest


def _check(n_women: int, n_men: int, sex_effect: float, effects: Effects) -> None:
    if min(n_women, n_men) < 0 or not 1 <= n_women + n_men <= MOST_PEOPLE:
        raise ValueError(
            f"n_women={n_women} and n_men={n_men} make no group of people; give 1 to {MOST_PEOPLE} "
            "in all."
        )
    if not abs(sex_effect) <= MOST_EFFECT:
        raise ValueError(f"sex_effect={sex_effect:g} is too large; give {MOST_EFFECT} at most.")
    if unknown := sorted(set(effects) - set(EFFECTS)):
        raise ValueError(f"No trait is called {unknown}; effects are of {sorted(EFFECTS)}.")
    check_parameters(name for sizes in effects.values() for name in sizes)
