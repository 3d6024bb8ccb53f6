"""Clips made ready to be compared with many others."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import xarray as xr

from eigenwalker.gait.frequency import NoStrideError
from eigenwalker.gait.gaps import fill_short_gaps
from eigenwalker.metric.cycles import common_clock
from eigenwalker.metric.loops import loop
from eigenwalker.metric.points import common_names
from eigenwalker.metric.registration import Registration, register, register_strides
from eigenwalker.trajectories import check_trajectories, sampling_rate


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


Clip = xr.DataArray | PreparedClip


def prepare(clip: Clip) -> PreparedClip:
    """Return a clip made ready to be compared.

    Parameters
    ----------
    clip : DataArray of shape (time, marker, axis), or PreparedClip
        Markers that were never seen are left out.

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
    clip = check_trajectories(clip)
    rate_hz = sampling_rate(clip)
    if np.isnan(clip.values[0]).any():
        clip = clip.dropna("marker", how="all")
    if not clip.sizes["marker"]:
        raise ValueError("No marker of this clip was ever seen, so there is nothing to compare.")
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
    if a.cycle is None or b.cycle is None:
        first, second, way = a.clip, b.clip, register
    else:
        names = common_names(a.cycle.marker.values, b.cycle.marker.values)
        first, second, way = a.cycle.sel(marker=names), b.cycle.sel(marker=names), register_strides
    if first.values.tobytes() > second.values.tobytes():
        return way(second, first).turned_round()
    return way(first, second)
