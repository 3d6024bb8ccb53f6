"""A model as one file of HTML that anyone can play with, and that asks nothing of anybody else."""

from __future__ import annotations

import gzip
import json
import re
from collections.abc import Mapping
from html import escape
from typing import Any

from eigenwalker.stimulus.html_page import built

PAGE, PLAYER, MANNEQUIN = "interactive.html", "player.html", "mannequin.js"
"""Built from ``frontend/`` when the package is."""
MOST_GZIPPED = 300_000
"""Bytes of a page to put on a web host; what draws the mannequin is inside as long as it fits."""
_SERVER, _NO_SERVER = "connect-src 'self'", "connect-src 'none'"


def interactive_page(model: Mapping[str, Any], *, report: str = "", server: bool = False) -> str:
    """Return the page on which a model walks.

    It holds script, style and model, and loads nothing: it works from the disk, without a network,
    and from any web host. Its state is in its address.

    Parameters
    ----------
    model : mapping
        Of `page_model`.
    report : str, optional
        Relative address of a report to link to.
    server : bool
        Whether ``eigenwalker serve`` is behind it, which reads captures and makes films. The page
        then may ask the place it came from, and no other.

    Returns
    -------
    str
        HTML, to be written in UTF-8.

    Raises
    ------
    FileNotFoundError
        If the package was installed without its built pages.

    Examples
    --------
    >>> from eigenwalker.explorer.model import page_model
    >>> page = interactive_page(page_model(ew.load_population(), traits=["sex"]))
    >>> page[:15].lower(), '"positive":"male"' in page
    ('<!doctype html>', True)

    """
    page = _holding(built(PAGE), "model", _as_json(model))
    page = _holding(page, "player", _as_json(built(PLAYER)))
    about = [("eigenwalker-report", report)] if report else []
    if server:
        about.append(("eigenwalker-server", "1"))
    else:
        page = _with(page, _SERVER, _NO_SERVER)
    metas = "".join(f'<meta name="{name}" content="{escape(said)}" />' for name, said in about)
    page = _with(page, "<head>", f"<head>{metas}")
    whole = _holding(page, "mannequin", _as_text(built(MANNEQUIN)))
    fits = server or len(gzip.compress(whole.encode("utf-8"))) < MOST_GZIPPED
    return whole if fits else page


def _holding(page: str, name: str, content: str) -> str:
    """The page with content in the script of that id, which nothing runs."""
    empty = re.compile(rf'(<script id="{name}" type="[a-z/]+">)(?:null)?(</script>)')
    found = empty.search(page)
    if found is None:
        raise ValueError(f"The built {PAGE} has no place for the {name}; build it again.")
    return page[: found.end(1)] + content + page[found.start(2) :]


def _as_json(content: Any) -> str:
    """JSON that no script element ends in: a "<" stands in its texts only."""
    text = json.dumps(content, separators=(",", ":"), ensure_ascii=False, allow_nan=False)
    return text.replace("<", "\\u003c")


def _as_text(script: str) -> str:
    """A script with its texts written so that they end no element."""
    return script.replace("</script", "<\\/script").replace("<!--", "<\\!--")


def _with(page: str, place: str, content: str) -> str:
    before, found, after = page.partition(place)
    if not found:
        raise ValueError(f"The built {PAGE} has no {place}; build it again.")
    return before + content + after
