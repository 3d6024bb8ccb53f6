"""Work that the server has done by child processes, one at a time."""

from __future__ import annotations

import asyncio
import json
import os
import shutil
import sys
import tempfile
from pathlib import Path
from typing import Any, NamedTuple

from eigenwalker.explorer import tasks_child as child_side

MOST_MEMORY = 4 * 2**30
"""Bytes that a child may ask for, where the system can limit that (Linux)."""


class Refused(ValueError):  # noqa: N818 - the name says what happened
    """What was sent cannot be used; the message says why."""


class Ending(Exception):  # noqa: N818 - the name says what happens
    """The server is about to end."""


class Task(NamedTuple):
    """Something that a child does: its name there, and how long it may take."""

    name: str
    seconds: int


CAPTURE = Task("capture", 90)
POPULATION = Task("population", 90)
STUDY = Task("study", 900)
FILM = Task("film", 180)


class Workshop:
    """A folder for work in progress, and the children that do it.

    Used as a context manager: the folder and all that is in it are removed at the end.
    """

    def __init__(self) -> None:
        self._turn = asyncio.Semaphore(1)
        self._child: asyncio.subprocess.Process | None = None
        self._closed = False

    def __enter__(self) -> Workshop:
        self.folder = Path(tempfile.mkdtemp(prefix="eigenwalker-"))
        return self

    def __exit__(self, *_: object) -> None:
        shutil.rmtree(self.folder, ignore_errors=True)

    def close(self) -> None:
        """End the work in progress and begin none."""
        self._closed = True
        if self._child is not None and self._child.returncode is None:
            self._child.kill()

    def bench(self) -> tempfile.TemporaryDirectory[str]:
        """Return a folder for one piece of work, which removes itself."""
        return tempfile.TemporaryDirectory(dir=self.folder, ignore_cleanup_errors=True)

    async def done(self, task: Task, bench: Path, asked: dict[str, Any]) -> dict[str, Any]:
        """Return what a child makes of what is asked, waiting for those who came before.

        Raises
        ------
        Refused
            If what was sent cannot be used, or takes too much time or memory.
        Ending
            If the server ends meanwhile.

        """
        (bench / child_side.ASKED).write_text(json.dumps(asked), encoding="utf-8")
        async with self._turn:
            status = 0 if self._closed else await self._run(task, bench)
        if self._closed:
            raise Ending("The server was ended.")
        if status == child_side.REFUSED:
            raise Refused(_answer(bench))
        if status == child_side.TOO_LARGE:
            raise Refused(f"This needs more than {MOST_MEMORY / 2**30:g} GiB of memory.")
        if status:
            raise Refused(f"This cannot be used: its reader breaks down over it (status {status}).")
        return _answer(bench)

    async def _run(self, task: Task, bench: Path) -> int:
        """Return the exit status of a child, which ends with whoever waits for it."""
        self._child = child = await asyncio.create_subprocess_exec(
            sys.executable, "-P", child_side.__file__,
            task.name, str(bench), str(task.seconds), str(MOST_MEMORY),
            stdin=asyncio.subprocess.DEVNULL,
            stdout=asyncio.subprocess.DEVNULL,
            stderr=asyncio.subprocess.DEVNULL,
            env=os.environ | {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"},
        )  # fmt: skip
        if self._closed:  # while the child was made
            child.kill()
        try:
            return await asyncio.wait_for(child.wait(), task.seconds)
        except TimeoutError:
            raise Refused(f"This takes more than {task.seconds} s, which is too long.") from None
        finally:
            if child.returncode is None:
                child.kill()
                await child.wait()


def _answer(bench: Path) -> Any:
    return json.loads((bench / child_side.ANSWER).read_text(encoding="utf-8"))
