"""How simulated observers answer: traits through noise, ratings on own scales, distances."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from typing import Any

import numpy as np

from eigenwalker.experiment.design import (
    POSITIVE,
    Adjustment,
    AnyBlock,
    Choice,
    Condition,
    Design,
    Detection,
    OddOneOut,
    Rating,
    SameOrDifferent,
    SimilarPair,
)
from eigenwalker.experiment.experiment_folder import Material
from eigenwalker.experiment.order import Trial


@dataclass(frozen=True)
class ObserverModel:
    """How simulated observers answer, and how they differ."""

    sensitivity: float = 1.5
    """d' a standard deviation of the walkers along the trait, from the front."""
    sensitivity_sd: float = 0.2
    """Spread of the logarithm of the sensitivity over observers."""
    view_loss: float = 0.5
    """Share of the sensitivity that is lost in profile."""
    structure: float = 0.6
    """Share of the sensitivity that is left where walkers show their structure only."""
    dynamics: float = 0.9
    """Share of the sensitivity that is left where walkers show their dynamics only."""
    bias_sd: float = 0.3
    lapse: float = 0.02
    """Share of answers that are given by chance."""
    scale_sd: float = 0.2
    """Spread of raters' use of the scale: the logarithm of their factor, and their shift."""
    missed: float = 0.01
    """Share of showings without an answer."""

    def draw(self, observer: int, rng: np.random.Generator) -> Truth:
        """Return one observer."""
        return Truth(
            observer,
            sensitivity=self.sensitivity * float(np.exp(rng.normal(0, self.sensitivity_sd))),
            bias=float(rng.normal(0, self.bias_sd)),
            gain=float(np.exp(rng.normal(0, self.scale_sd))),
            shift=float(rng.normal(0, self.scale_sd)),
            view_loss=self.view_loss,
            structure=self.structure,
            dynamics=self.dynamics,
            lapse=self.lapse,
            missed=self.missed,
        )


@dataclass(frozen=True)
class Truth:
    """What one observer is like."""

    observer: int
    sensitivity: float
    bias: float
    """Toward the second choice, in standard deviations of the noise."""
    gain: float
    shift: float
    """Of ratings, in steps."""
    view_loss: float
    structure: float
    dynamics: float
    lapse: float
    missed: float

    def seen_with(self, view_deg: float, information: str) -> float:
        """Return the sensitivity for a view and for what walkers show."""
        turned = abs(math.sin(math.radians(view_deg)))
        left = {"structure": self.structure, "dynamics": self.dynamics}.get(information, 1.0)
        return self.sensitivity * (1 - self.view_loss * turned) * left


@dataclass(frozen=True)
class Scene:
    """What there is to see: where all walkers are, along traits and among each other."""

    design: Design
    walker_names: Sequence[str]
    scores: np.ndarray
    directions: Mapping[str, np.ndarray]
    """For each pair of choices, scale, or trait: where each walker is, standardised."""
    classes: Mapping[str, Sequence[str]]

    @classmethod
    def of(cls, material: Material) -> Scene:
        """Return what the walkers of an experiment have to see."""
        scores = np.array(material.people["scores"])
        classes = material.people["classes"]
        design = material.design
        names = dict.fromkeys(_judged(design))
        found = {name: _along(scores, classes, name, design.seed) for name in names}
        return cls(design, material.walker_names, scores, found, classes)

    def place_along(self, trial: Trial, choices: Sequence[str], name: str) -> float:
        """Return where what a trial shows is along a trait, as its condition moved it."""
        known = {each.name: each for each in self.design.conditions}
        walkers = trial["walkers"]
        place = float(self.directions[name][walkers[0]]) if walkers else 0.0
        condition = known.get(trial["condition"])
        if condition is None or condition.trait is None:
            return place
        return place + condition.alpha * self._sign(condition, choices, walkers)

    def _sign(self, condition: Condition, choices: Sequence[str], walkers: Sequence[int]) -> float:
        """Return the way along a trait: 1 toward the second choice, -1 toward the first."""
        toward = condition.toward
        if toward == POSITIVE:
            toward = sorted(choices)[-1]
        if toward is None and walkers:
            labels = [each for each in self.classes.values() if set(each) == set(choices)]
            toward = labels[0][walkers[0]] if labels else choices[-1]
        return {choices[0]: -1.0, choices[-1]: 1.0}.get(str(toward), 0.0)

    def apart(self, trial: Trial, one: int, other: int) -> float:
        """Return how far two figures are apart; walkers are 1 apart at the median."""
        first, second = (trial["walkers"][place] for place in (one, other))
        along = [self._weight(trial, place) for place in (one, other)]
        distance = float(np.linalg.norm(self.scores[first] - self.scores[second]))
        return distance / self._usual + abs(along[0] - along[1])

    def _weight(self, trial: Trial, place: int) -> float:
        """Return the weight of a figure's condition; of others, their place in the design."""
        name = trial.get("conditions", [None] * 4)[place]
        for number, condition in enumerate(self.design.conditions):
            if condition.name == name:
                return condition.alpha if condition.trait else float(number)
        return {"structure": 1.0, "dynamics": 2.0}.get(str(name), 0.0)

    @cached_property
    def _usual(self) -> float:
        apart = self.scores[:, None] - self.scores[None]
        distances = np.linalg.norm(apart, axis=-1)
        return float(np.median(distances[np.triu_indices(len(distances), 1)]))


def _judged(design: Design) -> list[str]:
    names: list[str] = []
    for block in design.blocks:
        if isinstance(block, Choice):
            names.append("/".join(block.choices))
        elif isinstance(block, Rating):
            names += [str(block.scale or group.scale) for group in design.groups]
        elif isinstance(block, Adjustment):
            names.append(block.trait)
    return names


def _along(
    scores: np.ndarray, classes: Mapping[str, Sequence[str]], name: str, seed: int
) -> np.ndarray:
    """Return where walkers are along the difference of two classes; else along what is drawn."""
    ends = name.split("/")
    labels = next((each for each in classes.values() if set(each) == set(ends)), None)
    if labels is None and name in classes:
        labels, ends = classes[name], sorted(set(classes[name]))
    if labels is not None:
        last = np.array(labels) == ends[-1]
        axis = scores[last].mean(axis=0) - scores[~last].mean(axis=0)
    else:
        axis = np.random.default_rng([seed, *name.encode()]).normal(size=scores.shape[1])
    along = scores @ axis
    return (along - along.mean()) / along.std()


@dataclass
class Judgement:
    """One observer who answers trials."""

    scene: Scene
    group: str
    truth: Truth
    rng: np.random.Generator

    def response(self, block: AnyBlock, trial: Trial, level: int | None = None) -> Any:
        """Return the answer to a trial, as the page would report it."""
        lapses = self.rng.random() < self.truth.lapse
        if trial.get("catch") and not lapses:
            right = trial["correct"][self.rng.integers(len(trial["correct"]))]
            return int(right) if isinstance(block, Rating) else right
        match block:
            case Choice():
                return self._choice(block, trial, lapses)
            case Rating():
                return self._rating(block, trial, lapses)
            case Detection():
                assert level is not None
                return self._detection(block, trial, trial["levels"][level], lapses)
            case Adjustment():
                return self._setting(block, trial, lapses)
            case SameOrDifferent():
                return self._same(block, trial, lapses)
            case OddOneOut():
                return self._odd(block, trial, lapses)
            case SimilarPair():
                return self._pair(trial, lapses)

    def _noise(self) -> float:
        return float(self.rng.normal())

    def _sensitivity(self, trial: Trial) -> float:
        return self.truth.seen_with(trial["view_deg"], trial["information"])

    def _choice(self, block: Choice, trial: Trial, lapses: bool) -> str:
        place = self.scene.place_along(trial, block.choices, "/".join(block.choices))
        seen = place * self._sensitivity(trial) / 2 + self._noise() + self.truth.bias
        return block.choices[int((self._noise() if lapses else seen) > 0)]

    def _rating(self, block: Rating, trial: Trial, lapses: bool) -> int:
        scale = str(block.scale or self.scene.design.group(self.group).scale)
        place = self.scene.place_along(trial, ("", scale), scale)
        seen = place + self._noise() / self._sensitivity(trial)
        middle = (block.steps + 1) / 2
        step = middle + self.truth.shift + self.truth.gain * seen * block.steps / 5
        if lapses:
            step = self.rng.uniform(0.5, block.steps + 0.5)
        return int(np.clip(np.round(step), 1, block.steps))

    def _detection(self, block: Detection, trial: Trial, dots: int, lapses: bool) -> str:
        """Ten dots in the mask leave the sensitivity as it is; it falls with their root."""
        there = 1.0 if trial["correct"] == block.choices[0] else -1.0
        seen = there * self.truth.sensitivity * math.sqrt(10 / dots)
        seen = self._noise() if lapses else seen + self._noise() + self.truth.bias
        return block.choices[0] if seen > 0 else block.choices[1]

    def _setting(self, block: Adjustment, trial: Trial, lapses: bool) -> float:
        """The weight at which neither class is seen; the same place as the bias of choices."""
        own = self.scene.directions[block.trait][trial["walkers"][0]] if trial["walkers"] else 0.0
        sensitivity = self._sensitivity(trial)
        wanted = -own + (self._noise() - 2 * self.truth.bias) / sensitivity
        if lapses:
            wanted = self.rng.uniform(block.lowest, block.highest)
        return min(trial["levels"], key=lambda level: abs(level - wanted))

    def _same(self, block: SameOrDifferent, trial: Trial, lapses: bool) -> str:
        """Different is what looks more than half the usual distance apart."""
        sensitivity = self._sensitivity(trial)
        seen = sensitivity * (self.scene.apart(trial, 0, 1) - 0.5) + self._noise()
        seen = self._noise() if lapses else seen + self.truth.bias
        return block.choices[int(seen > 0)]

    def _odd(self, block: OddOneOut, trial: Trial, lapses: bool) -> int:
        """The one that is farthest from the others."""
        places = range(block.figures)
        noise = self.rng.gumbel(size=block.figures) / self._sensitivity(trial)
        far = [
            sum(self.scene.apart(trial, one, other) for other in places) / (block.figures - 1)
            for one in places
        ]
        return int(np.argmax(noise if lapses else noise + far))

    def _pair(self, trial: Trial, lapses: bool) -> list[int]:
        """The two that are least apart."""
        pairs = [*combinations(range(4), 2)]
        noise = self.rng.gumbel(size=6) / (3 * self._sensitivity(trial))
        apart = np.array([self.scene.apart(trial, *pair) for pair in pairs])
        return [*pairs[int(np.argmax(noise if lapses else noise - apart))]]
