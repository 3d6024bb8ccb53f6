"""NetCDF files of version 3: trajectories as `write_mocap` keeps them, read without a C library."""

from __future__ import annotations

import io
import json
import re
import warnings
from importlib import import_module
from pathlib import Path
from typing import Any, cast

import numpy as np
import xarray as xr

from eigenwalker.core.trajectories import AXES, DIMS, sampling_rate, trajectories_at
from eigenwalker.io.capture_file import CaptureFile
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.text_cells import MAX_SIZE
from eigenwalker.io.to_trajectories import with_coordinate, with_scalars
from eigenwalker.markers.label_repair import Rebuilt, Repair

looks_like_netcdf = re.compile(rb"CDF[\x01\x02]").match  # version 3
FORMAT = "eigenwalker trajectories"
VERSION = 1
TABLES = {"repairs": Repair, "rebuilt": Rebuilt}
"""Attributes that hold a table, and the type of a row."""
_xarray = import_module("xarray")  # whose reading and writing of files is not wholly typed
_EXPECTED = "trajectories as write_mocap writes them"
_OPEN = "open it with xarray and label it with label_trajectories()"


def holds_trajectories(beginning: bytes, _path: Path) -> bool:
    """Return whether a file is of ours, and no population."""
    return looks_like_netcdf(beginning) is not None and FORMAT.encode() in beginning


def read_netcdf(file: CaptureFile) -> xr.DataArray:
    """Return the trajectories in a NetCDF file, with what was known of the capture.

    ``attrs["original_source"]`` is the name of the file from which they were first read.
    """
    dataset = dataset_of(file.content, file.name, expected=_EXPECTED)
    if {"keypoints", "keypoint"} & set(map(str, dataset.sizes)):
        got = "a dataset of poses, as movement writes them"
        raise file.error(_EXPECTED, got, "read it in Python: from_movement(xr.open_dataset(path))")
    if str(dataset.attrs.get("format")) != FORMAT:
        raise file.error(_EXPECTED, "a NetCDF file that holds other things", _OPEN)
    if str(version := dataset.attrs.get("format_version")) != str(VERSION):
        expected = f"version {VERSION} of the format"
        raise file.error(expected, f"version {version}", "update eigenwalker")
    try:
        walk = _trajectories(dataset, 1.0 if file.unit is None else file.unit.millimetres)
    except (KeyError, TypeError, ValueError, IndexError) as error:
        raise file.error(_EXPECTED, f"a damaged file ({error})") from error
    if file.rate_hz is not None:
        walk = with_coordinate(walk, "time", np.arange(walk.sizes["time"]) / file.rate_hz)
    known = {
        str(name).removeprefix("capture_"): value
        for name, value in dataset.attrs.items()
        if str(name).startswith("capture_")
    }
    for name, kind in TABLES.items():
        if rows := _rows(known.pop(name, ""), kind):
            known[name] = rows
    if known.pop("units", "mm") != "mm":
        expected = "positions in mm, as the format has them"
        raise file.error(expected, "another unit in its attribute capture_units")
    if "source" in known:
        known.setdefault("original_source", known["source"])
    walk = with_scalars(walk, known)
    walk.attrs.update(
        known,
        source=file.name,
        format="NetCDF",
        up_axis="z",
        up_axis_known=True,
        unit="mm" if file.unit is None else file.unit.name,
        unit_guessed=False,
        unit_reason="" if file.unit is None else file.unit.reason,
    )
    return walk


def _rows(text: object, kind: type[Repair] | type[Rebuilt]) -> tuple[object, ...]:
    """Return the rows of a table that `write_netcdf` wrote; none of a damaged line."""
    try:
        entries = json.loads(str(text))
        return tuple(kind(*map(_hashable, entry)) for entry in entries)
    except (TypeError, ValueError, RecursionError):
        return ()


def _hashable(value: object) -> Any:
    return tuple(map(str, cast("list[object]", value))) if isinstance(value, list) else value


class _OnceOver(io.BytesIO):
    """Bytes of a file of which no more is read than it has, some of it twice."""

    n_read = 0

    def read(self, size: int | None = -1, /) -> bytes:
        read = super().read(size)
        self.n_read += len(read)
        if self.n_read > 3 * self.getbuffer().nbytes + 10_000:
            raise ValueError("several variables in one place of the file")
        return read


def dataset_of(content: bytes, source: str, *, expected: str) -> xr.Dataset:
    """Return what a NetCDF file of version 3 holds, by any program."""
    file = _OnceOver(content)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of what damage does to names and numbers
            with _xarray.open_dataset(file, engine="scipy", decode_times=False) as opened:
                return opened.load()
    except Exception as error:  # a damaged file fails anywhere in the library, in many ways
        raise UnreadableFile(source, expected, "a NetCDF file that is damaged") from error


def _trajectories(dataset: xr.Dataset, millimetres: float) -> xr.DataArray:
    position = dataset["position"].transpose(*DIMS)
    if position["axis"].values.tolist() != list(AXES) or position.attrs.get("units") != "mm":
        raise ValueError("axes or units are none of ours")
    values = np.asarray(position.values, dtype=float)
    if (np.abs(values) > MAX_SIZE).any():
        raise ValueError("infinite or absurd positions")
    with np.errstate(invalid="ignore"):  # of NaN that a processor would signal
        values = values * millimetres
    time = np.asarray(position["time"].values, dtype=float)
    if len(time) < 1 or not (np.diff(time) > 0).all():
        raise ValueError("times that do not go on")
    walk = trajectories_at(time, values, [str(name) for name in position["marker"].values])
    if len(time) > 1:
        sampling_rate(walk)  # which refuses uneven times
    if "rotation" in dataset:
        rotation = np.asarray(dataset["rotation"].transpose(*DIMS).values, dtype=float)
        walk = with_coordinate(walk, "rotation", rotation)
    return walk
