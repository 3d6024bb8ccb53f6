"""One function for all formats: the content of a file decides which reader takes it."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import xarray as xr

from eigenwalker.core.arguments import check_choice
from eigenwalker.core.trajectories import MILLIMETRES
from eigenwalker.io.capture_file import CaptureFile, as_utf8, read_bytes
from eigenwalker.io.errors import EXPORT_AGAIN, UnreadableFile
from eigenwalker.io.file_types import file_type_of, with_article
from eigenwalker.io.readers.asf_amc import looks_like_acclaim, read_asf_amc, skeleton_beside
from eigenwalker.io.readers.bvh import looks_like_bvh, read_bvh
from eigenwalker.io.readers.c3d import looks_like_c3d, read_c3d
from eigenwalker.io.readers.mot import looks_like_mot, read_mot
from eigenwalker.io.readers.netcdf import holds_trajectories, looks_like_netcdf, read_netcdf
from eigenwalker.io.readers.pose_json import holds_poses, looks_like_json, read_pose_json
from eigenwalker.io.readers.qualisys_tsv import looks_like_qualisys_tsv, read_qualisys_tsv
from eigenwalker.io.readers.trc import looks_like_trc, read_trc
from eigenwalker.io.readers.unmarked_table import (
    find_description,
    holds_points,
    looks_like_table,
    read_table,
)
from eigenwalker.io.readers.vicon_csv import looks_like_vicon_csv, read_vicon_csv
from eigenwalker.io.up_axis_and_unit import UNITS, Unit
from eigenwalker.markers.marker_sets import subjects

_ADVICE = {
    "NumPy": "write the positions of joints as CSV or JSON (docs/formats.md)",
    "HDF5": "if it is of movement, from_movement(xr.open_dataset(path)) reads it in Python",
}
"""What to do with files of some kinds that no reader takes."""
BEGINNING = 100_000
"""Bytes of a file from which it is decided whether it is meant as a capture."""


@dataclass(frozen=True)
class Reader:
    """A format that is read: how its files are known, and the function that reads them.

    Where other files have the suffix too, `is_meant` says by the beginning of a file and its path
    whether it is meant as a capture. `companion` finds the file beside a capture without which it
    cannot be read as it is.
    """

    name: str
    suffixes: tuple[str, ...]
    looks_like: Callable[[bytes], object]
    read: Callable[[CaptureFile], xr.DataArray]
    is_meant: Callable[[bytes, Path], object] | None = None
    companion: Callable[[Path], Path | None] | None = None


def _by_content(
    name: str,
    suffix: str,
    looks_like: Callable[[bytes], object],
    read: Callable[[CaptureFile], xr.DataArray],
) -> Reader:
    return Reader(name, (suffix,), looks_like, read, lambda beginning, _: looks_like(beginning))


READERS = (
    Reader("BVH", (".bvh",), looks_like_bvh, read_bvh),
    Reader("C3D", (".c3d",), looks_like_c3d, read_c3d),
    Reader("ASF/AMC", (".amc",), looks_like_acclaim, read_asf_amc, companion=skeleton_beside),
    Reader("NetCDF", (".nc",), looks_like_netcdf, read_netcdf, holds_trajectories),
    Reader("TRC", (".trc",), looks_like_trc, read_trc),
    Reader("STO/MOT", (".sto", ".mot"), looks_like_mot, read_mot),
    _by_content("Vicon CSV", ".csv", looks_like_vicon_csv, read_vicon_csv),
    _by_content("Qualisys TSV", ".tsv", looks_like_qualisys_tsv, read_qualisys_tsv),
    Reader("JSON", (".json",), looks_like_json, read_pose_json, holds_poses),
    Reader("table", (".csv", ".txt"), looks_like_table, read_table, holds_points, find_description),
)
"""Every format that is read, in the order in which they are tried."""
SUFFIXES = tuple(dict.fromkeys(suffix for reader in READERS for suffix in reader.suffixes))
"""Suffixes of files that may be captures."""


MOST_HZ = 1_000_000
"""No camera is faster."""


def read_mocap(
    path: str | os.PathLike[str],
    *,
    unit: str | None = None,
    rate_hz: float | None = None,
    default_unit: str | None = None,
    default_rate_hz: float | None = None,
    partial: Literal["refuse", "keep"] = "refuse",
    subject: str | None = None,
) -> xr.DataArray:
    """Return what a file of motion capture holds as trajectories, as captured.

    Read are C3D, BVH, motions (AMC) with their skeleton (ASF) beside them, TRC, OpenSim's STO and
    MOT, exports of Vicon (CSV) and Qualisys (TSV), JSON and tables of points, and NetCDF as
    `write_mocap` writes it. The content of a file decides, not its name.

    Parameters
    ----------
    path : str or path
        File to read.
    unit : {"um", "mm", "cm", "dm", "m", "in", "ft", "asf"}, optional
        Unit of length, in place of the one in the file. If left out, it is the one that the file
        names, else the one in which the body is as tall as people are, with a warning
        (`UnitGuessed`). ``"asf"`` is the unit of CMU skeletons, inch/0.45.
    rate_hz : float, optional
        Frames a second, in place of those in the file. If left out, they are those that the file
        names, else the usual ones of its format, with a warning (`RateAssumed`).
    default_unit, default_rate_hz : optional
        Unit and frames a second for a file that names none; other files keep their own.
    partial : {"refuse", "keep"}
        What to do with a file that declares more frames than it has (BVH, C3D, TRC, STO, Qualisys
        TSV, tables with a number of frames in the first line): refuse it, or take its whole frames.
        ``attrs["n_frames_cut"]`` is then the number of frames that are missing at the end.
    subject : str, optional
        The person to take from a capture of several (``"Anna"`` for ``Anna:LKNE``).

    Returns
    -------
    DataArray of shape (time, marker, axis)
        Positions in millimetres, z up; NaN where a marker was not seen. ``attrs`` hold ``source``
        (name of the file), ``format``, ``up_axis`` (upward axis of the file) and whether that is
        known (``up_axis_known``), ``unit`` (of the file), whether it is guessed (``unit_guessed``)
        and the reason for it (``unit_reason``). Where joints have orientations, they are in the
        coordinate ``rotation`` (time, marker, axis), as rotation vectors in radians.

    Raises
    ------
    UnreadableFile
        If there is no such file, or it is damaged, cut short, or of another format.
    ValueError
        If an argument makes no sense.

    See Also
    --------
    write_mocap : Writes such files.
    eigenwalker.markers.virtual_markers : Makes the 15 joints of what was read.

    Examples
    --------
    >>> ew.read_mocap("nowhere.c3d")
    Traceback (most recent call last):
    ...
    eigenwalker.io.errors.UnreadableFile: nowhere.c3d: expected a file, but got nothing of
    that name in '.'; check the path.
    """
    path = Path(path)
    given = checked_arguments(unit, rate_hz, default_unit, default_rate_hz, partial)
    content = as_utf8(read_bytes(path))
    file = CaptureFile(path, content, **given)
    for reader in READERS:
        if reader.looks_like(content):
            trajectories = reader.read(file)
            return trajectories if subject is None else _of_subject(trajectories, subject)
    raise _unknown_file(file)


def checked_arguments(
    unit: str | None = None,
    rate_hz: float | None = None,
    default_unit: str | None = None,
    default_rate_hz: float | None = None,
    partial: str = "refuse",
) -> dict[str, Any]:
    """Return the arguments of `read_mocap` as a `CaptureFile` takes them; refuse wrong ones."""
    check_choice(partial, ("refuse", "keep"), "partial")
    return {
        "unit": _checked_unit("unit", unit),
        "rate_hz": _checked_rate("rate_hz", rate_hz),
        "default_unit": _checked_unit("default_unit", default_unit),
        "default_rate_hz": _checked_rate("default_rate_hz", default_rate_hz),
        "keep_partial": partial == "keep",
    }


def _of_subject(trajectories: xr.DataArray, subject: str) -> xr.DataArray:
    """Return the markers of one subject, without its name before theirs."""
    if trajectories.attrs.get("subject") == subject:
        return trajectories
    names = [str(name) for name in trajectories.marker.values]
    own = [i for i, name in enumerate(names) if name.rpartition(":")[0] == subject]
    if not own:
        known = [name for name in subjects(names) or [trajectories.attrs.get("subject")] if name]
        advice = f"give one of {known}" if known else "it names nobody: leave this out"
        raise ValueError(f"subject={subject!r} is not in the capture; {advice}.")
    markers = [names[i].rpartition(":")[2] for i in own]
    chosen = trajectories.isel(marker=own)
    chosen["marker"] = markers
    return chosen.assign_attrs(subject=subject)


def _checked_unit(argument: str, unit: str | None) -> Unit | None:
    known = MILLIMETRES | UNITS
    if unit is None:
        return None
    check_choice(unit, sorted(known), argument)
    return Unit(unit, known[unit], "named by the caller")


def _checked_rate(argument: str, rate_hz: float | None) -> float | None:
    if rate_hz is not None and not 0 < rate_hz <= MOST_HZ:
        raise ValueError(
            f"{argument}={rate_hz:g} is no frame rate; give frames a second, above 0 and up to "
            f"{MOST_HZ}."
        )
    return rate_hz


def _unknown_file(file: CaptureFile) -> UnreadableFile:
    suffix = file.path.suffix.lower()
    if file.content.startswith(b"MATLAB") or suffix == ".mat":
        return file.error(
            "a capture that says what it is",
            "a MATLAB file, which does not",
            "read an array of it by read_mat(path, variable, markers=..., rate_hz=...), walkers by "
            "read_walkers_mat(path) or read_mm(path)",
        )
    got = file_type_of(file.content)
    for kind, advice in _ADVICE.items():
        if kind in got:
            return file.error("a capture that says what it is", got, advice)
    by_name = [r.name for r in READERS if suffix in r.suffixes and r.is_meant is None]
    if by_name:
        expected = f"{with_article(' or '.join(by_name))} file, as it is called"
        return file.error(expected, got, EXPORT_AGAIN)
    names = ", ".join(reader.name for reader in READERS if reader.name != "table")
    expected = f"a capture ({names} or a table of points)"
    return file.error(expected, got, "export it as one of these")


def is_capture(path: Path) -> bool:
    """Return whether a file in a folder is meant as a capture, sound or not.

    Its suffix decides; for suffixes that other files have too, such as ``.csv``, its beginning.

    Parameters
    ----------
    path : Path
        A file.

    Returns
    -------
    bool

    See Also
    --------
    read_mocap
    """
    readers = [reader for reader in READERS if path.suffix.lower() in reader.suffixes]
    if not readers or not path.is_file():
        return False
    try:
        with path.open("rb") as file:
            beginning = as_utf8(file.read(BEGINNING))
    except OSError:
        return True  # to be refused with the reason
    return any(r.is_meant is None or bool(r.is_meant(beginning, path)) for r in readers)


def companion_files(path: Path) -> list[Path]:
    """Return the files beside a capture without which it cannot be read as it is."""
    companions = [reader.companion(path) for reader in READERS if reader.companion]
    return [companion for companion in companions if companion]
