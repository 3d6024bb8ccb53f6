"""The Python call that made a stimulus, as text for its provenance."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import xarray as xr

from eigenwalker.core.walker import Walker

LONGEST = 2000
"""Letters of one text in a stimulus file."""


def call_text(function: Callable[..., Any], given: Mapping[str, Any]) -> str:
    """Return a call with the arguments that are not the function's defaults."""
    parameters = inspect.signature(function).parameters
    texts = [
        value_text(given[name])
        if parameter.kind is parameter.POSITIONAL_OR_KEYWORD
        else f"{name}={value_text(given[name])}"
        for name, parameter in parameters.items()
        if name not in ("self", "provenance") and not _same(given[name], parameter.default)
    ]
    return f"{function.__name__}({', '.join(texts)})"


def with_call(provenance: Mapping[str, str], call: str) -> dict[str, str]:
    """Return provenance with one more call; a stimulus that was typed has its command instead."""
    if "command" in provenance:
        return dict(provenance)
    before = provenance.get("call")
    text = call if before is None else f"{before}.{call}"
    return {**provenance, "call": text if len(text) <= LONGEST else f"{text[: LONGEST - 1]}…"}


def _same(value: Any, default: Any) -> bool:
    return type(value) is type(default) and value == default


def value_text(value: Any) -> str:
    """Return an argument as text; walkers and trajectories by what they are."""
    if isinstance(value, xr.DataArray):
        return f"<trajectories of {value.sizes.get('time', 0)} frames>"
    if isinstance(value, Walker):
        return f"<{value!r}>"
    if isinstance(value, np.ndarray | np.generic):
        return repr(value.tolist())
    if isinstance(value, list | tuple):
        inside = ", ".join(map(value_text, value))
        return f"[{inside}]" if isinstance(value, list) else f"({inside})"
    if type(value).__module__.startswith("eigenwalker"):
        return f"<{type(value).__name__} of {value_text(getattr(value, 'motion', ''))}>"
    return repr(value)
