"""Every feature of a stimulus in every kind of file, as the table in the docs has it."""

from __future__ import annotations

import re
import warnings
from pathlib import Path

import pytest

import eigenwalker as ew
from eigenwalker.stimulus import Figure, Stimulus, make_stimulus, write_stimulus
from eigenwalker.stimulus.targets import features_of
from eigenwalker.stimulus.write_stimulus import SUFFIXES

DOCS = Path(__file__).parents[2] / "docs" / "stimuli.md"
SMALL = {"size_px": (64, 64), "duration_s": 0.1, "rate_hz": 20}


def table() -> dict[str, dict[str, str]]:
    """Of the docs: what becomes of a feature, by its name and the suffix."""
    text = DOCS.read_text(encoding="utf-8").partition("## What each kind of file shows")[2]
    head, _, *rows = (
        [cell.strip() for cell in line.strip("|").split("|")]
        for line in re.findall(r"(?m)^\|.*\|$", text.partition("\n## ")[0])
    )
    return {row[0]: dict(zip(head[1:], row[1:], strict=True)) for row in rows}


@pytest.fixture(scope="module")
def with_features() -> dict[str, Stimulus]:
    people = ew.load_population()
    one, other = people.walkers[:2]
    plain = make_stimulus(one, **SMALL)
    return {
        "": plain,
        "sticks": make_stimulus(one, style="sticks", **SMALL),
        "mannequin": make_stimulus(one, style="mannequin", **SMALL),
        "blur": plain.then("blur", sd_px=3),
        "hidden dots": plain.then("occlude", parts="legs"),
        "masks": plain.then("mask", number=9, seed=1),
        "further figures": make_stimulus([one, Figure(other, position_mm=(0, 900, 0))], **SMALL),
        "limb dots": plain.then("limb_dots", number=9, lifetime_s=0.1, seed=1),
    }


def test_the_table_has_all_features_and_all_kinds_of_files(with_features):
    rows = table()
    assert [{"", *rows}, *map(set, rows.values())] == [
        set(with_features),
        *[set(SUFFIXES)] * len(rows),
    ]
    for name, stimulus in with_features.items():
        assert features_of(stimulus) == ([name] if name not in ("", "limb dots") else [])


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_what_a_file_does_not_show_is_said_or_refused(suffix, with_features, tmp_path):
    plain = write_stimulus(with_features[""], tmp_path / f"plain{suffix}")
    shown = plain.with_suffix(".npz") if suffix == ".py" else plain  # the script's dots
    for feature, row in table().items():
        path = tmp_path / f"one{suffix}"
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            try:
                write_stimulus(with_features[feature], path)
                refused = ""
            except ValueError as error:
                refused = str(error)
        texts = [str(each.message) for each in said]
        found = {(True, False): "refused", (False, True): "left out", (False, False): "yes"}
        assert found[bool(refused), bool(texts)] == row[suffix], feature
        assert all(feature in text for text in texts)
        if row[suffix] == "refused" and suffix == ".py":
            assert feature in refused
            assert "MovieStim" in refused
            assert not path.exists()
        elif row[suffix] == "yes":
            written = path.with_suffix(".npz") if suffix == ".py" else path
            assert written.read_bytes() != shown.read_bytes(), feature
