"""C3D files: the samples of markers, as most laboratories keep them."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np
import xarray as xr

from eigenwalker.core.trajectories import MILLIMETRES, label_trajectories
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.readers.c3d_sections import MAGIC, Header, Parameters, c3d_sections
from eigenwalker.io.up_axis_and_unit import Unit, guess_unit, turn_upright, up_axis
from eigenwalker.markers.marker_sets import numbered, repeated

_UNLABELLED = re.compile(
    r"\*\d*|u_\d+|new[ _]?\d+|un(labell?ed|named|identified).*|no[ _]?name.*", re.IGNORECASE
)
_NO_POSITION = re.compile(r"(Angles?|Forces?|Moments?|Powers?|GRF)\d*$")
_NO_POSITION_GROUPS = ("ANGLES", "FORCES", "MOMENTS", "POWERS", "SCALARS", "REACTIONS")
_MEASURES = {
    "LEGLENGTH": "leg_length",
    "KNEEWIDTH": "knee_width",
    "ANKLEWIDTH": "ankle_width",
    "ELBOWWIDTH": "elbow_width",
    "WRISTWIDTH": "wrist_width",
    "SHOULDEROFFSET": "shoulder_offset",
}
_SPELLINGS = {
    "millimeters": "mm",
    "millimetres": "mm",
    "centimeters": "cm",
    "centimetres": "cm",
    "meters": "m",
    "metres": "m",
    "meter": "m",
    "metre": "m",
    "inches": "in",
    "inch": "in",
    "feet": "ft",
}


def looks_like_c3d(content: bytes) -> bool:
    """Return whether a file begins as C3D files do."""
    return len(content) > 1 and content[1] == MAGIC and content[0] > 0


def read_c3d(content: bytes, *, source: str, unit: Unit | None = None) -> xr.DataArray:
    """Return where the markers of a C3D file are.

    Angles, forces, moments, powers and unlabelled points are left out, and named in
    ``attrs["left_out"]``; what a laboratory's model computed as positions stays.

    Parameters
    ----------
    content : bytes
        The whole file.
    source : str
        Its name, for messages.
    unit : Unit, optional
        Unit of its lengths, where the file names none or the wrong one.

    Returns
    -------
    DataArray of shape (time, marker, axis)
        In millimetres, z up, on the clock of the capture: its first frame is frame 1 at 0 s, and
        a file may begin later. NaN where a marker was not seen.

    Raises
    ------
    UnreadableFile
        If the file is no C3D, damaged or cut short.

    """
    header, parameters, samples = c3d_sections(content, source)
    rate_hz = _rate(header, parameters, source)
    positions, names, left_out = _markers(samples, parameters, source)
    twice = repeated(names)
    names, subject = _without_subject(numbered(names))
    up, up_known = _up(positions, names, parameters)
    positions = positions @ turn_upright(up).T
    named = unit or _unit(parameters)
    unit = named or guess_unit(positions, names, source=source)
    walk = label_trajectories(
        positions * unit.millimetres,
        markers=names,
        rate_hz=rate_hz,
        start_s=max(header.first_frame - 1, 0) / rate_hz,
    )
    walk.attrs.update(
        source=source,
        format="C3D",
        up_axis=up,
        up_axis_known=up_known,
        unit=unit.name,
        unit_guessed=named is None,
        unit_reason=unit.reason,
        subject=subject,
        left_out=left_out,
        repeated=twice,
        **_measures(parameters),
    )
    return walk


def _rate(header: Header, parameters: Parameters, source: str) -> float:
    rates = (parameters.number("POINT:RATE"), header.rate_hz)
    sound = [rate for rate in rates if rate is not None and np.isfinite(rate) and rate > 0]
    if not sound or max(sound) > 1.01 * min(sound) or not 0.1 <= sound[0] <= 1e5:
        raise UnreadableFile(
            source,
            "one frame rate in header and parameters",
            f"{header.rate_hz} and {rates[0]}",
        )
    return round(sound[0], 6)


def _markers(
    samples: np.ndarray, parameters: Parameters, source: str
) -> tuple[np.ndarray, list[str], list[str]]:
    """Return positions and names of the markers, and the names of the other points."""
    labels = parameters.texts("POINT:LABELS")
    if not labels:
        labels = [f"point_{number}" for number in range(1, samples.shape[1] + 1)]
    labels += ["*"] * (samples.shape[1] - len(labels))
    others = {name for group in _NO_POSITION_GROUPS for name in parameters.texts(f"POINT:{group}")}
    names: list[str] = []
    kept: list[int] = []
    left_out: list[str] = []
    for index, label in enumerate(labels[: samples.shape[1]]):
        plain = label.rsplit(":", 1)[-1].strip()
        unlabelled = not plain or _UNLABELLED.fullmatch(plain)
        if unlabelled or label in others or _NO_POSITION.search(plain):
            left_out.append(label)
        else:
            kept.append(index)
            names.append(label)
    if not names:
        raise UnreadableFile(
            source,
            "labelled markers",
            f"{len(labels)} points, all unlabelled or no positions",
            "label them first in the program that captured them",
        )
    return samples[:, kept], names, left_out


def _without_subject(names: list[str]) -> tuple[list[str], str]:
    """Return the names without the one subject that stands before them, and the subject."""
    subjects = {name.rpartition(":")[0] for name in names} - {""}
    plain = [name.rpartition(":")[2].strip() for name in names]
    if len(subjects) != 1 or len(set(plain)) < len(plain) or not all(plain):
        return names, ""
    return plain, subjects.pop()


def _up(positions: np.ndarray, names: Sequence[str], parameters: Parameters) -> tuple[str, bool]:
    """Return the axis that points up: the body tells, else the screen axes of the file.

    Many programs fill in the screen axes without knowing them, so the body goes first.
    """
    if up := up_axis(positions, names):
        return up, True
    screen = "".join(parameters.texts("POINT:Y_SCREEN")[:1]).replace("+", "").strip().lower()
    if re.fullmatch(r"-?[xyz]", screen):
        return screen, True
    return "z", False


def _unit(parameters: Parameters) -> Unit | None:
    for text in parameters.texts("POINT:UNITS"):
        name = _SPELLINGS.get(text.lower(), text.lower())
        if name in MILLIMETRES:
            return Unit(name, MILLIMETRES[name])
    return None


def _measures(parameters: Parameters) -> dict[str, float]:
    """Return what a laboratory measured on the subject, in millimetres."""
    measures: dict[str, float] = {}
    for key, name in _MEASURES.items():
        for side in ("left", "right"):
            number = parameters.number(f"PROCESSING:{side[0].upper()}{key}")
            if number and number > 0:
                measures[f"{side}_{name}_mm"] = number
    return measures
