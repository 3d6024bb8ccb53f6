"""NetCDF files: trajectories as they are, with names, units and what is known of the capture.

Of version 3 (64-bit offset), which every NetCDF library reads, and which is read back without one
written in C.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any, cast

import numpy as np
import xarray as xr

from eigenwalker._version import __version__
from eigenwalker.io.readers.netcdf import FORMAT, TABLES, VERSION


def write_netcdf(walk: xr.DataArray, unit: str, up: str, path: Path) -> None:
    """Write ``position`` (time, marker, axis), and ``rotation`` if known; unit and up are fixed."""
    if (unit, up) != ("mm", "z"):
        raise ValueError(
            f"NetCDF holds trajectories in millimetres, z up, not unit={unit!r}, up={up!r}; leave "
            "these out, or write another format."
        )
    dataset = _dataset(walk)
    known = {name: _storable(value) for name, value in walk.attrs.items() if name != "units"}
    dataset.attrs = {
        "format": FORMAT,
        "format_version": VERSION,
        "program": f"eigenwalker {__version__}",
        **{f"capture_{name}": value for name, value in known.items() if value is not None},
    }
    dataset.to_netcdf(path, engine="scipy", format="NETCDF3_64BIT")


def _dataset(walk: Any) -> Any:
    scalars = [name for name, value in walk.coords.items() if not value.dims]
    dataset = walk.drop_vars(["rotation", *scalars], errors="ignore").to_dataset(name="position")
    dataset["position"].attrs = {"units": "mm"}
    dataset["time"].attrs = {"units": "s"}
    if "rotation" in walk.coords:
        dataset["rotation"] = (walk.dims, walk.coords["rotation"].values, {"units": "rad"})
    return dataset


def _storable(value: object) -> str | int | float | None:
    """Return an attribute as NetCDF holds it: a word, a number, names in one line, or JSON."""
    if isinstance(value, np.generic):
        value = cast("Any", value).item()
    if isinstance(value, bool):
        return str(value)
    if isinstance(value, str | int | float):
        return value
    if not isinstance(value, list | tuple):
        return None
    entries = list(cast("Sequence[object]", value))
    if entries and all(isinstance(entry, tuple(TABLES.values())) for entry in entries):
        return json.dumps(entries)
    return ", ".join(map(str, entries))
