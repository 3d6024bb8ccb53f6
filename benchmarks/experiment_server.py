"""Load the server of an experiment, kill it, watch its disk, and count what became of answers.

Each starts ``eigenwalker experiment run`` in a process of its own and talks to it over one
connection an observer, in one event loop:

- ``load --observers 500 --seconds 60``: observers at their own pace, some 150 answers a second of
  8 kB, each after a report of its beginning; milliseconds from when an answer was due;
- ``return --observers 500``: all come back in the same second, each with 20 unsent answers;
- ``arrive --observers 500``: all begin in the same second, and one in five leaves;
- ``kill --kills 200 --observers 200``: the server is killed while observers send; nothing that
  it confirmed may be lost, doubled or altered;
- ``trace``: the system calls of a server, where ``strace`` is installed: no confirmation is sent
  before the answer's flush;
- ``export --answers 1_000_000``: the export of a synthetic database while a server runs.

The processor time of the server for an answer is printed too: on a busy machine it tells more than
the time that observers wait.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import random
import re
import resource
import secrets
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Coroutine
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

import eigenwalker as ew
from eigenwalker.experiment import store
from eigenwalker.experiment.experiment_folder import ANSWERS, new_experiment
from eigenwalker.experiment.writer_lock import running_server
from eigenwalker.web.hand_over import hand_over

FRAMES = [n * 16.667 + random.random() for n in range(1, 420)]
"""Of 7 s at 60 Hz, as a browser gives them: some 8 kB."""
FRAMES_TEXT = json.dumps(FRAMES)[1:]
N_TRIALS = 8


@dataclass
class Server:
    """``experiment run`` in a process of its own."""

    folder: Path
    port: int = 0
    prefix: list[str] = field(default_factory=list)
    starts: list[float] = field(default_factory=list)

    def start(self) -> None:
        """Start, or start again at the same port."""
        began = time.perf_counter()
        command = [sys.executable, "-m", "eigenwalker", "experiment", "run", str(self.folder)]
        self.process = subprocess.Popen(
            [*self.prefix, *command, "--port", str(self.port)], stdout=subprocess.PIPE, text=True
        )
        assert self.process.stdout is not None
        address = self.process.stdout.readline().split()[1].rstrip("/")
        self.port = int(address.rpartition(":")[2])
        self.starts.append(time.perf_counter() - began)

    def kill(self) -> None:
        """Kill, as a crash would."""
        self.process.kill()
        self.process.wait()
        assert self.process.stdout is not None
        self.process.stdout.close()

    def end(self) -> float:
        """Interrupt as Ctrl-C does, and return the seconds until the end."""
        began = time.perf_counter()
        self.process.terminate()
        self.process.wait()
        return time.perf_counter() - began

    def command(self, name: str, **arguments: Any) -> Any:
        """Have the server do what a command asks."""
        where = running_server(self.folder)
        assert where is not None
        return hand_over(*where, name, arguments)

    @property
    def cpu_s(self) -> float:
        """Seconds of processor time."""
        fields = Path(f"/proc/{self.process.pid}/stat").read_text().rpartition(")")[2].split()
        return sum(map(int, fields[11:13])) / os.sysconf("SC_CLK_TCK")

    @property
    def memory_mb(self) -> float:
        """The most memory it had."""
        status = Path(f"/proc/{self.process.pid}/status").read_text()
        return int(re.findall(r"VmHWM:\s+(\d+)", status)[0]) / 1000


@dataclass
class Observer:
    """One page, with one connection that is kept."""

    key: str
    server: Server
    session: int = 0
    group: str = ""
    confirmed: dict[str, float] = field(default_factory=dict)
    statuses: Counter[int] = field(default_factory=Counter)
    _streams: Any = None

    async def ask(self, path: str, body: bytes) -> tuple[int, dict[str, str], bytes]:
        """Return status, headers and body of an answer; status 0 where there is none."""
        head = (
            f"POST /api/{path} HTTP/1.1\r\nhost: 127.0.0.1:{self.server.port}\r\n"
            f"authorization: Bearer {self.key}\r\ncontent-type: application/json\r\n"
            f"content-length: {len(body)}\r\n\r\n"
        )
        try:
            if self._streams is None:
                self._streams = await asyncio.open_connection("127.0.0.1", self.server.port)
            reader, writer = self._streams
            writer.write(head.encode() + body)
            first, *lines = (await reader.readuntil(b"\r\n\r\n")).decode().split("\r\n")[:-2]
            headers = {name.lower(): text for name, _, text in (e.partition(": ") for e in lines)}
            content = await reader.readexactly(int(headers["content-length"]))
        except (OSError, asyncio.IncompleteReadError):
            self.close()
            first, headers, content = "HTTP/1.1 0", {}, b""
        status = int(first.split()[1])
        self.statuses[status] += 1
        return status, headers, content

    def close(self) -> None:
        """Close the connection."""
        if self._streams is not None:
            self._streams[1].close()
        self._streams = None

    async def begin(self) -> int:
        """Consent, and begin the session."""
        _, _, content = await self.ask("welcome", b"{}")
        consent = json.loads(content)["consent"]["en"]
        body = {"consent": consent, "language": "en", "own_key": secrets.token_urlsafe(16)}
        status, _, content = await self.ask("start", json.dumps(body).encode())
        if status == 200:
            found = json.loads(content)
            self.session, self.group = found["session"], found["group"]["name"]
        return status

    def items(self, number: int, kind: str = "answer") -> dict[str, tuple[float, str]]:
        """Return new items: names, the number by which each is known, and texts."""
        made: dict[str, tuple[float, str]] = {}
        for _ in range(number):
            name, mark = secrets.token_urlsafe(16), random.random()
            content = f'"response":"male","outcome":"answered","rt":{mark!r},"frame_times":['
            content += f"{mark!r},{FRAMES_TEXT}" if kind == "answer" else "]"
            made[name] = (
                mark,
                f'{{"answer":"{name}","kind":"{kind}","trial":{random.randint(1, N_TRIALS)},'
                f'"attempt":1,"content":{{{content}}}}}',
            )
        return made

    async def send(self, items: dict[str, tuple[float, str]]) -> None:
        """Send items until they are confirmed."""
        texts = ",".join(text for _, text in items.values())
        body = f'{{"session":{self.session},"items":[{texts}]}}'.encode()
        while True:
            status, headers, content = await self.ask("answers", body)
            if status == 200:
                for name in json.loads(content)["confirmed"]:
                    self.confirmed[name] = items[name][0]
                return
            await asyncio.sleep(float(headers.get("retry-after", 0.3 * random.random())))


async def pace(server: Server, observers: list[Observer], seconds: float) -> None:
    took: dict[str, list[float]] = {"begun": [], "answer": []}
    end = time.perf_counter() + seconds

    async def work(observer: Observer) -> None:
        due = time.perf_counter() + 3.3 * random.random()
        while due < end:
            for kind, when in (("begun", due - 1), ("answer", due)):
                items = observer.items(1, kind)
                await asyncio.sleep(max(when - time.perf_counter(), 0))
                when = max(when, end - seconds)
                await observer.send(items)
                took[kind].append(1000 * (time.perf_counter() - when))
            due += 2.2 + 2.2 * random.random()

    before = server.cpu_s
    await together(observers, work)
    cpu = server.cpu_s - before
    for kind, times in took.items():
        quantiles = np.percentile(times, [50, 99, 100]).round(1).tolist()
        print(f"{kind}: {len(times)}; ms from when due at 50, 99, 100 %: {quantiles}")
    print(f"{len(took['answer']) / seconds:.0f} answers/s; the server's processor time for one, ")
    print(f"with its beginning: {1000 * cpu / len(took['answer']):.2f} ms")


async def come_back(server: Server, observers: list[Observer]) -> None:
    waiting = {id(each): each.items(20) for each in observers}
    for each in observers:
        each.close()
    began, before = time.perf_counter(), server.cpu_s

    async def work(observer: Observer) -> None:
        await asyncio.sleep(random.random())
        await observer.begin()
        await observer.send(waiting[id(observer)])

    await together(observers, work)
    print(f"all confirmed after {time.perf_counter() - began:.1f} s, ", end="")
    print(f"processor time {server.cpu_s - before:.1f} s")


async def arrive(server: Server, observers: list[Observer]) -> None:
    for each in observers:
        each.close()
    began = time.perf_counter()

    async def work(observer: Observer) -> None:
        await asyncio.sleep(random.random())
        await observer.begin()
        if random.random() < 0.2:
            await observer.ask("end", b'{"session":%d,"how":"deleted"}' % observer.session)

    await together(observers, work)
    print(f"all had begun after {time.perf_counter() - began:.1f} s;", end=" ")
    print("groups:", {n: g["finished_or_under_way"] for n, g in status(server)["groups"].items()})


def status(server: Server) -> dict[str, Any]:
    from eigenwalker.experiment.status import experiment_status

    return experiment_status(server.folder)


async def kill(server: Server, observers: list[Observer], kills: int, alive_s: float) -> None:
    ended = asyncio.Event()

    async def work(observer: Observer) -> None:
        while not ended.is_set():
            items = observer.items(1)
            await observer.send(items)
            if random.random() < 0.02:  # the confirmation was lost on its way
                await observer.send(items)
            await asyncio.sleep(0.1 * random.random())

    async def kill_all() -> None:
        for number in range(kills):
            await asyncio.sleep(alive_s * (0.5 + random.random()))
            server.kill()
            await asyncio.to_thread(server.start)
            if number % 20 == 19:
                n_confirmed = sum(len(each.confirmed) for each in observers)
                print(f"{number + 1} kills, {n_confirmed} confirmed", flush=True)
        ended.set()

    await asyncio.gather(kill_all(), together(observers, work))
    print(f"ready after {np.median(server.starts):.2f} s (median)")


async def together(
    observers: list[Observer], work: Callable[[Observer], Coroutine[Any, Any, Any]]
) -> None:
    await asyncio.gather(*(work(each) for each in observers))


def compare(folder: Path, observers: list[Observer]) -> dict[str, Any]:
    """Return what the database has of what was confirmed."""
    confirmed = {name: mark for each in observers for name, mark in each.confirmed.items()}
    kept: Counter[str] = Counter()
    altered = 0
    database = sqlite3.connect(folder / ANSWERS)
    for name, content, frames in database.execute(
        "SELECT answer, content, frame_times FROM answer"
    ):
        kept[name] += 1
        mark = confirmed.get(name)
        times = json.loads(frames or "[]")
        whole = times in ([], [mark, *FRAMES]) and json.loads(content)["rt"] == mark
        altered += mark is not None and not whole
    statuses = sum((each.statuses for each in observers), Counter[int]())
    integrity = database.execute("PRAGMA integrity_check").fetchone()[0]
    database.close()
    return {
        "confirmed": len(confirmed),
        "lost": len(confirmed.keys() - kept.keys()),
        "doubled": sum(number > 1 for number in kept.values()),
        "altered": altered,
        "statuses": dict(statuses),
        "integrity": integrity,
    }


def trace(folder: Path) -> None:
    """Print whether a flush lies between each answer's write and its confirmation."""
    if shutil.which("strace") is None:
        print("strace is not installed")
        return
    log = folder.parent / "strace.txt"
    calls = "trace=pwrite64,write,fdatasync,fsync,sendto,sendmsg,writev"
    server = Server(
        folder, prefix=["strace", "-D", "-f", "-s", "5000", "-e", calls, "-o", str(log)]
    )
    server.start()
    observers = [Observer(key, server) for key in server.command("invite", number=20)]

    async def work(observer: Observer) -> None:
        await observer.begin()
        for _ in range(20):
            await observer.send(observer.items(1, "begun"))

    asyncio.run(together(observers, work))
    server.end()
    print(confirmations_before_flush(log.read_text(errors="replace").splitlines()))


def confirmations_before_flush(lines: list[str]) -> dict[str, int]:
    """Return how many confirmations a trace has, and how many came before their flush."""
    names = {
        name
        for line in lines
        if '"confirmed' in line.replace("\\", "")
        for name in re.findall(r"[A-Za-z0-9_-]{22}", line)
    }
    written: dict[str, int] = {}
    unfinished: dict[str, int] = {}
    flushed, early, confirmed = -1, 0, 0
    for number, line in enumerate(lines):
        thread = line.split()[0]
        if "pwrite64(" in line:  # the log of the database
            written |= dict.fromkeys((n for n in names - written.keys() if n in line), number)
        elif "sync(" in line:
            if "unfinished" in line:
                unfinished[thread] = number
            else:
                flushed = number
        elif "sync resumed" in line:
            flushed = unfinished.pop(thread)
        elif '"confirmed' in line.replace("\\", ""):
            for name in re.findall(r"[A-Za-z0-9_-]{22}", line):
                confirmed += 1
                early += not written.get(name, number) < flushed
    return {"confirmations": confirmed, "before their flush": early}


def synthetic(folder: Path, n_answers: int) -> None:
    """Fill the database with sessions of 1000 answers, as pages report them."""
    server = Server(folder)
    server.start()
    n_sessions = max(n_answers // 1000, 1)
    observers = [Observer(key, server) for key in server.command("invite", number=n_sessions)]
    asyncio.run(together(observers, Observer.begin))
    server.end()
    database = store.connect(folder / ANSWERS)
    timing = {"first_frame_ms": 16.7, "frames_dropped": 0, "frame_interval_ms": 16.667}
    with store.transaction(database):
        for each in observers:
            items = [
                {
                    "answer": secrets.token_urlsafe(16),
                    "kind": "answer",
                    "trial": n % N_TRIALS + 1,
                    "attempt": n // N_TRIALS + 1,
                    "content": {
                        "response": "male",
                        "response_by": "key",
                        "outcome": "answered",
                        "rt": random.random() * 3000,
                        "started_utc": "2026-11-30T21:00:00.000Z",
                        "time_utc": "2026-11-30T21:00:07.000Z",
                        **timing,
                    },
                }
                for n in range(1000)
            ]
            store.add_answers(database, each.session, items)
    database.close()


def export(folder: Path, n_answers: int) -> None:
    synthetic(folder, n_answers)
    server = Server(folder)
    server.start()
    began = time.perf_counter()
    command = ["export", str(folder), "-o", str(folder.parent / "data")]
    subprocess.run([sys.executable, "-m", "eigenwalker", "experiment", *command], check=True)
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(f"{n_answers} answers: {time.perf_counter() - began:.1f} s, ", end="")
    print(
        f"processor time {usage.ru_utime + usage.ru_stime:.1f} s, {usage.ru_maxrss / 1000:.0f} MB"
    )
    server.end()


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "what", choices=("load", "return", "arrive", "kill", "trace", "export"), help="see above"
    )
    parser.add_argument("--observers", type=int, default=500)
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--alive-s", type=float, default=1.0, help="mean time between kills")
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--answers", type=int, default=1_000_000)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / "experiment"
        made = new_experiment(folder, "troje2002", ew.load_population(), walkers=4)
        design = (folder / "design.toml").read_text(encoding="utf-8")
        (folder / "design.toml").write_text(design.replace("observers = 8", "observers = 99999"))
        assert not made.faults()
        if options.what in ("trace", "export"):
            trace(folder) if options.what == "trace" else export(folder, options.answers)
            return
        server = Server(folder)
        server.start()
        keys = server.command("invite", number=options.observers)
        observers = [Observer(key, server) for key in keys]

        async def run() -> None:
            if options.what == "arrive":
                await arrive(server, observers)
                return
            await together(observers, Observer.begin)
            if options.what == "load":
                await pace(server, observers, options.seconds)
            elif options.what == "return":
                await come_back(server, observers)
            else:
                await kill(server, observers, options.kills, options.alive_s)

        asyncio.run(run())
        print(f"memory {server.memory_mb:.0f} MB; ended within {server.end():.2f} s")
        print(compare(folder, observers))


if __name__ == "__main__":
    main()
