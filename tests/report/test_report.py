"""Report pages: whole, safe, and alone."""

from __future__ import annotations

import base64
from html.parser import HTMLParser

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from matplotlib.figure import Figure as Drawing

from eigenwalker.core.walker import Walker
from eigenwalker.plotting.walker_films import write_film
from eigenwalker.report.blocks import Code, Figure, Film, Items, Link, Report, Section, Table, Text
from eigenwalker.report.html_report import render_report, write_report

DASH = "\N{EN DASH}"
HOSTILE = "</p><script>alert('&amp;')</script><img src=x onerror=alert(1)> \"quoted' \x00\x1b[31m"


class Page(HTMLParser):
    """What a browser would find: elements with attributes, words within each kind."""

    EMPTY = frozenset({"meta", "link", "img"})

    def __init__(self, html: str) -> None:
        super().__init__(convert_charrefs=True)
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.words: dict[str, list[str]] = {}
        self.open: list[str] = []
        self.feed(html)
        self.close()

    def handle_starttag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))
        if tag not in self.EMPTY:
            self.open.append(tag)
            self.words.setdefault(tag, []).append("")

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if self.open:
            self.words[self.open[-1]][-1] += data

    def all(self, tag):
        return [attributes for name, attributes in self.elements if name == tag]


def drawing() -> Drawing:
    figure = Drawing(figsize=(3, 2))
    figure.subplots().plot([1, 2, 3])
    return figure


@pytest.fixture(scope="module")
def film(tmp_path_factory):
    hop = Walker(["foot"], [[0, 0, 50]], [[[0, 0, 40]]], [1], [0], 1.0)
    return write_film(hop, tmp_path_factory.mktemp("film") / "hop.mp4", n_strides=1, size_px=64)


def whole_report(film, words="as usual") -> Report:
    table = Table(
        words,
        [words, "Errors", "Share"],
        [[words, 3, 7.5], ["structure", None, float("nan")], [words, np.int64(11), 27.512]],
    )
    blocks = [Text(words), Items([words, "two"]), Code(words), table]
    pictures = [Figure(drawing(), words, words), Film(film, words, words)]
    return Report(
        words, words, [Section(words, blocks), Section("See", pictures), Section("3", [])]
    )


def test_the_page_is_one_file_that_parses(tmp_path, film):
    path = write_report(whole_report(film), tmp_path / "new" / "folder")
    assert [file.name for file in path.parent.iterdir()] == ["report.html"]
    page = Page(path.read_text(encoding="utf-8"))
    assert page.open == []
    assert path.read_text(encoding="utf-8").startswith("<!doctype html>\n<html lang=")
    assert page.words["h2"] == ["as usual", "See", "3"]


def test_hostile_names_stay_words(film):
    page = Page(render_report(whole_report(film, HOSTILE)))
    assert page.all("script") == []
    assert len(page.all("img")) == 1
    assert not any(name.startswith("on") for _, found in page.elements for name in found)
    shown = HOSTILE.replace("\x00", "\N{REPLACEMENT CHARACTER}").replace(
        "\x1b", "\N{REPLACEMENT CHARACTER}"
    )
    for tag in ("title", "h1", "h2", "p", "li", "pre", "figcaption", "th", "span"):
        assert shown in page.words[tag], tag
    assert page.all("img")[0]["alt"] == shown


@given(st.text(max_size=60))
@settings(max_examples=60, deadline=None)
def test_any_words_come_out_as_they_went_in(words):
    page = render_report(Report("Title", words, [Section("One", [Text(words)])]))
    page.encode("utf-8")
    if words.isprintable():
        assert Page(page).words["p"] == [words, words]


def test_nothing_is_asked_of_anybody(film):
    html = render_report(whole_report(film))
    page = Page(html)
    for _, attributes in page.elements:
        for name in ("src", "href", "srcset", "poster", "data", "action"):
            if attributes.get(name) is not None:
                assert attributes[name].startswith(("data:", "#"))
    assert "@import" not in html
    assert "url(" not in html
    assert page.all("link") == [{"rel": "icon", "href": "data:,"}]
    policy = next(m for m in page.all("meta") if m.get("http-equiv") == "Content-Security-Policy")
    assert policy["content"].startswith("default-src 'none'")


def test_the_film_in_the_page_is_the_film(film):
    video = Page(render_report(whole_report(film))).all("video")[0]
    kind, content = video["src"].split(";base64,")
    assert kind == "data:video/mp4"
    assert base64.b64decode(content) == film.read_bytes()
    assert {"controls", "muted", "loop"} <= set(video)
    assert video["aria-label"] == "as usual"


def test_the_figure_in_the_page_is_a_drawing_with_a_size_and_words(film):
    image = Page(render_report(whole_report(film))).all("img")[0]
    kind, content = image["src"].split(";base64,")
    assert kind == "data:image/svg+xml"
    assert b"<svg" in base64.b64decode(content)
    assert (image["width"], image["height"]) == ("375", "250")
    assert image["alt"] == "as usual"


def test_figures_may_have_letters_that_the_font_lacks():
    figure = drawing()
    figure.axes[0].set_title("\u6b69\u304f")
    assert "<img" in render_report(Report("T", "L", [Section("S", [Figure(figure, "c", "a")])]))


def test_a_report_is_the_same_every_time(film):
    assert render_report(whole_report(film)) == render_report(whole_report(film))


def test_tables_name_rows_and_columns_and_set_numbers_at_the_right(film):
    page = Page(render_report(whole_report(film)))
    headers = page.all("th")
    assert [header["scope"] for header in headers] == ["col"] * 3 + ["row"] * 3
    cells = page.words["td"]
    assert cells == ["3", "7.5", DASH, DASH, "11", "27.5"]
    assert all(cell["class"] == "number" for cell in page.all("td"))
    assert len(page.words["caption"]) == 1


@pytest.mark.parametrize(
    ("number", "words"),
    [
        (1049.4, "1049"),
        (-0.0166, "\N{MINUS SIGN}0.0166"),
        (9e-16, "0"),
        (0.25, "0.25"),
        (1440, "1440"),
    ],
)
def test_numbers_read_as_one_would_write_them(number, words):
    table = Table("Gait", ["of", "value"], [["a walker", number]])
    assert Page(render_report(Report("T", "L", [Section("S", [table])]))).words["td"] == [words]


@pytest.mark.parametrize(
    ("said", "shown"),
    [
        ("<= 0.005", "\N{LESS-THAN OR EQUAL TO} 0.005"),
        ("-12 %", "\N{MINUS SIGN}12 %"),
        ("+3 %", "+3 %"),
        ("-", DASH),
    ],
)
def test_numbers_that_come_as_words_are_set_as_numbers(said, shown):
    table = Table("Limbs", ["of", "value"], [["a walker", said]])
    page = Page(render_report(Report("T", "L", [Section("S", [table])])))
    assert page.words["td"] == [shown]
    assert page.all("td")[0]["class"] == "number"


def test_words_stay_at_the_left_and_as_they_are():
    table = Table("Traits", ["of", "value"], [["walk-1", "-6 or so"]])
    page = Page(render_report(Report("T", "L", [Section("S", [table])])))
    assert page.words["td"] == ["-6 or so"]
    assert "class" not in page.all("td")[0]


def test_columns_of_results_stay_on_the_screen_of_a_telephone(browser, tmp_path):
    columns = ["input", "nested errors", "nested %", "p", "separated at n", "best n", "errors"]
    row = ["first three eigenpostures", "13", "32.5", "<= 0.005", "17", "25", "13", "32.5"]
    table = Table("Errors", [*columns, "error %"], [row])
    page = browser.new_page(viewport={"width": 390, "height": 800})
    page.goto(write_report(Report("Sex", "", [Section("A", [table])]), tmp_path).as_uri())
    right = "[...document.querySelectorAll('th, td')].map((e) => e.getBoundingClientRect().right)"
    assert page.evaluate(f"Math.max(...{right})") <= 390
    page.close()


def test_a_table_with_a_short_row_is_refused():
    with pytest.raises(ValueError, match=r"2 columns .* a row of 1 cells"):
        Table("Errors", ["input", "errors"], [["structure"]])


def test_a_film_that_is_none_is_refused_and_leaves_no_page(tmp_path):
    report = Report("T", "L", [Section("S", [Film(tmp_path / "walk.doc", "c", "a")])])
    with pytest.raises(ValueError, match=r"walk\.doc"):
        write_report(report, tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_a_block_of_another_kind_is_refused():
    with pytest.raises(TypeError, match="got int"):
        render_report(Report("T", "L", [Section("S", [3])]))  # pyright: ignore[reportArgumentType] - on purpose


def test_sections_can_be_reached_from_the_top(film):
    page = Page(render_report(whole_report(film)))
    targets = {found["id"] for found in page.all("section")}
    assert {link["href"].lstrip("#") for link in page.all("a")} == targets


def test_a_report_links_to_a_page_beside_it_and_no_further():
    html = render_report(Report("Sex", "Told.", beside=Link("Play <here>", "my page.html")))
    assert '<a href="my%20page.html">Play &lt;here&gt;</a>' in html
    for elsewhere in ("../page.html", "https://example.org", "javascript:alert(1)", "a/b.html"):
        with pytest.raises(ValueError, match="files beside it"):
            Link("Play", elsewhere)
