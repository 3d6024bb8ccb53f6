"""One function for all formats: what a file is called and what it holds decide who reads it."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import xarray as xr

from eigenwalker.mocap.bvh import looks_like_bvh, read_bvh
from eigenwalker.mocap.c3d import looks_like_c3d, read_c3d
from eigenwalker.mocap.unreadable import AGAIN, UnreadableFile
from eigenwalker.mocap.upright import UNITS, Unit
from eigenwalker.trajectories import MILLIMETRES

MOST_BYTES = 2**31


class Format(NamedTuple):
    """A kind of file: what it is called, how to know it, and who reads it."""

    name: str
    suffix: str
    looks_like: Callable[[bytes], bool]
    read: Callable[..., xr.DataArray]


FORMATS = (
    Format("BVH", ".bvh", looks_like_bvh, read_bvh),
    Format("C3D", ".c3d", looks_like_c3d, read_c3d),
)
"""Every format that is read. A reader takes the bytes of a file and its name as ``source``."""


def read_mocap(path: str | os.PathLike[str], *, unit: str | None = None) -> xr.DataArray:
    """Return what a file holds as trajectories, as captured.

    Parameters
    ----------
    path : str or path
        A BVH or C3D file. What it holds decides, not what it is called.
    unit : {"um", "mm", "cm", "dm", "m", "in", "ft", "asf"}, optional
        Unit of length, for files that name none (all BVH) or the wrong one. If left out, it is the
        one the file names, or else the one in which the body is as tall as people are; that
        is warned of with `UnitGuessed`. ``"asf"`` is the unit of CMU skeletons, inch/0.45.

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
        If `unit` is not known.

    Examples
    --------
    >>> ew.read_mocap("nowhere.c3d")
    Traceback (most recent call last):
    ...
    eigenwalker.mocap.unreadable.UnreadableFile: nowhere.c3d: expected a file, but got nothing of
    that name in '.'; check the path.

    """
    path = Path(path)
    content = _content(path)
    known = MILLIMETRES | UNITS
    if unit is not None and unit not in known:
        raise ValueError(f"unit={unit!r} is not known; give one of {sorted(known)}.")
    named = None if unit is None else Unit(unit, known[unit], "named by the caller")
    for form in FORMATS:
        if form.looks_like(content):
            return form.read(content, source=path.name, unit=named)
    by_name = [form.name for form in FORMATS if form.suffix == path.suffix.lower()]
    formats = " or ".join(form.name for form in FORMATS)
    raise UnreadableFile(
        path.name,
        f"a {by_name[0]} file, as it is called" if by_name else f"a {formats} file",
        f"one that begins with {content[:16]!r}",
        AGAIN if by_name else f"export it as {formats}",
    )


def _content(path: Path) -> bytes:
    """Return the bytes of a file that is there and can be read."""
    name = path.name or str(path)
    if path.is_dir():
        raise UnreadableFile(name, "a file", "a folder", "name one of the files in it")
    if not path.exists():
        came = f"nothing of that name in {str(path.parent)!r}"
        raise UnreadableFile(name, "a file", came, "check the path")
    if not path.is_file():
        raise UnreadableFile(name, "a plain file", "a device or pipe", "save it as a file")
    try:
        if path.stat().st_size > MOST_BYTES:
            came = f"{path.stat().st_size / 1e9:.1f} GB"
            raise UnreadableFile(name, "2 GB at most", came, "cut it into shorter captures")
        content = path.read_bytes()
    except OSError as error:
        raise UnreadableFile(
            name, "a file that can be read", error.strerror or "an error", "check its permissions"
        ) from error
    if not content:
        raise UnreadableFile(name, "a capture", "an empty file")
    return content
