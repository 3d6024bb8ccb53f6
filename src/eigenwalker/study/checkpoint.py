"""The walkers that a long fit has made so far, in a file from which an interrupted fit goes on.

A text file to which lines are only added. The first is the head: folder, settings and program of
the fit. Each other line is the walker of one capture in JSON, after a checksum of it and the head.
A line whose checksum does not hold is ignored, and its capture is read again; so are all where the
head is another.
"""

from __future__ import annotations

import hashlib
import json
import warnings
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np

from eigenwalker._version import __version__
from eigenwalker.core.walker import CaptureFit, Walker

FORMAT = "eigenwalker checkpoint 2"


class Checkpoint:
    """The walkers that were made so far, by the names of their captures."""

    def __init__(self, path: Path, folder: Path, settings: Mapping[str, Any]) -> None:
        self.path = path
        head = {"format": FORMAT, "program": __version__, "folder": str(folder.resolve())}
        self._head = json.dumps({**head, "settings": dict(settings)}, sort_keys=True).encode()
        self._known: dict[str, dict[str, Any]] = {}
        self._goes_on = self._given_up = False
        if path.is_file():
            head, *lines = path.read_bytes().split(b"\n")
            self._goes_on = head == self._head
            for checksum, _, body in (line.partition(b" ") for line in lines if self._goes_on):
                if checksum == self._checksum(body):
                    entry = json.loads(body)
                    self._known[entry["file"]] = entry

    def _checksum(self, body: bytes) -> bytes:
        return hashlib.sha256(self._head + b"\n" + body).hexdigest().encode()

    def get(self, name: str, state: list[int]) -> tuple[Walker, dict[str, Any]] | None:
        """Return the walker of a capture and its row of `Study.files`, if they are there."""
        entry = self._known.get(name, {})
        return (_walker(entry["walker"]), entry["facts"]) if entry.get("state") == state else None

    def append(self, name: str, state: list[int], walker: Walker, row: Mapping) -> None:
        """Add the walker of a capture and its row of `Study.files`.

        Where that is not possible, as on a full disk, a warning says so and the fit goes on.
        """
        if self._given_up:
            return
        entry = {"file": name, "state": state, "facts": dict(row), "walker": walker}
        body = json.dumps(entry, default=_plain).encode()
        line = b"\n" + self._checksum(body) + b" " + body + b"\n"  # ends one that was cut short
        try:
            with self.path.open("ab" if self._goes_on else "wb") as file:
                file.write(line if self._goes_on else self._head + line)
            self._goes_on = True
        except OSError as error:
            self._given_up = True
            with suppress(OSError):
                self.path.unlink()
            warnings.warn(
                f"{self.path}: {error.strerror}. What was read is not kept, so that the same "
                "command starts from the beginning if it is interrupted.",
                stacklevel=2,
            )


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
