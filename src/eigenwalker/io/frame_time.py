"""Frame times of a few digits: the rates that they may mean, and the one that they do."""

from __future__ import annotations

import numpy as np

from eigenwalker.io.capture_file import CaptureFile

EXACT_HZ = (25, 50, 100, 200, 250, 500, 1000)
"""Usual rates whose frame times have three decimals or fewer: 0.01 is not rounded."""
MOST_USUAL_HZ = (120, 60, 30, 100, 240, 200, 50)
MAX_ROUNDING = 0.01
"""Frame times that are rounded by more than this share tell no rate."""
USUAL_RATES_HZ = (
    *(24, 25, 30, 48, 50, 60, 72, 75, 80, 90, 96, 100, 120, 125, 128, 144, 150, 160, 180, 192),
    *(200, 240, 250, 256, 300, 360, 400, 480, 500, 512, 600, 960, 1000),
    *(24000 / 1001, 30000 / 1001, 60000 / 1001, 120000 / 1001, 240000 / 1001),
)
MAX_DECIMALS = 5
"""With more, rounding changes no rate."""
TIME_NOISE_S = 1e-6
"""How exact seconds since 1970 are at least, as numbers of 8 bytes."""


def rate_of_step(
    file: CaptureFile, step: float, rounding: float, written: str, *, exact: bool = True
) -> tuple[float, dict[str, object]]:
    """Return the usual rate whose frame time is a step that was rounded, and attributes about it.

    `rounding` is the most by which the step is off, `written` what the file has, in words. Where
    several rates have that step it is said, and the most usual of them is taken. `exact` is whether
    a step that is the frame time of a rate in `EXACT_HZ` counts as not rounded.
    """
    near = [rate for rate in USUAL_RATES_HZ if abs(1 / rate - step) <= rounding]
    whole = [rate for rate in near if rate == int(rate)]
    nearest = float(min(whole or near or [1 / step], key=lambda rate: abs(1 / rate - step)))
    is_exact = nearest in EXACT_HZ and abs(step * nearest - 1) < 1e-9
    others = [rate for rate in (MOST_USUAL_HZ if is_exact else near) if rate in whole]
    is_sure = (is_exact and exact) or not set(others) - {nearest}
    if file.rate_hz or len(whole) < 2 or rounding < MAX_ROUNDING * step or is_sure:
        return nearest, {}
    usual = nearest if is_exact else next((r for r in MOST_USUAL_HZ if r in whole), nearest)
    least, most = 1 / (step + rounding), 1 / max(step - rounding, 1e-9)
    rounded = "may be rounded and then mean" if is_exact else "is rounded and may mean"
    reason = f"as its {written} {rounded} {least:.4g} to {most:.4g}"
    return file.frame_rate(file.default_rate_hz, usual_hz=float(usual), reason=reason)


def resolution_of(time: np.ndarray) -> float:
    """Return the power of ten of which all times are multiples, as they are if rounded to it.

    In seconds; 0 where there is none of `MAX_DECIMALS` or fewer.
    """
    since = time - time[0]
    for decimals in range(MAX_DECIMALS + 1):
        resolution = 10.0**-decimals
        if (np.abs(since - resolution * np.rint(since / resolution)) < TIME_NOISE_S).all():
            return resolution
    return 0.0


def rates_that_fit(time: np.ndarray, resolution: float) -> list[float]:
    """Return the rates of which times of all frames are the rounded ones, usual ones first."""
    length = time[-1] - time[0]
    if not (resolution > 0 and length > 0):
        return []
    frames = np.arange(len(time))
    about = frames[-1] / length
    slack = about * 1.01 * resolution / length
    usual = sorted(USUAL_RATES_HZ, key=lambda rate: (rate != int(rate), abs(rate - about)))
    near = [rate for rate in (*usual, round(about)) if rate and abs(rate - about) <= slack]
    fits = [rate for rate in near if np.ptp(time - frames / rate) <= 1.01 * resolution]
    return list(dict.fromkeys(map(float, fits)))
