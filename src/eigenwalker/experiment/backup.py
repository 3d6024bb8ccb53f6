"""Copies of the database while it is in use, and what a withdrawal does to those in the folder."""

from __future__ import annotations

import json
import sqlite3
import threading
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Any

from eigenwalker.core.atomic_write import atomic_write
from eigenwalker.experiment import store
from eigenwalker.experiment.experiment_folder import ANSWERS, BACKUPS, STIMULI, VERSIONS
from eigenwalker.experiment.rescue import FORMAT

HOUR_S = 3600.0


def back_up(folder: Path, target: Path | None = None) -> Path:
    """Write a copy of the answers by SQLite's own online copy, and return where it is."""
    path = target or folder / BACKUPS / ANSWERS
    path.parent.mkdir(parents=True, exist_ok=True)
    with (
        closing(store.read_only(folder / ANSWERS)) as source,
        atomic_write(path) as unfinished,
        closing(sqlite3.connect(unfinished)) as copy,
    ):
        source.backup(copy)
        copy.execute("PRAGMA journal_mode = DELETE")
    return path


@contextmanager
def hourly_backup(
    folder: Path, say: Callable[[str], None], *, every_s: float = HOUR_S
) -> Iterator[None]:
    """Write a copy now and every hour until the end, and say where or why not."""
    ended = threading.Event()

    def run() -> None:
        while True:
            try:
                say(f"Backup: {back_up(folder)}")
            except (OSError, sqlite3.Error) as error:
                say(f"No backup was written: {error}")
            if ended.wait(every_s):
                return

    thread = threading.Thread(target=run, name="backup", daemon=True)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()


def forget_in_copies(folder: Path, sessions: list[int]) -> None:
    """Remove what copies inside the folder hold of sessions that were withdrawn."""
    for path in folder.rglob("*.json"):
        if path.relative_to(folder).parts[0] in (STIMULI, VERSIONS):
            continue
        content = _rescue_file(path)
        if content is not None and content.get("session") in sessions:
            path.unlink()
    copies = list((folder / BACKUPS).glob("*.sqlite"))
    for path in copies:
        path.unlink()
    if copies:
        back_up(folder)


def _rescue_file(path: Path) -> dict[str, Any] | None:
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return None
    return content if isinstance(content, dict) and content.get("format") == FORMAT else None
