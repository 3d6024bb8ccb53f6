"""Who may ask the server, and what every answer says of itself."""

from __future__ import annotations

import ipaddress
import socket

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import JSONResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

LOOPBACK = ("127.0.0.1", "localhost", "::1")
WILDCARDS = ("0.0.0.0", "::", "")
HEADERS = {
    "x-content-type-options": "nosniff",
    "x-frame-options": "DENY",
    "referrer-policy": "no-referrer",
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
    "cache-control": "no-store",
}


class Guard:
    """Answers only those who call the server by its own name, and pages that it gave out itself.

    A page of somebody else may make a browser send requests to this machine, and may have its own
    name lead here (DNS rebinding). Both tell in the headers ``Origin`` and ``Host``.

    Parameters
    ----------
    app : ASGI application
    host : str
        What the server listens at. Where that is every address of the machine, it may be called by
        any of them in numbers, or by the machine's name.

    """

    def __init__(self, app: ASGIApp, host: str) -> None:
        self.app = app
        self.anywhere = host in WILDCARDS
        self.names = {*LOOPBACK, host, *([socket.gethostname().lower()] if self.anywhere else [])}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer one request."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return

        async def told(message: Message) -> None:
            if message["type"] == "http.response.start":
                MutableHeaders(scope=message).update(HEADERS)
            await send(message)

        refusal = self._refusal(Headers(scope=scope))
        answer = self.app if refusal is None else JSONResponse({"detail": refusal}, 403)
        await answer(scope, receive, told)

    def _refusal(self, headers: Headers) -> str | None:
        host = headers.get("host", "")
        if not self._is_mine(host):
            return "This server is not called that; open the address that it printed."
        origin = headers.get("origin")
        if origin is not None and origin.lower() != f"http://{host.lower()}":
            return "Pages of other places may not ask this server."
        if headers.get("sec-fetch-site", "none") not in ("none", "same-origin"):
            return "Pages of other places may not ask this server."
        return None

    def _is_mine(self, host: str) -> bool:
        name = _without_port(host).lower()
        return name in self.names or (self.anywhere and _is_number(name))


def _without_port(host: str) -> str:
    if host.startswith("["):
        return host[1:].partition("]")[0]
    return host.partition(":")[0]


def _is_number(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True
