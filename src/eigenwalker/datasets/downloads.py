"""Captures that others published, fetched from where they are, licensed, and checked.

Nothing is fetched without consent to its terms, and no file is stored whose SHA-256 differs from
that in ``downloads.tsv``.
"""

from __future__ import annotations

import csv
import logging
import os
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import NamedTuple
from urllib.parse import quote

import pooch
import requests

from eigenwalker.core.progress import Progress

SOURCE_URL = "https://raw.githubusercontent.com"
"""Where the repositories' files are, as ``<repository>/<commit>/<path>``."""
SOURCE_VARIABLE = "EIGENWALKER_DATA_URL"
"""Environment variable that names a mirror of it."""
TIMEOUT_S = 30
_CHUNK = 1 << 16


class PublishedFile(NamedTuple):
    """One file of a collection: its name here, its hash, and where it is published."""

    name: str
    sha256: str
    repository: str
    commit: str
    path: str

    def url(self, base_url: str) -> str:
        """Return the address of the file."""
        return f"{base_url.rstrip('/')}/{self.repository}/{self.commit}/{quote(self.path)}"


@dataclass(frozen=True)
class Collection:
    """Captures that were published together."""

    name: str
    about: str
    good_for: str
    size_mb: float
    licence: str
    terms: str
    citation: str
    files: tuple[PublishedFile, ...]

    def notice(self) -> str:
        """Return contents, licence and citation, to be shown before it is fetched."""
        return (
            f"{self.name}: {self.about}\n"
            f"Good for {self.good_for}.\n"
            f"{len(self.files)} files, {self.size_mb:g} MB\n"
            f"Licence: {self.licence}. {self.terms}\n"
            f"Please cite: {self.citation}"
        )


@cache
def collections() -> dict[str, Collection]:
    """Return the collections that can be fetched, by name."""
    package = files("eigenwalker.datasets")
    described = tomllib.loads((package / "downloads.toml").read_text(encoding="utf-8"))
    rows = csv.reader((package / "downloads.tsv").read_text(encoding="utf-8").splitlines()[1:],
                      delimiter="\t")  # fmt: skip
    published: dict[str, list[PublishedFile]] = {name: [] for name in described}
    for file, *origin in rows:
        collection, _, name = file.partition("/")
        published[collection].append(PublishedFile(name, *origin))
    return {
        name: Collection(name=name, files=tuple(published[name]), **facts)
        for name, facts in described.items()
    }


def own_copies() -> dict[str, dict[str, str]]:
    """Return published walkers that are read from a user's own copy: what each is good for."""
    text = (files("eigenwalker.datasets") / "own_copies.toml").read_text(encoding="utf-8")
    return tomllib.loads(text)


def collection_named(name: str) -> Collection:
    """Return the collection of that name, or say which there are."""
    if name not in collections():
        raise ValueError(f"There is no collection {name!r}; there are {sorted(collections())}.")
    return collections()[name]


def fetch_captures(
    name: str,
    folder: str | os.PathLike[str] | None = None,
    *,
    accept_licence: bool = False,
    base_url: str | None = None,
    progress: Progress | None = None,
) -> Path:
    """Return a folder with a collection of published captures, fetching what is not yet there.

    Files are written whole or not at all; if it is interrupted, the next call goes on.

    Parameters
    ----------
    name : str
        ``"cmu"``, ``"bandai-namco"``, ``"delussanet"`` or ``"pycgm"``.
    folder : path, optional
        Where to put the files; if left out, in this user's cache.
    accept_licence : bool
        Whether you have read the licence and keep to it; not needed for what is there already.
    base_url : str, optional
        Mirror to take; else the one in the environment variable ``EIGENWALKER_DATA_URL``; else
        where the files were published.
    progress : callable, optional
        Called with the number of files that are there, and of all.

    Returns
    -------
    Path
        The folder.

    Raises
    ------
    ValueError
        If there is no such collection, its licence is not accepted, or a file is not the one that
        was published.
    FileExistsError
        If a file of that name is there which is another.
    ConnectionError
        If a file cannot be fetched.

    See Also
    --------
    fit_folder : a population of such a folder.

    Examples
    --------
    >>> fetch_captures("cmu", "captures")
    Traceback (most recent call last):
    ...
    ValueError: cmu is not fetched before its licence is accepted, with accept_licence=True:
    cmu: one walk each of four people...
    """
    collection = collection_named(name)
    folder = folder_of(name) if folder is None else Path(folder)
    missing = missing_files(collection, folder)
    if missing and not accept_licence:
        raise ValueError(
            f"{name} is not fetched before its licence is accepted, with accept_licence=True:\n"
            f"{collection.notice()}"
        )
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OSError(
            f"The folder {folder} cannot be made ({error.strerror}); name another one."
        ) from error
    base_url = base_url or os.environ.get(SOURCE_VARIABLE) or SOURCE_URL
    n_files = len(collection.files)
    for done, file in enumerate(missing, start=n_files - len(missing)):
        if progress is not None:
            progress(done, n_files)
        _fetch(file, folder, file.url(base_url), f"{done} of {n_files} files are there already")
    if progress is not None:
        progress(n_files, n_files)
    return folder


def folder_of(name: str) -> Path:
    """Return the folder in this user's cache that a collection is kept in."""
    cache = Path(pooch.os_cache("eigenwalker"))
    if not cache.is_absolute():
        raise ValueError("This user has no home, and so no cache; name a folder for the captures.")
    return cache / name


def missing_files(collection: Collection, folder: Path) -> list[PublishedFile]:
    """Return the files of a collection that are not in a folder."""
    missing = []
    for file in collection.files:
        path = folder / file.name
        if not path.exists():
            missing.append(file)
        elif pooch.file_hash(str(path)) != file.sha256:
            raise FileExistsError(
                f"{path} is not the file of that name in {collection.name}, and is left as it is; "
                "move it away, or name another folder."
            )
    return missing


def _fetch(file: PublishedFile, folder: Path, url: str, there: str) -> None:
    downloader = pooch.HTTPDownloader(timeout=TIMEOUT_S, chunk_size=_CHUNK)
    try:
        with _quiet(pooch.get_logger()):
            pooch.retrieve(
                url,
                f"sha256:{file.sha256}",
                file.name,
                folder,
                downloader=downloader,  # pyright: ignore[reportArgumentType] - its own names differ
            )
    except requests.RequestException as error:
        raise ConnectionError(
            f"Could not fetch {url}: {_reason(error)}. Check the network and try again; {there}."
        ) from error
    except ValueError as error:
        raise ValueError(
            f"{url} gave another file than was published (its SHA-256 is not "
            f"{file.sha256[:12]}...), so nothing of it was kept. Try again; if it stays so, the "
            "source has changed."
        ) from error


def _reason(error: Exception) -> str:
    if isinstance(error, requests.HTTPError) and error.response is not None:
        return f"the server said {error.response.status_code} {error.response.reason}"
    if isinstance(error, requests.Timeout):
        return f"no answer within {TIMEOUT_S} s"
    if isinstance(error, requests.exceptions.ChunkedEncodingError):
        return "the connection broke off"
    if isinstance(error, requests.ConnectionError):
        return "no connection to the server"
    if isinstance(error, ValueError):
        return "this is no address; check base_url"
    return type(error).__name__


@contextmanager
def _quiet(logger: logging.Logger) -> Iterator[None]:
    """Keep a library from logging each file."""
    level = logger.level
    logger.setLevel(logging.WARNING)
    try:
        yield
    finally:
        logger.setLevel(level)
