"""Standard output and error that never end a command: what cannot be printed is lost, not the work.

A name that the terminal cannot encode is printed with escapes. Where printing fails, as into a full
disk or a pipe that was closed, all that follows is dropped.
"""

from __future__ import annotations

import errno
import io
import sys
from typing import Any


class _Output(io.FileIO):
    """A stream that keeps its first error, and from then on takes everything."""

    error: OSError | None = None

    def write(self, data: Any, /) -> int:
        if self.error is None:
            try:
                return super().write(data)
            except OSError as error:
                self.error = error
        return memoryview(data).nbytes


def print_without_fail() -> None:
    """Let standard output and error take everything; those of a test or a notebook stay."""
    for name in ("stdout", "stderr"):
        stream: Any = getattr(sys, name)
        if stream is None or stream is not getattr(sys, f"__{name}__"):
            continue
        stream.reconfigure(errors="backslashreplace")
        if sys.platform == "win32" and stream.isatty():
            continue
        taking = io.TextIOWrapper(
            io.BufferedWriter(_Output(stream.fileno(), "wb", closefd=False)),
            encoding=stream.encoding,
            errors="backslashreplace",
            line_buffering=stream.line_buffering,
            write_through=stream.write_through,
        )
        setattr(sys, name, taking)


def printing_error() -> OSError | None:
    """Return why not all could be printed; a reader that has left is no error."""
    if sys.stdout is None:
        return None
    sys.stdout.flush()
    error = getattr(getattr(sys.stdout.buffer, "raw", None), "error", None)
    return None if error is None or error.errno == errno.EPIPE else error
