"""The page of observers, as it was built, with what draws mannequins where a design shows any."""

from __future__ import annotations

from eigenwalker.experiment.design import Design
from eigenwalker.stimulus.html_page import MANNEQUIN, MODULE_SCRIPT, SCRIPTS, built

PAGE = "experiment.html"


def observer_page(design: Design) -> str:
    """Return the page as HTML; it loads nothing but what its server answers."""
    page = built(PAGE)
    styles = {design.picture.style, *(each.style for each in design.shown)}
    if "mannequin" not in styles:
        return page
    text = built(MANNEQUIN).replace("</script", "<\\/script").replace("<!--", "<\\!--")
    before, _, after = page.replace(SCRIPTS, f"{SCRIPTS} blob:", 1).rpartition("</body>")
    return f"{before}{MODULE_SCRIPT.format(text)}</body>{after}"
