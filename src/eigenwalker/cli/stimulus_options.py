"""Which options of ``stimulus`` go together: what has no effect is refused, or said."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

RIGS = (".bvh", ".glb")
RIG = ("skeleton", "rest_pose", "in_place", "rig_unit", "up")
AXIS = ("kind", "part", "components", "adjust")
PICTURE = ("view", "elevation", "eye_distance", "size", "height_deg", "dot_deg", "dot_px", "dot_mm")
SCREEN = ("distance", "px_per_cm")
ONE_WALKER = ("start_from", "information", *PICTURE, *SCREEN, "style", "blur", "mask")
POPULATION_ONLY = (
    *("trait", "start_from", "information", "morph_to", "size", "eye_distance", "crowd"),
    *("keep_size", "view", "elevation", "mapping", "with_flagged", *AXIS),
)
"""Options that a stimulus file does not take."""
MOST_STRIDES = 1000


def typed_options(context: Any) -> dict[str, Any]:
    """Return the options that are not left out."""
    source = context.get_parameter_source
    return {
        name: value
        for name, value in context.params.items()
        if (where := source(name)) is not None and where.name != "DEFAULT"
    }


def named(names: Iterable[str]) -> str:
    """Return options as they are typed: ``--dot-px and --dot-mm``."""
    return " and ".join(f"--{name.removeprefix('start_').replace('_', '-')}" for name in names)


def check_together(options: dict[str, Any], output: Path) -> None:
    """Refuse options that have no effect on each other, or contradict, before any work."""
    typed = options["typed"]
    has_rig = output.suffix.lower() in (RIGS if options["crowd"] is None else (".glb", ""))
    in_degrees = ("height_deg", "dot_deg", "dot_mm")
    start = str(options["start_from"])
    effects = (
        (AXIS, options["trait"] or options["morph_to"], "says how --trait moves; give --trait too"),
        (
            ("seed",),
            options["crowd"] is not None,
            "is for --crowd, which draws people; give it too",
        ),
        (
            ("mapping",),
            start != "average" and not start.isdecimal(),
            "names markers of a capture; give the capture too, with --from",
        ),
        (
            SCREEN,
            typed & set(in_degrees) or "deg" in (options["blur"] or ""),
            f"is for sizes in degrees or mm; give one, as with {named(in_degrees[:1])} 5",
        ),
        (RIG, has_rig, f"is for .bvh and .glb; {output} holds no rig"),
        (ONE_WALKER, options["crowd"] is None, "is for one walker, not for --crowd"),
    )
    for names, has_effect, reason in effects:
        if not has_effect and (idle := [name for name in names if name in typed]):
            raise ValueError(f"{named(idle[:1])} {reason}.")
    for one, other in (("strides", "duration"), ("dot_px", "dot_deg"), ("dot_px", "dot_mm"),
                       ("dot_deg", "dot_mm")):  # fmt: skip
        if {one, other} <= typed:
            raise ValueError(f"{named((one, other))} are both given; give one of them.")
    if (strides := options["strides"]) is not None and not 1 <= strides <= MOST_STRIDES:
        raise ValueError(f"--strides {strides}: expected 1 to {MOST_STRIDES}.")
    if has_rig and (idle := [name for name in PICTURE if name in typed]):
        print(f"eigenwalker: {output} is no picture: {named(idle)} has no effect.", file=sys.stderr)


def check_of_a_file(options: dict[str, Any]) -> None:
    """Refuse options that need a population, where a stimulus file is given."""
    if idle := [name for name in POPULATION_ONLY if name in options["typed"]]:
        file = options["people"].name
        raise ValueError(f"{named(idle[:1])} is for populations; {file} is a stimulus.")


def check_sizes(options: dict[str, Any]) -> None:
    """Refuse sizes on a screen that no screen has."""
    limits = {"height_deg": 180, "dot_deg": 180, "dot_px": 1000, "dot_mm": 1000,
              "distance": 1e6, "px_per_cm": 1e4}  # fmt: skip
    for name, most in limits.items():
        if options[name] is not None and not 0 < options[name] < most:
            expected = f"a number above 0 and below {most:g}"
            raise ValueError(f"{named((name,))}: expected {expected}, got {options[name]:g}.")
