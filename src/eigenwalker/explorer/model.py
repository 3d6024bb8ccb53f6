"""A population as the interactive page holds it: what walks, what varies, what tells traits."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd

from eigenwalker._version import __version__
from eigenwalker.analysis.walker_space import WalkerSpace
from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.walker import Walker
from eigenwalker.explorer.model_traits import model_traits
from eigenwalker.explorer.rounding import rounded, rounded_vectors, significant
from eigenwalker.population.features import FeatureLayout
from eigenwalker.population.population import FLAG, Population

FORMAT, VERSION = "eigenwalker model", 1
N_EIGENWALKERS = 10
MOST_WALKERS = 100
"""Walkers that can be shown themselves."""
MOST_POINTS = 500
"""Walkers that are points of the cloud."""


def page_model(
    population: Population,
    *,
    traits: Sequence[str] | None = None,
    first: str = "",
    title: str = "",
    source: str = "",
) -> dict[str, Any]:
    """Return a population as plain lists and numbers, for the page to play with.

    Flagged walkers are left out. Numbers are rounded, so that walkers are those of Python to a
    millionth of a millimetre.

    Parameters
    ----------
    population : Population
    traits : sequence of str, optional
        Traits to have sliders for, as `contrast` takes them; left out, all that have an axis.
    first : str
        A trait to begin with where `traits` is left out: ``"style=feminine:masculine"``.
    title : str
        What the page is called.
    source : str
        File of the population, for the line of Python that makes a walker; empty for the built-in.

    Returns
    -------
    dict
        To be written as JSON; ``docs/interactive.md`` says what it holds.

    Examples
    --------
    >>> model = page_model(ew.load_population(), traits=["sex"])
    >>> len(model["average"]), len(model["walkers"]), model["traits"][0]["positive"]
    (229, 40, 'male')

    """
    rows = np.flatnonzero(~population.flagged)
    if not len(rows):
        rows = np.arange(len(population))
    known, layout = population.X[rows], population.layout
    shown = _evenly(len(rows), MOST_WALKERS)
    points = np.union1d(shown, _evenly(len(rows), MOST_POINTS - len(shown)))
    axes = model_traits(population, traits, first=first)
    space = _space(known)
    return {
        "format": FORMAT,
        "version": VERSION,
        "program": f"eigenwalker {__version__}",
        "title": title or f"{len(rows)} walkers",
        "source": source,
        "simulated": "simulated" in population.provenance,
        "provenance": {str(name): str(said) for name, said in population.provenance.items()},
        "n_walkers": len(rows),
        "n_flagged": len(population) - len(rows),
        **_body(layout),
        "average": rounded_vectors(known.mean(axis=0), layout),
        **_variation(space, known, layout, points),
        "walkers": _walkers(population, rows[shown], axes),
        "cloud": _cloud(space, known, points, shown),
        "traits": axes,
    }


def walker_model(walker: Walker, *, title: str = "One walker") -> dict[str, Any]:
    """Return one walker as the page holds it, without a population: it is its own average.

    Parameters
    ----------
    walker : Walker
        Of any markers.
    title : str
        What the page is called.

    Returns
    -------
    dict
        As `page_model` returns it.

    Examples
    --------
    >>> hop = ew.Walker(["foot"], [[0, 0, 50]], [[[0, 0, 40]]], [1], [0], 1.0)
    >>> walker_model(hop)["average"]
    [0.0, 0.0, 50.0, 0.0, 0.0, 40.0, 1.0]

    """
    layout = FeatureLayout.of(walker)
    vector = layout.vector(walker)
    own = rounded_vectors(vector, layout)
    return {
        "format": FORMAT,
        "version": VERSION,
        "program": f"eigenwalker {__version__}",
        "title": title,
        "source": "",
        "simulated": False,
        "provenance": {},
        "n_walkers": 1,
        "n_flagged": 0,
        **_body(layout),
        "average": own,
        **_variation(None, vector[None], layout, np.array([0])),
        "walkers": [{"name": title, "row": 0, "vector": own, "traits": {}}],
        "cloud": _cloud(None, vector[None], np.array([0]), np.array([0])),
        "traits": [],
    }


def _body(layout: FeatureLayout) -> dict[str, Any]:
    """What walks: markers and how they are joined, and which number of a vector is what."""
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


def _evenly(number: int, most: int) -> np.ndarray:
    """Places spread over so many, all of them where they are not too many."""
    return np.unique(np.linspace(0, number - 1, min(number, most)).round().astype(int))


def _variation(
    space: WalkerSpace | None, known: np.ndarray, layout: FeatureLayout, points: np.ndarray
) -> dict[str, Any]:
    """What varies between the walkers: scale, eigenwalkers, and how far they spread."""
    if space is None:
        spread = {"rms": 1.0, "distances": [0.0] * len(points)}
        return {"scale": [1.0] * len(layout), "eigenwalkers": [], "spread": spread}
    usual = float(np.sqrt(space.explained_variance_[0] / space.explained_variance_ratio_[0]))
    far = np.sort(np.linalg.norm((known - space.average_walker_) / space.scale_, axis=1)) / usual
    upwards = np.ceil(far[points] * 1e5) / 1e5  # so that no walker is nearer than itself
    sds = np.sqrt(space.explained_variance_)
    return {
        "scale": [significant(each) for each in space.scale_],
        "eigenwalkers": [
            {
                "vector": rounded_vectors(sd * axis, layout, finer=1),
                "sd": significant(sd),
                "share": significant(share, 6),
            }
            for axis, sd, share in zip(
                space.eigenwalkers_, sds, space.explained_variance_ratio_, strict=True
            )
        ][:N_EIGENWALKERS],
        "spread": {"rms": significant(usual), "distances": rounded(upwards, 5)},
    }


def _space(known: np.ndarray) -> WalkerSpace | None:
    """The space of the walkers; None of one walker, or where all are the same."""
    try:
        return WalkerSpace().fit(known)
    except ValueError:
        return None


def _cloud(
    space: WalkerSpace | None, known: np.ndarray, points: np.ndarray, shown: np.ndarray
) -> dict[str, Any]:
    """Every walker as a point: its scores in standard deviations of the walkers."""
    if space is None:
        return {"n": 0, "scores": [], "walker": []}
    scores = space.transform(known[points]) / np.sqrt(space.explained_variance_)
    place = {int(row): number for number, row in enumerate(shown)}
    return {
        "n": len(points),
        "scores": rounded(scores[:, :N_EIGENWALKERS], 2),
        "walker": [place.get(int(point), -1) for point in points],
    }


def _walkers(population: Population, rows: np.ndarray, axes: list[dict]) -> list[dict[str, Any]]:
    two = next((axis["column"] for axis in axes if axis["two_classes"]), None)
    told = [str(name) for name in population.traits if name != FLAG]
    finer = -1 if len(rows) == MOST_WALKERS else 0  # pages of many walkers stay small
    return [
        {
            "name": _name(population.traits, row, two),
            "row": int(row),
            "vector": rounded_vectors(population.X[row], population.layout, finer=finer),
            "traits": {name: _plain(population.traits[name].iloc[row]) for name in told},
        }
        for row in rows
    ]


def _name(traits: pd.DataFrame, row: int, two: str | None) -> str:
    """What to call a walker: its file, or its class and its number."""
    if "file" in traits and (file := str(_plain(traits["file"].iloc[row]) or "")):
        return file
    said = "" if two is None else str(_plain(traits[two].iloc[row]) or "")
    return f"{said or 'walker'} {row}"


def _plain(value: Any) -> str | float | None:
    """A trait's value as JSON has it; None where it is missing or not finite."""
    if pd.isna(value) or (isinstance(value, float) and not np.isfinite(value)):
        return None
    value = value.item() if isinstance(value, np.generic) else value
    if isinstance(value, float):
        return significant(value, 6)
    return value if isinstance(value, int) and not isinstance(value, bool) else str(value)[:200]
