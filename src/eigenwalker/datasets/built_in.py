"""Populations to begin with: the built-in one, and those in files."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from eigenwalker.datasets.code_hash import people_file
from eigenwalker.population.population import Population

if TYPE_CHECKING:
    import xarray as xr

_PEOPLE: dict[str, Any] = {"n_women": 20, "n_men": 20, "seed": 0, "balanced": True}
BUILT_IN = "the built-in population, simulated: 20 women and 20 men who do not exist"


def load_population(path: str | Path | None = None) -> Population:
    """Return the population of a file, or the built-in one.

    Parameters
    ----------
    path : str or Path, optional
        File of ``Population.save`` or ``eigenwalker fit``; or published walkers: the BML tables
        (`read_bml_axes`) or Moler's walkers.mat. Left out, it is the built-in population
        of 20 women and 20 men, who are simulated: good to learn and test with, no evidence about
        people.

    Returns
    -------
    Population

    Raises
    ------
    UnreadableFile
        If the file holds no population or is damaged.

    See Also
    --------
    simulate_population : other simulated people.
    fit_folder : a population of captures.

    References
    ----------
    Troje (2002), Decomposing biological motion; ``docs/simulation.md``.

    Examples
    --------
    >>> people = ew.load_population()
    >>> len(people), people.X.shape
    (40, (40, 229))
    """
    if path is None:
        return _built_in()
    if Path(path).suffix.lower() == ".json":
        from eigenwalker.datasets.bml import read_bml_axes

        return read_bml_axes(path).population(source=Path(path).name)
    if Path(path).suffix.lower() == ".mat":
        from eigenwalker.datasets.moler import read_walkers_mat

        return read_walkers_mat(path)
    return Population.load(path)


@cache
def _built_in() -> Population:
    """The people that came with this code, or, where none did, the same ones simulated now."""
    from eigenwalker.datasets.built_in_file import read_people

    file = people_file()
    return read_people(file) if file.exists() else simulate_built_in()


def simulate_built_in() -> Population:
    """Simulate the built-in people, as building the package does."""
    from eigenwalker.simulation.people import simulate_population

    return simulate_population(**_PEOPLE)


def built_in_capture() -> xr.DataArray:
    """Return the walk in place, at 120 Hz, of the first woman of the built-in population."""
    from eigenwalker.gait.in_place import in_place
    from eigenwalker.markers.virtual_markers import virtual_markers
    from eigenwalker.simulation.people import simulate_captures

    capture, _ = next(simulate_captures(**_PEOPLE, markers="skin"))
    walk = in_place(virtual_markers(capture))
    return walk.assign_attrs(source="The first woman of the built-in population")
