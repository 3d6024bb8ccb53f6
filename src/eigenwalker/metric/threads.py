"""Work shared out to all cores, by threads: compiled kernels let each other run."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import cache


def in_threads(work: Callable[[int], object], starts: range, *, few: bool = False) -> None:
    """Call a function that lets other threads run with each number, over all cores."""
    if few or len(starts) < 2 or n_threads() < 2:
        for start in starts:
            work(start)
    else:
        for _ in _pool().map(work, starts):
            pass


def n_threads() -> int:
    """Return how many cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@cache
def _pool() -> ThreadPoolExecutor:
    return ThreadPoolExecutor(n_threads(), thread_name_prefix="eigenwalker-metric")


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_pool.cache_clear)  # threads do not live on in a child
