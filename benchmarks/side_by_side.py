"""Ways to the same answer, timed in turns within one process."""

from __future__ import annotations

import os
import platform
from collections.abc import Callable, Mapping
from statistics import median
from time import perf_counter

from threadpoolctl import threadpool_limits


def seconds(ways: Mapping[str, Callable[[], object]], *, rounds: int) -> dict[str, float]:
    """Return the median time of each way, in seconds.

    Every round runs every way once, so that whatever else the machine does slows all of them. One
    BLAS thread: what is compared is the arithmetic, and more threads slow small problems down.
    """
    times: dict[str, list[float]] = {name: [] for name in ways}
    with threadpool_limits(1, user_api="blas"):
        for way in ways.values():
            way()
        for _ in range(rounds):
            for name, way in ways.items():
                start = perf_counter()
                way()
                times[name].append(perf_counter() - start)
    return {name: median(taken) for name, taken in times.items()}


def print_table(title: str, times: Mapping[str, float], *, aims: Mapping[str, float]) -> None:
    """Print times in ms, and how often each goes into that of the first."""
    first = next(iter(times.values()))
    print(f"\n{title}")
    for name, taken in times.items():
        aim = f"   aim {aims[name]:.0f} x" if name in aims else ""
        print(f"  {name:<44} {1e3 * taken:10.2f} ms {first / taken:8.1f} x{aim}")


def machine() -> str:
    """Return on what this was measured."""
    return f"Python {platform.python_version()}, {platform.machine()}, {os.cpu_count()} cores"
