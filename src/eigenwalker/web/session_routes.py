"""The routes of observers' pages, and of commands that hand their writes to a running server.

What answers is handed in (`Sessions`): this room knows no experiment.
"""

from __future__ import annotations

import gzip
import json
import re
import shutil
import tempfile
from collections.abc import Callable, Mapping, Sequence
from contextlib import nullcontext
from functools import lru_cache
from pathlib import Path
from typing import Annotated, Any, Literal, Protocol

from fastapi import Depends, FastAPI, HTTPException, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import FileResponse, HTMLResponse, JSONResponse, Response
from pydantic import BaseModel, ConfigDict, Field, ValidationError
from starlette.background import BackgroundTask
from starlette.middleware.exceptions import ExceptionMiddleware
from starlette.routing import request_response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from eigenwalker.web.host_check import HostCheck
from eigenwalker.web.request_rate import RequestRate, TooMany
from eigenwalker.web.run import NO_ROOM, new_app
from eigenwalker.web.upload import TooLarge

MAX_BODY = 4_000_000
"""Bytes of a request: some hundred answers with the times of all their frames."""
AT_ONCE, PER_S = 100, 20
"""Requests of one key: so many at once, then so many a second."""
NOT_ALLOWED = "This link or key does not open this."
ISOLATED = {"cross-origin-embedder-policy": "require-corp"}
"""With the opener policy of all pages: clocks are fine, to 5 microseconds."""
PAGE, ANSWERS = "/s/{key}", "/api/answers"

Text = Annotated[str, Field(max_length=200)]
Key = Annotated[str, Field(pattern=r"^[A-Za-z0-9_-]{22}$")]
Site = Annotated[dict[Text, Annotated[str, Field(max_length=300)]], Field(max_length=10)]


class Sessions(Protocol):
    """What answers for an experiment."""

    def welcome(self, key: str, site: Mapping[str, str] | None = None) -> Any: ...  # noqa: D102
    def start(  # noqa: D102
        self,
        key: str,
        *,
        consent: str,
        language: str,
        own_key: str = "",
        site: Mapping[str, str] | None = None,
    ) -> Any: ...
    def stimuli(self, key: str, session: int) -> Any: ...  # noqa: D102
    async def answers(self, key: str, session: int, items: Sequence[Any]) -> Any: ...  # noqa: D102
    def end(self, key: str, session: int, how: str) -> Any: ...  # noqa: D102
    def lab_page(self, key: str) -> str: ...  # noqa: D102
    def lab_export(self, key: str, target: Path) -> None: ...  # noqa: D102
    def page_version(self, key: str) -> str | None: ...  # noqa: D102
    def page(self, version: str) -> str | None: ...  # noqa: D102


class _Body(BaseModel):
    model_config = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False)


class WelcomeBody(_Body):
    """What the first page asks with."""

    site: Site = {}


class StartBody(_Body):
    """What an observer agreed to, in which language."""

    consent: Annotated[str, Field(pattern="^[0-9a-f]{64}$")]
    language: Annotated[str, Field(pattern="^[a-z]{2,3}$")]
    own_key: Key
    site: Site = {}


class SessionBody(_Body):
    """A session by its number."""

    session: Annotated[int, Field(ge=1, lt=2**53)]


class Item(_Body):
    """Something that a page reports once."""

    answer: Annotated[str, Field(pattern=r"^[A-Za-z0-9_-]{16,64}$")]
    kind: Literal["begun", "answer", "event", "screen", "questions"]
    trial: Annotated[int, Field(ge=1, le=100_000)] | None = None
    showing: Annotated[int | None, Field(ge=1, le=100_000, alias="attempt")] = None
    content: Annotated[dict[Text, Any], Field(max_length=100)]

    def as_dict(self) -> dict[str, Any]:
        """Return the item under the names that pages use."""
        return {
            "answer": self.answer,
            "kind": self.kind,
            "trial": self.trial,
            "attempt": self.showing,
            "content": self.content,
        }


class AnswersBody(SessionBody):
    """Answers of one session."""

    items: Annotated[list[Item], Field(min_length=1, max_length=500)]


class EndBody(SessionBody):
    """How a session is over."""

    how: Literal["finished", "stopped", "deleted"]


def session_app(
    sessions: Sessions,
    page: str,
    *,
    host: str,
    public_url: str = "",
    refusals: Mapping[type[Exception], int],
    commands: Callable[[str, str, Any], Any] | None = None,
) -> FastAPI:
    """Return the application that serves an experiment.

    ======================== ====================================================================
    ``GET /s/KEY``           the page of the link's version; opening it uses nothing up
    ``GET /v/VERSION``       the same page, for a reload
    ``GET /lab/KEY``         the page of the lab
    ``GET …/KEY/data.zip``   the export, for the lab
    ``POST /api/welcome``    the texts, and whether a session can begin or is under way
    ``POST /api/start``      begins a session, or goes on
    ``POST /api/stimuli``    all stimuli of a session
    ``POST /api/answers``    keeps answers: those named as confirmed are on disk
    ``POST /api/end``        ends a session: finished, stopped, or deleted
    ======================== ====================================================================

    The key of the link is in the header ``Authorization: Bearer KEY``.
    """
    app = new_app(
        lambda _: nullcontext(),
        host=host,
        public_url=public_url,
        pages=["/s/", "/lab/"],
    )
    app.add_middleware(BodyLimit, max_bytes=MAX_BODY)
    app.state.rate = RequestRate(at_once=AT_ONCE, per_s=PER_S)
    app.add_exception_handler(OSError, _say_not_written)
    for error, status in {**refusals, TooMany: 429}.items():
        app.add_exception_handler(error, _refuse_with(status))

    @lru_cache(maxsize=8)
    def page_of(version: str | None) -> tuple[bytes, bytes]:
        """The page of a version, which it names, as it is and compressed."""
        found = None if version is None else sessions.page(version)
        text = page if found is None else found
        if version is not None and found is not None:
            text = text.replace("<head>", f'<head><meta name="version" content="{version}">', 1)
        return text.encode(), gzip.compress(text.encode(), mtime=0)

    @app.api_route("/s/{key}", methods=["GET", "HEAD"])
    def show_page(key: str, request: Request) -> Response:
        version = sessions.page_version(key[:100])
        return _compressed(request, *page_of(version), "text/html", ISOLATED)

    @app.api_route("/v/{version}", methods=["GET", "HEAD"])
    def show_version(version: str, request: Request) -> Response:
        known = version if re.fullmatch("[0-9a-f]{16}", version) else None
        return _compressed(request, *page_of(known), "text/html", ISOLATED)

    @app.api_route("/", methods=["GET", "HEAD"])
    def show_newest(request: Request) -> Response:
        return _compressed(request, *page_of(None), "text/html", ISOLATED)

    @app.get("/lab/{key}")
    def show_lab_page(key: str) -> HTMLResponse:
        app.state.rate.count(key[:100])
        return HTMLResponse(sessions.lab_page(key[:100]))

    @app.get("/lab/{key}/data.zip")
    def export(key: str) -> FileResponse:
        app.state.rate.count(key[:100])
        place = tempfile.mkdtemp()
        path = Path(place) / "data.zip"
        remove = BackgroundTask(shutil.rmtree, place, ignore_errors=True)
        try:
            sessions.lab_export(key[:100], path)
        except BaseException:
            shutil.rmtree(place, ignore_errors=True)
            raise
        return FileResponse(path, filename="data.zip", background=remove)

    @app.post("/api/welcome")
    def welcome(key: KeyOf, body: WelcomeBody) -> Any:
        return JSONResponse(sessions.welcome(key, body.site))

    @app.post("/api/start")
    def start(key: KeyOf, body: StartBody) -> Any:
        return JSONResponse(sessions.start(key, **body.model_dump()))

    @app.post("/api/stimuli")
    def stimuli(request: Request, key: KeyOf, body: SessionBody) -> Any:
        found = sessions.stimuli(key, body.session)
        return _compressed(request, found.plain, found.gzipped, "application/json")

    @app.post(ANSWERS, openapi_extra=_json_body(AnswersBody))
    async def answers(request: Request) -> JSONResponse:
        key = _key_of(request)
        body = _read_answers(await request.body())
        items = [item.as_dict() for item in body.items]
        outcome = await sessions.answers(key, body.session, items)
        conflict = any(each["outcome"] == "other content" for each in outcome["refused"])
        return JSONResponse(outcome, 409 if conflict else 200)

    @app.post("/api/end")
    def end(key: KeyOf, body: EndBody) -> Any:
        return JSONResponse(sessions.end(key, body.session, body.how))

    guarded = HostCheck(BodyLimit(request_response(answers), MAX_BODY), host, public_url)
    app.add_middleware(AnswersFirst, answers=ExceptionMiddleware(guarded, app.exception_handlers))

    if commands is not None:

        @app.post("/api/command/{name}")
        def command(name: str, key: KeyOf, body: dict[str, Any]) -> Any:
            return commands(key, name, body)

    return app


class AnswersFirst:
    """Takes answers before all else: nearly all that a server is asked, read by pydantic alone."""

    def __init__(self, app: ASGIApp, answers: ASGIApp) -> None:
        self.app, self.answers = app, answers

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer one request."""
        are_answers = scope.get("path") == ANSWERS and scope.get("method") == "POST"
        await (self.answers if are_answers else self.app)(scope, receive, send)


def _key_of(request: Request) -> str:
    kind, _, key = request.headers.get("authorization", "").partition(" ")
    if kind.lower() != "bearer" or not key or len(key) > 100:
        raise HTTPException(403, NOT_ALLOWED)
    request.app.state.rate.count(key)
    return key


KeyOf = Annotated[str, Depends(_key_of)]


def _read_answers(body: bytes) -> AnswersBody:
    try:
        return AnswersBody.model_validate_json(body)
    except ValidationError:  # or half a character of a pair, which pages may send
        pass
    try:
        return AnswersBody.model_validate(json.loads(body))
    except ValidationError as error:
        raise RequestValidationError(error.errors()) from None
    except RecursionError:
        raise ValueError("An answer is not nested that deeply.") from None


def _json_body(model: type[BaseModel]) -> dict[str, Any]:
    """Return what the description of the interface says of a body that the route reads itself."""
    schema = model.model_json_schema()
    return {"requestBody": {"required": True, "content": {"application/json": {"schema": schema}}}}


def _compressed(
    request: Request,
    plain: bytes,
    gzipped: bytes,
    media_type: str,
    headers: Mapping[str, str] | None = None,
) -> Response:
    """Return what was compressed beforehand, as the browser takes it."""
    headers = {**(headers or {}), "vary": "Accept-Encoding"}
    if "gzip" not in request.headers.get("accept-encoding", ""):
        return Response(plain, media_type=media_type, headers=headers)
    return Response(gzipped, media_type=media_type, headers={**headers, "content-encoding": "gzip"})


async def _say_not_written(_: Request, error: Exception) -> JSONResponse:
    """Answer where nothing could be written: nothing is confirmed, and pages send again."""
    return JSONResponse({"detail": NO_ROOM}, 503, {"retry-after": "5"})


def _refuse_with(status: int) -> Callable[[Request, Exception], Any]:
    async def answer(_: Request, error: Exception) -> JSONResponse:
        detail = NOT_ALLOWED if status == 403 else str(error)
        content = {"detail": detail, **getattr(error, "details", {})}
        return JSONResponse(content, status, getattr(error, "headers", None))

    return answer


class BodyLimit:
    """Refuses requests with more bytes than are taken, announced or not."""

    def __init__(self, app: ASGIApp, max_bytes: int) -> None:
        self.app, self.max_bytes = app, max_bytes

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer one request."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        size = 0
        length = dict(scope["headers"]).get(b"content-length", b"0")
        if length.isdigit() and int(length) > self.max_bytes:
            await self._refusal()(scope, receive, send)
            return

        async def counted() -> Message:
            nonlocal size
            message = await receive()
            size += len(message.get("body", b""))
            if size > self.max_bytes:
                raise TooLarge(self._sentence())
            return message

        await self.app(scope, counted, send)

    def _sentence(self) -> str:
        return f"Requests of up to {self.max_bytes // 1_000_000} MB are taken."

    def _refusal(self) -> JSONResponse:
        return JSONResponse({"detail": self._sentence()}, 413)
