"""Functions that die, hang, refuse or need too much end in a JobError."""

from __future__ import annotations

import asyncio
import sys
import time
from pathlib import Path

import pytest

from eigenwalker.io.sandbox import Job, JobError

FUNCTIONS = """
import os, time
import numpy as np

def dies():
    os.abort()

def hangs():
    time.sleep(60)

def wants_too_much():
    return bytes(np.ones(2**28))

def returns_too_much():
    return bytes(2**29)

def refuses():
    raise ValueError("a reason")

def breaks():
    raise KeyError("a key")

def echoes(*words):
    print("noise")
    return " ".join(words).encode()
"""


@pytest.fixture
def job(tmp_path: Path):
    def make(name: str, *arguments: str) -> Job:
        path = tmp_path / "functions.py"
        path.write_text(FUNCTIONS)
        namespace: dict = {}
        exec(compile(FUNCTIONS, path, "exec"), namespace)
        return Job(namespace[name], arguments, seconds=3, max_bytes=2**28 + 2**27)

    return make


@pytest.fixture(params=["run", "run_async"])
def run(request):
    return (lambda job: job.run()) if request.param == "run" else _run_async


def _run_async(job: Job) -> bytes:
    return asyncio.run(job.run_async())


ON_LINUX = pytest.mark.skipif(sys.platform != "linux", reason="no limit of memory there")


@pytest.mark.parametrize(
    ("name", "reason", "message"),
    [
        ("dies", "failed", ""),
        ("hangs", "too slow", ""),
        pytest.param("wants_too_much", "too large", "", marks=ON_LINUX),
        ("returns_too_much", "too large", ""),
        ("refuses", "refused", "a reason"),
        ("breaks", "failed", "'a key'"),
    ],
)
def test_a_function_that_gives_no_result_is_an_error_with_its_reason(
    job, run, name, reason, message
):
    with pytest.raises(JobError) as error:
        run(job(name))
    assert (error.value.reason, error.value.message) == (reason, message)


def test_a_result_holds_what_the_function_returns_and_nothing_that_it_prints(job, run):
    assert run(job("echoes", "two", "words")) == b"two words"


def test_a_cancelled_job_ends_its_process(job):
    async def cancel() -> None:
        task = asyncio.ensure_future(job("hangs").run_async())
        await asyncio.sleep(0.2)
        task.cancel()
        with pytest.raises(asyncio.CancelledError):
            await task

    start = time.monotonic()
    asyncio.run(cancel())
    assert time.monotonic() - start < 3
