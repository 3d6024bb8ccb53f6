"""What is known of a capture, what speaks against it, and the verdict."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from eigenwalker.gait.body_points import FLAT
from eigenwalker.markers.label_repair import Rebuilt, Repair
from eigenwalker.quality.anthropometry import WrongJoint

Verdict = Literal["use", "use with care", "do not use"]

STEADY_R2 = 0.90
"""Share that two harmonics explain of any steady walk: of real ones they explain 0.95 to 0.99, of
acted exhaustion still 0.91 and more."""

HOPELESS_R2 = 0.70
"""Below this, noise or a movement other than walking prevails."""

FEWEST_STRIDES = 2
"""A single stride has nothing to be compared with."""

ENOUGH_STRIDES = 10
"""The strides that Troje (2002) took of each walker: with so many no capture is unsteady."""

STEADY_SHARE = 0.40
"""Below this share of the time spent walking, a few steady strides make no steady walk."""

BONE_VARIATION = 0.05
"""Coefficient of variation above which a limb is no bone: markers on skin stay below 0.03."""

GROWN_MM = 1500.0
"""From ankles to head of a grown person. Skin moves over bones by millimetres, so the limbs of
smaller bodies may vary by as many millimetres as theirs, which is a greater share."""

FREQUENCIES_HZ = (0.5, 1.4)
"""Strides a second of walking people; above this people run, below they walk slowly or pause."""

SLOWEST_HZ = 0.25
"""Strides a second below which nothing is steady; patients walk with 0.35 and more."""

SHORT_STRIDE = 1.2
"""Length of a stride over that of the leg, up to which slow strides are those of slow people. Steps
grow with cadence (walk ratio: Sekiya et al. 1996, J Hum Mov Stud 30:241); at the usual pace people
have 1.6, and keep it where only the frame rate is wrong."""

MISSING_SHARE = 0.10
"""Share of filled samples above which a walk is partly interpolated."""

FLICKER_SHARE = 0.01
"""Share of a marker's samples off its path that is tolerated."""

HEIGHTS_MM = (500.0, 2500.0)
"""From ankles or feet to the head, no walking person measures less or more: with the wrong unit
they do."""

MOST_LEAN_DEG = 30.0
"""Walkers bent with age lean by less, from the middle between their feet to the head."""

CHILD_MM = 800.0
"""Below this it is a small child, or centimetres were taken for inches."""

LEVEL_CLIMB = 0.05
"""Rise over run of a path that is no longer level: ramps built for wheelchairs have 0.05 to 0.08,
stairs 0.5; tilted floors of laboratories 0.02."""

LEVEL_MM = 400.0
"""Rise of a body that is no longer level over any distance: a floor tilted by 0.02 over 20 m."""

STANDING_SLOPE = (-0.16, 0.08)
"""Rise over run of the ankles that stand in a level walk in place, set outside what our captures
show: -0.14 to 0, in simulated ones up to 0.05; a frame tilted by 10 degrees adds 0.18."""

SYNTHESISED_R2 = 0.9999
"""Share of variance that two harmonics explain only of walks that were made of them, whose feet
slide and whose limbs change length a little; captures reach 0.98."""

MOST_ROLL_DEG = 5.0
"""Lean to one side, in the mean of whole strides, beyond which the frame is tilted: real captures
stay below 2.5."""

FASTEST_FROUDE = 1.0
"""Speed squared over gravity and length of leg, above which nobody walks but racers (Alexander
1989, Physiol Rev 69:1199)."""

EXTENTS_MM = (500.0, 3500.0)
"""Diagonal of the box about a person, standing or lying."""

BACKWARDS_MM_S = -100.0
"""Speed below which a walk goes backwards and does not mark time."""

RULES_OUT = {"head_below_feet", "leaning", "impossible_height", "sides_swapped"}
RULES_OUT |= {
    "no_steady_walk",
    "not_level",
    "sloping",
    "not_periodic",
    "tilted",
    "flat",
    "wrong_joints",
}
"""Findings after which a capture is not to be used."""


@dataclass(frozen=True)
class Quality:
    """What is known of a capture, what speaks against it, and the verdict.

    Parameters
    ----------
    rate_hz, duration_s : float
        Frames a second, and seconds, of the whole capture.
    n_frames : int
        Of the whole capture.
    missing_share : mapping of str to float
        Share of frames without the marker, for markers that miss any.
    repairs : tuple of Repair
        Labels that were repaired, and jumps.
    rebuilt : tuple of Rebuilt
        What stands for markers that were never seen.
    repeated : tuple of str
        Names of several markers, of which the first is taken.
    sides_swapped : bool
        Whether knees bend backwards throughout: left is called right, or the capture is mirrored.
    bone_length_variation : mapping of (str, str) to float
        Coefficient of variation of the length of each limb, in the steady strides.
    height_mm, lean_deg, extent_mm, roll_deg : float
        Height of the head above the feet (or ankles), NaN if it is not above them; angle between
        the vertical and the line from feet to head, both NaN if head or feet are unknown; diagonal
        of the box about the body; and lean to the left in the mean of the steady strides.
    thickness : float
        SD of the body along its shortest axis over that along its longest.
    wrong_joints : tuple of WrongJoint
        What joints of a person cannot be.
    unit, unit_guessed
        Unit of length of the file, and whether it was guessed from the size of the body.
    n_strides, steady_share
        Steady strides, 0 if there are none, and the share of the time spent moving in them.
    straight_passes, unwound_deg
        Straight passes from which they were chosen, 0 for a walk that was unwound; and the range of
        the heading that was taken out.
    frequency_hz, speed_mm_s, climb, climb_mm, wander_mm : float
        Of the steady strides: climb is rise over run, negative downwards, climb_mm the rise;
        wander_mm the root mean square distance from a straight line walked at constant speed.
    standing_slope, froude, stance_shares, stride_of_leg : float
        Rise over run of the standing ankles; speed squared over gravity and length of leg; shares
        of the stride in which left and right foot stand, added; length of a stride over that of the
        leg. NaN if unknown.
    filled_share, r2, periodicity : float
        Of the steady strides: share of samples that were filled; share of variance that two
        harmonics explain; correlation of the movement with itself a stride later.
    treadmill : bool
        Whether the body stays where it is.
    n_frames_cut : int
        Frames that the file declares and lacks (``read_mocap(..., partial="keep")``).
    problem : str
        Why there are no steady strides; else empty.

    See Also
    --------
    assess : Makes it.
    """

    rate_hz: float
    duration_s: float
    n_frames: int
    missing_share: Mapping[str, float]
    repairs: tuple[Repair, ...]
    rebuilt: tuple[Rebuilt, ...]
    repeated: tuple[str, ...]
    sides_swapped: bool
    bone_length_variation: Mapping[tuple[str, str], float]
    height_mm: float
    lean_deg: float
    unit: str
    unit_guessed: bool
    extent_mm: float = np.nan
    roll_deg: float = np.nan
    thickness: float = np.nan
    wrong_joints: tuple[WrongJoint, ...] = ()
    n_strides: int = 0
    steady_share: float = 0.0
    straight_passes: int = 0
    unwound_deg: float = 0.0
    frequency_hz: float = np.nan
    speed_mm_s: float = np.nan
    climb: float = np.nan
    climb_mm: float = np.nan
    wander_mm: float = np.nan
    standing_slope: float = np.nan
    froude: float = np.nan
    stance_shares: float = np.nan
    stride_of_leg: float = np.nan
    filled_share: float = 0.0
    r2: float = np.nan
    periodicity: float = np.nan
    treadmill: bool = False
    n_frames_cut: int = 0
    problem: str = ""

    @property
    def verdict(self) -> Verdict:
        """What to do with the walk."""
        if RULES_OUT & {*self.findings}:
            return "do not use"
        return "use with care" if self.findings else "use"

    @property
    def findings(self) -> tuple[str, ...]:
        """Codes of all that speaks against the capture; empty for "use"."""
        walk = _of_walk(self) if self.n_strides else {"no_steady_walk": True}
        body = _of_body(self)
        checks = body | _of_joints(self) | walk | _of_labels(self)
        follow = next((_FOLLOW[code] for code in _FOLLOW if checks.get(code)), set())
        return tuple(code for code, holds in checks.items() if holds and code not in follow)

    @property
    def upright(self) -> bool:
        """Whether the head is above the feet."""
        return not np.isnan(self.height_mm) and self.lean_deg <= MOST_LEAN_DEG

    @property
    def size_mm(self) -> float:
        """Height of an upright body, else the diagonal of the box about it.

        Joints under skin are made with lengths in mm, so in a wrong unit the box is large; the
        height then tells more.
        """
        tiny = self.height_mm < HEIGHTS_MM[0] and self.extent_mm < EXTENTS_MM[0]
        return self.height_mm if self.upright or tiny else self.extent_mm

    @property
    def rigid_variation(self) -> float:
        """Coefficient of variation up to which limbs of this size are rigid."""
        small = self.upright and self.height_mm < GROWN_MM
        return BONE_VARIATION * (GROWN_MM / self.height_mm if small else 1.0)

    @property
    def slow_people(self) -> bool:
        """Whether strides are slow and short, as those of people who walk slowly."""
        slow = SLOWEST_HZ <= self.frequency_hz < FREQUENCIES_HZ[0]
        return bool(slow and self.stride_of_leg <= SHORT_STRIDE)

    @property
    def level(self) -> bool:
        """Whether the walk neither falls nor climbs."""
        return not (abs(self.climb) >= LEVEL_CLIMB or abs(self.climb_mm) >= LEVEL_MM)

    @property
    def jumps(self) -> dict[str, int]:
        """How often a marker was off its path, for moments or for good."""
        repairs = sorted(self.repairs, key=lambda repair: repair.kind == "jump")
        return dict(Counter(repair.marker for repair in repairs if repair.kind != "swap"))

    @property
    def removed_share(self) -> dict[str, float]:
        """Share of the samples of a marker that were off its path and are taken out."""
        removed: Counter[str] = Counter()
        for repair in self.repairs:
            if repair.kind == "flicker":
                removed[repair.marker] += repair.last_frame - repair.first_frame + 1
        return {marker: count / self.n_frames for marker, count in removed.items()}

    @property
    def left_right_swaps(self) -> int:
        """Number of stretches in which a left and a right label had changed places."""
        return sum(repair.kind == "swap" for repair in self.repairs)


_OF_BODY = {"wrong_joints", "sides_swapped", "tilted", "sloping", "elastic_limbs"}
_OF_BODY |= {"not_level", "backwards", "speed", "no_double_support"}
_FOLLOW = {
    "flat": _OF_BODY,
    "impossible_height": _OF_BODY,
    "head_below_feet": _OF_BODY - {"not_level", "elastic_limbs"},
    "leaning": _OF_BODY - {"not_level", "elastic_limbs"},
    "sides_swapped": {"wrong_joints", "tilted", "sloping"},
    "wrong_joints": {"sides_swapped", "tilted", "sloping"},
}
"""Findings that are no news after one about the body or its joints."""


def _of_body(quality: Quality) -> dict[str, bool]:
    """Return whether this is an upright person in this unit of length; the first problem counts."""
    if quality.thickness <= FLAT:
        return {"flat": True}
    if np.isnan(quality.lean_deg):
        return {}
    least, most = HEIGHTS_MM if quality.upright else EXTENTS_MM
    if not least <= quality.size_mm <= most:
        return {"impossible_height": True}
    if np.isnan(quality.height_mm):
        return {"head_below_feet": True}
    small = quality.upright and quality.height_mm < CHILD_MM
    return {"leaning": not quality.upright, "small_body": small}


def _of_walk(quality: Quality) -> dict[str, bool]:
    n_strides, r2, slope = quality.n_strides, quality.r2, quality.standing_slope
    few = n_strides < ENOUGH_STRIDES and quality.straight_passes <= 1
    return {
        "not_level": not quality.level,
        "sloping": quality.treadmill
        and not r2 > SYNTHESISED_R2
        and (slope < STANDING_SLOPE[0] or slope > STANDING_SLOPE[1]),
        "tilted": abs(quality.roll_deg) > MOST_ROLL_DEG,
        "backwards": quality.speed_mm_s < BACKWARDS_MM_S,
        "speed": quality.froude > FASTEST_FROUDE,
        "no_double_support": quality.stance_shares < 1,
        "hardly_periodic": HOPELESS_R2 <= r2 < STEADY_R2,
        "not_periodic": not r2 >= HOPELESS_R2,
        "cadence": not quality.slow_people
        and not FREQUENCIES_HZ[0] <= quality.frequency_hz <= FREQUENCIES_HZ[1],
        "one_stride": n_strides < FEWEST_STRIDES,
        "unsteady": few and n_strides >= FEWEST_STRIDES and quality.steady_share < STEADY_SHARE,
        "filled_gaps": quality.filled_share > MISSING_SHARE,
    }


def _of_joints(quality: Quality) -> dict[str, bool]:
    kinds = {each.kind for each in quality.wrong_joints}
    return {
        "sides_swapped": quality.sides_swapped and "side" not in kinds,
        "wrong_joints": bool(kinds),
    }


def _of_labels(quality: Quality) -> dict[str, bool]:
    most = max(quality.bone_length_variation.values(), default=0)
    return {
        "elastic_limbs": not quality.r2 > SYNTHESISED_R2 and most > quality.rigid_variation,
        "repeated_names": bool(quality.repeated),
        "swapped_labels": quality.left_right_swaps > 0,
        "flicker": max(quality.removed_share.values(), default=0) > FLICKER_SHARE,
        "jumps": any(repair.kind == "jump" for repair in quality.repairs),
        "cut_short": quality.n_frames_cut > 0,
    }
