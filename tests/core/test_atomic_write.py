"""On a full disk the old file stays; two writers of one file do not meet."""

from __future__ import annotations

import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import pandas as pd
import pytest

from eigenwalker.core.atomic_write import atomic_write, write_table

FULL = """
import resource, signal, sys
from pathlib import Path
import eigenwalker as ew
from eigenwalker.datasets import load_population
people = load_population()
small = {"duration_s": 0.2, "size_px": (96, 96)}
dots, shown = (ew.make_stimulus(people.walker(people.average), style=style, **small)
               for style in ("dots", "sticks"))
outputs = {
    **{each: lambda path: ew.write_stimulus(shown, path) for each in (
        "a.json", "a.mp4", "a.webm", "a.gif", "a.png", "a.svg", "a.csv", "a.npz", "a.mat",
        "a.html", "a.glb", "a.bvh", "frames")},
    "d.py": lambda path: ew.write_stimulus(dots, path),
    **{each: lambda path: ew.write_mocap(people.walker(people.average), path) for each in (
        "b.c3d", "b.trc", "b.csv", "b.nc", "b.bvh")},
    "people.nc": people.save,
    "report": lambda path: ew.report.write_report(ew.report.Report("A", "b" * 5000), path),
    "table.csv": lambda path: ew.core.atomic_write.write_table(people.traits, path),
}
folder = Path(sys.argv[1])
def content():
    files = sorted(path for path in folder.rglob("*") if path.is_file())
    return {path.name: path.read_bytes() for path in files}
import eigenwalker.core.atomic_write
for name, write in outputs.items():
    write(folder / name)
before = content()
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (500, 500))
for name, write in outputs.items():
    try:
        write(folder / name)
        print(name, "was written")
    except OSError as error:
        if name not in str(error.filename) and name not in ("frames",):
            print(name, "is not named:", error)
    except Exception as error:
        print(name, type(error), error)
    if content() != before:
        print(name, "is another:", content().keys() ^ before.keys())
        before = content()
"""


@pytest.mark.skipif(sys.platform == "win32", reason="Windows cannot limit the size of files")
def test_no_output_loses_the_old_file_on_a_full_disk(tmp_path) -> None:
    command = [sys.executable, "-W", "ignore", "-c", FULL, str(tmp_path)]
    said = subprocess.run(command, capture_output=True, text=True, check=True)
    assert said.stdout == ""


def test_two_writers_of_one_file_do_not_meet(tmp_path) -> None:
    path = tmp_path / "a.txt"
    with atomic_write(path) as one, atomic_write(path) as other:
        assert one != other
        assert one.suffix == other.suffix == ".txt"
        one.write_text("one")
        other.write_text("other")
    assert path.read_text() == "one"

    def write(number: int) -> None:
        with atomic_write(path) as unfinished:
            unfinished.write_text(f"{number}" * 10_000)

    with ThreadPoolExecutor(4) as threads:
        list(threads.map(write, range(10, 50)))
    assert len(set(path.read_text()[::2])) == len(path.read_text()) / 20_000 == 1
    assert [each.name for each in tmp_path.iterdir()] == ["a.txt"]


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such modes")
def test_a_private_file_stays_private(tmp_path) -> None:
    path = tmp_path / "people.nc"
    path.write_text("old")
    path.chmod(0o600)
    with atomic_write(path) as unfinished:
        unfinished.write_text("new")
    assert (path.read_text(), path.stat().st_mode & 0o777) == ("new", 0o600)


def test_a_link_stays_a_link_and_a_folder_a_folder(tmp_path) -> None:
    (tmp_path / "there").mkdir()
    (tmp_path / "link.txt").symlink_to(tmp_path / "there" / "a.txt")
    with atomic_write(tmp_path / "link.txt") as unfinished:
        unfinished.write_text("a")
    assert (tmp_path / "there" / "a.txt").read_text() == "a"
    with pytest.raises(IsADirectoryError, match="is a folder"), atomic_write(tmp_path / "there"):
        pass


def test_no_cell_is_a_formula(tmp_path) -> None:
    table = pd.DataFrame({"x": [-1.5, 2.0], "name": ["=1+1", "a=b"]}, index=["@a", "-b"])
    content = write_table(table, tmp_path / "a.csv").read_text().splitlines()
    assert content == [",x,name", "'@a,-1.5,'=1+1", "'-b,2.0,a=b"]
    numbers = pd.DataFrame({"setting": ["-3", "+1.5e3", "-3+1"]})
    content = write_table(numbers, tmp_path / "b.csv", index=False).read_text().split()
    assert content == ["setting", "-3", "+1.5e3", "'-3+1"]
