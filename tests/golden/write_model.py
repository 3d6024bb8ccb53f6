"""Write the golden file of the interactive page: a model, and what Python makes of choices in it.

    python tests/golden/write_model.py

The browser's tests read it too, and must find the same numbers within 1e-6. It changes only when a
definition changes.
"""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from eigenwalker.analysis import position_in_space
from eigenwalker.analysis.walker_space import WalkerSpace
from eigenwalker.explorer.mixing import mixed_vector, model_layout
from eigenwalker.explorer.model import page_model
from eigenwalker.gait.appearance import walker_measures
from eigenwalker.gait.heading import ground_speed
from eigenwalker.simulation.people import simulate_population

PATH = Path(__file__).parent / "model.json"
CYCLES = (0.0, 0.1, 0.35, 0.8)
STATES: tuple[dict[str, Any], ...] = (
    {},
    {"traits": {"sex": 2}},
    {"traits": {"sex": -6}},
    {"traits": {"sex": 3, "weight_kg": -2}, "kind": "mean_difference"},
    {"traits": {"sex": 6}, "part": "structure"},
    {"traits": {"sex": 6, "weight_kg": 1.5}, "part": "dynamics"},
    {"traits": {"weight_kg": -4}, "part": "p2", "kind": "mean_difference"},
    {"traits": {"sex": -3}, "part": "phases"},
    {"traits": {"sex": 4}, "from": 3},
    {"bias": {"trait": "sex", "steps": -3}},
    {"strengths": [1, 0, 0, 0]},
    {"strengths": [1.5, -2, 0.5, 2], "traits": {"sex": 1}},
    {"eigenwalkers": [2, -1, 0.5]},
    {"eigenwalkers": [0, 3], "from": 0, "bias": {"trait": "sex", "steps": 1}, "strengths": [0.5]},
)


def golden_model() -> dict[str, Any]:
    """A small model, of walkers who are simulated."""
    people = simulate_population(4, 4, seed=2)
    return page_model(people, traits=["sex", "weight_kg"], title="Four women and four men")


def computed(model: dict[str, Any], state: dict[str, Any]) -> dict[str, Any]:
    """What Python makes of a state."""
    vector = mixed_vector(model, state)
    walker = model_layout(model).walker(vector)
    walker = replace(walker, speed_mm_s=model["speed_factor"] * ground_speed(walker))
    known = np.array([each["vector"] for each in model["walkers"]])
    place = position_in_space(WalkerSpace().fit(known), vector, walkers=known)
    moments = np.array(CYCLES) * walker.period_s
    return {
        "vector": vector.round(9).tolist(),
        "positions_mm": walker.trajectories(moments).values.round(9).tolist(),
        "measures": {
            name: None if np.isnan(value) else value
            for name, value in walker_measures(walker).items()
        },
        "distance": place.distance,
        "percentile": place.percentile,
        "positions": {
            trait["name"]: trait["projection"]["offset"]
            + float(vector @ trait["projection"]["gradient"])
            for trait in model["traits"]
        },
    }


def main() -> None:
    """Write the file."""
    model = golden_model()
    cases = [{"state": state, **computed(model, state)} for state in STATES]
    content = {"about": "see write_model.py", "model": model, "cycles": CYCLES, "cases": cases}
    lines = json.dumps(content, separators=(",", ":"), allow_nan=False)
    PATH.write_text(lines.replace('{"state"', '\n{"state"') + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
