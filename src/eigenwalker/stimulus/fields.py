"""What may stand in a stimulus file: kinds of values that check themselves and know their schema.

One description of each value serves the check of files that anyone may have made, the defaults, and
the published JSON Schema.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

REQUIRED: Any = object()
"""Default of a field that must be given."""


class Refused(Exception):  # noqa: N818 - the name says what happened
    """Too much is amiss to look further."""


@dataclass(frozen=True)
class Kind:
    """A kind of value. `checked` returns it in its plain form and notes what is amiss."""

    def checked(self, value: Any, where: str, amiss: list[str]) -> Any:
        """Return the value as it is kept; add a sentence to `amiss` for each fault."""
        raise NotImplementedError

    def schema(self) -> dict[str, Any]:
        """Return the JSON Schema of such values."""
        raise NotImplementedError


@dataclass(frozen=True)
class Number(Kind):
    """A finite number between two limits, which belong to it."""

    low: float = -1e7
    high: float = 1e7
    whole: bool = False
    above: float | None = None

    def checked(self, value: Any, where: str, amiss: list[str]) -> Any:
        """Return a float, or an int of a whole number."""
        wanted = f"{'a whole number' if self.whole else 'a number'} {self._limits()}"
        if isinstance(value, bool) or not isinstance(value, int | float):
            return _note(amiss, where, wanted, value)
        try:
            number = float(value)
        except OverflowError:
            return _note(amiss, where, wanted, "one too large")
        within = self.low <= number <= self.high and (self.above is None or number > self.above)
        if not math.isfinite(number) or not within or (self.whole and number != int(number)):
            return _note(amiss, where, wanted, value)
        return int(value) if self.whole else number

    def _limits(self) -> str:
        low = f"above {self.above:g}" if self.above is not None else f"from {self.low:g}"
        return f"{low} to {self.high:g}"

    def schema(self) -> dict[str, Any]:
        """Return the JSON Schema of such numbers."""
        least = {"minimum": self.low} if self.above is None else {"exclusiveMinimum": self.above}
        return {"type": "integer" if self.whole else "number", **least, "maximum": self.high}


@dataclass(frozen=True)
class Boolean(Kind):
    """True or false."""

    def checked(self, value: Any, where: str, amiss: list[str]) -> Any:
        """Return the value."""
        return value if isinstance(value, bool) else _note(amiss, where, "true or false", value)

    def schema(self) -> dict[str, Any]:
        """Return the JSON Schema."""
        return {"type": "boolean"}


@dataclass(frozen=True)
class Text(Kind):
    """Words of limited length."""

    longest: int = 200
    shortest: int = 1
    pattern: str | None = None

    def checked(self, value: Any, where: str, amiss: list[str]) -> Any:
        """Return the words."""
        wanted = f"{self.shortest} to {self.longest} letters"
        if not isinstance(value, str) or not self.shortest <= len(value) <= self.longest:
            return _note(amiss, where, wanted, value)
        if self.pattern is not None:
            import re

            if not re.fullmatch(self.pattern, value):
                return _note(amiss, where, f"a text like {self.pattern}", value)
        if any(0xD800 <= ord(letter) <= 0xDFFF for letter in value):
            return _note(amiss, where, "text in Unicode", "half a letter")
        return value

    def schema(self) -> dict[str, Any]:
        """Return the JSON Schema."""
        like = {} if self.pattern is None else {"pattern": f"^{self.pattern}$"}
        return {"type": "string", "minLength": self.shortest, "maxLength": self.longest, **like}


@dataclass(frozen=True)
class Choice(Kind):
    """One of a few words."""

    words: tuple[str, ...]

    def checked(self, value: Any, where: str, amiss: list[str]) -> Any:
        """Return the word."""
        if isinstance(value, str) and value in self.words:
            return value
        return _note(amiss, where, f"one of {list(self.words)}", value)

    def schema(self) -> dict[str, Any]:
        """Return the JSON Schema."""
        return {"enum": list(self.words)}


@dataclass(frozen=True)
class Nullable(Kind):
    """A value that may also be null."""

    kind: Kind

    def checked(self, value: Any, where: str, amiss: list[str]) -> Any:
        """Return None, or the value as its kind keeps it."""
        return None if value is None else self.kind.checked(value, where, amiss)

    def schema(self) -> dict[str, Any]:
        """Return the JSON Schema."""
        return {"anyOf": [{"type": "null"}, self.kind.schema()]}


@dataclass(frozen=True)
class Either(Kind):
    """A list as the one kind says, or anything else as the other says."""

    list_kind: Kind
    other: Kind

    def checked(self, value: Any, where: str, amiss: list[str]) -> Any:
        """Return the value as its kind keeps it."""
        kind = self.list_kind if isinstance(value, list | tuple) else self.other
        return kind.checked(value, where, amiss)

    def schema(self) -> dict[str, Any]:
        """Return the JSON Schema."""
        return {"anyOf": [self.list_kind.schema(), self.other.schema()]}


@dataclass(frozen=True)
class List(Kind):
    """A list of values of one kind."""

    kind: Kind
    shortest: int = 0
    longest: int = 1000
    distinct: bool = False

    def checked(self, value: Any, where: str, amiss: list[str]) -> Any:
        """Return a tuple."""
        length = (
            f"{self.shortest}" if self.shortest == self.longest else
            f"{self.shortest} to {self.longest}"
        )  # fmt: skip
        if not isinstance(value, list | tuple):
            return _note(amiss, where, f"a list of {length} values", value)
        if not self.shortest <= len(value) <= self.longest:
            return _note(amiss, where, f"a list of {length} values", f"one of {len(value)}")
        kept = tuple(self.kind.checked(v, f"{where}[{i}]", amiss) for i, v in enumerate(value))
        if self.distinct and len(set(map(str, kept))) < len(kept):
            return _note(amiss, where, "values that differ from each other", "some twice")
        return kept

    def schema(self) -> dict[str, Any]:
        """Return the JSON Schema."""
        once = {"uniqueItems": True} if self.distinct else {}
        limits = {"minItems": self.shortest, "maxItems": self.longest}
        return {"type": "array", "items": self.kind.schema(), **limits, **once}


@dataclass(frozen=True)
class Words(Kind):
    """An object whose names are free and whose values are texts."""

    most: int = 30
    longest: int = 2000

    def checked(self, value: Any, where: str, amiss: list[str]) -> Any:
        """Return a dict."""
        if not isinstance(value, Mapping) or len(value) > self.most:
            return _note(amiss, where, f"an object of {self.most} texts at most", value)
        kind = Text(self.longest, shortest=0)
        return {
            Text(100).checked(name, where, amiss): kind.checked(text, f"{where}.{name}", amiss)
            for name, text in value.items()
        }

    def schema(self) -> dict[str, Any]:
        """Return the JSON Schema."""
        values = Text(self.longest, shortest=0).schema()
        return {"type": "object", "maxProperties": self.most, "additionalProperties": values}


@dataclass(frozen=True)
class Field:
    """A named value of an object: its kind, its default, and what it says."""

    kind: Kind
    about: str
    default: Any = REQUIRED


@dataclass(frozen=True)
class Object(Kind):
    """An object of known names; any other is refused."""

    fields: Mapping[str, Field]

    def checked(self, value: Any, where: str, amiss: list[str]) -> Any:
        """Return a dict of all fields, defaults filled in."""
        if not isinstance(value, Mapping):
            return _note(amiss, where, "an object", value)
        if unknown := [name for name in value if name not in self.fields]:
            known = list(self.fields)
            _note(amiss, where, f"no names but {known}", [str(name)[:40] for name in unknown[:5]])
        kept = {}
        for name, field in self.fields.items():
            if name in value:
                kept[name] = field.kind.checked(value[name], f"{where}.{name}", amiss)
            elif field.default is REQUIRED:
                _note(amiss, where, f"{name!r} ({field.about})", "none")
            else:
                kept[name] = field.default
        return kept

    def schema(self) -> dict[str, Any]:
        """Return the JSON Schema."""
        properties = {}
        for name, field in self.fields.items():
            properties[name] = {**field.kind.schema(), "description": field.about}
            if field.default is not REQUIRED:
                properties[name]["default"] = field.default
        required = [name for name, field in self.fields.items() if field.default is REQUIRED]
        return {
            "type": "object",
            "properties": properties,
            "required": required,
            "additionalProperties": False,
        }


MOST_FAULTS = 20


def _note(amiss: list[str], where: str, wanted: str, came: object) -> None:
    said = came if isinstance(came, str) and " " in came else repr(came)
    said = str(said)
    amiss.append(f"{where}: expected {wanted}, got {said if len(said) < 80 else said[:77] + '...'}")
    if len(amiss) >= MOST_FAULTS:
        raise Refused
