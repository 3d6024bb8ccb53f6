"""A server that runs until it is told to stop."""

from __future__ import annotations

import contextlib
import socket
from collections.abc import Callable
from types import FrameType

import uvicorn
from fastapi import FastAPI

from eigenwalker.web.host_check import WILDCARDS

USUAL_PORT = 8640
"""Taken where it is free, so that an address that was kept still leads to the page."""

MOST_AT_ONCE = 50
"""Requests; more are told to come back later."""


def listening_socket(host: str, port: int | None) -> socket.socket:
    """Return a socket that listens: at the port, or where none is asked for at a free one.

    Raises
    ------
    OSError
        If the port is taken, or the host is not this machine.

    """
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    if port is not None:
        return _bound(host, port, family)
    try:
        return _bound(host, USUAL_PORT, family)
    except OSError:
        return _bound(host, 0, family)


def _bound(host: str, port: int, family: socket.AddressFamily) -> socket.socket:
    try:
        return socket.create_server((host, port), family=family)
    except (OSError, OverflowError) as error:
        why = getattr(error, "strerror", None) or str(error)
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
) -> None:
    """Serve until interrupted; `on_exit` is called as soon as that happens."""
    config = uvicorn.Config(
        app,
        log_level="warning",
        server_header=False,
        timeout_graceful_shutdown=1,
        limit_concurrency=MOST_AT_ONCE,
        ws="none",
    )
    when_ready()
    with contextlib.suppress(KeyboardInterrupt), bound:
        _Server(config, on_exit).run(sockets=[bound])


class _Server(uvicorn.Server):
    """A server that ends its work as soon as it is told to end itself."""

    def __init__(self, config: uvicorn.Config, on_exit: Callable[[], None]) -> None:
        super().__init__(config)
        self._on_exit = on_exit

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:
        self._on_exit()
        super().handle_exit(sig, frame)
