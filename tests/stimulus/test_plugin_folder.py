"""The folder of the jsPsych plugin, and what a real browser shows of it, from the disk."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pandas as pd
import pytest

import eigenwalker as ew
from eigenwalker.stimulus import Stimulus, make_stimulus, write_stimulus
from eigenwalker.stimulus.plugin_folder import COPIED, PAGE, STIMULI, write_plugin

TRIALS = """async ([n, duration, block]) => {
  const jsPsych = initJsPsych();
  const busy = () => { const from = performance.now(); while (performance.now() - from < block); };
  const trial = {
    type: jsPsychWalker, stimulus: STIMULI[0].stimulus, choices: "NO_KEYS",
    stimulus_duration: duration, trial_duration: duration + 34,
    on_load: () => { if (block) setTimeout(busy, duration / 2); },
  };
  await jsPsych.run(Array.from({ length: n }, () => ({ ...trial })));
  return jsPsych.data.get().values();
}"""


@pytest.fixture(scope="module")
def walker() -> Stimulus:
    return make_stimulus(ew.load_population().walkers[0], duration_s=0.3, size_px=(200, 200))


def test_the_folder_has_all_that_a_page_without_network_needs(walker, tmp_path):
    assert write_plugin({"one": walker}, tmp_path / "new" / "study") == []
    folder = tmp_path / "new" / "study"
    assert {path.name for path in folder.iterdir()} == {PAGE, STIMULI, *COPIED}
    page = (folder / PAGE).read_text()
    assert f"eigenwalker {ew.__version__}" in page
    assert not [line for line in page.splitlines() if 'src="http' in line or 'href="http' in line]
    script = (folder / STIMULI).read_text().partition("STIMULI = [")[2].rpartition("]")[0]
    item = json.loads(script)
    assert item["name"] == "one"
    assert Stimulus.from_dict(item["stimulus"]).to_json() == walker.to_json()
    for name in ("jsPsych", "seedrandom", "three.js"):
        assert name in (folder / "licences.txt").read_text()


def test_an_edited_page_and_the_files_of_others_are_left_alone(walker, tmp_path):
    write_plugin({"one": walker}, tmp_path)
    page = tmp_path / PAGE
    page.write_text(page.read_text().replace("Who walks?", "Wer geht da?"))
    assert write_plugin({"two": walker}, tmp_path) == [PAGE]
    assert "Wer geht da?" in page.read_text()
    assert '"two"' in (tmp_path / STIMULI).read_text()
    assert write_plugin({"two": walker}, tmp_path, force=True) == []
    assert "Wer geht da?" not in page.read_text()
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / PAGE).write_text("mine")
    with pytest.raises(FileExistsError, match="choose another folder"):
        write_plugin({"one": walker}, tmp_path / "other")
    assert (tmp_path / "other" / PAGE).read_text() == "mine"


def test_the_command_takes_files_or_makes_an_example(walker, tmp_path, monkeypatch, run_command):
    monkeypatch.chdir(tmp_path)
    write_stimulus(walker, "tall </script>.json".replace("/", "_"))
    code, said, _ = run_command("plugin", "tall <_script>.json", "-o", "one")
    assert (code, "tall <_script>" in said) == (0, True)
    code, said, _ = run_command("plugin", "-o", "two")
    assert (code, "4 stimuli: woman_3, woman_1, man_1, man_3" in said) == (0, True)
    with Path("two", PAGE).open("a") as page:
        page.write("<!-- mine -->")
    code, said, _ = run_command("plugin", "-o", "two")
    assert (code, "was edited and is left as it is" in said) == (0, True)
    assert Path("two", PAGE).read_text().endswith("mine -->")
    Path("three").mkdir()
    shutil.copy("tall <_script>.json", "three/tall <_script>.json")
    _, _, complaint = run_command(
        "plugin", "tall <_script>.json", "three/tall <_script>.json", "-o", "f"
    )
    assert "Several stimuli are called" in complaint
    assert "no such stimulus files: none.json" in run_command("plugin", "none.json", "-o", "f")[2]
    assert "expected a folder" in run_command("plugin", "-o", "tall <_script>.json")[2]


def test_the_page_is_answered_from_the_disk_and_saves_a_table(browser, walker, tmp_path):
    mannequin = Stimulus.from_dict(
        {**walker.to_dict(), "display": {**walker.to_dict()["display"], "style": "mannequin"}}
    )
    write_plugin({"plain": walker, "wood": mannequin}, tmp_path)
    context = browser.new_context(accept_downloads=True, offline=True)
    page, amiss = context.new_page(), []
    page.on("pageerror", lambda error: amiss.append(str(error)))
    page.goto((tmp_path / PAGE).as_uri() + "?observer=7")
    page.keyboard.press(" ")
    for number in range(4):
        button = page.locator(".jspsych-walker-buttons button:not([disabled])").first
        button.wait_for()
        if number == 3:
            button.click()
        else:
            page.keyboard.press("j")
        button.wait_for(state="detached")
    with page.expect_download() as saved:
        page.get_by_role("button", name="CSV").click()
    table = pd.read_csv(saved.value.path())
    context.close()
    assert saved.value.suggested_filename == "walkers-7.csv"
    assert amiss == []
    assert sorted(table["name"]) == ["plain", "plain", "wood", "wood"]
    assert table["answer"].tolist() == ["a man"] * 3 + ["a woman"]
    assert table["response_device"].tolist() == ["keyboard"] * 3 + ["mouse"]
    assert {"rt", "refresh_rate", "frames_dropped", "first_frame", "seed"} <= set(table)


@pytest.mark.parametrize("block_ms", [0, 60])
def test_stimuli_last_whole_frames_of_a_real_browser(browser, walker, tmp_path, block_ms):
    write_plugin({"one": walker}, tmp_path)
    blank = "".join(
        f'<script src="{name}"></script>' for name in ("jspsych.js", COPIED[0], STIMULI)
    )
    (tmp_path / "trials.html").write_text(f"<!doctype html><body>{blank}</body>")
    page = browser.new_page()
    page.goto((tmp_path / "trials.html").as_uri())
    n_trials = 5 if block_ms else 20
    data = page.evaluate(TRIALS, [n_trials, 100, block_ms])
    page.close()
    assert len(data) == n_trials
    for trial in data:
        refresh_ms = 1000 / trial["refresh_rate"]
        planned = max(round(100 / refresh_ms), 1)
        assert trial["frames_planned"] == planned
        assert trial["frames_shown"] == len(trial["frame_times"]) <= planned
        passed = trial["frames_shown"] + trial["frames_dropped"]
        assert passed >= planned  # more, where the very frame that ends it was missed
        assert trial["shown_for"] == pytest.approx(passed * refresh_ms, abs=refresh_ms / 2)
        assert (trial["frames_dropped"] > 0) or not block_ms
