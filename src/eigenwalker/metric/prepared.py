"""Clips prepared to be compared with many others."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import reduce

import numpy as np
import xarray as xr

from eigenwalker.core.trajectories import sampling_rate
from eigenwalker.gait.frequency import NoStrideError
from eigenwalker.gait.gaps import fill_short_gaps
from eigenwalker.metric.clips import Clip, Clips, Loop, PreparedClip, as_trajectories, check_clips
from eigenwalker.metric.cycles import common_clock
from eigenwalker.metric.loops import loop
from eigenwalker.metric.points import common_names


def prepare(clip: Clip) -> PreparedClip:
    """Return a clip with its stride on the common clock, to be compared with many others.

    Functions that compare clips prepare them; to do it once saves time where a clip is used often.

    Parameters
    ----------
    clip : DataArray of shape (time, marker, axis), Walker, Loop or PreparedClip
        Markers that were never seen are left out, short gaps filled.

    Returns
    -------
    PreparedClip
        Without a stride if the clip does not repeat.

    Raises
    ------
    ValueError
        If it is one frame, or has gaps that are too long to be filled.

    See Also
    --------
    prepare_walk : Of a capture, in place.
    pair_table : Takes what it returns.

    References
    ----------
    Pražák et al. (2010), section 2.

    Examples
    --------
    >>> prepare(ew.simulate_walk(seed=1)).cycle.sizes["time"]
    120
    """
    if isinstance(clip, PreparedClip):
        return clip
    if isinstance(clip, Loop):
        return PreparedClip(clip.cycle, common_clock(clip))
    walk = _seen(as_trajectories(clip))
    filled, gaps = fill_short_gaps(walk.values, sampling_rate(walk))
    whole = walk.copy(data=filled)
    try:
        return PreparedClip(whole, common_clock(loop(walk)))
    except NoStrideError as error:
        if gaps:
            raise
        return PreparedClip(whole, None, str(error))


def prepare_together(
    clips: Clips, *, done: Callable[[], object] = lambda: None
) -> dict[str, PreparedClip]:
    """Return clips prepared to be compared with each other, with the points that all have.

    Clips in a sequence are named "0", "1" and so on; `done` is called after each clip.
    """
    clips = check_clips(clips)
    if not isinstance(clips, Mapping):
        clips = {str(number): clip for number, clip in enumerate(clips)}
    known = {
        name: clip if isinstance(clip, PreparedClip | Loop) else _seen(as_trajectories(clip))
        for name, clip in clips.items()
    }
    markers = [as_trajectories(clip).marker.values.tolist() for clip in known.values()]
    common = set(reduce(common_names, markers)) if markers else set()
    prepared = {}
    for (name, clip), names in zip(known.items(), markers, strict=True):
        if not isinstance(clip, PreparedClip) and len(names) > len(common):
            shared = [marker in common for marker in names]
            if isinstance(clip, Loop):
                clip = replace(clip, cycle=clip.cycle.isel(marker=shared))
            else:
                clip = clip.isel(marker=shared)
        prepared[name] = prepare(clip)
        done()
    return prepared


def _seen(clip: xr.DataArray) -> xr.DataArray:
    """Return a clip without the markers that were never seen."""
    if not clip.sizes["time"] or not np.isnan(clip.values[0]).any():
        return clip
    clip = clip.dropna("marker", how="all")
    if not clip.sizes["marker"]:
        raise ValueError("No marker of this clip was ever seen, so there is nothing to compare.")
    return clip
