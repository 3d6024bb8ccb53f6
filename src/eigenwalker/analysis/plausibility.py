"""How far a made-up walker is from anyone who was captured: extrapolation has limits (J30)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd
import xarray as xr

from eigenwalker.analysis.direction import SpacePosition, position_in_space
from eigenwalker.analysis.walker_space import WalkerSpace
from eigenwalker.core.skeleton import JOINTS
from eigenwalker.population.population import Population

LIMBS = {
    "upper arms": ("shoulder", "elbow"),
    "forearms": ("elbow", "wrist"),
    "thighs": ("hip", "knee"),
    "shanks": ("knee", "ankle"),
}


@dataclass(frozen=True, eq=False)
class Plausibility:
    """How far a walker is from the walkers of a population.

    Parameters
    ----------
    position : SpacePosition
        Its distance from the average walker beside theirs, and what lies outside their space.
    limb_change : Series
        How much longer each limb is than the average walker's: 0.1 is a tenth longer, left and
        right together.
    limb_stretch : Series
        Standard deviation of each limb's length over the stride as a share of its mean: bones are
        rigid, sums of walkers not quite.

    """

    position: SpacePosition
    limb_change: pd.Series
    limb_stretch: pd.Series


def plausibility(population: Population, vector: np.ndarray) -> Plausibility:
    """Return how plausible a walker is who belongs to no one.

    Parameters
    ----------
    population : Population
        Of walkers with the 15 joints, or some of them.
    vector : array of shape (feature,)
        The walker in question.

    Returns
    -------
    Plausibility

    Examples
    --------
    >>> people = ew.load_population()
    >>> bool(plausibility(people, people.average).limb_change.abs().max() < 1e-9)
    True

    """
    known = population.X[~population.flagged] if not population.flagged.all() else population.X
    space = WalkerSpace().fit(known)
    own, usual = (_limb_lengths(population, each) for each in (vector, population.average))
    return Plausibility(
        position=position_in_space(space, vector, walkers=known),
        limb_change=own.mean() / usual.mean() - 1,
        limb_stretch=own.std() / own.mean(),
    )


def _limb_lengths(population: Population, vector: np.ndarray) -> pd.DataFrame:
    """Length of each limb over a stride in mm, sides averaged: a table (time, limb)."""
    walker = population.walker(vector)
    stride = walker.trajectories(np.linspace(0, walker.period_s, 100, endpoint=False))
    there = set(walker.markers) & set(JOINTS.markers)
    lengths = {}
    for limb, (upper, lower) in LIMBS.items():
        sides = [
            segment_length(stride, f"{side}_{upper}", f"{side}_{lower}")
            for side in ("left", "right")
            if {f"{side}_{upper}", f"{side}_{lower}"} <= there
        ]
        if sides:
            lengths[limb] = np.mean(sides, axis=0)
    return pd.DataFrame(lengths)


def segment_length(walk: xr.DataArray, one: str, other: str) -> np.ndarray:
    """Return the distance of two markers over time in mm: array of shape (time,)."""
    between = walk.sel(marker=one).values - walk.sel(marker=other).values
    return np.linalg.norm(between, axis=-1)
