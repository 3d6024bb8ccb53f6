"""One stride that repeats for ever, from a clip that holds two or more (P2)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike
from scipy.interpolate import CubicSpline

from eigenwalker.core.quaternions import between, quaternions_at, vectors_of
from eigenwalker.core.trajectories import check_trajectories, sampling_rate, trajectories_at
from eigenwalker.gait.frequency import BOUNDS_HZ, NoStrideError
from eigenwalker.gait.in_place import in_place
from eigenwalker.gait.steady_strides import closes, closing_step
from eigenwalker.metric.points import refuse_names_twice

REPEATS_BELOW = 0.4
"""Mean squared distance of postures a period apart, as a share of that of any two: above this
nothing repeats. Steady walks are below 0.05, acted exhaustion below 0.2."""

AS_DEEP = 3.0
"""A minimum of the self map counts as the period if it is at most this many times as high as the
lowest one: people repeat their stride of a moment ago not always best."""

SHALLOW = 0.02
"""Share by which a minimum may be higher whatever the lowest one is."""


OPEN_ABOVE = 0.12
"""Squared distance of the two ends of a single stride, as a share of that of any two postures,
above which it is none: of whole strides cut from steady captures it is below 0.11, mostly 0.04."""

_STILL_MM = 0.1
"""Way below which nothing moves."""
_FEWEST_FRAMES = 8
_LEAST_RATE_HZ = 8.0
"""Below these not even the harmonics of a slow stride show."""


@dataclass(frozen=True, eq=False)
class Loop:
    """A clip that goes over into its own beginning.

    Parameters
    ----------
    cycle : DataArray of shape (time, marker, axis)
        One period, evenly sampled from 0 s; after its last frame comes the first.
    period_s : float
        Seconds of the period.
    start_s : float
        Where in the clip the first of the two periods begins.
    seam_mm : float
        Distance, in the mean over markers, of the two postures that a cut would have joined.
    mismatch_mm : float
        Distance of corresponding postures in the two periods, in the mean over markers and time:
        what blending has averaged away.
    n_periods : int
        2 where two periods were blended; 1 where the clip holds one only, whose seam was spread
        over it.

    """

    cycle: xr.DataArray
    period_s: float
    start_s: float
    seam_mm: float
    mismatch_mm: float
    n_periods: int

    def __repr__(self) -> str:
        return (
            f"Loop({self.cycle.sizes['time']} frames, {self.cycle.sizes['marker']} markers, period "
            f"{self.period_s:.3f} s, seam {self.seam_mm:.1f} mm)"
        )

    def trajectories(self, time: ArrayLike | xr.DataArray) -> xr.DataArray:
        """Return the loop played on, at any times in seconds.

        Parameters
        ----------
        time : array of shape (time,)
            Seconds; 0 is the first frame of the cycle.

        Returns
        -------
        DataArray of shape (time, marker, axis)

        """
        time = np.atleast_1d(np.asarray(time, dtype=float))
        values = np.concatenate([self.cycle.values, self.cycle.values[:1]])
        frames = np.linspace(0, self.period_s, len(values))
        spline = CubicSpline(frames, values, bc_type="periodic")
        return trajectories_at(time, spline(time % self.period_s), self.cycle.marker.values)


def loop(clip: xr.DataArray, *, already_in_place: bool = False) -> Loop:
    """Return one period of a clip as a seamless cycle.

    As in Pražák et al. (2010, section 3 and fig. 1, left): the period is where the motion map of
    the clip with itself has its minima, and two periods are blended along the line of 45 degrees
    there. Which two is decided by where they differ least.

    Parameters
    ----------
    clip : DataArray of shape (time, marker, axis)
        Trajectories of someone who walks, or does something else over and over, at any frame rate.
        The steady strides are brought in place first (`in_place`).
    already_in_place : bool
        Whether to take the clip as it is, whole and where it is.

    Returns
    -------
    Loop
        Of two periods blended into one. A clip that holds one only is closed by spreading over it
        what lacks to its beginning.

    Raises
    ------
    ValueError
        If something is amiss with the clip; its subclass `NoStrideError` if there is less than one
        period, or nothing repeats.

    Examples
    --------
    >>> walk = ew.simulate_walk(seed=1, frequency_hz=0.8)
    >>> found = loop(walk)
    >>> round(found.period_s, 3), found.cycle.sizes["time"]
    (1.25, 150)

    """
    clip = check_trajectories(clip, complete=already_in_place)
    refuse_names_twice(clip.marker.values.tolist())
    rate_hz = sampling_rate(clip)
    if clip.sizes["time"] < _FEWEST_FRAMES or rate_hz < _LEAST_RATE_HZ:
        raise NoStrideError(
            f"{clip.sizes['time']} frames at {rate_hz:.3g} a second are too few to see a stride; a "
            f"loop needs {_FEWEST_FRAMES} or more at {_LEAST_RATE_HZ:.0f} a second or more."
        )
    walk = clip if already_in_place or _comes_from_in_place(clip) else in_place(clip)
    movement = walk.values[:, _moving(clip.sel(marker=walk.marker.values).values)]
    movement = movement.reshape(walk.sizes["time"], -1)
    period = period_of(movement, rate_hz) if movement.size else None
    if period is not None:
        return _blended(walk, period, rate_hz)
    once = walk.attrs.get("n_strides") == 1 or (len(movement) > 2 and closes(movement))
    if once and movement.size:
        return _closed(walk, movement, rate_hz)
    raise NoStrideError(
        f"Nothing repeats in these {len(movement) / rate_hz:.3g} s: no two postures some time "
        f"apart, from {1 / BOUNDS_HZ[1]:.2g} s to half the clip, are alike throughout. A loop "
        "needs two periods of one action."
    )


def _moving(values: np.ndarray) -> np.ndarray:
    """Return which markers move at all; others would tell of the way of who walks by."""
    away = np.abs(values - np.nan_to_num(values[:1]))
    return np.nan_to_num(away).max(axis=(0, 2)) > _STILL_MM


def _comes_from_in_place(clip: xr.DataArray) -> bool:
    """Return whether these are the strides that `in_place` kept, all of them and no others."""
    told = [clip.attrs.get(name) for name in ("steady_start_s", "steady_end_s")]
    return told == clip.time.values[[0, -1]].tolist() and not np.isnan(clip.values).any()


def period_of(movement: np.ndarray, rate_hz: float) -> float | None:
    """Return the period of a movement in frames, or None if it does not repeat.

    The lines of 45 degrees on which the self map has its minima. Minima at several periods are all
    used, since a stride is longer or shorter than the next.

    Parameters
    ----------
    movement : array of shape (time, feature)
        Positions, evenly sampled, in place.
    rate_hz : float
        Frames a second.

    Returns
    -------
    float or None
        To a fraction of a frame.

    Examples
    --------
    >>> angles = 2 * np.pi * np.arange(100) / 33.3
    >>> round(period_of(np.stack([np.sin(angles), np.cos(2 * angles)], axis=1), 30), 1)
    33.3

    """
    n_frames = len(movement)
    heights = _along_diagonals(movement)
    lags = np.arange(max(1, int(rate_hz / BOUNDS_HZ[1])), max(1, n_frames // 2 + 2))
    lags = lags[lags < len(heights) - 1]
    lags = lags[(heights[lags] < heights[lags - 1]) & (heights[lags] <= heights[lags + 1])]
    bottoms = [_bottom(heights, lag) for lag in lags.tolist()]
    lowest = min((height for _, height in bottoms), default=np.inf)
    if lowest > REPEATS_BELOW:
        return None
    period = next(lag for lag, height in bottoms if height <= AS_DEEP * lowest + SHALLOW)
    periods = [period]
    for count in range(2, int(n_frames / period)):
        near, reach = round(count * periods[-1]), max(1, round(period / 10))
        window = np.arange(max(near - reach, 1), min(near + reach + 1, len(heights) - 1))
        if not window.size:
            break
        periods.append(_bottom(heights, int(window[heights[window].argmin()]))[0] / count)
    return float(np.mean(periods))


def _along_diagonals(movement: np.ndarray) -> np.ndarray:
    """Means of the squared self map along its diagonals, as shares of twice the variance.

    ``|x_i - x_j|^2 = |x_i|^2 + |x_j|^2 - 2 x_i x_j``, and sums of the last term over a diagonal
    are an autocorrelation: no map is filled for them.
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


def _bottom(heights: np.ndarray, lag: int) -> tuple[float, float]:
    """Where a parabola through a minimum and its neighbours has its bottom, and how low it is."""
    before, here, after = heights[lag - 1 : lag + 2].tolist()
    bend = before - 2 * here + after
    if not bend > 0:
        return float(lag), here
    aside = min(max(0.5 * (before - after) / bend, -1.0), 1.0)
    return lag + aside, max(here - 0.5 * bend * aside**2, 0.0)


def _blended(walk: xr.DataArray, period: float, rate_hz: float) -> Loop:
    """The two successive periods that differ least, the second passing into the first."""
    n_frames, n_cycle = walk.sizes["time"], round(period)
    start = _least_mismatch(walk.values, period)
    piece = slice(start, min(start + int(np.ceil(2 * period)) + 2, n_frames))
    path = CubicSpline(np.arange(n_frames)[piece], walk.values[piece])
    within = np.arange(n_cycle) * period / n_cycle
    first = start + within
    second = np.minimum(first + period, n_frames - 1)
    weight = (1 - np.cos(np.pi * within / period))[:, None, None] / 2
    values = weight * path(first) + (1 - weight) * path(second)
    gaps = np.linalg.norm(path(first) - path(second), axis=2).mean(axis=1)
    cycle = _as_cycle(walk, values, period / rate_hz)
    if "rotation" in walk.coords:
        vectors = walk.rotation.values
        turns = between(
            quaternions_at(vectors, second), quaternions_at(vectors, first), weight[..., 0]
        )
        cycle = cycle.assign_coords(rotation=(walk.rotation.dims, vectors_of(turns)))
    return Loop(
        cycle,
        period_s=period / rate_hz,
        start_s=float(walk.time.values[0] + start / rate_hz),
        seam_mm=float(gaps[0]),
        mismatch_mm=float(gaps.mean()),
        n_periods=2,
    )


def _least_mismatch(values: np.ndarray, period: float) -> int:
    """Frame from which two periods differ least, most in their middle, where both are seen."""
    n_frames, whole = len(values), int(period)
    frames = np.arange(max(1, n_frames - whole - 1))
    after = np.minimum(frames + whole + 1, n_frames - 1)
    later = values[np.minimum(frames + whole, n_frames - 1)]
    apart = later + (period - whole) * (values[after] - later) - values[frames]
    squares = np.einsum("tma,tma->t", apart, apart)
    fading = np.sin(np.pi * (np.arange(round(period)) + 0.5) / round(period)) ** 2
    mismatch = np.convolve(squares, fading, "valid" if len(squares) >= len(fading) else "same")
    return int(mismatch[: max(1, int(n_frames - 2 * period) + 1)].argmin())


def _closed(walk: xr.DataArray, movement: np.ndarray, rate_hz: float) -> Loop:
    """The one period that a clip holds; what lacks to its beginning is spread over it."""
    values = walk.values
    n_frames = len(values)
    gap = values[-1] + closing_step(values) - values[0]
    lacking = movement[-1] + closing_step(movement) - movement[0]
    if lacking @ lacking > OPEN_ABOVE * 2 * movement.var(axis=0).sum():
        raise NoStrideError(
            f"The beginning and the end of this stride are {_mean_norm(gap):.0f} mm apart, too far "
            "for the same moment of it: it seems to be less than a whole one."
        )
    share = np.arange(n_frames) / n_frames - 0.5
    cycle = _as_cycle(walk, values - share[:, None, None] * gap, n_frames / rate_hz)
    if "rotation" in walk.coords:
        cycle = cycle.assign_coords(rotation=(walk.rotation.dims, walk.rotation.values))
    return Loop(
        cycle,
        period_s=n_frames / rate_hz,
        start_s=float(walk.time.values[0]),
        seam_mm=_mean_norm(gap),
        mismatch_mm=0.0,
        n_periods=1,
    )


def _mean_norm(ways: np.ndarray) -> float:
    return float(np.linalg.norm(ways, axis=1).mean())


def _as_cycle(walk: xr.DataArray, values: np.ndarray, period_s: float) -> xr.DataArray:
    time = np.arange(len(values)) * period_s / len(values)
    cycle = trajectories_at(time, values, walk.marker.values)
    return cycle.assign_attrs(walk.attrs, frequency_hz=1 / period_s, n_strides=1)
