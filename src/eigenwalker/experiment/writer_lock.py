"""Only one process writes: a lock on the folder, and where the server that has it is reached."""

from __future__ import annotations

import json
import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO

LOCK, SERVER = ".lock", ".server.json"
NETWORK = ("nfs", "cifs", "smb", "9p", "afs", "fuse.sshfs", "fuse.rclone", "davfs", "glusterfs")


class Occupied(OSError):  # noqa: N818 - the name says what it is
    """Another process writes into the folder."""


@contextmanager
def only_writer(folder: Path) -> Iterator[None]:
    """Hold the lock of a folder; raise `Occupied` where another process has it."""
    refuse_network_drive(folder)
    with (folder / LOCK).open("a+b") as file:
        try:
            _lock(file)
        except OSError:
            raise Occupied(
                f"{folder} is in use by another command of this program; wait until it ended."
            ) from None
        yield


@contextmanager
def reachable(folder: Path, address: str, links: str = "") -> Iterator[str]:
    """Write where this server is, for other commands; yields the key that they show.

    `links` is the address that links to observers begin with, where it is another.
    """
    key = secrets.token_urlsafe(16)
    path = folder / SERVER
    unfinished = path.with_suffix(".part")
    unfinished.touch(mode=0o600)
    unfinished.write_text(
        json.dumps({"address": address, "links": links or address, "key": key}), encoding="utf-8"
    )
    unfinished.replace(path)
    try:
        yield key
    finally:
        path.unlink(missing_ok=True)


def running_server(folder: Path) -> tuple[str, str] | None:
    """Return address and key of the server that has the folder, as it wrote them."""
    try:
        there = json.loads((folder / SERVER).read_text(encoding="utf-8"))
        return str(there["address"]), str(there["key"])
    except (OSError, ValueError, KeyError, TypeError):
        return None


def link_address(folder: Path) -> str | None:
    """Return what links begin with while a server has the folder."""
    try:
        there = json.loads((folder / SERVER).read_text(encoding="utf-8"))
        return str(there["links"]).rstrip("/")
    except (OSError, ValueError, KeyError, TypeError):
        return None


def refuse_network_drive(folder: Path) -> None:
    """Refuse a folder on a network drive, where the system says that it is one."""
    try:
        mounts = Path("/proc/self/mountinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return
    place, best = str(folder.resolve()), ("", "")
    for mount in mounts:
        left, _, right = mount.partition(" - ")
        point = left.split()[4].replace("\\040", " ")
        if (place + "/").startswith(point.rstrip("/") + "/") and len(point) >= len(best[0]):
            best = (point, right.split()[0])
    if best[1].startswith(NETWORK):
        raise OSError(
            f"{folder} is on a network drive ({best[1]}), where answers are not safe; "
            "move it to a local disk."
        )


def _lock(file: IO[bytes]) -> None:
    if os.name == "nt":
        import msvcrt

        file.seek(0)
        msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
    else:
        import fcntl

        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
