"""The interactive page in a real Chromium: how regular its frames are, and what they cost.

Software rendering, as where there is no graphics card; a window of 1280 x 800 pixels; a population
of a hundred. Frames are those that the browser asks the page for; at 60 Hz one takes 16.7 ms. Work
is the time the page's main thread is busy of each frame, by the browser's own account: little of it
leaves a phone cool.
"""

from __future__ import annotations

import shutil
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import Any

import numpy as np
from playwright.sync_api import CDPSession, Page, sync_playwright
from side_by_side import machine

import eigenwalker as ew
from eigenwalker.explorer import interactive_page, page_model

SECONDS = 5.0
SCENES = {
    "1 walker": "",
    "1 walker, paused": "still",
    "1 walker, sticks and trails": "as=sticks&trails=1",
    "1 walker among noise": "x=scramble,mask",
    "4 panels": "show=four",
    "100 walkers": "show=crowd",
    "100 walkers, sticks": "show=crowd&as=sticks",
    "100 walkers upside down": "show=crowd&x=invert",
}
INTERVALS = """seconds => new Promise(done => {
    const times = [];
    const frame = time => {
        times.push(time);
        if (time - times[0] < 1000 * seconds) requestAnimationFrame(frame);
        else done(times.slice(1).map((after, i) => after - times[i]));
    };
    requestAnimationFrame(frame);
})"""
"""Milliseconds between the frames of some seconds."""


def busy_s(browser: CDPSession) -> float:
    """How long the page's main thread has worked."""
    metrics = browser.send("Performance.getMetrics")["metrics"]
    return next(each["value"] for each in metrics if each["name"] == "TaskDuration")


def measure(page: Page, act: Any = None) -> tuple[np.ndarray, float]:
    """Intervals between frames, and how long the main thread works for each, in ms."""
    browser = page.context.new_cdp_session(page)
    browser.send("Performance.enable")
    before = busy_s(browser)
    start = perf_counter()
    page.evaluate(f"window.measured = ({INTERVALS})({SECONDS})")
    while act is not None and perf_counter() - start < SECONDS:
        act()
    intervals = np.array(page.evaluate("window.measured"))
    return intervals, 1e3 * (busy_s(browser) - before) / len(intervals)


def report(name: str, intervals: np.ndarray, work_ms: float) -> None:
    median, late = np.percentile(intervals, [50, 99])
    print(f"  {name:<32}{median:8.1f}{late:8.1f}{intervals.max():8.1f}{work_ms:9.2f}")


def drag(page: Page) -> Any:
    """Turn the stage to and fro."""
    page.mouse.move(400, 300)
    page.mouse.down()
    way = iter(np.tile([*range(380, 520, 7), *range(520, 380, -7)], 1000))

    def act() -> None:
        page.mouse.move(float(next(way)), 300)

    return act


def main(chromium: str) -> None:
    """Measure each scene."""
    people = ew.simulate_population(n_women=50, n_men=50, seed=1)
    with TemporaryDirectory() as folder, sync_playwright() as play:
        path = Path(folder) / "index.html"
        path.write_text(interactive_page(page_model(people)), encoding="utf-8")
        browser = play.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
        print(f"\n{'':34}  frame, ms                work")
        print(f"  {'':<32}{'median':>8}{'99 %':>8}{'longest':>8}{'ms/frame':>9}")
        for name, address in SCENES.items():
            page = opened(browser, f"{path.as_uri()}#{address}")
            report(name, *measure(page))
            page.close()
        for name, address in (("1 walker, dragged", ""), ("100 walkers, dragged", "show=crowd")):
            page = opened(browser, f"{path.as_uri()}#{address}")
            report(name, *measure(page, drag(page)))
            page.close()
        print(f"\n  first paint {first_paint_ms(browser, path.as_uri()):.0f} ms")
        browser.close()


def opened(browser: Any, address: str) -> Page:
    page = browser.new_page(viewport={"width": 1280, "height": 800})
    page.goto(address)
    page.wait_for_timeout(1000)
    return page


def first_paint_ms(browser: Any, address: str) -> float:
    """Median of five openings: milliseconds until something is seen."""
    found = []
    for _ in range(5):
        page = opened(browser, address)
        entries = "performance.getEntriesByName('first-contentful-paint').map(e => e.startTime)"
        found += page.evaluate(entries)
        page.close()
    return float(np.median(found))


if __name__ == "__main__":
    print(machine())
    if chromium := shutil.which("chromium"):
        main(chromium)
    else:
        print("There is no chromium to measure the page in; it is left out.")
