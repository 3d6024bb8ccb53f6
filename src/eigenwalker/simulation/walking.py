"""A simulated walk: trajectories of someone walking, with the truth about them."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr

from eigenwalker.simulation.body import body_of
from eigenwalker.simulation.cycle import Cycle, Pace, pace_of, solve_cycle
from eigenwalker.simulation.playing import play
from eigenwalker.simulation.posture import SIDES, joint_positions, segment_turns
from eigenwalker.simulation.strides import walked_strides
from eigenwalker.simulation.traits import check_parameters, draw_people
from eigenwalker.skeleton import JOINTS
from eigenwalker.trajectories import label_trajectories


def simulate_walk(
    person: Mapping[str, float] | None = None,
    *,
    seed: int | np.random.SeedSequence = 0,
    duration_s: float = 12.0,
    rate_hz: float = 120.0,
    variability: float = 0.0,
    wander_mm: float = 0.0,
    noise_mm: float = 0.0,
    **parameters: float,
) -> xr.DataArray:
    """Return someone walking in place, with all that is known of the walk.

    A jointed body (segment shares of ANSUR II) moves by published joint-angle norms, changed as
    little as keeps its feet on the ground; speed, cadence and step length fit each other as in
    people. Bones are rigid, and nothing is disturbed unless asked for.

    Parameters
    ----------
    person : mapping of str to float, optional
        Parameters of `eigenwalker.simulation.PARAMETERS`, such as a row of `draw_people`. Left
        out, someone is drawn with `seed`.
    seed : int
        The same seed gives the same walk.
    duration_s, rate_hz : float
        Length in seconds, and frames a second.
    variability : float
        How much strides differ from each other: 1 as in healthy adults, 0 not at all.
    wander_mm : float
        SD of the slow wander on the belt.
    noise_mm : float
        SD of the noise of each coordinate.
    **parameters : float
        Parameters that the person is to have, whatever was drawn: ``frequency_hz=0.9``.

    Returns
    -------
    DataArray of shape (time, marker, axis)
        The 15 joints. Coordinates along time tell the truth of each frame: ``phase`` in cycles
        from a left heel strike, ``left_stance`` and ``right_stance``, joint angles in degrees such
        as ``left_knee_flexion_deg``. Scalar attributes tell the truth of the walk:
        ``frequency_hz``, ``speed_mm_s``, and the person's parameters.

    Raises
    ------
    ValueError
        If a parameter is unknown, or rate, duration or noise make no sense.

    Examples
    --------
    >>> walk = simulate_walk(seed=1, frequency_hz=0.9)
    >>> dict(walk.sizes)
    {'time': 1440, 'marker': 15, 'axis': 3}
    >>> round(walk.attrs["frequency_hz"], 2)
    0.9

    """
    check_parameters(parameters)
    if duration_s <= 0 or rate_hz <= 0 or noise_mm < 0:
        raise ValueError(
            f"duration_s={duration_s}, rate_hz={rate_hz} and noise_mm={noise_mm} make no walk; "
            "duration and rate must be above 0, noise 0 or more."
        )
    chance = np.random.default_rng(seed)
    if person is None:
        person = _anyone(chance)
    person = {**person, **parameters}
    time = np.arange(round(duration_s * rate_hz)) / rate_hz
    body = body_of(person)
    pace = pace_of(person, body)
    cycle = solve_cycle(person)
    strides = walked_strides(
        time, cycle, pace, chance=chance, variability=variability, wander_mm=wander_mm
    )
    angles, pelvis = play(person, body, pace, cycle, strides)
    positions = joint_positions(body, segment_turns(angles), pelvis)
    values = np.stack([positions[name] for name in JOINTS.markers], axis=1)
    if noise_mm:
        values = values + noise_mm * chance.standard_normal(values.shape)
    walk = label_trajectories(values, markers=JOINTS.markers, rate_hz=rate_hz)
    truth = truth_of(cycle, pace, strides.phase, angles)
    told = {name: value for name, value in person.items() if isinstance(value, (str, int, float))}
    told["frequency_hz"] = float((strides.phase[-1] - strides.phase[0]) / time[-1])
    return walk.assign_coords(
        {name: ("time", curve) for name, curve in truth.items()}
    ).assign_attrs(told, speed_mm_s=pace.speed, noise_mm=noise_mm, source="simulated")


def _anyone(chance: np.random.Generator) -> dict[str, float]:
    women = int(chance.random() < 0.5)
    seed = int(chance.integers(2**31))
    return draw_people(women, 1 - women, seed=seed).iloc[0].to_dict()


def truth_of(
    cycle: Cycle, pace: Pace, phase: np.ndarray, angles: Mapping[str, np.ndarray]
) -> dict[str, np.ndarray]:
    """Return what is known of each frame: phase, which foot stands, joint angles in degrees."""
    truth: dict[str, np.ndarray] = {"phase": phase}
    for leg, (name, side) in enumerate(SIDES.items()):
        truth[f"{name}_stance"] = (phase - cycle.onsets[leg]) % 1.0 <= pace.stance
        thigh, knee, pitch, lean = (
            angles[f"{name}_{angle}"] for angle in ("thigh", "knee_flexion", "foot_pitch", "splay")
        )
        joints = {
            "hip_flexion": thigh + angles["pelvis_tilt"],
            "hip_adduction": side * (angles["pelvis_obliquity"] - lean),
            "knee_flexion": knee,
            "ankle_dorsiflexion": knee - thigh - pitch,
            "foot_pitch": pitch,
        }
        for joint in ("shoulder_flexion", "shoulder_abduction", "elbow_flexion"):
            joints[joint] = angles[f"{name}_{joint}"]
        truth |= {f"{name}_{joint}_deg": np.degrees(curve) for joint, curve in joints.items()}
    for part in ("pelvis", "trunk", "head"):
        for turn in ("tilt", "obliquity", "rotation"):
            truth[f"{part}_{turn}_deg"] = np.degrees(angles[f"{part}_{turn}"])
    return truth
