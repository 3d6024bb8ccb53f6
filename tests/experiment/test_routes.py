"""What the server of an experiment lets through, and what it refuses."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from io import BytesIO
from typing import Any
from zipfile import ZipFile

import httpx
import pytest
import uvicorn
from fastapi import FastAPI

from eigenwalker.cli.experiment_commands import observer_app
from eigenwalker.experiment.link_keys import new_key
from eigenwalker.experiment.service import Service
from eigenwalker.web.request_rate import RequestRate
from eigenwalker.web.run import address_of, listening_socket

PUBLIC = "https://lab.example"


@pytest.fixture
def app(service: Service) -> FastAPI:
    return observer_app(
        service, "<!doctype html>", host="127.0.0.1", public_url=PUBLIC, command_key="c" * 22
    )


@pytest.fixture
def client(app: FastAPI) -> Iterator[httpx.Client]:
    config = uvicorn.Config(app, log_level="error", ws="none")
    server = uvicorn.Server(config)
    with listening_socket("127.0.0.1", 0) as bound:
        thread = threading.Thread(target=server.run, kwargs={"sockets": [bound]})
        thread.start()
        with httpx.Client(base_url=address_of(bound, "127.0.0.1"), timeout=30) as opened:
            yield opened
        server.should_exit = True
        thread.join()


def asked(client: httpx.Client, path: str, key: str, body: Any, **headers: str) -> Any:
    return client.post(
        f"/api/{path}", json=body, headers={"authorization": f"Bearer {key}", **headers}
    )


@pytest.fixture
def begun(client: httpx.Client, service: Service) -> tuple[str, int]:
    [key] = service.invite(1)
    consent = asked(client, "welcome", key, {}).json()["consent"]["en"]
    body = {"consent": consent, "language": "en", "own_key": new_key()}
    return key, asked(client, "start", key, body).json()["session"]


def item(**changes: Any) -> dict[str, Any]:
    content = {"response": "male", "outcome": "answered"}
    whole = {"answer": "a" * 22, "kind": "answer", "trial": 1, "attempt": 1, "content": content}
    return {**whole, **changes}


def test_an_answer_is_confirmed_once_and_another_content_conflicts(
    client: httpx.Client, begun: tuple[str, int]
) -> None:
    key, session = begun
    for _ in range(2):
        answer = asked(client, "answers", key, {"session": session, "items": [item()]})
        assert answer.status_code == 200
        assert answer.json() == {"confirmed": ["a" * 22], "refused": []}
    other = [item(content={"response": "female"}), item(answer="b" * 22)]
    answer = asked(client, "answers", key, {"session": session, "items": other})
    assert answer.status_code == 409
    assert answer.json()["confirmed"] == ["b" * 22]
    assert answer.json()["refused"][0]["outcome"] == "other content"


def test_half_a_character_is_taken_and_no_number_is_refused(
    client: httpx.Client, begun: tuple[str, int]
) -> None:
    key, session = begun
    start = f'{{"session":{session},"items":[{{"answer":"{"s" * 22}","kind":"answer","content":'
    for content, status in (
        ('{"text":"\\ud800"}', 200),
        ('{"text":"\\ud800"}', 200),
        ('{"text":"NaN is text"}', 409),
        ('{"rt":NaN}', 422),
        ('{"rt":1e999}', 422),
        ('{"rt":' + "[" * 2000 + "]" * 2000 + "}", 422),
    ):
        headers = {"authorization": f"Bearer {key}"}
        answer = client.post("/api/answers", content=f"{start}{content}}}]}}", headers=headers)
        assert answer.status_code == status, content


def test_the_lab_gets_the_export_as_an_archive(
    client: httpx.Client, service: Service, begun: tuple[str, int]
) -> None:
    key, session = begun
    asked(client, "answers", key, {"session": session, "items": [item()]})
    [lab] = service.invite(1, kind="lab")
    assert f'href="{lab}/data.zip"' in client.get(f"/lab/{lab}").text
    answer = client.get(f"/lab/{lab}/data.zip", timeout=120)
    with ZipFile(BytesIO(answer.content)) as archive:
        rows = archive.read("data/data/study-troje2002_data.csv").decode().splitlines()
    assert len(rows) == 2
    assert client.get(f"/lab/{key}/data.zip").status_code == 403


def test_stimuli_are_the_same_with_and_without_compression(
    client: httpx.Client, begun: tuple[str, int]
) -> None:
    key, session = begun
    answers = [
        asked(client, "stimuli", key, {"session": session}, **{"accept-encoding": coding})
        for coding in ("gzip", "identity")
    ]
    assert [each.headers.get("content-encoding") for each in answers] == ["gzip", None]
    assert answers[0].json() == answers[1].json()
    assert len(answers[0].json()) == 12


@pytest.mark.parametrize(
    "wrong",
    [
        {"answer": "short"},
        {"trial": "1"},
        {"trial": 0},
        {"kind": "other"},
        {"content": [1]},
        {"unknown": 1},
    ],
)
def test_what_is_not_as_it_should_be_is_refused(
    client: httpx.Client, begun: tuple[str, int], wrong: dict[str, Any]
) -> None:
    key, session = begun
    answer = asked(client, "answers", key, {"session": session, "items": [item(**wrong)]})
    assert answer.status_code == 422


def test_a_key_that_is_missing_or_of_another_gets_the_same_answer(
    client: httpx.Client, service: Service, begun: tuple[str, int]
) -> None:
    [foreign] = service.invite(1)
    body = {"session": begun[1], "items": [item()]}
    answers = [asked(client, "answers", key, body) for key in (foreign, new_key(), "?", "?" * 500)]
    assert {answer.status_code for answer in answers} == {403}
    assert len({answer.text for answer in answers}) == 1


def test_too_much_is_refused(client: httpx.Client, begun: tuple[str, int]) -> None:
    large = item(content={"text": "x" * 5_000_000})
    answer = asked(client, "answers", begun[0], {"session": begun[1], "items": [large]})
    assert answer.status_code == 413


def test_a_link_in_webmail_opens_the_page_and_nothing_else(client: httpx.Client) -> None:
    elsewhere = {
        "sec-fetch-site": "cross-site",
        "sec-fetch-mode": "navigate",
        "sec-fetch-dest": "document",
        "referer": "https://mail.example/",
    }
    assert client.get(f"/s/{new_key()}", headers=elsewhere).status_code == 200
    framed = {**elsewhere, "sec-fetch-dest": "iframe"}
    assert client.get(f"/s/{new_key()}", headers=framed).status_code == 403
    fetched = {**elsewhere, "sec-fetch-mode": "cors", "sec-fetch-dest": "empty"}
    assert client.get(f"/s/{new_key()}", headers=fetched).status_code == 403
    assert asked(client, "welcome", new_key(), {}, **elsewhere).status_code == 403


def test_answers_come_through_a_proxy_with_https_under_the_public_name_only(
    client: httpx.Client, begun: tuple[str, int]
) -> None:
    body = {"session": begun[1], "items": [item()]}
    same_site = {"sec-fetch-site": "same-origin"}
    for host in (
        "lab.example",
        client.base_url.netloc.decode(),
    ):  # Caddy keeps the name; nginx gives its own
        headers = {"host": host, "origin": PUBLIC, **same_site}
        assert asked(client, "answers", begun[0], body, **headers).status_code == 200
    for host, origin in (
        ("evil.example", "https://evil.example"),
        ("lab.example", "https://evil.example"),
        ("lab.example", "null"),
    ):
        headers = {"host": host, "origin": origin, **same_site}
        assert asked(client, "answers", begun[0], body, **headers).status_code == 403


def test_commands_need_the_key_of_the_folder(client: httpx.Client, begun: tuple[str, int]) -> None:
    arguments = {"number": 2, "kind": "personal"}
    assert asked(client, "command/invite", begun[0], arguments).status_code == 403
    assert asked(client, "command/_link", "c" * 22, {"key": "x"}).status_code == 403
    assert len(asked(client, "command/invite", "c" * 22, arguments).json()) == 2


def test_a_file_that_takes_no_more_confirms_nothing(
    client: httpx.Client, service: Service, begun: tuple[str, int]
) -> None:
    service.writer.do(lambda db: db.execute("PRAGMA query_only = ON"), alone=True)
    body = {"session": begun[1], "items": [item()]}
    assert asked(client, "answers", begun[0], body).status_code == 503
    service.writer.do(lambda db: db.execute("PRAGMA query_only = OFF"), alone=True)
    assert asked(client, "answers", begun[0], body).json()["confirmed"] == ["a" * 22]


def test_the_page_is_isolated_and_is_not_framed(client: httpx.Client) -> None:
    headers = client.get(f"/s/{new_key()}").headers
    assert headers["cross-origin-embedder-policy"] == "require-corp"
    assert headers["cross-origin-opener-policy"] == "same-origin"
    assert headers["referrer-policy"] == "no-referrer"
    assert headers["x-frame-options"] == "DENY"


def test_a_key_that_asks_too_often_is_told_when_to_come_back(
    app: FastAPI, client: httpx.Client, service: Service
) -> None:
    app.state.rate = RequestRate(at_once=2, per_s=0.01)
    one, other = service.invite(2)
    answers = [asked(client, "welcome", one, {}) for _ in range(3)]
    assert [answer.status_code for answer in answers] == [200, 200, 429]
    assert 90 <= int(answers[-1].headers["retry-after"]) <= 100
    assert asked(client, "welcome", other, {}).status_code == 200
