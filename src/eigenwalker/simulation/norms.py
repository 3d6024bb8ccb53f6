"""How joints turn over a stride: published norms as Fourier series.

Angles in degrees over a cycle phase in [0, 1) that begins at the left heel strike; the right limb
follows half a stride later. Forward, left side up, left side forward, flexion, abduction and inward
rotation are positive. Coefficients are in the order of `core.fourier.harmonic_basis`.
"""

from __future__ import annotations

from types import MappingProxyType

import numpy as np

from eigenwalker.core.fourier import shift_origin

FREE_SPEED = 0.43
"""Speed over sqrt(g leg) of the group "Free" of Schwartz et al. (2008)."""


def _series(mean: float, *pairs: tuple[float, float]) -> np.ndarray:
    """Return coefficients of a mean and, for each harmonic, the weights of cosine and sine."""
    return np.array([mean, *np.fliplr(pairs).ravel()])


CURVES_DEG = MappingProxyType(
    {
        # Schwartz, Rozumalski & Trost 2008, J Biomech 41:1639, 82 walks at free speed: Fourier
        # series of the printed group means. Pelvis against the room, hip on pelvis.
        "pelvis_tilt": _series(11.6, (0, 0), (0.4, -0.7), (0, 0), (0.2, 0)),
        "pelvis_obliquity": _series(0, (1.9, 2.1), (0, 0), (-1.2, 0.2)),
        "pelvis_rotation": _series(0, (3.7, 2.1), (0, 0), (0.3, -0.4)),
        "hip_flexion": _series(18.4, (20.9, -3.2), (-3.1, -1.5), (-0.1, 1.6), (-0.1, -0.1)),
        "knee_flexion": _series(22.9, (-1.9, -18.7), (-13.6, 7.0), (-0.7, 4.3), (-0.9, 0.6)),
        "ankle_dorsiflexion": _series(0.8, (-2.0, 7.1), (0.8, -7.2), (-4.6, 0.9), (2.2, 0.2)),
        # The same source, trunk on pelvis.
        "trunk_obliquity": _series(0, (-4.3, -3.3), (0, 0), (1.4, -0.2)),
        "trunk_rotation": _series(0, (-4.0, 0.5), (0, 0), (-0.5, 0.2)),
    }
)

SPEED_SLOPES_DEG = MappingProxyType(
    {
        # Change for each +0.1 of dimensionless speed: line through the slow, free and fast
        # groups of Schwartz et al. (2008).
        "pelvis_tilt": _series(0.81, (0, 0), (-0.10, -0.31)),
        "pelvis_obliquity": _series(0, (0.34, 0.70), (0, 0), (-0.12, -0.04)),
        "pelvis_rotation": _series(0, (1.10, -0.18), (0, 0), (0.15, -0.20)),
        "hip_flexion": _series(0.85, (2.45, 0), (-0.64, 0.57), (0, 0.08)),
        "knee_flexion": _series(1.48, (0.94, -0.27), (-0.68, 1.69), (-0.26, -0.15)),
        "ankle_dorsiflexion": _series(-0.97, (1.90, 1.25), (-1.09, -0.59), (0.05, 0.71)),
    }
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
