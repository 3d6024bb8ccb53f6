"""Readers that a damaged file may crash: run in a process of their own, within limits.

Readers written in C can die, hang or ask for all the memory there is. Here they do so in a child
process, and the file is refused as any other bad file is.
"""

from __future__ import annotations

import inspect
import io
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np

from eigenwalker.io import sandbox_child as child_side
from eigenwalker.io.errors import UnreadableFile

SECONDS = 10
MOST_BYTES = 2**30

Reader = Callable[[str], dict[str, np.ndarray]]


def arrays_from_child(
    reader: Reader,
    path: Path,
    *,
    expected: str,
    seconds: int = SECONDS,
    most_bytes: int = MOST_BYTES,
) -> dict[str, np.ndarray]:
    """Return the arrays that a reader finds in a file, read in a process of its own.

    Parameters
    ----------
    reader : function of a path
        Returns named arrays of numbers. The child imports the module that it stands in by itself,
        not this package, so that module should import only what reading takes.
    path : Path
        The file.
    expected : str
        What it should hold, for the message.
    seconds : int
        The child is ended after so long.
    most_bytes : int
        Memory it may take, where the system can limit that (Linux), and size of the arrays.

    Returns
    -------
    dict of str to array

    Raises
    ------
    UnreadableFile
        If the reader refuses the file, dies, hangs, or needs too much.

    """
    told = [inspect.getfile(reader), reader.__name__, os.path.abspath(path), seconds, most_bytes]
    try:
        child = subprocess.run(
            # -P: nothing is imported from the folder one happens to be in
            [sys.executable, "-P", child_side.__file__, *map(str, told)],
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=seconds,
            check=False,
            env=os.environ | {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"},
            creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
        )
    except subprocess.TimeoutExpired as error:
        came = f"one that takes more than {seconds} s to read"
        raise UnreadableFile(path.name, expected, came) from error
    if child.returncode == child_side.TOO_LARGE:
        came = f"one that needs more than {most_bytes / 2**30:.2g} GiB of memory"
        raise UnreadableFile(path.name, expected, came)
    if child.returncode == child_side.REFUSED:
        came = f"one of which its reader says: {child.stderr.decode(errors='replace')}"
        raise UnreadableFile(path.name, expected, came)
    if child.returncode:
        came = f"one on which its reader breaks down (status {child.returncode})"
        raise UnreadableFile(path.name, expected, came)
    with np.load(io.BytesIO(child.stdout), allow_pickle=False) as arrays:
        return {name[1:]: arrays[name] for name in arrays.files}
