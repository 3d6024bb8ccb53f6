"""Observers of known truth, who answer the designs of an experiment."""

from __future__ import annotations

import csv
import sqlite3
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from eigenwalker.experiment import store
from eigenwalker.experiment.design import Design, Detection
from eigenwalker.experiment.experiment_folder import Material
from eigenwalker.experiment.observer_model import Judgement, ObserverModel, Scene, Truth
from eigenwalker.experiment.order import Trial
from eigenwalker.experiment.service import Service
from eigenwalker.experiment.staircase import next_level

TRUTH = "simulated_truth.csv"
_HEAD = ("what", "name", "of", "value")


def simulate_observers(
    service: Service, number: int, seed: int, model: ObserverModel | None = None
) -> Path:
    """Have simulated observers answer all their sessions; return the file of the truth.

    They count in no group, and freeze nothing.
    """
    model = model or ObserverModel()
    version = service.keep_version()
    material = service.version_material(version)
    scene = Scene.of(material)
    truths: list[Truth] = []
    for n in range(number):
        rng = np.random.default_rng([seed, n])

        def add(db: sqlite3.Connection, rng: np.random.Generator = rng) -> Truth:
            return _one_observer(db, material, version, scene, model, rng)

        truths.append(service.writer.do(add))
    return write_truth(service.folder / TRUTH, truths, scene)


def _one_observer(
    db: sqlite3.Connection,
    material: Material,
    version: str,
    scene: Scene,
    model: ObserverModel,
    rng: np.random.Generator,
) -> Truth:
    design = material.design
    observer = store.add_observer(db, "simulated")
    limits = {each.name: each.observers for each in design.groups}
    found = store.put_into_group(db, observer, limits, *design.places_held)
    assert found is not None
    truth = model.draw(observer, rng)
    for session in range(design.n_sessions):
        trials = material.trials(*found, session)
        language = design.languages[0]
        row = store.add_session(
            db,
            {
                "observer": observer,
                "number": session + 1,
                "version": version,
                "language": language,
                "consent_hash": material.texts(language).consent_hash,
                "trials": trials,
            },
        )
        judgement = Judgement(scene, found[0], truth, rng)
        items = _Session(design, session + 1, judgement, rng).items(trials)
        store.add_answers(db, row, items, "simulation")
        store.end_session(db, row, "finished")
    return truth


@dataclass
class _Session:
    """What the page of one observer would report in one session."""

    design: Design
    number: int
    judgement: Judgement
    rng: np.random.Generator
    _right: dict[int, list[bool]] = field(default_factory=dict)
    """Of the detections so far, by block."""

    def items(self, trials: Sequence[Trial]) -> list[dict[str, Any]]:
        """Return items in their order, with trials that are missed and shown again."""
        items = [*self._questions("before")]
        spare = [trial for trial in trials if trial.get("spare")]
        waiting = [trial for trial in trials if not trial.get("spare")]
        while waiting:
            trial = waiting.pop(0)
            showing = 1
            while self.rng.random() < self.judgement.truth.missed:
                if trial["task"] != "similar_pair":
                    items += self._showing(trial, showing, "none")
                    showing += 1
                    continue
                items += self._showing(trial, showing, "timeout")
                if not spare:
                    break
                trial, showing = spare.pop(0), 1
            else:
                items += self._showing(trial, showing, "answered")
        return [*items, *self._questions("after")]

    def _showing(self, trial: Trial, showing: int, outcome: str) -> list[dict[str, Any]]:
        block = self.design.blocks[trial["block"] - 1]
        content: dict[str, Any] = {"response": None, "outcome": outcome}
        level: int | None = None
        if isinstance(block, Detection):
            right = self._right.setdefault(trial["block"], [])
            level = next_level(
                right, start=block.start, n_levels=len(block.mask_dots), down=block.down
            )
            content |= {"level": trial["levels"][level], "stimulus": trial["stimuli"][level]}
        if outcome == "answered":
            response = self.judgement.response(block, trial, level)
            rt = min(float(np.exp(self.rng.normal(7.2, 0.35))), self._longest_ms(trial))
            content |= {"response": response, "response_by": "key", "rt_ms": round(rt, 3)}
            if isinstance(block, Detection):
                right.append(response == trial["correct"])
            elif trial["task"] == "adjustment":
                place = trial["levels"].index(response)
                content |= {"response_by": "button", "stimulus": trial["stimuli"][place]}
        return [
            self._item(kind, reported, trial["trial"], showing)
            for kind, reported in (("begun", {}), ("answer", content))
        ]

    def _longest_ms(self, trial: Trial) -> float:
        block = self.design.blocks[trial["block"] - 1]
        known = {each.name: each.duration_s for each in self.design.conditions}
        if trial["task"] == "adjustment":
            return 600_000.0
        limit_s = getattr(block, "limit_s", None) or known.get(trial["condition"])
        return 1000 * max(limit_s or 0, self.design.picture.duration_s) - 1

    def _item(
        self,
        kind: str,
        content: dict[str, Any],
        trial: int | None = None,
        showing: int | None = None,
    ) -> dict[str, Any]:
        return {
            "answer": f"simulated-{self.judgement.truth.observer}-{self.rng.bytes(8).hex()}",
            "kind": kind,
            "trial": trial,
            "attempt": showing,
            "content": content,
        }

    def _questions(self, when: str) -> list[dict[str, Any]]:
        """Answers to questions, by chance."""
        wanted = [each for each in self.design.questions_in(self.number) if each.when == when]
        if not wanted:
            return []
        answers: dict[str, str] = {}
        for question in wanted:
            low, high = question.least, question.most
            low = (high - 50 if high is not None else 18) if low is None else low
            high = low + 50 if high is None else high
            answers[question.name] = {
                "text": "simulated",
                "number": f"{np.round(self.rng.uniform(low, high)):g}",
                "choice": str(self.rng.choice(question.options or [""])),
            }[question.kind]
        return [self._item("questions", {"when": when, "answers": answers})]


def write_truth(path: Path, truths: Sequence[Truth], scene: Scene) -> Path:
    """Add what the observers are like, and where the walkers are along each trait."""
    rows: list[tuple[str, str, str, str]] = []
    for truth in truths:
        values: Mapping[str, Any] = asdict(truth)
        observer = str(values["observer"])
        rows += [
            ("observer", name, observer, repr(round(value, 6)))
            for name, value in values.items()
            if name != "observer"
        ]
    for name, along in scene.directions.items():
        for walker, value in zip(scene.walker_names, along.tolist(), strict=True):
            rows.append(("walker", name, walker, repr(round(value, 6))))
    known: list[tuple[str, ...]] = []
    if path.exists():
        with path.open(encoding="utf-8", newline="") as file:
            known = [tuple(row) for row in csv.reader(file)][1:]
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerows([_HEAD, *dict.fromkeys([*known, *rows])])
    return path
