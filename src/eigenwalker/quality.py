"""What a capture is worth: what is in it, what is wrong with it, and the verdict."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
import xarray as xr

from eigenwalker.gait import in_place
from eigenwalker.gait.harmonics import share_explained
from eigenwalker.gait.heading import sides_swapped
from eigenwalker.gait.steady import body_relative
from eigenwalker.mocap.upright import body_height, head_and_feet
from eigenwalker.skeleton import JOINTS
from eigenwalker.trajectories import check_trajectories, sampling_rate

Verdict = Literal["use", "use with care", "do not use"]

STEADY_R2 = 0.90
"""Two harmonics explain less of no steady walk: of real ones they explain 0.95 to 0.99, of acted
exhaustion still 0.91 and more."""

HOPELESS_R2 = 0.70
"""Below this, noise or something other than walking prevails."""

LEVEL_CLIMB = 0.10
"""Rise over run of a path that is no longer level: the steepest ramps built for wheelchairs have
0.08, stairs 0.5; floors of laboratories that were set up askew 0.02."""

FEWEST_STRIDES = 2
"""A single stride has nothing to be compared with."""

ENOUGH_STRIDES = 10
"""What Troje (2002, J2) took of each walker: whoever has them needs no steadier capture."""

STEADY_SHARE = 0.40
"""Where less of the walking than this hangs together, and few strides do, it is unsteady."""

BONE_VARIATION = 0.05
"""Coefficient of variation above which a limb is no bone: markers on skin stay below 0.03."""

FREQUENCIES_HZ = (0.5, 1.4)
"""Strides a second of walking people; above this people run, below they shuffle or pause."""

MISSING_SHARE = 0.10
"""Share of the steady samples filled by splines above which the walk is partly ours."""

HEIGHTS_MM = (500.0, 2500.0)
"""From ankles or feet to the head, no walking person measures less or more: with the wrong unit
they do."""

CHILD_MM = 800.0
"""Below this it is a small child, or centimetres were taken for inches."""

LIMBS = tuple(
    (f"{side}_{upper}", f"{side}_{lower}")
    for side in ("left", "right")
    for upper, lower in (
        ("hip", "knee"),
        ("knee", "ankle"),
        ("shoulder", "elbow"),
        ("elbow", "wrist"),
    )
)
"""The segments that are single bones."""

_JUMP_FACTOR = 10.0
_JUMP_MM = 30.0
_SWAP_MM = 60.0
_LIVELY = 0.3
_LEAST_WAY_MM = 300.0


@dataclass(frozen=True)
class Quality:
    """What is in a capture and what is wrong with it.

    Parameters
    ----------
    rate_hz, duration_s, n_frames
        Of the capture as it came. What follows, but for the missing, concerns the steady part where
        there is one.
    missing_share : mapping of str to float
        Share of frames without the marker, for markers that miss any.
    jumps : mapping of str to int
        Sudden changes of place, for markers that make any.
    left_right_swaps : int
        Moments at which a left marker goes on where its right counterpart was, and the other way
        round.
    sides_swapped : bool
        Whether knees bend backwards all the time: left is called right, or the capture is mirrored.
    bone_length_variation : mapping of (str, str) to float
        Coefficient of variation of the length of each limb.
    n_strides : int
        Whole strides in the steady part; 0 if there is none.
    steady_share : float
        Share of the time spent moving that the steady part covers.
    frequency_hz, speed_mm_s, climb : float
        Of the steady part; climb is rise over run, down is negative.
    wander_mm : float
        Root mean square distance from a straight line walked at constant speed.
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
    jumps: Mapping[str, int]
    left_right_swaps: int
    sides_swapped: bool
    bone_length_variation: Mapping[tuple[str, str], float]
    n_strides: int
    steady_share: float
    frequency_hz: float
    speed_mm_s: float
    climb: float
    wander_mm: float
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
    positions, names = capture.values, capture.marker.values.tolist()
    missing = np.isnan(positions).any(axis=2).mean(axis=0)
    walk, complaint = _steady_walk(capture)
    steady = _steady_facts(walk, capture, rate_hz)
    judged = capture if walk is None else capture.sel(time=walk.time)
    jumps = _jumps(judged.values)
    swaps = _swaps(judged.values, names)
    bones = _bone_length_variation(judged)
    swapped = walk is not None and sides_swapped(walk.values, names)
    height_mm = _height(positions, names)
    faults = [
        *_faults_of_names(capture.attrs.get("repeated")),
        *_faults_of_body(height_mm, capture.attrs.get("unit")),
        *_faults_of_walk(walk, complaint, steady),
        *_faults_of_capture(jumps, names, swaps, bones, swapped=swapped),
    ]
    hopeless = any(fault.hopeless for fault in faults)
    return Quality(
        rate_hz=rate_hz,
        duration_s=len(positions) / rate_hz,
        n_frames=len(positions),
        missing_share={
            name: float(share) for name, share in zip(names, missing, strict=True) if share
        },
        jumps={name: int(count) for name, count in zip(names, jumps, strict=True) if count},
        left_right_swaps=swaps,
        sides_swapped=swapped,
        bone_length_variation=bones,
        n_strides=0 if walk is None else int(walk.attrs["n_strides"]),
        height_mm=np.nan if height_mm is None else height_mm,
        unit_guessed=bool(capture.attrs.get("unit_guessed", False)),
        verdict="do not use" if hopeless else "use with care" if faults else "use",
        reasons=tuple(fault.sentence for fault in faults),
        **steady._asdict(),
    )


class _Fault(NamedTuple):
    sentence: str
    hopeless: bool = False


class _Steady(NamedTuple):
    steady_share: float = 0.0
    frequency_hz: float = np.nan
    speed_mm_s: float = np.nan
    climb: float = np.nan
    wander_mm: float = np.nan
    r2: float = np.nan
    periodicity: float = np.nan
    level: bool = True
    treadmill: bool = False


def _steady_walk(capture: xr.DataArray) -> tuple[xr.DataArray | None, str]:
    """Return the walk in place, or None and what was wrong."""
    try:
        return in_place(capture), ""
    except ValueError as error:
        return None, str(error)


def _steady_facts(walk: xr.DataArray | None, capture: xr.DataArray, rate_hz: float) -> _Steady:
    if walk is None:
        return _Steady()
    facts = walk.attrs
    frequency_hz = facts["frequency_hz"]
    movement = walk.values.reshape(len(walk), -1)
    way = np.nanmax([abs(facts["speed_mm_s"]) / frequency_hz, _LEAST_WAY_MM]) * facts["n_strides"]
    climb = facts["climb_mm"] / way
    return _Steady(
        steady_share=min(
            1.0, len(walk) / max(1, _moving_frames(capture.values, rate_hz / frequency_hz))
        ),
        frequency_hz=frequency_hz,
        speed_mm_s=facts["speed_mm_s"],
        climb=float(climb),
        wander_mm=facts["wander_mm"],
        r2=share_explained(movement, np.arange(len(walk)) * frequency_hz / rate_hz),
        periodicity=_periodicity(movement, round(rate_hz / frequency_hz)),
        level=bool(abs(climb) < LEVEL_CLIMB),
        treadmill=facts["treadmill"],
    )


def _height(positions: np.ndarray, names: list[str]) -> float | None:
    """Return how tall a body is, NaN if its head is not above its feet; None if that is unknown."""
    if not all(np.isfinite(part).any() for part in head_and_feet(positions, names)):
        return None
    return body_height(positions, names)


def _moving_frames(positions: np.ndarray, stride: float) -> int:
    """Return how many frames there are in which the body moves as it does when walking."""
    seen = np.isfinite(positions).all(axis=(0, 2))
    movement = (
        body_relative(positions[:, seen]) if seen.sum() >= 3 else np.empty((len(positions), 0))
    )
    speed = np.linalg.norm(np.diff(movement, axis=0), axis=1)
    kernel = np.ones(max(1, round(stride / 2)))
    lively = np.convolve(speed, kernel, "same") / np.convolve(np.ones(len(speed)), kernel, "same")
    return int((lively > _LIVELY * np.quantile(lively, 0.8)).sum()) if movement.size else 0


def _periodicity(movement: np.ndarray, stride: int) -> float:
    """Return the correlation of all columns together with themselves a stride later."""
    centred = movement - movement.mean(axis=0)
    if len(centred) < 1.5 * stride:
        return float("nan")
    early, late = centred[:-stride], centred[stride:]
    scale = np.sqrt(np.vdot(early, early) * np.vdot(late, late))
    return float(np.vdot(early, late) / scale) if scale > 0 else float("nan")


def _bone_length_variation(capture: xr.DataArray) -> dict[tuple[str, str], float]:
    """Return SD over mean of each limb's length."""
    place = {name: index for index, name in enumerate(capture.marker.values.tolist())}
    found = {}
    for upper, lower in LIMBS:
        if upper in place and lower in place:
            bone = capture.values[:, place[upper]] - capture.values[:, place[lower]]
            length = np.linalg.norm(bone[np.isfinite(bone).all(axis=1)], axis=1)
            if len(length) and length.mean() > 0:
                found[upper, lower] = float(length.std() / length.mean())
    return found


def _jumps(positions: np.ndarray) -> np.ndarray:
    """Return for each marker how often it is suddenly elsewhere, against its usual acceleration."""
    bend = np.linalg.norm(np.diff(positions, n=2, axis=0), axis=2)
    bend = np.where(np.isfinite(bend), bend, 0.0)
    if len(bend) < 3:
        return np.zeros(positions.shape[1], dtype=int)
    sudden = bend > _JUMP_MM + _JUMP_FACTOR * np.quantile(bend, 0.9, axis=0)
    starts = sudden & ~np.vstack([np.zeros((1, sudden.shape[1]), dtype=bool), sudden[:-1]])
    return starts.sum(axis=0)


def _swaps(positions: np.ndarray, names: list[str]) -> int:
    """Return at how many moments left and right markers change places."""
    place = {name: index for index, name in enumerate(names)}
    count = 0
    for left, right in JOINTS.pairs:
        if left not in place or right not in place:
            continue
        one, other = positions[:, place[left]], positions[:, place[right]]
        straight = _distance(one[1:], one[:-1]) + _distance(other[1:], other[:-1])
        crossed = _distance(one[1:], other[:-1]) + _distance(other[1:], one[:-1])
        count += int((straight - crossed > 2 * _SWAP_MM).sum())
    return count


def _distance(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    return np.linalg.norm(one - other, axis=1)


def _faults_of_names(repeated: object) -> list[_Fault]:
    """Return what speaks against names that come more than once."""
    names = repeated if isinstance(repeated, str) else ", ".join(repeated or ())  # pyright: ignore[reportArgumentType] - names, or a line of them from a file
    if not names:
        return []
    return [_Fault(f"Several markers are called alike, and the first of them is taken: {names}.")]


def _faults_of_body(height_mm: float | None, unit: object) -> list[_Fault]:
    """Return what speaks against this being a person who stands upright, in the unit taken."""
    if height_mm is None:
        return []
    if np.isnan(height_mm):
        return [_Fault("The head is not above the feet: the wrong axis points up.", hopeless=True)]
    smallest, tallest = HEIGHTS_MM
    taken = f"the unit {unit} is wrong" if isinstance(unit, str) else "the unit of length is wrong"
    measured = f"From feet to head the body measures {_length(height_mm)}"
    if not smallest <= height_mm <= tallest:
        sentence = f"{measured}, which no walking person does: {taken}. Read it with unit=..."
        return [_Fault(sentence, hopeless=True)]
    if height_mm < CHILD_MM:
        return [_Fault(f"{measured}: if this is no small child, {taken}.")]
    return []


def _length(millimetres: float) -> str:
    if millimetres >= 1e5:
        return f"{millimetres / 1e6:.3g} km"
    return f"{millimetres:.3g} mm" if millimetres < 1000 else f"{millimetres / 1000:.3g} m"


def _faults_of_walk(walk: xr.DataArray | None, complaint: str, steady: _Steady) -> list[_Fault]:
    """Return what speaks against this being a steady walk on level ground."""
    if walk is None:
        return [_Fault(f"No steady walk was found. {complaint}", hopeless=True)]
    faults = []
    if not steady.level:
        faults.append(
            _Fault(
                f"This is no level walk: the body {'rises' if steady.climb > 0 else 'falls'} by "
                f"{abs(walk.attrs['climb_mm']):.0f} mm over {walk.attrs['n_strides']} strides.",
                hopeless=True,
            )
        )
    if not steady.r2 >= STEADY_R2:
        faults.append(
            _Fault(
                f"This is no steady walk: two harmonics explain {steady.r2:.2f} of the movement, "
                f"where steady walks reach {STEADY_R2:.2f} or more.",
                hopeless=not steady.r2 >= HOPELESS_R2,
            )
        )
    slowest, fastest = FREQUENCIES_HZ
    if not slowest <= steady.frequency_hz <= fastest:
        faults.append(
            _Fault(
                f"{steady.frequency_hz:.2f} strides a second is not the pace of a walk, which is "
                f"between {slowest} and {fastest}; the frame rate may be wrong."
            )
        )
    n_strides = int(walk.attrs["n_strides"])
    if n_strides < FEWEST_STRIDES:
        faults.append(_Fault("Only one stride is steady, so nothing tells how it varies."))
    elif steady.steady_share < STEADY_SHARE and n_strides < ENOUGH_STRIDES:
        faults.append(
            _Fault(
                f"This is no steady walk: {n_strides} strides hang together, "
                f"{steady.steady_share:.0%} of the time spent walking."
            )
        )
    filled = walk.attrs["filled_samples"] / (walk.sizes["time"] * walk.sizes["marker"])
    if filled > MISSING_SHARE:
        faults.append(_Fault(f"Of the steady samples {filled:.0%} were missing and were filled."))
    return faults


def _faults_of_capture(
    jumps: np.ndarray,
    names: list[str],
    swaps: int,
    bones: Mapping[tuple[str, str], float],
    *,
    swapped: bool,
) -> list[_Fault]:
    """Return what speaks against the markers having been followed well."""
    faults = []
    if elastic := {bone: share for bone, share in bones.items() if share > BONE_VARIATION}:
        worst = max(elastic, key=lambda bone: elastic[bone])
        faults.append(
            _Fault(
                f"{len(elastic)} of {len(bones)} limbs change length by more than "
                f"{BONE_VARIATION:.0%}; worst from {worst[0]} to {worst[1]}, {elastic[worst]:.1%}."
            )
        )
    if jumps.any():
        jumping = [name for name, count in zip(names, jumps, strict=True) if count]
        faults.append(_Fault(f"Markers jump: {', '.join(jumping)}."))
    if swaps:
        faults.append(_Fault(f"Left and right markers change places {swaps} times."))
    if swapped:
        faults.append(
            _Fault(
                "Knees bend backwards: left is called right, or the capture is mirrored.",
                hopeless=True,
            )
        )
    return faults
