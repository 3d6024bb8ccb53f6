"""Monotone paths of least cost through a motion map.

Plain dynamic time warping, and the same with slope limits: no more than so many frames of one clip
in a row while the other stands still (Kovar & Gleicher 2003, section 3.1). Both sum the cells that
they pass, so that a way round has to be worth its length; the distance of two clips is the mean of
these cells (P4).
"""

from __future__ import annotations

import numpy as np

from eigenwalker.metric.kernels import compiled

SLOPE_LIMIT = 3
"""Frames in a row that one clip may stand still: warps from a quarter to four times the speed."""

SLACK = 1e-5
"""Share of a usual cell that a frame of standing still has to gain: where frames hardly differ,
both clips go on."""

_CELLS_LOOKED_AT = 2000
"""Of which the median tells what is usual."""


def least_cost_path(cost: np.ndarray, *, slope_limit: int | None = None) -> np.ndarray:
    """Return the monotone path from the first frames to the last whose cells sum to least.

    Parameters
    ----------
    cost : array of shape (frame, other frame)
        Distances, 0 or more, none missing.
    slope_limit : int, optional
        Frames of one clip in a row that may be passed while the other stands still, where that
        gains more than rounding errors do (`SLACK`). Left out, any number: plain dynamic time
        warping.

    Returns
    -------
    array of int of shape (step, 2)
        Frames of the first and of the second clip, from beginning to end.

    Raises
    ------
    ValueError
        If there are no frames, a cell is missing, or slopes within the limit cannot join the ends.

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
    if np.isnan(cost.min()):
        raise ValueError("Cells of this map are missing, so no path leads through it; fill gaps.")
    if slope_limit is None:
        return _warped(cost)
    if slope_limit < 1:
        raise ValueError(f"slope_limit={slope_limit}; give 1 or more, or None for no limit.")
    some = cost.ravel()[:: max(1, cost.size // _CELLS_LOOKED_AT)]
    usual = float(np.median(some[np.isfinite(some)])) if np.isfinite(some).any() else 0.0
    path = limited_path(cost, min(slope_limit, max(n, m)), SLACK * usual)
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
def limited_path(cost, limit, slack):
    """Path with slope limits through a whole map; empty if there is none."""
    n, m = cost.shape
    margin = limit + 1
    cells = np.full((margin + n, margin + m), np.inf, cost.dtype)
    cells[margin:, margin:] = cost
    row = margin + m
    return _path_between(
        cells.ravel(), margin * row + margin, n, row, m, row + 1, m - 1, limit, slack
    )


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
    slack = SLACK * cost[0].mean()
    coarse = _path_near_line(cost, 0, 2 * band, band // 2, 2, limit, slack)
    middle = 0
    while coarse[middle, 0] < n // 4:
        middle += 1
    begin, lead = n // 2, 2 * (coarse[middle, 1] - coarse[middle, 0])
    path = _path_near_line(cost, begin, 2 * band + lead, band, 1, limit, slack)[:-1]
    for step in range(len(path)):
        path[step, 0] = (path[step, 0] + begin) % n
        path[step, 1] = (path[step, 1] + begin + shift + lead) % n
    return path


@compiled
def _path_near_line(cost, origin, lead, band, every, limit, slack):
    """Path from one frame of two cycles, of which every n-th is taken, on to the same one again."""
    n_frames, width = cost.shape[0], 2 * band + 1
    n_rows, length = n_frames // every + 1, (width + 7) // 8 * 8  # whole vectors of numbers
    margin, row = limit + 1, 2 * limit + length
    cells = np.full((margin + n_rows, row), np.inf, cost.dtype)
    for i in range(n_rows):
        leads = cost[(origin + i * every) % n_frames]
        for x in range(max(0, band - i), min(width, band + n_rows - i)):
            cells[margin + i, limit + x] = leads[lead + (x - band) * every]
    begin, last = margin * row + limit, n_rows - 1
    return _path_between(cells.ravel(), begin, n_rows, row, length, row, last, limit, slack, band)


@compiled
def _path_between(cost, begin, n_rows, row, length, across, last, limit, slack, first=0):
    """Path from the first frames of two clips to the last, through cells that lie in one line.

    A cell is reached by a diagonal step, after which up to `limit` frames of one clip may pass.
    All that it can be reached from stands in rows before, so each row is summed up at once.

    cost: cells of a map in one line, with a margin of infinite ones; begin: where the first row
    begins; n_rows, row, length: how many rows there are, how far apart, how many cells in each;
    across: how far a step of both clips leads; last: frame of the second clip at which the path
    ends; slack: what a frame of standing still has to gain; first: which cell of the first row the
    path begins with.
    """
    total = np.full(len(cost), np.inf, cost.dtype)
    start = begin + first - across
    total[start] = 0.0
    slack = cost.dtype.type(slack)
    passed, climbed = np.empty(length, cost.dtype), np.empty(length, cost.dtype)
    for at in range(begin, begin + n_rows * row, row):
        best = total[at : at + length]
        best[:] = total[at - across : at - across + length]
        passed[:] = 0.0
        climbed[:] = 0.0
        for s in range(1, limit + 1):
            beside, source = cost[at - s :], total[at - across - s :]
            below, deeper = cost[at - s * across + s :], total[at - (s + 1) * across + s :]
            for x in range(length):
                passed[x] += beside[x] + slack
                climbed[x] += below[x] + slack
                best[x] = min(best[x], min(source[x] + passed[x], deeper[x] + climbed[x]))
        best += cost[at : at + length]
    i, j = n_rows - 1, last
    end = start + n_rows * across + (j - i)
    if total[end] == np.inf:
        return np.empty((0, 2), np.int64)
    path = np.empty((2 * (i + j + 2), 2), np.int64)
    step, at = len(path), end
    while at != start:
        s = _frames_passed(cost, total, at, across, limit, slack)
        for _ in range(abs(s)):
            step -= 1
            path[step, 0], path[step, 1] = i, j
            if s > 0:
                j -= 1
            else:
                i -= 1
        step -= 1
        path[step, 0], path[step, 1] = i, j
        i -= 1
        j -= 1
        at -= across + s if s > 0 else across - s * (across - 1)
    return path[step:].copy()


@compiled
def _frames_passed(cost, total, at, across, limit, slack):
    """Frames of the second clip that pass before a cell, below 0 those of the first."""
    best, chosen = total[at - across], 0
    passed, climbed = 0.0, 0.0
    for s in range(1, limit + 1):
        passed += cost[at - s] + slack
        climbed += cost[at - s * across + s] + slack
        if total[at - across - s] + passed < best:
            best, chosen = total[at - across - s] + passed, s
        if total[at - (s + 1) * across + s] + climbed < best:
            best, chosen = total[at - (s + 1) * across + s] + climbed, -s
    return chosen
