"""A figure of a stimulus for animation: a rig that walks over ground, or in place as a cycle."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
import xarray as xr

from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.trajectories import label_trajectories
from eigenwalker.io.writers.rig import EXTRAS, SIDES, Rig, fit_rig, floor_of
from eigenwalker.stimulus.foot_contacts import bent_leg, find_contacts, plant
from eigenwalker.stimulus.rig_choices import RigChoices
from eigenwalker.stimulus.stimulus import Stimulus

N_JOINTS = len(JOINTS.markers)
MAX_ERROR_MM = 100.0
"""Root mean square by which bones of constant length may miss the dots."""
MAX_SHIFT_MM = 250.0
"""How far feet may be moved to stay in place; beyond it they are left as they are."""


class FootSlide(NamedTuple):
    """How far a figure's standing feet slide.

    Mean horizontal speed of the standing ball of a foot over the ground, how far it goes in a
    stance, and its speed before legs were bent so that it stays in place.
    """

    mean_mm_s: float
    per_stance_mm: float
    before_mm_s: float

    def __str__(self) -> str:
        return (
            f"Standing feet slide at {self.mean_mm_s:.0f} mm/s, {self.per_stance_mm:.0f} mm a "
            f"stance ({self.before_mm_s:.0f} mm/s before legs were adjusted)."
        )


class Animation(NamedTuple):
    """A figure that walks with constant bones.

    The rig; the places of its 15 joints (time, marker, axis), mm; how its feet stand; its forward
    speed; whether it is a cycle, whose last frame goes over into its first; how much faster it
    plays so that a cycle has whole frames.
    """

    rig: Rig
    walk: xr.DataArray
    slide: FootSlide
    speed_mm_s: float
    is_cycle: bool
    tempo: float
    n_frames: int

    def __str__(self) -> str:
        cycle = f"A cycle of {self.n_frames} frames" if self.is_cycle else ""
        if cycle and abs(self.tempo - 1) > 5e-5:
            cycle += f", played {100 * abs(self.tempo - 1):.1f} % "
            cycle += "faster" if self.tempo > 1 else "slower"
            cycle += " so that they are whole"
        speed = f"{cycle}. " if cycle else ""
        return f"{speed}Forward at {self.speed_mm_s:.0f} mm/s. {self.slide}"


@lru_cache(maxsize=1)
def animated(
    stimulus: Stimulus,
    *,
    figure: int = 0,
    rate_hz: float | None = None,
    choices: RigChoices | None = None,
    closed: bool = False,
) -> Animation:
    """Return a figure as its chain of transforms leaves it, with bones of constant length.

    It travels at the constant speed at which its standing feet, on average, stay where they are;
    legs are bent so that the balls of standing feet do stay. It stands on the floor, z = 0. A
    figure upside down does not travel. Where it is a cycle and `closed`, its first posture comes
    once more at its end, since players jump from the last key to the first. Raises ValueError if
    the figure lacks joints, or moves as no body with bones does.
    """
    choices = choices or RigChoices()
    rate_hz = rate_hz or stimulus.timing.rate_hz
    times, pad, tempo = _moments(stimulus, figure, rate_hz)
    seen = _joints(stimulus, figure, times, rate_hz)
    floor = floor_of(seen)
    seen = seen - np.array([0.0, 0.0, floor])
    rig = fit_rig(seen, floor_mm=0.0)
    body = _body(rig, seen, rate_hz)
    missed = body.values[:, :N_JOINTS] - seen.values[:, :N_JOINTS]
    error_mm = float(np.sqrt(np.mean(np.sum(missed**2, axis=2))))
    if error_mm > MAX_ERROR_MM:
        raise ValueError(
            f"This figure does not move as a body with bones: constant ones miss its joints by "
            f"{error_mm:.0f} mm. Leave out what takes the body apart, or write .csv or .npz."
        )
    walk, slide, velocity = _walking(body, seen, rate_hz)
    keep = slice(pad, len(times) - pad + (closed and tempo > 0))
    clock = (np.arange(len(times)) - pad) / rate_hz
    pelvis = walk.sel(marker="pelvis").values
    drift = _trend(pelvis, pad, rate_hz)[:2]
    total = drift + velocity
    travel = np.outer(clock, -drift if choices.in_place else velocity)
    walk = walk + np.pad(travel, ((0, 0), (0, 1)))[:, None]
    path = np.pad(np.outer(clock, np.zeros(2) if choices.in_place else total), ((0, 0), (0, 1)))
    rig = fit_rig(walk, choices.skeleton, choices.rest_pose, floor_mm=0.0, ground=path)
    rig = rig.frames(keep)
    walk = walk[keep, :N_JOINTS].assign_coords(time=clock[keep])
    speed = float(np.linalg.norm(total))
    n_frames = len(times) - 2 * pad
    return Animation(rig, walk, slide, speed, tempo > 0, tempo or 1.0, n_frames)


def _moments(stimulus: Stimulus, figure: int, rate_hz: float) -> tuple[np.ndarray, int, float]:
    """Return moments to play, of which so many at both ends are for smoothness, and the tempo.

    The tempo is 0 where it is no cycle.
    """
    duration_s, moving = stimulus.timing.duration_s, stimulus.scene[figure]
    n_frames = max(round(duration_s * rate_hz), 2)
    if not stimulus.figures[figure].is_periodic:
        return np.arange(n_frames) / rate_hz, 0, 0.0
    strides = duration_s / moving.period_s
    pad = max(round(moving.period_s * rate_hz), 2)
    if round(strides) < 1 or abs(strides - round(strides)) > 1e-4:
        return np.arange(-pad, n_frames + pad) / rate_hz, pad, 0.0
    step_s = moving.period_s / pad
    return np.arange(-pad, (round(strides) + 1) * pad) * step_s, pad, step_s * rate_hz


def _joints(stimulus: Stimulus, figure: int, times: np.ndarray, rate_hz: float) -> xr.DataArray:
    """Return the 15 joints of a figure, and feet, hands and top of the head where it has them."""
    played = stimulus.play(times)
    mine = np.flatnonzero(played.figures == figure)
    names = [played.dots[dot] for dot in mine]
    if lacking := [joint for joint in JOINTS.markers if joint not in names]:
        raise ValueError(
            f"Animation takes a figure with the 15 joints; figure {figure} lacks {lacking}. Leave "
            "out limb dots, or write .csv or .npz."
        )
    wanted = [*JOINTS.markers, *(extra for extra in EXTRAS if extra in names)]
    keep = [mine[names.index(joint)] for joint in wanted]
    return label_trajectories(played.positions[:, keep], markers=wanted, rate_hz=rate_hz)


def _body(rig: Rig, seen: xr.DataArray, rate_hz: float) -> xr.DataArray:
    """Return joints where a rig has them, and the balls of its feet."""
    names = [str(name) for name in seen.marker.values]
    names += [f"{side}_toe" for side in SIDES if f"{side}_toe" not in names]
    places = rig.positions
    values = np.stack([places[:, rig.roles.index(name)] for name in names], axis=1)
    return label_trajectories(values, markers=names, rate_hz=rate_hz)


def _walking(
    body: xr.DataArray, seen: xr.DataArray, rate_hz: float
) -> tuple[xr.DataArray, FootSlide, np.ndarray]:
    """Return a body whose standing feet stay in place if it moves at a velocity, and that."""
    names = [str(name) for name in body.marker.values]
    values = body.values.copy()

    def dot(name: str) -> int:
        return names.index(name)

    balls = [dot(f"{side}_toe") for side in SIDES]
    if values[:, dot("left_ankle"), 2].mean() > values[:, dot("pelvis"), 2].mean():
        return body, FootSlide(0.0, 0.0, 0.0), np.zeros(2)
    contacts = find_contacts(values[:, balls], rate_hz)
    path = np.outer(np.arange(len(values)) / rate_hz, contacts.velocity)
    path = np.pad(path, ((0, 0), (0, 1)))
    across = values[:, dot("left_hip")] - values[:, dot("right_hip")]
    forward = np.cross(across, [0.0, 0.0, 1.0])
    forward = forward / np.linalg.norm(forward, axis=1, keepdims=True)
    before = _slide(values[:, balls] + path[:, None], contacts.standing, rate_hz)
    for foot, side in enumerate(SIDES):
        hip, knee, ankle, toe = (dot(f"{side}_{part}") for part in ("hip", "knee", "ankle", "toe"))
        standing = contacts.standing[:, foot]
        low = float(values[standing, toe, 2].mean()) if standing.any() else 0.0
        shift = plant(values[:, toe] + path, standing, low)
        if np.abs(shift).max() > MAX_SHIFT_MM:
            continue
        shift[:, 2] += np.maximum(-(values[:, toe, 2] + shift[:, 2]), 0.0)
        target = values[:, ankle] + shift
        leg = bent_leg(values[:, hip], values[:, knee], values[:, ankle], target, forward)
        for part in ("toe", "heel"):
            if f"{side}_{part}" in names:
                values[:, dot(f"{side}_{part}")] += leg[1] - values[:, ankle]
        values[:, knee], values[:, ankle] = leg
    after = _slide(values[:, balls] + path[:, None], contacts.standing, rate_hz)
    walk = body.copy(data=values)
    return walk, FootSlide(*after, before[0]), contacts.velocity


def _trend(places: np.ndarray, pad: int, rate_hz: float) -> np.ndarray:
    """Return the mean velocity (3,) of places (time, 3), of which `pad` frames are a period."""
    if pad:
        return (places[pad:] - places[:-pad]).mean(axis=0) * rate_hz / pad
    return np.polyfit(np.arange(len(places)) / rate_hz, places, 1)[0]


def _slide(balls: np.ndarray, standing: np.ndarray, rate_hz: float) -> tuple[float, float]:
    """Return the mean speed of balls that stand, and how far they go in a stance on average."""
    both = standing[1:] & standing[:-1]
    way = np.linalg.norm(np.diff(balls[..., :2], axis=0), axis=2)[both]
    n_stances = np.count_nonzero(np.diff(standing.astype(int), axis=0) > 0) + standing[0].sum()
    if not len(way):
        return 0.0, 0.0
    return float(way.mean() * rate_hz), float(way.sum() / max(n_stances, 1))
