"""Functions that a damaged file may crash: run in a process of their own, within limits.

Readers written in C can die, hang or ask for all the memory there is. Here they do so in a child
process, and the caller goes on with an error.
"""

from __future__ import annotations

import asyncio
import inspect
import os
import subprocess
import sys
from collections.abc import Callable, Generator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Literal

from eigenwalker.io import sandbox_child

Reason = Literal["refused", "failed", "too large", "too slow"]
_REASONS: dict[int, Reason] = {
    sandbox_child.REFUSED: "refused",
    sandbox_child.TOO_LARGE: "too large",
}


class JobError(Exception):
    """A function that ran in a child process gave no result.

    It raised a ValueError ("refused") or another error ("failed"), whose `message` is kept, or it
    died with the exit `status`, or needed more memory or time than it may have.
    """

    def __init__(self, reason: Reason, message: str = "", status: int = 0) -> None:
        super().__init__(reason, message, status)
        self.reason = reason
        self.message = message
        self.status = status


@dataclass(frozen=True)
class Job:
    """A function of texts that returns bytes, to be run in a process of its own.

    The child imports the function's module by path, and not this package. It is ended after
    `seconds`, and may take memory of `max_bytes`, where the system can limit that (Linux).
    """

    function: Callable[..., bytes]
    arguments: tuple[str, ...]
    seconds: int = 10
    max_bytes: int = 2**30

    def run(self) -> bytes:
        """Return what the function returns, or raise `JobError`."""
        try:
            with _pipe_that_ends() as stdin:
                child = subprocess.run(
                    self._command(),
                    stdin=stdin,
                    stdout=subprocess.PIPE,
                    stderr=subprocess.DEVNULL,
                    timeout=self.seconds,
                    check=False,
                    env=_environment(),
                    creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
                )
        except subprocess.TimeoutExpired as error:
            raise JobError("too slow") from error
        return self._result(child.returncode, child.stdout)

    async def run_async(self) -> bytes:
        """Return what the function returns, without blocking; the child ends if cancelled."""
        with _pipe_that_ends() as stdin:
            child = await asyncio.create_subprocess_exec(
                *self._command(),
                stdin=stdin,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                env=_environment(),
            )
            try:
                output, _ = await asyncio.wait_for(child.communicate(), self.seconds)
            except TimeoutError as error:
                raise JobError("too slow") from error
            finally:
                if child.returncode is None:
                    child.kill()
                    await child.wait()
        return self._result(child.returncode or 0, output)

    def _command(self) -> list[str]:
        # -P: nothing is imported from the folder in which the program happens to run
        start = [sys.executable, "-P", sandbox_child.__file__]
        function = [inspect.getfile(self.function), self.function.__name__]
        return [*start, *function, str(self.seconds), str(self.max_bytes), *self.arguments]

    def _result(self, status: int, output: bytes) -> bytes:
        if status == 0:
            return output
        message = output.decode(errors="replace")
        raise JobError(_REASONS.get(status, "failed"), message, status)


@contextmanager
def _pipe_that_ends() -> Generator[int]:
    """Yield an end to read of a pipe that nothing is written to, and that ends with this process.

    The child ends with it too, even where this process was killed.
    """
    reading, writing = os.pipe()
    try:
        yield reading
    finally:
        os.close(reading)
        os.close(writing)


def _environment() -> dict[str, str]:
    return os.environ | {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
