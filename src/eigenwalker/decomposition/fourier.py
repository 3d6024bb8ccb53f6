"""One walk as a Fourier series whose coefficients are postures."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from eigenwalker.core.fourier import shift_origin
from eigenwalker.core.walker import Walker
from eigenwalker.decomposition.walk_components import PHASE_REFERENCE, WalkComponents


def decompose_fourier(
    walk: xr.DataArray,
    *,
    n_harmonics: int = 2,
    phase_ref: tuple[str, str] = PHASE_REFERENCE,
) -> Walker:
    r"""Return a walk as a Fourier series with postures for coefficients.

    .. math:: p(t) = p_0 + p_1 \sin \omega t + p_2 \cos \omega t + p_3 \sin 2 \omega t
              + p_4 \cos 2 \omega t

    The coefficients are found by least squares. The papers state no time origin, which walkers must
    share if they are to be compared: here the fundamental of left minus right ankle along the
    walking direction is a pure sine.

    Parameters
    ----------
    walk : DataArray of shape (time, marker, axis)
        Steady walking in place, such as `in_place` returns; millimetres, no missing samples. Its
        coordinate ``speed_mm_s``, if it has one, is the speed of the walker.
    n_harmonics : int
        Number of harmonics.
    phase_ref : pair of str
        Markers whose distance along x sets the time origin. Where the walk lacks them, the longest
        axis of the ellipse on which the fundamental moves all markers does.

    Returns
    -------
    Walker
        In the Fourier form; ``walker.fit`` says how well it explains the walk.

    See Also
    --------
    decompose_pca : The same sum with free phases.

    References
    ----------
    Troje (2002), Decomposing biological motion, eq. 15. Troje (2002), The little difference, eq. 1.
    Moler (2016), The eigenwalker model of the human gait.

    Examples
    --------
    >>> time = np.arange(0, 10, 0.01)
    >>> foot = np.cos(2 * np.pi * time)[:, None, None] * [[200, 0, 0]]
    >>> walk = ew.label_trajectories(foot, markers=["foot"], rate_hz=100)
    >>> walker = decompose_fourier(walk, n_harmonics=1)
    >>> walker.eigenpostures.sel(component=1, axis="x").values.round(6).tolist()
    [200.0]
    >>> round(walker.time_origin_s, 6)
    0.75
    """
    components = WalkComponents.of(walk, n_harmonics)
    postures = components.fourier_postures
    origin = origin_angle(postures, components.markers, phase_ref)
    return components.walker(
        "fourier",
        # The mean posture is regressed too: over broken strides it is not the average of frames.
        p0=components.fourier[0],
        p=shift_origin(postures, origin),
        harmonics=np.repeat(np.arange(1, n_harmonics + 1), 2),
        phases=np.tile([0.0, np.pi / 2], n_harmonics),
        origin=origin,
    )


def origin_angle(
    coefficients: np.ndarray,
    markers: Sequence[str],
    phase_ref: tuple[str, str] = PHASE_REFERENCE,
) -> float:
    """Return the angle, in radians, at which the phase reference rises through zero."""
    if set(phase_ref) <= set(markers):
        first, second = (list(markers).index(name) for name in phase_ref)
        sine, cosine = coefficients[:2, first, 0] - coefficients[:2, second, 0]
    else:
        plane = coefficients[:2].reshape(2, -1)
        scores, _, axes = np.linalg.svd(plane, full_matrices=False)
        sine, cosine = scores[:, 0] * np.sign(axes[0, np.abs(axes[0]).argmax()])
    return float(-np.arctan2(cosine, sine))
