"""A server of pages: its application, its socket, its start, and its end on an interrupt."""

from __future__ import annotations

import asyncio
import contextlib
import errno
import socket
from collections.abc import Awaitable, Callable, Collection, Coroutine
from types import FrameType
from typing import Any, TypeVar

import uvicorn
from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from starlette.middleware.gzip import GZipMiddleware
from starlette.requests import ClientDisconnect

from eigenwalker.web.host_check import WILDCARDS, HostCheck
from eigenwalker.web.task_runner import Ending
from eigenwalker.web.upload import TooLarge

_Answer = TypeVar("_Answer")

DEFAULT_PORT = 8640
"""Taken where it is free, so that a bookmarked address still leads to the page."""
NO_ROOM = "The server has no room for this, or may not write into its folder."
_NO_ROOM = (errno.ENOSPC, errno.EDQUOT, errno.EACCES, errno.EROFS)
KEEP_ALIVE_S = 75
"""Longer than proxies and observers wait between two requests: none meets a closing connection."""
MAX_CONCURRENT = 50
"""Requests; more are answered with 503."""


def new_app(
    lifespan: Any,
    *,
    host: str,
    public_url: str = "",
    pages: Collection[str] = (),
) -> FastAPI:
    """Return an application without routes, which refuses in sentences (``detail``).

    `public_url` is where a proxy gives it to others; `pages` begin the paths of pages that links
    elsewhere may open.
    """
    app = FastAPI(lifespan=lifespan, docs_url=None, redoc_url=None, openapi_url=None)
    app.add_middleware(GZipMiddleware, minimum_size=2000)
    app.add_middleware(HostCheck, host=host, public_url=public_url, pages=pages)
    for error, status, sentence in (
        (Exception, 500, "This went wrong here; the terminal says how."),
        (404, 404, "There is nothing of that name here."),
        (Ending, 503, None),
        (TooLarge, 413, None),
        (ClientDisconnect, 400, "The request ended before it was whole."),
        (ValueError, 422, None),
        (RequestValidationError, 422, None),
    ):
        app.add_exception_handler(error, _answer_with(status, sentence))
    app.add_exception_handler(OSError, _no_room)
    return app


async def _no_room(_: Request, error: Exception) -> JSONResponse:
    """Answer for a folder that takes no more; any other fault of the system is ours (500)."""
    if not (isinstance(error, OSError) and error.errno in _NO_ROOM):
        raise error
    return JSONResponse({"detail": NO_ROOM}, 507)


def _answer_with(
    status: int, sentence: str | None
) -> Callable[[Request, Exception], Awaitable[JSONResponse]]:
    async def answer(_: Request, error: Exception) -> JSONResponse:
        detail = str(error) if sentence is None else sentence
        if isinstance(error, RequestValidationError):
            wrong = ", ".join(str(each["loc"][-1]) for each in error.errors())
            detail = f"The request is not as it should be: {wrong}."
        return JSONResponse({"detail": detail}, status)

    return answer


async def while_connected(request: Request, answer: Coroutine[Any, Any, _Answer]) -> _Answer:
    """Return an answer; what makes it ends as soon as the client that waits for it has left."""
    making = asyncio.ensure_future(answer)
    leaving = asyncio.ensure_future(_left(request))
    try:
        await asyncio.wait({making, leaving}, return_when=asyncio.FIRST_COMPLETED)
        if not making.done():
            raise ClientDisconnect
        return making.result()
    finally:
        leaving.cancel()
        making.cancel()
        await asyncio.gather(making, leaving, return_exceptions=True)


async def _left(request: Request) -> None:
    while not await request.is_disconnected():
        await asyncio.sleep(0.2)


def listening_socket(host: str, port: int | None) -> socket.socket:
    """Return a socket that listens at a port, by default the usual one or any that is free."""
    if port is not None:
        return _bound(host, port)
    try:
        return _bound(host, DEFAULT_PORT)
    except OSError:
        return _bound(host, 0)


def _bound(host: str, port: int) -> socket.socket:
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    try:
        return socket.create_server((host, port), family=family)
    except (OSError, OverflowError) as error:
        why = (getattr(error, "strerror", None) or str(error)).partition(" (while ")[0]
        raise OSError(f"Nothing can be served at {host}, port {port}: {why}.") from None


def address_of(bound: socket.socket, host: str) -> str:
    """Return the address to open in a browser of this machine."""
    name = "127.0.0.1" if host in WILDCARDS else host
    return f"http://{f'[{name}]' if ':' in name else name}:{bound.getsockname()[1]}/"


def run(
    app: FastAPI,
    bound: socket.socket,
    *,
    when_ready: Callable[[], None],
    on_exit: Callable[[], None],
    max_concurrent: int = MAX_CONCURRENT,
) -> None:
    """Serve until interrupted; `on_exit` is called as soon as that happens."""
    config = uvicorn.Config(
        app,
        log_level="warning",
        server_header=False,
        timeout_keep_alive=KEEP_ALIVE_S,
        proxy_headers=False,
        timeout_graceful_shutdown=1,
        limit_concurrency=max_concurrent,
        ws="none",
    )
    when_ready()
    with contextlib.suppress(KeyboardInterrupt), bound:
        _Server(config, on_exit).run(sockets=[bound])


class _Server(uvicorn.Server):
    """A server that ends its jobs as soon as it is interrupted."""

    def __init__(self, config: uvicorn.Config, on_exit: Callable[[], None]) -> None:
        super().__init__(config)
        self._on_exit = on_exit

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:
        self._on_exit()
        super().handle_exit(sig, frame)
