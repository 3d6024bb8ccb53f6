"""A model as one file of HTML that anyone can play with, and that asks nothing of anybody else."""

from __future__ import annotations

import json
from collections.abc import Mapping
from html import escape
from importlib.resources import files
from typing import Any

PAGE = "interactive.html"
CARRIED = {"player": "player.html", "mannequin": "mannequin.js"}
"""What the page holds to save pages with and to draw bodies with, by the id of its script."""
_HELD = '<script id="{}" type="application/json">{}</script>'
_ALONE = "default-src 'none';"
_WITH_SERVER = "default-src 'none'; connect-src 'self';"


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
    >>> from eigenwalker.page.model import page_model
    >>> page = interactive_page(page_model(ew.load_population(), traits=["sex"]))
    >>> page[:15].lower(), '"positive":"male"' in page
    ('<!doctype html>', True)

    """
    page = built(PAGE)
    held: dict[str, Any] = {"model": model}
    held |= {name: built(file) for name, file in CARRIED.items() if _place(name) in page}
    for name, content in held.items():
        page = _with(page, _place(name), _HELD.format(name, _as_script(content)))
    about = [("eigenwalker-report", report)] if report else []
    if server:
        about.append(("eigenwalker-server", "1"))
        page = _with(page, _ALONE, _WITH_SERVER)
    metas = "".join(f'<meta name="{name}" content="{escape(said)}" />' for name, said in about)
    return _with(page, "<head>", f"<head>{metas}") if metas else page


def _place(name: str) -> str:
    return _HELD.format(name, "null")


def _as_script(content: Any) -> str:
    """JSON that no script element ends in: a "<" stands in its texts only."""
    text = json.dumps(content, separators=(",", ":"), ensure_ascii=False, allow_nan=False)
    return text.replace("<", "\\u003c")


def _with(page: str, place: str, content: str) -> str:
    before, found, after = page.partition(place)
    if not found:
        raise ValueError(f"The built {PAGE} has no {place}; build it again.")
    return before + content + after


def built(name: str) -> str:
    """Return a page or module that is built from ``frontend/`` when the package is.

    Raises
    ------
    FileNotFoundError
        If it is not there.

    """
    try:
        return files("eigenwalker.page").joinpath(name).read_text(encoding="utf-8")
    except FileNotFoundError:
        raise FileNotFoundError(
            f"{name} is not there: the package was installed without its built pages. In the "
            "project's folder run 'npm ci && npm run build' in frontend/, or install it again."
        ) from None
