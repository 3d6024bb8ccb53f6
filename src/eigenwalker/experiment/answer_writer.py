"""The one writer of a database: works wait in a row, and share a flush to disk."""

from __future__ import annotations

import errno
import queue
import sqlite3
import threading
from collections.abc import Callable
from concurrent.futures import Future
from pathlib import Path
from typing import Any, TypeVar

from eigenwalker.experiment import store

Result = TypeVar("Result")
Work = Callable[[sqlite3.Connection], Any]
MAX_SHARED = 200
"""Works that share one flush."""
NO_ROOM = "Answers cannot be written: {}. Nothing was confirmed; pages keep theirs and send again."


class AnswerWriter:
    """Runs works on the database, one after the other, in a thread of its own.

    A work's result is there only once what it wrote is on disk. Used as a context manager; at the
    end it does what still waits.
    """

    def __init__(self, path: Path) -> None:
        self._connection = store.connect(path)
        self._waiting: queue.SimpleQueue[tuple[Work, Future[Any], bool] | None]
        self._waiting = queue.SimpleQueue()
        self._thread = threading.Thread(target=self._run, name="answers", daemon=True)
        self.trouble = ""
        """What is wrong with the file, where something is."""

    def __enter__(self) -> AnswerWriter:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._waiting.put(None)
        self._thread.join()
        self._connection.close()

    def do(self, work: Callable[[sqlite3.Connection], Result], *, alone: bool = False) -> Result:
        """Return the result of a work, when it is on disk; `alone` runs it in no transaction."""
        return self.submit(work, alone=alone).result()

    def submit(
        self, work: Callable[[sqlite3.Connection], Result], *, alone: bool = False
    ) -> Future[Result]:
        """Have a work done, and return its result to come."""
        future: Future[Result] = Future()
        self._waiting.put((work, future, alone))
        return future

    def _run(self) -> None:
        while (first := self._waiting.get()) is not None:
            works = [first]
            ended = False
            while len(works) < MAX_SHARED and not self._waiting.empty():
                following = self._waiting.get()
                if following is None:
                    ended = True
                    break
                works.append(following)
            self._do_all(works)
            if ended:
                return

    def _do_all(self, works: list[tuple[Work, Future[Any], bool]]) -> None:
        shared = [(work, future) for work, future, alone in works if not alone]
        if shared:
            self._do_shared(shared)
        for work, future, alone in works:
            if alone:
                _settle(future, lambda work=work: work(self._connection))

    def _do_shared(self, works: list[tuple[Work, Future[Any]]]) -> None:
        """Do works in one transaction; their results are given after it is on disk."""
        done: list[tuple[Future[Any], Any, BaseException | None]] = []
        try:
            with store.transaction(self._connection):
                for work, future in works:
                    try:
                        done.append((future, store.within(self._connection, work), None))
                    except sqlite3.OperationalError:
                        raise
                    except Exception as error:
                        done.append((future, None, error))
            self.trouble = ""
        except Exception as error:  # whatever it is, the thread lives on and nothing is confirmed
            self.trouble = str(error)
            refusal = OSError(errno.ENOSPC, NO_ROOM.format(error))
            done = [(future, None, refusal) for _, future in works]
        for future, result, error in done:
            if error is None:
                future.set_result(result)
            else:
                future.set_exception(error)


def _settle(future: Future[Any], work: Callable[[], Any]) -> None:
    try:
        future.set_result(work())
    except sqlite3.OperationalError as error:
        future.set_exception(OSError(errno.ENOSPC, NO_ROOM.format(error)))
    except Exception as error:
        future.set_exception(error)
