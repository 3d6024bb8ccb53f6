"""Predictions and gait parameters of captures."""

from __future__ import annotations

import json
from pathlib import Path

import pandas as pd
import pytest

import eigenwalker as ew
from eigenwalker.simulation import simulate_population, simulate_walk


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("new")
    for seed, name in enumerate(["S1_a", "S1_b", "S7_a"]):
        ew.write_mocap(simulate_walk(seed=seed, rate_hz=60), folder / f"{name}.c3d")
    (folder / "none.c3d").write_text("nothing")
    return folder


def test_predictions_name_refused_files_and_people_who_were_learnt_from(
    folder, tmp_path, run_command
) -> None:
    people = simulate_population(6, 6, seed=4)
    traits = people.traits.assign(subject=[f"S{row}" for row in range(12)])
    path = ew.Population(people.walkers, traits).save(tmp_path / "people.nc")
    output = tmp_path / "new.csv"
    code, printed, errors = run_command(
        "predict", path, folder, "--trait", "sex", "-o", output, "--jobs", 1
    )
    table = pd.read_csv(output).set_index("file")
    assert code == 1
    assert table.loc["none.c3d", "status"] == "refused"
    assert "C3D" in table.loc["none.c3d", "reason"]
    assert table.loc["S1_a.c3d", "prediction"] in ("female", "male")
    assert table.loc["S7_a.c3d", "person_known"] == "S7"
    assert "are misclassified" in printed
    assert "learnt from the same people" in errors
    stored = json.loads(output.with_suffix(".json").read_text())
    assert 0 <= stored["error"] <= 1
    assert len(stored["predictions"]) == 4


def test_parameters_of_a_folder_have_units_means_and_reasons(folder, tmp_path, run_command) -> None:
    output = tmp_path / "gait.csv"
    pattern = "(?P<subject>S[0-9])_"
    named = ["S1_a.c3d", "S1_b.c3d", "S7_a.c3d", "none.c3d"]
    about = {"file": named, "Height (cm)": 175, "age_years": 42}
    traits = tmp_path / "traits.csv"
    pd.DataFrame(about).to_csv(traits, index=False)
    options = ["--trait-from-name", pattern, "--traits", traits, "--jobs", 1]
    code, _, errors = run_command("parameters", folder, "-o", output, *options)
    assert code == 1
    assert "refused: none.c3d: expected a C3D file" in errors
    table = pd.read_csv(output).set_index("file")
    assert table.loc["none.c3d", "status"] == "refused"
    walks = table.drop(index="none.c3d")
    assert walks["cadence_steps_min"].between(70, 140).all()
    assert (walks["stance_share_left"] + walks["swing_share_left"]).round(6).eq(100).all()
    persons = pd.read_csv(tmp_path / "gait-persons.csv").set_index(["person", "parameter"])
    first = persons.loc[("S1", "step_width_mm")]
    assert first["walks"] == 2
    assert first["mean"] == pytest.approx(walks["step_width_mm"][:2].mean())
    assert first["unit"] == "mm"
    book = pd.read_csv(tmp_path / "gait-codebook.csv")
    assert book["column"].tolist() == list(pd.read_csv(output, nrows=0))
    units = book.set_index("column")["unit"]
    assert (units["Height (cm)"], units["age_years"]) == ("cm", "years")
    assert len(json.loads((tmp_path / "gait.json").read_text())["files"]) == 4


def test_captures_of_which_none_can_be_read_end_with_2(folder, tmp_path, run_command) -> None:
    people = simulate_population(4, 4, seed=4)
    traits = people.traits.rename(columns={"sex": "Sex"})
    path = ew.Population(people.walkers, traits).save(tmp_path / "people.nc")
    code, printed, errors = run_command("predict", path, folder / "none.c3d", "--jobs", 1)
    assert code == 2
    assert "refused" in printed
    assert "Sex is told" in errors
    assert "Traceback" not in errors


def test_files_of_several_folders_are_called_as_they_were_named(folder, tmp_path) -> None:
    (tmp_path / "none.c3d").write_text("nothing")
    files = [folder / "none.c3d", tmp_path / "none.c3d"]
    told = ew.study.predict_captures(simulate_population(4, 4, seed=4), "sex", files, n_jobs=1)
    assert told.table["file"].tolist() == [path.as_posix() for path in files]


def test_a_capture_that_is_one_of_the_population_is_said_to_be(
    folder, tmp_path, run_command
) -> None:
    people = simulate_population(4, 4, seed=4)
    result = ew.study.process_capture(folder / "S1_a.c3d")
    walkers = [people.walker(people.vector(result.walker)), *people.walkers[1:]]
    path = ew.Population(walkers, people.traits, people.correspondence).save(tmp_path / "p.nc")
    code, printed, errors = run_command("predict", path, folder / "S1_a.c3d", "--jobs", 1)
    assert code == 0
    assert "this capture" in printed
    assert "themselves among the walkers learnt from" in errors
