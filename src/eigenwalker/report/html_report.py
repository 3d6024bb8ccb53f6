"""A report as one file of HTML, which asks nothing of anybody else."""

from __future__ import annotations

import base64
import io
import itertools
import math
import re
import warnings
from functools import singledispatch
from importlib.resources import files
from pathlib import Path
from urllib.parse import quote
from xml.etree.ElementTree import Element, SubElement, tostring

import av
import matplotlib as mpl
import matplotlib.figure

from eigenwalker.core.atomic_write import atomic_write
from eigenwalker.report.blocks import Block, Cell, Code, Figure, Film, Items, Report, Table, Text

FILMS = {".mp4": "video/mp4", ".webm": "video/webm", ".gif": "image/gif"}
ALLOWED = "default-src 'none'; img-src data:; media-src data:; style-src 'unsafe-inline'"
"""What a browser may load for the page: what the page itself holds."""
_FEW_COLUMNS = 6
"""As many as a telephone shows at once."""
SCREEN_DPI = 125
"""CSS pixels an inch of a figure takes: letters of 8 points are as large as a footnote."""
_NUMBER = re.compile(r"-|(<= )?[+-]?\d+(\.\d+)?(e[+-]?\d+)?( %)?")
"""A cell of words that is a number all the same, or the dash that stands for none."""
_UNPRINTABLE = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]")


def write_report(report: Report, folder: str | Path) -> Path:
    """Write a report into a folder as ``report.html`` and return the page's path.

    Figures and films are part of the page, which works from the disk and without a network. All
    words are taken as words, whatever a file name may hold.

    Parameters
    ----------
    report : Report
        Its title, sections and blocks.
    folder : path
        Made where it does not exist.

    Returns
    -------
    Path

    Raises
    ------
    FileNotFoundError, ValueError
        If a film does not exist or is none.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> from eigenwalker.report.blocks import Report
    >>> with TemporaryDirectory() as folder:
    ...     page = write_report(Report("<b>", "One walker."), folder)
    ...     "&lt;b&gt;" in page.read_text()
    True

    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    page = folder / "report.html"
    with atomic_write(page) as unfinished:
        unfinished.write_text(render_report(report), encoding="utf-8")
    return page


def render_report(report: Report) -> str:
    """Return the page of a report as text."""
    html = Element("html", lang="en")
    head = SubElement(html, "head")
    SubElement(head, "meta", charset="utf-8")
    SubElement(head, "meta", {"http-equiv": "Content-Security-Policy", "content": ALLOWED})
    SubElement(head, "meta", name="viewport", content="width=device-width, initial-scale=1")
    SubElement(head, "meta", name="referrer", content="no-referrer")
    _put(head, "title", report.title)
    SubElement(head, "link", rel="icon", href="data:,")
    SubElement(head, "style").text = (
        files("eigenwalker.report").joinpath("style.css").read_text("utf-8")
    )
    body = SubElement(html, "body")
    _fill(body, report)
    return "<!doctype html>\n" + tostring(html, encoding="unicode", method="html") + "\n"


def _fill(body: Element, report: Report) -> None:
    header = SubElement(body, "header")
    _put(header, "h1", report.title)
    _put(header, "p", report.lead, {"class": "lead"})
    if report.beside is not None:
        address = quote(report.beside.file)
        _put(SubElement(header, "p"), "a", report.beside.words, {"href": address})
    if len(report.sections) > 2:
        links = SubElement(SubElement(header, "nav", {"aria-label": "Sections"}), "ul")
        for number, section in enumerate(report.sections, start=1):
            _put(SubElement(links, "li"), "a", section.title, {"href": f"#section-{number}"})
    main = SubElement(body, "main")
    for number, section in enumerate(report.sections, start=1):
        part = SubElement(main, "section", id=f"section-{number}")
        _put(part, "h2", section.title)
        for films, blocks in itertools.groupby(
            section.blocks, lambda block: isinstance(block, Film)
        ):
            row = SubElement(part, "div", {"class": "films"}) if films else part
            row.extend([_element(block) for block in blocks])


@singledispatch
def _element(block: Block) -> Element:
    raise TypeError(f"A report takes {Block}; got {type(block).__name__}.")


@_element.register
def _(block: Text) -> Element:
    return _put(None, "p", block.words)


@_element.register
def _(block: Items) -> Element:
    points = Element("ul")
    for item in block.items:
        _put(points, "li", item)
    return points


@_element.register
def _(block: Code) -> Element:
    return _put(None, "pre", block.lines, {"tabindex": "0"})


@_element.register
def _(block: Table) -> Element:
    scroll = Element("div", _scrolled(block.caption, wide=len(block.columns) > _FEW_COLUMNS))
    table = SubElement(scroll, "table")
    _put(SubElement(table, "caption"), "span", block.caption)
    numeric = [_is_numeric(column) for column in zip(*block.rows, strict=True)]
    numeric = numeric or [False] * len(block.columns)
    heading = SubElement(SubElement(table, "thead"), "tr")
    for name, aligned in zip(block.columns, numeric, strict=True):
        _put(heading, "th", name, {"scope": "col"} | _aligned(aligned))
    rows = SubElement(table, "tbody")
    for row in block.rows:
        line = SubElement(rows, "tr")
        for place, (cell, aligned) in enumerate(zip(row, numeric, strict=True)):
            kind, extra = ("td", {}) if place else ("th", {"scope": "row"})
            _put(line, kind, _in_words(cell), extra | _aligned(aligned))
    return scroll


@_element.register
def _(block: Figure) -> Element:
    figure = Element("figure")
    wide = block.figure.get_figwidth() > 5.5
    plate = SubElement(figure, "div", {"class": "plate wide" if wide else "plate"})
    plate.attrib |= {"tabindex": "0"} if wide else {}
    source, width, height = _picture(block.figure)
    image = {"src": source, "alt": block.alt, "width": str(width), "height": str(height)}
    SubElement(plate, "img", {name: _clean(value) for name, value in image.items()})
    _put(figure, "figcaption", block.caption)
    return figure


@_element.register
def _(block: Film) -> Element:
    kind = FILMS.get(block.path.suffix.lower())
    if kind is None:
        raise ValueError(f"{block.path.name!r} is no film; a report takes {sorted(FILMS)}.")
    source = _embedded(block.path.read_bytes(), kind)
    width, height = _film_size(block.path)
    figure = Element("figure", style=f"flex-basis: {width}px")
    screen = SubElement(figure, "div", {"class": "screen"})
    shape = {"width": str(width), "height": str(height)}
    if kind.startswith("image"):
        SubElement(screen, "img", shape | {"src": source, "alt": _clean(block.alt)})
    else:
        how = dict.fromkeys(("controls", "loop", "muted", "playsinline", "autoplay"), "")
        SubElement(screen, "video", how | shape | {"src": source, "aria-label": _clean(block.alt)})
    _put(figure, "figcaption", block.caption)
    return figure


def _put(
    parent: Element | None, tag: str, words: str, attributes: dict[str, str] | None = None
) -> Element:
    """An element that holds plain words, at the end of `parent` where there is one."""
    element = Element(tag, attributes or {})
    element.text = _clean(words)
    if parent is not None:
        parent.append(element)
    return element


def _clean(words: str) -> str:
    """Words without what no page may hold: control characters and halves of characters."""
    return _UNPRINTABLE.sub("\N{REPLACEMENT CHARACTER}", words)


def _scrolled(name: str, *, wide: bool) -> dict[str, str]:
    """For what may be wider than a telephone: it scrolls in its own box, by keyboard too."""
    shape = "scroll wide" if wide else "scroll"
    return {"class": shape, "role": "region", "tabindex": "0", "aria-label": _clean(name)}


def _is_numeric(column: tuple[Cell, ...]) -> bool:
    return all(not isinstance(cell, str) or _NUMBER.fullmatch(cell) for cell in column)


def _aligned(numeric: bool) -> dict[str, str]:
    return {"class": "number"} if numeric else {}


def _in_words(cell: Cell) -> str:
    """Three figures of a number, more only before the point; rounding errors are 0."""
    if cell is None or (isinstance(cell, float) and math.isnan(cell)):
        return "\N{EN DASH}"
    if isinstance(cell, str):
        return _signed(cell) if _NUMBER.fullmatch(cell) else cell
    words = f"{cell:.3g}" if abs(cell) < 1000 and isinstance(cell, float) else f"{cell:.0f}"
    return _signed("0" if abs(cell) < 1e-9 else words)


def _signed(number: str) -> str:
    """A number with the signs that print has."""
    if number == "-":
        return "\N{EN DASH}"
    return number.replace("-", "\N{MINUS SIGN}").replace("<=", "\N{LESS-THAN OR EQUAL TO}")


def _picture(figure: matplotlib.figure.Figure) -> tuple[str, int, int]:
    """A figure as the address of the data themselves, with its size in CSS pixels."""
    drawn = io.BytesIO()
    same_everywhere = mpl.rc_context({"svg.hashsalt": "eigenwalker", "svg.fonttype": "path"})
    with same_everywhere, warnings.catch_warnings():
        # A letter that the font lacks is drawn as a box; the caption below has the letter itself.
        warnings.filterwarnings("ignore", message="Glyph .* missing")
        about = {"Date": None, "Creator": None}
        figure.savefig(drawn, format="svg", transparent=True, metadata=about)
    width, height = figure.get_size_inches() * SCREEN_DPI
    return _embedded(drawn.getvalue(), "image/svg+xml"), round(width), round(height)


def _film_size(path: Path) -> tuple[int, int]:
    with av.open(str(path)) as film:
        picture = film.streams.video[0]
        return picture.width, picture.height


def _embedded(content: bytes, kind: str) -> str:
    return f"data:{kind};base64,{base64.b64encode(content).decode('ascii')}"
