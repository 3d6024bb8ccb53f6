"""Every transform by its name in a stimulus file, with what it takes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple

from eigenwalker.stimulus import (
    body_transforms as body,
    dot_transforms as scattered,
    spatial_transforms as space,
    time_transforms as clocks,
)
from eigenwalker.stimulus.fields import (
    Boolean,
    Choice,
    Either,
    Field,
    List,
    Nullable,
    Number,
    Object,
    Text,
)
from eigenwalker.stimulus.moving_dots import Moving

MOST_MARKERS = 1000
MOST_FIGURES = 64
MOST_DOTS = 5000
"""Of one transform."""


class Transform(NamedTuple):
    """A way to change a moving figure.

    Parameters
    ----------
    function : callable
        Takes the figure, the stage and the parameters; returns the changed figure.
    fields : mapping of str to Field
        The parameters.
    adds : bool
        Whether what it returns joins the scene, rather than taking the figure's place.

    """

    function: Callable[..., Moving]
    fields: Mapping[str, Field]
    adds: bool = False


MM, DEG = Number(-1e6, 1e6), Number(-1e6, 1e6)
FACTOR = Number(-100, 100)
SEED = Field(Number(0, 2**32 - 1, whole=True), "seed of what is drawn at random")
MARKER_NAME = Text(100)
MARKERS = Field(List(MARKER_NAME, 1, MOST_MARKERS, distinct=True), "names of dots")
PLACE = List(MM, 3, 3)
BOX = Field(List(Number(0, 1e6, above=0), 2, 2), "width and height in the picture, mm")
LIFETIME = Nullable(Number(0, 3600, above=0))
TIME = Number(-1e5, 1e5)
FREQUENCY = Number(0, 100, above=0)

WALKER = Object(
    {
        "markers": Field(List(MARKER_NAME, 1, MOST_MARKERS, distinct=True), "names of the dots"),
        "p0": Field(List(PLACE, 1, MOST_MARKERS), "mean posture: for each dot x, y, z in mm"),
        "p": Field(
            List(List(PLACE, 1, MOST_MARKERS), 0, 64), "postures that ride on sines: the same each"
        ),
        "harmonics": Field(List(Number(1, 64, whole=True), 0, 64), "multiple of the frequency"),
        "phases": Field(List(Number(-1e3, 1e3), 0, 64), "radians at 0 s"),
        "frequency_hz": Field(FREQUENCY, "strides a second"),
        "form": Field(Choice(("eigenposture", "fourier")), "what was free", "eigenposture"),
        "speed_mm_s": Field(Nullable(Number(-1e5, 1e5)), "forward speed that was taken out", None),
    }
)
"""A walker: p0 + sum_i p_i sin(harmonic_i 2 pi f t + phase_i)."""

TRANSFORMS: dict[str, Transform] = {
    "invert": Transform(space.invert, {}),
    "mirror": Transform(space.mirror, {}),
    "rotate": Transform(
        space.rotate,
        {
            "axis": Field(
                Either(PLACE, Choice(("x", "y", "z", "sight"))), "named axis or a vector", "z"
            ),
            "angle_deg": Field(DEG, "by how much, right-handed", 0.0),
            "speed_deg_s": Field(Number(-1e4, 1e4), "how fast it turns on", 0.0),
        },
    ),
    "resize": Transform(
        space.resize, {"factor": Field(Number(0, 100, above=0), "how much larger")}
    ),
    "translate": Transform(
        space.translate,
        {
            "offset_mm": Field(PLACE, "forward, left, up", (0.0, 0.0, 0.0)),
            "velocity_mm_s": Field(PLACE, "forward, left, up", (0.0, 0.0, 0.0)),
        },
    ),
    "speed": Transform(clocks.speed, {"factor": Field(FACTOR, "how much faster; not 0")}),
    "reverse": Transform(clocks.reverse, {"end_s": Field(TIME, "the moment it begins with")}),
    "start": Transform(clocks.start, {"phase_deg": Field(DEG, "how far in the cycle it begins")}),
    "freeze": Transform(clocks.freeze, {"time_s": Field(TIME, "the moment shown", 0.0)}),
    "phase_scramble": Transform(
        clocks.phase_scramble,
        {"seed": SEED, "spread": Field(Number(0, 1), "share of the cycle clocks differ by", 1.0)},
    ),
    "delay": Transform(
        clocks.delay, {"markers": MARKERS, "phase_deg": Field(DEG, "share of the cycle they lag")}
    ),
    "morph": Transform(
        clocks.morph,
        {
            "walker": Field(WALKER, "into whom"),
            "start_s": Field(TIME, "when it begins"),
            "end_s": Field(TIME, "when it has passed, after the start"),
        },
    ),
    "occlude": Transform(body.occlude, {"markers": MARKERS}),
    "gain": Transform(
        body.gain,
        {
            "markers": MARKERS,
            "factor": Field(FACTOR, "how much larger the movement"),
            "axes": Field(Choice(("x", "y", "z", "xy", "xz", "yz", "xyz")), "of it", "xyz"),
        },
    ),
    "conflict": Transform(
        body.conflict,
        {
            "shoulder_width": Field(FACTOR, "factor", 1.0),
            "hip_width": Field(FACTOR, "factor", 1.0),
            "shoulder_sway": Field(FACTOR, "factor", 1.0),
            "hip_sway": Field(FACTOR, "factor", 1.0),
        },
    ),
    "ellipses": Transform(
        body.ellipses,
        {
            "shoulder_mm": Field(List(MM, 2, 2), "semi-axes forward and up"),
            "hip_mm": Field(List(MM, 2, 2), "semi-axes forward and up"),
            "phase_deg": Field(DEG, "of the left hip at 0 s", 0.0),
        },
    ),
    "perturb": Transform(
        body.perturb,
        {
            "markers": MARKERS,
            "amount_mm": Field(PLACE, "forward, left, up"),
            "frequency_hz": Field(Number(0, 1000), "of the sine"),
            "phase_deg": Field(DEG, "of the sine when it begins", 0.0),
            "start_s": Field(TIME, "when it begins", 0.0),
            "end_s": Field(TIME, "when it is over", 1e5),
        },
    ),
    "scramble": Transform(
        scattered.scramble,
        {
            "seed": SEED,
            "keep": Field(Choice(("nothing", "structure")), "what of the places", "nothing"),
            "box_mm": BOX,
            "directions": Field(Choice(("both", "horizontal", "vertical")), "that change", "both"),
        },
    ),
    "limb_dots": Transform(
        scattered.limb_dots,
        {
            "number": Field(Number(1, MOST_DOTS, whole=True), "how many dots"),
            "lifetime_s": Field(LIFETIME, "how long each lives; null for ever"),
            "asynchrony": Field(Number(0, 1), "0 all anew at once, 1 one after the other", 1.0),
            "places": Field(Choice(("limbs", "joints")), "where they are", "limbs"),
            "seed": SEED,
        },
    ),
    "blur": Transform(
        scattered.blur, {"sd_mm": Field(Number(0, 1e4), "standard deviation of the blobs")}
    ),
    "mask": Transform(
        scattered.mask,
        {
            "kind": Field(Choice(("random", "linear", "scrambled")), "how the dots move"),
            "number": Field(Number(1, MOST_DOTS, whole=True), "how many dots"),
            "box_mm": BOX,
            "centre_mm": Field(PLACE, "of the box, in the scene", (0.0, 0.0, 0.0)),
            "lifetime_s": Field(LIFETIME, "how long each stays; null for ever", None),
            "speed_mm_s": Field(Number(0, 1e5), "of linear motion", 0.0),
            "direction_deg": Field(Nullable(DEG), "of linear motion; null for any", None),
            "phases": Field(Boolean(), "whether scrambled dots have clocks of their own", False),
            "seed": SEED,
        },
        adds=True,
    ),
}
"""Transforms by name; `docs/stimulus-format.md` gives their formulas too."""
FIGURES = Field(
    Nullable(List(Number(0, MOST_FIGURES - 1, whole=True), 1, MOST_FIGURES, distinct=True)),
    "numbers of the figures it acts on; null for all",
    None,
)
