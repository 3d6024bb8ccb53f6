"""The walker that the page shows for its sliders, computed as the page does."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from eigenwalker.core.walker import Walker
from eigenwalker.population.features import FeatureLayout

RANGES = {"traits": 6.0, "bias": 3.0, "eigenwalkers": 6.0, "strengths": 2.0}
"""How far the page's sliders go, either way."""


def model_layout(model: Mapping[str, Any]) -> FeatureLayout:
    """Return the layout of a model's vectors."""
    fixed = tuple(model["fixed_phases"]) if model["form"] == "fourier" else ()
    return FeatureLayout(
        tuple(model["markers"]), tuple(model["harmonics"]), model["form"], fixed_phases=fixed
    )


def mixed_walker(model: Mapping[str, Any], state: Mapping[str, Any]) -> Walker:
    """Return the walker of `mixed_vector`."""
    return model_layout(model).walker(mixed_vector(model, state))


def mixed_vector(model: Mapping[str, Any], state: Mapping[str, Any]) -> np.ndarray:
    """Return the features (feature,) of the walker that the page shows for a state.

    Troje (2002), eq. 13, from any walker, then Moler's bias, eigenwalkers, and the strength of each
    component. The state has any of ``traits`` {name: standard deviations}, ``kind``, ``part``,
    ``from`` ("average", the number of a walker of the model, or "own" for the vector ``own``),
    ``bias`` {"trait", "steps"} in half the difference of the classes' means, ``eigenwalkers`` in
    standard deviations, ``strengths``, 1 being unchanged. What is left out changes nothing.
    """
    vector = _start(model, state)
    kind, part = state.get("kind", "discriminant"), state.get("part", "all")
    for name, steps in state.get("traits", {}).items():
        if steps:
            columns, step = _step(model, name, kind, part)
            vector[columns] += steps * step
    if bias := state.get("bias"):
        vector += bias["steps"] * _half_difference(model, bias["trait"])
    eigenwalkers, strengths = state.get("eigenwalkers", ()), state.get("strengths", ())
    for name, values, most in (
        ("eigenwalkers", eigenwalkers, len(model["eigenwalkers"])),
        ("strengths", strengths, len(model["harmonics"])),
    ):
        if len(values) > most:
            raise ValueError(f"There are {len(values)} {name} for a model that has {most}.")
    for steps, each in zip(eigenwalkers, model["eigenwalkers"], strict=False):
        vector += steps * np.array(each["vector"])
    for number, strength in enumerate(strengths, start=1):
        vector[slice(*model["layout"][f"p{number}"])] *= strength
    if not np.isfinite(vector).all():
        raise ValueError("Some of the numbers chosen are not finite.")
    return vector


def check_ranges(state: Mapping[str, Any]) -> None:
    """Refuse a state, as `mixed_vector` takes it, beyond the page's sliders."""
    bias = state.get("bias")
    values = {
        "traits": state.get("traits", {}),
        "bias": {f"The bias towards {bias['trait']}": bias["steps"]} if bias else {},
    }
    for kind, name in (
        ("eigenwalkers", "Eigenwalker"),
        ("strengths", "The strength of component"),
    ):
        values[kind] = {f"{name} {n}": each for n, each in enumerate(state.get(kind, ()), start=1)}
    for kind, most in RANGES.items():
        for name, value in values[kind].items():
            if abs(value) > most:
                raise ValueError(
                    f"{name} is {value:g}; give a number from {-most:g} to {most:g}, as far as "
                    "the sliders go."
                )


def _start(model: Mapping[str, Any], state: Mapping[str, Any]) -> np.ndarray:
    start = state.get("from", "average")
    if start == "average":
        return np.array(model["average"], dtype=float)
    if start == "own" and state.get("own") is not None:
        own = np.array(state["own"], dtype=float)
        return own if model.get("size_kept", True) else _size_divided(model, own)
    walkers = model["walkers"]
    if not isinstance(start, int) or not 0 <= start < len(walkers):
        raise ValueError(
            f"There is no walker {start!r} to start from; give 'average' or a number from 0 to "
            f"{len(walkers) - 1}."
        )
    return np.array(walkers[start]["vector"], dtype=float)


def _size_divided(model: Mapping[str, Any], vector: np.ndarray) -> np.ndarray:
    """Return a walker with the size of the average walker: Troje (2002), eq. 12."""
    layout = model_layout(model)
    mean = np.array(model["average"])[layout.columns("p0")]
    size = vector[layout.columns("p0")] @ mean / (mean @ mean)
    vector[layout.columns("postures")] /= size
    return vector


def _trait(model: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    traits = {trait["name"]: trait for trait in model["traits"]}
    if name not in traits:
        raise ValueError(f"There is no trait {name!r}; the model has {list(traits)}.")
    return traits[name]


def _step(
    model: Mapping[str, Any], name: str, kind: str, part: str
) -> tuple[np.ndarray, np.ndarray]:
    steps = _trait(model, name)["steps"]
    if kind not in steps:
        raise ValueError(f"kind={kind!r} is unknown; choose from {list(steps)}.")
    if part not in steps[kind]:
        raise ValueError(f"{name} has no axis in the part {part!r}; choose from {[*steps[kind]]}.")
    return model_layout(model).columns(part), np.array(steps[kind][part])


def _half_difference(model: Mapping[str, Any], name: str) -> np.ndarray:
    means = _trait(model, name).get("means")
    if means is None:
        raise ValueError(f"{name} has no two classes, so there is no bias towards one of them.")
    return (np.array(means["positive"]) - np.array(means["negative"])) / 2
