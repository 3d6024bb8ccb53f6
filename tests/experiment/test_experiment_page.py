"""The page of observers in a real browser: nothing that it took is lost, whatever ends."""

from __future__ import annotations

import csv
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from eigenwalker.experiment.experiment_texts import sections_of
from eigenwalker.experiment.export import export_experiment
from eigenwalker.experiment.status import experiment_status

if TYPE_CHECKING:
    from playwright.sync_api import Browser, BrowserContext, Page

AXE = Path(__file__).parents[2] / "frontend" / "node_modules" / "axe-core" / "axe.min.js"

DRAWN = """canvas => {
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    return data.filter((value, i) => i % 4 === 0 && value > 40).length;
}"""
"""How many pixels of a canvas are not dark."""


class Server:
    """``experiment run`` in a process of its own, which may be killed and started again."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.port = folder, 0
        self.start()

    def start(self) -> None:
        command = [sys.executable, "-m", "eigenwalker", "experiment", "run", str(self.folder)]
        self.process = subprocess.Popen(
            [*command, "--port", str(self.port)], stdout=subprocess.PIPE, text=True
        )
        assert self.process.stdout is not None
        self.address = self.process.stdout.readline().split()[1].rstrip("/")
        self.port = int(self.address.rpartition(":")[2])

    def kill(self) -> None:
        self.process.kill()
        self.process.wait()
        assert self.process.stdout is not None
        self.process.stdout.close()

    def link(self, run_command: Callable, *options: str) -> str:
        """Invite while it runs, and return the link."""
        links = self.folder / "one.csv"
        links.unlink(missing_ok=True)
        code, _, problems = run_command(
            *("experiment", "invite", self.folder, "-o", links, *options),
        )
        assert code == 0, problems
        return links.read_text(encoding="utf-8").split()[-1].partition(",")[2]


@pytest.fixture
def server(small: Callable[..., Path]) -> Iterator[Server]:
    started = Server(small(blank_s="0.05", instances="1", measure="false", full_screen="false"))
    yield started
    started.kill()


@contextmanager
def visit(browser: Browser, link: str, **options: object) -> Iterator[tuple[BrowserContext, Page]]:
    context = browser.new_context(viewport={"width": 900, "height": 700}, **options)
    page = context.new_page()
    page.set_default_timeout(10_000)
    page.goto(link)
    yield context, page
    context.close()


def press(page: Page, name: str) -> None:
    page.get_by_role("button", name=name, exact=False).click()


def answer(page: Page, key: str = "f") -> None:
    page.locator("#trials button:enabled").first.wait_for()
    page.evaluate("document.querySelector('#trials canvas').id = 'answered'")
    strike(page, key)
    page.locator("#answered").wait_for(state="detached")


def strike(page: Page, key: str) -> None:
    """Press a key, whatever is printed on it."""
    if key.isascii():
        return page.keyboard.press(key)
    strike = """([type, key]) => document.activeElement.dispatchEvent(
        new KeyboardEvent(type, { key, bubbles: true }))"""
    for kind in ("keydown", "keyup"):
        page.evaluate(strike, [kind, key])
    return None


def rows(folder: Path, output: Path) -> list[dict[str, str]]:
    export_experiment(folder, output)
    with min(output.glob("data/*.csv")).open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_an_observer_goes_on_after_the_server_and_the_page_ended(
    browser: Browser, server: Server, run_command: Callable, tmp_path: Path
) -> None:
    link = server.link(run_command)
    with visit(browser, link) as (_, page):
        press(page, "I have read this")
        assert link.rpartition("/")[2] not in page.url
        press(page, "Begin")
        answer(page)
        answer(page, "m")
        server.kill()
        answer(page)
        page.locator("#trials button:enabled").first.wait_for()
        server.start()
        page.reload()
        press(page, "Continue")
        answer(page, "m")
        press(page, "Continue")  # the break between blocks
        for _ in range(7):
            answer(page)
        page.locator("#trials button:enabled").first.wait_for()
        press(page, "Man (M)")
        page.get_by_text("every answer has arrived").wait_for()
        left = page.evaluate("indexedDB.databases()")
    assert left == []
    found = rows(server.folder, tmp_path / "data")
    answered = [row for row in found if row["outcome"] == "answered"]
    assert [row["trial"] for row in answered] == [str(n) for n in range(1, 13)]
    assert [row["response"] for row in answered[:3]] == ["female", "male", "female"]
    assert answered[-1]["response_by"] == "button"
    interrupted = [(row["trial"], row["attempt"]) for row in found if row["interrupted"] == "1"]
    assert interrupted == [("4", "1")]
    assert all(float(row["rt_ms"]) > 0 for row in answered)


def test_an_observer_who_stops_may_have_all_deleted(
    browser: Browser, server: Server, run_command: Callable
) -> None:
    with visit(browser, server.link(run_command, "--open")) as (context, page):
        press(page, "I have read this")
        press(page, "Begin")
        answer(page)
        second = context.new_page()
        second.goto(server.link(run_command))
        second.get_by_role("button", name="I have read this").wait_for()  # another link
        second.close()
        page.get_by_role("button", name="Stop", exact=True).click()
        press(page, "delete")
        page.get_by_text("Everything you gave was deleted").wait_for()
        assert page.evaluate("indexedDB.databases()") == []
    assert experiment_status(server.folder)["answers"] == 0
    assert experiment_status(server.folder)["withdrawn"] == 1


def test_of_two_tabs_one_works_and_the_other_says_so(
    browser: Browser, server: Server, run_command: Callable
) -> None:
    link = server.link(run_command)
    with visit(browser, link) as (context, page):
        press(page, "I have read this")
        second = context.new_page()
        second.goto(link)
        second.get_by_text("open in another tab").wait_for()
        page.close()
        second.reload()
        second.get_by_text("Welcome back").wait_for()


def test_without_storage_each_answer_is_sent_before_the_next_trial(
    browser: Browser, server: Server, run_command: Callable, tmp_path: Path
) -> None:
    context = browser.new_context()
    context.add_init_script("Object.defineProperty(window, 'indexedDB', { value: undefined })")
    page = context.new_page()
    page.goto(server.link(run_command))
    press(page, "I have read this")
    press(page, "Continue")
    press(page, "Begin")
    answer(page)
    page.locator("#trials canvas").wait_for()
    found = rows(server.folder, tmp_path / "data")
    assert [row["outcome"] for row in found][:1] == ["answered"]
    context.close()


HEBREW = {
    "direction": "rtl",
    "title": "מי הולך שם?",
    "language": "שפה",
    "agree": "קראתי ואני משתתף",
    "instructions": "לחצו **ש** לאישה, **ג** לגבר, או געו בלחצנים.",
    "key_female": "ש",
    "button_female": "אישה (ש)",
    "key_male": "ג",
    "button_male": "גבר (ג)",
}
QUESTIONS = """
[[questions]]
name = "age"
kind = "number"

[[questions]]
name = "hand"
kind = "choice"
options = ["left", "right"]
"""


@pytest.fixture
def in_hebrew(small: Callable[..., Path]) -> Iterator[Server]:
    """An experiment in two languages, with questions, on a screen that is measured."""
    folder = small(
        blank_s="0.05",
        instances="1",
        full_screen="false",
        languages='["en", "he"]',
        duration_s="4.0",
    )
    english = folder / "texts" / "en.md"
    words = (
        "\n\n# question_age\nAge\n\n# question_hand\nHand\n\n# option_left\nL\n\n# option_right\nR"
    )
    english.write_text(english.read_text(encoding="utf-8") + words, encoding="utf-8")
    sections = sections_of(english.read_text(encoding="utf-8")) | HEBREW
    text = "".join(f"# {name}\n{each}\n\n" for name, each in sections.items())
    (folder / "texts" / "he.md").write_text(text, encoding="utf-8")
    with (folder / "design.toml").open("a", encoding="utf-8") as file:
        file.write(QUESTIONS)
    started = Server(folder)
    yield started
    started.kill()


def check(page: Page, width: int) -> None:
    """What automatic checks of accessibility find on a page, and whether it fits."""
    if not page.evaluate("'axe' in window"):
        page.evaluate(AXE.read_text(encoding="utf-8"))
    found = page.evaluate("axe.run().then(({ violations }) => violations.map((v) => v.id))")
    assert found == []
    assert page.evaluate("document.documentElement.scrollWidth") <= width


def go_on_by_keys(page: Page) -> None:
    """Go to the first button of the page by the tabulator alone, and press it."""
    page.locator("#page .first").wait_for()
    for _ in range(20):
        if page.evaluate("document.activeElement.className") == "first":
            break
        page.keyboard.press("Tab")
    page.keyboard.press("Enter")


def test_all_pages_are_accessible_and_work_by_keys_alone_on_a_narrow_screen_from_right_to_left(
    browser: Browser, in_hebrew: Server, run_command: Callable, tmp_path: Path
) -> None:
    with visit(browser, in_hebrew.link(run_command), bypass_csp=True) as (_, page):
        page.set_viewport_size({"width": 320, "height": 640})
        page.get_by_label("Language").focus()
        page.keyboard.press("ArrowDown")
        page.get_by_role("heading", name=HEBREW["title"]).wait_for()
        assert page.evaluate("document.documentElement.dir") == "rtl"
        for wanted in (HEBREW["agree"], "The frame fits my card"):
            page.get_by_role("button", name=wanted).wait_for()
            check(page, 320)
            go_on_by_keys(page)
        page.get_by_label("Distance").wait_for()
        check(page, 320)
        go_on_by_keys(page)
        page.get_by_text("Please give a number").wait_for()
        page.get_by_label("Distance").focus()
        page.keyboard.type("40")
        page.keyboard.press("Enter")
        page.get_by_label("Age").wait_for()
        check(page, 320)
        page.get_by_label("Age").focus()
        page.keyboard.type("33")
        page.keyboard.press("Tab")
        page.keyboard.press("Space")
        go_on_by_keys(page)
        page.get_by_role("button", name="Begin").wait_for()
        check(page, 320)
        go_on_by_keys(page)
        page.locator("#trials button:enabled").first.wait_for()
        check(page, 320)
        page.locator("#trials button:enabled").first.wait_for()
        page.evaluate("document.querySelector('#trials canvas').id = 'asked'")
        page.get_by_role("button", name="Stop", exact=True).focus()
        page.keyboard.press("Enter")
        page.get_by_role("dialog").wait_for()
        strike(page, "ש")  # no answer to the trial behind it
        check(page, 320)
        page.keyboard.press("Escape")
        page.locator("#asked").wait_for(state="detached")
        for key in ("ש", "ג", "ש", "ג"):
            answer(page, key)
        page.get_by_text("You have finished a part").wait_for()
        check(page, 320)
        go_on_by_keys(page)
        for _ in range(8):
            answer(page, "ג")
        page.get_by_text("every answer has arrived").wait_for()
        check(page, 320)
        code = page.locator("code").inner_text()
        page.reload()
        page.get_by_text(code).wait_for()  # the last page is there again
    found = rows(in_hebrew.folder, tmp_path / "data")
    assert [row["interrupted"] for row in found].count("1") == 1
    given = [row["response"] for row in found if row["outcome"] == "answered"]
    assert given == ["female", "male"] * 2 + ["male"] * 8
    questions = next((tmp_path / "data").glob("**/*questions*.csv")).read_text(encoding="utf-8")
    assert "age,33" in questions
    assert "hand,left" in questions


def test_the_most_similar_pair_of_four_mannequins_is_chosen_by_touch_and_by_keys(
    browser: Browser, small: Callable[..., Path], run_command: Callable, tmp_path: Path
) -> None:
    folder = small("prazak2010", blank_s="0.6", trials="2", measure="false", full_screen="false")
    started = Server(folder)
    try:
        with visit(browser, started.link(run_command), has_touch=True) as (_, page):
            press(page, "I have read this")
            press(page, "Begin")
            page.get_by_role("button", name="Figure 4").tap()
            page.get_by_role("button", name="Figure 1").tap()
            page.get_by_text("1 to go").wait_for()
            page.locator("#trials canvas").first.wait_for()
            drawn = page.locator("#trials canvas").first.evaluate(DRAWN)
            page.keyboard.press("2")
            page.keyboard.press("3")
            page.get_by_text("every answer has arrived").wait_for()
    finally:
        started.kill()
    assert drawn > 100
    found = [row for row in rows(folder, tmp_path / "data") if row["outcome"] == "answered"]
    assert [row["response_by"] for row in found] == ["button", "key"]
    first, second = found
    assert (first["chosen_1"], first["chosen_2"]) == (first["a"], first["d"])
    assert (second["chosen_1"], second["chosen_2"]) == (second["b"], second["c"])


SOON = """const real = window.setTimeout;
window.setTimeout = (call, ms, ...rest) => real(call, ms > 100000 ? 300 : ms, ...rest);"""
"""Two minutes are over soon."""

LEFT = """new Promise((done) => {
    const opening = indexedDB.open("eigenwalker-experiment");
    opening.onsuccess = () => {
        const database = opening.result;
        const counting = database.transaction("items").objectStore("items").count();
        counting.onsuccess = () => (database.close(), done(counting.result));
    };
})"""
"""How many items are in the outbox of this machine."""


def test_a_session_ends_without_a_network_and_the_next_observer_of_the_machine_sends_what_is_left(
    browser: Browser, server: Server, run_command: Callable, tmp_path: Path
) -> None:
    links = [server.link(run_command) for _ in range(2)]
    with visit(browser, links[0]) as (context, page):
        page.add_init_script(SOON)
        page.goto(links[0])
        press(page, "I have read this")
        press(page, "Begin")
        answer(page)
        context.set_offline(True)
        for _ in range(3):
            answer(page, "m")
        press(page, "Continue")
        for _ in range(8):
            answer(page)
        page.get_by_text("Still on this computer: 2").wait_for()
        with page.expect_download() as download:
            press(page, "Save my answers as a file")
        download.value.save_as(tmp_path / "answers.json")
        page.close()
        context.set_offline(False)
        other = context.new_page()
        other.set_default_timeout(10_000)
        other.goto(links[1])
        press(other, "I have read this")
        press(other, "Begin")
        answer(other)
        for _ in range(50):
            if other.evaluate(LEFT) == 0:
                break
            other.wait_for_timeout(100)
        other.get_by_role("button", name="Stop", exact=True).click()
        press(other, "keep what I gave")
        other.get_by_text("You stopped").wait_for()
    found = [row for row in rows(server.folder, tmp_path / "data") if row["observer"] == "1"]
    assert [row["trial"] for row in found if row["outcome"] == "answered"] == [
        str(n) for n in range(1, 13)
    ]
    code, said, problems = run_command(
        "experiment", "rescue", server.folder, tmp_path / "answers.json"
    )
    assert code == 0, problems
    assert "already" in said or "had" in said


def test_zoom_and_leaving_full_screen_are_asked_about(
    browser: Browser, small: Callable[..., Path], run_command: Callable, tmp_path: Path
) -> None:
    started = Server(small(blank_s="0.05", instances="1"))
    try:
        with visit(browser, started.link(run_command)) as (context, page):
            press(page, "I have read this")
            page.locator("#card-size").focus()
            page.keyboard.press("ArrowRight")
            card = page.locator(".card").bounding_box()
            press(page, "fits my card")
            page.get_by_label("Distance").fill("60")
            press(page, "Continue")
            press(page, "Begin")
            page.locator("#trials button:enabled").first.wait_for()
            size = page.locator("#trials canvas").bounding_box()
            assert card is not None
            assert size is not None
            wanted = 512 * (card["width"] / 8.56) * 60 / (38 * 57)
            assert size["width"] == pytest.approx(wanted, rel=0.01)
            answer(page)
            page.evaluate("document.exitFullscreen()")
            answer(page)
            press(page, "Go on in this window")
            devices = context.new_cdp_session(page)
            screen = {"width": 900, "height": 700, "deviceScaleFactor": 1.5, "mobile": False}
            devices.send("Emulation.setDeviceMetricsOverride", screen)
            answer(page)
            press(page, "Tell the size again")
            press(page, "I have no card")
            press(page, "I do not know")
            page.locator("#trials button:enabled").first.wait_for()
            size = page.locator("#trials canvas").bounding_box()
            assert size is not None
            assert size["width"] == pytest.approx(512, abs=1)
            answer(page)
    finally:
        started.kill()


NEW_TASKS = """
[[blocks]]
task = "same_different"
trials = 2
practice = true
feedback = true

[[blocks]]
task = "odd_one_out"
trials = 3
break_every = 2

[[blocks]]
task = "adjustment"
trait = "sex"
steps = 5
instances = 1
"""


def test_same_or_different_the_odd_one_and_settings_are_answered_by_touch_and_by_keys(
    browser: Browser, small: Callable[..., Path], run_command: Callable, tmp_path: Path
) -> None:
    folder = small("same_different", blank_s="0.05", measure="false", full_screen="false")
    design = folder / "design.toml"
    head, _, rest = design.read_text(encoding="utf-8").partition("[[blocks]]")
    tail = rest[rest.index("[pace]") :]
    design.write_text(head + NEW_TASKS + tail, encoding="utf-8")
    with (folder / "texts" / "en.md").open("a", encoding="utf-8") as file:
        file.write("\n\n# figure\nFigure {number}\n")
    code, _, problems = run_command("experiment", "stimuli", folder)
    assert code == 0, problems
    started = Server(folder)
    try:
        with visit(browser, started.link(run_command), has_touch=True) as (_, page):
            press(page, "I have read this")
            press(page, "Begin")
            for _ in range(2):
                page.get_by_role("button", name="Same (S)").tap()
                page.locator(".feedback").wait_for()
            press(page, "Continue")
            page.get_by_role("button", name="Figure 2").tap()
            answer(page, "1")
            press(page, "Continue")  # the break within the block
            answer(page, "3")
            press(page, "Continue")
            page.locator("#trials input:enabled").wait_for()
            page.locator("#trials input").evaluate("slider => (slider.value = 0)")
            page.keyboard.press("ArrowRight")
            page.keyboard.press("Enter")
            page.get_by_text("every answer has arrived").wait_for()
    finally:
        started.kill()
    found = rows(folder, tmp_path / "data")
    assert [row["response"] for row in found] == ["same", "same", "1", "0", "2", "-3"]
    assert [row["response_device"] for row in found] == [*["touch"] * 3, *["keyboard"] * 3]
    assert {row["correct"] for row in found[:2]} == {"0", "1"}
    assert float(found[5]["setting"]) == -3
