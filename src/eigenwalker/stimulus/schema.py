"""What a stimulus file may hold: its parts, its schema, and what is amiss with one."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from eigenwalker.stimulus.fields import (
    Boolean,
    Choice,
    Field,
    Kind,
    List,
    Nullable,
    Number,
    Object,
    Refused,
    Text,
    Words,
)
from eigenwalker.stimulus.transforms import (
    DEG,
    FIGURES,
    MARKER_NAME,
    MOST_FIGURES,
    MOST_MARKERS,
    PLACE,
    TRANSFORMS,
    WALKER,
)

FORMAT = "eigenwalker stimulus"
VERSION = 1
MOST_SAMPLES = 3_000_000
"""Numbers in all sampled trajectories of a file."""
MOST_TRANSFORMS = 64
MOST_WORK = 1_000_000
"""Dots that may have to be computed for one moment."""
SAMPLE_LIMIT_MM = 1e7


@dataclass(frozen=True)
class Samples(Kind):
    """Numbers of shape (time, dot, 3), null where missing; kept as an array."""

    def checked(self, value: Any, where: str, amiss: list[str]) -> Any:
        """Return an array with NaN where a sample is missing."""
        fault = f"{where}: expected two frames or more of dots of x, y, z (numbers or null)"
        samples = value.astype(float) if isinstance(value, np.ndarray) else self._array(value)
        if samples is None or samples.ndim != 3 or samples.shape[2] != 3 or len(samples) < 2:
            amiss.append(fault)
            return None
        if samples.size > MOST_SAMPLES:
            amiss.append(f"{where}: expected {MOST_SAMPLES} numbers at most, got {samples.size}")
            return None
        if np.isinf(samples).any() or np.nanmax(np.abs(samples), initial=0) > SAMPLE_LIMIT_MM:
            amiss.append(f"{where}: expected numbers within {SAMPLE_LIMIT_MM:g} mm")
            return None
        if not (~np.isnan(samples)).all(axis=2).any():
            amiss.append(f"{where}: expected dots to be seen at some time, and none ever is")
            return None
        return samples

    def _array(self, value: Any) -> np.ndarray | None:
        if not isinstance(value, list | tuple) or len(value) > MOST_SAMPLES:
            return None
        try:
            flat = itertools.chain.from_iterable(itertools.chain.from_iterable(value))
            if not set(map(type, flat)) <= {int, float, type(None)}:
                return None
            return np.array(value, dtype=float)
        except (TypeError, ValueError, OverflowError):
            return None

    def schema(self) -> dict[str, Any]:
        """Return the JSON Schema."""
        place = List(Nullable(Number(-SAMPLE_LIMIT_MM, SAMPLE_LIMIT_MM)), 3, 3).schema()
        dots = {"type": "array", "items": place, "minItems": 1, "maxItems": MOST_MARKERS}
        return {"type": "array", "items": dots, "minItems": 2}


LINK = List(MARKER_NAME, 2, 2)
TRAJECTORIES = Object(
    {
        "markers": Field(List(MARKER_NAME, 1, MOST_MARKERS, distinct=True), "names of the dots"),
        "rate_hz": Field(Number(0, 10_000, above=0), "frames a second"),
        "repeat": Field(Boolean(), "whether it begins anew after the last frame", False),
        "samples": Field(Samples(), "frames of dots of x, y, z in mm; null is missing"),
        "speed_mm_s": Field(Nullable(Number(-1e5, 1e5)), "forward speed that was taken out", None),
    }
)
FIGURE = Object(
    {
        "walker": Field(Nullable(WALKER), "coefficients, for what is periodic", None),
        "trajectories": Field(Nullable(TRAJECTORIES), "samples, for what is not", None),
        "segments": Field(List(LINK, 0, 5000), "who is joined to whom", ()),
        "pairs": Field(List(LINK, 0, 500), "left dots with their right counterparts", ()),
        "position_mm": Field(PLACE, "where the figure's origin is in the scene", (0.0, 0.0, 0.0)),
        "heading_deg": Field(DEG, "by how much it is turned to its left", 0.0),
    }
)
VIEW = Object(
    {
        "view_deg": Field(DEG, "0 is the front, 90 in profile to the right", 0.0),
        "elevation_deg": Field(DEG, "of the observer above the horizontal", 0.0),
        "eye_distance_mm": Field(
            Nullable(Number(0, 1e7, above=0)), "from the centre; null for orthographic", None
        ),
        "centre_mm": Field(PLACE, "place of the scene in the middle of the picture"),
    }
)
TIMING = Object(
    {
        "duration_s": Field(Number(0, 3600, above=0), "how long it is shown"),
        "rate_hz": Field(Number(1, 1000), "frames a second of films and tables", 60.0),
    }
)
COLOUR = Text(7, 7, "#[0-9a-fA-F]{6}")
DISPLAY = Object(
    {
        "width_px": Field(Number(16, 8192, whole=True), "of the picture", 512),
        "height_px": Field(Number(16, 8192, whole=True), "of the picture", 512),
        "px_per_mm": Field(Number(0, 100, above=0), "pixels a millimetre of the walker"),
        "dot_px": Field(Number(0, 1000, above=0), "diameter of a dot", 8.0),
        "style": Field(Choice(("dots", "sticks", "mannequin")), "what is drawn", "dots"),
        "colour": Field(COLOUR, "of the figures", "#ffffff"),
        "background": Field(COLOUR, "of the rest", "#000000"),
        "viewing_distance_mm": Field(
            Nullable(Number(0, 1e6, above=0)), "from the observer's eye to the screen", None
        ),
        "px_per_cm": Field(Nullable(Number(0, 1e4, above=0)), "of the screen", None),
    }
)


@dataclass(frozen=True)
class Step(Kind):
    """A transform with its parameters."""

    def checked(self, value: Any, where: str, amiss: list[str]) -> Any:
        """Return a dict of the name and all parameters."""
        name = value.get("name") if isinstance(value, Mapping) else None
        if not isinstance(name, str) or name not in TRANSFORMS:
            amiss.append(
                f"{where}: expected the name of a transform among {list(TRANSFORMS)}, got "
                f"{str(name)[:40]!r}"
            )
            return None
        parameters = {key: given for key, given in value.items() if key != "name"}
        kept = self._object(name).checked(parameters, f"{where} ({name})", amiss)
        return None if kept is None else {"name": name, **kept}

    @staticmethod
    def _object(name: str) -> Object:
        return Object({**TRANSFORMS[name].fields, "figures": FIGURES})

    def schema(self) -> dict[str, Any]:
        """Return the JSON Schema."""
        kinds = []
        for name, transform in TRANSFORMS.items():
            schema = self._object(name).schema()
            about = (transform.function.__doc__ or "").split("\n\n")[0]
            kinds.append(
                {
                    "title": name,
                    "description": about,
                    **schema,
                    "properties": {"name": {"const": name}, **schema["properties"]},
                    "required": ["name", *schema["required"]],
                }
            )
        return {"oneOf": kinds}


STIMULUS = Object(
    {
        "format": Field(Choice((FORMAT,)), "what this file is"),
        "version": Field(Number(VERSION, VERSION, whole=True), "of the format"),
        "figures": Field(List(FIGURE, 1, MOST_FIGURES), "who is seen"),
        "transforms": Field(List(Step(), 0, MOST_TRANSFORMS), "what is done, in this order", ()),
        "view": Field(VIEW, "from where it is seen"),
        "timing": Field(TIMING, "how long"),
        "display": Field(DISPLAY, "how it is drawn"),
        "provenance": Field(Words(), "source, licence, program, citation ...", {}),
    }
)


def schema() -> dict[str, Any]:
    """Return the published JSON Schema of stimulus files (draft 2020-12)."""
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "eigenwalker stimulus",
        "description": (
            "Figures that move, the chain of transforms applied to them, and how they are shown. "
            "Millimetres, seconds, hertz; x forward, y to the walker's left, z up. "
            "docs/stimulus-format.md says what each transform does."
        ),
        **STIMULUS.schema(),
    }


def checked(content: Any) -> dict[str, Any]:
    """Return the content of a stimulus in its plain form, with defaults filled in.

    Raises
    ------
    ValueError
        If anything is amiss, saying all of it, up to twenty faults.

    """
    amiss: list[str] = []
    kept: Any = None
    try:
        kept = STIMULUS.checked(content, "stimulus", amiss)
        if not amiss:
            for number, figure in enumerate(kept["figures"]):
                _check_figure(figure, f"figures[{number}]", amiss)
        if not amiss:
            _check_chain(kept, amiss)
    except Refused:
        amiss.append("and more")
    if amiss:
        raise ValueError("This is no stimulus: " + "; ".join(amiss) + ".")
    return kept


def _check_figure(figure: dict[str, Any], where: str, amiss: list[str]) -> None:
    walker, trajectories = figure["walker"], figure["trajectories"]
    if (walker is None) == (trajectories is None):
        amiss.append(f"{where}: expected either walker or trajectories")
        return
    if walker is not None:
        _check_walker(walker, f"{where}.walker", amiss)
        markers = walker["markers"]
    else:
        markers = trajectories["markers"]
        if trajectories["samples"].shape[1] != len(markers):
            amiss.append(f"{where}: samples do not have {len(markers)} dots")
    linked = {name for link in (*figure["segments"], *figure["pairs"]) for name in link}
    if unknown := sorted(linked - set(markers)):
        amiss.append(f"{where}: segments or pairs name {unknown[:5]}, which are no markers of it")
    paired = [name for pair in figure["pairs"] for name in pair]
    if len(set(paired)) < len(paired):
        amiss.append(f"{where}: a marker stands in more than one pair")
    if any(one == other for one, other in figure["segments"]):
        amiss.append(f"{where}: a segment joins a marker to itself")


def _check_walker(walker: dict[str, Any], where: str, amiss: list[str]) -> None:
    n_markers = len(walker["markers"])
    lengths = {len(walker["p0"]), *(len(posture) for posture in walker["p"])}
    if lengths != {n_markers}:
        amiss.append(f"{where}: {n_markers} markers, but postures of {sorted(lengths)} dots")
    if not len(walker["p"]) == len(walker["harmonics"]) == len(walker["phases"]):
        amiss.append(
            f"{where}: {len(walker['p'])} postures ride on {len(walker['harmonics'])} harmonics "
            f"with {len(walker['phases'])} phases"
        )


def dots_computed(content: dict[str, Any]) -> int:
    """Return how many dots have to be computed for one moment of a stimulus that is checked."""
    return _check_chain(content, [])


def _check_chain(content: dict[str, Any], amiss: list[str]) -> int:
    """Follow the dots through the chain, where transforms must name dots that are there.

    Returns how many have to be computed for one moment.
    """
    figures = content["figures"]
    dots = [list((f["walker"] or f["trajectories"])["markers"]) for f in figures]
    segments = [len(figure["segments"]) for figure in figures]
    evaluations, added = [1] * len(figures), 0
    for number, step in enumerate(content["transforms"]):
        where = f"transforms[{number}] ({step['name']})"
        chosen = range(len(figures)) if step["figures"] is None else step["figures"]
        if max(chosen) >= len(figures):
            amiss.append(f"{where}: there are only {len(figures)} figures, counted from 0")
            return 0
        if TRANSFORMS[step["name"]].adds and len(chosen) > 1:
            amiss.append(f"{where}: name one figure, as in figures: [0]")
        for figure in chosen:
            amiss += _step_faults(step, where, dots[figure], segments[figure])
            match step["name"]:
                case "phase_scramble":
                    evaluations[figure] *= len(dots[figure])
                case "delay" | "morph":
                    evaluations[figure] *= 2
                case "limb_dots":
                    dots[figure] = [f"dot_{dot + 1}" for dot in range(step["number"])]
                    segments[figure] = 0
                    evaluations[figure] += 1
                case "mask":
                    clocks = step["number"] if step["phases"] else 1
                    added += step["number"] + clocks * evaluations[figure] * len(dots[figure])
    work = added + sum(n * len(names) for n, names in zip(evaluations, dots, strict=True))
    if work > MOST_WORK:
        amiss.append(
            f"its chain computes {work} dots for one moment, and no more than {MOST_WORK} are "
            "shown in time; use fewer dots or fewer transforms that give each dot a clock"
        )
    return work


def _step_faults(step: dict[str, Any], where: str, dots: list[str], n_segments: int) -> list[str]:
    faults = []
    if unknown := [name for name in step.get("markers", ()) if name not in dots]:
        faults.append(f"{where}: there are no dots {unknown[:5]}; there are {dots[:40]}")
    sides = [f"{side}_{joint}" for side in ("left", "right") for joint in ("shoulder", "hip")]
    match step["name"]:
        case "conflict" | "ellipses" if lacking := [s for s in sides if s not in dots]:
            faults.append(f"{where}: the figure lacks {lacking}")
        case "morph":
            _check_walker(step["walker"], f"{where}.walker", faults)
            if set(step["walker"]["markers"]) != set(dots):
                faults.append(f"{where}: the other walker has other dots than the figure")
            if not step["end_s"] > step["start_s"]:
                faults.append(f"{where}: it must end after it starts")
        case "speed" if step["factor"] == 0:
            faults.append(f"{where}: a factor of 0 stands still; use freeze")
        case "rotate" if not isinstance(step["axis"], str) and not any(step["axis"]):
            faults.append(f"{where}: an axis needs a length above 0")
        case "limb_dots" if step["places"] == "limbs" and not n_segments:
            faults.append(f"{where}: the figure has no segments to put dots on; use joints")
    return faults
