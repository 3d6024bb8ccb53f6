"""Jobs in child processes, a few at a time, and a folder for their files."""

from __future__ import annotations

import asyncio
import os
import shutil
import tempfile
from contextlib import suppress
from pathlib import Path
from typing import IO

from eigenwalker.io.sandbox import Job, JobError

try:
    import fcntl
except ImportError:  # Windows, where a file that is open cannot be removed
    fcntl = None

N_JOBS = max(2, min(os.cpu_count() or 2, 4))
"""Jobs that run at once, so that one slow file does not hold up all others."""
_PREFIX, _IN_USE = "eigenwalker-", ".in-use"


class Refused(ValueError):  # noqa: N818 - the name says what happened
    """What was sent cannot be used; the message says why."""


class Ending(Exception):  # noqa: N818 - the name says what happens
    """The server is about to end."""


class TaskRunner:
    """Runs the jobs of a server, a few at once.

    Used as a context manager: `folder` and all that is in it are removed at the end. What a server
    left that was killed is removed when the next one starts.
    """

    def __init__(self) -> None:
        self._turn = asyncio.Semaphore(N_JOBS)
        self._running: set[asyncio.Task[bytes]] = set()
        self._closed = False

    def __enter__(self) -> TaskRunner:
        remove_abandoned(Path(tempfile.gettempdir()))
        self.folder = Path(tempfile.mkdtemp(prefix=_PREFIX))
        self._in_use = (self.folder / _IN_USE).open("w")
        _lock(self._in_use)
        return self

    def __exit__(self, *_: object) -> None:
        self._in_use.close()
        shutil.rmtree(self.folder, ignore_errors=True)

    def close(self) -> None:
        """End the jobs that run, and begin none."""
        self._closed = True
        for job in self._running:
            job.cancel()

    def workdir(self) -> tempfile.TemporaryDirectory[str]:
        """Return a folder for one job, which removes itself."""
        return tempfile.TemporaryDirectory(dir=self.folder, ignore_cleanup_errors=True)

    async def run(self, job: Job) -> bytes:
        """Return the result of a job, once there is a turn for it; the job ends if cancelled."""
        async with self._turn:
            if self._closed:
                raise Ending("The server was ended.")
            task = asyncio.create_task(job.run_async())
            self._running.add(task)
            try:
                return await task
            except JobError as error:
                raise Refused(_sentence(job, error)) from None
            except asyncio.CancelledError:
                if self._closed:
                    raise Ending("The server was ended.") from None
                raise
            finally:
                self._running.discard(task)


def remove_abandoned(folder: Path) -> None:
    """Remove the folders of servers that were killed, which no process has in use any more."""
    for left in folder.glob(f"{_PREFIX}*/{_IN_USE}"):
        with suppress(OSError):
            if left.parent.is_symlink() or (fcntl and left.stat().st_uid != os.getuid()):
                continue
            with left.open("a") as file:
                _lock(file)
            left.unlink()
            shutil.rmtree(left.parent)


def _lock(file: IO[str]) -> None:
    """Lock a file for as long as it is open; OSError if another process has it."""
    if fcntl:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)


def _sentence(job: Job, error: JobError) -> str:
    return {
        "refused": error.message,
        "too large": f"This needs more than {job.max_bytes / 2**30:g} GiB of memory.",
        "too slow": f"This takes more than {job.seconds} s, which is too long.",
        "failed": f"This cannot be used: its reader breaks down over it (status {error.status}).",
    }[error.reason]
