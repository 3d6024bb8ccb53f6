"""What may be left out or said in other words when a transform is asked for in Python.

A stimulus file states numbers. Here they are worked out from the figures as they are at that place
of the chain.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.walker import Walker
from eigenwalker.plotting.projection import observer_axes
from eigenwalker.stimulus.figure import walker_to_dict
from eigenwalker.stimulus.moving_dots import Moving
from eigenwalker.stimulus.player import scene
from eigenwalker.stimulus.transforms import TRANSFORMS

if TYPE_CHECKING:
    from eigenwalker.stimulus.stimulus import Stimulus

Wish = dict[str, Any]
ARM_SWING = tuple(f"{side}_{joint}" for side in ("left", "right") for joint in ("elbow", "wrist"))
MASK_ROOM = (2.0, 1.15)
"""How much wider and higher than the figure the box of a mask is where none is given."""


def granted(stimulus: Stimulus, name: str, wish: Mapping[str, Any]) -> Wish:
    """Return a transform as it stands in a file.

    Parameters
    ----------
    stimulus : Stimulus
        Whose chain it is added to.
    name : str
        A transform, or ``"arm_swing"`` (the gain of elbows and wrists), ``"overground"`` (the
        translation with a figure's own speed, in the middle of the picture at half time).
    wish : mapping
        Its parameters. May be left out: the box of ``scramble`` (the figure's extent), the box of
        ``mask`` (twice as wide, 1.15 times as high) and its centre, the end of ``reverse``,
        ``perturb`` and ``morph`` (the duration), the phase of ``ellipses`` (that of the figure's
        legs). May be said otherwise: markers as ``parts`` of the body or as those to ``show``, the
        number of a mask's dots as ``signal_to_noise`` or ``dots_per_m2``, the walker of ``morph``
        as a `Walker`.

    """
    asked = dict(wish)
    if isinstance(asked.get("figures"), int):
        asked["figures"] = [asked["figures"]]
    if name in _WISHES:
        name, asked = _WISHES[name](stimulus, asked)
    if name not in TRANSFORMS:
        raise ValueError(
            f"There is no transform {name!r}; there are {sorted({*TRANSFORMS, *_WISHES})}."
        )
    return {**asked, "name": name}


def _figure(stimulus: Stimulus, asked: Wish) -> tuple[int, Moving]:
    number = (asked.get("figures") or [0])[0]
    figures = scene(stimulus.content)
    if not 0 <= number < len(stimulus.figures):
        raise ValueError(f"There is no figure {number}; there are {len(stimulus.figures)}.")
    return number, figures[number]


def _markers(asked: Wish, dots: tuple[str, ...]) -> list[str]:
    """Names of dots, from names, parts of the body, or those to be left to see."""
    groups = JOINTS.groups
    wanted = asked.pop("parts", None)
    if wanted is not None:
        chosen = [wanted] if isinstance(wanted, str) else list(wanted)
        if unknown := [part for part in chosen if part not in groups and part not in dots]:
            raise ValueError(f"There are no parts {unknown}; there are {[*groups, *dots]}.")
        named = {name for part in chosen for name in groups.get(part, (part,))}
        return [dot for dot in dots if dot in named]
    named = asked.pop("markers")
    return [named] if isinstance(named, str) else list(named)


def _with_markers(name: str) -> Callable[[Stimulus, Wish], tuple[str, Wish]]:
    def wish(stimulus: Stimulus, asked: Wish) -> tuple[str, Wish]:
        _, moving = _figure(stimulus, asked)
        if "show" in asked:
            shown = _markers({"parts": asked.pop("show")}, moving.dots)
            asked["markers"] = [dot for dot in moving.dots if dot not in shown]
        if "parts" in asked or "markers" in asked:
            asked["markers"] = _markers(asked, moving.dots)
        if name == "perturb":
            asked.setdefault("end_s", stimulus.timing.duration_s)
        return name, asked

    return wish


def _arm_swing(stimulus: Stimulus, asked: Wish) -> tuple[str, Wish]:
    _, moving = _figure(stimulus, asked)
    swinging = [dot for dot in ARM_SWING if dot in moving.dots]
    return "gain", {"markers": swinging, **asked}


def _overground(stimulus: Stimulus, asked: Wish) -> tuple[str, Wish]:
    number, _ = _figure(stimulus, asked)
    motion = stimulus.figures[number].motion
    usual = motion.speed_mm_s if isinstance(motion, Walker) else motion.attrs.get("speed_mm_s")
    speed = asked.pop("speed_mm_s", usual)
    if speed is None or not np.isfinite(speed):
        raise ValueError("The speed of this figure is not known; give speed_mm_s.")
    half = speed * stimulus.timing.duration_s / 2
    return "translate", {"offset_mm": [-half, 0, 0], "velocity_mm_s": [speed, 0, 0], **asked}


def _reverse(stimulus: Stimulus, asked: Wish) -> tuple[str, Wish]:
    return "reverse", {"end_s": stimulus.timing.duration_s, **asked}


def _morph(stimulus: Stimulus, asked: Wish) -> tuple[str, Wish]:
    if isinstance(asked.get("walker"), Walker):
        asked["walker"] = walker_to_dict(asked["walker"])
    return "morph", {"start_s": 0.0, "end_s": stimulus.timing.duration_s, **asked}


def _scramble(stimulus: Stimulus, asked: Wish) -> tuple[str, Wish]:
    if "box_mm" not in asked:
        _, moving = _figure(stimulus, asked)
        asked["box_mm"] = _extent(stimulus, moving)
    return "scramble", asked


def _mask(stimulus: Stimulus, asked: Wish) -> tuple[str, Wish]:
    number, moving = _figure(stimulus, asked)
    extent = _extent(stimulus, moving)
    box = [round(room * size) for room, size in zip(MASK_ROOM, extent, strict=True)]
    asked = {
        "figures": [number],
        "kind": "random",
        "box_mm": box,
        "centre_mm": moving.middle.round(3).tolist(),
        **asked,
    }
    if "signal_to_noise" in asked:
        asked["number"] = max(round(len(moving.dots) / asked.pop("signal_to_noise")), 1)
    elif "dots_per_m2" in asked:
        width, height = asked["box_mm"]
        asked["number"] = max(round(asked.pop("dots_per_m2") * width * height / 1e6), 1)
    return "mask", asked


def _ellipses(stimulus: Stimulus, asked: Wish) -> tuple[str, Wish]:
    if "phase_deg" not in asked:
        _, moving = _figure(stimulus, asked)
        asked["phase_deg"] = _phase_of_legs(moving)
    return "ellipses", asked


def _phase_of_legs(moving: Moving) -> float:
    """Where in its swing forward the left leg is at 0 s: ``sin(c + phase)`` is how far ahead."""
    cycle = np.arange(64) / 64
    places = moving.at(cycle * moving.period_s).positions[..., 0]
    left, right = moving.dots.index("left_ankle"), moving.dots.index("right_ankle")
    ahead = np.nan_to_num(places[:, left] - places[:, right])
    sine, cosine = ahead @ np.sin(2 * np.pi * cycle), ahead @ np.cos(2 * np.pi * cycle)
    return round(float(np.rad2deg(np.arctan2(cosine, sine))), 3)


def _extent(stimulus: Stimulus, moving: Moving) -> list[float]:
    """Width and height in the picture of a figure's mean posture, in whole millimetres."""
    axes = observer_axes(stimulus.view.view_deg, stimulus.view.elevation_deg)[:2]
    seen = moving.mean @ axes.T
    extent = np.nanmax(seen, axis=0) - np.nanmin(seen, axis=0)
    return np.maximum(np.ceil(extent), 100.0).tolist()


_WISHES: dict[str, Callable[[Stimulus, Wish], tuple[str, Wish]]] = {
    **{name: _with_markers(name) for name in ("occlude", "gain", "delay", "perturb")},
    "arm_swing": _arm_swing,
    "overground": _overground,
    "reverse": _reverse,
    "morph": _morph,
    "scramble": _scramble,
    "mask": _mask,
    "ellipses": _ellipses,
}
