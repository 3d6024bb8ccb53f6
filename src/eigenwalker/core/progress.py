"""Reporting the progress of long work."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import TypeVar

Progress = Callable[[int, int], object]
"""Called after each step with the number of steps done and the number of all steps."""

_Step = TypeVar("_Step")


def ticked(steps: Iterable[_Step], n_steps: int, progress: Progress | None) -> Iterator[_Step]:
    """Yield the steps one by one, and report how many are done after each."""
    for done, step in enumerate(steps, start=1):
        yield step
        if progress is not None:
            progress(done, n_steps)
