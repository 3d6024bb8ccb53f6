"""One walk as eigenpostures that ride on sines (Troje 2002)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from eigenwalker.core.walker import Walker
from eigenwalker.decomposition.walk_components import PHASE_REFERENCE, WalkComponents

_ROUNDING = 1e-9


def decompose_pca(walk: xr.DataArray, *, n_harmonics: int = 2) -> Walker:
    r"""Return the eigenpostures of a walk and the sines they ride on.

    .. math:: p(t) = p_0 + \sum_i p_i \sin(h_i \omega t + \phi_i)

    The eigenpostures are principal components of the postures, two for each harmonic. A sine of the
    stride frequency, or of the multiple that explains most, is fitted to the scores of each; its
    amplitude is multiplied into the eigenposture, and the first phase is set to 0.

    The first eigenposture has the sign with which the left ankle is ahead of the right where its
    sine is positive (with no ankles, its largest entry is positive); the others have the sign that
    puts their phase between 0 and pi. `Population` settles which eigenposture of one walker
    corresponds to which of another.

    Parameters
    ----------
    walk : DataArray of shape (time, marker, axis)
        Steady walking in place, such as `in_place` returns; millimetres, no missing samples. Its
        coordinate ``speed_mm_s``, if it has one, is the speed of the walker.
    n_harmonics : int
        Multiples of the stride frequency to allow; there are two eigenpostures for each.

    Returns
    -------
    Walker
        In the eigenposture form; ``walker.fit`` says how well it explains the walk.

    Raises
    ------
    ValueError
        If samples are missing, the walk is too short, nothing moves, or the frame rate cannot show
        so many harmonics.

    See Also
    --------
    decompose_fourier : The same sum with fixed phases.

    References
    ----------
    Troje (2002), Decomposing biological motion, eq. 1 to 3.

    Examples
    --------
    >>> time = np.arange(0, 10, 0.01)
    >>> swing = np.sin(2 * np.pi * time)[:, None, None] * [[200, 0, 0], [-200, 0, 0]]
    >>> lift = np.cos(4 * np.pi * time)[:, None, None] * [[0, 0, 30], [0, 0, 30]]
    >>> feet = ["left_ankle", "right_ankle"]
    >>> walk = ew.label_trajectories(swing + lift, markers=feet, rate_hz=100)
    >>> walker = decompose_pca(walk)
    >>> round(walker.frequency_hz, 6), walker.harmonics[:2].tolist()
    (1.0, [1, 2])
    >>> walker.eigenpostures.sel(component=1, axis="x").values.round(6).tolist()
    [200.0, -200.0]
    """
    components = WalkComponents.of(walk, n_harmonics)
    found = components.eigenpostures
    p = (found.amplitudes[:, None] * found.components).reshape(-1, len(components.markers), 3)
    phases = found.phases.copy()
    if is_negative(p[0], components.markers):
        p[0], phases[0] = -p[0], phases[0] + np.pi
    origin = -phases[0] / found.harmonics[0]
    phases, sign_changed = _half_turn(phases + found.harmonics * origin)
    p[sign_changed] *= -1
    return components.walker(
        "eigenposture", p0=found.mean, p=p, harmonics=found.harmonics, phases=phases, origin=origin
    )


def is_negative(posture: np.ndarray, markers: Sequence[str]) -> bool:
    """Return whether the right ankle is ahead, or else the largest entry is negative."""
    left, right = PHASE_REFERENCE
    if left in markers and right in markers:
        names = list(markers)
        ahead = posture[names.index(left), 0] - posture[names.index(right), 0]
        if ahead != 0:
            return bool(ahead < 0)
    return bool(posture.flat[np.abs(posture).argmax()] < 0)


def _half_turn(phases: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return phases within [0, pi), the first one 0, and which eigenpostures change their sign."""
    phases = (phases + _ROUNDING) % (2 * np.pi) - _ROUNDING
    phases[0] = 0.0
    sign_changed = phases >= np.pi - _ROUNDING
    return np.where(sign_changed, phases - np.pi, phases), sign_changed
