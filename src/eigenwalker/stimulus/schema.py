"""What a stimulus file may hold, as models that check a file and give the published JSON Schema.

``python -m eigenwalker.stimulus.schema`` prints ``schema.json``.
"""

from __future__ import annotations

import json
import reprlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby
from typing import Annotated, Any, Literal, get_args

import numpy as np
from pydantic import BeforeValidator, ConfigDict, Field, ValidationError, model_validator
from pydantic.json_schema import GenerateJsonSchema

from eigenwalker.plotting.projection import observer_axes
from eigenwalker.stimulus.body_transforms import Conflict, Ellipses, Gain, Occlude, Perturb
from eigenwalker.stimulus.dot_transforms import Blur, LimbDots, Mask, Scramble, numbered
from eigenwalker.stimulus.figure import FigurePart
from eigenwalker.stimulus.spatial_transforms import Invert, Mirror, Resize, Rotate, Translate
from eigenwalker.stimulus.time_transforms import (
    Delay,
    Freeze,
    Morph,
    PhaseScramble,
    Reverse,
    Speed,
    Start,
)
from eigenwalker.stimulus.transform_types import (
    MAX_FIGURES,
    Degrees,
    KnownNames,
    Length,
    Part,
    Transform,
    Vector,
    about,
    problem,
    whole,
)

FORMAT = "eigenwalker stimulus"
VERSION = 1
MAX_TRANSFORMS = 64
MAX_WORK = 1_000_000
"""Dots that may have to be computed for one moment."""
MAX_PROBLEMS = 20
SHOULDERS_AND_HIPS = ("left_shoulder", "left_hip", "right_shoulder", "right_hip")

_Transforms = (
    Invert | Mirror | Rotate | Resize | Translate
    | Speed | Reverse | Start | Freeze | PhaseScramble | Delay | Morph
    | Occlude | Gain | Conflict | Ellipses | Perturb
    | Scramble | LimbDots | Blur | Mask
)  # fmt: skip
AnyTransform = Annotated[_Transforms, Field(discriminator="name")]
TRANSFORMS: dict[str, type[Transform]] = {
    get_args(kind.model_fields["name"].annotation)[0]: kind for kind in get_args(_Transforms)
}
"""Transforms by their names in files; `docs/stimulus-format.md` gives their formulas too."""
Pixels = Annotated[int, Field(strict=True, ge=16, le=8192), BeforeValidator(whole)]
Colour = Annotated[str, Field(strict=True, min_length=7, max_length=7, pattern="^#[0-9a-fA-F]{6}$")]
Style = Literal["dots", "sticks", "mannequin"]
ProvenanceName = Annotated[str, Field(strict=True, min_length=1, max_length=100)]
ProvenanceText = Annotated[str, Field(strict=True, max_length=2000)]


@dataclass(frozen=True, kw_only=True)
class View(KnownNames):
    """From where a stimulus is seen; see `project`. The centre is in the middle of the picture."""

    view_deg: Annotated[Degrees, about("0 is the front, 90 in profile to the right")] = 0.0
    elevation_deg: Annotated[Degrees, about("of the observer above the horizontal")] = 0.0
    eye_distance_mm: Annotated[
        Annotated[float, Field(strict=True, gt=0, le=1e7)] | None,
        about("from the centre; null for orthographic"),
    ] = None
    centre_mm: Annotated[Vector, about("place of the scene in the middle of the picture")]

    @cached_property
    def axes(self) -> np.ndarray:
        """The observer's right, up and the direction to the observer: rows of a rotation."""
        return observer_axes(self.view_deg, self.elevation_deg)


@dataclass(frozen=True, kw_only=True)
class Timing(KnownNames):
    """How long a stimulus is shown, and the frames a second of films and tables of it."""

    duration_s: Annotated[float, Field(strict=True, gt=0, le=3600), about("how long it is shown")]
    rate_hz: Annotated[
        float, Field(strict=True, ge=1, le=1000), about("frames a second of films and tables")
    ] = 60.0


@dataclass(frozen=True, kw_only=True)
class Display(KnownNames):
    """How a stimulus is drawn, and before what screen its observer sits."""

    width_px: Annotated[Pixels, about("of the picture")] = 512
    height_px: Annotated[Pixels, about("of the picture")] = 512
    px_per_mm: Annotated[
        float, Field(strict=True, gt=0, le=100), about("pixels a millimetre of the walker")
    ]
    dot_px: Annotated[float, Field(strict=True, gt=0, le=1000), about("diameter of a dot")] = 8.0
    style: Annotated[Style, about("what is drawn")] = "dots"
    colour: Annotated[Colour, about("of the figures")] = "#ffffff"
    background: Annotated[Colour, about("of the rest")] = "#000000"
    viewing_distance_mm: Annotated[
        Annotated[float, Field(strict=True, gt=0, le=1e6)] | None,
        about("from the observer's eye to the screen"),
    ] = None
    px_per_cm: Annotated[
        Annotated[float, Field(strict=True, gt=0, le=1e4)] | None, about("of the screen")
    ] = None


def _few(value: Any) -> Any:
    if isinstance(value, Mapping) and len(value) > 30:
        raise problem("expected an object of 30 texts at most")
    return value


class StimulusFile(Part):
    """Figures that move, the chain of transforms applied to them, and how they are shown.

    Millimetres, seconds, hertz; x forward, y to the walker's left, z up. docs/stimulus-format.md
    says what each transform does.

    See Also
    --------
    eigenwalker.write_stimulus : Writes the file.
    """

    model_config = ConfigDict(title=FORMAT)

    format: Literal["eigenwalker stimulus"] = Field(description="what this file is")
    version: Annotated[int, Field(strict=True, ge=VERSION, le=VERSION), BeforeValidator(whole)] = (
        Field(description="of the format")
    )
    figures: Annotated[tuple[FigurePart, ...], Length(1, MAX_FIGURES)] = Field(
        description="who is seen"
    )
    transforms: Annotated[tuple[AnyTransform, ...], Length(0, MAX_TRANSFORMS)] = Field(
        (), description="what is done, in this order"
    )
    view: View = Field(description="from where it is seen")
    timing: Timing = Field(description="how long")
    display: Display = Field(description="how it is drawn")
    provenance: Annotated[
        dict[ProvenanceName, ProvenanceText], Field(max_length=30), BeforeValidator(_few)
    ] = Field({}, description="source, licence, program, citation ...")

    @model_validator(mode="after")
    def _chain_fits(self) -> StimulusFile:
        _, problems = _follow_chain(self)
        if problems:
            raise problem("; ".join(problems))
        return self

    @property
    def dots_computed(self) -> int:
        """How many dots have to be computed for one moment."""
        return _follow_chain(self)[0]

    def to_dict(self) -> dict[str, Any]:
        """Return the content as JSON has it, with all defaults filled in."""
        content = self.model_dump(mode="json")
        for figure in content["figures"]:
            del figure["trajectories" if figure["trajectories"] is None else "walker"]
        return {**content, "transforms": [step.to_dict() for step in self.transforms]}


def _follow_chain(file: StimulusFile) -> tuple[int, list[str]]:
    """Follow the dots through the chain, where transforms must name dots that are there.

    Returns how many dots have to be computed for one moment, and what does not fit.
    """
    figures = file.figures
    dots = [list(figure.motion.markers) for figure in figures]
    segments = [len(figure.segments) for figure in figures]
    evaluations, added, problems = [1] * len(figures), 0, []
    for number, step in enumerate(file.transforms):
        where = f"transforms[{number}] ({step.name})"
        chosen = range(len(figures)) if step.figures is None else step.figures
        if max(chosen) >= len(figures):
            return 0, [f"{where}: there are only {len(figures)} figures, counted from 0"]
        if step.adds_dots and len(chosen) > 1:
            problems.append(f"{where}: name one figure, as in figures: [0]")
        for figure in chosen:
            problems += [
                f"{where}: {one}" for one in _misfits(step, dots[figure], segments[figure])
            ]
            match step:
                case PhaseScramble():
                    evaluations[figure] *= len(dots[figure])
                case Delay() | Morph():
                    evaluations[figure] *= 2
                case LimbDots():
                    dots[figure] = list(numbered("dot", step.number))
                    segments[figure] = 0
                    evaluations[figure] += 1
                case Mask():
                    clocks = step.number if step.phases else 1
                    added += step.number + clocks * evaluations[figure] * len(dots[figure])
    work = added + sum(n * len(names) for n, names in zip(evaluations, dots, strict=True))
    if work > MAX_WORK:
        problems.append(
            f"its chain computes {work} dots for one moment, and no more than {MAX_WORK} are "
            "shown in time; use fewer dots or fewer transforms that give each dot a clock"
        )
    return work, problems


def _misfits(step: Transform, dots: Sequence[str], n_segments: int) -> list[str]:
    """What a transform needs of a figure that the figure does not have."""
    match step:
        case Occlude() | Gain() | Delay() | Perturb():
            if unknown := [name for name in step.markers if name not in dots]:
                return [f"there are no dots {unknown[:5]}; there are {dots[:40]}"]
        case Conflict() | Ellipses():
            if lacking := [name for name in SHOULDERS_AND_HIPS if name not in dots]:
                return [f"the figure lacks {lacking}"]
        case Morph() if set(step.walker.markers) != set(dots):
            return ["the other walker has other dots than the figure"]
        case LimbDots(places="limbs") if not n_segments:
            return ["the figure has no segments to put dots on; use joints"]
    return []


def checked(content: Any) -> StimulusFile:
    """Return the content of a stimulus file, checked, with all defaults filled in.

    Raises ValueError with up to twenty problems: the place of each, what was expected, what is
    there.
    """
    try:
        return StimulusFile.model_validate(content)
    except ValidationError as error:
        raise ValueError("This is no stimulus: " + "; ".join(_problems(error)) + ".") from None


EXPECTED = {
    "missing": "a value",
    "float_type": "a number",
    "int_type": "a whole number",
    "greater_than": "a number above {gt:g}",
    "greater_than_equal": "a number from {ge:g}",
    "less_than_equal": "a number up to {le:g}",
    "bool_type": "true or false",
    "string_type": "a text",
    "string_unicode": "text in Unicode",
    "string_too_short": "{min_length} letters at least",
    "string_too_long": "{max_length} letters at most",
    "string_pattern_mismatch": "a text like {pattern}",
    "literal_error": "{expected}",
    "union_tag_invalid": f"the name of a transform among {list(TRANSFORMS)}",
    "union_tag_not_found": f"the name of a transform among {list(TRANSFORMS)}",
    **dict.fromkeys(
        ("dict_type", "model_type", "dataclass_type", "model_attributes_type"), "an object"
    ),
}
"""What was expected, by pydantic's types of errors."""


def _problems(error: ValidationError) -> list[str]:
    """Return a sentence for each place that is wrong."""
    errors = error.errors(include_url=False)[: MAX_PROBLEMS + 1]
    sentences = []
    for place, group in groupby(errors, lambda one: _place(one["loc"])):
        several = list(group)
        if len(several) == 1 and several[0]["type"] == "stimulus":
            sentences.append(place + several[0]["msg"])
            continue
        expected = [
            EXPECTED.get(one["type"], one["msg"]).format(**one.get("ctx", {}))
            for one in several
            if one["type"] != "stimulus"
        ]
        got = several[0]["input"]
        if several[0]["type"].startswith("union_tag"):
            got = got.get("name")
        got = "none" if several[0]["type"] == "missing" else reprlib.repr(got)
        sentences.append(f"{place}expected {' or '.join(expected)}, got {got}")
    return sentences[:MAX_PROBLEMS] + ["and more"] * (len(sentences) > MAX_PROBLEMS)


def _place(path: Sequence[str | int]) -> str:
    """Write the place of a value in a file, as in ``stimulus.transforms[0] (speed).factor: ``."""
    place = "stimulus"
    for depth, step in enumerate(path):
        if isinstance(step, int):
            place += f"[{step}]"
        elif depth == 2 and path[0] == "transforms":
            place += f" ({step})"
        elif "[" not in step:  # as in the names of the members of a union
            place += f".{step[:40]}"
    return f"{place}: " if path else ""


class _PlainSchema(GenerateJsonSchema):
    """A schema without titles of fields, which any validator of JSON Schema reads."""

    def field_title_should_be_set(self, schema: Any) -> bool:
        return False

    def tagged_union_schema(self, schema: Any) -> dict[str, Any]:
        union = super().tagged_union_schema(schema)
        del union["discriminator"]["mapping"]
        return union


def json_schema() -> dict[str, Any]:
    """Return the published JSON Schema of stimulus files (draft 2020-12)."""
    schema = StimulusFile.model_json_schema(schema_generator=_PlainSchema)
    return {"$schema": GenerateJsonSchema.schema_dialect, **schema}


def _folded(value: Any, indent: str = "") -> str:
    """Write JSON with what fits into a line in one line."""
    line = json.dumps(value)
    if len(indent) + len(line) <= 100 or not isinstance(value, dict | list):
        return line
    deeper = indent + " "
    if isinstance(value, list):
        parts = [_folded(item, deeper) for item in value]
    else:
        parts = [f"{json.dumps(name)}: {_folded(item, deeper)}" for name, item in value.items()]
    opening, closing = "[]" if isinstance(value, list) else "{}"
    return f"{opening}\n{deeper}" + f",\n{deeper}".join(parts) + f"\n{indent}{closing}"


if __name__ == "__main__":
    print(_folded(json_schema()))
