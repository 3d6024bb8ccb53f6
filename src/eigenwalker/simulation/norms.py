"""How joints turn over a stride: published norms as Fourier series.

Angles in degrees over a cycle phase in [0, 1) that begins at the left heel strike; the right limb
follows half a stride later. Forward, left side up, left side forward, flexion, abduction and inward
rotation are positive. Coefficients are in the order of `core.fourier.harmonic_basis`.
"""

from __future__ import annotations

import tomllib
from importlib.resources import files

import numpy as np

from eigenwalker.core.fourier import shift_origin

FREE_SPEED = 0.43
"""Speed over sqrt(g leg) of the group "Free" of Schwartz et al. (2008)."""


def _series(mean: float, *pairs: list[float]) -> np.ndarray:
    """Return coefficients of a mean and, for each harmonic, the weights of cosine and sine."""
    return np.array([mean, *np.fliplr(pairs).ravel()])


_PRINTED = tomllib.loads(
    (files("eigenwalker.simulation") / "norms.toml").read_text(encoding="utf-8")
)
CURVES_DEG, SPEED_SLOPES_DEG = (
    {name: _series(*weights) for name, weights in _PRINTED[table].items()}
    for table in ("curves", "speed_slopes")
)


def norm_coefficients(name: str, speed: float, n_harmonics: int) -> np.ndarray:
    """Return the Fourier coefficients, in degrees, of a joint's norm at a walking speed.

    The group mean at free speed, plus a change that is linear in the dimensionless speed v:
    ``c(v) = c_free + slope * (v - 0.43) / 0.1``. Both are from children (Schwartz et al. 2008); the
    slope is that of a line through their slow, free and fast groups. Curves of the trunk do not
    depend on speed.

    Parameters
    ----------
    name : str
        ``"pelvis_tilt"``, ``"pelvis_obliquity"``, ``"pelvis_rotation"``, ``"hip_flexion"``,
        ``"knee_flexion"``, ``"ankle_dorsiflexion"``, ``"trunk_obliquity"`` or
        ``"trunk_rotation"``.
    speed : float
        Speed divided by sqrt(g times leg length).
    n_harmonics : int
        Harmonics wanted; those that the norm lacks are 0.

    Returns
    -------
    array of shape (1 + 2 * n_harmonics,)
        Mean, then sine and cosine of each harmonic of the stride from a left heel strike.

    See Also
    --------
    eigenwalker.core.harmonic_basis : the waves that these coefficients weight.

    References
    ----------
    Schwartz, M. H., Rozumalski, A., & Trost, J. P. (2008). The effect of walking speed on the gait
    of typically developing children. Journal of Biomechanics, 41, 1639-1650.

    Examples
    --------
    >>> norm_coefficients("hip_flexion", 0.43, 1).tolist()
    [18.4, -3.2, 20.9]
    """
    coefficients = np.zeros(1 + 2 * max(n_harmonics, 4))
    curve = CURVES_DEG[name]
    coefficients[: len(curve)] += curve
    if (slope := SPEED_SLOPES_DEG.get(name)) is not None:
        coefficients[: len(slope)] += slope * (speed - FREE_SPEED) / 0.1
    return coefficients[: 1 + 2 * n_harmonics]


def delay(coefficients: np.ndarray, lag: float) -> np.ndarray:
    """Return the Fourier coefficients of a curve that is late by a share of the cycle."""
    return np.append(coefficients[:1], shift_origin(coefficients[1:], -2 * np.pi * lag))
