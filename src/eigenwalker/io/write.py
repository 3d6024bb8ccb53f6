"""One function for all formats: the suffix of the file decides which writer takes it."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Literal, NamedTuple

import xarray as xr

from eigenwalker.core.atomic_write import atomic_write
from eigenwalker.core.trajectories import MILLIMETRES, check_trajectories, sampling_rate
from eigenwalker.core.walker import Walker
from eigenwalker.io.up_axis_and_unit import turn_upright
from eigenwalker.io.writers.bvh import write_bvh
from eigenwalker.io.writers.c3d import write_c3d
from eigenwalker.io.writers.csv_trc import write_csv, write_trc
from eigenwalker.io.writers.netcdf import write_netcdf
from eigenwalker.io.writers.sampled_walk import RATE_HZ, sampled_walk, with_progress

Up = Literal["y", "z"]


class Format(NamedTuple):
    """A format that is written: its usual unit and upward axis, and its writer."""

    unit: str
    up: Up
    write: Callable[[xr.DataArray, str, Up, Path], None]


FORMATS = {
    ".bvh": Format("cm", "y", write_bvh),
    ".c3d": Format("mm", "z", write_c3d),
    ".csv": Format("mm", "z", write_csv),
    ".nc": Format("mm", "z", write_netcdf),
    ".trc": Format("mm", "y", write_trc),
}
"""Every format that is written, by suffix.

A writer takes positions in the unit and frame of the file, the unit, the upward axis, and the path.
"""


def write_mocap(
    trajectories: xr.DataArray | Walker,
    path: str | os.PathLike[str],
    *,
    n_strides: int | None = None,
    duration_s: float | None = None,
    rate_hz: float | None = None,
    overground: bool = False,
    unit: str | None = None,
    up: Up | None = None,
) -> Path:
    """Write trajectories, or a walker that walks, as a file of motion capture.

    ======= ==== == ========================================================================
    suffix  unit up content
    ======= ==== == ========================================================================
    .bvh    cm   y  a skeleton with constant bones, from the 15 joints (see `constant_bones`)
    .c3d    mm   z  the markers, as 4-byte floats
    .csv    mm   z  ``time_s``, then ``head_x, head_y, head_z, ...``; a first line names unit and up
    .nc     mm   z  NetCDF 3: the trajectories as they are, to be opened with xarray
    .trc    mm   y  the markers, as OpenSim reads them
    ======= ==== == ========================================================================

    With y up, the body faces z and has x to its left. The file appears whole or not at all.

    Parameters
    ----------
    trajectories : DataArray of shape (time, marker, axis), or Walker
        Positions in millimetres; NaN is missing, which BVH cannot hold.
    path : str or path
        File to write, or to replace.
    n_strides : int, optional
        Length of a walker's walk in strides; 4 if neither this nor `duration_s` is given.
    duration_s : float, optional
        Its length in seconds.
    rate_hz : float, optional
        Frames a second of a walker; 120 if left out.
    overground : bool
        Whether to put forward progress back, from the walker's ``speed_mm_s`` (of trajectories that
        walk in place, ``attrs["speed_mm_s"]``).
    unit : {"um", "mm", "cm", "dm", "m", "in", "ft"}, optional
        Unit of length in the file.
    up : {"y", "z"}, optional
        Axis that points up in the file.

    Returns
    -------
    Path
        The file written.

    Raises
    ------
    ValueError
        If the suffix or a choice is not known, or the format cannot hold these trajectories.
    FileNotFoundError
        If the folder does not exist.

    See Also
    --------
    read_mocap : Reads these files back.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> hop = ew.Walker(["foot"], [[0, 0, 50]], [[[0, 0, 40]]], [1], [0], 1.0)
    >>> with TemporaryDirectory() as folder:
    ...     path = write_mocap(hop, Path(folder) / "hop.csv", n_strides=1, rate_hz=4)
    ...     print(path.read_text())
    # eigenwalker trajectories; unit: mm; up: z; frames: 4
    time_s,foot_x,foot_y,foot_z
    0,0,0,50
    0.25,0,0,90
    0.5,0,0,50
    0.75,0,0,10
    <BLANKLINE>

    """
    path = Path(path)
    form = _format_of(path)
    unit, up = unit or form.unit, up or form.up
    if unit not in MILLIMETRES:
        raise ValueError(f"unit={unit!r} is not known; give one of {sorted(MILLIMETRES)}.")
    if up not in ("y", "z"):
        raise ValueError(f"up={up!r} is not known; give 'y' or 'z'.")
    if isinstance(trajectories, Walker):
        walk = sampled_walk(
            trajectories,
            n_strides=n_strides,
            duration_s=duration_s,
            rate_hz=rate_hz or RATE_HZ,
            overground=overground,
        )
    elif (n_strides, duration_s, rate_hz) != (None, None, None):
        raise ValueError(
            "n_strides, duration_s and rate_hz are for walkers; these are trajectories, which are "
            "written as they are."
        )
    else:
        walk = check_trajectories(trajectories)
        walk = with_progress(walk) if overground else walk
    sampling_rate(walk)  # which refuses uneven times
    turned = walk.copy(data=walk.values @ turn_upright(up) / MILLIMETRES[unit]).rename(path.name)
    with atomic_write(path) as unfinished:
        form.write(turned, unit, up, unfinished)
    return path


def _format_of(path: Path) -> Format:
    if path.suffix.lower() not in FORMATS:
        raise ValueError(f"{path.name!r} must end in one of {sorted(FORMATS)} to hold a capture.")
    if not path.parent.is_dir():
        raise FileNotFoundError(f"The folder {str(path.parent)!r} does not exist; make it first.")
    return FORMATS[path.suffix.lower()]
