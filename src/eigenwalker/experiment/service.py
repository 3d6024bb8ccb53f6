"""What pages ask of an experiment: its welcome, a session, stimuli, answers, the end."""

from __future__ import annotations

import json
import sqlite3
import subprocess
import sys
import threading
from collections.abc import Collection, Mapping, Sequence
from concurrent.futures import Future
from dataclasses import asdict, dataclass, field
from datetime import UTC, datetime, timedelta
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any
from zipfile import ZIP_DEFLATED, ZipFile

from eigenwalker.experiment import store
from eigenwalker.experiment.answer_writer import AnswerWriter
from eigenwalker.experiment.backup import forget_in_copies
from eigenwalker.experiment.experiment_folder import DESIGN, OBSERVER_PAGE, VERSIONS, Material
from eigenwalker.experiment.lab_page import lab_page
from eigenwalker.experiment.link_keys import hash_of, keyed_hash, new_key, same, withdrawal_code
from eigenwalker.experiment.order import trials_for_page
from eigenwalker.experiment.rescue import take_items
from eigenwalker.experiment.status import experiment_status
from eigenwalker.experiment.stimulus_bundle import Bundle

Content = dict[str, Any]
OBSERVERS = ("personal", "open", "preview")
"""Kinds of links that lead to the page of observers."""
RETRY_S = 5.0
"""Between attempts to remove the bytes of a withdrawal while an export reads them."""
FINAL = ("answered", "timeout")
"""Outcomes after which a trial is not shown again."""


class NotAllowed(PermissionError):  # noqa: N818 - the name says what it is
    """No key, or one that is not for this."""


class Gone(PermissionError):  # noqa: N818 - the name says what it is
    """The observer withdrew."""


class Closed(ValueError):  # noqa: N818 - the name says what it is
    """No session can begin now; the message is the name of the text that says why."""

    def __init__(self, reason: str, **details: Any) -> None:
        super().__init__(reason)
        self.details = details


@dataclass
class Service:
    """An experiment as pages and commands use it; all writes go through its writer."""

    folder: Path
    writer: AnswerWriter
    _materials: dict[str, Material] = field(default_factory=dict)
    _current: tuple[Any, str] = (None, "")
    _n_trials: dict[tuple[str, int], int] = field(default_factory=dict)
    """Of sessions, under the hash of the key that reached them; for the writer's thread alone."""
    _exporting: threading.Lock = field(default_factory=threading.Lock)

    @property
    def material(self) -> Material:
        """The version for new sessions: the folder as it is."""
        return Material(self.folder)

    def version_material(self, version: str) -> Material:
        """Return design, texts and stimuli of a version, as they were."""
        if version not in self._materials:
            self._materials[version] = Material(self.folder / VERSIONS / version[:16])
        return self._materials[version]

    def keep_version(self, *, freeze: bool = False) -> str:
        """Keep the folder's design, texts and stimuli as a version, and return its hash."""
        material = self.material
        try:
            state = material.state()
            if not freeze and self._current[0] == state:
                return self._current[1]
            if self._current[1] and material.faults():
                return self._current[1]
            version = material.hash()
        except (ValueError, OSError):  # it is being edited: new sessions get what was there
            if freeze or not self._current[1]:
                raise
            return self._current[1]
        target = self.folder / VERSIONS / version[:16]
        if not target.exists():
            target.parent.mkdir(exist_ok=True)
            material.copy_to(target)
        design = (target / DESIGN).read_text(encoding="utf-8-sig")
        self.writer.do(lambda db: store.add_version(db, version, design, freeze=freeze))
        self._current = (state, version)
        return version

    # ------------------------------------------------------------------------------ for commands

    def invite(self, number: int, *, kind: str = "personal") -> list[str]:
        """Return keys of new links; only their hashes are kept."""
        if kind != "lab":
            self.keep_version(freeze=kind != "preview")
        keys = [new_key() for _ in range(number)]

        def add(db: sqlite3.Connection) -> None:
            for key in keys:
                observer = store.add_observer(db) if kind == "personal" else None
                store.add_link(db, hash_of(key), kind, observer)

        self.writer.do(add)
        return keys

    def withdraw(self, code: str) -> int:
        """Delete all of the observer with that code, and return how many answers that was."""

        def find(db: sqlite3.Connection) -> int:
            key = store.secret(db)
            for each in store.observers(db):
                if same(withdrawal_code(key, each["observer"]), code.strip().upper()):
                    return each["observer"]
            raise ValueError("Nobody has that code; compare it letter by letter.")

        return self._withdraw(self.writer.do(find))

    def _withdraw(self, observer: int) -> int:

        def delete(db: sqlite3.Connection) -> tuple[list[int], int]:
            self._n_trials.clear()
            sessions = [each["session"] for each in store.sessions_of(db, observer)]
            return sessions, store.withdraw_observer(db, observer)

        sessions, n_answers = self.writer.do(delete)
        self._remove_bytes()
        forget_in_copies(self.folder, sessions)
        return n_answers

    def _remove_bytes(self) -> None:
        """Remove what deleted rows left in the files: now, or once an export has been read."""
        try:
            self.writer.do(store.remove_bytes, alone=True)
        except BlockingIOError:
            again = threading.Timer(RETRY_S, self._remove_bytes)
            again.daemon = True
            again.start()

    # --------------------------------------------------------------------------------- for the lab

    def lab_page(self, key: str) -> str:
        """Return the page of the lab, for the key of the lab."""
        self.writer.do(lambda db: self._link(db, key, ["lab"]))
        status = experiment_status(self.folder, check=False)
        return lab_page(status, self.writer.trouble, f"{key}/data.zip")

    def lab_export(self, key: str, target: Path) -> None:
        """Write the data as a ZIP archive, in a process of its own: answers are not held up."""
        self.writer.do(lambda db: self._link(db, key, ["lab"]))
        with self._exporting, TemporaryDirectory() as place:
            command = [sys.executable, "-m", "eigenwalker", "experiment", "export"]
            arguments = [str(self.folder.resolve()), "-o", f"{place}/data"]
            done = subprocess.run([*command, *arguments], capture_output=True, text=True)
            if done.returncode:
                raise ValueError(done.stderr.strip() or "The export failed.")
            with ZipFile(target, "w", ZIP_DEFLATED) as archive:
                for path in sorted(Path(place).rglob("*")):
                    if path.is_file():
                        archive.write(path, path.relative_to(place))

    def rescue(self, content: dict[str, Any]) -> list[str]:
        """Take answers of a file, and say of each what became of it."""
        return self.writer.do(lambda db: take_items(db, content))

    def simulate(self, number: int, seed: int, model: Mapping[str, float] | None = None) -> str:
        """Add simulated observers with all their answers; return the file of the truth."""
        from eigenwalker.experiment.observer_model import ObserverModel
        from eigenwalker.experiment.simulated_observers import simulate_observers

        return str(simulate_observers(self, number, seed, ObserverModel(**(model or {}))))

    # --------------------------------------------------------------------------------- for pages

    def page_version(self, key: str) -> str | None:
        """Return the version whose page a link shows: that of the session under way, or the newest.

        None for a key that opens nothing, so that the page says so.
        """

        def find(db: sqlite3.Connection) -> list[Content]:
            link = self._link(db, key)
            return store.sessions_of(db, link["observer"]) if link["observer"] else []

        try:
            begun = self.writer.do(find)
        except (NotAllowed, Gone):
            return None
        version = begun[-1]["version"] if self._under_way(begun) else self.keep_version()
        return version[:16]

    def page(self, version: str) -> str | None:
        """Return the page as it was when a version was made."""
        path = self.folder / VERSIONS / version / OBSERVER_PAGE
        known = len(version) == 16 and version.isalnum() and path.is_file()
        return path.read_text(encoding="utf-8") if known else None

    def welcome(self, key: str, site: Mapping[str, str] | None = None) -> Content:
        """Return what the first page shows; nothing is used up and nothing begins."""

        def find(db: sqlite3.Connection) -> tuple[Content, list[Content], Content]:
            link = self._link(db, key)
            observer = link["observer"] or self._known_observer(db, link, site)
            begun = [] if observer is None else store.sessions_of(db, observer)
            over = link["observer"] and begun and begun[-1]["outcome"]
            return link, begun, {"end": self._end_content(db, begun[-1])} if over else {}

        link, begun, end = self.writer.do(find)
        version = begun[-1]["version"] if self._under_way(begun) else self.keep_version()
        material = self.version_material(version)
        design = material.design
        texts = {name: material.texts(name) for name in design.languages}
        state = self._state(design, begun)
        return {
            "name": design.name,
            "page": version[:16],
            "state": state,
            "languages": {name: each.for_page for name, each in texts.items()},
            "consent": {name: each.consent_hash for name, each in texts.items()},
            "test": link["kind"] == "preview" or link["observer_kind"] == "test",
            "personal": link["observer"] is not None,
            "phones": design.screen.phones,
            "site_parameters": design.recruiting.parameters,
            **(end if state["name"] == "finished" else {}),
        }

    def start(
        self,
        key: str,
        *,
        consent: str,
        language: str,
        own_key: str = "",
        site: Mapping[str, str] | None = None,
    ) -> Content:
        """Begin a session, or go on with the one under way; an observer's click asks for it.

        An open link gives each observer a key of their own, which the page makes, so that a
        request sent twice begins one session.
        """

        def go_on(db: sqlite3.Connection, observer: int | None, proof: str) -> Content | None:
            begun = store.sessions_of(db, observer) if observer else []
            if not self._under_way(begun):
                return None
            store.note_seen(db, begun[-1]["session"])
            return self._session_content(db, begun[-1], proof)

        found = self.writer.do(lambda db: go_on(db, self._link(db, key)["observer"], hash_of(key)))
        if found is not None:
            return found
        version = self.keep_version()
        material = self.version_material(version)

        def begin(db: sqlite3.Connection) -> Content:
            link, proof = self._link(db, key), hash_of(own_key or key)
            observer = link["observer"] or self._arriving(db, link, own_key, site, material)
            begun = store.sessions_of(db, observer)
            return go_on(db, observer, proof) or self._session_content(
                db,
                self._new_session(db, observer, begun, version, material, consent, language),
                proof,
            )

        return self.writer.do(begin)

    @staticmethod
    def _under_way(begun: Sequence[Content]) -> bool:
        return bool(begun) and begun[-1]["outcome"] is None

    def _new_session(
        self,
        db: sqlite3.Connection,
        observer: int,
        begun: Sequence[Content],
        version: str,
        material: Material,
        consent: str,
        language: str,
    ) -> Content:
        design = material.design
        state = self._state(design, begun)
        if state["name"] != "new":
            raise Closed(state["name"], **state)
        if language not in design.languages:
            raise ValueError(f"There are no texts in {language!r}.")
        if not same(material.texts(language).consent_hash, consent):
            raise ValueError("The consent is to another text; load the page again.")
        who = store.find_observer(db, observer)
        group, place = who["group"], who["place"]
        if group is None or not begun:
            limits = {each.name: each.observers for each in design.groups}
            found = store.put_into_group(db, observer, limits, *design.places_held)
            if found is None:
                raise Closed("closed")
            group, place = found
        trials = material.trials(group, place, len(begun))
        values = {
            "observer": observer,
            "number": len(begun) + 1,
            "version": version,
            "language": language,
            "consent_hash": consent,
            "trials": trials,
        }
        store.add_session(db, values)
        return store.sessions_of(db, observer)[-1]

    def stimuli(self, key: str, session: int) -> Bundle:
        """Return all stimuli of a session by their names, as JSON."""
        row = self.writer.do(lambda db: self._session(db, key, session))
        names = {name for trial in json.loads(row["trials"]) for name in trial["stimuli"]}
        return self.version_material(row["version"]).stimuli(sorted(names))

    def answers(self, key: str, session: int, items: Sequence[Content]) -> list[store.Received]:
        """Keep answers, and return for each what became of it, once that is on disk."""
        return self.submit_answers(key, session, items).result()

    def submit_answers(
        self, key: str, session: int, items: Sequence[Content]
    ) -> Future[list[store.Received]]:
        """Have answers kept; the result comes once they are on disk."""
        who = (hash_of(key), session)

        def add(db: sqlite3.Connection) -> list[store.Received]:
            if who not in self._n_trials:
                self._n_trials[who] = self._n_trials_of(db, *who)
            store.note_seen(db, session)
            return store.add_answers(db, session, items, n_trials=self._n_trials[who])

        return self.writer.submit(add)

    @staticmethod
    def _n_trials_of(db: sqlite3.Connection, key_hash: str, session: int) -> int:
        """Return the number of trials of a session, if the key is that of its observer."""
        owner = store.session_of_link(db, key_hash, session)
        if owner is None:
            raise NotAllowed
        if owner["withdrawn_utc"]:
            raise Gone
        return owner["n_trials"]

    def end(self, key: str, session: int, how: str) -> Content:
        """End a session: finished, stopped with its answers, or deleted with all of them."""

        def finish(db: sqlite3.Connection) -> Content:
            row = self._session(db, key, session)
            if how == "deleted":
                return row
            if how == "finished" and not self._all_answered(db, row):
                raise Closed("not all answers have arrived")
            store.end_session(db, session, how)
            return self._end_content(db, self._session(db, key, session))

        found = self.writer.do(finish)
        return {"deleted": self._withdraw(found["observer"])} if how == "deleted" else found

    def _end_content(self, db: sqlite3.Connection, row: Content) -> Content:
        """Return what the last page of a session shows, also when it is loaded again."""
        recruiting = self.version_material(row["version"]).design.recruiting
        shown = recruiting.model_dump(include={"completion_code", "return_url"})
        return {
            "withdrawal_code": withdrawal_code(store.secret(db), row["observer"]),
            "n_answers": store.n_confirmed(db, row["session"]),
            **(shown if row["outcome"] == "finished" else {}),
        }

    @staticmethod
    def _all_answered(db: sqlite3.Connection, row: Content) -> bool:
        """Whether each trial, and a spare one for each timeout, has an answer that counts.

        An answer that was refused for good counts: its observer can do nothing about it.
        """
        answers = store.answers_of(db, row["session"])
        outcomes = {
            each["trial"]: each["content"].get("outcome")
            for each in answers
            if each["kind"] == "answer" and each["content"].get("outcome") in FINAL
        }
        n_timeouts = sum(outcome == "timeout" for outcome in outcomes.values())
        trials = json.loads(row["trials"])
        spare = [trial["trial"] for trial in trials if trial.get("spare")]
        needed = {trial["trial"] for trial in trials if not trial.get("spare")}
        missing = (needed | set(spare[:n_timeouts])) - set(outcomes)
        refused = store.n_refused(db, row["session"])
        refused += sum(each["content"].get("event") == "refused" for each in answers)
        return len(missing) <= refused

    # ----------------------------------------------------------------------------------- its parts

    def _link(
        self, db: sqlite3.Connection, key: str, kinds: Collection[str] = OBSERVERS
    ) -> Content:
        link = store.find_link(db, hash_of(key))
        if link is None or not same(link["hash"], hash_of(key)) or link["kind"] not in kinds:
            raise NotAllowed
        if link["withdrawn_utc"]:
            raise Gone
        return link

    def _known_observer(
        self, db: sqlite3.Connection, link: Content, site: Mapping[str, str] | None
    ) -> int | None:
        if link["kind"] != "open" or not site:
            return None
        return store.observer_of_site(db, self._site_hash(db, site))

    def _site_hash(self, db: sqlite3.Connection, site: Mapping[str, str]) -> str:
        return keyed_hash(store.secret(db), _identifier(site))

    def _arriving(
        self,
        db: sqlite3.Connection,
        link: Content,
        own_key: str,
        site: Mapping[str, str] | None,
        material: Material,
    ) -> int:
        """Return the observer who comes by a link for many, recognised or new."""
        own = store.find_link(db, hash_of(own_key))
        if own is not None:
            return own["observer"]
        kind = "test" if link["kind"] == "preview" else "real"
        recruiting = material.design.recruiting
        known = {name: text for name, text in (site or {}).items() if name in recruiting.parameters}
        site_hash = self._site_hash(db, known) if known and kind == "real" else None
        observer = store.observer_of_site(db, site_hash) if site_hash else None
        if observer is None:
            observer = store.add_observer(db, kind, site_hash)
            if known and kind == "real" and recruiting.keep_raw:
                store.keep_raw_identifier(db, observer, _identifier(known))
        store.add_link(db, hash_of(own_key), "personal", observer)
        return observer

    def _session(self, db: sqlite3.Connection, key: str, session: int) -> Content:
        """Return a session, if the key is that of its observer."""
        link = self._link(db, key)
        begun = store.sessions_of(db, link["observer"]) if link["observer"] else []
        found = [each for each in begun if each["session"] == session]
        if not found:
            raise NotAllowed
        return found[0]

    @staticmethod
    def _state(design: Any, begun: Sequence[Content]) -> Content:
        """Return whether a session is new, under way, not due yet, or all are over."""
        if not begun:
            return {"name": "new", "session": 1}
        last = begun[-1]
        if last["outcome"] is None:
            return {"name": "under_way", "session": last["number"]}
        if last["outcome"] == "stopped" or len(begun) >= design.n_sessions:
            return {"name": "finished", "session": last["number"], "outcome": last["outcome"]}
        ended = datetime.fromisoformat(last["ended_utc"])
        due = ended + timedelta(hours=design.sessions.least_hours)
        latest = ended + timedelta(hours=design.sessions.most_hours)
        now = datetime.now(UTC)
        name = "not_due" if now < due else "closed" if now > latest else "new"
        return {"name": name, "session": len(begun) + 1, "due_utc": due.isoformat()}

    def _session_content(self, db: sqlite3.Connection, row: Content, proof: str) -> Content:
        """Return what a page needs to run a session, or to go on with it."""
        design = self.version_material(row["version"]).design
        answers = store.answers_of(db, row["session"])
        group = store.find_observer(db, row["observer"])["group"]
        return {
            "session": row["session"],
            "proof": proof,
            "number": row["number"],
            "language": row["language"],
            "trials": trials_for_page(design, json.loads(row["trials"])),
            "group": design.group(group).model_dump(mode="json"),
            "blocks": [block.model_dump(mode="json") for block in design.blocks],
            "picture": design.picture.model_dump(mode="json"),
            "questions": [
                each.model_dump(mode="json") for each in design.questions_in(row["number"])
            ],
            "pace": design.pace.model_dump(mode="json"),
            "screen": design.screen.model_dump(mode="json"),
            "answered": [
                {name: each[name] for name in ("answer", "kind", "trial", "attempt")}
                | {name: each["content"].get(name) for name in ("outcome", "response", "when")}
                | {"at": each["received_utc"]}
                for each in answers
            ],
        }


def _identifier(site: Mapping[str, str]) -> str:
    return json.dumps(dict(site), sort_keys=True)


def received(outcomes: Sequence[store.Received]) -> Content:
    """Return what became of answers, as pages read it."""
    return {
        "confirmed": [each.answer for each in outcomes if each.outcome == "confirmed"],
        "refused": [asdict(each) for each in outcomes if each.outcome != "confirmed"],
    }
