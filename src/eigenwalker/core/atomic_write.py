"""Files that appear whole or not at all."""

from __future__ import annotations

import os
import re
import secrets
import shutil
from collections.abc import Collection, Generator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas as pd

_FORMULA = ("=", "+", "-", "@", "\t", "\r")
"""How a cell begins that a spreadsheet takes for a formula."""
_NUMBER = re.compile(r"[+-]\d+([.,]\d+)?([eE][+-]?\d+)?")


@contextmanager
def atomic_write(path: Path) -> Generator[Path, None, None]:
    """Yield a path in the same folder, of the same suffix, to write to; no other has it.

    The file then appears at `path`, in place of one that is there and readable by the same people,
    or not at all after an error.
    """
    if path.is_dir():
        raise IsADirectoryError(f"{path} is a folder; name a file to write.")
    target = Path(os.path.realpath(path))
    unfinished = target.with_name(f".{secrets.token_hex(8)}.part{path.suffix}")
    try:
        yield unfinished
        if target.exists():
            shutil.copymode(target, unfinished)
        os.replace(unfinished, target)
    except OSError as error:
        if error.errno is None or error.filename not in (None, unfinished, str(unfinished)):
            raise
        raise OSError(error.errno, error.strerror, str(path)) from error
    finally:
        unfinished.unlink(missing_ok=True)


def check_destination(path: Path, suffixes: Collection[str] = (), purpose: str = "") -> str:
    """Return the suffix of a file that can be written, in small letters; refuse others."""
    suffix = path.suffix.lower()
    if suffixes and suffix not in suffixes:
        raise ValueError(f"{path.name!r} must end in one of {sorted(suffixes)} {purpose}.")
    if not path.parent.is_dir():
        raise FileNotFoundError(f"The folder {str(path.parent)!r} does not exist; make it first.")
    return suffix


def write_table(table: pd.DataFrame, path: Path, **options: Any) -> Path:
    """Write a table as CSV, with the options of pandas, and return its path.

    A text that a spreadsheet would run as a formula gets an apostrophe before it.
    """
    import pandas as pd

    plain: Any = table.rename(index=_no_formula)
    for name in table:
        if table[name].dtype.kind not in "biuf":
            cells = [_no_formula(cell) for cell in plain[name]]
            plain[name] = pd.Series(cells, plain.index, dtype=object)  # also what is no text
    with atomic_write(path) as unfinished:
        plain.to_csv(unfinished, errors="backslashreplace", **options)
    return path


def _no_formula(value: Any) -> Any:
    """Return a cell that no spreadsheet takes for a formula; a number stays one."""
    formula = isinstance(value, str) and value.startswith(_FORMULA)
    return f"'{value}" if formula and not _NUMBER.fullmatch(value) else value
