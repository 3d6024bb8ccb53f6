"""What a stimulus is written as: opened again, by other programs where there are any."""

from __future__ import annotations

import ast
import sys
import types
import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path

import av
import numpy as np
import pandas as pd
import pytest
from matplotlib.image import imread
from scipy.io import loadmat

from eigenwalker.core.walker import Walker
from eigenwalker.stimulus.make import make_stimulus
from eigenwalker.stimulus.position_tables import psychopy_script
from eigenwalker.stimulus.stimulus import Stimulus
from eigenwalker.stimulus.write_stimulus import write_stimulus


def three_dots() -> Walker:
    p0 = [[0, 0, 1600], [0, 200, 100], [0, -200, 100]]
    p = [[[0, 40, 0], [250, 0, 0], [-250, 0, 0]], [[0, 0, 30], [0, 0, 60], [0, 0, 60]]]
    return Walker(("head", "left_ankle", "right_ankle"), p0, p, [1, 2], [0, 0.7], 0.84)


@pytest.fixture(scope="module")
def shown() -> Stimulus:
    made = make_stimulus(three_dots(), azimuth_deg=30, duration_s=1, rate_hz=25, size_px=(301, 240))
    return made.then("start", phase_deg=200)


def light_at(frame: np.ndarray, near: np.ndarray, reach: int = 8) -> np.ndarray:
    """Where the light around a place is, in pixels from the upper left corner."""
    column, row = np.floor(near).astype(int)
    rows, columns = np.mgrid[row - reach : row + reach + 1, column - reach : column + reach + 1]
    light = frame[rows, columns].astype(float)
    light[light < 40] = 0
    return np.array([(light * columns).sum(), (light * rows).sum()]) / light.sum() + 0.5


@pytest.mark.parametrize("suffix", [".mp4", ".webm", ".gif"])
def test_dots_of_films_are_where_the_numbers_say(shown, tmp_path, suffix):
    path = write_stimulus(shown, tmp_path / f"film{suffix}")
    with av.open(str(path)) as film:
        frames = [frame.to_ndarray(format="gray") for frame in film.decode(video=0)]
        assert film.duration / av.time_base == pytest.approx(1, abs=0.011)
    assert len(frames) == 25
    table = pd.read_csv(write_stimulus(shown, tmp_path / "dots.csv"))
    for row in table.iloc[::7].itertuples():
        near = np.array([row.x_px, row.y_px])
        assert np.abs(light_at(frames[row.frame], near) - near).max() < 0.5


def test_a_gif_lasts_as_long_whatever_the_rate(tmp_path):
    made = make_stimulus(three_dots(), duration_s=1.37, rate_hz=60, size_px=(64, 64))
    with av.open(str(write_stimulus(made, tmp_path / "film.gif"))) as film:
        assert film.duration / av.time_base == pytest.approx(1.37, abs=0.001)


def test_frames_and_drawings_show_the_same_dots(shown, tmp_path):
    folder = write_stimulus(shown, tmp_path / "frames")
    names = sorted(path.name for path in folder.iterdir())
    assert (len(names), names[0]) == (25, "frame_0000.png")
    frame = imread(folder / names[0])[..., 0] * 255
    assert frame.shape == (240, 301)
    circles = ET.fromstring(write_stimulus(shown, tmp_path / "one.svg").read_text()).findall(
        "{*}circle"
    )
    assert len(circles) == 3
    for circle in circles:
        near = np.array([float(circle.get("cx", "")), float(circle.get("cy", ""))])
        assert np.abs(light_at(frame, near) - near).max() < 0.1
    assert (imread(write_stimulus(shown, tmp_path / "one.png"))[..., 0] * 255 == frame).all()


def test_hidden_dots_are_not_drawn(shown, tmp_path):
    hidden = shown.then("occlude", parts="legs")
    assert write_stimulus(hidden, tmp_path / "one.svg").read_text().count("<circle") == 1
    frames = imread(write_stimulus(hidden, tmp_path / "one.png"))[..., 0]
    assert frames[120:].max() == 0


def test_colours_are_those_asked_for(tmp_path):
    made = make_stimulus(three_dots(), colour="#ff8800", background="#103060", duration_s=0.2,
                         size_px=(200, 200))  # fmt: skip
    picture = (imread(write_stimulus(made, tmp_path / "one.png"))[..., :3] * 255).round()
    assert picture[0, 0].tolist() == [0x10, 0x30, 0x60]
    assert [255, 0x88, 0] in picture.reshape(-1, 3).tolist()
    with av.open(str(write_stimulus(made, tmp_path / "film.gif"))) as film:
        frame = next(film.decode(video=0)).to_ndarray(format="rgb24")
    assert np.abs(frame.astype(int) - picture).max() <= 1


def test_a_blob_spreads_the_light_of_a_dot(tmp_path):
    still = Walker(["dot"], [[0, 0, 0]], [[[0, 0, 0]]], [1], [0], 1.0)
    made = make_stimulus(still, size_px=(200, 200)).then("blur", sd_mm=12)
    light = imread(write_stimulus(made, tmp_path / "blob.png"))[100, :, 0]
    sd = 12 * made.display.px_per_mm
    expected = np.exp(-((np.arange(200) + 0.5 - 100) ** 2) / (2 * sd**2))
    assert np.abs(light - expected).max() < 0.02


def test_tables_are_in_mm_pixels_and_degrees(shown, tmp_path):
    sized = shown.sized(5, viewing_distance_mm=570, px_per_cm=38)
    arrays = np.load(write_stimulus(sized, tmp_path / "dots.npz"))
    played = sized.play()
    np.testing.assert_allclose(arrays["mm"], played.positions)
    on_screen_mm = (arrays["px"] - [150.5, 120]) * [1, -1] / 3.8
    np.testing.assert_allclose(arrays["deg"], np.rad2deg(np.arctan(on_screen_mm / 570)))
    table = pd.read_csv(write_stimulus(sized, tmp_path / "dots.csv"))
    assert len(table) == 75
    np.testing.assert_allclose(
        table[["right_deg", "up_deg"]].to_numpy(), arrays["deg"].reshape(-1, 2), rtol=1e-6
    )
    assert Stimulus.from_json(str(arrays["stimulus"])).to_json() == sized.to_json()


def test_matlab_gets_what_drawdots_takes(shown, tmp_path):
    content = loadmat(write_stimulus(shown.then("occlude", parts="head"), tmp_path / "dots.mat"))
    assert content["xy"].shape == (2, 3, 25)
    assert np.isnan(content["xy"][:, 0]).all()
    np.testing.assert_allclose(content["xy"][:, 1, 4], content["px"][4, 1] - np.array([150.5, 120]))
    assert [str(name[0]) for name in content["dots"].ravel()] == list(three_dots().markers)


def test_the_psychopy_script_shows_every_dot(shown, tmp_path, monkeypatch):
    """Run against a stand-in that keeps what is drawn: PsychoPy needs a screen."""
    drawn = []

    class Clock:
        now = -2 / 64

        def getTime(self):  # noqa: N802 - PsychoPy's name
            Clock.now += 1 / 64
            return Clock.now

    class Dots:
        def __init__(self, win, **looks):
            self.looks = looks

        def draw(self):
            drawn.append((self.xys, self.opacities))

    psychopy = types.ModuleType("psychopy")
    psychopy.core = types.SimpleNamespace(Clock=Clock)
    psychopy.event = types.SimpleNamespace(getKeys=list)
    window = types.SimpleNamespace(flip=lambda: None, close=lambda: None)
    psychopy.visual = types.SimpleNamespace(Window=lambda **looks: window, ElementArrayStim=Dots)
    monkeypatch.setitem(sys.modules, "psychopy", psychopy)
    script = write_stimulus(shown, tmp_path / "show.py")
    exec(compile(script.read_text(), script, "exec"), {"__file__": str(script)})
    expected = shown.play().picture * shown.display.px_per_mm
    assert len(drawn) == 33
    np.testing.assert_allclose(drawn[7][0], expected[int(14 / 64 * 25)], atol=1e-9)
    np.testing.assert_allclose(drawn[-1][0], expected[24], atol=1e-9)


def test_no_name_becomes_code_of_the_psychopy_script(shown):
    hostile = Path("/tmp", 'a"""\n{x}\\' + "'''; import os\u2028\ud800.npz")
    named = replace(shown, provenance={"program": hostile.stem.replace("\ud800", "")})
    scripts = [psychopy_script(shown, Path("a.npz")), psychopy_script(named, hostile)]
    plain, other = (ast.parse(script) for script in scripts)
    assert scripts[1].isascii()
    assert [node.value for node in ast.walk(other) if isinstance(node, ast.Constant)].count(
        hostile.name
    ) == 1
    for tree in (plain, other):
        for node in ast.walk(tree):
            if isinstance(node, ast.Constant):
                node.value = None
    assert ast.dump(plain) == ast.dump(other)


def test_an_unknown_suffix_names_those_that_are(shown, tmp_path):
    with pytest.raises(ValueError, match=r"must end in one of .*\.glb"):
        write_stimulus(shown, tmp_path / "film.avi")
    with pytest.raises(FileNotFoundError, match="make it first"):
        write_stimulus(shown, tmp_path / "nowhere" / "film.gif")
