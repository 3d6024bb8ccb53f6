"""The command line, as a person types it."""

from __future__ import annotations

import json
import re
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import av
import numpy as np
import pandas as pd
import pytest

import eigenwalker as ew
from eigenwalker.io import write_mocap
from eigenwalker.population import Population
from eigenwalker.simulation import Route, simulate_captures, simulate_population, simulate_walk


@pytest.fixture
def run(run_command):
    """Type a command; get its exit code, what it printed, and what it wrote to stderr."""
    return run_command


@pytest.fixture(scope="module")
def folder(tmp_path_factory, write_c3d) -> Path:
    folder = tmp_path_factory.mktemp("captures")
    for number, (walk, person) in enumerate(simulate_captures(4, 4, seed=4)):
        write_c3d(folder / f"{person['sex']}_{number}.c3d", walk)
    return folder


@pytest.fixture(scope="module")
def people(tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("people") / "people.nc"
    simulate_population(6, 6, seed=4).save(path)
    return path


def test_help_imports_nothing_heavy() -> None:
    code = (
        "import sys; import eigenwalker.cli.main as cli; sys.argv = ['eigenwalker', '--help']\n"
        "try: cli.main()\n"
        "except SystemExit: pass\n"
        "print([name for name in ('numpy', 'pandas', 'xarray', 'scipy', 'rich', 'typer') "
        "if name in sys.modules])"
    )
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert said.stdout.splitlines()[-1] == "[]"
    for command in ("demo", "info", "fit", "classify", "synthesize"):
        assert command in said.stdout


@pytest.mark.parametrize(
    ("words", "code", "answer"),
    [
        (["-h"], 0, "Commands:"),
        ([], 2, "Commands:"),
        (["--version"], 0, f"eigenwalker {ew.__version__}"),
        (["compre"], 2, "Did you mean 'compare'?"),
        (["--bad"], 2, "No such option '--bad'"),
        (["fit", "-h"], 0, "Usage: eigenwalker fit"),
        (["data", "list", "-h"], 0, "Usage: eigenwalker data list"),
    ],
)
def test_what_no_command_is_typed_for(run, words, code, answer) -> None:
    ended, printed, errors = run(*words)
    assert (ended, answer in printed + errors) == (code, True)


def test_a_module_that_runs_is_called_as_such_and_says_on_what_it_runs(run, monkeypatch) -> None:
    said = run("--version")[1]
    assert re.fullmatch(rf"eigenwalker {ew.__version__} \(Python 3\.\d+\.\d+\w*, \w+ \w+\)\n", said)
    monkeypatch.setattr("eigenwalker.cli.main.called_as", lambda: "python -m eigenwalker")
    assert run("-h")[1].startswith("Usage: python -m eigenwalker [OPTIONS]")
    assert run("fit", "-h")[1].startswith("Usage: python -m eigenwalker fit ")
    assert "Try 'python -m eigenwalker -h' for help." in run("fitt")[2]


def test_shells_complete_commands_and_their_options(run, monkeypatch) -> None:
    monkeypatch.setenv("_EIGENWALKER_COMPLETE", "complete_bash")
    for typed, words in (("cl", ["classify"]), ("fit --tr", ["--traits", "--trait-from-name"])):
        monkeypatch.setenv("COMP_WORDS", f"eigenwalker {typed}")
        monkeypatch.setenv("COMP_CWORD", str(len(typed.split())))
        assert run()[1].split() == words


def test_where_no_trait_is_named_one_that_walkers_have_is_told_and_named(
    run, people, tmp_path
) -> None:
    known = Population.load(people)
    bare = known.traits.drop(columns="sex")
    for name, traits in (("age_years", bare), ("style", bare.assign(style=["a", "b"] * 6))):
        replace(known, traits=traits).save(tmp_path / "some.nc")
        code, said, errors = run("classify", tmp_path / "some.nc", "--permutations", 1)
        assert (code, said.partition(":")[0]) == (0, name)
        assert f"No trait 'sex' tells these walkers apart: {name} is told." in errors
    for traits, problem in (
        (bare[["flag"]], "The population has no trait to tell"),
        (bare[["flag"]].assign(style=list("abc") * 4), "choose two, for instance style=a:b"),
    ):
        replace(known, traits=traits).save(tmp_path / "some.nc")
        code, _, errors = run("classify", tmp_path / "some.nc")
        assert (code, problem in errors) == (2, True)


def test_what_to_cite_is_printed(run) -> None:
    assert "@article{troje2002decomposing," in run("cite")[1]
    assert run("cite", "cmu")[1].count("@") == 1


def test_fit_reads_a_folder_and_ends_with_0(run, folder, tmp_path) -> None:
    output = tmp_path / "people.nc"
    code, said, _ = run("fit", folder, "-o", output, "--trait-from-name", "(?P<sex>female|male)_")
    assert code == 0
    assert "8 of 8 captures read, 0 of them flagged" in said
    people = Population.load(output)
    assert people.traits["sex"].value_counts().to_dict() == {"female": 4, "male": 4}


def test_fit_ends_with_1_when_some_were_refused_and_2_when_all_were(run, folder, tmp_path) -> None:
    for name in ("female_0.c3d", "male_4.c3d"):
        (tmp_path / name).write_bytes((folder / name).read_bytes())
    (tmp_path / "broken.c3d").write_bytes(b"\x02\x50" + bytes(5000))
    code, said, _ = run("fit", tmp_path, "-o", tmp_path / "some.nc")
    assert code == 1
    assert "1 refused:\n  broken.c3d: " in said
    assert len(Population.load(tmp_path / "some.nc")) == 2
    for name in ("female_0.c3d", "male_4.c3d"):
        (tmp_path / name).unlink()
    code, said, errors = run("fit", tmp_path, "-o", tmp_path / "none.nc")
    assert code == 2
    assert "No capture of 1 could be used." in errors
    assert not (tmp_path / "none.nc").exists()


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such signals")
def test_a_fit_that_is_killed_goes_on_where_it_stopped(folder, tmp_path, run) -> None:
    captures, output = tmp_path / "captures", tmp_path / "people.nc"
    captures.mkdir()
    for path in folder.iterdir():
        for copy in range(2):
            (captures / f"{copy}_{path.name}").write_bytes(path.read_bytes())
    command = [sys.executable, "-c", CALL, "fit", captures, "-o", output, "--jobs", "1"]
    journal = tmp_path / "people.nc.part"
    for how, lines in ((signal.SIGKILL, 1), (signal.SIGINT, 3)):
        with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as fit:
            while fit.poll() is None and _lines(journal) < lines:
                time.sleep(0.01)
            fit.send_signal(how)
            said = fit.communicate()[1]
        assert fit.returncode == (130 if how == signal.SIGINT else -how), said
        assert not output.exists()
        kept = _lines(journal)
        assert lines <= kept < 16
    assert f"interrupted. What was read is kept in {journal}." in said
    assert "The same command goes on where it stopped; with --fresh it begins again." in said
    assert "Traceback" not in said
    code, said, errors = run(*command[3:])
    assert code == 0
    assert "captures were read by an earlier run" in errors
    assert not journal.exists()
    run("fit", captures, "-o", tmp_path / "at_once.nc", "--fresh", "--jobs", 1)
    resumed, at_once = Population.load(output), Population.load(tmp_path / "at_once.nc")
    np.testing.assert_array_equal(resumed.X, at_once.X)
    pd.testing.assert_frame_equal(resumed.traits, at_once.traits)


# Whoever runs the tests in the background passes on that interrupts are ignored.
CALL = (
    "import signal; signal.signal(signal.SIGINT, signal.default_int_handler); "
    "from eigenwalker.cli.main import main; main()"
)


def _lines(path: Path) -> int:
    return path.read_bytes().count(b"\n") if path.is_file() else 0


def test_a_whole_study_can_be_rehearsed(run, tmp_path) -> None:
    people, captures = tmp_path / "people.nc", tmp_path / "captures"
    code, said, _ = run(
        "simulate", "--women", 2, "--men", 3, "--seed", 1, "-o", people, "--captures", captures
    )
    assert code == 0
    assert "5 walkers" in said
    code, said, _ = run(
        "fit", captures, "--traits", captures / "traits.csv", "-o", tmp_path / "again.nc"
    )
    assert code == 0
    truth, again = Population.load(people), Population.load(tmp_path / "again.nc")
    assert again.traits["sex"].tolist() == truth.traits["sex"].tolist()
    assert again.X.shape == truth.X.shape


def test_info_says_what_is_in_a_capture(run, folder) -> None:
    code, said, _ = run("info", folder / "male_5.c3d")
    assert code == 0
    assert "left_ankle" in said
    code, said, _ = run("info", folder / "male_5.c3d", "--json")
    facts = json.loads(said)
    assert facts["format"] == "C3D"
    assert facts["verdict"] == "use"
    assert facts["rate_hz"] == 120


def test_info_reports_what_a_capture_is_worth(run, tmp_path) -> None:
    walk = simulate_walk(seed=3, duration_s=8, rate_hz=100, markers="skin", noise_mm=1)
    spoilt = walk.sel(marker=walk.marker != "LASI").copy()
    spoilt.loc[{"marker": "RKNE", "time": walk.time[200:204]}] += 300
    spoilt.loc[{"marker": "LANK", "time": walk.time[400:]}] = walk.sel(marker="RANK").values[400:]
    spoilt.loc[{"marker": "RANK", "time": walk.time[400:]}] = walk.sel(marker="LANK").values[400:]
    path = write_mocap(spoilt, tmp_path / "walk.c3d")
    code, said, _ = run("info", path)
    assert code == 0
    for words in ("strides found", "share explained", "periodicity", "drift", "missing samples"):
        assert words in said
    told = {line[:23].strip(): line[23:].strip() for line in said.splitlines()}
    assert told["verdict"] == "use with care"
    assert told["problems"].startswith("Left and right changed places and were put right: LANK")
    assert told["marker set"].startswith("Plug-in Gait, 97% of its points found (next is ")
    assert told["rebuilt markers"] == "left_front_waist: mirrored from right_front_waist"
    assert told["jumps"] == "RKNE: 1"
    assert told["left-right swaps"] == "LANK and RANK, frames 400 to 799"
    assert told["rate"] == "100 Hz"
    facts = json.loads(run("info", path, "--json")[1])
    assert facts["swaps"] == ["LANK and RANK, frames 400 to 799"]
    assert 0.9 < facts["marker_set_share"] < 1
    assert facts["r2"] > 0.95


def test_info_says_how_a_turning_walk_was_dealt_with(run, tmp_path) -> None:
    around = simulate_walk(seed=3, duration_s=10, rate_hz=100, route=Route(turning_deg_s=30))
    said = run("info", write_mocap(around, tmp_path / "around.c3d"))[1]
    assert "degrees and was unwound" in said


def test_fit_sums_up_what_was_found_and_filters_if_asked(run, folder, tmp_path) -> None:
    output, table = tmp_path / "people.nc", tmp_path / "captures.csv"
    code, said, _ = run("fit", folder, "-o", output, "--low-pass", 6, "--table", table)
    assert code == 0
    for words in ("strides found: ", "share explained: ", "periodicity: ", "jumps: ", "drift: "):
        assert words in said
    assert "verdict:               use 8" in said
    assert Population.load(output).provenance["low_pass"].startswith("6 Hz")
    columns = set(pd.read_csv(table).columns)
    assert {"rate_hz", "strides", "marker_set", "rebuilt", "left_right_swaps", "r2"} <= columns


def test_info_says_what_is_in_a_population(run, people) -> None:
    code, said, _ = run("info", people, "--json")
    assert code == 0
    facts = json.loads(said)
    assert facts["walkers"] == 12
    assert facts["features"] == 229
    assert any("sex: female 6, male 6" in line for line in facts["traits"])


def test_demo_writes_a_report_and_films_and_ends(run, people, tmp_path) -> None:
    code, said, _ = run("demo", people, "-o", tmp_path / "new" / "out", "--no-open")
    assert code == 0
    assert "everything, with size" in said
    page = tmp_path / "new" / "out" / "report.html"
    assert str(page) in said
    assert "Sex from gait" in page.read_text()
    assert '<a href="index.html">' in page.read_text()
    index = (tmp_path / "new" / "out" / "index.html").read_text(encoding="utf-8")
    assert '<meta name="eigenwalker-report" content="report.html"' in index
    assert '"positive":"male"' in index
    films = sorted((tmp_path / "new" / "out").glob("*.mp4"))
    assert "sex-discriminant-dots.mp4" in [film.name for film in films]


def test_classify_prints_the_table(run, people) -> None:
    code, said, _ = run("classify", people, "--trait", "sex", "--permutations", "20")
    assert code == 0
    assert "sex: female to male, 12 walkers" in said
    assert "first three eigenpostures" in said
    code, said, _ = run("classify", people, "--trait", "weight", "--permutations", "0")
    assert code == 0
    assert "weight_kg: light to heavy" in said
    assert "nested RMSE" in said
    ps = [line.split()[4] for line in said.splitlines() if line.lstrip().startswith("dynamics")]
    assert ps == ["-"]


def test_classify_reports_on_a_trait_that_is_a_number(run, people, tmp_path) -> None:
    code, _, _ = run(
        "classify", people, "--trait", "weight", "--permutations", "20", "-o", tmp_path
    )
    assert code == 0
    page = (tmp_path / "report.html").read_text()
    assert "Share of the variance of weight_kg explained" in page
    assert "nested R2" in page
    assert "what to expect of new people" in page
    results = pd.read_csv(tmp_path / "results.csv").set_index("input")
    assert results.loc["dynamics", "nested RMSE"] > 0
    assert (tmp_path / "figures" / "space.pdf").read_bytes().startswith(b"%PDF")


def test_synthesize_films_a_walker_and_says_how_plausible_it_is(run, people, tmp_path) -> None:
    film = tmp_path / "walker.mp4"
    code, said, _ = run(
        "synthesize", people, "--trait", "sex=+3", "--trait", "weight=-1",
        "--duration", "1", "-o", film,
    )  # fmt: skip
    assert code == 0
    assert "sex: 3 standard deviations towards male" in said
    assert "weight_kg: 1 standard deviations towards light" in said
    assert "Limbs: upper arms" in said
    with av.open(str(film)) as opened:
        assert float(opened.streams.video[0].duration * opened.streams.video[0].time_base) == 1


def test_synthesize_starts_from_a_walker_or_a_capture(run, people, folder, tmp_path) -> None:
    film = tmp_path / "walker.gif"
    for start in ("3", str(folder / "male_5.c3d")):
        code, said, _ = run(
            "synthesize",
            people,
            "--from",
            start,
            "--trait",
            "sex=-1",
            "--duration",
            "0.4",
            "-o",
            film,
        )
        assert code == 0, said
        assert film.stat().st_size > 0


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("info", "nowhere.c3d"), "nothing of that name"),
        (("info", "nowhere.nc"), "nothing of that name"),
        (("classify", "--trait", "beauty"), "no trait 'beauty'"),
        (("classify", "nowhere.nc"), "nothing of that name"),
        (("synthesize", "--trait", "sex"), "sex=+3"),
        (("synthesize", "--trait", "sex=much"), "sex=+3"),
        (("synthesize", "--from", "99"), "walker from 0 to 39"),
        (("synthesize", "-o", "walker.xyz"), "must end in one of"),
        (("synthesize", "--part", "p9"), "no part 'p9'"),
        (("fit", ".", "-o", "people.csv"), "written as .nc"),
        (("fit", ".", "-o", "people.nc", "--form", "wavelet"), "eigenposture"),
    ],
)
def test_mistakes_are_answered_in_a_sentence(run, words, said, tmp_path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    if "--part" in words:
        words = (*words, "--trait", "sex=1")
    code, _, errors = run(*words)
    assert code == 2
    assert said in errors
    assert "Traceback" not in errors
