"""The three sections of a C3D file: header, parameters and samples, as numbers.

Written after the format's manual (c3d.org), for the points alone: from Intel, DEC and MIPS
machines, in integers or floats. Tolerant of what real files do against the manual (parameters given
twice, counts that disagree), and strict with a file that holds fewer frames than it declares.
"""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from eigenwalker.io.capture_file import CaptureFile
from eigenwalker.io.missing_codes import CODES
from eigenwalker.io.text_cells import MAX_SIZE

BLOCK = 512
MAX_COUNT = 65535
"""The largest number of a frame in the header."""
MAX_PARAMETER_BLOCKS = 255
MAX_CONTINUED = 30
PROCESSORS = {84: "Intel", 85: "DEC", 86: "MIPS"}
_ORDER = {"Intel": "<", "DEC": "<", "MIPS": ">"}
"""Order of bytes on these machines."""


@dataclass(frozen=True)
class Parameter:
    """One entry of the parameter section, as it stands in the file."""

    kind: int
    dimensions: tuple[int, ...]
    raw: bytes
    processor: str

    def numbers(self) -> list[float]:
        """Return the value as numbers, whatever kind they are stored as."""
        if self.kind not in (1, 2, 4):
            return []
        raw = self.raw[: len(self.raw) // self.kind * self.kind]
        if self.kind == 4:
            return _floats(raw, self.processor).tolist()
        return np.frombuffer(raw, f"{_ORDER[self.processor]}u{self.kind}").tolist()

    def texts(self) -> list[str]:
        """Return the value as a list of texts without the blanks that pad them."""
        width = self.dimensions[0] if self.dimensions else len(self.raw)
        if self.kind != -1 or not width:
            return []
        words = (self.raw[at : at + width] for at in range(0, len(self.raw), width))
        return [_text(word) for word in words]


class Parameters(dict[str, Parameter]):
    """The parameters of a file by ``GROUP:NAME``."""

    def number(self, name: str) -> float | None:
        """Return the first number of a parameter, if it has a finite one."""
        numbers = self[name].numbers() if name in self else []
        return float(numbers[0]) if numbers and np.isfinite(numbers[0]) else None

    def texts(self, name: str) -> list[str]:
        """Return the texts of a parameter and of those that continue it (LABELS, LABELS2, ...)."""
        parts = [name, *(f"{name}{number}" for number in range(2, MAX_CONTINUED))]
        return [text for part in parts if part in self for text in self[part].texts()]


class Header(NamedTuple):
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


def c3d_sections(file: CaptureFile) -> tuple[Header, Parameters, np.ndarray, dict[str, int]]:
    """Return header, parameters, positions (time, point, 3) in the file's unit, and attributes."""
    header = _header(file)
    parameters = _parameters(file, header)
    return header, parameters, *_samples(file, header, parameters)


def _header(file: CaptureFile) -> Header:
    content = file.content
    block = content[0] if content else 0
    at = (block - 1) * BLOCK
    if len(content) < BLOCK or not block or len(content) < at + 4:
        got = f"{len(content)} bytes: the file is cut short"
        raise file.error("a header and parameters of 512 bytes each or more", got)
    mark = content[at + 3]
    if mark not in PROCESSORS:
        expected = "the mark of an Intel, DEC or MIPS file (84 to 86) at its parameters"
        raise file.error(expected, str(mark))
    processor = PROCESSORS[mark]
    words = struct.unpack(_ORDER[processor] + "12H", content[:24])
    return Header(
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
    with np.errstate(invalid="ignore"):  # of NaN that a processor would signal
        if processor != "DEC":
            return np.frombuffer(raw, _ORDER[processor] + "f4").astype(float)
        # A VAX float has its 16-bit halves exchanged and an exponent that is larger by two.
        halves = np.frombuffer(raw, "<u2").reshape(-1, 2)
        return np.ascontiguousarray(halves[:, ::-1]).view("<f4")[:, 0].astype(float) / 4


def _parameters(file: CaptureFile, header: Header) -> Parameters:
    """Return the parameters by ``GROUP:NAME``; of one given twice, the first."""
    content = file.content
    at = (header.parameter_block - 1) * BLOCK + 4
    end = min(len(content), at + MAX_PARAMETER_BLOCKS * BLOCK)
    if header.data_block > header.parameter_block:
        end = min(end, (header.data_block - 1) * BLOCK)
    groups: dict[int, str] = {}
    entries: dict[tuple[int, str], Parameter] = {}
    try:
        while at + 2 <= end:
            length, group = struct.unpack_from("bb", content, at)
            if not length or not group:
                break
            name = _text(content[at + 2 : at + 2 + abs(length)]).upper()
            at += 2 + abs(length)
            (step,) = struct.unpack_from(_ORDER[header.processor] + "H", content, at)
            record = content[at + 2 : at + step if step else end]
            if group < 0:
                groups.setdefault(-group, name)
            else:
                entries.setdefault((group, name), _parameter(record, header.processor))
            if not step:
                break
            at += step
    except struct.error:
        got = "an end within them: the file is cut short"
        raise file.error("whole parameters", got) from None
    return Parameters(
        (f"{groups.get(group, group)}:{name}", parameter)
        for (group, name), parameter in entries.items()
    )


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


def _samples(
    file: CaptureFile, header: Header, parameters: Parameters
) -> tuple[np.ndarray, dict[str, int]]:
    """Return positions in the file's unit, NaN where a point is missing, and what is cut off."""
    declared_points = parameters.number("POINT:USED")
    if header.n_points == 0 or declared_points not in (None, header.n_points):
        expected = "the number of points in its header, one or more, to be that of its parameters"
        raise file.error(expected, f"{header.n_points} and {declared_points}")
    scale = _scale(file, header, parameters)
    words = 4 * header.n_points + header.n_analog
    stride = words * (4 if scale < 0 else 2)
    start = (max(header.data_block, 1) - 1) * BLOCK
    end = len(file.content)
    if header.parameter_block > header.data_block:
        end = (header.parameter_block - 1) * BLOCK
    available = max(end - start, 0)
    n_declared = _declared_frames(file, header, parameters, stride, available)
    n_frames = min(available // stride, n_declared)
    attrs = file.check_frames(n_declared, n_frames)
    raw = file.content[start : start + n_frames * stride]
    if scale < 0:
        table = _floats(raw, header.processor)
    else:
        table = np.frombuffer(raw, _ORDER[header.processor] + "i2").astype(float)
    points = table.reshape(n_frames, words)[:, : 4 * header.n_points]
    points = points.reshape(n_frames, header.n_points, 4)
    positions = points[..., :3] * (1.0 if scale < 0 else scale)
    with np.errstate(invalid="ignore"):
        positions[np.abs(np.abs(positions) - CODES[0]) < 1e-6 * CODES[0]] = np.nan
        absurd = np.abs(positions) > MAX_SIZE
    absurd[points[..., 3] < 0] = False
    if absurd.any():
        raise file.error("finite positions", "infinite or absurd ones")
    positions[(points[..., 3] < 0) | np.isnan(positions).any(axis=2)] = np.nan
    # Some programs put a marker that was not seen, and is elsewhere in other frames, at 0, 0, 0.
    at_zero = (positions == 0).all(axis=2)
    always = (at_zero | np.isnan(positions).any(axis=2)).all(axis=0)
    positions[at_zero & ~always] = np.nan
    return positions, attrs


def _scale(file: CaptureFile, header: Header, parameters: Parameters) -> float:
    """Return the factor of integer samples, or a negative number for float samples."""
    scale = parameters.number("POINT:SCALE")
    scale = header.scale if scale is None else scale
    agree = np.isfinite(header.scale) and np.sign(scale) == np.sign(header.scale)
    if not np.isfinite(scale) or not scale or not agree:
        got = f"{header.scale} and {scale}"
        raise file.error("one scale of the samples in header and parameters", got)
    if scale > 0 and abs(scale - header.scale) > 1e-4 * scale:
        raise file.error(f"the scale {header.scale} of the header", f"{scale} in its parameters")
    return scale


def _declared_frames(
    file: CaptureFile, header: Header, parameters: Parameters, stride: int, available: int
) -> int:
    """Return the number of frames that the file declares.

    The header counts to 65535; longer files, and those of some programs, declare the number
    in parameters. Where declarations differ, that one counts which the length of the file bears
    out. Where a count ran over, and none is borne out, the length alone counts.
    """
    counts = [header.last_frame - header.first_frame + 1]
    fields = [parameters.get(f"TRIAL:ACTUAL_{which}_FIELD") for which in ("START", "END")]
    first, last = (field.numbers() if field else [] for field in fields)
    if len(first) > 1 and len(last) > 1:
        counts.append(int(last[0] + 65536 * last[1] - first[0] - 65536 * first[1]) + 1)
    for name in ("POINT:LONG_FRAMES", "POINT:FRAMES"):
        if (number := parameters.number(name)) is not None:
            counts.append(int(number))
    counts = [count for count in counts if count > 0]
    fitting = [n for n in counts if 0 <= available - n * stride < BLOCK]
    declared = fitting[0] if fitting else max(counts, default=0)
    if not fitting and 0 < declared <= MAX_COUNT < available // stride:
        by_length = range(max(available - BLOCK, 0) // stride + 1, available // stride + 1)
        modulo = {count % (MAX_COUNT + 1) for count in counts}
        wrapped = [n for n in by_length if n % (MAX_COUNT + 1) in modulo]
        if wrapped or MAX_COUNT in (header.last_frame, declared):
            declared = wrapped[0] if wrapped else _without_padding(file, stride, available)
    if not declared:
        raise file.error("one frame or more", "none")
    return declared


def _without_padding(file: CaptureFile, stride: int, available: int) -> int:
    """Return the number of frames in samples that end with the file, but for its last zeros."""
    samples = file.content[-available:]
    zeros = min(available - len(samples.rstrip(b"\0")), BLOCK - 1)
    return -(-(available - zeros) // stride)
