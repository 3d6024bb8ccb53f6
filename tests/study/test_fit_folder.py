"""From a folder of captures to a population, with bad files among good ones."""

from __future__ import annotations

import json
import os
import signal
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from eigenwalker.analysis.classification import classify
from eigenwalker.simulation.people import simulate_captures
from eigenwalker.study.checkpoint import Checkpoint
from eigenwalker.study.fit_folder import fit_folder
from eigenwalker.study.process_capture import process_capture

fitting = sys.modules["eigenwalker.study.fit_folder"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory, write_c3d) -> Path:
    """Six walks, one of them cut short, one of them no walk; and a file of another kind."""
    folder = tmp_path_factory.mktemp("captures")
    (folder / "men").mkdir()
    for number, (walk, person) in enumerate(simulate_captures(3, 3, seed=4)):
        where = folder / "men" if person["sex"] == "male" else folder
        write_c3d(where / f"{person['sex']}_{number}.c3d", walk)
    whole = (folder / "female_1.c3d").read_bytes()
    (folder / "female_1.c3d").write_bytes(whole[: len(whole) // 2])
    still = walk - walk + walk.isel(time=0)
    write_c3d(folder / "female_2.c3d", still.transpose("time", "marker", "axis"))
    (folder / "notes.txt").write_text("not a capture")
    return folder


def test_bad_files_stop_no_others_and_are_named_with_the_reason(folder) -> None:
    study = fit_folder(folder, n_jobs=1)
    assert study.population is not None
    assert len(study.population) == 4
    assert study.files["file"].tolist() == [
        "female_0.c3d", "female_1.c3d", "female_2.c3d",
        "men/male_3.c3d", "men/male_4.c3d", "men/male_5.c3d",
    ]  # fmt: skip
    refused = study.refused.set_index("file")["reason"]
    assert set(refused.index) == {"female_1.c3d", "female_2.c3d"}
    assert "frames" in refused["female_1.c3d"]
    used = study.files[study.files["status"] == "used"]
    assert (used["r2"] > 0.9).all()
    assert used["strides"].between(7, 12).all()


def test_a_table_says_who_is_who_and_which_files_count(folder, tmp_path) -> None:
    table = pd.DataFrame(
        {
            "file": ["men/male_3.c3d", "female_0.c3d", "men/nobody.c3d"],
            "sex": ["male", "female", "male"],
            "weight_kg": [80, 60, np.nan],
        }
    )
    table.to_csv(tmp_path / "people.csv", index=False)
    study = fit_folder(folder, traits=tmp_path / "people.csv", n_jobs=1)
    assert study.population is not None
    assert study.population.traits["sex"].tolist() == ["male", "female"]
    assert study.population.traits["weight_kg"].tolist() == [80, 60]
    assert "nothing of that name" in study.refused["reason"].item()


def test_a_pattern_takes_traits_from_names(folder) -> None:
    study = fit_folder(folder, trait_from_name=r"(?P<sex>female|male)_(?P<number>\d)", n_jobs=1)
    assert study.population is not None
    assert study.population.traits["sex"].tolist() == ["female", "male", "male", "male"]
    assert study.population.traits["number"].tolist() == [0, 3, 4, 5]


def test_processes_and_progress_change_nothing(folder) -> None:
    steps = []
    alone = fit_folder(folder, n_jobs=1, progress=lambda done, total: steps.append((done, total)))
    together = fit_folder(folder, n_jobs=2)
    assert steps == [(done, 6) for done in range(1, 7)]
    assert alone.population is not None
    assert together.population is not None
    np.testing.assert_array_equal(alone.population.X, together.population.X)
    pd.testing.assert_frame_equal(alone.files, together.files)


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"traits": pd.DataFrame({"name": ["a"]})}, "needs a column 'file'"),
        ({"traits": pd.DataFrame({"file": ["a", "a"]})}, "more than once"),
        ({"traits": pd.DataFrame({"file": ["a", None], "x": [1, 2]})}, "Row 2 of the traits table"),
        ({"traits": pd.DataFrame({"file": ["a"], "x": [1], "x ": [1]})}, r"columns \['x'\] more"),
        ({"traits": "nowhere.csv"}, r"nowhere\.csv could not be read"),
        ({"trait_from_name": "("}, "no regular expression"),
        ({"trait_from_name": "walk"}, "no named group"),
        ({"trait_from_name": "(?P<x>zebra)"}, "matches no file name"),
    ],
)
def test_tables_and_patterns_that_make_no_sense_are_refused(folder, wrong, said) -> None:
    with pytest.raises(ValueError, match=said):
        fit_folder(folder, **wrong)


def test_no_path_leads_out_of_the_folder(folder) -> None:
    table = pd.DataFrame({"file": ["../../etc/passwd", "/etc/passwd", "men/../female_0.c3d"]})
    study = fit_folder(folder, traits=table, n_jobs=1)
    assert study.files["status"].tolist() == ["refused", "refused", "used"]
    assert "leads out of the folder" in study.files["reason"][0]


def test_an_empty_folder_and_no_folder_are_refused(tmp_path) -> None:
    with pytest.raises(ValueError, match=r"no captures \(.*\*\.bvh, \*\.c3d"):
        fit_folder(tmp_path)
    with pytest.raises(ValueError, match="is no folder"):
        fit_folder(tmp_path / "none")


def test_acted_styles_of_bandai_namco_are_told_apart(captures) -> None:
    """The issue's own check: all 175 read, steady strides found, acted styles told apart."""
    study = fit_folder(captures / "bandai-namco", trait_from_name="walk_(?P<style>[a-z]+)_")
    assert study.population is not None
    assert len(study.population) == 175
    assert len(study.refused) == 0
    assert study.files["r2"].median() >= 0.96
    found = classify(study.population, "style=feminine:masculine", n_permutations=0)
    assert found.results[0].curves.fewest_errors == 0


@pytest.mark.filterwarnings("ignore::eigenwalker.io.UnitGuessed")
@pytest.mark.parametrize(("name", "r2"), [("02_01.c3d", 0.97), ("12_01.bvh", 0.94)])
def test_real_captures_reach_the_share_explained_of_the_prototype(captures, name, r2) -> None:
    walker = process_capture(captures / "cmu" / name, form="fourier").walker
    assert walker.fit is not None
    assert walker.fit.fourier_r2 == walker.fit.r2 >= r2


def test_an_interrupted_run_goes_on_where_it_stopped(folder, tmp_path, monkeypatch) -> None:
    checkpoint = tmp_path / "people.nc.part"

    def interrupted(done: int, _total: int) -> None:
        if done == 4:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fit_folder(folder, n_jobs=1, checkpoint=checkpoint, progress=interrupted)
    with checkpoint.open("a") as file:
        file.write('{"file": "female_2.c3d", "state"')  # as a power cut leaves it
    read = []
    monkeypatch.setattr(
        fitting, "process_capture", lambda path, **how: (read.append(path), made(path, **how))[1]
    )
    made = process_capture
    again = fit_folder(folder, n_jobs=1, checkpoint=checkpoint)
    assert [path.name for path in read] == [
        "female_1.c3d", "female_2.c3d", "male_4.c3d", "male_5.c3d",
    ]  # fmt: skip
    monkeypatch.undo()
    at_once = fit_folder(folder, n_jobs=1)
    assert again.population is not None
    assert at_once.population is not None
    np.testing.assert_array_equal(again.population.X, at_once.population.X)
    pd.testing.assert_frame_equal(again.files, at_once.files)
    pd.testing.assert_frame_equal(again.population.traits, at_once.population.traits)


def test_what_has_changed_is_read_again(folder, tmp_path) -> None:
    checkpoint, path = tmp_path / "people.nc.part", tmp_path / "in" / "a.c3d"
    path.parent.mkdir()
    path.write_bytes((folder / "female_0.c3d").read_bytes())
    first = fit_folder(path.parent, n_jobs=1, checkpoint=checkpoint)
    fourier = fit_folder(path.parent, n_jobs=1, checkpoint=checkpoint, form="fourier")
    path.write_bytes((folder / "men" / "male_3.c3d").read_bytes())
    changed = fit_folder(path.parent, n_jobs=1, checkpoint=checkpoint)
    assert first.population is not None
    assert fourier.population is not None
    assert changed.population is not None
    assert fourier.population.walkers[0].form == "fourier"
    assert not np.array_equal(first.population.X, changed.population.X)


@pytest.fixture(scope="module")
def kept(folder, tmp_path_factory) -> Path:
    """Return the checkpoint of one capture."""
    checkpoint = tmp_path_factory.mktemp("kept") / "people.nc.part"
    fit_folder(folder, traits=pd.DataFrame({"file": ["female_0.c3d"]}), checkpoint=checkpoint)
    return checkpoint


@pytest.mark.parametrize("damage", ["", "[]\n", "{}\n", "\x00\xff\n", '{"file": "female_0.c3d"}\n'])
def test_a_damaged_checkpoint_costs_time_and_nothing_else(folder, kept, tmp_path, damage) -> None:
    checkpoint = tmp_path / "people.nc.part"
    checkpoint.write_text(damage, encoding="latin-1")
    study = fit_folder(
        folder, traits=pd.DataFrame({"file": ["female_0.c3d"]}), n_jobs=1, checkpoint=checkpoint
    )
    assert study.population is not None
    assert study.n_resumed == 0
    assert checkpoint.read_bytes() == kept.read_bytes()


def test_what_does_not_hold_in_a_checkpoint_is_not_taken(folder, kept, tmp_path) -> None:
    """Every bit of the head, the checksum and a sample of the rest; and every digit there."""
    settings = json.loads(kept.read_bytes().splitlines()[0])["settings"]
    state = fitting._state(folder, "female_0.c3d")
    content, damaged = kept.read_bytes(), tmp_path / "damaged.part"
    assert Checkpoint(kept, folder, settings).get("female_0.c3d", state)
    begins = content.index(b"\n") + 80
    for place in [*range(begins), *range(begins, len(content) - 1, 97)]:
        changed = [content[place] ^ 1 << bit for bit in (place % 8, (place + 3) % 8)]
        if 48 <= content[place] < 58:
            changed.append(48 + (content[place] - 47) % 10)
        for byte in changed:
            damaged.write_bytes(content[:place] + bytes([byte]) + content[place + 1 :])
            found = Checkpoint(damaged, folder, settings).get("female_0.c3d", state)
            assert found is None, place
    assert Checkpoint(kept, folder.parent, settings).get("female_0.c3d", state) is None
    assert Checkpoint(kept, folder, settings | {"form": "x"}).get("female_0.c3d", state) is None


def test_a_full_disk_ends_the_checkpoint_and_not_the_fit(folder, tmp_path) -> None:
    names = pd.DataFrame({"file": ["female_0.c3d"]})
    (tmp_path / "people.nc.part").mkdir()  # in whose place no file can be written
    with pytest.warns(UserWarning, match="starts from the beginning if it is interrupted"):
        study = fit_folder(folder, traits=names, n_jobs=1, checkpoint=tmp_path / "people.nc.part")
    assert study.population is not None


def test_a_process_ended_by_the_system_costs_its_own_capture_alone(folder, monkeypatch) -> None:
    def killed(where: Path, name: str, *others, made=fitting._outcome):
        if name == "men/male_4.c3d":
            os.kill(os.getpid(), signal.SIGKILL)
        return made(where, name, *others)

    monkeypatch.setattr(fitting, "_outcome", killed)
    names = pd.DataFrame({"file": ["female_1.c3d", "men/male_4.c3d", "men/male_5.c3d"]})
    found = fit_folder(folder, traits=names, n_jobs=2)
    reasons = found.refused.set_index("file")["reason"]
    assert reasons.index.tolist() == ["female_1.c3d", "men/male_4.c3d"]
    assert reasons.str.contains("memory runs out").tolist() == [False, True]
    assert found.files.set_index("file")["status"]["men/male_5.c3d"] == "used"
