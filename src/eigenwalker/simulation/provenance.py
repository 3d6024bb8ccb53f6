"""How a simulated population was made, as text: all that is needed to simulate its people again."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

import numpy as np

from eigenwalker.simulation.overground import Route
from eigenwalker.simulation.planted_effect import PlantedEffect
from eigenwalker.simulation.trait_effects import EFFECTS

KEY = "recipe"
"""Entry of a population's provenance that holds the text."""
CAPTURE = {"variability": 1.0, "wander_mm": 10.0, "noise_mm": 1.0}
"""How captures are made by default: strides of healthy adults on a treadmill, and the millimetre of
noise of Troje (2002)."""


def provenance_text(
    people: Mapping[str, Any], planted: Mapping[str, PlantedEffect], capture: Mapping[str, Any]
) -> str:
    """Return as JSON how people were drawn, as `draw_people` takes it, and captured."""
    content = {**people, "planted": planted, "capture": capture}
    if people["effects"] is EFFECTS:
        del content["effects"]
    if not planted:
        del content["planted"]
    return json.dumps(content, default=_plain)


def _plain(value: Any) -> Any:
    if isinstance(value, Route | PlantedEffect):
        return asdict(value)
    return dict(value) if isinstance(value, Mapping) else np.asarray(value).tolist()


def read_provenance(
    text: str,
) -> tuple[dict[str, Any], dict[str, PlantedEffect], dict[str, Any]]:
    """Return the arguments of `provenance_text`."""
    people = {"effects": EFFECTS, **json.loads(text)}
    capture = people.pop("capture", {"markers": "skin", **CAPTURE})
    if capture.get("route") is not None:
        capture["route"] = Route(**capture["route"])
    planted = {
        trait: PlantedEffect(
            np.array(each["structure"]), np.array(each["movement"]), each["frequency_hz"]
        )
        for trait, each in people.pop("planted", {}).items()
    }
    return people, planted, capture
