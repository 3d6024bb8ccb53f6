"""Smooth warps of time for actions that do not repeat (Troje 2002, discussion)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.interpolate import BSpline, CubicSpline
from scipy.optimize import least_squares

from eigenwalker.metric.alignment import Alignment, align_steps
from eigenwalker.metric.clips import Clip, as_trajectories, at_one_rate
from eigenwalker.metric.motion_maps import motion_map
from eigenwalker.metric.points import common_positions
from eigenwalker.metric.registration import Registration, register

_DEGREE = 3

_MAX_MOMENTS = 150
"""Moments at which clips are compared during the fit."""

_STIFFNESS = 1e-3
"""Weight of changes of speed relative to the variance of the movement: it decides where nothing
moves, and is negligible elsewhere."""


def register_by_spline(a: Clip, b: Clip, *, n_pieces: int = 6, align: bool = True) -> Registration:
    r"""Return which moments of two clips of one action correspond, by a smooth warp of time.

    The time of the second clip is a monotone cubic B-spline of the time of the first, whose
    coefficients are cumulative sums of exponentials, :math:`c_n = \sum_{m \le n} e^{r_m}`, scaled
    to the duration of the second clip. Starting from the registered path (`register`), r minimises
    the squared distance between corresponding positions, relative to their variance, plus
    :math:`\lambda^2 \sum (r_m - \bar r)^2` with :math:`\lambda` = 0.001. Where actions are not
    periodic, this replaces uniform scaling of time.

    Parameters
    ----------
    a, b : DataArray of shape (time, marker, axis), Walker, Loop or PreparedClip
        Clips of one action each, with the same beginning and end.
    n_pieces : int
        Pieces of the spline: how often the second clip may change its speed.
    align : bool
        Whether heading and place are removed, for each pair of moments on its own.

    Returns
    -------
    Registration
        With a step for each frame of the first clip; `times` are exact, `path` the nearest frames.

    See Also
    --------
    register : By dynamic time warping.

    References
    ----------
    Troje (2002), discussion.

    Examples
    --------
    The same reach, at first slower and then faster:

    >>> time = np.linspace(0, 1, 101)[:, None, None]
    >>> def reach(t):
    ...     hand = np.concatenate([600 * t**2, 200 * np.sin(2 * t), 1000 + 0 * t], axis=2)
    ...     return hand * np.array([[1.0], [0.5], [0.0]])
    >>> a, b = (
    ...     ew.label_trajectories(reach(t), markers=["hand", "elbow", "shoulder"], rate_hz=100)
    ...     for t in (time, time**1.5)
    ... )
    >>> times = register_by_spline(a, b, align=False).times
    >>> bool(np.abs(times[:, 0] - times[:, 1] ** 1.5).max() < 0.01)
    True
    """
    if n_pieces < 1:
        raise ValueError(f"n_pieces={n_pieces}; a warp needs 1 or more.")
    a, b = at_one_rate(as_trajectories(a), as_trajectories(b))
    start = register(a, b, align=align, slope_limit=None)
    first, second = common_positions(a, b)
    warp = _fitted_warp(a.time.values, first, b.time.values, second, start, n_pieces, align)
    time = a.time.values
    other = warp(time)
    frames = np.abs(np.subtract.outer(other, b.time.values)).argmin(axis=1)
    path = np.stack([np.arange(len(time)), frames], axis=1)
    placed = CubicSpline(b.time.values, second)(other)
    alignment = Alignment(np.zeros(len(time)), np.zeros((len(time), 2)))
    if align:
        alignment = align_steps(first, placed)
    cells = motion_map(a, b, align=align)
    distances = np.linalg.norm(first - alignment.apply(placed), axis=2)
    return Registration(
        first=a,
        second=b,
        path=path,
        times=np.stack([time, other], axis=1),
        map=cells,
        cost=float(distances.mean()),
        alignment=alignment,
        periodic=False,
    )


def _fitted_warp(
    time: np.ndarray,
    first: np.ndarray,
    other: np.ndarray,
    second: np.ndarray,
    start: Registration,
    n_pieces: int,
    align: bool,
) -> Callable[[np.ndarray], np.ndarray]:
    """Return the time of the second clip as a function of the time of the first."""
    length, origin = time[-1] - time[0], time[0]
    inner = np.linspace(0, 1, n_pieces + 1)
    knots = np.concatenate([np.zeros(_DEGREE), inner, np.ones(_DEGREE)])
    moments = np.linspace(0, 1, min(len(time), _MAX_MOMENTS))
    target = CubicSpline(time, first)(origin + length * moments)
    path = CubicSpline(other, second)
    scale = np.sqrt(first.var(axis=0).sum() * len(moments))

    def warp_of(rises: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
        steps = np.exp(rises - rises.max())
        shares = np.concatenate([[0], np.cumsum(steps) / steps.sum()])
        spline = BSpline(knots, other[0] + (other[-1] - other[0]) * shares, _DEGREE)
        return lambda moment: np.clip(spline((moment - origin) / length), other[0], other[-1])

    def misfit(rises: np.ndarray) -> np.ndarray:
        placed = path(warp_of(rises)(origin + length * moments))
        if align:
            placed = align_steps(target, placed).apply(placed)
        stiff = _STIFFNESS * (rises - rises.mean())
        return np.concatenate([(target - placed).ravel() / max(scale, 1e-9), stiff])

    return warp_of(least_squares(misfit, _rises_of(start, knots, origin, length)).x)


def _rises_of(start: Registration, knots: np.ndarray, origin: float, length: float) -> np.ndarray:
    """Return the r at which the spline follows the registered path, from its Greville abscissae."""
    n = len(knots) - _DEGREE - 1
    averages = np.array([knots[i + 1 : i + 1 + _DEGREE].mean() for i in range(n)])
    clock, first = np.unique(start.times[:, 0], return_index=True)
    rises = np.diff(np.interp(origin + length * averages, clock, start.times[first, 1]))
    return np.log(np.maximum(rises, 0.05 * rises.mean()))
