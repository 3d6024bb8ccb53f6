"""C3D files: the samples of markers, as most laboratories keep them.

Written after the format's manual (c3d.org), for the points alone: header, parameter section and
data section, from Intel, DEC and MIPS machines, in integers or floats. Tolerant of what real files
do against the manual (parameters given twice, padded or prefixed names), and strict with a file
that holds fewer frames than it declares.
"""

from __future__ import annotations

import math
import re
import struct
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import xarray as xr

from eigenwalker.mocap.marker_names import numbered
from eigenwalker.mocap.unreadable import UnreadableFile
from eigenwalker.mocap.upright import Unit, guess_unit, turn_upright, up_axis
from eigenwalker.trajectories import MILLIMETRES, label_trajectories

BLOCK = 512
MAGIC = 0x50
MOST_PARAMETER_BLOCKS = 255
MOST_DISTANT = 1e9
"""No marker is further off than this, in whatever unit."""
PROCESSORS = {84: "Intel", 85: "DEC", 86: "MIPS"}
_AGAIN = "export or copy the file again"
_UNLABELLED = re.compile(r"\*\d*|u_?\d+|un(labell?ed|named).*|no[ _]?name.*", re.IGNORECASE)
_NO_POSITION = re.compile(r"(angles?|forces?|moments?|powers?|grf)\d*$", re.IGNORECASE)
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


@dataclass(frozen=True)
class Parameter:
    """One entry of the parameter section, as it stands in the file."""

    kind: int
    dimensions: tuple[int, ...]
    raw: bytes
    processor: str

    def numbers(self) -> list[float]:
        """Return the value as numbers, whatever kind they are stored as."""
        order = ">" if self.processor == "MIPS" else "<"
        if self.kind == 4:
            return _floats(self.raw[: len(self.raw) // 4 * 4], self.processor).tolist()
        dtype = {1: "u1", 2: "u2"}.get(self.kind)
        if dtype is None:
            return []
        return np.frombuffer(
            self.raw[: len(self.raw) // self.kind * self.kind], order + dtype
        ).tolist()

    def texts(self) -> list[str]:
        """Return the value as a list of texts without the blanks that pad them."""
        width = self.dimensions[0] if self.dimensions else len(self.raw)
        if self.kind != -1 or not width:
            return []
        words = (self.raw[at : at + width] for at in range(0, len(self.raw), width))
        return [_text(word) for word in words]


Parameters = dict[str, Parameter]


class _Header(NamedTuple):
    """The numbers of the first block that say where the samples are."""

    processor: str
    parameter_block: int
    n_points: int
    n_analog: int
    first_frame: int
    last_frame: int
    scale: float
    data_block: int
    rate_hz: float


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
    header = _header(content, source)
    parameters = _parameters(content, header, source)
    samples = _samples(content, header, parameters, source)
    rate_hz = _rate(header, parameters, source)
    positions, names, left_out = _markers(samples, parameters, source)
    names, subject = _without_subject(names)
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
        **_measures(parameters),
    )
    return walk


def _header(content: bytes, source: str) -> _Header:
    block = content[0] if content else 0
    at = (block - 1) * BLOCK
    if len(content) < BLOCK or not block or len(content) < at + 4:
        raise UnreadableFile(
            source,
            "a header and parameters of 512 bytes each or more",
            f"{len(content)} bytes: the file is cut short",
            _AGAIN,
        )
    if content[at + 3] not in PROCESSORS:
        raise UnreadableFile(
            source,
            "the mark of an Intel, DEC or MIPS file (84 to 86) at its parameters",
            str(content[at + 3]),
            _AGAIN,
        )
    processor = PROCESSORS[content[at + 3]]
    order = ">" if processor == "MIPS" else "<"
    words = struct.unpack(order + "12H", content[:24])
    return _Header(
        processor=processor,
        parameter_block=block,
        n_points=words[1],
        n_analog=words[2],
        first_frame=words[3],
        last_frame=words[4],
        scale=float(_floats(content[12:16], processor)[0]),
        data_block=words[8],
        rate_hz=float(_floats(content[20:24], processor)[0]),
    )


def _floats(raw: bytes, processor: str) -> np.ndarray:
    """Return 4-byte floats of any of the three machines."""
    if processor != "DEC":
        return np.frombuffer(raw, ">f4" if processor == "MIPS" else "<f4").astype(float)
    # A VAX float has its 16-bit halves exchanged and an exponent that is larger by two.
    halves = np.frombuffer(raw, "<u2").reshape(-1, 2)
    swapped = np.ascontiguousarray(halves[:, ::-1]).view("<f4")[:, 0]
    return swapped.astype(float) / 4


def _parameters(content: bytes, header: _Header, source: str) -> Parameters:
    """Return the parameters by ``GROUP:NAME``; of one given twice, the first."""
    at = (header.parameter_block - 1) * BLOCK + 4
    end = min(len(content), at + MOST_PARAMETER_BLOCKS * BLOCK)
    if header.data_block > header.parameter_block:
        end = min(end, (header.data_block - 1) * BLOCK)
    order = ">" if header.processor == "MIPS" else "<"
    groups: dict[int, str] = {}
    found: dict[tuple[int, str], Parameter] = {}
    try:
        while at + 2 <= end:
            length, group = struct.unpack_from("bb", content, at)
            if not length or not group:
                break
            name = _text(content[at + 2 : at + 2 + abs(length)]).upper()
            at += 2 + abs(length)
            (step,) = struct.unpack_from(order + "H", content, at)
            record = content[at + 2 : at + step if step else end]
            if group < 0:
                groups.setdefault(-group, name)
            else:
                found.setdefault((group, name), _parameter(record, header.processor))
            if not step:
                break
            at += step
    except struct.error:
        raise UnreadableFile(
            source, "whole parameters", "an end within them: the file is cut short", _AGAIN
        ) from None
    return {f"{groups.get(group, group)}:{name}": p for (group, name), p in found.items()}


def _parameter(record: bytes, processor: str) -> Parameter:
    kind, n_dimensions = struct.unpack_from("bB", record)
    dimensions = struct.unpack_from(f"{n_dimensions}B", record, 2)
    length = math.prod((abs(kind), *dimensions))
    return Parameter(kind, dimensions, record[2 + n_dimensions :][:length], processor)


def _text(raw: bytes) -> str:
    try:
        text = raw.decode("utf-8")
    except UnicodeDecodeError:
        text = raw.decode("latin-1")
    return text.replace("\0", " ").strip()


def _number(parameters: Parameters, name: str) -> float | None:
    """Return the first number of a parameter, if it has a finite one."""
    numbers = parameters[name].numbers() if name in parameters else []
    return float(numbers[0]) if numbers and np.isfinite(numbers[0]) else None


def _samples(content: bytes, header: _Header, parameters: Parameters, source: str) -> np.ndarray:
    """Return positions in the file's unit, array (time, point, 3), NaN where a point is missing."""
    declared_points = _number(parameters, "POINT:USED")
    if header.n_points == 0 or declared_points not in (None, header.n_points):
        raise UnreadableFile(
            source,
            "the number of points in its header, one or more, to be that of its parameters",
            f"{header.n_points} and {declared_points}",
            _AGAIN,
        )
    scale = _scale(header, parameters, source)
    words = 4 * header.n_points + header.n_analog
    stride = words * (4 if scale < 0 else 2)
    start = (max(header.data_block, 1) - 1) * BLOCK
    available = max(len(content) - start, 0)
    n_frames = _frames(header, parameters, stride, available, source)
    raw = content[start : start + n_frames * stride]
    if scale < 0:
        table = _floats(raw, header.processor)
    else:
        table = np.frombuffer(raw, ">i2" if header.processor == "MIPS" else "<i2").astype(float)
    points = table.reshape(n_frames, words)[:, : 4 * header.n_points]
    points = points.reshape(n_frames, header.n_points, 4)
    positions = points[..., :3] * (1.0 if scale < 0 else scale)
    if (np.abs(positions) > MOST_DISTANT).any():
        raise UnreadableFile(source, "finite positions", "infinite or absurd ones", _AGAIN)
    positions[(points[..., 3] < 0) | np.isnan(positions).any(axis=2)] = np.nan
    return _without_zeros(positions)


def _scale(header: _Header, parameters: Parameters, source: str) -> float:
    """Return the factor of integer samples, or a negative number for float samples."""
    scale = _number(parameters, "POINT:SCALE")
    scale = header.scale if scale is None else scale
    agree = np.isfinite(header.scale) and np.sign(scale) == np.sign(header.scale)
    if not np.isfinite(scale) or not scale or not agree:
        raise UnreadableFile(
            source,
            "one scale of the samples in header and parameters",
            f"{header.scale} and {scale}",
            _AGAIN,
        )
    if scale > 0 and abs(scale - header.scale) > 1e-4 * scale:
        raise UnreadableFile(
            source, f"the scale {header.scale} of the header", f"{scale} in its parameters", _AGAIN
        )
    return scale


def _frames(
    header: _Header, parameters: Parameters, stride: int, available: int, source: str
) -> int:
    """Return the number of frames: the one declared, if all were delivered.

    The header counts to 65535; longer files, and those of some programs, declare the number
    in parameters. Where declarations differ, that one counts which the length of the file bears
    out.
    """
    counts = [header.last_frame - header.first_frame + 1]
    fields = [parameters.get(f"TRIAL:ACTUAL_{which}_FIELD") for which in ("START", "END")]
    first, last = (field.numbers() if field else [] for field in fields)
    if len(first) > 1 and len(last) > 1:
        counts.append(int(last[0] + 65536 * last[1] - first[0] - 65536 * first[1]) + 1)
    for name in ("POINT:LONG_FRAMES", "POINT:FRAMES"):
        if (number := _number(parameters, name)) is not None:
            counts.append(int(number))
    counts = [count for count in counts if count > 0]
    delivered = available // stride
    fitting = [n for n in counts if 0 <= available - n * stride < BLOCK]
    declared = fitting[0] if fitting else max(counts, default=0)
    if not declared:
        raise UnreadableFile(source, "one frame or more", "none", _AGAIN)
    if delivered < declared:
        raise UnreadableFile(
            source,
            f"{declared} frames, as it declares",
            f"{delivered}: the file is cut short",
            _AGAIN,
        )
    return declared


def _without_zeros(positions: np.ndarray) -> np.ndarray:
    """Return positions with NaN where a marker that is elsewhere sits at 0, 0, 0 exactly.

    Some programs mark so what was not seen.
    """
    at_zero = (positions == 0).all(axis=2)
    some = at_zero.any(axis=0) & ~(at_zero | np.isnan(positions).any(axis=2)).all(axis=0)
    positions[at_zero & some] = np.nan
    return positions


def _rate(header: _Header, parameters: Parameters, source: str) -> float:
    rates = (_number(parameters, "POINT:RATE"), header.rate_hz)
    sound = [rate for rate in rates if rate is not None and np.isfinite(rate) and rate > 0]
    if not sound or max(sound) > 1.01 * min(sound) or not 0.1 <= sound[0] <= 1e5:
        raise UnreadableFile(
            source,
            "one frame rate in header and parameters",
            f"{header.rate_hz} and {rates[0]}",
            _AGAIN,
        )
    return round(sound[0], 6)


def _markers(
    samples: np.ndarray, parameters: Parameters, source: str
) -> tuple[np.ndarray, list[str], list[str]]:
    """Return positions and names of the markers, and the names of the other points."""
    labels = _texts(parameters, "POINT:LABELS")
    if not labels:
        labels = [f"point_{number}" for number in range(1, samples.shape[1] + 1)]
    labels += ["*"] * (samples.shape[1] - len(labels))
    others = {
        name for group in _NO_POSITION_GROUPS for name in _texts(parameters, f"POINT:{group}")
    }
    names: list[str] = []
    kept: list[int] = []
    left_out: list[str] = []
    for index, label in enumerate(labels[: samples.shape[1]]):
        plain = label.rsplit(":", 1)[-1].strip()
        if (
            not plain
            or _UNLABELLED.fullmatch(plain)
            or label in others
            or _NO_POSITION.search(plain)
        ):
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
    return samples[:, kept], numbered(names), left_out


def _texts(parameters: Parameters, name: str) -> list[str]:
    """Return the texts of a parameter and of those that continue it (LABELS, LABELS2, ...)."""
    texts: list[str] = []
    for number in ("", *range(2, 30)):
        if f"{name}{number}" in parameters:
            texts += parameters[f"{name}{number}"].texts()
    return texts


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
    screen = "".join(_texts(parameters, "POINT:Y_SCREEN")[:1]).replace("+", "").strip().lower()
    if re.fullmatch(r"-?[xyz]", screen):
        return screen, True
    return "z", False


def _unit(parameters: Parameters) -> Unit | None:
    for text in _texts(parameters, "POINT:UNITS"):
        name = _SPELLINGS.get(text.lower(), text.lower())
        if name in MILLIMETRES:
            return Unit(name, MILLIMETRES[name])
    return None


def _measures(parameters: Parameters) -> dict[str, float]:
    """Return what a laboratory measured on the subject, in millimetres."""
    measures: dict[str, float] = {}
    for key, name in _MEASURES.items():
        for side in ("left", "right"):
            number = _number(parameters, f"PROCESSING:{side[0].upper()}{key}")
            if number and number > 0:
                measures[f"{side}_{name}_mm"] = number
    return measures
