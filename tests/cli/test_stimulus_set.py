"""``eigenwalker stimulus --conditions``: a set of stimuli from a table."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from eigenwalker.analysis import trait_axis
from eigenwalker.datasets import load_population
from eigenwalker.stimulus import Stimulus

ROWS = (
    ("name", "Trait", "view", "--invert", "scramble", "height-deg"),
    ("man", "sex=3", "30", "", "", "5"),
    ("woman", "sex=-3", "0", "yes", "", ""),
    ("both", "sex=1;weight=-2", "90", "no", "seed=3", ""),
)


@pytest.fixture
def run(run_command, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    return partial(run_command, "stimulus", "--conditions")


def write(rows, path="conditions.csv"):
    Path(path).write_text("\n".join(",".join(row) for row in rows), encoding="utf-8")
    return path


def content(path):
    made = json.loads(Path(path).read_text(encoding="utf-8"))
    del made["provenance"]
    return made


def test_each_row_is_the_stimulus_that_its_options_make(run, run_command):
    code, said, complaint = run(write(ROWS), "-o", "set", "--rate", "50")
    assert (code, "3 stimuli" in said) == (0, True), complaint
    table = pd.read_csv("set/stimuli.csv", dtype=str)
    assert table["file"].tolist() == ["man.json", "woman.json", "both.json"]
    assert table["Trait"].tolist() == [row[1] for row in ROWS[1:]]
    typed = {
        "man": ("--trait", "sex=3", "--view", "30", "--height-deg", "5"),
        "woman": ("--trait", "sex=-3", "--view", "0", "--invert"),
        "both": (
            "--trait",
            "sex=1",
            "--trait",
            "weight=-2",
            "--view",
            "90",
            "--scramble",
            "seed=3",
        ),
    }
    for name, words in typed.items():
        assert run_command("stimulus", *words, "--rate", "50", "-o", "one.json")[0] == 0
        assert content("one.json") == content(f"set/{name}.json")


def test_a_workbook_is_a_table_and_rows_without_names_are_numbered(run):
    book = pytest.importorskip("openpyxl").Workbook()
    for row in (("trait", "duration"), ("sex=2", 2), ("sex=-2", 2.5)):
        book.active.append(row)
    book.save("conditions.xlsx")
    assert run("conditions.xlsx", "-o", "set")[0] == 0
    made = [Stimulus.load(f"set/stimulus_00{number}.json") for number in (1, 2)]
    assert [each.timing.duration_s for each in made] == [2, 2.5]
    assert run("conditions.xlsx", "-o", "set")[0] == 0
    Path("set/stimuli.csv").write_text("by hand")
    assert "changed since: stimuli.csv" in run("conditions.xlsx", "-o", "set")[2]
    assert run("conditions.xlsx")[0] == 0
    assert Path("stimuli/stimulus_001.json").is_file()


@pytest.mark.parametrize(
    ("row", "column", "cell", "sentence"),
    [
        (0, 2, "veiw", "the column 'veiw' is no option of stimulus; did you mean 'view'"),
        (0, 2, "people", "the column 'people' is no option"),
        (3, 2, "ninety", "conditions.csv, line 4: .*--view"),
        (2, 1, "sax=-3", "line 3 .woman.json.: There is no trait 'sax'"),
        (2, 3, "maybe", "line 3: --invert is yes or no, got 'maybe'"),
        (2, 0, "man", "line 3: another row is called 'man.json' too"),
        (2, 0, "stimuli.csv", "line 3: stimuli.csv says which stimulus is which"),
        (2, 0, "../man", "line 3: '../man' is no name for a file"),
    ],
)
def test_what_is_wrong_is_refused_with_its_row_and_nothing_is_written(
    run, row, column, cell, sentence
):
    rows = [list(each) for each in ROWS]
    rows[row][column] = cell
    code, said, complaint = run(write(rows), "-o", "set")
    assert code != 0
    assert said == ""
    with pytest.raises(ValueError, match=sentence):
        raise ValueError(complaint)
    assert not Path("set").exists()


def test_size_is_divided_out_of_traits_unless_it_is_kept(run_command, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    heights, people = {}, load_population()
    for words in ((), ("--keep-size",)):
        for sign in (-6, 6):
            command = ("stimulus", "--trait", f"sex={sign}", *words, "-o", "one.json")
            assert run_command(*command)[0] == 0
            made = Stimulus.load("one.json")
            posture = made.figures[0].motion.p0
            heights[words, sign] = np.ptp(posture[:, 2])
            assert made.provenance["size"] == ("kept" if words else "divided out")
    kept, out = heights[("--keep-size",), -6], heights[(), -6]
    assert kept < 0.9 * out
    assert heights[(), 6] == pytest.approx(out, rel=0.03)
    normalised = people.size_normalised()
    woman = normalised.average - 6 * trait_axis(normalised, "sex").step
    expected = np.ptp(normalised.walker(woman).p0[:, 2])
    assert out == pytest.approx(expected)
