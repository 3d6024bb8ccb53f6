"""What a known-bad file is: how to make it, what must be said of it, and at which door."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np
import xarray as xr

from corpus.sound_files import Files, sound_files
from eigenwalker.simulation.walk import simulate_walk

Door = Literal["capture", "table of traits", "population", "mat", "walkers.mat", "bml"]
Ending = Literal["refused", "flagged"]


class BadFile(NamedTuple):
    """One known-bad file.

    Parameters
    ----------
    name : str
        What is wrong with it, in words.
    make : function of a folder
        Writes it there, with the files it needs, and returns its path.
    said : str
        Regular expression for what must be said of it.
    ending : {"refused", "flagged"}
        Whether it is refused at reading, or read and then given another verdict than "use".
    door : str
        By whom it is read.

    """

    name: str
    make: Callable[[Path], Path]
    said: str
    ending: Ending = "refused"
    door: Door = "capture"


def written(files: Files | Callable[[], Files]) -> Callable[[Path], Path]:
    """Return how to write files that belong together; the first is the one to read."""

    def make(folder: Path) -> Path:
        found = files() if callable(files) else files
        for name, content in found.items():
            (folder / name).write_bytes(content)
        return folder / next(iter(found))

    return make


def changed(
    kind: str, old: str | bytes, new: str | bytes, *, variant: int = 0, beside: bool = False
) -> Callable[[Path], Path]:
    """Return how to write a sound file in which the first match of a pattern is replaced."""

    def files() -> Files:
        found = dict(_small(kind)[variant])
        name = list(found)[1 if beside else 0]
        pattern = old.encode() if isinstance(old, str) else old
        put = new.encode() if isinstance(new, str) else new
        found[name], count = re.subn(pattern, lambda hit: put, found[name], count=1, flags=re.M)
        assert count, f"{old!r} is not in the {kind} file"
        return found

    return written(files)


def cut(kind: str, end: Callable[[bytes], int], *, variant: int = 0) -> Callable[[Path], Path]:
    """Return how to write a sound file that ends early."""

    def files() -> Files:
        found = dict(_small(kind)[variant])
        name = next(iter(found))
        found[name] = found[name][: end(found[name])]
        return found

    return written(files)


@lru_cache
def _small(kind: str) -> list[Files]:
    return sound_files(kind)


@lru_cache
def person() -> xr.DataArray:
    """A walk over ground that is for use: five seconds at 50 Hz."""
    walk = simulate_walk(seed=3, duration_s=5, rate_hz=50, truth=False, noise_mm=1.0)
    forward = 1200 * walk.time.values[:, None, None] * np.array([1, 0, 0])
    return walk.copy(data=(walk.values + forward).round(3))
