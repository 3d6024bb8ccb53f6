"""The database of answers: all SQL of experiments. `AnswerWriter` runs these in transactions."""

from __future__ import annotations

import json
import os
import secrets
import sqlite3
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from importlib.resources import files
from pathlib import Path
from typing import Any

from pydantic_core import to_json

APPLICATION_ID = 0x65776578
VERSION = 2
MIGRATIONS = {
    1: """
        CREATE INDEX answer_dropping ON answer (session)
            WHERE kind = 'answer' AND json_extract(content, '$.frames_dropped') > 0;
        CREATE INDEX answer_screen ON answer (session) WHERE kind = 'screen';
    """
}
"""Statements that bring a database from that version to the next."""
MAX_CHECKED = 100_000_000
"""Bytes of a database that is checked whole at each start."""
Row = dict[str, Any]


class UnusableDatabase(ValueError):  # noqa: N818 - the name says what it is
    """A file that holds no answers, or answers of a newer program; it is left as it is."""


def utc_now() -> str:
    """Return the time as it is written into the database."""
    return datetime.now(UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")


def connect(path: Path) -> sqlite3.Connection:
    """Return the one connection that writes, with the newest schema; makes the file if need be."""
    path = Path(path)
    exists = path.exists() and path.stat().st_size > 0
    if exists:
        _check(path)
    connection = sqlite3.connect(path, isolation_level=None, check_same_thread=False, timeout=10)
    connection.row_factory = sqlite3.Row
    pragmas = ("secure_delete = ON", "synchronous = FULL", "fullfsync = ON", "foreign_keys = ON")
    for pragma in pragmas:
        connection.execute(f"PRAGMA {pragma}")
    mode = connection.execute("PRAGMA journal_mode = WAL").fetchone()[0]
    if mode != "wal":
        connection.close()
        raise OSError(f"{path}: the folder's file system cannot keep a WAL; use a local disk.")
    if not exists:
        schema = files("eigenwalker.experiment").joinpath("schema.sql").read_text("utf-8")
        connection.executescript(
            f"BEGIN IMMEDIATE; {schema} PRAGMA application_id = {APPLICATION_ID}; "
            f"PRAGMA user_version = {VERSION}; "
            f"INSERT INTO setting VALUES ('secret', '{secrets.token_hex(32)}'); COMMIT;"
        )
        _flush_folder(path.parent)
    else:
        _migrate(connection)
    return connection


def read_only(path: Path, *, check: bool = True) -> sqlite3.Connection:
    """Return a connection that only reads; a file that a server has open needs no check."""
    if not Path(path).exists():
        raise FileNotFoundError(f"{path}: there are no answers yet.")
    if check:
        _check(path)
    return _open_to_read(path)


def _open_to_read(path: Path) -> sqlite3.Connection:
    uri = f"{Path(path).resolve().as_uri()}?mode=ro"
    connection = sqlite3.connect(uri, uri=True, isolation_level=None, check_same_thread=False)
    connection.row_factory = sqlite3.Row
    return connection


def _check(path: Path) -> None:
    """Refuse, without a write, what is no database of answers that this program can use."""
    try:
        with closing(_open_to_read(path)) as connection:
            application = connection.execute("PRAGMA application_id").fetchone()[0]
            version = connection.execute("PRAGMA user_version").fetchone()[0]
            connection.execute("SELECT count(*) FROM sqlite_schema").fetchone()
            small = path.stat().st_size <= MAX_CHECKED
            check = "PRAGMA quick_check(1)" if small else "SELECT 'ok'"
            healthy = connection.execute(check).fetchone()[0]
    except sqlite3.DatabaseError as error:
        raise UnusableDatabase(
            f"{path} is damaged or no database ({error}); put a backup in its place."
        ) from None
    if application != APPLICATION_ID:
        raise UnusableDatabase(f"{path} is a database of another program; move it away.")
    if version > VERSION:
        raise UnusableDatabase(
            f"{path} was written by a newer version of this program; install that version."
        )
    if healthy != "ok":
        raise UnusableDatabase(f"{path} is damaged ({healthy}); put a backup in its place.")


def _migrate(connection: sqlite3.Connection) -> None:
    version = connection.execute("PRAGMA user_version").fetchone()[0]
    for old in range(version, VERSION):
        connection.executescript(
            f"BEGIN IMMEDIATE; {MIGRATIONS[old]} PRAGMA user_version = {old + 1}; COMMIT;"
        )


def _flush_folder(folder: Path) -> None:
    """Have the folder's entry of a new file on disk, where the system can do that."""
    if os.name == "posix":
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def rows(connection: sqlite3.Connection, sql: str, *values: Any) -> list[Row]:
    """Return rows as dictionaries."""
    return [dict(row) for row in connection.execute(sql, values)]


def _one(connection: sqlite3.Connection, sql: str, *values: Any) -> Row | None:
    row = connection.execute(sql, values).fetchone()
    return None if row is None else dict(row)


# ------------------------------------------------------------------------------- versions, links


def secret(connection: sqlite3.Connection) -> str:
    """Return the secret of this experiment, with which identifiers are hashed."""
    return connection.execute("SELECT value FROM setting WHERE name = 'secret'").fetchone()[0]


def add_version(
    connection: sqlite3.Connection, version: str, design: str, *, freeze: bool = False
) -> None:
    """Keep a version of the design; the first invitation freezes it."""
    connection.execute(
        "INSERT INTO version VALUES (?, ?, NULL) ON CONFLICT DO NOTHING", (version, design)
    )
    if freeze:
        connection.execute(
            "UPDATE version SET frozen_utc = ? WHERE version = ? AND frozen_utc IS NULL",
            (utc_now(), version),
        )


def versions(connection: sqlite3.Connection) -> list[Row]:
    """Return the versions, oldest first."""
    return rows(connection, "SELECT * FROM version ORDER BY rowid")


def add_link(
    connection: sqlite3.Connection, hash: str, kind: str, observer: int | None = None
) -> None:
    """Keep the hash of a key."""
    connection.execute(
        "INSERT INTO link VALUES (?, ?, ?, ?) ON CONFLICT DO NOTHING",
        (hash, kind, observer, utc_now()),
    )


def add_observer(
    connection: sqlite3.Connection, kind: str = "real", site_hash: str | None = None
) -> int:
    """Add an observer, who is in no group yet, and return the number."""
    sql = "INSERT INTO observer (kind, site_hash) VALUES (?, ?) RETURNING observer"
    return connection.execute(sql, (kind, site_hash)).fetchone()[0]


def find_observer(connection: sqlite3.Connection, observer: int) -> Row:
    """Return an observer by the number."""
    return rows(connection, "SELECT * FROM observer WHERE observer = ?", observer)[0]


def find_link(connection: sqlite3.Connection, hash: str) -> Row | None:
    """Return a link by the hash of its key, with its observer."""
    return _one(
        connection,
        'SELECT link.hash, link.kind, link.observer, observer.kind AS observer_kind, "group",'
        " place, withdrawn_utc FROM link LEFT JOIN observer USING (observer) WHERE hash = ?",
        hash,
    )


def observer_of_site(connection: sqlite3.Connection, site_hash: str) -> int | None:
    """Return the observer whom a recruiting site sent before."""
    found = _one(connection, "SELECT observer FROM observer WHERE site_hash = ?", site_hash)
    return None if found is None else found["observer"]


def keep_raw_identifier(connection: sqlite3.Connection, observer: int, text: str) -> None:
    """Keep an identifier as it came."""
    connection.execute(
        "INSERT INTO raw_identifier VALUES (?, ?) ON CONFLICT DO NOTHING", (observer, text)
    )


# ---------------------------------------------------------------------------- groups and sessions

_ACTIVE = """
    SELECT observer.observer, "group", place FROM observer
    WHERE kind = 'real' AND withdrawn_utc IS NULL AND "group" IS NOT NULL
    AND EXISTS (SELECT 1 FROM session JOIN presence USING (session)
                WHERE session.observer = observer.observer
                AND number = (SELECT max(number) FROM session AS any_of
                              WHERE any_of.observer = observer.observer)
                AND (outcome IS NULL AND seen_utc > ?
                     OR outcome = 'finished' AND (number >= ? OR ended_utc > ?)))
"""


def active_places(
    connection: sqlite3.Connection,
    hold_place_min: float,
    n_sessions: int = 1,
    most_hours: float = 0.0,
) -> list[Row]:
    """Return group and place of all real observers who finished or are under way.

    Between their sessions observers are under way until the next may no longer begin.
    """

    def before_now(minutes: float) -> str:
        moment = datetime.now(UTC) - timedelta(minutes=minutes)
        return moment.isoformat(timespec="milliseconds")[:23] + "Z"

    values = (before_now(hold_place_min), n_sessions, before_now(60 * most_hours))
    return rows(connection, _ACTIVE, *values)


def put_into_group(
    connection: sqlite3.Connection,
    observer: int,
    limits: Mapping[str, int],
    hold_place_min: float,
    n_sessions: int = 1,
    most_hours: float = 0.0,
) -> tuple[str, int] | None:
    """Put an observer into the group with the fewest, and return it; none where all are full.

    Tests and simulated observers take turns among themselves and count in no group.
    """
    kind = connection.execute(
        "SELECT kind FROM observer WHERE observer = ?", (observer,)
    ).fetchone()[0]
    if kind == "real":
        taken = active_places(connection, hold_place_min, n_sessions, most_hours)
    else:
        sql = 'SELECT "group", place FROM observer WHERE kind = ? AND "group" IS NOT NULL'
        taken = rows(connection, sql, kind)
    places = {name: {row["place"] for row in taken if row["group"] == name} for name in limits}
    free = [name for name in limits if kind != "real" or len(places[name]) < limits[name]]
    if not free:
        return None
    group = min(free, key=lambda name: len(places[name]) / limits[name])
    place = next(n for n in range(len(places[group]) + 1) if n not in places[group])
    connection.execute(
        'UPDATE observer SET "group" = ?, place = ? WHERE observer = ?', (group, place, observer)
    )
    return group, place


def add_session(connection: sqlite3.Connection, values: Row) -> int:
    """Add a session, and return its number among all."""
    session = connection.execute(
        "INSERT INTO session (observer, number, version, language, consent_hash, consent_utc,"
        " trials) VALUES (?, ?, ?, ?, ?, ?, ?) RETURNING session",
        (
            *(values[name] for name in ("observer", "number", "version", "language")),
            *(values["consent_hash"], utc_now(), json.dumps(values["trials"])),
        ),
    ).fetchone()[0]
    note_seen(connection, session)
    return session


def sessions_of(connection: sqlite3.Connection, observer: int) -> list[Row]:
    """Return the sessions of an observer, oldest first."""
    return rows(connection, "SELECT * FROM session WHERE observer = ? ORDER BY number", observer)


def session_of_link(connection: sqlite3.Connection, hash: str, session: int) -> Row | None:
    """Return observer, withdrawal and number of trials, if the session is of the link's observer.

    Of an observer who withdrew, whatever the session.
    """
    return _one(
        connection,
        "SELECT observer, withdrawn_utc, json_array_length(trials) AS n_trials"
        " FROM link JOIN observer USING (observer) LEFT JOIN session USING (observer)"
        " WHERE hash = ? AND (session = ? OR withdrawn_utc IS NOT NULL)",
        hash,
        session,
    )


def session_by_proof(connection: sqlite3.Connection, session: int, proof: str) -> bool:
    """Return whether a proof is the hash of a key of the session's observer."""
    sql = (
        "SELECT link.hash FROM session JOIN link USING (observer)"
        " WHERE session = ? AND link.kind = 'personal'"
    )
    found = rows(connection, sql, session)
    return any(secrets.compare_digest(row["hash"], proof) for row in found)


def note_seen(connection: sqlite3.Connection, session: int) -> None:
    """Note that an observer is there."""
    connection.execute("INSERT OR REPLACE INTO presence VALUES (?, ?)", (session, utc_now()))


def end_session(connection: sqlite3.Connection, session: int, outcome: str) -> None:
    """Note that a session is over; its first end counts."""
    connection.execute(
        "UPDATE session SET ended_utc = ?, outcome = ? WHERE session = ? AND outcome IS NULL",
        (utc_now(), outcome, session),
    )


# ----------------------------------------------------------------------------------------- answers


@dataclass(frozen=True)
class Received:
    """What became of an answer: "confirmed", or the reason why it is refused for good."""

    answer: str
    outcome: str


def add_answers(
    connection: sqlite3.Connection,
    session: int,
    items: Sequence[Row],
    via: str = "page",
    *,
    n_trials: int | None = None,
) -> list[Received]:
    """Add answers of a session, each once; another content under a known name is kept apart."""
    known, now = n_trials or _n_trials(connection, session), utc_now()
    return [_add_answer(connection, session, item, known, now, via) for item in items]


def _n_trials(connection: sqlite3.Connection, session: int) -> int:
    sql = "SELECT json_array_length(trials) FROM session WHERE session = ?"
    return connection.execute(sql, (session,)).fetchone()[0]


def _add_answer(
    connection: sqlite3.Connection, session: int, item: Row, n_trials: int, now: str, via: str
) -> Received:
    rest = dict(item["content"])
    frames = rest.pop("frame_times", None)
    content, times = as_text(rest), None if frames is None else as_text(frames)
    name, trial, showing, kind = (item[each] for each in ("answer", "trial", "attempt", "kind"))
    if trial is not None and not 1 <= trial <= n_trials:
        return _refuse(connection, session, name, "unknown trial", as_text(item), now)
    added = connection.execute(
        "INSERT INTO answer VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?) ON CONFLICT DO NOTHING",
        (name, session, kind, trial, showing, content, now, via, times),
    )
    if added.rowcount:
        return Received(name, "confirmed")
    known = connection.execute(
        "SELECT session, kind, trial, attempt, content, frame_times FROM answer WHERE answer = ?",
        (name,),
    ).fetchone()
    same = tuple(known)[:4] == (session, kind, trial, showing) and all(
        one == other or (one and other and json.loads(one) == json.loads(other))
        for one, other in ((known[4], content), (known[5], times))
    )
    if same:
        return Received(name, "confirmed")
    return _refuse(connection, session, name, "other content", as_text(item), now)


def as_text(value: Any) -> str:
    """Return what a page reported as JSON; raise `ValueError` for what JSON does not have."""
    try:
        text = to_json(value, inf_nan_mode="constants").decode()
    except ValueError:  # half a character of a pair, which only escapes can say
        text = ""
    if text and "NaN" not in text and "Infinity" not in text:
        return text
    try:
        return json.dumps(value, separators=(",", ":"), allow_nan=False)
    except RecursionError:
        raise ValueError("An answer is not nested that deeply.") from None


def _refuse(
    connection: sqlite3.Connection, session: int, name: str, reason: str, content: str, now: str
) -> Received:
    connection.execute(
        "INSERT INTO refused (answer, session, reason, content, received_utc)"
        " VALUES (?, ?, ?, ?, ?) ON CONFLICT DO NOTHING",
        (name, session, reason, content, now),
    )
    return Received(name, reason)


def answers_of(connection: sqlite3.Connection, session: int) -> list[Row]:
    """Return the answers of a session, in the order in which they came, with their content."""
    sql = (
        "SELECT answer, kind, trial, attempt, content, received_utc FROM answer"
        " WHERE session = ? ORDER BY rowid"
    )
    found = rows(connection, sql, session)
    return [{**row, "content": json.loads(row["content"])} for row in found]


def frame_times(connection: sqlite3.Connection) -> Iterator[Row]:
    """Yield the names of answers with the times of their frames."""
    sql = "SELECT answer, frame_times FROM answer WHERE frame_times IS NOT NULL ORDER BY rowid"
    for row in connection.execute(sql):
        yield {"answer": row["answer"], "frame_times": json.loads(row["frame_times"])}


def n_confirmed(connection: sqlite3.Connection, session: int) -> int:
    """Return how many answers of a session are kept."""
    sql = "SELECT count(*) FROM answer WHERE session = ?"
    return connection.execute(sql, (session,)).fetchone()[0]


def n_refused(connection: sqlite3.Connection, session: int) -> int:
    """Return how many answers of a session were refused for good."""
    sql = "SELECT count(*) FROM refused WHERE session = ?"
    return connection.execute(sql, (session,)).fetchone()[0]


# -------------------------------------------------------------------------------------- withdrawal


def withdraw_observer(connection: sqlite3.Connection, observer: int) -> int:
    """Delete all that an observer gave, and return how many answers that was.

    The links stay, so that they are known as withdrawn.
    """
    sessions = [row["session"] for row in sessions_of(connection, observer)]
    n_answers = sum(n_confirmed(connection, session) for session in sessions)
    for session in sessions:
        for table in ("answer", "refused", "presence"):
            connection.execute(f"DELETE FROM {table} WHERE session = ?", (session,))
    for table in ("session", "raw_identifier"):
        connection.execute(f"DELETE FROM {table} WHERE observer = ?", (observer,))
    connection.execute(
        'UPDATE observer SET site_hash = NULL, "group" = NULL, place = NULL, withdrawn_utc = ?'
        " WHERE observer = ? AND withdrawn_utc IS NULL",
        (utc_now(), observer),
    )
    connection.execute("INSERT INTO record (time_utc, what) VALUES (?, 'withdrawal')", (utc_now(),))
    return n_answers


def remove_bytes(connection: sqlite3.Connection) -> None:
    """Remove what deleted rows left in the files; must run outside a transaction."""
    connection.execute("VACUUM")
    busy = connection.execute("PRAGMA wal_checkpoint(TRUNCATE)").fetchone()[0]
    if busy:
        raise BlockingIOError("The database is being read.")


# ---------------------------------------------------------------------------------------- overview


def observers(connection: sqlite3.Connection) -> list[Row]:
    """Return all observers."""
    return rows(connection, "SELECT * FROM observer ORDER BY observer")


def sessions(connection: sqlite3.Connection) -> Iterator[Row]:
    """Yield all sessions with group and kind of their observers, but without their trials."""
    sql = (
        "SELECT session, observer, number, version, language, consent_hash, consent_utc, ended_utc,"
        ' outcome, observer.kind AS observer_kind, "group", place FROM session'
        " JOIN observer USING (observer) ORDER BY observer, number"
    )
    for row in connection.execute(sql):
        yield dict(row)


def versions_of_sessions(connection: sqlite3.Connection) -> list[str]:
    """Return the versions that observers were shown, oldest first."""
    sql = (
        "SELECT version FROM version WHERE version IN (SELECT version FROM session) ORDER BY rowid"
    )
    return [row["version"] for row in connection.execute(sql)]


def trials_of(connection: sqlite3.Connection, session: int) -> str:
    """Return the trials of a session, as JSON."""
    sql = "SELECT trials FROM session WHERE session = ?"
    return connection.execute(sql, (session,)).fetchone()[0]


def reports_of(connection: sqlite3.Connection, session: int, kind: str) -> list[Row]:
    """Return what a session's pages reported of one kind, in the order in which it came."""
    sql = (
        "SELECT content FROM answer WHERE session = ? AND kind = ? AND trial IS NULL ORDER BY rowid"
    )
    return [json.loads(row["content"]) for row in connection.execute(sql, (session, kind))]


def n_dropping(connection: sqlite3.Connection, share: float) -> int:
    """Return how many trials dropped more than that share of their frames."""
    sql = (
        "SELECT count(*) FROM answer WHERE kind = 'answer'"
        " AND json_extract(content, '$.frames_dropped') > 0"
        " AND json_extract(content, '$.frames_dropped') > ? *"
        " (json_extract(content, '$.frames_shown') + json_extract(content, '$.frames_dropped'))"
    )
    return connection.execute(sql, (share,)).fetchone()[0]


def n_not_stored(connection: sqlite3.Connection) -> int:
    """Return how many sessions had a page that could store nothing."""
    sql = (
        "SELECT count(DISTINCT session) FROM answer WHERE kind = 'screen'"
        " AND json_extract(content, '$.stored') = 0"
    )
    return connection.execute(sql).fetchone()[0]


def counts(connection: sqlite3.Connection) -> Row:
    """Return how many answers, refused ones, withdrawals and links there are."""
    tables = {"answers": "answer", "refused": "refused", "links": "link"}
    found = {
        name: connection.execute(f"SELECT count(*) FROM {table}").fetchone()[0]
        for name, table in tables.items()
    }
    sql = "SELECT count(*) FROM observer WHERE withdrawn_utc IS NOT NULL"
    return {**found, "withdrawn": connection.execute(sql).fetchone()[0]}


@contextmanager
def transaction(connection: sqlite3.Connection) -> Iterator[None]:
    """All or nothing of what is written inside, on disk at its end."""
    connection.execute("BEGIN IMMEDIATE")
    try:
        yield
        connection.execute("COMMIT")
    except BaseException:
        if connection.in_transaction:
            connection.execute("ROLLBACK")
        raise


def within(connection: sqlite3.Connection, work: Callable[[sqlite3.Connection], Any]) -> Any:
    """Run a part of a transaction, undone by itself where it fails."""
    connection.execute("SAVEPOINT part")
    try:
        result = work(connection)
    except BaseException:
        if connection.in_transaction:
            connection.execute("ROLLBACK TO part")
            connection.execute("RELEASE part")
        raise
    connection.execute("RELEASE part")
    return result
