"""Files that are sent to a server: taken up to a size, under safe names in one folder."""

from __future__ import annotations

import json
import re
import unicodedata
from collections.abc import AsyncIterator
from pathlib import Path

MAX_BYTES = 200_000_000
"""Of one request."""
MAX_FILES = 500
_MAX_NAME = 80
_MAX_BYTES_OF_NAME = 200


class TooLarge(ValueError):  # noqa: N818 - the name says what is wrong
    """More than the server takes."""


async def receive_files(
    chunks: AsyncIterator[bytes], folder: Path, name: str, manifest: str
) -> list[str]:
    """Write the body of a request into a folder, and return the names of its files."""
    body = folder / ".body"
    await stream_to_file(chunks, body, MAX_BYTES)
    sizes = parse_manifest(manifest) if manifest else [(name or "file", body.stat().st_size)]
    paths = split_multipart(body, sizes, folder)
    body.unlink()
    return [path.name for path in paths]


async def stream_to_file(chunks: AsyncIterator[bytes], path: Path, max_bytes: int) -> None:
    """Write what is sent to a file; raise `TooLarge` where it is too much."""
    size = 0
    with path.open("wb") as file:
        async for chunk in chunks:
            size += len(chunk)
            if size > max_bytes:
                raise TooLarge(f"Files of up to {max_bytes // 1_000_000} MB are taken.")
            file.write(chunk)


def parse_manifest(manifest: str) -> list[tuple[str, int]]:
    """Return names and sizes of files that come one after the other, from JSON.

    Examples
    --------
    >>> parse_manifest('[["walk.amc", 12]]')
    [('walk.amc', 12)]
    """
    try:
        files = [(name, size) for name, size in json.loads(manifest)]
    except (ValueError, TypeError, RecursionError):
        raise ValueError("The list of files is not one of names and sizes in JSON.") from None
    if not 1 <= len(files) <= MAX_FILES:
        raise ValueError(f"1 to {MAX_FILES} files are taken at once, not {len(files)}.")
    for name, size in files:
        if not isinstance(name, str) or not isinstance(size, int) or size < 0:
            raise ValueError("The list of files has an entry without a name and a size.")
    return files


def split_multipart(body: Path, files: list[tuple[str, int]], folder: Path) -> list[Path]:
    """Cut the body of a request into its files, and return their paths."""
    total = sum(size for _, size in files)
    if total != body.stat().st_size:
        raise ValueError(f"{body.stat().st_size} bytes came where the files have {total}.")
    paths = [folder / safe_name(name) for name, _ in files]
    if len({path.name.lower() for path in paths}) < len(paths):
        raise ValueError("Two of the files have the same name; give each its own.")
    with body.open("rb") as source:
        for path, (_, size) in zip(paths, files, strict=True):
            with path.open("wb") as file:
                for start in range(0, size, 2**20):
                    file.write(source.read(min(2**20, size - start)))
    return paths


def safe_name(name: str) -> str:
    """Return a safe name for a file: no path, and no name that an operating system reserves.

    Examples
    --------
    >>> safe_name("../../etc/passwd"), safe_name("walk 1 (slow).c3d"), safe_name("..")
    ('passwd', 'walk 1 (slow).c3d', 'file')
    """
    last = unicodedata.normalize("NFC", re.split(r"[/\\]", name)[-1])
    plain = re.sub(r"[^\w .()+=,-]", "_", last).strip(" .")
    if re.fullmatch(r"(con|prn|aux|nul|com\d|lpt\d)(\..*)?", plain, re.IGNORECASE):
        plain = f"_{plain}"
    if len(plain) > _MAX_NAME or len(plain.encode()) > _MAX_BYTES_OF_NAME:
        suffix = Path(plain).suffix[:10]
        stem = plain[: _MAX_NAME - len(suffix)]
        while len((stem + suffix).encode()) > _MAX_BYTES_OF_NAME:
            stem = stem[:-1]
        plain = stem + suffix
    return plain or "file"
