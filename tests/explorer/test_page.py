"""The interactive page in a real browser: what a visitor does, and what the page does then."""

from __future__ import annotations

import gzip
import json
import threading
from collections.abc import Iterator
from dataclasses import replace
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

import av
import numpy as np
import pandas as pd
import pytest
import uvicorn
from matplotlib.image import imread

import eigenwalker as ew
from eigenwalker.explorer.app import make_app
from eigenwalker.explorer.interactive_page import interactive_page
from eigenwalker.explorer.model import page_model
from eigenwalker.web.run import address_of, listening_socket

if TYPE_CHECKING:
    from playwright.sync_api import Browser, ConsoleMessage, Locator

playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")

AXE = Path(__file__).parents[2] / "frontend" / "node_modules" / "axe-core" / "axe.min.js"
SIZES = {"desktop": (1440, 900), "wide": (1920, 1080), "phone": (390, 844), "small": (360, 640)}
LATER = "requestAnimationFrame(() => requestAnimationFrame(() => {{ {} }}))"
"""Once the page has shown what was done, and drawn it."""
DROP = """([name, text]) => {
    const data = new DataTransfer();
    data.items.add(new File([text], name));
    for (const type of ["dragover", "drop"]) {
        document.body.dispatchEvent(new DragEvent(type, { dataTransfer: data, bubbles: true }));
    }
}"""


@pytest.fixture(scope="module")
def model() -> dict:
    return page_model(ew.load_population())


@pytest.fixture(scope="module")
def address(model: dict, tmp_path_factory: pytest.TempPathFactory) -> str:
    path = tmp_path_factory.mktemp("page") / "index.html"
    path.write_text(interactive_page(model, report="report.html"), encoding="utf-8")
    return path.as_uri()


def untimed_table() -> bytes:
    """A walk as a table in metres without times."""
    walk = ew.simulate_walk(seed=5, sex="male", duration_s=6, rate_hz=60)
    columns = [f"{name}_{axis}" for name in walk.marker.values for axis in "xyz"]
    table = pd.DataFrame(walk.values.reshape(len(walk), -1) / 1000, columns=columns)
    return table.interpolate(limit_direction="both").to_csv(index=False).encode()


def said_in(address: str) -> dict[str, str]:
    """What the end of an address says, by its short names."""
    parts = (part.partition("=") for part in address.split("&") if part)
    return {name: said for name, _, said in parts}


class Visit:
    """A visitor's page, and what was amiss on it."""

    def __init__(self, browser: Browser, address: str, size: str, **options) -> None:
        width, height = SIZES[size]
        self.context = browser.new_context(
            viewport={"width": width, "height": height}, accept_downloads=True, **options
        )
        self.page = self.context.new_page()
        self.amiss: list[str] = []
        self.asked: list[str] = []
        self.page.on("pageerror", lambda error: self.amiss.append(str(error)))
        self.page.on("console", self._heard)
        self.page.on("request", lambda request: self.asked.append(request.url))
        self.page.goto(address)
        self.page.locator("#main-slider input").wait_for()

    def _heard(self, message: ConsoleMessage) -> None:
        if message.type in ("error", "warning"):
            self.amiss.append(message.text)

    def open(self, title: str) -> Locator:
        section = self.page.locator("details", has=self.page.locator(f"h2:text-is('{title}')"))
        if section.get_attribute("open") is None:
            section.locator("summary").click()
        return section

    def unfold(self) -> None:
        unfolding = "document.querySelectorAll('details').forEach((each) => (each.open = true))"
        self.page.evaluate(unfolding)

    def bring(self, name: str, content: bytes) -> None:
        """Choose a file, as one who cannot drop it."""
        self.page.locator("#file").set_input_files(
            {"name": name, "mimeType": "application/octet-stream", "buffer": content}
        )

    def state(self) -> dict[str, str]:
        """What the address says, once it has followed."""
        rested = "setTimeout(() => done(location.hash.slice(1)), 300)"
        said = self.page.evaluate(f"new Promise((done) => {LATER.format(rested)})")
        return said_in(said)

    def picture(self) -> str:
        """What the stage draws, two frames from now."""
        drawn = "document.querySelector('#viewer canvas').toDataURL()"
        return self.page.evaluate(f"new Promise((done) => {LATER.format(f'done({drawn})')})")


@pytest.fixture
def visit(browser: Browser, address: str) -> Iterator:
    visits: list[Visit] = []

    def begin(state: str = "", size: str = "desktop", **options) -> Visit:
        visits.append(Visit(browser, f"{address}#{state}", size, **options))
        return visits[-1]

    yield begin
    for each in visits:
        each.context.close()
    assert [amiss for each in visits for amiss in each.amiss] == []


def test_the_page_asks_for_nothing(visit):
    there = visit()
    there.page.wait_for_timeout(200)
    assert len(there.asked) == 1
    page = files("eigenwalker.stimulus").joinpath("built", "interactive.html").read_text("utf-8")
    assert '<link rel="icon" href="data:,"' in page
    assert "default-src 'none'" in page
    assert len(gzip.compress(page.encode())) < 95_000


def test_names_that_every_object_has_are_names_of_traits(visit, model):
    there = visit("still")
    people = ew.simulate_population(n_women=6, n_men=6, seed=5)
    sex = people.traits["sex"].map({"female": "constructor", "male": "toString"})
    odd = {"__proto__": sex, "constructor": people.traits["weight_kg"]}
    people = replace(people, traits=pd.DataFrame(odd))
    there.page.evaluate(DROP, ["model.json", json.dumps(page_model(people))])
    there.page.get_by_text("12 simulated walkers").first.wait_for()
    there.unfold()
    slider = there.page.locator("#main-slider input")
    assert slider.input_value() == "0"
    slider.fill("2")
    assert "+2.0 SD towards toString" in slider.get_attribute("aria-valuetext")
    assert there.state()["t"] == "__proto__:2"
    for place in ("#panel", "#insight", "#main-slider"):
        assert "NaN" not in there.page.locator(place).inner_html()


def test_the_large_slider_makes_the_walker_that_python_makes(visit):
    there = visit("still")
    before = there.picture()
    slider = there.page.get_by_role("slider", name="Sex")
    slider.focus()
    slider.press("End")
    assert slider.get_attribute("aria-valuetext") == "+6.0 SD towards man"
    assert there.state()["t"] == "sex:6"
    assert there.picture() != before
    people = ew.load_population()
    vector = people.average + 6 * ew.trait_axis(people, "sex").step
    posture = people.walker(vector).mean_posture
    elbows = posture.sel(marker="left_elbow", axis="y") - posture.sel(
        marker="right_elbow", axis="y"
    )
    shown = there.page.locator(".measure", has_text="Elbows apart").locator("b").inner_text()
    assert float(shown) == pytest.approx(float(elbows), abs=0.51)
    assert "the farthest walker is at" in there.page.locator(".verdict").inner_text()


def test_a_double_click_puts_a_slider_back(visit):
    there = visit("t=sex:4,weight_kg:-2")
    there.page.get_by_role("slider", name="Weight").dblclick(position={"x": 20, "y": 14})
    assert there.state() == {"t": "sex:4"}


def test_everything_can_be_undone_and_reset(visit):
    there = visit()
    there.page.get_by_role("slider", name="Sex").press("Home")
    there.page.get_by_role("button", name="Undo").click()
    assert there.state() == {}
    there.page.get_by_role("slider", name="Sex").press("Home")
    assert there.state() == {"t": "sex:-6"}
    there.page.get_by_role("button", name="Reset all").click()
    assert there.state() == {}


def test_a_drag_is_one_step_that_is_undone_and_reset_knows_the_view(visit):
    there = visit("az=0&still")
    box = there.page.locator("#viewer canvas").bounding_box()
    there.page.mouse.move(box["x"] + 300, box["y"] + 300)
    there.page.mouse.down()
    there.page.mouse.move(box["x"] + 360, box["y"] + 300, steps=5)
    there.page.wait_for_timeout(800)
    there.page.mouse.move(box["x"] + 400, box["y"] + 300, steps=5)
    there.page.wait_for_timeout(150)  # a hand that rests throws nothing
    there.page.mouse.up()
    assert float(there.state()["az"]) == pytest.approx(50, abs=1)
    there.page.get_by_role("button", name="Undo").click()
    assert there.state()["az"] == "0"
    there.page.get_by_role("button", name="Reset all").click()
    assert "az" not in there.state()
    there.page.get_by_role("button", name="Undo").click()
    assert there.state()["az"] == "0"


def test_dragging_turns_the_walker_and_so_do_the_arrows(visit):
    there = visit("az=0&still")
    box = there.page.locator("#viewer canvas").bounding_box()
    there.page.mouse.move(box["x"] + 300, box["y"] + 300)
    there.page.mouse.down()
    there.page.mouse.move(box["x"] + 400, box["y"] + 300, steps=5)
    there.page.wait_for_timeout(150)  # a hand that rests throws nothing
    there.page.mouse.up()
    dragged = float(there.state()["az"])
    assert abs(dragged) > 20
    stage = there.page.get_by_role("slider", name="Walker, seen from")
    stage.press("ArrowRight")
    assert float(there.state()["az"]) == pytest.approx(dragged - 5, abs=0.01)
    assert stage.get_attribute("aria-valuetext") == f"{round(dragged - 5)} degrees"


def test_the_space_bar_lets_the_walker_stand_where_it_is(visit):
    there = visit()
    there.page.locator("body").press(" ")
    standing = there.picture()
    assert "still" in there.state()
    assert there.picture() == standing
    there.page.locator("body").press(" ")
    assert "still" not in there.state()


def test_who_asked_for_little_motion_gets_a_walker_that_stands(visit):
    there = visit(reduced_motion="reduce")
    assert there.page.get_by_role("button", name="Play").is_visible()
    assert there.picture() == there.picture()


def test_a_point_of_the_cloud_walks_when_it_is_clicked(visit, model):
    there = visit("t=sex:3&still")
    section = there.open("Among the others")
    before = there.picture()
    there.page.evaluate("document.querySelector('.cloud').scrollIntoView()")
    chosen = int(np.argmin([scores[0] for scores in model["cloud"]["scores"]]))
    name = model["walkers"][model["cloud"]["walker"][chosen]]["name"]
    box = section.get_by_role("option", name=name, exact=True).bounding_box()
    there.page.mouse.click(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    assert there.state()["w"] == str(model["cloud"]["walker"][chosen])
    assert there.open("Who walks").get_by_role("combobox").inner_text().count(name) == 1
    assert there.picture() != before


def test_the_cloud_can_be_walked_with_the_keyboard(visit):
    there = visit()
    cloud = there.open("Among the others").get_by_role("listbox")
    cloud.focus()
    cloud.press("ArrowUp")
    cloud.press("ArrowRight")
    active = cloud.get_attribute("aria-activedescendant")
    name = there.page.locator(f"#{active}").get_attribute("aria-label")
    cloud.press("Enter")
    walker = int(there.state()["w"])
    option = cloud.locator("[aria-selected=true]")
    assert option.count() == 1
    assert option.get_attribute("aria-label") == name
    assert name.endswith(str(walker))


def test_an_address_tells_all_controls_where_they_stand(visit):
    state = (
        "t=sex:-2,happy:3&k=m&p=dynamics&b=sex:1.5&s=1,0,1,-1&az=90&eye=1&trails=1&dark=0&x=invert"
    )
    there = visit(state)
    assert there.state() == said_in(state)
    assert there.page.locator("html").get_attribute("data-theme") == "light"
    assert there.page.get_by_role("slider", name="Happy").input_value() == "3"
    assert there.page.get_by_role("radio", name="Side", exact=True).is_checked()
    there.open("Body or motion")
    playwright.expect(there.page.get_by_role("radio", name="Motion only")).to_be_checked()
    playwright.expect(there.page.get_by_role("radio", name="Differs most")).to_be_checked()
    there.open("Stride, sway, hop, bounce")
    playwright.expect(there.page.get_by_role("slider", name="Bounce")).to_have_value("-1")
    there.open("Look")
    playwright.expect(there.page.get_by_role("switch", name="Upside down")).to_be_checked()


def test_a_hostile_address_is_passed_over(visit):
    there = visit("t=sex:1e999,__proto__:3&w=-3&s=,,,x")
    for state in ("x=mask;number:9e9&az=NaN", "%%%&&&==", "p=<script>&as=1&show=two&still"):
        there.page.evaluate("(hash) => { location.hash = hash }", state)
        there.page.wait_for_timeout(100)
    assert there.page.get_by_role("slider", name="Sex").input_value() == "0"
    assert there.page.get_by_role("alert").inner_text() == ""


def test_a_link_to_a_capture_says_that_it_does_not_hold_it(visit):
    there = visit("w=own&t=sex:2")
    there.page.get_by_role("status").get_by_text("drop it again").wait_for()
    assert there.state() == {"t": "sex:2"}


def test_the_hills_show_where_somebody_is_and_the_thumb_how_far_one_was_led(visit, model):
    there = visit("w=27&still")
    assert there.page.get_by_role("slider", name="Sex").input_value() == "0"
    projection = model["traits"][0]["projection"]
    score = projection["offset"] + np.dot(projection["gradient"], model["walkers"][27]["vector"])
    assert there.page.locator(".mark").inner_text() == f"this walker +{score:.1f}"
    there.page.get_by_role("button", name="Reset all").click()
    there.page.locator(".mark").wait_for(state="hidden")


def test_to_move_a_slider_of_a_trait_leaves_the_mean_walkers(visit):
    there = visit("show=four&t=sex:3&still")
    changes = there.open("What changes")
    assert changes.get_by_text("Several walk").is_visible()
    assert changes.locator(".measures").is_hidden()
    there.page.get_by_role("slider", name="Sex").press("ArrowRight")
    assert there.state() == {"t": "sex:3.05", "still": ""}
    assert changes.locator(".measures").is_visible()


def test_a_component_walks_alone(visit):
    there = visit()
    section = there.open("Stride, sway, hop, bounce")
    section.get_by_role("button", name="Sway alone").click()
    assert there.state()["s"] == "0,1,0,0"
    section.get_by_role("button", name="Sway alone").click()
    assert "s" not in there.state()


def test_several_walk_at_once(visit):
    there = visit("still")
    seen = [there.picture()]
    for scene, said in (("Means", "four"), ("Side by side", "side"), ("All", "crowd")):
        there.open("Several at once").get_by_role("radio", name=scene, exact=True).click()
        assert there.state()["show"] == said
        seen.append(there.picture())
    assert len(set(seen)) == 4
    box = there.page.locator("#viewer canvas").bounding_box()
    there.page.mouse.click(box["x"] + 0.05 * box["width"], box["y"] + 0.1 * box["height"])
    assert there.state()["w"] == "0"


def test_a_file_that_cannot_be_read_is_told_and_nothing_is_lost(visit):
    there = visit("t=sex:2")
    alert = there.page.get_by_role("alert")
    for name, content, sentence in (
        ("broken.json", b"{", "not JSON"),
        ("list.json", b"[1, 2]", "neither a model nor a stimulus"),
        ("model.json", b'{"format": "eigenwalker model", "version": 1}', "no model of walkers"),
        ("<img src=x onerror=alert(1)>.json", b"{}", "<img src=x"),
        ("walk.c3d", b"\x02P", "eigenwalker serve"),
        ("people.nc", b"CDF", "eigenwalker serve"),
    ):
        there.bring(name, content)
        alert.get_by_text(sentence).wait_for()
        alert.get_by_role("button", name="Dismiss").click()
        assert alert.inner_text() == ""
    assert there.state() == {"t": "sex:2"}


@pytest.mark.parametrize("size", ["desktop", "phone", "small"])
def test_notices_lie_over_the_stage_alone(visit, size):
    there = visit("still", size)
    long = "a very long name of a file " * 30
    for _ in range(3):
        there.bring(f"{long}.c3d", b"")
        there.page.get_by_role("alert").get_by_text("serve").wait_for()
    there.open("Keep and share").get_by_role("button", name="Stimulus").click()
    there.page.get_by_role("status").get_by_text("saved").wait_for()
    notices = there.page.locator(".notice")
    assert notices.count() == 2
    boxes = [notices.nth(i).bounding_box() for i in range(2)]
    assert boxes[1]["y"] < boxes[0]["y"]  # the newer one, which is further down in the page
    lowest = max(box["y"] + box["height"] for box in boxes)
    for control in ("#main-slider", "#playback .scrub", "#playback .round"):
        place = there.page.locator(control).bounding_box()
        gone_by = place["y"] + place["height"] <= 0
        assert gone_by or lowest <= place["y"]


def test_a_dropped_model_is_walked(visit):
    there = visit("t=sex:2")
    other = page_model(ew.simulate_population(n_women=4, n_men=3, seed=5), traits=["sex"])
    there.page.evaluate(DROP, ["model.json", json.dumps(other)])
    there.page.get_by_text("7 simulated walkers").first.wait_for()
    assert there.page.get_by_role("slider", name="Weight").count() == 0
    assert there.page.get_by_role("slider", name="Sex").input_value() == "0"


def test_what_is_saved_is_what_python_reads(visit, tmp_path):
    there = visit("t=sex:3&still&at=0.25&x=invert&az=90")
    section = there.open("Keep and share")
    saved = {}
    for button in ("Picture", "Film", "Page", "Stimulus"):
        with there.page.expect_download() as download:
            section.get_by_role("button", name=button, exact=True).click()
        saved[button] = tmp_path / download.value.suggested_filename
        download.value.save_as(saved[button])
    stimulus = ew.Stimulus.load(saved["Stimulus"])
    people = ew.load_population()
    vector = people.average + 3 * ew.trait_axis(people, "sex").step
    walker = people.walker(vector)
    np.testing.assert_allclose(stimulus.figures[0].motion.p0, walker.p0, atol=1e-4)
    assert stimulus.view.view_deg == 90
    assert [step["name"] for step in stimulus.transforms] == ["invert"]
    height, width, _ = imread(saved["Picture"]).shape
    assert height == width > 500
    with av.open(str(saved["Film"])) as film:
        assert film.streams.video[0].average_rate == 60
        assert sum(1 for _ in film.decode(video=0)) > 100
    assert "eigenwalker stimulus" in saved["Page"].read_text("utf-8")


def test_a_saved_stimulus_that_is_brought_back_walks_the_same(visit, tmp_path):
    there = visit("t=sex:3&still")
    before = there.picture()
    with there.page.expect_download() as download:
        there.open("Keep and share").get_by_role("button", name="Stimulus").click()
    path = tmp_path / "mine.json"
    download.value.save_as(path)
    there.page.get_by_role("button", name="Reset all").click()
    assert there.picture() != before
    there.bring("mine.json", path.read_bytes())
    there.page.get_by_role("status").get_by_text("mine walks").wait_for()
    assert there.state()["w"] == "own"
    assert there.picture() == before


def test_the_python_that_is_copied_makes_the_walker_that_is_seen(visit):
    state = "t=sex:-2,weight_kg:1.5&p=dynamics&k=m&w=4&e=1,0,-2&s=1,0.5,1,1&b=sex:1"
    there = visit(f"{state}&still")
    section = there.open("Keep and share")
    there.context.grant_permissions(["clipboard-read", "clipboard-write"])
    section.get_by_role("button", name="Copy Python").click()
    there.page.get_by_role("status").get_by_text("Python copied").wait_for()
    lines = there.page.evaluate("navigator.clipboard.readText()")
    made: dict = {}
    exec(compile(lines, "<copied>", "exec"), made)
    with there.page.expect_download() as download:
        section.get_by_role("button", name="Stimulus").click()
    seen = ew.Stimulus.load(download.value.path()).figures[0].motion
    np.testing.assert_allclose(made["walker"].p0, seen.p0, atol=1e-4)
    np.testing.assert_allclose(made["walker"].p, seen.p, atol=1e-4)


def test_models_that_lack_things_walk_all_the_same(visit, model):
    nobody = {"walkers": [], "cloud": {"n": 0, "scores": [], "walker": []}, "eigenwalkers": []}
    tags = [each | {"name": "<b onclick=alert(1)>"} for each in model["walkers"]]
    other = {name: f"marker {name}" for name in model["markers"]}
    text = json.dumps(model)
    for name, new in other.items():
        text = text.replace(json.dumps(name), json.dumps(new))
    there = visit("still")
    there.unfold()
    for name, odd in (
        ("no traits", model | {"traits": []}),
        ("nobody", model | nobody | {"traits": []}),
        ("tags", model | {"walkers": tags, "source": "<img src=x onerror=alert(1)>"}),
        ("other markers", json.loads(text)),
    ):
        there.page.evaluate(DROP, [f"{name}.json", json.dumps(odd)])
        there.page.get_by_role("status").get_by_text(f"{name}.json: 40 simulated").wait_for()
        there.unfold()
        assert "NaN" not in there.page.locator("body").inner_text()
        assert there.page.locator("b[onclick], img").count() == 0


@pytest.fixture(scope="module")
def served() -> Iterator[str]:
    """Address of a page with Python behind it."""
    app = make_app(ew.simulate_population(n_women=4, n_men=4, seed=3))
    with listening_socket("127.0.0.1", None) as bound:
        server = uvicorn.Server(uvicorn.Config(app, log_level="error", ws="none"))
        thread = threading.Thread(target=server.run, kwargs={"sockets": [bound]})
        thread.start()
        yield address_of(bound, "127.0.0.1")
        server.should_exit = True
        thread.join()


def test_a_capture_walks_on_the_page_that_is_served(browser, served, tmp_path):
    there = Visit(browser, served, "desktop")
    walk = ew.simulate_walk(seed=5, sex="male", duration_s=6)
    there.page.locator("#file").set_input_files(ew.write_mocap(walk, tmp_path / "mine.c3d"))
    told = there.page.get_by_role("status").get_by_text("the sines of this walker hold")
    told.wait_for(timeout=90_000)
    assert there.state()["w"] == "own"
    assert "mine.c3d" in there.page.locator("#people").inner_text()
    there.open("Who walks")
    there.bring("untimed.csv", untimed_table())
    there.page.get_by_role("alert").get_by_text('"Frames a second"').wait_for(timeout=90_000)
    assert "(..." not in there.page.get_by_role("alert").inner_text()
    there.page.get_by_label("Frames a second").fill("60")
    there.page.get_by_label("Unit of length").select_option("m")
    there.bring("untimed.csv", untimed_table())
    told = there.page.get_by_role("status").get_by_text("Read at 60 frames a second, in m")
    told.wait_for(timeout=90_000)
    there.page.get_by_label("Frames a second").fill("")
    there.page.get_by_label("Unit of length").select_option(label="as the file says")
    own = [f"pt{number:02d}" for number in range(15)]
    walk = ew.simulate_walk(seed=6, duration_s=6).assign_coords(marker=own)
    named = ew.write_mocap(walk, tmp_path / "own.c3d")
    there.page.locator("#file").set_input_files(named)
    there.page.get_by_role("alert").get_by_text("Marker names").wait_for(timeout=90_000)
    pairs = zip(ew.JOINTS.markers, own, strict=True)
    there.bring("names.toml", "\n".join(["[joints]", *(f'{a} = "{b}"' for a, b in pairs)]).encode())
    there.page.get_by_text("Marker names: names.toml").wait_for()
    there.page.locator("#file").set_input_files(named)
    there.page.get_by_role("status").get_by_text("own.c3d walks").wait_for(timeout=90_000)
    there.page.get_by_role("button", name="remove").click()
    there.bring("broken.c3d", b"no capture at all")
    there.page.get_by_role("alert").get_by_text("broken.c3d").wait_for(timeout=90_000)
    assert there.state()["w"] == "own"
    assert {url for url in there.asked if not url.startswith(served)} == set()
    there.context.close()


def test_nothing_hangs_over_the_edge_and_the_large_slider_is_in_reach(visit):
    there = visit("still&show=side&x=mask,scramble,limb_dots")
    there.unfold()
    for width, height in SIZES.values():
        there.page.set_viewport_size({"width": width, "height": height})
        assert there.page.evaluate("document.documentElement.scrollWidth") == width
        wider = """[...document.querySelectorAll("#panel, #insight")]
            .filter((panel) => panel.scrollWidth > panel.clientWidth + 1).length"""
        assert there.page.evaluate(wider) == 0
        box = there.page.locator("#main-slider input").bounding_box()
        assert box["x"] >= 0
        assert box["x"] + box["width"] <= width
        assert box["y"] + box["height"] <= height


@pytest.mark.skipif(not AXE.is_file(), reason="axe-core is not installed in frontend/")
def test_an_audit_of_accessibility_finds_nothing_serious(visit):
    there = visit("t=sex:2&show=four&x=mask&still")
    there.unfold()
    there.bring("a.c3d", b"no capture")
    there.page.get_by_role("alert").get_by_text("serve").wait_for()
    there.page.evaluate(AXE.read_text("utf-8"))
    for size, theme in (("desktop", "Light page"), ("phone", "Dark page")):
        there.page.set_viewport_size(dict(zip(("width", "height"), SIZES[size], strict=True)))
        there.page.get_by_role("button", name=theme).click()
        there.page.wait_for_timeout(200)
        found = there.page.evaluate("axe.run()")
        assert _serious(found) == [], (size, theme)
        assert len(found["passes"]) > 20


def _serious(found: dict) -> list[tuple]:
    return [
        (finding["id"], node["target"], node["failureSummary"])
        for finding in found["violations"]
        if finding["impact"] in ("serious", "critical")
        for node in finding["nodes"]
    ]
