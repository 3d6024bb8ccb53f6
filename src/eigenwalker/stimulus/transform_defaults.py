"""Parameters of transforms that may be left out, or given in other terms, in Python.

A stimulus file states numbers. Here they are computed from the figures as they are at that place
of the chain.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from eigenwalker.core.arguments import check_numbers
from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.walker import Walker
from eigenwalker.stimulus.dot_size import USUAL_HEIGHT_MM, degrees_in_px
from eigenwalker.stimulus.figure import Figure, WalkerPart
from eigenwalker.stimulus.moving_dots import MovingDots
from eigenwalker.stimulus.player import play
from eigenwalker.stimulus.schema import TRANSFORMS, Display, View
from eigenwalker.stimulus.start_phase import beginning_at, leg_phase

ARM_SWING = tuple(f"{side}_{joint}" for side in ("left", "right") for joint in ("elbow", "wrist"))
MASK_BOX, SCRAMBLE_BOX = (0.75, 1.15), (0.4, 1.0)
"""Width and height of the boxes of masks and of scrambled dots where none are given.

In heights of the figure, whatever its own width: noise is as dense about narrow walkers as about
wide ones.
"""

Parameters = dict[str, Any]
_Resolver = Callable[["Situation", Parameters], Parameters]


@dataclass(frozen=True)
class Situation:
    """The stimulus to whose chain a transform is added.

    `figures` are as they are without any transform, `scene` is after the transforms so far.
    """

    figures: Sequence[Figure]
    scene: Sequence[MovingDots]
    view: View
    display: Display
    duration_s: float

    def number(self, parameters: Parameters) -> int:
        """Return the number of the first figure that a transform acts on."""
        number = (parameters.get("figures") or [0])[0]
        if not 0 <= number < len(self.figures):
            raise ValueError(f"There is no figure {number}; there are {len(self.figures)}.")
        return number

    def moving(self, parameters: Parameters) -> MovingDots:
        """Return the first figure that a transform acts on."""
        return self.scene[self.number(parameters)]

    def height(self, parameters: Parameters) -> float:
        """Return the larger extent in the picture, mm, of the first figure before all transforms.

        Over a period, as figures are fitted into the picture and sized: a box made by it is as
        large in the picture for all figures that are as high there.
        """
        bare = self.figures[self.number(parameters)].moving_dots()
        seen = play([bare], self.view, bare.sample_times).picture.reshape(-1, 2)
        return max(float((np.nanmax(seen, axis=0) - np.nanmin(seen, axis=0)).max()), 100.0)


def resolve_transform(name: str, parameters: Mapping[str, Any], situation: Situation) -> Parameters:
    """Return a transform as it stands in a file, in a situation that gives what is left out.

    May be left out: the box of ``scramble`` (as high as the figure, 0.4 times as wide, whatever its
    own width), the box of ``mask`` (1.15 times as high, 0.75 times as wide) and its centre, the end
    of ``reverse``, ``perturb`` and ``morph`` (the duration), the phase of ``ellipses`` (that of the
    figure's legs). May be given otherwise: markers as ``parts`` of the body or as those to
    ``show``, the number of a mask's dots as ``signal_to_noise`` or ``dots_per_m2``, the blobs of
    ``blur`` as ``sd_deg``, or as ``sd_usual_mm`` on a walker whose dots reach 1.5 m, the walker of
    ``morph`` as a `Walker`. Two more names:
    ``"arm_swing"`` is the gain of elbows and wrists, ``"overground"`` the translation with a
    figure's own speed, in the middle of the picture at half time.
    """
    given = dict(parameters)
    if isinstance(given.get("figures"), int):
        given["figures"] = [given["figures"]]
    if name in _DEFAULTS:
        given = _DEFAULTS[name](situation, given)
    name = _SHORTHANDS.get(name, name)
    if name not in TRANSFORMS:
        known = sorted({*TRANSFORMS, *_SHORTHANDS})
        raise ValueError(f"There is no transform {name!r}; there are {known}.")
    return {**given, "name": name}


def _markers(given: Parameters, dots: tuple[str, ...]) -> list[str]:
    """Names of dots, from names, or from parts of the body."""
    groups = JOINTS.groups
    wanted = given.pop("parts", None)
    if wanted is not None:
        chosen = [wanted] if isinstance(wanted, str) else list(wanted)
        if unknown := [part for part in chosen if part not in groups and part not in dots]:
            known = ", ".join(dict.fromkeys([*groups, *dots]))
            raise ValueError(f"There is no part {unknown[0]!r}; there are {known}.")
        named = {name for part in chosen for name in groups.get(part, (part,))}
        return [dot for dot in dots if dot in named]
    named = given.pop("markers")
    return [named] if isinstance(named, str) else list(named)


def _with_markers(situation: Situation, given: Parameters) -> Parameters:
    dots = situation.moving(given).dots
    if "show" in given:
        shown = _markers({"parts": given.pop("show")}, dots)
        given["markers"] = [dot for dot in dots if dot not in shown]
    if "parts" in given or "markers" in given:
        given["markers"] = _markers(given, dots)
    return given


def _perturb(situation: Situation, given: Parameters) -> Parameters:
    return {"end_s": situation.duration_s, **_with_markers(situation, given)}


def _arm_swing(situation: Situation, given: Parameters) -> Parameters:
    dots = situation.moving(given).dots
    return {"markers": [dot for dot in ARM_SWING if dot in dots], **given}


def _overground(situation: Situation, given: Parameters) -> Parameters:
    motion = situation.figures[situation.number(given)].motion
    own = motion.speed_mm_s if isinstance(motion, Walker) else motion.attrs.get("speed_mm_s")
    speed = given.pop("speed_mm_s", own)
    if speed is None or not np.isfinite(speed):
        raise ValueError("The speed of this figure is not known; give speed_mm_s.")
    half = speed * situation.duration_s / 2
    return {"offset_mm": [-half, 0, 0], "velocity_mm_s": [speed, 0, 0], **given}


def _morph(situation: Situation, given: Parameters) -> Parameters:
    if isinstance(given.get("walker"), Walker):
        motion = situation.figures[situation.number(given)].motion
        phase = leg_phase(motion) if isinstance(motion, Walker) else None
        other = (
            given["walker"] if phase is None else beginning_at(given["walker"], np.rad2deg(phase))
        )
        given["walker"] = WalkerPart.of(other)
    return {"start_s": 0.0, "end_s": situation.duration_s, **given}


def _mask(situation: Situation, given: Parameters) -> Parameters:
    moving = situation.moving(given)
    given = {
        "figures": [situation.number(given)],
        "kind": "random",
        "box_mm": _box(situation, given, MASK_BOX),
        "centre_mm": moving.middle.round(3).tolist(),
        **given,
    }
    numbers = {"number", "signal_to_noise", "dots_per_m2"} & given.keys()
    if len(numbers) > 1:
        raise ValueError(f"The number of dots is given as {sorted(numbers)}; give one of them.")
    for name in numbers - {"number"}:
        if not 0 < float(check_numbers(given[name], name)) < np.inf:
            raise ValueError(f"{name}={given[name]!r} must be above 0.")
    if "signal_to_noise" in given:
        given["number"] = max(round(len(moving.dots) / given.pop("signal_to_noise")), 1)
    elif "dots_per_m2" in given:
        width, height = given["box_mm"]
        given["number"] = max(round(given.pop("dots_per_m2") * width * height / 1e6), 1)
    return given


def _phase_of_legs(situation: Situation, given: Parameters) -> float:
    """Phase of the left leg's swing at 0 s, degrees: ``sin(c + phase)`` is how far it is ahead."""
    moving, cycle = situation.moving(given), np.arange(64) / 64
    forward = moving.at(cycle * moving.period_s).positions[..., 0]
    left, right = moving.dots.index("left_ankle"), moving.dots.index("right_ankle")
    ahead = np.nan_to_num(forward[:, left] - forward[:, right])
    sine, cosine = ahead @ np.sin(2 * np.pi * cycle), ahead @ np.cos(2 * np.pi * cycle)
    return round(float(np.rad2deg(np.arctan2(cosine, sine))), 3)


def _box(situation: Situation, given: Parameters, shape: tuple[float, float]) -> list[float]:
    """Width and height of a box, mm, of a shape in heights of the figure; it lies if that lies."""
    seen = situation.moving(given).mean @ situation.view.axes[:2].T
    width, height = np.nanmax(seen, axis=0) - np.nanmin(seen, axis=0)
    box = [round(side * situation.height(given), 3) for side in shape]
    return box if height >= width else box[::-1]


def _blur(situation: Situation, given: Parameters) -> Parameters:
    """Blobs in degrees, or in mm on a walker of usual height that is as high in the picture."""
    if "sd_deg" in given:
        size = degrees_in_px(situation.display, given.pop("sd_deg"), "sd_deg")
        given["sd_px"] = round(size, 4)
    elif "sd_usual_mm" in given:
        height_px = situation.height(given) * situation.display.px_per_mm
        given["sd_px"] = round(given.pop("sd_usual_mm") * height_px / USUAL_HEIGHT_MM, 4)
    return given


def _computed(name: str, compute: Callable[[Situation, Parameters], Any]) -> _Resolver:
    """Return what fills in one parameter where it is left out."""

    def resolve(situation: Situation, given: Parameters) -> Parameters:
        return given if name in given else {name: compute(situation, given), **given}

    return resolve


_DEFAULTS: dict[str, _Resolver] = {
    **dict.fromkeys(("occlude", "gain", "delay"), _with_markers),
    "perturb": _perturb,
    "arm_swing": _arm_swing,
    "overground": _overground,
    "reverse": _computed("end_s", lambda situation, given: situation.duration_s),
    "morph": _morph,
    "scramble": _computed("box_mm", lambda situation, given: _box(situation, given, SCRAMBLE_BOX)),
    "blur": _blur,
    "mask": _mask,
    "ellipses": _computed("phase_deg", _phase_of_legs),
}
_SHORTHANDS = {"arm_swing": "gain", "overground": "translate"}
