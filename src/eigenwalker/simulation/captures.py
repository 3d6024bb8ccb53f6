"""Simulated captures as files, with a table of who is who: a whole study to rehearse."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import pandas as pd
import xarray as xr

from eigenwalker.io.write import FORMATS, write_mocap
from eigenwalker.simulation.trait_effects import TRAITS


def write_captures(
    captures: Iterable[tuple[xr.DataArray, pd.Series]],
    folder: str | Path,
    *,
    format: str = "c3d",
) -> Path:
    """Write captures into a folder, with a table of the traits and one of the truth.

    Captures are written as they come, so that no more than one is in memory.

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

    Examples
    --------
    >>> import tempfile
    >>> from eigenwalker.simulation import simulate_captures
    >>> folder = Path(tempfile.mkdtemp())
    >>> write_captures(simulate_captures(1, 1, duration_s=2), folder, format="csv").name
    'traits.csv'
    >>> sorted(path.name for path in folder.iterdir())
    ['traits.csv', 'truth.csv', 'walker_0001.csv', 'walker_0002.csv']

    """
    if f".{format}" not in FORMATS:
        known = [suffix.removeprefix(".") for suffix in FORMATS]
        raise ValueError(f"format={format!r} is not known; give one of {known}.")
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    people = []
    for number, (walk, person) in enumerate(captures, start=1):
        file = f"walker_{number:04}.{format}"
        write_mocap(walk, folder / file)
        people.append({"file": file, **person.to_dict()})
    table = pd.DataFrame(people)
    table[["file", *TRAITS]].to_csv(folder / "traits.csv", index=False)
    table.to_csv(folder / "truth.csv", index=False)
    return folder / "traits.csv"
