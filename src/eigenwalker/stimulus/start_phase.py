"""The moment of the stride at which walkers begin: one for all, so that no first frame tells."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from eigenwalker.core.walker import Walker, fourier_coefficients

ANKLES = ("left_ankle", "right_ankle")


def leg_phase(walker: Walker) -> float | None:
    """Return the phase at 0 s of the left ankle's swing past the right one, radians.

    That of the first harmonic of the distance between them, forward: 0 where the left ankle passes
    the right one on its way forward. None for a walker without ankles, or whose ankles rest.
    """
    if not set(ANKLES) <= set(walker.markers):
        return None
    left, right = (walker.markers.index(name) for name in ANKLES)
    swing = fourier_coefficients(walker, 1)[..., 0]
    sine, cosine = swing[:, left] - swing[:, right]
    return float(np.arctan2(cosine, sine)) if np.hypot(sine, cosine) > 1e-6 else None


def beginning_at(walker: Walker, phase_deg: float) -> Walker:
    """Return a walker whose legs have this phase at 0 s; without ankles, the walker as it is."""
    own = leg_phase(walker)
    if own is None:
        return walker
    ahead = np.deg2rad(phase_deg) - own
    shifted = replace(walker, phases=walker.phases + walker.harmonics * ahead)
    if walker.form == "eigenposture":
        return shifted
    n_harmonics = len(walker.harmonics) // 2
    return replace(walker, p=fourier_coefficients(shifted, n_harmonics))
