"""Golden files: what Python computes is what they say, so that the browser can be held to it."""

from __future__ import annotations

import importlib.util
import json
from pathlib import Path

import numpy as np
import pytest

from eigenwalker.stimulus.drawing import hulls_of, mannequins
from eigenwalker.stimulus.mannequin import body_heights
from eigenwalker.stimulus.random_streams import normals, permutation, random_words, uniforms
from eigenwalker.stimulus.schema import TRANSFORMS, json_schema
from eigenwalker.stimulus.stimulus import Stimulus

FOLDER = Path(__file__).parents[1] / "golden"
FILES = sorted(FOLDER.glob("stimulus_*.json"))


def read(path: Path) -> dict:
    return json.loads(path.read_text(encoding="utf-8"))


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_positions_are_those_of_the_golden_file(path):
    golden = read(path)
    played = Stimulus.from_dict(golden["stimulus"]).play(golden["times_s"])
    assert list(played.dots) == golden["dots"]
    assert played.figures.tolist() == golden["figures"]
    assert played.visible.astype(int).tolist() == golden["visible"]
    for found, wanted in (("positions", "positions_mm"), ("picture", "picture_mm")):
        np.testing.assert_allclose(
            getattr(played, found), np.array(golden[wanted], dtype=float), rtol=0, atol=1e-6
        )


def test_every_transform_has_a_golden_file():
    used = {step["name"] for path in FILES for step in read(path)["stimulus"]["transforms"]}
    assert used == set(TRANSFORMS)


def test_mannequins_are_those_of_the_golden_file():
    golden = read(FOLDER / "mannequin.json")
    stimulus = Stimulus.from_dict(golden["stimulus"])
    bodies = mannequins(stimulus)
    hulls = hulls_of(stimulus, bodies, stimulus.play([golden["time_s"]]), 0)
    balls = np.concatenate([hulls.middles, hulls.radii[..., None]], axis=2)
    np.testing.assert_allclose(balls, golden["balls"], rtol=0, atol=1e-5)
    assert hulls.tones.tolist() == golden["tones"]
    np.testing.assert_allclose(body_heights(stimulus), golden["heights_mm"])


def test_random_numbers_are_those_of_the_golden_file():
    for stream in read(FOLDER / "random.json")["streams"]:
        name = [stream[part] for part in ("purpose", "seed", "index", "life")]
        assert random_words(*name, count=8).tolist() == stream["words"]
        assert uniforms(*name, count=4).tolist() == stream["uniforms"]
        np.testing.assert_allclose(normals(*name, count=4), stream["normals"], rtol=1e-14)
        assert permutation(*name[:3], size=10).tolist() == stream["permutation_of_10"]


def test_the_published_schema_is_that_of_the_code():
    path = Path(str(importlib.util.find_spec("eigenwalker.stimulus").origin)).parent
    assert read(path / "schema.json") == json.loads(json.dumps(json_schema()))
