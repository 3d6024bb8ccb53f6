"""Clips made ready to be compared with many others."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import reduce

import numpy as np
import xarray as xr

from eigenwalker.gait.frequency import NoStrideError
from eigenwalker.gait.gaps import fill_short_gaps
from eigenwalker.metric.cycles import common_clock
from eigenwalker.metric.loops import loop
from eigenwalker.metric.points import common_names, refuse_names_twice
from eigenwalker.metric.registration import Registration, register, register_strides
from eigenwalker.trajectories import check_trajectories, sampling_rate
from eigenwalker.walker import Walker

RATE_HZ = 100.0
"""Frames a second at which walkers are played, as the paper's clips were."""

N_STRIDES = 3
"""Strides that they walk."""


@dataclass(frozen=True, eq=False)
class PreparedClip:
    """A clip made ready to be compared with many others, by several metrics.

    Parameters
    ----------
    clip : DataArray of shape (time, marker, axis)
        As it was, short gaps filled.
    cycle : DataArray of shape (time, marker, axis), optional
        One stride of it on the common clock; None if it does not repeat.
    complaint : str
        Why there is no stride.

    """

    clip: xr.DataArray
    cycle: xr.DataArray | None
    complaint: str = ""


Clip = xr.DataArray | Walker | PreparedClip
"""Whatever can be compared."""

Clips = Mapping[str, Clip] | Sequence[Clip]
"""Clips by name, or in order."""


def prepare(clip: Clip) -> PreparedClip:
    """Return a clip made ready to be compared.

    Parameters
    ----------
    clip : DataArray of shape (time, marker, axis), Walker or PreparedClip
        Markers that were never seen are left out. Walkers walk in place.

    Returns
    -------
    PreparedClip

    Raises
    ------
    ValueError
        If it is one frame, or has gaps that are too long to be filled.

    Examples
    --------
    >>> prepare(ew.simulate_walk(seed=1)).cycle.sizes["time"]
    120

    """
    if isinstance(clip, PreparedClip):
        return clip
    clip = as_trajectories(clip)
    rate_hz = sampling_rate(clip)
    try:
        return PreparedClip(clip, common_clock(loop(clip)))
    except NoStrideError as error:
        filled, gaps = fill_short_gaps(clip.values, rate_hz)
        if gaps:
            raise
        return PreparedClip(clip.copy(data=filled), None, str(error))


def on_mannequin(clips: Iterable[PreparedClip]) -> bool:
    """Return whether any of these clips is of the neutral mannequin (`retarget`)."""
    return any(bool(each.clip.attrs.get("retargeted")) for each in clips)


def registration_of(a: PreparedClip, b: PreparedClip) -> Registration:
    """Return how two prepared clips are registered: as strides if both repeat, else end to end.

    Along the same path as in tables of pairs, whichever clip is named first.
    """
    if a.cycle is not None and b.cycle is not None:
        return register_strides(a.cycle, b.cycle)
    if a.clip.values.tobytes() > b.clip.values.tobytes():
        return register(b.clip, a.clip).turned_round()
    return register(a.clip, b.clip)


def of_common_points(clips: Mapping[str, Clip]) -> dict[str, Clip]:
    """Return clips of the points that all have, so that no other decides how one is prepared.

    What was prepared stays as it is.

    Raises
    ------
    ValueError
        If they have no points in common.

    """
    markers = []
    for clip in clips.values():
        there = clip.clip if isinstance(clip, PreparedClip) else as_trajectories(clip)
        markers.append([str(name) for name in there.marker.values])
    common = reduce(common_names, markers)
    return {
        name: clip
        if isinstance(clip, PreparedClip)
        else as_trajectories(clip).sel(marker=[each for each in there if each in common])
        for (name, clip), there in zip(clips.items(), markers, strict=True)
    }


def named(clips: Clips) -> dict[str, Clip]:
    """Return clips by name; those that are given in order are called "0", "1" and so on."""
    if isinstance(clips, Mapping):
        return {str(name): clip for name, clip in clips.items()}
    return {str(number): clip for number, clip in enumerate(clips)}


def as_trajectories(clip: xr.DataArray | Walker) -> xr.DataArray:
    """Return trajectories, checked, of markers that were seen; of a walker a few strides."""
    if isinstance(clip, Walker):
        return clip.trajectories(np.arange(0, N_STRIDES * clip.period_s, 1 / RATE_HZ))
    clip = check_trajectories(clip)
    if not clip.sizes["time"] or not np.isnan(clip.values[0]).any():
        return clip
    refuse_names_twice(clip.marker.values.tolist())
    clip = clip.dropna("marker", how="all")
    if not clip.sizes["marker"]:
        raise ValueError("No marker of this clip was ever seen, so there is nothing to compare.")
    return clip
