"""The gallery shows every transform, and its pictures, lines and options say the same."""

from __future__ import annotations

import importlib.util
import shlex
import sys
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest

from eigenwalker.stimulus.schema import TRANSFORMS
from eigenwalker.stimulus.stimulus import Stimulus

DOCS = Path(__file__).parents[2] / "docs"
spec = importlib.util.spec_from_file_location("draw_gallery", DOCS / "draw_gallery.py")
assert spec is not None
assert spec.loader is not None
gallery = importlib.util.module_from_spec(spec)
sys.modules["draw_gallery"] = gallery  # where a class of it looks its annotations up
spec.loader.exec_module(gallery)


@pytest.fixture(scope="module")
def names():
    return gallery.setting()


def test_every_transform_is_in_the_gallery(names):
    shown = {step["name"] for row in gallery.ROWS for step in gallery.made(row, names).transforms}
    assert shown == set(TRANSFORMS)
    assert set(TRANSFORMS) <= {row.name for row in gallery.ROWS}


def test_the_page_is_what_the_table_gives():
    assert (DOCS / "gallery.md").read_text(encoding="utf-8") == gallery.page()
    assert {row.section for row in gallery.ROWS} == set(gallery.TITLES)


def test_every_row_has_its_picture_and_no_other_is_kept():
    pictures = {path.name: path.stat().st_size for path in gallery.PICTURES.iterdir()}
    assert set(pictures) == {f"{row.name}.gif" for row in gallery.ROWS}
    assert all(2_000 < size < 160_000 for size in pictures.values())
    assert sum(pictures.values()) < 1_200_000


@pytest.mark.parametrize("row", gallery.ROWS, ids=lambda row: row.name)
def test_each_line_runs_and_shows_dots_in_the_picture(row, names):
    stimulus = gallery.made(row, names)
    played = stimulus.play([0.0, 0.6, 1.1])
    half = np.array([stimulus.display.width_px, stimulus.display.height_px]) / 2
    inside = np.abs(played.picture) * stimulus.display.px_per_mm < half
    seen = inside.all(axis=2) & played.visible
    assert seen.sum(axis=1).min() >= 7


@pytest.mark.parametrize(
    "row", [row for row in gallery.ROWS if row.options is not None], ids=lambda row: row.name
)
def test_the_options_make_the_same_stimulus_as_the_line(row, names, tmp_path, run_command):
    path = tmp_path / "stim.json"
    code, _, errors = run_command(*shlex.split(gallery.command(row.options, str(path)))[1:])
    assert code == 0, errors
    typed, line = Stimulus.load(path), gallery.made(row, names)
    for part in ("transforms", "view", "timing"):
        assert getattr(typed, part) == getattr(line, part)
    assert _rounded(typed.display) == _rounded(line.display)
    moments = [0.0, 0.6, 1.1]
    places, others = typed.play(moments).positions, line.play(moments).positions
    np.testing.assert_allclose(places, others, atol=1e-6)  # mm


def _rounded(display):
    """What a display is, but for the last digits of its sizes."""
    entries = asdict(display).items()
    return {name: round(it, 9) if isinstance(it, float) else it for name, it in entries}
