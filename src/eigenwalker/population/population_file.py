"""A population as one self-describing NetCDF file.

Dimensions are ``walker, component, marker, axis``; every number has its unit beside it, and the
file says its version, so that other programs can read it without this one. Nothing in it is code.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import fields
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
import xarray as xr

from eigenwalker._version import __version__
from eigenwalker.core.arguments import check_numbers
from eigenwalker.core.atomic_write import atomic_write, check_destination
from eigenwalker.core.trajectories import AXES
from eigenwalker.core.walker import CaptureFit, Walker
from eigenwalker.io.capture_file import read_bytes
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.file_types import file_type_of
from eigenwalker.io.readers.netcdf import dataset_of, looks_like_netcdf
from eigenwalker.population.correspondence import Correspondence, ReferenceWalker
from eigenwalker.population.trait_table import check_traits

FORMAT = "eigenwalker population"
VERSION = 1
_EXPECTED = "a population file"
_MAKE = "make one with 'eigenwalker fit' or Population.save"
_FIELDS = {
    "p0": ("mm", ("walker", "marker", "axis")),
    "p": ("mm", ("walker", "component", "marker", "axis")),
    "phases": ("rad", ("walker", "component")),
    "frequency_hz": ("Hz", ("walker",)),
    "speed_mm_s": ("mm/s", ("walker",)),
    "time_origin_s": ("s", ("walker",)),
}
"""Fields of a walker: their units and dimensions."""
_FIT_DIMS = {
    "variance_share": ("walker", "share"),
    "sine_r2": ("walker", "component"),
    "fourier": ("walker", "coefficient", "marker", "axis"),
    "eigenpostures": ("walker", "component", "marker", "axis"),
    "harmonics": ("walker", "component"),
    "phases": ("walker", "component"),
}


class Stored(NamedTuple):
    """What a population file holds."""

    walkers: Sequence[Walker]
    traits: pd.DataFrame
    correspondence: Correspondence
    provenance: Mapping[str, str]


def write_population(content: Stored, path: Path) -> Path:
    """Write walkers in correspondence, with their traits, to a NetCDF file; return its path."""
    check_destination(path)
    dataset = _dataset(content.walkers, content.traits, content.correspondence)
    dataset.attrs = {
        "format": FORMAT,
        "format_version": VERSION,
        "program": f"eigenwalker {__version__}",
        "form": content.walkers[0].form,
        "provenance": json.dumps(dict(content.provenance)),
    }
    with atomic_write(path) as unfinished:
        dataset.to_netcdf(unfinished, engine="scipy", format="NETCDF3_64BIT")  # pyright: ignore[reportUnknownMemberType]
    return path


def looks_like_population(path: Path) -> bool:
    """Return whether a file is meant as a population."""
    with path.open("rb") as file:
        beginning = file.read(100_000)
    return bool(looks_like_netcdf(beginning)) and FORMAT.encode() in beginning


def read_population(path: Path) -> Stored:
    """Read what `write_population` wrote, or raise UnreadableFile."""
    content = read_bytes(path, expected=_EXPECTED)
    if not looks_like_netcdf(content):
        raise UnreadableFile(path.name, _EXPECTED, file_type_of(content), _MAKE)
    dataset = dataset_of(content, path.name, expected=_EXPECTED)
    if str(dataset.attrs.get("format")) != FORMAT:
        content = "a NetCDF file that holds no walkers of eigenwalker"
        raise UnreadableFile(path.name, _EXPECTED, content, _MAKE)
    if str(version := dataset.attrs.get("format_version")) != str(VERSION):
        raise UnreadableFile(
            path.name,
            f"version {VERSION} of the format",
            f"version {version}",
            "update eigenwalker",
        )
    try:
        return _stored(dataset)
    except (KeyError, ValueError, TypeError, IndexError, RecursionError) as error:
        raise UnreadableFile(
            path.name, _EXPECTED, f"a damaged one ({error})", "make or copy it again"
        ) from error


def _dataset(
    walkers: Sequence[Walker], traits: pd.DataFrame, correspondence: Correspondence
) -> xr.Dataset:
    first = walkers[0]
    variables: dict[str, tuple[Any, ...]] = {
        name: (dims, np.stack([getattr(walker, name) for walker in walkers]), {"units": unit})
        for name, (unit, dims) in _FIELDS.items()
    }
    if all(walker.fit is not None for walker in walkers):
        for entry in fields(CaptureFit):
            stacked = np.stack([np.asarray(getattr(walker.fit, entry.name)) for walker in walkers])
            variables[f"fit_{entry.name}"] = (_FIT_DIMS.get(entry.name, ("walker",)), stacked)
    for number, name in enumerate(traits):
        variables[f"trait_{number}"] = (
            "walker",
            _storable(traits[name]),
            {"trait": _utf8(str(name))},
        )
    reference = correspondence.reference
    variables["similarity"] = (("walker", "component"), correspondence.similarity)
    variables["correspondence_flag"] = ("walker", np.array(correspondence.flags, dtype=object))
    variables["reference_axes"] = (("harmonic", "pair", "feature"), reference.axes)
    variables["reference_average"] = (("coefficient", "feature"), reference.average)
    coords = {
        "marker": [_utf8(name) for name in first.markers],
        "axis": list(AXES),
        "harmonics": ("component", first.harmonics),
    }
    return xr.Dataset(variables, coords)


def _storable(column: pd.Series) -> np.ndarray:
    if pd.api.types.is_bool_dtype(column) or not pd.api.types.is_numeric_dtype(column):
        texts = column.astype(object).where(column.notna(), "")
        return np.array([_utf8(str(text)) for text in texts], dtype=object)
    whole = pd.api.types.is_integer_dtype(column) and not column.isna().any()
    small = whole and column.abs().max() < 2**31
    return column.to_numpy(dtype="int32" if small else float)


def _utf8(text: str) -> str:
    """Return a text with escapes for what UTF-8 lacks: bytes of a file name that are no letters."""
    return text.encode(errors="backslashreplace").decode()


def _stored(dataset: xr.Dataset) -> Stored:
    if not dataset.sizes["walker"]:
        raise ValueError("no walkers")
    markers = tuple(str(name) for name in dataset["marker"].values)
    harmonics = dataset["harmonics"].values
    form = dataset.attrs["form"]
    _check_layout(dataset, markers, harmonics, form)
    arrays = {name: dataset[name].values for name in _FIELDS}
    fits = _fits(dataset) if "fit_r2" in dataset else [None] * dataset.sizes["walker"]
    walkers = tuple(
        Walker(
            markers=markers,
            harmonics=harmonics,
            form=form,
            fit=fits[number],
            **{name: values[number] for name, values in arrays.items()},
        )
        for number in range(dataset.sizes["walker"])
    )
    traits = pd.DataFrame(
        {
            str(dataset[f"trait_{number}"].attrs["trait"]): dataset[f"trait_{number}"].values
            for number in range(sum(str(name).startswith("trait_") for name in dataset))
        }
    )
    check_traits(traits)
    reference = ReferenceWalker(
        dataset["reference_axes"].values, dataset["reference_average"].values, form, markers
    )
    flags = tuple(str(flag) for flag in dataset["correspondence_flag"].values)
    provenance = json.loads(dataset.attrs["provenance"])
    return Stored(
        walkers,
        traits,
        Correspondence(reference, dataset["similarity"].values, flags),
        {str(key): str(value) for key, value in dict(provenance).items()},
    )


def _check_layout(
    dataset: xr.Dataset, markers: tuple[str, ...], harmonics: np.ndarray, form: str
) -> None:
    """Raise ValueError if parts of a file do not fit each other."""
    n_harmonics, odd = divmod(len(harmonics), 2)
    if odd or harmonics.tolist() != np.repeat(np.arange(1, n_harmonics + 1), 2).tolist():
        raise ValueError(f"harmonics {harmonics.tolist()[:8]} are not 1, 1, 2, 2, ...")
    n_features = len(markers) * len(AXES)
    for name, shape in (
        ("reference_axes", (n_harmonics, 2, n_features)),
        ("reference_average", (2 * n_harmonics, n_features)),
    ):
        if dataset[name].shape != shape:
            raise ValueError(f"{name} has shape {dataset[name].shape}, not {shape}")
    numbers = ["reference_axes", "reference_average", "similarity"]
    numbers += [name for name in map(str, dataset) if name.startswith("fit_")]
    for name in numbers:
        check_numbers(dataset[name].values, name)
    if form == "eigenposture" and np.any(dataset["phases"].values[:, 0] != 0):
        raise ValueError("the first phase of a walker is not 0")
    traits = [dataset[name].attrs.get("trait") for name in map(str, dataset) if "trait_" in name]
    if len(set(traits)) < len(traits):
        raise ValueError("two traits have one name")


def _fits(dataset: xr.Dataset) -> list[CaptureFit]:
    names = [entry.name for entry in fields(CaptureFit)]
    columns = {name: dataset[f"fit_{name}"].values for name in names}
    columns = {
        name: column.tolist() if column.ndim == 1 else column for name, column in columns.items()
    }
    return [
        CaptureFit(**{name: column[number] for name, column in columns.items()})
        for number in range(dataset.sizes["walker"])
    ]
