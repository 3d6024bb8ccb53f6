"""Each file of the corpus is refused or flagged, with its message; nothing is accepted silently."""

from __future__ import annotations

import re
import warnings
from pathlib import Path

import pytest

from corpus.bad_file import BadFile, person
from corpus.make_bad_files import BAD_FILES, main
from corpus.sound_files import KINDS, c3d_file, sound_files
from eigenwalker.core.skeleton import JOINTS
from eigenwalker.datasets.bml import read_bml_axes
from eigenwalker.datasets.moler import read_walkers_mat
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.read import read_mocap
from eigenwalker.io.readers.mat import read_mat
from eigenwalker.population.population import Population
from eigenwalker.study.fit_folder import fit_folder
from eigenwalker.study.inspect import inspect_file

DOORS = {
    "population": Population.load,
    "mat": lambda path: read_mat(path, "walk", markers=JOINTS.markers, rate_hz=25),
    "walkers.mat": read_walkers_mat,
    "bml": read_bml_axes,
}


def _said_of(bad: BadFile, path: Path) -> tuple[str, str]:
    """Return how a file ended, "refused", "flagged" or "used", and all that was said of it."""
    try:
        if bad.door == "capture":
            facts = inspect_file(path)
            problems = facts["problems"]
            assert isinstance(problems, list)
            return ("flagged" if problems else "used"), " ".join(map(str, problems))
        if bad.door == "table of traits":
            files = fit_folder(path.parent / "captures", traits=path, n_jobs=1).files
            assert files["status"].tolist() == ["used", "refused"]
            return "refused", files["reason"].iloc[-1]
        DOORS[bad.door](path)
    except UnreadableFile as error:
        return "refused", str(error)
    except ValueError as error:
        assert bad.door == "table of traits"
        return "refused", str(error)
    return "used", ""


@pytest.mark.parametrize("bad", BAD_FILES, ids=lambda bad: bad.name)
def test_what_is_bad_is_said(bad, tmp_path) -> None:
    ending, said = _said_of(bad, bad.make(tmp_path))
    assert ending == bad.ending, said
    assert re.search(bad.said, said), said
    assert len(said) < 2000
    assert said.isprintable()
    assert not re.search(r"(^|[ (\[=])b['\"]", said)
    assert said.rstrip().endswith(".")


def test_there_are_two_hundred_bad_files_of_different_names() -> None:
    assert len({bad.name for bad in BAD_FILES}) == len(BAD_FILES) >= 200


@pytest.mark.filterwarnings("ignore::eigenwalker.io.UnitGuessed")
@pytest.mark.filterwarnings("ignore::eigenwalker.io.RateAssumed")
@pytest.mark.parametrize("kind", sorted(set(KINDS) - {"mat", "population", "bml", "stimulus"}))
def test_the_sound_files_that_they_are_made_of_are_read(kind, tmp_path) -> None:
    for files in sound_files(kind):
        for name, content in files.items():
            (tmp_path / name).write_bytes(content)
        assert read_mocap(tmp_path / next(iter(files))).sizes["time"] == 12


def test_the_walk_that_they_are_made_of_is_for_use(tmp_path) -> None:
    (tmp_path / "a.c3d").write_bytes(c3d_file(person()))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        facts = inspect_file(tmp_path / "a.c3d")
    assert (facts["verdict"], facts["problems"]) == ("use", [])


def test_the_corpus_can_be_written_into_a_folder(tmp_path, capsys) -> None:
    main(tmp_path / "bad")
    rows = (tmp_path / "bad" / "expected.tsv").read_text(encoding="utf-8").splitlines()
    assert len(rows) == len(BAD_FILES) + 1
    assert f"{len(BAD_FILES)} bad files" in capsys.readouterr().out
