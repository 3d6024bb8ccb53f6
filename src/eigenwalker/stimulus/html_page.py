"""A stimulus as one file of HTML, with the script that plays it inside."""

from __future__ import annotations

from importlib.resources import files
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from eigenwalker.stimulus.stimulus import Stimulus

PAGE, MANNEQUIN = "player.html", "mannequin.js"
"""Built from ``frontend/`` when the package is."""
STIMULUS_SCRIPT = '<script id="stimulus" type="application/json">{}</script>'
"""The element that holds the stimulus."""
MODULE_SCRIPT = '<script id="mannequin" type="text/plain">{}</script>'
"""The element that holds the module that draws mannequins, run when one is shown."""
SCRIPTS = "script-src 'unsafe-inline'"
"""The page may run scripts that stand in it; for a mannequin also what it makes of its text."""


def stand_alone_page(stimulus: Stimulus) -> str:
    """Return a page that plays a stimulus, again and again, at the rate of the screen.

    The page holds script, style and stimulus and loads nothing; for a mannequin it also holds
    three.js, half a megabyte. With ``#t=0.5`` after its address it stands still at that moment,
    with ``#bare`` it shows no controls, with ``#t=0.5&bare`` both.

    Parameters
    ----------
    stimulus : Stimulus

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
    write_stimulus : Writes it, as .html.

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
    content = STIMULUS_SCRIPT.format(stimulus.to_json().replace("<", "\\u003c"))
    before, after = built(PAGE).split(STIMULUS_SCRIPT.format("null"))
    if stimulus.display.style == "mannequin":
        content += MODULE_SCRIPT.format(built(MANNEQUIN).replace("</script", "<\\/script"))
        before = before.replace(SCRIPTS, f"{SCRIPTS} blob:")
    return before + content + after


def built(name: str) -> str:
    """Return a page or module that is built from ``frontend/`` when the package is."""
    try:
        return files("eigenwalker.stimulus").joinpath("built", name).read_text(encoding="utf-8")
    except FileNotFoundError:
        raise FileNotFoundError(
            f"{name} is not there: the package was installed without its built pages. In the "
            "project's folder run 'npm ci && npm run build' in frontend/, or install it again."
        ) from None
