"""A simulated walk: trajectories of someone walking, with the truth about them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal

import numpy as np
import pandas as pd
import xarray as xr

from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.trajectories import label_trajectories
from eigenwalker.simulation.body_markers import skin_markers
from eigenwalker.simulation.cadence import Pace, pace_of
from eigenwalker.simulation.cycle import Cycle, solve_cycle
from eigenwalker.simulation.measurement_noise import with_drift, with_gaps, with_noise
from eigenwalker.simulation.overground import Route, set_off
from eigenwalker.simulation.person import check_parameters
from eigenwalker.simulation.posture import SIDES, joint_positions, segment_turns
from eigenwalker.simulation.segment_lengths import body_of
from eigenwalker.simulation.stride_noise import Strides, walked_strides
from eigenwalker.simulation.trait_effects import draw_people
from eigenwalker.simulation.walk_cycle_frames import Angles, play

FULL = (*JOINTS.markers, *(f"{side}_{part}" for side in SIDES for part in ("heel", "ball", "toe")))
"""The 15 joints, and of each foot where heel, ball and tip of the toes touch the ground."""


def simulate_walk(
    person: Mapping[str, float] | None = None,
    *,
    seed: int | Sequence[int] = 0,
    sex: Literal["female", "male"] | None = None,
    duration_s: float = 12.0,
    rate_hz: float = 120.0,
    markers: Literal["joints", "full", "skin"] = "joints",
    route: Route | None = None,
    variability: float = 0.0,
    wander_mm: float = 0.0,
    drift_mm_s: float = 0.0,
    noise_mm: float = 0.0,
    gap_share: float = 0.0,
    soft_tissue: float = 1.0,
    truth: bool = True,
    **parameters: float,
) -> xr.DataArray:
    """Return someone walking, with all that is known of the walk.

    A jointed body (segment shares of ANSUR II) moves by published joint-angle norms, changed as
    little as keeps its feet on the ground; speed, cadence and step length fit each other as in
    people. Bones are rigid, and nothing is disturbed unless asked for.

    Parameters
    ----------
    person : mapping of str to float, optional
        Parameters of `PARAMETERS`, such as a row of `draw_people`. Left out, someone is drawn.
    seed : int or sequence of int
        The same seed gives the same walk, whatever markers, noise and gaps are asked for.
    sex : {"female", "male"}, optional
        Whom to draw; left out, either.
    duration_s, rate_hz : float
        Length in seconds, and frames a second.
    markers : {"joints", "full", "skin"}
        The 15 joints, these and the soles of the feet (`FULL`), or the 38 markers on the skin of
        a full-body Plug-in Gait set without RBAK.
    route : Route, optional
        Where to walk over ground; left out, in place as on a treadmill.
    variability : float
        How much strides differ from each other: 1 as in healthy adults, 0 not at all.
    wander_mm : float
        SD of the slow wander on the belt.
    drift_mm_s : float
        How fast the belt carries the walker away.
    noise_mm : float
        SD of the noise of each coordinate.
    gap_share : float
        Share of the samples that are missing.
    soft_tissue : float
        How much markers on the skin move over the bones: 1 as in people, 0 not at all.
    truth : bool
        Whether to tell the truth of each frame; leaving it out saves time.
    **parameters : float
        Parameters that the person is to have, whatever was drawn: ``frequency_hz=0.9``.

    Returns
    -------
    DataArray of shape (time, marker, axis)
        Millimetres. Coordinates along time tell the truth of each frame: ``phase`` in cycles
        from a left heel strike, ``left_stance`` and ``right_stance``, joint angles in degrees such
        as ``left_knee_flexion_deg``. Scalar attributes tell the truth of the walk:
        ``frequency_hz``, ``speed_mm_s``, ``stance_of_stride``, and the person's parameters.

    Raises
    ------
    ValueError
        If a parameter is unknown, or rate, duration, noise or gaps make no sense.

    Examples
    --------
    >>> walk = simulate_walk(seed=1, frequency_hz=0.9)
    >>> dict(walk.sizes)
    {'time': 1440, 'marker': 15, 'axis': 3}
    >>> round(walk.attrs["frequency_hz"], 2)
    0.9

    """
    _check(duration_s, rate_hz, noise_mm, gap_share, markers, sex)
    check_parameters(parameters)
    drawn, walked, shaken, slid, lost = (_chance(seed, stream) for stream in range(5))
    person = {**(_anyone(drawn, sex) if person is None else person), **parameters}
    time = np.arange(round(duration_s * rate_hz)) / rate_hz
    body = body_of(person)
    pace = pace_of(person, body)
    cycle = solve_cycle(person)
    strides = walked_strides(
        time, cycle, pace, chance=walked, variability=variability, wander_mm=wander_mm
    )
    angles, pelvis = play(person, body, pace, cycle, strides)
    if route is not None:
        angles, pelvis = set_off(angles, pelvis, body, pace, route.vigour(time))
    turns = segment_turns(angles)
    places = joint_positions(body, turns, pelvis)
    if markers == "skin":
        places = skin_markers(
            body, places, turns, strides.phase, chance=slid, soft_tissue=soft_tissue
        )
    if route is not None:
        places = route.along(places, time, pace.speed)
    names = {"joints": JOINTS.markers, "full": FULL, "skin": tuple(places)}[markers]
    values = np.stack([places[name] for name in names], axis=1)
    values = with_noise(with_drift(values, time, drift_mm_s), noise_mm, shaken)
    values = with_gaps(values, rate_hz, gap_share, lost)
    walk = label_trajectories(values, markers=names, rate_hz=rate_hz)
    told = _scalars(person, cycle, pace, strides, time) | {"noise_mm": noise_mm}
    coords = _truth(cycle, pace, strides.phase, angles) if truth else {}
    return walk.assign_coords(coords).assign_attrs(told)


def true_events(walk: xr.DataArray) -> pd.DataFrame:
    """Return when the feet of a simulated walk struck and left the ground.

    Parameters
    ----------
    walk : DataArray of shape (time, marker, axis)
        As `simulate_walk` returns it.

    Returns
    -------
    DataFrame with columns side, event ("heel_strike", "toe_off") and time_s, in order of time

    Examples
    --------
    >>> events = true_events(simulate_walk(seed=1, duration_s=2.5, frequency_hz=1.0))
    >>> events[events["event"] == "heel_strike"]["side"].tolist()
    ['left', 'right', 'left', 'right', 'left']

    """
    phase, time = walk["phase"].values, walk["time"].values
    rows = []
    for side in SIDES:
        for event, share in (("heel_strike", 0.0), ("toe_off", walk.attrs["stance_of_stride"])):
            begins = walk.attrs["right_onset"] * (side == "right") + share
            at = np.arange(np.ceil(phase[0] - begins), np.floor(phase[-1] - begins) + 1) + begins
            rows += [(side, event, moment) for moment in np.interp(at, phase, time)]
    table = pd.DataFrame(rows, columns=["side", "event", "time_s"])
    return table.sort_values("time_s", ignore_index=True)


def _check(
    duration_s: float, rate_hz: float, noise_mm: float, gap_share: float, markers: str,
    sex: str | None,
) -> None:  # fmt: skip
    amiss = []
    if not (duration_s > 0 and rate_hz > 0 and duration_s * rate_hz >= 2):
        amiss.append(f"duration_s={duration_s} at rate_hz={rate_hz} holds fewer than two frames")
    if not noise_mm >= 0:
        amiss.append(f"noise_mm={noise_mm} must be 0 or more")
    if not 0 <= gap_share < 1:
        amiss.append(f"gap_share={gap_share} must be from 0 to below 1")
    if markers not in ("joints", "full", "skin"):
        amiss.append(f"markers={markers!r} is not known; give 'joints', 'full' or 'skin'")
    if sex not in (None, "female", "male"):
        amiss.append(f"sex={sex!r} is not known; give 'female' or 'male'")
    if amiss:
        raise ValueError("This walk cannot be simulated: " + "; ".join(amiss) + ".")


def _chance(seed: int | Sequence[int], stream: int) -> np.random.Generator:
    return np.random.default_rng([*np.atleast_1d(seed).tolist(), stream])


def _anyone(chance: np.random.Generator, sex: str | None) -> dict[str, Any]:
    women = int(chance.random() < 0.5) if sex is None else int(sex == "female")
    drawn = draw_people(women, 1 - women, seed=int(chance.integers(2**31))).iloc[0]
    return {str(name): value for name, value in drawn.items()}


def _scalars(
    person: Mapping[str, float], cycle: Cycle, pace: Pace, strides: Strides, time: np.ndarray
) -> dict[str, str | float]:
    told: dict[str, str | float] = {
        name: value if isinstance(value, str) else float(value) for name, value in person.items()
    }
    cycles = strides.phase[-1] - strides.phase[0]
    return told | {
        "frequency_hz": float(cycles / (time[-1] - time[0])),
        "speed_mm_s": pace.speed,
        "stance_of_stride": pace.stance,
        "right_onset": float(cycle.onsets[1]),
        "source": "simulated",
    }


def _truth(
    cycle: Cycle, pace: Pace, phase: np.ndarray, angles: Angles
) -> dict[str, tuple[str, np.ndarray]]:
    """Return what is known of each frame: phase, which foot stands, joint angles in degrees."""
    truth: dict[str, np.ndarray] = {"phase": phase}
    for leg, (name, side) in enumerate(SIDES.items()):
        truth[f"{name}_stance"] = (phase - cycle.onsets[leg]) % 1.0 <= pace.stance
        own = {joint: angles[f"{name}_{joint}"] for joint in _TOLD_OF_A_SIDE}
        lean, listing = angles[f"{name}_splay"], angles["pelvis_obliquity"]
        own |= {
            "hip_flexion": own["thigh"] + angles["pelvis_tilt"],
            "hip_adduction": side * (listing - lean),
            "ankle_dorsiflexion": own["knee_flexion"] - own["thigh"] - own["foot_pitch"],
        }
        truth |= {f"{name}_{joint}_deg": np.degrees(curve) for joint, curve in own.items()}
    for part in ("pelvis", "trunk", "head"):
        for turn in ("tilt", "obliquity", "rotation"):
            truth[f"{part}_{turn}_deg"] = np.degrees(angles[f"{part}_{turn}"])
    return {name: ("time", curve) for name, curve in truth.items()}


_TOLD_OF_A_SIDE = (
    *("thigh", "knee_flexion", "foot_pitch"),
    *("shoulder_flexion", "shoulder_abduction", "elbow_flexion"),
)
