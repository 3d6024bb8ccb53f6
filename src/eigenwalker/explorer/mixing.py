"""From what is chosen on the page to the walker that is made of it, as the page does it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from eigenwalker.core.walker import Walker
from eigenwalker.population.features import FeatureLayout


def model_layout(model: Mapping[str, Any]) -> FeatureLayout:
    """Return which number of a model's vectors is what."""
    fixed = tuple(model["fixed_phases"]) if model["form"] == "fourier" else ()
    return FeatureLayout(
        tuple(model["markers"]), tuple(model["harmonics"]), model["form"], fixed_phases=fixed
    )


def mixed_walker(model: Mapping[str, Any], state: Mapping[str, Any]) -> Walker:
    """Return the walker that the page shows for a state.

    Parameters
    ----------
    model : mapping
        Of `page_model`.
    state : mapping
        What is chosen; see `mixed_vector`.

    Returns
    -------
    Walker

    Raises
    ------
    ValueError
        If the numbers do not make anything that could walk, or the state asks for what the model
        does not have.

    """
    return model_layout(model).walker(mixed_vector(model, state))


def mixed_vector(model: Mapping[str, Any], state: Mapping[str, Any]) -> np.ndarray:
    """Return the features of the walker that the page shows for a state.

    Eq. 13 of Troje (2002) from any walker (W7), then Moler's bias, eigenwalkers, and the strength
    of each component.

    Parameters
    ----------
    model : mapping
        Of `page_model`.
    state : mapping
        Any of ``traits`` {name: standard deviations}, ``kind``, ``part``, ``from`` ("average", the
        number of a walker of the model, or "own" for the vector ``own``), ``bias`` {"trait",
        "steps"} in half the difference of the classes' means, ``eigenwalkers`` in standard
        deviations, ``strengths``, 1 being as it is. What is left out changes nothing.

    Returns
    -------
    array of shape (feature,)

    Raises
    ------
    ValueError
        If there is no such trait, part or walker.

    Examples
    --------
    >>> from eigenwalker.explorer.model import page_model
    >>> people = ew.load_population()
    >>> model = page_model(people, traits=["sex"])
    >>> man = people.average + 2 * ew.trait_axis(people, "sex").step
    >>> bool(np.abs(mixed_vector(model, {"traits": {"sex": 2}}) - man).max() < 1e-6)
    True

    """
    vector = _start(model, state)
    kind, part = state.get("kind", "discriminant"), state.get("part", "all")
    for name, steps in state.get("traits", {}).items():
        if steps:
            columns, step = _step(model, name, kind, part)
            vector[columns] += steps * step
    if bias := state.get("bias"):
        vector += bias["steps"] * _half_difference(model, bias["trait"])
    _check_count("eigenwalkers", state.get("eigenwalkers", ()), len(model["eigenwalkers"]))
    for steps, each in zip(state.get("eigenwalkers", ()), model["eigenwalkers"], strict=False):
        vector += steps * np.array(each["vector"])
    _check_count("strengths", state.get("strengths", ()), len(model["harmonics"]))
    for number, strength in enumerate(state.get("strengths", ()), start=1):
        vector[slice(*model["layout"][f"p{number}"])] *= strength
    if not np.isfinite(vector).all():
        raise ValueError("Some of the numbers chosen are not finite.")
    return vector


RANGES = {"traits": 6.0, "bias": 3.0, "eigenwalkers": 6.0, "strengths": 2.0}
"""How far the page's sliders go, either way."""


def check_ranges(state: Mapping[str, Any]) -> None:
    """Refuse a state that the page cannot show.

    Parameters
    ----------
    state : mapping
        As `mixed_vector` takes it.

    Raises
    ------
    ValueError
        If a number is beyond the page's sliders.

    Examples
    --------
    >>> check_ranges({"traits": {"sex": 6}})
    >>> check_ranges({"traits": {"sex": 99}})
    Traceback (most recent call last):
    ...
    ValueError: sex is 99; give a number from -6 to 6, as far as the sliders go.

    """
    bias = state.get("bias")
    given = {
        "traits": dict(state.get("traits", {})),
        "bias": {f"The bias towards {bias['trait']}": bias["steps"]} if bias else {},
        "eigenwalkers": _numbered("Eigenwalker", state.get("eigenwalkers", ())),
        "strengths": _numbered("The strength of component", state.get("strengths", ())),
    }
    for kind, most in RANGES.items():
        for name, value in given[kind].items():
            if abs(value) > most:
                raise ValueError(
                    f"{name} is {value:g}; give a number from {-most:g} to {most:g}, as far as "
                    "the sliders go."
                )


def _numbered(what: str, values: Any) -> dict[str, float]:
    return {f"{what} {number}": value for number, value in enumerate(values, start=1)}


def _start(model: Mapping[str, Any], state: Mapping[str, Any]) -> np.ndarray:
    start = state.get("from", "average")
    if start == "average":
        return np.array(model["average"], dtype=float)
    if start == "own" and state.get("own") is not None:
        return np.array(state["own"], dtype=float)
    walkers = model["walkers"]
    if not isinstance(start, int) or not 0 <= start < len(walkers):
        raise ValueError(
            f"There is no walker {start!r} to start from; give 'average' or a number from 0 to "
            f"{len(walkers) - 1}."
        )
    return np.array(walkers[start]["vector"], dtype=float)


def _trait(model: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    for trait in model["traits"]:
        if trait["name"] == name:
            return trait
    known = [trait["name"] for trait in model["traits"]]
    raise ValueError(f"There is no trait {name!r}; the model has {known}.")


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


def _check_count(what: str, values: Any, most: int) -> None:
    if len(values) > most:
        raise ValueError(f"There are {len(values)} {what} for a model that has {most}.")
