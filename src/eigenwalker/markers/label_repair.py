"""Labels of markers repaired: left and right that changed places, samples off a marker's path."""

from __future__ import annotations

from typing import Literal, NamedTuple, TypeVar

import numpy as np
import xarray as xr

from eigenwalker.core.runs import runs_of_true
from eigenwalker.core.trajectories import check_trajectories, sampling_rate
from eigenwalker.markers.flicker import find_flicker
from eigenwalker.markers.left_right_swaps import exchanged_sides
from eigenwalker.markers.marker_sets import side_pairs


class Repair(NamedTuple):
    """A stretch of a capture in which a marker did not have the right label.

    Parameters
    ----------
    marker : str
        The marker; of a swap the left one.
    kind : {"swap", "flicker", "jump"}
        Labels of two markers had changed places, and were exchanged; samples were off the marker's
        path for moments, and are missing now; or the marker left its path for good, which is not
        repaired.
    first_frame, last_frame : int
        Both belong to the stretch. Of a jump: the first and the last frame that begins elsewhere.
    partner : str
        The right marker of a swap, else empty.

    See Also
    --------
    repair_labels : makes it.
    """

    marker: str
    kind: Literal["swap", "flicker", "jump"]
    first_frame: int
    last_frame: int
    partner: str = ""


class Rebuilt(NamedTuple):
    """What stands for markers that were never seen.

    Parameters
    ----------
    point : str
        The joint or landmark.
    kind : {"from", "mirrored", "above neck"}
        The midpoint of ``sources`` alone; their mirror image; a place above the neck.
    sources, lacking : tuple of str
        Markers from which it was made, and those that are absent.

    See Also
    --------
    eigenwalker.virtual_markers : Rebuilds them.
    """

    point: str
    kind: Literal["from", "mirrored", "above neck"]
    sources: tuple[str, ...] = ()
    lacking: tuple[str, ...] = ()


_Record = TypeVar("_Record", Repair, Rebuilt)


def records_in(walk: xr.DataArray, attribute: str, kind: type[_Record]) -> tuple[_Record, ...]:
    """Return the records that an attribute of a capture lists; other things in it are none."""
    listed = walk.attrs.get(attribute)
    listed = listed if isinstance(listed, (tuple, list)) else ()
    return tuple(each for each in listed if isinstance(each, kind))


def repair_labels(trajectories: xr.DataArray) -> xr.DataArray:
    """Return a capture in which left and right keep their places and no marker flickers.

    Parameters
    ----------
    trajectories : DataArray of shape (time, marker, axis)
        As captured; pairs of left and right are known by their names.

    Returns
    -------
    DataArray of shape (time, marker, axis)
        Labels that had changed places are exchanged; samples off a marker's path are NaN.
        ``attrs["repairs"]`` is a tuple of `Repair`, those of earlier repairs first. The same object
        if there was nothing to repair.

    See Also
    --------
    virtual_markers, in_place : both repair labels first.

    Examples
    --------
    >>> walk = ew.simulate_walk(seed=1, duration_s=3)
    >>> walk.loc[{"marker": "left_knee", "time": walk.time[100:102]}] += 500
    >>> repair_labels(walk).attrs["repairs"]
    (Repair(marker='left_knee', kind='flicker', first_frame=100, last_frame=101, partner=''),)
    """
    walk = check_trajectories(trajectories)
    rate_hz = sampling_rate(walk)
    names = walk.marker.values.tolist()
    pairs = [(names.index(left), names.index(right)) for left, right in side_pairs(names)]
    positions, repairs = _exchanged(walk.values, names, pairs)
    flicker = find_flicker(positions, rate_hz)
    for name, flags, jumps in zip(names, flicker.off_path.T, flicker.jumps, strict=True):
        repairs += [Repair(name, "flicker", a, b - 1) for a, b in runs_of_true(flags)]
        repairs += [Repair(name, "jump", jumps[0], jumps[-1])] if jumps else []
    if not repairs:
        return walk
    positions = np.where(flicker.off_path[..., None], np.nan, positions)
    repairs = tuple(dict.fromkeys([*records_in(walk, "repairs", Repair), *repairs]))
    return walk.copy(data=positions).assign_attrs(repairs=repairs)


def _exchanged(
    positions: np.ndarray, names: list[str], pairs: list[tuple[int, int]]
) -> tuple[np.ndarray, list[Repair]]:
    """Return positions with swapped labels exchanged, and the swaps."""
    swaps: list[Repair] = []
    if not pairs:
        return positions, swaps
    exchanged = exchanged_sides(positions, pairs)
    repaired = positions.copy() if exchanged.any() else positions
    for (left, right), flags in zip(pairs, exchanged.T, strict=True):
        for start, stop in runs_of_true(flags):
            repaired[start:stop, [left, right]] = positions[start:stop, [right, left]]
            swaps.append(Repair(names[left], "swap", start, stop - 1, names[right]))
    return repaired, swaps
