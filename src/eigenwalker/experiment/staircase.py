"""An adaptive staircase: the level of a trial, from the answers so far and nothing else."""

from __future__ import annotations

from collections.abc import Iterable


def next_level(correct: Iterable[bool], *, start: int, n_levels: int, down: int) -> int:
    """Return the place of the next level, from 0, the easiest, to the hardest.

    After `down` right answers in a row the next level is harder, after a wrong one it is easier
    (Levitt, 1971). The page computes the same, so it needs no network for it.

    Examples
    --------
    >>> next_level([True, True, True, False], start=1, n_levels=5, down=2)
    1
    """
    level, in_a_row = start, 0
    for right in correct:
        in_a_row = in_a_row + 1 if right else 0
        if not right:
            level = max(level - 1, 0)
        elif in_a_row == down:
            level, in_a_row = min(level + 1, n_levels - 1), 0
    return level
