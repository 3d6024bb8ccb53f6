"""What observers, recruiting sites and the lab get from an experiment."""

from __future__ import annotations

import csv
import json
import re
from collections.abc import Callable
from contextlib import closing
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest

from eigenwalker.experiment import store
from eigenwalker.experiment.answer_writer import AnswerWriter
from eigenwalker.experiment.backup import back_up
from eigenwalker.experiment.experiment_folder import ANSWERS, DESIGN, Material
from eigenwalker.experiment.export import export_experiment
from eigenwalker.experiment.link_keys import hash_of, new_key
from eigenwalker.experiment.rescue import checksum
from eigenwalker.experiment.service import Closed, Gone, NotAllowed, Service
from eigenwalker.experiment.staircase import next_level
from eigenwalker.experiment.status import experiment_status


def begin(service: Service, key: str, own_key: str = "", **more: Any) -> dict[str, Any]:
    consent = service.welcome(key)["consent"]["en"]
    return service.start(key, consent=consent, language="en", own_key=own_key, **more)


def item(trial: int = 1, name: str | None = None, **content: Any) -> dict[str, Any]:
    content = {"response": "male", "outcome": "answered", **content}
    return {
        "answer": name or new_key(),
        "kind": "answer",
        "trial": trial,
        "attempt": 1,
        "content": content,
    }


def exported(service: Service, folder: Path) -> list[dict[str, str]]:
    export_experiment(service.folder, folder)
    tables = folder.glob("data/*_data.csv")
    trials = next(path for path in tables if "_description-" not in path.name)
    return list(csv.DictReader(trials.read_text(encoding="utf-8").splitlines()))


def test_a_session_goes_on_where_it_was(service: Service) -> None:
    [key] = service.invite(1)
    first = begin(service, key)
    assert len(first["trials"]) == 16
    service.answers(key, first["session"], [item(1)])
    assert service.welcome(key)["state"]["name"] == "under_way"
    again = begin(service, key)
    assert again["session"] == first["session"]
    assert again["trials"] == first["trials"]
    assert [each["trial"] for each in again["answered"]] == [1]


def test_opening_a_link_uses_nothing_up(service: Service) -> None:
    [key] = service.invite(1)
    for _ in range(3):
        assert service.welcome(key)["state"]["name"] == "new"
    assert experiment_status(service.folder)["groups"]["frontal"]["sessions"] == {}


def test_a_session_needs_consent_to_the_text_as_it_is(service: Service) -> None:
    [key] = service.invite(1)
    with pytest.raises(ValueError, match="another text"):
        service.start(key, consent="0" * 64, language="en")


def test_nobody_reaches_the_session_of_another(service: Service) -> None:
    one, other = service.invite(2)
    session = begin(service, one)["session"]
    for call in (
        lambda: service.answers(other, session, [item()]),
        lambda: service.stimuli(other, session),
        lambda: service.end(other, session, "deleted"),
        lambda: service.welcome("x" * 22),
    ):
        with pytest.raises(NotAllowed):
            call()


def test_an_open_link_gives_each_observer_a_key_and_knows_who_comes_back(
    small: Callable[..., Path],
) -> None:
    folder = small()
    with (folder / DESIGN).open("a", encoding="utf-8") as file:
        file.write('[recruiting]\nparameters = ["PROLIFIC_PID"]\n')
    with AnswerWriter(folder / ANSWERS) as writer:
        service = Service(folder, writer)
        [link] = service.invite(1, kind="open")
        own, site = new_key(), {"PROLIFIC_PID": "needle", "other": "x"}
        first = begin(service, link, own, site=site)
        assert begin(service, link, own)["session"] == first["session"]
        assert begin(service, link, new_key(), site=site)["session"] == first["session"]
        assert begin(service, link, new_key())["session"] != first["session"]
    assert all(b"needle" not in path.read_bytes() for path in folder.glob("answers*"))


def test_recruiting_closes_when_each_group_has_its_number(small: Callable[..., Path]) -> None:
    folder = small(observers="1")
    with AnswerWriter(folder / ANSWERS) as writer:
        service = Service(folder, writer)
        keys = service.invite(4)
        groups = [begin(service, key)["group"]["name"] for key in keys[:3]]
        assert sorted(groups) == ["frontal", "half-profile", "profile"]
        with pytest.raises(Closed, match="closed"):
            begin(service, keys[3])


def test_a_session_that_is_not_due_says_when(small: Callable[..., Path]) -> None:
    folder = small("wdp2002", least_hours="24.0")
    with AnswerWriter(folder / ANSWERS) as writer:
        service = Service(folder, writer)
        [key] = service.invite(1)
        views = []
        for number in (1, 2, 3):
            session = begin(service, key)
            assert session["number"] == number
            views.append({trial["view_deg"] for trial in session["trials"]})
            items = [item(trial["trial"]) for trial in session["trials"]]
            service.answers(key, session["session"], items)
            service.end(key, session["session"], "finished")
            if number == 3:
                break
            state = service.welcome(key)["state"]
            assert state["name"] == "not_due"
            due = datetime.fromisoformat(state["due_utc"]) - datetime.now(UTC)
            assert timedelta(hours=23.9) < due < timedelta(hours=24.1)
            with pytest.raises(Closed, match="not_due"):
                begin(service, key)
            writer.do(
                lambda db: db.execute(
                    "UPDATE session SET ended_utc = ?",
                    ((datetime.now(UTC) - timedelta(hours=25)).isoformat(),),
                )
            )
        assert service.welcome(key)["state"]["name"] == "finished"
        assert sorted(view for (view,) in views) == [0.0, 30.0, 90.0]


def test_a_changed_design_leaves_sessions_under_way_as_they_are(service: Service) -> None:
    one, other, late = service.invite(3)
    before = begin(service, one)
    path = service.folder / DESIGN
    text = path.read_text("utf-8")
    path.write_text(text.replace("blank_s = 3.0", "blank_s = 2.0"))
    assert begin(service, one)["pace"]["blank_s"] == before["pace"]["blank_s"] == 3.0
    assert begin(service, other)["pace"]["blank_s"] == 2.0
    versions = [service.page_version(key) for key in (one, other, new_key())]
    assert len(set(versions)) == 3
    assert versions[2] is None
    for version in versions[:2]:
        assert "<head>" in str(service.page(str(version)))
    path.write_text("this is no design", encoding="utf-8")
    assert begin(service, one)["pace"]["blank_s"] == 3.0
    path.write_text(text.replace("duration_s = 7.0", "duration_s = 6.0"))  # of other stimuli
    assert Material(service.folder).faults()[0].startswith("stimuli/ were made for another design")
    assert begin(service, late)["picture"]["duration_s"] == 7.0


def test_who_withdraws_is_gone_by_the_code_of_the_last_page(service: Service) -> None:
    [key] = service.invite(1)
    session = begin(service, key)["session"]
    service.answers(key, session, [item(note="needle")])
    with pytest.raises(Closed, match="not all answers"):
        service.end(key, session, "finished")
    code = service.end(key, session, "stopped")["withdrawal_code"]
    with pytest.raises(ValueError, match="Nobody has that code"):
        service.withdraw("AAAA-BBBB-CCCC-DDDD")
    assert service.withdraw(code.lower()) == 1
    with pytest.raises(Gone):
        service.welcome(key)
    assert all(b"needle" not in path.read_bytes() for path in service.folder.glob("answers*"))


def test_the_export_has_a_row_a_showing_and_the_same_bytes(
    service: Service, tmp_path: Path
) -> None:
    [key] = service.invite(1)
    session = begin(service, key)["session"]
    begun = {"answer": new_key(), "kind": "begun", "trial": 1, "attempt": 1}
    items = [
        {**begun, "content": {"time_utc": "2026-01-01T00:00:00Z"}},
        item(1, outcome="none", response=None, time_utc="2026-01-02"),
        {**item(1, rt_ms=500.5, time_utc="2026-01-03"), "attempt": 2},
        {**begun, "answer": new_key(), "trial": 2, "content": {"time_utc": "2026-01-04"}},
        {**item(2, page_hidden=1, response="=1+1", time_utc="2026-01-05"), "attempt": 2},
    ]
    service.answers(key, session, items)
    rows = exported(service, tmp_path / "one")
    found = [
        (row["trial"], row["attempt"], row["outcome"], row["repeated"], row["interrupted"])
        for row in rows
    ]
    assert found == [
        ("1", "1", "none", "0", "0"),
        ("1", "2", "answered", "1", "0"),
        ("2", "1", "interrupted", "0", "1"),
        ("2", "2", "answered", "0", "0"),
    ]
    assert rows[1]["rt_ms"] == "500.5"
    assert rows[3]["flag"] == "hidden"
    assert rows[3]["response"] == "'=1+1"
    assert {row["session_outcome"] for row in rows} == {"left"}
    description = json.loads((tmp_path / "one" / "dataset_description.json").read_text())
    measured = {each["name"] for each in description["variableMeasured"]}
    for path in (tmp_path / "one" / "data").glob("*.csv"):
        assert re.fullmatch(r"([a-z]+-[A-Za-z0-9]+_)+data\.csv", path.name)
        assert set(path.read_text(encoding="utf-8").splitlines()[0].split(",")) <= measured
    exported(service, tmp_path / "two")
    for path in (tmp_path / "one").rglob("*"):
        if path.is_file():
            other = tmp_path / "two" / path.relative_to(tmp_path / "one")
            assert path.read_bytes() == other.read_bytes(), path


def test_a_rescue_file_is_taken_answer_by_answer(service: Service) -> None:
    [key] = service.invite(1)
    session = begin(service, key)
    texts = [json.dumps(item(trial)) for trial in (1, 2, 3)]
    proof = hash_of(key)
    items = [{"text": text, "check": checksum(proof + text)} for text in texts]
    items[1]["text"] = items[1]["text"].replace("male", "female")
    content = {"session": session["session"], "proof": proof, "items": items}
    service.answers(key, session["session"], [json.loads(texts[2])])
    assert service.rescue(content) == [
        "1. answer of trial 1: taken",
        "2. edited or damaged; not taken",
        "3. answer of trial 3: given already",
    ]
    with pytest.raises(ValueError, match="another experiment"):
        service.rescue({**content, "proof": "0" * 64})


def test_simulated_observers_answer_all_and_count_in_no_group(
    service: Service, tmp_path: Path
) -> None:
    service.simulate(6, seed=1)
    status = experiment_status(service.folder)
    assert status["simulated"] == 6
    assert status["versions"] == []
    assert all(group["finished_or_under_way"] == 0 for group in status["groups"].values())
    rows = exported(service, tmp_path / "data")
    answered = [row for row in rows if row["outcome"] == "answered"]
    assert len(answered) == 6 * 16
    assert {row["simulated"] for row in rows} == {"1"}
    truth = (service.folder / "simulated_truth.csv").read_text(encoding="utf-8").splitlines()
    assert len(truth) == 1 + 9 * 6 + 40
    found = service.writer.do(store.counts)
    assert found["refused"] == 0


def test_the_lab_page_needs_its_own_key(service: Service) -> None:
    [lab], [key] = service.invite(1, kind="lab"), service.invite(1)
    session = begin(service, key)["session"]
    service.answers(key, session, [item(frames_dropped=90, frames_shown=10)])
    page = service.lab_page(lab)
    assert "Answers are being kept" in page
    assert "<td>frontal</td><td>1</td><td>8</td>" in page
    for wrong in (key, new_key()):
        with pytest.raises(NotAllowed):
            service.lab_page(wrong)
    with pytest.raises(NotAllowed):
        service.welcome(lab)


def test_backups_are_whole_and_forget_who_withdraws(service: Service, tmp_path: Path) -> None:
    keys = service.invite(2)
    for number, key in enumerate(keys):
        session = begin(service, key)["session"]
        service.answers(key, session, [item(note=f"needle-{number}")])
    path = back_up(service.folder)
    assert b"needle-0" in path.read_bytes()
    with closing(store.read_only(path)) as copy:
        assert store.counts(copy)["answers"] == 2
    saved = {"format": "eigenwalker rescue", "session": session, "items": ["needle-1"]}
    (service.folder / "answers.json").write_text(json.dumps(saved))
    service.end(keys[1], session, "deleted")
    files = [file for file in service.folder.rglob("*") if file.is_file()]
    assert not [file for file in files if b"needle-1" in file.read_bytes()]
    assert b"needle-0" in path.read_bytes()


def test_each_level_of_a_staircase_follows_from_the_answers(
    small: Callable[..., Path], tmp_path: Path
) -> None:
    folder = small("detection")
    with AnswerWriter(folder / ANSWERS) as writer:
        service = Service(folder, writer)
        service.simulate(3, seed=2)
        rows = exported(service, tmp_path / "data")
    levels = [5, 10, 20, 40, 80]
    for observer in {row["observer"] for row in rows}:
        right: list[bool] = []
        for row in rows:
            if row["observer"] != observer or row["outcome"] != "answered":
                continue
            place = next_level(right, start=0, n_levels=5, down=2)
            assert float(row["level"]) == levels[place]
            assert f"_{levels[place]}_" in row["stimulus"]
            right.append(row["response"] == row["condition"])
        assert len(right) == 60
        assert 0.5 < np.mean(right) < 0.95


def test_answers_to_questions_are_a_table_of_their_own(
    small: Callable[..., Path], tmp_path: Path
) -> None:
    folder = small()
    with (folder / DESIGN).open("a", encoding="utf-8") as file:
        file.write('[[questions]]\nname = "hand"\nkind = "choice"\noptions = ["left", "right"]\n')
    faults = Material(folder).faults()
    assert [fault.split("# ")[1].split("'")[0] for fault in faults] == [
        "question_hand",
        "option_left",
        "option_right",
    ]
    with AnswerWriter(folder / ANSWERS) as writer:
        service = Service(folder, writer)
        [key] = service.invite(1)
        session = begin(service, key)
        assert session["questions"][0]["name"] == "hand"
        content = {"when": "before", "answers": {"hand": "left"}}
        asked = {**item(content=content), "kind": "questions", "trial": None, "content": content}
        service.answers(key, session["session"], [asked])
        exported(service, tmp_path / "data")
    table = tmp_path / "data" / "data" / "study-troje2002_description-questions_data.csv"
    assert table.read_text(encoding="utf-8").splitlines()[1:] == ["1,1,hand,left"]


def test_whatever_a_page_reports_the_export_is_whole(service: Service, tmp_path: Path) -> None:
    [key] = service.invite(1)
    session = begin(service, key)["session"]
    strange = {"rt_ms": "late", "frames_shown": 1.5, "page_hidden": 10**30, "response_by": [1]}
    items = [
        item(1, **strange, frame_times=[0, "x", 16.7]),
        item(2, rt_ms=1e300, response='a "quoted", text', started_utc="@now", focus_lost=True),
        item(3, response="\ud800", first_frame_ms=True, outcome={"no": 1}),
        {**item(content={}), "kind": "screen", "trial": None, "content": {"px_per_cm": 38.5}},
    ]
    service.answers(key, session, items)
    rows = exported(service, tmp_path / "data")
    assert [row["rt_ms"] for row in rows] == ["", "1e+300", ""]
    assert [row["frames_shown"] + row["page_hidden"] for row in rows] == ["", "", ""]
    assert [row["focus_lost"] for row in rows] == ["", "1", ""]
    assert rows[0]["response_by"] == "[1]"
    assert rows[1]["response"] == 'a "quoted", text'
    assert rows[1]["started_utc"] == "'@now"
    assert rows[2]["response"] == "?"
    export_experiment(service.folder, tmp_path / "data", frames=True)
    frames = pq.read_table(tmp_path / "data" / "data" / "study-troje2002_frames.parquet")
    assert frames["frame_times_ms"].to_pylist() == [[0.0, 16.7]]
    screens = tmp_path / "data" / "data" / "study-troje2002_description-screens_data.parquet"
    assert pq.read_table(screens)["px_per_cm"].to_pylist() == [38.5]
    with pytest.raises(ValueError, match="inside"):
        export_experiment(service.folder, service.folder / "data")
