"""Runs of True in an array of flags."""

from __future__ import annotations

import numpy as np


def runs_of_true(flags: np.ndarray) -> list[tuple[int, int]]:
    """Return where each run of True starts, and where it stops (not included)."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], flags.astype(np.int8), [0]])))
    return [(int(start), int(stop)) for start, stop in zip(edges[::2], edges[1::2], strict=True)]
