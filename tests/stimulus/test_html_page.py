"""The stand-alone page, and what a real browser draws from it."""

from __future__ import annotations

import html
import re
import shutil
import subprocess
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread
from scipy import ndimage

import eigenwalker as ew
from eigenwalker.stimulus import html_page as stand_alone
from eigenwalker.stimulus.drawing import drawn_frames, drawn_shades, places_px
from eigenwalker.stimulus.figure import Figure
from eigenwalker.stimulus.html_page import stand_alone_page
from eigenwalker.stimulus.make import make_stimulus
from eigenwalker.stimulus.stimulus import Stimulus
from eigenwalker.stimulus.write_stimulus import write_stimulus

SIZE_PX = (640, 480)
CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser"))), None)
drawn = pytest.mark.skipif(
    CHROMIUM is None, reason="chromium is not installed, so nothing is drawn"
)


def average_walker() -> ew.Walker:
    people = ew.load_population()
    return people.walker(people.average)


def shown(**options) -> Stimulus:
    stimulus = make_stimulus(average_walker(), size_px=SIZE_PX, **options)
    return replace(stimulus, display=replace(stimulus.display, dot_px=7.0))


SOFT_GL = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader")
"""WebGL without a graphics card."""


def in_chromium(page: str, folder: Path, *options: str, at: str = "") -> str:
    """What chromium says of a page."""
    assert CHROMIUM is not None
    path = folder / "page.html"
    path.write_text(page, encoding="utf-8")
    flags = ["--headless", "--no-sandbox", "--hide-scrollbars", "--no-first-run"]
    flags += [] if set(options) & set(SOFT_GL) else ["--disable-gpu"]
    flags += [f"--user-data-dir={folder / 'profile'}", "--disable-background-networking"]
    flags += [f"--window-size={SIZE_PX[0]},{SIZE_PX[1]}", "--force-device-scale-factor=1"]
    answer = subprocess.run(
        [CHROMIUM, *flags, *options, f"{path.as_uri()}#{at}"],
        capture_output=True,
        timeout=60,
        check=True,
    )
    return answer.stdout.decode()


def screenshot(stimulus: Stimulus, time_s: float, folder: Path, *options: str) -> np.ndarray:
    """How bright each pixel is, 0 to 1: the stimulus fills the window and stands still."""
    return coloured(stimulus, time_s, folder, *options).mean(axis=2)


def coloured(stimulus: Stimulus, time_s: float, folder: Path, *options: str) -> np.ndarray:
    """Red, green and blue of each pixel, 0 to 1."""
    picture = folder / "picture.png"
    in_chromium(
        stand_alone_page(stimulus),
        folder,
        f"--screenshot={picture}",
        "--virtual-time-budget=4000",  # until what is loaded on demand is there
        *options,
        at=f"t={time_s}&bare",
    )
    return np.asarray(imread(picture))[..., :3]


def in_film(stimulus: Stimulus, time_s: float) -> np.ndarray:
    """Red, green and blue, 0 to 1, as Python's films have them."""
    (numbers,) = drawn_frames(stimulus, np.array([time_s]))
    return (drawn_shades(stimulus) / 255)[numbers]


def test_the_page_loads_nothing():
    page = stand_alone_page(shown())
    assert "default-src 'none'" in page
    assert '<link rel="icon" href="data:,"' in page
    links = re.findall(r"""<[^>]*\s(?:src|href)=["']?([^"'\s>]*)""", page)
    assert [link for link in links if not link.startswith("data:")] == []
    assert len(page) < 100_000


def test_no_text_of_a_stimulus_ends_its_script():
    page = stand_alone_page(shown(provenance={"source": "</script><script>alert(1)</script><!--"}))
    assert page.count("</script>") == stand_alone_page(shown()).count("</script>")
    assert "<script>alert" not in page


def test_a_page_that_was_not_built_says_how_to_build_it(monkeypatch):
    monkeypatch.setattr(stand_alone, "PAGE", "nowhere.html")
    with pytest.raises(FileNotFoundError, match="npm run build"):
        stand_alone_page(shown())


def plain() -> Stimulus:
    return shown()


def perspective() -> Stimulus:
    return shown(azimuth_deg=70, eye_distance_mm=3000).then("invert")


def scrambled_in_noise() -> Stimulus:
    scrambled = shown().then("scramble", seed=4, box_mm=[1500, 1500])
    return scrambled.then("mask", number=20, seed=2)


def two_leaning() -> Stimulus:
    other = Figure(average_walker(), position_mm=(0, 900, 0))
    both = make_stimulus([average_walker(), other], size_px=SIZE_PX)
    return both.then("rotate", axis="sight", angle_deg=20)


@drawn
@pytest.mark.parametrize("make", [plain, perspective, scrambled_in_noise, two_leaning])
def test_dots_are_drawn_where_python_says(make: Callable[[], Stimulus], tmp_path: Path):
    stimulus, time_s = make(), 0.4
    bright = screenshot(stimulus, time_s, tmp_path)
    played = stimulus.play([time_s])
    wanted = places_px(stimulus, played)[0][played.visible[0]]
    alone = [
        place for number, place in enumerate(wanted)
        if np.delete(np.hypot(*(wanted - place).T), number).min() > stimulus.display.dot_px + 2
    ]  # fmt: skip
    labels, n_found = ndimage.label(bright > 0.02, structure=np.ones((3, 3)))  # pyright: ignore[reportGeneralTypeIssues] - two, where no output is given
    centres = ndimage.center_of_mass(bright, labels, range(1, n_found + 1))
    found = np.array(centres)[:, ::-1] + 0.5  # from the left and upper edge
    inside = [
        place for place in alone if (place > 8).all() and (place < np.array(SIZE_PX) - 8).all()
    ]
    assert len(inside) >= 11
    for place in inside:
        assert np.hypot(*(found - place).T).min() < 0.5


@drawn
@pytest.mark.parametrize("transform", ["dots", "sticks", "blur"])
def test_the_browser_draws_what_films_show(transform: str, tmp_path: Path):
    stimulus = shown(style="dots" if transform == "blur" else transform)
    if transform == "blur":
        stimulus = stimulus.then("blur", sd_mm=60)
    apart = np.abs(in_film(stimulus, 0.3).mean(axis=2) - screenshot(stimulus, 0.3, tmp_path))
    assert apart.mean() < 0.002
    assert apart.max() < 0.5  # softer edges, nothing more


def test_only_pages_of_mannequins_hold_three_dimensions():
    plain, wooden = stand_alone_page(shown()), stand_alone_page(shown(style="mannequin"))
    assert len(plain) < 60_000 < 500_000 < len(wooden) < 700_000
    assert "blob:" not in plain.split("<title>")[0]
    assert "script-src 'unsafe-inline' blob:;" in wooden
    assert wooden.count("</script>") == plain.count("</script>") + 1
    assert "<!--" not in wooden


def three_kinds() -> list[Stimulus]:
    """Level; in perspective, from above, in wood's colours; two figures, one behind the other."""
    wood = {"colour": "#c8965a", "background": "#e8f0ff"}
    other = Figure(average_walker(), position_mm=(-300, 250, 0), heading_deg=120)
    return [
        shown(style="mannequin"),
        shown(style="mannequin", eye_distance_mm=3000, elevation_deg=20, **wood),
        shown_all([average_walker(), other], style="mannequin", azimuth_deg=0).then("invert"),
    ]


def shown_all(figures, **options) -> Stimulus:
    return make_stimulus(figures, size_px=SIZE_PX, **options)


@drawn
@pytest.mark.parametrize("kind", range(3))
def test_the_browser_and_films_show_the_same_mannequin(kind: int, tmp_path: Path):
    stimulus = three_kinds()[kind]
    ground = in_film(replace(stimulus, figures=stimulus.figures[:1]), 0.3)[0, 0]
    browser, film = coloured(stimulus, 0.3, tmp_path, *SOFT_GL), in_film(stimulus, 0.3)
    one, other = (np.abs(picture - ground).max(axis=2) > 0.06 for picture in (browser, film))
    assert one.mean() > 0.02
    assert (one & other).sum() / (one | other).sum() > 0.97
    assert np.abs(browser - film)[one & other].mean() < 0.01


@drawn
def test_without_webgl_the_mannequin_is_drawn_flat(tmp_path: Path):
    stimulus = shown(style="mannequin")
    flat = screenshot(stimulus, 0.3, tmp_path, "--disable-3d-apis")
    film = in_film(stimulus, 0.3).mean(axis=2)
    assert ((flat > 0.1) & (film > 0.1)).sum() / ((flat > 0.1) | (film > 0.1)).sum() > 0.9


@drawn
def test_the_page_tells_what_it_shows(tmp_path: Path):
    words = "made by <b>us</b> </script> & others"
    stimulus = shown(provenance={"source": words}).then("invert")
    dom = in_chromium(stand_alone_page(stimulus), tmp_path, "--dump-dom", at="t=0")
    said = [html.unescape(text) for text in re.findall(r"<dd>(.*?)</dd>", dom)]
    assert words in said
    assert "invert" in said


@drawn
def test_what_cannot_be_played_is_said_in_words(tmp_path: Path):
    page = stand_alone_page(shown()).replace('"version": 1', '"version": 7')
    dom = in_chromium(page, tmp_path, "--dump-dom")
    trouble = re.search(r'<p id="trouble"[^>]*>(.*?)</p>', dom)
    assert trouble is not None
    assert "stimulus.version" in trouble[1]


def test_a_stimulus_is_written_as_a_page(tmp_path: Path):
    path = write_stimulus(shown(), tmp_path / "walker.html")
    assert path.read_text(encoding="utf-8") == stand_alone_page(shown())
