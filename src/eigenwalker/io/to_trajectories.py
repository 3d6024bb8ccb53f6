"""What all readers of tables end in: points with names -> trajectories in millimetres, z up."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np
import xarray as xr

from eigenwalker.core.trajectories import MILLIMETRES, label_trajectories
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.up_axis_and_unit import (
    PLAUSIBLE_MM,
    Unit,
    body_height,
    guess_unit,
    head_and_feet,
    turn_upright,
    up_axis,
)
from eigenwalker.markers.marker_sets import numbered, repeated

_SPELLINGS = {
    "millimeter": "mm",
    "millimetre": "mm",
    "centimeter": "cm",
    "centimetre": "cm",
    "meter": "m",
    "metre": "m",
    "inch": "in",
    "inches": "in",
    "foot": "ft",
    "feet": "ft",
}
_UNLABELLED = re.compile(r"\*\d*|u_?\d+|un(labell?ed|named|identified).*", re.IGNORECASE)


def unit_named(text: str) -> Unit | None:
    """Return the unit of length that a word names, in any spelling; None for other words.

    Examples
    --------
    >>> unit_named("Millimeters").name, unit_named("deg")
    ('mm', None)

    """
    word = text.strip().strip("[]()").lower()
    name = _SPELLINGS.get(word, _SPELLINGS.get(word.removesuffix("s"), word))
    return Unit(name, MILLIMETRES[name]) if name in MILLIMETRES else None


def without_zeros(positions: np.ndarray) -> np.ndarray:
    """Return positions with NaN for points at 0, 0, 0 exactly, where a format means that so."""
    return np.where((positions == 0).all(axis=2, keepdims=True), np.nan, positions)


def as_captured(
    positions: np.ndarray,
    names: Sequence[str],
    *,
    rate_hz: float,
    source: str,
    format_name: str,
    unit: Unit | None = None,
    file_unit: Unit | None = None,
    usual_unit: Unit | None = None,
    up: str | None = None,
    usual_up: str = "z",
    start_s: float = 0.0,
) -> xr.DataArray:
    """Return points of a table as trajectories.

    Unlabelled points, and a subject's name before all names, are left out.

    Parameters
    ----------
    positions : array of shape (time, marker, 3)
        In the unit and frame of the file; NaN where a point is missing.
    names : sequence of str
        One name a marker.
    rate_hz : float
        Frames a second.
    source, format_name : str
        Names of file and format.
    unit : Unit, optional
        Unit that the caller names.
    file_unit : Unit, optional
        Unit that the file names.
    usual_unit : Unit, optional
        Unit in which the format is mostly written. It is taken if head and feet, where they are
        known, then are as far apart as in people, within a factor of 2. Otherwise, the unit is
        guessed.
    up : str, optional
        Axis that the file says is up, such as ``"-y"``; the body tells if it is left out.
    usual_up : str
        Axis that is mostly up in this format, where neither file nor body tell.
    start_s : float
        Time of the first frame.

    Returns
    -------
    DataArray of shape (time, marker, axis)

    Raises
    ------
    UnreadableFile
        If there is no labelled point that was seen.

    """
    plain = [name.strip() for name in names]
    kept = [i for i, name in enumerate(plain) if name and not _UNLABELLED.fullmatch(_own(name))]
    positions = positions[:, kept]
    positions[np.isnan(positions).any(axis=2)] = np.nan
    if np.isnan(positions).all():
        came = f"{len(positions)} frames of {len(kept)} labelled points that were never seen"
        raise UnreadableFile(source, "positions of labelled points", came)
    names, subject = _without_subject(numbered([plain[i] for i in kept]))
    known_up = up or up_axis(positions, names)
    positions = positions @ turn_upright(known_up or usual_up).T
    usual = usual_unit if usual_unit and _fits(positions, names, usual_unit) else None
    named = unit or file_unit or usual
    taken = named or guess_unit(positions, names, source=source)
    walk = label_trajectories(
        positions * taken.millimetres, markers=names, rate_hz=rate_hz, start_s=start_s
    )
    walk.attrs.update(
        source=source,
        format=format_name,
        up_axis=known_up or usual_up,
        up_axis_known=known_up is not None,
        unit=taken.name,
        unit_guessed=named is None,
        unit_reason=taken.reason,
        subject=subject,
        left_out=[name for i, name in enumerate(plain) if i not in set(kept)],
        repeated=repeated([plain[i] for i in kept]),
    )
    return walk


def _fits(positions: np.ndarray, names: Sequence[str], unit: Unit) -> bool:
    """Return whether a body is between half and twice as tall as people, or cannot be measured."""
    if not all(part.size for part in head_and_feet(positions, names)):
        return True
    height = body_height(positions, names) * unit.millimetres
    return not (height < PLAUSIBLE_MM[0] / 2 or height > PLAUSIBLE_MM[1] * 2)


def _own(name: str) -> str:
    return name.rpartition(":")[2].strip()


def _without_subject(names: list[str]) -> tuple[list[str], str]:
    """Return the names without the one subject that stands before them, and the subject."""
    subjects = {name.rpartition(":")[0] for name in names} - {""}
    plain = [_own(name) for name in names]
    if len(subjects) != 1 or len(set(plain)) < len(plain) or not all(plain):
        return names, ""
    return plain, subjects.pop()
