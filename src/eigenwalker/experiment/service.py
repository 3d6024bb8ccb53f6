"""What pages ask of an experiment: its welcome, a session, stimuli, answers, the end."""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

from eigenwalker.experiment import store
from eigenwalker.experiment.answer_writer import AnswerWriter
from eigenwalker.experiment.backup import forget_in_copies
from eigenwalker.experiment.experiment_folder import DESIGN, VERSIONS, Material
from eigenwalker.experiment.lab_page import lab_page
from eigenwalker.experiment.link_keys import hash_of, keyed_hash, new_key, same, withdrawal_code
from eigenwalker.experiment.order import session_trials
from eigenwalker.experiment.rescue import take_items
from eigenwalker.experiment.status import experiment_status

Content = dict[str, Any]
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
        sessions = [each["session"] for each in self._sessions(observer)]
        n_answers = self.writer.do(lambda db: store.withdraw_observer(db, observer))
        self.writer.do(store.remove_bytes, alone=True)
        forget_in_copies(self.folder, sessions)
        return n_answers

    # --------------------------------------------------------------------------------- for the lab

    def lab_page(self, key: str) -> str:
        """Return the page of the lab, for the key of the lab."""
        if self._link(key)["kind"] != "lab":
            raise NotAllowed
        return lab_page(experiment_status(self.folder), self.writer.trouble)

    def rescue(self, content: dict[str, Any]) -> list[str]:
        """Take answers of a file, and say of each what became of it."""
        return self.writer.do(lambda db: take_items(db, content))

    def simulate(self, number: int, seed: int) -> str:
        """Add simulated observers with all their answers; return the file of the truth."""
        from eigenwalker.experiment.simulated_observers import simulate_observers

        return str(simulate_observers(self, number, seed))

    # --------------------------------------------------------------------------------- for pages

    def welcome(self, key: str, site: Mapping[str, str] | None = None) -> Content:
        """Return what the first page shows; nothing is used up and nothing begins."""
        link = self._link(key)
        if link["kind"] == "lab":
            raise NotAllowed
        observer = link["observer"] or self._known_observer(link, site)
        begun = [] if observer is None else self._sessions(observer)
        under_way = [each for each in begun if each["outcome"] is None]
        version = under_way[-1]["version"] if under_way else None
        material = self.version_material(version or self.keep_version())
        design = material.design
        texts = {name: material.texts(name) for name in design.languages}
        return {
            "name": design.name,
            "state": self._state(design, begun),
            "languages": {name: each.for_page for name, each in texts.items()},
            "consent": {name: each.consent_hash for name, each in texts.items()},
            "test": link["kind"] == "preview" or link["observer_kind"] == "test",
            "personal": link["observer"] is not None,
            "phones": design.screen.phones,
            "site_parameters": design.recruiting.parameters,
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
        link = self._link(key)
        if link["kind"] == "lab":
            raise NotAllowed
        begun = self._sessions(link["observer"]) if link["observer"] else []
        if begun and begun[-1]["outcome"] is None:
            self.writer.do(lambda db: store.note_seen(db, begun[-1]["session"]))
            return self._session_content(begun[-1], hash_of(key))
        version = self.keep_version()
        material = self.version_material(version)

        def begin(db: sqlite3.Connection) -> Content:
            observer = link["observer"] or self._arriving(db, link, own_key, site, material)
            begun = store.sessions_of(db, observer)
            if begun and begun[-1]["outcome"] is None:
                store.note_seen(db, begun[-1]["session"])
                return begun[-1]
            return self._new_session(db, observer, begun, version, material, consent, language)

        return self._session_content(self.writer.do(begin), hash_of(own_key or key))

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
            found = store.put_into_group(db, observer, limits, design.pace.hold_place_min)
            if found is None:
                raise Closed("closed")
            group, place = found
        trials = session_trials(
            design, material.walkers, group=group, place=place, session=len(begun)
        )
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

    def stimuli(self, key: str, session: int) -> str:
        """Return all stimuli of a session by their names, as JSON."""
        row = self._session(key, session)
        material = self.version_material(row["version"])
        names = {name for trial in json.loads(row["trials"]) for name in trial["stimuli"]}
        parts = [f"{json.dumps(name)}:{material.stimulus_text(name)}" for name in sorted(names)]
        return "{" + ",".join(parts) + "}"

    def answers(self, key: str, session: int, items: Sequence[Content]) -> list[store.Received]:
        """Keep answers, and return for each what became of it, once that is on disk."""

        def add(db: sqlite3.Connection) -> list[store.Received]:
            owner = store.session_of_link(db, hash_of(key), session)
            if owner is None:
                raise NotAllowed
            if owner["withdrawn_utc"]:
                raise Gone
            store.note_seen(db, session)
            return store.add_answers(db, session, items)

        return self.writer.do(add)

    def end(self, key: str, session: int, how: str) -> Content:
        """End a session: finished, stopped with its answers, or deleted with all of them."""
        row = self._session(key, session)
        if how == "deleted":
            return {"deleted": self._withdraw(row["observer"])}
        if how == "finished" and not self._all_answered(row):
            raise Closed("not all answers have arrived")
        self.writer.do(lambda db: store.end_session(db, session, how))
        recruiting = self.version_material(row["version"]).design.recruiting
        code = self.writer.do(lambda db: withdrawal_code(store.secret(db), row["observer"]))
        shown = {"completion_code": recruiting.completion_code, "return_url": recruiting.return_url}
        n_answers = self.writer.do(lambda db: store.n_confirmed(db, session))
        return {
            "withdrawal_code": code,
            "n_answers": n_answers,
            **(shown if how == "finished" else {}),
        }

    def _all_answered(self, row: Content) -> bool:
        """Whether each trial, and a spare one for each timeout, has an answer that counts.

        An answer that was refused for good counts: its observer can do nothing about it.
        """
        answers = self.writer.do(lambda db: store.answers_of(db, row["session"]))
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
        refused = self.writer.do(lambda db: store.n_refused(db, row["session"]))
        refused += sum(each["content"].get("event") == "refused" for each in answers)
        return len(missing) <= refused

    # ----------------------------------------------------------------------------------- its parts

    def _link(self, key: str) -> Content:
        link = self.writer.do(lambda db: store.find_link(db, hash_of(key)))
        if link is None or not same(link["hash"], hash_of(key)):
            raise NotAllowed
        if link["withdrawn_utc"]:
            raise Gone
        return link

    def _known_observer(self, link: Content, site: Mapping[str, str] | None) -> int | None:
        if link["kind"] != "open" or not site:
            return None
        return self.writer.do(lambda db: store.observer_of_site(db, self._site_hash(db, site)))

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

    def _sessions(self, observer: int) -> list[Content]:
        return self.writer.do(lambda db: store.sessions_of(db, observer))

    def _session(self, key: str, session: int) -> Content:
        """Return a session, if the key is that of its observer."""
        link = self._link(key)
        begun = self._sessions(link["observer"]) if link["observer"] else []
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
            return {"name": "finished", "session": last["number"]}
        ended = datetime.fromisoformat(last["ended_utc"])
        due = ended + timedelta(hours=design.sessions.least_hours)
        latest = ended + timedelta(hours=design.sessions.most_hours)
        now = datetime.now(UTC)
        name = "not_due" if now < due else "closed" if now > latest else "new"
        return {"name": name, "session": len(begun) + 1, "due_utc": due.isoformat()}

    def _session_content(self, row: Content, proof: str) -> Content:
        """Return what a page needs to run a session, or to go on with it."""
        design = self.version_material(row["version"]).design
        answers = self.writer.do(lambda db: store.answers_of(db, row["session"]))
        group = self.writer.do(lambda db: store.find_observer(db, row["observer"])["group"])
        return {
            "session": row["session"],
            "proof": proof,
            "number": row["number"],
            "language": row["language"],
            "trials": json.loads(row["trials"]),
            "group": design.group(group).model_dump(mode="json"),
            "blocks": [block.model_dump(mode="json") for block in design.blocks],
            "picture": design.picture.model_dump(mode="json"),
            "questions": [each.model_dump(mode="json") for each in design.questions],
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
