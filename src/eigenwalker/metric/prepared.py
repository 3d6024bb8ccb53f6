"""Clips made ready to be compared with many others."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import reduce

import numpy as np
import xarray as xr

from eigenwalker.core.trajectories import check_trajectories, sampling_rate
from eigenwalker.core.walker import Walker
from eigenwalker.gait.frequency import NoStrideError
from eigenwalker.gait.gaps import fill_short_gaps
from eigenwalker.metric.cycles import common_clock
from eigenwalker.metric.loops import loop
from eigenwalker.metric.points import common_names, refuse_names_twice
from eigenwalker.metric.registration import Registration, register, register_strides

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
    filled, gaps = fill_short_gaps(clip.values, sampling_rate(clip))
    whole = clip.copy(data=filled)
    try:
        return PreparedClip(whole, common_clock(loop(clip)))
    except NoStrideError as error:
        if gaps:
            raise
        return PreparedClip(whole, None, str(error))


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


def prepare_alike(
    clips: Clips, *, done: Callable[[], object] = lambda: None
) -> dict[str, PreparedClip]:
    """Return clips made ready to be compared with each other, by the points that all have.

    What only some clips have decides nothing then. Clips that are prepared stay as they are.

    Parameters
    ----------
    clips : mapping of str to DataArray, Walker or PreparedClip, or sequence, or Population
        Clips that are given in order are called "0", "1" and so on.
    done : callable, optional
        Called after each clip.

    Raises
    ------
    ValueError
        If they have no points in common.

    """
    clips = getattr(clips, "walkers", clips)
    if not isinstance(clips, Mapping):
        clips = {str(number): clip for number, clip in enumerate(clips)}
    plain = {
        name: clip if isinstance(clip, PreparedClip) else as_trajectories(clip)
        for name, clip in clips.items()
    }
    markers = [
        [str(m) for m in (each.clip if isinstance(each, PreparedClip) else each).marker.values]
        for each in plain.values()
    ]
    common = set(reduce(common_names, markers)) if markers else set()
    found = {}
    for (name, clip), there in zip(plain.items(), markers, strict=True):
        if not isinstance(clip, PreparedClip) and len(there) > len(common):
            clip = clip.isel(marker=[marker in common for marker in there])
        found[name] = prepare(clip)
        done()
    return found


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
