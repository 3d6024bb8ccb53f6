"""A report as one file of HTML that loads nothing else."""

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
CONTENT_POLICY = "default-src 'none'; img-src data:; media-src data:; style-src 'unsafe-inline'"
"""What a browser may load for the page: only what the page itself holds."""
_FEW_COLUMNS = 4
"""Columns that fit on the screen of a telephone."""
SCREEN_DPI = 125
"""CSS pixels per inch of a figure: letters of 8 points are as large as a footnote."""
_NUMBER = re.compile(r"-|(<= )?[+-]?\d+(\.\d+)?(e[+-]?\d+)?( %)?")
"""Text of a cell that is a number, or the dash that stands for none."""
_UNPRINTABLE = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]")


def write_report(report: Report, folder: str | Path) -> Path:
    """Write a report into a folder as ``report.html`` and return the page's path.

    Figures and films are part of the page, which works from the disk and without a network. All
    text is escaped, whatever a file name may hold.

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

    See Also
    --------
    write_classification_report : The page of a classifier.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     page = write_report(ew.report.Report("<b>", "One walker."), folder)
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
    SubElement(head, "meta", {"http-equiv": "Content-Security-Policy", "content": CONTENT_POLICY})
    SubElement(head, "meta", name="viewport", content="width=device-width, initial-scale=1")
    SubElement(head, "meta", name="referrer", content="no-referrer")
    _add(head, "title", report.title)
    SubElement(head, "link", rel="icon", href="data:,")
    style = files("eigenwalker.report").joinpath("style.css").read_text("utf-8")
    SubElement(head, "style").text = style
    body = SubElement(html, "body")
    header = SubElement(body, "header")
    _add(header, "h1", report.title)
    _add(header, "p", report.lead, {"class": "lead"})
    if report.beside is not None:
        address = quote(report.beside.file)
        _add(SubElement(header, "p"), "a", report.beside.text, {"href": address})
    sections = list(enumerate(report.sections, start=1))
    if len(sections) > 2:
        links = SubElement(SubElement(header, "nav", {"aria-label": "Sections"}), "ul")
        for number, section in sections:
            _add(SubElement(links, "li"), "a", section.title, {"href": f"#section-{number}"})
    main = SubElement(body, "main")
    for number, section in sections:
        part = SubElement(main, "section", id=f"section-{number}")
        _add(part, "h2", section.title)
        for films, blocks in itertools.groupby(
            section.blocks, lambda block: isinstance(block, Film)
        ):
            row = SubElement(part, "div", {"class": "films"}) if films else part
            row.extend([_element(block) for block in blocks])
    return "<!doctype html>\n" + tostring(html, encoding="unicode", method="html") + "\n"


@singledispatch
def _element(block: Block) -> Element:
    raise TypeError(f"A report takes {Block}; got {type(block).__name__}.")


@_element.register
def _(block: Text) -> Element:
    return _add(None, "p", block.text)


@_element.register
def _(block: Items) -> Element:
    points = Element("ul")
    for item in block.items:
        _add(points, "li", item)
    return points


@_element.register
def _(block: Code) -> Element:
    return _add(None, "pre", block.lines, {"tabindex": "0"})


@_element.register
def _(block: Table) -> Element:
    size = "scroll wide" if len(block.columns) > _FEW_COLUMNS else "scroll"
    region = {"role": "region", "tabindex": "0", "aria-label": _clean(block.caption)}
    scroll = Element("div", {"class": size, **region})
    table = SubElement(scroll, "table")
    _add(SubElement(table, "caption"), "span", block.caption)
    numeric = [_is_numeric(column) for column in zip(*block.rows, strict=True)]
    alignment = [{"class": "number"} if each else {} for each in numeric]
    alignment = alignment or [{} for _ in block.columns]
    heading = SubElement(SubElement(table, "thead"), "tr")
    for name, aligned in zip(block.columns, alignment, strict=True):
        _add(heading, "th", name, {"scope": "col"} | aligned)
    rows = SubElement(table, "tbody")
    for row in block.rows:
        line = SubElement(rows, "tr")
        for index, (cell, aligned) in enumerate(zip(row, alignment, strict=True)):
            tag, scope = ("td", {}) if index else ("th", {"scope": "row"})
            _add(line, tag, _cell_text(cell), scope | aligned)
    return scroll


@_element.register
def _(block: Figure) -> Element:
    figure = Element("figure")
    wide = block.figure.get_figwidth() > 5.5
    plate = {"class": "plate wide", "tabindex": "0"} if wide else {"class": "plate"}
    width, height = (str(round(inches * SCREEN_DPI)) for inches in block.figure.get_size_inches())
    image = {"src": _svg(block.figure), "alt": block.alt, "width": width, "height": height}
    image = {name: _clean(value) for name, value in image.items()}
    SubElement(SubElement(figure, "div", plate), "img", image)
    _add(figure, "figcaption", block.caption)
    return figure


@_element.register
def _(block: Film) -> Element:
    kind = FILMS.get(block.path.suffix.lower())
    if kind is None:
        raise ValueError(f"{block.path.name!r} is no film; a report takes {sorted(FILMS)}.")
    source = _data_url(block.path.read_bytes(), kind)
    with av.open(str(block.path)) as film:
        width, height = film.streams.video[0].width, film.streams.video[0].height
    figure = Element("figure", style=f"flex-basis: {width}px")
    screen = SubElement(figure, "div", {"class": "screen"})
    shape = {"width": str(width), "height": str(height)}
    if kind.startswith("image"):
        SubElement(screen, "img", shape | {"src": source, "alt": _clean(block.alt)})
    else:
        flags = dict.fromkeys(("controls", "loop", "muted", "playsinline", "autoplay"), "")
        SubElement(
            screen, "video", flags | shape | {"src": source, "aria-label": _clean(block.alt)}
        )
    _add(figure, "figcaption", block.caption)
    return figure


def _add(
    parent: Element | None, tag: str, text: str, attributes: dict[str, str] | None = None
) -> Element:
    """Return an element that holds plain text, at the end of `parent` where there is one."""
    element = Element(tag, attributes or {})
    element.text = _clean(text)
    if parent is not None:
        parent.append(element)
    return element


def _clean(text: str) -> str:
    """Return text without what no page may hold: control characters and lone surrogates."""
    return _UNPRINTABLE.sub("\N{REPLACEMENT CHARACTER}", text)


def _is_numeric(column: tuple[Cell, ...]) -> bool:
    return all(not isinstance(cell, str) or _NUMBER.fullmatch(cell) for cell in column)


def _cell_text(cell: Cell) -> str:
    """Return three figures of a number, more only before the point; rounding errors are 0."""
    if cell is None or (isinstance(cell, float) and math.isnan(cell)):
        return "\N{EN DASH}"
    if isinstance(cell, str):
        return _with_signs(cell) if _NUMBER.fullmatch(cell) else cell
    text = f"{cell:.3g}" if abs(cell) < 1000 and isinstance(cell, float) else f"{cell:.0f}"
    return _with_signs("0" if abs(cell) < 1e-9 else text)


def _with_signs(number: str) -> str:
    """Return a number with the signs of print."""
    if number == "-":
        return "\N{EN DASH}"
    return number.replace("-", "\N{MINUS SIGN}").replace("<=", "\N{LESS-THAN OR EQUAL TO}")


def _svg(figure: matplotlib.figure.Figure) -> str:
    """Return the address of a figure as SVG, the same on all machines."""
    image = io.BytesIO()
    reproducible = mpl.rc_context({"svg.hashsalt": "eigenwalker", "svg.fonttype": "path"})
    with reproducible, warnings.catch_warnings():
        # A letter that the font lacks is drawn as a box; the caption below has the letter itself.
        warnings.filterwarnings("ignore", message="Glyph .* missing")
        metadata = {"Date": None, "Creator": None}
        figure.savefig(image, format="svg", transparent=True, metadata=metadata)
    return _data_url(image.getvalue(), "image/svg+xml")


def _data_url(content: bytes, kind: str) -> str:
    return f"data:{kind};base64,{base64.b64encode(content).decode('ascii')}"
