"""A captured person who walks in another style, with the bones of that person."""

from __future__ import annotations

import numpy as np
import xarray as xr

from eigenwalker.core.quaternions import Rotation
from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.trajectories import label_trajectories
from eigenwalker.core.walker import Walker
from eigenwalker.stimulus.moving_dots import parents_of

N_SAMPLES = 240
"""Moments of a stride, between which players draw straight lines."""
CARRIERS = {"heel": "ankle", "toe": "ankle", "hand": "wrist", "clavicle": "shoulder"}
"""Joints whose bone points beyond the 15 joints turn with."""


def captured_body(walk: xr.DataArray, own: Walker, start: Walker, styled: Walker) -> xr.DataArray:
    """Return one stride (time, marker, axis) of a captured person in another style.

    `walk` and its walker `own` have all joints that were captured; `start` is the same person among
    a population, and `styled` what became of it there. Bones are as long as in `walk`. Each bone
    turns as that of `start` must turn to become that of `styled`, at the same moment of the stride;
    feet, hands and head turn with the bones that carry them. The stride takes as long as that of
    `styled`.
    """
    cycle = 2 * np.pi * np.arange(N_SAMPLES) / N_SAMPLES
    lead = _lead(own, start, cycle)
    places = own.positions(cycle + lead)
    names, dots = list(own.markers), list(JOINTS.markers)
    order = [start.markers.index(name) for name in dots]
    before, after = start.positions(cycle)[:, order], styled.positions(cycle)[:, order]
    parents = {dots[dot]: dots[parent] for dot, parent in parents_of(JOINTS).items() if parent >= 0}
    new = places.copy()
    root, pelvis = names.index("pelvis"), dots.index("pelvis")
    new[:, root] += after[:, pelvis] - before[:, pelvis]
    turn: dict[str, Rotation] = {"pelvis": Rotation.identity(N_SAMPLES)}

    def carry(name: str, parent: str, turned: Rotation) -> None:
        child, carrier = names.index(name), names.index(parent)
        way = places[:, child] - places[:, carrier]
        length = _length(way)  # 0 where a capture has two joints in one place
        longer = _length(walk.values[:, child] - walk.values[:, carrier]) / length if length else 1
        new[:, child] = new[:, carrier] + turned.apply(way * longer)

    for dot, parent in parents.items():
        child, carrier = dots.index(dot), dots.index(parent)
        turn[dot] = _turn(
            before[:, child] - before[:, carrier], after[:, child] - after[:, carrier]
        )
        carry(dot, parent, turn[dot])
    for name in names:
        side, _, part = name.partition("_")
        if name == "head_top":
            carry(name, "head", turn["head"])
        elif part in CARRIERS:
            joint = f"{side}_{CARRIERS[part]}"
            if part == "clavicle":
                carry(name, "sternum", turn[joint])
            else:
                carry(name, joint, turn[joint])
    ankles = [names.index(f"{side}_ankle") for side in ("left", "right")]
    new[..., 2] += places[:, ankles, 2].min() - new[:, ankles, 2].min()
    stride = label_trajectories(new, markers=names, rate_hz=N_SAMPLES * styled.frequency_hz)
    return stride.assign_attrs(speed_mm_s=styled.speed_mm_s)


def _length(ways: np.ndarray) -> float:
    return float(np.median(np.linalg.norm(ways, axis=1)))


def _lead(own: Walker, start: Walker, cycle: np.ndarray) -> float:
    """Return the angle of the stride by which one's own clock is ahead of the population's."""
    joints = [[walker.markers.index(name) for name in JOINTS.markers] for walker in (own, start)]
    mine, its = own.positions(cycle)[:, joints[0]], start.positions(cycle)[:, joints[1]]
    spectra = [np.fft.fft(each - each.mean(axis=0), axis=0) for each in (mine, its)]
    agreement = np.fft.ifft(spectra[0] * spectra[1].conj(), axis=0).real.sum(axis=(1, 2))
    best = int(agreement.argmax())
    around = agreement[[best - 1, best, (best + 1) % len(cycle)]]
    bend = around[0] - 2 * around[1] + around[2]
    finer = 0.5 * (around[0] - around[2]) / bend if bend else 0.0
    return float(2 * np.pi * (best + finer) / len(cycle))


def _turn(before: np.ndarray, after: np.ndarray) -> Rotation:
    """Return the smallest turns of some ways, (time, 3), into the directions of others."""
    one, other = (way / np.linalg.norm(way, axis=1, keepdims=True) for way in (before, after))
    cosine = np.sum(one * other, axis=1)
    return Rotation.from_quat(np.column_stack([np.cross(one, other), 1 + cosine]))
