"""The walkers that a long fit has made so far, in a file from which an interrupted fit goes on.

A text file with one line of JSON a capture, to which lines are only added. A line that is cut short
or does not fit is ignored, and its capture is read again.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np

from eigenwalker.core.walker import CaptureFit, Walker


class Checkpoint:
    """The walkers that were made so far, by the names of their captures."""

    def __init__(self, path: Path, settings: Mapping[str, Any]) -> None:
        self.path = path
        self._settings = dict(settings)
        self._known: dict[str, dict] = {}
        self._whole_lines = True
        if path.is_file():
            text = path.read_text(encoding="utf-8", errors="replace")
            self._whole_lines = not text or text.endswith("\n")
            for line in text.splitlines():
                with suppress(ValueError, TypeError, KeyError, RecursionError):  # of a cut line
                    entry = json.loads(line)
                    if entry["settings"] == self._settings:
                        self._known[entry["file"]] = entry

    def get(self, name: str, state: list[int]) -> tuple[Walker, dict[str, Any]] | None:
        """Return the walker of a capture and its row of `Study.files`, if they are there."""
        entry = self._known.get(name, {})
        if entry.get("state") != state:
            return None
        try:
            return _walker(entry["walker"]), dict(entry["facts"])
        except (TypeError, ValueError, KeyError, AttributeError):
            return None

    def append(self, name: str, state: list[int], walker: Walker, row: Mapping) -> None:
        """Add the walker of a capture and its row of `Study.files`."""
        entry = {
            "file": name,
            "state": state,
            "settings": self._settings,
            "facts": dict(row),
            "walker": walker,
        }
        with self.path.open("a", encoding="utf-8") as file:
            start = "" if self._whole_lines else "\n"
            file.write(f"{start}{json.dumps(entry, default=_plain)}\n")
        self._whole_lines = True


def _plain(value: object) -> object:
    """Return a walker, its fit, or arrays and numbers of numpy in types of JSON."""
    if isinstance(value, Walker | CaptureFit):
        return {entry.name: getattr(value, entry.name) for entry in fields(value)}
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} cannot be written into a checkpoint.")


def _walker(entry: dict) -> Walker:
    fit = entry["fit"]
    if fit is not None:
        arrays = {name: np.array(value) for name, value in fit.items() if isinstance(value, list)}
        fit = CaptureFit(**(fit | arrays))
    return Walker(**{**entry, "fit": fit})
