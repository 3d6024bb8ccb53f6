"""How a simulated population was made: all that is needed to simulate the same people again."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from eigenwalker.simulation.overground import Route
from eigenwalker.simulation.planted_effect import PlantedEffect
from eigenwalker.simulation.trait_effects import EFFECTS, Effects

KEY = "recipe"
"""Entry of a population's provenance that holds it."""
CAPTURE = {"variability": 1.0, "wander_mm": 10.0, "noise_mm": 1.0}
"""How captures are made by default: strides of healthy adults on a treadmill, and the millimetre of
noise of Troje (2002)."""


@dataclass(frozen=True)
class Provenance:
    """How people were drawn, as `draw_people` takes it, and captured, as `simulate_walk` does."""

    n_women: int
    n_men: int
    seed: int
    sex_effect: float
    effects: Effects
    planted: Mapping[str, PlantedEffect]
    capture: Mapping[str, Any]

    def to_json(self) -> str:
        """Return it as JSON, without what is as by default."""
        content = dict(vars(self))
        if self.effects is EFFECTS:
            del content["effects"]
        if not self.planted:
            del content["planted"]
        return json.dumps(content, default=_plain)


def provenance_from_json(text: str) -> Provenance:
    """Return the provenance that a population carries."""
    content = json.loads(text)
    capture = content.pop("capture", {"markers": "skin", **CAPTURE})
    if capture.get("route") is not None:
        capture["route"] = Route(**capture["route"])
    planted = {
        trait: PlantedEffect(
            np.array(each["structure"]), np.array(each["movement"]), each["frequency_hz"]
        )
        for trait, each in content.pop("planted", {}).items()
    }
    effects = content.pop("effects", EFFECTS)
    return Provenance(effects=effects, planted=planted, capture=capture, **content)


def _plain(value: Any) -> Any:
    """Return mappings, dataclasses and numbers of numpy as JSON knows them."""
    if isinstance(value, Route | PlantedEffect):
        return asdict(value)
    return dict(value) if isinstance(value, Mapping) else np.asarray(value).tolist()
