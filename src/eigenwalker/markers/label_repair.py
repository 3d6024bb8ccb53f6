"""A capture with its labels put right."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence

import numpy as np
import xarray as xr

from eigenwalker.markers.flicker import find_flicker
from eigenwalker.markers.left_right_swaps import exchanged_sides

SWAPS, FLICKER, JUMPS = "swaps", "flicker", "jumps"
"""Attributes that tell what was found; each entry names markers and frames."""

_ENTRY = re.compile(r"(?P<marker>.*), frames? (?P<first>\d+)(?: to (?P<last>\d+))?")


def mend(walk: xr.DataArray, pairs: Sequence[tuple[str, str]], rate_hz: float) -> xr.DataArray:
    """Return a capture in which left and right keep their places and no marker flickers.

    Parameters
    ----------
    walk : DataArray of shape (time, marker, axis)
        As captured.
    pairs : sequence of pairs of str
        Names of left markers and their right counterparts.
    rate_hz : float
        Frames a second.

    Returns
    -------
    DataArray of shape (time, marker, axis)
        Where labels had changed places they are exchanged; samples that were elsewhere are NaN.
        ``attrs["swaps"]`` and ``attrs["flicker"]`` say where, ``attrs["jumps"]`` which markers
        jumped for good, each beside what they said before. The same object if nothing was amiss.

    Examples
    --------
    >>> walk = ew.simulate_walk(seed=1, duration_s=3)
    >>> walk.loc[{"marker": "left_knee", "time": walk.time[100:102]}] += 500
    >>> mend(walk, ew.JOINTS.pairs, 120).attrs["flicker"]
    ['left_knee, frames 100 to 101']

    """
    names = walk.marker.values.tolist()
    place = {name: index for index, name in enumerate(names)}
    pairs = [pair for pair in pairs if set(pair) <= set(place)]
    positions = walk.values
    swaps: list[str] = []
    if pairs and len(positions) > 1:
        sides = [(place[left], place[right]) for left, right in pairs]
        exchanged = exchanged_sides(positions, sides)
        if exchanged.any():
            positions = _exchange(positions, sides, exchanged)
            swaps = [
                f"{left} and {right}, {_frames(run)}"
                for (left, right), flags in zip(pairs, exchanged.T, strict=True)
                for run in _runs(flags)
            ]
    flicker = find_flicker(positions, rate_hz)
    gone = [
        f"{name}, {_frames(run)}"
        for name, flags in zip(names, flicker.elsewhere.T, strict=True)
        for run in _runs(flags)
    ]
    jumps = [name for name, count in zip(names, flicker.jumps, strict=True) if count]
    if not swaps and not gone and not jumps:
        return walk
    if gone:
        positions = np.where(flicker.elsewhere[..., None], np.nan, positions)
    found = {SWAPS: swaps, FLICKER: gone, JUMPS: jumps}
    entries = {key: list(dict.fromkeys([*told(walk, key), *found[key]])) for key in found}
    return walk.copy(data=positions).assign_attrs(
        {key: some for key, some in entries.items() if some}
    )


def told(walk: xr.DataArray, found: str) -> list[str]:
    """Return the entries of an attribute that tells what was found; some files make them one."""
    entries = walk.attrs.get(found, [])
    return [entries] * bool(entries) if isinstance(entries, str) else list(entries)


def markers_of(entries: Sequence[str]) -> list[str]:
    """Return the marker or markers that each entry of an attribute is about.

    Examples
    --------
    >>> markers_of(["left_knee, frames 100 to 101", "left_elbow"])
    ['left_knee', 'left_elbow']

    """
    return [hit["marker"] if (hit := _ENTRY.fullmatch(entry)) else entry for entry in entries]


def samples_of(entries: Sequence[str]) -> dict[str, int]:
    """Return in how many frames each marker is, by the entries of an attribute.

    Examples
    --------
    >>> samples_of(["left_knee, frames 100 to 101", "left_knee, frame 7"])
    {'left_knee': 3}

    """
    samples: Counter[str] = Counter()
    for entry in entries:
        if hit := _ENTRY.fullmatch(entry):
            samples[hit["marker"]] += int(hit["last"] or hit["first"]) - int(hit["first"]) + 1
    return dict(samples)


def _exchange(
    positions: np.ndarray, sides: Sequence[tuple[int, int]], exchanged: np.ndarray
) -> np.ndarray:
    mended = positions.copy()
    for (left, right), flags in zip(sides, exchanged.T, strict=True):
        mended[flags, left] = positions[flags, right]
        mended[flags, right] = positions[flags, left]
    return mended


def _runs(flags: np.ndarray) -> list[tuple[int, int]]:
    edges = np.flatnonzero(np.diff(np.concatenate([[0], flags.astype(np.int8), [0]])))
    return [(int(a), int(b)) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def _frames(run: tuple[int, int]) -> str:
    start, stop = run
    return f"frame {start}" if stop == start + 1 else f"frames {start} to {stop - 1}"
