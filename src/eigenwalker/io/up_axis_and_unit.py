"""Which way is up, and how long a unit is: found from where head and feet are."""

from __future__ import annotations

import re
import warnings
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

UPRIGHT = 3.0
"""How many times further head and feet must be apart along up than along the other axes."""
PERSON_MM = 1600.0
"""A height between a child's and a tall man's, to which guessed units are held."""
PLAUSIBLE_MM = (800.0, 2300.0)
UNITS = {"mm": 1.0, "cm": 10.0, "in": 25.4, "asf": 25.4 / 0.45, "m": 1000.0}
"""Millimetres a unit, for the units that files without one are written in.

``"asf"`` is the length unit of the Acclaim skeletons of the CMU collection: inches over 0.45.
"""

_HIGH = re.compile(r"head|hd$|skull|nose|vertex|glabella|^sgl$")
_NEXT_HIGH = re.compile(r"neck|^c7$|cv7|clav")
_HIPS = re.compile(r"hip|pelv|asis|psis|[lr](asi|psi|ias|ips)$|sacr|troch|gtr$|iliac|waist|upleg")
_KNEES = re.compile(r"knee|kne$|kn[ei]$|[lr](fle|fme|kne)$|patella|lowerleg|shank|tib")
_LOW = re.compile(r"foot|toe|heel|hee$|ankle|ank$|mt\d$|metatars|malle|^[lr]f(al|cc)$")


class UnitGuessed(UserWarning):
    """A file names no unit of length, so it was guessed from the height of the body.

    Silence it with ``warnings.simplefilter("ignore", UnitGuessed)``, or name the unit:
    ``read_mocap(path, unit="cm")``.

    See Also
    --------
    read_mocap : Gives it; ``default_unit`` answers it.
    """


class UpAxisAssumed(UserWarning):
    """The body stands along another axis than the one that its file names as upward.

    Silence it with ``warnings.simplefilter("ignore", UpAxisAssumed)``.

    See Also
    --------
    read_mocap : Gives it.
    """


class Unit(NamedTuple):
    """A unit of length, how long it is, and why it was taken (empty where a file names it)."""

    name: str
    millimetres: float
    reason: str = ""


def head_and_feet(positions: np.ndarray, names: Sequence[str]) -> tuple[np.ndarray, np.ndarray]:
    """Return the points at the head and those at the feet, two arrays (time, some markers, 3)."""
    plain = _plain(names)
    high = _matching(positions, plain, _HIGH)
    high = high if high.size else _matching(positions, plain, _NEXT_HIGH)
    return high, _matching(positions, plain, _LOW)


def _plain(names: Sequence[str]) -> list[str]:
    return [re.sub(r"[^a-z0-9]", "", name.rsplit(":", 1)[-1].lower()) for name in names]


def _matching(
    positions: np.ndarray, plain_names: Sequence[str], pattern: re.Pattern[str]
) -> np.ndarray:
    return positions[:, [i for i, name in enumerate(plain_names) if pattern.search(name)]]


def up_axis(positions: np.ndarray, names: Sequence[str]) -> str | None:
    """Return the axis along which the body stands, such as ``"z"`` or ``"-y"``.

    By where the head is above the feet; of half a body, neck or hips above knees or feet. In the
    middle of the frames, so that single wild samples do not count. None where names or posture
    leave it open.
    """
    high, low = head_and_feet(positions, names)
    plain = _plain(names)
    if not high.size:
        high = _matching(positions, plain, _HIPS)
    if not low.size:
        low = _matching(positions, plain, _KNEES)
    if not high.size or not low.size:
        return None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # frames without a sample give NaN
        rises = np.nanmean(high, axis=1) - np.nanmean(low, axis=1)
        rise = np.nanmedian(rises, axis=0)
        if np.isnan(rise).any():  # never seen in one frame
            rise = np.nanmedian(high, axis=(0, 1)) - np.nanmedian(low, axis=(0, 1))
    if np.isnan(rise).any():
        return None
    axis = int(np.abs(rise).argmax())
    if abs(rise[axis]) <= UPRIGHT * np.abs(np.delete(rise, axis)).max():
        return None
    return ("-" if rise[axis] < 0 else "") + "xyz"[axis]


def turn_upright(up: str) -> np.ndarray:
    """Return the rotation matrix that turns the axis `up` into z.

    The axes are exchanged in turn, so that a body which faces z in a y-up frame faces x.
    """
    axis = "xyz".index(up[-1])
    turn = np.eye(3)[[(axis + 1) % 3, (axis + 2) % 3, axis]]
    return np.diag([1.0, -1.0, -1.0]) @ turn if up.startswith("-") else turn


def body_height(positions: np.ndarray, names: Sequence[str]) -> float:
    """Return how tall a body is: from the lowest point of the feet to the highest of the head.

    Of all points, where names tell neither; in the middle of the frames.
    """
    high, low = head_and_feet(positions, names)
    if not high.size or not low.size:
        high = low = positions
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # frames without a sample give NaN
        height = np.nanmedian(np.nanmax(high[..., 2], axis=1) - np.nanmin(low[..., 2], axis=1))
    return float(height) if height > 0 else np.nan


def guess_unit(positions: np.ndarray, names: Sequence[str], *, source: str) -> Unit:
    """Return the unit in which a body is as tall as people are, and warn that it is a guess."""
    height = body_height(positions, names)
    name = "mm"
    if not np.isnan(height):
        name = min(UNITS, key=lambda unit: abs(np.log(height * UNITS[unit] / PERSON_MM)))
    tall = height * UNITS[name]
    if PLAUSIBLE_MM[0] <= tall <= PLAUSIBLE_MM[1]:
        reason = f"from head to foot the body measures {height:.4g}, which is {tall:.0f} mm"
    else:
        reason = (
            f"the body measures {height:.4g} from head to foot, which makes no person "
            f"in any known unit ({tall:.0f} mm here)"
        )
    reason += f" if the unit is {name}" + (" (inch/0.45)" if name == "asf" else "")
    warnings.warn(
        f"{source} names no unit of length; {reason}. Name it to be sure: "
        f"read_mocap(..., unit={name!r}).",
        UnitGuessed,
        stacklevel=4,  # who called read_mocap
    )
    return Unit(name, UNITS[name], reason)
