"""Sentences that name an argument of Python, in the words of another way into the program."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Mapping

_VALUE = (
    r"\"(?:[^\"\\]|\\.)*\"|'(?:[^'\\]|\\.)*'|\.\.\.|\([^()]*\)|\[[^\[\]]*\]"
    r"|[\w+-]+(?:\.\d+)?(?:e[+-]?\d+)?"
)
_CALL = re.compile(rf"\b[a-z_]+\(\.\.\., (?P<name>\w+)=(?P<value>{_VALUE}|[^()]*)\)")
_ARGUMENT = re.compile(rf"(?<![\w'\"])(?P<name>[a-z_]+)=(?P<value>{_VALUE})")
EXAMPLES = {"rate_hz": "30", "unit": "mm"}
"""Values to show where the sentence leaves them open, as in ``rate_hz=...``."""


def reworded(
    sentence: str,
    arguments: Mapping[str, str],
    python: str = "in Python, ",
    written: Callable[[str], str] = str,
) -> str:
    """Return a sentence in which arguments are named as they are given here.

    `arguments` has a text for each, with ``{value}`` in it where it takes one. A call with another
    argument stays as it is, after `python`, and so does what stands between quotation marks:
    that is what somebody typed, or is to type. `written` turns texts into words as they are typed.

    Examples
    --------
    >>> asked = "t.csv has no times; name the rate: read_mocap(..., rate_hz=30)."
    >>> reworded(asked, {"rate_hz": "--rate {value}"})
    't.csv has no times; name the rate: --rate 30.'
    """

    def here(found: re.Match[str], otherwise: str) -> str:
        known = arguments.get(found["name"])
        if known is None:
            return otherwise
        value = found["value"]
        if value == "...":
            value = EXAMPLES.get(found["name"], "")
        elif value[:1] in ("'", '"'):
            value = written(ast.literal_eval(value))
        return known.format(value=value).strip()

    sentence = _CALL.sub(lambda found: here(found, f"{python}{found[0]}"), sentence)
    return _ARGUMENT.sub(lambda found: here(found, found[0]), sentence)
