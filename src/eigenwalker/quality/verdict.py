"""What speaks against using a capture, in sentences, and the verdict that follows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal, NamedTuple

import numpy as np

from eigenwalker.markers.label_repair import markers_of
from eigenwalker.quality.steadiness import Steadiness

Verdict = Literal["use", "use with care", "do not use"]

STEADY_R2 = 0.90
"""Two harmonics explain less of no steady walk: of real ones they explain 0.95 to 0.99, of acted
exhaustion still 0.91 and more."""

HOPELESS_R2 = 0.70
"""Below this, noise or something other than walking prevails."""

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

FLICKER_SHARE = 0.01
"""Share of a marker's samples that may be taken out as elsewhere without saying so."""

HEIGHTS_MM = (500.0, 2500.0)
"""From ankles or feet to the head, no walking person measures less or more: with the wrong unit
they do."""

MOST_LEAN_DEG = 30.0
"""Walkers who are bent with age lean by less, from the middle between their feet to the head."""

CHILD_MM = 800.0
"""Below this it is a small child, or centimetres were taken for inches."""


class Fault(NamedTuple):
    """Something that speaks against a capture, and whether it rules it out."""

    sentence: str
    hopeless: bool = False


def verdict_of(faults: Sequence[Fault]) -> Verdict:
    """Return what is to be done with a capture that has these faults.

    Examples
    --------
    >>> verdict_of([]), verdict_of([Fault("Markers jump.")])
    ('use', 'use with care')

    """
    if any(fault.hopeless for fault in faults):
        return "do not use"
    return "use with care" if faults else "use"


def faults_of_body(height_mm: float | None, lean_deg: float, unit: object) -> list[Fault]:
    """Return what speaks against this being a person who stands upright, in the unit taken."""
    if height_mm is None:
        return []
    if np.isnan(height_mm):
        return [Fault("The head is not above the feet: the wrong axis points up.", hopeless=True)]
    if lean_deg > MOST_LEAN_DEG:
        sentence = (
            f"From feet to head the body leans by {lean_deg:.0f} degrees: the frame is tilted, or "
            "head or feet are not where they are said to be."
        )
        return [Fault(sentence, hopeless=True)]
    smallest, tallest = HEIGHTS_MM
    taken = f"the unit {unit} is wrong" if isinstance(unit, str) else "the unit of length is wrong"
    measured = f"From feet to head the body measures {_length(height_mm)}"
    if not smallest <= height_mm <= tallest:
        sentence = f"{measured}, which no walking person does: {taken}. Read it with unit=..."
        return [Fault(sentence, hopeless=True)]
    if height_mm < CHILD_MM:
        return [Fault(f"{measured}: if this is no small child, {taken}.")]
    return []


def _length(millimetres: float) -> str:
    if millimetres >= 1e5:
        return f"{millimetres / 1e6:.3g} km"
    return f"{millimetres:.3g} mm" if millimetres < 1000 else f"{millimetres / 1000:.3g} m"


def faults_of_walk(steady: Steadiness, complaint: str) -> list[Fault]:
    """Return what speaks against this being a steady walk on level ground."""
    if not steady.n_strides:
        return [Fault(f"No steady walk was found. {complaint}", hopeless=True)]
    faults = []
    if not steady.level:
        rises = "rises" if steady.climb > 0 else "falls"
        faults.append(
            Fault(
                f"This is no level walk: the body {rises} by {abs(steady.climb_mm):.0f} mm over "
                f"{steady.n_strides} strides.",
                hopeless=True,
            )
        )
    if not steady.r2 >= STEADY_R2:
        faults.append(
            Fault(
                f"This is no steady walk: two harmonics explain {steady.r2:.2f} of the movement, "
                f"where steady walks reach {STEADY_R2:.2f} or more.",
                hopeless=not steady.r2 >= HOPELESS_R2,
            )
        )
    slowest, fastest = FREQUENCIES_HZ
    if not slowest <= steady.frequency_hz <= fastest:
        faults.append(
            Fault(
                f"{steady.frequency_hz:.2f} strides a second is not the pace of a walk, which is "
                f"between {slowest} and {fastest}; the frame rate may be wrong."
            )
        )
    return [*faults, *_faults_of_strides(steady)]


def _faults_of_strides(steady: Steadiness) -> list[Fault]:
    """Return what is wrong with how many strides there are, and how whole they are."""
    faults = []
    few = steady.n_strides < ENOUGH_STRIDES and steady.straight_passes <= 1
    if steady.n_strides < FEWEST_STRIDES:
        faults.append(Fault("Only one stride is steady, so nothing tells how it varies."))
    elif steady.steady_share < STEADY_SHARE and few:
        faults.append(
            Fault(
                f"This is no steady walk: {steady.n_strides} strides hang together, "
                f"{steady.steady_share:.0%} of the time spent walking."
            )
        )
    if steady.filled_share > MISSING_SHARE:
        share = f"{steady.filled_share:.0%}"
        faults.append(Fault(f"Of the steady samples {share} were missing and were filled."))
    return faults


def faults_of_limbs(
    variation: Mapping[tuple[str, str], float], *, sides_swapped: bool
) -> list[Fault]:
    """Return what speaks against the limbs being those of a body."""
    faults = []
    if elastic := {bone: share for bone, share in variation.items() if share > BONE_VARIATION}:
        worst = max(elastic, key=lambda bone: elastic[bone])
        faults.append(
            Fault(
                f"{len(elastic)} of {len(variation)} limbs change length by more than "
                f"{BONE_VARIATION:.0%}; worst from {worst[0]} to {worst[1]}, {elastic[worst]:.1%}."
            )
        )
    if sides_swapped:
        faults.append(
            Fault(
                "Knees bend backwards: left is called right, or the capture is mirrored.",
                hopeless=True,
            )
        )
    return faults


def faults_of_labels(
    swaps: Sequence[str],
    removed: Mapping[str, float],
    jumps: Sequence[str],
    repeated: str | Sequence[str] = (),
) -> list[Fault]:
    """Return what speaks against the markers having been followed well.

    Parameters
    ----------
    swaps : sequence of str
        Where left and right changed places and were put right, as `mend` tells.
    removed : mapping of str to float
        Share of each marker's samples that were elsewhere and were taken out.
    jumps : sequence of str
        Markers that jump for good.
    repeated : sequence of str, or str
        Names that came more than once; a line of them from some files.

    """
    faults = []
    if names := repeated if isinstance(repeated, str) else ", ".join(repeated):
        faults.append(
            Fault(f"Several markers are called alike, and the first of them is taken: {names}.")
        )
    if swaps:
        shown = "; ".join(swaps[:3]) + (f" and {len(swaps) - 3} more" if len(swaps) > 3 else "")
        faults.append(Fault(f"Left and right changed places and were put right: {shown}."))
    if often := [name for name, share in removed.items() if share > FLICKER_SHARE]:
        faults.append(Fault(f"Markers flicker, and gaps were left: {', '.join(often)}."))
    if jumps:
        faults.append(Fault(f"Markers jump: {', '.join(dict.fromkeys(markers_of(jumps)))}."))
    return faults
