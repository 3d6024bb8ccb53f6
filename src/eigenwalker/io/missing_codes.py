"""Numbers that programs write for a marker that was not seen, known by what they are."""

from __future__ import annotations

import numpy as np

CODES = (3.697314e28, 3.4028235e38, 1.7976931348623157e308)
"""What NDI's programs write (with a minus), and the largest numbers of 4 and of 8 bytes."""
NINES = tuple(float("9" * digits) for digits in range(4, 13))
MIN_REPEATED = 3
"""How often one number in all three coordinates is a code, however near it is."""
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

    A code is a number of nines alone in all three coordinates; one number other than 0 in all
    three, in `MIN_REPEATED` samples or further out than `FAR_FACTOR` times 99 % of the coordinates
    of markers whose three differ; a number of nines in any coordinate that is so far out; or a
    number that stays exactly the same in one for `MIN_REPEATED` frames, so far out or of nines.
    """
    size = np.abs(positions)
    same = (positions == positions[..., :1]).all(axis=2)
    repeated = _repeated(positions[same, 0])
    nines = np.isin(size, NINES)
    usual = size[np.isfinite(size) & ~nines & ~same[..., None]]
    limit = FAR_FACTOR * float(np.quantile(usual, 0.99)) if usual.size else np.inf
    far = size > limit
    if not (repeated.size or far.any() or nines.any()):
        return positions, []
    missing = (
        nines.all(axis=2)
        | (same & (far[..., 0] | np.isin(positions[..., 0], repeated)))
        | (nines & far).any(axis=2)
        | ((nines | far) & _stays(positions)).any(axis=2)
    )
    if not missing.any():
        return positions, []
    found, counts = np.unique(positions[missing], return_counts=True)
    is_found = np.isin(np.abs(found), NINES) | (np.abs(found) > limit) | np.isin(found, repeated)
    most = found[is_found][np.argsort(-counts[is_found], kind="stable")]
    return np.where(missing[..., None], np.nan, positions), [f"{code:.10g}" for code in most[:10]]


def _repeated(numbers: np.ndarray) -> np.ndarray:
    """Return the numbers other than 0 that stand in all three coordinates so often as codes do."""
    values, counts = np.unique(numbers[(numbers != 0) & np.isfinite(numbers)], return_counts=True)
    return values[counts >= MIN_REPEATED]


def _stays(positions: np.ndarray) -> np.ndarray:
    """Return where a coordinate is exactly the same for `MIN_REPEATED` frames or more."""
    stays = np.zeros(positions.shape, dtype=bool)
    equal = positions[1:] == positions[:-1]
    run = equal[1:] & equal[:-1]  # of three frames
    for shift in range(MIN_REPEATED):
        stays[shift : len(run) + shift] |= run
    return stays
