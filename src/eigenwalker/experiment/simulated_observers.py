"""Observers of known truth: they see traits through noise, rate on own scales, compare pairs."""

from __future__ import annotations

import csv
import math
import sqlite3
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np

from eigenwalker.experiment import store
from eigenwalker.experiment.design import Choice, Design, Detection, Rating, SimilarPair
from eigenwalker.experiment.experiment_folder import Material
from eigenwalker.experiment.order import Trial
from eigenwalker.experiment.service import Service
from eigenwalker.experiment.staircase import next_level

TRUTH = "simulated_truth.csv"


@dataclass(frozen=True)
class Model:
    """How simulated observers answer."""

    sensitivity: float = 1.5
    """d' a standard deviation of the walkers along the trait, from the front."""
    view_loss: float = 0.5
    """Share of the sensitivity that is lost in profile."""
    bias_sd: float = 0.3
    lapse: float = 0.02
    scale_sd: float = 0.2
    """Spread of raters' use of the scale: their factor and their shift in steps."""
    missed: float = 0.01
    """Share of showings without an answer."""


@dataclass(frozen=True)
class Truth:
    """What one observer is like."""

    observer: int
    bias: float
    gain: float
    shift: float


def simulate_observers(
    service: Service, number: int, seed: int, model: Model | None = None
) -> Path:
    """Have simulated observers answer all their sessions; return the file of the truth.

    They count in no group, and freeze nothing.
    """
    model = model or Model()
    version = service.keep_version()
    material = service.version_material(version)
    directions = _directions(material, seed)
    truths: list[Truth] = []
    for n in range(number):
        rng = np.random.default_rng([seed, n])

        def add(db: sqlite3.Connection, rng: np.random.Generator = rng) -> Truth:
            return _one_observer(db, material, version, directions, model, rng)

        truths.append(service.writer.do(add))
    return _write_truth(service.folder / TRUTH, truths, directions, material)


def _one_observer(
    db: sqlite3.Connection,
    material: Material,
    version: str,
    directions: dict[str, np.ndarray],
    model: Model,
    rng: np.random.Generator,
) -> Truth:
    from eigenwalker.experiment.order import session_trials

    design = material.design
    observer = store.add_observer(db, "simulated")
    limits = {each.name: each.observers for each in design.groups}
    found = store.put_into_group(db, observer, limits, design.pace.hold_place_min)
    assert found is not None
    truth = Truth(
        observer,
        bias=float(rng.normal(0, model.bias_sd)),
        gain=float(np.exp(rng.normal(0, model.scale_sd))),
        shift=float(rng.normal(0, model.scale_sd)),
    )
    for session in range(design.n_sessions):
        trials = session_trials(
            design, material.walkers, group=found[0], place=found[1], session=session
        )
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
        answering = _Answering(design, found[0], directions, _scores(material), model, truth, rng)
        store.add_answers(db, row, answering.items(trials), "simulation")
        store.end_session(db, row, "finished")
    return truth


def _scores(material: Material) -> np.ndarray:
    return np.array(material.people["scores"])


def _directions(material: Material, seed: int) -> dict[str, np.ndarray]:
    """Return for each trait or scale the scores of all walkers along it, standardised.

    A trait of two classes lies along the difference of their means; a scale's direction is drawn.
    """
    scores = _scores(material)
    found: dict[str, np.ndarray] = {}
    names: list[tuple[str, Sequence[str] | None]] = []
    for block in material.design.blocks:
        if isinstance(block, Choice):
            names.append(("/".join(block.choices), block.choices))
        elif isinstance(block, Rating):
            names += [(str(block.scale or g.scale), None) for g in material.design.groups]
    for number, (name, classes) in enumerate(names):
        axis = np.random.default_rng([seed, 1_000_000 + number]).normal(size=scores.shape[1])
        labels = next(
            (
                each
                for each in material.people["classes"].values()
                if set(each) == set(classes or ())
            ),
            None,
        )
        if labels is not None and classes is not None:
            last = np.array(labels) == classes[-1]
            axis = scores[last].mean(axis=0) - scores[~last].mean(axis=0)
        along = scores @ axis
        found.setdefault(name, (along - along.mean()) / along.std())
    return found


@dataclass(frozen=True)
class _Answering:
    """One observer in one session."""

    design: Design
    group: str
    directions: dict[str, np.ndarray]
    scores: np.ndarray
    model: Model
    truth: Truth
    rng: np.random.Generator

    _right: list[bool] = field(default_factory=list)
    """Of the detections so far."""

    def items(self, trials: Sequence[Trial]) -> list[dict[str, Any]]:
        """Return what a page would report, with trials that are missed and shown again."""
        items: list[dict[str, Any]] = []
        spare = [trial for trial in trials if trial.get("spare")]
        waiting = [trial for trial in trials if not trial.get("spare")]
        while waiting:
            trial = waiting.pop(0)
            showing = 1
            while self.rng.random() < self.model.missed:
                outcome = "timeout" if trial["task"] == "similar_pair" else "none"
                items += self._showing(trial, showing, None, outcome)
                if outcome == "timeout":
                    trial, showing = spare.pop(0), 0
                showing += 1
            items += self._showing(trial, showing, self._response(trial), "answered")
        return items

    def _showing(
        self, trial: Trial, showing: int, response: Any, outcome: str
    ) -> list[dict[str, Any]]:
        content = {"response": response, "outcome": outcome}
        block = self.design.blocks[trial["block"] - 1]
        if isinstance(block, Detection):
            level = self._level(block)
            content |= {"level": trial["levels"][level], "stimulus": trial["stimuli"][level]}
            if outcome == "answered":
                self._right.append(response == trial["correct"])
        if response is not None:
            rt = float(np.exp(self.rng.normal(7.2, 0.35)))
            content |= {"response_by": "key", "rt_ms": round(rt, 3)}
        return [
            {
                "answer": f"simulated-{self.truth.observer}-{self.rng.bytes(8).hex()}",
                "kind": kind,
                "trial": trial["trial"],
                "attempt": showing,
                "content": reported,
            }
            for kind, reported in (("begun", {}), ("answer", content))
        ]

    def _sensitivity(self, view_deg: float) -> float:
        turned = abs(math.sin(math.radians(view_deg)))
        return self.model.sensitivity * (1 - self.model.view_loss * turned)

    def _response(self, trial: Trial) -> Any:
        block = self.design.blocks[trial["block"] - 1]
        lapses = self.rng.random() < self.model.lapse
        if isinstance(block, SimilarPair):
            return self._pair(trial, lapses)
        if isinstance(block, Detection):
            return self._detection(block, trial, lapses)
        walker = trial["walkers"][0]
        if isinstance(block, Choice):
            signal = self.directions["/".join(block.choices)][walker]
            signal += self._moved(trial) * np.sign(signal)
            seen = signal * self._sensitivity(trial["view_deg"]) / 2 + self.rng.normal()
            seen = self.rng.normal() if lapses else seen + self.truth.bias
            return block.choices[int(seen > 0)]
        assert isinstance(block, Rating)
        scale = str(block.scale or self.design.group(self.group).scale)
        seen = self.directions[scale][walker] + self.rng.normal() / self._sensitivity(
            trial["view_deg"]
        )
        middle = (block.steps + 1) / 2
        step = middle + self.truth.shift + self.truth.gain * seen * block.steps / 5
        if lapses:
            step = self.rng.uniform(0.5, block.steps + 0.5)
        return int(np.clip(np.round(step), 1, block.steps))

    def _level(self, block: Detection) -> int:
        n_levels = len(block.mask_dots)
        return next_level(self._right, start=block.start, n_levels=n_levels, down=block.down)

    def _detection(self, block: Detection, trial: Trial, lapses: bool) -> str:
        """Ten dots in the mask leave the sensitivity as it is; it falls with their root."""
        dots = trial["levels"][self._level(block)]
        there = 0.5 if trial["correct"] == block.choices[0] else -0.5
        seen = there * 2 * self.model.sensitivity * math.sqrt(10 / dots)
        seen = self.rng.normal() if lapses else seen + self.rng.normal() + self.truth.bias
        return block.choices[0] if seen > 0 else block.choices[1]

    def _moved(self, trial: Trial) -> float:
        """How far the condition moves a walker toward the extreme of its class."""
        known = {each.name: each.alpha for each in self.design.conditions}
        return known.get(trial["condition"], 0.0)

    def _pair(self, trial: Trial, lapses: bool) -> list[int]:
        pairs = list(combinations(range(4), 2))
        if lapses:
            return list(pairs[self.rng.integers(6)])
        places = self.scores[trial["walkers"]]
        apart = [np.linalg.norm(places[a] - places[b]) for a, b in pairs]
        noise = self.rng.gumbel(size=6) / self.model.sensitivity
        return list(pairs[int(np.argmax(noise - np.array(apart)))])


def _write_truth(
    path: Path, truths: Sequence[Truth], directions: dict[str, np.ndarray], material: Material
) -> Path:
    """Write what the observers are like, and where the walkers are along each trait."""
    is_new = not path.exists()
    with path.open("a", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        if is_new:
            writer.writerow(["what", "name", "of", "value"])
        for truth in truths:
            for name in ("bias", "gain", "shift"):
                writer.writerow(["observer", name, truth.observer, repr(getattr(truth, name))])
        for name, along in directions.items():
            for walker, value in zip(material.walker_names, along.tolist(), strict=True):
                writer.writerow(["walker", name, walker, repr(round(value, 6))])
    return path
