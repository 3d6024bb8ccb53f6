"""Numbers that programs write for a marker that was not seen, known by what they are."""

from __future__ import annotations

import numpy as np

CODES = (3.697314e28, 3.4028235e38, 1.7976931348623157e308)
"""What NDI's programs write (with a minus), and the largest numbers of 4 and of 8 bytes."""
NINES = tuple(float("9" * digits) for digits in range(4, 13))
FAR_FACTOR = 10.0
"""How many times further than nearly all other coordinates a code is that is not known."""


def is_code(number: str | float) -> bool:
    """Return whether a number is one of `CODES` or of many nines, which no length is."""
    try:
        size = abs(float(number))
    except ValueError:
        return False
    return any(abs(size - code) <= 1e-6 * code for code in CODES) or (size > 1e9 and size in NINES)


def without_codes(positions: np.ndarray) -> tuple[np.ndarray, list[str]]:
    """Return positions (time, marker, 3) with NaN for codes, and the codes that were found.

    A code is a number of nines alone in all three coordinates, or one number in all three, or a
    number of nines in any, further out than `FAR_FACTOR` times 99 % of the coordinates
    of markers whose three differ.
    """
    size = np.abs(positions)
    same = (positions == positions[..., :1]).all(axis=2)
    usual = size[(size < NINES[0]) & ~same[..., None]]  # which leaves out NaN
    limit = FAR_FACTOR * float(np.quantile(usual, 0.99)) if usual.size else 0.0
    if not limit or not np.nanmax(size) > min(limit, NINES[0] - 1):
        return positions, []
    nines = np.isin(size, NINES)
    missing = (
        nines.all(axis=2) | (same & (size[..., 0] > limit)) | (nines & (size > limit)).any(axis=2)
    )
    found = np.unique(positions[missing])
    codes = [f"{code:.10g}" for code in found if abs(code) in NINES or abs(code) > limit]
    return np.where(missing[..., None], np.nan, positions), codes[:10]
