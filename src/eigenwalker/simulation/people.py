"""Many simulated people: their captures, files of these, and the population that they make."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from joblib import Parallel, delayed

from eigenwalker.core.arguments import check_choice
from eigenwalker.core.atomic_write import write_table
from eigenwalker.core.blas_threads import one_blas_thread
from eigenwalker.core.walker import Walker
from eigenwalker.decomposition.pca import decompose_pca
from eigenwalker.gait.in_place import in_place
from eigenwalker.markers.virtual_markers import virtual_markers
from eigenwalker.population.population import Population
from eigenwalker.simulation.planted_effect import PlantedEffect, add_effect
from eigenwalker.simulation.provenance import CAPTURE, KEY, provenance_text
from eigenwalker.simulation.trait_effects import EFFECTS, TRAITS, Effects, draw_people
from eigenwalker.simulation.walk import simulate_walk

_PER_TASK = 100


def simulate_captures(
    n_women: int = 20,
    n_men: int = 20,
    *,
    seed: int = 0,
    sex_effect: float = 1.0,
    effects: Effects = EFFECTS,
    planted: Mapping[str, PlantedEffect] | None = None,
    balanced: bool = False,
    **capture: Any,
) -> Iterator[tuple[xr.DataArray, pd.Series]]:
    """Yield the capture of one simulated person after another, with all that is known of them.

    One capture at a time is in memory, however many there are.

    Parameters
    ----------
    n_women, n_men : int
        How many of each; women come first.
    seed : int
        The same seed gives the same people and captures.
    sex_effect : float
        Multiplies all differences between the sexes, of body and of movement: 0 removes them.
    effects : mapping of trait to mapping of parameter to effect size
        See `draw_people`; ``{}`` for none.
    planted : mapping of trait to PlantedEffect, optional
        Effects in mean posture, movement or frequency themselves, for each unit of the trait's
        score (see `draw_people`: sex counts from -0.5 to 0.5).
    balanced : bool
        Whether chance is taken out of the draw: see `draw_people`.
    **capture
        How the capture is made, as `simulate_walk` takes it: ``markers="skin"``,
        ``noise_mm=0``. What is left out is `CAPTURE`.

    Yields
    ------
    capture : DataArray of shape (time, marker, axis)
    person : Series
        Traits, parameters and scores, as `draw_people` returns them.

    See Also
    --------
    write_captures : files of them.
    simulate_population : the population that they make.

    References
    ----------
    Troje (2002), methods; ``docs/simulation.md``.

    Examples
    --------
    >>> for capture, person in simulate_captures(1, 1, duration_s=3):
    ...     print(person["sex"], capture.sizes["time"])
    female 360
    male 360
    """
    people = draw_people(
        n_women, n_men, seed=seed, sex_effect=sex_effect, effects=effects, balanced=balanced,
        over_ground=capture.get("route") is not None,
    )  # fmt: skip
    planted = planted or {}
    for number in range(len(people)):
        person = people.iloc[number]
        walk = _capture(person, (seed, number), planted, capture)
        yield _with_effects(walk, person, planted), person


def _capture(
    person: pd.Series, seed: tuple[int, int], planted: Mapping[str, PlantedEffect],
    capture: Mapping[str, Any],
) -> xr.DataArray:  # fmt: skip
    parameters = {str(name): value for name, value in person.items()}
    for trait, effect in planted.items():
        parameters["frequency_hz"] += person[f"{trait}_score"] * effect.frequency_hz
    return simulate_walk(parameters, seed=seed, **{**CAPTURE, **capture})


def _with_effects(
    walk: xr.DataArray, person: pd.Series, planted: Mapping[str, PlantedEffect]
) -> xr.DataArray:
    for trait, effect in planted.items():
        walk = add_effect(walk, effect, person[f"{trait}_score"])
    return walk


def simulate_population(
    n_women: int = 20,
    n_men: int = 20,
    *,
    seed: int = 0,
    sex_effect: float = 1.0,
    effects: Effects = EFFECTS,
    planted: Mapping[str, PlantedEffect] | None = None,
    balanced: bool = False,
    n_jobs: int = -1,
    **capture: Any,
) -> Population:
    """Return a population of simulated walkers, every property of which is known.

    Each capture is simulated and processed as in Troje (2002): 38 markers on the skin, the 15
    joints from them, the walk in place, its decomposition, correspondence.

    Parameters
    ----------
    n_women, n_men, seed, sex_effect, effects, planted, balanced, **capture
        See `simulate_captures`; with ``markers="joints"`` the true joints are taken. Effects are
        planted in the 15 joints.
    n_jobs : int
        Processes that share the work of more than a hundred walkers; -1 for one a core.

    Returns
    -------
    Population
        With the traits sex, age_years, weight_kg, height_mm, happy and nervous; `truth_of` gives
        the rest.

    See Also
    --------
    simulate_captures : the captures themselves.
    truth_of : all that is true of the people.

    References
    ----------
    Troje (2002), methods; ``docs/simulation.md``.

    Examples
    --------
    >>> people = simulate_population(2, 2, seed=1)
    >>> people.X.shape
    (4, 229)
    """
    settings = {"n_women": n_women, "n_men": n_men, "seed": seed, "sex_effect": sex_effect}
    settings |= {"effects": effects, "balanced": balanced}
    settings["over_ground"] = capture.get("route") is not None
    people, planted = draw_people(**settings), dict(planted or {})
    capture = {"markers": "skin", **CAPTURE, **capture}
    parts = np.array_split(np.arange(len(people)), max(len(people) // _PER_TASK, 1))
    tasks = (delayed(_walkers)(people.iloc[part], part, seed, planted, capture) for part in parts)
    lists = Parallel(n_jobs=n_jobs if len(parts) > 1 else 1)(tasks)
    return Population(
        [walker for some in lists or () for walker in some or ()],
        people[list(TRAITS)],
        provenance={
            "simulated": f"{n_women} women and {n_men} men who do not exist, seed {seed}",
            KEY: provenance_text(settings, planted, capture),
        },
    )


def _walkers(
    people: pd.DataFrame, numbers: np.ndarray, seed: int, planted: Mapping[str, PlantedEffect],
    capture: Mapping[str, Any],
) -> list[Walker]:  # fmt: skip
    """Return the walkers of some of the people; only these leave the process that made them."""
    walkers = []
    with one_blas_thread():
        for row, number in enumerate(numbers):
            person = people.iloc[row]
            settings = {"truth": bool(planted), **capture}
            walk = _capture(person, (seed, int(number)), planted, settings)
            if capture["markers"] == "skin":
                # Effects need the phase of each frame, which virtual markers do not carry on.
                phase = {"phase": walk["phase"]} if "phase" in walk.coords else {}
                walk = virtual_markers(walk).assign_coords(phase)
            walk = _with_effects(walk, person, planted)
            walk = in_place(walk)
            walkers.append(decompose_pca(walk))
    return walkers


def write_captures(
    captures: Iterable[tuple[xr.DataArray, pd.Series]],
    folder: str | Path,
    *,
    format: str = "c3d",
) -> Path:
    """Write captures into a folder, with a table of the traits; return the path of that table.

    Captures are written as they are simulated, so that no more than one is in memory.

    Parameters
    ----------
    captures : iterable of capture and person
        Such as `simulate_captures` yields, best with ``markers="skin"``.
    folder : path
        Made if need be.
    format : str
        Any suffix that `write_mocap` knows: C3D or TRC as motion capture systems write them, CSV
        for a table with a column for each coordinate.

    Returns
    -------
    Path
        Of ``traits.csv``, whose column ``file`` names each capture; ``truth.csv`` beside it holds
        all parameters of each person.

    Raises
    ------
    ValueError
        If the format is unknown.

    See Also
    --------
    simulate_captures : Makes them.

    Examples
    --------
    >>> import tempfile
    >>> folder = Path(tempfile.mkdtemp())
    >>> write_captures(simulate_captures(1, 1, duration_s=2), folder, format="csv").name
    'traits.csv'
    >>> sorted(path.name for path in folder.iterdir())
    ['traits.csv', 'truth.csv', 'walker_0001.csv', 'walker_0002.csv']
    """
    from eigenwalker.io.write import FORMATS, write_mocap

    check_choice(format, [suffix.removeprefix(".") for suffix in FORMATS], "format")
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    people = []
    for number, (walk, person) in enumerate(captures, start=1):
        file = f"walker_{number:04}.{format}"
        write_mocap(walk, folder / file)
        people.append({"file": file, **person.to_dict()})
    table = pd.DataFrame(people)
    write_table(table, folder / "truth.csv", index=False)
    return write_table(table[["file", *TRAITS]], folder / "traits.csv", index=False)
