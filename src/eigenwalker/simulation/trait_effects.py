"""Traits of simulated people, what they do to a walk, and people drawn with them."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np
import pandas as pd

from eigenwalker.simulation.person import PARAMETERS, check_parameters

Effects = Mapping[str, Mapping[str, float]]

EFFECTS: Mapping[str, Mapping[str, float]] = MappingProxyType(
    {
        # Men less women, in SDs within a sex, beside the means above.
        "sex": {
            "obliquity_factor": -0.58,  # Smith et al. 2002
            "pelvis_rotation_factor": -0.4,  # Bruening 2015: direction; size chosen
            "trunk_lean_factor": 0.6,  # Bruening 2015, Troje 2002: direction; size chosen
            "arm_swing_deg": -0.5,  # Bruening 2015: direction; size chosen
            "arm_out_deg": 0.6,  # Troje 2002, WDP2002: direction; size chosen
            "lateral_mm": 0.5,  # WDP2002: direction; size chosen
            "pelvis_tilt_deg": -0.4,  # Cho 2004: direction; size chosen
        },
        # For each SD of the trait.
        "weight": {
            "hip_share": 0.3,  # ANSUR: mass with bicristal 0.69, much of it through height
            "step_width_mm": 0.3,
            "arm_out_deg": 0.3,
            "frequency_hz": -0.2,  # WDP2002: slightly lower
            "vertical_mm": -0.3,  # WDP2002: light people move up and down more
        },
        "age": {"arm_swing_deg": -0.1},  # Mirelman 2015, over 30 to 77 years
        "happy": {
            "stride_share": 0.4,
            "arm_swing_deg": 0.5,
            "vertical_mm": 0.4,
            "trunk_tilt_deg": -0.4,
            "lateral_mm": -0.3,
            "head_tilt_deg": -0.3,
        },
        "nervous": {
            "frequency_hz": 0.4,
            "stride_share": -0.4,
            "arm_swing_deg": -0.5,
            "elbow_mean_deg": 0.4,
            "elbow_swing_deg": 0.2,
        },
    }
)
"""What traits do to parameters, in standard deviations of the parameter."""

TRAITS = ("sex", "age_years", "weight_kg", "height_mm", "happy", "nervous")


_SCALES = {
    "age": (26.0, 4.5, -1.3, 2.6),  # Troje 2002: 20 to 38, mean 26
    "weight": (0.0, 1.0, -2.5, 2.5),
    "happy": (3.5, 0.8, -2.5, 2.5),  # six-point scale, as in WDP2002
    "nervous": (3.5, 0.8, -2.5, 2.5),
}
"""Mean, SD, lowest and highest score of each continuous trait on its own scale."""


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
    for trait, (mean, sd, lowest, highest) in _SCALES.items():
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
