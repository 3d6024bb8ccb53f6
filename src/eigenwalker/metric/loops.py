"""Loops: one seamless stride from a clip that holds two or more (Pražák et al. 2010, section 3)."""

from __future__ import annotations

from contextlib import suppress

import numpy as np
import xarray as xr
from scipy.interpolate import CubicSpline

from eigenwalker.core.quaternions import between, quaternions_at, vectors_of
from eigenwalker.core.smoothing import parabola_vertex
from eigenwalker.core.trajectories import (
    DIMS,
    check_trajectories,
    sampling_rate,
    trajectories_at,
)
from eigenwalker.gait.body_points import find_origin
from eigenwalker.gait.frequency import BOUNDS_HZ, NoStrideError
from eigenwalker.gait.in_place import in_place
from eigenwalker.gait.steady_strides import closes, closing_step
from eigenwalker.metric.clips import Clip, Loop, as_trajectories
from eigenwalker.metric.retargeting import is_mannequin

REPEATS_BELOW = 0.4
"""Mean squared distance of postures one period apart, relative to that of any two postures, above
which nothing repeats. Steady walks are below 0.05, acted exhaustion below 0.2."""

DEPTH_RATIO = 3.0
"""A minimum of the self map is the period if it is at most this many times as high as the lowest
one: two strides in succession are not always the most similar ones."""

DEPTH_MARGIN = 0.02
"""How much higher a minimum may be in any case."""

OPEN_ABOVE = 0.12
"""Squared distance between the ends of a single stride, relative to that of any two postures, above
which it is less than a stride. Whole strides of steady captures are below 0.11, mostly at 0.04."""

_STILL_MM = 0.1
"""Range of positions below which a marker does not move."""
_AT_ORIGIN_MM = 1e-6
"""Distance from the origin up to which a clip is in place."""
_MIN_FRAMES = 8
_MIN_RATE_HZ = 8.0
"""Below these not even the harmonics of a slow stride can be seen."""


def loop(clip: Clip, *, already_in_place: bool = False) -> Loop:
    r"""Return one period of a clip as a seamless cycle.

    The period T is where the motion map of the clip with itself has a minimum along its diagonals
    (`period_of`). Of all pairs of successive periods x(s + u) and x(s + T + u), 0 <= u < T, the
    one is taken with the least mismatch in its middle, where both are visible,

    .. math:: s = \arg\min_s \sum_u \sin^2\!\frac{\pi u}{T}\; \|x(s + u) - x(s + T + u)\|^2,

    and both are blended along the line of 45 degrees in the map, so that the second period passes
    into the first:

    .. math::

        y(u) = w(u)\, x(s + u) + (1 - w(u))\, x(s + T + u), \qquad
        w(u) = \tfrac12 \left(1 - \cos\frac{\pi u}{T}\right)

    Captured rotations are blended by the same weights. If the clip holds one period only, the
    difference between its end and its beginning is distributed linearly over it.

    Parameters
    ----------
    clip : DataArray of shape (time, marker, axis), Walker, Loop or PreparedClip
        A walk or another repeated action, at any frame rate. Of captures the steady strides are
        brought in place first (`in_place`), unless the clip is in place: without gaps, its origin
        (the mean pelvis on the floor) at 0 to within rounding. A loop is returned unchanged.
    already_in_place : bool
        Whether to take the clip whole and where it is.

    Returns
    -------
    Loop

    Raises
    ------
    ValueError
        If samples are missing for too long or markers share a name.
    NoStrideError
        A ValueError: if the clip holds less than one period, or nothing repeats.

    See Also
    --------
    prepare_walk : Also places the walk on a mannequin.

    References
    ----------
    Pražák et al. (2010), section 3 and fig. 1, left.

    Examples
    --------
    >>> walk = ew.simulate_walk(seed=1, frequency_hz=0.8)
    >>> stride = loop(walk)
    >>> round(stride.period_s, 3), stride.cycle.sizes["time"]
    (1.25, 150)
    """
    if isinstance(clip, Loop):
        return clip
    clip = check_trajectories(as_trajectories(clip), complete=already_in_place)
    rate_hz = sampling_rate(clip)
    if clip.sizes["time"] < _MIN_FRAMES or rate_hz < _MIN_RATE_HZ:
        raise NoStrideError(
            f"{clip.sizes['time']} frames at {rate_hz:.3g} a second are too few to see a stride; a "
            f"loop needs {_MIN_FRAMES} or more at {_MIN_RATE_HZ:.0f} a second or more."
        )
    walk = clip if already_in_place or _is_in_place(clip) else in_place(clip)
    movement = walk.values[:, _moving(clip.sel(marker=walk.marker.values).values)]
    movement = movement.reshape(walk.sizes["time"], -1)
    period = period_of(movement, rate_hz) if movement.size else None
    if period is not None:
        return _blended(walk, period, rate_hz)
    if movement.size and (closes(movement) or (not already_in_place and _is_one_stride(clip))):
        return _closed(walk, movement, rate_hz)
    raise NoStrideError(
        f"Nothing repeats in these {len(movement) / rate_hz:.3g} s: no two postures some time "
        f"apart, from {1 / BOUNDS_HZ[1]:.2g} s to half the clip, are alike throughout. A loop "
        "needs two periods of one action."
    )


def _is_in_place(clip: xr.DataArray) -> bool:
    """Return whether a clip is a walk as `in_place` gives it, perhaps shown on the mannequin."""
    if np.isnan(clip.values).any():
        return False
    origin = np.abs(find_origin(clip.values, clip.marker.values.tolist()))
    return bool((origin[:2] < _AT_ORIGIN_MM).all()) and (
        origin[2] < _AT_ORIGIN_MM or is_mannequin(clip)
    )


def _is_one_stride(clip: xr.DataArray) -> bool:
    with suppress(NoStrideError):
        return in_place(clip).attrs["n_strides"] == 1
    return False


def _moving(values: np.ndarray) -> np.ndarray:
    """Return which markers move; a fixed point of the room would show the progress of the walk."""
    distance = np.abs(values - np.nan_to_num(values[:1]))
    return np.nan_to_num(distance).max(axis=(0, 2)) > _STILL_MM


def period_of(movement: np.ndarray, rate_hz: float) -> float | None:
    r"""Return the period of a movement of shape (time, feature) in frames; None if nothing repeats.

    The mean of the squared self map along the diagonal of lag :math:`\tau`, relative to the mean
    over all pairs of frames,

    .. math:: h(\tau) = \frac{1}{2 \sigma^2 (n - \tau)} \sum_i \|x_i - x_{i + \tau}\|^2,

    has minima at multiples of the period. The period is the shortest lag, between the bounds of
    stride frequency and half the clip, with a minimum of at most
    ``DEPTH_RATIO * lowest + DEPTH_MARGIN``; minima are refined by parabolas. As strides differ in
    duration, the result is the mean of :math:`\tau_k / k` over the minima near all multiples k.
    """
    n_frames = len(movement)
    heights = _diagonal_means(movement)
    lags = np.arange(max(1, int(rate_hz / BOUNDS_HZ[1])), max(1, n_frames // 2 + 2))
    lags = lags[lags < len(heights) - 1]
    lags = lags[(heights[lags] < heights[lags - 1]) & (heights[lags] <= heights[lags + 1])]
    minima = [_refined_minimum(heights, lag) for lag in lags.tolist()]
    lowest = min((height for _, height in minima), default=np.inf)
    if lowest > REPEATS_BELOW:
        return None
    period = next(lag for lag, height in minima if height <= DEPTH_RATIO * lowest + DEPTH_MARGIN)
    periods = [period]
    for count in range(2, int(n_frames / period)):
        near, reach = round(count * periods[-1]), max(1, round(period / 10))
        window = np.arange(max(near - reach, 1), min(near + reach + 1, len(heights) - 1))
        if not window.size:
            break
        lag, _ = _refined_minimum(heights, int(window[heights[window].argmin()]))
        periods.append(lag / count)
    return float(np.mean(periods))


def _diagonal_means(movement: np.ndarray) -> np.ndarray:
    """Return h of `period_of` for every lag.

    ``|x_i - x_j|^2 = |x_i|^2 + |x_j|^2 - 2 x_i x_j``, and the last term summed along a diagonal is
    an autocorrelation, so no map is needed.
    """
    n = len(movement)
    centred = movement - movement.mean(axis=0)
    size = 1 << max(2 * n - 1, 1).bit_length()
    spectrum = np.fft.rfft(centred, size, axis=0)
    power = sum(np.einsum("fc,fc->f", part, part) for part in (spectrum.real, spectrum.imag))
    products = np.fft.irfft(power, size)[:n]
    sums = np.concatenate([[0], np.cumsum(np.einsum("tc,tc->t", centred, centred))])
    if not sums[-1] > 1e-9 * n:
        return np.ones(n)
    lags = np.arange(n)
    squares = sums[n - lags] + (sums[n] - sums[lags]) - 2 * products
    return squares / (n - lags) / (2 * sums[-1] / n)


def _refined_minimum(heights: np.ndarray, lag: int) -> tuple[float, float]:
    """Return the vertex of the parabola about a minimum, within one frame of it."""
    before, here, after = heights[lag - 1 : lag + 2].tolist()
    if not before - 2 * here + after > 0:
        return float(lag), here
    shift, height = parabola_vertex(before, here, after)
    return lag + min(max(shift, -1.0), 1.0), max(height, 0.0)


def _blended(walk: xr.DataArray, period: float, rate_hz: float) -> Loop:
    n_frames, n_cycle = walk.sizes["time"], round(period)
    start = _least_mismatch(walk.values, period)
    near = slice(start, min(start + int(np.ceil(2 * period)) + 2, n_frames))
    path = CubicSpline(np.arange(n_frames)[near], walk.values[near])
    within = np.arange(n_cycle) * period / n_cycle
    first = start + within
    second = np.minimum(first + period, n_frames - 1)
    weight = (1 - np.cos(np.pi * within / period))[:, None, None] / 2
    values = weight * path(first) + (1 - weight) * path(second)
    gaps = np.linalg.norm(path(first) - path(second), axis=2).mean(axis=1)
    rotation = None
    if "rotation" in walk.coords:
        start_q, stop_q = (quaternions_at(walk.rotation.values, at) for at in (second, first))
        rotation = vectors_of(between(start_q, stop_q, weight[..., 0]))
    return Loop(
        _as_cycle(walk, values, rotation, period / rate_hz),
        period_s=period / rate_hz,
        start_s=float(walk.time.values[0] + start / rate_hz),
        seam_mm=float(gaps[0]),
        mismatch_mm=float(gaps.mean()),
        n_periods=2,
    )


def _least_mismatch(values: np.ndarray, period: float) -> int:
    """Return the frame at which the two periods begin that differ least."""
    n_frames, whole = len(values), int(period)
    frames = np.arange(max(1, n_frames - whole - 1))
    later = values[np.minimum(frames + whole, n_frames - 1)]
    after = values[np.minimum(frames + whole + 1, n_frames - 1)]
    difference = later + (period - whole) * (after - later) - values[frames]
    squares = np.einsum("tma,tma->t", difference, difference)
    window = np.sin(np.pi * (np.arange(round(period)) + 0.5) / round(period)) ** 2
    mismatch = np.convolve(squares, window, "valid" if len(squares) >= len(window) else "same")
    return int(mismatch[: max(1, int(n_frames - 2 * period) + 1)].argmin())


def _closed(walk: xr.DataArray, movement: np.ndarray, rate_hz: float) -> Loop:
    values = walk.values
    n_frames = len(values)
    gap = values[-1] + closing_step(values) - values[0]
    moving_gap = movement[-1] + closing_step(movement) - movement[0]
    if moving_gap @ moving_gap > OPEN_ABOVE * 2 * movement.var(axis=0).sum():
        raise NoStrideError(
            f"The beginning and the end of this stride are {_mean_norm(gap):.0f} mm apart, too far "
            "for the same moment of it: it seems to be less than a whole one."
        )
    share = np.arange(n_frames) / n_frames - 0.5
    rotation = walk.rotation.values if "rotation" in walk.coords else None
    return Loop(
        _as_cycle(walk, values - share[:, None, None] * gap, rotation, n_frames / rate_hz),
        period_s=n_frames / rate_hz,
        start_s=float(walk.time.values[0]),
        seam_mm=_mean_norm(gap),
        mismatch_mm=0.0,
        n_periods=1,
    )


def _mean_norm(vectors: np.ndarray) -> float:
    return float(np.linalg.norm(vectors, axis=1).mean())


def _as_cycle(
    walk: xr.DataArray, values: np.ndarray, rotation: np.ndarray | None, period_s: float
) -> xr.DataArray:
    time = np.arange(len(values)) * period_s / len(values)
    cycle = trajectories_at(time, values, walk.marker.values)
    if rotation is not None:
        cycle = cycle.assign_coords(rotation=(DIMS, rotation))
    return cycle.assign_attrs(walk.attrs, frequency_hz=1 / period_s, n_strides=1)
