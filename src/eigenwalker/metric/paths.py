"""Monotone paths of least cost through a motion map.

Plain dynamic time warping, and the same with slope limits: no more than so many frames of one clip
in a row while the other stands still (Kovar & Gleicher 2003, section 3.1). Both sum the cells that
they pass; the distance of two clips is the mean of these cells (P4).
"""

from __future__ import annotations

import numpy as np

from eigenwalker.metric.kernels import compiled

SLOPE_LIMIT = 3
"""Frames in a row that one clip may stand still: warps from a quarter to four times the speed."""


def least_cost_path(cost: np.ndarray, *, slope_limit: int | None = None) -> np.ndarray:
    """Return the monotone path from the first frames to the last whose cells sum to least.

    Parameters
    ----------
    cost : array of shape (frame, other frame)
        Distances, 0 or more, none missing.
    slope_limit : int, optional
        Frames of one clip in a row that may be passed while the other stands still. Left out,
        any number: plain dynamic time warping.

    Returns
    -------
    array of int of shape (step, 2)
        Frames of the first and of the second clip, from beginning to end.

    Raises
    ------
    ValueError
        If there are no frames, or slopes within the limit cannot join the two ends.

    Examples
    --------
    >>> clip, slower = np.arange(3.0), np.array([0, 0, 1, 1, 2, 2.0])
    >>> cost = np.abs(clip[:, None] - slower)
    >>> least_cost_path(cost, slope_limit=2).tolist()
    [[0, 0], [0, 1], [1, 2], [1, 3], [2, 4], [2, 5]]

    """
    n, m = cost.shape
    if not n or not m:
        raise ValueError(f"A path needs frames on both sides; there are {n} and {m}.")
    cost = np.ascontiguousarray(cost, dtype=float)
    if slope_limit is None:
        return _warped(cost)
    if slope_limit < 1:
        raise ValueError(f"slope_limit={slope_limit}; give 1 or more, or None for no limit.")
    path = limited_path(cost, slope_limit, max(n, m))
    if not len(path):
        raise ValueError(
            f"With slope_limit={slope_limit} no path joins {n} frames with {m}: one clip would "
            "have to be played too many times faster. Raise the limit, give None for none, or cut "
            "the clips to the same action."
        )
    return path


@compiled
def _warped(cost):
    """Path of plain dynamic time warping; of equal ways the diagonal one."""
    n, m = cost.shape
    total = np.empty((n, m))
    total[0, 0] = cost[0, 0]
    for j in range(1, m):
        total[0, j] = total[0, j - 1] + cost[0, j]
    for i in range(1, n):
        above, row, here = total[i - 1], total[i], cost[i]
        left = above[0] + here[0]
        row[0] = left
        for j in range(1, m):
            left = min(min(above[j - 1], above[j]), left) + here[j]
            row[j] = left
    path = np.empty((n + m, 2), np.int64)
    i, j, at = n - 1, m - 1, n + m
    while True:
        at -= 1
        path[at, 0], path[at, 1] = i, j
        if i == 0 and j == 0:
            break
        if i == 0:
            j -= 1
        elif j == 0:
            i -= 1
        else:
            corner, up, left = total[i - 1, j - 1], total[i - 1, j], total[i, j - 1]
            if corner <= up and corner <= left:
                i -= 1
                j -= 1
            elif up <= left:
                i -= 1
            else:
                j -= 1
    return path[at:].copy()


@compiled
def limited_path(cost, limit, band):
    """Path with slope limits, no further than `band` frames from the diagonal; empty if none.

    A cell is reached by a diagonal step, after which up to `limit` frames of one clip may pass.
    """
    n, m = cost.shape
    total = np.full((n, m), np.inf)
    run = np.zeros((n, m), np.int8)
    along = 0.0
    for j in range(min(limit + 1, m)):
        along += cost[0, j]
        total[0, j] = along
    along = 0.0
    for i in range(min(limit + 1, n)):
        along += cost[i, 0]
        total[i, 0] = along
    for i in range(1, n):
        for j in range(max(1, i - band), min(m, i + band + 1)):
            best, chosen = total[i - 1, j - 1], 0
            passed = 0.0
            for s in range(1, min(limit, j - 1) + 1):
                passed += cost[i, j - s]
                if total[i - 1, j - 1 - s] + passed < best:
                    best, chosen = total[i - 1, j - 1 - s] + passed, s
            passed = 0.0
            for s in range(1, min(limit, i - 1) + 1):
                passed += cost[i - s, j]
                if total[i - 1 - s, j - 1] + passed < best:
                    best, chosen = total[i - 1 - s, j - 1] + passed, -s
            total[i, j] = best + cost[i, j]
            run[i, j] = chosen
    if total[n - 1, m - 1] == np.inf:
        return np.empty((0, 2), np.int64)
    return _traced(run)


@compiled
def _traced(run):
    n, m = run.shape
    path = np.empty((n + m, 2), np.int64)
    i, j, at = n - 1, m - 1, n + m
    while True:
        s = 0 if i == 0 or j == 0 else run[i, j]
        for _ in range(abs(s)):
            at -= 1
            path[at, 0], path[at, 1] = i, j
            if s > 0:
                j -= 1
            else:
                i -= 1
        at -= 1
        path[at, 0], path[at, 1] = i, j
        if i == 0 and j == 0:
            break
        if i > 0 and j > 0:
            i -= 1
            j -= 1
        elif i > 0:
            i -= 1
        else:
            j -= 1
    return path[at:].copy()


@compiled
def closed_path(cost, shift, limit, band):
    """Path once round two cycles of as many frames each, near the line on which both advance alike.

    Nothing marks the beginning of a cycle, so a first path, of every second frame, is laid from
    where we happen to begin; where it is half a cycle later, free of both ends, the second one
    begins and ends.

    Parameters: the shift of the second cycle that suits best on the whole; cost[frame, lead],
    where the second is ahead of that by ``lead - 2 * band`` frames; the limit of slope; the band
    about the line in which each path keeps. The number of frames divides by 4.
    """
    n = cost.shape[0]
    coarse = limited_path(_unrolled(cost, 0, 2 * band, band // 2, 2), limit, band // 2)
    middle = 0
    while coarse[middle, 0] < n // 4:
        middle += 1
    begin, lead = n // 2, 2 * (coarse[middle, 1] - coarse[middle, 0])
    path = limited_path(_unrolled(cost, begin, 2 * band + lead, band, 1), limit, band)[:-1]
    for step in range(len(path)):
        path[step, 0] = (path[step, 0] + begin) % n
        path[step, 1] = (path[step, 1] + begin + shift + lead) % n
    return path


@compiled
def _unrolled(cost, begin, lead, band, every):
    """Map of two cycles, of every n-th frame from one on to the same again, within a band."""
    n = cost.shape[0]
    size = n // every + 1
    piece = np.full((size, size), np.inf)
    for i in range(size):
        row = cost[(begin + i * every) % n]
        for j in range(max(0, i - band), min(size, i + band + 1)):
            piece[i, j] = row[lead + (j - i) * every]
    return piece
