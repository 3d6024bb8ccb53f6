"""The contents of a capture or population file, and what is wrong with it, as plain values."""

from __future__ import annotations

import os
import warnings
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from eigenwalker.core.trajectories import sampling_rate
from eigenwalker.datasets.bml import looks_like_bml
from eigenwalker.datasets.built_in import load_population
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.read import read_mocap
from eigenwalker.population.population import Population, flags_of
from eigenwalker.population.population_file import looks_like_population
from eigenwalker.study.messages import (
    Fact,
    plain_fact,
    reasons,
    rebuilt_in_words,
    repair_in_words,
)
from eigenwalker.study.process_capture import NoWalkError, process_capture

_MEASURED = (
    *("missing_share", "jumps", "removed_share", "left_right_swaps", "sides_swapped"),
    *("bone_length_variation", "height_mm", "unit_guessed", "n_strides", "steady_share"),
    *("straight_passes", "unwound_deg", "frequency_hz", "speed_mm_s", "climb", "climb_mm"),
    *("wander_mm", "filled_share", "r2", "periodicity", "level", "treadmill"),
)
_MARKER_SET = ("marker_set", "marker_set_share", "marker_set_runner_up", "approximate")


def inspect_file(path: str | Path, **reading: Any) -> dict[str, Fact]:
    """Return what is in a capture or a population file, and what is wrong with it.

    Parameters
    ----------
    path : str or Path
        A capture of any format that `read_mocap` reads, a population (``.nc``), or published
        walkers, which are a population too.
    **reading
        As `read_mocap` takes them, such as ``unit`` and ``rate_hz``; and ``mapping``, as
        `virtual_markers` takes it.

    Returns
    -------
    dict
        Names and values fit for JSON; lists hold one sentence an entry. ``kind`` is "capture" or
        "population". A capture has ``verdict``, ``problems``, ``format``, what `Quality` measured
        and its marker set; a population has ``walkers`` (their number), ``flagged``, ``form``,
        ``features``, ``markers``, ``traits``, ``frequency_hz`` (mean) and ``provenance``.

    See Also
    --------
    process_capture : The walker of a capture.

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
    return {name: plain_fact(value) for name, value in file_facts(Path(path), **reading).items()}


def file_facts(path: Path, **reading: Any) -> dict[str, object]:
    """Return what `inspect_file` does, with mappings, tuples and NaN as they are."""
    with suppress(OSError):  # reading it gives the reason
        if path.is_file() and looks_like_population(path):
            return _of_population(Population.load(path))
    if (published := _published(path)) is not None:
        return _of_population(published)
    return _of_capture(path, **reading)


def _published(path: Path) -> Population | None:
    """Return the walkers of a publication in a file (BML tables, Moler's walkers.mat), if any."""
    is_there = os.path.isfile(path)  # False, without an error, of names that are too long
    if path.suffix.lower() not in (".json", ".mat") or not is_there:
        return None
    if path.suffix.lower() == ".json" and not looks_like_bml(path):
        return None
    with suppress(UnreadableFile):  # a capture, perhaps
        return load_population(path)
    return None


def _of_population(population: Population) -> dict[str, object]:
    traits, first = population.traits, population.walkers[0]
    flags = zip(population.names, flags_of(traits), strict=True)
    return {
        "kind": "population",
        "walkers": len(population),
        "flagged": [f"{name}: {flag}" for name, flag in flags if flag],
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


def _of_capture(path: Path, *, mapping: Any = None, **reading: Any) -> dict[str, object]:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        capture = read_mocap(path, **reading)
    problems = [str(warning.message) for warning in caught]
    facts = _as_read(capture)
    try:
        result = process_capture(capture, mapping=mapping)
        joints, quality = result.walk, result.quality
    except NoWalkError as error:
        joints, quality = error.joints, error.quality
    except ValueError as error:
        return {
            "kind": "capture",
            "verdict": "do not use",
            "problems": [*problems, str(error)],
            "marker_set": None,
        } | facts
    return {
        "kind": "capture",
        "verdict": quality.verdict,
        "problems": [*problems, *reasons(quality)],
        **{name: getattr(quality, name) for name in _MEASURED},
        "rebuilt": [line for line in rebuilt_in_words(quality).split("; ") if line],
        "swaps": [repair_in_words(each) for each in quality.repairs if each.kind == "swap"],
        **facts,
        **{name: joints.attrs.get(name) for name in _MARKER_SET},
    }


def _as_read(capture: xr.DataArray) -> dict[str, object]:
    """Return what is known of a capture with any markers."""
    missing = np.isnan(capture.values).any(axis=2)
    rate_hz = sampling_rate(capture) if len(capture) > 1 else None
    codes = capture.attrs.get("missing_codes", ())
    return {
        "format": capture.attrs["format"],
        "unit": capture.attrs.get("unit"),
        "rate_hz": rate_hz,
        "rate_reason": capture.attrs.get("rate_reason", ""),
        "duration_s": len(capture) / rate_hz if rate_hz else None,
        "n_frames": len(capture),
        "missing_samples": float(missing.mean()),
        **({"missing_codes": list(codes)} if codes else {}),
        "missing_markers": capture.marker.values[missing.all(axis=0)].tolist(),
        "markers": capture.marker.values.tolist(),
    }
