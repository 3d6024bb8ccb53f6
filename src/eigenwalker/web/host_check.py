"""Which requests a server answers, and what headers every answer has."""

from __future__ import annotations

import ipaddress
import socket
from collections.abc import Collection
from urllib.parse import urlsplit

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
    """Answers only requests to the server's own names, from pages that it gave out itself.

    Any page may make a browser send requests to this machine, and may have its own name lead here
    (DNS rebinding). The headers ``Origin`` and ``Host`` show both. `public_url` is the server's
    address behind a proxy, such as ``https://lab.example``. A link on a page elsewhere may open a
    page whose path begins with one of `pages`, as a whole page and with nothing sent to it.
    """

    def __init__(
        self, app: ASGIApp, host: str, public_url: str = "", pages: Collection[str] = ()
    ) -> None:
        self.app = app
        self.anywhere = host in WILDCARDS
        self.names = {*LOOPBACK, host, *([socket.gethostname().lower()] if self.anywhere else [])}
        public = urlsplit(public_url.lower())
        self.names |= {public.hostname} if public.hostname else set()
        self.public_origin = f"{public.scheme}://{public.netloc}"
        self.pages = tuple(pages)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer one request."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return

        async def send_with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                MutableHeaders(scope=message).update(HEADERS)
            await send(message)

        refusal = self._refusal(scope, Headers(scope=scope))
        answer = self.app if refusal is None else JSONResponse({"detail": refusal}, 403)
        await answer(scope, receive, send_with_headers)

    def _refusal(self, scope: Scope, headers: Headers) -> str | None:
        host = headers.get("host", "").lower()
        name = host[1:].partition("]")[0] if host.startswith("[") else host.partition(":")[0]
        if name not in self.names and not (self.anywhere and _is_address(name)):
            return "This server is not called that; open the address that it printed."
        if self._is_followed_link(scope, headers):
            return None
        origin = headers.get("origin", f"http://{host}").lower()
        site = headers.get("sec-fetch-site", "none")
        own = (f"http://{host}", self.public_origin)
        if origin not in own or site not in ("none", "same-origin"):
            return "Pages of other places may not ask this server."
        return None

    def _is_followed_link(self, scope: Scope, headers: Headers) -> bool:
        """Whether a browser opens a page, wherever the link to it was."""
        how = (headers.get("sec-fetch-mode"), headers.get("sec-fetch-dest"))
        return (
            scope["method"] in ("GET", "HEAD")
            and scope["path"].startswith(self.pages)
            and how == ("navigate", "document")
        )


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True
