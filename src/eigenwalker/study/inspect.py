"""What is in a file, and what is wrong with it, as plain facts."""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr

from eigenwalker.core.trajectories import sampling_rate
from eigenwalker.io.errors import printable
from eigenwalker.io.read import read_mocap
from eigenwalker.markers.virtual_markers import virtual_markers
from eigenwalker.population.population import Population
from eigenwalker.population.population_file import looks_like_population
from eigenwalker.quality.findings import assess

Fact = str | float | int | bool | None | list[str]


def inspect_file(
    path: str | Path, *, unit: str | None = None, rate_hz: float | None = None
) -> dict[str, Fact]:
    """Return what is in a capture or a population file, and what is wrong with it.

    Parameters
    ----------
    path : str or Path
        A capture of any format that `read_mocap` reads, or a population (``.nc``).
    unit, rate_hz
        As `read_mocap` takes them, for captures that name none.

    Returns
    -------
    dict
        Names and values fit for JSON; lists hold one sentence an entry.

    Raises
    ------
    UnreadableFile
        If the file cannot be read at all.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     file = ew.write_mocap(ew.simulate_walk(seed=1), f"{folder}/walk.c3d")
    ...     facts = inspect_file(file)
    >>> facts["format"], facts["verdict"], facts["n_strides"], facts["problems"]
    ('C3D', 'use', 10, [])

    """
    path = Path(path)
    if _is_population(path):
        return _plain(_of_population(Population.load(path)))
    return _plain(_of_capture(path, unit, rate_hz))


def _is_population(path: Path) -> bool:
    try:
        return path.is_file() and looks_like_population(path)
    except OSError:
        return False  # for the reason to be said when it is read


def _of_population(population: Population) -> dict[str, object]:
    traits = population.traits
    flagged = population.flagged
    names = traits.get("file", "walker " + traits.index.to_series().astype(str))[flagged]
    flags = [f"{name}: {flag}" for name, flag in zip(names, traits["flag"][flagged], strict=True)]
    first = population.walkers[0]
    return {
        "kind": "population",
        "walkers": len(population),
        "flagged": flags,
        "form": f"{first.form}, harmonics {', '.join(map(str, first.harmonics))}",
        "features": len(population.feature_names),
        "markers": list(first.markers),
        "traits": [
            _trait_in_words(str(name), traits[name])
            for name in traits
            if name not in ("flag", "file")
        ],
        "frequency_hz": float(np.mean([walker.frequency_hz for walker in population.walkers])),
        "provenance": [f"{key}: {value}" for key, value in population.provenance.items()],
    }


def _trait_in_words(name: str, values: pd.Series) -> str:
    known = values[values.notna() & (values.astype(str) != "")]
    if known.dtype.kind == "f":
        return f"{name}: {known.mean():.4g} (SD {known.std():.3g}), {len(known)} known"
    counts = known.value_counts()
    shown = ", ".join(f"{value} {count}" for value, count in counts.head(8).items())
    return f"{name}: {shown}{', ...' if len(counts) > 8 else ''}"


def _of_capture(path: Path, unit: str | None, rate_hz: float | None) -> dict[str, object]:
    problems: list[str] = []
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        capture = read_mocap(path, unit=unit, rate_hz=rate_hz)
    problems += [str(each.message) for each in said]
    facts = _as_read(capture)
    try:
        joints = virtual_markers(capture)
        assessed = _assessed(joints, problems)
    except ValueError as error:
        return {
            "kind": "capture",
            "verdict": "do not use",
            "problems": [*problems, str(error)],
            "marker_set": None,
        } | facts
    taken = {
        name: joints.attrs.get(name)
        for name in ("marker_set", "marker_set_share", "marker_set_runner_up", "approximate")
    }
    return {"kind": "capture", **assessed, **facts, **taken}


def _as_read(capture: xr.DataArray) -> dict[str, object]:
    """What is known of a capture whatever its markers are."""
    missing = np.isnan(capture.values).any(axis=2)
    share = missing.mean(axis=0)
    names = capture.marker.values.tolist()
    return {
        "format": capture.attrs["format"],
        "unit": capture.attrs.get("unit"),
        "rate_hz": sampling_rate(capture) if len(capture) > 1 else None,
        "duration_s": len(capture) / sampling_rate(capture) if len(capture) > 1 else None,
        "n_frames": len(capture),
        "missing_samples": float(missing.mean()),
        "missing_markers": [
            name for name, all_of_it in zip(names, share == 1, strict=True) if all_of_it
        ],
        "markers": names,
    }


def _assessed(joints: xr.DataArray, problems: list[str]) -> dict[str, object]:
    """The verdict on a capture, its reasons, and what was measured."""
    quality = assess(joints)
    measured: dict[str, object] = {}
    for name, value in vars(quality).items():
        if isinstance(value, Mapping):
            measured[name] = [f"{_name(key)}: {number:.3g}" for key, number in value.items()]
        elif name not in ("reasons", "verdict"):
            measured[name] = value
    return {
        "verdict": quality.verdict,
        "problems": [*problems, *quality.reasons],
        **measured,
    }


def _name(key: str | tuple[str, str]) -> str:
    return key if isinstance(key, str) else " to ".join(key)


def _plain(facts: dict[str, object]) -> dict[str, Fact]:
    """The same facts in types that JSON has; what is not a number is None."""
    return {name: _plain_value(value) for name, value in facts.items()}


def _plain_value(value: object) -> Fact:
    if isinstance(value, bool | np.bool_):
        return bool(value)
    if isinstance(value, int | np.integer):
        return int(value)
    if isinstance(value, float | np.floating):
        return float(value) if math.isfinite(value) else None
    if isinstance(value, list | tuple):
        return [printable(str(each)) for each in value]
    return None if value is None else printable(str(value))
