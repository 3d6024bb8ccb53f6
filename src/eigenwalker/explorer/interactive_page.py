"""A model as one file of HTML, which works without a network."""

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
MAX_GZIPPED = 300_000
"""Bytes of a page to put on a web host; what draws the mannequin is inside as long as it fits."""
_SERVER, _NO_SERVER = "connect-src 'self'", "connect-src 'none'"


def interactive_page(model: Mapping[str, Any], *, report: str = "", server: bool = False) -> str:
    """Return the interactive page of a model, as HTML.

    It holds script, style and model, and loads nothing: it works from the disk, without a network,
    and from any web host. Its state is in its address.

    Parameters
    ----------
    model : mapping
        As `page_model` returns it.
    report : str
        Relative address of a report to link to.
    server : bool
        Whether ``eigenwalker serve`` is behind it, which reads captures and makes films. The page
        then may send requests to the place it came from, and to no other.

    Returns
    -------
    str
        HTML, to be written in UTF-8.

    Raises
    ------
    FileNotFoundError
        If the package was installed without its built pages.

    See Also
    --------
    page_model : The numbers of the page.
    show : The same in a notebook.

    Examples
    --------
    >>> page = interactive_page(ew.explorer.page_model(ew.load_population(), traits=["sex"]))
    >>> page[:15].lower(), '"positive":"male"' in page
    ('<!doctype html>', True)
    """
    page = _fill(built(PAGE), "model", _as_json(model))
    page = _fill(page, "player", _as_json(built(PLAYER)))
    about = [("eigenwalker-report", report)] if report else []
    if server:
        about.append(("eigenwalker-server", "1"))
    else:
        page = _replace(page, _SERVER, _NO_SERVER)
    metas = "".join(f'<meta name="{name}" content="{escape(value)}" />' for name, value in about)
    page = _replace(page, "<head>", f"<head>{metas}")
    script = built(MANNEQUIN).replace("</script", "<\\/script").replace("<!--", "<\\!--")
    whole = _fill(page, "mannequin", script)
    fits = server or len(gzip.compress(whole.encode("utf-8"))) < MAX_GZIPPED
    return whole if fits else page


def _fill(page: str, name: str, content: str) -> str:
    """Return the page with content in the script element of that id, which nothing runs."""
    empty = re.search(rf'(<script id="{name}" type="[a-z/]+">)(?:null)?(</script>)', page)
    if empty is None:
        raise ValueError(f"The built {PAGE} has no place for the {name}; build it again.")
    return page[: empty.end(1)] + content + page[empty.start(2) :]


def _as_json(content: Any) -> str:
    """Return JSON that ends no script element: a "<" stands in its texts only."""
    text = json.dumps(content, separators=(",", ":"), ensure_ascii=False, allow_nan=False)
    return text.replace("<", "\\u003c")


def _replace(page: str, old: str, new: str) -> str:
    if old not in page:
        raise ValueError(f"The built {PAGE} has no {old}; build it again.")
    return page.replace(old, new, 1)
