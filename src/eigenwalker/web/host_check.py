"""Which requests a server answers, and what headers every answer has."""

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


class HostCheck:
    """Answers only requests to the server's own name, from pages that it gave out itself.

    Any page may make a browser send requests to this machine, and may have its own name lead here
    (DNS rebinding). The headers ``Origin`` and ``Host`` show both.
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

        async def send_with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                MutableHeaders(scope=message).update(HEADERS)
            await send(message)

        refusal = self._refusal(Headers(scope=scope))
        answer = self.app if refusal is None else JSONResponse({"detail": refusal}, 403)
        await answer(scope, receive, send_with_headers)

    def _refusal(self, headers: Headers) -> str | None:
        host = headers.get("host", "").lower()
        name = host[1:].partition("]")[0] if host.startswith("[") else host.partition(":")[0]
        if name not in self.names and not (self.anywhere and _is_address(name)):
            return "This server is not called that; open the address that it printed."
        origin = headers.get("origin", f"http://{host}").lower()
        site = headers.get("sec-fetch-site", "none")
        if origin != f"http://{host}" or site not in ("none", "same-origin"):
            return "Pages of other places may not ask this server."
        return None


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True
