"""``eigenwalker compare``, as a person types it."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import partial
from itertools import combinations
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from eigenwalker.io.write import write_mocap
from eigenwalker.metric import PUBLISHED, pair_distances
from eigenwalker.population.population import Population
from eigenwalker.simulation.people import simulate_population
from eigenwalker.simulation.walk import simulate_walk
from eigenwalker.study.walks import walks_of_population

Typed = Callable[..., tuple[int, str, str]]


@pytest.fixture
def run(run_command: Typed) -> Typed:
    """Type ``compare`` and what follows; get its exit code, output and complaint."""
    return partial(run_command, "compare")


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    """Two walks of each of two people, the second time from elsewhere in the stride."""
    place = tmp_path_factory.mktemp("walks")
    for person in (1, 2):
        walk = simulate_walk(seed=person, duration_s=6.0, rate_hz=60, markers="skin")
        write_mocap(walk.isel(time=slice(None, 300)), place / f"person{person}_first.c3d")
        write_mocap(walk.isel(time=slice(37, None)), place / f"person{person}_second.c3d")
    return place


@pytest.fixture(scope="module")
def people(tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("people") / "people.nc"
    simulate_population(3, 3, seed=2).save(path)
    return path


def difference(said: str) -> float:
    found = re.search(r"Difference \(\S+\): ([\d.e+-]+)[,.;]", said)
    assert found, said
    return float(found[1].rstrip("."))


def test_two_walks_get_a_number_where_they_differ_and_a_report(run, folder, tmp_path):
    one, other = folder / "person1_first.c3d", folder / "person2_first.c3d"
    code, said, complaint = run(one, other, "-o", tmp_path / "report")
    assert code == 0, complaint
    assert difference(said) > 0
    assert re.search(r"more than between \d+ % of pairs of 40 simulated people", said)
    assert re.search(r"Of the difference are \w+( \w+)? \d+ %", said)
    page = (tmp_path / "report" / "report.html").read_text()
    assert page.count("<img") >= 5  # bodies, shares, two of maps, transitions
    assert "positions-sigmoid" in page
    assert "mannequin" in page
    for term in ("Distance:", "lee:", "Joint group:", "Motion map:"):
        assert f">{term}" in page


def test_the_same_person_is_nearer_than_another(run, folder):
    mine = run(folder / "person1_first.c3d", folder / "person1_second.c3d")[1]
    others = run(folder / "person1_first.c3d", folder / "person2_second.c3d")[1]
    assert difference(mine) < 0.2 * difference(others)


def test_a_walk_and_itself_do_not_differ(run, folder):
    code, said, _ = run(folder / "person1_first.c3d", folder / "person1_first.c3d")
    assert code == 0
    assert difference(said) == 0
    assert "do not differ" in said


def test_bodies_count_only_when_asked_for(run, folder):
    walks = folder / "person1_first.c3d", folder / "person2_first.c3d"
    neutral = difference(run(*walks)[1])
    own = difference(run(*walks, "--own-bodies")[1])
    assert own != neutral


def test_all_pairs_of_a_folder_become_a_table_and_a_report(run, folder, tmp_path):
    pattern = "(?P<who>person[0-9])"
    code, said, complaint = run(
        folder, "-o", tmp_path / "pairs", "--trait-from-name", pattern, "--metric", "kovar"
    )
    assert code == 0, complaint
    table = pd.read_csv(tmp_path / "pairs" / "differences.csv", index_col="walk")
    assert table.shape == (4, 4)
    assert (table.to_numpy() == table.to_numpy().T).all()
    assert "6 pairs of 4 walks by kovar" in said
    assert re.search(r"person1 +2 .* 1 +0.333\n", said)  # all have their own person as the nearest
    assert (tmp_path / "pairs" / "report.html").read_text().count("<img") == 2


def test_nearest_walks_to_a_query_come_in_order(run, folder):
    code, said, _ = run(folder, "--nearest", folder / "person2_first.c3d")
    assert code == 0
    names = re.findall(r"person\d_\w+\.c3d$", said, flags=re.MULTILINE)
    assert names[:2] == ["person2_first.c3d", "person2_second.c3d"]
    assert len(names) == 4


def test_captures_that_cannot_be_compared_are_said_and_the_others_compared(run, folder, tmp_path):
    mixed = tmp_path / "mixed"
    mixed.mkdir()
    for path in folder.glob("*_first.c3d"):
        (mixed / path.name).write_bytes(path.read_bytes())
    (mixed / "broken.c3d").write_bytes(b"no capture")
    code, said, complaint = run(mixed)
    assert code == 1
    assert "1 pairs of 2 walks" in said
    assert "broken.c3d" in complaint


def test_all_pairs_of_a_population_by_trait(run, people, tmp_path):
    code, said, complaint = run(people, "--trait", "sex", "-o", tmp_path)
    assert code == 0, complaint
    assert "15 pairs of 6 walks" in said
    assert re.search(r"female +3 ", said)
    assert (tmp_path / "report.html").is_file()


def answers_about(people: Path, path: Path, n_trials: int = 400) -> Path:
    """Answers of eight observers, who look at how far apart elbows and feet are."""
    walks = walks_of_population(Population.load(people)).clips
    apart = pair_distances(walks, metric="positions-sigmoid").to_dict()
    spread = np.std(list(apart.values()))
    rng = np.random.default_rng(3)
    rows = []
    for trial in range(n_trials):
        four = [f"walker {i}" for i in sorted(rng.permutation(len(walks))[:4])]
        pairs = list(combinations(four, 2))
        felt = [apart[pair] - 0.5 * spread * rng.gumbel() for pair in pairs]
        shown = [name.split()[1] for name in rng.permutation(four)]
        chosen = [name.split()[1] for name in pairs[int(np.argmin(felt))]]
        rows.append([f"observer {trial % 8}", *shown, *chosen])
    columns = ["observer", *"abcd", "chosen_1", "chosen_2"]
    pd.DataFrame(rows, columns=columns).to_csv(path, index=False)
    return path


def test_weights_are_fitted_to_answers_and_reported(run, tmp_path):
    people = tmp_path / "twelve.nc"
    simulate_population(6, 6, seed=4).save(people)
    answers = answers_about(people, tmp_path / "answers.csv")
    code, said, complaint = run(people, "--answers", answers, "-o", tmp_path / "fit")
    assert code == 0, complaint
    assert "8 observers, 400 answers, 66 pairs" in said
    weights = pd.read_csv(tmp_path / "fit" / "weights.csv", index_col="group")
    assert weights.relative.sum() == pytest.approx(1)
    planted = pd.Series(PUBLISHED["positions-sigmoid"].group_weights)
    assert weights.loc[["upper_arm", "forearm", "toe"], "relative"].sum() > 0.5
    assert (weights.relative_high + 1e-9 >= 0.8 * planted[weights.index]).mean() > 0.8
    pairs = pd.read_csv(tmp_path / "fit" / "pairs.csv")
    assert np.corrcoef(pairs.difference, pairs.predicted)[0, 1] > 0.6
    again = run(people, "--metric", tmp_path / "fit" / "weights.csv")
    assert (again[0], "66 pairs of 12 walks by weights" in again[1]) == (0, True), again[2]
    page = (tmp_path / "fit" / "report.html").read_text()
    assert "distance in walker space" in page
    assert page.count("<img") == 3
    by_choices = pd.read_csv(tmp_path / "fit" / "weights-by-choices.csv", index_col="group")
    assert np.corrcoef(by_choices.relative, planted[by_choices.index])[0, 1] > 0.95
    assert f"forearm {by_choices.relative.forearm:.2f}" in said
    again = run(people, "--metric", tmp_path / "fit" / "weights-by-choices.csv")
    assert (again[0], "by weights-by-choices" in again[1]) == (0, True), again[2]


def test_flagged_walkers_are_left_out_unless_asked_for(run, people, tmp_path):
    population = Population.load(people)
    traits = population.traits.assign(flag=["", "hops", "", "", "", ""])
    Population(population.walkers, traits).save(tmp_path / "flagged.nc")
    code, said, complaint = run(tmp_path / "flagged.nc")
    assert (code, "of 5 walks" in said, "walker 1: hops" in complaint) == (0, True, True)
    code, said, _ = run(tmp_path / "flagged.nc", "--with-flagged")
    assert (code, "of 6 walks" in said) == (0, True)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["{folder}/person1_first.c3d"], "name a second one"),
        (["{folder}", "--metric", "cubed"], "positions-sigmoid"),
        (["{folder}", "--trait", "sex"], "--trait-from-name"),
        (["{people}", "--trait", "shoe"], "no trait 'shoe'"),
        (["{folder}/person1_first.c3d", "{folder}"], "is a folder"),
        (["{folder}/person1_first.c3d", "{folder}/nobody.c3d"], "nobody.c3d"),
        (["{people}", "--answers", "{folder}/nothing.csv"], "could not be read as CSV"),
        (["{people}", "--answers", "{folder}/person1_first.c3d"], "nswers"),
        (["{folder}/nobody"], "nobody does not exist"),
        (["{two}", "--nearest", "c.c3d"], "about many walks"),
        (["{two}", "--trait", "sex"], "--trait is about many walks"),
        (["{two}", "--clusters", "3"], "--clusters is about many walks"),
        (["{two}", "--with-flagged"], "--with-flagged is about many walks"),
        (["{folder}", "--nearest", "c.c3d", "--answers", "a.csv"], "--answers does not go"),
        (["{folder}", "--nearest", "c.c3d", "-o", "out"], "-o does not go with --nearest"),
        (["{people}", "--nearest", "c.c3d", "--trait", "sex"], "--trait does not go"),
        (["{people}", "--answers", "a.csv", "--trait", "sex"], "--trait does not go"),
        (["{folder}", "--clusters", "0", "-o", "out"], "--clusters 0"),
        (["{folder}", "--clusters", "9", "-o", "out"], "there are 4 walks"),
        (["{folder}", "--clusters", "2"], "with -o"),
        (["{people}", "--unit", "cm"], "--unit is for captures"),
        (["{people}", "--trait-from-name", "(?P<a>.)"], "for a population give --trait"),
        (["{people}", "--trait", "weight_kg"], "no classes"),
        (["{people}", "{folder}/person1_first.c3d"], "--nearest"),
        (["{two}", "-o", "{people}"], "is a file"),
        (["{folder}", "--metric", "{folder}/person1_first.csv"], "could not be read as CSV"),
    ],
)
def test_what_makes_no_sense_is_said_in_a_sentence(run, folder, people, words, said):
    if words[0] == "{two}":
        words = ["{folder}/person1_first.c3d", "{folder}/person2_first.c3d", *words[1:]]
    code, printed, complaint = run(*(word.format(folder=folder, people=people) for word in words))
    assert (code, printed) == (2, "")
    assert said in complaint
    assert not complaint.endswith((" \n", "\n\n"))


def stairs(path: Path) -> Path:
    """Someone who walks down, which is no walk like the others."""
    walk = simulate_walk(seed=3, duration_s=6.0, rate_hz=60, markers="skin")
    down = walk.copy()
    down.loc[{"axis": "z"}] -= 150 * walk.time
    return write_mocap(down, path)


def test_flagged_captures_are_said_and_left_out_unless_asked_for(run, folder, tmp_path):
    for path in folder.glob("*_first.c3d"):
        (tmp_path / path.name).write_bytes(path.read_bytes())
    stairs(tmp_path / "stairs.c3d")
    code, said, complaint = run(tmp_path)
    assert (code, "of 2 walks" in said) == (0, True)
    assert "stairs.c3d: This is no level walk" in complaint
    code, said, complaint = run(tmp_path, "--with-flagged")
    assert (code, "of 3 walks" in said) == (0, True)
    assert "stairs.c3d: it is flagged: This is no level walk" in complaint
    code, said, complaint = run(tmp_path / "stairs.c3d", tmp_path / "person1_first.c3d")
    assert code == 0
    assert "Mind stairs.c3d: it is flagged: This is no level walk" in complaint


def test_a_file_without_a_stride_is_named(run, folder, tmp_path):
    still = simulate_walk(seed=1, duration_s=3.0, rate_hz=60, markers="skin")
    still = still.copy(data=np.repeat(still.values[:1], len(still), axis=0))
    write_mocap(still, tmp_path / "still.c3d")
    code, _, complaint = run(folder / "person1_first.c3d", tmp_path / "still.c3d")
    assert code == 2
    assert "still.c3d" in complaint


def test_the_walk_of_a_person_is_no_further_from_itself_than_from_others(run, folder):
    _, said, _ = run(folder / "person1_first.c3d", folder / "person2_first.c3d")
    own = re.search(r"First and last strides of one capture differ by ([\d.e-]+) ", said)
    assert own, said
    assert float(own[1]) < 0.2 * difference(said)


def test_hips_on_the_skin_are_minded(run, tmp_path):
    names = []
    for seed in (1, 2):
        walk = simulate_walk(seed=seed, duration_s=6.0, rate_hz=60)
        for side, out in (("left", 90), ("right", -90)):
            walk.loc[{"marker": f"{side}_hip", "axis": "y"}] += out
        names.append(write_mocap(walk, tmp_path / f"skin{seed}.csv"))
    code, _, complaint = run(*names, "--unit", "mm")
    assert code == 0, complaint
    assert "points on the skin" in complaint


@pytest.mark.filterwarnings("ignore::eigenwalker.io.UnitGuessed")
def test_captures_of_different_formats_are_compared(run, captures, tmp_path):
    walks = captures / "cmu" / "02_01.c3d", captures / "cmu" / "12_01.bvh"
    code, said, complaint = run(*walks, "--metric", "angles-absolute", "-o", tmp_path)
    assert code == 0, complaint
    assert "thigh" in said
    assert "clavicle too, which the walks do not show" in said


def test_styles_are_nearer_to_themselves(run, captures, tmp_path):
    for style in ("feminine", "active", "normal"):
        for number in (1, 2, 3):
            name = f"dataset-2_walk_{style}_00{number}.bvh"
            (tmp_path / name).symlink_to(captures / "bandai-namco" / name)
    pattern = "walk_(?P<style>[a-z]+)_"
    code, said, complaint = run(tmp_path, "--unit", "cm", "--trait-from-name", pattern)
    assert code == 0, complaint
    rows = re.findall(r"^(\w+) +3 +([\d.]+) +([\d.]+)", said, flags=re.MULTILINE)
    assert [style for style, *_ in rows] == ["active", "feminine", "normal"]
    assert all(float(within) < float(others) for _, within, others in rows)


def test_a_unit_is_for_files_that_name_none(run, folder, tmp_path):
    first, second = folder / "person1_first.c3d", folder / "person2_first.c3d"
    plain = run(first, second)
    told = run(first, second, "--unit", "m", "--rate", "30")
    assert told[0] == 0
    assert told[1] == plain[1]


def test_two_captures_have_a_mapping_too(run, folder, tmp_path):
    names = tmp_path / "names.toml"
    names.write_text('[joints]\nleft_wrist = "LWRA"\nright_wrist = "RWRA"\n')
    first, second = folder / "person1_first.c3d", folder / "person2_first.c3d"
    code, printed, _ = run(first, second, "--mapping", names)
    assert code == 0
    assert printed != run(first, second)[1]


def test_a_report_is_a_folder(run, folder, tmp_path):
    two = folder / "person1_first.c3d", folder / "person2_first.c3d"
    code, _, complaint = run(*two, "-o", tmp_path / "picture.png")
    assert code != 0
    assert "name a folder" in complaint
    assert not (tmp_path / "picture.png").exists()
