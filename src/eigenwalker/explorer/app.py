"""The routes: the page, and what it asks of Python."""

from __future__ import annotations

import re
import secrets
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

from fastapi import FastAPI, Query, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import HTMLResponse, JSONResponse, Response
from starlette.middleware.gzip import GZipMiddleware

from eigenwalker.explorer import tasks, tasks_child as child_side, upload
from eigenwalker.explorer.interactive_page import interactive_page
from eigenwalker.explorer.model import page_model
from eigenwalker.explorer.tasks import Refused, Workshop
from eigenwalker.explorer.upload import TooLarge, kept, listed, parted
from eigenwalker.population.population import Population
from eigenwalker.web.host_check import Guard

FILMS = {"mp4": "video/mp4", "webm": "video/webm", "gif": "image/gif"}
MOST_PIXELS = 2e9
"""Of all frames of a film: a minute at 60 Hz of 700 x 700."""
MOST_DOTS = 4_000_000
"""Computed for all frames of a film: a minute at 60 Hz of 1000."""
MOST_STIMULUS = 64_000_000
MOST_POPULATIONS = 20
_SERVED = "served"
_KEPT = re.compile(f"{_SERVED}|[0-9a-f]{{16}}")
"""Names under which populations are kept."""


def make_app(
    population: Population,
    *,
    host: str = "127.0.0.1",
    title: str = "",
    source: str = "",
) -> FastAPI:
    """Return the application that serves the interactive page of a population.

    ========================= ===================================================================
    ``GET /``                 the page
    ``POST /api/capture``     a capture as a point of the population's space
    ``POST /api/population``  the model of a population's file, or of many captures
    ``POST /api/film``        a film of a stimulus
    ========================= ===================================================================

    Whatever is sent is read by a process of its own, one at a time, within limits of time and
    memory, and removed afterwards. What cannot be used is refused with a sentence (``detail``).

    Parameters
    ----------
    population : Population
        What the page shows at first.
    host : str
        Where the server listens: who calls it otherwise is refused.
    title, source : str
        As `page_model` takes them.

    Returns
    -------
    FastAPI

    """
    workshop = Workshop()
    model = page_model(population, title=title, source=source) | {"population": _SERVED}
    page = interactive_page(model, server=True)

    @asynccontextmanager
    async def opened(_: FastAPI) -> AsyncIterator[None]:
        with workshop:
            population.save(workshop.folder / f"{_SERVED}.nc")
            yield

    app = FastAPI(lifespan=opened, docs_url=None, redoc_url=None, openapi_url=None)
    app.state.workshop = workshop
    app.add_middleware(GZipMiddleware, minimum_size=2000)
    app.add_middleware(Guard, host=host)
    _add_refusals(app)

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
    """A capture, and the files it needs beside it, as a walker of the population."""
    workshop = _workshop(request)
    people = workshop.folder / f"{population}.nc"
    if not _KEPT.fullmatch(population) or not people.is_file():
        raise Refused("That population is no longer here; load it again.")
    with workshop.bench() as bench:
        asked = {
            "files": await _received(request, Path(bench), name, files),
            "population": str(people),
            "unit": unit,
            "rate_hz": rate,
        }
        return await workshop.done(tasks.CAPTURE, Path(bench), asked)


async def read_population(request: Request, name: str = "", files: str = "") -> dict[str, Any]:
    """The model of a population's file, or of captures that are made into a population."""
    workshop = _workshop(request)
    with workshop.bench() as bench:
        folder = Path(bench)
        task = tasks.STUDY if files else tasks.POPULATION
        asked = {"files": await _received(request, folder, name, files)}
        answer = await workshop.done(task, folder, asked)
        answer["model"]["population"] = _keep(workshop, folder / child_side.PEOPLE)
        return answer


def _keep(workshop: Workshop, people: Path) -> str:
    """Keep a population for captures to be compared with, and forget the oldest of many."""
    known = sorted(workshop.folder.glob("*.nc"), key=lambda path: path.stat().st_mtime_ns)
    others = [path for path in known if path.stem != _SERVED]
    for path in others[: max(len(others) - MOST_POPULATIONS + 1, 0)]:
        path.unlink()
    name = secrets.token_hex(8)
    people.rename(workshop.folder / f"{name}.nc")
    return name


async def make_film(request: Request, format: str = Query(...)) -> Response:
    """A film of a stimulus."""
    if format not in FILMS:
        raise Refused(f"Films are made as {', '.join(FILMS)}, not as {format[:20]!r}.")
    workshop = _workshop(request)
    with workshop.bench() as bench:
        folder = Path(bench)
        sent = child_side.sent_to(folder)
        await kept(request.stream(), sent / "stimulus.json", MOST_STIMULUS)
        asked = {"files": ["stimulus.json"], "format": format}
        asked |= {"most_pixels": MOST_PIXELS, "most_dots": MOST_DOTS}
        answer = await workshop.done(tasks.FILM, folder, asked)
        film = (folder / answer["file"]).read_bytes()
    return Response(film, media_type=FILMS[format])


async def _received(request: Request, bench: Path, name: str, files: str) -> list[str]:
    """Write the files of a request into a folder of their own, and return their names."""
    folder, whole = child_side.sent_to(bench), bench / "whole"
    await kept(request.stream(), whole, upload.MOST_BYTES)
    sizes = listed(files) if files else [(name or "file", whole.stat().st_size)]
    paths = parted(whole, sizes, folder)
    whole.unlink()
    return [path.name for path in paths]


def _workshop(request: Request) -> Workshop:
    return request.app.state.workshop


def _add_refusals(app: FastAPI) -> None:
    """Say in a sentence what is wrong, whatever it is."""

    def says(status: int) -> Callable[[Request, Exception], Awaitable[JSONResponse]]:
        async def answer(_: Request, error: Exception) -> JSONResponse:
            return JSONResponse({"detail": str(error)}, status)

        return answer

    async def odd(_: Request, error: Exception) -> JSONResponse:
        assert isinstance(error, RequestValidationError)
        wrong = ", ".join(str(each["loc"][-1]) for each in error.errors())
        return JSONResponse({"detail": f"The request is not as it should be: {wrong}."}, 422)

    async def nothing(_: Request, __: Exception) -> JSONResponse:
        return JSONResponse({"detail": "There is nothing of that name here."}, 404)

    async def broken(_: Request, __: Exception) -> JSONResponse:
        return JSONResponse({"detail": "This went wrong here; the terminal says how."}, 500)

    app.add_exception_handler(Exception, broken)
    app.add_exception_handler(tasks.Ending, says(503))
    app.add_exception_handler(TooLarge, says(413))
    app.add_exception_handler(ValueError, says(422))
    app.add_exception_handler(RequestValidationError, odd)
    app.add_exception_handler(404, nothing)
