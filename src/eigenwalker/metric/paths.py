"""Monotone paths of least cost through a motion map.

Plain dynamic time warping, and the same with slope limits (Kovar & Gleicher 2003, section 3.1).
Both minimise the sum of the cells that they pass, so that a detour has to save more than the cells
that it adds; the distance between two clips is the mean of these cells.
"""

from __future__ import annotations

import numpy as np

from eigenwalker.metric.kernels import compiled

SLOPE_LIMIT = 3
"""Frames in succession for which one clip may be held: speeds from a quarter to four times."""

HOLD_COST = 1e-5
"""Cost of a held frame, relative to the median cell: where frames hardly differ, none is held."""

_N_SAMPLED = 2000
"""Cells of which the median is taken."""


def least_cost_path(cost: np.ndarray, *, slope_limit: int | None = None) -> np.ndarray:
    r"""Return the monotone path from the first frames to the last with the least sum of cells.

    Of all sequences of cells from (0, 0) to (n - 1, m - 1) whose steps are (1, 1), (1, 0) or (0, 1)
    the one that minimises :math:`\sum_{(i, j)} D(i, j) + \epsilon\, n_{held}`. By a slope limit L,
    at most L steps (1, 0) or (0, 1) follow a step (1, 1), all of one kind: one clip is held while
    at most L frames of the other pass. :math:`\epsilon` is `HOLD_COST` times the median of D, and 0
    without a limit (plain dynamic time warping). Costs are of shape (frame, other frame), 0 or
    more, without NaN; paths of shape (step, 2).
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
    sampled = cost.ravel()[:: max(1, cost.size // _N_SAMPLED)]
    sampled = sampled[np.isfinite(sampled)]
    hold_cost = HOLD_COST * float(np.median(sampled)) if sampled.size else 0.0
    path = limited_path(cost, min(slope_limit, max(n, m)), hold_cost)
    if not len(path):
        raise ValueError(
            f"With slope_limit={slope_limit} no path joins {n} frames with {m}: one clip would "
            "have to be played too many times faster. Raise the limit, give None for none, or cut "
            "the clips to the same action."
        )
    return path


@compiled
def _warped(cost):
    """Return the path of plain dynamic time warping; of equal paths the most diagonal one."""
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
    i, j, step = n - 1, m - 1, n + m
    while True:
        step -= 1
        path[step, 0], path[step, 1] = i, j
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
    return path[step:].copy()


@compiled
def limited_path(cost, limit, hold_cost):
    """Return the path with a slope limit through a whole map; empty if there is none."""
    n, m = cost.shape
    margin = limit + 1
    cells = np.full((margin + n, margin + m), np.inf, cost.dtype)
    cells[margin:, margin:] = cost
    row = margin + m
    return _path_between(
        cells.ravel(), margin * row + margin, n, row, m, row + 1, m - 1, limit, hold_cost
    )


@compiled
def closed_path(cost, shift, limit, band):
    """Return the path once round two cycles of equally many frames.

    A cycle has no first frame. So a coarse path, of every second frame, is found from frame 0.
    Where it is half a cycle later, independent of its ends, the final path begins and ends.

    cost: (frame, lead), where the second cycle is ahead of the global shift by ``lead - 2 * band``
    frames; shift: frames by which the second cycle is globally ahead; band: frames by which each
    path may deviate from that line. The number of frames is divisible by 4.
    """
    n = cost.shape[0]
    hold_cost = HOLD_COST * cost[0].mean()
    coarse = _path_near_line(cost, 0, 2 * band, band // 2, 2, limit, hold_cost)
    middle = 0
    while coarse[middle, 0] < n // 4:
        middle += 1
    begin, lead = n // 2, 2 * (coarse[middle, 1] - coarse[middle, 0])
    path = _path_near_line(cost, begin, 2 * band + lead, band, 1, limit, hold_cost)[:-1]
    for step in range(len(path)):
        path[step, 0] = (path[step, 0] + begin) % n
        path[step, 1] = (path[step, 1] + begin + shift + lead) % n
    return path


@compiled
def _path_near_line(cost, origin, lead, band, every, limit, hold_cost):
    """Return the path from one frame of two cycles, of which every n-th counts, round to itself."""
    n_frames, width = cost.shape[0], 2 * band + 1
    n_rows, length = n_frames // every + 1, (width + 7) // 8 * 8  # whole vectors of numbers
    margin, row = limit + 1, 2 * limit + length
    cells = np.full((margin + n_rows, row), np.inf, cost.dtype)
    for i in range(n_rows):
        leads = cost[(origin + i * every) % n_frames]
        for x in range(max(0, band - i), min(width, band + n_rows - i)):
            cells[margin + i, limit + x] = leads[lead + (x - band) * every]
    begin, last = margin * row + limit, n_rows - 1
    return _path_between(
        cells.ravel(), begin, n_rows, row, length, row, last, limit, hold_cost, band
    )


@compiled
def _path_between(cost, begin, n_rows, row, length, diagonal, last, limit, hold_cost, first=0):
    """Return the path from the first frames of two clips to the last; empty if there is none.

    A cell is reached by a diagonal step, after which up to `limit` frames of one clip may pass. All
    cells from which it can be reached are in earlier rows, so each row is summed at once.

    cost: cells of a map as one vector, with a margin of infinite ones; begin: index of the first
    row; n_rows, row, length: number of rows, their distance, cells in each; diagonal: distance of a
    step of both clips; last: frame of the second clip at which the path ends; hold_cost: cost of a
    held frame; first: cell of the first row with which the path begins.
    """
    total = np.full(len(cost), np.inf, cost.dtype)
    start = begin + first - diagonal
    total[start] = 0.0
    hold_cost = cost.dtype.type(hold_cost)
    along_second, along_first = np.empty(length, cost.dtype), np.empty(length, cost.dtype)
    for at in range(begin, begin + n_rows * row, row):
        best = total[at : at + length]
        best[:] = total[at - diagonal : at - diagonal + length]
        along_second[:] = 0.0
        along_first[:] = 0.0
        for s in range(1, limit + 1):
            beside, source = cost[at - s :], total[at - diagonal - s :]
            above, higher = cost[at - s * diagonal + s :], total[at - (s + 1) * diagonal + s :]
            for x in range(length):
                along_second[x] += beside[x] + hold_cost
                along_first[x] += above[x] + hold_cost
                best[x] = min(best[x], min(source[x] + along_second[x], higher[x] + along_first[x]))
        best += cost[at : at + length]
    i, j = n_rows - 1, last
    end = start + n_rows * diagonal + (j - i)
    if total[end] == np.inf:
        return np.empty((0, 2), np.int64)
    path = np.empty((2 * (i + j + 2), 2), np.int64)
    step, at = len(path), end
    while at != start:
        s = _held_before(cost, total, at, diagonal, limit, hold_cost)
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
        at -= diagonal + s if s > 0 else diagonal - s * (diagonal - 1)
    return path[step:].copy()


@compiled
def _held_before(cost, total, at, diagonal, limit, hold_cost):
    """Return how many frames of the second clip pass before a cell; negative, of the first."""
    best, chosen = total[at - diagonal], 0
    along_second, along_first = 0.0, 0.0
    for s in range(1, limit + 1):
        along_second += cost[at - s] + hold_cost
        along_first += cost[at - s * diagonal + s] + hold_cost
        if total[at - diagonal - s] + along_second < best:
            best, chosen = total[at - diagonal - s] + along_second, s
        if total[at - (s + 1) * diagonal + s] + along_first < best:
            best, chosen = total[at - (s + 1) * diagonal + s] + along_first, -s
    return chosen
