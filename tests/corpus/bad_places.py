"""Files that are no files, are something else than their name says, or lie where they may not."""

from __future__ import annotations

import os
import sys
import zipfile
from collections.abc import Callable
from io import BytesIO
from pathlib import Path

from corpus.bad_file import BadFile, person, written
from corpus.sound_files import acclaim_files, c3d_file

SUFFIXES = (".c3d", ".bvh", ".amc", ".trc", ".sto", ".mot", ".csv", ".tsv", ".json", ".txt", ".nc")
LONG = "a" * 200


def _zip() -> bytes:
    packed = BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        archive.writestr("../../evil.c3d", "x" * 1000)
    return packed.getvalue()


OTHER_FILES = {
    "a picture": b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR" + bytes(200),
    "a PDF": b"%PDF-1.7\n%\xe2\xe3\xcf\xd3\n" + b"1 0 obj << >> endobj\n" * 20,
    "an archive": _zip(),
    "a program": b"\x7fELF\x02\x01\x01" + bytes(500),
    "a letter": b"Dear colleague,\n\nplease find the captures enclosed.\n\nYours, Anna\n",
    "a web page": b"<!DOCTYPE html><html><head><title>404</title></head></html>\n",
    "a pointer of Git LFS": b"version https://git-lfs.github.com/spec/v1\noid sha256:4d\n",
    "zeros": bytes(5000),
}


def wrong_contents() -> list[BadFile]:
    """Return files that are empty or of another kind than they are called."""
    empty = [
        BadFile(
            f"empty {suffix}", written({f"a{suffix}": b""}), "expected .*, but got an empty file"
        )
        for suffix in SUFFIXES
    ]
    return empty + [
        BadFile(
            f"{what} called {suffix}",
            written({f"a{suffix}": content}),
            rf"^a\{suffix}: expected .*, but got .*; .*\.$",
        )
        for what, content in OTHER_FILES.items()
        for suffix in (".c3d", ".bvh", ".trc", ".csv", ".json", ".nc")
    ]


def _folder(folder: Path) -> Path:
    (folder / "a.c3d").mkdir()
    return folder / "a.c3d"


def _dangling(folder: Path) -> Path:
    (folder / "a.c3d").symlink_to(folder / "nowhere")
    return folder / "a.c3d"


def _round(folder: Path) -> Path:
    (folder / "a.c3d").symlink_to(folder / "b.c3d")
    (folder / "b.c3d").symlink_to(folder / "a.c3d")
    return folder / "a.c3d"


def _pipe(folder: Path) -> Path:
    os.mkfifo(folder / "a.c3d")
    return folder / "a.c3d"


def _locked(folder: Path) -> Path:
    path = folder / "a.c3d"
    path.write_bytes(c3d_file(person()))
    path.chmod(0)
    return path


def _named(name: str) -> Callable[[Path], Path]:
    return written({name: b"\x02\x50" + bytes(2000)})


def no_files() -> list[BadFile]:
    """Return what cannot be read as a file, and files of strange names."""
    found = [
        BadFile("nothing", lambda folder: folder / "a.c3d", "nothing of that name in .*check the"),
        BadFile("a folder", _folder, "expected a file, but got a folder; name one of the files"),
        BadFile("a name of 200 letters", _named(f"{LONG}.c3d"), f"^{LONG}.c3d: expected"),
        BadFile(
            "a name in other letters", _named("Gang_行走_ходьба.c3d"), "^Gang_行走_ходьба.c3d: ex"
        ),
        BadFile(
            "a name that clears the screen",
            _named("a\x1b[2J.c3d"),
            "^a\N{REPLACEMENT CHARACTER}\\[",
        ),
        BadFile("a name with blanks", _named(" my walk .c3d"), "^ my walk .c3d: expected"),
        BadFile(
            "a name that is too long", lambda f: f / f"{'a' * 300}.c3d", "a{300}.c3d: expected"
        ),
    ]
    if sys.platform != "win32":
        found += [
            BadFile("a link to nothing", _dangling, "nothing of that name"),
            BadFile("a link to itself", _round, "nothing of that name|links"),
            BadFile("a pipe", _pipe, "expected a plain file, but got a device or pipe"),
            BadFile("a device", lambda _: Path("/dev/zero"), "a device or pipe"),
        ]
        if os.geteuid():  # to root all files are readable
            found.append(BadFile("a locked file", _locked, "Permission denied; check its permiss"))
    return found


def _listed(*files: str, link: bool = False, asf: bool = False) -> Callable[[Path], Path]:
    """Return how to write a traits table beside a folder of captures, and what it should not reach.

    Outside lies a capture that could be read.
    """

    def make(folder: Path) -> Path:
        inside = folder / "captures"
        inside.mkdir()
        (folder / "outside.c3d").write_bytes(c3d_file(person()))
        (inside / "a.c3d").write_bytes(c3d_file(person()))
        if link:
            (inside / "link.c3d").symlink_to(folder / "outside.c3d")
        if asf:
            (inside / "07_01.amc").write_bytes(acclaim_files()["07_01.amc"])
            (folder / "07.asf").write_bytes(acclaim_files()["07.asf"])
        table = folder / "people.csv"
        names = [name.format(folder=folder) for name in files]
        table.write_text("\n".join(["file,sex", *(f'"{name}",f' for name in names)]) + "\n")
        return table

    return make


def _table_of(content: bytes) -> Callable[[Path], Path]:
    def make(folder: Path) -> Path:
        table = _listed("a.c3d")(folder)
        table.write_bytes(content)
        return table

    return make


def wrong_tables() -> list[BadFile]:
    """Return tables of traits that lead out of their folder, or are no such tables."""
    out = "leads out of the folder .*list captures inside it only"
    cases = [
        ("that leads out of the folder", _listed("a.c3d", "../outside.c3d"), out),
        ("that goes in and out again", _listed("a.c3d", "x/../../outside.c3d"), out),
        ("with an absolute path", _listed("a.c3d", "{folder}/outside.c3d"), out),
        ("of a secret", _listed("a.c3d", "/etc/passwd"), out),
        ("of a file that is not there", _listed("a.c3d", "nobody.c3d"), "nothing of that name"),
        ("of the folder itself", _listed("a.c3d", "."), "expected a file, but got a folder"),
        ("with a skeleton outside", _listed("a.c3d", "07_01.amc", asf=True), "beside the motion"),
        ("with a file twice", _listed("a.c3d", "a.c3d"), "lists .* more than once"),
        ("with an empty name", _listed("a.c3d", ""), "Line 3 of the traits table names no file"),
        ("without a column of files", _table_of(b"shoe,sex\n7,f\n"), "needs a column 'file'"),
        ("that is empty", _table_of(b""), "has no line below its headings"),
        ("that is a picture", _table_of(OTHER_FILES["a picture"]), "could not be read: "),
            ]  # fmt: skip
    if sys.platform != "win32":
        cases.append(("of a link that leads out", _listed("a.c3d", "link.c3d", link=True), out))
    return [
        BadFile(f"table {what}", make, said, door="table of traits") for what, make, said in cases
    ]
