"""All that is found out about a capture, gathered."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import xarray as xr

from eigenwalker.core.trajectories import check_trajectories, sampling_rate
from eigenwalker.gait.heading import sides_swapped
from eigenwalker.gait.in_place import in_place
from eigenwalker.markers.label_repair import (
    FLICKER,
    JUMPS,
    SWAPS,
    markers_of,
    mend,
    samples_of,
    told,
)
from eigenwalker.markers.marker_sets import side_pairs
from eigenwalker.quality.body_size import bone_length_variation, height_of, lean_of
from eigenwalker.quality.steadiness import steadiness_of
from eigenwalker.quality.verdict import (
    Verdict,
    faults_of_body,
    faults_of_labels,
    faults_of_limbs,
    faults_of_walk,
    verdict_of,
)


@dataclass(frozen=True)
class Quality:
    """What is in a capture and what is wrong with it.

    Parameters
    ----------
    rate_hz, duration_s, n_frames
        Of the capture as it came. What follows, but for the missing and the mended, concerns the
        steady part where there is one.
    missing_share : mapping of str to float
        Share of frames without the marker, for markers that miss any.
    rebuilt : tuple of str
        Markers that were never seen, and what stands for them.
    jumps : mapping of str to int
        How often a marker was elsewhere, for moments or for good.
    removed_share : mapping of str to float
        Share of the samples of a marker that were taken out, as it was elsewhere for moments.
    swaps : tuple of str
        Where left and right markers had changed places and were put right.
    left_right_swaps : int
        How many such stretches there are.
    sides_swapped : bool
        Whether knees bend backwards all the time: left is called right, or the capture is mirrored.
    bone_length_variation : mapping of (str, str) to float
        Coefficient of variation of the length of each limb.
    n_strides : int
        Whole strides in the steady part; 0 if there is none.
    steady_share : float
        Share of the time spent moving that the steady part covers.
    straight_passes : int
        Among how many straight passes the strides were chosen; 0 for a walk that was unwound.
    unwound_deg : float
        How far the heading changed that was taken out.
    frequency_hz, speed_mm_s, climb, climb_mm : float
        Of the steady part; climb is rise over run, down is negative.
    wander_mm : float
        Drift: root mean square distance from a straight line walked at constant speed.
    filled_share : float
        Share of the steady samples that were filled.
    r2 : float
        Share of variance that two harmonics explain in the steady part in place.
    periodicity : float
        Correlation of the movement with itself a stride later.
    level : bool
        Whether the walk neither falls nor climbs.
    treadmill : bool
        Whether the body stays where it is.
    height_mm : float
        From the feet (or ankles) to the head; NaN where they are not known or not upright.
    unit_guessed : bool
        Whether the unit of length was guessed from the size of the body.
    verdict : {"use", "use with care", "do not use"}
        On the whole.
    reasons : tuple of str
        Sentences for all that speaks against using it; empty for "use".

    """

    rate_hz: float
    duration_s: float
    n_frames: int
    missing_share: Mapping[str, float]
    rebuilt: tuple[str, ...]
    jumps: Mapping[str, int]
    removed_share: Mapping[str, float]
    swaps: tuple[str, ...]
    left_right_swaps: int
    sides_swapped: bool
    bone_length_variation: Mapping[tuple[str, str], float]
    n_strides: int
    steady_share: float
    straight_passes: int
    unwound_deg: float
    frequency_hz: float
    speed_mm_s: float
    climb: float
    climb_mm: float
    wander_mm: float
    filled_share: float
    r2: float
    periodicity: float
    level: bool
    treadmill: bool
    height_mm: float
    unit_guessed: bool
    verdict: Verdict
    reasons: tuple[str, ...]

    @property
    def flag(self) -> str:
        """All that is wrong in one line, empty for a walk that can be used."""
        return " ".join(self.reasons)


def assess(trajectories: xr.DataArray) -> Quality:
    """Return what is in a capture and what is wrong with it, however bad it is.

    Parameters
    ----------
    trajectories : DataArray of shape (time, marker, axis)
        As captured; joints as `virtual_markers` gives them tell most, but any markers do.

    Returns
    -------
    Quality

    Raises
    ------
    TypeError, ValueError
        If these are no trajectories at all, or their times are not evenly spaced.

    Examples
    --------
    >>> feet = ew.Walker(
    ...     ["left_ankle", "right_ankle", "pelvis"],
    ...     [[0, 90, 80], [0, -90, 80], [0, 0, 900]],
    ...     [[[300, 0, 0], [-300, 0, 0], [0, 20, 0]]],
    ...     [1],
    ...     [0],
    ...     0.9,
    ... )
    >>> quality = assess(feet.trajectories(np.arange(0, 5, 0.01)))
    >>> quality.verdict, quality.n_strides, round(quality.r2, 6)
    ('use', 4, 1.0)

    """
    capture = check_trajectories(trajectories)
    rate_hz = sampling_rate(capture)
    names = capture.marker.values.tolist()
    missing = np.isnan(capture.values).any(axis=2).mean(axis=0)
    capture = mend(capture, side_pairs(names), rate_hz)
    walk, complaint = _steady_walk(capture)
    steady = steadiness_of(walk, capture.values, rate_hz)
    bones = bone_length_variation(capture if walk is None else capture.sel(time=walk.time))
    swapped = walk is not None and sides_swapped(walk.values, names)
    height_mm = height_of(capture.values, names)
    swaps, flicker, jumps = (told(capture, found) for found in (SWAPS, FLICKER, JUMPS))
    removed = {name: count / len(capture) for name, count in samples_of(flicker).items()}
    faults = [
        *faults_of_body(height_mm, lean_of(capture.values, names), capture.attrs.get("unit")),
        *faults_of_walk(steady, complaint),
        *faults_of_limbs(bones, sides_swapped=swapped),
        *faults_of_labels(swaps, removed, jumps, capture.attrs.get("repeated", ())),
    ]
    return Quality(
        rate_hz=rate_hz,
        duration_s=len(capture) / rate_hz,
        n_frames=len(capture),
        missing_share={
            name: float(share) for name, share in zip(names, missing, strict=True) if share
        },
        rebuilt=tuple(told(capture, "rebuilt")),
        jumps=dict(Counter(markers_of([*flicker, *jumps]))),
        removed_share=removed,
        swaps=tuple(swaps),
        left_right_swaps=len(swaps),
        sides_swapped=swapped,
        bone_length_variation=bones,
        height_mm=np.nan if height_mm is None else height_mm,
        unit_guessed=bool(capture.attrs.get("unit_guessed", False)),
        verdict=verdict_of(faults),
        reasons=tuple(fault.sentence for fault in faults),
        **steady._asdict(),
    )


def _steady_walk(capture: xr.DataArray) -> tuple[xr.DataArray | None, str]:
    """Return the walk in place, or None and what was wrong."""
    try:
        return in_place(capture), ""
    except ValueError as error:
        return None, str(error)
