"""The bytes of a file, and of a file beside it that explains it."""

from __future__ import annotations

from pathlib import Path

from eigenwalker.io.errors import UnreadableFile

MOST_BYTES = 2**31


def content_of(path: Path, *, most_bytes: int = MOST_BYTES, expected: str = "a capture") -> bytes:
    """Return the bytes of a file that is there and can be read.

    Parameters
    ----------
    path : Path
        Where it is.
    most_bytes : int
        More is refused unread.
    expected : str
        What the file should hold, for the message on an empty one.

    Returns
    -------
    bytes

    Raises
    ------
    UnreadableFile
        If it is no plain file, too large, empty, or may not be read.

    """
    name = path.name or str(path)
    try:
        if path.is_dir():
            raise UnreadableFile(name, "a file", "a folder", "name one of the files in it")
        if not path.exists():
            came = f"nothing of that name in {str(path.parent)!r}"
            raise UnreadableFile(name, "a file", came, "check the path")
        if not path.is_file():
            raise UnreadableFile(name, "a plain file", "a device or pipe", "save it as a file")
        if path.stat().st_size > most_bytes:
            came = f"{path.stat().st_size / 1e9:.3g} GB"
            most = f"{most_bytes / 1e9:.2g} GB at most"
            raise UnreadableFile(name, most, came, "cut it into shorter captures")
        content = path.read_bytes()
    except OSError as error:
        raise UnreadableFile(
            name,
            "a file that can be read",
            error.strerror or "an error",
            "check path and permissions",
        ) from error
    if not content:
        raise UnreadableFile(name, expected, "an empty file")
    return content


def beside(path: Path, suffix: str) -> Path | None:
    """Return where the file of the same name and another suffix is, if there is one.

    Parameters
    ----------
    path : Path
        Of the capture.
    suffix : str
        Of the file beside it, with its dot.

    Returns
    -------
    Path or None

    """
    other = path.with_suffix(suffix)
    return other if other != path and other.is_file() else None
