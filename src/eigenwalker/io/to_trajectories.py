"""The last step of every reader: named points -> trajectories in millimetres, z up."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from eigenwalker.core.quaternions import Rotation, product
from eigenwalker.core.trajectories import DIMS, MILLIMETRES, label_trajectories
from eigenwalker.io.capture_file import CaptureFile
from eigenwalker.io.up_axis_and_unit import (
    PLAUSIBLE_MM,
    Unit,
    UpAxisAssumed,
    body_height,
    guess_unit,
    head_and_feet,
    turn_upright,
    up_axis,
)
from eigenwalker.markers.marker_sets import MEASURED, numbered, repeated

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


def unit_named(text: str) -> Unit | None:
    """Return the unit of length that a word names, in any spelling; None for other words."""
    word = text.strip().strip("[]()").lower()
    name = _SPELLINGS.get(word, _SPELLINGS.get(word.removesuffix("s"), word))
    return Unit(name, MILLIMETRES[name]) if name in MILLIMETRES else None


def without_zeros(positions: np.ndarray, *, unless_always: bool = False) -> np.ndarray:
    """Return positions with NaN for points at 0, 0, 0 exactly, where a format means that so.

    With `unless_always`, a point that is at 0, 0, 0 in all frames stays there.
    """
    at_zero = (positions == 0).all(axis=2)
    if unless_always:
        at_zero &= ~at_zero.all(axis=0)
    return np.where(at_zero[..., None], np.nan, positions)


def without_subject(names: Sequence[str]) -> tuple[list[str], str]:
    """Return the names without the one subject before them (``Anna:LKNE``), and the subject."""
    subjects = {name.rpartition(":")[0] for name in names} - {""}
    plain = [own_name(name) for name in names]
    if len(subjects) != 1 or len(set(plain)) < len(plain) or not all(plain):
        return list(names), ""
    return plain, subjects.pop()


def labelled_points(
    positions: np.ndarray, names: Sequence[str], is_labelled: Callable[[str], bool]
) -> tuple[np.ndarray, list[str], dict[str, object]]:
    """Return positions and names of the points that a person labelled, and attributes.

    The subject's name before all names is taken off. ``subject``, ``left_out`` and ``repeated`` are
    the attributes.
    """
    names = [name.strip() for name in names]
    labelled = [i for i, name in enumerate(names) if is_labelled(name)]
    left_out = [name for name in names if not is_labelled(name)]
    names = [names[i] for i in labelled]
    plain, subject = without_subject(numbered(names))
    attrs: dict[str, object] = {"subject": subject, "left_out": left_out}
    attrs["repeated"] = repeated(names)
    return positions[:, labelled], plain, attrs


def own_name(name: str) -> str:
    """Return the name of a marker without that of its subject."""
    return name.rpartition(":")[2].strip()


class FileFrame(NamedTuple):
    """Unit and upward axis as a file names them, and the usual ones of its format."""

    unit: Unit | None = None
    usual_unit: Unit | None = None
    up: str | None = None
    usual_up: str = "z"
    up_is_sure: bool = False
    """Whether a person named the axis, so that it counts even if the body stands otherwise."""


def trajectories_of(
    file: CaptureFile,
    positions: np.ndarray,
    names: Sequence[str],
    *,
    format_name: str,
    rate_hz: float,
    start_s: float = 0.0,
    frame: FileFrame,
    quaternions: np.ndarray | None = None,
    unit_source: str | None = None,
) -> xr.DataArray:
    """Return the points of a file as trajectories, upright and in millimetres.

    `positions` (time, marker, 3) and `quaternions` (time, marker, 4; x, y, z, w) are in the unit
    and frame of the file. The unit is the one that the caller or the file names, else the caller's
    default, else the usual one of the format, if head and feet are then as far apart as in people,
    within a factor of 2. Otherwise it is guessed from the height of the body. Up is the axis along
    which the body stands, else the one that the file names, else the usual one of the format.
    """
    unit, usual_unit, named_up, usual_up, _ = frame
    body_up = None if frame.up_is_sure and named_up else up_axis(positions, names)
    known_up = body_up or named_up
    up_reason = ""
    if named_up and known_up != named_up:
        up_reason = f"the file names {named_up} as upward, but the body stands along {body_up}"
        warnings.warn(f"{file.name}: {up_reason}, which counts.", UpAxisAssumed, stacklevel=4)
    turn = turn_upright(known_up or usual_up)
    positions = positions @ turn.T
    usual = usual_unit if usual_unit and _fits_a_body(positions, names, usual_unit) else None
    known_unit = file.unit or unit or file.default_unit or usual
    used = known_unit or guess_unit(positions, names, source=unit_source or file.name)
    walk = label_trajectories(
        positions * used.millimetres, markers=names, rate_hz=rate_hz, start_s=start_s
    )
    if quaternions is not None:
        turned = product(Rotation.from_matrix(turn).as_quat(), quaternions).reshape(-1, 4)
        vectors = Rotation.from_quat(turned).as_rotvec().reshape(walk.shape)
        walk = with_coordinate(walk, "rotation", vectors)
    walk.attrs.update(
        source=file.name,
        format=format_name,
        up_axis=known_up or usual_up,
        up_axis_known=known_up is not None,
        up_axis_reason=up_reason,
        unit=used.name,
        unit_guessed=known_unit is None,
        unit_reason=used.reason,
    )
    return walk


def with_coordinate(walk: Any, name: str, values: np.ndarray) -> xr.DataArray:
    """Return trajectories with a coordinate of shape (time, marker, axis), or fewer of these."""
    return walk.assign_coords({name: (DIMS[: values.ndim], values)})


def with_scalars(walk: Any, known: Mapping[str, object]) -> xr.DataArray:
    """Return trajectories with coordinates for what is known of a capture and used later.

    Lengths that were measured on the person, and the speed of a walk that is in place.
    """
    used = [name for name in known if name.endswith(MEASURED)]
    used += ["speed_mm_s"] if {"speed_mm_s", "heading_deg"} <= set(known) else []
    numbers = {name: known[name] for name in used if isinstance(known[name], int | float)}
    return walk.assign_coords(numbers)


def _fits_a_body(positions: np.ndarray, names: Sequence[str], unit: Unit) -> bool:
    """Return whether a body is between half and twice as tall as people, or cannot be measured."""
    if not all(part.size for part in head_and_feet(positions, names)):
        return True
    height = body_height(positions, names) * unit.millimetres
    return not (height < PLAUSIBLE_MM[0] / 2 or height > PLAUSIBLE_MM[1] * 2)
