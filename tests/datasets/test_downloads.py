"""Published captures: licence first, hash checked, nothing half done. All servers are loopback."""

from __future__ import annotations

import hashlib
import io
import sys
import threading
from collections.abc import Iterator
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from urllib.parse import unquote

import pooch
import pytest

from eigenwalker.cli.exit_codes import EXIT_FAILED
from eigenwalker.datasets import downloads
from eigenwalker.datasets.downloads import (
    Collection,
    PublishedFile,
    collections,
    fetch_captures,
    own_copies,
)
from eigenwalker.io import UnitGuessed, read_mocap

WALKS = {"walk 1.c3d": b"one walk" * 1000, "walk_2.c3d": b"another", "LICENSE": b"Be kind."}
COMMIT = "0" * 40


@dataclass
class Server:
    """Files by address, how they are given, and what was asked for."""

    files: dict[str, bytes] = field(default_factory=dict)
    manner: str = "whole"
    asked: list[str] = field(default_factory=list)
    url: str = ""

    def answer(self, request: BaseHTTPRequestHandler) -> None:
        path = unquote(request.path.lstrip("/"))
        self.asked.append(path.rpartition("/")[2])
        content = self.files.get(path)
        if content is None:
            request.send_error(404)
            return
        request.send_response(200)
        request.send_header("Content-Length", str(len(content)))
        request.end_headers()
        if self.manner == "changed":
            content = content[:-1] + b"?"
        request.wfile.write(content[: len(content) // 2] if self.manner == "cut" else content)


@pytest.fixture
def server(monkeypatch) -> Iterator[Server]:
    monkeypatch.setenv("NO_PROXY", "127.0.0.1")
    served = Server()

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            served.answer(self)

        def log_message(self, format: str, *args: object) -> None:
            del format, args

    with ThreadingHTTPServer(("127.0.0.1", 0), Handler) as running:
        served.url = f"http://127.0.0.1:{running.server_port}"
        thread = threading.Thread(target=running.serve_forever, args=(0.01,))
        thread.start()
        yield served
        running.shutdown()
        thread.join()


@pytest.fixture
def small(server, monkeypatch) -> Collection:
    """A collection of three files, published on the server."""
    published = tuple(
        PublishedFile(
            name, hashlib.sha256(content).hexdigest(), "lab/walks", COMMIT, f"data/{name}"
        )
        for name, content in WALKS.items()
    )
    collection = Collection(
        "small",
        "walks of nobody",
        "tests",
        0.1,
        "CC BY 4.0",
        "Say whose it is.",
        "Nobody (2024).",
        published,
    )
    server.files = {f"lab/walks/{COMMIT}/data/{name}": WALKS[name] for name in WALKS}
    monkeypatch.setattr(downloads, "collections", lambda: {"small": collection})
    monkeypatch.setenv(downloads.SOURCE_VARIABLE, server.url)
    return collection


@pytest.fixture
def run(run_command, monkeypatch):
    """Type a command, with someone at the keyboard or not; get its exit code and output."""

    def typed(*words: object, says: str | None = None) -> tuple[int, str, str]:
        keyboard = io.StringIO(f"{says}\n")
        monkeypatch.setattr(keyboard, "isatty", lambda: says is not None)
        monkeypatch.setattr(sys, "stdin", keyboard)
        return run_command(*words)

    return typed


def _there(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()} if folder.is_dir() else {}


def test_a_collection_is_fetched_once(small, server, tmp_path: Path):
    steps: list[tuple[int, int]] = []
    folder = fetch_captures(
        "small", tmp_path / "walks", accept_licence=True, progress=lambda *step: steps.append(step)
    )
    assert _there(folder) == WALKS
    assert steps == [(0, 3), (1, 3), (2, 3), (3, 3)]
    assert sorted(server.asked) == sorted(WALKS)
    assert fetch_captures("small", folder) == folder, "what is there needs no consent"
    assert len(server.asked) == 3


def test_the_licence_comes_first(small, server, tmp_path: Path):
    with pytest.raises(
        ValueError, match=r"(?s)Good for tests\..*CC BY 4\.0\. Say whose it is\..*Nobody \(2024\)"
    ):
        fetch_captures("small", tmp_path)
    assert not server.asked
    assert not _there(tmp_path)


@pytest.mark.parametrize(
    ("manner", "error", "told"),
    [
        ("changed", ValueError, "another file than was published"),
        ("cut", ConnectionError, "broke off"),
    ],
)
def test_a_changed_or_broken_download_is_refused(
    small, server, tmp_path: Path, manner, error, told
):
    server.manner = manner
    with pytest.raises(error, match=told):
        fetch_captures("small", tmp_path, accept_licence=True)
    assert not _there(tmp_path)
    server.manner = "whole"
    fetch_captures("small", tmp_path, accept_licence=True)
    assert _there(tmp_path) == WALKS


def test_what_was_interrupted_goes_on_where_it_stopped(small, server, tmp_path: Path):
    lost = server.files.pop(f"lab/walks/{COMMIT}/data/walk_2.c3d")
    with pytest.raises(ConnectionError, match=r"said 404 .* 1 of 3 files are there already"):
        fetch_captures("small", tmp_path, accept_licence=True)
    server.files[f"lab/walks/{COMMIT}/data/walk_2.c3d"] = lost
    fetch_captures("small", tmp_path, accept_licence=True)
    assert _there(tmp_path) == WALKS
    assert server.asked.count("walk 1.c3d") == 1


def test_a_file_of_ones_own_is_left_as_it_is(small, server, tmp_path: Path):
    (tmp_path / "LICENSE").write_text("mine")
    with pytest.raises(FileExistsError, match="left as it is"):
        fetch_captures("small", tmp_path, accept_licence=True)
    assert (tmp_path / "LICENSE").read_text() == "mine"
    assert not server.asked


def test_no_network_is_said_in_a_sentence(small, server, tmp_path: Path):
    with pytest.raises(ConnectionError, match=r"no connection to the server\. Check the network"):
        fetch_captures("small", tmp_path, accept_licence=True, base_url="http://127.0.0.1:9")
    with pytest.raises(ConnectionError, match="no address; check base_url"):
        fetch_captures("small", tmp_path, accept_licence=True, base_url="nowhere")
    assert not server.asked


def test_left_out_the_folder_is_in_the_cache_of_the_user(small, tmp_path: Path, monkeypatch):
    monkeypatch.setattr(pooch, "os_cache", lambda project: tmp_path / project)
    folder = fetch_captures("small", accept_licence=True)
    assert folder == tmp_path / "eigenwalker" / "small"
    assert _there(folder) == WALKS


# ---------------------------------------------------------------- the command line


def test_fetch_asks_before_it_fetches(run, small, server, tmp_path: Path):
    code, said, complaint = run("data", "fetch", "small", "-o", tmp_path, says="n")
    assert code == EXIT_FAILED
    assert "Licence: CC BY 4.0. Say whose it is." in said
    assert "Please cite: Nobody (2024)." in said
    assert "not accepted" in complaint
    assert not server.asked
    code, said, _ = run("data", "fetch", "small", "-o", tmp_path, says="y")
    assert (code, _there(tmp_path)) == (0, WALKS)
    assert said.endswith(f"3 files: {tmp_path}\n")


def test_fetch_of_what_is_there_asks_nothing(run, small, server, tmp_path: Path):
    code, said, _ = run("data", "fetch", "small", "-o", tmp_path, "--accept-licence")
    assert (code, len(server.asked)) == (0, 3)
    assert "Please cite: Nobody (2024)." in said
    code, said, _ = run("data", "fetch", "small", "-o", tmp_path)
    assert (code, said, len(server.asked)) == (0, f"3 files: {tmp_path}\n", 3)


def test_fetch_with_nobody_to_ask_says_what_to_say(run, small, server, tmp_path: Path):
    code, _, complaint = run("data", "fetch", "small", "-o", tmp_path)
    assert (code, server.asked) == (EXIT_FAILED, [])
    assert "--accept-licence" in complaint
    code, _, complaint = run("data", "fetch", "large")
    assert (code, complaint) == (
        EXIT_FAILED,
        "eigenwalker: There is no collection 'large'; there are ['small'].\n",
    )


def test_list_names_what_there_is(run):
    code, said, _ = run("data", "list")
    assert code == 0
    for name, collection in collections().items():
        assert f"{name} " in said
        assert collection.licence in said
    for own in own_copies().values():
        assert f"{own['file']}: {own['about']}" in said
        assert own["use"] in said


# ---------------------------------------------------------------- the collections themselves


def test_every_collection_says_what_one_must_know():
    for collection in collections().values():
        assert collection.terms
        assert collection.citation
        assert collection.files
        assert len({file.name for file in collection.files}) == len(collection.files)
        for file in collection.files:
            assert len(file.sha256) == 64
            assert len(file.commit) == 40
            assert Path(file.name).name == file.name, "files lie in the folder, not beyond it"
            assert file.url(downloads.SOURCE_URL).startswith("https://")


@pytest.mark.parametrize("name", ["bandai-namco", "cmu", "delussanet", "pycgm"])
def test_real_captures_are_fetched_as_they_were_published(
    captures: Path, server, tmp_path: Path, name
):
    collection = collections()[name]
    server.files = {
        f"{file.repository}/{file.commit}/{file.path}": (captures / name / file.name).read_bytes()
        for file in collection.files
    }
    size_mb = sum(map(len, server.files.values())) / 1e6
    assert collection.size_mb == pytest.approx(size_mb, rel=0.1)
    folder = fetch_captures(name, tmp_path, accept_licence=True, base_url=server.url)
    assert {path.name for path in folder.iterdir()} == {file.name for file in collection.files}


@pytest.mark.filterwarnings(f"ignore::{UnitGuessed.__module__}.UnitGuessed")
def test_what_was_fetched_can_be_read(captures: Path, server, tmp_path: Path):
    file = next(file for file in collections()["cmu"].files if file.name == "12_01.bvh")
    server.files = {
        f"{each.repository}/{each.commit}/{each.path}": (captures / "cmu" / each.name).read_bytes()
        for each in collections()["cmu"].files
    }
    folder = fetch_captures("cmu", tmp_path, accept_licence=True, base_url=server.url)
    assert read_mocap(folder / file.name).sizes["time"] == 524
