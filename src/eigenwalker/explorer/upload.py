"""Files that are sent to the server: taken up to a size, under names that lead nowhere."""

from __future__ import annotations

import json
import re
from collections.abc import AsyncIterator
from pathlib import Path

MOST_BYTES = 200_000_000
"""Of one request."""
MOST_FILES = 500
_LONGEST = 80


class TooLarge(ValueError):  # noqa: N818 - the name says what is wrong
    """More than the server takes."""


async def kept(chunks: AsyncIterator[bytes], path: Path, most_bytes: int) -> None:
    """Write what comes to a file, and stop where it is too much.

    Raises
    ------
    TooLarge

    """
    size = 0
    with path.open("wb") as file:
        async for chunk in chunks:
            size += len(chunk)
            if size > most_bytes:
                raise TooLarge(f"Files of up to {most_bytes // 1_000_000} MB are taken.")
            file.write(chunk)


def listed(files: str) -> list[tuple[str, int]]:
    """Return names and sizes of files that come one after the other.

    Parameters
    ----------
    files : str
        JSON: ``[["walk.amc", 1200], ["person.asf", 800]]``.

    Raises
    ------
    ValueError
        If it is none.

    Examples
    --------
    >>> listed('[["walk.amc", 12]]')
    [('walk.amc', 12)]

    """
    try:
        found = [(name, size) for name, size in json.loads(files)]
    except (ValueError, TypeError, RecursionError):
        raise ValueError("The list of files is not one of names and sizes in JSON.") from None
    if not 1 <= len(found) <= MOST_FILES:
        raise ValueError(f"1 to {MOST_FILES} files are taken at once, not {len(found)}.")
    for name, size in found:
        if not isinstance(name, str) or not isinstance(size, int) or size < 0:
            raise ValueError("The list of files has an entry without a name and a size.")
    return found


def parted(whole: Path, files: list[tuple[str, int]], folder: Path) -> list[Path]:
    """Cut what came into the files it is made of, and return their paths.

    Raises
    ------
    ValueError
        If sizes do not add up, or two files have one name.

    """
    total = sum(size for _, size in files)
    if total != whole.stat().st_size:
        raise ValueError(f"{whole.stat().st_size} bytes came where the files have {total}.")
    paths = [folder / safe_name(name) for name, _ in files]
    if len({path.name.lower() for path in paths}) < len(paths):
        raise ValueError("Two of the files have the same name; give each its own.")
    with whole.open("rb") as source:
        for path, (_, size) in zip(paths, files, strict=True):
            with path.open("wb") as file:
                for start in range(0, size, 2**20):
                    file.write(source.read(min(2**20, size - start)))
    return paths


def safe_name(name: str) -> str:
    """Return a name for a file that leads nowhere and means nothing to a system.

    Examples
    --------
    >>> safe_name("../../etc/passwd"), safe_name("walk 1 (slow).c3d"), safe_name("..")
    ('passwd', 'walk 1 (slow).c3d', 'file')

    """
    last = re.split(r"[/\\]", name)[-1]
    plain = re.sub(r"[^\w .()+=,-]", "_", last).strip(" .")
    if re.fullmatch(r"(con|prn|aux|nul|com\d|lpt\d)(\..*)?", plain, re.IGNORECASE):
        plain = f"_{plain}"
    if len(plain) > _LONGEST:
        suffix = Path(plain).suffix[:10]
        plain = plain[: _LONGEST - len(suffix)] + suffix
    return plain or "file"
