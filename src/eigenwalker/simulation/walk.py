"""A simulated walk: trajectories of someone walking, with the truth about them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal

import numpy as np
import pandas as pd
import xarray as xr

from eigenwalker.core.arguments import generator
from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.trajectories import check_trajectories, label_trajectories
from eigenwalker.gait.events import HEEL_STRIKE, TOE_OFF
from eigenwalker.simulation.body import body_of
from eigenwalker.simulation.body_markers import skin_markers
from eigenwalker.simulation.cycle import Cycle, solve_cycle
from eigenwalker.simulation.overground import Route, blend_with_standing
from eigenwalker.simulation.person import check_parameters
from eigenwalker.simulation.posture import SIDES, joint_positions, segment_rotations
from eigenwalker.simulation.prior_curves import GaitParameters, gait_parameters
from eigenwalker.simulation.stride_noise import Strides, simulate_strides
from eigenwalker.simulation.trait_effects import draw_people
from eigenwalker.simulation.walk_cycle_frames import Angles, walk_cycle_frames

FULL = (*JOINTS.markers, *(f"{side}_{part}" for side in SIDES for part in ("heel", "ball", "toe")))
"""The 15 joints, and of each foot where heel, ball and tip of the toes touch the ground."""
_MEAN_GAP_S, _LONGEST_GAP_S = 0.05, 0.12


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
    """Return trajectories of someone walking, with all that is known of the walk.

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
        Of the person who is drawn; left out, either.
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
        Share of the samples that are missing, in gaps of up to 0.12 s.
    soft_tissue : float
        How much markers on the skin move over the bones: 1 as in people, 0 not at all.
    truth : bool
        Whether to add the truth of each frame; leaving it out saves time.
    **parameters : float
        Parameters that replace those of the person: ``frequency_hz=0.9``.

    Returns
    -------
    DataArray of shape (time, marker, axis)
        Millimetres. Coordinates along time hold the truth of each frame: ``phase`` in cycles
        from a left heel strike, ``left_stance`` and ``right_stance``, joint angles in degrees such
        as ``left_knee_flexion_deg``. Scalar attributes hold the truth of the walk:
        ``frequency_hz``, ``speed_mm_s``, ``stance_of_stride``, and the person's parameters.

    Raises
    ------
    ValueError
        If a parameter is unknown, or rate, duration, noise or gaps make no sense.

    See Also
    --------
    true_events : heel strikes and toe offs of such a walk.
    simulate_captures : walks of many people.

    References
    ----------
    Schwartz, Rozumalski & Trost (2008), Journal of Biomechanics 41:1639 (joint angles);
    Gordon et al. (2014), Natick/TR-15/007 (bodies); ``docs/simulation.md`` lists the rest.

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
    streams = (generator(seed, "seed", n) for n in range(5))
    person_rng, stride_rng, noise_rng, skin_rng, gap_rng = streams
    if person is None:
        person = _anyone(person_rng, sex, over_ground=route is not None)
    person = {**person, **parameters}
    time = np.arange(round(duration_s * rate_hz)) / rate_hz
    body, cycle = body_of(person), solve_cycle(person)
    gait = gait_parameters(person, body)
    strides = simulate_strides(
        time, cycle, gait, rng=stride_rng, variability=variability, wander_mm=wander_mm
    )
    angles, pelvis = walk_cycle_frames(person, body, gait, cycle, strides)
    if route is not None:
        ramp = route.speed_ramp(time)
        angles, pelvis = blend_with_standing(angles, pelvis, body, gait, ramp)
    rotations = segment_rotations(angles)
    places = joint_positions(body, rotations, pelvis)
    if markers == "skin":
        places = skin_markers(
            body, places, rotations, strides.phase, rng=skin_rng, soft_tissue=soft_tissue
        )
    names = {"joints": JOINTS.markers, "full": FULL, "skin": tuple(places)}[markers]
    values = np.stack([places[name] for name in names], axis=1)
    if route is not None:
        values = route.along(values, time, gait.speed)
    values[..., 0] += drift_mm_s * time[:, None]
    if noise_mm:
        values += noise_mm * noise_rng.standard_normal(values.shape)
    _add_gaps(values, rate_hz, gap_share, gap_rng)
    walk = label_trajectories(values, markers=names, rate_hz=rate_hz)
    scalars = _scalars(person, cycle, gait, strides, time) | {"noise_mm": noise_mm}
    coords = _truth(cycle, gait, strides.phase, angles) if truth else {}
    return walk.assign_coords(coords).assign_attrs(scalars)


def true_events(walk: xr.DataArray) -> pd.DataFrame:
    """Return when the feet of a simulated walk strike and leave the ground.

    Parameters
    ----------
    walk : DataArray of shape (time, marker, axis)
        As `simulate_walk` returns it.

    Returns
    -------
    DataFrame
        One row an event, in the order of time, as `gait_events` gives them: ``time_s``; ``side``;
        ``event``, "heel_strike" or "toe_off"; ``marker``, the point of the foot that does so.

    See Also
    --------
    gait.gait_events : estimates of the same from trajectories.

    Examples
    --------
    >>> events = true_events(simulate_walk(seed=1, duration_s=2.5, frequency_hz=1.0))
    >>> events[events["event"] == "heel_strike"]["side"].tolist()
    ['left', 'right', 'left', 'right', 'left']
    """
    walk = check_trajectories(walk)
    phase, time = walk["phase"].values, walk["time"].values
    kinds = ((HEEL_STRIKE, 0.0, "heel"), (TOE_OFF, walk.attrs["stance_of_stride"], "toe"))
    rows = []
    for side in SIDES:
        for event, share, point in kinds:
            begins = walk.attrs["right_onset"] * (side == "right") + share
            at = np.arange(np.ceil(phase[0] - begins), np.floor(phase[-1] - begins) + 1) + begins
            moments = np.interp(at, phase, time).tolist()
            rows += [(moment, side, event, f"{side}_{point}") for moment in moments]
    return pd.DataFrame(sorted(rows), columns=["time_s", "side", "event", "marker"])


def _check(
    duration_s: float, rate_hz: float, noise_mm: float, gap_share: float, markers: str,
    sex: str | None,
) -> None:  # fmt: skip
    frames = duration_s > 0 and rate_hz > 0 and duration_s * rate_hz >= 2
    checks = {
        f"duration_s={duration_s} at rate_hz={rate_hz} holds fewer than two frames": frames,
        f"noise_mm={noise_mm} must be 0 or more": noise_mm >= 0,
        f"gap_share={gap_share} must be from 0 to below 1": 0 <= gap_share < 1,
        f"markers={markers!r} is not known; give 'joints', 'full' or 'skin'": (
            markers in ("joints", "full", "skin")
        ),
        f"sex={sex!r} is not known; give 'female' or 'male'": sex in (None, "female", "male"),
    }
    if problems := [problem for problem, fine in checks.items() if not fine]:
        raise ValueError("This walk cannot be simulated: " + "; ".join(problems) + ".")


def _anyone(rng: np.random.Generator, sex: str | None, over_ground: bool) -> dict[str, Any]:
    women = int(rng.random() < 0.5) if sex is None else int(sex == "female")
    seed = int(rng.integers(2**31))
    person = draw_people(women, 1 - women, seed=seed, over_ground=over_ground).iloc[0]
    return {str(name): value for name, value in person.items()}


def _add_gaps(values: np.ndarray, rate_hz: float, share: float, rng: np.random.Generator) -> None:
    """Set a share of the samples of each marker to NaN, in short gaps."""
    n_frames, n_markers, _ = values.shape
    for marker in range(n_markers):
        lost = 0
        while lost < share * n_frames:
            length = 1 + int(min(rng.exponential(_MEAN_GAP_S), _LONGEST_GAP_S) * rate_hz)
            start = int(rng.integers(n_frames))
            values[start : start + length, marker] = np.nan
            lost += length


def _scalars(
    person: Mapping[str, Any], cycle: Cycle, gait: GaitParameters, strides: Strides,
    time: np.ndarray,
) -> dict[str, str | float]:  # fmt: skip
    cycles = strides.phase[-1] - strides.phase[0]
    return {
        **{name: each if isinstance(each, str) else float(each) for name, each in person.items()},
        "frequency_hz": float(cycles / (time[-1] - time[0])),
        "speed_mm_s": gait.speed,
        "stance_of_stride": gait.stance,
        "right_onset": float(cycle.onsets[1]),
        "source": "simulated",
    }


_JOINT_ANGLES = (
    *("thigh", "knee_flexion", "foot_pitch"),
    *("shoulder_flexion", "shoulder_abduction", "elbow_flexion"),
)


def _truth(
    cycle: Cycle, gait: GaitParameters, phase: np.ndarray, angles: Angles
) -> dict[str, tuple[str, np.ndarray]]:
    """Return what is known of each frame: phase, which foot stands, joint angles in degrees."""
    truth: dict[str, np.ndarray] = {"phase": phase}
    for leg, (name, side) in enumerate(SIDES.items()):
        truth[f"{name}_stance"] = (phase - cycle.onsets[leg]) % 1.0 <= gait.stance
        own = {joint: angles[f"{name}_{joint}"] for joint in _JOINT_ANGLES}
        own |= {
            "hip_flexion": own["thigh"] + angles["pelvis_tilt"],
            "hip_adduction": side * (angles["pelvis_obliquity"] - angles[f"{name}_splay"]),
            "ankle_dorsiflexion": own["knee_flexion"] - own["thigh"] - own["foot_pitch"],
        }
        truth |= {f"{name}_{joint}_deg": np.degrees(curve) for joint, curve in own.items()}
    for part in ("pelvis", "trunk", "head"):
        for angle in ("tilt", "obliquity", "rotation"):
            truth[f"{part}_{angle}_deg"] = np.degrees(angles[f"{part}_{angle}"])
    return {name: ("time", curve) for name, curve in truth.items()}
