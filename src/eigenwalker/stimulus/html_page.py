"""A stimulus as one file of HTML, with the script that plays it inside."""

from __future__ import annotations

from importlib.resources import files
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from eigenwalker.stimulus.stimulus import Stimulus

PAGE, MANNEQUIN = "player.html", "mannequin.js"
"""Built from ``frontend/`` when the package is."""
HELD = '<script id="stimulus" type="application/json">{}</script>'
"""Where the page holds its stimulus."""
HELD_MODULE = '<script id="mannequin" type="text/plain">{}</script>'
"""Where it holds the module that draws the mannequin, which is run when it is asked for."""
SCRIPTS = "script-src 'unsafe-inline'"
"""What the page may run: what stands in it; for the mannequin also what it makes of its text."""


def stand_alone_page(stimulus: Stimulus) -> str:
    """Return a page that plays a stimulus, again and again, at the rate of the screen.

    It holds script, style and stimulus, and loads nothing; for the mannequin, three.js too, which
    makes half a megabyte of it. With ``#t=0.5`` after its address it
    stands still at that moment, with ``#bare`` it shows no controls, with ``#t=0.5&bare`` both.

    Parameters
    ----------
    stimulus : Stimulus
        What to play.

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
    >>> from eigenwalker.stimulus import make_stimulus
    >>> hop = ew.Walker(["foot"], [[0, 0, 50]], [[[0, 0, 40]]], [1], [0], 1.0)
    >>> page = stand_alone_page(make_stimulus(hop))
    >>> page[:15], '"frequency_hz":1.0' in page
    ('<!doctype html>', True)

    """
    # In JSON a "<" stands in texts only, where it may be written as its number; so no text can end
    # the script element that holds it.
    content = HELD.format(stimulus.to_json().replace("<", "\\u003c"))
    before, after = built(PAGE).split(HELD.format("null"))
    if stimulus.display.style == "mannequin":
        content += HELD_MODULE.format(built(MANNEQUIN).replace("</script", "<\\/script"))
        before = before.replace(SCRIPTS, f"{SCRIPTS} blob:")
    return before + content + after


def built(name: str) -> str:
    """Return a page or module that is built from ``frontend/`` when the package is.

    Raises
    ------
    FileNotFoundError
        If it is not there.

    """
    try:
        return files("eigenwalker.stimulus").joinpath("built", name).read_text(encoding="utf-8")
    except FileNotFoundError:
        raise FileNotFoundError(
            f"{name} is not there: the package was installed without its built pages. In the "
            "project's folder run 'npm ci && npm run build' in frontend/, or install it again."
        ) from None
