"""When frames were taken: declared rates, written times, and what to do where they differ."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from eigenwalker.io.capture_file import CaptureFile
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.frame_time import (
    MAX_ROUNDING,
    TIME_NOISE_S,
    rate_of_step,
    rates_that_fit,
    resolution_of,
)

RATES_HZ = (0.1, 1e5)
"""No capture has fewer or more frames a second."""
MAX_DISAGREEMENT = 0.01
"""How much, as a share, a declared rate and that of written times may differ."""
MAX_JITTER = 0.1
"""Times that are off an even clock by less than this share of a frame count as rounded."""
MAX_GAPS = 10
"""A table with fewer than one in this many frames is no capture."""

MAX_START_S = 1e7
"""Captures whose clock shows a later time than this are counted from their first frame."""
MIN_FITTED = 20
"""Fewer frames at rounded times show no rate, as one that is left out looks like rounding."""
MAX_ROUNDING_S = 0.0101
"""How far written times may be off a declared rate: they were rounded to 0.01 s or better."""

TIME_UNITS = {
    **dict.fromkeys(("s", "sec", "second", "seconds", "iso"), 1.0),
    **dict.fromkeys(("ms", "millisecond", "milliseconds"), 1e-3),
    **dict.fromkeys(("us", "µs", "microsecond", "microseconds"), 1e-6),
    **dict.fromkeys(("ns", "nanosecond", "nanoseconds"), 1e-9),
}
"""Seconds in each unit of time, by the words for it."""
_USUAL_STEPS = ((1.0, "s"), (1e3, "ms"), (1e6, "us"))
_RATE = re.compile(r"(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?", re.ASCII)


class TimedPositions(NamedTuple):
    """Positions at evenly spaced times: frames a second, time of the first frame, attributes."""

    positions: np.ndarray
    rate_hz: float
    start_s: float = 0.0
    attrs: Mapping[str, object] = {}


def parse_rate(word: str, where: str, file: CaptureFile) -> float:
    """Return the frames a second that a file declares."""
    word = word.replace(",", ".")
    rate = float(word) if _RATE.fullmatch(word) else 0.0
    if not RATES_HZ[0] <= rate <= RATES_HZ[1]:
        raise file.error(
            f"frames a second between {RATES_HZ[0]:g} and {RATES_HZ[1]:g} as {where}",
            repr(word[:40]),
            "put it right, or name it: read_mocap(..., rate_hz=...)",
        )
    return rate


def declared_rate(file: CaptureFile, word: str, where: str) -> float:
    """Return the frames a second that a file declares, or that the caller names instead."""
    if file.rate_hz is not None:
        return file.rate_hz
    try:
        return parse_rate(word, where, file)
    except UnreadableFile:
        if file.default_rate_hz is None:
            raise
        return file.default_rate_hz


def counts_frames(time: np.ndarray) -> bool:
    """Return whether times go on in whole steps of 1, as the numbers of frames do."""
    steps = np.diff(time)
    return bool(len(steps) and np.median(steps) == 1 and (steps == np.rint(steps)).all())


def usual_unit(time: np.ndarray, rate_hz: float | None = None) -> str:
    """Return the unit in which the steps of times are those of captures.

    It is the one that makes them steps of `rate_hz`, where the file declares it. Otherwise steps
    below 1 are seconds, below 1000 milliseconds, below 10^6 microseconds, else nanoseconds.
    """
    steps = np.diff(time)
    step = float(min(np.median(steps[steps > 0]), steps.mean())) if (steps > 0).any() else 0.0
    if rate_hz and step:
        fits = {
            unit: abs(step * TIME_UNITS[unit] * rate_hz - 1) for unit in ("s", "ms", "us", "ns")
        }
        best = min(fits, key=lambda unit: fits[unit])
        return best if fits[best] < 0.5 else "s"
    return next((unit for most, unit in _USUAL_STEPS if step < most), "ns")


def in_seconds(time: np.ndarray, unit: str) -> np.ndarray:
    """Return times in seconds that are in one of `TIME_UNITS`."""
    scale = TIME_UNITS[unit]
    return time[0] * scale + (time - time[0]) * scale if len(time) else time


def clock_in_seconds(
    file: CaptureFile, time: np.ndarray, unit: str | None, rate_hz: float | None
) -> tuple[np.ndarray, str, dict[str, object]]:
    """Return written times in seconds, the unit in which they are written, and attributes.

    The unit is guessed (`usual_unit`) where the file names none. Of a clock that began long before
    the capture, times are counted from the first frame. Times that say nothing, of a file that
    declares its rate, become those of its frames.
    """
    attrs: dict[str, object] = {}
    if not len(time):
        return time, "s", attrs
    if rate_hz and (says_nothing(time) or (unit is None and counts_frames(time))):
        return np.arange(len(time)) / rate_hz, "s", attrs
    if unit is None and not rate_hz and counts_frames(time) and file.rate_hz is None:
        expected, name_it = "times in seconds", "name the rate: read_mocap(..., rate_hz=...)"
        got = "times in whole steps of 1, which number the frames or lack their unit"
        if file.default_rate_hz is None:
            raise file.error(expected, got, name_it)
        return np.arange(len(time)) / file.default_rate_hz, "s", attrs
    known = unit or usual_unit(time, rate_hz)
    if known != "s" and not unit:
        attrs["time_unit_guessed"] = known
    time = in_seconds(time, known)
    if abs(time[0]) > MAX_START_S:
        attrs["clock_start_s"] = float(time[0])
        time = time - time[0]
    return time, known, attrs


def says_nothing(time: np.ndarray) -> bool:
    """Return whether no time is written, or the same in all frames."""
    return bool(np.isnan(time).all() or (time == time[0]).all())


def on_clock(
    file: CaptureFile,
    positions: np.ndarray,
    time: np.ndarray,
    rate_hz: float | None = None,
    *,
    resolution_s: float = 0.0,
) -> TimedPositions:
    """Return positions at even times: at the rate that the caller names, else by written times.

    `time` is in seconds, `rate_hz` what the file declares, and `resolution_s` the last decimal in
    which all times are written, as where they were rounded; 0 where it is not known. The caller's
    default rate counts where the times are unusable.
    """
    if file.rate_hz is not None:
        return TimedPositions(positions, file.rate_hz)
    try:
        return on_even_clock(file, positions, time, rate_hz, resolution_s=resolution_s)
    except UnreadableFile:
        if file.default_rate_hz is None:
            raise
        return TimedPositions(positions, file.default_rate_hz)


def on_even_clock(
    file: CaptureFile,
    positions: np.ndarray,
    time: np.ndarray,
    rate_hz: float | None = None,
    *,
    resolution_s: float = 0.0,
) -> TimedPositions:
    """Return positions taken at the given times as frames of an even clock.

    Frames that were left out become missing ones. Times that jitter, as those of cameras do, are
    interpolated; times of a few digits are those of the usual rate that gives them, once rounded.
    Refused are times that go back, or that do not fit the declared rate.
    """
    steps = np.diff(time)
    if rate_hz and _fits_rate(time, rate_hz):
        return TimedPositions(positions, rate_hz, float(time[0]))
    if rounded := _rounded(file, time, rate_hz, resolution_s):
        return TimedPositions(positions, rounded[0], float(time[0]), rounded[1])
    if not np.isfinite(time).all() or not (steps > 0).all():
        raise _stops(file, time)
    if len(time) < 2:
        if rate_hz is None:
            raise file.error("two frames or more", f"{len(time)}")
        return TimedPositions(positions, rate_hz, float(time[0]) if len(time) else 0.0)
    step = 1 / rate_hz if rate_hz else float(np.median(steps))
    frames = np.concatenate([[0], np.cumsum(np.maximum(np.rint(steps / step), 1))])
    length = time[-1] - time[0]
    written = frames[-1] / length
    agree = abs(length - frames[-1] * step) <= MAX_DISAGREEMENT * length + 0.5 * step
    if rate_hz and not (agree and np.median(steps) < 1.5 * step):
        raise file.error(
            f"times of {rate_hz:g} frames a second, as it declares",
            f"{1 / float(np.median(steps)):.4g}",
            "put one of them right, or name the rate: read_mocap(..., rate_hz=...)",
        )
    rate = rate_hz or _without_rounding(written, length)
    if not RATES_HZ[0] <= rate <= RATES_HZ[1] or frames[-1] > MAX_GAPS * len(time):
        got = f"{written:.4g}, with {int(frames[-1]) + 1 - len(time)} frames left out"
        raise file.error("times of a capture", got, "are they seconds?")
    n_frames = int(frames[-1]) + 1
    even = np.full((n_frames, *positions.shape[1:]), np.nan)
    even[frames.astype(int)] = positions
    jitter = np.abs(time - time[0] - frames / written) / step
    if rate_hz is None and jitter.max() > MAX_JITTER:
        even = _interpolated(positions, time, time[0] + np.arange(n_frames) / rate, step)
    return TimedPositions(even, float(rate), float(time[0]))


def _rounded(
    file: CaptureFile, time: np.ndarray, rate_hz: float | None, resolution_s: float
) -> tuple[float, dict[str, object]] | None:
    """Return the rate of frames that all are there at rounded times, and attributes about it.

    None where times do not show it.
    """
    if len(time) < 3 or not np.isfinite(time).all() or not time[0] < time[-1]:
        return None
    steps = np.diff(time)
    step = float(time[-1] - time[0]) / len(steps)
    resolution = resolution_s or resolution_of(time)
    if (steps < -TIME_NOISE_S).any() or resolution < TIME_NOISE_S:
        return None
    note: dict[str, object] = {}
    if resolution > MAX_ROUNDING * step:
        note = {"rate_reason": f"as its times are rounded to {resolution:g} s"}
    if np.ptp(steps) < TIME_NOISE_S:  # one step was rounded, and then counted up
        rounding = 0.5000001 * resolution
        if rate_hz:
            return (rate_hz, note) if abs(1 / rate_hz - step) <= rounding else None
        written = f"step of {step:.6g} s"
        rate, assumed = rate_of_step(file, step, rounding, written, exact=not resolution_s)
        return rate, assumed or ({} if abs(rate * step - 1) < 1e-6 else note)
    fits = rates_that_fit(time, resolution) if len(time) >= MIN_FITTED else []
    if rate_hz or not fits:
        return (rate_hz, note) if rate_hz in fits else None
    whole = [rate for rate in fits if rate == int(rate)]
    if len(whole) < 2:
        return fits[0], note
    if (steps < 0.5 * resolution).any():
        return None  # too few digits: several frames have one time
    reason = f"as its times are rounded to {resolution:g} s and fit {whole[0]:g} and {whole[1]:g}"
    return file.frame_rate(file.default_rate_hz, usual_hz=fits[0], reason=reason)


def _stops(file: CaptureFile, time: np.ndarray) -> UnreadableFile:
    """Return the error for times that do not go on, which names the reason if it is seen."""
    steps = np.diff(time)
    late = int(np.argmin(np.append(steps > 0, False))) + 2
    pair = time[max(late - 2, 0) : late]
    got = f"{', then '.join(f'{each:.10g}' for each in pair)} s at frame {late} of the table"
    if (steps >= 0).all():  # which leaves out NaN
        digits = ": none differs" if time[0] == time[-1] else f" {resolution_of(time) or 1e-6:g} s"
        got += f"; the times have too few digits, of{digits}" if ":" not in digits else digits
    name_it = "name the rate instead: read_mocap(..., rate_hz=...)"
    return file.error("times that go on", got, name_it)


def _fits_rate(time: np.ndarray, rate_hz: float) -> bool:
    """Return whether times are those of a rate, but for the decimals that were rounded off."""
    if not len(time):
        return False
    off = np.abs(time - time[0] - np.arange(len(time)) / rate_hz)
    half_frame = 0.5 / rate_hz
    return bool((off <= (max(MAX_ROUNDING_S, half_frame) if len(time) > 3 else half_frame)).all())


def _without_rounding(rate: float, length: float) -> float:
    """Return the whole rate that written times mean, if they were rounded to milliseconds."""
    whole = round(rate)
    return float(whole) if whole and abs(1 - rate / whole) * length < 1.1e-3 else rate


def _interpolated(
    positions: np.ndarray, time: np.ndarray, even: np.ndarray, step: float
) -> np.ndarray:
    """Return positions at even times, missing where either neighbour in time is."""
    after = np.clip(np.searchsorted(time, even), 1, len(time) - 1)
    before = after - 1
    share = ((even - time[before]) / (time[after] - time[before])).clip(0, 1)[:, None, None]
    between = positions[before] * (1 - share) + positions[after] * share
    between[(time[after] - time[before]) > 2.5 * step] = np.nan
    return between
