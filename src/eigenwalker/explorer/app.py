"""The routes of the interactive page: the page, and what it asks of Python."""

from __future__ import annotations

import json
import re
import secrets
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

from fastapi import FastAPI, Query, Request
from fastapi.responses import HTMLResponse, Response

from eigenwalker.explorer import tasks
from eigenwalker.explorer.interactive_page import interactive_page
from eigenwalker.explorer.model import page_models
from eigenwalker.io.sandbox import Job
from eigenwalker.markers.mapping import as_mapping
from eigenwalker.population.population import Population
from eigenwalker.web.run import new_app, while_connected
from eigenwalker.web.task_runner import Refused, TaskRunner
from eigenwalker.web.upload import receive_files, stream_to_file

FILMS = {
    "mp4": "video/mp4",
    "webm": "video/webm",
    "gif": "image/gif",
    "bvh": "text/plain",
    "glb": "model/gltf-binary",
}
"""What is made of a stimulus; BVH and GLB hold the movement of its first walker."""
MAX_MEMORY = 4 * 2**30
"""Bytes that a task may take, where the system can limit that (Linux)."""
SECONDS = {"capture": 90, "population": 90, "study": 900, "film": 180}
"""How long each task may take."""
MAX_PIXELS = 2e9
"""Of all frames of a film: a minute at 60 Hz of 700 x 700."""
MAX_DOTS = 4_000_000
"""Computed for all frames of a film: a minute at 60 Hz of 1000."""
MAX_STIMULUS_BYTES = 64_000_000
MAX_POPULATIONS = 20
_SERVED = "served"
_POPULATION = re.compile(f"{_SERVED}|[0-9a-f]{{16}}")
"""Names under which populations are kept."""


def make_app(
    population: Population,
    *,
    host: str = "127.0.0.1",
    title: str = "",
    source: str = "",
    mapping: Any = None,
    keep_size: bool = False,
) -> FastAPI:
    """Return the application that serves the interactive page of a population.

    ========================= ===================================================================
    ``GET /``                 the page
    ``POST /api/capture``     a capture as a point of the population's space
    ``POST /api/population``  the model of a population's file, or of many captures
    ``POST /api/film``        a film of a stimulus, or the movement of its first walker
    ========================= ===================================================================

    `mapping` is for captures with marker names of their own, as `virtual_markers` takes it; one
    that is sent beside a capture (TOML) is used instead.

    Files that are sent are read by child processes, a few at a time, within limits of time and
    memory, and removed afterwards. What cannot be used is refused with a sentence (``detail``).
    """
    runner = TaskRunner()
    models = page_models(population, keep_size=keep_size, title=title, source=source)
    model = models | {"population": _SERVED}
    page = interactive_page(model, server=True)

    @asynccontextmanager
    async def lifespan(_: FastAPI) -> AsyncIterator[None]:
        with runner:
            population.save(runner.folder / f"{_SERVED}.nc")
            yield

    app = new_app(lifespan, host=host)
    app.state.task_runner = runner
    app.state.mapping = as_mapping(mapping).as_dict()

    @app.api_route("/", methods=["GET", "HEAD"])
    def show_page() -> HTMLResponse:
        return HTMLResponse(page)

    app.post("/api/capture")(read_capture)
    app.post("/api/population")(read_population)
    app.post("/api/film")(make_film)
    return app


async def read_capture(
    request: Request,
    name: str = "",
    files: str = "",
    population: str = _SERVED,
    unit: str | None = None,
    rate: float | None = None,
) -> dict[str, Any]:
    """Return a capture, with the files it needs beside it, as a walker of the population."""
    runner = _runner(request)
    people = runner.folder / f"{population}.nc"
    if not _POPULATION.fullmatch(population) or not people.is_file():
        raise Refused("That population is no longer here; load it again.")
    with runner.workdir() as workdir:
        settings = {"population": str(people), "unit": unit, "rate_hz": rate}
        settings["mapping"] = request.app.state.mapping
        settings["files"] = await _receive(request, workdir, name, files)
        return await _run(request, tasks.capture, workdir, settings)


async def read_population(
    request: Request,
    name: str = "",
    files: str = "",
    unit: str | None = None,
    rate: float | None = None,
) -> dict[str, Any]:
    """Return the model of a population's file, or of captures that are made into a population."""
    runner = _runner(request)
    with runner.workdir() as workdir:
        settings = {"unit": unit, "rate_hz": rate, "mapping": request.app.state.mapping}
        settings["files"] = await _receive(request, workdir, name, files)
        task = tasks.study if files else tasks.population
        answer = await _run(request, task, workdir, settings)
        answer["model"]["population"] = _keep(runner.folder, Path(workdir, tasks.PEOPLE))
        return answer


def _keep(folder: Path, people: Path) -> str:
    """Keep a population for captures to be compared with, and remove the oldest of many."""
    known = sorted(folder.glob("*.nc"), key=lambda path: path.stat().st_mtime_ns)
    others = [path for path in known if path.stem != _SERVED]
    for path in others[: max(len(others) - MAX_POPULATIONS + 1, 0)]:
        path.unlink()
    name = secrets.token_hex(8)
    people.rename(folder / f"{name}.nc")
    return name


async def make_film(request: Request, format: str = Query(...)) -> Response:
    """Return a film of a stimulus."""
    if format not in FILMS:
        raise Refused(f"Films are made as {', '.join(FILMS)}, not as {format[:20]!r}.")
    runner = _runner(request)
    with runner.workdir() as workdir:
        stimulus = tasks.files_of(workdir) / "stimulus.json"
        await stream_to_file(request.stream(), stimulus, MAX_STIMULUS_BYTES)
        limits = {"max_pixels": MAX_PIXELS, "max_dots": MAX_DOTS}
        answer = await _run(request, tasks.film, workdir, {"format": format, **limits})
        film = Path(workdir, answer["file"]).read_bytes()
    return Response(film, media_type=FILMS[format])


def _runner(request: Request) -> TaskRunner:
    return request.app.state.task_runner


async def _receive(request: Request, workdir: str, name: str, manifest: str) -> list[str]:
    return await receive_files(request.stream(), tasks.files_of(workdir), name, manifest)


async def _run(
    request: Request, task: Callable[[str], bytes], workdir: str, settings: dict[str, Any]
) -> dict[str, Any]:
    """Return the answer of a task that a child process does in a folder."""
    Path(workdir, tasks.SETTINGS).write_text(json.dumps(settings), encoding="utf-8")
    job = Job(task, (workdir,), seconds=SECONDS[task.__name__], max_bytes=MAX_MEMORY)
    return json.loads(await while_connected(request, _runner(request).run(job)))
