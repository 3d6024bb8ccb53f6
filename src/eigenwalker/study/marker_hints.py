"""What the places of markers say of them, where their names say nothing."""

from __future__ import annotations

import itertools
from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy.ndimage import uniform_filter1d
from scipy.optimize import linear_sum_assignment

from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.trajectories import sampling_rate
from eigenwalker.datasets.built_in import load_population

WALKS_MM_S = 200.0
"""Speed from which on the way that the markers take is the direction of walking."""
LEAST_FRAMES = 20
NEAR = 0.12
"""Share of the height within which a marker may be the joint that is looked for."""
_ANKLES, _HEADS = (0.0, 0.03, 0.06), (0.88, 0.92, 0.96, 1.0)
"""Heights of the lowest and the highest joint that are tried, as shares of that of all markers."""
_WEIGHTS = np.array([0.5, 1.0, 2.0])
"""Of a marker along, across and above: limbs swing, and heights differ least."""


class MarkerHints(NamedTuple):
    """Where markers are, in words, and which joint each may be.

    ``places`` is by marker, ``joints`` by joint; ``sides_known`` whether left and right could be
    told, by the direction of walking.
    """

    places: dict[str, str]
    joints: dict[str, str]
    sides_known: bool


def marker_hints(capture: xr.DataArray) -> MarkerHints:
    """Return what the places of the markers of a capture, in mm and z up, say of them."""
    names = [str(name) for name in capture.marker.values]
    seen = np.isfinite(capture.values).all(axis=2).mean(axis=0) > 0.5
    positions = capture.values[:, seen]
    names = [name for name, is_seen in zip(names, seen, strict=True) if is_seen]
    if len(names) < 3:
        return MarkerHints({}, {}, False)
    relative, sides_known = _seen_from_the_body(positions, sampling_rate(capture))
    places, swing = np.nanmedian(relative, axis=0), np.nanstd(relative[..., 0], axis=0)
    floor = np.nanpercentile(relative[..., 2], 1)
    height = max(float(places[:, 2].max() - floor), 1.0)
    places = (places - [0, 0, floor]) / height
    return MarkerHints(
        {
            name: _in_words(place, swing_mm, height, sides_known)
            for name, place, swing_mm in zip(names, places, swing, strict=True)
        },
        _nearest(names, places),
        sides_known,
    )


def _seen_from_the_body(positions: np.ndarray, rate_hz: float) -> tuple[np.ndarray, bool]:
    """Return positions from their middle, x forwards, while they move; else as they are."""
    middle = np.nanmean(positions, axis=1)
    middle[:, 2] = 0
    known = np.isfinite(middle).all(axis=1)
    relative = (positions - middle[:, None])[known]
    path = uniform_filter1d(middle[known, :2], max(int(rate_hz / 2), 1), axis=0, mode="nearest")
    if len(path) < LEAST_FRAMES:
        return relative, False
    velocity = np.gradient(path, axis=0) * rate_hz
    speed = np.linalg.norm(velocity, axis=1)
    moves = speed > WALKS_MM_S
    if moves.sum() < LEAST_FRAMES:
        return relative, False
    forward = velocity[moves] / speed[moves, None]
    x, y = np.moveaxis(relative[moves][..., :2], -1, 0)
    along = x * forward[:, :1] + y * forward[:, 1:]
    across = y * forward[:, :1] - x * forward[:, 1:]
    return np.stack([along, across, relative[moves][..., 2]], axis=-1), True


def _in_words(place: np.ndarray, swing_mm: float, height: float, sides_known: bool) -> str:
    words = f"at {place[2]:.0%} of the height of all"
    if not sides_known:
        return words
    side = f"{abs(place[1]) * height:.0f} mm {'left' if place[1] > 0 else 'right'} of the middle"
    return f"{words}, {side}, swings {swing_mm:.0f} mm (SD) along the way"


def _nearest(names: list[str], places: np.ndarray) -> dict[str, str]:
    """Return the marker that is nearest to where each joint is in the average of people."""
    people = load_population()
    joints = people.walker(people.average).mean_posture.sel(marker=list(JOINTS.markers)).values
    joints = joints - joints.mean(axis=0) * [1, 1, 0] - [0, 0, joints[:, 2].min()]
    markers = places - places.mean(axis=0) * [1, 1, 0]
    ways: list[tuple[float, np.ndarray, np.ndarray, np.ndarray]] = []
    for ankle, head in itertools.product(_ANKLES, _HEADS):
        expected = joints * (head - ankle) / joints[:, 2].max() + [0, 0, ankle]
        apart = np.abs(expected[:, None] - markers[None]) @ _WEIGHTS
        rows, columns = linear_sum_assignment(apart)
        ways.append((float(np.minimum(apart[rows, columns], NEAR).sum()), apart, rows, columns))
    _, apart, rows, columns = min(ways, key=lambda way: way[0])
    return {
        JOINTS.markers[row]: names[column]
        for row, column in zip(rows, columns, strict=True)
        if apart[row, column] < NEAR
    }
