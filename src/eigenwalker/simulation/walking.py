"""A simulated walk: a person's cycle played over time by a jointed body."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy.spatial.transform import Rotation

from eigenwalker.kinematics import forward_kinematics
from eigenwalker.simulation.body import Body, body_of
from eigenwalker.simulation.cycle import (
    LEG_HARMONICS,
    PELVIS_HARMONICS,
    SIDES,
    Cycle,
    Pace,
    pace_of,
    solve_cycle,
    splay,
    trunk_curves,
)
from eigenwalker.simulation.norms import CURVES_DEG, basis
from eigenwalker.simulation.traits import check_parameters, draw_people
from eigenwalker.skeleton import JOINTS
from eigenwalker.trajectories import label_trajectories

_SIDE_NAMES = ("left", "right")


class Segment(NamedTuple):
    """A joint and the segment that turns about it, as it stands in the room."""

    name: str
    parent: str | None
    offset: np.ndarray
    turn: Rotation


def simulate_walk(
    person: Mapping[str, float] | None = None,
    *,
    seed: int | np.random.SeedSequence = 0,
    duration_s: float = 12.0,
    rate_hz: float = 120.0,
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
    phase = person["frequency_hz"] * time
    body = body_of(person)
    pace = pace_of(person, body)
    angles, pelvis = play(person, solve_cycle(person), body, pace, phase)
    positions = joint_positions(body, angles, pelvis)
    values = np.stack([positions[name] for name in JOINTS.markers], axis=1)
    if noise_mm:
        values = values + noise_mm * chance.standard_normal(values.shape)
    walk = label_trajectories(values, markers=JOINTS.markers, rate_hz=rate_hz)
    truth = {name: ("time", curve) for name, curve in truth_of(person, pace, phase, angles).items()}
    scalars = {n: v for n, v in person.items() if isinstance(v, (str, int, float))}
    return walk.assign_coords(truth).assign_attrs(
        scalars, speed_mm_s=pace.speed, noise_mm=noise_mm, source="simulated"
    )


def _anyone(chance: np.random.Generator) -> dict[str, float]:
    women = int(chance.random() < 0.5)
    seed = int(chance.integers(2**31))
    return draw_people(women, 1 - women, seed=seed).iloc[0].to_dict()


def play(
    person: Mapping[str, float], cycle: Cycle, body: Body, pace: Pace, phase: np.ndarray
) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """Return joint angles (radians) and the pelvis point's path at phases of the cycle.

    Parameters
    ----------
    person, cycle, body, pace
        Who walks, and how.
    phase : array of shape (frame,)
        In cycles, going on beyond 1.

    Returns
    -------
    angles : dict of str to array of shape (frame,)
    pelvis : array of shape (frame, 3)

    """
    waves = basis(phase, PELVIS_HARMONICS)
    angles = {name: waves @ c for name, c in trunk_curves(person, pace.effort).items()}
    pelvis = waves @ cycle.pelvis.T
    yaw = np.radians(person["foot_progression_deg"])
    for leg, (side, name) in enumerate(zip(SIDES, _SIDE_NAMES, strict=True)):
        own = phase - cycle.onsets[leg]
        waves = basis(own, LEG_HARMONICS)
        thigh, knee, pitch = (waves @ c[leg] for c in (cycle.thigh, cycle.knee, cycle.pitch))
        down = body.thigh * np.cos(thigh) + body.shank * np.cos(thigh - knee)
        hip = _pelvis_turn(angles).apply(body.hip * [1, side, 1]) + pelvis
        angles[f"{name}_thigh"], angles[f"{name}_knee_flexion"] = thigh, knee
        angles[f"{name}_foot_pitch"] = pitch
        angles[f"{name}_foot_yaw"] = np.full(len(phase), yaw)
        angles[f"{name}_splay"] = splay(side, pace, body, yaw, pitch, hip[:, 1], down)
        swing, elbow = _arm(person, side, own)
        angles[f"{name}_shoulder_flexion"], angles[f"{name}_elbow_flexion"] = swing, elbow
    for name in ("shoulder_abduction", "shoulder_rotation"):
        source = {"shoulder_abduction": "arm_out_deg", "shoulder_rotation": "arm_in_rotation_deg"}
        for side in _SIDE_NAMES:
            angles[f"{side}_{name}"] = np.full(len(phase), np.radians(person[source[name]]))
    angles["head_tilt"] = np.full(len(phase), np.radians(person["head_tilt_deg"]))
    angles["head_obliquity"] = 0.2 * angles["trunk_obliquity"]
    angles["head_rotation"] = 0.3 * angles["trunk_rotation"]
    return angles, pelvis


def _arm(
    person: Mapping[str, float], side: int, own: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Shoulder and elbow flexion of a side over its own phase."""
    share = 1 + side * person["arm_asymmetry"] / 2
    later = own - person["arm_lag"]
    curves = {}
    for name in ("arm_swing", "elbow_swing"):
        series = CURVES_DEG[name]
        curves[name] = basis(later, len(series) // 2) @ series * share
    swing = person["arm_mean_deg"] + person["arm_swing_deg"] * curves["arm_swing"]
    elbow = person["elbow_mean_deg"] + person["elbow_swing_deg"] * curves["elbow_swing"]
    return np.radians(swing), np.radians(np.maximum(elbow, 2.0))


def _pelvis_turn(angles: Mapping[str, np.ndarray], part: str = "pelvis") -> Rotation:
    """Turn of pelvis, trunk or head in the room: tilt, then obliquity, then rotation."""
    tilt, listing, turn = (angles[f"{part}_{name}"] for name in ("tilt", "obliquity", "rotation"))
    return Rotation.from_euler("yxz", np.stack([tilt, listing, -turn], axis=1))


def joint_positions(
    body: Body, angles: Mapping[str, np.ndarray], pelvis: np.ndarray
) -> dict[str, np.ndarray]:
    """Return where all joints are, and heel, ball and toes: arrays of shape (frame, 3).

    Parameters
    ----------
    body : Body
    angles : mapping of str to array of shape (frame,)
        As `play` returns them.
    pelvis : array of shape (frame, 3)
        Path of the pelvis point.

    """
    segments = _segments(body, angles)
    index = {segment.name: number for number, segment in enumerate(segments)}
    parents = [-1 if s.parent is None else index[s.parent] for s in segments]
    turns = np.stack(
        [
            (s.turn if s.parent is None else segments[index[s.parent]].turn.inv() * s.turn)
            .as_quat()
            for s in segments
        ],
        axis=1,
    )
    offsets = np.zeros((len(pelvis), len(segments), 3))
    for number, segment in enumerate(segments):
        offsets[:, number] = pelvis if segment.parent is None else segment.offset
    positions, _ = forward_kinematics(parents, offsets, turns)
    return {segment.name: positions[:, number] for number, segment in enumerate(segments)}


def _segments(body: Body, angles: Mapping[str, np.ndarray]) -> list[Segment]:
    pelvis, trunk, head = (_pelvis_turn(angles, part) for part in ("pelvis", "trunk", "head"))
    segments = [
        Segment("pelvis", None, np.zeros(3), pelvis),
        Segment("trunk", "pelvis", np.zeros(3), trunk),
        Segment("sternum", "trunk", body.sternum, trunk),
        Segment("neck", "trunk", body.neck, head),
        Segment("head", "neck", body.head, head),
    ]
    for side, name in zip(SIDES, _SIDE_NAMES, strict=True):
        segments += _leg_segments(body, angles, side, name)
        segments += _arm_segments(body, angles, side, name, trunk)
    return segments


def _leg_segments(
    body: Body, angles: Mapping[str, np.ndarray], side: int, name: str
) -> list[Segment]:
    thigh, knee, pitch, yaw, lean = (
        angles[f"{name}_{angle}"]
        for angle in ("thigh", "knee_flexion", "foot_pitch", "foot_yaw", "splay")
    )

    def in_leg_plane(forward: np.ndarray) -> Rotation:
        return Rotation.from_euler("yx", np.stack([-forward, lean], axis=1))

    foot = Rotation.from_euler("yz", np.stack([pitch, -side * yaw], axis=1))
    sole = body.foot
    return [
        Segment(f"{name}_hip", "pelvis", body.hip * [1, side, 1], in_leg_plane(thigh)),
        Segment(
            f"{name}_knee", f"{name}_hip", np.array([0, 0, -body.thigh]), in_leg_plane(thigh - knee)
        ),
        Segment(f"{name}_ankle", f"{name}_knee", np.array([0, 0, -body.shank]), foot),
        Segment(f"{name}_heel", f"{name}_ankle", np.array([-sole.heel, 0, -sole.height]), foot),
        Segment(f"{name}_ball", f"{name}_ankle", np.array([sole.ball, 0, -sole.height]), foot),
    ]


def _arm_segments(
    body: Body, angles: Mapping[str, np.ndarray], side: int, name: str, trunk: Rotation
) -> list[Segment]:
    swing, out, inwards, elbow = (
        angles[f"{name}_{angle}"]
        for angle in (
            "shoulder_flexion", "shoulder_abduction", "shoulder_rotation", "elbow_flexion",
        )
    )  # fmt: skip
    upper = trunk * Rotation.from_euler(
        "YXZ", np.stack([-swing, side * out, -side * inwards], axis=1)
    )
    fore = upper * Rotation.from_euler("y", -elbow[:, None])
    return [
        Segment(f"{name}_shoulder", "trunk", body.shoulder * [1, side, 1], upper),
        Segment(f"{name}_elbow", f"{name}_shoulder", np.array([0, 0, -body.upper_arm]), fore),
        Segment(f"{name}_wrist", f"{name}_elbow", np.array([0, 0, -body.forearm]), fore),
    ]


def truth_of(
    person: Mapping[str, float], pace: Pace, phase: np.ndarray, angles: Mapping[str, np.ndarray]
) -> dict[str, np.ndarray]:
    """Return what is known of each frame: phase, which foot stands, joint angles in degrees."""
    truth: dict[str, np.ndarray] = {"phase": phase}
    onsets = (0.0, 0.5 + person["step_asymmetry"])
    for side, name, onset in zip(SIDES, _SIDE_NAMES, onsets, strict=True):
        truth[f"{name}_stance"] = (phase - onset) % 1.0 <= pace.stance
        thigh, knee = angles[f"{name}_thigh"], angles[f"{name}_knee_flexion"]
        lean, listing = angles[f"{name}_splay"], angles["pelvis_obliquity"]
        joints = {
            "hip_flexion": thigh + angles["pelvis_tilt"],
            "hip_adduction": side * (listing - lean),
            "knee_flexion": knee,
            "ankle_dorsiflexion": knee - thigh - angles[f"{name}_foot_pitch"],
            "foot_pitch": angles[f"{name}_foot_pitch"],
            "shoulder_flexion": angles[f"{name}_shoulder_flexion"],
            "shoulder_abduction": angles[f"{name}_shoulder_abduction"],
            "elbow_flexion": angles[f"{name}_elbow_flexion"],
        }
        truth |= {f"{name}_{joint}_deg": np.degrees(curve) for joint, curve in joints.items()}
    for part in ("pelvis", "trunk", "head"):
        for turn in ("tilt", "obliquity", "rotation"):
            truth[f"{part}_{turn}_deg"] = np.degrees(angles[f"{part}_{turn}"])
    return truth
