"""The server behind the page: what it gives, and all that it refuses."""

from __future__ import annotations

import errno
import json
import os
import re
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path

import httpx
import numpy as np
import pandas as pd
import pytest
import uvicorn
from fastapi import FastAPI

import eigenwalker as ew
from eigenwalker.explorer import app as explorer_app, tasks
from eigenwalker.explorer.app import make_app
from eigenwalker.simulation import simulate_population
from eigenwalker.study.process_capture import process_capture
from eigenwalker.web import task_runner, upload
from eigenwalker.web.host_check import HEADERS
from eigenwalker.web.run import address_of, listening_socket, new_app
from eigenwalker.web.upload import safe_name


@pytest.fixture(scope="module")
def people() -> ew.Population:
    return simulate_population(4, 4, seed=3)


@pytest.fixture(scope="module")
def app(people: ew.Population) -> FastAPI:
    return make_app(people)


@contextmanager
def served(app: FastAPI) -> Iterator[httpx.Client]:
    """Someone who asks a server that runs beside the tests."""
    with listening_socket("127.0.0.1", None) as bound:
        server = uvicorn.Server(uvicorn.Config(app, log_level="error", ws="none"))
        thread = threading.Thread(target=server.run, kwargs={"sockets": [bound]})
        thread.start()
        try:
            with httpx.Client(base_url=address_of(bound, "127.0.0.1"), timeout=60) as client:
                yield client
        finally:
            server.should_exit = True
            thread.join()


@pytest.fixture(scope="module")
def client(app: FastAPI) -> Iterator[httpx.Client]:
    with served(app) as client:
        yield client


@pytest.fixture(scope="module")
def capture_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("captures")
    walk = ew.simulate_walk(seed=5, sex="male", duration_s=6)
    return ew.write_mocap(walk, folder / "walk.c3d")


@pytest.fixture(autouse=True)
def nothing_is_left(app: FastAPI, client: httpx.Client) -> Iterator[None]:
    yield
    left = {path.name for path in app.state.task_runner.folder.iterdir() if path.suffix != ".nc"}
    assert left == {".in-use"}


def test_the_page_is_served_and_says_that_it_is(client):
    answer = client.get("/")
    assert answer.status_code == 200
    assert '<meta name="eigenwalker-server" content="1"' in answer.text
    assert "connect-src 'self'" in answer.text
    assert {name: answer.headers[name] for name in HEADERS} == HEADERS


def untimed_table() -> bytes:
    """A walk as a table in metres without times."""
    walk = ew.simulate_walk(seed=5, sex="male", duration_s=6, rate_hz=60)
    columns = [f"{name}_{axis}" for name in walk.marker.values for axis in "xyz"]
    table = pd.DataFrame(walk.values.reshape(len(walk), -1) / 1000, columns=columns)
    return table.interpolate(limit_direction="both").to_csv(index=False).encode()


@pytest.mark.parametrize("route", ["capture?name=a.csv&", "population?files={manifest}&"])
def test_refusals_name_fields_of_the_page_and_what_they_say_is_used(client, route):
    table = untimed_table()
    route = f"/api/{route}".replace("{manifest}", json.dumps([["a.csv", len(table)]]))
    told = client.post(route, content=table).json()["detail"]
    assert '"Frames a second"' in told
    assert "rate_hz" not in told
    assert "(..." not in told
    answer = client.post(f"{route}rate=60&unit=m", content=table)
    assert answer.status_code == 200, answer.json()
    assert not any("rate_hz" in message for message in answer.json()["messages"])


@pytest.mark.parametrize(
    "path",
    ["/../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "/served.nc", "/docs", "/openapi.json"],
)
def test_nothing_else_is_there(client, path):
    answer = client.get(path)
    assert answer.status_code == 404
    assert answer.json() == {"detail": "There is nothing of that name here."}


def test_a_capture_becomes_a_walker_of_the_population(client, people, capture_file):
    answer = client.post("/api/capture?name=../walk.c3d", content=capture_file.read_bytes())
    told = answer.json()
    vector = people.vector(process_capture(capture_file).walker)
    assert (told["name"], told["verdict"], told["flag"]) == ("walk.c3d", "use", "")
    np.testing.assert_allclose(told["vector"], vector, atol=1e-9)
    assert re.match(r"\d+ strides in 6 s at 0\.\d\d Hz", told["messages"][0])
    assert told["measures"]["frequency_hz"] == pytest.approx(people.walker(vector).frequency_hz)


def sent_together(files: list[Path]) -> tuple[str, bytes]:
    """The list of files as the page sends it, and the files one after the other."""
    contents = [path.read_bytes() for path in files]
    sizes = [[path.name, len(content)] for path, content in zip(files, contents, strict=True)]
    return json.dumps(sizes), b"".join(contents)


def test_real_captures_become_walkers(client, captures):
    both = [captures / "cmu" / name for name in ("35_01.amc", "35.asf")]
    files, content = sent_together(both)
    for query, body in (
        ({"name": "02_01.c3d"}, (captures / "cmu" / "02_01.c3d").read_bytes()),
        ({"files": files}, content),
    ):
        answer = client.post("/api/capture", params=query, content=body)
        assert answer.status_code == 200, answer.text
        assert len(answer.json()["vector"]) == 229


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("walk.bvh", b"HIERARCHY\nROOT hips\n{", "walk.bvh: expected"),
        ("", b"", "file: expected"),
    ],
)
def test_what_is_no_capture_is_refused_in_the_words_of_its_reader(client, name, content, said):
    answer = client.post("/api/capture", params={"name": name}, content=content)
    assert answer.status_code == 422
    assert said in answer.json()["detail"]


def test_a_population_is_loaded_and_captures_are_compared_with_it(client, capture_file, tmp_path):
    others = simulate_population(3, 3, seed=8)
    others.save(tmp_path / "others.nc")
    sent = (tmp_path / "others.nc").read_bytes()
    answer = client.post("/api/population?name=others.nc", content=sent).json()
    assert (answer["model"]["n_walkers"], answer["model"]["title"]) == (6, "others")
    query = {"name": "walk.c3d", "population": answer["model"]["population"]}
    told = client.post("/api/capture", params=query, content=capture_file.read_bytes()).json()
    vector = others.vector(process_capture(capture_file).walker)
    np.testing.assert_allclose(told["vector"], vector, atol=1e-9)


def test_captures_sent_together_become_a_population(client, tmp_path):
    files = []
    for seed, sex in enumerate(["female", "male", "female", "male"]):
        walk = ew.simulate_walk(sex=sex, seed=seed, duration_s=5)
        files.append(ew.write_mocap(walk, tmp_path / f"{seed}.c3d"))
    (tmp_path / "bad.c3d").write_bytes(b"\x02\x50 cut short")
    table = "file,sex\n0.c3d,female\n1.c3d,male\n2.c3d,female\n3.c3d,male\nbad.c3d,male\n"
    (tmp_path / "traits.csv").write_text(table)
    files += [tmp_path / "bad.c3d", tmp_path / "traits.csv"]
    names, content = sent_together(files)
    answer = client.post("/api/population", params={"files": names}, content=content).json()
    assert answer["model"]["n_walkers"] == 4
    assert [trait["name"] for trait in answer["model"]["traits"]] == ["sex"]
    assert (answer["model"]["title"], answer["model"]["source"]) == (
        "Captures 0.c3d, 1.c3d and 2 more",
        "people.nc",
    )
    assert answer["messages"][0].startswith("bad.c3d: refused.")
    assert answer["messages"][-1].endswith("eigenwalker fit FOLDER -o people.nc")


@pytest.mark.parametrize(("route", "name"), [("capture", "task.json"), ("population", "people.nc")])
def test_files_may_be_called_as_the_servers_own(client, route, name):
    answer = client.post(f"/api/{route}", params={"name": name}, content=b'{"a": 1}')
    assert answer.status_code == 422
    assert answer.json()["detail"].startswith(f"{name}: expected")


@pytest.mark.parametrize("population", ["../served", "gone", "", "served.nc", "a" * 500])
def test_a_population_that_is_not_here_is_said_to_be_gone(client, population):
    answer = client.post("/api/capture", params={"name": "a.c3d", "population": population})
    assert (answer.status_code, answer.json()["detail"]) == (
        422,
        "That population is no longer here; load it again.",
    )


@pytest.mark.parametrize(
    ("files", "said"),
    [
        ("[[", "not one of names and sizes"),
        ('{"a": 1}', "not one of names and sizes"),
        ('[["a.c3d", -1]]', "without a name and a size"),
        ("[[3, 5]]", "without a name and a size"),
        ("[" * 20_000, "not one of names and sizes"),
        ('[["a.c3d", 3], ["../A.c3d", 2]]', "the same name"),
        ('[["a.c3d", 3000000000]]', "5 bytes came where the files have 3000000000"),
        ("[]", "1 to 500 files"),
    ],
)
def test_lists_of_files_that_make_no_sense_are_refused(client, files, said):
    answer = client.post("/api/capture", params={"files": files}, content=b"12345")
    assert answer.status_code == 422
    assert said in answer.json()["detail"]


@pytest.mark.parametrize(
    ("sent", "safe"),
    [
        ("../../x.c3d", "x.c3d"),
        ("C:\\x\\y.bvh", "y.bvh"),
        ("a\x00b\n.trc", "a_b_.trc"),
        ("..", "file"),
        ("NUL.csv", "_NUL.csv"),
        ("<b>.nc", "_b_.nc"),
        (f"{'long' * 99}.c3d", f"{'long' * 19}.c3d"),
        ("\U0001d538" * 80 + ".c3d", "\U0001d538" * 49 + ".c3d"),
        ("Mu\u0308ller.\ud800", "M\u00fcller._"),
    ],
)
def test_names_lead_nowhere(sent, safe):
    assert safe_name(sent) == safe


def test_a_film_and_the_movement_are_made_of_a_stimulus(client, people):
    shown = ew.make_stimulus(people.walkers[0], duration_s=0.5, size_px=(64, 64))
    for format, kind, begins in (
        ("gif", "image/gif", b"GIF89a"),
        ("bvh", "text/plain; charset=utf-8", b"HIERARCHY"),
        ("glb", "model/gltf-binary", b"glTF"),
    ):
        answer = client.post(f"/api/film?format={format}", content=shown.to_json())
        assert answer.headers["content-type"] == kind
        assert answer.content.startswith(begins)


def test_films_that_cannot_be_made_are_refused(client, people):
    shown = ew.make_stimulus(people.walkers[0], duration_s=3000)
    for query, content, said in (
        ("format=mp4", shown.to_json(), "of 3000 s with 512 x 512 pixels at 60 Hz is too long"),
        ("format=exe", "{}", "mp4, webm, gif, bvh, glb, not as 'exe'"),
        ("", "{}", "not as it should be: format"),
    ):
        answer = client.post(f"/api/film?{query}", content=content)
        assert answer.status_code == 422
        assert said in answer.json()["detail"]


def test_films_of_more_dots_than_can_be_computed_are_refused_before_they_are(client, people):
    masks = {"kind": "linear", "number": 5000, "box_mm": [2000, 2000], "speed_mm_s": 500}
    shown = ew.make_stimulus(people.walkers[0], duration_s=1).then("mask", **masks, seed=0)
    (mask,) = shown.transforms
    shown = replace(shown, transforms=[{**mask, "seed": seed} for seed in range(64)])
    answer = client.post("/api/film?format=mp4", content=shown.to_json())
    assert answer.status_code == 422
    assert answer.json()["detail"].startswith(
        "A film of 1 s with 320975 dots to compute at 60 Hz is too long here; up to 0.21 s are made"
    )


def test_more_than_it_takes_is_cut_off(client, monkeypatch):
    monkeypatch.setattr(upload, "MAX_BYTES", 2_000_000)
    answer = client.post("/api/capture?name=a.c3d", content=iter([b"x" * 500_000] * 9))
    assert (answer.status_code, answer.json()["detail"]) == (
        413,
        "Files of up to 2 MB are taken.",
    )


@pytest.mark.parametrize(
    ("error", "status"),
    [(OSError(errno.ENOSPC, "full"), 507), (FileNotFoundError(errno.ENOENT, "lost"), 500)],
)
def test_only_a_folder_that_takes_no_more_has_no_room(error, status):
    app = new_app(None, host="127.0.0.1")

    @app.get("/")
    def fail():
        raise error

    with served(app) as client:
        assert client.get("/").status_code == status


def test_a_task_that_takes_too_long_is_ended(client, monkeypatch):
    monkeypatch.setitem(explorer_app.SECONDS, "capture", 0)
    answer = client.post("/api/capture?name=a.c3d", content=b"x")
    assert answer.status_code == 422
    assert "takes more than 0 s" in answer.json()["detail"]


def test_a_task_that_breaks_down_is_refused(client, monkeypatch):
    def capture(folder: str) -> bytes:
        raise AssertionError("The child finds no function of this name, which is a local one.")

    monkeypatch.setattr(tasks, "capture", capture)
    answer = client.post("/api/capture?name=a.c3d", content=b"x")
    assert answer.status_code == 422
    assert "breaks down over it (status 1)" in answer.json()["detail"]


@pytest.mark.parametrize(
    "headers",
    [
        {"host": "evil.example"},
        {"host": "evil.example:8640"},
        {"host": "127.0.0.1.evil.example"},
        {"host": ""},
        {"origin": "http://evil.example"},
        {"origin": "null"},
        {"origin": "http://127.0.0.1:9999"},
        {"sec-fetch-site": "cross-site"},
        {"sec-fetch-site": "same-site"},
    ],
)
def test_pages_of_others_are_refused(client, headers):
    for answer in (
        client.get("/", headers=headers),
        client.post("/api/film?format=mp4", headers=headers, content="{}"),
    ):
        assert answer.status_code == 403
        assert answer.headers["x-content-type-options"] == "nosniff"


def test_its_own_page_is_answered(client):
    own = str(client.base_url).rstrip("/")
    for headers in ({"origin": own}, {"host": "localhost:8640"}, {"host": "[::1]:8640"}):
        assert client.get("/", headers=headers).status_code == 200


def test_a_server_for_others_is_called_by_numbers_or_its_name(people):
    with served(make_app(people, host="0.0.0.0")) as client:
        assert client.get("/", headers={"host": "192.168.1.7:80"}).status_code == 200
        assert client.get("/", headers={"host": "evil.example"}).status_code == 403


def test_a_free_port_is_taken_where_the_usual_one_is_not():
    with listening_socket("127.0.0.1", None) as one, listening_socket("127.0.0.1", None) as two:
        ports = [each.getsockname()[1] for each in (one, two)]
        assert ports[0] != ports[1]
        assert address_of(two, "127.0.0.1") == f"http://127.0.0.1:{ports[1]}/"
        with pytest.raises(OSError, match=f"Nothing can be served at 127.0.0.1, port {ports[0]}"):
            listening_socket("127.0.0.1", ports[0])


def film_asked_of(address: str, shown: str, answers: list[int]) -> None:
    with suppress(httpx.HTTPError):
        answer = httpx.post(f"{address}api/film?format=mp4", content=shown, timeout=60)
        answers.append(answer.status_code)


@contextmanager
def typed_serve(people: ew.Population, folder: Path) -> Iterator[tuple[subprocess.Popen, str]]:
    """A server started on the command line, its temporary files in a folder; and its address."""
    people.save(folder / "people.nc")
    command = [sys.executable, "-c", "from eigenwalker.cli.main import main; main()", "serve"]
    server = subprocess.Popen(
        [*command, str(folder / "people.nc"), "--no-open"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ | {"TMPDIR": str(folder)},
    )
    try:
        assert server.stdout is not None
        address = re.search(r"http://127\.0\.0\.1:\d+/", server.stdout.readline())
        assert address is not None
        assert "eigenwalker-server" in httpx.get(address[0], timeout=20).text
        yield server, address[0]
    finally:
        server.kill()
        server.communicate()


def works(folder: Path) -> bool:
    return bool(list(folder.glob("eigenwalker-*/*/task.json")))


def wait_until(happened: Callable[[], bool]) -> None:
    ends = time.monotonic() + 30
    while not happened() and time.monotonic() < ends:
        time.sleep(0.02)
    assert happened()


@pytest.mark.skipif(sys.platform == "win32", reason="Windows sends interrupts to whole consoles")
def test_an_interrupt_ends_it_and_its_work_without_a_word(people, tmp_path):
    shown = ew.make_stimulus(people.walkers[0], duration_s=100).to_json()
    with typed_serve(people, tmp_path) as (server, address):
        asked = threading.Thread(target=film_asked_of, args=(address, shown, answers := []))
        asked.start()
        wait_until(lambda: works(tmp_path))
        server.send_signal(signal.SIGINT)
        rest, errors = server.communicate(timeout=20)
    asked.join()
    assert (answers, server.returncode, rest) == ([503], 0, "")
    assert errors == ""
    assert list(tmp_path.glob("eigenwalker-*")) == []


@pytest.mark.skipif(sys.platform != "linux", reason="children are looked up in /proc")
def test_work_that_nobody_waits_for_any_more_ends(people, tmp_path, capture_file):
    """Clients that leave, a film beside which a capture is read, and a server that is killed."""
    shown = ew.make_stimulus(people.walkers[0], duration_s=100).to_json()
    with typed_serve(people, tmp_path) as (server, address):
        port = int(address.rstrip("/").rpartition(":")[2])
        with socket.create_connection(("127.0.0.1", port)) as leaving:
            leaving.sendall(
                f"POST /api/capture?name=a HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n".encode()
            )
            leaving.sendall(b"Content-Length: 999999\r\n\r\nabc")
        with pytest.raises(httpx.ReadTimeout):
            httpx.post(f"{address}api/film?format=mp4", content=shown, timeout=2)
        wait_until(lambda: not works(tmp_path))
        asked = threading.Thread(target=film_asked_of, args=(address, shown, []))
        asked.start()
        wait_until(lambda: works(tmp_path))
        sent = capture_file.read_bytes()
        assert httpx.post(f"{address}api/capture?name=a.c3d", content=sent, timeout=60).is_success
        assert works(tmp_path)
        children = Path(f"/proc/{server.pid}/task/{server.pid}/children").read_text().split()
        server.kill()
        rest, errors = server.communicate(timeout=20)
    asked.join()
    assert (rest, errors) == ("", "")
    assert len(children) == 1
    wait_until(lambda: not Path(f"/proc/{children[0]}").exists())
    (left,) = tmp_path.glob("eigenwalker-*")
    with left.joinpath(".in-use").open("a") as another:
        task_runner._lock(another)
        task_runner.remove_abandoned(tmp_path)
        assert left.exists()
    task_runner.remove_abandoned(tmp_path)
    assert not left.exists()
