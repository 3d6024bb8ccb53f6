"""Jobs in child processes, one at a time, and a folder for their files."""

from __future__ import annotations

import asyncio
import shutil
import tempfile
from pathlib import Path

from eigenwalker.io.sandbox import Job, JobError


class Refused(ValueError):  # noqa: N818 - the name says what happened
    """What was sent cannot be used; the message says why."""


class Ending(Exception):  # noqa: N818 - the name says what happens
    """The server is about to end."""


class TaskRunner:
    """Runs the jobs of a server, each after the one before.

    Used as a context manager: `folder` and all that is in it are removed at the end.
    """

    def __init__(self) -> None:
        self._turn = asyncio.Semaphore(1)
        self._current: asyncio.Task[bytes] | None = None
        self._closed = False

    def __enter__(self) -> TaskRunner:
        self.folder = Path(tempfile.mkdtemp(prefix="eigenwalker-"))
        return self

    def __exit__(self, *_: object) -> None:
        shutil.rmtree(self.folder, ignore_errors=True)

    def close(self) -> None:
        """End the job that runs, and begin none."""
        self._closed = True
        if self._current is not None:
            self._current.cancel()

    def workdir(self) -> tempfile.TemporaryDirectory[str]:
        """Return a folder for one job, which removes itself."""
        return tempfile.TemporaryDirectory(dir=self.folder, ignore_cleanup_errors=True)

    async def run(self, job: Job) -> bytes:
        """Return the result of a job, after those that came before it."""
        async with self._turn:
            if self._closed:
                raise Ending("The server was ended.")
            self._current = asyncio.create_task(job.run_async())
            try:
                return await self._current
            except JobError as error:
                raise Refused(_sentence(job, error)) from None
            except asyncio.CancelledError:
                if self._closed:
                    raise Ending("The server was ended.") from None
                raise


def _sentence(job: Job, error: JobError) -> str:
    return {
        "refused": error.message,
        "too large": f"This needs more than {job.max_bytes / 2**30:g} GiB of memory.",
        "too slow": f"This takes more than {job.seconds} s, which is too long.",
        "failed": f"This cannot be used: its reader breaks down over it (status {error.status}).",
    }[error.reason]
