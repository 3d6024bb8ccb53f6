"""Frames a second, for files that do not say."""

from __future__ import annotations

import warnings


class RateAssumed(UserWarning):
    """A file names no frame rate, so the usual one of its kind was taken.

    Silence it with ``warnings.simplefilter("ignore", RateAssumed)``, or name the rate:
    ``read_mocap(path, rate_hz=120)``.
    """


def assume_rate(rate_hz: float, *, source: str, reason: str) -> dict[str, object]:
    """Warn that a rate is assumed, and return what the attributes of the capture say of it.

    Parameters
    ----------
    rate_hz : float
        Frames a second, as they usually are in files of this kind.
    source : str
        Name of the file, for the warning.
    reason : str
        Why this rate was taken.

    Returns
    -------
    dict
        ``rate_assumed`` and ``rate_reason``.

    Examples
    --------
    >>> with warnings.catch_warnings():
    ...     warnings.simplefilter("ignore", RateAssumed)
    ...     assume_rate(120, source="a.amc", reason="as in the CMU collection")
    {'rate_assumed': True, 'rate_reason': 'as in the CMU collection'}

    """
    warnings.warn(
        f"{source} names no frame rate; {rate_hz:g} frames a second are assumed, {reason}. "
        f"Name it to be sure: read_mocap(..., rate_hz={rate_hz:g}).",
        RateAssumed,
        stacklevel=4,  # who called read_mocap
    )
    return {"rate_assumed": True, "rate_reason": reason}
