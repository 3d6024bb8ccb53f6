"""A population as the interactive page holds it: walkers, their variation, and their traits."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd

from eigenwalker._version import __version__
from eigenwalker.analysis.walker_space import WalkerSpace
from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.walker import Walker
from eigenwalker.explorer.model_traits import model_traits, rounded_vectors, significant
from eigenwalker.population.features import FeatureLayout
from eigenwalker.population.population import FLAG, Population, check_population

N_EIGENWALKERS = 10
MAX_WALKERS = 100
"""Walkers that can be selected."""
MAX_POINTS = 500
"""Walkers that are points of the cloud."""


def page_model(
    population: Population,
    *,
    traits: Sequence[str] | None = None,
    first: str = "",
    title: str = "",
    source: str = "",
) -> dict[str, Any]:
    """Return a population as plain lists and numbers, as the interactive page holds it.

    Flagged walkers are left out. Numbers are rounded, so that walkers are those of Python to a
    millionth of a millimetre.

    Parameters
    ----------
    population : Population
    traits : sequence of str, optional
        Traits that get sliders, as `trait_contrast` takes them; left out, all that have an axis.
    first : str
        The first trait, where `traits` is left out: ``"style=feminine:masculine"``.
    title : str
        Title of the page.
    source : str
        File of the population, for the line of Python that makes a walker; empty for the built-in.

    Returns
    -------
    dict
        To be written as JSON; ``docs/interactive.md`` describes it.

    See Also
    --------
    interactive_page : the page that holds it.

    Examples
    --------
    >>> model = page_model(ew.load_population(), traits=["sex"])
    >>> len(model["average"]), len(model["walkers"]), model["traits"][0]["positive"]
    (229, 40, 'male')
    """
    check_population(population)
    rows = np.flatnonzero(~population.flagged)
    if not len(rows):
        rows = np.arange(len(population))
    axes = model_traits(population, traits, first=first)
    selected = _evenly(len(rows), MAX_WALKERS)
    content = _of_vectors(population.X[rows], population.layout, selected, title)
    return content | {
        "source": source,
        "simulated": "simulated" in population.provenance,
        "provenance": {str(name): str(value) for name, value in population.provenance.items()},
        "n_flagged": len(population) - len(rows),
        "speed_factor": population.speed_factor,
        "walkers": _walkers(population, rows[selected], axes),
        "traits": axes,
    }


def page_models(population: Population, *, keep_size: bool = False, **named: Any) -> dict[str, Any]:
    """Return the model of a page on which size can be kept or divided out (Troje 2002, eq. 12).

    The model with which the page begins; its entry ``other_size`` holds the other one.
    """
    models = {
        sized: page_model(people, **named) | {"size_kept": sized}
        for sized, people in ((True, population), (False, population.size_normalised()))
    }
    return models[keep_size] | {"other_size": models[not keep_size]}


def walker_model(walker: Walker, *, title: str = "One walker") -> dict[str, Any]:
    """Return one walker, of any markers, as the page holds it: it is its own average."""
    layout = FeatureLayout.of(walker)
    content = _of_vectors(layout.vector(walker)[None], layout, np.array([0]), title)
    vector = content["average"]
    return content | {"walkers": [{"name": title, "row": 0, "vector": vector, "traits": {}}]}


def _of_vectors(
    X: np.ndarray, layout: FeatureLayout, selected: np.ndarray, title: str
) -> dict[str, Any]:
    """Return the model of walkers without traits or source."""
    space = _space(X)
    points = np.union1d(selected, _evenly(len(X), MAX_POINTS - len(selected)))
    return {
        "format": "eigenwalker model",
        "version": 1,
        "program": f"eigenwalker {__version__}",
        "title": title or f"{len(X)} walkers",
        "source": "",
        "simulated": False,
        "provenance": {},
        "n_walkers": len(X),
        "n_flagged": 0,
        "speed_factor": 1.0,
        **_body(layout),
        "average": rounded_vectors(X.mean(axis=0), layout),
        **_variation(space, X, layout, points),
        "walkers": [],
        "cloud": _cloud(space, X, points, selected),
        "traits": [],
    }


def _space(X: np.ndarray) -> WalkerSpace | None:
    """Return the space of the walkers; None for one walker, or where all are the same."""
    try:
        return WalkerSpace().fit(X)
    except ValueError:
        return None


def _evenly(number: int, most: int) -> np.ndarray:
    """Return so many indices, evenly spaced, all of them where they are not too many."""
    return np.unique(np.linspace(0, number - 1, min(number, most)).round().astype(int))


def _body(layout: FeatureLayout) -> dict[str, Any]:
    """Return markers and how they are joined, and the place of each feature in a vector."""
    skeleton = JOINTS.restricted_to(layout.markers)
    free = layout.form == "eigenposture"
    unknown = [0.0, *[None] * (len(layout.harmonics) - 1)]
    return {
        "markers": list(layout.markers),
        "segments": [list(link) for link in skeleton.segments],
        "pairs": [list(pair) for pair in skeleton.pairs],
        "groups": {name: list(members) for name, members in skeleton.groups.items() if members},
        "form": layout.form,
        "harmonics": list(layout.harmonics),
        "fixed_phases": unknown if free else list(layout.fixed_phases),
        "layout": {name: [part.start, part.stop] for name, part in layout.blocks.items()},
    }


def _variation(
    space: WalkerSpace | None, X: np.ndarray, layout: FeatureLayout, points: np.ndarray
) -> dict[str, Any]:
    """Return scale, eigenwalkers, and the distances of walkers from the average."""
    if space is None:
        spread = {"rms": 1.0, "distances": [0.0] * len(points)}
        return {"scale": [1.0] * len(layout), "eigenwalkers": [], "spread": spread}
    rms = float(np.sqrt(space.explained_variance_[0] / space.explained_variance_ratio_[0]))
    far = np.sort(np.linalg.norm((X - space.average_walker_) / space.scale_, axis=1)) / rms
    upwards = np.ceil(far[points] * 1e5) / 1e5  # so that no walker is nearer than itself
    sds = np.sqrt(space.explained_variance_)
    shares = space.explained_variance_ratio_
    return {
        "scale": [significant(each) for each in space.scale_],
        "eigenwalkers": [
            {
                "vector": rounded_vectors(sd * axis, layout, finer=1),
                "sd": significant(sd),
                "share": significant(share, 6),
            }
            for axis, sd, share in zip(space.eigenwalkers_, sds, shares, strict=True)
        ][:N_EIGENWALKERS],
        "spread": {"rms": significant(rms), "distances": np.round(upwards, 5).tolist()},
    }


def _cloud(
    space: WalkerSpace | None, X: np.ndarray, points: np.ndarray, selected: np.ndarray
) -> dict[str, Any]:
    """Return walkers as points: their scores in standard deviations of the walkers."""
    if space is None:
        return {"n": 0, "scores": [], "walker": []}
    scores = space.transform(X[points]) / np.sqrt(space.explained_variance_)
    place = {int(row): number for number, row in enumerate(selected)}
    return {
        "n": len(points),
        "scores": (np.round(scores[:, :N_EIGENWALKERS], 2) + 0.0).tolist(),
        "walker": [place.get(int(point), -1) for point in points],
    }


def _walkers(population: Population, rows: np.ndarray, axes: list[dict]) -> list[dict[str, Any]]:
    classes = next((axis["column"] for axis in axes if axis["two_classes"]), "")
    finer = -1 if len(rows) == MAX_WALKERS else 0  # pages of many walkers stay small
    walkers = []
    for row in rows:
        traits = population.traits
        values = {str(name): _plain(traits[name].iloc[row]) for name in traits}
        name = values.get("file") or f"{values.get(classes) or 'walker'} {row}"
        values.pop(FLAG, None)
        vector = rounded_vectors(population.X[row], population.layout, finer=finer)
        walkers.append({"name": str(name), "row": int(row), "vector": vector, "traits": values})
    return walkers


def _plain(value: Any) -> str | float | None:
    """Return the value of a trait as JSON has it; None where it is missing or not finite."""
    if pd.isna(value) or (isinstance(value, float) and not np.isfinite(value)):
        return None
    value = value.item() if isinstance(value, np.generic) else value
    if isinstance(value, float):
        return significant(value, 6)
    return value if isinstance(value, int) and not isinstance(value, bool) else str(value)[:200]
