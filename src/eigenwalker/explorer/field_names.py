"""Messages in the words of the page: its fields in place of arguments of Python."""

from __future__ import annotations

import re

from eigenwalker.core.wording import reworded

_RATE = '"Frames a second" under "Who walks" on this page ({value})'
_UNIT = '"Unit of length" under "Who walks" on this page ({value})'
_NAMES = '"Marker names" under "Who walks" on this page'
FIELDS = {"rate_hz": _RATE, "default_rate_hz": _RATE, "unit": _UNIT, "default_unit": _UNIT}
FIELDS["mapping"] = _NAMES
"""Fields of the page that give arguments of Python, which messages name."""
_CALL = re.compile(r"\b[a-z]\w*[_.][\w.]*\((?:[^()]|\((?:[^()]|\([^()]*\))*\))*\)")
_PARTS = re.compile(r"((?<=[.!?]) |; )")


def in_fields(sentence: str) -> str:
    """Return a sentence that names fields of the page, without advice that only Python can take.

    Examples
    --------
    >>> in_fields("t.csv has no times; name the rate: read_mocap(..., rate_hz=30).")
    't.csv has no times; name the rate: "Frames a second" under "Who walks" on this page (30).'
    >>> in_fields("a.bvh is cut; copy it again, or take what is there: read_mocap(..., partial=1).")
    'a.bvh is cut; copy it again. More can be done with it in Python.'
    """
    sentence = reworded(sentence, FIELDS, python="")
    masked = _CALL.sub("\0", sentence)
    if "\0" not in masked:
        return sentence
    plain = ""
    texts = _PARTS.split(masked)
    for before, text in zip(["", *texts[1::2]], texts[::2], strict=True):
        advice, call, _ = text.partition("\0")
        part = advice.rpartition(", or ")[0] if call else text
        plain += (before if plain else "") + part if part else ""
    return f"{plain.rstrip('.')}. More can be done with it in Python.".lstrip(". ")
