"""Answers are kept once, are on disk when confirmed, and leave no bytes after a withdrawal."""

from __future__ import annotations

import os
import sqlite3
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from pathlib import Path

import pytest

from eigenwalker.experiment import store
from eigenwalker.experiment.answer_writer import AnswerWriter
from eigenwalker.experiment.link_keys import hash_of, new_key

KILLED = """
import sys
from pathlib import Path
from eigenwalker.experiment import store
from eigenwalker.experiment.answer_writer import AnswerWriter

with AnswerWriter(Path(sys.argv[1])) as writer:
    for number in range(100_000):
        item = {"answer": f"{sys.argv[2]}-{number:015d}", "kind": "answer", "trial": 1,
                "attempt": 1, "content": {"number": number}}
        writer.do(lambda db: store.add_answers(db, 1, [item]))
        print(item["answer"], flush=True)
"""


def session(db: sqlite3.Connection, kind: str = "real") -> int:
    store.add_version(db, "v", "design")
    observer = store.add_observer(db, kind)
    store.add_link(db, hash_of(new_key()), "personal", observer)
    values = {"observer": observer, "number": 1, "version": "v", "language": "en"}
    return store.add_session(db, {**values, "consent_hash": "c", "trials": [{"trial": 1}]})


def item(name: str = "a" * 20, **content: object) -> dict:
    return {"answer": name, "kind": "answer", "trial": 1, "attempt": 1, "content": content}


@pytest.fixture
def writer(tmp_path: Path) -> Iterator[AnswerWriter]:
    with AnswerWriter(tmp_path / "answers.sqlite") as opened:
        opened.do(session)
        yield opened


def test_an_answer_sent_again_is_confirmed_again_and_kept_once(writer: AnswerWriter) -> None:
    for _ in range(3):
        received = writer.do(lambda db: store.add_answers(db, 1, [item(rt_ms=1.0)]))
        assert received == [store.Received("a" * 20, "confirmed")]
    assert writer.do(lambda db: store.n_confirmed(db, 1)) == 1


def test_another_content_of_the_same_name_is_refused_and_both_are_kept(
    writer: AnswerWriter,
) -> None:
    first = item(rt_ms=1.0, frame_times=[0, 16.7])
    writer.do(lambda db: store.add_answers(db, 1, [first]))
    other = item(rt_ms=1.0, frame_times=[0, 16.8])
    received = writer.do(lambda db: store.add_answers(db, 1, [other, other]))
    assert {each.outcome for each in received} == {"other content"}
    assert writer.do(store.counts)["refused"] == 1
    assert writer.do(lambda db: store.answers_of(db, 1))[0]["content"] == {"rt_ms": 1.0}


def test_a_failed_part_undoes_nothing_of_the_works_beside_it(writer: AnswerWriter) -> None:
    def fails(db: sqlite3.Connection) -> None:
        store.add_answers(db, 1, [item("b" * 20)])
        raise ValueError("no")

    works = [lambda db, n=n: store.add_answers(db, 1, [item(f"{n:020d}")]) for n in range(40)]
    with ThreadPoolExecutor(20) as pool:
        futures = [pool.submit(writer.do, work) for work in [*works[:20], fails, *works[20:]]]
        failed = [future for future in futures if future.exception()]
    assert len(failed) == 1
    assert writer.do(lambda db: store.n_confirmed(db, 1)) == 40


def test_what_was_confirmed_is_there_after_the_writer_is_killed(tmp_path: Path) -> None:
    path = tmp_path / "answers.sqlite"
    with AnswerWriter(path) as writer:
        writer.do(session)
    confirmed: list[str] = []
    for turn in range(2):
        child = subprocess.Popen(
            [sys.executable, "-c", KILLED, str(path), f"turn{turn}"],
            stdout=subprocess.PIPE,
            text=True,
        )
        assert child.stdout is not None
        confirmed += [child.stdout.readline().strip() for _ in range(50)]
        child.kill()
        confirmed += [line.strip() for line in child.stdout if line.endswith("\n")]
        child.wait()
        child.stdout.close()
    with AnswerWriter(path) as writer:
        kept = [each["answer"] for each in writer.do(lambda db: store.answers_of(db, 1))]
    assert len(set(kept)) == len(kept)
    assert set(confirmed) <= set(kept)
    assert len(kept) <= len(confirmed) + 2  # one more each time, written and not yet confirmed


def test_groups_stay_balanced_when_many_arrive_at_once_and_some_leave(tmp_path: Path) -> None:
    limits = {"a": 20, "b": 20, "c": 20}

    def arrive(db: sqlite3.Connection) -> tuple[str, int] | None:
        session(db)
        observer = store.observers(db)[-1]["observer"]
        return store.put_into_group(db, observer, limits, 60)

    with AnswerWriter(tmp_path / "answers.sqlite") as writer:
        with ThreadPoolExecutor(30) as pool:
            places = list(pool.map(lambda _: writer.do(arrive), range(70)))
        assert places.count(None) == 10
        assert len({each for each in places if each}) == 60

        def leave(db: sqlite3.Connection) -> None:
            db.execute("UPDATE presence SET seen_utc = '2000' WHERE session % 5 = 0")

        writer.do(leave)
        free = 60 - len(writer.do(lambda db: store.active_places(db, 60)))
        again = [writer.do(arrive) for _ in range(free + 3)]
        assert again.count(None) == 3


@pytest.mark.parametrize(
    ("ended", "sessions", "held"),
    [("2000", 1, True), ("2000", 3, False), ("now", 3, True)],
)
def test_who_does_not_come_back_for_the_next_session_gives_the_place_back(
    tmp_path: Path, ended: str, sessions: int, held: bool
) -> None:
    def finish(db: sqlite3.Connection) -> None:
        number = session(db)
        store.put_into_group(db, store.observers(db)[-1]["observer"], {"only": 1}, 60)
        when = store.utc_now() if ended == "now" else ended
        db.execute(
            "UPDATE session SET outcome = 'finished', ended_utc = ? WHERE session = ?",
            (when, number),
        )

    with AnswerWriter(tmp_path / "answers.sqlite") as writer:
        writer.do(finish)
        active = writer.do(lambda db: store.active_places(db, 60, sessions, 24))
    assert len(active) == held


def test_tests_and_simulated_observers_take_no_place(tmp_path: Path) -> None:
    with AnswerWriter(tmp_path / "answers.sqlite") as writer:
        for kind in ("test", "simulated", "real"):

            def arrive(db: sqlite3.Connection, kind: str = kind) -> tuple[str, int] | None:
                session(db, kind)
                observer = store.observers(db)[-1]["observer"]
                return store.put_into_group(db, observer, {"only": 1}, 60)

            assert writer.do(arrive) == ("only", 0)


def test_a_withdrawn_answer_is_in_no_file_of_the_folder(tmp_path: Path) -> None:
    with AnswerWriter(tmp_path / "answers.sqlite") as writer:
        writer.do(session)
        for n in range(50):
            content = {"text": f"needle-{n}" * 50}
            writer.do(lambda db, n=n, c=content: store.add_answers(db, 1, [item(f"{n:020d}", **c)]))
        writer.do(lambda db: store.add_answers(db, 1, [item("0" * 20, text="needle-refused")]))
        assert writer.do(lambda db: store.withdraw_observer(db, 1)) == 50
        writer.do(store.remove_bytes, alone=True)
        for path in tmp_path.iterdir():
            assert b"needle" not in path.read_bytes(), path
        assert writer.do(store.counts)["withdrawn"] == 1


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ("PRAGMA application_id = 1", "another program"),
        ("PRAGMA user_version = 99", "newer version"),
    ],
)
def test_a_database_that_is_not_ours_is_refused_untouched(
    tmp_path: Path, change: str, reason: str
) -> None:
    path = tmp_path / "answers.sqlite"
    store.connect(path).close()
    with sqlite3.connect(path) as database:
        database.execute(change)
    database.close()
    before = path.read_bytes()
    with pytest.raises(store.UnusableDatabase, match=reason):
        store.connect(path)
    path.write_bytes(before[:3000] + os.urandom(2000))
    with pytest.raises(store.UnusableDatabase, match="damaged"):
        store.connect(path)


def test_a_database_of_an_older_version_is_brought_forward_with_all_it_has(tmp_path: Path) -> None:
    path, fresh = tmp_path / "answers.sqlite", tmp_path / "fresh.sqlite"
    schema = Path(__file__).with_name("schema_1.sql").read_text(encoding="utf-8")
    with closing(sqlite3.connect(path, isolation_level=None)) as old:
        old.executescript(schema)
        old.execute(f"PRAGMA application_id = {store.APPLICATION_ID}")
        old.execute("PRAGMA user_version = 1")
        session(old)
        content = {"rt_ms": 1.0, "frames_dropped": 9, "frames_shown": 1}
        store.add_answers(old, 1, [item(**content)], n_trials=1)
    with AnswerWriter(path) as writer:
        assert writer.do(lambda db: store.answers_of(db, 1))[0]["content"] == content
        assert writer.do(lambda db: store.n_dropping(db, 0.5)) == 1
    store.connect(fresh).close()
    shapes = []
    for each in (path, fresh):
        with closing(sqlite3.connect(each)) as database:
            shapes.append(set(database.execute("SELECT type, name FROM sqlite_schema")))
            assert database.execute("PRAGMA user_version").fetchone()[0] == store.VERSION
    assert shapes[0] == shapes[1]


def test_a_full_disk_confirms_nothing_and_is_named(writer: AnswerWriter) -> None:
    pages = writer.do(lambda db: db.execute("PRAGMA page_count").fetchone()[0])
    writer.do(lambda db: db.execute(f"PRAGMA max_page_count = {pages + 3}"), alone=True)
    large = item(text="x" * 100_000)
    with pytest.raises(OSError, match="Nothing was confirmed"):
        writer.do(lambda db: store.add_answers(db, 1, [large]))
    assert "full" in writer.trouble
    writer.do(lambda db: db.execute("PRAGMA max_page_count = 100000"), alone=True)
    assert writer.do(lambda db: store.add_answers(db, 1, [large]))[0].outcome == "confirmed"
