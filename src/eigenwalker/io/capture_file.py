"""A file to be read as a capture: its bytes, and what the caller knows of it."""

from __future__ import annotations

import codecs
import re
import warnings
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from eigenwalker.io.errors import EXPORT_AGAIN, UnreadableFile
from eigenwalker.io.up_axis_and_unit import Unit

MAX_BYTES = 2**31
MAX_POSITIONS = 4_000_000
"""Joints times frames that a skeleton may have, however few numbers move it."""
MAX_COLUMNS = 100_000
"""More columns are no table of a body's points."""
_KEEP_PARTIAL = (
    f'{EXPORT_AGAIN}, or take the frames that are there: read_mocap(..., partial="keep")'
)


_MARKS = {
    "utf-32": (b"\xff\xfe\x00\x00", b"\x00\x00\xfe\xff"),
    "utf-16": (b"\xff\xfe", b"\xfe\xff"),
}
_WIDE = {"utf-32-le": (4, 0), "utf-32-be": (4, 3), "utf-16-le": (2, 0), "utf-16-be": (2, 1)}
"""Bytes of a letter, and which of them is not 0 in plain ones."""


class RateAssumed(UserWarning):
    """A file names no frame rate, so the usual one of its format was taken.

    Silence it with ``warnings.simplefilter("ignore", RateAssumed)``, or name the rate:
    ``read_mocap(path, rate_hz=120)``.

    See Also
    --------
    read_mocap : Gives it; ``default_rate_hz`` answers it.
    """


@dataclass(frozen=True)
class CaptureFile:
    """A file, and the arguments of `read_mocap` that its reader takes into account.

    `unit` and `rate_hz` replace those of the file; the defaults are for a file that names none.
    With `keep_partial`, a file that declares more frames than it has gives its whole frames.
    """

    path: Path
    content: bytes = field(repr=False)
    unit: Unit | None = None
    rate_hz: float | None = None
    default_unit: Unit | None = None
    default_rate_hz: float | None = None
    keep_partial: bool = False

    @property
    def name(self) -> str:
        """Name of the file without its folder, for messages."""
        return self.path.name

    @property
    def text(self) -> str:
        """The letters of the file, whatever else is in it."""
        return self.content.decode("utf-8-sig", errors="replace")

    @cached_property
    def lines(self) -> list[str]:
        """The lines of a text, none of more than `MAX_COLUMNS` columns."""
        lines = lines_of(self.content, self.name)
        widest = max((line.count(mark) for line in lines for mark in "\t,; "), default=0) + 1
        if widest > MAX_COLUMNS:
            expected = f"{MAX_COLUMNS} columns at most"
            raise self.error(expected, f"{widest}", "keep those of the body")
        return lines

    def error(self, expected: str, got: str, advice: str = EXPORT_AGAIN) -> UnreadableFile:
        """Return the error to raise when the file does not hold what is expected."""
        return UnreadableFile(self.name, expected, got, advice)

    def check_frames(self, n_declared: int, n_frames: int) -> dict[str, int]:
        """Refuse a file that does not have the frames that it declares.

        Of a partial file that is to be kept, return the attribute ``n_frames_cut``: how many frames
        are missing at its end.
        """
        if n_frames == n_declared:
            return {}
        expected = f"{n_declared} frames, as it declares"
        if n_frames > n_declared:
            raise self.error(expected, f"{n_frames}: the count is wrong")
        if self.keep_partial and n_frames:
            return {"n_frames_cut": n_declared - n_frames}
        raise self.error(expected, f"{n_frames}: the file is cut short", _KEEP_PARTIAL)

    def check_size(self, n_points: int, n_frames: int) -> None:
        """Refuse more positions than `MAX_POSITIONS` that the file does not hold one by one."""
        most = max(MAX_POSITIONS, len(self.content) // 4)
        if n_points * n_frames > most:
            got = f"{n_points} joints in {n_frames} frames"
            raise self.error(f"{most} positions at most", got, "cut it into shorter captures")

    def frame_rate(
        self, declared_hz: float | None, *, usual_hz: float, reason: str
    ) -> tuple[float, dict[str, object]]:
        """Return the frames a second of a file that may name none, and attributes about them.

        If neither file nor caller name any, `usual_hz` is assumed, with a warning.
        """
        rate_hz = self.rate_hz or declared_hz or self.default_rate_hz
        if rate_hz is not None:
            return rate_hz, {}
        warnings.warn(
            f"{self.name} names no frame rate; {usual_hz:g} frames a second are assumed, {reason}. "
            f"Name it to be sure: read_mocap(..., rate_hz={usual_hz:g}).",
            RateAssumed,
            stacklevel=4,  # the caller of read_mocap
        )
        return usual_hz, {"rate_assumed": True, "rate_reason": reason}


def read_bytes(path: Path, *, max_bytes: int = MAX_BYTES, expected: str = "a capture") -> bytes:
    """Return the bytes of a plain file that is there, not empty and not too large."""
    name = path.name or str(path)
    try:
        if path.is_dir():
            raise UnreadableFile(name, "a file", "a folder", "name one of the files in it")
        if not path.exists():
            got = f"nothing of that name in {str(path.parent)!r}"
            raise UnreadableFile(name, "a file", got, "check the path")
        if not path.is_file():
            raise UnreadableFile(name, "a plain file", "a device or pipe", "save it as a file")
        if path.stat().st_size > max_bytes:
            limit = f"{max_bytes / 1e9:.2g} GB at most"
            got = f"{path.stat().st_size / 1e9:.3g} GB"
            raise UnreadableFile(name, limit, got, "cut it into shorter captures")
        content = path.read_bytes()
    except OSError as error:
        got = error.strerror or "an error"
        advice = "check path and permissions"
        raise UnreadableFile(name, "a file that can be read", got, advice) from error
    if not content:
        raise UnreadableFile(name, expected, "an empty file")
    return content


def as_utf8(content: bytes) -> bytes:
    """Return a text in UTF-16 or UTF-32 as UTF-8, by its mark or its zeros; others as they are."""
    encoding = wide_encoding(content)
    if encoding is None:
        return content
    try:
        return codecs.getincrementaldecoder(encoding)().decode(content).encode()
    except UnicodeError:
        return content


def wide_encoding(content: bytes) -> str | None:
    """Return the encoding of a text of two or four bytes a letter; None for any other content.

    Without a mark at its start it is known by zeros: all letters of its beginning but some are
    plain ones, at the same place among the bytes of each.
    """
    for encoding, mark in _MARKS.items():
        if content.startswith(mark):
            return encoding
    beginning = content[:256]
    for encoding, (width, at) in _WIDE.items():
        letters = beginning[at::width]
        zeros = b"".join(beginning[other::width] for other in range(width) if other != at)
        plain = sum(byte in b"\t\r\n" or 32 <= byte < 127 for byte in letters)
        n = len(beginning) // width
        if n >= 8 and plain > 0.9 * n and zeros.count(0) > 0.9 * n * (width - 1):
            return encoding
    return None


def is_text(content: bytes) -> bool:
    """Return whether a file holds text, by its first bytes."""
    return not any(byte < 32 and byte not in b"\t\n\r\f\x1a" for byte in content[:1024])


def lines_of(content: bytes, source: str) -> list[str]:
    """Return the lines of a text in UTF-8 or Windows-1252, without empty ones at its end."""
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = content.decode("cp1252", errors="replace")
    if "\0" in text:
        raise UnreadableFile(source, "text", "bytes that are no letters")
    return re.split(r"\r\n|\n|\r", text.rstrip("\n\r\x1a "))
