"""Kill the server of an experiment again and again, or load it, and count what became of answers.

``python benchmarks/experiment_server.py kill --kills 20 --observers 200`` kills the server while
observers send, and compares what was confirmed with what is in the database: nothing may be lost,
doubled or altered. ``load --observers 500 --seconds 30`` measures the time from when an answer was
due until it was confirmed.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import random
import secrets
import sqlite3
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import httpx
import numpy as np

import eigenwalker as ew
from eigenwalker.experiment.experiment_folder import ANSWERS, new_experiment
from eigenwalker.experiment.writer_lock import running_server
from eigenwalker.web.hand_over import hand_over

FRAMES = [round(n * 16.667, 3) for n in range(420)]
"""Of 7 s at 60 Hz: some 3.5 kB; each answer adds noise to them, to some 7 kB in all."""


@dataclass
class Server:
    """``experiment run`` in a process of its own."""

    folder: Path
    port: int = 0
    restarts: list[float] = field(default_factory=list)

    def start(self) -> None:
        """Start, or start again at the same port."""
        began = time.perf_counter()
        command = [sys.executable, "-m", "eigenwalker", "experiment", "run", str(self.folder)]
        self.process = subprocess.Popen(
            [*command, "--port", str(self.port)], stdout=subprocess.PIPE, text=True
        )
        assert self.process.stdout is not None
        self.address = self.process.stdout.readline().split()[1].rstrip("/")
        self.port = int(self.address.rpartition(":")[2])
        self.restarts.append(time.perf_counter() - began)

    def kill(self) -> None:
        """Kill, as a power cut of the process would."""
        self.process.kill()
        self.process.wait()


@dataclass
class Observer:
    """One page: it sends an answer until it is confirmed, then the next."""

    key: str
    session: int = 0
    confirmed: dict[str, str] = field(default_factory=dict)
    retries: int = 0
    errors: int = 0

    async def ask(self, client: httpx.AsyncClient, path: str, body: Any) -> httpx.Response:
        """Ask the server with the key of the link."""
        headers = {"authorization": f"Bearer {self.key}"}
        return await client.post(f"/api/{path}", json=body, headers=headers)

    async def begin(self, client: httpx.AsyncClient) -> None:
        """Consent, and begin the session."""
        consent = (await self.ask(client, "welcome", {})).json()["consent"]["en"]
        body = {"consent": consent, "language": "en", "own_key": secrets.token_urlsafe(16)}
        self.session = (await self.ask(client, "start", body)).json()["session"]

    async def send(self, client: httpx.AsyncClient) -> None:
        """Send an answer until it is confirmed."""
        frames = [round(t + random.random(), 3) for t in FRAMES]
        item = {
            "answer": secrets.token_urlsafe(16),
            "kind": "answer",
            "trial": random.randint(1, 8),
            "attempt": 1,
            "content": {"response": "male", "rt_ms": random.random(), "frame_times": frames},
        }
        while True:
            try:
                answer = await self.ask(
                    client, "answers", {"session": self.session, "items": [item]}
                )
            except httpx.TransportError:
                self.retries += 1
                await asyncio.sleep(0.2 * random.random())
                continue
            if answer.status_code == 200 and item["answer"] in answer.json()["confirmed"]:
                self.confirmed[item["answer"]] = json.dumps(frames, separators=(",", ":"))
                if random.random() < 0.02:  # the confirmation was lost on its way
                    continue
                return
            self.errors += answer.status_code not in (429, 503)
            await asyncio.sleep(float(answer.headers.get("retry-after", 0.2)))


async def kill(server: Server, observers: list[Observer], kills: int) -> None:
    ended = asyncio.Event()

    async def work(observer: Observer, client: httpx.AsyncClient) -> None:
        while not ended.is_set():
            await observer.send(client)
            await asyncio.sleep(0.2 * random.random())

    limits = httpx.Limits(max_connections=len(observers))
    async with httpx.AsyncClient(base_url=server.address, timeout=20, limits=limits) as client:
        works = [asyncio.create_task(work(each, client)) for each in observers]
        for _ in range(kills):
            await asyncio.sleep(1 + random.random())
            server.kill()
            await asyncio.to_thread(server.start)
        ended.set()
        await asyncio.gather(*works)


async def load(server: Server, observers: list[Observer], seconds: float) -> list[float]:
    took: list[float] = []
    end = time.perf_counter() + seconds

    async def work(observer: Observer, client: httpx.AsyncClient) -> None:
        due = time.perf_counter() + 3.3 * random.random()
        while due < end:
            await asyncio.sleep(max(due - time.perf_counter(), 0))
            await observer.send(client)
            took.append(time.perf_counter() - due)
            due += 2.2 + 2.2 * random.random()

    limits = httpx.Limits(max_connections=len(observers))
    async with httpx.AsyncClient(base_url=server.address, timeout=60, limits=limits) as client:
        await asyncio.gather(*(work(each, client) for each in observers))
    return took


def compare(folder: Path, observers: list[Observer]) -> dict[str, int]:
    database = sqlite3.connect(folder / ANSWERS)
    rows = database.execute("SELECT answer, frame_times FROM answer").fetchall()
    kept = dict(rows)
    confirmed = {name: text for each in observers for name, text in each.confirmed.items()}
    return {
        "confirmed": len(confirmed),
        "lost": sum(name not in kept for name in confirmed),
        "doubled": len(rows) - len(kept),
        "altered": sum(kept.get(name, text) != text for name, text in confirmed.items()),
        "retries": sum(each.retries for each in observers),
        "errors": sum(each.errors for each in observers),
        "integrity": int(database.execute("PRAGMA integrity_check").fetchone()[0] == "ok"),
    }


async def begin_all(server: Server, observers: list[Observer]) -> None:
    async with httpx.AsyncClient(base_url=server.address, timeout=60) as client:
        await asyncio.gather(*(each.begin(client) for each in observers))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("what", choices=("kill", "load"))
    parser.add_argument("--observers", type=int, default=200)
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--seconds", type=float, default=30)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / "experiment"
        made = new_experiment(folder, "troje2002", ew.load_population(), walkers=4)
        design = (folder / "design.toml").read_text(encoding="utf-8")
        (folder / "design.toml").write_text(design.replace("observers = 8", "observers = 9999"))
        assert not made.faults()
        server = Server(folder)
        server.start()
        where = running_server(folder)
        assert where is not None
        keys = hand_over(*where, "invite", {"number": options.observers})
        observers = [Observer(key) for key in keys]
        asyncio.run(begin_all(server, observers))
        if options.what == "kill":
            asyncio.run(kill(server, observers, options.kills))
            print(f"restart: median {np.median(server.restarts):.2f} s")
        else:
            took = np.array(asyncio.run(load(server, observers, options.seconds))) * 1000
            memory = Path(f"/proc/{server.process.pid}/status").read_text()
            print(next(line for line in memory.splitlines() if line.startswith("VmHWM")))
            quantiles = np.percentile(took, [50, 99, 100]).round(1).tolist()
            print(f"{len(took)} answers; ms at 50, 99, 100 %: {quantiles}")
        server.process.terminate()
        server.process.wait()
        print(compare(folder, observers))


if __name__ == "__main__":
    main()
