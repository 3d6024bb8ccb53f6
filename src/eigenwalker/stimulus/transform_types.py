"""What stimulus files are made of: kinds of values, objects of known names, and transforms."""

from __future__ import annotations

import functools
import reprlib
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, NamedTuple

import numpy as np
from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    GetCoreSchemaHandler,
    model_validator,
)
from pydantic_core import CoreSchema, PydanticCustomError, core_schema
from typing_extensions import TypeAliasType

from eigenwalker.stimulus.moving_dots import MovingDots

MAX_MARKERS = 1000
MAX_FIGURES = 64
MAX_DOTS = 5000
"""Dots that one transform may make."""
MAX_REPORTED_PER_LIST = 64
"""Longer lists are checked up to their first wrong value only."""


def problem(message: str) -> PydanticCustomError:
    """Return the error that a validator raises to say what is wrong with a value."""
    return PydanticCustomError("stimulus", "{message}", {"message": message})


@dataclass(frozen=True)
class Length:
    """How many values a list may have, and whether they must differ.

    Checked before the values are, so that the time that a hostile file takes is bounded.
    """

    least: int
    most: int
    distinct: bool = False

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        schema = {**handler(source), "fail_fast": self.most > MAX_REPORTED_PER_LIST}
        return core_schema.no_info_before_validator_function(self._check, schema)  # pyright: ignore[reportArgumentType] - the schema of a tuple

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: Any) -> dict[str, Any]:
        different = {"uniqueItems": True} if self.distinct else {}
        return {**handler(schema), "minItems": self.least, "maxItems": self.most, **different}

    def _check(self, values: Any) -> Any:
        limits = f"{self.least}" if self.least == self.most else f"{self.least} to {self.most}"
        if not isinstance(values, list | tuple):
            raise problem(f"expected a list of {limits} values, got {reprlib.repr(values)}")
        if not self.least <= len(values) <= self.most:
            raise problem(f"expected a list of {limits} values, got one of {len(values)}")
        if self.distinct and len(set(map(str, values))) < len(values):
            raise problem("expected values that differ from each other, got some twice")
        return values


def check_names(kind: type, value: Any) -> Any:
    """Refuse an object of a file that has other names than the fields of its class."""
    if isinstance(value, Mapping):
        names = list(getattr(kind, "model_fields", None) or kind.__dataclass_fields__)
        if unknown := [str(name)[:40] for name in value if name not in names]:
            raise problem(f"expected no names but {names}, got {unknown[:5]}")
    return value


class KnownNames:
    """A dataclass whose fields are the names of an object in a file; others are refused."""

    __pydantic_config__ = ConfigDict(extra="forbid")

    @classmethod
    def __get_pydantic_core_schema__(cls, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        check = functools.partial(check_names, cls)
        return core_schema.no_info_before_validator_function(check, handler(source))


def _first_paragraph(schema: dict[str, Any]) -> None:
    schema["description"] = schema.get("description", "").split("\n\n")[0]


class Part(BaseModel):
    """A part of a stimulus file."""

    model_config = ConfigDict(
        extra="forbid", frozen=True, defer_build=True, json_schema_extra=_first_paragraph
    )

    @model_validator(mode="before")
    @classmethod
    def _names_are_known(cls, value: Any) -> Any:
        return check_names(cls, value)


def whole(value: Any) -> Any:
    """Return a number without decimals as an int, as JSON does not tell 3.0 from 3."""
    return int(value) if isinstance(value, float) and value.is_integer() else value


def about(text: str) -> Any:
    """Return what gives a field its description in the schema."""
    return Field(description=text)


Millimetres = Annotated[float, Field(strict=True, ge=-1e6, le=1e6)]
Degrees = Annotated[float, Field(strict=True, ge=-1e6, le=1e6)]
Seconds = Annotated[float, Field(strict=True, ge=-1e5, le=1e5)]
Lifetime = Annotated[float, Field(strict=True, gt=0, le=3600)] | None
Frequency = Annotated[float, Field(strict=True, gt=0, le=100)]
Speed = Annotated[float, Field(strict=True, ge=-1e5, le=1e5)]
Factor = Annotated[float, Field(strict=True, ge=-100, le=100)]
Share = Annotated[float, Field(strict=True, ge=0, le=1)]
Seed = Annotated[int, Field(strict=True, ge=0, le=2**32 - 1), BeforeValidator(whole)]
DotCount = Annotated[int, Field(strict=True, ge=1, le=MAX_DOTS), BeforeValidator(whole)]
Harmonic = Annotated[int, Field(strict=True, ge=1, le=64), BeforeValidator(whole)]
FigureNumber = Annotated[int, Field(strict=True, ge=0, le=MAX_FIGURES - 1), BeforeValidator(whole)]
Vector = TypeAliasType("Vector", Annotated[tuple[Millimetres, ...], Length(3, 3)])
MarkerName = Annotated[str, Field(strict=True, min_length=1, max_length=100)]
Markers = TypeAliasType(
    "Markers", Annotated[tuple[MarkerName, ...], Length(1, MAX_MARKERS, distinct=True)]
)
BoxSize = Annotated[tuple[Annotated[float, Field(strict=True, gt=0, le=1e6)], ...], Length(2, 2)]
Switch = Annotated[bool, Field(strict=True)]


FigureNumbers = TypeAliasType(
    "FigureNumbers", Annotated[tuple[FigureNumber, ...], Length(1, MAX_FIGURES, distinct=True)]
)


class Context(NamedTuple):
    """What a transform knows in addition to the dots that it changes.

    The observer's right, up and the direction to the observer, rows of a matrix in the figure's own
    frame; and the figure's number, from 0: figures of one scene draw different random numbers.
    """

    observer: np.ndarray
    figure: int


class Transform(Part, ABC):
    """A change of a figure. Its fields are what a stimulus file states."""

    figures: Annotated[
        FigureNumbers | None,
        about("numbers of the figures it acts on; null for all"),
    ] = None
    adds_dots: ClassVar[bool] = False
    """Whether the result joins the scene, rather than taking the figure's place."""

    name: Any

    @classmethod
    def parameter_names(cls) -> list[str]:
        """Return the names of the parameters, in their order."""
        return [name for name in cls.model_fields if name not in ("name", "figures")]

    def to_dict(self) -> dict[str, Any]:
        """Return the transform as it stands in a file: its name, its parameters, its figures."""
        content = self.model_dump(mode="json")
        figures = content.pop("figures")
        return {"name": content.pop("name"), **content, "figures": figures}

    @abstractmethod
    def apply(self, moving: MovingDots, context: Context) -> MovingDots:
        """Return the changed figure."""
