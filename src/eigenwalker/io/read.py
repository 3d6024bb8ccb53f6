"""One function for all formats: what a file is called and what it holds decide who reads it."""

from __future__ import annotations

import math
import os
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr

from eigenwalker.core.trajectories import MILLIMETRES
from eigenwalker.io.errors import AGAIN, UnreadableFile
from eigenwalker.io.file_types import kind_of, with_article
from eigenwalker.io.readers.asf_amc import find_skeleton, looks_like_acclaim, read_asf_amc
from eigenwalker.io.readers.bvh import looks_like_bvh, read_bvh
from eigenwalker.io.readers.c3d import looks_like_c3d, read_c3d
from eigenwalker.io.readers.mot import looks_like_mot, read_mot
from eigenwalker.io.readers.netcdf import holds_trajectories, looks_like_netcdf, read_netcdf
from eigenwalker.io.readers.pose_json import holds_poses, looks_like_json, read_pose_json
from eigenwalker.io.readers.qualisys_tsv import looks_like_qualisys_tsv, read_qualisys_tsv
from eigenwalker.io.readers.trc import looks_like_trc, read_trc
from eigenwalker.io.readers.unmarked_table import (
    DESCRIPTION,
    holds_points,
    looks_like_table,
    read_table,
)
from eigenwalker.io.readers.vicon_csv import looks_like_vicon_csv, read_vicon_csv
from eigenwalker.io.sniff import beside, content_of
from eigenwalker.io.up_axis_and_unit import UNITS, Unit

BEGINNING = 100_000
"""Bytes of a file that tell whether it is meant as a capture."""


class Format(NamedTuple):
    """A kind of file: what it is called, how to know it, and who reads it.

    `wants` names what its reader takes beside the bytes: ``"path"`` where a file beside it is
    needed, ``"rate_hz"`` where files may name no rate. Where other files have the suffix too,
    `among_others` tells from the beginning of a file and its path whether it is meant as a capture.
    """

    name: str
    suffix: str
    looks_like: Callable[[bytes], bool]
    read: Callable[..., xr.DataArray]
    wants: tuple[str, ...] = ()
    among_others: Callable[[bytes, Path], bool] | None = None


def _by(looks_like: Callable[[bytes], bool]) -> Callable[[bytes, Path], bool]:
    return lambda beginning, _path: looks_like(beginning)


_RATE = ("rate_hz",)
_PATH_AND_RATE = ("path", "rate_hz")
FORMATS = (
    Format("BVH", ".bvh", looks_like_bvh, read_bvh),
    Format("C3D", ".c3d", looks_like_c3d, read_c3d),
    Format("ASF/AMC", ".amc", looks_like_acclaim, read_asf_amc, _PATH_AND_RATE),
    Format("NetCDF", ".nc", looks_like_netcdf, read_netcdf, among_others=holds_trajectories),
    Format("TRC", ".trc", looks_like_trc, read_trc, _RATE),
    Format("STO", ".sto", looks_like_mot, read_mot, _RATE),
    Format("MOT", ".mot", looks_like_mot, read_mot, _RATE),
    Format(
        "Vicon CSV", ".csv", looks_like_vicon_csv, read_vicon_csv, _RATE, _by(looks_like_vicon_csv)
    ),
    Format(
        "Qualisys TSV",
        ".tsv",
        looks_like_qualisys_tsv,
        read_qualisys_tsv,
        _RATE,
        _by(looks_like_qualisys_tsv),
    ),
    Format("JSON", ".json", looks_like_json, read_pose_json, _RATE, holds_poses),
    Format("table", ".csv", looks_like_table, read_table, _PATH_AND_RATE, holds_points),
    Format("table", ".txt", looks_like_table, read_table, _PATH_AND_RATE, holds_points),
)
"""Every format that is read. A reader takes the bytes of a file and its name as ``source``."""


def read_mocap(
    path: str | os.PathLike[str], *, unit: str | None = None, rate_hz: float | None = None
) -> xr.DataArray:
    """Return what a file holds as trajectories, as captured.

    Parameters
    ----------
    path : str or path
        A file of any of the `FORMATS`, such as C3D, BVH, TRC, or a motion (AMC) with its skeleton
        (ASF) beside it. What it holds decides, not what it is called.
    unit : {"um", "mm", "cm", "dm", "m", "in", "ft", "asf"}, optional
        Unit of length, for files that name none (all BVH) or the wrong one. If left out, it is the
        one the file names, or else the one in which the body is as tall as people are; that
        is warned of with `UnitGuessed`. ``"asf"`` is the unit of CMU skeletons, inch/0.45.
    rate_hz : float, optional
        Frames a second, for files that name none (most AMC) or the wrong one. If left out, it is
        the one the file names, or else the usual one of its kind; that is warned of with
        `RateAssumed`.

    Returns
    -------
    DataArray of shape (time, marker, axis)
        Positions in millimetres, z up; NaN where a marker was not seen. ``attrs`` tell ``source``
        (name of the file), ``format``, ``up_axis`` (the one of the file) and whether that is known
        (``up_axis_known``), ``unit`` (of the file), whether it is guessed (``unit_guessed``) and
        why it was taken (``unit_reason``). Where joints have orientations, they are in the
        coordinate ``rotation`` (time, marker, axis), as rotation vectors in radians.

    Raises
    ------
    UnreadableFile
        If there is no such file, or it is damaged, cut short, or of another format.
    ValueError
        If `unit` is not known, or `rate_hz` no rate.

    Examples
    --------
    >>> ew.read_mocap("nowhere.c3d")
    Traceback (most recent call last):
    ...
    eigenwalker.io.errors.UnreadableFile: nowhere.c3d: expected a file, but got nothing of
    that name in '.'; check the path.

    """
    path = Path(path)
    content = content_of(path)
    known = MILLIMETRES | UNITS
    if unit is not None and unit not in known:
        raise ValueError(f"unit={unit!r} is not known; give one of {sorted(known)}.")
    if rate_hz is not None and not 0 < rate_hz < math.inf:
        raise ValueError(f"rate_hz={rate_hz} is no frame rate; give frames a second, above 0.")
    named = None if unit is None else Unit(unit, known[unit], "named by the caller")
    for form in FORMATS:
        if form.looks_like(content):
            wanted = {name: {"path": path, "rate_hz": rate_hz}[name] for name in form.wants}
            walk = form.read(content, source=path.name, unit=named, **wanted)
            return walk if "rate_hz" in wanted else _at_rate(walk, rate_hz)
    if content.startswith(b"MATLAB") or path.suffix.lower() == ".mat":
        raise UnreadableFile(
            path.name, "a capture that says what it is", "a MATLAB file, which does not", _OF_MATLAB
        )
    of_its_suffix = [form for form in FORMATS if form.suffix == path.suffix.lower()]
    by_name = [form.name for form in of_its_suffix if form.among_others is None]
    raise UnreadableFile(
        path.name,
        with_article(f"{' or '.join(by_name)} file, as it is called") if by_name else _CAPTURE,
        kind_of(content),
        AGAIN if by_name else "export it as one of these",
    )


_NAMES = list(dict.fromkeys(form.name for form in FORMATS if form.name != "table"))
_CAPTURE = f"a capture ({', '.join(_NAMES)} or a table of points)"
_OF_MATLAB = (
    "read an array of it by read_mat(path, variable, markers=..., rate_hz=...), walkers by "
    "read_walkers_mat(path) or read_mm(path)"
)


def is_capture(path: Path) -> bool:
    """Return whether a file in a folder is meant as a capture, sound or not.

    Its suffix tells, and for suffixes that other files have too, such as ``.csv``, what it begins
    with.

    Parameters
    ----------
    path : Path
        A file.

    Returns
    -------
    bool

    """
    forms = [form for form in FORMATS if form.suffix == path.suffix.lower()]
    if not forms or not path.is_file():
        return False
    try:
        with path.open("rb") as file:
            beginning = file.read(BEGINNING)
    except OSError:
        return True  # to be refused with the reason
    return any(form.among_others is None or form.among_others(beginning, path) for form in forms)


def explained_by(path: Path) -> list[Path]:
    """Return the files beside a capture without which it cannot be read as it is.

    Parameters
    ----------
    path : Path
        A capture.

    Returns
    -------
    list of Path
        The skeleton of an AMC file, the description of a table; for most captures none.

    """
    if path.suffix.lower() == ".amc":
        try:
            return [find_skeleton(path)]
        except UnreadableFile:
            return []
    description = beside(path, DESCRIPTION)
    return [description] if description else []


def _at_rate(walk: xr.DataArray, rate_hz: float | None) -> xr.DataArray:
    """Return a capture on the clock that the caller names, if one is named."""
    if rate_hz is None:
        return walk
    return walk.assign_coords(time=np.arange(walk.sizes["time"]) / rate_hz)
