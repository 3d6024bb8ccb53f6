"""Read spoilt files of every format, and report each that ends otherwise than it may.

    python tests/fuzz/mutate.py --format c3d --count 100000 --seed 0

A file may end in data or in `UnreadableFile`, within 10 s and 1 GiB, without a warning but those
of guessed units and assumed rates. Files are read in child processes, so that this program outlives
all of them; where a format is read in a child process by the package itself, its death is such a
refusal. The same seed gives the same files. What ends otherwise is kept in a folder.

With ``--door info`` the whole of what ``eigenwalker info`` does is run, with ``--door fit`` what
``eigenwalker fit`` does with one file, where any ValueError is an answer too.
"""

from __future__ import annotations

import argparse
import os
import resource
import select
import signal
import sys
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import numpy as np

from corpus.sound_files import KINDS, Files, sound_files, walk_of
from eigenwalker.core.trajectories import check_trajectories, sampling_rate
from eigenwalker.datasets.bml import read_bml_axes
from eigenwalker.io.capture_file import RateAssumed
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.read import read_mocap
from eigenwalker.io.readers.mat_arrays import mat_arrays
from eigenwalker.io.up_axis_and_unit import UnitGuessed
from eigenwalker.population.population import Population
from eigenwalker.stimulus.stimulus import Stimulus
from eigenwalker.study.inspect import inspect_file
from eigenwalker.study.process_capture import process_capture
from fuzz.mutations import mutated, nested_attribute

SECONDS = 10
MOST_BYTES = 2**30
BATCH = 1000
_MOST_MM = 1e14


@dataclass
class Outcome:
    """How the spoilt files of one format ended."""

    counts: Counter[str] = field(default_factory=Counter)
    slowest_s: float = 0.0
    offences: list[str] = field(default_factory=list)


def spoilt(kind: str, sound: list[Files], number: int, seed: int) -> Files:
    """Return spoilt file `number` of a kind: one of the files that belong together is changed."""
    random = Random(f"{kind} {seed} {number}")
    files = dict(random.choice(sound))
    name = random.choice(list(files))
    others = random.choice(sound)
    if kind in ("population", "netcdf") and random.random() < 0.03:
        files[name] = nested_attribute(files[name], random)
    else:
        files[name] = mutated(files[name], others.get(name, files[name]), random)
    return files


def _captured(path: Path) -> None:
    walk = check_trajectories(read_mocap(path))
    values = walk.values
    if not len(values) or np.isinf(values).any() or (np.abs(values) > _MOST_MM).any():
        raise AssertionError("positions that are infinite or absurd, or none")
    if len(set(walk.marker.values.tolist())) != walk.sizes["marker"]:
        raise AssertionError("two markers of one name")
    if len(values) > 1 and not 0 < sampling_rate(walk) < 1e6:
        raise AssertionError("no frame rate")


def _of_population(path: Path) -> None:
    if not np.isfinite(Population.load(path).X).all():
        raise AssertionError("features that are not finite")


DOORS: dict[str, dict[str, Callable[[Path], object]]] = {
    "read": dict.fromkeys(KINDS, _captured)
    | {
        "population": _of_population,
        "stimulus": Stimulus.load,
        "bml": lambda path: read_bml_axes(path).walker(),
        "mat": lambda path: mat_arrays(str(path)),
    },
    "info": dict.fromkeys(KINDS, inspect_file),
    "fit": dict.fromkeys(KINDS, process_capture),
}


def _end_of(door: Callable[[Path], object], path: Path, answers: tuple[type, ...]) -> str:
    """Return how one file ends: 'd' for data, 'r' for refused, or a traceback."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            warnings.simplefilter("ignore", UnitGuessed)
            warnings.simplefilter("ignore", RateAssumed)
            door(path)
    except answers:
        return "r"
    except BaseException:
        return traceback.format_exc()
    return "d"


def _work(kind: str, sound: list[Files], numbers: range, seed: int, door: str, out: int) -> None:
    """Read spoilt files one after the other, telling the parent a line of each."""
    in_child = KINDS[kind].in_child and door == "read"
    answers = (Exception,) if in_child else (ValueError,) if door == "fit" else (UnreadableFile,)
    grown = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (grown + MOST_BYTES,) * 2)
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    signal.signal(signal.SIGALRM, signal.SIG_DFL)
    with TemporaryDirectory() as folder:
        for number in numbers:
            files = spoilt(kind, sound, number, seed)
            for name, content in files.items():
                (Path(folder) / name).write_bytes(content)
            start = time.perf_counter()
            signal.alarm(SECONDS)
            end = _end_of(DOORS[door][kind], Path(folder) / next(iter(files)), answers)
            signal.alarm(0)
            took = time.perf_counter() - start
            os.write(out, f"{end[0]} {took:.4f}\n".encode())
            if len(end) > 1:
                os.write(out, ("".join(f"# {line}\n" for line in end.splitlines())).encode())


def fuzz(kind: str, numbers: range, seed: int, door: str, keep: Path) -> Outcome:
    """Return how the spoilt files of a kind end."""
    sound = sound_files(kind, walk_of(0.5 if door == "read" else 3.0))
    outcome = Outcome()
    done = numbers.start
    while done < numbers.stop:
        batch = range(done, min(done + BATCH, numbers.stop))
        told, status = _in_a_child(kind, sound, batch, seed, door)
        count = 0
        for line in told.splitlines():
            if line.startswith("# "):
                outcome.offences[-1] += line[2:] + "\n"
                continue
            end, took = line.split()
            outcome.slowest_s = max(outcome.slowest_s, float(took))
            outcome.counts[{"d": "data", "r": "refused"}.get(end, "other")] += 1
            if end not in "dr":
                outcome.offences.append(f"{kind} {batch[count]}\n")
                _keep(keep, kind, spoilt(kind, sound, batch[count], seed), batch[count])
            count += 1
        if count < len(batch):
            dead = batch[count]
            if KINDS[kind].in_child and door == "read":
                outcome.counts["refused"] += 1
                outcome.counts["of which the child died"] += 1
            else:
                outcome.counts["other"] += 1
                outcome.offences.append(f"{kind} {dead}\nthe process ended with {status}\n")
                _keep(keep, kind, spoilt(kind, sound, dead, seed), dead)
            count += 1
        done += count
    return outcome


def _in_a_child(
    kind: str, sound: list[Files], batch: range, seed: int, door: str
) -> tuple[str, int]:
    """Return what a child told of a batch, and its exit status."""
    listen, tell = os.pipe()
    child = os.fork()
    if not child:
        os.close(listen)
        try:
            _work(kind, sound, batch, seed, door, tell)
        finally:
            os._exit(0)
    os.close(tell)
    told = bytearray()
    while True:
        heard, _, _ = select.select([listen], [], [], 6 * SECONDS)
        if not heard:  # not even its alarm ended it
            os.kill(child, signal.SIGKILL)
        raw = os.read(listen, 65536) if heard else b""
        told += raw
        if not raw:
            break
    os.close(listen)
    _, status = os.waitpid(child, 0)
    whole = told[: told.rfind(b"\n") + 1]
    return whole.decode(errors="replace"), os.waitstatus_to_exitcode(status)


def _keep(folder: Path, kind: str, files: Files, number: int) -> None:
    where = folder / f"{kind}_{number}"
    where.mkdir(parents=True, exist_ok=True)
    for name, content in files.items():
        (where / name).write_bytes(content)


def main() -> int:
    """Return 0 if all files ended as they may."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--format", action="append", choices=list(KINDS), help="default: all")
    parser.add_argument("--count", type=int, default=1000, help="files of each format")
    parser.add_argument("--first", type=int, default=0, help="number of the first file")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--door", choices=list(DOORS), default="read")
    parser.add_argument("--keep", type=Path, default=Path("fuzz-offences"), help="folder")
    told = parser.parse_args()
    failed = False
    for kind in told.format or list(KINDS):
        start = time.monotonic()
        numbers = range(told.first, told.first + told.count)
        outcome = fuzz(kind, numbers, told.seed, told.door, told.keep)
        counts = ", ".join(f"{count} {end}" for end, count in outcome.counts.most_common())
        took = time.monotonic() - start
        print(f"{kind}: {counts}; slowest {outcome.slowest_s:.2f} s; {took:.0f} s", flush=True)
        shown = {offence.splitlines()[-1]: offence for offence in outcome.offences}
        for offence in list(shown.values())[:20]:
            print("  " + offence.strip().replace("\n", "\n  "), flush=True)
        failed |= bool(outcome.offences)
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
