"""Files that appear whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def atomic_write(path: Path) -> Iterator[Path]:
    """Yield a path to write to; the file then appears at `path`, or not at all after an error.

    Parameters
    ----------
    path : Path
        The file to write, in a folder that exists. A file that is there is replaced.

    Yields
    ------
    Path
        A hidden file in the same folder, with the same suffix. It is removed after an error.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from pathlib import Path
    >>> with TemporaryDirectory() as folder:
    ...     with atomic_write(Path(folder, "answer.txt")) as unfinished:
    ...         size = unfinished.write_text("42")
    ...     [path.name for path in Path(folder).iterdir()]
    ['answer.txt']

    """
    unfinished = path.with_name(f".{os.getpid()}.part.{path.name}")
    try:
        yield unfinished
        os.replace(unfinished, path)
    finally:
        unfinished.unlink(missing_ok=True)
