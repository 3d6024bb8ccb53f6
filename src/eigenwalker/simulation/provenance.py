"""The recipe of a simulated population: all that is needed to make the same people walk again."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from eigenwalker.simulation.overground import Route
from eigenwalker.simulation.planted_effect import Pattern
from eigenwalker.simulation.trait_effects import EFFECTS, Effects

CAPTURE = {"variability": 1.0, "wander_mm": 10.0, "noise_mm": 1.0}
"""What a capture is like if nothing else is asked for: strides of healthy adults on a treadmill,
and the millimetre of noise of Troje (2002)."""


@dataclass(frozen=True)
class Recipe:
    """How people were drawn and captured.

    Attributes
    ----------
    n_women, n_men, seed, sex_effect, effects
        As `draw_people` takes them.
    planted : dict of trait to Pattern
    capture : dict
        As `simulate_walk` takes it.

    """

    n_women: int
    n_men: int
    seed: int
    sex_effect: float
    effects: Effects
    planted: Mapping[str, Pattern]
    capture: Mapping[str, Any]

    def as_text(self) -> str:
        """Return the recipe as JSON; the usual effects go without saying."""
        known: dict[str, Any] = {
            "n_women": self.n_women,
            "n_men": self.n_men,
            "seed": self.seed,
            "sex_effect": self.sex_effect,
            "capture": {
                name: asdict(value) if isinstance(value, Route) else value
                for name, value in self.capture.items()
            },
        }
        if self.effects is not EFFECTS:
            known["effects"] = {trait: dict(sizes) for trait, sizes in self.effects.items()}
        if self.planted:
            known["planted"] = {trait: _numbers(each) for trait, each in self.planted.items()}
        return json.dumps(known, default=lambda number: number.item())  # of numpy


def read_recipe(text: str) -> Recipe:
    """Return the recipe that a population carries."""
    known = json.loads(text)
    capture = dict(known.pop("capture", {"markers": "skin", **CAPTURE}))
    if capture.get("route") is not None:
        capture["route"] = Route(**capture["route"])
    return Recipe(
        effects=known.pop("effects", EFFECTS),
        planted={trait: _pattern(each) for trait, each in known.pop("planted", {}).items()},
        capture=capture,
        **known,
    )


def _numbers(pattern: Pattern) -> dict[str, object]:
    return {
        "structure": np.asarray(pattern.structure).tolist(),
        "movement": np.asarray(pattern.movement).tolist(),
        "frequency_hz": pattern.frequency_hz,
    }


def _pattern(numbers: dict) -> Pattern:
    return Pattern(
        np.array(numbers["structure"]), np.array(numbers["movement"]), numbers["frequency_hz"]
    )
