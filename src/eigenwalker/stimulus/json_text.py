"""The text of a stimulus file, written so that a person can read it, and read with care."""

from __future__ import annotations

import json
from typing import Any

import numpy as np

MAX_BYTES = 64_000_000


def written(content: dict[str, Any]) -> str:
    """Return content as JSON: one part a line, and one figure and one transform a line."""
    lines = []
    for name, part in content.items():
        if isinstance(part, list) and part:
            items = ",\n  ".join(map(_compact, part))
            lines.append(f'"{name}": [\n  {items}\n]')
        else:
            lines.append(f'"{name}": {_compact(part)}')
    return "{\n" + ",\n".join(lines) + "\n}\n"


def plain(content: Any) -> Any:
    """Return content as JSON would give it back: lists, and None where a sample is missing."""
    if isinstance(content, dict):
        return {name: plain(part) for name, part in content.items()}
    if isinstance(content, list | tuple):
        return [plain(part) for part in content]
    if isinstance(content, np.ndarray):
        values = content.astype(object)
        values[np.isnan(content)] = None
        return values.tolist()
    return content


def parsed(text: str) -> Any:
    """Return the content of a text of JSON.

    Raises
    ------
    ValueError
        If it is no JSON, is nested without end, has a name twice or a number that is not finite.

    """
    if len(text) > MAX_BYTES:
        raise ValueError(f"A stimulus has {MAX_BYTES} letters at most; this has {len(text)}.")
    try:
        return json.loads(text, parse_constant=_refuse_constant, object_pairs_hook=_refuse_twice)
    except RecursionError:
        raise ValueError("A stimulus is not nested that deeply.") from None
    except ValueError as error:
        raise ValueError(f"This is no JSON of a stimulus: {error}.") from None


def _compact(part: Any) -> str:
    return json.dumps(part, separators=(",", ":"), allow_nan=False, ensure_ascii=False)


def _refuse_constant(name: str) -> Any:
    raise ValueError(f"it has a number {name}, and numbers must be finite")


def _refuse_twice(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    kept = dict(pairs)
    if len(kept) < len(pairs):
        raise ValueError("an object has one name twice")
    return kept
